//! `babybench inspect`

use std::error::Error;
use std::io::{self, Write, stdout};
use std::path::{Path, PathBuf};

use crate::report::skin::draw_skin;
use babybench::config::{Compat, Delays};
use babybench::formats::png::write_png;
use babybench::mimo::{joint_part, strength_table};
use babybench::mjcf_loader::elements;
use babybench::model::{EqualityKind, TrnType};
use babybench::physics::collision::PairTable;
use babybench::runs::replay;
use babybench::sensors::ProprioceptionComponent;
use babybench::{Blueprint, Env, Model};
use clap::Args;

use super::keys::list_keys;
use super::{Source, body, read_recording, sources};
use crate::arguments::{age, number, png};

/// Arguments of `inspect`.
#[derive(Args)]
pub struct Inspect {
    #[command(flatten)]
    source: Option<Source>,
    /// Describe MIMo at this age (months) instead of the configuration's, his body included
    #[arg(long, value_name = "MONTHS", allow_negative_numbers = true, value_parser = age, conflicts_with = "mjcf")]
    age: Option<f64>,
    /// Draw the touch sensors on the body in the settled state to a PNG image, instead of printing
    #[arg(long, value_name = "PNG", value_parser = png())]
    touch: Option<PathBuf>,
    /// List the MJCF elements and attributes that the loader understands, with defaults, instead of printing
    #[arg(long, exclusive = true)]
    mjcf: bool,
    /// Print every key of the configuration with its values, default and meaning, as Markdown
    #[arg(long, exclusive = true)]
    keys: bool,
    /// Print strength, proportions and noise of infants over age, and the constants behind them with unit, mark and source, as Markdown
    #[arg(long, exclusive = true)]
    sources: bool,
    /// Draw them at a step of this recording (as for replay), with the forces on them
    #[arg(long, value_name = "FILE", requires = "touch")]
    state: Option<PathBuf>,
    /// Step of the recording; the last one by default
    #[arg(long, value_name = "T", requires = "state", allow_negative_numbers = true, value_parser = number::<usize>)]
    step: Option<usize>,
}

/// Height of the picture of the skin, pixels.
const PICTURE_HEIGHT: usize = 900;

impl Inspect {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        if self.mjcf {
            return Ok(list_mjcf(&mut stdout().lock())?);
        }
        if self.keys {
            return Ok(list_keys(&mut stdout().lock())?);
        }
        if self.sources {
            return sources::write(&mut stdout().lock());
        }
        let source = self.source.as_ref();
        let source = source.ok_or("give --config FILE, or --keys, --mjcf or --sources alone")?;
        let mut config = source.read(Compat::Api)?;
        config.age = self.age.or(config.age);
        let blueprint = source.build(config)?;
        if let Some(path) = &self.touch {
            return self.draw_touch(&blueprint, path);
        }
        let mut out = stdout().lock();
        let env = blueprint.env()?;
        write_sizes(&mut out, &env)?;
        if let Some(age) = blueprint.config().age {
            body::write(&mut out, &env, age)?;
            let assets = blueprint.assets();
            body::write_strength(&mut out, &strength_table(blueprint.config(), assets)?)?;
        }
        write_joints(&mut out, &env)?;
        write_actuators(&mut out, &env)?;
        write_spaces(&mut out, &env)?;
        write_observation(&mut out, &env)?;
        write_pipeline(&mut out, &env)?;
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
                return Err(format!(
                    "{file}: --step {step} is out of range: the recording has {n} steps, counted from 0"
                )
                .into());
            }
            recording.len = step + 1;
            let one_step = !recording.qpos.is_empty();
            replay(&mut env, &recording, one_step)?;
        } else {
            env.by_hand().reset_to(blueprint.init_qpos(), blueprint.init_qvel())?;
        }
        let s = env.state();
        let felt = if self.state.is_some() {
            env.senses().touch()
        } else {
            None
        };
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
            let body = &env.model().body_name[c.body];
            let other = c.other.name(env.model());
            writeln!(out, "  {body:20} touched by {other:20} with {:8.3} N", c.normal)?;
        }
        Ok(())
    }
}

/// Writes the name of the scene and the numbers of its elements.
fn write_sizes(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let (config, model) = (env.config(), env.model());
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
    let table = PairTable::new(model);
    let pairs = table.pairs();
    writeln!(
        out,
        "timestep {} s, frame_skip {}; {} pairs of geoms can collide; total body mass {:.4} kg",
        model.opt.timestep,
        config.frame_skip,
        pairs.map_or_else(|| "many".to_string(), |pairs| pairs.len().to_string()),
        model.body_mass.iter().sum::<f64>(),
    )
}

/// Writes MIMo's joints in the order of the observation.
fn write_joints(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let (model, blueprint) = (env.model(), env.blueprint());
    writeln!(out, "\nMIMo's joints (indices into angles, velocities and limits)")?;
    let (low, high) = ("low", "high");
    writeln!(
        out,
        "{:>4} {:34} {:8} {low:>9} {high:>9} {:>9}  locked",
        "", "name", "part", "settled"
    )?;
    let joints = env.senses().proprioception().joints();
    for (k, (&j, &q)) in joints.joint.iter().zip(&joints.qpos).enumerate() {
        let part = joint_part(model, j).map_or("", |p| p.name());
        let [low, high] = model.jnt_range[j];
        let held = (0..model.neq()).any(|e| {
            blueprint.params().eq_active[e]
                && matches!(model.eq_kind[e], EqualityKind::Joint { joint1, .. } if joint1 == j)
        });
        writeln!(
            out,
            "{k:>4} {:34} {part:8} {low:>9.4} {high:>9.4} {:>9.4}  {}",
            model.jnt_name[j],
            blueprint.init_qpos()[q],
            if held { "yes" } else { "" }
        )?;
    }
    Ok(())
}

