//! Records of runs: what is in them, that a replay has the same bits, and what is measured from them.

use crate::common::*;
use babybench::config::{Behavior, Config, Scene};
use babybench::eval::Measures;
use babybench::policy::{NoisePolicy, Policy};
use babybench::runs::{Record, RecordError, RecordOptions, Recorder};
use babybench::spaces::Noise;
use babybench::{Blueprint, Env};

/// Records episodes of held random actions.
fn record(env: &mut Env, folder: &Folder, options: RecordOptions, episodes: u64, steps: usize) -> Record {
    let mut recorder = Recorder::create(folder.path(), env, options).expect("a folder");
    let mut policy = NoisePolicy::new(Noise::Held { seconds: 0.1 });
    let mut action = Vec::new();
    for episode in 0..episodes {
        env.reset(Some(10 + episode)).expect("no divergence");
        policy.begin(env, episode).expect("a noise");
        recorder.begin(env, episode);
        for _ in 0..steps {
            policy.act(env, &mut action).expect("a noise");
            recorder.step(env, &action).expect("no divergence");
        }
        recorder.end(env).expect("the episode can be written");
    }
    Record::open(folder.path()).expect("a record")
}

fn touching(behavior: Behavior, scene: Scene) -> Blueprint {
    blueprint(Config {
        behavior,
        scene,
        vision_active: false,
        ..Config::default()
    })
}

#[test]
fn a_record_is_repeated_with_the_same_bits() {
    for (behavior, scene) in [
        (Behavior::SelfTouch, Scene::Crib),
        (Behavior::HandRegard, Scene::Cubes),
        (Behavior::None, Scene::Base),
        (Behavior::None, Scene::Blanket),
    ] {
        let folder = Folder::new("record");
        let blueprint = touching(behavior, scene);
        let mut env = blueprint.env().expect("an environment");
        let record = record(&mut env, &folder, RecordOptions::default(), 2, 40);
        assert_eq!(
            record.manifest().episodes.iter().map(|e| e.steps).collect::<Vec<_>>(),
            [40, 40]
        );
        assert_eq!(record.manifest().configuration, *env.config());
        assert_eq!(record.manifest().bodies, env.model().body_name[..]);
        // in another environment, and the later episode first
        let mut other = blueprint.env().expect("an environment");
        for episode in [1, 0] {
            let replayed = record.replay(episode, &mut other).expect("a replay");
            assert_eq!(
                (replayed.steps, replayed.first_difference),
                (40, None),
                "{behavior}, episode {episode}"
            );
        }
    }
}

#[test]
fn infants_with_noise_delays_and_eyes_are_repeated_too() {
    let folder = Folder::new("record_infant");
    let mut env = blueprint(infant()).env().expect("an environment");
    let options = RecordOptions {
        senses: true,
        eyes_every: Some(3),
        policy: "held".to_string(),
    };
    let record = record(&mut env, &folder, options, 1, 8);
    assert_eq!(record.replay(0, &mut env).expect("a replay").first_difference, None);
    let npz = record.npz(0).expect("an archive");
    assert_eq!(npz.get_i64("eye_steps").expect("steps").data, [0, 3, 6]);
    let side = env.config().vision_resolution as usize;
    assert_eq!(npz.get_u8("eye_left").expect("images").shape, [3, side, side, 3]);
    let observed = npz.get_f64("observation").expect("proprioception");
    assert_eq!(observed.shape, [8, env.observation().proprioception.len()]);
    assert_eq!(
        observed.data[7 * observed.shape[1]..],
        *env.observation().proprioception
    );
}

#[test]
fn hands_are_counted_by_page_by_kit_and_by_pixels() {
    let folder = Folder::new("record_regards");
    let text = "behavior: hand_regard\nscene: base\ntouch_active: False\nvision_resolution: 32\nvision_outputs: [segmentation]";
    let mut env = Env::new(Config::from_yaml(text, "seen").expect("valid")).expect("an environment");
    let options = RecordOptions {
        eyes_every: Some(2),
        ..RecordOptions::default()
    };
    let record = record(&mut env, &folder, options, 1, 20);
    let details = env.info().details.regards.expect("both counters");
    assert_eq!(Some(details.page.to_array()), env.info().behavior.regards());
    let measures = Measures::of_episode(&record, 0).expect("measures");
    let shares = details.page.to_array().map(|count| count as f64 / 20.0);
    assert_eq!(measures.regards.map(|shares| shares.to_array()), Some(shares));
    let seen = measures.hands_seen.expect("segmentation").to_array();
    assert!(seen.iter().all(|share| (0.0..=1.0 + 1e-12).contains(share)), "{seen:?}");
    // counters are part of a snapshot
    let snapshot = env.snapshot();
    let line = env.info().to_detailed_json();
    assert!(
        line.contains("\"page_regards\": {\"right_eye_right_hand\": ") && line.contains("kit_regards"),
        "{line}"
    );
    let mut other = env.blueprint().env().expect("an environment");
    other.restore(&snapshot).expect("a snapshot");
    assert_eq!(other.info().details.regards, Some(details));
    env.reset(None).expect("no divergence");
    assert_eq!(
        env.info().details.regards,
        Some(babybench::env::RegardCounts::default())
    );
}

