//! Joints that are locked.

use super::*;

fn angle(env: &Env, joint: &str) -> f64 {
    let range = env
        .senses()
        .proprioception()
        .find(env.model(), ProprioceptionComponent::Angles, joint)
        .expect("a joint of MIMo");
    env.observation().proprioception[range.start]
}

#[test]
fn joints_lock_at_any_angle_and_unlock() {
    for &kind in ActuationModel::ALL {
        let mut env = env(config(kind, Behavior::None, Scene::Base, Compat::Api));
        env.reset(Some(0)).expect("no divergence");
        let zero = vec![0.0; env.action_space().len()];
        for target in [-1.2, -0.4] {
            let report = env.mimo_mut().lock("robot:right_elbow", target).expect("a lock");
            assert_eq!(
                (report.changed.len(), report.held.len(), report.beyond_limits.len()),
                (1, 0, 0)
            );
            repeat(&mut env, &zero, 150);
            let got = angle(&env, "robot:right_elbow");
            println!("{kind}: locked at {target}, is at {got}");
            assert!((got - target).abs() < 1e-2, "{kind}: {got} is not {target}");
        }
        env.reset(Some(0)).expect("no divergence");
        repeat(&mut env, &zero, 150);
        assert!(
            (angle(&env, "robot:right_elbow") + 0.4).abs() < 1e-2,
            "locks outlast resets"
        );
        assert_eq!(
            env.mimo_mut()
                .unlock("robot:right_elbow")
                .expect("a lock")
                .changed
                .len(),
            1
        );
        assert_eq!(
            env.mimo_mut()
                .unlock("robot:right_elbow")
                .expect("a lock")
                .changed
                .len(),
            0
        );
        let mut high = zero.clone();
        let elbow = actuator(env.model(), "act:right_elbow");
        high[elbow] = env.action_space().low()[elbow].min(-1.0);
        if kind == ActuationModel::Muscle {
            high[elbow] = 1.0;
        }
        repeat(&mut env, &high, 100);
        assert!(
            angle(&env, "robot:right_elbow") < -0.45,
            "{}",
            angle(&env, "robot:right_elbow")
        );
    }
}

#[test]
fn parts_lock_and_held_joints_are_reported() {
    let mut env = env(config(
        ActuationModel::SpringDamper,
        Behavior::None,
        Scene::Cubes,
        Compat::Api,
    ));
    env.reset(Some(0)).expect("no divergence");
    // three hip angles and the knee of each leg are held by the scene
    let legs = env.mimo_mut().lock(Part::Legs, 0.0).expect("locks");
    assert_eq!((legs.changed.len(), legs.held.len()), (0, 8));
    let arms = env.mimo_mut().lock(Part::Arms, 0.05).expect("locks");
    assert_eq!((arms.changed.len(), arms.held.len()), (8, 0));
    let beyond = env.mimo_mut().lock("robot:left_elbow", 3.0).expect("a lock");
    assert_eq!(beyond.beyond_limits.len(), 1);
    let free = env.mimo_mut().unlock(Part::Legs).expect("locks");
    assert_eq!((free.changed.len(), free.held.len()), (0, 8));

    let before = env.snapshot();
    let lock_error = |e: EnvError| match e {
        EnvError::Lock(e) => e,
        e => panic!("{e}"),
    };
    let none = lock_error(env.mimo_mut().lock("robot:tail", 0.0).expect_err("no such joint"));
    assert!(matches!(none, LockError::NoJoint { .. }) && none.to_string().contains("robot:tail"));
    let root = lock_error(env.mimo_mut().lock("mimo_location", 0.0).expect_err("a free joint"));
    assert!(matches!(root, LockError::NoLock { .. }));
    let far = 10_000;
    assert!(matches!(
        lock_error(env.mimo_mut().unlock(far).expect_err("no such joint")),
        LockError::NoJoint { .. }
    ));
    for angle in [f64::NAN, f64::INFINITY] {
        assert!(matches!(
            lock_error(env.mimo_mut().lock(Part::Head, angle).expect_err("angle")),
            LockError::Angle { .. }
        ));
    }
    assert_eq!(env.snapshot(), before);
}
