//! Printing to pipes that may be closed: `println!` and `eprintln!` would panic.

/// Writes a line to the standard output. A closed pipe is an ordinary error, which ends the program quietly (see `main`).
macro_rules! say {
    ($($text:tt)*) => {
        std::io::Write::write_fmt(
            &mut std::io::stdout().lock(),
            format_args!("{}\n", $crate::print::harmless(format!($($text)*))),
        )
    };
}

/// Writes a line to the standard error and ignores errors.
macro_rules! note {
    ($($text:tt)*) => {{
        let line = $crate::print::harmless(format!($($text)*));
        let _ = std::io::Write::write_fmt(&mut std::io::stderr().lock(), format_args!("{line}\n"));
    }};
}

/// Replaces control characters except line breaks: names from files must not control the terminal.
pub fn harmless(text: String) -> String {
    let harmful =
        |c: char| c.is_control() && c != '\n' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if text.contains(harmful) {
        text.chars().map(|c| if harmful(c) { '\u{fffd}' } else { c }).collect()
    } else {
        text
    }
}

pub(crate) use {note, say};

#[cfg(test)]
mod tests {
    use super::harmless;

    #[test]
    fn names_do_not_steer_the_terminal() {
        assert_eq!(harmless("a\nb \u{1b}[2J\u{7}".to_string()), "a\nb \u{fffd}[2J\u{fffd}");
        assert_eq!(harmless("\u{9b}1m \u{202e}é".to_string()), "\u{fffd}1m \u{fffd}é");
    }
}
