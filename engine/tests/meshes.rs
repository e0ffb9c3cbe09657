//! Meshes: what is taken, what it weighs, and what is refused. Live MuJoCo is asked in `conformance`.

use mjcf_sim::Limits;
use mjcf_sim::assets::MemoryAssets;
use mjcf_sim::mjcf_loader::load_str_with;
use mjcf_sim::model::{GeomType, Model};
use mjcf_sim::physics::compile;

const CORNERS: &str = "0 0 0 1 0 0 0 1 0 0 0 1";
const FACES: &str = "0 2 1 0 1 3 0 3 2 1 2 3";

/// A cube of 2 m in Wavefront's format.
const CUBE: &str = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn load_with(mesh: &str, geom: &str, limits: &Limits) -> Result<Model, String> {
    let mut assets = MemoryAssets::new();
    for (name, bytes) in [
        ("cube.obj", CUBE.as_bytes()),
        ("d/cube.txt", CUBE.as_bytes()),
        ("bad.obj", b"v 0 0"),
    ] {
        assets.insert(name, bytes).expect("a plain name");
    }
    let text = format!(
        "<mujoco><compiler meshdir=''/><default><default class='big'><mesh scale='2 2 2'/></default></default>
         <asset>{mesh}</asset><worldbody><body><freejoint/><geom {geom}/></body></worldbody></mujoco>"
    );
    let spec = load_str_with(&text, "m.xml", &assets, limits);
    spec.and_then(compile).map_err(|e| e.to_string())
}

fn load(mesh: &str, geom: &str) -> Result<Model, String> {
    load_with(mesh, geom, &Limits::default())
}

const GEOM: &str = "type='mesh' mesh='m'";

#[test]
fn a_cube_from_a_file_weighs_what_a_box_weighs() {
    let cube = load("<mesh file='cube.obj'/>", "type='mesh' mesh='cube'").expect("valid");
    assert_eq!(cube.body_mass[1], 8000.0);
    // its third parts are in single precision
    assert!(
        cube.geom_pos[0].iter().all(|x| (x - 1.0).abs() < 1e-7),
        "{:?}",
        cube.geom_pos
    );
    assert_eq!((cube.geom_type[0], cube.geom_dataid[0]), (GeomType::Mesh, Some(0)));
    for moment in cube.body_inertia[1] {
        assert!((moment / (8000.0 * 8.0 / 12.0) - 1.0).abs() < 1e-6, "{moment}");
    }
    let [mesh] = &cube.meshes[..] else { panic!("one mesh") };
    assert_eq!((mesh.name.as_str(), mesh.vert.len(), mesh.face.len()), ("cube", 8, 12));
    let hull = mesh.hull.as_ref().expect("it touches");
    assert_eq!((hull.vert.len(), hull.face.len(), hull.edge.len()), (8, 12, 36));
    // what only is drawn needs no hull
    let drawn = load(
        "<mesh file='cube.obj'/>",
        "type='mesh' mesh='cube' contype='0' conaffinity='0'",
    )
    .expect("valid");
    assert!(drawn.meshes[0].hull.is_none());
    let typed = load(
        "<mesh name='m' file='d/cube.txt' content_type='model/obj' class='big'/>",
        GEOM,
    )
    .expect("valid");
    assert_eq!(typed.body_mass[1], 64_000.0);
}

#[test]
fn corners_alone_have_the_faces_of_their_hull() {
    let mesh = format!("<mesh name='m' vertex='{CORNERS} 0.1 0.1 0.1'/>");
    let model = load(&mesh, GEOM).expect("valid");
    assert!(
        (model.body_mass[1] - 1000.0 / 6.0).abs() < 1e-4,
        "{}",
        model.body_mass[1]
    );
    assert_eq!((model.meshes[0].vert.len(), model.meshes[0].face.len()), (5, 4));
    let shell = load(&format!("<mesh name='m' vertex='{CORNERS}' inertia='shell'/>"), GEOM).expect("valid");
    assert!((shell.body_mass[1] / 1000.0 - 1.5 - 0.75_f64.sqrt()).abs() < 1e-6);
}

#[test]
fn shapes_fit_meshes() {
    let sphere = load(
        &format!("<mesh name='m' vertex='{CORNERS}'/>"),
        "type='sphere' mesh='m' fitscale='2'",
    )
    .expect("valid");
    assert!(
        (sphere.geom_size[0][0] / 2.0 - 0.322_748_61).abs() < 1e-7,
        "{:?}",
        sphere.geom_size
    );
    assert_eq!(sphere.geom_dataid[0], Some(0));
    let error = load("<mesh file='cube.obj'/>", "type='plane' mesh='cube'").expect_err("a plane");
    assert!(error.contains("a plane"), "{error}");
}