#[test]
fn archives_hold_what_happened() {
    let folder = Folder::new("record_arrays");
    let mut env = touching(Behavior::SelfTouch, Scene::Crib)
        .env()
        .expect("an environment");
    let record = record(&mut env, &folder, RecordOptions::default(), 1, 200);
    let npz = record.npz(0).expect("an archive");
    for array in npz.arrays() {
        assert!(
            record.manifest().arrays.contains_key(&array.name),
            "{} is not described",
            array.name
        );
    }
    let (ptr, idx) = (
        npz.get_i64("touch_ptr").expect("touch").data,
        npz.get_i64("touch_idx").expect("touch").data,
    );
    let val = npz.get_f64("touch_val").expect("touch").data;
    let mut dense = vec![0.0_f64; npz.get_i64("touch_len").expect("touch").data[0] as usize];
    for k in ptr[199] as usize..ptr[200] as usize {
        dense[idx[k] as usize] = val[k];
    }
    let felt = env.observation().touch.expect("touch");
    assert_eq!(dense.len(), felt.len());
    assert!(felt.iter().any(|v| *v != 0.0));
    for (found, felt) in dense.iter().zip(felt) {
        assert!(
            (found - f64::from(*felt)).abs() <= 5e-4 * f64::from(felt.abs()),
            "{found} for {felt}"
        );
    }
    let qpos = npz.get_f64("qpos").expect("positions");
    for (found, q) in qpos.data[199 * qpos.shape[1]..].iter().zip(&env.state().qpos) {
        assert!((found - q).abs() < 1e-6);
    }
    assert_eq!(npz.get_f64("time").expect("time").data[199], 1.0);
    // lists of first touches are those of the information
    let (hands, geoms) = (
        npz.get_i64("first_touch_hand").expect("hands").data,
        npz.get_i64("first_touch_geom").expect("geoms").data,
    );
    for (hand, touched) in env.info().behavior.touches().expect("self_touch").iter().enumerate() {
        let found: Vec<usize> = hands
            .iter()
            .zip(&geoms)
            .filter(|(h, _)| **h == hand as i64)
            .map(|(_, g)| *g as usize)
            .collect();
        assert_eq!(found, *touched);
    }
    let side = npz
        .get_f64("skin_is_elsewhere")
        .expect_err("skin.npz has it")
        .to_string();
    assert!(side.contains("no array"));
}

