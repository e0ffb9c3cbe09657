//! Motions: joint angles over time become what MIMo feels and sees.

use crate::common::*;
use babybench::Limits;
use babybench::config::{ActuationModel, Behavior, Config, Scene};
use babybench::policy::{NoisePolicy, Policy};
use babybench::runs::{Motion, MotionError, MotionMode, Record, RecordOptions, Recorder, play_motion};
use babybench::spaces::Noise;
use babybench::{Blueprint, Env};

const STEPS: usize = 60;

fn crib(actuation_model: ActuationModel) -> Blueprint {
    blueprint(Config {
        behavior: Behavior::SelfTouch,
        scene: Scene::Crib,
        vision_active: false,
        actuation_model,
        ..Config::default()
    })
}

/// Moves MIMo at random; returns positions and proprioception after each step, and the motion that these are.
fn moved(env: &mut Env) -> (Vec<Vec<f64>>, Vec<Vec<f64>>, Motion) {
    env.reset(Some(4)).expect("no divergence");
    let mut policy = NoisePolicy::new(Noise::Held { seconds: 0.1 });
    policy.begin(env, 0).expect("a noise");
    let (mut action, mut qpos, mut felt) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..STEPS {
        policy.act(env, &mut action).expect("a noise");
        let step = env.step(&action).expect("no divergence");
        felt.push(step.observation.proprioception.to_vec());
        qpos.push(env.state().qpos.clone());
    }
    let joints = env.senses().proprioception().joints();
    let names = joints.joint.iter().map(|&j| env.model().jnt_name[j].clone()).collect();
    let angles = qpos.iter().flat_map(|q| joints.qpos.iter().map(|&at| q[at])).collect();
    let root = qpos
        .iter()
        .map(|q| ([q[0], q[1], q[2]], [q[3], q[4], q[5], q[6]]))
        .collect();
    let motion = Motion::new(names, 1.0 / env.blueprint().dt(), angles, Some(root)).expect("a motion");
    (qpos, felt, motion)
}

#[test]
fn a_motion_out_of_a_run_gives_its_proprioceptive_angles() {
    let blueprint = crib(ActuationModel::SpringDamper);
    let mut env = blueprint.env().expect("an environment");
    let (qpos, felt, motion) = moved(&mut env);
    let folder = Folder::new("motion_kinematic");
    let options = RecordOptions {
        senses: true,
        ..RecordOptions::default()
    };
    let mut recorder = Recorder::create(folder.path(), &env, options).expect("a folder");
    env.reset(Some(9)).expect("no divergence");
    let n = env.senses().proprioception().joints().len();
    let (mut step, mut touched) = (0, 0);
    let played = play_motion(
        &mut env,
        &motion,
        MotionMode::Kinematic,
        Some((&mut recorder, 0)),
        |env| {
            let found = env.observation().proprioception;
            for (k, (found, expected)) in found[..n].iter().zip(&felt[step][..n]).enumerate() {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "step {step}, angle {k}: {found}, {expected}"
                );
            }
            let same = env
                .state()
                .qpos
                .iter()
                .zip(&qpos[step])
                .all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(same, "step {step}: {:?}", &env.state().qpos[..7]);
            touched += usize::from(
                env.observation()
                    .touch
                    .is_some_and(|touch| touch.iter().any(|v| *v != 0.0)),
            );
            step += 1;
            assert_eq!(env.info().steps, step as u64);
            true
        },
    );
    let played = played.expect("a motion");
    assert_eq!((played.steps, played.error, played.worst), (STEPS as u64, 0.0, None));
    assert!(touched > STEPS / 2, "the crib is felt in {touched} steps");
    let record = Record::open(folder.path()).expect("a record");
    let npz = record.npz(0).expect("an archive");
    let angles = npz.get_f64("observation").expect("proprioception");
    assert_eq!(angles.shape[0], STEPS);
    let difference = angles.data[..n].iter().zip(&felt[0][..n]).map(|(a, b)| (a - b).abs());
    assert!(difference.fold(0.0, f64::max) < 1e-9);
}

