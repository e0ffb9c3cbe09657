//! Comparison of a custom scene's MIMo with the library's.

use std::borrow::Cow;
use std::fmt::Debug;

use super::{CustomScene, CustomSceneError};
use crate::assets::{AssetError, AssetSource};
use crate::config::{Config, Learner, Scene};
use crate::mimo::MimoBodies;
use crate::mimo::document::{DOCUMENT, scene_xml};
use crate::mimo::error::SceneError;
use crate::mimo::scene::SceneSource;
use crate::model::{Material, Model};

/// The first difference: part, array, what was found, what was expected.
type SceneDifference = (String, &'static str, String, String);

/// The library's files, without those of a custom scene.
struct LibraryAssets<'a, A>(&'a CustomScene<A>);

impl<A: AssetSource> AssetSource for LibraryAssets<'_, A> {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        self.0.read_library(path)
    }

    fn contains(&self, path: &str) -> bool {
        self.0.has_library(path)
    }
}

impl<A: AssetSource> CustomScene<A> {
    /// Checks that the document left MIMo as he is on the bare floor. `model` is compiled from `source`, at the age of `config`.
    pub fn compare(&self, source: &SceneSource<'_>, model: &Model, config: &Config) -> Result<(), SceneError> {
        let plain = Config {
            scene: Scene::Base,
            scene_extra: String::new(),
            learner: Learner::Mimo,
            other_age: None,
            age: None,
            ..config.clone()
        };
        let library = LibraryAssets(self);
        let usual = SceneSource::of(config, &scene_xml(&plain), DOCUMENT, &library).original()?;
        let original;
        let model = match config.age {
            None => model,
            Some(_) => {
                original = source.original().map_err(|e| self.localized(e))?;
                &original
            }
        };
        match difference(model, &usual) {
            None => Ok(()),
            Some((part, field, found, expected)) => Err(CustomSceneError::Changed {
                path: self.path.clone(),
                part,
                field,
                found,
                expected,
            }
            .into()),
        }
    }
}

