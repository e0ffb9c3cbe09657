//! Strength by ratios to the torque of gravity, and springs that follow it.

use std::collections::BTreeMap;

use super::error::{GrowthError, missing};
use super::gravity::Weights;
use super::ratios::{Against, CURVES, RATIO_AGES, RatioCurve, rule};
use super::sizes::Sizes;
use crate::assets::AssetSource;
use crate::config::{ActuationModel, Behavior, BodyParts, Config, Scene, SpringModel, StrengthModel};
use crate::mimo::document::{DOCUMENT, scene_xml};
use crate::mimo::error::SceneError;
use crate::mimo::sources::{Mark, SourcedConstant};
use crate::mimo::{JOINT_PREFIX, Version};
use crate::mjcf_loader::Draft;
use crate::model::Model;
use crate::physics::compile;

/// A strength of MIMo at an age, under both settings of `strength`.
#[derive(Clone, Debug, PartialEq)]
pub struct StrengthRow {
    /// Joint and direction.
    pub name: &'static str,
    /// The torque that the ratios refer to, N m: gravity's, or that of a share of the weight.
    pub gravity: f64,
    /// Torques under `strength: volume` and under `strength: infant`, N m.
    pub torques: [f64; 2],
}

impl StrengthRow {
    /// Returns both torques over that of gravity.
    pub fn ratios(&self) -> [f64; 2] {
        self.torques.map(|torque| torque / self.gravity)
    }
}

/// The strength and the springs of a body, as factors on those of the original.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Maturity {
    /// The greatest torques of actuators in the negative and in the positive direction, N m, and their factors on the original's.
    strength: BTreeMap<String, [Torque; 2]>,
    /// Factors on stiffness and damping of joints.
    springs: BTreeMap<String, f64>,
    rows: Vec<StrengthRow>,
}

/// A greatest torque, N m, and its ratio to the original body's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Torque {
    newton_metres: f64,
    factor: f64,
}

impl Maturity {
    /// Computes the factors of a body with the strength of an age in months.
    ///
    /// # Errors
    /// Assets that cannot be compiled.
    pub fn of(config: &Config, age: f64, sizes: &Sizes, assets: &dyn AssetSource) -> Result<Self, SceneError> {
        let text = bare_scene(sizes.version);
        let draft = || Draft::read_str(&text, DOCUMENT, assets);
        let original = compile(draft()?.compile(assets)?)?;
        let grown = |shapes| -> Result<Model, SceneError> {
            let mut draft = draft()?;
            sizes.resize(shapes, &mut draft)?;
            Ok(compile(draft.compile(assets)?)?)
        };
        let [body, strong] = [grown(&sizes.body)?, grown(&sizes.strong)?];
        let volumes = sizes.volume_ratios(&mut draft()?)?;
        let bodies = Bodies {
            original: Weights::of(&original),
            strong: Weights::of(&strong),
            model: &original,
            age,
        };
        let mut made = Self::default();
        if config.springs == SpringModel::Weight {
            made.springs = springs(&bodies.original, &Weights::of(&body), &original);
        }
        for (actuator, name) in original.actuator_name.iter().enumerate() {
            let volume = sizes.volume_ratio(&volumes, name).unwrap_or(1.0);
            let Some((group, curves)) = rule(without_side(name)) else {
                continue;
            };
            let before = torques(&original, actuator);
            let own = group.factor(&config.strength_factors);
            let share = super::strength::share(name, sizes.version);
            let mut torque = [Torque::default(); 2];
            for ((torque, curve), before) in torque.iter_mut().zip(curves).zip(before) {
                torque.factor = own * bodies.factor(curve, volume)?;
                torque.newton_metres = before * torque.factor * share;
            }
            made.strength.insert(name.clone(), torque);
        }
        made.rows = rows(&bodies, sizes, &volumes, &made.strength)?;
        if config.strength == StrengthModel::Volume {
            made.strength.clear();
        }
        Ok(made)
    }

    /// Returns the strengths under both settings, as printed by `babybench inspect --age`.
    pub fn rows(&self) -> &[StrengthRow] {
        &self.rows
    }

    /// Returns whether the strength of actuators is that of infants.
    pub fn has_strength(&self) -> bool {
        !self.strength.is_empty()
    }

    /// Sets the strength of infants, and springs by weight, for a document's MIMo.
    pub fn apply(&self, draft: &mut Draft, own: &[String]) {
        for joint in draft.joints() {
            if let Some(factor) = self.springs.get(joint.name) {
                *joint.stiffness *= factor;
                *joint.damping *= factor;
            }
        }
        for mut actuator in draft
            .actuators()
            .filter(|actuator| own.iter().any(|j| j == actuator.joint))
        {
            let Some([negative, positive]) = self.strength.get(actuator.name) else {
                continue;
            };
            let most = negative.newton_metres.max(positive.newton_metres);
            if actuator.is_servo() {
                // a servo's gear would change its angles
                actuator.limit_force([-negative.newton_metres, positive.newton_metres]);
            } else if most > 0.0 {
                *actuator.gear = most;
                actuator.limit_force([-negative.newton_metres / most, positive.newton_metres / most]);
            } else {
                *actuator.gear = 0.0;
            }
            for (fmax, torque) in actuator.user.iter_mut().skip(1).zip([negative, positive]) {
                *fmax *= torque.factor;
            }
        }
    }
}

