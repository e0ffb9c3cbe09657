//! Contacts of single pairs of geoms, bit for bit those of MuJoCo 3.3.0.
//!
//! `data/contact_pairs.npz` is written by `scripts/contact_pairs.py`, which also says what is in it. The environment
//! variable `BB_CONTACT_PAIRS` names another file of the same kind.

use std::collections::BTreeMap;
use std::path::PathBuf;

use babybench::formats::npz::Npz;
use babybench::math::{Mat3, Vec3};
use babybench::model::GeomType;
use babybench::physics::contact::{ContactOptions, ContactPoint, PlacedGeom, Scratch, bounding_test, collide};
use conformance::data;
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![contacts_of_single_pairs_equal_mujocos, a_moved_geom_is_noticed]
}

/// The poses and the contacts recorded for them.
struct Recording {
    kinds: Vec<i64>,
    size: Vec<f64>,
    rbound: Vec<f64>,
    pos: Vec<f64>,
    mat: Vec<f64>,
    margin: Vec<f64>,
    ncon: Vec<i64>,
    dist: Vec<f64>,
    contact_pos: Vec<f64>,
    frame: Vec<f64>,
}

impl Recording {
    fn open() -> Recording {
        let path = std::env::var_os("BB_CONTACT_PAIRS").map_or(data::path("contact_pairs.npz"), PathBuf::from);
        let npz = Npz::open(&path).unwrap();
        let reals = |name| npz.get_f64(name).unwrap().data;
        let integers = |name| npz.get_i64(name).unwrap().data;
        Recording {
            kinds: integers("type"),
            size: reals("size"),
            rbound: reals("rbound"),
            pos: reals("pos"),
            mat: reals("mat"),
            margin: reals("margin"),
            ncon: integers("ncon"),
            dist: reals("dist"),
            contact_pos: reals("contact_pos"),
            frame: reals("frame"),
        }
    }

    fn contact(&self, k: usize) -> ContactPoint {
        ContactPoint {
            dist: self.dist[k],
            pos: fixed(&self.contact_pos, k),
            frame: fixed(&self.frame, k),
        }
    }
}

/// Row `k` of an array whose rows have N numbers.
fn fixed<const N: usize>(values: &[f64], k: usize) -> [f64; N] {
    values[N * k..N * (k + 1)].try_into().unwrap()
}

fn geom_type(mujoco: i64) -> GeomType {
    match mujoco {
        0 => GeomType::Plane,
        2 => GeomType::Sphere,
        3 => GeomType::Capsule,
        4 => GeomType::Ellipsoid,
        5 => GeomType::Cylinder,
        6 => GeomType::Box,
        other => panic!("geom type {other}"),
    }
}

/// Figures of one pair of shapes.
#[derive(Default)]
struct Tally {
    poses: usize,
    touching: usize,
    contacts: usize,
    mismatches: usize,
    first: Option<String>,
}

fn contacts_of_single_pairs_equal_mujocos() {
    let recording = Recording::open();
    let options = ContactOptions::default();
    let mut scratch = Scratch::new();
    let mut found = Vec::new();
    let mut tallies: BTreeMap<(GeomType, GeomType), Tally> = BTreeMap::new();
    let mut next = 0;
    for (pose, &ncon) in recording.ncon.iter().enumerate() {
        let expected: Vec<ContactPoint> = (next..next + ncon as usize).map(|k| recording.contact(k)).collect();
        next += ncon as usize;

        let mats: [Mat3; 2] = [0, 1].map(|k| fixed(&recording.mat, 2 * pose + k));
        let [a, b] = [0, 1].map(|k| PlacedGeom {
            kind: geom_type(recording.kinds[2 * pose + k]),
            size: fixed(&recording.size, 2 * pose + k) as Vec3,
            pos: fixed(&recording.pos, 2 * pose + k),
            mat: &mats[k],
            mesh: None,
            hfield: None,
        });
        let (radius_a, radius_b) = (recording.rbound[2 * pose], recording.rbound[2 * pose + 1]);
        let margin = recording.margin[pose];
        found.clear();
        if bounding_test(&a, radius_a, &b, radius_b, margin) {
            collide(&a, &b, margin, &options, &mut scratch, &mut found);
        }

        let tally = tallies.entry((a.kind, b.kind)).or_default();
        tally.poses += 1;
        tally.touching += (ncon > 0) as usize;
        tally.contacts += ncon as usize;
        if found != expected {
            tally.mismatches += 1;
            tally.first.get_or_insert_with(|| {
                format!("pose {pose}, margin {margin}\n{a:?}\n{b:?}\n expected {expected:?}\n found {found:?}")
            });
        }
    }
    assert_eq!(next, recording.dist.len());

    show!("pair | poses | touching | contacts | mismatches");
    for ((first, second), tally) in &tallies {
        let Tally {
            poses,
            touching,
            contacts,
            mismatches,
            ..
        } = tally;
        show!("{first:?}-{second:?} | {poses} | {touching} | {contacts} | {mismatches}");
    }
    assert_eq!(tallies.len(), 20, "every pair of shapes is there");
    for (pair, tally) in &tallies {
        assert!(tally.touching * 2 > tally.poses, "{pair:?} hardly touch");
        assert_eq!(
            tally.mismatches,
            0,
            "{pair:?}: {}",
            tally.first.as_deref().unwrap_or("")
        );
    }
}

/// The comparison would notice a difference: nearly every contact changes when one geom moves by 1e-10 m.
fn a_moved_geom_is_noticed() {
    let recording = Recording::open();
    let mut scratch = Scratch::new();
    let mut found = Vec::new();
    let (mut next, mut touching, mut equal) = (0, 0, 0);
    for (pose, &ncon) in recording.ncon.iter().enumerate() {
        let expected: Vec<ContactPoint> = (next..next + ncon as usize).map(|k| recording.contact(k)).collect();
        next += ncon as usize;
        let mats: [Mat3; 2] = [0, 1].map(|k| fixed(&recording.mat, 2 * pose + k));
        let [a, mut b] = [0, 1].map(|k| PlacedGeom {
            kind: geom_type(recording.kinds[2 * pose + k]),
            size: fixed(&recording.size, 2 * pose + k) as Vec3,
            pos: fixed(&recording.pos, 2 * pose + k),
            mat: &mats[k],
            mesh: None,
            hfield: None,
        });
        b.pos = b.pos.map(|x| x + 1e-10);
        if ncon > 0 {
            touching += 1;
            found.clear();
            collide(
                &a,
                &b,
                recording.margin[pose],
                &ContactOptions::default(),
                &mut scratch,
                &mut found,
            );
            equal += (found == expected) as usize;
        }
    }
    show!("{equal} of {touching} contact sets unchanged");
    assert!(equal * 100 < touching);
}
