//! Rooms that are refused, with place and remedy.

use super::*;

#[test]
fn what_is_wrong_is_said_with_place_and_remedy() {
    let plain = free(Behavior::None, Scene::Base);
    let whole = room("", "");
    let twice = whole.replace(
        "</worldbody>",
        "<body name=\"twin\"><include file=\"mimo.xml\"/></body></worldbody>",
    );
    let cases: &[(String, &[&str])] = &[
        (
            whole.replace("<include file=\"mimo_settings.xml\"/>", ""),
            &[
                "rooms/mine.xml",
                "<include file=\"mimo_settings.xml\"/> is missing in <mujoco>",
                "his senses",
            ],
        ),
        (
            whole.replace("<include file=\"mimo.xml\"/>", ""),
            &[
                "rooms/mine.xml",
                "<include file=\"mimo.xml\"/> is missing in <body name=\"mimo_location\">",
            ],
        ),
        (
            twice,
            &[
                "rooms/mine.xml:8:",
                "worldbody/body/include",
                "file \"mimo.xml\" is already included",
            ],
        ),
        (
            whole.replace("\"mimo_location\"", "\"bed\""),
            &[
                "rooms/mine.xml:3:14: mujoco/worldbody/body",
                "<body name=\"mimo_location\"",
                "freejoint",
            ],
        ),
        (
            room(
                "<body name=\"toy\"><geom size=\".1\"/><include file=\"../toys/ball.xml\"/></body>",
                "",
            ),
            &[
                "rooms/mine.xml:7:",
                "file \"../toys/ball.xml\" lies outside the document's folder",
            ],
        ),
        (
            room(
                "",
                "<asset><texture name=\"t\" type=\"2d\" file=\"../wood.png\"/></asset>",
            ),
            &[
                "rooms/mine.xml:12:",
                "asset/texture",
                "../wood.png",
                "outside the document's folder",
            ],
        ),
        (
            room("", "<asset><texture name=\"t\" type=\"2d\" file=\"wood.png\"/></asset>"),
            &["rooms/mine.xml:12:", "file \"rooms/wood.png\" does not exist"],
        ),
        (
            room("", "<include file=\"walls.xml\"/>"),
            &["rooms/mine.xml:12:", "file \"rooms/walls.xml\" does not exist"],
        ),
        (
            room("<body name=\"left_hand\"/>", ""),
            &["rooms/mine.xml:7:", "body name \"left_hand\" is used twice"],
        ),
        (
            room("", "<compiler angle=\"radian\"/>"),
            &[
                "rooms/mine.xml:12:12: mujoco/compiler: angle=\"radian\"",
                "write degrees",
            ],
        ),
        (
            room("", "<compiler texturedir=\"tex\"/>"),
            &["texturedir=\"tex\"", "in front of the name"],
        ),
        (
            room("", "<option timestep=\"0.002\"/>"),
            &["rooms/mine.xml:12:12: mujoco/option", "leave timestep out"],
        ),
        (
            whole
                .replacen(
                    "<worldbody>",
                    "<default><geom margin=\"0.01\"/></default><worldbody>",
                    1,
                )
                .replace(
                    "<include file=\"mimo_settings.xml\"/>",
                    "<compiler autolimits=\"false\"/><include file=\"mimo_settings.xml\"/>",
                ),
            &[
                "rooms/mine.xml: this makes another MIMo",
                "geom_margin 0.01 instead of 0.0",
                "<default> without a class",
            ],
        ),
    ];
    for (document, parts) in cases {
        let error = in_room(&plain, document)
            .err()
            .unwrap_or_else(|| panic!("{document} is taken"));
        for part in *parts {
            assert!(error.contains(part), "{error}\n  lacks {part}");
        }
    }
}

