//! Printing to pipes that may be closed: `println!` and `eprintln!` would panic.

/// Writes a line to the standard output. A closed pipe is an error like others, which ends the program quietly (see
/// `main`).
macro_rules! say {
    ($($text:tt)*) => {
        std::io::Write::write_fmt(&mut std::io::stdout().lock(), format_args!("{}\n", format_args!($($text)*)))
    };
}

/// Writes a line to the standard error and ignores whether anybody reads it.
macro_rules! note {
    ($($text:tt)*) => {{
        let line = format_args!($($text)*);
        let _ = std::io::Write::write_fmt(&mut std::io::stderr().lock(), format_args!("{line}\n"));
    }};
}

pub(crate) use {note, say};
