//! Videos of evaluations: a writer of Motion-JPEG in .avi files and the frame that the reference composes.

mod avi;
mod frame;

pub use avi::{AviWriter, DEFAULT_FPS, DEFAULT_QUALITY};
pub use frame::{FRAME_HEIGHT, FRAME_WIDTH, FramePainter, Panel};

use crate::render::RenderError;

/// Why a video cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// A size or frame rate that the format cannot hold.
    #[error("a video cannot have {width} x {height} pixels at {fps} frames per second")]
    Format {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Frames per second.
        fps: u32,
    },
    /// A frame of wrong size.
    #[error("the frame has {found} bytes but the video's have {expected}")]
    Frame {
        /// Bytes found.
        found: usize,
        /// Bytes needed.
        expected: usize,
    },
    /// The format ends at 2 GiB.
    #[error(
        "the video has {frames} frames and is full: .avi files end at 2 GiB; make episodes shorter, or no videos (--no-render)"
    )]
    Full {
        /// Frames written.
        frames: u32,
    },
    /// A frame cannot be encoded.
    #[error("cannot encode a frame: {0}")]
    Encode(String),
    /// A frame cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The scene lacks a camera that the frame shows.
    #[error("the scene has no camera named {0:?}, which the frame shows")]
    Camera(&'static str),
    /// The output fails.
    #[error("cannot write the video: {0}")]
    Write(#[from] std::io::Error),
}
