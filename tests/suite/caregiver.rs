//! Bodies that follow paths, or are put somewhere by a program: a caregiver's hand.

use std::path::Path;

use babybench::vector::{VectorEnv, VectorOptions};
use babybench::{Blueprint, Config, Env, EnvError};

use testkit::show;

/// The room in which a caregiver's hand moves on its path.
pub(crate) fn caregiver() -> Config {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/config_caregiver.yml");
    let config = Config::from_file(&file).expect("the configuration");
    Config {
        vision_active: false,
        ..config
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Steps without moving; returns where the hand was, and how strongly MIMo felt it in each step.
fn live(env: &mut Env, steps: usize) -> Vec<([f64; 3], f64)> {
    let action = vec![0.0; env.action_space().len()];
    let hand = env.model().body("caregiver").expect("a hand");
    let mut lived = Vec::new();
    for _ in 0..steps {
        env.step(&action).expect("steps");
        let of_hand = |geom: usize| env.model().geom_bodyid[geom] == hand;
        let contacts = env.state().contact.iter();
        let felt = contacts.filter(|c| c.geom.into_iter().any(of_hand)).map(|c| c.force[0]);
        lived.push((env.state().mocap_pos[0], felt.sum()));
    }
    lived
}

#[test]
fn a_hand_strokes_mimo_where_its_path_says() {
    let mut env = Env::new(caregiver()).expect("the room");
    env.reset(Some(0)).expect("resets");
    let lived = live(&mut env, 1000);
    let dt = env.blueprint().dt();
    assert!((dt - 0.005).abs() < 1e-12);
    // the reset makes ten physics steps
    let at = |seconds: f64| lived[(seconds / dt) as usize - 11].0;
    assert!(distance(at(1.75), [-0.1, 0.12, 0.385]) < 2e-3, "{:?}", at(1.75));
    assert!(distance(at(4.9), [-0.2 * 1.4 / 1.5, 0.3, 0.5]) < 2e-3, "{:?}", at(4.9));
    let felt = |from: f64, to: f64| {
        let part = &lived[(from / dt) as usize..(to / dt) as usize];
        part.iter().filter(|(_, force)| *force > 0.0).count() as f64 / part.len() as f64
    };
    show!("touched in {:.2} of the stroke", felt(1.0, 2.5));
    assert_eq!(felt(0.0, 0.5), 0.0);
    assert!(felt(1.0, 2.5) > 0.8, "{}", felt(1.0, 2.5));
    assert_eq!(felt(3.5, 4.5), 0.0);
}

#[test]
fn snapshots_resets_and_vectors_know_where_the_hand_is() {
    let mut env = Env::new(caregiver()).expect("the room");
    env.reset(Some(0)).expect("resets");
    live(&mut env, 150);
    let snapshot = env.snapshot();
    let on = live(&mut env, 100);
    env.restore(&snapshot).expect("restores");
    assert_eq!(live(&mut env, 100), on);
    let mut other = env.blueprint().env().expect("another");
    other.restore(&snapshot).expect("restores");
    assert_eq!(live(&mut other, 100), on);

    env.reset(Some(0)).expect("resets");
    let alone = live(&mut env, 60);
    let blueprint = Blueprint::new(caregiver()).expect("the room");
    let mut envs = VectorEnv::new(&blueprint, 3, VectorOptions::default()).expect("memory");
    envs.reset(0).expect("resets");
    let actions = vec![0.0; 3 * env.action_space().len()];
    for _ in 0..60 {
        envs.step(&actions).expect("steps");
    }
    for k in 0..3 {
        let state = envs.env(k).expect("it is here").state();
        assert_eq!(state.mocap_pos[0], alone[59].0);
    }
}

#[test]
fn a_program_puts_it_elsewhere_until_a_reset() {
    let config = Config {
        mocap_motion: String::new(),
        ..caregiver()
    };
    let mut env = Env::new(config).expect("the room");
    env.reset(Some(0)).expect("resets");
    assert_eq!(live(&mut env, 1)[0].0, [-0.2, 0.3, 0.5]);
    env.by_hand()
        .set_mocap("caregiver", [0.1, 0.2, 0.6], [0.0; 4])
        .expect("a hand");
    assert_eq!(live(&mut env, 2)[1].0, [0.1, 0.2, 0.6]);
    for (name, pos) in [
        ("nobody", [0.0; 3]),
        ("head", [0.0; 3]),
        ("caregiver", [f64::NAN, 0.0, 0.0]),
    ] {
        env.by_hand()
            .set_mocap(name, pos, [1.0, 0.0, 0.0, 0.0])
            .expect_err(name);
    }
    assert_eq!(env.state().mocap_pos[0], [0.1, 0.2, 0.6]);
    env.reset(Some(0)).expect("resets");
    assert_eq!(env.state().mocap_pos[0], [-0.2, 0.3, 0.5]);
}

#[test]
fn paths_of_bodies_that_are_not_there_are_refused() {
    let config = Config {
        scene_extra: String::new(),
        ..caregiver()
    };
    match Env::new(config) {
        Err(EnvError::MocapMotion(error)) => {
            assert_eq!(error.line, 1);
            assert!(
                error.to_string().contains("the scene has no body \"caregiver\""),
                "{error}"
            );
        }
        other => panic!("{other:?}"),
    }
}
