//! Skins beside MuJoCo 3.3.0: what is taken, and the compiled arrays.

use babybench::Model;
use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::physics::compile;
use conformance::data;
use conformance::loading::{Outcome, compare_bytes};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::mutation::mutate_document;
use testkit::{Rng, show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: skins_of_documents_are_taken_alike, skins_of_files_are_taken_alike, attached_skins_are_taken_alike, skins_of_cables_are_taken_alike, divided_skins_of_cables_are_equal]
}

/// Compiles a document without files.
fn model(text: &str) -> Model {
    load_str(text, "m.xml", &MemoryAssets::new())
        .and_then(compile)
        .expect("it is taken")
}

/// Compares a document with the files beside it.
fn outcome(text: &str, files: &[(&str, &[u8])]) -> Outcome {
    let mut assets = MemoryAssets::new();
    for (name, bytes) in files {
        assets.insert(name, *bytes).expect("a name of a file");
    }
    let mut all = vec![("m.xml", text.as_bytes())];
    all.extend_from_slice(files);
    compare_bytes(needed(), ("m.xml", text), &all, &assets)
}

fn same(text: &str, files: &[(&str, &[u8])]) {
    if let Outcome::Fault(fault) = outcome(text, files) {
        panic!("{fault}\n{text}");
    }
}

