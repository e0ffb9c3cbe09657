//! Image submissions, and how their images are read back.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::task::{Context, Poll};

use super::device::Gpu;
use super::map_status::MapStatus;
use super::{Channel, GpuError};
use crate::RenderError;

/// The rows of an image in the buffer, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    pub offset: usize,
    pub pitch: usize,
    pub width: usize,
    pub height: usize,
}

/// Buffers that can be reused.
pub type BufferPool = Arc<Mutex<Vec<wgpu::Buffer>>>;

/// Images that the device is drawing. Several submissions may be pending at once.
#[derive(Debug)]
#[must_use = "images are lost unless they are read"]
pub struct Pending<C: Channel> {
    gpu: Gpu,
    slots: Vec<Slot>,
    transfer: Option<Transfer>,
    channel: std::marker::PhantomData<C>,
}

#[derive(Debug)]
struct Transfer {
    buffer: wgpu::Buffer,
    #[cfg_attr(target_arch = "wasm32", allow(dead_code))] // browsers cannot wait
    submission: wgpu::SubmissionIndex,
    arrival: Arc<Mutex<MapStatus>>,
    /// Notified when the buffer has arrived.
    #[cfg_attr(target_arch = "wasm32", allow(dead_code))] // browsers cannot wait
    told: Arc<Condvar>,
    pool: BufferPool,
}

/// Images, one after the other: rows from the top, three values for each pixel of [`Rgb`](super::Rgb), one of the
/// other kinds.
#[derive(Clone, Debug, PartialEq)]
pub struct Images<C: Channel> {
    values: Vec<C::Value>,
    /// Index of the first value of each image, and the end.
    starts: Vec<usize>,
}

impl<C: Channel> Images<C> {
    /// Returns the number of images.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Returns whether there are no images.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns one image, by its index among the requests.
    pub fn get(&self, index: usize) -> Option<&[C::Value]> {
        self.values.get(*self.starts.get(index)?..*self.starts.get(index + 1)?)
    }

    /// Iterates over the images, in the order of the requests.
    pub fn iter(&self) -> impl Iterator<Item = &[C::Value]> {
        self.starts.windows(2).map(|w| &self.values[w[0]..w[1]])
    }

    /// Returns all images; when their sizes are equal, an array of shape (images, height, width, values).
    pub fn as_slice(&self) -> &[C::Value] {
        &self.values
    }

    /// Returns all images as an owned vector; see [`Images::as_slice`].
    pub fn into_vec(self) -> Vec<C::Value> {
        self.values
    }
}

impl<C: Channel> Pending<C> {
    /// Creates an empty submission.
    pub(super) fn none(gpu: &Gpu) -> Self {
        Self {
            gpu: gpu.clone(),
            slots: Vec::new(),
            transfer: None,
            channel: std::marker::PhantomData,
        }
    }

