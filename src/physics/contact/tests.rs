//! Tests of conventions that hold for all pairs, and of absurd input.

use testkit::Rng;

use super::*;
use crate::math::{MAT3_ID, Quat, add, mat_mul, norm, quat_normalize, quat_to_mat, transpose};

const KINDS: [GeomType; 6] = [
    GeomType::Plane,
    GeomType::Sphere,
    GeomType::Capsule,
    GeomType::Ellipsoid,
    GeomType::Cylinder,
    GeomType::Box,
];

/// Returns the 20 pairs that collide.
fn pairs() -> impl Iterator<Item = (GeomType, GeomType)> {
    let all = KINDS.into_iter().flat_map(|a| KINDS.into_iter().map(move |b| (a, b)));
    all.filter(|(a, b)| a <= b && *b != GeomType::Plane)
}

/// Numbers on which formulas break down.
const ODD: [f64; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    0.1,
    1e-300,
    1e-160,
    1e-16,
    1e-8,
    1e8,
    1e10,
    1e160,
    -1e300,
    1e308,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// Random shapes and poses.
struct RandomShapes(Rng);

impl RandomShapes {
    fn new(seed: u64) -> Self {
        Self(Rng::with_seed(seed))
    }

    /// Draws from 0..1.
    fn unit(&mut self) -> f64 {
        self.0.f64()
    }

    /// Draws from -x..x.
    fn within(&mut self, x: f64) -> f64 {
        x * (2.0 * self.unit() - 1.0)
    }

    fn vec(&mut self, x: f64) -> Vec3 {
        [self.within(x), self.within(x), self.within(x)]
    }

    fn size(&mut self) -> Vec3 {
        [0; 3].map(|_| 0.02 + 0.18 * self.unit())
    }

    fn rotation(&mut self) -> Mat3 {
        let q: Quat = [0; 4].map(|_| self.within(1.0));
        quat_to_mat(quat_normalize(q))
    }

    /// Draws size, position and orientation of two geoms, the second near the first unless both are of the same type, and replaces some of the
    /// numbers by unusual ones.
    fn odd_poses(&mut self, same: bool, share: f64) -> [f64; 30] {
        let mut numbers = [0.0; 30];
        for (at, near) in [(0, 0.0), (15, if same { 0.0 } else { 0.1 })] {
            numbers[at..at + 3].copy_from_slice(&self.size());
            numbers[at + 3..at + 6].copy_from_slice(&self.vec(near));
            numbers[at + 6..at + 15].copy_from_slice(&self.rotation());
        }
        for number in &mut numbers {
            if self.unit() < share {
                *number = self.pick(&ODD);
            }
        }
        numbers
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[(self.unit() * from.len() as f64) as usize]
    }
}

/// Returns the half extent along the local z axis.
fn height(kind: GeomType, size: Vec3) -> f64 {
    match kind {
        GeomType::Plane => 0.0,
        GeomType::Sphere => size[0],
        GeomType::Capsule => size[0] + size[1],
        GeomType::Cylinder => size[1],
        _ => size[2],
    }
}

fn contacts(a: &PlacedGeom, b: &PlacedGeom, margin: f64, options: &ContactOptions) -> Vec<ContactPoint> {
    let mut out = Vec::new();
    collide(a, b, margin, options, &mut Scratch::new(), &mut out);
    out
}

#[test]
fn normals_point_from_first_to_second_and_positions_lie_midway() {
    let depth = 0.01;
    for (first, second) in pairs() {
        let size = [0.1, 0.2, 0.15];
        let (below, above) = (height(first, size), height(second, size));
        let a = PlacedGeom {
            kind: first,
            size,
            pos: [0.0; 3],
            mat: &MAT3_ID,
            mesh: None,
            hfield: None,
        };
        let b = PlacedGeom {
            kind: second,
            size,
            pos: [0.003, -0.002, below + above - depth],
            mat: &MAT3_ID,
            mesh: None,
            hfield: None,
        };
        let found = contacts(
            &a,
            &b,
            0.0,
            &ContactOptions {
                quirks: Quirks::none(),
                ..ContactOptions::default()
            },
        );
        assert!(!found.is_empty(), "{first:?} {second:?}");
        for contact in found {
            let n = contact.normal();
            assert!(n[2] > 0.999, "{first:?} {second:?} {contact:?}");
            // 1e-4: round ends are not exactly on top of each other
            assert!((contact.dist + depth).abs() < 1e-4, "{first:?} {second:?} {contact:?}");
            assert!(
                (contact.pos[2] - (below - depth / 2.0)).abs() < 1e-4,
                "{first:?} {second:?} {contact:?}"
            );
        }
    }
}

#[test]
fn frames_are_rotations_and_a_used_scratch_changes_nothing() {
    let mut random = RandomShapes::new(7);
    let mut scratch = Scratch::new();
    let options = ContactOptions::default();
    for (first, second) in pairs() {
        let mut count = 0;
        for _ in 0..500 {
            let (mat_a, mat_b) = (random.rotation(), random.rotation());
            let (pos, size_a, size_b) = (random.vec(1.0), random.size(), random.size());
            let a = PlacedGeom {
                kind: first,
                size: size_a,
                pos,
                mat: &mat_a,
                mesh: None,
                hfield: None,
            };
            let b = PlacedGeom {
                kind: second,
                size: size_b,
                pos: add(pos, random.vec(0.15)),
                mat: &mat_b,
                mesh: None,
                hfield: None,
            };
            let mut out = Vec::new();
            collide(&a, &b, 0.0, &options, &mut scratch, &mut out);
            assert_eq!(out, contacts(&a, &b, 0.0, &options));
            for contact in &out {
                assert!(contact.dist <= 0.0);
                let product = mat_mul(&contact.frame, &transpose(&contact.frame));
                for (x, id) in product.iter().zip(MAT3_ID) {
                    assert!((x - id).abs() < 1e-14, "{first:?} {second:?} {contact:?}");
                }
            }
            count += out.len();
        }
        assert!(count > 100, "{first:?} {second:?}");
    }
}

#[test]
fn pairs_that_do_not_collide_or_come_in_the_wrong_order_give_nothing() {
    let size = [0.5; 3];
    let mut checked = 0;
    for first in KINDS {
        for second in KINDS {
            if pairs().any(|pair| pair == (first, second)) {
                continue;
            }
            let geom = |kind, x| PlacedGeom {
                kind,
                size,
                pos: [x, 0.0, 0.1],
                mat: &MAT3_ID,
                mesh: None,
                hfield: None,
            };
            assert!(contacts(&geom(first, 0.0), &geom(second, 0.1), 0.0, &ContactOptions::default()).is_empty());
            checked += 1;
        }
    }
    assert_eq!(checked, 36 - 20);
}

#[test]
fn input_that_is_not_sane_is_survived() {
    let mut random = RandomShapes::new(99);
    let mut scratch = Scratch::new();
    let mut out = Vec::new();
    for first in KINDS {
        for second in KINDS {
            for round in 0..3000 {
                // from a few odd numbers in a sane pose to nothing but odd numbers
                let numbers = random.odd_poses(first == second, [0.02, 0.2, 1.0][round % 3]);
                let part = |from: usize| -> Vec3 { [numbers[from], numbers[from + 1], numbers[from + 2]] };
                let mat = |from: usize| -> Mat3 { std::array::from_fn(|k| numbers[from + k]) };
                let (mat_a, mat_b) = (mat(6), mat(21));
                let a = PlacedGeom {
                    kind: first,
                    size: part(0),
                    pos: part(3),
                    mat: &mat_a,
                    mesh: None,
                    hfield: None,
                };
                let b = PlacedGeom {
                    kind: second,
                    size: part(15),
                    pos: part(18),
                    mat: &mat_b,
                    mesh: None,
                    hfield: None,
                };
                let margin = if round % 2 == 0 { 0.0 } else { random.pick(&ODD) };
                let quirks = if round % 4 < 2 {
                    Quirks::default()
                } else {
                    Quirks::none()
                };
                let options = ContactOptions {
                    ccd_tolerance: if round % 5 == 0 { random.pick(&ODD) } else { 1e-6 },
                    ccd_iterations: random.pick(&[0, 1, 2, 50, 400]),
                    nativeccd: round % 7 != 0,
                    multiccd: round % 3 == 0,
                    quirks,
                };
                out.clear();
                bounding_test(&a, numbers[0], &b, numbers[15], margin);
                collide(&a, &b, margin, &options, &mut scratch, &mut out);
                assert!(out.len() <= box_box::MAX_POINTS);
            }
        }
    }
}

#[test]
fn a_stack_of_boxes_has_half_the_depth_by_default() {
    let size = [0.5; 3];
    let a = PlacedGeom {
        kind: GeomType::Box,
        size,
        pos: [0.0; 3],
        mat: &MAT3_ID,
        mesh: None,
        hfield: None,
    };
    let b = PlacedGeom {
        pos: [0.25, 0.125, 0.75],
        ..a
    };
    let depths = |quirks| {
        let found = contacts(
            &a,
            &b,
            0.0,
            &ContactOptions {
                quirks,
                ..ContactOptions::default()
            },
        );
        assert_eq!(found.len(), 4);
        found.iter().map(|c| c.dist).collect::<Vec<_>>()
    };
    assert_eq!(depths(Quirks::default()), [-0.125; 4]);
    assert_eq!(depths(Quirks::none()), [-0.25; 4]);
}

#[test]
fn geoms_with_one_centre_touch_only_without_the_quirks() {
    let mat = quat_to_mat(quat_normalize([0.9, 0.3, -0.1, 0.2]));
    let a = PlacedGeom {
        kind: GeomType::Cylinder,
        size: [0.25, 0.5, 0.0],
        pos: [0.0; 3],
        mat: &MAT3_ID,
        mesh: None,
        hfield: None,
    };
    for other in [&MAT3_ID, &mat] {
        let b = PlacedGeom { mat: other, ..a };
        assert!(contacts(&a, &b, 0.0, &ContactOptions::default()).is_empty());
        let found = contacts(
            &a,
            &b,
            0.0,
            &ContactOptions {
                quirks: Quirks::none(),
                ..ContactOptions::default()
            },
        );
        assert!(
            found.len() == 1 && found[0].dist < -0.4 && norm(found[0].pos) < 0.5,
            "{found:?}"
        );
    }
}

/// Checks that each quirk switched off alone shows in some pose, in its own pair only.
#[test]
fn every_quirk_can_be_switched_off() {
    type Switch = fn(&mut Quirks);
    let switches: [(&str, GeomType, Switch); 5] = [
        ("half_box_face_depth", GeomType::Box, |q| q.half_box_face_depth = false),
        ("box_edge_determinant_reuse", GeomType::Box, |q| {
            q.box_edge_determinant_reuse = false
        }),
        ("stale_box_corner", GeomType::Capsule, |q| q.stale_box_corner = false),
        ("same_centre_is_no_contact", GeomType::Cylinder, |q| {
            q.same_centre_is_no_contact = false
        }),
        ("failed_depth_is_no_contact", GeomType::Cylinder, |q| {
            q.failed_depth_is_no_contact = false
        }),
    ];
    for (name, kind, switch) in switches {
        let mut quirks = Quirks::default();
        switch(&mut quirks);
        let mut random = RandomShapes::new(5);
        let mut changed = 0;
        for round in 0..20_000 {
            // sizes and positions on a grid give exact coincidences
            let grid = |v: Vec3| {
                if round % 2 == 0 {
                    v.map(|x| (x * 16.0).round() / 16.0)
                } else {
                    v
                }
            };
            let (mat_a, mat_b) = (
                if round % 2 == 0 { MAT3_ID } else { random.rotation() },
                random.rotation(),
            );
            let mat_b = if round % 4 == 0 { MAT3_ID } else { mat_b };
            let (size_a, size_b) = (
                grid(random.size().map(|s| s + 0.05)),
                grid(random.size().map(|s| s + 0.05)),
            );
            let a = PlacedGeom {
                kind,
                size: size_a,
                pos: [0.0; 3],
                mat: &mat_a,
                mesh: None,
                hfield: None,
            };
            let b = PlacedGeom {
                kind: GeomType::Box,
                size: size_b,
                pos: grid(random.vec(0.2)),
                mat: &mat_b,
                mesh: None,
                hfield: None,
            };
            let other = ContactOptions {
                quirks,
                ..ContactOptions::default()
            };
            changed += (contacts(&a, &b, 0.0, &ContactOptions::default()) != contacts(&a, &b, 0.0, &other)) as usize;
        }
        println!("{name}: {changed} of 20000 poses");
        assert!(changed > 0, "{name}");
    }
}
