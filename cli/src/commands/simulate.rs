//! `babybench simulate`

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write, stdout};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use babybench::Model;
use babybench::assets::FileSystem;
use babybench::formats::avi::AviWriter;
use babybench::formats::npz::NpzWriter;
use babybench::mjcf_loader::load;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};
use babybench::render::{FreeCamera, Poses, RenderRequest, Renderer, Scenery, View};
use babybench::spaces::NumpyRng;
use clap::{Args, ValueEnum};

use crate::arguments::{count, number};
use crate::interrupt::{Interrupt, Interrupted};

/// Arguments of `simulate`.
#[derive(Args)]
pub struct Simulate {
    /// MJCF document; paths of includes and textures start at its folder
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    /// Simulated time, s
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true, value_parser = seconds,
        conflicts_with = "steps")]
    seconds: f64,
    /// Steps of the model's time step instead
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number::<u64>)]
    steps: Option<u64>,
    /// Keyframe to start from, by name or number; qpos0 at rest by default
    #[arg(long, value_name = "KEY")]
    keyframe: Option<String>,
    /// Controls of the actuators: zero, those of the keyframe (keyframe), or random within their ranges
    #[arg(long, value_name = "WHICH", default_value = "zero")]
    policy: Policy,
    /// Seed of random controls
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = number::<u64>)]
    seed: u64,
    /// Video (.avi, Motion JPEG) to write
    #[arg(long, value_name = "FILE")]
    video: Option<PathBuf>,
    /// Camera of the video, by name; a view of the whole model by default
    #[arg(long, value_name = "NAME", requires = "video")]
    camera: Option<String>,
    /// Width and height of the video, pixels
    #[arg(long, value_name = "N", default_value_t = 480, requires = "video", allow_negative_numbers = true,
        value_parser = count::<usize>)]
    size: usize,
    /// NumPy archive (.npz) to write: time, qpos, qvel, act, ctrl, qacc and sensordata of every step
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// The source of controls.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Policy {
    Zero,
    Keyframe,
    Random,
}

/// Pictures of a video per second of simulated time.
const FPS: u32 = 30;

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(s) if (0.0..=1e9).contains(&s) => Ok(s),
        _ => Err("expected seconds, at least 0".to_owned()),
    }
}