    /// Requests the contents of a buffer that a submission fills.
    pub(super) fn new(
        gpu: &Gpu,
        slots: Vec<Slot>,
        buffer: wgpu::Buffer,
        submission: wgpu::SubmissionIndex,
        pool: &BufferPool,
    ) -> Self {
        let arrival = Arc::new(Mutex::new(MapStatus::default()));
        let told = Arc::new(Condvar::new());
        let (of_device, waiting) = (arrival.clone(), told.clone());
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            let mut arrival = of_device.lock().unwrap_or_else(PoisonError::into_inner);
            arrival.mapped = Some(result);
            waiting.notify_all();
            if let Some(waker) = arrival.waker.take() {
                waker.wake();
            }
        });
        let transfer = Some(Transfer {
            buffer,
            submission,
            arrival,
            told,
            pool: pool.clone(),
        });
        Self {
            gpu: gpu.clone(),
            slots,
            transfer,
            channel: std::marker::PhantomData,
        }
    }

    /// Waits for the images without blocking the thread: in browsers until the event loop delivers them, elsewhere by polling the device whenever the
    /// future is polled.
    ///
    /// # Errors
    /// Fails if the device was lost, ran out of memory or reported an error.
    pub async fn read(self) -> Result<Images<C>, RenderError> {
        if let Some(transfer) = &self.transfer {
            MapFuture {
                gpu: &self.gpu,
                transfer,
            }
            .await?;
        }
        self.collect()
    }

    /// Waits for the images, blocking the thread.
    ///
    /// # Errors
    /// Fails like [`Pending::read`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(self) -> Result<Images<C>, RenderError> {
        self.block()?;
        self.collect()
    }

    /// Waits like [`Pending::wait`] and writes each image into its own buffer: slices of one array, for example,
    /// by `chunks_exact_mut`.
    ///
    /// # Errors
    /// Fails like [`Pending::read`], or if the length of a buffer differs from that of its image.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait_into<'o>(self, outs: impl IntoIterator<Item = &'o mut [C::Value]>) -> Result<(), RenderError> {
        self.block()?;
        self.unpack(outs)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn block(&self) -> Result<(), GpuError> {
        let Some(transfer) = &self.transfer else {
            return Ok(());
        };
        let wait = wgpu::PollType::Wait {
            submission_index: Some(transfer.submission.clone()),
            timeout: None,
        };
        let polled = self.gpu.device.poll(wait);
        self.gpu.check()?;
        polled.map_err(|e| GpuError::Device(e.to_string()))?;
        match transfer.arrived() {
            Some(result) => result.map_err(|e| GpuError::Device(e.to_string())),
            None => Err(GpuError::Device("it finished without giving its pictures".to_string())),
        }
    }

    fn collect(self) -> Result<Images<C>, RenderError> {
        let mut starts = vec![0];
        for slot in &self.slots {
            starts.push(starts[starts.len() - 1] + slot.width * slot.height * C::PER_PIXEL);
        }
        let mut all = vec![C::Value::default(); starts[starts.len() - 1]];
        let mut rest = &mut all[..];
        let lengths = starts.windows(2).map(|w| w[1] - w[0]);
        self.unpack(lengths.filter_map(|n| rest.split_off_mut(..n)))?;
        Ok(Images { values: all, starts })
    }

    /// Copies the images, which are upside down, out of the mapped buffer.
    fn unpack<'o>(self, outs: impl IntoIterator<Item = &'o mut [C::Value]>) -> Result<(), RenderError> {
        self.gpu.check()?;
        let Some(Transfer { buffer, pool, .. }) = self.transfer else {
            return Ok(());
        };
        let mut outs = outs.into_iter();
        let view = buffer
            .get_mapped_range(..)
            .map_err(|e| GpuError::Device(e.to_string()))?;
        for slot in &self.slots {
            let picture = outs.next().unwrap_or_default();
            let (found, expected) = (picture.len(), slot.width * slot.height * C::PER_PIXEL);
            if found != expected {
                return Err(RenderError::Buffer { found, expected });
            }
            let rows = picture.chunks_exact_mut(slot.width * C::PER_PIXEL);
            // drawn upside down, for OpenGL's sample positions
            for (row, from) in rows.rev().zip(view[slot.offset..].chunks(slot.pitch)) {
                C::unpack(&from[..slot.width * C::OUTPUT.bytes() as usize], row);
            }
        }
        drop(view);
        buffer.unmap();
        // only now: a buffer that is still mapped cannot be written to
        pool.lock().unwrap_or_else(PoisonError::into_inner).push(buffer);
        Ok(())
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl Transfer {
    /// Returns the device's answer once it has finished the submission. Another thread that polls the same device may have taken the answer first and
    /// be about to deliver it.
    fn arrived(&self) -> Option<Result<(), wgpu::BufferAsyncError>> {
        const LONGEST: std::time::Duration = std::time::Duration::from_secs(10);
        let arrival = self.arrival.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.told.wait_timeout_while(arrival, LONGEST, |a| a.mapped.is_none());
        waited.unwrap_or_else(PoisonError::into_inner).0.mapped.clone()
    }
}

/// A future that is ready when the buffer is mapped.
struct MapFuture<'a> {
    gpu: &'a Gpu,
    transfer: &'a Transfer,
}

impl Future for MapFuture<'_> {
    type Output = Result<(), GpuError>;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let failed = |e: &dyn std::fmt::Display| Poll::Ready(Err(GpuError::Device(e.to_string())));
        if let Err(e) = self.gpu.device.poll(wgpu::PollType::Poll) {
            return failed(&e);
        }
        if let Err(e) = self.gpu.check() {
            return Poll::Ready(Err(e));
        }
        let mut arrival = self.transfer.arrival.lock().unwrap_or_else(PoisonError::into_inner);
        match &arrival.mapped {
            Some(Ok(())) => Poll::Ready(Ok(())),
            Some(Err(e)) => failed(e),
            None => {
                arrival.waker = Some(context.waker().clone());
                drop(arrival);
                // WebGPU reports when the buffer is ready, but WebGL2 and native devices only when they are polled
                #[cfg(not(target_arch = "wasm32"))]
                context.waker().wake_by_ref();
                #[cfg(target_arch = "wasm32")]
                super::timer::later(&self.transfer.arrival);
                Poll::Pending
            }
        }
    }
}
