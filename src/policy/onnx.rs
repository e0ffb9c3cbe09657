//! Policies that are ONNX models.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rten::{DataType, Dimension, Model, ModelOptions, NodeId, RunOptions, ThreadPool, Value, ValueOrView, ValueType};
use thiserror::Error;

use super::{Policy, PolicyError};
use crate::env::Env;
use crate::spaces::{Dtype, ObservationSpace};

/// Names of outputs that hold the action; without one of them, the first output does.
const OUTPUTS: [&str; 2] = ["action", "actions"];

/// An error of an ONNX model that is to be a policy.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum OnnxError {
    /// The file cannot be read, is no model, or has operators that are not known.
    #[error("cannot load the model: {0}")]
    Load(String),
    /// An input is not among the active senses.
    #[error(
        "the model has an input {found:?}, which is not an active sense; name the inputs after the senses \
         ({expected}), or use a single input of any other name for all of them in one vector"
    )]
    Name {
        /// Name of the input.
        found: String,
        /// Names of the active senses.
        expected: String,
    },
    /// The model has no input or no output.
    #[error("the model has no {0}")]
    Nothing(&'static str),
    /// An input has a shape that does not fit.
    #[error("the input {name:?} has the shape {found} but must have {expected}")]
    Shape {
        /// Name of the input.
        name: String,
        /// Its shape in the model.
        found: String,
        /// Shapes that fit.
        expected: String,
    },
    /// An input has a type that does not fit.
    #[error("the input {name:?} has the type {found} but must be {expected}")]
    Type {
        /// Name of the input.
        name: String,
        /// Its type in the model.
        found: String,
        /// Types that fit.
        expected: &'static str,
    },
    /// The model fails when it runs.
    #[error("the model failed: {0}")]
    Run(String),
    /// The output is not an action.
    #[error("the output {name:?} has {found} but an action has {expected} numbers (f32)")]
    Output {
        /// Name of the output.
        name: String,
        /// What it has.
        found: String,
        /// Length of an action.
        expected: usize,
    },
    /// The action is not finite.
    #[error("the output {name:?} is not finite: number {index} is {value}")]
    NotFinite {
        /// Name of the output.
        name: String,
        /// Place in the action.
        index: usize,
        /// Its value, as text.
        value: String,
    },
}

/// A policy that is an ONNX model, such as one exported from Stable-Baselines3 or PyTorch.
///
/// Inputs: one for each sense that the model uses, named after its key (`observation`, `touch`, `vestibular`,
/// `eye_left`, `eye_right`), or a single one of any other name for all active senses, flattened and in the
/// alphabetical order of their keys, as Gymnasium's `FlattenObservation` makes it. Vectors have shape `[n]` or `[1,
/// n]`; images `[height, width, 3]` or `[3, height, width]`, with or without a 1 in front, and values of 0 to 255
/// (Stable-Baselines3 scales them in the model). The size of the batch, or of anything else, may be left open. Numbers
/// are `float32`; images may also be `uint8`.
///
/// Output: the action, `float32`, named `action` or `actions`, or the first output. It is clipped to the action space,
/// as Stable-Baselines3 does. A policy with squashed outputs has to bring them to the range of the action space itself.
///
/// A policy that was trained in the Python kit needs `compat: reference`, which has its order of proprioception and its
/// action space. The last bits of the numbers may differ between machines: the runtime uses the vector instructions at
/// hand.
pub struct OnnxPolicy {
    path: PathBuf,
    model: Model,
    inputs: Vec<Input>,
    output: NodeId,
    output_name: String,
    options: RunOptions,
}

/// An input of the model.
struct Input {
    node: NodeId,
    /// Keys of senses, one after the other.
    senses: Vec<&'static str>,
    shape: Vec<usize>,
    bytes: bool,
    channels_first: bool,
}

