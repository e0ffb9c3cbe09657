//! Scenes of one's own: documents in which MIMo is included.

mod guide;
mod refused;

use babybench::actuation::build;
use babybench::assets::MemoryAssets;
use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::env::BlueprintOptions;
use babybench::mimo::{BodyFigures, MimoJoints, joint_part};
use babybench::physics::ContactSide;
use babybench::runs::{read_scene, write_scene_from};
use babybench::sensors::SkinLayout;
use babybench::{Blueprint, Config, Env};
use std::path::Path;

use crate::allocations;
use crate::common::*;

/// A room: what is in the world besides MIMo, who lies on the floor, and what else is in the document.
fn room(world: &str, more: &str) -> String {
    format!(
        "<mujoco model=\"room\">
           <worldbody>
             <body name=\"mimo_location\" pos=\"0 0 0.1\" euler=\"0 -90 0\">
               <freejoint name=\"mimo_location\"/>
               <include file=\"mimo.xml\"/>
             </body>
             {world}
           </worldbody>
           <include file=\"base.xml\"/>
           <include file=\"mimo_settings.xml\"/>
           <include file=\"mimo_actuators.xml\"/>
           {more}
         </mujoco>"
    )
}

fn assets(files: &[(&str, &str)]) -> BlueprintOptions {
    let mut assets = MemoryAssets::new();
    for (path, text) in files {
        assets.insert(path, text.as_bytes()).expect("a path");
    }
    BlueprintOptions::default().with_assets(assets)
}

/// The blueprint of `config` in a room.
fn in_room(config: &Config, document: &str) -> Result<Blueprint, String> {
    let config = Config {
        scene: Scene::File("rooms/mine.xml".to_string()),
        ..config.clone()
    };
    Blueprint::with(config, assets(&[("rooms/mine.xml", document)])).map_err(|e| e.to_string())
}

fn felt(behavior: Behavior) -> Config {
    Config {
        touch_active: true,
        touch_scale: 2.0,
        ..free(behavior, Scene::Base)
    }
}

/// A number for everything that is observed in some steps.
fn observed(env: &mut Env) -> u64 {
    let mut sum = Fnv::default();
    env.reset(Some(7)).expect("no divergence");
    let mut action = Vec::new();
    for _ in 0..30 {
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        sum.add(step.observation.proprioception);
        sum.add(step.observation.vestibular.expect("balance is on"));
        let touch = step.observation.touch.expect("touch is on");
        sum.add(&touch.iter().map(|&v| f64::from(v)).collect::<Vec<_>>());
    }
    sum.0
}

#[test]
fn a_room_with_nothing_of_its_own_is_the_bare_floor_to_the_bit() {
    for behavior in [Behavior::None, Behavior::SelfTouch, Behavior::HandRegard] {
        for actuation_model in ActuationModel::ALL {
            let config = Config {
                actuation_model: *actuation_model,
                ..felt(behavior)
            };
            let own = in_room(&config, &room("", "")).expect("a room");
            let base = Blueprint::new(config).expect("the floor");
            assert!(own.model() == base.model(), "{behavior}, {actuation_model}");
            let [mut own, mut base] = [own, base].map(|b| b.env().expect("an environment"));
            assert_eq!(observed(&mut own), observed(&mut base), "{behavior}, {actuation_model}");
        }
    }
}

#[test]
fn a_room_runs_alike_each_time() {
    let ball = "<body name=\"ball\" pos=\"0.1 0.3 0.3\"><freejoint/><geom size=\"0.05\" mass=\"0.1\"/></body>";
    let run = || {
        observed(
            &mut in_room(&felt(Behavior::SelfTouch), &room(ball, ""))
                .expect("a room")
                .env()
                .expect("one"),
        )
    };
    let first = run();
    assert_eq!(first, run());
    let bare = observed(
        &mut in_room(&felt(Behavior::SelfTouch), &room("", ""))
            .expect("a room")
            .env()
            .expect("one"),
    );
    assert_ne!(first, bare, "he does not notice the ball");
}