/// The original body, and the body whose weight determines the strength.
struct Bodies<'m> {
    original: Weights<'m>,
    strong: Weights<'m>,
    model: &'m Model,
    /// Age of the strength, months.
    age: f64,
}

impl Bodies<'_> {
    /// Returns the torques that the ratios of a curve refer to, N m, for the original body and for the other.
    fn gravity(&self, curve: &RatioCurve) -> Result<[f64; 2], GrowthError> {
        let both = [&self.original, &self.strong].map(|weights| match curve.against {
            Against::Joint(joint) => weights.torque(joint),
            Against::Support => weights.support(),
            Against::Grip | Against::Volume => weights.grip(),
        });
        match both {
            [Some(original), Some(strong)] => Ok([original, strong]),
            _ => Err(missing(format!("part that the strength of \"{}\" follows", curve.name))),
        }
    }

    /// Returns the torque of the original body that a curve refers to, N m.
    fn reference(&self, curve: &RatioCurve) -> f64 {
        let (name, direction) = curve.reference;
        // version 2 has no such motor; its fingers follow the shares alone
        self.model
            .actuator(name)
            .map_or(0.0, |k| torques(self.model, k)[direction])
    }

    /// Returns the factor of a curve on the torques of the original body; `volume` is the factor by the volume of the part.
    fn factor(&self, curve: &RatioCurve, volume: f64) -> Result<f64, GrowthError> {
        let [original, strong] = self.gravity(curve)?;
        Ok(match curve.against {
            Against::Volume => curve.at(self.age, 1.0) * volume,
            Against::Grip => curve.at(self.age, 1.0) * strong / original,
            Against::Joint(_) | Against::Support => {
                let torque = self.reference(curve);
                curve.at(self.age, torque / original) * strong / torque
            }
        })
    }
}

/// Returns the rows of a table of strength.
fn rows(
    bodies: &Bodies,
    sizes: &Sizes,
    volumes: &[(String, usize, f64)],
    strength: &BTreeMap<String, [Torque; 2]>,
) -> Result<Vec<StrengthRow>, GrowthError> {
    let mut rows = Vec::new();
    for curve in CURVES {
        let (name, direction) = curve.reference;
        let (Some(actuator), Some(infant)) = (bodies.model.actuator(name), strength.get(name)) else {
            continue;
        };
        let volume = sizes.volume_ratio(volumes, name).unwrap_or(1.0);
        let today = torques(bodies.model, actuator)[direction] * volume;
        let gravity = match curve.against {
            Against::Volume => bodies.strong.torque("robot:left_elbow").unwrap_or(f64::NAN),
            _ => bodies.gravity(curve)?[1],
        };
        rows.push(StrengthRow {
            name: curve.name,
            gravity,
            torques: [today, infant[direction].newton_metres],
        });
    }
    Ok(rows)
}

/// Returns the factors on the springs and dampers of MIMo's joints: the loads of gravity over those of the original body. The joints of the eyes are
/// left out, because they pass through the centre of their load.
fn springs(original: &Weights, body: &Weights, model: &Model) -> BTreeMap<String, f64> {
    let own = model.jnt_name.iter().filter(|name| name.starts_with(JOINT_PREFIX));
    let factor = |name: &String| {
        let (before, now) = (original.load(name)?, body.load(name)?);
        (before > 1e-9).then(|| (name.clone(), now / before))
    };
    own.filter_map(factor).collect()
}

/// Returns the greatest torques of a motor in the negative and in the positive direction, N m.
fn torques(model: &Model, actuator: usize) -> [f64; 2] {
    let [low, high] = model.actuator_forcerange[actuator];
    [-low, high].map(|share| share * model.actuator_gear[actuator])
}

/// Returns the name of an actuator without `act:` and side.
pub(super) fn without_side(actuator: &str) -> &str {
    let name = actuator.strip_prefix("act:").unwrap_or(actuator);
    let side = ["left_", "right_"].iter().find_map(|side| name.strip_prefix(side));
    side.unwrap_or(name)
}

/// Returns the document of a MIMo with all motors and nothing else.
pub(super) fn bare_scene(version: Version) -> String {
    scene_xml(&Config {
        behavior: match version {
            Version::V1 => Behavior::None,
            Version::V2 => Behavior::HandRegard,
        },
        scene: Scene::Base,
        actuation_model: ActuationModel::SpringDamper,
        act: BodyParts::all(true),
        ..Config::default()
    })
}

/// Lists the constants of strength.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let curves = CURVES.iter().map(|curve| SourcedConstant {
        name: format!("strength, {}", curve.name),
        values: curve.ratios.to_vec(),
        ages: RATIO_AGES.to_vec(),
        unit: match curve.against {
            Against::Joint(_) => "of gravity's torque",
            Against::Support => "of half the weight times the thigh",
            Against::Grip => "of the original body's ratio",
            Against::Volume => "of `strength: volume`",
        },
        source: curve.source,
        mark: curve.mark,
    });
    let arm = SourcedConstant {
        name: "arm of a hand's grip".to_string(),
        values: vec![super::gravity::GRIP_ARM],
        ages: Vec::new(),
        unit: "m",
        source: "ours",
        mark: Mark::Unsourced,
    };
    curves.chain([arm]).collect()
}
