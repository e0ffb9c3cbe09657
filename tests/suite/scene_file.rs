//! The scene beside the logs of a run, from assets of other people.

use babybench::assets::{AssetSource, MemoryAssets, Overlay};
use babybench::config::{Behavior, Scene};
use babybench::mimo::{build_model, embedded};
use babybench::runs::{read_scene, write_scene_from};

use crate::common::*;

/// Writes the scene of the crib from the embedded assets with some files replaced, and checks that what is read back is
/// the scene that was meant.
fn survives(name: &str, replaced: &[(&str, String)]) {
    let mut memory = MemoryAssets::new();
    for (path, text) in replaced {
        memory.insert(path, text.as_bytes()).expect("a path");
    }
    let assets = Overlay::new(embedded()).with(memory);
    let config = free(Behavior::SelfTouch, Scene::Crib);
    let folder = Folder::new(name);
    let meant = build_model(&config, &assets).expect("a scene");
    write_scene_from(&config, &assets, folder.path()).expect("a document");
    assert!(read_scene(folder.path()).expect("it loads") == meant, "{name}");
}

fn original(path: &str) -> String {
    let bytes = embedded().read(path).expect("an asset").into_owned();
    String::from_utf8(bytes).expect("text")
}

#[test]
fn an_include_that_brings_nothing_is_refused_as_in_mujoco() {
    let empty = "<mujocoinclude/>".to_string();
    let with = "<asset><include file=\"empty.xml\"/></asset></mujocoinclude>";
    let crib = original("babybench/crib.xml").replace("</mujocoinclude>", with);
    for replaced in [
        vec![("babybench/crib.xml", crib), ("babybench/empty.xml", empty.clone())],
        vec![("babybench/crib.xml", empty)],
    ] {
        let mut memory = MemoryAssets::new();
        for (path, text) in replaced {
            memory.insert(path, text.as_bytes()).expect("a path");
        }
        let config = free(Behavior::SelfTouch, Scene::Crib);
        let error = build_model(&config, &Overlay::new(embedded()).with(memory)).expect_err("nothing is included");
        assert!(error.to_string().contains("the file has no elements"), "{error}");
    }
}

#[test]
fn a_folder_of_textures_is_followed() {
    let base = original("babybench/base.xml");
    let moved = base.replace("../tex/rug.png", "rug.png");
    assert_ne!(moved, base);
    for folder in ["../tex", "../tex/"] {
        let compiler = format!("<mujocoinclude>\n<compiler texturedir=\"{folder}\"/>");
        let moved = moved.replacen("<mujocoinclude>", &compiler, 1);
        let meta = "babybench/meta_common.xml";
        let replaced = [
            ("babybench/base.xml", moved),
            (meta, original(meta).replace("../tex/", "")),
        ];
        survives("scene_file_texturedir", &replaced);
    }
}

#[test]
fn meshes_and_attached_models_come_along() {
    let corner =
        |far: &str| format!("v 0 0 0\nv {far} 0 0\nv 0 {far} 0\nv 0 0 {far}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    // two files of one name, of which each gives its mesh its own
    let toy = "<mujoco><compiler meshdir=\"parts/\"/><asset><mesh file=\"corner.obj\"/></asset>\
         <worldbody><body name=\"toy\" pos=\"0 0 2\"><geom type=\"mesh\" mesh=\"corner\"/></body></worldbody></mujoco>";
    let added = "<asset><mesh file=\"shapes/corner.obj\"/><mesh file=\"corner.obj\" name=\"other\"/><model name=\"box\" file=\"toys/toy.xml\"/></asset>\
         <worldbody><geom type=\"mesh\" mesh=\"corner\" pos=\"2 0 2\"/><geom type=\"mesh\" mesh=\"other\" pos=\"2 2 2\"/>\
         <attach model=\"box\" body=\"toy\" prefix=\"a_\"/></worldbody></mujocoinclude>";
    let crib = original("babybench/crib.xml").replace("</mujocoinclude>", added);
    survives(
        "scene_file_meshes",
        &[
            ("babybench/crib.xml", crib),
            ("babybench/shapes/corner.obj", corner("0.1")),
            ("babybench/corner.obj", corner("0.2")),
            ("babybench/toys/toy.xml", toy.to_string()),
            ("babybench/toys/parts/corner.obj", corner("0.3")),
        ],
    );
}