/// Compares some arrays of two models, each at its own index. The message is built in one place, because it is larger than a comparison.
macro_rules! compare {
    ($part:expr, $a:ident[$i:expr], $b:ident[$j:expr]: $($field:ident)*) => {
        let (i, j) = ($i, $j);
        let first: Option<(&'static str, &dyn Debug, &dyn Debug)> = 'first: {
            $(
                let (found, expected) = (&$a.$field[i], &$b.$field[j]);
                if found != expected {
                    break 'first Some((stringify!($field), found, expected));
                }
            )*
            None
        };
        if let Some((field, found, expected)) = first {
            return Some(differs($part, field, found, expected));
        }
    };
}

/// Returns the material of a geom; the number of its texture is the document's.
fn look(model: &Model, geom: usize) -> Option<Material> {
    let texture = None;
    let material = model.geom_matid[geom].map(|id| model.materials[id].clone());
    material.map(|material| Material { texture, ..material })
}

/// Describes a difference. It is one separate function for all types, because the page's modules would otherwise contain its code for every call.
#[cold]
#[inline(never)]
fn differs(part: String, field: &'static str, found: &dyn Debug, expected: &dyn Debug) -> SceneDifference {
    (part, field, format!("{found:?}"), format!("{expected:?}"))
}

/// Compares MIMo in a model with MIMo in another.
fn difference(model: &Model, usual: &Model) -> Option<SceneDifference> {
    in_order(model, usual).or_else(|| by_name(model, usual))
}

/// Compares the elements of MIMo's bodies in the order of the ids. Documents cannot add elements to these bodies.
fn in_order(model: &Model, usual: &Model) -> Option<SceneDifference> {
    let own = |model: &Model, carriers: &[usize]| -> Vec<usize> {
        let mimo = MimoBodies::of(model);
        (0..carriers.len()).filter(|&id| mimo.contains(carriers[id])).collect()
    };
    let all: fn(&Model) -> Vec<usize> = |model| (0..model.nbody()).collect();
    let pairs = |a: &[usize], b: &[usize]| own(model, a).into_iter().zip(own(usual, b));
    for (i, j) in pairs(&all(model), &all(usual)) {
        compare!(format!("the body {:?}", usual.body_name[j]), model[i], usual[j]:
            body_name body_pos body_quat body_ipos body_iquat body_mass body_inertia);
    }
    for (i, j) in pairs(&model.jnt_bodyid, &usual.jnt_bodyid) {
        let part = || format!("the joint {:?}", usual.jnt_name[j]);
        compare!(part(), model[i], usual[j]:
            jnt_name jnt_type jnt_pos jnt_axis jnt_limited jnt_range jnt_margin jnt_stiffness jnt_solref jnt_solimp
            jnt_actfrclimited jnt_actfrcrange jnt_actgravcomp);
        compare!(part(), model[model.jnt_dofadr[i]], usual[usual.jnt_dofadr[j]]:
            dof_armature dof_damping dof_frictionloss dof_solref dof_solimp);
        compare!(part(), model[model.jnt_qposadr[i]], usual[usual.jnt_qposadr[j]]: qpos0 qpos_spring);
    }
    for (i, j) in pairs(&model.geom_bodyid, &usual.geom_bodyid) {
        let part = || match usual.geom_name[j].as_str() {
            "" => format!("a geom of the body {:?}", usual.body_name[usual.geom_bodyid[j]]),
            name => format!("the geom {name:?}"),
        };
        compare!(part(), model[i], usual[j]:
            geom_type geom_size geom_pos geom_quat geom_contype geom_conaffinity geom_condim geom_priority geom_friction
            geom_solmix geom_solref geom_solimp geom_margin geom_gap geom_fluid geom_rgba);
        let (found, expected) = (look(model, i), look(usual, j));
        if found != expected {
            return Some(differs(part(), "geom_matid", &found, &expected));
        }
    }
    for (i, j) in pairs(&model.site_bodyid, &usual.site_bodyid) {
        compare!(format!("the site {:?}", usual.site_name[j]), model[i], usual[j]: site_name site_pos site_quat site_size);
    }
    for (i, j) in pairs(&model.cam_bodyid, &usual.cam_bodyid) {
        compare!(format!("the camera {:?}", usual.cam_name[j]), model[i], usual[j]: cam_name cam_pos cam_quat cam_fovy);
    }
    None
}

/// Compares the elements that refer to MIMo. A document may have more elements of these kinds.
fn by_name(model: &Model, usual: &Model) -> Option<SceneDifference> {
    let missing = |part: String| Some((part, "name", "no such element".to_string(), "one".to_string()));
    for (j, name) in usual.actuator_name.iter().enumerate() {
        let part = format!("the actuator {name:?}");
        let Some(i) = model.actuator(name) else {
            return missing(part);
        };
        compare!(part, model[i], usual[j]:
            actuator_trntype actuator_gear actuator_ctrllimited actuator_ctrlrange actuator_forcelimited actuator_forcerange actuator_gainprm
            actuator_biastype actuator_biasprm);
        // a document may reserve more numbers
        let (found, expected) = (&model.actuator_user[i], &usual.actuator_user[j]);
        if !found.starts_with(expected) {
            return Some(differs(part, "actuator_user", found, expected));
        }
    }
    for (j, name) in usual.sensor_name.iter().enumerate() {
        let part = format!("the sensor {name:?}");
        let Some(i) = model.sensor(name) else {
            return missing(part);
        };
        compare!(part, model[i], usual[j]: sensor_type);
    }
    for (j, name) in usual.eq_name.iter().enumerate() {
        let part = format!("the equality {name:?}");
        let Some(i) = model.equality(name) else {
            return missing(part);
        };
        compare!(part, model[i], usual[j]: eq_active0 eq_solref eq_solimp);
    }
    for (j, name) in usual.tendon_name.iter().enumerate() {
        let part = format!("the tendon {name:?}");
        let Some(i) = model.tendon(name) else {
            return missing(part);
        };
        compare!(part, model[i], usual[j]:
            tendon_limited tendon_range tendon_margin tendon_frictionloss tendon_stiffness tendon_damping tendon_solref_lim tendon_solimp_lim);
    }
    None
}
