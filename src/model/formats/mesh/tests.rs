use super::*;

fn obj(text: &str) -> Result<Triangles, String> {
    read(text.as_bytes(), MeshFormat::Obj)
}

fn read(bytes: &[u8], format: MeshFormat) -> Result<Triangles, String> {
    Triangles::read(bytes, format, false, &Limits::DEFAULT).map_err(|e| e.to_string())
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn polygons_become_triangles() {
    let square = obj(&format!("{SQUARE}f 1 2 3 4\nf -4 -3 -2\nf 1 2\nl 1 2\n")).expect("valid");
    assert_eq!(square.face, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    assert!(square.facenormal.is_empty() && square.facetexcoord.is_empty());
    // the corner between the arms of an arrow is not an ear
    let arrow = obj("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n").expect("valid");
    assert_eq!(arrow.face, [[1, 2, 3], [0, 1, 3]]);
}

/// A ring of `corners` corners, as one polygon.
fn ring(corners: usize) -> String {
    let angle = |k: usize| k as f64 / corners as f64 * std::f64::consts::TAU;
    let vertices = (0..corners).map(|k| format!("v {:.6} {:.6} 0\n", angle(k).cos(), angle(k).sin()));
    let polygon = (1..=corners).map(|k| format!(" {k}"));
    vertices.chain(["f".to_owned()]).chain(polygon).collect::<String>() + "\nf 1 2 3\n"
}

#[test]
fn polygons_of_more_than_a_hundred_corners_are_left_out_as_in_the_reference() {
    assert_eq!(obj(&ring(100)).expect("valid").face.len(), 99);
    assert_eq!(obj(&ring(101)).expect("valid").face, [[0, 1, 2]]);
}

#[test]
fn the_first_object_counts_and_all_vertices() {
    let text = format!("o a\n{SQUARE}f 1 2 3\nusemtl x\nf 1 3 4\ng b\nv 0 0 1\nf 1 2 5\n");
    let mesh = obj(&text).expect("valid");
    assert_eq!((mesh.vert.len(), mesh.face.len()), (5, 2));
}

#[test]
fn corners_name_textures_and_normals() {
    let text = format!("{SQUARE}vt 0 0\nvt .25 .75\nvn 0 0 1\nf 1/1/1 2/2/1 3//1\r\nf 1 3 4\n");
    let mesh = obj(&text).expect("valid");
    assert_eq!(mesh.texcoord, [[0.0, 1.0], [0.25, 0.25]]);
    assert_eq!(mesh.facetexcoord, [[0, 1, NONE], [NONE; 3]]);
    assert_eq!(mesh.facenormal, [[0; 3], [NONE; 3]]);
    let mirrored = Triangles::read(text.as_bytes(), MeshFormat::Obj, true, &Limits::DEFAULT).expect("valid");
    assert_eq!(mirrored.facetexcoord[0], [0, NONE, 1]);
}

#[test]
fn numbers_round_as_those_of_the_reference() {
    let mesh = obj("v 1.5e2 -.25 +3\nv 0.1 123.456 -7e-3\n").expect("valid");
    assert_eq!(mesh.vert, [[150.0, -0.25, 3.0], [0.1, 123.456, -0.007]]);
}

#[test]
fn broken_text_is_an_error_with_its_line() {
    for (text, part) in [
        ("v 0 0\n", "line 1 has too few numbers"),
        ("v 0 a 0\n", "line 1: \"a\" is not a number"),
        ("v 0 nan 0\n", "is not a number"),
        ("v 0 1e300 0\n", "is not a number"),
        ("\nf 0 1 2\n", "line 2: \"0\" is not an index"),
        ("f 1 2 -9\n", "is not an index"),
        ("f 1/2/3/4 1 1\n", "is not an index"),
        ("f 1 2 3\n", "face 0 names vertex 0, of which there are 0"),
        (
            "v 0 0 0\nvn 0 0 1\nf 1//2 1//1 1//1\n",
            "face 0 names normal 1, of which there are 1",
        ),
    ] {
        let error = obj(text).expect_err(text);
        assert!(error.contains(part), "{text:?}: {error}");
    }
    assert_eq!(
        read(b"v \xff\n", MeshFormat::Obj),
        Err("line 1 is not UTF-8 text".to_owned())
    );
    let mut many = "v 0 0 0\n".to_owned();
    many.push_str(&format!("f{}\n", " 1".repeat(100)).repeat(5000));
    let error = obj(&many).expect_err("5000 polygons of 100 corners");
    assert!(error.contains("too many corners"), "{error}");
    let limits = Limits {
        mesh_elements: 4,
        ..Limits::DEFAULT
    };
    let error = Triangles::read(
        b"v 0 0 0\nv 0 0 0\nv 0 0 0\nv 0 0 0\nv 0 0 0\n",
        MeshFormat::Obj,
        false,
        &limits,
    );
    assert_eq!(error, Err(MeshError::TooMuch(4)));
}

/// Encodes triangles as binary STL.
fn stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for t in triangles {
        bytes.extend([0; 12]);
        bytes.extend(t.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn stl_vertices_at_one_place_are_one() {
    let (a, b, c, d) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.0, 0.0, 0.0]);
    let mesh = read(&stl(&[[a, b, c], [c, b, d]]), MeshFormat::Stl).expect("valid");
    assert_eq!(
        (mesh.vert.as_slice(), mesh.face.as_slice()),
        (&[a, b, c][..], &[[0, 1, 2], [2, 1, 0]][..])
    );
    let mirrored = Triangles::read(&stl(&[[a, b, c]]), MeshFormat::Stl, true, &Limits::DEFAULT).expect("valid");
    assert_eq!(mirrored.face, [[0, 2, 1]]);
}

#[test]
fn broken_files_announce_what_they_lack() {
    let good = stl(&[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    for cut in 0..good.len() {
        assert!(read(&good[..cut], MeshFormat::Stl).is_err(), "{cut}");
        assert!(read(&good[..cut], MeshFormat::Msh).is_err(), "{cut}");
    }
    let mut many = good.clone();
    many[80..84].copy_from_slice(&100_000_000_u32.to_le_bytes());
    assert!(
        read(&many, MeshFormat::Stl)
            .expect_err("too many")
            .contains("from 1 to 200000")
    );
    for x in [f32::NAN, f32::INFINITY, 2e9] {
        let bad = stl(&[[[x, 0.0, 0.0], [0.0; 3], [0.0; 3]]]);
        assert!(read(&bad, MeshFormat::Stl).expect_err("too far").contains("vertex 0"));
    }
}

/// Encodes a tetrahedron in MuJoCo's format.
fn msh(header: [i32; 4], corner: u32) -> Vec<u8> {
    let mut bytes: Vec<u8> = header.iter().flat_map(|n| n.to_le_bytes()).collect();
    let vert = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    bytes.extend(vert.iter().flat_map(|x| x.to_le_bytes()));
    for _ in 0..header[2].max(0) {
        bytes.extend([0; 8]);
    }
    let face = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, corner];
    bytes.extend(face.iter().flat_map(|i: &u32| i.to_le_bytes()));
    bytes
}

#[test]
fn msh_has_what_its_header_says() {
    let bytes = msh([4, 0, 4, 4], 3);
    let mesh = read(&bytes, MeshFormat::Msh).expect("valid");
    assert_eq!(
        (mesh.face.len(), mesh.facetexcoord, mesh.facenormal.len()),
        (4, mesh.face, 0)
    );
    let mirrored = Triangles::read(&bytes, MeshFormat::Msh, true, &Limits::DEFAULT).expect("valid");
    assert_eq!((mirrored.face[0], mirrored.facetexcoord[0]), ([0, 1, 2], [0, 2, 1]));
    for (header, part) in [
        ([3, 0, 0, 4], "the header announces 3 vertices"),
        ([4, 1, 0, 4], "1 normals"),
        ([4, 0, 0, -1], "-1 faces"),
        (
            [100_000_000, 0, 0, 0],
            "the file has 112 bytes where its header asks for 1200000016",
        ),
        ([i32::MAX, i32::MAX, i32::MAX, i32::MAX], "where its header asks for"),
    ] {
        let mut bytes = msh([4, 0, 0, 4], 3);
        bytes[..16].copy_from_slice(&header.map(i32::to_le_bytes).concat());
        let error = read(&bytes, MeshFormat::Msh).expect_err(part);
        assert!(error.contains(part), "{error}");
    }
    let error = read(&msh([4, 0, 0, 4], 9), MeshFormat::Msh).expect_err("no vertex 9");
    assert_eq!(error, "face 3 names vertex 9, of which there are 4");
}
