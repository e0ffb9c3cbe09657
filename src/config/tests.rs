//! Tests of the configuration; one helper, [`check`], returns the result of a text: the keys that differ from the defaults,
//! or the error.

mod conflicts;
mod keys;

use testkit::Rng;
use testkit::mutation::mutate_text;

use super::*;
use crate::limits::Limits;

/// The default of [`Limits::config_bytes`].
const CONFIG_BYTES: usize = 1 << 20;

fn read(input: &str) -> Result<Config, ConfigError> {
    Config::from_yaml(input, "c.yml")
}

/// Summarises in one line the keys of `config` that differ from the defaults, or the error.
fn summary(result: Result<Config, ConfigError>) -> String {
    match result {
        Err(error) => format!("error {error}"),
        Ok(config) => {
            let differs = |key: &&Key| key.value(&config) != key.default_value();
            let show = |key: &Key| format!("{}={}", key.name, key.value(&config).to_yaml());
            Config::keys()
                .iter()
                .filter(differs)
                .map(show)
                .collect::<Vec<_>>()
                .join(" ")
        }
    }
}

#[track_caller]
fn check(input: &str, expect: &str) {
    assert_eq!(summary(read(input)), expect, "input: {input:.200}");
}

#[track_caller]
fn check_error(input: &str, expect: &str) {
    check(input, &format!("error c.yml{expect}"));
}

#[test]
fn defaults_are_those_of_the_api_page() {
    let page = "save_dir=\"results/test_installation\" behavior=none scene=base max_episode_steps=1000 frame_skip=1 \
                render_size=480 save_logs_every=1000 compat=api mimo_version=2 engine=soft renderer=cpu learner=mimo other_age=none scene_extra=\"\" mocap_motion=\"\" seed=0 facial_expression=default done_active=true action_penalty=true jitter=false position_inaccurate=false \
                starting_position=supine mobile_limb=right_foot mobile_baseline=0.2 mobile_extinction=0.2 mobile_reward=false play_reward=false GROWTH DELAYS proprio_velocity=true \
                proprio_torque=true proprio_limits=true proprio_actuation=true vestibular_active=true \
                vision_active=true vision_resolution=64 vision_outputs=[rgb] vision_threads=1 vision_rate=none vision_lazy=false EYES touch_active=true touch_scale=1.0 touch_function=normal touch_rate=none \
                touch_response=nearest touch_hands=true touch_fingers=true touch_arms=true touch_feet=true \
                touch_legs=true touch_body=true touch_head=true touch_eyes=false PAIN actuation_model=spring_damper \
                act_hands=true act_fingers=true act_arms=true act_feet=true act_legs=true act_body=true act_head=true \
                act_eyes=true act_others=false REFLEXES lock_hands=false lock_fingers=false lock_arms=false lock_feet=false lock_legs=false \
                lock_body=false lock_head=false lock_eyes=false";
    let growth = "age=none age_schedule=none age_grid=0.25 strength_age=none strength=volume springs=fixed proportions=mimo touch_grows=false \
                  sex=none length_z=none weight_z=none head_z=none gestation=none body_random=0.0 body_seed=0 body_number=0 \
                  strength_neck=1.0 strength_trunk=1.0 strength_shoulder=1.0 \
                  strength_elbow=1.0 strength_wrist=1.0 strength_grip=1.0 strength_hip=1.0 strength_knee=1.0 \
                  strength_ankle=1.0 ankle_circumference=none calf_circumference=none \
                  elbow_hand_length=none fist_breadth=none foot_breadth=none foot_length=none \
                  forearm_circumference=none hand_breadth=none hand_length=none head_circumference=none \
                  hip_breadth=none knee_sole_length=none middle_finger_diameter=none rump_knee_length=none \
                  shoulder_elbow_length=none thigh_circumference=none thumb_diameter=none upper_arm_circumference=none";
    let delays = "delay_unit=steps delay_by_age=false delay_sensory=0.0 delay_motor=0.0 delay_proprioception=none delay_touch=none \
                  delay_vestibular=none delay_vision=none noise_proprioception=0.0 noise_touch=0.0 \
                  noise_vestibular=0.0 noise_vision=0.0 noise_motor=0.0 noise_motor_color=none";
    let eyes = "vision_width=none vision_width_left=none vision_width_right=none vision_height=none \
                vision_height_left=none vision_height_right=none vision_fovy=none vision_fovy_left=none \
                vision_fovy_right=none vision_acuity=false vision_acuity_left=none vision_acuity_right=none vision_foveation=0.0 \
                vision_foveation_left=none vision_foveation_right=none";
    let pain = "touch_pooled=false pain_active=false pain_threshold=20.0 pain_slope=0.1 pain_limit=none \
                pain_decay_old=0.0 pain_decay_new=1.0";
    let reflexes = "reflexes=none reflex_gain=1.0 reflex_vor=replace reflex_observed=false reflex_gain_palmar_grasp=none reflex_gain_plantar_grasp=none reflex_gain_rooting=none reflex_gain_moro=none reflex_gain_atnr=none \
                    reflex_gain_stepping=none reflex_gain_vor=none reflex_gain_stretch=none reflex_delay_palmar_grasp=none reflex_delay_plantar_grasp=none reflex_delay_rooting=none reflex_delay_moro=none reflex_delay_atnr=none \
                    reflex_delay_stepping=none reflex_delay_vor=none reflex_delay_stretch=none";
    let ours: Vec<String> = Config::keys()
        .iter()
        .map(|key| format!("{}={}", key.name, key.default_value().to_yaml()))
        .collect();
    let sections = [
        ("GROWTH", growth),
        ("DELAYS", delays),
        ("EYES", eyes),
        ("PAIN", pain),
        ("REFLEXES", reflexes),
    ];
    let all = sections
        .iter()
        .fold(page.to_string(), |all, (name, keys)| all.replace(name, keys));
    assert_eq!(ours.join(" "), all);
    check("{}", "");
    assert!(Config::default().validate().is_ok());
}

