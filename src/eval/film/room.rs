//! Videos of evaluation episodes, one composed frame for each step.

use std::ffi::OsStr;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::skin_panel::SkinPanel;
use super::{FRAME_HEIGHT, FRAME_WIDTH, Film, FilmError, FrameComposer, Panel};
use crate::config::Behavior;
use crate::env::Env;
use crate::files::{sweep, unfinished};
use crate::formats::avi::{AviWriter, DEFAULT_FPS};
use crate::render::{Poses, Scenery};

/// A film of the room, the view from above and the behavior's subject, in `.avi` files.
///
/// That is the skin (unless touch is off) for `self_touch`, what both eyes see for `hand_regard`, and the room from the
/// side for `none`.
pub struct RoomFilm {
    composer: FrameComposer,
    skin: SkinPanel,
    scenery: Arc<Scenery>,
    folder: PathBuf,
    frame: Vec<u8>,
    fps: u32,
    writer: Option<(PathBuf, AviWriter<File>)>,
}

impl std::fmt::Debug for RoomFilm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RoomFilm")
            .field("folder", &self.folder)
            .finish_non_exhaustive()
    }
}

impl RoomFilm {
    /// Creates a film for environments of the scene of `env`. `folder` holds the unfinished video. It must be on the file system of the
    /// finished videos, and is created if necessary.
    ///
    /// # Errors
    /// Textures that cannot be read, a scene without the cameras, a folder that cannot be made.
    pub fn new(env: &Env, folder: impl Into<PathBuf>) -> Result<Self, FilmError> {
        let folder = folder.into();
        std::fs::create_dir_all(&folder)?;
        sweep(&folder);
        Ok(Self {
            composer: FrameComposer::new(env.model())?,
            skin: SkinPanel::new(),
            scenery: env.blueprint().scenery()?,
            folder,
            frame: vec![0; 3 * FRAME_WIDTH * FRAME_HEIGHT],
            fps: DEFAULT_FPS,
            writer: None,
        })
    }

    /// Sets the number of frames per second, [`DEFAULT_FPS`] by default. The number of steps per simulated second shows the scene in
    /// real time.
    #[must_use]
    pub fn with_fps(mut self, fps: u32) -> Self {
        self.fps = fps;
        self
    }

    /// Creates a temporary file in the folder.
    fn begin(&self) -> Result<(PathBuf, AviWriter<File>), FilmError> {
        let (path, file) = unfinished(&self.folder, OsStr::new("evaluation"))?;
        let writer = AviWriter::new(file, FRAME_WIDTH as u32, FRAME_HEIGHT as u32, self.fps)?;
        Ok((path, writer))
    }
}

impl Film for RoomFilm {
    fn frame(&mut self, env: &Env) -> Result<(), FilmError> {
        let mut taken = match self.writer.take() {
            Some(taken) => taken,
            None => self.begin()?,
        };
        let panel = match env.config().behavior {
            Behavior::HandRegard => Panel::Binocular,
            Behavior::SelfTouch => self.skin.draw(env).map_or(Panel::Side, Panel::Picture),
            _ => Panel::Side,
        };
        let composed = self
            .composer
            .compose(&self.scenery, &Poses::from(env.state()), panel, &mut self.frame);
        let written = match composed {
            Ok(()) => taken.1.frame(&self.frame).map_err(FilmError::from),
            Err(e) => Err(e.into()),
        };
        self.writer = Some(taken);
        written
    }

    fn end(&mut self, path: &Path) -> Result<(), FilmError> {
        if let Some((temporary, writer)) = self.writer.take() {
            writer.into_inner().sync_all()?;
            std::fs::rename(temporary, path)?;
        }
        Ok(())
    }

    fn discard(&mut self) {
        if let Some((temporary, _)) = self.writer.take() {
            // what stays is removed by the next film
            let _ = std::fs::remove_file(temporary);
        }
    }
}

impl Drop for RoomFilm {
    fn drop(&mut self) {
        self.discard();
    }
}
