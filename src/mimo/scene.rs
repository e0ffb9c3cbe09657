//! Scenes: documents with MIMo, compiled at his age.

use super::custom_scene::{CustomScene, location};
use super::document::{document_path, scene_xml};
use super::error::SceneError;
use super::growth::blame;
use super::placement::{GeomOverlap, LowestPoint, overlaps};
use super::third::VersionAssets;
use super::version::{EYES, SECOND_PREFIX, Version};
use super::{Growth, Individual, StrengthRow};
use crate::assets::AssetSource;
use crate::config::{Config, FacialExpression, IndividualOptions, Measurements, Sex};
use crate::math::{Vec3, scale};
use crate::mjcf_loader::{Draft, LoadError};
use crate::model::Model;
use crate::physics::compile;

/// The material of MIMo's head.
const HEAD: &str = "head";

/// Loads and compiles the scene of a configuration from `assets`, with MIMo at his age.
///
/// A MIMo whose size differs from the original's is moved up or down until his lowest point is where the original's is, both in the posture in
/// which the scene holds them. A custom scene is one of the assets, or otherwise a file of the system; see
/// [`scene_assets`](crate::mimo::scene_assets).
///
/// # Errors
/// Fails if the assets cannot be read or compiled, and then names file, line and element; if a custom scene lacks MIMo or changes
/// him; if MIMo cannot grow to the age, or measurements or z-scores make a body whose parts vanish or overlap, and then names the keys.
pub fn build_model(config: &Config, assets: &dyn AssetSource) -> Result<Model, SceneError> {
    build_scene(&scene_xml(config), Version::of(config.behavior), config, assets)
}

/// Compiles a document with a MIMo of some version, at the age of a configuration; see [`build_model`].
///
/// # Errors
/// As [`build_model`].
pub fn build_scene(
    document: &str,
    version: Version,
    config: &Config,
    assets: &dyn AssetSource,
) -> Result<Model, SceneError> {
    let path = document_path(config);
    let assets = &VersionAssets::new(config, assets);
    let Some(room) = CustomScene::open(config, assets)? else {
        return SceneSource::of(config, document, path, assets).build(version, config);
    };
    let source = SceneSource::of(config, document, path, &room);
    if document != scene_xml(config) {
        // a task with a document of its own, which may or may not have the room
        return source.build(version, config).map_err(|e| room.localized(e));
    }
    room.check(&source)?;
    let model = source.build(version, config).map_err(|e| room.localized(e))?;
    room.compare(&source, &model, config)?;
    Ok(model)
}

/// Returns the greatest torques of MIMo at the age of a configuration, under both settings of the key `strength`; empty without an age.
///
/// # Errors
/// As [`build_model`].
pub fn strength_table(config: &Config, assets: &dyn AssetSource) -> Result<Vec<StrengthRow>, SceneError> {
    match Growth::of(config, Version::of(config.behavior), assets)? {
        Some(growth) => growth.strength_rows(config, assets),
        None => Ok(Vec::new()),
    }
}

/// A document and its includes.
#[derive(Clone, Copy)]
pub(super) struct SceneSource<'a> {
    pub document: &'a str,
    /// Its file name in the assets.
    pub path: &'a str,
    /// His face: the texture of the material of his head.
    face: FacialExpression,
    /// The vertical fields of view of his left and his right eye, degrees, where the configuration has its own.
    fields: [Option<f64>; 2],
    pub assets: &'a dyn AssetSource,
}

impl<'a> SceneSource<'a> {
    /// Returns a document, read as file `path` of the assets, with the MIMo of a configuration in it.
    pub fn of(config: &Config, document: &'a str, path: &'a str, assets: &'a dyn AssetSource) -> Self {
        Self {
            document,
            path,
            face: config.facial_expression,
            fields: config.eyes.fields(),
            assets,
        }
    }

    fn read(&self) -> Result<Draft, LoadError> {
        let mut draft = Draft::read_str(self.document, self.path, self.assets)?;
        if self.face != FacialExpression::Default
            && let Some(texture) = draft.material_texture(HEAD)
        {
            *texture = Some(format!("tex_head_{}", self.face));
        }
        for (eye, field) in EYES.into_iter().zip(self.fields) {
            if let (Some(fovy), Some(field)) = (draft.camera_fovy(eye), field) {
                *fovy = field;
            }
        }
        Ok(draft)
    }

    /// Compiles the document with MIMo of the original proportions.
    pub fn original(&self) -> Result<Model, SceneError> {
        Ok(compile(self.read()?.compile(self.assets)?)?)
    }