#[test]
fn a_toy_on_the_belly_is_felt() {
    let toy = "<body name=\"toy\" pos=\"-0.05 0 0.25\"><freejoint/><geom name=\"toy\" type=\"box\" size=\".04 .04 .02\" mass=\".3\"/></body>";
    let mut env = in_room(&felt(Behavior::None), &room(toy, ""))
        .expect("a room")
        .env()
        .expect("one");
    env.reset(Some(0)).expect("no divergence");
    let rest = vec![0.0; env.action_space().len()];
    repeat(&mut env, &rest, 20);
    let geom = env.model().geom("toy").expect("the toy");
    let touch = env.senses().touch().expect("the skin");
    let press: f64 = touch
        .contacts()
        .iter()
        .filter(|c| c.other == ContactSide::Geom(geom))
        .map(|c| c.normal)
        .sum();
    assert!(press > 1.0, "the toy presses with {press} N");
}

/// Toys with names of MIMo's kind: a finger and a hand of v2 and of none, a joint of his, a motor, senses.
const IMPOSTORS: &str = "
    <body name=\"left_ffdistal\" pos=\"0.6 0.6 0.1\">
      <joint name=\"robot:head_tilt2\" type=\"hinge\" axis=\"0 1 0\" range=\"-90 90\"/>
      <geom name=\"false finger\" size=\"0.05\" mass=\"0.2\"/>
      <site name=\"false site\"/>
      <body name=\"left_head\" pos=\"0 0 0.15\">
        <joint name=\"robot:left_knee2\" type=\"hinge\" axis=\"1 0 0\" range=\"-90 90\"/>
        <geom size=\"0.05\" mass=\"0.2\"/>
      </body>
    </body>
    <body name=\"hand\" pos=\"0 0.03 0.4\"><freejoint name=\"robot:free\"/><geom name=\"false hand\" size=\"0.05\" mass=\"0.2\"/></body>";
const FALSE_SENSES: &str = "
    <actuator>
      <motor name=\"act:head_tilt2\" joint=\"robot:head_tilt2\" gear=\"0.1\"/>
      <position name=\"spring\" joint=\"robot:left_knee2\" kp=\"0.5\" user=\"1 2 3\"/>
    </actuator>
    <sensor><torque name=\"false torque\" site=\"false site\"/><gyro name=\"false gyro\" site=\"false site\"/></sensor>";

#[test]
fn toys_with_the_names_of_parts_are_toys() {
    for behavior in [Behavior::SelfTouch, Behavior::None] {
        for actuation_model in ActuationModel::ALL {
            let config = Config {
                actuation_model: *actuation_model,
                age: Some(9.0),
                ..felt(behavior)
            };
            let blueprint = in_room(&config, &room(IMPOSTORS, FALSE_SENSES)).expect("a room");
            let base = Blueprint::new(config.clone()).expect("the floor");
            let (model, plain) = (blueprint.model(), base.model());
            // joints and parts
            assert_eq!(MimoJoints::new(model).len(), 47);
            for name in ["robot:head_tilt2", "robot:left_knee2", "robot:free"] {
                assert_eq!(joint_part(model, model.joint(name).expect("the toy's")), None);
            }
            assert_eq!(BodyFigures::of(model), BodyFigures::of(plain));
            // skin
            let bodies = |layout: &SkinLayout| layout.bodies().iter().map(|b| b.name.clone()).collect::<Vec<_>>();
            let [skin, other] = [&blueprint, &base].map(|b| b.skin().expect("touch is on"));
            assert_eq!((bodies(skin), skin.len()), (bodies(other), other.len()));
            // actions and observations
            let [mut env, mut other] = [&blueprint, &base].map(|b| b.env().expect("an environment"));
            assert_eq!(env.action_space(), other.action_space());
            assert_eq!(
                format!("{:?}", env.observation_space()),
                format!("{:?}", other.observation_space())
            );
            assert_eq!(
                env.blueprint().actuation().action_names(model),
                build(plain, &config).expect("it fits").action_names(plain)
            );
            let toys = ["act:head_tilt2", "spring"].map(|name| model.actuator(name).expect("the toy's"));
            assert_eq!(model.actuator_gear[toys[0]], 0.1, "toys do not grow");
            other.reset(Some(1)).expect("no divergence");
            env.reset(Some(1)).expect("no divergence");
            random_steps(&mut env, 10);
            for toy in toys {
                assert_eq!(env.state().ctrl[toy], 0.0);
            }
            if behavior == Behavior::SelfTouch {
                let false_hand = model.geom("false hand").expect("the toy");
                let touches = env.info().behavior.touches().expect("self-touch");
                assert!(touches.into_iter().all(|list| !list.contains(&false_hand)));
            }
        }
    }
}

