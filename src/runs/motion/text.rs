//! Motions as tables of text.

use std::path::Path;

use super::{Motion, MotionError};
use crate::limits::Limits;
use crate::text::quoted;

/// The columns of the root: position, m, and quaternion.
const ROOT: [&str; 7] = ["root_x", "root_y", "root_z", "root_qw", "root_qx", "root_qy", "root_qz"];
/// Columns that a table may have.
const COLUMNS: usize = 10_000;
/// Tolerance of a time against even spacing, as a share of the spacing.
const UNEVEN: f64 = 0.1;

/// The targets of the columns of a table.
struct ColumnTargets {
    /// For each column except the time: joint, or index in [`ROOT`].
    place: Vec<Result<usize, usize>>,
    names: Vec<String>,
    rooted: bool,
}

/// Parses a table: a line of names, then a line for each frame.
pub(super) fn parse(path: &Path, bytes: &[u8], degrees: bool, limits: &Limits) -> Result<Motion, MotionError> {
    let fault = |line: usize, reason: String| MotionError::Line {
        path: path.to_path_buf(),
        line: line + 1,
        reason,
    };
    let text = std::str::from_utf8(bytes).map_err(|e| fault(0, format!("no text in UTF-8: {e}")))?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (at, head) = lines.next().ok_or_else(|| fault(0, "the table is empty".to_string()))?;
    let columns = ColumnTargets::of(head).map_err(|reason| fault(at, reason))?;
    let scale = if degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
    let (mut times, mut angles, mut root) = (Vec::new(), Vec::new(), Vec::new());
    let joints = columns.names.len();
    for (at, line) in lines {
        let mut row = vec![0.0; joints];
        let mut pose = [0.0; 7];
        let mut cells = line.split(',');
        times.push(number(cells.next().unwrap_or_default()).map_err(|reason| fault(at, reason))?);
        let mut found = 0;
        // in this order no cell beyond the last column is read
        for (place, cell) in columns.place.iter().zip(cells.by_ref()) {
            let value = number(cell).map_err(|reason| fault(at, reason))?;
            match *place {
                Ok(joint) => row[joint] = value * scale,
                Err(part) => pose[part] = value,
            }
            found += 1;
        }
        if found != columns.place.len() || cells.next().is_some() {
            let (found, expected) = (line.split(',').count(), columns.place.len() + 1);
            return Err(fault(
                at,
                format!("{found} cells, where the first line has {expected} names"),
            ));
        }
        // row by row, so that a long table is refused before it fills the memory
        if angles.len() + joints + 7 > limits.motion_numbers {
            let most = limits.motion_numbers;
            return Err(fault(at, format!("more numbers than the limit motion_numbers, {most}")));
        }
        angles.extend(row);
        if columns.rooted {
            let [x, y, z, w, a, b, c] = pose;
            root.push(([x, y, z], [w, a, b, c]));
        }
    }
    let rate = rate(&times).map_err(MotionError::Unfit)?;
    Motion::new_with(columns.names, rate, angles, columns.rooted.then_some(root), limits)
}

impl ColumnTargets {
    /// Reads the line of names.
    fn of(head: &str) -> Result<Self, String> {
        let mut cells = head.split(',').map(|cell| cell.trim().trim_matches('"'));
        let first = cells.next().unwrap_or_default();
        if first != "time" {
            return Err(format!("the first column is {}; expected time, in s", quoted(first)));
        }
        let (mut place, mut names, mut seen) = (Vec::new(), Vec::new(), [false; 7]);
        for cell in cells {
            if place.len() >= COLUMNS {
                return Err(format!("more than {COLUMNS} columns"));
            }
            place.push(match ROOT.iter().position(|name| *name == cell) {
                Some(part) if std::mem::replace(&mut seen[part], true) => return Err(format!("{cell} appears twice")),
                Some(part) => Err(part),
                None => {
                    names.push(cell.to_string());
                    Ok(names.len() - 1)
                }
            });
        }
        let rooted = seen.contains(&true);
        if let Some(missing) = seen.iter().position(|seen| rooted && !seen) {
            return Err(format!("the root has no column {}", ROOT[missing]));
        }
        Ok(Self { place, names, rooted })
    }
}

/// Parses a number.
fn number(cell: &str) -> Result<f64, String> {
    let cell = cell.trim().trim_matches('"');
    cell.parse().map_err(|_| format!("{} is not a number", quoted(cell)))
}

/// Returns the number of frames per second.
fn rate(times: &[f64]) -> Result<f64, String> {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return Err("the motion has no frames".to_string());
    };
    if times.len() == 1 {
        // a single pose has no duration
        return Ok(1.0);
    }
    let each = (last - first) / (times.len() - 1) as f64;
    if !(each > 0.0 && each.is_finite()) {
        return Err(format!("times go from {first} to {last} s; expected ascending times"));
    }
    let off = |(k, &t): (usize, &f64)| t.is_nan() || (t - (first + k as f64 * each)).abs() > UNEVEN * each;
    if let Some((frame, t)) = times.iter().enumerate().find(|&(k, t)| off((k, t))) {
        return Err(format!(
            "frame {frame} is at {t} s, where equal distances of {each} s put it at {} s: resample the motion",
            first + frame as f64 * each
        ));
    }
    Ok(1.0 / each)
}