impl std::fmt::Debug for OnnxPolicy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OnnxPolicy")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl OnnxPolicy {
    /// Reads a model.
    ///
    /// # Errors
    /// A file that is missing or no model, operators that are not known.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, PolicyError> {
        let path = path.as_ref().to_path_buf();
        let loaded = std::fs::read(&path).map_err(|e| OnnxError::Load(e.to_string()));
        let loaded = loaded.and_then(Self::load);
        match loaded {
            Ok((model, output, output_name)) => Ok(Self {
                path,
                model,
                inputs: Vec::new(),
                output,
                output_name,
                // networks are small and episodes run side by side
                options: RunOptions::default().with_thread_pool(Some(Arc::new(ThreadPool::with_num_threads(1)))),
            }),
            Err(source) => Err(PolicyError::Onnx { path, source }),
        }
    }

    fn error(&self, source: OnnxError) -> PolicyError {
        let path = self.path.clone();
        PolicyError::Onnx { path, source }
    }

    fn load(bytes: Vec<u8>) -> Result<(Model, NodeId, String), OnnxError> {
        let model = ModelOptions::with_all_ops().load(bytes);
        let model = model.map_err(|e| OnnxError::Load(e.to_string()))?;
        if model.input_ids().is_empty() {
            return Err(OnnxError::Nothing("input"));
        }
        let outputs = || model.output_ids().iter().map(|&id| (id, name(&model, id)));
        let named = outputs().find(|(_, name)| OUTPUTS.contains(&name.as_str()));
        let (output, output_name) = named.or_else(|| outputs().next()).ok_or(OnnxError::Nothing("output"))?;
        Ok((model, output, output_name))
    }

    /// Matches the model's inputs with the senses of the environment.
    fn connect(&self, env: &Env) -> Result<Vec<Input>, OnnxError> {
        let spaces = env.observation_space();
        let ids = self.model.input_ids();
        let names: Vec<String> = ids.iter().map(|&id| name(&self.model, id)).collect();
        let find = |name: &str| spaces.iter().find(|s| s.key == name);
        let mut inputs = Vec::with_capacity(ids.len());
        for (&node, name) in ids.iter().zip(&names) {
            let input = match find(name) {
                Some(space) => self.sense(node, name, space)?,
                None if ids.len() == 1 => self.flat(node, name, &spaces)?,
                None => {
                    let expected: Vec<_> = spaces.iter().map(|s| format!("{:?}", s.key)).collect();
                    return Err(OnnxError::Name {
                        found: name.clone(),
                        expected: expected.join(", "),
                    });
                }
            };
            inputs.push(input);
        }
        Ok(inputs)
    }

    /// Connects an input with one sense.
    fn sense(&self, node: NodeId, name: &str, space: &ObservationSpace) -> Result<Input, OnnxError> {
        let image = space.dtype == Dtype::U8;
        let bytes = self.takes_bytes(node, name, image)?;
        let (shape, channels_first) = match space.shape[..] {
            [height, width, channels] => {
                let orders = [vec![height, width, channels], vec![channels, height, width]];
                let found = self.shape(node, name, &orders)?;
                (found.0, found.1 == 1)
            }
            _ => (self.shape(node, name, std::slice::from_ref(&space.shape))?.0, false),
        };
        let senses = vec![space.key];
        Ok(Input {
            node,
            senses,
            shape,
            bytes,
            channels_first,
        })
    }

    /// Connects an input with all senses.
    fn flat(&self, node: NodeId, name: &str, spaces: &[ObservationSpace]) -> Result<Input, OnnxError> {
        let bytes = self.takes_bytes(node, name, false)?;
        let mut senses: Vec<_> = spaces.iter().map(|s| s.key).collect();
        senses.sort_unstable();
        let all = spaces.iter().map(|s| s.shape.iter().product::<usize>()).sum();
        let (shape, _) = self.shape(node, name, &[vec![all]]).map_err(|e| match e {
            OnnxError::Shape { name, found, expected } => {
                let what = senses.join(", ");
                let expected = format!("{expected}: all active senses in one vector ({what})");
                OnnxError::Shape { name, found, expected }
            }
            other => other,
        })?;
        Ok(Input {
            node,
            senses,
            shape,
            bytes,
            channels_first: false,
        })
    }

    /// Returns whether an input takes bytes instead of floats.
    fn takes_bytes(&self, node: NodeId, name: &str, image: bool) -> Result<bool, OnnxError> {
        match self.model.node_info(node).and_then(|i| i.dtype()) {
            None | Some(ValueType::Tensor(DataType::Float)) => Ok(false),
            Some(ValueType::Tensor(DataType::UInt8)) if image => Ok(true),
            Some(other) => Err(OnnxError::Type {
                name: name.to_string(),
                found: other.to_string(),
                expected: if image { "f32 or u8" } else { "f32" },
            }),
        }
    }

    /// Returns the shape that an input gets, and which of the `fitting` ones it is.
    fn shape(&self, node: NodeId, name: &str, fitting: &[Vec<usize>]) -> Result<(Vec<usize>, usize), OnnxError> {
        let batch = |shape: &[usize]| [&[1], shape].concat();
        let Some(declared) = self.model.node_info(node).and_then(|i| i.shape()) else {
            return Ok((batch(&fitting[0]), 0));
        };
        let matches = |shape: &[usize]| {
            let fits = |(d, n): (&Dimension, &usize)| match d {
                Dimension::Fixed(size) => size == n,
                Dimension::Symbolic(_) => true,
            };
            declared.len() == shape.len() && declared.iter().zip(shape).all(fits)
        };
        let candidates = || {
            fitting
                .iter()
                .enumerate()
                .flat_map(|(k, s)| [(batch(s), k), (s.clone(), k)])
        };
        candidates().find(|(shape, _)| matches(shape)).ok_or_else(|| {
            let all: Vec<String> = candidates().map(|(shape, _)| format!("{shape:?}")).collect();
            let dimension = |d: &Dimension| match d {
                Dimension::Fixed(size) => size.to_string(),
                Dimension::Symbolic(name) => name.clone(),
            };
            let found: Vec<String> = declared.iter().map(dimension).collect();
            OnnxError::Shape {
                name: name.to_string(),
                found: format!("[{}]", found.join(", ")),
                expected: all.join(" or "),
            }
        })
    }

    fn run(&self, env: &Env, action: &mut Vec<f32>) -> Result<(), OnnxError> {
        let failed = |e: &dyn std::fmt::Display| OnnxError::Run(e.to_string());
        let mut values: Vec<(NodeId, ValueOrView)> = Vec::with_capacity(self.inputs.len());
        for input in &self.inputs {
            let value = match input.bytes {
                true => Value::from_shape(&input.shape, input.pixels(env)).map_err(|e| failed(&e))?,
                false => Value::from_shape(&input.shape, input.numbers(env)).map_err(|e| failed(&e))?,
            };
            values.push((input.node, value.into()));
        }
        let outputs = self.model.run(values, &[self.output], Some(self.options.clone()));
        let output = outputs.map_err(|e| failed(&e))?.pop();
        let space = env.action_space();
        let misfit = |found: String| OnnxError::Output {
            name: self.output_name.clone(),
            found,
            expected: space.len(),
        };
        let numbers = match output {
            Some(Value::FloatTensor(tensor)) => tensor.into_data(),
            _ => return Err(misfit("whole numbers".to_string())),
        };
        if numbers.len() != space.len() {
            return Err(misfit(format!("{} numbers", numbers.len())));
        }
        action.clear();
        action.extend(numbers);
        for (index, value) in action.iter_mut().enumerate() {
            if !value.is_finite() {
                let (name, value) = (self.output_name.clone(), value.to_string());
                return Err(OnnxError::NotFinite { name, index, value });
            }
            *value = space.clip(index, *value);
        }
        Ok(())
    }
}