#[test]
fn velocities_are_those_that_lead_from_pose_to_pose() {
    let blueprint = crib(ActuationModel::SpringDamper);
    let mut env = blueprint.env().expect("an environment");
    env.reset(Some(1)).expect("no divergence");
    let dt = env.blueprint().dt();
    // a joint at 2 rad/s in a motion whose rate differs from that of the steps, and a root that turns at 1 rad/s and climbs
    let (rate, frames) = (100.0, 21);
    let time = |k: usize| k as f64 / rate;
    let angles = (0..frames).map(|k| 2.0 * time(k) - 1.0).collect();
    let pose = |k: usize| {
        (
            [0.0, 0.0, 1.0 + 0.5 * time(k)],
            [(0.5 * time(k)).cos(), 0.0, 0.0, (0.5 * time(k)).sin()],
        )
    };
    let names = vec!["robot:right_elbow".to_string()];
    let motion = Motion::new(names, rate, angles, Some((0..frames).map(pose).collect())).expect("a motion");
    let model = env.model();
    let joint = model.joint("robot:right_elbow").expect("an elbow");
    let (qpos, dof) = (model.jnt_qposadr[joint], model.jnt_dofadr[joint]);
    let mut step = 0;
    let played = play_motion(&mut env, &motion, MotionMode::Kinematic, None, |env| {
        let state = env.state();
        let at = f64::from(step) * dt;
        assert!((state.qpos[qpos] - (2.0 * at - 1.0)).abs() < 1e-9, "step {step}");
        assert!((state.qvel[dof] - 2.0).abs() < 1e-9, "step {step}: {}", state.qvel[dof]);
        let expected = [0.0, 0.0, 0.5, 0.0, 0.0, 1.0];
        let near = state.qvel[..6].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(near, "step {step}: {:?}", &state.qvel[..6]);
        step += 1;
        true
    });
    assert_eq!(played.expect("a motion").steps, 41);
}

#[test]
fn motors_and_servos_follow_a_motion_and_the_record_is_repeated() {
    for actuation in [ActuationModel::SpringDamper, ActuationModel::Positional] {
        let blueprint = crib(actuation);
        let mut env = blueprint.env().expect("an environment");
        env.reset(Some(1)).expect("no divergence");
        let wave = |k: usize| -1.0 + 0.3 * (k as f64 / 20.0).sin();
        let names = vec!["robot:right_elbow".to_string()];
        let motion = Motion::new(names, 100.0, (0..200).map(wave).collect(), None).expect("a motion");
        let folder = Folder::new("motion_tracking");
        let mut recorder = Recorder::create(folder.path(), &env, RecordOptions::default()).expect("a folder");
        let played = play_motion(
            &mut env,
            &motion,
            MotionMode::Tracking,
            Some((&mut recorder, 3)),
            |_| true,
        );
        let played = played.expect("a motion");
        assert!(played.error > 0.0 && played.error < 0.25, "{actuation}: {played:?}");
        assert_eq!(played.worst.map(|(name, _)| name).as_deref(), Some("robot:right_elbow"));
        let record = Record::open(folder.path()).expect("a record");
        let replayed = record
            .replay(3, &mut blueprint.env().expect("an environment"))
            .expect("a replay");
        assert_eq!(
            (replayed.steps, replayed.first_difference),
            (played.steps, None),
            "{actuation}"
        );
    }
    let mut env = crib(ActuationModel::Muscle).env().expect("an environment");
    env.reset(Some(1)).expect("no divergence");
    let motion = Motion::new(vec!["robot:left_elbow".to_string()], 10.0, vec![0.0], None).expect("a motion");
    let refused = play_motion(&mut env, &motion, MotionMode::Tracking, None, |_| true).expect_err("muscles");
    assert!(matches!(refused, MotionError::Muscles), "{refused}");
}

#[test]
fn motions_are_files_of_numpy_and_tables() {
    let folder = Folder::new("motion_files");
    std::fs::create_dir_all(folder.path()).expect("a folder");
    let names = vec!["robot:right_elbow".to_string(), "robot:left_knee".to_string()];
    let root = vec![([0.0, 0.1, 0.2], [1.0, 0.0, 0.0, 0.0]); 3];
    let angles = vec![0.0, -0.5, 0.25, -0.75, 0.5, -1.0];
    let motion = Motion::new(names, 50.0, angles, Some(root)).expect("a motion");
    let path = folder.path().join("m.npz");
    motion.write(&path).expect("a file");
    assert_eq!(Motion::read(&path).expect("a motion"), motion);
    let table = "\u{feff}# from a video\ntime,robot:right_elbow,root_x,root_y,root_z,\"robot:left_knee\",root_qw,root_qx,root_qy,root_qz\r\n\
                 1.00, 0,0,0.1,0.2,-0.5,1,0,0,0\r\n1.02,0.25,0,0.1,0.2,-0.75,2,0,0,0\n\n1.04,0.5,0,0.1,0.2,-1,1,0,0,0\n";
    let path = folder.path().join("m.csv");
    std::fs::write(&path, table).expect("a file");
    let read = Motion::read(&path).expect("a motion");
    assert_eq!(
        (read.names(), read.angles(), read.root()),
        (motion.names(), motion.angles(), motion.root())
    );
    assert!((read.rate() - 50.0).abs() < 1e-9, "{}", read.rate());
    std::fs::write(&path, "time,robot:right_elbow\n0,90\n0.1,-45\n").expect("a file");
    let degrees = Motion::read_with(&path, true, &Limits::DEFAULT).expect("a motion");
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(degrees.angles(), [quarter, -0.5 * quarter]);
}

