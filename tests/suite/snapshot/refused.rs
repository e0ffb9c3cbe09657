//! Snapshots that are refused.

use super::*;

#[test]
fn snapshots_of_other_environments_are_refused() {
    let base = of(ActuationModel::SpringDamper, Behavior::None, Scene::Base, Compat::Api);
    let snapshot = started(base.clone()).snapshot();
    let mut others = vec![
        Config {
            actuation_model: ActuationModel::Muscle,
            ..base.clone()
        },
        Config {
            scene: Scene::Crib,
            ..base.clone()
        },
        Config {
            behavior: Behavior::SelfTouch,
            ..base.clone()
        },
        Config {
            compat: Compat::Reference,
            ..base.clone()
        },
    ];
    let mut act = base.clone();
    act.act.eyes = false;
    others.push(act);
    for config in others {
        let mut other = started(config);
        let before = other.snapshot();
        let refused = other.restore(&snapshot);
        assert!(
            matches!(refused, Err(SnapshotError::OtherConfiguration { .. })),
            "{refused:?}"
        );
        assert_eq!(other.snapshot(), before);
    }
    // another value of any key that is not of the run around it
    let refused = |change: &dyn Fn(&mut Config)| {
        let mut config = base.clone();
        change(&mut config);
        let mut other = started(config);
        let (before, refused) = (
            other.snapshot(),
            other.restore(&snapshot).expect_err("another configuration"),
        );
        assert_eq!(other.snapshot(), before);
        refused.to_string()
    };
    for (said, change) in [
        (
            "proprio_torque was true, but here it is false",
            &(|config: &mut Config| config.proprio_torque = false) as &dyn Fn(&mut Config),
        ),
        ("vestibular_active was true, but here it is false", &|config| {
            config.vestibular_active = !config.vestibular_active;
        }),
        ("frame_skip was 2, but here it is 3", &|config| config.frame_skip = 3),
        ("noise_motor was 0.0, but here it is 0.25", &|config| {
            config.noise.motor = 0.25;
        }),
        (
            "delay_sensory was 0.0, but here it is 2.0; proprio_limits was true, but here it is false",
            &|config| {
                config.proprio_limits = false;
                config.delays.sensory = 2.0;
            },
        ),
    ] {
        let text = refused(change);
        assert_eq!(
            text,
            format!("the snapshot was taken with another configuration: {said}")
        );
    }
}

#[test]
fn damaged_bytes_are_refused() {
    let mut env = started(of(
        ActuationModel::Muscle,
        Behavior::SelfTouch,
        Scene::Base,
        Compat::Api,
    ));
    let good = env.snapshot().as_bytes().to_vec();
    assert_eq!(Snapshot::from_bytes(Vec::new()), Err(SnapshotError::NotASnapshot));
    assert_eq!(Snapshot::from_bytes(vec![7; 4096]), Err(SnapshotError::NotASnapshot));
    for n in (0..good.len()).step_by(97).chain(good.len() - 9..good.len()) {
        assert!(Snapshot::from_bytes(good[..n].to_vec()).is_err(), "cut at {n}");
    }
    for k in (0..good.len()).step_by(11).chain(0..40) {
        let mut bytes = good.clone();
        bytes[k] ^= 0x41;
        // a changed fingerprint is noticed by the environment
        match Snapshot::from_bytes(bytes) {
            Ok(s) => assert_eq!(env.restore(&s), Err(SnapshotError::OtherEnvironment), "byte {k}"),
            Err(e) => assert!(!e.to_string().is_empty()),
        }
    }
    let mut newer = good.clone();
    newer[8] = 9;
    assert_eq!(Snapshot::from_bytes(newer), Err(SnapshotError::Version { found: 9 }));
    let mut longer = good.clone();
    longer.push(0);
    assert!(Snapshot::from_bytes(longer).is_err());
    assert_eq!(env.snapshot().as_bytes(), good);
}

/// Bytes whose checksum fits but whose content is nonsense: never a panic, and the environment stays as it was or runs on.
#[test]
fn forged_bytes_never_panic() {
    let mut env = started(of(
        ActuationModel::Muscle,
        Behavior::SelfTouch,
        Scene::Base,
        Compat::Api,
    ));
    let good = env.snapshot();
    let mut x = 1_u64;
    let mut random = || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        x
    };
    let (mut refused, mut taken) = (0, 0);
    for k in 0..3000 {
        let mut bytes = good.as_bytes().to_vec();
        match k % 3 {
            0 => {
                let at = 32 + (random() as usize) % (bytes.len() - 40);
                bytes[at..at + 8].copy_from_slice(&random().to_le_bytes());
            }
            1 => bytes.truncate(32 + (random() as usize) % (bytes.len() - 32)),
            // counts and lists
            _ => {
                let at = 32 + 8 * ((random() as usize) % 10);
                let value = [u64::MAX, 1 << 40, 3, 100][(random() % 4) as usize];
                bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
            }
        }
        let sum = checksum(&bytes[32..]);
        bytes[24..32].copy_from_slice(&sum.to_le_bytes());
        // the checksum fits, but too little may be left
        let Ok(forged) = Snapshot::from_bytes(bytes) else {
            refused += 1;
            continue;
        };
        match env.restore(&forged) {
            Err(_) => {
                refused += 1;
                assert_eq!(env.snapshot(), good);
            }
            Ok(()) => {
                taken += 1;
                let action = vec![0.5; env.action_space().len()];
                let _ = env.step(&action);
                env.restore(&good).expect("its own snapshot");
            }
        }
    }
    println!("{refused} refused, {taken} taken");
    assert!(refused > 0 && taken > 0);
}

/// The checksum as the documentation of the layout has it.
fn checksum(bytes: &[u8]) -> u64 {
    let mix = |h: u64, w: u64| (h ^ w).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let words = bytes.chunks_exact(8);
    let rest = words.remainder();
    let h = words.fold(bytes.len() as u64, |h, w| {
        mix(h, u64::from_le_bytes(w.try_into().expect("eight")))
    });
    rest.iter().fold(h, |h, b| mix(h, u64::from(*b)))
}
