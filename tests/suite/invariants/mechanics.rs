//! Laws of mechanics that the engine must obey whatever MuJoCo does.

use babybench::Model;
use babybench::config::{Behavior, Compat, Scene};
use babybench::math::mat_t_vec;
use babybench::model::{EqualityKind, JointType};
use babybench::physics::{ConstraintType, Engine, State};

use crate::common::*;

/// `J' f` of the constraints that act from outside a joint: contacts and welds.
fn external(model: &Model, engine: &dyn Engine, s: &State) -> Vec<f64> {
    let mut out = vec![0.0; model.nv];
    for (k, row) in s.efc_rows().enumerate() {
        let outside = match row.kind {
            ConstraintType::ContactElliptic
            | ConstraintType::ContactPyramidal
            | ConstraintType::ContactFrictionless => true,
            ConstraintType::Equality => matches!(model.eq_kind[row.id], EqualityKind::Weld { .. }),
            ConstraintType::FrictionDof
            | ConstraintType::FrictionTendon
            | ConstraintType::LimitJoint
            | ConstraintType::LimitTendon => false,
        };
        if outside {
            let jacobian = engine.efc_j(s, k).expect("the row exists");
            for (out, j) in out.iter_mut().zip(jacobian) {
                *out += j * row.force;
            }
        }
    }
    out
}

/// `M x`
fn mul_m(engine: &dyn Engine, s: &State, x: &[f64]) -> Vec<f64> {
    let product = |row: &[f64]| row.iter().zip(x).map(|(m, x)| m * x).sum();
    engine.full_m(s).chunks_exact(x.len()).map(product).collect()
}

