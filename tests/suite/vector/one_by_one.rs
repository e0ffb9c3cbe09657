//! Operations on single environments of a vector: seeds, masks, locks, snapshots, and who is ready first.

#[cfg(feature = "parallel")]
use std::sync::{Arc, Condvar, Mutex};

use super::*;
use babybench::config::Part;
use babybench::vector::Seeds;

#[test]
fn seeds_and_masks_reset_as_gymnasium_does() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let start = |seed| {
        let mut env = blueprint.env().expect("available");
        env.reset(Some(seed)).expect("no divergence").proprioception.to_vec()
    };
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::Disabled);
    let batch = envs.reset(40).expect("no divergence");
    let [first, second] = [0, 1].map(|k| observed(&batch, k).proprioception.to_vec());
    assert_eq!([&first, &second], [&start(40), &start(41)]);
    let list = [Some(7), None, Some(40)];
    let batch = envs.reset(Seeds::Each(&list)).expect("no divergence");
    assert_eq!(observed(&batch, 0).proprioception, start(7));
    assert_ne!(observed(&batch, 1).proprioception, second);
    assert_eq!(observed(&batch, 2).proprioception, first);
    let kept = [0, 2].map(|k| observed(&envs.batch(), k).proprioception.to_vec());
    let batch = envs.reset_where(&[false, true, false], 40).expect("no divergence");
    assert_eq!(observed(&batch, 1).proprioception, second);
    assert_eq!(observed(&batch, 0).proprioception, kept[0]);
    assert_eq!(observed(&batch, 2).proprioception, kept[1]);
}

#[test]
fn environments_can_be_locked_kept_and_moved_one_by_one() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::Disabled);
    envs.reset(0).expect("no divergence");
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are here");
    envs.lock(1, Part::Arms, 0.1).expect("arms can be locked");
    let before = envs.snapshot(2).expect("it is here");
    let [_, one, two] = [0, 1, 2].map(|k| envs.step(&actions).map(|b| observed(&b, k).proprioception.to_vec()));
    let (one, two) = (one.expect("valid actions"), two.expect("valid actions"));
    envs.restore(2, &before).expect("its own snapshot");
    for _ in 0..3 {
        envs.step(&actions).expect("valid actions");
    }
    assert_eq!(observed(&envs.batch(), 2).proprioception, two);
    envs.unlock(1, Part::Arms).expect("arms can be unlocked");
    let unlocked = envs.step(&actions).expect("valid actions");
    assert_ne!(observed(&unlocked, 1).proprioception, one);
    let (qpos, qvel) = (blueprint.init_qpos(), blueprint.init_qvel());
    envs.set_state(0, qpos, qvel).expect("a settled state");
    assert_eq!(envs.env(0).expect("it is here").state().qpos, qpos);
}

#[cfg(feature = "parallel")]
#[test]
fn a_slow_environment_does_not_hold_the_others() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::NextStep);
    envs.reset(0).expect("no divergence");
    let gate = Arc::new((Mutex::new(false), Condvar::new()));
    let at_gate = gate.clone();
    let slow = envs.env_mut(0).expect("it is here");
    slow.by_hand().set_probe(Some(Arc::new(move |_| {
        let open = at_gate.0.lock().expect("no panic");
        drop(at_gate.1.wait_while(open, |open| !*open).expect("no panic"));
    })));
    let len = envs.single_action_space().len();
    envs.send(&vec![0.1; 3 * len], &[0, 1, 2]).expect("all are here");
    for _ in 0..3 {
        // the first thread stands at the gate
        let ids = envs.recv(2).expect("two are quick").ids.to_vec();
        assert_eq!(ids.iter().sum::<usize>(), 3, "{ids:?}");
        envs.send(&vec![0.1; 2 * len], &ids).expect("they are here");
    }
    *gate.0.lock().expect("no panic") = true;
    gate.1.notify_all();
    let mut ids = envs.recv(3).expect("all are in flight").ids.to_vec();
    ids.sort_unstable();
    assert_eq!(ids, [0, 1, 2]);
}
