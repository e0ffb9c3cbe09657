//! Lookup of the fields of MuJoCo's structures.

/// A member of a structure: a number, some numbers, or a pointer to an array of `rows` by `cols`.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// MuJoCo's name.
    pub name: &'static str,
    /// Offset in the structure, bytes.
    pub at: usize,
    /// Type of its values.
    pub kind: Kind,
    /// Rows of the array.
    pub rows: Size,
    /// Columns of the array.
    pub cols: Size,
}

/// Type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `mjtNum`.
    F64,
    /// `float`.
    F32,
    /// `int`.
    I32,
    /// `mjtByte`.
    U8,
}

/// A number of rows or columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Always the same.
    Fixed(usize),
    /// A named size of `mjModel` or `mjData`.
    Named(&'static str),
    /// A size of `mjModel` times a number.
    Times(&'static str, usize),
}

/// Returns the field with a name, found at compile time: a name that does not exist stops the build.
pub const fn field(table: &[Field], name: &str) -> Field {
    match position(table, name) {
        Some(k) => table[k],
        None => panic!("no such field"),
    }
}

/// Returns the position of a field in a table, if it is there.
pub const fn position(table: &[Field], name: &str) -> Option<usize> {
    let mut k = 0;
    while k < table.len() {
        if equal(table[k].name, name) {
            return Some(k);
        }
        k += 1;
    }
    None
}

const fn equal(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut k = 0;
    while k < a.len() {
        if a[k] != b[k] {
            return false;
        }
        k += 1;
    }
    true
}
