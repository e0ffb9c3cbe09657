//! A short training: it beats the random policies, and gives the same bits with any number of threads.

use babybench::{Blueprint, Config};
use learner::training::{Kind, Round, Settings, Training};

fn train(kind: Kind, updates: usize, threads: usize, folder: &str) -> (Vec<Round>, f64) {
    let save_dir = std::env::temp_dir().join(format!("babybench_learner_{folder}_{}", std::process::id()));
    let text = include_str!("../../../configs/config_selftouch.yml");
    let config = Config {
        touch_scale: 3.0,
        max_episode_steps: 400,
        save_dir: save_dir.display().to_string(),
        ..Config::from_yaml(text, "config_selftouch.yml").expect("the example is valid")
    };
    let settings = Settings {
        envs: 24,
        threads,
        updates,
        seed: 1,
    };
    let blueprint = Blueprint::new(config).expect("embedded assets");
    let mut training = Training::new(&blueprint, kind, settings).expect("a folder");
    let rounds = training.run(|_, _| ()).expect("no divergence");
    let score = training.score().expect("episodes");
    std::fs::remove_dir_all(save_dir).expect("the folder of the run");
    (rounds, score)
}

#[test]
fn curiosity_finds_more_of_the_body_than_chance() {
    const UPDATES: usize = 44;
    let short = |kind: Kind, updates| {
        let (rounds, score) = train(kind, updates, 2, kind.name());
        let end = Round::end(&rounds);
        println!("{}: {end:?}, score {score:.3}", kind.name());
        end
    };
    let random = short(Kind::Random, 5);
    let held = short(Kind::Held, UPDATES);
    let curious = short(Kind::Curious, UPDATES);
    assert!(curious.parts > 1.1 * held.parts && curious.reward > held.reward);
    assert!(curious.parts > 4.0 * random.parts);
}

#[test]
fn the_same_seed_gives_the_same_bits_with_any_number_of_threads() {
    let [one, two, three] = [1, 2, 3].map(|threads| train(Kind::Curious, 3, threads, &format!("threads_{threads}")));
    assert_eq!(one, two);
    assert_eq!(one, three);
    assert!(one.0[2].parts > 0.0);
}