#[test]
fn what_is_no_mesh_is_refused() {
    let own = |rest: &str| format!("<mesh name='m' vertex='{CORNERS}' {rest}/>");
    for (mesh, geom, part) in [
        (
            "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0'/>",
            GEOM,
            "4 vertices at least",
        ),
        (
            "<mesh name='m' vertex='0 0 0 1'/>",
            GEOM,
            "three numbers for each vertex",
        ),
        (
            "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 nan 0 0'/>",
            GEOM,
            "is not a finite number",
        ),
        (
            "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 0'/>",
            GEOM,
            "no convex hull",
        ),
        (
            "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 0' face='0 1 2 1 3 2' inertia='exact'/>",
            "type='mesh' mesh='m' contype='0' conaffinity='0'",
            "too small",
        ),
        (
            "<mesh name='m' vertex='0 0 0 1e30 0 0 0 1e30 0 0 0 1e30'/>",
            GEOM,
            "mesh",
        ),
        (
            &own("face='0 1 9'"),
            GEOM,
            "face 0 names vertex 9, of which there are 4",
        ),
        (&own("face='0 1 0.5'"), GEOM, "\"0.5\" is not"),
        (&own("face='0 1'"), GEOM, "three whole numbers"),
        (&own("face='0 1 4294967295'"), GEOM, "4294967295 must be"),
        (&own("normal='0 0 1'"), GEOM, "as many normals"),
        (&own("texcoord='0 0'"), GEOM, "as many texture coordinates"),
        (&own("maxhullvert='3'"), GEOM, "maxhullvert"),
        (&own("scale='0 1 1'"), GEOM, "too small"),
        (&own("refquat='0 0 0 0'"), GEOM, "zero quaternion"),
        (
            &own("inertia='exact' face='0 2 1 0 3 1 0 3 2 1 2 3'"),
            GEOM,
            "inconsistent orientation",
        ),
        (&own("inertia='exact' face='0 1 2 0 3 1 0 2 3 1 3 2'"), GEOM, "negative"),
        (&own("file='cube.obj'"), GEOM, "the file has vertices already"),
        ("<mesh name='m' file='d/cube.txt'/>", GEOM, "OBJ, STL or MSH"),
        ("<mesh name='m' file='none.obj'/>", GEOM, "does not exist"),
        (
            "<mesh name='m' file='bad.obj'/>",
            GEOM,
            "file \"bad.obj\": line 1 has too few numbers",
        ),
        ("<mesh vertex='0 0 0'/>", GEOM, "attribute \"name\" is required"),
        ("<mesh name='m' vertex='0 0 0'/>", "type='mesh'", "4 vertices"),
        (&own(""), "type='mesh'", "attribute \"mesh\" is required"),
        (&own(""), "type='mesh' mesh='n'", "there is no mesh \"n\""),
        (&own(""), "type='mesh' mesh='m' fromto='0 0 0 0 0 1'", "fromto"),
    ] {
        let error = load(mesh, geom).expect_err(mesh);
        assert!(error.contains("m.xml:1") || error.contains("m.xml:2"), "{error}");
        assert!(error.contains(part), "{mesh}: {error}");
    }
    let limits = Limits {
        mesh_elements: 20,
        ..Limits::default()
    };
    let two =
        format!("<mesh name='m' vertex='{CORNERS}' face='{FACES}'/><mesh name='n' vertex='{CORNERS}' face='{FACES}'/>");
    assert!(
        load_with(
            &two,
            GEOM,
            &Limits {
                mesh_elements: 16,
                ..Limits::default()
            }
        )
        .is_ok()
    );
    let three = format!("{two}<mesh name='o' file='cube.obj'/>");
    assert!(
        load_with(&three, GEOM, &limits)
            .expect_err("too much")
            .contains("more than")
    );
    let limits = Limits {
        mesh_numbers: 11,
        ..Limits::default()
    };
    assert!(
        load_with(&two, GEOM, &limits)
            .expect_err("too much")
            .contains("12 values")
    );
}

