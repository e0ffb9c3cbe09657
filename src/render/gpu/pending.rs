//! Pictures on their way back.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};

use super::device::Gpu;
use super::{Channel, GpuError};
use crate::render::RenderError;

/// Where the rows of a picture lie in the buffer, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    pub offset: usize,
    pub pitch: usize,
    pub width: usize,
    pub height: usize,
}

/// Buffers that can be used again.
pub type Pool = Arc<Mutex<Vec<wgpu::Buffer>>>;

/// What the device said about the buffer, and who waits for it.
#[derive(Debug, Default)]
struct Arrival {
    mapped: Option<Result<(), wgpu::BufferAsyncError>>,
    waker: Option<Waker>,
}

/// Pictures that the device is drawing. Several may be pending at once.
#[derive(Debug)]
#[must_use = "pictures are lost unless they are read"]
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
    arrival: Arc<Mutex<Arrival>>,
    pool: Pool,
}

/// Pictures, one after the other: of each, rows from the top, three values for each pixel of [`Rgb`](super::Rgb), one of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures<C: Channel> {
    values: Vec<C::Value>,
    /// Where each picture begins, and the end.
    starts: Vec<usize>,
}

impl<C: Channel> Pictures<C> {
    /// Number of pictures.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One picture, in the order of the shots.
    pub fn get(&self, index: usize) -> Option<&[C::Value]> {
        self.values.get(*self.starts.get(index)?..*self.starts.get(index + 1)?)
    }

    /// The pictures in turn.
    pub fn iter(&self) -> impl Iterator<Item = &[C::Value]> {
        self.starts.windows(2).map(|w| &self.values[w[0]..w[1]])
    }

    /// All pictures; of equal sizes, an array of shape (pictures, height, width, values).
    pub fn as_slice(&self) -> &[C::Value] {
        &self.values
    }

    /// As [`Pictures::as_slice`], owned.
    pub fn into_vec(self) -> Vec<C::Value> {
        self.values
    }
}

impl<C: Channel> Pending<C> {
    /// Nothing to wait for.
    pub(super) fn none(gpu: &Gpu) -> Self {
        Self {
            gpu: gpu.clone(),
            slots: Vec::new(),
            transfer: None,
            channel: std::marker::PhantomData,
        }
    }

    /// Asks for the contents of a buffer that a submission fills.
    pub(super) fn new(
        gpu: &Gpu,
        slots: Vec<Slot>,
        buffer: wgpu::Buffer,
        submission: wgpu::SubmissionIndex,
        pool: &Pool,
    ) -> Self {
        let arrival = Arc::new(Mutex::new(Arrival::default()));
        let told = arrival.clone();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            let mut arrival = told.lock().unwrap_or_else(PoisonError::into_inner);
            arrival.mapped = Some(result);
            if let Some(waker) = arrival.waker.take() {
                waker.wake();
            }
        });
        let transfer = Some(Transfer {
            buffer,
            submission,
            arrival,
            pool: pool.clone(),
        });
        Self {
            gpu: gpu.clone(),
            slots,
            transfer,
            channel: std::marker::PhantomData,
        }
    }

    /// Waits for the pictures without blocking the thread: in browsers until the event loop brings them, elsewhere by
    /// asking the device whenever the future is polled.
    ///
    /// # Errors
    /// The device was lost, ran out of memory or failed.
    pub async fn read(self) -> Result<Pictures<C>, RenderError> {
        if let Some(transfer) = &self.transfer {
            Mapped {
                gpu: &self.gpu,
                transfer,
            }
            .await?;
        }
        self.collect()
    }

    /// Waits for the pictures, blocking the thread.
    ///
    /// # Errors
    /// As [`Pending::read`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(self) -> Result<Pictures<C>, RenderError> {
        self.block()?;
        self.collect()
    }

    /// As [`Pending::wait`], each picture into memory of its own: pieces of an array, for example, by `chunks_exact_mut`.
    ///
    /// # Errors
    /// As [`Pending::read`]; memory of another length than its picture.
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
        match transfer.mapped() {
            Some(result) => result.map_err(|e| GpuError::Device(e.to_string())),
            None => Err(GpuError::Device("it finished without giving its pictures".to_string())),
        }
    }

    fn collect(self) -> Result<Pictures<C>, RenderError> {
        let mut starts = vec![0];
        for slot in &self.slots {
            starts.push(starts[starts.len() - 1] + slot.width * slot.height * C::PER_PIXEL);
        }
        let mut all = vec![C::Value::default(); starts[starts.len() - 1]];
        let mut rest = &mut all[..];
        let lengths = starts.windows(2).map(|w| w[1] - w[0]);
        self.unpack(lengths.filter_map(|n| rest.split_off_mut(..n)))?;
        Ok(Pictures { values: all, starts })
    }

    /// Copies the pictures, which are upside down, out of the mapped buffer.
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
            for (row, from) in rows.rev().zip(view[slot.offset..].chunks(slot.pitch)) {
                C::unpack(&from[..slot.width * C::OUTPUT.bytes() as usize], row);
            }
        }
        drop(view);
        buffer.unmap();
        pool.lock().unwrap_or_else(PoisonError::into_inner).push(buffer);
        Ok(())
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl Transfer {
    fn mapped(&self) -> Option<Result<(), wgpu::BufferAsyncError>> {
        let arrival = self.arrival.lock().unwrap_or_else(PoisonError::into_inner);
        arrival.mapped.clone()
    }
}

/// Ready when the buffer is mapped.
struct Mapped<'a> {
    gpu: &'a Gpu,
    transfer: &'a Transfer,
}

impl Future for Mapped<'_> {
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
                // outside browsers nobody tells us: ask again
                #[cfg(not(target_arch = "wasm32"))]
                context.waker().wake_by_ref();
                Poll::Pending
            }
        }
    }
}
