//! Printing that survives a reader who has had enough: `println!` and `eprintln!` panic then.

/// Writes a line to the standard output. A closed pipe is an error like others, which ends the program quietly (see
/// `main`).
macro_rules! say {
    ($($text:tt)*) => {
        std::io::Write::write_fmt(&mut std::io::stdout().lock(), format_args!("{}\n", format_args!($($text)*)))
    };
}

/// Writes a line to the standard error; if nobody reads it, so be it.
macro_rules! note {
    ($($text:tt)*) => {{
        let line = format_args!($($text)*);
        let _ = std::io::Write::write_fmt(&mut std::io::stderr().lock(), format_args!("{line}\n"));
    }};
}

pub(crate) use {note, say};
