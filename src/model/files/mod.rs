//! Untrusted files, which are read within limits, and our own files, which are replaced as a whole or not at all.

mod owner;
mod unfinished;

use std::fs::{File, FileType};
use std::io::{self, Read};
use std::path::Path;

pub use owner::Owner;
pub use unfinished::replace_file;
pub use unfinished::{replace_file_with, sweep, unfinished};

/// Opens an untrusted file. Anything but a regular file is refused before it is opened: a pipe could block forever, and a device may be endless.
pub fn open(path: &Path) -> io::Result<File> {
    let regular = |meta: std::fs::Metadata| {
        if meta.is_file() {
            Ok(())
        } else {
            Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                format!("this is {}, not a regular file", kind(meta.file_type())),
            ))
        }
    };
    regular(std::fs::metadata(path)?)?;
    let file = File::open(path)?;
    // it may be another one by now
    regular(file.metadata()?)?;
    Ok(file)
}

/// Reads an untrusted file of at most `limit` bytes; see [`open`]. The error for a larger one has the kind
/// [`io::ErrorKind::FileTooLarge`].
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    // one byte more than allowed distinguishes a file that is too large from one that just fits, even if its metadata
    // are wrong
    let mut bytes = Vec::new();
    let file = open(path)?;
    if file.metadata()?.len() <= limit {
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
        if bytes.len() as u64 <= limit {
            return Ok(bytes);
        }
    }
    Err(io::Error::new(
        io::ErrorKind::FileTooLarge,
        format!("the file has more than {limit} bytes"),
    ))
}

/// Describes an entry that is not a regular file.
fn kind(kind: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return "a named pipe";
        } else if kind.is_socket() {
            return "a socket";
        } else if kind.is_char_device() || kind.is_block_device() {
            return "a device";
        }
    }
    if kind.is_dir() { "a folder" } else { "something else" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_within_the_limit_are_read() {
        let folder = std::env::temp_dir().join(format!("babybench_files_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("a");
        std::fs::write(&path, [7; 10]).expect("a file");
        assert_eq!(read(&path, 10).expect("it fits"), [7; 10]);
        let large = read(&path, 9).expect_err("too large");
        assert_eq!(large.kind(), io::ErrorKind::FileTooLarge);
        assert_eq!(large.to_string(), "the file has more than 9 bytes");
        let text = |path: &Path| read(path, 10).expect_err("not a file").to_string();
        assert_eq!(text(&folder), "this is a folder, not a regular file");
        assert_eq!(
            read(&folder.join("b"), 10).expect_err("none").kind(),
            io::ErrorKind::NotFound
        );
        #[cfg(unix)]
        {
            assert_eq!(text(Path::new("/dev/zero")), "this is a device, not a regular file");
            let socket = folder.join("socket");
            let _listener = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
            assert_eq!(text(&socket), "this is a socket, not a regular file");
        }
        std::fs::remove_dir_all(&folder).expect("the folder was made");
    }
}