#[test]
fn hostile_tables_are_refused_with_their_line() {
    let folder = Folder::new("motion_hostile");
    std::fs::create_dir_all(folder.path()).expect("a folder");
    let path = folder.path().join("m.csv");
    let wide = format!("time{}\n", ",a".repeat(20_000));
    for (text, said) in [
        ("", "line 1: the table is empty"),
        ("a,b\n", "line 1: the first column is a; expected time"),
        ("time,a\n", "no frames"),
        ("time,a\n0,x\n", "line 2: x is not a number"),
        ("time,a\n0\n", "line 2: 1 cells, where the first line has 2 names"),
        ("time,a\n0,1,2\n", "line 2: 3 cells"),
        ("time,a\n0,nan\n", "frame 0 of \"a\" is NaN"),
        ("time,a\n0,inf\n", "expected an angle in rad"),
        ("time,a\n0,90\n", "--degrees"),
        ("time,a\n0,0\n0,0\n", "expected ascending times"),
        ("time,a\nnan,0\n0,0\n", "expected ascending times"),
        ("time,a\n0,0\n1e-300,0\n", "the rate is"),
        ("time,a\n0,0\n1e9,0\n", "motion_seconds"),
        ("time,a\n0,0\n1,0\n1.1,0\n", "resample"),
        ("time,a,a\n0,0,0\n", "appears twice"),
        ("time,root_x\n0,0\n", "the root has no column root_y"),
        ("time,root_x,root_x\n0,0,0\n", "root_x appears twice"),
        (
            "time,root_x,root_y,root_z,root_qw,root_qx,root_qy,root_qz\n0,0,0,0,0,0,0,0\n",
            "unit quaternion",
        ),
        (
            "time,root_x,root_y,root_z,root_qw,root_qx,root_qy,root_qz\n0,1e9,0,0,1,0,0,0\n",
            "within 1000 m",
        ),
        (&*wide, "more than 10000 columns"),
    ] {
        std::fs::write(&path, text).expect("a file");
        let error = Motion::read(&path).expect_err(said).to_string();
        assert!(error.contains(said), "{text:.60}: {error}");
    }
    std::fs::write(&path, [0xff, 0xfe]).expect("a file");
    assert!(Motion::read(&path).expect_err("no text").to_string().contains("UTF-8"));
    assert!(matches!(Motion::read("m.txt"), Err(MotionError::Kind { .. })));
    assert!(matches!(
        Motion::read(folder.path().join("none.csv")),
        Err(MotionError::Io { .. })
    ));
}

#[test]
fn motions_keep_to_limits_and_to_mimos_joints() {
    let one = |rate: f64, angles: Vec<f64>| Motion::new(vec!["robot:right_elbow".to_string()], rate, angles, None);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e12] {
        assert!(matches!(one(rate, vec![0.0]), Err(MotionError::Unfit(_))), "{rate}");
    }
    assert!(
        one(1e-9, vec![0.0, 0.0])
            .expect_err("31 years")
            .to_string()
            .contains("motion_seconds")
    );
    let limits = Limits {
        motion_numbers: 3,
        ..Limits::default()
    };
    let long = Motion::new_with(vec!["a".to_string()], 1.0, vec![0.0; 4], None, &limits);
    assert!(
        long.expect_err("long")
            .to_string()
            .contains("the limit motion_numbers is 3")
    );
    assert!(Motion::new(Vec::new(), 1.0, Vec::new(), None).is_err());
    let mut env = crib(ActuationModel::SpringDamper).env().expect("an environment");
    env.reset(None).expect("no divergence");
    let other = Motion::new(vec!["robot:right_elbo".to_string()], 1.0, vec![0.0], None).expect("a motion");
    let error = play_motion(&mut env, &other, MotionMode::Kinematic, None, |_| true).expect_err("no joint");
    assert!(
        error.to_string().contains("did you mean \"robot:right_elbow\"?"),
        "{error}"
    );
    let far = one(1.0, vec![3.0]).expect("a motion");
    let played = play_motion(&mut env, &far, MotionMode::Kinematic, None, |_| true).expect("a pose");
    assert_eq!(played.beyond_limits, ["robot:right_elbow"]);
    // whoever sits has no root to be moved
    let root = Some(vec![([0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.0])]);
    let rooted = Motion::new(Vec::new(), 1.0, Vec::new(), root).expect("a motion");
    for (behavior, scene) in [(Behavior::SelfTouch, Scene::Crib), (Behavior::SelfBody, Scene::Base)] {
        let config = Config {
            behavior,
            scene,
            vision_active: false,
            ..Config::default()
        };
        let mut env = blueprint(config).env().expect("an environment");
        env.reset(None).expect("no divergence");
        let free = env.model().jnt_type[0] == babybench::model::JointType::Free;
        match play_motion(&mut env, &rooted, MotionMode::Kinematic, None, |_| true) {
            Ok(played) => assert!(free && played.steps == 1, "{behavior}"),
            Err(error) => assert!(!free && matches!(error, MotionError::Root), "{behavior}: {error}"),
        }
    }
}
