//! JSON as the library writes it: one line, with the separators of Python's `json.dumps`.

use std::io;

use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};

/// Puts a space after each comma and colon.
struct Spaced;

impl Spaced {
    fn separate<W: ?Sized + io::Write>(writer: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { writer.write_all(b", ") }
    }
}

impl Formatter for Spaced {
    fn begin_array_value<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        Self::separate(writer, first)
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        Self::separate(writer, first)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }
}

/// Appends a value as a line of JSON. Numbers that are not finite become `null`.
///
/// # Errors
/// Errors of the value's own `Serialize`; writing to memory cannot fail.
pub(crate) fn line(out: &mut Vec<u8>, value: &impl Serialize) -> io::Result<()> {
    value.serialize(&mut Serializer::with_formatter(&mut *out, Spaced))?;
    out.push(b'\n');
    Ok(())
}

/// Returns values as lines of JSON; see [`line`].
pub(crate) fn lines<T: Serialize>(values: impl IntoIterator<Item = T>) -> io::Result<Vec<u8>> {
    let mut out = Vec::new();
    for value in values {
        line(&mut out, &value)?;
    }
    Ok(out)
}

/// Returns a value as JSON without a line break, for types whose `Serialize` cannot fail.
pub(crate) fn text(value: &impl Serialize) -> String {
    let mut out = Vec::new();
    let written = line(&mut out, value).map(|()| out.pop());
    debug_assert!(written.is_ok(), "{written:?}");
    String::from_utf8(out).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_look_like_those_of_python() {
        let value = (
            [1_u64, 2],
            [0.1 + 0.2, f64::NAN, f64::NEG_INFINITY, -0.0],
            "e\u{301} \"\\\n\u{7}",
            Vec::<u8>::new(),
        );
        assert_eq!(
            text(&value),
            "[[1, 2], [0.30000000000000004, null, null, -0.0], \"e\u{301} \\\"\\\\\\n\\u0007\", []]"
        );
        let map: std::collections::BTreeMap<&str, f32> = [("a", 0.1), ("b", 1e-7)].into();
        let lines = lines([&map, &map]).expect("JSON");
        assert_eq!(
            String::from_utf8(lines).expect("UTF-8"),
            "{\"a\": 0.1, \"b\": 1e-7}\n".repeat(2)
        );
    }
}
