//! Arrays over the environments of a vector.

use babybench::sensors::{EYES_DEPTH, EYES_GRAY, EYES_SEGMENTATION};
use babybench::vector::Buffers;
use numpy::PyReadwriteArray1;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::info::Space;
use crate::observation::{GOALS, Maps, Slab};

/// Arrays over environments, which Rust writes and Python reads.
pub struct Arrays {
    pub rows: usize,
    /// Observations by key, as Python sees them.
    pub dict: Py<PyDict>,
    proprioception: Slab<f64>,
    touch: Option<Slab<f32>>,
    /// Values of a touch sensor.
    touch_width: usize,
    /// For each row the touch sensors that are not zero.
    touched: Vec<Vec<u32>>,
    pooled: Option<Slab<f64>>,
    pain: Option<Slab<f32>>,
    eyes: Option<[Slab<u8>; 2]>,
    maps: Maps,
    vestibular: Option<Slab<f64>>,
    /// Achieved and desired.
    goals: Option<[Slab<f64>; 2]>,
    pub rewards: Slab<f64>,
    pub terminated: Slab<bool>,
    pub truncated: Slab<bool>,
}

impl Arrays {
    pub fn new(py: Python<'_>, rows: usize, spaces: &[Space], touch_width: usize) -> PyResult<Self> {
        let shape = |key: &str| {
            let of = spaces.iter().find(|space| space.0 == key)?;
            Some([&[rows], &of.1[..]].concat())
        };
        fn slab<T: numpy::Element>(py: Python<'_>, shape: Option<Vec<usize>>) -> PyResult<Option<Slab<T>>> {
            shape.map(|shape| Slab::new(py, &shape)).transpose()
        }
        let touch = slab(py, shape("touch"))?;
        let eyes = slab(py, shape("eye_left"))?.zip(slab(py, shape("eye_right"))?);
        let goals = slab(py, shape(GOALS[0]))?.zip(slab(py, shape(GOALS[1]))?);
        let dict = PyDict::new(py);
        let arrays = Self {
            rows,
            maps: Maps::new(&dict, shape)?,
            dict: dict.unbind(),
            proprioception: Slab::new(py, &shape("observation").unwrap_or_default())?,
            touched: touch.iter().flat_map(|_| vec![Vec::new(); rows]).collect(),
            touch,
            touch_width,
            pooled: slab(py, shape("touch_pooled"))?,
            pain: slab(py, shape("pain"))?,
            eyes: eyes.map(|(left, right)| [left, right]),
            vestibular: slab(py, shape("vestibular"))?,
            goals: goals.map(|(achieved, desired)| [achieved, desired]),
            rewards: Slab::new(py, &[rows])?,
            terminated: Slab::new(py, &[rows])?,
            truncated: Slab::new(py, &[rows])?,
        };
        let dict = arrays.dict.bind(py);
        dict.set_item("observation", &arrays.proprioception.view)?;
        if let Some(touch) = &arrays.touch {
            dict.set_item("touch", &touch.view)?;
        }
        if let Some(pooled) = &arrays.pooled {
            dict.set_item("touch_pooled", &pooled.view)?;
        }
        if let Some(pain) = &arrays.pain {
            dict.set_item("pain", &pain.view)?;
        }
        if let Some([left, right]) = &arrays.eyes {
            dict.set_item("eye_left", &left.view)?;
            dict.set_item("eye_right", &right.view)?;
        }
        if let Some(vestibular) = &arrays.vestibular {
            dict.set_item("vestibular", &vestibular.view)?;
        }
        for (key, slab) in GOALS.into_iter().zip(arrays.goals.iter().flatten()) {
            dict.set_item(key, &slab.view)?;
        }
        Ok(arrays)
    }

