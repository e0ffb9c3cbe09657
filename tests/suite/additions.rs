//! Additions to a scene of the library, and actuators of bodies that are not MIMo's.

use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::mimo::SceneBuilder;
use babybench::runs::complete_scene;
use babybench::{Blueprint, Config, Env};

use crate::common::*;

const BALL: &str = "<freejoint/><geom name='ball' size='0.04' mass='0.03' material='red'/>";
const RED: &str = "<asset><material name='red' rgba='1 0.2 0.2 1'/></asset>";
/// An arm of two joints, of which a motor turns the one and a servo the other.
const ARM: &str = "<body name='arm' pos='0.8 0 0.3'><joint name='arm' axis='0 0 1' damping='0.01'/><geom type='capsule' size='0.01' fromto='0 0 0 0.1 0 0'/>\
                   <body pos='0.1 0 0'><joint name='wrist' axis='0 1 0' damping='0.01'/><geom size='0.02'/></body></body>\
                   <actuator><motor name='arm' joint='arm' gear='0.01' ctrlrange='-2 2' ctrllimited='true'/><position name='wrist' joint='wrist' kp='0.1'/></actuator>";

fn with(scene: Scene, fragments: &[&str]) -> Config {
    let start = SceneBuilder::new(scene.clone());
    let builder = fragments.iter().fold(start, |builder, fragment| builder.with(fragment));
    builder.config(free(Behavior::SelfTouch, scene))
}

fn error(fragments: &[&str]) -> String {
    Blueprint::new(with(Scene::Crib, fragments))
        .expect_err("it is wrong")
        .to_string()
}

#[test]
fn bodies_are_added_to_every_scene_and_mimo_stays_as_he_is() {
    for scene in Scene::LIBRARY {
        let config = SceneBuilder::new(scene.clone())
            .body("a new ball", [0.0, 0.7, 1.0], BALL)
            .with(RED)
            .config(free(Behavior::SelfTouch, scene.clone()));
        let (plain, added) = (blueprint(free(Behavior::SelfTouch, scene.clone())), blueprint(config));
        assert_eq!(added.model().nbody(), plain.model().nbody() + 1, "{scene}");
        assert!(added.model().body("a new ball").is_some());
        let (mut one, mut other) = (plain.env().expect("valid"), added.env().expect("valid"));
        assert_eq!(one.action_space(), other.action_space());
        let lengths = |env: &mut Env| env.reset(Some(0)).expect("no divergence").proprioception.len();
        assert_eq!(lengths(&mut one), lengths(&mut other), "{scene}");
        random_steps(&mut other, 5);
    }
}

/// Nothing added is nothing changed; and the text is part of what a snapshot fits.
#[test]
fn snapshots_tell_what_was_added() {
    let plain = free(Behavior::SelfTouch, Scene::Crib);
    let same = with(Scene::Crib, &[]);
    assert_eq!(plain, same);
    let mut small = env(with(
        Scene::Crib,
        &["<body pos='0 0 2'><freejoint/><geom size='0.1' mass='1'/></body>"],
    ));
    let large = env(with(
        Scene::Crib,
        &["<body pos='0 0 2'><freejoint/><geom size='0.2' mass='1'/></body>"],
    ));
    let snapshot = large.snapshot();
    assert!(small.restore(&snapshot).is_err());
    let own = small.snapshot();
    small.restore(&own).expect("its own");
}

#[test]
fn configurations_hold_it_through_files_and_scenes() {
    let config = with(
        Scene::Crib,
        &[
            "<body name='ball' pos='0 0 2'>\n\t<freejoint/><geom size='0.1'/> <!-- so --></body>",
            RED,
        ],
    );
    assert_eq!(
        Config::from_yaml(&config.to_yaml(), "c.yml").expect("its own text"),
        config
    );
    let block =
        "scene: crib\nscene_extra: |\n  <geom name='one' size='1' pos='9 0 0'/>\n  <geom size='1' pos='9 9 0'/>\n";
    let read = Config::from_yaml(block, "c.yml").expect("a block of text");
    assert_eq!(read.scene_extra.lines().count(), 2);
    let scene = complete_scene(&config).expect("whole").xml;
    assert!(scene.contains("name=\"ball\"") && scene.matches("-->").count() == 1);
}

