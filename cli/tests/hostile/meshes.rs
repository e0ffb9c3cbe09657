//! Meshes and height fields: files of a model that is simulated for two steps.

use std::fmt::Write;

use crate::bytes::{chunk, header, png, zlib};
use crate::case::{Case, Content};

/// A ball that falls on a mesh, or on what stands in its place.
fn simulated(name: &str, asset: &str, geom: &str) -> Case {
    let model = format!(
        "<mujoco>\n<asset>{asset}</asset>\n<worldbody>\n{geom}\n<body pos='0 0 2'><freejoint/><geom size='.1'/></body>\n</worldbody>\n</mujoco>"
    );
    Case::new(format!("mesh: {name}"), "simulate m.xml --steps 2 --out a.npz").file("m.xml", model)
}

/// A mesh of a file.
fn of_file(name: &str, file: &str, content: impl Into<Content>) -> Case {
    let asset = format!("<mesh name='m' file='{file}'/>");
    let geom = "<body><freejoint/><geom type='mesh' mesh='m'/></body>";
    simulated(&format!("{file}, {name}"), &asset, geom).file(file, content)
}

/// A mesh in the document.
fn inline(name: &str, attributes: &str) -> Case {
    let geom = "<body><freejoint/><geom type='mesh' mesh='m'/></body>";
    simulated(
        &format!("inline, {name}"),
        &format!("<mesh name='m' {attributes}/>"),
        geom,
    )
}

/// A height field of a file.
fn heights(name: &str, file: &str, content: impl Into<Content>) -> Case {
    let asset = format!("<hfield name='h' size='1 1 1 .1' file='{file}'/>");
    simulated(
        &format!("heights, {file}, {name}"),
        &asset,
        "<geom type='hfield' hfield='h'/>",
    )
    .file(file, content)
}

/// A skin of a file.
fn skin(name: &str, content: impl Into<Content>) -> Case {
    let asset = "<skin name='s' file='a.skn'/>";
    simulated(&format!("skin, {name}"), asset, "").file("a.skn", content)
}

