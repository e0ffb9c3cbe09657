//! Hulls of meshes beside MuJoCo 3.3.0's `mesh_graph` and `mesh_poly...`: corners, edges, triangles and polygons, each in its order.

use std::fmt::Write;

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::physics::compile;
use conformance::loading::distances;
use conformance::mujoco::{MUJOCO, Simulation, needed};
use testkit::harness::Trial;
use testkit::{Rng, show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: hulls_have_the_order_of_mujoco, flat_meshes_have_the_hull_that_rounding_leaves]
}

type Points = Vec<[f64; 3]>;

/// Returns points on a sphere, ring by ring, with a pole at either end: rings are flat, so that facets of the hull are merged.
fn globe(rings: usize, around: usize, axes: [f64; 3]) -> Points {
    let mut points = vec![[0.0, 0.0, axes[2]], [0.0, 0.0, -axes[2]]];
    for ring in 1..rings {
        let (height, radius) = (std::f64::consts::PI * ring as f64 / rings as f64).sin_cos();
        for k in 0..around {
            let (y, x) = (std::f64::consts::TAU * k as f64 / around as f64).sin_cos();
            points.push([axes[0] * height * x, axes[1] * height * y, axes[2] * radius]);
        }
    }
    points
}

/// Returns the points of a grid of cubes: most are inside the hull or on its faces.
fn grid(sides: [usize; 3]) -> Points {
    let mut points = Vec::new();
    for x in 0..sides[0] {
        for y in 0..sides[1] {
            for z in 0..sides[2] {
                points.push([0.1 * x as f64, 0.1 * y as f64, 0.1 * z as f64]);
            }
        }
    }
    points
}

/// Returns the points of a ring, such as one for teething.
fn ring(around: usize, about: usize) -> Points {
    let mut points = Vec::new();
    for k in 0..around {
        let (y, x) = (std::f64::consts::TAU * k as f64 / around as f64).sin_cos();
        for l in 0..about {
            let (z, out) = (std::f64::consts::TAU * l as f64 / about as f64).sin_cos();
            points.push([x * (0.03 + 0.01 * out), y * (0.03 + 0.01 * out), 0.01 * z]);
        }
    }
    points
}

/// Returns the points of a prism: two polygons.
fn prism(corners: usize, half: f64) -> Points {
    let circle = globe(2, corners, [0.1, 0.1, 1.0]);
    let ends = |sign: f64| circle[2..].iter().map(move |p| [p[0], p[1], sign * half]);
    ends(-1.0).chain(ends(1.0)).collect()
}

/// Returns points anywhere in a box, a thousandth of which is the thickness of the second kind.
fn cloud(rng: &mut Rng, count: usize, axes: [f64; 3]) -> Points {
    let mut point = || axes.map(|half| half * (2.0 * rng.f64() - 1.0));
    (0..count).map(|_| point()).collect()
}

/// Returns a document whose mesh has these points and touches.
fn document(points: &[[f64; 3]], attributes: &str) -> String {
    let mut vertex = String::new();
    points
        .iter()
        .flatten()
        .for_each(|x| write!(vertex, "{x} ").expect("strings take everything"));
    format!(
        "<mujoco><option><flag multiccd='enable'/></option><asset><mesh name='m' vertex='{vertex}' {attributes}/></asset>\
         <worldbody><body><freejoint/><geom type='mesh' mesh='m'/></body></worldbody></mujoco>"
    )
}

/// Compiles a document on both sides, and asserts that all arrays of the hull and its polygons are the same.
fn same_hull(name: &str, document: &str) {
    let theirs = Simulation::new(needed(), "m.xml", &[("m.xml", document.as_bytes())]).expect(name);
    let ours = load_str(document, "m.xml", &MemoryAssets::new())
        .and_then(compile)
        .expect(name);
    let of_hull = |distance: &conformance::loading::Distance| {
        distance.name.starts_with("mesh_graph") || distance.name.starts_with("mesh_poly")
    };
    let arrays: Vec<_> = distances(&ours, &theirs).into_iter().filter(of_hull).collect();
    assert_eq!(arrays.len(), 8, "{name}: all arrays are compared");
    for array in arrays {
        // normals are of vertices whose last digits depend on the order of sums, and on the processor that MuJoCo runs on
        let limit = if array.name == "mesh_polynormal" {
            array.limit
        } else {
            0.0
        };
        assert!(array.error <= limit, "{name}: {} {}", array.name, array.place);
    }
    let mesh = &ours.meshes[0];
    let hull = mesh.hull.as_ref().expect("a mesh that touches has a hull");
    let (corners, triangles) = (hull.vert.len(), hull.face.len());
    show!(
        "{name}: {corners} corners, {triangles} triangles, {} polygons",
        mesh.polygons.normal.len()
    );
}

fn hulls_have_the_order_of_mujoco() {
    let mut rng = Rng::with_seed(27);
    let mut shapes = vec![
        (
            "a tetrahedron",
            vec![[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]],
        ),
        ("a box", grid([2, 2, 2])),
        ("a slab of cubes", grid([6, 5, 2])),
        ("cubes", grid([4, 4, 4])),
        ("a prism", prism(6, 0.05)),
        ("a disc of 200 corners", prism(100, 0.002)),
        ("a globe", globe(8, 12, [0.1; 3])),
        ("an egg", globe(24, 32, [0.03, 0.03, 0.045])),
        ("a ring", ring(24, 12)),
    ];
    for count in [5, 30, 200, 2000] {
        shapes.push(("a cloud", cloud(&mut rng, count, [0.1, 0.2, 0.3])));
        shapes.push(("a sheet", cloud(&mut rng, count, [0.1, 0.2, 0.0003])));
    }
    for (name, points) in shapes {
        same_hull(name, &document(&points, ""));
        same_hull(name, &document(&points, "maxhullvert='12'"));
    }
}

fn flat_meshes_have_the_hull_that_rounding_leaves() {
    let level = grid([5, 5, 1]);
    let upright = level.iter().map(|&[x, y, _]| [x, x, y]).collect();
    for points in [level.clone(), upright] {
        let document = document(&points, "");
        let files = [("m.xml", document.as_bytes())];
        assert!(Simulation::new(needed(), "m.xml", &files).is_err(), "MuJoCo takes it");
        assert!(
            load_str(&document, "m.xml", &MemoryAssets::new()).is_err(),
            "it is taken"
        );
    }
    // what single precision leaves of a slanted plane has a thickness
    let slanted: Points = level.iter().map(|&[x, y, _]| [x, y, 0.1 + 0.1 * x]).collect();
    same_hull("a slanted plane", &document(&slanted, ""));
}
