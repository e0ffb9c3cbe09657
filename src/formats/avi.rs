//! Motion-JPEG in AVI 1.0, valid after every frame.
//!
//! The layout is RIFF `AVI ` with `hdrl`, `movi` and, at the end, `idx1`. After each frame the index is written again
//! behind it and the header is brought up to date; the next frame is then written over the index. So a program that is
//! interrupted after a frame leaves a whole file. One that is interrupted within a frame leaves a file whose header
//! still describes the frames before, and players find those from the chunks even where the index was written over.

use std::io::{Seek, SeekFrom, Write};

use super::jpeg::{ColorResolution, write_jpeg};

/// Quality of the frames, 1 to 100; colours are stored in full resolution (4:4:4).
pub const DEFAULT_QUALITY: u8 = 92;
/// Frames per second of the reference's videos.
pub const DEFAULT_FPS: u32 = 60;
/// AVI 1.0 ends here: sizes are 32-bit and some players treat them as signed.
const MAX_BYTES: u64 = (2 << 30) - 1;

// Places of numbers in the header that change with every frame.
const RIFF_SIZE: u64 = 4;
const TOTAL_FRAMES: u64 = 48;
const AVIH_BUFFER: u64 = 60;
const STREAM_LENGTH: u64 = 140;
const STREAM_BUFFER: u64 = 144;
const MOVI_SIZE: u64 = 216;
/// Start of the four letters `movi`, from which the index counts.
const MOVI: u64 = 220;

/// An error in writing a video.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AviError {
    /// The format does not support the size or frame rate.
    #[error("a video cannot have {width} x {height} pixels at {fps} frames per second")]
    Format {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Frames per second.
        fps: u32,
    },
    /// A frame has the wrong size.
    #[error("the frame has {found} bytes, but those of the video have {expected}")]
    Frame {
        /// Bytes found.
        found: usize,
        /// Bytes needed.
        expected: usize,
    },
    /// The format ends at 2 GiB.
    #[error(
        "the video is full after {frames} frames: .avi files are limited to 2 GiB; shorten the episodes or disable \
         videos (--no-render)"
    )]
    Full {
        /// Number of frames written.
        frames: u32,
    },
    /// A frame cannot be encoded.
    #[error("cannot encode a frame: {0}")]
    Encode(String),
    /// The output fails.
    #[error("cannot write the video: {0}")]
    Write(#[from] std::io::Error),
}

/// A video being written.
#[derive(Debug)]
pub struct AviWriter<W: Write + Seek> {
    out: W,
    width: u32,
    height: u32,
    quality: u8,
    frames: u32,
    /// Offset of the next frame.
    end: u64,
    largest: u32,
    index: Vec<u8>,
    jpeg: Vec<u8>,
}

impl<W: Write + Seek> AviWriter<W> {
    /// Starts a video of `fps` frames per second with [`DEFAULT_QUALITY`].
    ///
    /// # Errors
    /// A size or frame rate of 0, a size above 65535, a failing output.
    pub fn new(mut out: W, width: u32, height: u32, fps: u32) -> Result<Self, AviError> {
        let fine = 1..=u32::from(u16::MAX);
        if !fine.contains(&width) || !fine.contains(&height) || fps == 0 {
            return Err(AviError::Format { width, height, fps });
        }
        out.write_all(&header(width, height, fps))?;
        Ok(Self {
            out,
            width,
            height,
            quality: DEFAULT_QUALITY,
            frames: 0,
            end: MOVI + 4,
            largest: 0,
            index: Vec::new(),
            jpeg: Vec::new(),
        })
    }

    /// Sets the quality of the frames that follow, 1 to 100.
    pub fn set_quality(&mut self, quality: u8) {
        self.quality = quality.clamp(1, 100);
    }

    /// Returns the number of frames written.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Adds a frame: red, green and blue of each pixel, rows from the top.
    ///
    /// # Errors
    /// A frame of wrong size, a video that would exceed 2 GiB (which stays valid), a failing output.
    pub fn frame(&mut self, rgb: &[u8]) -> Result<(), AviError> {
        let expected = 3 * self.width as usize * self.height as usize;
        if rgb.len() != expected {
            return Err(AviError::Frame {
                found: rgb.len(),
                expected,
            });
        }
        self.jpeg.clear();
        // `new` has checked that the size fits
        let size = [self.width as u16, self.height as u16];
        write_jpeg(&mut self.jpeg, rgb, size, self.quality, ColorResolution::Full)
            .map_err(|e| AviError::Encode(e.to_string()))?;
        let size = self.jpeg.len() as u32;
        // RIFF chunks begin at even places
        if self.jpeg.len() % 2 == 1 {
            self.jpeg.push(0);
        }
        let next = self.end + 8 + self.jpeg.len() as u64;
        // with the index that will follow, one entry longer
        if next + 8 + self.index.len() as u64 + 16 > MAX_BYTES {
            return Err(AviError::Full { frames: self.frames });
        }
        self.out.seek(SeekFrom::Start(self.end))?;
        self.out.write_all(b"00dc")?;
        self.out.write_all(&size.to_le_bytes())?;
        self.out.write_all(&self.jpeg)?;
        let offset = (self.end - MOVI) as u32;
        self.index.extend(b"00dc");
        for v in [0x10, offset, size] {
            self.index.extend(v.to_le_bytes());
        }
        self.end = next;
        self.frames += 1;
        self.largest = self.largest.max(size);
        self.out.write_all(b"idx1")?;
        self.out.write_all(&(self.index.len() as u32).to_le_bytes())?;
        self.out.write_all(&self.index)?;
        let total = self.end + 8 + self.index.len() as u64;
        for (at, value) in [
            (RIFF_SIZE, total as u32 - 8),
            (TOTAL_FRAMES, self.frames),
            (AVIH_BUFFER, self.largest),
            (STREAM_LENGTH, self.frames),
            (STREAM_BUFFER, self.largest),
            (MOVI_SIZE, (self.end - MOVI) as u32),
        ] {
            self.out.seek(SeekFrom::Start(at))?;
            self.out.write_all(&value.to_le_bytes())?;
        }
        self.out.flush()?;
        Ok(())
    }