#[test]
fn a_servo_of_a_toy_holds_whatever_moves_mimo() {
    let angle = |actuation_model| {
        let config = Config {
            actuation_model,
            ..free(Behavior::None, Scene::Base)
        };
        let mut env = in_room(&config, &room(IMPOSTORS, FALSE_SENSES))
            .expect("a room")
            .env()
            .expect("one");
        env.reset(Some(0)).expect("no divergence");
        let joint = env.model().joint("robot:left_knee2").expect("the toy's");
        let at = env.model().jnt_qposadr[joint];
        let mut start = env.state().qpos.clone();
        start[at] = 0.5;
        let still = vec![0.0; env.model().nv];
        env.by_hand().reset_to(&start, &still).expect("a state");
        let rest = vec![0.0; env.action_space().len()];
        repeat(&mut env, &rest, 5);
        env.state().qpos[at]
    };
    let angles = [ActuationModel::SpringDamper, ActuationModel::Muscle].map(angle);
    assert!(angles[0] < 0.5 && angles[0] == angles[1], "{angles:?}");
}

#[test]
fn a_step_in_a_room_allocates_nothing_after_the_first_few() {
    for actuation_model in ActuationModel::ALL {
        let config = Config {
            actuation_model: *actuation_model,
            ..felt(Behavior::SelfTouch)
        };
        let mut env = in_room(&config, &room(IMPOSTORS, FALSE_SENSES))
            .expect("a room")
            .env()
            .expect("one");
        env.reset(Some(0)).expect("no divergence");
        let action = vec![0.1; env.action_space().len()];
        repeat(&mut env, &action, 200);
        env.reset(Some(0)).expect("no divergence");
        let calls = allocations::of_this_thread();
        repeat(&mut env, &action, 50);
        assert_eq!(allocations::of_this_thread() - calls, 0, "{actuation_model}");
    }
}

#[test]
fn mimo_grows_where_he_lies_and_his_toys_do_not_hold_him_up() {
    // a ball that is lower than MIMo and one that is higher than him: neither is he
    let toys = "<geom name=\"cellar\" size=\".1\" pos=\"3 0 -2\"/><geom name=\"lamp\" size=\".1\" pos=\"-3 0 4\"/>";
    for age in [0.0, 24.0] {
        let config = Config {
            age: Some(age),
            ..free(Behavior::None, Scene::Base)
        };
        let own = in_room(&config, &room(toys, "")).expect("a room");
        let base = Blueprint::new(config.clone()).expect("the floor");
        let place = |blueprint: &Blueprint| {
            let body = blueprint.model().body("mimo_location").expect("MIMo");
            blueprint.model().body_pos[body]
        };
        assert_eq!(place(&own), place(&base), "{age} months");
        // on a shelf that leans, he is moved up, not along it
        let shelf = room("", "").replace(
            "<body name=\"mimo_location\" pos=\"0 0 0.1\" euler=\"0 -90 0\">",
            "<body name=\"shelf\" pos=\"1 1 1\" euler=\"30 0 0\"><body name=\"mimo_location\" pos=\"0 0 0.1\">",
        );
        let shelf = shelf.replace("<freejoint name=\"mimo_location\"/>", "");
        let shelf = shelf.replace("</body>", "</body></body>");
        let hip = |config: &Config| {
            let mut env = in_room(config, &shelf).expect("a room").env().expect("one");
            let (start, still) = (env.model().qpos0.clone(), vec![0.0; env.model().nv]);
            env.by_hand().reset_to(&start, &still).expect("a state");
            env.state().xpos[env.model().body("hip").expect("MIMo")]
        };
        let original = Config {
            age: None,
            ..config.clone()
        };
        let (grown, original) = (hip(&config), hip(&original));
        let [x, y, z] = [0, 1, 2].map(|k| (grown[k] - original[k]).abs());
        assert!(
            x < 1e-12 && y < 1e-12 && z > 1e-3,
            "{age} months: {grown:?}, {original:?}"
        );
    }
}

