//! Remedies for errors of the file system.

use std::error::Error;
use std::io::{self, ErrorKind};

/// Returns advice on an error of the file system.
pub fn hint(error: &(dyn Error + 'static)) -> Option<String> {
    let chain = std::iter::successors(Some(error), |&e| e.source());
    let kind = chain.filter_map(|e| e.downcast_ref::<io::Error>()).last()?.kind();
    let advice = match kind {
        ErrorKind::NotFound => {
            let here = std::env::current_dir().map_or_else(|_| "here".to_string(), |d| d.display().to_string());
            return Some(format!(
                "check the spelling and that the folder exists; relative paths start at {here}"
            ));
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "you have no permission to read or write this; change its permissions, or choose another place (save_dir in \
             the configuration, or the option that names the file)"
        }
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "the disk is full; free some space, or choose another place. Files that were there before are unchanged"
        }
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "there is a file where a folder is needed; choose another place"
        }
        ErrorKind::IsADirectory => "there is a folder where a file is needed; add a file name",
        ErrorKind::InvalidFilename => "the system does not allow this name; choose another one",
        _ => return None,
    };
    Some(advice.to_string())
}