impl Simulate {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let interrupt = Interrupt::watch();
        let (model, assets) = self.load()?;
        let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
        let mut state = engine.new_state();
        if let Some(key) = &self.keyframe {
            engine.reset_to_keyframe(&mut state, keyframe(&model, key)?)?;
        }
        let mut controls = Controls::new(self, &model, &state)?;
        let film = self.video.as_ref().map(|path| Film::new(self, path, &model, &assets));
        let mut film = film.transpose()?;
        let mut rows = self.out.as_ref().map(|_| Rows::default());
        let steps = self.steps.unwrap_or((self.seconds / model.opt.timestep).round() as u64);
        let (started, mut stepping) = (Instant::now(), 0.0);
        for step in 0..steps {
            if interrupt.wanted() {
                return Err(Interrupted(format!("interrupted after {step} of {steps} steps")).into());
            }
            controls.set(&model, &mut state);
            let from = Instant::now();
            let (time, qpos, qvel, act) = before(rows.is_some(), &state);
            engine
                .step(&mut state)
                .map_err(|e| format!("{}: {e}", self.model.display()))?;
            stepping += from.elapsed().as_secs_f64();
            if let Some(rows) = &mut rows {
                rows.push(time, &qpos, &qvel, &act, &state);
            }
            if let Some(film) = &mut film {
                film.picture(&state)?;
            }
        }
        engine.forward(&mut state)?;
        if let (Some(rows), Some(path)) = (rows, &self.out) {
            rows.write(&model, path)?;
        }
        if let (Some(film), Some(path)) = (film, &self.video) {
            film.finish(path)?;
        }
        self.report(&model, &state, steps, stepping, started.elapsed().as_secs_f64())
    }

    /// Reads and compiles the model.
    fn load(&self) -> Result<(Arc<Model>, FileSystem), Box<dyn Error>> {
        let (assets, file) = FileSystem::beside(&self.model)?;
        let model = load(&assets, &file)
            .and_then(compile)
            .map_err(|error| error.in_folder(assets.folder()))?;
        Ok((Arc::new(model), assets))
    }

    /// Prints the contents of the model, its path, and the time of loading.
    fn report(
        &self,
        model: &Model,
        state: &State,
        steps: u64,
        stepping: f64,
        whole: f64,
    ) -> Result<(), Box<dyn Error>> {
        let mut out = stdout().lock();
        writeln!(out, "{}", self.model.display())?;
        writeln!(
            out,
            "  {} bodies, {} joints (nq {}, nv {}), {} geoms, {} actuators, {} sensors, {} keyframes",
            model.nbody() - 1,
            model.njnt(),
            model.nq,
            model.nv,
            model.ngeom(),
            model.nu(),
            model.nsensor(),
            model.nkey()
        )?;
        let per_step = if steps > 0 { 1e6 * stepping / steps as f64 } else { 0.0 };
        writeln!(
            out,
            "  {steps} steps of {} s: {per_step:.1} us a step, {:.0} times real time ({whole:.2} s in all)",
            model.opt.timestep,
            if stepping > 0.0 {
                steps as f64 * model.opt.timestep / stepping
            } else {
                0.0
            }
        )?;
        writeln!(
            out,
            "At {:.4} s: {} contacts, {} constraint rows",
            state.time,
            state.contact.len(),
            state.nefc()
        )?;
        for j in 0..model.njnt() {
            let (adr, n) = (model.jnt_qposadr[j], model.jnt_type[j].nq());
            let label = match model.jnt_name[j].as_str() {
                "" => format!("of body {:?}", model.body_name[model.jnt_bodyid[j]]),
                name => name.to_owned(),
            };
            writeln!(out, "  joint {label}: {}", shown(&state.qpos[adr..adr + n]))?;
        }
        for (i, name) in model.sensor_name.iter().enumerate() {
            let (adr, dim) = (model.sensor_adr[i], model.sensor_dim[i]);
            let label = if name.is_empty() {
                model.sensor_type[i].name()
            } else {
                name
            };
            writeln!(out, "  sensor {label}: {}", shown(&state.sensordata[adr..adr + dim]))?;
        }
        for path in [&self.video, &self.out].into_iter().flatten() {
            writeln!(out, "wrote {}", path.display())?;
        }
        Ok(())
    }
}

fn shown(values: &[f64]) -> String {
    values.iter().map(|v| format!("{v:.6}")).collect::<Vec<_>>().join(" ")
}

/// Finds a keyframe by name or by number.
fn keyframe(model: &Model, key: &str) -> Result<usize, String> {
    let found = model
        .key(key)
        .or_else(|| key.parse().ok().filter(|&k: &usize| k < model.nkey()));
    found.ok_or_else(|| {
        let names: Vec<_> = model
            .keys
            .iter()
            .map(|k| k.name.as_str())
            .filter(|n| !n.is_empty())
            .collect();
        let (count, names) = (model.nkey(), names.join(", "));
        format!("--keyframe {key}: the model has no such keyframe; it has {count}, numbered from 0: {names}")
    })
}

/// Copies the part of the state that a row of the archive holds, if there is an archive.
fn before(wanted: bool, state: &State) -> (f64, Vec<f64>, Vec<f64>, Vec<f64>) {
    if wanted {
        (state.time, state.qpos.clone(), state.qvel.clone(), state.act.clone())
    } else {
        (state.time, Vec::new(), Vec::new(), Vec::new())
    }
}

/// The controls of a run.
struct Controls {
    policy: Policy,
    rng: NumpyRng,
    held: Vec<f64>,
}

impl Controls {
    fn new(arguments: &Simulate, model: &Model, state: &State) -> Result<Self, Box<dyn Error>> {
        if arguments.policy == Policy::Keyframe && arguments.keyframe.is_none() {
            return Err("--policy keyframe: say which with --keyframe".into());
        }
        let held = match arguments.policy {
            Policy::Keyframe => state.ctrl.clone(),
            Policy::Zero | Policy::Random => vec![0.0; model.nu()],
        };
        Ok(Self {
            policy: arguments.policy,
            rng: NumpyRng::seed(arguments.seed),
            held,
        })
    }

