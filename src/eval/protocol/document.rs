//! Reads a protocol from its YAML document and checks that its parts fit each other.

use std::path::PathBuf;

use super::entries::{measure, published};
use super::tree::{Entry, Fault, Node, fault, read};
use super::{Condition, Control, Fixture, FixtureKind, MeasureRule, Phase, Protocol, Yoke};
use crate::config::{Config, ConfigReader, MAX_AGE};
use crate::eval::movement::MovementOptions;
use crate::text::quoted;

/// Greatest numbers of trials and of parts of a phase, and the longest phase, s.
const MAX_TRIALS: u32 = 1000;
const MAX_PARTS: u32 = 100;
const MAX_SECONDS: f64 = 36_000.0;

impl Protocol {
    /// Parses a document. `file` names it in errors of the configuration, and `folder` is where paths of scenes in it start.
    pub(super) fn parse(name: &str, text: &str, file: &str, folder: PathBuf) -> Result<Self, Fault> {
        let root = read(text)?;
        let mut fields = root.fields("a protocol")?;
        let config = fields.need("config")?;
        let keys = flat(config, "config")?;
        let ages = fields.need("ages")?.numbers("ages")?;
        // some keys need an age; each run has its own
        let base = Config {
            age: ages.first().copied().filter(|age| (0.0..=MAX_AGE).contains(age)),
            ..Config::default()
        };
        let mut protocol = Self {
            name: name.to_string(),
            title: fields.need("title")?.text("title")?.to_string(),
            about: fields.words("about")?,
            config: configuration(base, &keys, file, folder.clone()).map_err(|reason| fault(config.line, reason))?,
            keys,
            ages,
            trials: fields.count("trials", MAX_TRIALS)?,
            phases: each(fields.need("phases")?, "phases", phase)?,
            fixture: fields.get("fixture").map(fixture).transpose()?,
            conditions: match fields.get("conditions") {
                Some(entry) => each(entry, "conditions", condition)?,
                None => vec![Condition::default()],
            },
            camera: camera(fields.get("camera"))?,
            measures: each(fields.need("measures")?, "measures", measure)?,
            published: each(fields.need("published")?, "published", published)?,
            text: text.to_string(),
            folder,
        };
        let line = fields.line();
        fields.end()?;
        protocol
            .published
            .iter_mut()
            .for_each(|row| row.place(&protocol.phases, &protocol.conditions));
        protocol.check().map_err(|reason| fault(line, reason))?;
        for condition in &protocol.conditions {
            protocol
                .configured(condition, "", None)
                .map_err(|error| fault(line, error.to_string()))?;
        }
        Ok(protocol)
    }

    /// Checks names that refer to other parts, and numbers.
    fn check(&self) -> Result<(), String> {
        if self.ages.is_empty() || self.ages.iter().any(|age| !(0.0..=MAX_AGE).contains(age)) {
            return Err(format!("`ages` are months from 0 to {MAX_AGE}, at least one"));
        }
        if self
            .ages
            .iter()
            .enumerate()
            .any(|(k, age)| self.ages[..k].contains(age))
        {
            return Err("`ages` has an age twice".to_string());
        }
        for (what, empty) in [
            ("phases", self.phases.is_empty()),
            ("measures", self.measures.is_empty()),
        ] {
            if empty {
                return Err(format!("`{what}` is empty"));
            }
        }
        self.camera.check().map_err(|error| format!("`camera`: {error}"))?;
        if self.fixture.is_some() && self.phases.len() != 1 {
            return Err("a fixture moves for one phase; this protocol has several".to_string());
        }
        self.check_measures()?;
        self.check_yokes()?;
        self.check_published()
    }

    fn has_phase(&self, name: &str) -> bool {
        self.phases.iter().any(|phase| phase.name == name)
    }

    fn condition(&self, name: &str) -> Option<usize> {
        self.conditions.iter().position(|condition| condition.name == name)
    }

    fn check_measures(&self) -> Result<(), String> {
        for measure in &self.measures {
            let base = match &measure.rule {
                MeasureRule::Ratio { over, .. } | MeasureRule::Reached { over, .. } => over,
                MeasureRule::Age { of, .. } if self.measure(of).is_none() => {
                    let name = &measure.name;
                    return Err(format!("`{name}` is the age of `{of}`, which is not a measure"));
                }
                _ => continue,
            };
            if !self.has_phase(base) {
                let name = &measure.name;
                return Err(format!("`{name}` compares with `{base}`, which is not a phase"));
            }
        }
        Ok(())
    }

    fn check_yokes(&self) -> Result<(), String> {
        for (at, condition) in self.conditions.iter().enumerate() {
            let Some(yoke) = &condition.yoke else {
                continue;
            };
            if self.condition(&yoke.to).is_none_or(|other| other >= at) || !self.has_phase(&yoke.phase) {
                return Err(format!(
                    "a condition is yoked to `{}` in `{}`; expected an earlier condition and a phase",
                    yoke.to, yoke.phase
                ));
            }
        }
        Ok(())
    }

    fn check_published(&self) -> Result<(), String> {
        for row in &self.published {
            let measure = row.measure.as_deref().filter(|name| self.measure(name).is_none());
            let phase = row.phase.as_deref().filter(|name| !self.has_phase(name));
            let condition = row.condition.as_deref().filter(|name| self.condition(name).is_none());
            if let Some(name) = measure.or(phase).or(condition) {
                let says = &row.says;
                return Err(format!(
                    "the published row \"{says}\" names `{name}`, which does not exist"
                ));
            }
        }
        Ok(())
    }
}

