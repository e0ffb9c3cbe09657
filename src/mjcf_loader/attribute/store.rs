//! Stores the values of attributes in fields of the typed document, and writes fields as attributes.

use super::Value;

/// A function that reads or writes a field.
pub(crate) type FieldVisitor<'a> = &'a mut dyn FnMut(&mut dyn AttributeField);

/// A field that holds the value of an attribute.
pub(crate) trait AttributeField {
    /// Stores a value. A value of another kind, which the tables rule out, changes nothing.
    fn store(&mut self, value: &Value);

    /// Returns the content as a document would write it; empty for nothing.
    fn show(&self) -> String;
}

impl AttributeField for String {
    fn store(&mut self, value: &Value) {
        if let Value::Text(text) = value {
            text.clone_into(self);
        }
    }

    fn show(&self) -> String {
        self.clone()
    }
}

impl AttributeField for bool {
    fn store(&mut self, value: &Value) {
        if let Value::Flag(flag) = value {
            *self = *flag;
        }
    }

    fn show(&self) -> String {
        self.to_string()
    }
}

impl AttributeField for f64 {
    fn store(&mut self, value: &Value) {
        if let Value::Reals(values) = value
            && let [first, ..] = values[..]
        {
            *self = first;
        }
    }

    fn show(&self) -> String {
        self.to_string()
    }
}

impl<const N: usize> AttributeField for [f64; N] {
    fn store(&mut self, value: &Value) {
        if let Value::Reals(values) = value {
            for (to, from) in self.iter_mut().zip(values) {
                *to = *from;
            }
        }
    }

    fn show(&self) -> String {
        self.map(|value| value.to_string()).join(" ")
    }
}

impl AttributeField for Vec<f64> {
    fn store(&mut self, value: &Value) {
        if let Value::Reals(values) = value {
            self.clone_from(values);
        }
    }

    fn show(&self) -> String {
        self.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
    }
}

impl AttributeField for [u8; 3] {
    fn store(&mut self, value: &Value) {
        if let Value::Letters(letters) = value {
            *self = *letters;
        }
    }

    fn show(&self) -> String {
        self.map(char::from).iter().collect()
    }
}

macro_rules! store_whole {
    ($($ty:ty),*) => {$(
        impl AttributeField for $ty {
            fn store(&mut self, value: &Value) {
                if let Value::Int(value) = value
                    && let Ok(value) = Self::try_from(*value)
                {
                    *self = value;
                }
            }

            fn show(&self) -> String {
                self.to_string()
            }
        }
    )*};
}
store_whole!(usize, i32, i64);

/// Bits, which documents write as whole numbers whose sign is the highest bit.
impl AttributeField for u32 {
    fn store(&mut self, value: &Value) {
        if let Value::Int(value) = value
            && let Ok(value) = i32::try_from(*value)
        {
            *self = value.cast_unsigned();
        }
    }

    fn show(&self) -> String {
        self.cast_signed().to_string()
    }
}

/// An optional value. A negative count, which the tables allow as -1, counts as not given.
macro_rules! store_optional {
    ($([$($parameter:tt)*] $ty:ty = $empty:expr),* $(,)?) => {$(
        impl<$($parameter)*> AttributeField for Option<$ty> {
            fn store(&mut self, value: &Value) {
                if !matches!(value, Value::Int(..0)) {
                    let mut given = $empty;
                    given.store(value);
                    *self = Some(given);
                }
            }

            fn show(&self) -> String {
                self.as_ref().map(AttributeField::show).unwrap_or_default()
            }
        }
    )*};
}
store_optional!([] String = String::new(), [] f64 = 0.0, [] usize = 0, [] i64 = 0, [const N: usize] [f64; N] = [0.0; N]);