    /// Sets the controls of the next step. A random control is within its range, or from -1 to 1 without a range.
    fn set(&mut self, model: &Model, state: &mut State) {
        state.ctrl.copy_from_slice(&self.held);
        if self.policy == Policy::Random {
            for (i, ctrl) in state.ctrl.iter_mut().enumerate() {
                let [low, high] = if model.actuator_ctrllimited[i] {
                    model.actuator_ctrlrange[i]
                } else {
                    [-1.0, 1.0]
                };
                *ctrl = self.rng.uniform_in(low, high);
            }
        }
    }
}

/// The arrays of the archive, for every step: the state at its start, and the quantities computed there.
#[derive(Default)]
struct Rows {
    time: Vec<f64>,
    qpos: Vec<f64>,
    qvel: Vec<f64>,
    act: Vec<f64>,
    ctrl: Vec<f64>,
    qacc: Vec<f64>,
    sensordata: Vec<f64>,
}

impl Rows {
    fn push(&mut self, time: f64, qpos: &[f64], qvel: &[f64], act: &[f64], state: &State) {
        self.time.push(time);
        for (to, from) in [
            (&mut self.qpos, qpos),
            (&mut self.qvel, qvel),
            (&mut self.act, act),
            (&mut self.ctrl, &state.ctrl),
            (&mut self.qacc, &state.qacc),
            (&mut self.sensordata, &state.sensordata),
        ] {
            to.extend_from_slice(from);
        }
    }

    fn write(&self, model: &Model, path: &Path) -> Result<(), Box<dyn Error>> {
        let n = self.time.len();
        let mut npz = NpzWriter::new();
        npz.add("time", &[n], &self.time)?;
        for (name, width, data) in [
            ("qpos", model.nq, &self.qpos),
            ("qvel", model.nv, &self.qvel),
            ("act", model.na, &self.act),
            ("ctrl", model.nu(), &self.ctrl),
            ("qacc", model.nv, &self.qacc),
            ("sensordata", model.nsensordata(), &self.sensordata),
        ] {
            npz.add(name, &[n, width], data)?;
        }
        Ok(npz.write(path)?)
    }
}

/// Returns the temporary path of a video, so that a failed run leaves an earlier video unchanged.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// A video of a run.
struct Film {
    renderer: Renderer,
    writer: AviWriter<BufWriter<File>>,
    camera: Option<usize>,
    free: FreeCamera,
    size: usize,
    rgb: Vec<u8>,
    /// Simulated time of the next picture, s.
    next: f64,
}

impl Film {
    fn new(arguments: &Simulate, path: &Path, model: &Model, assets: &FileSystem) -> Result<Self, Box<dyn Error>> {
        let camera = match &arguments.camera {
            None => None,
            Some(name) => Some(model.camera(name).ok_or_else(|| {
                let all = model.cam_name.join(", ");
                format!("--camera {name}: the model has no such camera; it has {all}")
            })?),
        };
        let size = arguments.size;
        let view = View {
            camera: View::FREE,
            width: size,
            height: size,
        };
        view.check()?;
        let file = File::create(unfinished(path)).map_err(|e| format!("{}: {e}", path.display()))?;
        let side = u32::try_from(size)?;
        Ok(Self {
            renderer: Renderer::cpu(Arc::new(Scenery::new(model, assets)?)),
            writer: AviWriter::new(BufWriter::new(file), side, side, FPS)?,
            camera,
            free: FreeCamera::of(model),
            size,
            rgb: vec![0; 3 * size * size],
            next: 0.0,
        })
    }

    /// Adds a picture of a state if it is time for one.
    fn picture(&mut self, state: &State) -> Result<(), Box<dyn Error>> {
        while state.time > self.next {
            let mut poses = Poses::from(state);
            poses.free = Some(self.free.pose()?);
            let view = View {
                camera: self.camera.unwrap_or(View::FREE),
                width: self.size,
                height: self.size,
            };
            self.renderer
                .rgb(&[RenderRequest { view, poses }], [&mut self.rgb[..]])?;
            self.writer.frame(&self.rgb)?;
            self.next += 1.0 / f64::from(FPS);
        }
        Ok(())
    }

    fn finish(self, path: &Path) -> Result<(), Box<dyn Error>> {
        let named = |e: std::io::Error| format!("{}: {e}", path.display());
        self.writer.into_inner().flush().map_err(named)?;
        Ok(fs::rename(unfinished(path), path).map_err(named)?)
    }
}
