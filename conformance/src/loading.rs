//! A comparison of MuJoCo and our loader on the same document.

use babybench::assets::AssetSource;
use babybench::mjcf_loader::{ErrorKind, LoadError, load_str};
use babybench::physics::compile;

use crate::arrays::{
    activations, actuators, derived, derived_unrecorded, looks, names, narrowed, needle, of_flexes, of_meshes,
    of_skins, options, physical, unrecorded,
};
use crate::mujoco::{Mujoco, Simulation};

/// Relative tolerance of compiled numbers; absolute below 1.
const TOLERANCE: f64 = 1e-10;

/// The same where masses are sums in single precision over triangles in another order.
const OF_HULLS: f64 = 1e-5;

/// The same for normals of polygons of such meshes, whose corners differ in digits of single precision, times the factor of [`needle`].
const OF_NORMALS: f64 = 1e-6;

/// The same for angles of lenses, which MuJoCo takes from the system's arctangent in single precision.
const OF_LENSES: f64 = 1e-7;

/// The same for inverse weights, which magnify rounding by the condition of the inertia.
const DERIVED: f64 = 1e-8;

/// The outcome of giving one document to both loaders.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Both load it, and the models agree.
    Equal,
    /// Both reject it.
    Rejected,
    /// Ours rejects what MuJoCo accepts, for a reason in [`deliberate`].
    Stricter(&'static str),
    /// An unexpected difference.
    Fault(String),
}

/// Why our loader rejects inertias without an inverse. MuJoCo divides by their zero pivots: its numbers are infinite, or what rounding
/// leaves of zero.
pub const SINGULAR: &str = "inertias that are singular";

/// Returns why our loader rejects what MuJoCo accepts, if it is meant to.
pub fn deliberate(error: &LoadError) -> Option<&'static str> {
    match &error.kind {
        ErrorKind::UnknownElement { .. }
        | ErrorKind::UnknownAttribute { .. }
        | ErrorKind::Plugin { .. }
        | ErrorKind::UnsupportedElement { .. } => Some("elements and attributes that are not supported"),
        ErrorKind::OutOfRange { .. } | ErrorKind::OutOfBounds { .. } | ErrorKind::BadSize { .. } => {
            Some("numbers outside their physical range, such as negative damping")
        }
        ErrorKind::BadNumber { .. } => Some("not a number, infinity and hexadecimal numbers"),
        ErrorKind::WrongCount { found: 0, .. } => Some("attributes without a value, which MuJoCo takes for absent"),
        ErrorKind::UnknownName { name, .. } if name.is_empty() => Some("references without a name"),
        ErrorKind::MissingAttribute("geom1" | "geom2") => Some("contact pairs of a single geom"),
        ErrorKind::Invalid(r#"only a camera with mode="targetbody" has a target"#) => {
            Some("cameras with a target that their mode does not use")
        }
        ErrorKind::Invalid(message) if message.starts_with("a damping ratio needs a gain") => {
            Some("damping ratios of servos with a negative gain")
        }
        ErrorKind::Invalid("the tendon names this joint twice") => Some("tendons that name a joint twice"),
        ErrorKind::Invalid(message) if message.starts_with("island=") => Some("islands with conjugate gradients"),
        ErrorKind::Invalid(message) if message.starts_with("two joints of one kind along one axis") => {
            Some("joints that move a body alike")
        }
        ErrorKind::Invalid(message) if message.starts_with("the inertia at qpos0 is singular") => Some(SINGULAR),
        ErrorKind::Invalid(message) if message.contains("has no distance from itself") => {
            Some("distances of boxes and meshes from themselves")
        }
        ErrorKind::Invalid(message) if message.starts_with("the muscle moves nothing") => {
            Some("muscles that move nothing, whose force is a quotient of rounding errors")
        }
        ErrorKind::Invalid("face names a vertex that the skin does not have") => {
            Some("skins whose faces name vertices that they do not have")
        }
        ErrorKind::Invalid("a number of the skin is not finite") => Some("skins with numbers that are not finite"),
        ErrorKind::Invalid(message) if message.starts_with("MuJoCo 3.3.0 scrambles") => {
            Some("textures of four channels that MuJoCo draws as noise")
        }
        ErrorKind::Invalid(message) if message.starts_with("MuJoCo 3.3.0 draws textures of three") => {
            Some("textures of other than three or four channels, which MuJoCo cannot draw")
        }
        ErrorKind::BadWord { .. } => Some("kinds that are not supported"),
        ErrorKind::TooMuch { .. } => Some("limits on untrusted text"),
        _ => None,
    }
}

/// Loads the document `main` of `files` on both sides and compares the compiled models.
pub fn compare(api: &'static Mujoco, main: &str, files: &[(&str, &str)], assets: &dyn AssetSource) -> Outcome {
    let text = files.iter().find(|f| f.0 == main).map_or("", |f| f.1);
    let bytes: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    compare_bytes(api, (main, text), &bytes, assets)
}