#[test]
fn files_that_are_missing_or_have_names_of_the_library_are_refused() {
    let open = |path: &str, files: &[(&str, &str)]| {
        let config = Config {
            scene: Scene::File(path.to_string()),
            ..free(Behavior::None, Scene::Base)
        };
        Blueprint::with(config, assets(files))
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    let whole = room("", "");
    let missing = open("rooms/none.xml", &[]).expect_err("no such file");
    for part in [
        "`scene` is rooms/none.xml",
        "does not exist",
        "base, crib, cubes",
        "the folder of the configuration",
    ] {
        assert!(missing.contains(part), "{missing}");
    }
    let own_name = open("rooms/crib.xml", &[("rooms/crib.xml", &whole)]).expect_err("the library's name");
    assert!(
        own_name.contains("the library has a file called crib.xml"),
        "{own_name}"
    );
    for name in ["mimo.xml", "mimo_v1.xml", "base.xml", "settings.xml"] {
        let files = [
            ("rooms/mine.xml", whole.as_str()),
            (&format!("rooms/{name}"), "<mujoco/>"),
        ];
        match open("rooms/mine.xml", &files) {
            Err(e) => assert!(
                e.contains(&format!("\"rooms/{name}\" has the name of a file of the library")),
                "{e}"
            ),
            Ok(()) => panic!("{name} is taken"),
        }
    }
    // one that the document does not name is nobody's business, and a room may be called as it likes
    assert_eq!(
        open("scene.xml", &[("scene.xml", &whole), ("crib.xml", "<mujoco/>")]),
        Ok(())
    );
}

#[test]
fn rooms_on_the_disk_have_their_files_beside_them_and_links_lead_nowhere() {
    let folder = Folder::new("rooms");
    std::fs::create_dir_all(folder.path().join("nursery/walls")).expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("nursery/mine.xml", &room("", "<include file=\"walls/north.xml\"/>"));
    write(
        "nursery/walls/north.xml",
        "<mujocoinclude><worldbody><geom name=\"wall\" type=\"box\" size=\"1 .05 1\" pos=\"0 2 1\"/></worldbody></mujocoinclude>",
    );
    write(
        "room.yml",
        "scene: nursery/mine.xml\ntouch_active: false\nvision_active: false\n",
    );
    // the path starts at the folder of the configuration
    let config = Config::from_file(folder.path().join("room.yml")).expect("a configuration");
    let path = folder.path().join("nursery/mine.xml");
    assert_eq!(config.scene, Scene::File(path.to_str().expect("UTF-8").to_string()));
    assert_eq!(
        Config::from_yaml(&config.to_yaml(), "again").expect("it reads back"),
        config
    );
    let blueprint = Blueprint::new(config).expect("a room");
    assert!(blueprint.model().geom("wall").is_some());
    blueprint.scenery().expect("textures of the library");
    #[cfg(unix)]
    {
        let outside = folder.path().join("outside.xml");
        std::fs::write(&outside, "<mujocoinclude/>").expect("a file");
        std::fs::remove_file(folder.path().join("nursery/walls/north.xml")).expect("it was there");
        std::os::unix::fs::symlink(&outside, folder.path().join("nursery/walls/north.xml")).expect("a link");
        let error = Blueprint::new(blueprint.config().clone())
            .expect_err("it leads out")
            .to_string();
        assert!(
            error.contains("mine.xml:12:") && error.contains("a link that leads out"),
            "{error}"
        );
    }
}

#[test]
fn tasks_with_a_scene_of_their_own_refuse_another() {
    let error = Config::from_yaml("behavior: reach\nscene: mine.xml\n", "c.yml").expect_err("a task");
    assert_eq!(
        error.to_string(),
        "c.yml:2:8: `scene` is mine.xml, but a task has a scene of its own; leave `scene` out"
    );
    let typo = Config::from_yaml("scene: crip\n", "c.yml")
        .expect_err("a typo")
        .to_string();
    assert!(
        typo.contains("did you mean `crib`?") && typo.contains("ends in .xml"),
        "{typo}"
    );
}
