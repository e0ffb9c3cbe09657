//! The chapter of the guide about rooms.

use super::*;

/// The blocks of a language in a page of the guide.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    let rest = page.split(&fence).skip(1);
    rest.filter_map(|block| block.split("```").next().map(str::to_string))
        .collect()
}

#[test]
fn the_chapter_of_the_guide_builds_a_room_that_runs_after_every_step() {
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide");
    let page = std::fs::read_to_string(guide.join("rooms.md")).expect("the chapter");
    let (steps, yaml) = (blocks(&page, "xml"), blocks(&page, "yaml"));
    let (steps, second) = steps.split_at(10);
    let keys: String = yaml[0]
        .lines()
        .filter(|l| !l.starts_with("scene:"))
        .map(|l| format!("{l}\n"))
        .collect();
    let config = Config {
        vision_active: false,
        touch_scale: 2.0,
        ..Config::from_yaml(&keys, "rooms.md").expect("the configuration")
    };
    let mut document = steps[0].clone();
    for (number, step) in steps.iter().enumerate() {
        if number > 0 {
            document = document.replace("</mujoco>", &format!("\n{step}</mujoco>"));
        }
        in_room(&config, &document).unwrap_or_else(|e| panic!("after step {}: {e}", number + 1));
    }
    // what the chapter tells after that: a second infant, a ball in the crib, and one that strokes him
    assert_eq!((second.len(), yaml.len()), (1, 3));
    let two = steps[0].replace("</mujoco>", &format!("\n{}</mujoco>", second[0]));
    let pair = in_room(&config, &two).unwrap_or_else(|e| panic!("a second infant: {e}"));
    assert!(pair.env().expect("valid").blueprint().second_infant().is_some());
    for (text, body) in yaml[1..].iter().zip(["ball", "caregiver"]) {
        let added = Config {
            touch_active: false,
            vision_active: false,
            ..Config::from_yaml(text, "rooms.md").expect("the configuration")
        };
        let added = Blueprint::new(added).unwrap_or_else(|e| panic!("{body}: {e}"));
        assert!(added.model().body(body).is_some());
    }
    let whole = std::fs::read_to_string(guide.join("rooms/play_room.xml")).expect("the document");
    assert!(
        whole == document,
        "docs/guide/rooms/play_room.xml is not what the chapter's steps make"
    );
    let file = guide.join("rooms/play_room.yml");
    assert_eq!(std::fs::read_to_string(&file).expect("the configuration"), yaml[0]);
    let mut env = env(Config {
        touch_scale: 2.0,
        vision_active: false,
        ..Config::from_file(file).expect("the configuration")
    });
    env.reset(Some(0)).expect("no divergence");
    random_steps(&mut env, 200);
    let pendant = env.model().body("star").expect("the mobile");
    assert!(env.state().xpos[pendant][2] > 0.2, "it hangs");
    assert_eq!(
        env.state().ctrl[env.model().actuator("mobile").expect("the motor")],
        0.0
    );
}