    /// Returns the output. There is nothing left to write, so dropping the writer is enough.
    pub fn into_inner(self) -> W {
        self.out
    }
}

fn header(width: u32, height: u32, fps: u32) -> Vec<u8> {
    let mut h = Vec::with_capacity(MOVI as usize + 4);
    let word = |h: &mut Vec<u8>, v: u32| h.extend(v.to_le_bytes());
    let chunk = |h: &mut Vec<u8>, name: &[u8; 4], size: u32| {
        h.extend(name);
        h.extend(size.to_le_bytes());
    };
    chunk(&mut h, b"RIFF", MOVI as u32 + 4 - 8);
    h.extend(b"AVI ");
    chunk(&mut h, b"LIST", 192);
    h.extend(b"hdrl");
    chunk(&mut h, b"avih", 56);
    // microseconds per frame, bytes per second, padding, flags (has an index), frames, initial frames, streams, buffer,
    // width, height, reserved
    for v in [1_000_000 / fps, 0, 0, 0x10, 0, 0, 1, 0, width, height, 0, 0, 0, 0] {
        word(&mut h, v);
    }
    chunk(&mut h, b"LIST", 116);
    h.extend(b"strl");
    chunk(&mut h, b"strh", 56);
    h.extend(b"vidsMJPG");
    // flags, priority and language, initial frames, scale, rate, start, length, buffer, quality (default), sample size
    for v in [0, 0, 0, 1, fps, 0, 0, 0, u32::MAX, 0] {
        word(&mut h, v);
    }
    for v in [0, 0, width as u16, height as u16] {
        h.extend(v.to_le_bytes());
    }
    chunk(&mut h, b"strf", 40);
    for v in [40, width, height] {
        word(&mut h, v);
    }
    h.extend(1u16.to_le_bytes());
    h.extend(24u16.to_le_bytes());
    h.extend(b"MJPG");
    for v in [3 * width * height, 0, 0, 0, 0] {
        word(&mut h, v);
    }
    chunk(&mut h, b"LIST", 4);
    h.extend(b"movi");
    h
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn word(bytes: &[u8], at: u64) -> u32 {
        let at = at as usize;
        u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
    }

    /// Walks through the chunks of a file and returns the frames found.
    fn frames(bytes: &[u8]) -> Vec<Vec<u8>> {
        assert_eq!(&bytes[..4], b"RIFF");
        assert_eq!(word(bytes, RIFF_SIZE) as usize + 8, bytes.len());
        assert_eq!(&bytes[MOVI as usize..][..4], b"movi");
        assert_eq!(&bytes[108..112], b"vids");
        let end = MOVI as usize + word(bytes, MOVI_SIZE) as usize;
        let mut at = MOVI as usize + 4;
        let mut out = Vec::new();
        while at < end {
            assert_eq!(&bytes[at..at + 4], b"00dc");
            let size = word(bytes, at as u64 + 4) as usize;
            out.push(bytes[at + 8..at + 8 + size].to_vec());
            at += 8 + size + size % 2;
        }
        assert_eq!(at, end);
        if !out.is_empty() {
            assert_eq!(&bytes[end..end + 4], b"idx1");
            assert_eq!(word(bytes, end as u64 + 4) as usize, 16 * out.len());
            for (k, frame) in out.iter().enumerate() {
                let entry = end as u64 + 8 + 16 * k as u64;
                let offset = MOVI + u64::from(word(bytes, entry + 8));
                assert_eq!(&bytes[offset as usize..][..4], b"00dc");
                assert_eq!(word(bytes, entry + 12) as usize, frame.len());
            }
        }
        assert_eq!(word(bytes, TOTAL_FRAMES) as usize, out.len());
        assert_eq!(word(bytes, STREAM_LENGTH) as usize, out.len());
        out
    }

    #[test]
    fn the_file_is_whole_after_every_frame() {
        let mut avi = AviWriter::new(Cursor::new(Vec::new()), 20, 10, 60).unwrap();
        assert!(frames(avi.out.get_ref()).is_empty());
        for k in 0..5u8 {
            let rgb: Vec<u8> = (0..600).map(|i| (i as u8).wrapping_mul(k)).collect();
            avi.frame(&rgb).unwrap();
            let found = frames(avi.out.get_ref());
            assert_eq!(found.len(), k as usize + 1);
            let image = image::load_from_memory(&found[k as usize]).unwrap();
            assert_eq!((image.width(), image.height()), (20, 10));
        }
    }

    #[test]
    fn wrong_frames_are_refused_and_the_file_stays_whole() {
        let mut avi = AviWriter::new(Cursor::new(Vec::new()), 4, 4, 60).unwrap();
        avi.frame(&[7; 48]).unwrap();
        assert!(matches!(
            avi.frame(&[7; 47]),
            Err(AviError::Frame {
                found: 47,
                expected: 48
            })
        ));
        assert_eq!(frames(avi.out.get_ref()).len(), 1);
        assert!(AviWriter::new(Cursor::new(Vec::new()), 0, 4, 60).is_err());
        assert!(AviWriter::new(Cursor::new(Vec::new()), 4, 4, 0).is_err());
    }
}
