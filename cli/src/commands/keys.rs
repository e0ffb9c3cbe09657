//! The guide's chapter on the keys of the configuration.

use std::io::{self, Write};

use babybench::Config;
use babybench::config::{Key, KeyKind};

/// Writes every key with its values, default and meaning, as Markdown.
pub fn list_keys(out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "# Configuration\n\n\
         A configuration is a flat YAML mapping, or a table of the same keys in Rust, Python and JavaScript. Keys that are left out have their default. A key that\n\
         does not exist and a value that is not allowed are errors. They name file, line, key and the allowed values. `babybench inspect --keys` prints this\n\
         page."
    )?;
    let mut section = "";
    for key in Config::keys() {
        if key.section != section {
            section = key.section;
            writeln!(
                out,
                "\n## {section}\n\n| key | values | default | meaning |\n|---|---|---|---|"
            )?;
        }
        let (values, default) = (values(key), key.default_value().to_yaml());
        writeln!(out, "| `{}` | {values} | `{default}` | {} |", key.name, key.doc)?;
    }
    Ok(())
}

/// Returns what a key accepts, with names as code.
fn values(key: &Key) -> String {
    let names = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    match key.kind {
        KeyKind::Choice(choices) => names(choices),
        KeyKind::ChoiceOrFile { names: known, ending } => {
            format!("{}, or a path that ends in `{ending}`", names(known))
        }
        KeyKind::List(choices) => format!("list of {}", names(choices)),
        KeyKind::NoneOrList(choices) => format!("some of {}", names(choices)),
        KeyKind::Text => "text".to_string(),
        _ => key.kind.expected(),
    }
}
