//! Paths of bodies that a document marks with `mocap="true"`, such as a hand that comes and goes.

use thiserror::Error;

use crate::math::{Quat, Vec3, quat_normalize};
use crate::model::Model;
use crate::physics::State;
use crate::text::quoted;

/// Values of a pose.
const VALUES: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];

/// An error in the key [`mocap_motion`](crate::Config::mocap_motion).
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("mocap_motion, line {line}: {reason}")]
pub struct PathError {
    /// The line, from 1.
    pub line: usize,
    /// Description of the fault.
    pub reason: String,
}

/// Poses of bodies over time.
#[derive(Debug, PartialEq)]
pub(crate) struct Paths {
    /// The times of the poses, s, ascending. The first is the start of an episode.
    times: Vec<f64>,
    bodies: Vec<BodyPath>,
}

#[derive(Debug, PartialEq)]
struct BodyPath {
    /// Its number among the mocap bodies.
    mocap: usize,
    pos: Vec<Vec3>,
    /// Orientations; empty if the text has none.
    quat: Vec<Quat>,
}

/// The columns of a body's values in the text.
struct BodyColumns<'a> {
    body: &'a str,
    mocap: usize,
    places: [Option<usize>; 7],
}

impl Paths {
    /// Reads paths: a line of names, `time` and `BODY.x`, `BODY.y`, `BODY.z`, with or without `BODY.qw` to `BODY.qz`, then a line of
    /// numbers for each time. An empty text has no paths.
    pub fn new(text: &str, model: &Model) -> Result<Option<Self>, PathError> {
        let lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
        let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let Some((line, head)) = lines.next() else {
            return Ok(None);
        };
        let fault = |line, reason| PathError { line, reason };
        let names: Vec<&str> = head.split(',').map(str::trim).collect();
        let columns = columns(&names, model).map_err(|reason| fault(line, reason))?;
        let mut times = Vec::new();
        let mut bodies: Vec<BodyPath> = columns.iter().map(BodyPath::of).collect();
        for (line, row) in lines {
            let values = numbers(row, names.len()).map_err(|reason| fault(line, reason))?;
            // from the first time on, whatever it is
            let time = values[0];
            match times.last() {
                Some(last) if time <= *last => {
                    let reason = format!("the time is {time}, after {last}: times must ascend");
                    return Err(fault(line, reason));
                }
                _ => times.push(time),
            }
            for (path, columns) in bodies.iter_mut().zip(&columns) {
                path.push(columns, &values).map_err(|reason| fault(line, reason))?;
            }
        }
        let Some(&first) = times.first() else {
            return Err(fault(line, "there are no poses below the names".to_owned()));
        };
        times.iter_mut().for_each(|time| *time -= first);
        Ok(Some(Self { times, bodies }))
    }

    /// Moves the bodies to their poses at the time of a state. After their last time the paths start again.
    pub fn place(&self, state: &mut State) {
        let (before, share) = self.moment(state.time);
        let after = (before + 1).min(self.times.len() - 1);
        for path in &self.bodies {
            let (a, b) = (path.pos[before], path.pos[after]);
            state.mocap_pos[path.mocap] = [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]));
            if let (Some(a), Some(b)) = (path.quat.get(before), path.quat.get(after)) {
                // the shorter way, because both signs are the same orientation
                let along: f64 = (0..4).map(|k| a[k] * b[k]).sum();
                let sign = if along < 0.0 { -1.0 } else { 1.0 };
                let mixed = [0, 1, 2, 3].map(|k| a[k] + share * (sign * b[k] - a[k]));
                state.mocap_quat[path.mocap] = quat_normalize(mixed);
            }
        }
    }

    /// Returns the index of the last time before a time, and the elapsed share of the interval to the next.
    fn moment(&self, time: f64) -> (usize, f64) {
        let last = self.times.len() - 1;
        // a single pose lasts no time, and a remainder by 0 is NaN
        if last == 0 {
            return (0, 0.0);
        }
        let time = time % self.times[last];
        let after = self.times.partition_point(|t| *t <= time).clamp(1, last);
        let (from, to) = (self.times[after - 1], self.times[after]);
        (after - 1, (time - from) / (to - from))
    }
}

impl BodyPath {
    fn of(columns: &BodyColumns) -> Self {
        Self {
            mocap: columns.mocap,
            pos: Vec::new(),
            quat: Vec::new(),
        }
    }

