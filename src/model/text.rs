//! Untrusted text in messages, and the names that it may have meant.

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

/// Returns the known name nearest to `text`, if it is so near that it was probably meant. The comparison ignores the case of ASCII letters.
pub fn nearest<'n>(text: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    const LONGEST: usize = 64; // the distance costs the product of the lengths
    const COST: usize = 1 << 20; // the sum of these products: a document may have a hundred thousand names
    if text.len() > LONGEST {
        return None;
    }
    let most = |name: &str| 1 + name.len() / 4; // a longer name may have more typing errors
    let mut cost = 0;
    // nearly all names are ASCII, and tables of all other letters are 16 kB of a WebAssembly module
    let text = text.to_ascii_lowercase();
    known
        .filter(|name| name.len() <= LONGEST && name.len().abs_diff(text.len()) <= most(name))
        .take_while(|name| {
            cost += name.len() * text.len();
            cost <= COST
        })
        .map(|name| (strsim::damerau_levenshtein(&text, &name.to_ascii_lowercase()), name))
        // with more errors allowed, most words would resemble some name
        .filter(|(distance, name)| *distance <= most(name) && *distance < name.len())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// Returns the text with which an error about an unknown name suggests `nearest`; empty if there is none.
pub fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean \"{}\"?", quoted(name)))
}

/// Returns whether a character changes the direction or the order of others, or is invisible.
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

    #[test]
    fn suggestions_are_names_with_few_typing_errors() {
        let known = ["left_hand", "right_hand", "a", "Head"];
        let find = |text: &str| nearest(text, known.into_iter());
        assert_eq!(find("left_hnad"), Some("left_hand"));
        assert_eq!(find("RIGHT_HAND"), Some("right_hand"));
        assert_eq!(find("haed"), Some("Head"));
        assert_eq!(find("foot"), None);
        // a name of one letter is near to every other one, so that it says nothing
        assert_eq!(find("b"), None);
        assert_eq!(find(&"left_hand".repeat(8)), None);
        // names beyond the cost are not looked at, so that a large document is refused as fast as a small one
        let many = std::iter::repeat_n("b".repeat(60), 300)
            .chain(["a".repeat(60)])
            .collect::<Vec<_>>();
        let meant = format!("{}c", "a".repeat(60));
        assert_eq!(nearest(&meant, many.iter().map(String::as_str)), None);
        assert_eq!(
            nearest(&meant, many.iter().rev().map(String::as_str)),
            Some(&*"a".repeat(60))
        );
        assert_eq!(suggestion(find("haed")), "; did you mean \"Head\"?");
        assert_eq!(suggestion(None), "");
    }
}
