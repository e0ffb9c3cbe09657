//! Seeded damage to text and bytes, so that failures can be repeated.

mod document;

use fastrand::Rng;

pub use document::{generate, mutate as mutate_document};

/// Words of MJCF, YAML, JSON or XML, for use in wrong places.
pub const WORDS: &[&[u8]] = &[
    b"nan",
    b"-1",
    b"1e308",
    b"-1e308",
    b"1e999",
    b"1e-320",
    b"0",
    b"",
    b"<",
    b">",
    b"\"",
    b"'",
    b"&",
    b"/>",
    b"<!--",
    b"-->",
    b"<body>",
    b"</body>",
    b"99999999999999999999",
    b"\x00",
    b"\xff\x00",
    "\u{fffd}".as_bytes(),
    b"<include file=\"m.xml\"/>",
    b"<default>",
    b"auto",
    b"\n",
    b"<!DOCTYPE",
    b": ",
    b"- ",
    b"{",
    b"]",
    b"!",
    b"*",
    b"#",
    b"\t",
];

/// Returns a copy of `bytes` with up to four pieces of it changed, removed, doubled or replaced by one of `words`.
pub fn mutate(bytes: &[u8], words: &[&[u8]], rng: &mut Rng) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..rng.usize(1..=4) {
        mutate_once(&mut out, words, rng);
    }
    out
}

/// Returns a mutation of a text, in which invalid UTF-8 becomes U+FFFD.
pub fn mutate_text(text: &str, rng: &mut Rng) -> String {
    String::from_utf8_lossy(&mutate(text.as_bytes(), WORDS, rng)).into_owned()
}

fn mutate_once(out: &mut Vec<u8>, words: &[&[u8]], rng: &mut Rng) {
    if out.is_empty() {
        out.push(rng.u8(..));
        return;
    }
    let at = rng.usize(..out.len());
    let end = (at + rng.usize(..12)).min(out.len());
    let word = |rng: &mut Rng| words[rng.usize(..words.len())].iter().copied();
    match rng.u32(..12) {
        0 => out[at] ^= 1 << rng.u32(..8),
        1 => out[at] = rng.u8(..),
        2 => out.truncate(at),
        3 => drop(out.drain(at..end)),
        4 => drop(out.splice(at..end, word(rng))),
        5 => drop(out.splice(at..at, word(rng))),
        // a quoted value changes, which passes the syntax
        6 | 7 => {
            let quotes: Vec<usize> = (at..out.len()).filter(|&k| out[k] == b'"').take(2).collect();
            if let [from, to] = quotes[..] {
                drop(out.splice(from + 1..to, word(rng)));
            }
        }
        8 => {
            let piece = out[at..end].to_vec();
            let to = rng.usize(..out.len());
            drop(out.splice(to..to, piece));
        }
        // another digit, which mostly gets past every check of form
        _ => {
            if let Some(digit) = out[at..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                *digit = b'0' + rng.u8(..10);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mutations_repeat_with_their_seed_and_differ_without() {
        let text = "<a b=\"1 2\"><c d=\"3\"/></a>";
        let many = |seed: u64| -> Vec<String> {
            let mut rng = Rng::with_seed(seed);
            (0..200).map(|_| mutate_text(text, &mut rng)).collect()
        };
        assert_eq!(many(1), many(1));
        assert_ne!(many(1), many(2));
        let changed = many(1).iter().filter(|t| *t != text).count();
        assert!(changed > 180, "{changed} of 200 differ from the text");
    }
}