    fn push(&mut self, columns: &BodyColumns, values: &[f64]) -> Result<(), String> {
        let [x, y, z, rest @ ..] = columns.places.map(|place| place.map(|place| values[place]));
        let zero = |value: Option<f64>| value.unwrap_or_default();
        self.pos.push([x, y, z].map(zero));
        if rest.iter().all(Option::is_some) {
            let quat = rest.map(zero);
            if quat.iter().map(|v| v * v).sum::<f64>() < 1e-12 {
                return Err(format!("the orientation of \"{}\" is zero", quoted(columns.body)));
            }
            self.quat.push(quat_normalize(quat));
        }
        Ok(())
    }
}

/// Finds the columns of each body.
fn columns<'a>(names: &[&'a str], model: &Model) -> Result<Vec<BodyColumns<'a>>, String> {
    if names.first() != Some(&"time") {
        let found = quoted(names.first().copied().unwrap_or_default());
        return Err(format!(
            "the first name is \"{found}\": expected time, then BODY.x, BODY.y and BODY.z"
        ));
    }
    let mut all: Vec<BodyColumns> = Vec::new();
    for (place, name) in names.iter().enumerate().skip(1) {
        let split = name.rsplit_once('.');
        let value = split.and_then(|(_, value)| VALUES.iter().position(|known| *known == value));
        let (Some((body, _)), Some(value)) = (split, value) else {
            let known = VALUES.join(", ");
            return Err(format!(
                "\"{}\": expected the name of a body, a point, and one of {known}",
                quoted(name)
            ));
        };
        let k = match all.iter().position(|columns| columns.body == body) {
            Some(k) => k,
            None => {
                let (mocap, places) = (mocap(body, model)?, [None; 7]);
                all.push(BodyColumns { body, mocap, places });
                all.len() - 1
            }
        };
        if all[k].places[value].replace(place).is_some() {
            return Err(format!("\"{}\" appears twice", quoted(name)));
        }
    }
    for columns in &all {
        let given = columns.places.map(|place| place.is_some());
        if given[..3] != [true; 3] || (given[3..] != [true; 4] && given[3..] != [false; 4]) {
            let body = quoted(columns.body);
            return Err(format!(
                "\"{body}\" needs x, y and z, and of qw, qx, qy and qz all or none"
            ));
        }
    }
    Ok(all)
}

/// Returns the number of a body among the mocap bodies.
fn mocap(body: &str, model: &Model) -> Result<usize, String> {
    let found = model.body(body).and_then(|id| model.body_mocapid[id]);
    found.ok_or_else(|| {
        let known = (0..model.nbody()).filter(|id| model.body_mocapid[*id].is_some());
        let known: Vec<String> = known
            .map(|id| format!("\"{}\"", quoted(&model.body_name[id])))
            .collect();
        let known = if known.is_empty() {
            "none; add one, such as scene_extra: <body name=\"hand\" mocap=\"true\">...</body>".to_owned()
        } else {
            known.join(", ")
        };
        format!(
            "the scene has no body \"{}\" with mocap=\"true\"; there are: {known}",
            quoted(body)
        )
    })
}

