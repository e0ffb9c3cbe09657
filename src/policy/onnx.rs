//! Policies that are ONNX models.

mod bounds;
mod constants;
mod runtime;
#[cfg(test)]
mod tests;
mod wire;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rten::{DataType, Dimension, Model, ModelOptions, NodeId, RunOptions, ThreadPool, Value, ValueOrView, ValueType};
use thiserror::Error;

use super::{Policy, PolicyError};
use crate::env::{Env, Observation};
use crate::files;
use crate::limits::Limits;
use crate::sensors::ObservationEntry;
use crate::spaces::{BoxSpace, Dtype, ObservationSpace, Values};
use crate::text::quoted;

/// Names of outputs that hold the action; without one of them, the first output does.
const OUTPUTS: [&str; 2] = ["action", "actions"];

/// An error of an ONNX model that serves as a policy.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum OnnxError {
    /// The file cannot be read, is not a model, or has unknown operators.
    #[error("cannot load the model: {0}")]
    Load(String),
    /// An input is not among the active senses.
    #[error(
        "the model has an input \"{}\", which is not an active sense; name the inputs after the senses \
         ({expected}), or use a single input of any other name for all of them in one vector", quoted(.found)
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
    #[error("the input \"{}\" has the shape {} but must have {expected}", quoted(.name), quoted(.found))]
    Shape {
        /// Name of the input.
        name: String,
        /// Its shape in the model.
        found: String,
        /// Shapes that fit.
        expected: String,
    },
    /// An input has a type that does not fit.
    #[error("the input \"{}\" has the type {found} but must be {expected}", quoted(.name))]
    Type {
        /// Name of the input.
        name: String,
        /// Its type in the model.
        found: String,
        /// Types that fit.
        expected: &'static str,
    },
    /// The model fails when it runs.
    #[error("the model failed: {}", quoted(.0))]
    Run(String),
    /// The output is not an action.
    #[error("the output \"{}\" has {found} but an action has {expected} numbers (f32)", quoted(.name))]
    Output {
        /// Name of the output.
        name: String,
        /// The shape it has.
        found: String,
        /// Length of an action.
        expected: usize,
    },
    /// The action is not finite.
    #[error("the output \"{}\" is not finite: number {index} is {value}", quoted(.name))]
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
/// Inputs: one for each entry of the observation that the model uses, named after its key
/// ([`ObservationEntry`](crate::sensors::ObservationEntry): `observation`, `touch`, `eye_left`, ...), or a single one of any other name for
/// all active senses, flattened and in the alphabetical order of their keys, as Gymnasium's `FlattenObservation` makes it. Vectors have
/// shape `[n]` or `[1, n]`; images `[height, width, 3]` or `[3, height, width]`, with or without a 1 in front, and values of 0 to 255
/// (Stable-Baselines3 scales them in the model). The size of the batch, or of anything else, may be left open. Numbers are `float32`;
/// images may also be `uint8`.
///
/// Output: the action, `float32`, named `action` or `actions`, or the first output. It is clipped to the action space,
/// as Stable-Baselines3 does. A policy with squashed outputs has to bring them to the range of the action space itself.
///
/// A model need be trusted not to take all memory or time: sizes that stand in it are checked before it runs, but not those
/// that it computes. It can read no file and start no program. Its graph has at most 10,000 operators (1,000 in WebAssembly), and
/// a graph inside of an operator 1,000. Where the runtime panics, that is an error, and no hook for panics hears of it: the first
/// model that is read sets one that passes all others on to the hook that was there before.
///
/// A policy that was trained in the Python kit needs `compat: reference`, which has its order of proprioception and its action space. The
/// last bits of the numbers may differ between machines, because the runtime uses the available vector instructions.
pub struct OnnxPolicy {
    path: PathBuf,
    model: Model,
    inputs: Vec<ModelInput>,
    output: NodeId,
    output_name: String,
    options: RunOptions,
    /// Operators of its graph.
    operators: usize,
}

