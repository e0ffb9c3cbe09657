//! Limits on untrusted input.

const KIB: u64 = 1 << 10;
const MIB: u64 = KIB << 10;
const GIB: u64 = MIB << 10;

/// Defines the limits, each with its default and its documentation.
macro_rules! limits {
    ($(#[$about:meta])* $name:ident { $($(#[$doc:meta])* $field:ident: $type:ty = $default:expr,)* }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name {
            $(
                $(#[$doc])*
                #[doc = concat!("\n\nDefault: `", stringify!($default), "`.")]
                pub $field: $type,
            )*
        }

        impl $name {
            /// The limits of functions without a parameter for them.
            pub const DEFAULT: Self = Self { $($field: $default as $type,)* };
        }
    };
}

limits! {
    /// Bounds on untrusted input, so that no text or file exhausts memory or the stack.
    ///
    /// Every reader has a function that takes limits; the shorter one beside it uses [`Limits::default`]. Exceeding a limit is
    /// an error of the reader that names the limit. Fields may be added in later versions, so start from the default:
    ///
    /// ```
    /// use mjcf_sim::assets::MemoryAssets;
    /// use mjcf_sim::{Limits, mjcf_loader};
    ///
    /// let text = "<mujoco><worldbody><body><body/></body></worldbody></mujoco>";
    /// let limits = Limits { depth: 3, ..Limits::default() };
    /// let error = mjcf_loader::load_str_with(text, "deep.xml", &MemoryAssets::new(), &limits).unwrap_err();
    /// assert!(error.to_string().ends_with("more than 3 nested elements"));
    /// ```
    Limits {
        /// MJCF: bytes of XML in a document and its includes.
        document_bytes: usize = 4 * MIB,
        /// MJCF: elements in a document, its includes and the models that it names; the limit also applies to the elements examined when bodies of
        /// models are attached.
        elements: usize = 100_000,
        /// MJCF: attributes of an element.
        attributes: usize = 64,
        /// MJCF: levels of nested elements, across includes. A level takes up to 3 KiB of stack without optimisation.
        depth: usize = 500,
        /// MJCF: levels of nested includes, and of models within models. A level takes up to 2 KiB of stack without optimisation.
        include_depth: usize = 16,
        /// MJCF: bytes of a name or any other text attribute. Default classes copy them.
        text_bytes: usize = 1024,
        /// MJCF: default classes.
        classes: usize = 5000,
        /// MJCF: user values of an element. Default classes copy them.
        user: usize = 256,
        /// MJCF: bodies, including the world.
        bodies: usize = 20_000,
        /// MJCF: geoms.
        geoms: usize = 20_000,
        /// MJCF: degrees of freedom.
        dofs: usize = 20_000,
        /// MJCF: explicit contact pairs.
        pairs: usize = 20_000,
        /// MJCF: numbers in all keyframes together.
        key_numbers: usize = 4_194_304,
        /// MJCF: steps of the simulations that find the lengths of muscles.
        lengthrange_steps: usize = 1_000_000,
        /// MJCF: vertices, normals, texture coordinates and faces of all meshes together.
        mesh_elements: usize = 4_194_304,
        /// MJCF: numbers of a mesh in the document itself.
        mesh_numbers: usize = 1_048_576,
        /// MJCF: the largest magnitude of a number. Products of a few such numbers stay finite.
        real: f64 = 1e30,
        /// Physics: pairs of geoms in large scenes whose boxes overlap.
        near_pairs: usize = 4_194_304,
        /// Physics: contacts in a step of a large scene.
        contacts: usize = 50_000,
        /// Physics: numbers in the matrices of the solver `PGS`, and of the solver against slip.
        dual_numbers: usize = 16_777_216,
        /// Assets: bytes of a file that is read from a directory.
        asset_bytes: u64 = 64 * MIB,
        /// Pictures: pixels of a side.
        picture_side: u32 = 8192,
        /// Pictures: bytes of memory for decoding one.
        picture_bytes: u64 = 160 * MIB,
        /// Pictures: pixels of all textures of a scene, in files and in patterns, before they are reduced.
        texture_pixels: usize = 268_435_456,
        /// Policies: bytes of an answer of a program.
        answer_bytes: usize = MIB,
        /// Policies: bytes of an ONNX model.
        model_bytes: u64 = GIB,
        /// Configurations: bytes of a YAML text.
        config_bytes: usize = MIB,
        /// NumPy archives: bytes of a file.
        npz_bytes: u64 = 4 * GIB,
        /// NumPy archives: arrays in an archive.
        npz_arrays: usize = 65_536,
        /// NumPy archives: bytes of the header of an array.
        npz_header_bytes: usize = 16 * KIB,
        /// NumPy archives: bytes of an array in memory, as stored and as converted.
        npz_array_bytes: usize = GIB,
        /// Pickles: bytes of a file.
        pickle_bytes: usize = 256 * MIB,
        /// Pickles: numbers in arrays and items in lists, all together.
        pickle_numbers: usize = 67_108_864,
        /// Pickles: lists, dictionaries, texts and arrays.
        pickle_objects: usize = 8_388_608,
        /// Pickles: levels of nested values. A level takes up to 1 KiB of stack without optimisation.
        pickle_depth: usize = 32,
        /// Pickles: dimensions of an array.
        pickle_dimensions: usize = 8,
        /// Motions: numbers in the rows of a motion.
        motion_numbers: usize = 33_554_432,
        /// Motions: bytes of a text file.
        motion_text_bytes: u64 = 512 * MIB,
        /// Motions: longest duration, s.
        motion_seconds: f64 = 86_400.0,
        /// Logs: records of a log.
        records: usize = 2_000_000,
        /// Logs: touched parts in one list of a record.
        record_touches: usize = 4096,
    }
}

impl Limits {
    /// Returns the largest number of coordinates of a model within these limits: four for three degrees of freedom.
    pub fn state(&self) -> usize {
        2 * self.dofs
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self::DEFAULT
    }
}
