//! Key frames of an evaluation video: the moments at which something happened.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use babybench::env::{BehaviorInfo, EYE_HAND_PAIRS, Info, PartNames};
use babybench::files;
use babybench::runs::logs::EvaluationLog;

/// Frames in the page.
const FRAMES: usize = 8;
/// Largest frame, bytes.
const MAX_FRAME: u32 = 4 << 20;
/// Maximum number of chunks of a video that are read.
const MAX_CHUNKS: usize = 1 << 20;

/// A moment of an episode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct EpisodeMoment {
    /// Step, from 0.
    pub step: usize,
    /// The event.
    pub text: String,
}

/// Finds the moments of an episode worth a picture, in their order: the first touches of each part, or the starts of the longest looks at
/// a hand; then evenly spread moments up to the limit.
pub(super) fn moments(log: &EvaluationLog, names: Option<&PartNames>) -> Vec<EpisodeMoment> {
    let mut chosen = match log.info.first().map(|i| &i.behavior) {
        Some(BehaviorInfo::SelfTouch { .. }) => first_touches(&log.info, names),
        Some(BehaviorInfo::HandRegard { .. }) => looks(&log.info),
        _ => Vec::new(),
    };
    chosen.truncate(FRAMES);
    let last = log.len().saturating_sub(1);
    for k in 0..FRAMES {
        let step = last * k / (FRAMES - 1);
        let gap = (last / (2 * FRAMES)).max(1);
        if chosen.len() < FRAMES && chosen.iter().all(|m| m.step.abs_diff(step) >= gap) {
            let text = String::new();
            chosen.push(EpisodeMoment { step, text });
        }
    }
    chosen.sort_by_key(|m| m.step);
    chosen
}

fn first_touches(info: &[Info], names: Option<&PartNames>) -> Vec<EpisodeMoment> {
    let mut known = [0, 0];
    let mut out: Vec<EpisodeMoment> = Vec::new();
    for (step, touches) in info
        .iter()
        .map(|i| i.behavior.touches().unwrap_or_default())
        .enumerate()
    {
        for (hand, name) in ["right", "left"].into_iter().enumerate() {
            for &geom in touches[hand].get(known[hand]..).unwrap_or_default() {
                let part = names.map_or_else(|| format!("geom {geom}").into(), |n| n.get(geom));
                let text = format!("the {name} hand touches {}", part.replace('_', " "));
                match out.last_mut().filter(|m| m.step == step) {
                    Some(m) => m.text = format!("{}; {text}", m.text),
                    None => out.push(EpisodeMoment { step, text }),
                }
            }
            known[hand] = touches[hand].len();
        }
    }
    out
}

/// Finds the spans of steps in which an eye has a hand in view, the longest first.
fn looks(info: &[Info]) -> Vec<EpisodeMoment> {
    let counts: Vec<[u64; 4]> = info.iter().filter_map(|i| i.behavior.regards()).collect();
    let mut spans: Vec<(usize, usize, usize)> = Vec::new();
    for pair in 0..4 {
        let mut start = None;
        for k in 1..=counts.len() {
            let seen = k < counts.len() && counts[k][pair] > counts[k - 1][pair];
            match (seen, start) {
                (true, None) => start = Some(k),
                (false, Some(first)) => {
                    spans.push((k - first, first + (k - first) / 2, pair));
                    start = None;
                }
                _ => {}
            }
        }
    }
    spans.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut out: Vec<EpisodeMoment> = Vec::new();
    for (length, step, pair) in spans {
        let name = EYE_HAND_PAIRS[pair]
            .replacen("eye_", "eye on the ", 1)
            .replace('_', " ");
        let text = format!("{name} ({length} steps)");
        match out.iter_mut().find(|m| m.step.abs_diff(step) < 5) {
            Some(m) if m.text.matches(';').count() < 1 => m.text = format!("{}; {text}", m.text),
            Some(_) => {}
            None => out.push(EpisodeMoment { step, text }),
        }
    }
    out
}