#[test]
fn values_arrive_in_their_fields() {
    check(
        "max_episode_steps: 1_000_000\nframe_skip: 4",
        "max_episode_steps=1000000 frame_skip=4",
    );
    check("seed: 18446744073709551615", "seed=18446744073709551615");
    check("touch_scale: 1e-1", "touch_scale=0.1");
    check(
        "touch_eyes: yes\nact_eyes: off\nlock_body: On",
        "touch_eyes=true act_eyes=false lock_body=true",
    );
    check("save_dir : out # where to\nscene : crib", "save_dir=\"out\" scene=crib");
    check(
        "\u{feff}scene: cubes\r\nengine: rapier\r\n",
        "scene=cubes engine=rapier",
    );
    check("%YAML 1.1\n---\nscene: crib\n...\n", "scene=crib");
    check(
        "{\"behavior\": \"self_touch\", \"touch_hands\": false}",
        "behavior=self_touch touch_hands=false",
    );
    let config = read("touch_hands: no\nact_legs: no\nlock_head: yes").unwrap();
    let off: Vec<_> = config
        .touch
        .iter()
        .filter(|(_, on)| !**on)
        .map(|(part, _)| part.name())
        .collect();
    assert_eq!(off, ["hands", "eyes"]);
    assert!(!config.act.get(Part::Legs) && config.lock.get(Part::Head));
    assert!(!read("touch_scale: 0").unwrap().touch_enabled() && !read("touch_active: no").unwrap().touch_enabled());
}

