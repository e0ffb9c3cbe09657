//! MuJoCo's functions.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;

use libloading::Library;

/// Model, data or file system of MuJoCo.
pub(super) type Handle = *mut c_void;

/// Elements that have names, with `mjtObj`'s numbers.
pub const NAMED: [(&str, i32, &str); 15] = [
    ("flex", 9, "nflex"),
    ("skin", 11, "nskin"),
    ("body", 1, "nbody"),
    ("jnt", 3, "njnt"),
    ("geom", 5, "ngeom"),
    ("site", 6, "nsite"),
    ("cam", 7, "ncam"),
    ("light", 8, "nlight"),
    ("tex", 13, "ntex"),
    ("mat", 14, "nmat"),
    ("eq", 17, "neq"),
    ("tendon", 18, "ntendon"),
    ("actuator", 19, "nu"),
    ("sensor", 20, "nsensor"),
    ("key", 24, "nkey"),
];

/// A loaded library. The safe wrappers uphold the requirements of its functions.
pub struct Mujoco {
    version: c_int,
    pub(super) load_xml: unsafe extern "C" fn(*const c_char, Handle, *mut c_char, c_int) -> Handle,
    pub(super) make_data: unsafe extern "C" fn(Handle) -> Handle,
    pub(super) reset_data: unsafe extern "C" fn(Handle, Handle),
    pub(super) delete_model: unsafe extern "C" fn(Handle),
    pub(super) delete_data: unsafe extern "C" fn(Handle),
    pub(super) step: unsafe extern "C-unwind" fn(Handle, Handle),
    pub(super) forward: unsafe extern "C-unwind" fn(Handle, Handle),
    pub(super) energy_pos: unsafe extern "C" fn(Handle, Handle),
    pub(super) energy_vel: unsafe extern "C" fn(Handle, Handle),
    pub(super) contact_force: unsafe extern "C" fn(Handle, Handle, c_int, *mut f64),
    pub(super) apply_ft: unsafe extern "C" fn(Handle, Handle, *const f64, *const f64, *const f64, c_int, *mut f64),
    pub(super) is_sparse: unsafe extern "C" fn(Handle) -> c_int,
    pub(super) full_m: unsafe extern "C" fn(Handle, *mut f64, *const f64),
    pub(super) id2name: unsafe extern "C" fn(Handle, c_int, c_int) -> *const c_char,
    pub(super) state_size: unsafe extern "C" fn(Handle, u32) -> c_int,
    pub(super) get_state: unsafe extern "C" fn(Handle, Handle, *mut f64, u32),
    pub(super) set_state: unsafe extern "C" fn(Handle, Handle, *const f64, u32),
    default_vfs: unsafe extern "C" fn(Handle),
    add_buffer_vfs: unsafe extern "C" fn(Handle, *const c_char, *const c_void, c_int) -> c_int,
    delete_vfs: unsafe extern "C" fn(Handle),
    _library: Library,
}

/// Swallows warnings, which MuJoCo would otherwise write to a file in the current directory.
unsafe extern "C" fn ignore(_: *const c_char) {}

/// Leaves MuJoCo when it gives up, which would otherwise end the process. Its frames hold nothing that needs to be released except memory
/// of the data, which a reset reclaims.
unsafe extern "C-unwind" fn give_up(message: *const c_char) {
    // SAFETY: MuJoCo's messages end with 0.
    let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
    std::panic::resume_unwind(Box::new(message))
}

