//! Text from outside, as messages quote it.

use std::fmt::Write as _;

/// Greatest number of characters that a message quotes of a text.
const QUOTED: usize = 200;

/// Returns a text as a message may show it: on one line, without control characters, and cut after 200 characters, with
/// its length.
pub fn quoted(text: &str) -> String {
    let mut out = String::new();
    let mut characters = text.chars();
    for c in characters.by_ref().take(QUOTED) {
        if c.is_control() || is_format(c) {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    if characters.next().is_some() {
        // writing to a string cannot fail
        let _ = write!(out, "... ({} bytes)", text.len());
    }
    out
}

/// Returns whether a character changes the direction or the order of others, or is not seen.
fn is_format(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_are_short_and_harmless() {
        assert_eq!(quoted("right_hand é \"1\""), "right_hand é \"1\"");
        assert_eq!(quoted("\u{1b}[2J\n\u{9b}1m\u{202e}"), "\\u{1b}[2J\\n\\u{9b}1m\\u{202e}");
        let long = "é".repeat(300);
        assert_eq!(quoted(&long), format!("{}... (600 bytes)", "é".repeat(200)));
        assert_eq!(quoted(&"x".repeat(200)), "x".repeat(200));
    }
}