#[test]
fn errors_name_place_key_value_and_what_is_allowed() {
    check_error(
        "scene: crib\nbehaviour: none",
        ":2:1: unknown key `behaviour`; did you mean `behavior`?",
    );
    check_error(
        "Touch_Hand: 1",
        ":1:1: unknown key `Touch_Hand`; did you mean `touch_hands`?",
    );
    check_error("wings: 1", ":1:1: unknown key `wings`");
    check_error("<<: {scene: crib}", ":1:1: unknown key `<<`");
    check_error(
        "seed: 1\nscene: base\nseed: 2",
        ":3:1: `seed` was already given in line 1; keep one of the two",
    );
    check_error(
        "frame_skip: 0",
        ":1:13: `frame_skip` is 0, expected a whole number from 1 to 10000",
    );
    check_error(
        "seed: -1",
        ":1:7: `seed` is -1, expected a whole number from 0 to 18446744073709551615",
    );
    check_error(
        "render_size: 4097",
        ":1:14: `render_size` is 4097, expected a whole number from 1 to 4096",
    );
    check_error(
        "touch_scale: -2.5",
        ":1:14: `touch_scale` is -2.5, expected 0 or a finite number of at least 0.01",
    );
    check_error(
        "touch_active: 'True'",
        ":1:15: `touch_active` is 'True' in quotes, expected true or false",
    );
    let list = "expected a list in brackets of one or more of rgb, gray, depth, segmentation, each once";
    check_error("vision_outputs: []", &format!(":1:17: `vision_outputs` is [], {list}"));
    check_error(
        "vision_outputs: [rgb, rgb]",
        &format!(":1:23: `vision_outputs` is rgb, {list}"),
    );
    check_error(
        "vision_outputs: [depht]",
        &format!(":1:18: `vision_outputs` is depht, {list}; did you mean `depth`?"),
    );
    check_error("act_eyes: [1]", ":1:11: `act_eyes` is a list, expected true or false");
    check_error(
        "act_eyes: {a: 1}",
        ":1:11: `act_eyes` is a mapping, expected true or false",
    );
    check_error(
        "scene: cube",
        ":1:8: `scene` is cube, expected one of base, crib, cubes, mobile, playroom, blanket, or the path of a file that ends in .xml; did you mean `cubes`?",
    );
    check_error(
        "seed:\nscene: crib",
        ":1:5: `seed` needs a value: a whole number from 0 to 18446744073709551615; leave the line out for the default",
    );
    let (long, cut) = ("x".repeat(100_000), "x".repeat(60));
    check_error(&format!("? {long}\n: 1"), &format!(":1:3: unknown key `{cut}...`"));
}

#[test]
fn what_is_no_flat_mapping_is_refused() {
    let flat = "a configuration is one flat list of `key: value` lines";
    check_error("", &format!(":1:1: the file is empty: {flat}"));
    check_error("# nothing\n", &format!(":2:1: the file is empty: {flat}"));
    check_error("---\n", &format!(":1:4: the file is a single value: {flat}"));
    check_error("- scene\n", &format!(":1:1: the file is a list: {flat}"));
    check_error("crib", &format!(":1:1: the file is a single value: {flat}"));
    check_error("seed: 1\n---\nseed: 2\n", &format!(":2:1: a second document: {flat}"));
    check_error("scene: &a crib", &format!(":1:11: an anchor (`&`): {flat}"));
    check_error("scene: !!str crib", &format!(":1:14: a tag (`!`): {flat}"));
    check_error("&a {seed: 1}", &format!(":1:4: an anchor (`&`): {flat}"));
    check_error(
        "? [seed]\n: 1",
        &format!(":1:3: a key that is a list or mapping: {flat}"),
    );
    check_error(
        "scene: *a",
        ":1:8: not valid YAML: while parsing node, found unknown anchor",
    );
}

#[test]
fn milliseconds_are_rounded_to_steps() {
    let delays = Delays {
        unit: DelayUnit::Ms,
        ..Delays::default()
    };
    for (ms, frame_skip, steps) in [
        (0.0, 1, 0),
        (2.4, 1, 0),
        (2.5, 1, 1),
        (100.0, 1, 20),
        (100.0, 2, 10),
        (104.9, 2, 10),
    ] {
        assert_eq!(delays.steps(ms, frame_skip), steps, "{ms} ms, frame_skip {frame_skip}");
    }
}

#[test]
fn a_changed_configuration_is_checked_like_a_file() {
    let invalid = [
        (
            Config {
                frame_skip: 0,
                ..Config::default()
            },
            "frame_skip",
        ),
        (
            Config {
                touch_scale: f64::NAN,
                ..Config::default()
            },
            "touch_scale",
        ),
        (
            Config {
                save_dir: String::new(),
                ..Config::default()
            },
            "save_dir",
        ),
        (
            Config {
                touch_function: TouchFunction::NormalForce,
                ..Config::default()
            },
            "touch_function",
        ),
    ];
    for (config, key) in invalid {
        let error = config.validate().unwrap_err();
        assert_eq!((error.key(), error.position()), (Some(key), None), "{error}");
    }
}