#[test]
fn snapshots_tell_rooms_apart_by_what_is_in_them() {
    let plain = free(Behavior::None, Scene::Base);
    let take = |world: &str| {
        let mut env = in_room(&plain, &room(world, "")).expect("a room").env().expect("one");
        env.reset(Some(0)).expect("no divergence");
        env
    };
    let wall = |x: f64| format!("<geom name=\"wall\" type=\"box\" size=\".1 1 1\" pos=\"{x} 0 0\"/>");
    let (mut here, mut same, mut other) = (take(&wall(2.0)), take(&wall(2.0)), take(&wall(2.5)));
    let moment = here.snapshot();
    random_steps(&mut here, 3);
    same.restore(&moment).expect("the same room");
    let error = other.restore(&moment).expect_err("the wall is elsewhere").to_string();
    assert!(error.contains("scene"), "{error}");
    // wherever it lies
    let config = Config {
        scene: Scene::File("moved.xml".to_string()),
        ..plain.clone()
    };
    let moved = Blueprint::with(config, assets(&[("moved.xml", &room(&wall(2.0), ""))])).expect("a room");
    moved.env().expect("one").restore(&moment).expect("the same room");
}

#[test]
fn the_scene_of_a_run_holds_the_whole_room() {
    let dots = "<asset><texture name=\"dots\" type=\"2d\" file=\"a/rug.png\"/><material name=\"dots\" texture=\"dots\"/></asset>";
    let document = room(
        "<geom name=\"mat\" type=\"box\" size=\".5 .5 .01\" pos=\"1 1 0\" material=\"dots\"/>",
        dots,
    );
    let picture =
        std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/tex/leg_up.png")).expect("a picture");
    let mut files = MemoryAssets::new();
    files.insert("rooms/mine.xml", document).expect("a path");
    files.insert("rooms/a/rug.png", picture).expect("a path");
    let config = Config {
        scene: Scene::File("rooms/mine.xml".to_string()),
        ..free(Behavior::SelfTouch, Scene::Base)
    };
    let meant = babybench::mimo::build_model(&config, &files).expect("a room");
    let folder = Folder::new("room_of_a_run");
    write_scene_from(&config, &files, folder.path()).expect("a document");
    let found = read_scene(folder.path()).expect("it loads");
    let names = |model: &babybench::Model| (model.geom_name.clone(), model.body_mass.clone(), model.textures.len());
    assert_eq!(names(&found), names(&meant));
    // his rug and the library's have the same name, and both are there
    let file = |name: &str| {
        let texture = found.textures.iter().find(|t| t.name == name).expect("a texture");
        let file = texture
            .file
            .iter()
            .chain(texture.cube_files.iter().flatten())
            .next()
            .expect("a file");
        std::fs::read(folder.path().join(file)).expect("it was written")
    };
    assert_ne!(file("dots"), file("texrug"));
}

#[test]
fn other_ages_and_actuators_keep_the_room() {
    let blueprint = in_room(&free(Behavior::SelfTouch, Scene::Base), &room(IMPOSTORS, "")).expect("a room");
    let servos = blueprint.with_actuation(ActuationModel::Positional).expect("servos");
    let young = servos.with_age(Some(2.0)).expect("an infant");
    for other in [&servos, &young] {
        assert!(other.model().body("left_head").is_some());
        other.scenery().expect("its look");
    }
    assert!(young.model().body_mass.iter().sum::<f64>() < servos.model().body_mass.iter().sum::<f64>());
}
