//! Observations as dictionaries of arrays: fresh ones, or views that each step brings up to date.

use babybench::Env;
use babybench::env::Observation;
use babybench::sensors::touch::POOLED;
use babybench::sensors::{EYES_DEPTH, EYES_GRAY, EYES_SEGMENTATION, SkinValues};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadwriteArray1};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::shaped;
use crate::info::Space;
use crate::recycled::Recycled;

/// The goal that a step achieved, and the one to be achieved.
pub const GOALS: [&str; 2] = ["achieved_goal", "desired_goal"];

/// Returns the goals of an observation, if it has any.
fn goals<'a>(o: &Observation<'a>) -> Option<[&'a [f64]; 2]> {
    Some([o.achieved_goal?, o.desired_goal?])
}

/// Returns a fresh dictionary of fresh arrays.
pub fn fresh<'py>(py: Python<'py>, env: &Env) -> PyResult<Bound<'py, PyDict>> {
    let (dict, o) = (PyDict::new(py), env.observation());
    dict.set_item(intern!(py, "observation"), PyArray1::from_slice(py, o.proprioception))?;
    if let Some(touch) = env.senses().touch_observed() {
        dict.set_item(intern!(py, "touch"), sparse(py, touch)?)?;
    }
    if let (Some(pool), Some(pooled)) = (env.senses().touch_pool(), o.touch_pooled) {
        dict.set_item(
            intern!(py, "touch_pooled"),
            shaped(py, pooled, &[pool.bodies().len(), POOLED])?,
        )?;
    }
    if let Some(pain) = env.senses().pain_observed() {
        dict.set_item(intern!(py, "pain"), sparse(py, pain)?)?;
    }
    if let (Some(vision), Some(left), Some(right)) = (env.senses().vision(), o.eye_left, o.eye_right) {
        dict.set_item(intern!(py, "eye_left"), shaped(py, left, &vision.shape())?)?;
        dict.set_item(intern!(py, "eye_right"), shaped(py, right, &vision.shape())?)?;
    }
    if let Some([height, width, _]) = env.senses().vision().map(|vision| vision.shape()) {
        let shape = [height, width];
        set_pair(&dict, EYES_GRAY, o.eye_gray, shape)?;
        set_pair(&dict, EYES_DEPTH, o.eye_depth, shape)?;
        set_pair(&dict, EYES_SEGMENTATION, o.eye_segmentation, shape)?;
    }
    if let Some(vestibular) = o.vestibular {
        dict.set_item(intern!(py, "vestibular"), PyArray1::from_slice(py, vestibular))?;
    }
    for (key, goal) in GOALS.into_iter().zip(goals(&o).into_iter().flatten()) {
        dict.set_item(key, PyArray1::from_slice(py, goal))?;
    }
    Ok(dict)
}

/// Puts fresh images of both eyes into a dictionary, if there are any.
fn set_pair<T: Element + Copy>(
    dict: &Bound<'_, PyDict>,
    keys: [&str; 2],
    images: Option<[&[T]; 2]>,
    shape: [usize; 2],
) -> PyResult<()> {
    for (key, image) in keys.into_iter().zip(images.into_iter().flatten()) {
        dict.set_item(key, shaped(dict.py(), image, &shape)?)?;
    }
    Ok(())
}

/// Returns an observation that no environment holds any more as a fresh dictionary of fresh arrays.
pub fn dict_of_row<'py>(py: Python<'py>, o: &Observation<'_>, spaces: &[Space]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, shape, ..) in spaces {
        let array = match *key {
            "observation" => shaped(py, o.proprioception, shape),
            "touch" => shaped(py, o.touch.unwrap_or_default(), shape),
            "touch_pooled" => shaped(py, o.touch_pooled.unwrap_or_default(), shape),
            "pain" => shaped(py, o.pain.unwrap_or_default(), shape),
            "eye_left" => shaped(py, o.eye_left.unwrap_or_default(), shape),
            "eye_right" => shaped(py, o.eye_right.unwrap_or_default(), shape),
            "eye_left_gray" => shaped(py, o.eye_gray.unwrap_or_default()[0], shape),
            "eye_right_gray" => shaped(py, o.eye_gray.unwrap_or_default()[1], shape),
            "eye_left_depth" => shaped(py, o.eye_depth.unwrap_or_default()[0], shape),
            "eye_right_depth" => shaped(py, o.eye_depth.unwrap_or_default()[1], shape),
            "eye_left_segmentation" => shaped(py, o.eye_segmentation.unwrap_or_default()[0], shape),
            "eye_right_segmentation" => shaped(py, o.eye_segmentation.unwrap_or_default()[1], shape),
            "achieved_goal" => shaped(py, o.achieved_goal.unwrap_or_default(), shape),
            "desired_goal" => shaped(py, o.desired_goal.unwrap_or_default(), shape),
            _ => shaped(py, o.vestibular.unwrap_or_default(), shape),
        };
        dict.set_item(*key, array?)?;
    }
    Ok(dict)
}