#[test]
fn files_are_read_within_the_limit_and_as_utf_8() {
    let folder = std::env::temp_dir().join(format!("babybench-config-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("c.yml");
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        Config::from_file(&path)
    };
    assert_eq!(read(b"scene: crib\n").unwrap().scene, Scene::Crib);
    let error = read(b"seed: 1\nsave_dir: \xc3\xa9\xff\n").unwrap_err();
    assert!(
        matches!(error, ConfigError::Encoding { .. }) && error.position() == Some((2, 12)),
        "{error}"
    );
    assert!(matches!(
        read(&vec![b'#'; CONFIG_BYTES]),
        Err(ConfigError::Unsupported { .. })
    ));
    assert!(matches!(
        read(&vec![b'#'; CONFIG_BYTES + 1]),
        Err(ConfigError::TooLarge { .. })
    ));
    let limits = Limits {
        config_bytes: 11,
        ..Limits::default()
    };
    let reader = ConfigReader {
        limits,
        ..ConfigReader::default()
    };
    std::fs::write(&path, "scene: crib").unwrap();
    assert!(reader.clone().read_file(&path).is_ok());
    let error = reader.read_text("scene: cubes", "c.yml");
    assert!(matches!(error, Err(ConfigError::TooLarge { limit: 11, .. })));
    std::fs::remove_dir_all(&folder).unwrap();
    let error = Config::from_file(&path).unwrap_err();
    assert!(
        matches!(error, ConfigError::Read { .. }) && error.to_string().contains("c.yml"),
        "{error}"
    );
}

#[test]
fn example_configurations_load() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let mut count = 0;
    for path in files {
        let name = path.display().to_string();
        let config = Config::from_file(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(read(&config.to_yaml()).unwrap(), config, "{name}");
        count += 1;
    }
    assert!(count >= 3, "{} holds {count} configurations", folder.display());
}

#[test]
fn bombs_end_in_an_error() {
    let most = CONFIG_BYTES;
    let bombs = [
        "[".repeat(most),
        "{".repeat(most),
        "? ".repeat(most / 2),
        "- ".repeat(most / 2),
        format!("seed: {}", "[".repeat(most - 6)),
        format!("? {}\n: 1", "k".repeat(most - 8)),
        format!("save_dir: {}\n{}", "x ".repeat(1000), "#\n".repeat(most / 4)) + "x",
        "a: &a [1]\nb: &b [*a,*a]\nc: &c [*b,*b]\n".repeat(1000),
        "seed: 1\n".repeat(most / 8),
        "\n---".repeat(most / 4),
        "\t".repeat(most),
        "!".repeat(most),
        "\"".repeat(most - 1),
        "%x\n".repeat(most / 4),
    ];
    for bomb in bombs {
        let error = read(&bomb).unwrap_err().to_string();
        assert!(error.len() < 400, "{error}");
    }
}

#[test]
fn damaged_files_never_panic() {
    let seeds = [
        Config::default().to_yaml(),
        "scene : crib # c\nsave_dir: \"\\u00e9\"\nseed: 1_0\ntouch_scale: 1.\n".to_string(),
        "{\"behavior\": 'none', ? seed : 3, touch_scale: -1e3}\n...\n".to_string(),
    ];
    let mut rng = Rng::with_seed(1);
    let (mut good, mut bad) = (0, 0);
    for round in 0..6000 {
        let text = mutate_text(&seeds[round % seeds.len()], &mut rng);
        match read(&text) {
            Ok(config) => {
                good += 1;
                assert_eq!(read(&config.to_yaml()).unwrap(), config);
            }
            Err(error) => {
                bad += 1;
                assert!(
                    error.position().is_some() && error.to_string().starts_with("c.yml:"),
                    "{error}"
                );
            }
        }
    }
    assert!(good > 500 && bad > 500, "{good} loaded, {bad} refused");
}
