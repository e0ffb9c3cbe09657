//! Files that are replaced whole or not at all.

use std::io::{self, Write};
use std::path::Path;

/// Writes a new file beside `path` and renames it over it: `path` holds what it held before or all of `bytes`, whenever
/// the process ends.
pub(crate) fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "not a file name"))?;
    let (temporary, mut file) = (0..1000)
        .find_map(|number| {
            let mut beside = std::ffi::OsString::from(".");
            beside.push(name);
            beside.push(format!(".{number}.tmp"));
            let beside = path.with_file_name(beside);
            match std::fs::File::options().write(true).create_new(true).open(&beside) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => None,
                result => Some(result.map(|file| (beside, file))),
            }
        })
        .unwrap_or_else(|| {
            Err(io::Error::new(
                io::ErrorKind::AlreadyExists,
                "a thousand temporary files beside it",
            ))
        })?;
    let written = file.write_all(bytes).and_then(|()| file.sync_all());
    drop(file);
    let renamed = written.and_then(|()| std::fs::rename(&temporary, path));
    if renamed.is_err() {
        // The first error is the one to report; a leftover does no harm.
        let _ = std::fs::remove_file(&temporary);
    }
    renamed
}