/// Returns touch or pain as a fresh array, of which only what feels something is written.
pub fn sparse<'py>(py: Python<'py>, touch: &SkinValues) -> PyResult<Bound<'py, PyArray1<f32>>> {
    let array = PyArray1::zeros(py, touch.values().len(), false);
    write_touched(array.readwrite().as_slice_mut()?, touch);
    Ok(array)
}

/// Writes what is felt into zeros.
pub fn write_touched(out: &mut [f32], touch: &SkinValues) {
    let (width, values) = (touch.width(), touch.values());
    for &sensor in touch.touched() {
        let of = width * sensor as usize..width * (sensor as usize + 1);
        out[of.clone()].copy_from_slice(&values[of]);
    }
}

/// An array that Rust writes and Python reads.
pub struct Slab<T> {
    array: Py<PyArray1<T>>,
    shape: Vec<usize>,
    /// What Python sees: the same memory, in its shape, read-only.
    pub view: Py<PyAny>,
    copies: Recycled<T>,
}

impl<T: Element> Slab<T> {
    /// Makes an array of zeros, of which Python sees a read-only view of a shape.
    pub fn new(py: Python<'_>, shape: &[usize]) -> PyResult<Self> {
        let array = PyArray1::<T>::zeros(py, shape.iter().product::<usize>(), false);
        let view = array.call_method1(intern!(py, "reshape"), (shape,))?;
        view.getattr(intern!(py, "flags"))?
            .setattr(intern!(py, "writeable"), false)?;
        Ok(Self {
            array: array.unbind(),
            shape: shape.to_vec(),
            view: view.unbind(),
            copies: Recycled::default(),
        })
    }

    /// Lends the array for writing.
    pub fn lend<'py>(&self, py: Python<'py>) -> PyReadwriteArray1<'py, T> {
        // nobody else borrows it: Python has the view only
        self.array.bind(py).readwrite()
    }

    /// Returns an array of Python's own, written by a function of this one; it writes all of it.
    pub fn copy<'py>(&mut self, py: Python<'py>, write: impl FnOnce(&[T], &mut [T])) -> PyResult<Bound<'py, PyAny>> {
        let array = self.array.bind(py).readonly();
        let values = array.as_slice()?;
        self.copies.array(py, &self.shape, |out| write(values, out))
    }

    /// Lends the array to a function.
    pub fn write<R>(&self, py: Python<'_>, write: impl FnOnce(&mut [T]) -> R) -> PyResult<R> {
        Ok(write(self.lend(py).as_slice_mut()?))
    }
}

/// An observation whose arrays stay the same from step to step.
pub struct Views {
    pub dict: Py<PyDict>,
    proprioception: Slab<f64>,
    touch: Option<Slab<f32>>,
    /// Touch sensors that are not zero in the array.
    touched: Vec<u32>,
    pooled: Option<Slab<f64>>,
    pain: Option<Slab<f32>>,
    eyes: Option<[Slab<u8>; 2]>,
    maps: Maps,
    vestibular: Option<Slab<f64>>,
    goals: Option<[Slab<f64>; 2]>,
}

/// Images of both eyes with one number for each pixel, those that are observed.
#[derive(Default)]
pub struct Maps {
    pub gray: Option<[Slab<u8>; 2]>,
    pub depth: Option<[Slab<f32>; 2]>,
    pub segmentation: Option<[Slab<i32>; 2]>,
}

impl Maps {
    /// Makes arrays of the shapes that `shape` gives for keys, and puts their views into a dictionary.
    pub fn new(dict: &Bound<'_, PyDict>, shape: impl Fn(&str) -> Option<Vec<usize>>) -> PyResult<Self> {
        fn pair<T: Element>(
            dict: &Bound<'_, PyDict>,
            keys: [&str; 2],
            shape: Option<Vec<usize>>,
        ) -> PyResult<Option<[Slab<T>; 2]>> {
            let Some(shape) = shape else { return Ok(None) };
            let pair = [Slab::new(dict.py(), &shape)?, Slab::new(dict.py(), &shape)?];
            for (key, slab) in keys.into_iter().zip(&pair) {
                dict.set_item(key, &slab.view)?;
            }
            Ok(Some(pair))
        }
        Ok(Self {
            gray: pair(dict, EYES_GRAY, shape(EYES_GRAY[0]))?,
            depth: pair(dict, EYES_DEPTH, shape(EYES_DEPTH[0]))?,
            segmentation: pair(dict, EYES_SEGMENTATION, shape(EYES_SEGMENTATION[0]))?,
        })
    }

