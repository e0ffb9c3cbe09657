//! What to do about errors of the file system.

use std::error::Error;
use std::io::{self, ErrorKind};

/// Advice, if an error comes from the file system.
pub fn hint(error: &(dyn Error + 'static)) -> Option<String> {
    let chain = std::iter::successors(Some(error), |&e| e.source());
    let kind = chain.filter_map(|e| e.downcast_ref::<io::Error>()).last()?.kind();
    let advice = match kind {
        ErrorKind::NotFound => {
            let here = std::env::current_dir().map_or_else(|_| "here".to_string(), |d| d.display().to_string());
            return Some(format!(
                "check the spelling, and that the folder is there; paths that do not start at the root start at {here}"
            ));
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "this is not yours to read or write; change its permissions, or choose another place (save_dir in the \
             configuration, or the option that names the file)"
        }
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "there is no room; make some, or choose another place. Files that were there before are as they were"
        }
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "there is a file where a folder is needed; choose another place"
        }
        ErrorKind::IsADirectory => "this is a folder, but a file is needed; add the name of a file",
        ErrorKind::InvalidFilename => "the system does not allow this name; choose another one",
        _ => return None,
    };
    Some(advice.to_string())
}