/// MuJoCo's format of skins: announced sizes, a triangle, and a bone that announces a number of vertices.
fn skn(sizes: [i32; 4], corners: [i32; 3], body: &[u8], pulls: i32) -> Vec<u8> {
    let mut out: Vec<u8> = sizes.iter().flat_map(|n| n.to_le_bytes()).collect();
    let numbers = |out: &mut Vec<u8>, numbers: &[f32]| out.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    numbers(&mut out, CORNER[..3].as_flattened());
    out.extend(corners.iter().flat_map(|k| k.to_le_bytes()));
    out.extend([body, &[0; 40]].concat().iter().take(40));
    numbers(&mut out, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    out.extend([pulls, 0, 1, 2].iter().flat_map(|k| k.to_le_bytes()));
    numbers(&mut out, &[1.0; 3]);
    out
}

fn skins() -> Vec<Case> {
    let sizes = [3, 0, 1, 1];
    let sound = skn(sizes, [0, 1, 2], b"world", 3);
    let mut odd = sound.clone();
    odd[16..20].copy_from_slice(&f32::NAN.to_le_bytes());
    let end = sound.len();
    let mut light = sound.clone();
    light[end - 12..].fill(0);
    vec![
        skin("sound", sound.clone()),
        skin("empty", ""),
        skin("only sizes", vec![0; 16]),
        skin("sizes that are negative", skn([3, -1, 1, 1], [0, 1, 2], b"world", 3)),
        skin("sizes beyond all memory", skn([i32::MAX; 4], [0, 1, 2], b"world", 3)),
        skin("2 billion bones", skn([3, 0, 1, i32::MAX], [0, 1, 2], b"world", 3)),
        skin(
            "a bone of 2 billion vertices",
            skn(sizes, [0, 1, 2], b"world", i32::MAX),
        ),
        skin("a bone of -1 vertices", skn(sizes, [0, 1, 2], b"world", -1)),
        skin("a corner that is not there", skn(sizes, [0, 1, 3], b"world", 3)),
        skin("a corner of number -1", skn(sizes, [0, 1, -1], b"world", 3)),
        skin("a body that is not there", skn(sizes, [0, 1, 2], b"nobody", 3)),
        skin("a body that is no text", skn(sizes, [0, 1, 2], &[0xff; 40], 3)),
        skin("a vertex that is not a number", odd),
        skin("no weights", light),
        skin("bytes after its end", [sound.clone(), vec![0; 9]].concat()),
        skin("cut in its bone", &sound[..end - 20]),
    ]
}

/// Binary STL that announces a number of triangles.
fn stl(announced: u32, triangles: &[[f32; 9]]) -> Vec<u8> {
    let mut out = vec![0; 80];
    out.extend(announced.to_le_bytes());
    for triangle in triangles {
        out.extend([0; 12]);
        triangle.iter().for_each(|x| out.extend(x.to_le_bytes()));
        out.extend([0; 2]);
    }
    out
}

/// MuJoCo's own format: announced sizes, then numbers, then corners.
fn msh(sizes: [i32; 4], numbers: &[f32], corners: &[i32]) -> Vec<u8> {
    let sizes = sizes.iter().flat_map(|n| n.to_le_bytes());
    let numbers = numbers.iter().flat_map(|x| x.to_le_bytes());
    sizes
        .chain(numbers)
        .chain(corners.iter().flat_map(|k| k.to_le_bytes()))
        .collect()
}

/// Heights of MuJoCo's own format.
fn field(rows: i32, columns: i32, values: &[f32]) -> Vec<u8> {
    let sizes = [rows.to_le_bytes(), columns.to_le_bytes()].concat();
    [sizes, values.iter().flat_map(|x| x.to_le_bytes()).collect()].concat()
}

const CORNER: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
const SIDES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn tetrahedron() -> Vec<[f32; 9]> {
    let corners = |side: [usize; 3]| side.map(|k| CORNER[k]).concat();
    SIDES
        .iter()
        .map(|&side| corners(side).try_into().expect("nine numbers"))
        .collect()
}

/// The tetrahedron with other faces or vertices below it.
fn obj(more: &str) -> String {
    let mut text = String::new();
    for [x, y, z] in CORNER {
        writeln!(text, "v {x} {y} {z}").expect("a string");
    }
    for side in SIDES {
        let [a, b, c] = side.map(|k| k + 1);
        writeln!(text, "f {a} {b} {c}").expect("a string");
    }
    text + more
}

fn files() -> Vec<Case> {
    let mut odd = tetrahedron();
    odd[1][4] = f32::NAN;
    let mut far = tetrahedron();
    far[1][4] = f32::INFINITY;
    let mut huge = tetrahedron();
    huge.iter_mut().flatten().for_each(|x| *x *= 1e38);
    let flat: Vec<[f32; 9]> = vec![[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]; 4];
    let point = vec![[0.5; 9]; 4];
    let all: Vec<f32> = CORNER.concat();
    let sides: Vec<i32> = SIDES.concat().iter().map(|&k| k as i32).collect();
    let turned: Vec<[f32; 9]> = tetrahedron()
        .iter()
        .map(|t| [&t[3..6], &t[..3], &t[6..]].concat().try_into().expect("nine"))
        .collect();
    vec![
        of_file("sound", "a.stl", stl(4, &tetrahedron())),
        of_file("empty", "a.stl", ""),
        of_file("only a header", "a.stl", vec![0; 80]),
        of_file("no triangles", "a.stl", stl(0, &[])),
        of_file(
            "100 million triangles that are not there",
            "a.stl",
            stl(100_000_000, &tetrahedron()),
        ),
        of_file("4 billion triangles", "a.stl", stl(u32::MAX, &tetrahedron())),
        of_file("more triangles than it says", "a.stl", stl(3, &tetrahedron())),
        of_file("cut in a triangle", "a.stl", &stl(4, &tetrahedron())[..200]),
        of_file(
            "text",
            "a.stl",
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid",
        ),
        of_file("a coordinate that is not a number", "a.stl", stl(4, &odd)),
        of_file("a coordinate without end", "a.stl", stl(4, &far)),
        of_file("coordinates of 1e37", "a.stl", stl(4, &huge)),
        of_file("one triangle four times", "a.stl", stl(4, &flat)),
        of_file("one point", "a.stl", stl(4, &point)),
        of_file("inside out", "a.stl", stl(4, &turned)),
        of_file("a hole", "a.stl", stl(3, &tetrahedron()[..3])),
        of_file("a pipe", "a.stl", Content::Pipe),
        of_file("a folder", "a.stl", Content::Folder),
        of_file("a link that leaves the folder", "a.stl", Content::Link("/etc/passwd")),
        of_file("a gibibyte of zeros", "a.stl", Content::Zeros(1 << 30)),
        of_file("sound", "a.obj", obj("")),
        of_file("empty", "a.obj", ""),
        of_file("not text", "a.obj", vec![0xff; 1000]),
        of_file("no faces", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"),
        of_file("one vertex", "a.obj", "v 0 0 0\n"),
        of_file("a vertex of two numbers", "a.obj", obj("v 1 2\n")),
        of_file("a vertex in words", "a.obj", obj("v a b c\n")),
        of_file("a vertex that is not a number", "a.obj", obj("v nan 0 0\n")),
        of_file("a vertex of 1e300", "a.obj", obj("v 1e300 0 0\n")),
        of_file("a corner that is not there", "a.obj", obj("f 1 2 99\n")),
        of_file("a corner before the first", "a.obj", obj("f 1 2 -99\n")),
        of_file("a corner of number 0", "a.obj", obj("f 0 1 2\n")),
        of_file("a corner of number 1e18", "a.obj", obj("f 1 2 1000000000000000000\n")),
        of_file(
            "a corner of 30 digits",
            "a.obj",
            obj(&format!("f 1 2 {}\n", "9".repeat(30))),
        ),
        of_file("a face of two corners", "a.obj", obj("f 1 2\n")),
        of_file(
            "a face of 100,000 corners",
            "a.obj",
            obj(&format!("f{}\n", " 1 2 3".repeat(33_334))),
        ),
        of_file("faces that are twice there", "a.obj", obj(&obj(""))),
        of_file("a normal that is not there", "a.obj", obj("f 1//9 2//9 3//9\n")),
        of_file(
            "texture coordinates that are not there",
            "a.obj",
            obj("f 1/9 2/9 3/9\n"),
        ),
        of_file("a line of 8 million characters", "a.obj", "v".repeat(8 << 20)),
        of_file("a million empty lines", "a.obj", obj(&"\n".repeat(1 << 20))),
        of_file("a million continued lines", "a.obj", obj(&"\\\n".repeat(1 << 20))),
        of_file("a million faces", "a.obj", obj(&"f 1 2 3\n".repeat(1 << 20))),
        of_file("sound", "a.msh", msh([4, 0, 0, 4], &all, &sides)),
        of_file("empty", "a.msh", ""),
        of_file("sizes that are negative", "a.msh", msh([-4, 0, 0, -4], &all, &sides)),
        of_file("sizes beyond all memory", "a.msh", msh([i32::MAX; 4], &all, &sides)),
        of_file(
            "100 million faces that are not there",
            "a.msh",
            msh([4, 0, 0, 100_000_000], &all, &sides),
        ),
        of_file("normals that are not there", "a.msh", msh([4, 4, 0, 4], &all, &sides)),
        of_file(
            "a corner that is not there",
            "a.msh",
            msh([4, 0, 0, 1], &all, &[0, 1, 4]),
        ),
        of_file("a corner of number -1", "a.msh", msh([4, 0, 0, 1], &all, &[0, 1, -1])),
        of_file(
            "a vertex that is not a number",
            "a.msh",
            msh([4, 0, 0, 4], &[&all[..11], &[f32::NAN]].concat(), &sides),
        ),
        of_file("three vertices", "a.msh", msh([3, 0, 0, 1], &all[..9], &[0, 1, 2])),
        of_file(
            "bytes after its end",
            "a.msh",
            [msh([4, 0, 0, 4], &all, &sides), vec![0; 9]].concat(),
        ),
        of_file("a format of no mesh", "a.dae", "<COLLADA/>"),
        of_file("a name without an end", "a", "v 0 0 0"),
    ]
}

fn documents() -> Vec<Case> {
    let vertex = "vertex='0 0 0 .1 0 0 0 .1 0 0 0 .1'";
    let numbers = |count: usize| (0..count).map(|k| format!("{} ", k % 977)).collect::<String>();
    let sheet: String = (0..400).map(|k| format!("{} {} 0 ", k % 20, k / 20)).collect();
    vec![
        inline("sound", vertex),
        inline("no vertices", ""),
        inline("three vertices", "vertex='0 0 0 1 0 0 0 1 0'"),
        inline("four numbers", "vertex='0 0 0 1'"),
        inline("on a plane", &format!("vertex='{sheet}'")),
        inline("on a line", "vertex='0 0 0 1 0 0 2 0 0 3 0 0 4 0 0'"),
        inline("at one point", &format!("vertex='{}'", "1 2 3 ".repeat(8))),
        inline("not a number", "vertex='0 0 0 1 0 0 0 1 0 0 0 nan'"),
        inline("beyond single precision", "vertex='0 0 0 1e39 0 0 0 1e39 0 0 0 1e39'"),
        inline("all but a point", "vertex='0 0 0 1e-30 0 0 0 1e-30 0 0 0 1e-30'"),
        inline("a corner that is not there", &format!("{vertex} face='0 1 7'")),
        inline("a negative corner", &format!("{vertex} face='0 1 -1'")),
        inline("two corners", &format!("{vertex} face='0 1'")),
        inline("faces that hold nothing", &format!("{vertex} face='0 1 1 2 2 2'")),
        inline("scale 0", &format!("{vertex} scale='0 0 0'")),
        inline("scale not a number", &format!("{vertex} scale='nan 1 1'")),
        inline("mirrored", &format!("{vertex} scale='-1 1 1'")),
        inline("no orientation", &format!("{vertex} refquat='0 0 0 0'")),
        inline("a hull of three corners", &format!("{vertex} maxhullvert='3'")),
        inline("a hull of -5 corners", &format!("{vertex} maxhullvert='-5'")),
        inline("normals for two vertices", &format!("{vertex} normal='0 0 1 0 0 1'")),
        inline(
            "texture coordinates for one vertex",
            &format!("{vertex} texcoord='0 0'"),
        ),
        inline("a file that is not there", "file='a.stl'"),
        inline("a file above its folder", "file='../../../../etc/passwd.stl'"),
        inline("an address for a file", "file='http://a/b.obj'"),
        inline(
            "exact inertia of what is inside out",
            &format!("{vertex} face='0 1 2 0 3 1 0 2 3 1 3 2' inertia='exact'"),
        ),
        inline("30,000 vertices", &format!("vertex='{}'", numbers(90_000))),
        simulated("a geom without a mesh", "", "<geom type='mesh'/>"),
        simulated("a mesh that is not there", "", "<geom type='mesh' mesh='m'/>"),
        simulated(
            "one name twice",
            &format!("<mesh name='m' {vertex}/><mesh name='m' {vertex}/>"),
            "",
        ),
        simulated(
            "a plane of a mesh",
            &format!("<mesh name='m' {vertex}/>"),
            "<geom type='plane' mesh='m'/>",
        ),
    ]
}

fn fields() -> Vec<Case> {
    let grey = |size: u32, rows: usize| {
        png(&[
            &header(size, size, 8, 0),
            &chunk(b"IDAT", &zlib(&vec![0; rows * (size as usize + 1)])),
        ])
    };
    let field_of = |attributes: &str| format!("<hfield name='h' {attributes}/>");
    let inline = |name: &str, attributes: &str| {
        simulated(
            &format!("heights, inline, {name}"),
            &field_of(attributes),
            "<geom type='hfield' hfield='h'/>",
        )
    };
    vec![
        heights("sound", "a.png", grey(4, 4)),
        heights("one pixel", "a.png", grey(1, 1)),
        heights("rows that are not there", "a.png", grey(8, 2)),
        heights(
            "8192 x 8192 that are not there",
            "a.png",
            png(&[&header(8192, 8192, 8, 0), &chunk(b"IDAT", &zlib(&[0; 9]))]),
        ),
        heights("text", "a.png", "not a picture"),
        heights("sound", "a.bin", field(2, 2, &[0.0, 1.0, 2.0, 3.0])),
        heights("empty", "a.bin", ""),
        heights("no rows", "a.bin", field(0, 4, &[])),
        heights("-2 rows", "a.bin", field(-2, -2, &[0.0; 4])),
        heights(
            "more heights than there are numbers",
            "a.bin",
            field(i32::MAX, i32::MAX, &[0.0; 4]),
        ),
        heights(
            "100 million heights that are not there",
            "a.bin",
            field(10_000, 10_000, &[0.0; 4]),
        ),
        heights("too few heights", "a.bin", field(3, 3, &[0.0; 4])),
        heights(
            "a height that is not a number",
            "a.bin",
            field(2, 2, &[0.0, f32::NAN, 0.0, 0.0]),
        ),
        inline("sound", "nrow='2' ncol='2' size='1 1 1 .1' elevation='0 1 0 1'"),
        inline("no size", "nrow='2' ncol='2' elevation='0 1 0 1'"),
        inline("a size of 0", "nrow='2' ncol='2' size='1 1 0 0' elevation='0 1 0 1'"),
        inline("100 million heights", "nrow='10000' ncol='10000' size='1 1 1 .1'"),
        inline("one row", "nrow='1' ncol='4' size='1 1 1 .1'"),
        inline("too few heights", "nrow='2' ncol='2' size='1 1 1 .1' elevation='0 1'"),
        inline(
            "heights that are no numbers",
            "nrow='2' ncol='2' size='1 1 1 .1' elevation='0 1 nan inf'",
        ),
        simulated(
            "heights that move",
            &field_of("nrow='2' ncol='2' size='1 1 1 .1'"),
            "<body><freejoint/><geom type='hfield' hfield='h'/></body>",
        ),
    ]
}

pub fn cases() -> Vec<Case> {
    [files(), documents(), fields(), skins()].concat()
}
