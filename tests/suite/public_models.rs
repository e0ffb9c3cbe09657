//! Demands of public models on the loader: lenses, empty references, colours beyond one.

use std::sync::Arc;

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, SoftEngine, SoftOptions, compile};
use babybench::render::{CpuRenderer, Poses, RenderError, Scenery, View};

fn engine(text: &str) -> SoftEngine {
    let model = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
    let model = model.unwrap_or_else(|e| panic!("{e}"));
    SoftEngine::new(Arc::new(model), SoftOptions::default())
}

#[test]
fn lenses_and_sensors_of_cameras_give_their_field_of_view() {
    let camera = |attributes: &str| {
        let text = format!("<mujoco><worldbody><camera {attributes}/></worldbody></mujoco>");
        let model = load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile);
        model
            .map(|model| (model.cam_fovy[0], model.cam_intrinsic[0]))
            .map_err(|e| e.to_string())
    };
    let sensor = r#"sensorsize="1 2" resolution="100 200""#;
    let (fovy, lens) = camera(&format!(r#"{sensor} focal="1 1" principalpixel="3 4""#)).expect("valid");
    assert!((fovy - 90.0).abs() < 1e-5, "{fovy}");
    assert_eq!(lens.map(|v| v as f32), [1.0, 1.0, 0.03, 0.04]);
    let (fovy, lens) = camera(&format!(r#"{sensor} focal="1 1" focalpixel="20 30""#)).expect("pixels count");
    assert!((fovy - 146.601_513_78).abs() < 1e-5, "{fovy}");
    assert_eq!(lens.map(|v| v as f32), [0.2, 0.3, 0.0, 0.0]);
    for (attributes, part) in [
        (r#"focal="1 1""#, "need the sensorsize"),
        (r#"sensorsize="1 2" focal="1 1""#, "needs the resolution"),
        (
            r#"sensorsize="1 2" resolution="1 1" fovy="30""#,
            "either fovy or sensorsize",
        ),
        (sensor, "two positive focal lengths"),
        (r#"sensorsize="1 -2" resolution="1 1" focal="1 1""#, "to be positive"),
    ] {
        let error = camera(attributes).expect_err(attributes);
        assert!(error.contains(part), "{attributes}: {error}");
    }
}

#[test]
fn empty_references_colours_beyond_one_and_frames_that_stay_are_taken() {
    let engine = engine(
        r#"<mujoco><worldbody><light diffuse="1.5 1 1"/><body><freejoint align="false"/><geom size=".1" material="" rgba="41 .5 0 1"/>
           <site material=""/></body></worldbody></mujoco>"#,
    );
    assert_eq!(engine.model().geom_matid, [None]);
    let itself = r#"<mujoco><worldbody><body name="x"><geom name="a" type="box" size=".1 .1 .1"/></body></worldbody>
                    <sensor><distance geom1="a" body2="x" cutoff="1"/></sensor></mujoco>"#;
    let error = load_str(itself, "m.xml", &MemoryAssets::new())
        .and_then(compile)
        .expect_err("refused");
    assert!(error.to_string().contains("has no distance from itself"), "{error}");
}

#[test]
fn pictures_are_as_wide_as_the_sensor_sees() {
    let sensor = r#"sensorsize="2 2" resolution="64 64""#;
    let mut engine = engine(&format!(
        r#"<mujoco><worldbody><geom size=".5" pos="0 0 -3"/><camera fovy="90"/><camera {sensor} focal="1 1"/>
           <camera {sensor} focal="2 1"/><camera {sensor} focal="1 1" principal="0 .1"/><camera orthographic="true"/></worldbody></mujoco>"#
    ));
    let mut state = engine.new_state();
    engine.forward(&mut state).expect("finite");
    let scenery = Scenery::new(engine.model(), &MemoryAssets::new()).expect("no images");
    let (poses, mut renderer) = (Poses::from(&state), CpuRenderer::new());
    let mut sides = |camera: usize| {
        let view = View {
            camera,
            width: 64,
            height: 64,
        };
        let mut geoms = vec![0; view.pixels()];
        renderer.segmentation(&scenery, &poses, &view, &mut geoms)?;
        let row = (0..64).filter(|x| geoms[32 * 64 + x] == 0).count();
        let column = (0..64).filter(|y| geoms[64 * y + 32] == 0).count();
        Ok::<_, RenderError>((row, column))
    };
    let (row, column) = sides(0).expect("drawn");
    assert!(row == column && (8..14).contains(&row), "{row} {column}");
    assert_eq!(sides(1).expect("drawn"), (row, column));
    let (wide, high) = sides(2).expect("drawn");
    assert!(wide.abs_diff(2 * row) <= 2 && high == column, "{wide} {high}");
    assert!(matches!(sides(3), Err(RenderError::OffCentre { camera: 3 })));
    assert!(matches!(sides(4), Err(RenderError::Orthographic { camera: 4 })));
}

/// Of rows with nearly no regularisation a force is the product of a huge number and a tiny one: it is that which balances the rest.
#[test]
fn a_ball_at_rest_without_friction_presses_steadily() {
    let mut engine = engine(
        r#"<mujoco><worldbody><geom type="plane" size="2 2 .1" friction="0 0 0"/><body pos="0 0 .1"><freejoint/>
           <geom size=".1" mass=".1" friction="0 0 0"/><site name="s" size=".2"/></body></worldbody><sensor><touch site="s"/></sensor></mujoco>"#,
    );
    let mut state = engine.new_state();
    for step in 0..1000 {
        engine.step(&mut state).expect("finite");
        let touch = state.sensordata[0];
        assert!(step < 980 || (touch - 0.981).abs() < 1e-4, "step {step}: {touch}");
    }
}

#[test]
fn skins_are_looked_through_and_not_drawn() {
    let data = r#"vertex="0 0 0 1 0 0 0 1 0" face="0 1 2""#;
    let bone = r#"<bone body="b" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 1"/>"#;
    let load = |section: &str, skin: &str| {
        let body = r#"<worldbody><body name="b"><geom size=".1"/></body></worldbody>"#;
        let text = format!("<mujoco><{section}>{skin}</{section}>{body}</mujoco>");
        let model = load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile);
        model.map(|model| model.nbody()).map_err(|e| e.to_string())
    };
    for section in ["asset", "deformable"] {
        let skin = format!(r#"<skin name="s" {data} rgba="1 0 0 1" inflate=".1" group="2">{bone}</skin>"#);
        assert_eq!(load(section, &skin), Ok(2));
        for (skin, part) in [
            (
                format!(r#"<skin {data} material="x">{bone}</skin>"#),
                r#"there is no material "x""#,
            ),
            (
                format!("<skin {data}>{}</skin>", bone.replace(r#""b""#, r#""z""#)),
                r#"there is no body "z""#,
            ),
            (format!("<skin {data}/>"), "a skin needs a file"),
            (r#"<skin file="a.skn"/>"#.to_owned(), "a.skn"),
            (format!(r#"<skin file="a.skn" {data}/>"#), "not both"),
        ] {
            let error = load(section, &skin).expect_err(&skin);
            assert!(error.contains(part), "{skin}: {error}");
        }
    }
}