#[test]
fn what_is_no_record_is_refused() {
    let folder = Folder::new("record_refused");
    let mut env = touching(Behavior::SelfTouch, Scene::Crib)
        .env()
        .expect("an environment");
    let found = record(&mut env, &folder, RecordOptions::default(), 1, 5);
    let again = Recorder::create(folder.path(), &env, RecordOptions::default());
    assert!(matches!(again, Err(RecordError::Exists { .. })));
    let blind = RecordOptions {
        eyes_every: Some(1),
        ..RecordOptions::default()
    };
    let elsewhere = Folder::new("record_blind");
    assert!(matches!(
        Recorder::create(elsewhere.path(), &env, blind),
        Err(RecordError::Blind)
    ));
    let error = found.replay(7, &mut env).expect_err("no episode").to_string();
    assert!(error.contains("no episode 7; there are 0"), "{error}");
    let mut other = touching(Behavior::HandRegard, Scene::Crib)
        .env()
        .expect("an environment");
    assert!(matches!(
        found.replay(0, &mut other),
        Err(RecordError::Unfit { .. } | RecordError::Snapshot { .. })
    ));
    // a program that changes the scene between steps is found out
    let changed = Folder::new("record_changed");
    let mut recorder = Recorder::create(changed.path(), &env, RecordOptions::default()).expect("a folder");
    let action = vec![0.1; env.action_space().len()];
    assert!(matches!(recorder.step(&mut env, &action), Err(RecordError::NotBegun)));
    env.reset(Some(0)).expect("no divergence");
    recorder.begin(&env, 0);
    for step in 0..6 {
        if step == 3 {
            env.state_mut().qvel[6] += 0.5;
        }
        recorder.step(&mut env, &action).expect("no divergence");
    }
    recorder.end(&env).expect("the episode can be written");
    assert!(matches!(recorder.step(&mut env, &action), Err(RecordError::NotBegun)));
    let record = Record::open(changed.path()).expect("a record");
    assert_eq!(record.replay(0, &mut env).expect("a replay").first_difference, Some(3));
    let manifest = folder.path().join("manifest.json");
    let text = std::fs::read_to_string(&manifest).expect("a manifest");
    for (from, to, part) in [
        ("babybench record", "something else", "not a record of babybench"),
        ("\"version\": 1,", "\"version\": 9,", "of version 9"),
        (
            "episode_0.npz",
            "../episode_0.npz",
            "not the name of a file in this folder",
        ),
        ("\"dt\"", "\"td\"", "missing field"),
    ] {
        std::fs::write(&manifest, text.replacen(from, to, 1)).expect("a file");
        let error = Record::open(folder.path()).expect_err(part).to_string();
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn measures_of_a_record_add_up() {
    let folder = Folder::new("record_measures");
    let mut env = touching(Behavior::SelfTouch, Scene::Crib)
        .env()
        .expect("an environment");
    let record = record(&mut env, &folder, RecordOptions::default(), 2, 300);
    let all = Measures::of_record(&record).expect("measures");
    assert_eq!(all.len(), 2);
    for measures in &all {
        assert_eq!((measures.steps, measures.seconds), (300, 1.5));
        for hand in [&measures.right_hand, &measures.left_hand] {
            let most = hand
                .regions
                .values()
                .fold(0.0_f64, |most, region| most.max(region.share));
            let sum: f64 = hand.regions.values().map(|region| region.share).sum();
            assert!(most <= hand.share && hand.share <= sum + 1e-12, "{hand:?}");
            // the time of touches is that of contact and of short gaps
            assert!(hand.per_minute / 60.0 * hand.duration + 1e-12 >= hand.share, "{hand:?}");
        }
        let both = measures.right_hand.share.max(measures.left_hand.share);
        assert!(measures.double_touch >= both && measures.double_touch <= 1.0);
        assert!(measures.smoothness.is_some_and(|s| s < 0.0) && measures.symmetry.is_some_and(|s| s.abs() <= 1.0));
    }
    let mean = Measures::mean(&all).expect("time");
    let share = 0.5 * (all[0].right_hand.share + all[1].right_hand.share);
    assert!((mean.right_hand.share - share).abs() < 1e-12);
    assert_eq!((mean.episodes, mean.steps), (2, 600));
    assert_eq!(Measures::mean(&[]), None);
    let json: serde_json::Value = serde_json::from_str(&mean.to_json()).expect("JSON");
    assert_eq!(json["steps"], 600);
}

#[test]
fn a_record_of_changed_models_and_ages_is_repeated() {
    let folder = Folder::new("record_changes");
    let blueprint = touching(Behavior::SelfTouch, Scene::Crib);
    let mut env = blueprint.env().expect("an environment");
    let mut recorder = Recorder::create(folder.path(), &env, RecordOptions::default()).expect("a folder");
    let still = vec![0.0; env.action_space().len()];
    for episode in 0..4 {
        match episode {
            1 => env.model_mut().change(|model| model.opt.gravity = [0.0, 0.0, -1.62]),
            2 => env.mimo_mut().set_age(Some(3.0)),
            3 => env.mimo_mut().set_age(None),
            _ => Ok(()),
        }
        .expect("it can be changed");
        env.reset(Some(episode)).expect("no divergence");
        recorder.begin(&env, episode);
        for _ in 0..5 {
            recorder.step(&mut env, &still).expect("no divergence");
        }
        assert!(recorder.has_steps());
        if episode == 3 {
            recorder.give_up(&env).expect("the episode can be written");
        } else {
            recorder.end(&env).expect("the episode can be written");
        }
        assert!(!recorder.has_steps());
    }
    let record = Record::open(folder.path()).expect("a record");
    let episodes = &record.manifest().episodes;
    assert_eq!(
        episodes.iter().map(|e| (e.age, e.unfinished)).collect::<Vec<_>>(),
        [(None, false), (None, false), (Some(Some(3.0)), false), (None, true)]
    );
    let changed = record.npz(1).expect("an archive").get_f64("model.opt.gravity");
    assert_eq!(changed.expect("it was changed").data, [0.0, 0.0, -1.62]);
    for episode in [3, 2, 1, 0, 2] {
        let replayed = record.replay(episode, &mut env).expect("a replay");
        assert_eq!((replayed.steps, replayed.first_difference), (5, None), "{episode}");
    }
    assert!(
        env.model_mut()
            .set_changed_numbers(&[("nothing".to_string(), vec![1.0])])
            .is_err()
    );
    assert!(
        env.model_mut()
            .set_changed_numbers(&[("opt.gravity".to_string(), vec![1.0])])
            .is_err()
    );
}
