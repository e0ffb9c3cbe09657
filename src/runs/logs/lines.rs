//! `training.jsonl`: the records of a training log as lines of JSON, for programs that read no pickles.
//!
//! Lines on disk are not formatted again: a new file consists of the old one and the new lines.

use std::collections::VecDeque;
use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

use super::LogError;
use super::line::LineFormatter;
use crate::env::{Info, PartNames};
use crate::files::{self, replace_file_with};

/// Size in bytes at which buffered lines are written, and read.
const AT_ONCE: usize = 1 << 16;

/// A file that this log has written or read.
#[derive(Clone, Debug)]
struct KnownFile {
    records: usize,
    length: u64,
    modified: Option<SystemTime>,
}

impl KnownFile {
    fn of(records: usize, meta: &Metadata) -> Self {
        Self {
            records,
            length: meta.len(),
            modified: meta.modified().ok(),
        }
    }

    /// Returns whether a file is unchanged according to its metadata.
    fn is(&self, meta: &Metadata) -> bool {
        // if another program has changed the file, all lines are rewritten
        meta.is_file() && meta.len() == self.length && meta.modified().ok() == self.modified
    }
}

/// The records of a resumed log: their number and the first of them.
#[derive(Clone, Debug)]
struct ResumedRecords {
    records: usize,
    first: Info,
}

/// The known contents of the `.jsonl` file next to a training log.
#[derive(Debug, Default)]
pub(super) struct JsonLines {
    /// The writer of lines, with the names of touched parts.
    names: Option<PartNames>,
    resumed: Option<ResumedRecords>,
    known: Mutex<Option<KnownFile>>,
}

impl Clone for JsonLines {
    fn clone(&self) -> Self {
        Self {
            names: self.names.clone(),
            resumed: self.resumed.clone(),
            known: Mutex::new(self.known()),
        }
    }
}

impl JsonLines {
    /// Resumes from the `.jsonl` file, if there is one, next to a log of `records` records, whose first record is `first`.
    pub fn of(first: Option<Info>, records: usize) -> Self {
        Self {
            resumed: first.map(|first| ResumedRecords { records, first }),
            ..Self::default()
        }
    }

    /// Sets the names of touched parts.
    pub fn set_names(&mut self, names: Option<PartNames>) {
        if self.names != names {
            self.names = names;
            // lines with other names are formatted again
            self.known = Mutex::default();
        }
    }

    /// Marks the file, just written, as up to date with `records` records.
    pub fn know(&self, path: &Path, records: usize) {
        let meta = std::fs::metadata(path).ok();
        let known = meta.map(|meta| KnownFile::of(records, &meta));
        *self.known.lock().unwrap_or_else(PoisonError::into_inner) = known;
    }

    fn known(&self) -> Option<KnownFile> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Updates the file to `total` records. `recent` are the last of them, and `visit` yields all.
    ///
    /// # Errors
    /// Errors of the file system and of `visit`.
    pub fn save(
        &self,
        path: &Path,
        total: usize,
        recent: &VecDeque<Info>,
        visit: impl FnOnce(&mut dyn FnMut(&Info)) -> Result<(), LogError>,
    ) -> Result<(), LogError> {
        let last = |records: usize| recent.len().checked_sub(total.checked_sub(records)?);
        let usable = |known: &KnownFile| last(known.records).is_some();
        let known = self
            .known()
            .filter(|known| std::fs::metadata(path).is_ok_and(|meta| known.is(&meta)));
        let adopt = || {
            let resumed = self.resumed.as_ref()?;
            let before = recent.get(last(resumed.records)?.checked_sub(1)?)?;
            self.adopt(path, resumed, before).ok().flatten()
        };
        let known = known.or_else(adopt).filter(usable);
        // if appending fails, writing the whole file again may still work
        let added = known.and_then(|known| self.append(path, &known, recent.range(last(known.records)?..)).ok());
        if added.is_none() {
            self.write_all(path, visit)?;
        }
        self.know(path, total);
        Ok(())
    }