/// Reads a configuration from keys over a base.
pub(super) fn configuration(base: Config, keys: &str, file: &str, folder: PathBuf) -> Result<Config, String> {
    let reader = ConfigReader {
        folder,
        ..ConfigReader::over(base)
    };
    let text = if keys.is_empty() { "{}" } else { keys };
    reader.read_text(text, file).map_err(|error| error.to_string())
}

/// Reads each entry of a list.
fn each<T>(entry: &Entry, key: &'static str, one: impl Fn(&Entry) -> Result<T, Fault>) -> Result<Vec<T>, Fault> {
    entry.list(key)?.iter().map(one).collect()
}

/// Returns a mapping of the keys of a configuration as its text.
fn flat(entry: &Entry, key: &'static str) -> Result<String, Fault> {
    let Node::Map(entries) = &entry.node else {
        return Err(fault(
            entry.line,
            format!("`{key}` is a mapping of keys of a configuration"),
        ));
    };
    let mut out = String::new();
    for (name, value) in entries {
        let text = value.text(name)?;
        out.push_str(&format!("{name}: {text}\n"));
    }
    Ok(out)
}

fn phase(entry: &Entry) -> Result<Phase, Fault> {
    let mut fields = entry.fields("a phase")?;
    let seconds = fields.need("seconds")?;
    let phase = Phase {
        name: fields.need("name")?.text("name")?.to_string(),
        about: fields.words("about")?,
        seconds: seconds.number("seconds")?,
        parts: fields.count("parts", MAX_PARTS)?,
    };
    if !(phase.seconds > 0.0 && phase.seconds <= MAX_SECONDS) {
        return Err(fault(
            seconds.line,
            format!("`seconds` is above 0 and at most {MAX_SECONDS}"),
        ));
    }
    fields.end()?;
    Ok(phase)
}

fn fixture(entry: &Entry) -> Result<Fixture, Fault> {
    let mut fields = entry.fields("a fixture")?;
    let kind = fields.need("kind")?;
    let degrees = fields.need("degrees")?.number("degrees")?;
    let at = fields
        .get("at")
        .map(|entry| entry.numbers("at"))
        .transpose()?
        .unwrap_or_default();
    let gives_way = fields.number("gives_way")?;
    let fixture = Fixture {
        kind: match kind.text("kind")? {
            "pull" => FixtureKind::Pull,
            "tilt" => FixtureKind::Tilt,
            other => {
                let reason = format!("`kind` is {:?}; expected pull or tilt", quoted(other));
                return Err(fault(kind.line, reason));
            }
        },
        weld: fields.need("weld")?.text("weld")?.to_string(),
        degrees,
        joints: fields.need("joints")?.names("joints")?,
        at,
        gives_way,
    };
    if !(1.0..=180.0).contains(&degrees) || fixture.at.iter().any(|at| !(0.0..=degrees).contains(at)) {
        return Err(fault(
            entry.line,
            "`degrees` is 1 to 180, and every `at` lies within it",
        ));
    }
    fields.end()?;
    Ok(fixture)
}

fn condition(entry: &Entry) -> Result<Condition, Fault> {
    let mut fields = entry.fields("a condition")?;
    let condition = Condition {
        name: fields.need("name")?.text("name")?.to_string(),
        about: fields.words("about")?,
        keys: fields
            .get("keys")
            .map(|keys| flat(keys, "keys"))
            .transpose()?
            .unwrap_or_default(),
        controls: match fields.get("controls") {
            Some(entry) => each(entry, "controls", control)?,
            None => Vec::new(),
        },
        yoke: fields.get("yoke").map(yoke).transpose()?,
    };
    fields.end()?;
    Ok(condition)
}

fn control(entry: &Entry) -> Result<Control, Fault> {
    let mut fields = entry.fields("a control")?;
    let control = Control {
        actuator: fields.need("actuator")?.text("actuator")?.to_string(),
        joints: fields.need("joints")?.names("joints")?,
        gain: fields.need("gain")?.number("gain")?,
    };
    fields.end()?;
    Ok(control)
}

fn yoke(entry: &Entry) -> Result<Yoke, Fault> {
    let mut fields = entry.fields("a yoke")?;
    let yoke = Yoke {
        joint: fields.need("joint")?.text("joint")?.to_string(),
        to: fields.need("to")?.text("to")?.to_string(),
        phase: fields.need("phase")?.text("phase")?.to_string(),
    };
    fields.end()?;
    Ok(yoke)
}

fn camera(entry: Option<&Entry>) -> Result<MovementOptions, Fault> {
    let mut options = MovementOptions::default();
    let Some(entry) = entry else {
        return Ok(options);
    };
    let mut fields = entry.fields("a camera")?;
    options.fps = fields.number("fps")?.unwrap_or(options.fps);
    options.jitter = fields.number("jitter")?.unwrap_or(options.jitter);
    if let Some(band) = fields.get("band") {
        let found = band.numbers("band")?;
        options.band = <[f64; 2]>::try_from(found).map_err(|_| fault(band.line, "`band` has two frequencies, Hz"))?;
    }
    fields.end()?;
    Ok(options)
}
