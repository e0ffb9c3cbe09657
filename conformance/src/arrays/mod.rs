//! Arrays of our compiled model under MuJoCo's names and in its layout.

mod actuators;
mod elements;
mod flexes;
mod looks;
mod meshes;
mod relations;
mod skins;

use babybench::Model;
use babybench::model::GeomType;

pub use actuators::{activations, actuators};
pub use elements::unrecorded;
use elements::{of_bodies, of_geoms, of_joints, of_sites_and_cameras};
pub use flexes::of_flexes;
pub use looks::{looks, narrowed};
pub use meshes::{needle, of_meshes};
use relations::{of_contacts, of_equalities, of_sensors, of_tendons};
pub use skins::of_skins;

fn ids(values: &[usize]) -> Vec<f64> {
    values.iter().map(|&v| v as f64).collect()
}

fn groups(values: &[i32]) -> Vec<f64> {
    values.iter().map(|&v| f64::from(v)).collect()
}

fn flags(values: &[bool]) -> Vec<f64> {
    values.iter().map(|&v| f64::from(u8::from(v))).collect()
}

fn flat<const N: usize>(values: &[[f64; N]]) -> Vec<f64> {
    values.iter().flatten().copied().collect()
}

fn optional(values: &[Option<usize>]) -> Vec<f64> {
    values.iter().map(|v| v.map_or(-1.0, |v| v as f64)).collect()
}

fn shapes(values: &[GeomType]) -> Vec<f64> {
    values.iter().map(|shape| f64::from(shape.code())).collect()
}

/// Returns user data, one row after another.
fn users(values: &[Vec<f64>]) -> Vec<f64> {
    values.iter().flatten().copied().collect()
}

/// Returns the addresses of ranges as MuJoCo stores them: -1 for an empty range.
fn addresses(first: &[usize], number: &[usize]) -> Vec<f64> {
    first
        .iter()
        .zip(number)
        .map(|(&first, &number)| if number == 0 { -1.0 } else { first as f64 })
        .collect()
}

/// Named arrays.
type Named = Vec<(&'static str, Vec<f64>)>;

/// Returns the arrays that matter to physics and sensors, under MuJoCo's names.
pub fn physical(m: &Model) -> Named {
    let groups = [
        sizes_and_options(m),
        of_bodies(m),
        of_joints(m),
        of_geoms(m),
        of_sites_and_cameras(m),
        of_contacts(m),
        of_equalities(m),
        of_tendons(m),
        of_sensors(m),
    ];
    groups.concat()
}

fn sizes_and_options(m: &Model) -> Named {
    vec![
        ("nq", vec![m.nq as f64]),
        ("nv", vec![m.nv as f64]),
        ("opt_timestep", vec![m.opt.timestep]),
        ("opt_gravity", m.opt.gravity.to_vec()),
        ("opt_iterations", vec![m.opt.iterations as f64]),
        ("opt_tolerance", vec![m.opt.tolerance]),
        ("opt_ls_iterations", vec![m.opt.ls_iterations as f64]),
        ("opt_ls_tolerance", vec![m.opt.ls_tolerance]),
        ("opt_impratio", vec![m.opt.impratio]),
        ("opt_ccd_iterations", vec![m.opt.ccd_iterations as f64]),
        ("opt_ccd_tolerance", vec![m.opt.ccd_tolerance]),
    ]
}

/// Returns the arrays that follow from the dynamics at `qpos0`.
pub fn derived(m: &Model) -> Named {
    let s = &m.stat;
    vec![
        ("body_subtreemass", m.body_subtreemass.clone()),
        ("body_invweight0", flat(&m.body_invweight0)),
        ("dof_invweight0", m.dof_invweight0.clone()),
        ("dof_M0", m.dof_m0.clone()),
        ("tendon_invweight0", m.tendon_invweight0.clone()),
        ("meaninertia", vec![s.meaninertia]),
        ("meanmass", vec![s.meanmass]),
        ("meansize", vec![s.meansize]),
        ("extent", vec![s.extent]),
        ("center", s.center.to_vec()),
    ]
}

/// Returns those of actuators and flexes, which no recording has.
pub fn derived_unrecorded(m: &Model) -> Named {
    vec![
        (
            "flexedge_invweight0",
            m.flexes.iter().flat_map(|f| f.edge_invweight0.clone()).collect(),
        ),
        ("actuator_acc0", m.actuator_acc0.clone()),
        ("actuator_length0", m.actuator_length0.clone()),
    ]
}

/// Returns the simulation options.
pub fn options(m: &Model) -> Named {
    let o = &m.opt;
    vec![
        ("timestep", vec![o.timestep]),
        ("gravity", o.gravity.to_vec()),
        ("iterations", vec![o.iterations as f64]),
        ("tolerance", vec![o.tolerance]),
        ("ls_iterations", vec![o.ls_iterations as f64]),
        ("ls_tolerance", vec![o.ls_tolerance]),
        ("impratio", vec![o.impratio]),
        ("noslip_iterations", vec![o.noslip_iterations as f64]),
        ("noslip_tolerance", vec![o.noslip_tolerance]),
        ("ccd_iterations", vec![o.ccd_iterations as f64]),
        ("ccd_tolerance", vec![o.ccd_tolerance]),
    ]
}

/// Returns the names of elements by kind.
pub fn names(m: &Model) -> Vec<(&'static str, Vec<String>)> {
    vec![
        ("body", m.body_name.clone()),
        ("jnt", m.jnt_name.clone()),
        ("geom", m.geom_name.clone()),
        ("site", m.site_name.clone()),
        ("cam", m.cam_name.clone()),
        ("eq", m.eq_name.clone()),
        ("tendon", m.tendon_name.clone()),
        ("actuator", m.actuator_name.clone()),
        ("sensor", m.sensor_name.clone()),
        ("tex", m.textures.iter().map(|t| t.name.clone()).collect()),
        ("mat", m.materials.iter().map(|t| t.name.clone()).collect()),
        ("light", m.lights.iter().map(|t| t.name.clone()).collect()),
    ]
}
