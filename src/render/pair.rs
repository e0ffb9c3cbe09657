//! Two images at a time: a thread draws the second while the caller draws the first.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Mutex, PoisonError};

use crate::math::{Mat3, Vec3};
use crate::threads::{Job, PARALLEL, ThreadPool};
use crate::view::ImageBuffers;
use crate::{CpuRenderer, Poses, RenderError, RenderRequest, Scenery, View};

/// Draws two images at once, one of them on a separate thread. The thread starts with the first pair of images.
#[derive(Default)]
pub struct PairRenderer {
    /// The drawing state, while the thread does not hold it.
    drawing: Option<Box<DrawingJob>>,
    thread: Option<DrawingThread>,
}

/// The thread, with the id of the process that started it.
struct DrawingThread {
    pool: ThreadPool<DrawingJob>,
    process: u32,
}

impl PairRenderer {
    /// Returns whether a second thread would help: the build has threads, and the machine another core.
    pub fn is_of_use() -> bool {
        PARALLEL && std::thread::available_parallelism().is_ok_and(|cores| cores.get() > 1)
    }

    /// Draws two images of a scene: the first with the caller's renderer.
    ///
    /// # Errors
    /// As [`CpuRenderer::draw`], the first image's first.
    pub fn draw(
        &mut self,
        scenery: &Arc<Scenery>,
        own: &mut CpuRenderer,
        [first, second]: [(&RenderRequest, ImageBuffers<'_>); 2],
    ) -> Result<(), RenderError> {
        let draw_first = || own.draw(scenery, &first.0.poses, &first.0.view, first.1);
        let mut drawing = match self.drawing.take() {
            Some(drawing) => drawing,
            None => Box::new(DrawingJob::new(scenery)),
        };
        drawing.take_up(second.0, &second.1);
        let drawn = match self.thread() {
            Some(DrawingThread { pool, .. }) => {
                pool.submit(std::iter::once(drawing), false);
                // unwinding past the thread would lose the drawing that it holds
                let drawn = catch_unwind(AssertUnwindSafe(draw_first));
                drawing = pool.wait_next();
                drawn.unwrap_or_else(|payload| resume_unwind(payload))
            }
            // the system gives no thread: the caller draws both
            None => {
                drawing.run();
                draw_first()
            }
        };
        if let Some(payload) = drawing.panic().take() {
            resume_unwind(payload);
        }
        let outcome = drawn.and(drawing.hand_over(second.1));
        self.drawing = Some(drawing);
        outcome
    }

    /// Wakes the thread, if there is one in this process, because there will soon be two images to draw.
    pub fn wake(&self) {
        if let Some(thread) = self.thread.as_ref().filter(|t| t.process == std::process::id()) {
            thread.pool.wake();
        }
    }

    /// Returns the number of passes of the thread over a scene's geometry.
    pub fn passes(&self) -> u64 {
        self.drawing.as_ref().map_or(0, |drawing| drawing.renderer.passes())
    }

    /// Returns the thread, starting it if needed. A forked process starts its own.
    fn thread(&mut self) -> Option<&DrawingThread> {
        let process = std::process::id();
        if self.thread.as_ref().is_some_and(|thread| thread.process != process) {
            self.leave_behind();
        }
        if self.thread.is_none() {
            let pool = ThreadPool::of_one().ok()?;
            self.thread = Some(DrawingThread { pool, process });
        }
        self.thread.as_ref()
    }

    /// Forgets a thread of the parent process. A fork copies memory but not threads, so joining it would block forever.
    fn leave_behind(&mut self) {
        std::mem::forget(self.thread.take());
    }
}

impl Drop for PairRenderer {
    fn drop(&mut self) {
        if self.thread.as_ref().is_some_and(|t| t.process != std::process::id()) {
            self.leave_behind();
        }
    }
}

impl std::fmt::Debug for PairRenderer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pair").finish_non_exhaustive()
    }
}

/// The images of one view to draw, with their buffers.
struct DrawingJob {
    scenery: Arc<Scenery>,
    renderer: CpuRenderer,
    poses: PosesBuffer,
    view: View,
    rgb: Image<u8>,
    gray: Image<u8>,
    depth: Image<f32>,
    segmentation: Image<i32>,
    outcome: Result<(), RenderError>,
    /// The payload of a panic. The mutex makes the type `Sync`; a payload alone is not.
    panicked: Mutex<Option<Box<dyn Any + Send>>>,
}

impl DrawingJob {
    fn new(scenery: &Arc<Scenery>) -> Self {
        Self {
            scenery: scenery.clone(),
            renderer: CpuRenderer::new(),
            poses: PosesBuffer::default(),
            view: View {
                camera: View::FREE,
                width: 0,
                height: 0,
            },
            rgb: Image::default(),
            gray: Image::default(),
            depth: Image::default(),
            segmentation: Image::default(),
            outcome: Ok(()),
            panicked: Mutex::new(None),
        }
    }

