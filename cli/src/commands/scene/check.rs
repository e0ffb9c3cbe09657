//! `babybench scene check`

use std::error::Error;
use std::io::{self, Write, stdout};
use std::path::PathBuf;

use babybench::config::Scene;
use babybench::mimo::{MimoBodies, Version, embedded, unused_attributes};
use babybench::physics::collision::PairTable;
use babybench::{Blueprint, Config, Env, Model};
use clap::Args;

/// Depth above which bodies fly apart, m.
const DEEP: f64 = 0.005;

/// Arguments of `scene check`.
#[derive(Args)]
pub struct Check {
    /// The document (.xml), or a configuration (.yml) whose scene it is
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

impl Check {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let config = self.config()?;
        let blueprint = Blueprint::new(config)?;
        blueprint.scenery()?;
        let mut env = blueprint.env()?;
        let mut out = stdout().lock();
        write_sizes(&mut out, &env)?;
        write_reach(&mut out, &env)?;
        let still = vec![0.0; blueprint.model().nv];
        env.by_hand().reset_to(&blueprint.model().qpos0, &still)?;
        write_contacts(&mut out, &env)?;
        let unused = unused_attributes(blueprint.config(), &embedded())?;
        writeln!(out, "\nWithout effect here")?;
        for one in &unused {
            writeln!(out, "  {}: {}: {}", one.place, one.attribute, one.meaning)?;
        }
        if unused.is_empty() {
            writeln!(out, "  nothing")?;
        }
        Ok(())
    }

    /// Returns the configuration that the file is, or the default one for a document.
    fn config(&self) -> Result<Config, Box<dyn Error>> {
        let Some(path) = self.file.to_str().filter(|path| path.ends_with(Scene::ENDING)) else {
            return Ok(Config::from_file(&self.file)?);
        };
        Ok(Config {
            scene: Scene::File(path.to_string()),
            ..Config::default()
        })
    }
}

/// Writes the number of elements of each kind, and how many are MIMo's.
fn write_sizes(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let (config, model) = (env.config(), env.model());
    let mimo = MimoBodies::of(model);
    let own = |carriers: &[usize]| carriers.iter().filter(|&&body| mimo.contains(body)).count();
    let all: Vec<usize> = (0..model.nbody()).collect();
    writeln!(
        out,
        "{}: MIMo {} for behavior {}, actuation {}",
        config.scene,
        Version::label(config),
        config.behavior,
        config.actuation_model
    )?;
    writeln!(out, "\n{:12} {:>5} {:>7}", "", "all", "MIMo's")?;
    for (what, all, own) in [
        ("bodies", model.nbody(), own(&all)),
        ("joints", model.njnt(), own(&model.jnt_bodyid)),
        ("geoms", model.ngeom(), own(&model.geom_bodyid)),
        ("actuators", model.nu(), mimo.actuators().len()),
        ("sensors", model.nsensor(), mimo.sensors().len()),
        ("cameras", model.ncam(), own(&model.cam_bodyid)),
    ] {
        writeln!(out, "{what:12} {all:>5} {own:>7}")?;
    }
    writeln!(
        out,
        "degrees of freedom {}, lights {}, mass of all bodies {:.3} kg",
        model.nv,
        model.lights.len(),
        model.body_mass.iter().sum::<f64>()
    )?;
    let cameras: Vec<&str> = model.cam_name.iter().map(String::as_str).collect();
    writeln!(out, "cameras: {}", cameras.join(", "))
}

/// Writes what MIMo may touch.
fn write_reach(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let model = env.model();
    let mimo = MimoBodies::of(model);
    let own = |g: usize| mimo.contains(model.geom_bodyid[g]);
    let pairs = PairTable::new(model);
    writeln!(out, "\nMIMo may touch")?;
    let mut none = true;
    for other in (0..model.ngeom()).filter(|&g| !own(g)) {
        let (mut parts, mut all) = (0, 0);
        for part in (0..model.ngeom()).filter(|&g| own(g)) {
            all += 1;
            parts += usize::from(pairs.may_touch(part.min(other), part.max(other)));
        }
        if parts > 0 {
            none = false;
            let with = if parts == all {
                "all".to_string()
            } else {
                format!("{parts} of {all}")
            };
            writeln!(out, "  {} with {with} of his geoms", named(model, other))?;
        }
    }
    if none {
        writeln!(
            out,
            "  nothing: contype and conaffinity of all other geoms keep them apart"
        )?;
    }
    Ok(())
}

/// Writes what overlaps at the start, before the scene settles. MIMo's own parts always overlap slightly.
fn write_contacts(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let model = env.model();
    let mimo = MimoBodies::of(model);
    let own = |g: usize| mimo.contains(model.geom_bodyid[g]);
    let mut deep: Vec<([usize; 2], f64)> = Vec::new();
    for c in env
        .state()
        .contact
        .iter()
        .filter(|c| !c.geom.iter().all(|&g| own(g)) && c.dist < 0.0)
    {
        match deep.iter_mut().find(|(geoms, _)| *geoms == c.geom) {
            Some((_, depth)) => *depth = depth.max(-c.dist),
            None => deep.push((c.geom, -c.dist)),
        }
    }
    deep.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    writeln!(out, "\nOverlaps at the start")?;
    for ([a, b], depth) in &deep {
        let advice = if *depth > DEEP {
            ": they will fly apart; move one of them"
        } else {
            ""
        };
        let (a, b) = (named(model, *a), named(model, *b));
        writeln!(out, "  {a} and {b}, {:.2} mm{advice}", 1e3 * depth)?;
    }
    if deep.is_empty() {
        writeln!(out, "  nothing")?;
    }
    Ok(())
}

/// Names a geom by its body, and by its own name if it has one.
fn named(model: &Model, geom: usize) -> String {
    let body = &model.body_name[model.geom_bodyid[geom]];
    match model.geom_name[geom].as_str() {
        "" => format!("geom {geom} of body {body:?}"),
        name => format!("{name:?} of body {body:?}"),
    }
}
