//! Invariants 1 and 2: ids equal MuJoCo's, the model never changes.

use std::sync::Arc;

use babybench::config::{Behavior, BodyParts, Part, Scene};
use babybench::mimo::{build_model, embedded};
use babybench::model::SensorType;
use babybench::physics::collision::PairTable;
use babybench::{Config, Model};

use crate::common::*;

fn model(config: &Config) -> Model {
    build_model(config, &embedded()).expect("the assets load")
}

/// nq, nv, nbody, ngeom, neq; candidate pairs of geoms, and those within MIMo.
const SIZES: [([usize; 5], [usize; 2]); 6] = [
    ([54, 53, 24, 39, 47], [654, 546]),
    ([54, 53, 30, 73, 48], [1878, 546]),
    ([166, 149, 40, 55, 64], [1398, 546]),
    ([98, 97, 56, 77, 91], [2723, 2501]),
    ([98, 97, 62, 111, 92], [5239, 2501]),
    ([210, 193, 72, 93, 108], [4075, 2501]),
];

#[test]
fn invariant_1_sizes_and_candidate_pairs_equal_mujocos() {
    for ((behavior, scene), (sizes, pairs)) in MODELS.into_iter().zip(SIZES) {
        let m = model(&free(behavior, scene.clone()));
        let found = [m.nq, m.nv, m.nbody(), m.ngeom(), m.neq()];
        assert_eq!(found, sizes, "{behavior} {scene}: nq, nv, nbody, ngeom, neq");
        let table = PairTable::new(&m);
        let hip = m.body("hip").expect("MIMo has a hip");
        let own = |g: usize| m.in_subtree(m.geom_bodyid[g], hip);
        let pairs_of_all = table.pairs().expect("a small scene");
        let within = pairs_of_all.iter().filter(|p| p.geom.iter().all(|&g| own(g))).count();
        assert_eq!(
            [pairs_of_all.len(), within],
            pairs,
            "{behavior} {scene}: pairs, pairs within MIMo"
        );
    }
}

#[test]
fn invariant_1_geom_body_and_joint_ids_equal_mujocos() {
    for (behavior, scene) in MODELS {
        let m = model(&free(behavior, scene.clone()));
        let v1 = behavior == Behavior::None;
        let (hip, last, torques) = (
            m.body("hip").expect("MIMo has a hip"),
            if v1 { 38 } else { 76 },
            if v1 { 21 } else { 53 },
        );
        assert_eq!(m.geom_name[..3], ["transparent", "floor", "rug"]);
        assert_eq!(m.body_name[..3], ["world", "mimo_location", "hip"]);
        assert_eq!(m.jnt_name[0], "mimo_location");
        let own: Vec<usize> = (0..m.ngeom())
            .filter(|&g| m.in_subtree(m.geom_bodyid[g], hip))
            .collect();
        assert_eq!(own, (3..=last).collect::<Vec<_>>(), "{behavior} {scene}: MIMo's geoms");
        assert_eq!(
            m.sensor_type.iter().filter(|t| **t == SensorType::Torque).count(),
            torques
        );
        assert_eq!((m.ncam(), m.lights.len(), m.ntendon()), (7, 5, 9));
        let mass = m.body_subtreemass[hip];
        let expect = if v1 { 10.90487 } else { 10.8999078 };
        assert!(
            (mass - expect).abs() < 5e-8,
            "{behavior}: mass {mass} instead of {expect}"
        );
        let palm = |name: &str| {
            let b = m.body(name).expect("MIMo has hands");
            (0..m.ngeom()).filter(|&g| m.geom_bodyid[g] == b).collect::<Vec<_>>()
        };
        let (right, left) = (palm("right_hand"), palm("left_hand"));
        if v1 {
            assert_eq!((right, left), (vec![13, 14], vec![19, 20]));
        } else {
            assert_eq!((right.len(), left.len()), (4, 4));
        }
    }
}

#[test]
fn invariant_1_actuators_equal_mujocos_in_number_and_order() {
    let order = [
        Part::Body,
        Part::Head,
        Part::Eyes,
        Part::Arms,
        Part::Hands,
        Part::Fingers,
        Part::Legs,
        Part::Feet,
    ];
    for (behavior, counts) in [
        (Behavior::None, [3, 3, 6, 8, 6, 2, 8, 8]),
        (Behavior::HandRegard, [3, 3, 6, 8, 6, 44, 8, 10]),
    ] {
        let all = model(&free(behavior, Scene::Base)).actuator_name.clone();
        let mut names = Vec::new();
        for (part, count) in order.into_iter().zip(counts) {
            let mut act = BodyParts::all(false);
            *act.get_mut(part) = true;
            let group = model(&Config {
                act,
                ..free(behavior, Scene::Base)
            })
            .actuator_name
            .clone();
            assert_eq!(group.len(), count, "{behavior}: act_{}", part.name());
            names.extend(group);
        }
        assert_eq!(all, names, "{behavior}: groups follow each other");
    }
    for (name, nu) in [("self_touch", 30), ("hand_regard", 17), ("test_installation", 44)] {
        assert_eq!(model(&example(name)).nu(), nu, "{name}");
    }
}

#[test]
fn invariant_2_the_model_is_shared_and_never_changes() {
    for (name, _) in EXAMPLES {
        let blueprint = blueprint(body_only(name));
        let before = Model::clone(blueprint.model());
        let mut a = blueprint.env().expect("available");
        let b = blueprint.env().expect("available");
        a.reset(Some(1)).expect("no divergence");
        random_steps(&mut a, 100);
        assert!(Arc::ptr_eq(a.model(), b.model()) && Arc::ptr_eq(a.model(), blueprint.model()));
        assert!(before == **a.model(), "{name}: the model changed");
    }
}
