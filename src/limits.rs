//! Limits on input that may come from anywhere.

/// Bounds what readers take from untrusted input, so that no text or file exhausts the memory or the stack.
///
/// Every reader has a function that takes limits; the shorter one beside it uses [`Limits::default`]. Exceeding a limit is
/// an error of the reader that names the limit. Fields may be added in later versions, so start from the default:
///
/// ```
/// use babybench::assets::MemoryAssets;
/// use babybench::{Limits, mjcf_loader};
///
/// let text = "<mujoco><worldbody><body><body/></body></worldbody></mujoco>";
/// let limits = Limits { depth: 3, ..Limits::default() };
/// let error = mjcf_loader::load_str_with(text, "deep.xml", &MemoryAssets::new(), &limits).unwrap_err();
/// assert!(error.to_string().ends_with("more than 3 nested elements"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// MJCF: bytes of XML in a document and its includes; 4 MiB by default.
    pub document_bytes: usize,
    /// MJCF: elements in a document and its includes; 100,000 by default.
    pub elements: usize,
    /// MJCF: attributes of an element; 64 by default.
    pub attributes: usize,
    /// MJCF: levels of nested elements, across includes; 100 by default. A level takes up to 3 KiB of stack without
    /// optimisation.
    pub depth: usize,
    /// MJCF: levels of nested includes; 16 by default. A level takes up to 2 KiB of stack without optimisation.
    pub include_depth: usize,
    /// MJCF: bytes of a name or any other attribute that is text; 256 by default. Default classes copy them.
    pub text_bytes: usize,
    /// MJCF: default classes; 1000 by default.
    pub classes: usize,
    /// MJCF: user values of an actuator or a camera; 64 by default. Default classes copy them.
    pub user: usize,
    /// MJCF: bodies, the world among them; 20,000 by default.
    pub bodies: usize,
    /// MJCF: geoms; 20,000 by default.
    pub geoms: usize,
    /// MJCF: degrees of freedom; 20,000 by default.
    pub dofs: usize,
    /// MJCF: explicit contact pairs; 20,000 by default.
    pub pairs: usize,
    /// MJCF: the largest magnitude of a number; 1e30 by default, with which products of a few numbers stay finite.
    pub real: f64,
    /// Physics: pairs of geoms in large scenes whose boxes overlap; 4,194,304 by default.
    pub near_pairs: usize,
    /// Physics: contacts in a step of a large scene; 50,000 by default.
    pub contacts: usize,
    /// Assets: bytes of a file that is read from a directory; 64 MiB by default.
    pub asset_bytes: u64,
    /// Pictures: pixels of a side; 8192 by default.
    pub picture_side: u32,
    /// Pictures: bytes of memory for decoding one; 160 MiB by default.
    pub picture_bytes: u64,
    /// Policies: bytes of an answer of a program; 1 MiB by default.
    pub answer_bytes: usize,
    /// Policies: bytes of an ONNX model; 1 GiB by default.
    pub model_bytes: u64,
    /// Configurations: bytes of a YAML text; 1 MiB by default.
    pub config_bytes: usize,
    /// NumPy archives: bytes of a file; 4 GiB by default.
    pub npz_bytes: u64,
    /// NumPy archives: arrays in an archive; 65,536 by default.
    pub npz_arrays: usize,
    /// NumPy archives: bytes of the header of an array; 16 KiB by default.
    pub npz_header_bytes: usize,
    /// NumPy archives: bytes of an array in memory, as stored and as converted; 1 GiB by default.
    pub npz_array_bytes: usize,
    /// Pickles: bytes of a file; 256 MiB by default.
    pub pickle_bytes: usize,
    /// Pickles: numbers in arrays and items in lists, all together; 67,108,864 by default.
    pub pickle_numbers: usize,
    /// Pickles: lists, dictionaries, texts and arrays; 8,388,608 by default.
    pub pickle_objects: usize,
    /// Pickles: levels of nested values; 32 by default. A level takes up to 1 KiB of stack without optimisation.
    pub pickle_depth: usize,
    /// Pickles: dimensions of an array; 8 by default.
    pub pickle_dimensions: usize,
    /// Logs: records of a log; 2,000,000 by default.
    pub records: usize,
    /// Logs: touched parts in one list of a record; 4096 by default.
    pub record_touches: usize,
}

impl Limits {
    /// The limits of the functions that take none.
    pub const DEFAULT: Self = Self {
        document_bytes: 4 << 20,
        elements: 100_000,
        attributes: 64,
        depth: 100,
        include_depth: 16,
        text_bytes: 256,
        classes: 1000,
        user: 64,
        bodies: 20_000,
        geoms: 20_000,
        dofs: 20_000,
        pairs: 20_000,
        real: 1e30,
        near_pairs: 1 << 22,
        contacts: 50_000,
        asset_bytes: 64 << 20,
        picture_side: 8192,
        picture_bytes: 160 << 20,
        answer_bytes: 1 << 20,
        model_bytes: 1 << 30,
        config_bytes: 1 << 20,
        npz_bytes: 1 << 32,
        npz_arrays: 1 << 16,
        npz_header_bytes: 1 << 14,
        npz_array_bytes: 1 << 30,
        pickle_bytes: 256 << 20,
        pickle_numbers: 1 << 26,
        pickle_objects: 1 << 23,
        pickle_depth: 32,
        pickle_dimensions: 8,
        records: 2_000_000,
        record_touches: 4096,
    };
}

impl Default for Limits {
    fn default() -> Self {
        Self::DEFAULT
    }
}
