//! The keys of the configuration, as the guide's chapter about them.

use std::io::{self, Write};

use babybench::Config;
use babybench::config::{Key, KeyKind};

/// Writes every key with what it accepts, its default and its meaning, as Markdown.
pub fn list_keys(out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "# Configuration\n\n\
         A configuration is a flat YAML mapping, or a table of the same keys in Rust, Python and JavaScript. Keys left out have their default; a key that\n\
         does not exist, or a value that is not allowed, is an error that names file, line, key and what is allowed.\n\
         `babybench inspect --keys` prints this page."
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

/// Says what a key accepts, names in code.
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
        KeyKind::Text => "text".to_string(),
        _ => key.kind.expected(),
    }
}
