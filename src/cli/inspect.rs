//! `babybench inspect`

use std::error::Error;

use babybench::config::Compat;
use babybench::mimo::joint_part;
use babybench::model::JointId;
use babybench::sensors::Component;
use clap::Args;

use super::Source;

/// Arguments of `inspect`.
#[derive(Args)]
pub struct Inspect {
    #[command(flatten)]
    source: Source,
}

impl Inspect {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let blueprint = self.source.blueprint(Compat::Api)?;
        let env = blueprint.env()?;
        let (config, model) = (blueprint.config(), &**blueprint.model());
        println!(
            "behavior {}, scene {}, actuation {}, compat {}",
            config.behavior, config.scene, config.actuation_model, config.compat
        );
        println!(
            "nq {}  nv {}  nbody {}  njnt {}  ngeom {}  nsite {}  nu {}  neq {}  ntendon {}  nsensor {}",
            model.nq,
            model.nv,
            model.nbody(),
            model.njnt(),
            model.ngeom(),
            model.nsite(),
            model.nu(),
            model.neq(),
            model.ntendon(),
            model.nsensor(),
        );
        println!(
            "timestep {} s, {} per action; {} geom pairs may touch; mass of the bodies {:.4} kg",
            model.opt.timestep,
            config.frame_skip,
            env.engine().pairs().pairs().len(),
            model.body_mass.iter().sum::<f64>(),
        );

        println!("\nMIMo's joints (index in angles, velocities and limits)");
        println!(
            "{:>4} {:34} {:8} {:>9} {:>9} {:>9}  held",
            "", "name", "part", "low", "high", "settled"
        );
        let joints = env.proprioception().joints();
        for (k, (&j, &q)) in joints.joint.iter().zip(&joints.qpos).enumerate() {
            let part = joint_part(model, JointId(j)).map_or("", |p| p.name());
            let [low, high] = model.jnt_range[j];
            let held = (0..model.neq()).any(|e| {
                blueprint.params().eq_active[e]
                    && matches!(model.eq_kind[e], babybench::model::EqualityKind::Joint { joint1, .. } if joint1.0 == j)
            });
            println!(
                "{k:>4} {:34} {part:8} {low:>9.4} {high:>9.4} {:>9.4}  {}",
                model.jnt_name[j],
                blueprint.init_qpos()[q],
                if held { "yes" } else { "" }
            );
        }

        println!("\nActuators");
        println!(
            "{:>4} {:34} {:34} {:>9} {:>17}",
            "", "name", "joint", "gear", "force range"
        );
        for i in 0..model.nu() {
            let joint = &model.jnt_name[model.actuator_trnid[i]];
            let [lo, hi] = model.actuator_forcerange[i];
            let (name, gear) = (&model.actuator_name[i], model.actuator_gear[i]);
            println!("{i:>4} {name:34} {joint:34} {gear:>9} {lo:>8} {hi:>8}");
        }

        let space = env.action_space();
        println!("\nAction: {} numbers (f32)", space.len());
        for i in 0..space.len() {
            let name = model
                .actuator_name
                .get(i % model.nu().max(1))
                .map_or("", String::as_str);
            println!("{i:>4} {name:34} {:>9} {:>9}", space.low()[i], space.high()[i]);
        }

        println!("\nObservation");
        for s in env.observation_space() {
            println!(
                "  {:12} shape {:?}, {:?}, {} to {}",
                s.key, s.shape, s.dtype, s.low, s.high
            );
        }
        println!("  observation is made of");
        let proprioception = env.proprioception();
        for (component, range) in proprioception.layout() {
            let what = match component {
                Component::Angles => "rad, joints as above",
                Component::Velocities => "rad/s, joints as above",
                Component::Torques => "N m, three for each torque sensor",
                Component::Limits => "0 inside, 1 at a limit, joints as above",
                Component::Actuation => "state of the actuators",
            };
            println!("    {:4}..{:4} {:10} {what}", range.start, range.end, component.name());
        }
        if let Some(r) = proprioception.range(Component::Torques) {
            println!("  torque sensors");
            for (k, name) in proprioception.sensor_names(model).enumerate() {
                println!("    {:4}..{:4} {name}", r.start + 3 * k, r.start + 3 * k + 3);
            }
        }
        if let Some(r) = proprioception.range(Component::Actuation) {
            println!("  actuation");
            for (k, name) in env.actuation().observation_names(model).iter().enumerate() {
                println!("    {:4} {name}", r.start + k);
            }
        }
        if let Some(v) = env.vestibular() {
            println!("  vestibular is made of");
            for (name, range) in v.layout(model) {
                println!("    {:4}..{:4} {name}", range.start, range.end);
            }
        }
        Ok(())
    }
}