/// Power of a wrench along a motion.
fn dot6(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Torque that reaches each degree of freedom through its joint, from the internal wrenches, minus the sum of its causes;
/// and what the solver left of the equation of motion, `M qacc - qfrc_smooth - qfrc_constraint`.
fn torque_residuals(model: &Model, engine: &dyn Engine, s: &State) -> Vec<[f64; 2]> {
    let external = external(model, engine, s);
    let inertial = mul_m(engine, s, &s.qacc);
    (0..model.nv)
        .map(|d| {
            let through = dot6(&s.cdof[d], &s.cfrc_int[model.dof_bodyid[d]]);
            let applied = s.qfrc_actuator[d] + s.qfrc_passive[d] + s.qfrc_applied[d];
            let causes = applied + s.qfrc_constraint[d] - external[d] - model.dof_armature[d] * s.qacc[d];
            [through - causes, inertial[d] - s.qfrc_smooth[d] - s.qfrc_constraint[d]]
        })
        .collect()
}

#[test]
fn torque_sensors_feel_exactly_what_acts_through_the_joint() {
    let mut failed = Vec::new();
    for (behavior, scene) in MODELS {
        let mut env = env(free(behavior, scene.clone()));
        env.reset(Some(0)).expect("no divergence");
        let model = env.model().clone();
        let hinge: Vec<bool> = model
            .dof_jntid
            .iter()
            .map(|&j| model.jnt_type[j] == JointType::Hinge)
            .collect();
        // residual at hinges and free joints; what remains without the solver's share; that share; the largest torque
        let (mut at, mut rest, mut solver, mut largest) = ([0.0_f64; 2], 0.0_f64, 0.0_f64, 0.0_f64);
        let worse = |a: &mut f64, b: f64| *a = if b.is_nan() { f64::INFINITY } else { a.max(b.abs()) };
        for _ in 0..60 {
            random_steps(&mut env, 1);
            let s = env.state();
            for (d, [r, e]) in torque_residuals(&model, &*env.blueprint().engine(), s)
                .into_iter()
                .enumerate()
            {
                worse(&mut at[usize::from(!hinge[d])], r);
                worse(&mut rest, r - e);
                worse(&mut solver, e);
                if hinge[d] {
                    worse(&mut largest, dot6(&s.cdof[d], &s.cfrc_int[model.dof_bodyid[d]]));
                }
            }
        }
        let name = format!("{behavior}/{scene}");
        let [hinges, others] = at;
        println!(
            "{name:18} residual {hinges:.1e} N m at hinges (of {largest:.1}), {others:.1e} at free joints, of which the \
             solver leaves {solver:.1e}; without it {rest:.1e}"
        );
        if rest > 6e-12 || hinges > 3e-7 {
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn in_reference_the_weld_of_the_crib_counts_double() {
    let mut env = env(babybench::Config {
        compat: Compat::Reference,
        ..free(Behavior::None, Scene::Crib)
    });
    env.reset(Some(0)).expect("no divergence");
    random_steps(&mut env, 20);
    let model = env.model().clone();
    let residuals = torque_residuals(&model, &*env.blueprint().engine(), env.state());
    let residuals: Vec<f64> = residuals.iter().map(|r| r[0]).collect();
    for (d, r) in residuals.iter().enumerate().filter(|(_, r)| r.abs() > 1e-6) {
        let body = &model.body_name[model.dof_bodyid[d]];
        println!("{:18} {r:8.3} N m", model.jnt_name[model.dof_jntid[d]]);
        assert!(
            ["lower_body", "mimo_location", "hip"].contains(&body.as_str()),
            "{body} is beyond the weld"
        );
    }
    assert!(max_abs(&residuals) > 1e-3);
}

/// Vertical force of the world's geoms on MIMo, N.
fn support(model: &Model, s: &State) -> f64 {
    let world = |g: usize| model.body_weldid[model.geom_bodyid[g]] == 0;
    s.contact
        .iter()
        .map(|c| {
            let up = mat_t_vec(&c.frame, [c.force[0], c.force[1], c.force[2]])[2];
            f64::from(i32::from(world(c.geom[0])) - i32::from(world(c.geom[1]))) * up
        })
        .sum()
}

#[test]
fn the_floor_carries_exactly_mimos_weight() {
    let mut env = env(free(Behavior::None, Scene::Base));
    env.reset(Some(0)).expect("no divergence");
    let model = env.model().clone();
    let weight = model.body_subtreemass[1] * -model.opt.gravity[2];
    assert!((weight - 10.90487 * 9.81).abs() < 1e-6, "{weight}");
    let action = vec![0.0; env.action_space().len()];
    let mut error = f64::INFINITY;
    for k in 1..=if cfg!(debug_assertions) { 8 } else { 20 } {
        repeat(&mut env, &action, 1000);
        let s = env.state();
        error = (support(&model, s) / weight - 1.0).abs();
        println!(
            "after {k:2}000 steps: {} contacts carry the weight up to {error:.1e}, max |qvel| {:.1e}, max |qacc| {:.1e}",
            s.contact.len(),
            max_abs(&s.qvel),
            max_abs(&s.qacc)
        );
        if error < 7e-7 {
            break;
        }
    }
    assert!(error < 7e-7, "MIMo does not rest");
}

#[test]
fn energy_does_not_grow_while_nothing_drives() {
    // kinetic energy of MIMo falling onto the floor and coming to rest, plus its potential energy
    let mut env = env(free(Behavior::None, Scene::Base));
    env.reset(Some(0)).expect("no divergence");
    let model = env.model().clone();
    let action = vec![0.0; env.action_space().len()];
    let energy = |engine: &dyn Engine, s: &State| {
        let momentum = mul_m(engine, s, &s.qvel);
        let kinetic = 0.5 * momentum.iter().zip(&s.qvel).map(|(p, v)| p * v).sum::<f64>();
        let potential = model.body_subtreemass[1] * 9.81 * s.subtree_com[1][2];
        let springs: f64 = (0..model.njnt())
            .map(|j| {
                0.5 * s.params.jnt_stiffness[j]
                    * (s.qpos[model.jnt_qposadr[j]] - model.qpos_spring[model.jnt_qposadr[j]]).powi(2)
            })
            .sum();
        (kinetic, potential + springs)
    };
    let mut first = None;
    let mut last = (0.0, 0.0);
    for _ in 0..400 {
        env.step(&action).expect("no divergence");
        last = energy(&*env.blueprint().engine(), env.state());
        let total = last.0 + last.1;
        let start = *first.get_or_insert(total);
        assert!(total <= start + 0.05, "energy rose from {start} to {total} J");
    }
    println!(
        "energy from {:.4} J to {:.4} J, of which kinetic {:.1e} J",
        first.unwrap_or_default(),
        last.0 + last.1,
        last.0
    );
}