    /// Returns the observations in arrays of Python's own, or as read-only views.
    pub fn observations<'py>(&mut self, py: Python<'py>, copy: bool) -> PyResult<Bound<'py, PyDict>> {
        if !copy {
            return Ok(self.dict.bind(py).clone());
        }
        let dict = PyDict::new(py);
        put(&dict, EYES_GRAY, &mut self.maps.gray)?;
        put(&dict, EYES_DEPTH, &mut self.maps.depth)?;
        put(&dict, EYES_SEGMENTATION, &mut self.maps.segmentation)?;
        let whole = |from: &[f64], to: &mut [f64]| to.copy_from_slice(from);
        dict.set_item(intern!(py, "observation"), self.proprioception.copy(py, whole)?)?;
        if let Some(touch) = &mut self.touch {
            let (width, touched) = (self.touch_width, &self.touched);
            let sparse = |from: &[f32], to: &mut [f32]| copy_touched(from, to, width, touched);
            dict.set_item(intern!(py, "touch"), touch.copy(py, sparse)?)?;
        }
        if let Some(pooled) = &mut self.pooled {
            dict.set_item(intern!(py, "touch_pooled"), pooled.copy(py, whole)?)?;
        }
        if let Some(pain) = &mut self.pain {
            let whole = |from: &[f32], to: &mut [f32]| to.copy_from_slice(from);
            dict.set_item(intern!(py, "pain"), pain.copy(py, whole)?)?;
        }
        put(&dict, ["eye_left", "eye_right"], &mut self.eyes)?;
        if let Some(vestibular) = &mut self.vestibular {
            dict.set_item(intern!(py, "vestibular"), vestibular.copy(py, whole)?)?;
        }
        put(&dict, GOALS, &mut self.goals)?;
        Ok(dict)
    }

    /// Lends all arrays to work that fills them.
    pub fn fill<R>(&mut self, py: Python<'_>, work: impl FnOnce(Buffers<'_>) -> PyResult<R>) -> PyResult<R> {
        let mut proprioception = self.proprioception.lend(py);
        let mut touch = self.touch.as_ref().map(|slab| slab.lend(py));
        let mut pooled = self.pooled.as_ref().map(|slab| slab.lend(py));
        let mut pain = self.pain.as_ref().map(|slab| slab.lend(py));
        let mut goals = lend(py, &self.goals);
        let (left, right) = match &self.eyes {
            Some([left, right]) => (Some(left), Some(right)),
            None => (None, None),
        };
        let (mut left, mut right) = (left.map(|slab| slab.lend(py)), right.map(|slab| slab.lend(py)));
        let mut gray = lend(py, &self.maps.gray);
        let mut depth = lend(py, &self.maps.depth);
        let mut geoms = lend(py, &self.maps.segmentation);
        let mut vestibular = self.vestibular.as_ref().map(|slab| slab.lend(py));
        let mut rewards = self.rewards.lend(py);
        let (mut terminated, mut truncated) = (self.terminated.lend(py), self.truncated.lend(py));
        let touched = touch.is_some().then_some(&mut self.touched[..]);
        let [achieved_goal, desired_goal] = match slices(&mut goals)? {
            Some([achieved, desired]) => [Some(achieved), Some(desired)],
            None => [None, None],
        };
        work(Buffers {
            proprioception: Some(proprioception.as_slice_mut()?),
            touch: slice(&mut touch)?,
            touch_pooled: slice(&mut pooled)?,
            pain: slice(&mut pain)?,
            eye_left: slice(&mut left)?,
            eye_right: slice(&mut right)?,
            eye_gray: slices(&mut gray)?,
            eye_depth: slices(&mut depth)?,
            eye_segmentation: slices(&mut geoms)?,
            vestibular: slice(&mut vestibular)?,
            rewards: Some(rewards.as_slice_mut()?),
            terminated: Some(terminated.as_slice_mut()?),
            truncated: Some(truncated.as_slice_mut()?),
            touched,
            achieved_goal,
            desired_goal,
        })
    }
}

/// Copies touch of which only what is felt is not zero: a long row for each environment.
fn copy_touched(from: &[f32], to: &mut [f32], width: usize, touched: &[Vec<u32>]) {
    to.fill(0.0);
    let row = from.len() / touched.len().max(1);
    for (env, sensors) in touched.iter().enumerate() {
        for &sensor in sensors {
            let first = env * row + width * sensor as usize;
            to[first..first + width].copy_from_slice(&from[first..first + width]);
        }
    }
}

/// Puts copies of the images of both eyes into a dictionary, if there are any.
fn put<T: numpy::Element + Copy>(
    dict: &Bound<'_, PyDict>,
    keys: [&str; 2],
    slabs: &mut Option<[Slab<T>; 2]>,
) -> PyResult<()> {
    for (key, slab) in keys.into_iter().zip(slabs.iter_mut().flatten()) {
        dict.set_item(key, slab.copy(dict.py(), |from, to| to.copy_from_slice(from))?)?;
    }
    Ok(())
}

fn slice<'a, T: numpy::Element>(array: &'a mut Option<PyReadwriteArray1<'_, T>>) -> PyResult<Option<&'a mut [T]>> {
    Ok(array.as_mut().map(|array| array.as_slice_mut()).transpose()?)
}

fn lend<'py, T: numpy::Element>(
    py: Python<'py>,
    slabs: &Option<[Slab<T>; 2]>,
) -> Option<[PyReadwriteArray1<'py, T>; 2]> {
    slabs.as_ref().map(|pair| pair.each_ref().map(|slab| slab.lend(py)))
}

fn slices<'a, T: numpy::Element>(
    arrays: &'a mut Option<[PyReadwriteArray1<'_, T>; 2]>,
) -> PyResult<Option<[&'a mut [T]; 2]>> {
    let Some([left, right]) = arrays else { return Ok(None) };
    Ok(Some([left.as_slice_mut()?, right.as_slice_mut()?]))
}
