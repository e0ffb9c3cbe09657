//! Delays of senses, like those of nerves.

use super::{Signal, Transform};
use crate::sensors::{EyeImages, SkinValues};
use crate::spaces::NumpyRng;

/// Values that can wait in a delay.
pub(crate) trait DelayValues {
    /// Exchanges the values of two of the same size.
    fn exchange(&mut self, other: &mut Self);
    /// Takes over the values of another of the same size.
    fn assign(&mut self, other: &Self);
    fn save(&self, out: &mut Vec<u8>);
    /// Restores the memory saved at the front of `bytes`; `false` if they do not fit.
    fn load(&mut self, bytes: &mut &[u8]) -> bool;
    fn memory(&self) -> usize;
}

/// A number that can be written to bytes.
trait ByteNumber: Copy {
    const SIZE: usize;
    fn write(self, out: &mut Vec<u8>);
    /// Reads a number that a sense can report.
    fn read(bytes: &[u8]) -> Option<Self>;
}

macro_rules! numbers {
    ($($type:ident: $fits:expr;)*) => {$(
        impl ByteNumber for $type {
            const SIZE: usize = size_of::<$type>();
            fn write(self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
            fn read(bytes: &[u8]) -> Option<Self> {
                let number = $type::from_le_bytes(bytes.try_into().ok()?);
                let fits: fn($type) -> bool = $fits;
                fits(number).then_some(number)
            }
        }
    )*};
}

numbers! {
    f64: |v| v.is_finite();
    f32: |v| !v.is_nan(); // distances may be infinite
    u8: |_| true;
    i32: |_| true;
    u32: |_| true;
}

fn take<'b>(bytes: &mut &'b [u8], n: usize) -> Option<&'b [u8]> {
    let (head, tail) = bytes.split_at_checked(n)?;
    *bytes = tail;
    Some(head)
}

impl<T: ByteNumber> DelayValues for Vec<T> {
    fn exchange(&mut self, other: &mut Self) {
        self.swap_with_slice(other);
    }
    fn assign(&mut self, other: &Self) {
        self.copy_from_slice(other);
    }
    fn save(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|v| v.write(out));
    }
    fn load(&mut self, bytes: &mut &[u8]) -> bool {
        self.iter_mut().all(|v| {
            let read = take(bytes, T::SIZE).and_then(T::read);
            read.map(|number| *v = number).is_some()
        })
    }
    fn memory(&self) -> usize {
        T::SIZE * self.len()
    }
}

impl DelayValues for EyeImages {
    fn exchange(&mut self, other: &mut Self) {
        std::mem::swap(self, other);
    }
    fn assign(&mut self, other: &Self) {
        self.copy_from(other);
    }
    fn save(&self, out: &mut Vec<u8>) {
        self.rgb.save(out);
        self.gray.save(out);
        self.depth.save(out);
        self.segmentation.save(out);
    }
    fn load(&mut self, bytes: &mut &[u8]) -> bool {
        self.rgb.load(bytes) && self.gray.load(bytes) && self.depth.load(bytes) && self.segmentation.load(bytes)
    }
    fn memory(&self) -> usize {
        self.bytes()
    }
}

impl DelayValues for SkinValues {
    fn exchange(&mut self, other: &mut Self) {
        std::mem::swap(self, other);
    }
    fn assign(&mut self, other: &Self) {
        self.copy_from(other);
    }
    fn save(&self, out: &mut Vec<u8>) {
        (self.touched().len() as u32).write(out);
        for &sensor in self.touched() {
            sensor.write(out);
            self.of(sensor as usize).iter().for_each(|v| v.write(out));
        }
    }
    fn load(&mut self, bytes: &mut &[u8]) -> bool {
        self.clear();
        let mut word = || take(bytes, u32::SIZE).and_then(u32::read).map(|v| v as usize);
        let Some(touched) = word() else { return false };
        (0..touched).all(|_| {
            let sensor = take(bytes, u32::SIZE).and_then(u32::read).map(|v| v as usize);
            let Some(sensor) = sensor.filter(|&s| s < self.sensors()) else {
                return false;
            };
            self.of_mut(sensor).iter_mut().all(|v| {
                let read = take(bytes, f32::SIZE).and_then(f32::read).filter(|v| v.is_finite());
                read.map(|number| *v = number).is_some()
            })
        })
    }
    fn memory(&self) -> usize {
        4 * self.values().len() + 5 * self.sensors()
    }
}

