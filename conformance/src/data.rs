//! The data in `conformance/data`, whose README describes each file.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use babybench::formats::npz::Npz;
use serde_json::Value;

/// Returns the path of a file of the data.
pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

/// Returns the text of a file.
pub fn text(name: &str) -> String {
    std::fs::read_to_string(path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Opens a NumPy archive.
pub fn npz(name: &str) -> Npz {
    Npz::open(path(name)).unwrap_or_else(|e| panic!("{e}"))
}

/// Reads a file of gzipped JSON.
pub fn json(name: &str) -> Value {
    let bytes = std::fs::read(path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mut text = String::new();
    let read = flate2::read::GzDecoder::new(&bytes[..]).read_to_string(&mut text);
    read.unwrap_or_else(|e| panic!("{name}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns the names of the files in a folder with an ending, without it, sorted.
pub fn names(folder: &str, ending: &str) -> Vec<String> {
    let files = std::fs::read_dir(path(folder)).unwrap_or_else(|e| panic!("{folder}: {e}"));
    let names = files.filter_map(|file| file.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = names
        .filter_map(|n| Some(n.strip_suffix(ending)?.to_string()))
        .collect();
    names.sort();
    assert!(!names.is_empty(), "{folder} holds no file that ends in {ending}");
    names
}