fn load_hfield(hfield: &str, geom: &str, limits: &Limits) -> Result<Model, String> {
    let mut assets = MemoryAssets::new();
    let heights = [0.0_f32, 1.0, 2.0, 4.0].into_iter().flat_map(f32::to_le_bytes);
    let file: Vec<u8> = [2_i32, 2]
        .into_iter()
        .flat_map(i32::to_le_bytes)
        .chain(heights)
        .collect();
    assets.insert("a.hf", file).expect("a plain name");
    assets.insert("b.hf", b"short").expect("a plain name");
    let far = [2_u32, 2, 0x7f00_0000, 0xff00_0000, 0, 0]
        .into_iter()
        .flat_map(u32::to_le_bytes);
    assets.insert("far.hf", far.collect::<Vec<_>>()).expect("a plain name");
    let text = format!("<mujoco><asset>{hfield}</asset><worldbody><geom {geom}/></worldbody></mujoco>");
    let spec = load_str_with(&text, "m.xml", &assets, limits);
    spec.and_then(compile).map_err(|e| e.to_string())
}

#[test]
fn heights_are_scaled_and_begin_at_the_least_y() {
    let load = |hfield: &str, name: &str| {
        let geom = format!("type='hfield' hfield='{name}'");
        load_hfield(hfield, &geom, &Limits::default()).expect("valid")
    };
    let model = load(
        "<hfield name='h' nrow='2' ncol='2' size='2 3 4 1' elevation='1 3 5 5'/>",
        "h",
    );
    let [hfield] = &model.hfields[..] else {
        panic!("one height field")
    };
    assert_eq!(hfield.data, [1.0, 1.0, 0.0, 0.5]);
    assert_eq!((model.geom_type[0], model.geom_dataid[0]), (GeomType::HField, Some(0)));
    assert_eq!(model.geom_size[0], [2.0, 3.0, 1.5]);
    assert_eq!(model.geom_aabb[0], [0.0, 0.0, 1.5, 2.0, 3.0, 2.5]);
    assert_eq!(model.geom_rbound[0], 29.0_f64.sqrt());
    let file = load("<hfield file='a.hf' size='2 3 4 1'/>", "a");
    assert_eq!(
        (file.hfields[0].name.as_str(), &file.hfields[0].data[..]),
        ("a", &[0.0, 0.25, 0.5, 1.0][..])
    );
    let flat = load("<hfield name='h' nrow='3' ncol='2' size='2 3 4 1'/>", "h");
    assert_eq!(flat.hfields[0].data, [0.0; 6]);
}

#[test]
fn what_is_no_height_field_is_refused() {
    let geom = "type='hfield' hfield='h'";
    let own = |rest: &str| format!("<hfield name='h' {rest}/>");
    let limits = Limits {
        mesh_elements: 20,
        ..Limits::default()
    };
    for (hfield, geom, part) in [
        (own("nrow='2' ncol='2'"), geom, "attribute \"size\" is required"),
        (own("nrow='2' ncol='2' size='1 1 1 0'"), geom, "must be positive"),
        (own("nrow='1' ncol='2' size='1 1 1 1'"), geom, "2 rows and 2 columns"),
        (
            own("nrow='65536' ncol='65536' size='1 1 1 1'"),
            geom,
            "more than 20 heights",
        ),
        (
            own("nrow='3' ncol='3' size='1 1 1 1'") + "<hfield name='i' nrow='3' ncol='4' size='1 1 1 1'/>",
            geom,
            "more than 11 heights",
        ),
        (
            own("nrow='2' ncol='2' size='1 1 1 1' elevation='1 2 3'"),
            geom,
            "nrow times ncol",
        ),
        (
            own("nrow='2' ncol='2' size='1 1 1 1' elevation='nan 2 3 4'"),
            geom,
            "not a finite number",
        ),
        (own("file='far.hf' size='1 1 1 1'"), geom, "too far from each other"),
        (
            own("file='b.hf' size='1 1 1 1'"),
            geom,
            "file \"b.hf\": the file has 5 bytes",
        ),
        (own("file='c.hf' size='1 1 1 1'"), geom, "does not exist"),
        (own("file='a.hf' content_type='a' size='1 1 1 1'"), geom, "content_type"),
        (
            "<hfield size='1 1 1 1'/>".to_owned(),
            geom,
            "attribute \"name\" is required",
        ),
        (
            own("nrow='2' ncol='2' size='1 1 1 1'"),
            "type='hfield'",
            "attribute \"hfield\" is required",
        ),
        (
            own("nrow='2' ncol='2' size='1 1 1 1'"),
            "type='hfield' hfield='i'",
            "there is no hfield \"i\"",
        ),
        (
            own("nrow='2' ncol='2' size='1 1 1 1'"),
            "size='1' hfield='h'",
            "only a geom with type=\"hfield\"",
        ),
    ] {
        let error = load_hfield(&hfield, geom, &limits).expect_err(&hfield);
        assert!(error.contains("m.xml:1") && error.contains(part), "{hfield}: {error}");
    }
}
