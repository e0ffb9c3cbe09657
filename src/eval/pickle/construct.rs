//! The constructors that logs name, and what they would make.

use std::borrow::Cow;
use std::sync::Arc;

use super::machine::{Done, Item, Machine, Object};
use super::numbers::Dtype;
use super::{Array, MAX_DIMENSIONS, PickleError};

/// The constructors that logs name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Callable {
    Reconstruct,
    Frombuffer,
    Ndarray,
    Dtype,
    Scalar,
    Encode,
}

impl Callable {
    fn named(module: &str, name: &str) -> Option<Self> {
        Some(match (module, name) {
            ("numpy.core.multiarray" | "numpy._core.multiarray", "_reconstruct") => Self::Reconstruct,
            ("numpy.core.numeric" | "numpy._core.numeric", "_frombuffer") => Self::Frombuffer,
            ("numpy.core.multiarray" | "numpy._core.multiarray", "scalar") => Self::Scalar,
            ("numpy", "ndarray") => Self::Ndarray,
            ("numpy", "dtype") => Self::Dtype,
            // how protocol 2 writes bytes
            ("_codecs", "encode") => Self::Encode,
            _ => return None,
        })
    }
}

impl<'a> Machine<'a> {
    pub(super) fn global(&mut self, module: &str, name: &str) -> Done {
        let Some(callable) = Callable::named(module, name) else {
            let short = |s: &str| s.chars().take(80).filter(|c| !c.is_control()).collect::<String>();
            let name = format!("{}.{}", short(module), short(name));
            return Err(PickleError::Global { at: self.op, name });
        };
        self.push(Object::Callable(callable));
        Ok(())
    }

    pub(super) fn as_text(&self, item: Item) -> Result<&'a str, PickleError> {
        match item {
            Item::Object(o) => match &self.objects[o] {
                Object::Text(t) => Ok(t),
                _ => Err(self.bad("something other than text where text belongs")),
            },
            _ => Err(self.bad("something other than text where text belongs")),
        }
    }

    fn as_bytes(&self, item: Item) -> Result<&[u8], PickleError> {
        match item {
            Item::Object(o) => match &self.objects[o] {
                Object::Bytes(b) => Ok(b),
                _ => Err(self.bad("something other than bytes where bytes belong")),
            },
            _ => Err(self.bad("something other than bytes where bytes belong")),
        }
    }

    fn as_tuple(&self, item: Item) -> Result<&[Item], PickleError> {
        match item {
            Item::Object(o) => match &self.objects[o] {
                Object::Tuple(t) => Ok(t),
                _ => Err(self.bad("something other than a tuple where a tuple belongs")),
            },
            _ => Err(self.bad("something other than a tuple where a tuple belongs")),
        }
    }

    fn as_dtype(&self, item: Item) -> Result<Dtype, PickleError> {
        match item {
            Item::Object(o) => match &self.objects[o] {
                Object::Dtype(d) => Ok(*d),
                _ => Err(self.bad("something other than a type of numbers where one belongs")),
            },
            _ => Err(self.bad("something other than a type of numbers where one belongs")),
        }
    }

    fn as_shape(&self, item: Item) -> Result<Vec<usize>, PickleError> {
        let one = |item: &Item| match *item {
            Item::Int(i) => usize::try_from(i).ok(),
            _ => None,
        };
        let shape = match item {
            Item::Int(_) => one(&item).map(|n| vec![n]),
            _ => match self.as_tuple(item)? {
                dims if dims.len() > MAX_DIMENSIONS => None,
                dims => dims.iter().map(one).collect(),
            },
        };
        shape.ok_or_else(|| self.bad("a shape that is none"))
    }

    /// Makes what the constructors would make.
    pub(super) fn reduce(&mut self) -> Done {
        let [callable, arguments] = self.pops()?;
        let callable = match callable {
            Item::Object(o) => match self.objects[o] {
                Object::Callable(c) => c,
                _ => return Err(self.bad("a call of something that is no constructor")),
            },
            _ => return Err(self.bad("a call of something that is no constructor")),
        };
        let made = match (callable, self.as_tuple(arguments)?) {
            // the arguments say only that it is empty so far
            (Callable::Reconstruct, [_, _, _]) => Object::Array(None),
            (Callable::Dtype, &[name, _, _]) => {
                let dtype = Dtype::named(self.as_text(name)?);
                Object::Dtype(dtype.ok_or_else(|| self.bad("an array of something other than real numbers"))?)
            }
            (Callable::Frombuffer, &[data, dtype, shape, order]) => {
                let fortran = self.as_text(order)? != "C";
                Object::Array(Some(self.numbers(data, dtype, shape, fortran)?))
            }
            (Callable::Scalar, &[dtype, data]) => {
                let (dtype, bytes) = (self.as_dtype(dtype)?, self.as_bytes(data)?);
                let number = match dtype.scalar_integer(bytes) {
                    Some(i) => Item::Int(i),
                    None => {
                        let array = dtype.array(bytes, Vec::new(), false).map_err(|e| self.bad(e))?;
                        Item::Float(array.data.first().copied().unwrap_or(f64::NAN))
                    }
                };
                self.stack.push(number);
                return Ok(());
            }
            (Callable::Encode, &[text, coding]) => {
                let (text, coding) = (self.as_text(text)?, self.as_text(coding)?);
                if !matches!(coding, "latin1" | "latin-1") {
                    return Err(self.bad("bytes in an unknown coding"));
                }
                self.spend(text.len())?;
                let bytes: Option<Vec<u8>> = text.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
                let bytes = bytes.ok_or_else(|| self.bad("bytes beyond 255"))?;
                Object::Bytes(Cow::Owned(bytes))
            }
            _ => return Err(self.bad("a constructor with unknown arguments")),
        };
        self.push(made);
        Ok(())
    }

    /// The state of an array or a type of numbers.
    pub(super) fn set_state(&mut self) -> Done {
        let state = self.pop()?;
        let Item::Object(object) = self.top()? else {
            return Err(self.bad("a state for something that has none"));
        };
        match (&self.objects[object], self.as_tuple(state)?) {
            (Object::Dtype(_), &[_, order, ..]) => {
                let big = match self.as_text(order)? {
                    "<" | "|" | "=" => false,
                    ">" => true,
                    _ => return Err(self.bad("an unknown byte order")),
                };
                if let Object::Dtype(dtype) = &mut self.objects[object] {
                    dtype.big_endian = big;
                }
            }
            (Object::Array(_), &[_, shape, dtype, Item::Bool(fortran), data]) => {
                let array = self.numbers(data, dtype, shape, fortran)?;
                self.objects[object] = Object::Array(Some(array));
            }
            _ => return Err(self.bad("a state for something that has none")),
        }
        Ok(())
    }

    fn numbers(&mut self, data: Item, dtype: Item, shape: Item, fortran: bool) -> Result<Arc<Array>, PickleError> {
        let dtype = self.as_dtype(dtype)?;
        let shape = self.as_shape(shape)?;
        self.spend(dtype.count(self.as_bytes(data)?))?;
        let array = dtype.array(self.as_bytes(data)?, shape, fortran);
        array.map(Arc::new).map_err(|e| self.bad(e))
    }
}