/// An input of the model.
struct ModelInput {
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
        match files::read(&path, Limits::DEFAULT.model_bytes) {
            Ok(bytes) => Self::from_bytes(bytes, path),
            Err(e) => {
                let source = OnnxError::Load(e.to_string());
                Err(PolicyError::Onnx { path, source })
            }
        }
    }

    /// Reads a model from memory. Errors name `name` as its file.
    ///
    /// # Errors
    /// Bytes that are not a model, operators that are not known.
    pub fn from_bytes(bytes: Vec<u8>, name: impl Into<PathBuf>) -> Result<Self, PolicyError> {
        let path = name.into();
        match Self::load(bytes) {
            Ok((model, output, output_name, operators)) => Ok(Self {
                path,
                model,
                inputs: Vec::new(),
                output,
                output_name,
                // networks are small and episodes run side by side
                options: RunOptions::default().with_thread_pool(Some(Arc::new(ThreadPool::with_num_threads(1)))),
                operators,
            }),
            Err(source) => Err(PolicyError::Onnx { path, source }),
        }
    }

    fn error(&self, source: OnnxError) -> PolicyError {
        let path = self.path.clone();
        PolicyError::Onnx { path, source }
    }

    fn load(bytes: Vec<u8>) -> Result<(Model, NodeId, String, usize), OnnxError> {
        let refused = |reason: String| OnnxError::Load(quoted(&reason));
        let operators = bounds::check(&bytes).map_err(refused)?;
        let model = runtime::call(operators, || ModelOptions::with_all_ops().load(bytes));
        let model = model.map_err(refused)?;
        let model = model.map_err(|e| OnnxError::Load(quoted(&e.to_string())))?;
        if model.input_ids().is_empty() {
            return Err(OnnxError::Nothing("input"));
        }
        let outputs = || model.output_ids().iter().map(|&id| (id, name(&model, id)));
        let named = outputs().find(|(_, name)| OUTPUTS.contains(&name.as_str()));
        let (output, output_name) = named.or_else(|| outputs().next()).ok_or(OnnxError::Nothing("output"))?;
        Ok((model, output, output_name, operators))
    }

    /// Matches the model's inputs with senses, before [`OnnxPolicy::decide`]. With an environment, [`Policy::begin`] does it.
    ///
    /// # Errors
    /// An input that is not a sense, or of another shape or type.
    pub fn connect(&mut self, spaces: &[ObservationSpace]) -> Result<(), PolicyError> {
        self.inputs = self.match_inputs(spaces).map_err(|e| self.error(e))?;
        Ok(())
    }

    /// Writes the action for an observation into `action`, clipped to `space`: what [`Policy::act`] does, without an
    /// environment.
    ///
    /// # Errors
    /// The model fails, or its output is not an action.
    pub fn decide(
        &self,
        observation: &Observation,
        space: &BoxSpace,
        action: &mut Vec<f32>,
    ) -> Result<(), PolicyError> {
        self.run(observation, space, action).map_err(|e| self.error(e))
    }

    /// Returns whether the model takes images.
    fn sees(&self) -> bool {
        let mut senses = self.inputs.iter().flat_map(|input| &input.senses);
        senses.any(|key| ObservationEntry::of_key(key).is_some_and(|entry| entry.image.is_some()))
    }

    fn match_inputs(&self, spaces: &[ObservationSpace]) -> Result<Vec<ModelInput>, OnnxError> {
        let ids = self.model.input_ids();
        let names: Vec<String> = ids.iter().map(|&id| name(&self.model, id)).collect();
        let find = |name: &str| spaces.iter().find(|s| s.key == name);
        let mut inputs = Vec::with_capacity(ids.len());
        for (&node, name) in ids.iter().zip(&names) {
            let input = match find(name) {
                Some(space) => self.sense(node, name, space)?,
                None if ids.len() == 1 => self.flat(node, name, spaces)?,
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
    fn sense(&self, node: NodeId, name: &str, space: &ObservationSpace) -> Result<ModelInput, OnnxError> {
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
        Ok(ModelInput {
            node,
            senses,
            shape,
            bytes,
            channels_first,
        })
    }

    /// Connects an input with all senses.
    fn flat(&self, node: NodeId, name: &str, spaces: &[ObservationSpace]) -> Result<ModelInput, OnnxError> {
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
        Ok(ModelInput {
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

    /// Returns the shape that an input gets, and its index among the `fitting` ones.
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

    fn run(&self, seen: &Observation, space: &BoxSpace, action: &mut Vec<f32>) -> Result<(), OnnxError> {
        let failed = |e: &dyn std::fmt::Display| OnnxError::Run(e.to_string());
        let mut values: Vec<(NodeId, ValueOrView)> = Vec::with_capacity(self.inputs.len());
        for input in &self.inputs {
            let value = if input.bytes {
                Value::from_shape(&input.shape, input.pixels(seen)).map_err(|e| failed(&e))?
            } else {
                Value::from_shape(&input.shape, input.numbers(seen)).map_err(|e| failed(&e))?
            };
            values.push((input.node, value.into()));
        }
        let run = || self.model.run(values, &[self.output], Some(self.options.clone()));
        let outputs = runtime::call(self.operators, run).map_err(OnnxError::Run)?;
        let output = outputs.map_err(|e| failed(&e))?.pop();
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

impl ModelInput {
    /// Returns the image of an eye as bytes.
    fn pixels(&self, o: &Observation) -> Vec<u8> {
        match self.senses.first().and_then(|key| o.get(key)) {
            Some(Values::U8(image)) => self.ordered(image),
            _ => Vec::new(),
        }
    }

    /// Returns all senses as numbers.
    fn numbers(&self, o: &Observation) -> Vec<f32> {
        let values = |key: &&str| match o.get(key) {
            Some(Values::U8(image)) => Values::U8(&self.ordered(image)).to_f32(),
            Some(values) => values.to_f32(),
            None => Vec::new(),
        };
        self.senses.iter().flat_map(values).collect()
    }

    /// Rearranges an image (H, W, 3) in the order of the input.
    fn ordered(&self, image: &[u8]) -> Vec<u8> {
        if self.channels_first {
            (0..3).flat_map(|c| image.iter().skip(c).step_by(3).copied()).collect()
        } else {
            image.to_vec()
        }
    }
}

/// Returns the name of a node.
fn name(model: &Model, id: NodeId) -> String {
    let info = model.node_info(id);
    info.and_then(|i| i.name().map(str::to_string)).unwrap_or_default()
}

impl Policy for OnnxPolicy {
    fn begin(&mut self, env: &mut Env, _episode: u64) -> Result<(), PolicyError> {
        self.connect(&env.observation_space())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        if self.inputs.is_empty() {
            self.connect(&env.observation_space())?;
        }
        if self.sees() {
            env.senses_mut().look().map_err(|e| PolicyError::Other(Box::new(e)))?;
        }
        self.decide(&env.observation(), env.action_space(), action)
    }
}
