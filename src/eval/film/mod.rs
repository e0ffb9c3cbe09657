//! Videos of evaluation episodes, and the frame that the Python kit composes.

mod frame;
mod room;
mod skin_panel;

use std::error::Error;
use std::path::Path;

pub use frame::{FRAME_HEIGHT, FRAME_WIDTH, FrameComposer, FrameError, Panel};
pub use room::RoomFilm;

use crate::env::Env;

/// An error in making a video.
pub type FilmError = Box<dyn Error + Send + Sync>;

/// A recorder of the videos of evaluation episodes.
pub trait Film {
    /// Adds a frame of the environment's current step. The first one starts a video.
    ///
    /// # Errors
    /// Errors of drawing, encoding or the file system.
    fn frame(&mut self, env: &Env) -> Result<(), FilmError>;

    /// Finishes the video and moves it to `path`, replacing an older file. The folder must exist.
    ///
    /// # Errors
    /// As [`Film::frame`].
    fn end(&mut self, path: &Path) -> Result<(), FilmError>;

    /// Discards the unfinished video.
    fn discard(&mut self);
}
