//! The wrapper around MuJoCo 3.3.0 itself.

use conformance::live::{Case, Drive, Motion};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::trials;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: arrays_by_offset_are_those_of_mj_get_state, a_fresh_simulation_repeats_itself, sizes_and_names_are_those_of_our_model]
}

/// `mj_getState` knows the layout of `mjData` by itself.
fn arrays_by_offset_are_those_of_mj_get_state() {
    let api = needed();
    for case in Case::all() {
        let mut simulation = case.simulation(api).expect("MuJoCo loads our scenes");
        let mut drive = Drive::new(&case.model, Motion::Random, 1);
        let mut ctrl = vec![0.0; case.model.nu()];
        for k in 0..20 {
            drive.set(k, &mut ctrl);
            simulation.set_ctrl(&ctrl);
            simulation.step();
        }
        let [qpos, qvel, warmstart, by_state] = simulation.state_by_mujoco();
        assert_eq!(simulation.qpos(), qpos, "{}", case.name);
        assert_eq!(simulation.qvel(), qvel, "{}", case.name);
        assert_eq!(simulation.qacc_warmstart(), warmstart, "{}", case.name);
        assert_eq!((simulation.ctrl(), &ctrl), (&by_state[..], &ctrl), "{}", case.name);
        assert_eq!(
            warmstart,
            simulation.qacc(),
            "the step ends with its acceleration as the next start"
        );
        assert!(
            (simulation.time() - 0.1).abs() < 1e-12 && simulation.ncon() > 0,
            "{}",
            case.name
        );
        assert_eq!(simulation.efc_force().len(), simulation.nefc());
        let finite = |v: &[f64]| v.iter().all(|x| x.is_finite());
        assert!(finite(simulation.efc_force()) && finite(simulation.efc_pos()) && finite(simulation.sensordata()));
    }
}

fn a_fresh_simulation_repeats_itself() {
    let api = needed();
    let case = &Case::all()[0];
    let run = || {
        let mut simulation = case.simulation(api).expect("MuJoCo loads our scenes");
        (0..50).for_each(|_| simulation.step());
        (simulation.qpos().to_vec(), simulation.contacts())
    };
    assert_eq!(run(), run());
}

fn sizes_and_names_are_those_of_our_model() {
    let api = needed();
    for case in Case::all() {
        let simulation = case.simulation(api).expect("MuJoCo loads our scenes");
        let m = &case.model;
        let sizes = [
            ("nq", m.nq),
            ("nv", m.nv),
            ("nu", m.nu()),
            ("nbody", m.nbody()),
            ("ngeom", m.ngeom()),
        ];
        for (name, size) in sizes {
            assert_eq!(simulation.size(name), size, "{} {name}", case.name);
        }
        let kinds = [
            ("body", &m.body_name),
            ("jnt", &m.jnt_name),
            ("geom", &m.geom_name),
            ("actuator", &m.actuator_name),
        ];
        for (kind, names) in kinds {
            assert_eq!(&simulation.names(kind), names, "{} {kind}", case.name);
        }
    }
}