impl Input {
    /// Returns the image of an eye.
    fn pixels(&self, env: &Env) -> Vec<u8> {
        let o = env.observation();
        let image = match self.senses.first() {
            Some(&"eye_left") => o.eye_left,
            _ => o.eye_right,
        };
        self.ordered(image.unwrap_or_default())
    }

    /// Returns all senses as numbers.
    fn numbers(&self, env: &Env) -> Vec<f32> {
        let o = env.observation();
        let single = |v: &[f64]| v.iter().map(|&x| x as f32).collect::<Vec<f32>>();
        let image = |v: Option<&[u8]>| self.ordered(v.unwrap_or_default()).into_iter().map(f32::from).collect();
        let values = |sense: &&str| match *sense {
            "observation" => single(o.proprioception),
            "touch" => o.touch.unwrap_or_default().to_vec(),
            "vestibular" => single(o.vestibular.unwrap_or_default()),
            "eye_left" => image(o.eye_left),
            _ => image(o.eye_right),
        };
        self.senses.iter().flat_map(values).collect()
    }

    /// Rearranges an image (H, W, 3) in the order of the input.
    fn ordered(&self, image: &[u8]) -> Vec<u8> {
        match self.channels_first {
            true => (0..3).flat_map(|c| image.iter().skip(c).step_by(3).copied()).collect(),
            false => image.to_vec(),
        }
    }
}

/// Returns the name of a node.
fn name(model: &Model, id: NodeId) -> String {
    let info = model.node_info(id);
    info.and_then(|i| i.name().map(str::to_string)).unwrap_or_default()
}

impl Policy for OnnxPolicy {
    fn begin(&mut self, env: &mut Env) -> Result<(), PolicyError> {
        self.inputs = self.connect(env).map_err(|e| self.error(e))?;
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        if self.inputs.is_empty() {
            self.begin(env)?;
        }
        self.run(env, action).map_err(|e| self.error(e))
    }
}