#[test]
fn faults_have_their_place_in_the_text() {
    for (fragments, place, what) in [
        (&["<geom colour='1'/>"][..], "scene_extra:1:", "colour"),
        (
            &[RED, "<body>\n  <geom size='0.1' material='blue'/>\n</body>"],
            "scene_extra:3:3",
            "blue",
        ),
        (
            &["<asset/> <geom size='1' colour='red'/>"],
            "scene_extra:1:10",
            "colour",
        ),
        (&["<body"], "scene_extra:1:", ""),
        (&["<geom size='1'/></mujocoinclude><geom/>"], "scene_extra:", ""),
        (&["<compiler angle='radian'/>"], "scene_extra:1:1", "write degrees"),
        (&["<option timestep='0.001'/>"], "scene_extra:1:1", "leave timestep out"),
        (&["<body name='hip'/>"], "scene_extra", "hip"),
        (
            &["<asset><texture name='t' type='2d' file='wood.png'/></asset>"],
            "scene_extra",
            "wood.png",
        ),
        (&["<include file='other.xml'/>"], "scene_extra", "other.xml"),
        (&["<nonsense/>"], "scene_extra:1:1", "nonsense"),
    ] {
        let error = error(fragments);
        println!("{error}");
        assert!(error.contains(place) && error.contains(what), "{fragments:?}: {error}");
    }
    for text in [
        "behavior: reach\nscene_extra: <geom/>",
        "scene: rooms/mine.xml\nscene_extra: <geom/>",
    ] {
        let error = Config::from_yaml(text, "c.yml").expect_err("refused").to_string();
        assert!(error.contains("c.yml:2:") && error.contains("leave it out"), "{error}");
    }
}

#[test]
fn other_actuators_rest_unless_they_are_asked_for() {
    for actuation_model in [ActuationModel::SpringDamper, ActuationModel::Positional] {
        let rest = Config {
            actuation_model,
            ..with(Scene::Crib, &[ARM])
        };
        let asked = Config {
            act_others: true,
            ..rest.clone()
        };
        let (mut rest, mut asked) = (env(rest), env(asked));
        let n = rest.action_space().len();
        assert_eq!(asked.action_space().len(), n + 2);
        assert_eq!(
            (asked.action_space().low()[n], asked.action_space().high()[n + 1]),
            (-2.0, 1.0)
        );
        let (model, actuation) = (asked.model().clone(), asked.blueprint().actuation());
        assert_eq!(actuation.action_names(&model)[n..], ["arm control", "wrist control"]);
        let names = actuation.observation_names(&model);
        assert_eq!(
            names[names.len() - 6..],
            [
                "arm control",
                "wrist control",
                "arm angle",
                "wrist angle",
                "arm velocity",
                "wrist velocity"
            ]
        );
        let length = rest.reset(Some(3)).expect("no divergence").proprioception.len();
        assert_eq!(
            asked.reset(Some(3)).expect("no divergence").proprioception.len(),
            length + 6
        );
        assert!(rest.restore(&asked.snapshot()).is_err());

        let id = |name: &str| model.actuator(name).expect("an actuator");
        repeat(&mut rest, &vec![0.1; n], 20);
        assert_eq!([rest.state().ctrl[id("arm")], rest.state().ctrl[id("wrist")]], [0.0; 2]);
        let mut action = vec![0.1; n + 2];
        action[n..].copy_from_slice(&[5.0, 0.5]);
        repeat(&mut asked, &action, 20);
        assert_eq!(
            [asked.state().ctrl[id("arm")], asked.state().ctrl[id("wrist")]],
            [2.0, 0.5]
        );
        let arm = model.jnt_qposadr[model.joint("arm").expect("a joint")];
        assert!(asked.state().qpos[arm] > rest.state().qpos[arm] + 0.01);
        let seen = asked.observation().proprioception;
        assert_eq!(
            seen[seen.len() - 6..seen.len() - 3],
            [2.0, 0.5, asked.state().qpos[arm]]
        );
        // the last number of an action has the name of its actuator
        action[n + 1] = f32::NAN;
        let error = asked.step(&action).expect_err("not finite").to_string();
        assert!(error.contains("wrist"), "{error}");
    }
    let muscles = "actuation_model: muscle\nact_others: true";
    let error = Config::from_yaml(muscles, "c.yml").expect_err("refused").to_string();
    assert!(
        error.contains("c.yml:2:") && error.contains("spring_damper or positional"),
        "{error}"
    );
}

/// Where there is nothing to drive besides MIMo, asking for it changes no bit.
#[test]
fn without_other_actuators_nothing_changes() {
    let plain = free(Behavior::SelfTouch, Scene::Crib);
    let asked = Config {
        act_others: true,
        ..plain.clone()
    };
    let run = |config: Config| {
        let mut env = env(config);
        env.reset(Some(1)).expect("no divergence");
        random_steps(&mut env, 30);
        bits(env.state())
    };
    assert!(run(plain) == run(asked));
}
