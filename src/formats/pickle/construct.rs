//! The values that the constructors named in logs would build.

use std::borrow::Cow;
use std::sync::Arc;

use super::numbers::Dtype;
use super::objects::{Callable, PickleObject, StackItem};
use super::stack::{OpcodeResult, PickleMachine};
use super::{Array, PickleError};

impl PickleMachine<'_> {
    pub(super) fn global(&mut self, module: &str, name: &str) -> OpcodeResult {
        let Some(callable) = Callable::named(module, name) else {
            let short = |s: &str| s.chars().take(80).filter(|c| !c.is_control()).collect::<String>();
            let name = format!("{}.{}", short(module), short(name));
            return Err(PickleError::Global { at: self.op, name });
        };
        self.push(PickleObject::Callable(callable));
        Ok(())
    }

    /// Builds the value of a constructor.
    pub(super) fn reduce(&mut self) -> OpcodeResult {
        let [callable, arguments] = self.pops()?;
        let callable = match callable {
            StackItem::Object(o) => match self.objects[o] {
                PickleObject::Callable(c) => c,
                _ => return Err(self.bad("a call of something that is not a constructor")),
            },
            _ => return Err(self.bad("a call of something that is not a constructor")),
        };
        let made = match (callable, self.as_tuple(arguments)?) {
            // the arguments say only that it is empty so far
            (Callable::Reconstruct, [_, _, _]) => PickleObject::Array(None),
            (Callable::Dtype, &[name, _, _]) => {
                let dtype = Dtype::named(self.as_text(name)?);
                PickleObject::Dtype(dtype.ok_or_else(|| self.bad("an array of something other than real numbers"))?)
            }
            (Callable::Frombuffer, &[data, dtype, shape, order]) => {
                let fortran = self.as_text(order)? != "C";
                PickleObject::Array(Some(self.numbers(data, dtype, shape, fortran)?))
            }
            (Callable::Scalar, &[dtype, data]) => {
                let (dtype, bytes) = (self.as_dtype(dtype)?, self.as_bytes(data)?);
                let number = match dtype.scalar_integer(bytes) {
                    Some(i) => StackItem::Int(i),
                    None => {
                        let array = dtype.array(bytes, Vec::new(), false).map_err(|e| self.bad(e))?;
                        StackItem::Float(array.data.first().copied().unwrap_or(f64::NAN))
                    }
                };
                self.stack.push(number);
                return Ok(());
            }
            (Callable::Encode, &[text, coding]) => {
                let (text, coding) = (self.as_text(text)?, self.as_text(coding)?);
                if !matches!(coding, "latin1" | "latin-1") {
                    return Err(self.bad("bytes in an unknown encoding"));
                }
                self.spend(text.len())?;
                let bytes: Option<Vec<u8>> = text.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
                let bytes = bytes.ok_or_else(|| self.bad("bytes beyond 255"))?;
                PickleObject::Bytes(Cow::Owned(bytes))
            }
            _ => return Err(self.bad("a constructor with unknown arguments")),
        };
        self.push(made);
        Ok(())
    }

    /// Sets the state of an array or of a type of numbers.
    pub(super) fn set_state(&mut self) -> OpcodeResult {
        let state = self.pop()?;
        let StackItem::Object(object) = self.top()? else {
            return Err(self.bad("a state for an object that takes none"));
        };
        match (&self.objects[object], self.as_tuple(state)?) {
            (PickleObject::Dtype(_), &[_, order, ..]) => {
                let big = match self.as_text(order)? {
                    "<" | "|" | "=" => false,
                    ">" => true,
                    _ => return Err(self.bad("an unknown byte order")),
                };
                if let PickleObject::Dtype(dtype) = &mut self.objects[object] {
                    dtype.big_endian = big;
                }
            }
            (PickleObject::Array(_), &[_, shape, dtype, StackItem::Bool(fortran), data]) => {
                let array = self.numbers(data, dtype, shape, fortran)?;
                self.objects[object] = PickleObject::Array(Some(array));
            }
            _ => return Err(self.bad("a state for an object that takes none")),
        }
        Ok(())
    }

    fn numbers(
        &mut self,
        data: StackItem,
        dtype: StackItem,
        shape: StackItem,
        fortran: bool,
    ) -> Result<Arc<Array>, PickleError> {
        let dtype = self.as_dtype(dtype)?;
        let shape = self.as_shape(shape)?;
        self.spend(dtype.count(self.as_bytes(data)?))?;
        let array = dtype.array(self.as_bytes(data)?, shape, fortran);
        array.map(Arc::new).map_err(|e| self.bad(e))
    }
}