impl Mujoco {
    /// Loads a library.
    ///
    /// # Errors
    /// It is not a library, or lacks a function.
    pub fn load(path: &Path) -> Result<Self, String> {
        let name = path.display();
        // SAFETY: the initialisers of MuJoCo's library do nothing but register plugins.
        let library = unsafe { Library::new(path) }.map_err(|e| format!("{name} does not load: {e}"))?;
        macro_rules! symbol {
            ($symbol:literal) => {
                // SAFETY: the types of this file are those of MuJoCo's headers, the same in all releases used.
                *unsafe { library.get($symbol) }
                    .map_err(|e| format!("{name} has no {}: {e}", String::from_utf8_lossy($symbol)))?
            };
        }
        let version: unsafe extern "C" fn() -> c_int = symbol!(b"mj_version");
        let warning: *mut unsafe extern "C" fn(*const c_char) = symbol!(b"mju_user_warning");
        let error: *mut unsafe extern "C-unwind" fn(*const c_char) = symbol!(b"mju_user_error");
        // SAFETY: `mj_version` needs nothing; the handlers are global variables that are set before any other call.
        let version = unsafe {
            *warning = ignore;
            *error = give_up;
            version()
        };
        Ok(Self {
            version,
            load_xml: symbol!(b"mj_loadXML"),
            make_data: symbol!(b"mj_makeData"),
            reset_data: symbol!(b"mj_resetData"),
            delete_model: symbol!(b"mj_deleteModel"),
            delete_data: symbol!(b"mj_deleteData"),
            step: symbol!(b"mj_step"),
            forward: symbol!(b"mj_forward"),
            energy_pos: symbol!(b"mj_energyPos"),
            energy_vel: symbol!(b"mj_energyVel"),
            contact_force: symbol!(b"mj_contactForce"),
            apply_ft: symbol!(b"mj_applyFT"),
            is_sparse: symbol!(b"mj_isSparse"),
            full_m: symbol!(b"mj_fullM"),
            id2name: symbol!(b"mj_id2name"),
            state_size: symbol!(b"mj_stateSize"),
            get_state: symbol!(b"mj_getState"),
            set_state: symbol!(b"mj_setState"),
            default_vfs: symbol!(b"mj_defaultVFS"),
            add_buffer_vfs: symbol!(b"mj_addBufferVFS"),
            delete_vfs: symbol!(b"mj_deleteVFS"),
            _library: library,
        })
    }

    /// Returns the version, such as 330.
    pub fn version(&self) -> i32 {
        self.version
    }

    /// Compiles the document `path` of `files`, which are names and contents.
    pub(super) fn compile(&self, path: &str, files: &[(&str, &[u8])]) -> Result<Handle, String> {
        // an `mjVFS` is one pointer; this is larger
        let mut vfs = [0_usize; 16];
        let vfs: Handle = vfs.as_mut_ptr().cast();
        // SAFETY: the file system is initialised before and released after use; names end with 0; lengths are those of the buffers.
        unsafe {
            (self.default_vfs)(vfs);
            let added = self.add(vfs, files);
            let model = added.and_then(|()| self.read_xml(path, vfs));
            (self.delete_vfs)(vfs);
            model
        }
    }

    unsafe fn add(&self, vfs: Handle, files: &[(&str, &[u8])]) -> Result<(), String> {
        for (name, content) in files {
            let c_name = CString::new(*name).map_err(|e| format!("{name:?}: {e}"))?;
            let n = c_int::try_from(content.len()).map_err(|_| format!("{name} is too large"))?;
            // SAFETY: as in `compile`.
            let status = unsafe { (self.add_buffer_vfs)(vfs, c_name.as_ptr(), content.as_ptr().cast(), n) };
            if status != 0 {
                return Err(format!("MuJoCo does not take the file {name}: status {status}"));
            }
        }
        Ok(())
    }

    unsafe fn read_xml(&self, path: &str, vfs: Handle) -> Result<Handle, String> {
        let path = CString::new(path).map_err(|e| e.to_string())?;
        let mut error = [0_u8; 1000];
        // SAFETY: as in `compile`; the message ends with 0 inside the buffer.
        let model = unsafe { (self.load_xml)(path.as_ptr(), vfs, error.as_mut_ptr().cast(), error.len() as c_int) };
        if model.is_null() {
            let message = CStr::from_bytes_until_nul(&error).map(|m| m.to_string_lossy().into_owned());
            return Err(message.unwrap_or_default());
        }
        Ok(model)
    }
}
