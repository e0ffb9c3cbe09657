//! Records as lines of JSON, byte for byte as `InfoWithDetails` serializes them. A long log has millions of them, so names and small numbers,
//! their main contents, are formatted once.

use std::io;

use crate::env::{Info, InfoValue, PARTS, PartNames, RegardCounts, STEPS};
use crate::json;

/// A writer of lines.
pub(super) struct LineFormatter<'n> {
    names: Option<&'n PartNames>,
    /// Names of geoms as JSON, by geom, filled on demand.
    quoted: Vec<String>,
}

impl<'n> LineFormatter<'n> {
    /// Creates a writer of lines in which touched parts have names, if there are any.
    pub fn new(names: Option<&'n PartNames>) -> Self {
        let quoted = Vec::new();
        Self { names, quoted }
    }

    /// Appends the line of a record.
    ///
    /// # Errors
    /// As [`json::line`].
    pub fn line(&mut self, out: &mut Vec<u8>, info: &Info) -> io::Result<()> {
        let (names, mut before) = (self.names, "{\"");
        let mut begin = |out: &mut Vec<u8>, key: &str| {
            out.extend_from_slice(std::mem::replace(&mut before, ", \"").as_bytes());
            out.extend_from_slice(key.as_bytes());
            out.extend_from_slice(b"\": ");
        };
        for (key, value) in info.behavior.fields() {
            begin(out, key);
            match value {
                InfoValue::Count(count) => number(out, count),
                InfoValue::Geoms(geoms) => list(out, geoms, |out, geom| number(out, geom as u64)),
                other => {
                    json::line(out, &other)?;
                    // `json::line` ends with a line break
                    out.pop();
                }
            }
        }
        if let (Some(names), Some(touches)) = (names, info.behavior.touches()) {
            for (key, geoms) in PARTS.into_iter().zip(touches) {
                begin(out, key);
                list(out, geoms, |out, geom| self.name(out, geom, names));
            }
        }
        if let Some(RegardCounts { page, kit }) = info.details.regards {
            for (key, counts) in [("page_regards", page), ("kit_regards", kit)] {
                begin(out, key);
                json::line(out, &counts)?;
                out.pop();
            }
        }
        begin(out, STEPS);
        number(out, info.steps);
        out.extend_from_slice(b"}\n");
        Ok(())
    }

    fn name(&mut self, out: &mut Vec<u8>, geom: usize, names: &PartNames) {
        match self.quoted.get(geom) {
            Some(name) => out.extend_from_slice(name.as_bytes()),
            // only a few names are kept, even if a log has more numbers
            None if geom < KEPT => {
                let more = self.quoted.len()..=geom;
                self.quoted.extend(more.map(|geom| json::text(&&*names.get(geom))));
                self.name(out, geom, names);
            }
            None => out.extend_from_slice(json::text(&&*names.get(geom)).as_bytes()),
        }
    }
}

/// Number of geoms whose names are kept.
const KEPT: usize = 1000;

/// Appends a list.
fn list(out: &mut Vec<u8>, geoms: &[usize], mut item: impl FnMut(&mut Vec<u8>, usize)) {
    out.push(b'[');
    for (k, &geom) in geoms.iter().enumerate() {
        if k > 0 {
            out.extend_from_slice(b", ");
        }
        item(out, geom);
    }
    out.push(b']');
}

/// Appends a number.
fn number(out: &mut Vec<u8>, mut n: u64) {
    let (mut digits, mut first) = ([0; 20], 20);
    loop {
        first -= 1;
        digits[first] = b'0' + (n % 10) as u8;
        n /= 10;
        if n == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[first..]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::env::{BehaviorInfo, InfoDetails, InfoWithDetails, Outcome, PerHand, TaskInfo};

    #[test]
    fn lines_are_those_of_serde() {
        let blueprint = crate::Blueprint::new(crate::Config {
            touch_active: false,
            vision_active: false,
            ..crate::Config::default()
        });
        let names = PartNames::new(blueprint.expect("a scene").model());
        let touches = |right: &[usize], left: &[usize]| BehaviorInfo::SelfTouch {
            touches: PerHand {
                right_hand: right.to_vec(),
                left_hand: left.to_vec(),
            },
        };
        let task = TaskInfo {
            outcome: Outcome {
                is_success: true,
                is_failure: false,
            },
            episode_return: -0.1,
            task: "a \"task\"\u{7} of one's own".into(),
            ..TaskInfo::default()
        };
        let behaviors = [
            BehaviorInfo::None,
            touches(&[], &[]),
            touches(&[3, 0, 35, 7], &[12]),
            touches(&[], &[999, 1000, usize::MAX]),
            BehaviorInfo::HandRegard {
                counts: [0, 9, 10, u64::MAX].into(),
            },
            BehaviorInfo::Task(task),
        ];
        for names in [None, Some(&names)] {
            let mut maker = LineFormatter::new(names);
            for (steps, behavior) in [0, 1, 100, 12_345, u64::MAX, 7].into_iter().zip(behaviors.clone()) {
                let regards = behavior.regards().map(|counts| RegardCounts {
                    page: counts.into(),
                    kit: [1, 2, 3, 4].into(),
                });
                let mut details = InfoDetails {
                    regards,
                    ..InfoDetails::default()
                };
                let info = Info {
                    steps,
                    behavior,
                    details: details.clone(),
                };
                if let Some(names) = names {
                    details.name_parts(info.behavior.touches(), names);
                }
                let (mut line, mut expected) = (Vec::new(), Vec::new());
                maker.line(&mut line, &info).expect("a line");
                let details = Some(&details);
                json::line(&mut expected, &InfoWithDetails { info: &info, details }).expect("a line");
                assert_eq!(String::from_utf8(line), String::from_utf8(expected));
            }
        }
    }
}