/// Values that each wait for the same number of steps.
#[derive(Clone, Debug)]
struct RingBuffer<T> {
    slots: Vec<T>,
    next: usize,
    /// Whether the slots hold values; if not, the first values fill all of them.
    filled: bool,
}

impl<T: DelayValues + Clone> RingBuffer<T> {
    fn new(steps: usize, empty: T) -> Self {
        Self {
            slots: vec![empty; steps],
            next: 0,
            filled: false,
        }
    }

    /// Exchanges new values for those from as many steps ago as there are slots.
    fn pass(&mut self, values: &mut T) {
        if !self.filled {
            self.fill(values);
        }
        let steps = self.slots.len();
        if let Some(slot) = self.slots.get_mut(self.next) {
            // the slot is read and written in one exchange: its values are the oldest, and the next to be overwritten
            slot.exchange(values);
            self.next = (self.next + 1) % steps;
        }
    }

    fn fill(&mut self, values: &T) {
        self.slots.iter_mut().for_each(|slot| slot.assign(values));
        (self.next, self.filled) = (0, true);
    }

    /// Writes the values in the order of their release.
    fn save(&self, out: &mut Vec<u8>) {
        out.push(u8::from(self.filled));
        if self.filled {
            // independent of the ring's position, so equal delays have equal snapshots
            let (late, early) = self.slots.split_at(self.next);
            early.iter().chain(late).for_each(|slot| slot.save(out));
        }
    }

    fn load(&mut self, mut bytes: &[u8]) -> bool {
        self.next = 0;
        let flag = take(&mut bytes, 1);
        self.filled = flag == Some(&[1]);
        let known = self.filled || flag == Some(&[0]);
        known && (!self.filled || self.slots.iter_mut().all(|slot| slot.load(&mut bytes))) && bytes.is_empty()
    }

    fn memory(&self) -> usize {
        self.slots.iter().map(DelayValues::memory).sum()
    }
}

/// A delay line for vectors of single-precision numbers, such as actions.
///
/// ```
/// use babybench::sensors::transform::DelayLine;
///
/// let mut line = DelayLine::new(3, 1);
/// let out: Vec<f32> = (1..=8).map(|k| line.pass(&[k as f32])[0]).collect();
/// assert_eq!(out, [1.0, 1.0, 1.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
/// line.fill(&[0.0]);
/// assert_eq!(line.pass(&[9.0]), [0.0]);
/// ```
#[derive(Clone, Debug)]
pub struct DelayLine {
    ring: RingBuffer<Vec<f32>>,
    values: Vec<f32>,
}

impl DelayLine {
    /// Creates a line for vectors of a length. It returns the first vector until it is full.
    pub fn new(steps: usize, len: usize) -> Self {
        Self {
            ring: RingBuffer::new(steps, vec![0.0; len]),
            values: vec![0.0; len],
        }
    }

    /// Returns the number of steps.
    pub fn steps(&self) -> usize {
        self.ring.slots.len()
    }

    /// Pushes values, and returns the delayed ones.
    ///
    /// # Panics
    /// Values of another length.
    pub fn pass(&mut self, values: &[f32]) -> &[f32] {
        self.values.copy_from_slice(values);
        self.ring.pass(&mut self.values);
        &self.values
    }

    /// Fills the line with values, which it returns before later ones.
    ///
    /// # Panics
    /// Values of another length.
    pub fn fill(&mut self, values: &[f32]) {
        self.values.copy_from_slice(values);
        self.ring.fill(&self.values);
    }

    /// Empties the line: the next values fill it.
    pub fn clear(&mut self) {
        self.ring.filled = false;
    }

