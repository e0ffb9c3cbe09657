//! Where the files are that an included document names.

use std::fs;
use std::path::{Path, PathBuf};

use babybench::assets::FileSystem;
use babybench::mjcf_loader::load;
use babybench::physics::compile;
use conformance::mujoco::{MUJOCO, Mujoco, Simulation, needed};
use testkit::harness::Trial;
use testkit::trials;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: files_are_found_where_mujoco_finds_them]
}

/// What stands in the included document, and the name of its file. The size of the geom says which of several files was taken.
const NAMING: [(&str, &str); 4] = [
    (
        "<asset><mesh name='x' file='file.obj'/></asset><worldbody><geom type='mesh' mesh='x'/></worldbody>",
        "file.obj",
    ),
    (
        "<asset><hfield name='x' size='1 1 1 1' file='file.hf'/></asset><worldbody><geom type='hfield' hfield='x'/></worldbody>",
        "file.hf",
    ),
    ("<include file='file.xml'/>", "file.xml"),
    (
        "<asset><model name='x' file='file.xml'/></asset><worldbody><attach model='x' body='b' prefix='its_'/></worldbody>",
        "file.xml",
    ),
];

const SETTINGS: [&str; 4] = ["", "meshdir='m'", "assetdir='a'", "meshdir='m' assetdir='a'"];

/// Folders that have the file, alone and in pairs in turn.
const FOLDERS: [&str; 5] = ["", "sub/", "m/", "a/", "sub/m/"];

/// Returns the content of a file that is told by the number of what it brings: points of a mesh, rows of a height field, geoms.
fn content(kind: &str, number: usize) -> Vec<u8> {
    match kind {
        "file.obj" => {
            let more: String = (0..number).map(|k| format!("v 0 0 {}\n", k + 2)).collect();
            format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n{more}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").into_bytes()
        }
        "file.hf" => {
            let rows = number as u32 + 2;
            let sizes = [rows, 2].map(u32::to_le_bytes).concat();
            [sizes, vec![0; 8 * rows as usize]].concat()
        }
        _ => {
            let geoms = "<geom size='1'/>".repeat(number + 1);
            format!("<mujoco><worldbody><body name='b'>{geoms}</body></worldbody></mujoco>").into_bytes()
        }
    }
}

fn write(root: &Path, path: &str, bytes: impl AsRef<[u8]>) {
    let path = root.join(path);
    fs::create_dir_all(path.parent().expect("a folder")).expect("created");
    fs::write(path, bytes).expect("written");
}

fn files_are_found_where_mujoco_finds_them() {
    let api = needed();
    let root = std::env::temp_dir().join(format!("babybench-included-{}", std::process::id()));
    let (mut compared, mut number) = (0, 0);
    for (text, name) in NAMING {
        for settings in SETTINGS {
            for (k, first) in FOLDERS.iter().enumerate() {
                for second in &FOLDERS[k..] {
                    // MuJoCo keeps what it has read, by path and second
                    number += 1;
                    let folder = root.join(number.to_string());
                    write(
                        &folder,
                        "main.xml",
                        format!("<mujoco><compiler {settings}/><include file='sub/part.xml'/></mujoco>"),
                    );
                    write(&folder, "sub/part.xml", format!("<mujoco>{text}</mujoco>"));
                    write(&folder, &format!("{second}{name}"), content(name, 1));
                    write(&folder, &format!("{first}{name}"), content(name, 0));
                    compared += usize::from(same(
                        api,
                        &folder,
                        &format!("{text} {settings} in {first:?}, {second:?}"),
                    ));
                }
            }
        }
    }
    fs::remove_dir_all(&root).expect("removed");
    assert!(compared > 100, "{compared} documents were taken");
}

/// Compares what both sides find; returns whether they find something. What MuJoCo alone does not find is no other meaning.
fn same(api: &'static Mujoco, folder: &PathBuf, what: &str) -> bool {
    let ours = load(&FileSystem::new(folder), "main.xml").and_then(compile);
    let theirs = Simulation::new(api, &folder.join("main.xml").to_string_lossy(), &[]);
    let Ok(theirs) = theirs else {
        return false;
    };
    let ours = ours.unwrap_or_else(|e| panic!("{what}: {e}"));
    let sizes = ["nmeshvert", "nhfielddata", "ngeom"].map(|size| theirs.size(size));
    let vertices = ours.meshes.iter().map(|mesh| mesh.vert.len()).sum();
    let heights = ours.hfields.iter().map(|field| field.nrow * field.ncol).sum();
    assert_eq!([vertices, heights, ours.ngeom()], sizes, "{what}");
    true
}