/// Reads frames of a Motion-JPEG video in an `.avi` file by number. Missing ones are left out: the file may be cut off or still be
/// growing.
///
/// # Errors
/// The file cannot be read, is not an `.avi` file or has another encoding.
pub(super) fn frames(path: &Path, numbers: &[usize]) -> io::Result<Vec<(usize, Vec<u8>)>> {
    let broken = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what.to_string());
    let mut file = io::BufReader::new(files::open(path)?);
    let mut head = [0; 12];
    let whole = file.read_exact(&mut head).is_ok();
    if !whole || &head[..4] != b"RIFF" || &head[8..] != b"AVI " {
        return Err(broken("not an .avi file"));
    }
    let (mut out, mut frame) = (Vec::new(), 0);
    for _ in 0..MAX_CHUNKS {
        let mut head = [0; 8];
        if file.read_exact(&mut head).is_err() {
            break;
        }
        let [a, b, c, d, size @ ..] = head;
        let size = u32::from_le_bytes(size);
        let padded = i64::from(size) + i64::from(size % 2);
        match &[a, b, c, d] {
            b"LIST" => {
                let mut kind = [0; 4];
                if file.read_exact(&mut kind).is_err() {
                    break;
                }
                if &kind != b"movi" {
                    file.seek_relative(padded - 4)?;
                }
            }
            b"00dc" | b"00db" => {
                if numbers.contains(&frame) && size <= MAX_FRAME {
                    let mut data = vec![0; size as usize];
                    if file.read_exact(&mut data).is_err() {
                        break;
                    }
                    if !data.starts_with(&[0xff, 0xd8]) {
                        return Err(broken("the video is not Motion-JPEG"));
                    }
                    out.push((frame, data));
                    file.seek_relative(i64::from(size % 2))?;
                } else {
                    file.seek_relative(padded)?;
                }
                frame += 1;
            }
            b"idx1" => break,
            _ => {
                file.seek(SeekFrom::Current(padded))?;
            }
        }
    }
    match frame {
        0 => Err(broken("the video has no frames")),
        _ => Ok(out),
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    fn touch(right: &[usize], left: &[usize]) -> Info {
        Info {
            behavior: BehaviorInfo::SelfTouch {
                touches: babybench::env::PerHand {
                    right_hand: right.to_vec(),
                    left_hand: left.to_vec(),
                },
            },
            ..Info::default()
        }
    }

    fn log(info: Vec<Info>) -> EvaluationLog {
        EvaluationLog {
            nq: 1,
            qpos: vec![0.0; info.len()],
            info,
        }
    }

    #[test]
    fn first_touches_are_moments() {
        let mut info = vec![touch(&[], &[]); 40];
        info.extend(vec![touch(&[5], &[]); 30]);
        info.extend(vec![touch(&[5, 7], &[6]); 30]);
        let moments = moments(&log(info), None);
        assert_eq!(moments.len(), FRAMES);
        let told: Vec<_> = moments.iter().filter(|m| !m.text.is_empty()).collect();
        assert_eq!((told[0].step, &*told[0].text), (40, "the right hand touches geom 5"));
        let both = "the right hand touches geom 7; the left hand touches geom 6";
        assert_eq!((told[1].step, &*told[1].text), (70, both));
        assert!(moments.windows(2).all(|m| m[0].step < m[1].step));
    }

    #[test]
    fn long_looks_are_moments() {
        let counts = |k: u64| BehaviorInfo::HandRegard {
            counts: [0, k.clamp(20, 50) - 20, k.clamp(70, 75) - 70, 0].into(),
        };
        let info = (0..100).map(|k| Info {
            behavior: counts(k),
            ..Info::default()
        });
        let moments = moments(&log(info.collect()), None);
        let told: Vec<_> = moments.iter().filter(|m| !m.text.is_empty()).collect();
        assert_eq!(told[0].text, "right eye on the left hand (30 steps)");
        assert_eq!(told[0].step, 36);
        assert_eq!(told[1].text, "left eye on the right hand (5 steps)");
    }

    #[test]
    fn short_episodes_have_few_moments() {
        assert!(moments(&log(Vec::new()), None).len() <= 1);
        assert_eq!(moments(&log(vec![touch(&[], &[]); 3]), None).len(), 3);
    }

    #[test]
    fn frames_come_out_as_they_went_in() {
        let folder = std::env::temp_dir().join(format!("babybench_strip_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("a.avi");
        let mut avi =
            babybench::formats::avi::AviWriter::new(std::fs::File::create(&path).expect("a file"), 16, 16, 60)
                .expect("a video");
        for k in 0..6_u8 {
            avi.frame(&[40 * k; 3 * 256]).expect("a frame");
        }
        drop(avi);
        let found = frames(&path, &[1, 4, 9]).expect("frames");
        assert_eq!(found.iter().map(|f| f.0).collect::<Vec<_>>(), [1, 4]);
        for (k, jpeg) in &found {
            let image = image::load_from_memory(jpeg).expect("an image").to_rgb8();
            assert!(image.get_pixel(8, 8).0[0].abs_diff(40 * *k as u8) < 4);
        }
        let whole = std::fs::read(&path).expect("a video");
        for n in 0..whole.len() {
            std::fs::write(&path, &whole[..n]).expect("a file");
            if let Ok(found) = frames(&path, &[0, 5]) {
                assert!(
                    found.iter().all(|(_, jpeg)| jpeg.starts_with(&[0xff, 0xd8])),
                    "{n} bytes"
                );
            }
        }
        std::fs::write(&path, b"no video at all").expect("a file");
        assert!(frames(&path, &[0]).is_err());
        std::fs::remove_dir_all(&folder).expect("the folder was made");
    }
}
