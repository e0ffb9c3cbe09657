//! Files that are written under another name and renamed when they are complete.
//!
//! The writer of such a file holds a lock on it, which the system releases when the process ends, however it ends. So a
//! file without its lock was left by a process that was killed, and the next one removes it.

use std::ffi::{OsStr, OsString};
use std::fs::{File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Maximum number of files of one name that can be written at the same time.
const AT_ONCE: usize = 1000;

/// Creates the unfinished file `.NAME.N.tmp` in a folder, for the smallest `N` that no process is writing.
pub fn unfinished(folder: &Path, name: &OsStr) -> io::Result<(PathBuf, File)> {
    for number in 0..AT_ONCE {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{number}.tmp"));
        let path = folder.join(hidden);
        remove_if_abandoned(&path);
        match File::options().write(true).create_new(true).open(&path) {
            Ok(file) => match file.try_lock() {
                // until it was locked, another process could take it for abandoned
                Ok(()) if !path.exists() => {}
                Err(TryLockError::WouldBlock) => {}
                // a file system without locks still has unfinished files
                Ok(()) | Err(TryLockError::Error(_)) => return Ok((path, file)),
            },
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::new(
        io::ErrorKind::AlreadyExists,
        format!("{AT_ONCE} unfinished files beside it"),
    ))
}

/// Removes the unfinished files of killed processes from a folder. Files that cannot be removed stay.
pub fn sweep(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        if is_unfinished(&entry.file_name()) {
            remove_if_abandoned(&entry.path());
        }
    }
}

/// Returns whether a name has the form that [`unfinished`] creates.
fn is_unfinished(name: &OsStr) -> bool {
    let number = name
        .to_str()
        .and_then(|name| name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.'));
    number.is_some_and(|(name, number)| {
        !name.is_empty() && number.len() <= 3 && !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit())
    })
}

fn remove_if_abandoned(path: &Path) {
    // a link or a folder of that name is not ours to remove
    if !std::fs::symlink_metadata(path).is_ok_and(|meta| meta.is_file()) {
        return;
    }
    if let Ok(file) = File::options().write(true).open(path)
        && file.try_lock().is_ok()
    {
        // the lock goes with `file`, after the removal
        let _ = std::fs::remove_file(path);
    }
}

/// Writes a new file next to `path` and renames it over it: `path` holds either its old content or all of `bytes`, no matter when the process ends.
pub fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace_file_with(path, |file| file.write_all(bytes))
}

/// Replaces a file as [`replace_file`] does, by the output of `write`.
pub fn replace_file_with(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "not a file name"))?;
    let (temporary, mut file) = unfinished(path.parent().unwrap_or(Path::new("")), name)?;
    // synchronised before it is renamed: after a crash of the system the name must not lead to an empty file
    let written = write(&mut file).and_then(|()| file.sync_all());
    #[cfg(windows)]
    drop(file); // open files cannot be renamed there
    let renamed = written.and_then(|()| std::fs::rename(&temporary, path));
    if renamed.is_err() {
        // the first error is the one to report
        let _ = std::fs::remove_file(&temporary);
    }
    renamed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_killed_process_left_is_removed_and_what_another_writes_is_not() {
        let folder = std::env::temp_dir().join(format!("babybench_unfinished_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let (mine, held) = unfinished(&folder, OsStr::new("a")).expect("a file");
        assert_eq!(mine, folder.join(".a.0.tmp"));
        for name in [".a.1.tmp", ".b.0.tmp", ".c.tmp", "d.0.tmp", ".e.x.tmp", "log"] {
            std::fs::write(folder.join(name), "left").expect("a file");
        }
        // of the same name, at once
        let (second, _held_too) = unfinished(&folder, OsStr::new("a")).expect("a file");
        assert_eq!(second, folder.join(".a.1.tmp"));
        assert_eq!(std::fs::read(&second).expect("it is new"), b"");
        sweep(&folder);
        let mut names: Vec<_> = std::fs::read_dir(&folder)
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name())
            .collect();
        names.sort();
        assert_eq!(names, [".a.0.tmp", ".a.1.tmp", ".c.tmp", ".e.x.tmp", "d.0.tmp", "log"]);
        drop(held);
        sweep(&folder);
        assert!(!mine.exists());
        std::fs::remove_dir_all(&folder).expect("the folder was made");
    }
}