    /// Copies what is observed.
    fn update(&self, py: Python<'_>, o: &Observation<'_>) -> PyResult<()> {
        fn copy<T: Element + Copy>(
            py: Python<'_>,
            slabs: &Option<[Slab<T>; 2]>,
            images: Option<[&[T]; 2]>,
        ) -> PyResult<()> {
            for (slab, image) in slabs.iter().flatten().zip(images.into_iter().flatten()) {
                slab.write(py, |out| out.copy_from_slice(image))?;
            }
            Ok(())
        }
        copy(py, &self.gray, o.eye_gray)?;
        copy(py, &self.depth, o.eye_depth)?;
        copy(py, &self.segmentation, o.eye_segmentation)
    }
}

impl Views {
    /// Makes views of what an environment observes.
    pub fn new(py: Python<'_>, env: &Env) -> PyResult<Self> {
        let Observation {
            proprioception,
            touch_pooled,
            pain,
            eye_left,
            vestibular,
            ..
        } = env.observation();
        let goals = match goals(&env.observation()) {
            Some([goal, _]) => Some([Slab::new(py, &[goal.len()])?, Slab::new(py, &[goal.len()])?]),
            None => None,
        };
        let eyes = match env.senses().vision().filter(|_| eye_left.is_some()) {
            Some(vision) => Some([Slab::new(py, &vision.shape())?, Slab::new(py, &vision.shape())?]),
            None => None,
        };
        let spaces = env.observation_space();
        let mut views = Self {
            dict: PyDict::new(py).unbind(),
            proprioception: Slab::new(py, &[proprioception.len()])?,
            touch: env.senses().touch().map(|t| Slab::new(py, &[t.len()])).transpose()?,
            touched: Vec::new(),
            pooled: touch_pooled
                .map(|v| Slab::new(py, &[v.len() / POOLED, POOLED]))
                .transpose()?,
            pain: pain.map(|v| Slab::new(py, &[v.len()])).transpose()?,
            eyes,
            maps: Maps::default(),
            vestibular: vestibular.map(|v| Slab::new(py, &[v.len()])).transpose()?,
            goals,
        };
        let dict = views.dict.bind(py);
        dict.set_item("observation", &views.proprioception.view)?;
        if let Some(touch) = &views.touch {
            dict.set_item("touch", &touch.view)?;
        }
        if let Some(pooled) = &views.pooled {
            dict.set_item("touch_pooled", &pooled.view)?;
        }
        if let Some(pain) = &views.pain {
            dict.set_item("pain", &pain.view)?;
        }
        if let Some([left, right]) = &views.eyes {
            dict.set_item("eye_left", &left.view)?;
            dict.set_item("eye_right", &right.view)?;
        }
        views.maps = Maps::new(dict, |key| {
            let space = spaces.iter().find(|space| space.key == key)?;
            Some(space.shape.clone())
        })?;
        if let Some(vestibular) = &views.vestibular {
            dict.set_item("vestibular", &vestibular.view)?;
        }
        for (key, slab) in GOALS.into_iter().zip(views.goals.iter().flatten()) {
            dict.set_item(key, &slab.view)?;
        }
        views.update(py, env)?;
        Ok(views)
    }

    /// Brings the arrays up to date.
    pub fn update(&mut self, py: Python<'_>, env: &Env) -> PyResult<()> {
        let o = env.observation();
        self.proprioception
            .write(py, |out| out.copy_from_slice(o.proprioception))?;
        if let (Some(slab), Some(pooled)) = (&self.pooled, o.touch_pooled) {
            slab.write(py, |out| out.copy_from_slice(pooled))?;
        }
        if let (Some(slab), Some(pain)) = (&self.pain, o.pain) {
            slab.write(py, |out| out.copy_from_slice(pain))?;
        }
        if let (Some(slab), Some(touch)) = (&self.touch, env.senses().touch_observed()) {
            let (width, touched) = (touch.width(), &mut self.touched);
            slab.write(py, |out| {
                for &sensor in &*touched {
                    out[width * sensor as usize..width * (sensor as usize + 1)].fill(0.0);
                }
                write_touched(out, touch);
            })?;
            touched.clear();
            touched.extend_from_slice(touch.touched());
        }
        if let (Some([left, right]), Some(l), Some(r)) = (&self.eyes, o.eye_left, o.eye_right) {
            left.write(py, |out| out.copy_from_slice(l))?;
            right.write(py, |out| out.copy_from_slice(r))?;
        }
        self.maps.update(py, &o)?;
        if let (Some(slab), Some(vestibular)) = (&self.vestibular, o.vestibular) {
            slab.write(py, |out| out.copy_from_slice(vestibular))?;
        }
        for (slab, goal) in self.goals.iter().flatten().zip(goals(&o).into_iter().flatten()) {
            slab.write(py, |out| out.copy_from_slice(goal))?;
        }
        Ok(())
    }
}
