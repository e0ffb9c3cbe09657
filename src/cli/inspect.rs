//! `babybench inspect`

use std::error::Error;
use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

use babybench::Blueprint;
use babybench::config::Compat;
use babybench::eval::{replay, write_png};
use babybench::mimo::joint_part;
use babybench::model::JointId;
use babybench::sensors::Component;
use babybench::sensors::touch::draw_skin;
use clap::Args;

use super::arguments::{number, png};
use super::{Source, read_recording};

/// Arguments of `inspect`.
#[derive(Args)]
pub struct Inspect {
    #[command(flatten)]
    source: Source,
    /// Draw the touch sensors on the body, in the settled state, as a PNG image, instead of printing.
    #[arg(long, value_name = "PNG", value_parser = png())]
    touch: Option<PathBuf>,
    /// Draw them in a step of this recording (as for replay), with the forces that are felt.
    #[arg(long, value_name = "FILE", requires = "touch")]
    state: Option<PathBuf>,
    /// The step of the recording; the last one if not given.
    #[arg(long, value_name = "T", requires = "state", allow_negative_numbers = true, value_parser = number::<usize>)]
    step: Option<usize>,
}

/// Height of the picture of the skin, pixels.
const PICTURE_HEIGHT: usize = 900;

impl Inspect {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let blueprint = self.source.blueprint(Compat::Api)?;
        if let Some(path) = &self.touch {
            return self.draw_touch(&blueprint, path);
        }
        let mut out = stdout().lock();
        let env = blueprint.env()?;
        let (config, model) = (blueprint.config(), &**blueprint.model());
        writeln!(
            out,
            "behavior {}, scene {}, actuation {}, compat {}",
            config.behavior, config.scene, config.actuation_model, config.compat
        )?;
        writeln!(
            out,
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
        )?;
        writeln!(
            out,
            "timestep {} s, {} per action; {} geom pairs may touch; mass of the bodies {:.4} kg",
            model.opt.timestep,
            config.frame_skip,
            env.engine().pairs().pairs().len(),
            model.body_mass.iter().sum::<f64>(),
        )?;

        writeln!(out, "\nMIMo's joints (index in angles, velocities and limits)")?;
        writeln!(
            out,
            "{:>4} {:34} {:8} {:>9} {:>9} {:>9}  held",
            "", "name", "part", "low", "high", "settled"
        )?;
        let joints = env.proprioception().joints();
        for (k, (&j, &q)) in joints.joint.iter().zip(&joints.qpos).enumerate() {
            let part = joint_part(model, JointId(j)).map_or("", |p| p.name());
            let [low, high] = model.jnt_range[j];
            let held = (0..model.neq()).any(|e| {
                blueprint.params().eq_active[e]
                    && matches!(model.eq_kind[e], babybench::model::EqualityKind::Joint { joint1, .. } if joint1.0 == j)
            });
            writeln!(
                out,
                "{k:>4} {:34} {part:8} {low:>9.4} {high:>9.4} {:>9.4}  {}",
                model.jnt_name[j],
                blueprint.init_qpos()[q],
                if held { "yes" } else { "" }
            )?;
        }

        writeln!(out, "\nActuators")?;
        writeln!(
            out,
            "{:>4} {:34} {:34} {:>9} {:>17}",
            "", "name", "joint", "gear", "force range"
        )?;
        for i in 0..model.nu() {
            let joint = &model.jnt_name[model.actuator_trnid[i]];
            let [lo, hi] = model.actuator_forcerange[i];
            let (name, gear) = (&model.actuator_name[i], model.actuator_gear[i]);
            writeln!(out, "{i:>4} {name:34} {joint:34} {gear:>9} {lo:>8} {hi:>8}")?;
        }

        let space = env.action_space();
        writeln!(out, "\nAction: {} numbers (f32)", space.len())?;
        for (i, name) in env.actuation().action_names(model).iter().enumerate() {
            writeln!(out, "{i:>4} {name:44} {:>12} {:>12}", space.low()[i], space.high()[i])?;
        }

        writeln!(out, "\nObservation")?;
        for s in env.observation_space() {
            writeln!(
                out,
                "  {:12} shape {:?}, {:?}, {} to {}",
                s.key, s.shape, s.dtype, s.low, s.high
            )?;
        }
        writeln!(out, "  observation is made of")?;
        let proprioception = env.proprioception();
        for (component, range) in proprioception.layout() {
            let what = match component {
                Component::Angles => "rad, joints as above",
                Component::Velocities => "rad/s, joints as above",
                Component::Torques => "N m, three for each torque sensor",
                Component::Limits => "0 inside, 1 at a limit, joints as above",
                Component::Actuation => "state of the actuators",
            };
            writeln!(
                out,
                "    {:4}..{:4} {:10} {what}",
                range.start,
                range.end,
                component.name()
            )?;
        }
        writeln!(out, "  in detail")?;
        for entry in proprioception.entries(model, env.actuation()) {
            let (range, component) = (entry.range, entry.component.name());
            writeln!(
                out,
                "    {:4}..{:4} {component:10} {}",
                range.start, range.end, entry.name
            )?;
        }
        if let Some(v) = env.vestibular() {
            writeln!(out, "  vestibular is made of")?;
            for (name, range) in v.layout(model) {
                writeln!(out, "    {:4}..{:4} {name}", range.start, range.end)?;
            }
        }
        Ok(())
    }

    /// Writes the picture of the skin.
    fn draw_touch(&self, blueprint: &Blueprint, path: &Path) -> Result<(), Box<dyn Error>> {
        let mut out = stdout().lock();
        let Some(skin) = blueprint.skin() else {
            return Err("touch is off in this configuration: set touch_active and a touch_scale > 0".into());
        };
        let mut env = blueprint.env()?;
        if let Some(file) = &self.state {
            let mut recording = read_recording(file, &env)?;
            let step = self.step.unwrap_or(recording.len.saturating_sub(1));
            if step >= recording.len {
                let (file, n) = (file.display(), recording.len);
                return Err(format!("{file}: it has {n} steps, from 0: there is no --step {step}").into());
            }
            recording.len = step + 1;
            let one_step = !recording.qpos.is_empty();
            replay(&mut env, &recording, one_step)?;
        } else {
            env.reset_to(blueprint.init_qpos(), blueprint.init_qvel())?;
        }
        let s = env.state();
        let felt = if self.state.is_some() { env.touch() } else { None };
        let picture = draw_skin(env.model(), skin, &s.xpos, &s.xmat, felt, PICTURE_HEIGHT);
        write_png(path, &picture.rgb, picture.width, picture.height)?;
        writeln!(
            out,
            "{} sensors on {} bodies: {}",
            skin.len(),
            skin.bodies().len(),
            path.display()
        )?;
        for c in felt.map_or(&[][..], |t| t.contacts()) {
            let body = &env.model().body_name[c.body.0];
            let other = &env.model().body_name[env.model().geom_bodyid[c.other.0]];
            writeln!(out, "  {body:20} touched by {other:20} with {:8.3} N", c.normal)?;
        }
        Ok(())
    }
}