fn numbers(row: &str, expected: usize) -> Result<Vec<f64>, String> {
    let cells: Vec<&str> = row.split(',').map(str::trim).collect();
    if cells.len() != expected {
        return Err(format!("{} numbers for {expected} names", cells.len()));
    }
    let read = |cell: &&str| {
        let number = cell.parse::<f64>().ok().filter(|v| v.abs() <= 1e10);
        number.ok_or_else(|| format!("\"{}\" is not a number of at most 1e10", quoted(cell)))
    };
    cells.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::Paths;
    use crate::Model;
    use crate::assets::MemoryAssets;
    use crate::mjcf_loader::load_str;
    use crate::physics::{Engine, SoftEngine, SoftOptions, State, compile};

    fn model() -> Arc<Model> {
        let text = r#"<mujoco><worldbody>
            <body name="still"><geom size="1"/></body>
            <body name="hand" mocap="true" pos="1 2 3"><geom size="1"/></body>
            <body name="other" mocap="true"/>
        </worldbody></mujoco>"#;
        compiled(text)
    }

    fn compiled(text: &str) -> Arc<Model> {
        let model = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
        Arc::new(model.expect("compiles"))
    }

    fn state(model: &Arc<Model>) -> State {
        SoftEngine::new(model.clone(), SoftOptions::default()).new_state()
    }

    #[test]
    fn bodies_go_in_straight_lines_and_turn_the_shorter_way_again_and_again() {
        let model = model();
        let text = "# to and fro\ntime, hand.x, hand.y, hand.z, other.z, other.x, other.y, other.qw, other.qx, other.qy, other.qz\n
            5, 0, 0, 0,  1, 0, 0,  1, 0, 0, 0\n 7, 2, 0, 4,  1, 0, 0,  0, 0, -3, 0\n\n 8, 0, 0, 0,  1, 0, 0,  -1, 0, 0, 0\n";
        let paths = Paths::new(text, &model).expect("paths").expect("some");
        let mut state = state(&model);
        let mut at = |time: f64| {
            state.time = time;
            paths.place(&mut state);
            (state.mocap_pos.clone(), state.mocap_quat[1])
        };
        assert_eq!(at(0.0).0, [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(at(0.5).0[0], [0.5, 0.0, 1.0]);
        assert_eq!(at(2.5).0[0], [1.0, 0.0, 2.0]);
        let half = 0.5_f64.sqrt();
        let turned = at(1.0).1;
        assert!(
            (turned[0] - half).abs() < 1e-15 && (turned[2] + half).abs() < 1e-15,
            "{turned:?}"
        );
        // from the end to the start, which is the same orientation with the other sign
        let turned = at(2.5).1;
        assert!((turned[0].abs() - half).abs() < 1e-15, "{turned:?}");
        assert_eq!(at(3.0), at(0.0));
        assert_eq!(at(302.5).0[0], [1.0, 0.0, 2.0]);
    }

    #[test]
    fn one_pose_is_a_place_and_no_text_is_nothing() {
        let model = model();
        let mut state = state(&model);
        let paths = Paths::new("time,hand.x,hand.y,hand.z\n0,7,8,9", &model).expect("paths");
        state.time = 3.0;
        paths.expect("some").place(&mut state);
        assert_eq!(state.mocap_pos[0], [7.0, 8.0, 9.0]);
        assert_eq!(state.mocap_quat[0], [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(Paths::new("\n# nothing\n", &model), Ok(None));
    }

    #[test]
    fn faults_are_told_with_their_line() {
        let model = model();
        let head = "time,hand.x,hand.y,hand.z";
        for (text, expected) in [
            (
                "hand.x".to_owned(),
                "line 1: the first name is \"hand.x\": expected time",
            ),
            (
                "time,hand.w".to_owned(),
                "line 1: \"hand.w\": expected the name of a body",
            ),
            ("time,hand".to_owned(), "line 1: \"hand\": expected the name of a body"),
            (
                "time,still.x".to_owned(),
                "no body \"still\" with mocap=\"true\"; there are: \"hand\", \"other\"",
            ),
            ("time,hand.x,hand.x".to_owned(), "\"hand.x\" appears twice"),
            ("time,hand.x,hand.y".to_owned(), "\"hand\" needs x, y and z"),
            (format!("{head},hand.qw"), "of qw, qx, qy and qz all or none"),
            (format!("\n{head}\n"), "line 2: there are no poses"),
            (format!("{head}\n0,1,2"), "line 2: 3 numbers for 4 names"),
            (
                format!("{head}\n0,1,2,nan"),
                "line 2: \"nan\" is not a number of at most 1e10",
            ),
            (format!("{head}\n0,1,2,1e300"), "is not a number of at most 1e10"),
            (format!("{head}\n0,1,2,3\n\n0,1,2,3"), "line 4: the time is 0, after 0"),
            (
                format!("{head},hand.qw,hand.qx,hand.qy,hand.qz\n0,1,2,3,0,0,0,0"),
                "the orientation of \"hand\" is zero",
            ),
        ] {
            let error = Paths::new(&text, &model).expect_err(&text).to_string();
            assert!(
                error.starts_with("mocap_motion, ") && error.contains(expected),
                "{error}"
            );
        }
        let empty = compiled("<mujoco/>");
        let error = Paths::new(head, &empty).expect_err("no body").to_string();
        assert!(error.contains("there are: none; add one"), "{error}");
    }
}