    pub(crate) fn save(&self, out: &mut Vec<u8>) {
        self.ring.save(out);
    }

    pub(crate) fn load(&mut self, bytes: &[u8]) -> bool {
        self.ring.load(bytes)
    }
}

/// A delay of a sense by a number of steps of the environment. Until they have passed, the first values of the episode
/// are repeated: the k-th observation has the values of step max(1, k - steps).
#[derive(Clone, Debug)]
pub struct Delay {
    steps: usize,
    /// Duration of a step in ms, for display.
    step_ms: f64,
    memory: DelayQueue,
}

/// The queue of delayed values, created with the size of the first ones.
#[derive(Clone, Debug)]
enum DelayQueue {
    Numbers(RingBuffer<Vec<f64>>, Vec<f64>),
    Skin(Box<RingBuffer<SkinValues>>),
    Eye(Box<RingBuffer<EyeImages>>),
}

impl Delay {
    /// Creates a delay of signals of the size of `like`, whose values are ignored. A step takes `step_ms` ms.
    pub fn new(steps: usize, step_ms: f64, like: &Signal<'_>) -> Self {
        let memory = match like {
            Signal::Numbers(values) => {
                let zeros = vec![0.0; values.len()];
                DelayQueue::Numbers(RingBuffer::new(steps, zeros.clone()), zeros)
            }
            Signal::Skin(values) => {
                let zeros = SkinValues::new(values.sensors(), values.width());
                // a clone would not keep the capacity for all sensors
                let slots = (0..steps).map(|_| SkinValues::new(zeros.sensors(), zeros.width()));
                DelayQueue::Skin(Box::new(RingBuffer {
                    slots: slots.collect(),
                    next: 0,
                    filled: false,
                }))
            }
            Signal::Eye { images, .. } => DelayQueue::Eye(Box::new(RingBuffer::new(steps, EyeImages::clone(images)))),
        };
        Self { steps, step_ms, memory }
    }

    /// Returns the number of steps.
    pub fn steps(&self) -> usize {
        self.steps
    }
}

impl Transform for Delay {
    fn describe(&self) -> String {
        let (steps, ms) = (self.steps, self.steps as f64 * self.step_ms);
        let plural = if steps == 1 { "" } else { "s" };
        format!("delay of {steps} step{plural} ({ms} ms)")
    }

    fn apply(&mut self, signal: Signal<'_>, _: &mut NumpyRng) {
        match (&mut self.memory, signal) {
            (DelayQueue::Numbers(ring, room), Signal::Numbers(values)) if room.len() == values.len() => {
                room.copy_from_slice(values);
                ring.pass(room);
                values.copy_from_slice(room);
            }
            (DelayQueue::Skin(ring), Signal::Skin(values)) => ring.pass(values),
            (DelayQueue::Eye(ring), Signal::Eye { images, .. }) => ring.pass(images),
            _ => {}
        }
    }

    fn reset(&mut self) {
        match &mut self.memory {
            DelayQueue::Numbers(ring, _) => ring.filled = false,
            DelayQueue::Skin(ring) => ring.filled = false,
            DelayQueue::Eye(ring) => ring.filled = false,
        }
    }

    fn save(&self, out: &mut Vec<u8>) {
        match &self.memory {
            DelayQueue::Numbers(ring, _) => ring.save(out),
            DelayQueue::Skin(ring) => ring.save(out),
            DelayQueue::Eye(ring) => ring.save(out),
        }
    }

    fn load(&mut self, bytes: &[u8]) -> bool {
        match &mut self.memory {
            DelayQueue::Numbers(ring, _) => ring.load(bytes),
            DelayQueue::Skin(ring) => ring.load(bytes),
            DelayQueue::Eye(ring) => ring.load(bytes),
        }
    }

    fn memory(&self) -> usize {
        match &self.memory {
            DelayQueue::Numbers(ring, _) => ring.memory(),
            DelayQueue::Skin(ring) => ring.memory(),
            DelayQueue::Eye(ring) => ring.memory(),
        }
    }
}
