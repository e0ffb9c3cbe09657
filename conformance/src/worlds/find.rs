//! The documents under some folders.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::differential::state::hash;

/// A document that no other one includes.
pub struct Document {
    /// The requested folder.
    pub folder: PathBuf,
    /// Its path in that folder, with slashes.
    pub path: String,
}

/// Lists the MJCF documents under some folders, except copies and those that others include.
///
/// # Errors
/// A folder or a file that cannot be read.
pub fn find(folders: &[PathBuf]) -> Result<Vec<Document>, String> {
    let (mut all, mut copies) = (Vec::new(), BTreeSet::new());
    for folder in folders {
        let mut files = Vec::new();
        walk(folder, &mut files)?;
        files.sort();
        let mut texts = Vec::new();
        let mut included = BTreeSet::new();
        for file in files {
            let bytes = std::fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
            let text = String::from_utf8_lossy(&bytes).into_owned();
            included.extend(includes(&file, &text));
            texts.push((file, text));
        }
        for (file, text) in texts {
            let is_part = file.canonicalize().is_ok_and(|path| included.contains(&path));
            if is_part || !text.contains("<mujoco") || !copies.insert(hash(0, &text)) {
                continue;
            }
            let path = file.strip_prefix(folder).unwrap_or(&file);
            let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
            all.push(Document {
                folder: folder.clone(),
                path: parts.join("/"),
            });
        }
    }
    Ok(all)
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| format!("{}: {e}", folder.display()))?.path();
        if path.is_dir() {
            walk(&path, files)?;
        } else if path.extension().is_some_and(|kind| kind == "xml" || kind == "mjcf") {
            files.push(path);
        }
    }
    Ok(())
}

/// Lists what a document includes.
fn includes(file: &Path, text: &str) -> Vec<PathBuf> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let tags = text.split("<include").skip(1);
    let named = tags.filter_map(|tag| {
        let quoted = tag.split_once("file")?.1.trim_start().strip_prefix('=')?.trim_start();
        let quote = quoted.chars().next().filter(|c| "\"'".contains(*c))?;
        quoted[1..].split_once(quote).map(|(name, _)| folder.join(name))
    });
    named.filter_map(|path| path.canonicalize().ok()).collect()
}