/// A skin of three vertices: its attributes, and those of its only bone.
fn one(skin: &str, bone: &str) -> String {
    document(&format!(r#"<skin {skin}><bone body="a" {bone}/></skin>"#))
}

fn document(skin: &str) -> String {
    format!(
        r#"<mujoco><deformable>{skin}</deformable><worldbody>
        <body name="a"><joint/><geom size="0.05"/></body></worldbody></mujoco>"#
    )
}

fn skins_of_documents_are_taken_alike() {
    const SKIN: &str = r#"name="s" vertex="0 0 0 1 0 0 1 1 0" face="0 1 2""#;
    const BONE: &str = r#"bindpos="0 0 0" bindquat="1 0 0 0""#;
    const PULL: &str = r#"vertid="0 1 2" vertweight="1 1 1""#;
    let whole = format!("{BONE} {PULL}");
    for skin in [
        SKIN.to_string(),
        SKIN.replace(r#"name="s" "#, ""),
        SKIN.replace("1 1 0", "1"),
        SKIN.replace("0 1 2", "0 1"),
        SKIN.replace("0 1 2", "0 1 1.5"),
        SKIN.replace("0 1 2", "0 1 3"),
        SKIN.replace(r#" face="0 1 2""#, ""),
        format!(r#"{SKIN} texcoord="0 0 1 0 1 1""#),
        format!(r#"{SKIN} texcoord="0 0 1 0""#),
        format!(r#"{SKIN} texcoord="0 0 1 0 1""#),
        format!(r#"{SKIN} inflate="-0.1" rgba="1 0.3 0.7 0.2" group="5""#),
        format!(r#"{SKIN} group="6""#),
        format!(r#"{SKIN} rgba="1 1 1""#),
        format!(r#"{SKIN} material="none""#),
        format!(r#"{SKIN} file="s.skn""#),
    ] {
        same(&one(&skin, &whole), &[]);
    }
    for bone in [
        r#"vertid="0 1 3" vertweight="1 1 1""#,
        r#"vertid="0 1 -1" vertweight="1 1 1""#,
        r#"vertid="0 1 2" vertweight="1 1""#,
        r#"vertid="0 1" vertweight="1 1""#,
        r#"vertid="0 1 2" vertweight="1 1 -1""#,
        r#"vertid="0 1 2 2" vertweight="1 1 -1 3""#,
        r#"vertid="0 1 2 0 0" vertweight="1 1 0.3 0.7 0.1""#,
        r#"vertid="0 1 2" vertweight="1 1 1e-16""#,
        r#"vertid="0 1 2""#,
        r#"vertweight="1 1 1""#,
    ] {
        same(&one(SKIN, &format!("{BONE} {bone}")), &[]);
    }
    for pose in [
        r#"bindpos="0.1 0.2 0.3" bindquat="2 0.3 -1 1""#,
        r#"bindpos="0 0 0" bindquat="0 0 0 0""#,
        r#"bindpos="0 0 0""#,
        r#"bindquat="1 0 0 0""#,
    ] {
        same(&one(SKIN, &format!("{pose} {PULL}")), &[]);
    }
    let twice = one(SKIN, &whole).replace(
        "</deformable>",
        &format!(r#"<skin {SKIN}><bone body="world" {whole}/></skin></deformable>"#),
    );
    same(&twice, &[]);
    same(&twice.replacen(r#"name="s""#, r#"name="t""#, 1), &[]);
    same(&one(SKIN, &whole).replace(r#"body="a" bind"#, r#"body="b" bind"#), &[]);
    same(&document(&format!("<skin {SKIN}/>")), &[]);
    let room = data::text("skins.xml");
    assert!(matches!(outcome(&room, &[]), Outcome::Equal), "the room of skins");
    let mut rng = Rng::with_seed(1);
    for _ in 0..300 {
        same(&mutate_document(&room, &mut rng), &[]);
    }
}

/// A file with random weights of two bones.
fn file(rng: &mut Rng, names: [&str; 2]) -> Vec<u8> {
    let (vertices, faces) = (4 + rng.usize(..20), 1 + rng.usize(..20));
    let textured = if rng.bool() { vertices } else { 0 };
    let mut bytes = Vec::new();
    let integers = |bytes: &mut Vec<u8>, n: &[usize]| n.iter().for_each(|&n| bytes.extend((n as i32).to_le_bytes()));
    integers(&mut bytes, &[vertices, textured, faces, 2]);
    let reals = |bytes: &mut Vec<u8>, rng: &mut Rng, count: usize| {
        (0..count).for_each(|_| bytes.extend((rng.f64() as f32).to_le_bytes()));
    };
    reals(&mut bytes, rng, 3 * vertices + 2 * textured);
    let corners: Vec<usize> = (0..3 * faces).map(|_| rng.usize(..vertices)).collect();
    integers(&mut bytes, &corners);
    for name in names {
        let mut field = [0; 40];
        field[..name.len()].copy_from_slice(name.as_bytes());
        bytes.extend(field);
        reals(&mut bytes, rng, 7);
        integers(&mut bytes, &[vertices]);
        integers(&mut bytes, &(0..vertices).collect::<Vec<_>>());
        reals(&mut bytes, rng, vertices);
    }
    bytes
}

fn skins_of_files_are_taken_alike() {
    let text = document(r#"<skin name="s" file="s.skn"/>"#);
    let mut rng = Rng::with_seed(2);
    let (mut equal, mut rejected) = (0, 0);
    for _ in 0..200 {
        let bytes = file(&mut rng, ["a", "world"]);
        assert!(
            matches!(outcome(&text, &[("s.skn", &bytes)]), Outcome::Equal),
            "a file of a skin"
        );
        for _ in 0..3 {
            let mut other = bytes.clone();
            // larger numbers of elements, and those of a bone, end MuJoCo
            match rng.usize(..4) {
                0 => other.truncate(rng.usize(..bytes.len())),
                1 => other.extend([0; 4]),
                2 => other[4 * rng.usize(..4)] = rng.u8(..),
                _ => other[16 + rng.usize(..12 * usize::from(bytes[0]))] ^= 1 << rng.usize(..8),
            }
            match outcome(&text, &[("s.skn", &other)]) {
                Outcome::Equal => equal += 1,
                Outcome::Rejected | Outcome::Stricter(_) => rejected += 1,
                Outcome::Fault(fault) => panic!("{fault}"),
            }
        }
    }
    show!("changed files of skins: {equal} taken alike, {rejected} rejected");
    same(&text, &[("s.skn", &[])]);
    same(&text, &[("s.skn", &[0; 16])]);
    same(&text, &[("s.skn", &file(&mut rng, ["a", "nobody"]))]);
    let filled = document(r#"<skin name="s" file="s.skn" texcoord="0 0"/>"#);
    same(&filled, &[("s.skn", &file(&mut rng, ["a", "world"]))]);
}

fn attached_skins_are_taken_alike() {
    let attach = |prefix: &str| {
        format!(
            r#"<mujoco><asset><model name="c" file="c.xml"/></asset><worldbody>
            <body name="x"><attach model="c" body="a" prefix="{prefix}"/></body></worldbody></mujoco>"#
        )
    };
    let skin = r#"name="s" vertex="0 0 0 1 0 0 1 1 0" face="0 1 2""#;
    let child = one(
        skin,
        r#"bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 1""#,
    );
    same(&attach("p_"), &[("c.xml", child.as_bytes())]);
    let child = document(r#"<skin name="s" file="s.skn"/>"#);
    let mut rng = Rng::with_seed(3);
    for name in ["a", "p_a"] {
        let skin = file(&mut rng, [name, "world"]);
        same(&attach("p_"), &[("c.xml", child.as_bytes()), ("s.skn", &skin)]);
    }
}

fn skins_of_cables_are_taken_alike() {
    let cable = |geom: &str, skin: &str, more: &str| {
        format!(
            r#"<mujoco><asset><material name="cloth" rgba="1 0 0 1"/></asset><worldbody><composite prefix="p" type="cable"
            curve="s cos(s) 0" count="7 1 1" size="1 0.1 2" {more}><joint kind="main" damping="0.1"/><geom {geom}/>{skin}</composite>
            </worldbody></mujoco>"#
        )
    };
    for geom in [
        r#"type="box" size="0.01 0.02 0.03""#,
        r#"type="box" size="0.05 0.01 0.004""#,
        r#"type="capsule" size="0.01""#,
        r#"type="cylinder" size="0.01""#,
    ] {
        for skin in [
            "",
            "<skin/>",
            r#"<skin texcoord="true" inflate="0.1" rgba="1 0 0 0.5" group="2"/>"#,
            r#"<skin material="cloth"/>"#,
            r#"<skin material="none"/>"#,
            r#"<skin group="7"/>"#,
        ] {
            for more in ["", r#"initial="none""#, r#"initial="free""#] {
                same(&cable(geom, skin, more), &[]);
            }
        }
        // one body, and a copy of a cable
        same(&cable(geom, "", "").replace("7 1 1", "2 1 1"), &[]);
        let copied =
            cable(geom, "", "").replace("<composite", r#"<replicate count="2" offset="0 1 0"><body><composite"#);
        same(&copied.replace("</composite>", "</composite></body></replicate>"), &[]);
    }
}

/// What MuJoCo takes is equal in all arrays: which vertices a bone pulls, too, though some weights are nothing but rounding.
fn divided_skins_of_cables_are_equal() {
    let cable = |count: usize, curve: &str, size: &str, skin: &str| {
        format!(
            r#"<mujoco><worldbody><composite prefix="p" type="cable" curve="{curve}" count="{count} 1 1" size="1 0.2 2">
            <geom type="box" size="{size}"/><skin {skin}/></composite></worldbody></mujoco>"#
        )
    };
    let mut vertices = 0;
    let mut equal = |text: &str| match outcome(text, &[]) {
        Outcome::Equal => vertices += model(text).skins[0].vert.len(),
        Outcome::Fault(fault) => panic!("{fault}\n{text}"),
        Outcome::Rejected | Outcome::Stricter(_) => panic!("refused: {text}"),
    };
    for subgrid in [0, 1, 2, 3, 4, 5, 6, 9, 12] {
        for count in [4, 5, 8, 13] {
            for curve in ["s", "s cos(s) sin(s)", "cos(s) sin(s) 0"] {
                for size in ["0.01 0.02 0.03", "0.05 0.3 0.004"] {
                    equal(&cable(count, curve, size, &format!(r#"subgrid="{subgrid}""#)));
                }
            }
            equal(&cable(
                count,
                "s",
                "0.07 0.01 0.1",
                &format!(r#"subgrid="{subgrid}" texcoord="true" inflate="3""#),
            ));
        }
    }
    for subgrid in ["-1", "-2147483648", "+2"] {
        equal(&cable(4, "s", "0.01 0.02 0.03", &format!(r#"subgrid="{subgrid}""#)));
    }
    show!("divided skins of cables: {vertices} vertices are pulled alike");
    for (count, subgrid) in [(3, "1"), (4, "1.5"), (4, "2147483648"), (4, "x"), (4, "")] {
        let text = cable(count, "s", "0.01 0.02 0.03", &format!(r#"subgrid="{subgrid}""#));
        assert!(matches!(outcome(&text, &[]), Outcome::Rejected), "{text}");
    }
}