    /// Compiles the document with MIMo at the age of a configuration.
    fn build(&self, version: Version, config: &Config) -> Result<Model, SceneError> {
        let place = location(config.learner);
        let mut other = Growth::of(&of_other(config), version, self.assets)?;
        if let Some(growth) = other.take() {
            other = Some(growth.mature(&of_other(config), self.assets)?);
        }
        let Some(growth) = Growth::of(config, version, self.assets)? else {
            let mut draft = self.read()?;
            grow_other(&mut draft, other.as_ref())?;
            return Ok(compile(draft.compile(self.assets)?)?);
        };
        let growth = growth.mature(config, self.assets)?;
        let made = self.grow(&growth, other.as_ref(), place);
        let unusual = Individual::of(config).is_some_and(|infant| infant.is_unusual());
        if config.measurements == Measurements::default() && !unusual {
            return made;
        }
        // measurements and z-scores may describe an impossible body
        let age = growth.age();
        let allowed = if unusual { UNUSUAL_OVERLAP } else { OVERLAP };
        let ordinary = ordinary(config);
        let usual = overlaps(&self.build(version, &ordinary)?.into())?;
        let fault = |made: &Result<Model, SceneError>| -> Option<String> {
            match made {
                Ok(model) => {
                    let found = overlaps(&model.clone().into()).ok()?;
                    deeper(model, &found, &usual, allowed)
                }
                Err(e) => Some(format!("the body cannot be made ({e})")),
            }
        };
        let Some(reason) = fault(&made) else { return made };
        let works = |other: &Config| {
            let growth = Growth::of(other, version, self.assets).ok().flatten();
            growth.is_some_and(|growth| fault(&self.grow(&growth, None, place)).is_none())
        };
        Err(blame(config, age, reason, works).into())
    }

    /// Compiles the scene with a MIMo that has grown, his lowest point where the original's is.
    fn grow(&self, growth: &Growth, other: Option<&Growth>, place: &str) -> Result<Model, SceneError> {
        let grown = |shift: Vec3| -> Result<Model, SceneError> {
            let mut draft = self.read()?;
            growth.apply(&mut draft)?;
            grow_other(&mut draft, other)?;
            if let Some(pos) = draft.body_pos(place) {
                pos.iter_mut().zip(shift).for_each(|(x, by)| *x += by);
            }
            Ok(compile(draft.compile(self.assets)?)?)
        };
        let before = LowestPoint::of(&self.original()?.into())?;
        let after = LowestPoint::of(&grown([0.0; 3])?.into())?;
        grown(scale(before.up, before.height - after.height))
    }
}

/// Returns the configuration of a body of the same age without measurements and z-scores of its own.
fn ordinary(config: &Config) -> Config {
    let individual = IndividualOptions {
        sex: Individual::of(config).map_or(Sex::None, |infant| infant.sex),
        gestation: config.individual.gestation,
        ..IndividualOptions::default()
    };
    Config {
        measurements: Measurements::default(),
        individual,
        ..config.clone()
    }
}

/// Returns the configuration of the second infant's body.
fn of_other(config: &Config) -> Config {
    Config {
        age: config.other_age,
        strength_age: None,
        measurements: Measurements::default(),
        individual: IndividualOptions::default(),
        ..config.clone()
    }
}

/// Sets the age of a document's second infant.
fn grow_other(draft: &mut Draft, growth: Option<&Growth>) -> Result<(), SceneError> {
    let Some(growth) = growth else { return Ok(()) };
    draft.set_prefix(SECOND_PREFIX);
    let grown = growth.apply(draft);
    draft.set_prefix("");
    Ok(grown?)
}

/// Tolerance of the overlap of two parts, beyond that of an ordinary body of the same age, m.
const OVERLAP: f64 = 0.003;
/// The same for bodies with z-scores: with a difference of 3 between those of length and weight, parts of a newborn are 5.4 mm deeper in each other
/// than in the median one, and he moves as usual.
const UNUSUAL_OVERLAP: f64 = 0.008;

/// Returns two parts of MIMo that overlap more than usual, if any.
fn deeper(model: &Model, found: &[GeomOverlap], usual: &[GeomOverlap], allowed: f64) -> Option<String> {
    let name = |geom: usize| &model.body_name[model.geom_bodyid[geom]];
    found.iter().find_map(|o| {
        let before = usual.iter().find(|u| u.geoms == o.geoms).map_or(0.0, |u| u.depth);
        let (a, b, depth) = (name(o.geoms[0]), name(o.geoms[1]), 1e3 * o.depth);
        let text = || format!("{a:?} and {b:?} are {depth:.1} mm in each other at rest");
        (o.depth > before + allowed).then(text)
    })
}