/// Writes the actuators of the model.
fn write_actuators(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let model = env.model();
    writeln!(out, "\nActuators")?;
    writeln!(
        out,
        "{:>4} {:34} {:34} {:>9} {:>17}",
        "", "name", "joint", "gear", "force range"
    )?;
    for i in 0..model.nu() {
        let joint = match model.actuator_joint(i) {
            Some(joint) => &model.jnt_name[joint],
            None => target(model, i),
        };
        let [lo, hi] = model.actuator_forcerange[i];
        let (name, gear) = (&model.actuator_name[i], model.actuator_gear[i]);
        writeln!(out, "{i:>4} {name:34} {joint:34} {gear:>9} {lo:>8} {hi:>8}")?;
    }
    Ok(())
}

/// Returns the name of the element that an actuator acts on, if it is not a joint.
fn target(model: &Model, actuator: usize) -> &String {
    let id = model.actuator_trnid[actuator];
    match model.actuator_trntype[actuator] {
        TrnType::SliderCrank | TrnType::Site => &model.site_name[id],
        TrnType::Body => &model.body_name[id],
        _ => &model.tendon_name[id],
    }
}

/// Writes the action space and the observation space.
fn write_spaces(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let space = env.action_space();
    writeln!(out, "\nAction space: {} numbers (f32)", space.len())?;
    for (i, name) in env.blueprint().actuation().action_names(env.model()).iter().enumerate() {
        writeln!(out, "{i:>4} {name:44} {:>12} {:>12}", space.low()[i], space.high()[i])?;
    }
    writeln!(out, "\nObservation space")?;
    for s in env.observation_space() {
        writeln!(
            out,
            "  {:12} shape {:?}, {:?}, {} to {}",
            s.key, s.shape, s.dtype, s.low, s.high
        )?;
    }
    Ok(())
}

/// Writes the meaning of each number of the observation.
fn write_observation(out: &mut impl Write, env: &Env) -> io::Result<()> {
    writeln!(out, "  components of `observation`")?;
    let proprioception = env.senses().proprioception();
    for (component, range) in proprioception.layout() {
        let what = match component {
            ProprioceptionComponent::Angles => "rad, joints as above",
            ProprioceptionComponent::Velocities => "rad/s, joints as above",
            ProprioceptionComponent::Torques => "N m, three for each torque sensor",
            ProprioceptionComponent::Limits => "0 within the range, 1 at a limit, joints as above",
            ProprioceptionComponent::Actuation => "state of the actuators",
        };
        let name = component.name();
        writeln!(out, "    {:4}..{:4} {name:10} {what}", range.start, range.end)?;
    }
    writeln!(out, "  entry by entry")?;
    for entry in proprioception.entries(env.model(), env.blueprint().actuation()) {
        let (range, component) = (entry.range, entry.component.name());
        writeln!(
            out,
            "    {:4}..{:4} {component:10} {}",
            range.start, range.end, entry.name
        )?;
    }
    if env.config().reflexes.observed {
        writeln!(out, "  components of `reflexes`, 0 to 1")?;
        for (at, reflex) in env.reflexes().enumerate() {
            writeln!(out, "    {at:4}..{:4} {reflex}", at + 1)?;
        }
    }
    if let Some(v) = env.senses().vestibular() {
        writeln!(out, "  components of `vestibular`")?;
        for (name, range) in v.layout(env.model()) {
            writeln!(out, "    {:4}..{:4} {name}", range.start, range.end)?;
        }
    }
    Ok(())
}

/// Writes the path from each sense to the observation, and from actions to the actuators.
fn write_pipeline(out: &mut impl Write, env: &Env) -> io::Result<()> {
    writeln!(out, "\nFrom the senses to the observation")?;
    for (sense, chain) in env.senses().transforms() {
        let chain: Vec<String> = chain.map(|transform| transform.describe()).collect();
        let way = if chain.is_empty() {
            "as it is".to_string()
        } else {
            chain.join(" -> ")
        };
        writeln!(out, "  {:12} {way}", sense.key())?;
    }
    let (steps, config) = (env.blueprint().action_delay(), env.config());
    let ms = steps as f64 * Delays::step_ms(config.frame_skip);
    match steps {
        0 => writeln!(out, "  actions      as they are"),
        1 => writeln!(out, "  actions      delay of 1 step ({ms} ms)"),
        _ => writeln!(out, "  actions      delay of {steps} steps ({ms} ms)"),
    }
}

/// Lists the MJCF that the loader understands: an attribute a line, with values, default and meaning.
fn list_mjcf(out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "Attributes with their values, default (* if a default class may set another) and meaning"
    )?;
    for element in elements() {
        writeln!(out, "\n{}", element.path)?;
        for a in element.attributes {
            let star = if a.in_default { "*" } else { "" };
            let default = if a.required {
                "required".to_owned()
            } else {
                a.default + star
            };
            writeln!(out, "  {:17} {:44} {default:30} {}", a.name, a.values, a.meaning)?;
        }
    }
    Ok(())
}
