//! Numbers of a type that is known at run time: the entries of observations, in a row.

use super::Dtype;

/// A type of number that observations hold.
pub(crate) trait Number: Copy + Default + 'static {
    /// Its name at run time.
    const DTYPE: Dtype;

    /// Returns values of this type; `None` for another type.
    fn of(values: Values<'_>) -> Option<&[Self]>;

    /// Returns values of this type, for writing; `None` for another type.
    fn of_mut(values: ValuesMut<'_>) -> Option<&mut [Self]>;
}

macro_rules! numbers {
    ($($(#[$doc:meta])* $kind:ident: $type:ty;)*) => {
        /// Numbers of one of four types.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Values<'a> {
            $($(#[$doc])* $kind(&'a [$type]),)*
        }

        /// Numbers of one of four types, for writing.
        #[derive(Debug, PartialEq)]
        pub enum ValuesMut<'a> {
            $($(#[$doc])* $kind(&'a mut [$type]),)*
        }

        /// An array of numbers of one of four types.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Array {
            $($(#[$doc])* $kind(Vec<$type>),)*
        }

        $(impl Number for $type {
            const DTYPE: Dtype = Dtype::$kind;

            fn of(values: Values<'_>) -> Option<&[Self]> {
                match values {
                    Values::$kind(values) => Some(values),
                    _ => None,
                }
            }

            fn of_mut(values: ValuesMut<'_>) -> Option<&mut [Self]> {
                match values {
                    ValuesMut::$kind(values) => Some(values),
                    _ => None,
                }
            }
        }

        impl<'a> From<&'a [$type]> for Values<'a> {
            fn from(values: &'a [$type]) -> Self {
                Self::$kind(values)
            }
        }

        impl<'a> From<&'a mut [$type]> for ValuesMut<'a> {
            fn from(values: &'a mut [$type]) -> Self {
                Self::$kind(values)
            }
        })*

        impl<'a> Values<'a> {
            /// Returns the number of values.
            pub fn len(self) -> usize {
                match self {
                    $(Self::$kind(values) => values.len(),)*
                }
            }

            /// Returns the type of the numbers.
            pub fn dtype(self) -> Dtype {
                match self {
                    $(Self::$kind(_) => Dtype::$kind,)*
                }
            }

            /// Returns row `row` of `rows` rows of equal length; empty if the row does not exist.
            pub fn row(self, row: usize, rows: usize) -> Self {
                let len = self.len() / rows.max(1);
                match self {
                    $(Self::$kind(values) => {
                        Self::$kind(values.get(row * len..(row + 1) * len).unwrap_or_default())
                    })*
                }
            }

            /// Returns the bytes of the numbers, the lowest of each first.
            pub fn to_le_bytes(self) -> Vec<u8> {
                match self {
                    $(Self::$kind(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),)*
                }
            }
        }

        impl ValuesMut<'_> {
            /// Returns the number of values.
            pub fn len(&self) -> usize {
                match self {
                    $(Self::$kind(values) => values.len(),)*
                }
            }

            /// Writes `values` into row `row`, where all rows have the length of `values`. Writes nothing if there is no such row, or if the type
            /// differs.
            pub fn write_row(self, row: usize, values: Values<'_>) {
                match (self, values) {
                    $((Self::$kind(out), Values::$kind(values)) => {
                        if let Some(out) = out.get_mut(row * values.len()..(row + 1) * values.len()) {
                            out.copy_from_slice(values);
                        }
                    })*
                    _ => {}
                }
            }
        }

        impl Array {
            /// Makes an array of zeros.
            pub fn zeros(dtype: Dtype, len: usize) -> Self {
                match dtype {
                    $(Dtype::$kind => Self::$kind(vec![<$type>::default(); len]),)*
                }
            }

            /// Returns the numbers.
            pub fn values(&self) -> Values<'_> {
                match self {
                    $(Self::$kind(values) => Values::$kind(values),)*
                }
            }

            /// Returns the first `len` numbers, or all of them if there are fewer.
            pub fn first(&self, len: usize) -> Values<'_> {
                match self {
                    $(Self::$kind(values) => Values::$kind(&values[..len.min(values.len())]),)*
                }
            }

            /// Returns the numbers, for writing.
            pub fn values_mut(&mut self) -> ValuesMut<'_> {
                match self {
                    $(Self::$kind(values) => ValuesMut::$kind(values),)*
                }
            }

            /// Appends numbers of the same type; values of another type are left out.
            pub fn extend(&mut self, more: Values<'_>) {
                match (self, more) {
                    $((Self::$kind(values), Values::$kind(more)) => values.extend_from_slice(more),)*
                    _ => {}
                }
            }
        }
    };
}

numbers! {
    /// 64-bit floats.
    F64: f64;
    /// 32-bit floats.
    F32: f32;
    /// 8-bit unsigned integers.
    U8: u8;
    /// 32-bit integers.
    I32: i32;
}

impl Values<'_> {
    /// Returns whether there are no values.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Returns the numbers in single precision.
    pub fn to_f32(self) -> Vec<f32> {
        match self {
            Self::F64(values) => values.iter().map(|&v| v as f32).collect(),
            Self::F32(values) => values.to_vec(),
            Self::U8(values) => values.iter().map(|&v| f32::from(v)).collect(),
            Self::I32(values) => values.iter().map(|&v| v as f32).collect(),
        }
    }
}

impl ValuesMut<'_> {
    /// Returns whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