/// Loads a document, given by name and text and part of `files`, with both, and compares the compiled models.
pub fn compare_bytes(
    api: &'static Mujoco,
    (main, text): (&str, &str),
    files: &[(&str, &[u8])],
    assets: &dyn AssetSource,
) -> Outcome {
    let ours = load_str(text, main, assets).and_then(compile);
    let theirs = Simulation::new(api, main, files);
    match (ours, theirs) {
        (Err(_), Err(_)) => Outcome::Rejected,
        (Ok(_), Err(e)) => Outcome::Fault(format!("we load it, MuJoCo does not: {}", e.trim())),
        (Err(e), Ok(_)) => match deliberate(&e) {
            Some(reason) => Outcome::Stricter(reason),
            None => Outcome::Fault(format!("MuJoCo loads it, we do not: {e}")),
        },
        (Ok(model), Ok(simulation)) => difference(&model, &simulation).map_or(Outcome::Equal, Outcome::Fault),
    }
}

/// An array of our compiled model and the same array of MuJoCo's.
pub struct Distance {
    /// Name in MuJoCo.
    pub name: &'static str,
    /// Largest difference, relative to MuJoCo's value where that is above 1; infinite where the lengths differ.
    pub error: f64,
    /// The error up to which the array counts as equal.
    pub limit: f64,
    /// The place of the largest difference, for display.
    pub place: String,
}

/// Compares all arrays of the models.
pub fn distances(model: &babybench::Model, simulation: &Simulation) -> Vec<Distance> {
    let compiled = physical(model)
        .into_iter()
        .chain(unrecorded(model))
        .chain(of_meshes(model))
        .chain(of_skins(model))
        .chain(of_flexes(model))
        .chain(actuators(model))
        .chain(activations(model))
        .chain(looks(model))
        .chain(options(model));
    let of_hulls = model.meshes.iter().any(|mesh| mesh.of_hull);
    let lenses = model.cam_sensorsize.iter().any(|size| *size != [0.0; 2]);
    let compiled = compiled.map(|(name, values)| {
        let limit = match name {
            "mesh_polynormal" if of_hulls => OF_NORMALS * needle(model),
            _ if of_hulls => OF_HULLS,
            "cam_fovy" if lenses => OF_LENSES,
            _ => TOLERANCE,
        };
        (name, values, limit)
    });
    let derived = derived(model).into_iter().chain(derived_unrecorded(model));
    let derived = derived.map(|(name, values)| (name, values, if of_hulls { OF_HULLS } else { DERIVED }));
    let mut all = Vec::new();
    for (name, ours, limit) in compiled.chain(derived) {
        let theirs = simulation.model_array(name).or_else(|| simulation.model_value(name));
        let Some(theirs) = theirs.or_else(|| simulation.known_size(name).map(|n| vec![n as f64])) else {
            continue;
        };
        let theirs = narrowed(name, &theirs);
        if ours.len() != theirs.len() {
            let place = format!("{name} has {} values, MuJoCo {}", ours.len(), theirs.len());
            let error = f64::INFINITY;
            all.push(Distance {
                name,
                error,
                limit,
                place,
            });
            continue;
        }
        let error = |(a, b): (&f64, &f64)| match (a - b).abs() / b.abs().max(1.0) {
            // an inertia that is singular has no inverse
            _ if !b.is_finite() => 0.0,
            error if error.is_nan() => f64::INFINITY,
            error => error,
        };
        let errors = ours.iter().zip(&theirs).map(error).enumerate();
        let worst = errors.fold((0, 0.0), |worst, next| if next.1 > worst.1 { next } else { worst });
        let place = match ours.get(worst.0) {
            Some(value) => format!("{name}[{}] is {value:e}, MuJoCo's {:e}", worst.0, theirs[worst.0]),
            None => String::new(),
        };
        let error = worst.1;
        all.push(Distance {
            name,
            error,
            limit,
            place,
        });
    }
    all
}

/// Describes the first kind of elements whose names differ between the models; `None` if they agree.
pub fn other_names(model: &babybench::Model, simulation: &Simulation) -> Option<String> {
    let of_skins = ("skin", model.skins.iter().map(|skin| skin.name.clone()).collect());
    let of_flexes = ("flex", model.flexes.iter().map(|flex| flex.name.clone()).collect());
    let of_keys = ("key", model.keys.iter().map(|key| key.name.clone()).collect());
    let mut all = names(model).into_iter().chain([of_skins, of_flexes, of_keys]);
    all.find_map(|(kind, ours)| {
        let theirs = simulation.names(kind);
        (ours != theirs).then(|| format!("names of {kind}: {ours:?} instead of {theirs:?}"))
    })
}

/// Describes the first difference between the models; `None` if they agree.
pub fn difference(model: &babybench::Model, simulation: &Simulation) -> Option<String> {
    if let Some(names) = other_names(model, simulation) {
        return Some(names);
    }
    let far = |distance: &Distance| distance.error > distance.limit;
    distances(model, simulation)
        .into_iter()
        .find(far)
        .map(|distance| distance.place)
}
