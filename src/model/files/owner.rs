//! Folders that belong to one process at a time.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// The file in an owned folder that names its owner.
const NAME: &str = ".owner";

/// A folder that belongs to this process until the value is dropped or the process ends in any way.
///
/// The lock is the system's, on a file that holds the number of the process. A process may own a folder several times. On
/// file systems without locks nobody is refused.
#[derive(Debug)]
pub struct Owner {
    path: PathBuf,
    /// `None` in a process that already owned the folder.
    file: Option<File>,
}

impl Owner {
    /// Claims a folder.
    ///
    /// # Errors
    /// [`io::ErrorKind::ResourceBusy`] for a folder that belongs to another process; errors of the file system.
    pub fn of(folder: &Path) -> io::Result<Self> {
        let path = folder.join(NAME);
        loop {
            let mut file = (File::options().read(true).write(true).create(true).truncate(false)).open(&path)?;
            match file.try_lock() {
                // until it was locked, its last owner could remove it
                Ok(()) if !path.exists() => continue,
                Ok(()) | Err(TryLockError::Error(_)) => {
                    file.set_len(0)?;
                    write!(file, "{}", std::process::id())?;
                    return Ok(Self { path, file: Some(file) });
                }
                Err(TryLockError::WouldBlock) => {}
            }
            let mut text = String::new();
            file.rewind()?;
            // no number has more digits; if it is this process's, its other owner holds the lock
            file.take(20).read_to_string(&mut text)?;
            return match text.parse::<u32>() {
                Ok(number) if number == std::process::id() => Ok(Self { path, file: None }),
                Ok(number) => Err(busy(&format!("process {number}"))),
                Err(_) => Err(busy("another process")),
            };
        }
    }
}

fn busy(owner: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::ResourceBusy,
        format!("{owner} trains into this folder; wait until it ends, or choose another save_dir"),
    )
}

impl Drop for Owner {
    fn drop(&mut self) {
        if self.file.is_some() {
            // while it is locked, so that no other process's file is removed
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_belongs_to_one_process() {
        let folder = std::env::temp_dir().join(format!("babybench_owner_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        // left by a killed process
        std::fs::write(folder.join(NAME), "1").expect("a file");
        let first = Owner::of(&folder).expect("nobody holds it");
        let number = std::fs::read_to_string(folder.join(NAME)).expect("it names its owner");
        assert_eq!(number, std::process::id().to_string());
        let again = Owner::of(&folder).expect("the same process");
        drop(again);
        assert!(folder.join(NAME).exists());
        drop(first);
        assert!(!folder.join(NAME).exists());
        // a lock that is not of this process, as far as the file says
        let theirs = File::create(folder.join(NAME)).expect("a file");
        theirs.lock().expect("nobody holds it");
        (&theirs).write_all(b"1").expect("it is open");
        let error = Owner::of(&folder).expect_err("it is taken");
        assert_eq!(error.kind(), io::ErrorKind::ResourceBusy);
        assert_eq!(
            error.to_string(),
            "process 1 trains into this folder; wait until it ends, or choose another save_dir"
        );
        std::fs::remove_dir_all(&folder).expect("the folder was made");
    }
}