    /// Takes over a request, and reserves memory for as many values as `images` has.
    fn take_up(&mut self, request: &RenderRequest, images: &ImageBuffers<'_>) {
        self.view = request.view;
        self.poses.copy_from(&request.poses);
        self.rgb.make_room(images.rgb.as_deref());
        self.gray.make_room(images.gray.as_deref());
        self.depth.make_room(images.depth.as_deref());
        self.segmentation.make_room(images.segmentation.as_deref());
    }

    fn panic(&mut self) -> &mut Option<Box<dyn Any + Send>> {
        self.panicked.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// Copies the images to the caller's buffers.
    fn hand_over(&mut self, images: ImageBuffers<'_>) -> Result<(), RenderError> {
        std::mem::replace(&mut self.outcome, Ok(()))?;
        self.rgb.hand_over(images.rgb);
        self.gray.hand_over(images.gray);
        self.depth.hand_over(images.depth);
        self.segmentation.hand_over(images.segmentation);
        Ok(())
    }
}

impl Job for DrawingJob {
    fn run(&mut self) {
        let images = ImageBuffers {
            rgb: self.rgb.wanted(),
            gray: self.gray.wanted(),
            depth: self.depth.wanted(),
            segmentation: self.segmentation.wanted(),
        };
        let (renderer, scenery, poses, view) = (&mut self.renderer, &self.scenery, self.poses.lend(), &self.view);
        let drawn = catch_unwind(AssertUnwindSafe(|| renderer.draw(scenery, &poses, view, images)));
        match drawn {
            Ok(outcome) => self.outcome = outcome,
            Err(payload) => *self.panic() = Some(payload),
        }
    }
}

/// The buffer of an image, and whether the image is wanted.
#[derive(Default)]
struct Image<T> {
    values: Vec<T>,
    is_wanted: bool,
}

impl<T: Copy + Default> Image<T> {
    fn make_room(&mut self, like: Option<&[T]>) {
        self.is_wanted = like.is_some();
        self.values.resize(like.map_or(0, <[T]>::len), T::default());
    }

    fn wanted(&mut self) -> Option<&mut [T]> {
        self.is_wanted.then_some(&mut self.values)
    }

    fn hand_over(&self, out: Option<&mut [T]>) {
        if let Some(out) = out {
            out.copy_from_slice(&self.values);
        }
    }
}

/// A copy of poses.
#[derive(Default)]
struct PosesBuffer {
    geom_xpos: Vec<Vec3>,
    geom_xmat: Vec<Mat3>,
    geom_size: Vec<Vec3>,
    site_xpos: Vec<Vec3>,
    site_xmat: Vec<Mat3>,
    ten_wrapadr: Vec<usize>,
    ten_wrapnum: Vec<usize>,
    wrap_xpos: Vec<Vec3>,
    wrap_obj: Vec<i32>,
    cam_xpos: Vec<Vec3>,
    cam_xmat: Vec<Mat3>,
    free: Option<(Vec3, Mat3)>,
    xpos: Vec<Vec3>,
    xmat: Vec<Mat3>,
    subtree_com: Vec<Vec3>,
    flexvert_xpos: Vec<Vec3>,
}

impl PosesBuffer {
    fn copy_from(&mut self, poses: &Poses) {
        fn copy<T: Copy>(to: &mut Vec<T>, from: &[T]) {
            to.clear();
            to.extend_from_slice(from);
        }
        copy(&mut self.geom_xpos, poses.geom_xpos);
        copy(&mut self.geom_xmat, poses.geom_xmat);
        copy(&mut self.geom_size, poses.geom_size);
        copy(&mut self.site_xpos, poses.site_xpos);
        copy(&mut self.site_xmat, poses.site_xmat);
        copy(&mut self.ten_wrapadr, poses.ten_wrapadr);
        copy(&mut self.ten_wrapnum, poses.ten_wrapnum);
        copy(&mut self.wrap_xpos, poses.wrap_xpos);
        copy(&mut self.wrap_obj, poses.wrap_obj);
        copy(&mut self.cam_xpos, poses.cam_xpos);
        copy(&mut self.cam_xmat, poses.cam_xmat);
        self.free = poses.free;
        copy(&mut self.xpos, poses.xpos);
        copy(&mut self.xmat, poses.xmat);
        copy(&mut self.subtree_com, poses.subtree_com);
        copy(&mut self.flexvert_xpos, poses.flexvert_xpos);
    }

    fn lend(&self) -> Poses<'_> {
        Poses {
            geom_xpos: &self.geom_xpos,
            geom_xmat: &self.geom_xmat,
            geom_size: &self.geom_size,
            site_xpos: &self.site_xpos,
            site_xmat: &self.site_xmat,
            ten_wrapadr: &self.ten_wrapadr,
            ten_wrapnum: &self.ten_wrapnum,
            wrap_xpos: &self.wrap_xpos,
            wrap_obj: &self.wrap_obj,
            cam_xpos: &self.cam_xpos,
            cam_xmat: &self.cam_xmat,
            free: self.free,
            xpos: &self.xpos,
            xmat: &self.xmat,
            subtree_com: &self.subtree_com,
            flexvert_xpos: &self.flexvert_xpos,
        }
    }
}
