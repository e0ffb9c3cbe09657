//! Names of models in errors.

use super::*;

#[test]
fn errors_quote_what_comes_from_a_model() {
    let hostile = format!("a\u{1b}[2J\n{}", "é".repeat(5000));
    let text = || hostile.clone();
    for error in [
        OnnxError::Load(quoted(&hostile)),
        OnnxError::Name {
            found: text(),
            expected: "\"observation\"".to_string(),
        },
        OnnxError::Shape {
            name: text(),
            found: text(),
            expected: "[1, 3]".to_string(),
        },
        OnnxError::Type {
            name: text(),
            found: "i32".to_string(),
            expected: "f32",
        },
        OnnxError::Run(text()),
        OnnxError::Output {
            name: text(),
            found: "3 numbers".to_string(),
            expected: 2,
        },
        OnnxError::NotFinite {
            name: text(),
            index: 1,
            value: "NaN".to_string(),
        },
    ] {
        let said = error.to_string();
        assert!(said.contains("a\\u{1b}[2J\\n") && said.len() < 1500, "{said}");
        assert!(!said.chars().any(char::is_control), "{said:?}");
    }
}