    /// Returns whether a file holds the lines of a resumed log: the same number, with the same first and last one.
    fn adopt(&self, path: &Path, resumed: &ResumedRecords, last: &Info) -> io::Result<Option<KnownFile>> {
        let mut file = files::open(path)?;
        let meta = file.metadata()?;
        let mut begins = |line: &[u8], from: SeekFrom| -> io::Result<bool> {
            file.seek(from)?;
            let mut found = Vec::new();
            Read::by_ref(&mut file)
                .take(line.len() as u64)
                .read_to_end(&mut found)?;
            Ok(found == line)
        };
        let (mut first, mut end) = (Vec::new(), b"\n".to_vec());
        let mut maker = LineFormatter::new(self.names.as_ref());
        maker.line(&mut first, &resumed.first)?;
        maker.line(&mut end, last)?;
        // the line break of the line before belongs to the end
        let end = if resumed.records == 1 { &end[1..] } else { &end[..] };
        // the ends and the number of lines, because comparing all lines would mean formatting all records
        let same = begins(&first, SeekFrom::Start(0))? && begins(end, SeekFrom::End(-(end.len() as i64)))?;
        file.seek(SeekFrom::Start(0))?;
        Ok((same && breaks(&mut file)? == resumed.records).then(|| KnownFile::of(resumed.records, &meta)))
    }

    /// Replaces a file by its contents and more lines.
    fn append<'r>(
        &self,
        path: &Path,
        known: &KnownFile,
        more: impl ExactSizeIterator<Item = &'r Info>,
    ) -> io::Result<()> {
        if more.len() == 0 {
            return Ok(());
        }
        // a new file: a process killed while it appends would leave half a line
        replace_file_with(path, |file| {
            // the system copies this itself if it can
            let copied = io::copy(&mut files::open(path)?, file)?;
            // it was replaced between the check and the copy
            if copied != known.length {
                return Err(io::Error::other("it is a different file now"));
            }
            let mut writer = self.writer(file);
            more.for_each(|info| writer.push(info));
            writer.finish()
        })
    }

    /// Writes the lines of all records that `visit` yields.
    pub fn write_all(
        &self,
        path: &Path,
        visit: impl FnOnce(&mut dyn FnMut(&Info)) -> Result<(), LogError>,
    ) -> Result<(), LogError> {
        let mut read = Ok(());
        let written = replace_file_with(path, |file| {
            let mut writer = self.writer(file);
            read = visit(&mut |info| writer.push(info));
            match &read {
                Ok(()) => writer.finish(),
                Err(e) => Err(io::Error::other(e.to_string())),
            }
        });
        // first, because the error of the file only repeats it
        read?;
        written.map_err(|source| {
            let path = path.to_path_buf();
            LogError::Io { path, source }
        })
    }

    fn writer<'l>(&'l self, file: &'l mut File) -> LinesWriter<'l> {
        LinesWriter {
            maker: LineFormatter::new(self.names.as_ref()),
            file,
            buffer: Vec::new(),
            written: Ok(()),
        }
    }
}

/// Writes lines piece by piece, because names make them long.
struct LinesWriter<'l> {
    maker: LineFormatter<'l>,
    file: &'l mut File,
    buffer: Vec<u8>,
    /// The first error.
    written: io::Result<()>,
}

impl LinesWriter<'_> {
    fn push(&mut self, info: &Info) {
        // the visit cannot be stopped, so the first error is kept for the end
        if self.written.is_err() {
            return;
        }
        self.written = self.maker.line(&mut self.buffer, info);
        if self.written.is_ok() && self.buffer.len() > AT_ONCE {
            self.written = self.file.write_all(&self.buffer);
            self.buffer.clear();
        }
    }

    fn finish(self) -> io::Result<()> {
        self.written?;
        self.file.write_all(&self.buffer)
    }
}

/// Counts the line breaks of a file.
fn breaks(file: &mut File) -> io::Result<usize> {
    // in pieces whose number of line breaks fits a byte, many at a time
    let piece = |bytes: &[u8]| usize::from(bytes.iter().map(|&byte| u8::from(byte == b'\n')).sum::<u8>());
    let (mut count, mut buffer) = (0, vec![0; AT_ONCE]);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(count),
            n => count += buffer[..n].chunks(usize::from(u8::MAX)).map(piece).sum::<usize>(),
        }
    }
}
