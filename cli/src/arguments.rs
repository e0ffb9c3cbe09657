//! Values of arguments.

use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

use babybench::config::MAX_AGE;
use clap::builder::{PathBufValueParser, TypedValueParser};

/// Parses a whole number from 0.
pub fn number<T: FromStr + PartialOrd + Display + Default>(text: &str) -> Result<T, String> {
    from(text, T::default())
}

/// Parses a whole number from 1.
pub fn count<T: FromStr + PartialOrd + Display + From<u8>>(text: &str) -> Result<T, String> {
    from(text, T::from(1))
}

fn from<T: FromStr + PartialOrd + Display>(text: &str, least: T) -> Result<T, String> {
    match text.parse() {
        Ok(n) if n >= least => Ok(n),
        _ => Err(format!("expected a whole number of at least {least}")),
    }
}

/// Parses an age that MIMo can have, months.
pub fn age(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(age) if (0.0..=MAX_AGE).contains(&age) => Ok(age),
        _ => Err(format!("expected an age in months, 0 to {MAX_AGE}")),
    }
}

/// Returns a parser of file names that end in `.png`.
pub fn png() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.extension() {
        Some(end) if end.eq_ignore_ascii_case("png") => Ok(path),
        _ => Err("pictures are PNG files: expected a name that ends in .png"),
    })
}

/// Returns a parser of file names that end in `.png` or `.svg`.
pub fn picture() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.extension() {
        Some(end) if ["png", "svg"].iter().any(|known| end.eq_ignore_ascii_case(known)) => Ok(path),
        _ => Err("expected a name that ends in .png, or in .svg with --age"),
    })
}

/// Quotes a path so that it is one word of a command line.
pub fn word(path: impl Display) -> String {
    let mut path = path.to_string();
    if path.starts_with('-') {
        // not an option
        path.insert_str(0, "./");
    }
    let plain = |c: char| c.is_alphanumeric() || "/\\.:_-+,~@%=".contains(c);
    // a shell would put a home folder for ~
    if path.chars().all(plain) && !path.is_empty() && !path.starts_with('~') {
        path
    } else if cfg!(windows) {
        format!("\"{path}\"")
    } else {
        shlex::try_quote(&path).map_or_else(|_| path.clone(), Into::into)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_bounds() {
        assert_eq!(number::<u64>("0"), Ok(0));
        assert_eq!(count::<u32>("4294967295"), Ok(u32::MAX));
        for text in ["0", "-1", "1.5", "many", "", "4294967296"] {
            let refused = count::<u32>(text).expect_err(text);
            assert_eq!(refused, "expected a whole number of at least 1");
        }
    }

    #[cfg(unix)]
    #[test]
    fn words_can_be_typed() {
        assert_eq!(word("results/self_touch"), "results/self_touch");
        assert_eq!(word("my results/é"), "'my results/é'");
        assert_eq!(word(""), "''");
        assert_eq!(word("-dash"), "./-dash");
        assert_eq!(word("~/x"), "'~/x'");
    }
}
