//! The description of a record: its geoms, its skin, and the meaning of its arrays.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::RecordError;
use super::rows::MODEL;
use crate::config::{Part, Sex};
use crate::env::{Env, PartNames};
use crate::formats::npz::NpzWriter;
use crate::mimo::{BodyFigures, Individual, MimoBodies, body_kind};
use crate::model::Model;

/// One of MIMo's joints.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JointDescription {
    /// Its name.
    pub name: String,
    /// Its index into `qpos`.
    pub qpos: usize,
    /// Its index into `qvel`.
    pub dof: usize,
}

/// An infant who differs from others of his age.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InfantDescription {
    /// Boy or girl.
    pub sex: Sex,
    /// The z-score of his length.
    pub length_z: f64,
    /// The z-score of his weight.
    pub weight_z: f64,
    /// The z-score of his head circumference.
    pub head_z: f64,
    /// His length, m.
    pub length: f64,
    /// His weight, kg.
    pub weight: f64,
    /// The circumference of his head, m.
    pub head_circumference: f64,
}

impl InfantDescription {
    /// Describes the infant of an environment as its record begins; `None` if he is no individual.
    pub(super) fn of(env: &Env) -> Option<Self> {
        let infant = Individual::of(env.config())?;
        let figures = BodyFigures::of(env.model())?;
        Some(Self {
            sex: infant.sex,
            length_z: infant.length_z,
            weight_z: infant.weight_z,
            head_z: infant.head_z,
            length: figures.stature,
            weight: figures.mass,
            head_circumference: BodyFigures::head_circumference(env.model())?,
        })
    }
}

/// A geom of the scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GeomDescription {
    /// Its name as a part of the body; see [`PartNames`](crate::env::PartNames).
    pub part: String,
    /// The body that carries it.
    pub body: String,
    /// The region of MIMo's body: head, trunk, arm, hand, leg or foot; none if the geom is not his.
    pub region: Option<String>,
    /// The side of MIMo's body: right or left; none in the middle.
    pub side: Option<String>,
    /// The hand to which it belongs: right or left, for palms; none for all others.
    pub palm_of: Option<String>,
}

/// Describes MIMo's joints, in the order of the observation.
pub(super) fn limb_joints(env: &Env) -> Vec<JointDescription> {
    let joints = env.senses().proprioception().joints();
    let each = joints.joint.iter().zip(joints.qpos.iter().zip(&joints.dof));
    let describe = |(&joint, (&qpos, &dof)): (&usize, (&usize, &usize))| JointDescription {
        name: env.model().jnt_name[joint].clone(),
        qpos,
        dof,
    };
    each.map(describe).collect()
}

/// Describes all geoms of a scene, by id.
pub(super) fn geoms(model: &Model) -> Vec<GeomDescription> {
    let (names, mimo) = (PartNames::new(model), MimoBodies::of(model));
    let has_mimo = model.body("hip").is_some();
    let describe = |geom: usize| {
        let body = model.geom_bodyid[geom];
        let name = &model.body_name[body];
        let own = has_mimo && mimo.contains(body);
        let kind = body_kind(name).filter(|_| own);
        let side = match name {
            name if name.starts_with("right_") => Some("right"),
            name if name.starts_with("left_") => Some("left"),
            _ => None,
        };
        let side = side.filter(|_| own).map(str::to_string);
        GeomDescription {
            part: names.get(geom).to_string(),
            body: name.clone(),
            region: own.then(|| kind.map_or("hand", |kind| region(kind.part)).to_string()),
            palm_of: side.clone().filter(|_| kind.is_some_and(|kind| kind.name == "hand")),
            side,
        }
    };
    (0..model.ngeom()).map(describe).collect()
}

/// Returns the region of the body that a part belongs to.
fn region(part: Part) -> &'static str {
    match part {
        Part::Head | Part::Eyes => "head",
        Part::Body => "trunk",
        Part::Arms => "arm",
        Part::Hands | Part::Fingers => "hand",
        Part::Legs => "leg",
        Part::Feet => "foot",
    }
}

/// Writes the positions of the touch sensors, if there are any: `skin.npz`.
pub(super) fn write_skin(env: &Env, dir: &Path) -> Result<(), RecordError> {
    let Some(skin) = env.blueprint().skin() else {
        return Ok(());
    };
    let (mut body, mut position) = (Vec::new(), Vec::new());
    for part in skin.bodies() {
        for at in part.positions() {
            body.push(part.body as i32);
            position.extend(at.map(|x| x as f32));
        }
    }
    let mut npz = NpzWriter::new();
    npz.add("body", &[body.len()], &body)?;
    npz.add("position", &[body.len(), 3], &position)?;
    npz.write(dir.join("skin.npz"))?;
    Ok(())
}

/// Returns dimensions and meaning of an array of an archive.
pub(super) fn meaning(name: &str) -> (&'static str, &'static str) {
    if name.starts_with(MODEL) {
        return (
            "(N)",
            "Numbers of the model that a program had changed before the episode: the whole array, rows one after the other.",
        );
    }
    let known = MEANINGS.iter().find(|(known, ..)| *known == name);
    known.map_or(
        (
            "(T, ...) or (K, H, W, ...)",
            "An entry of the observation, under its key; images are those of eye_steps.",
        ),
        |&(_, shape, meaning)| (shape, meaning),
    )
}

/// Lists names, dimensions and meanings, one line per array.
macro_rules! meanings {
    ($($name:literal $shape:literal $meaning:literal)*) => {
        &[$(($name, $shape, $meaning)),*]
    };
}

/// Names, dimensions and meanings.
const MEANINGS: &[(&str, &str, &str)] = meanings! {
    "snapshot" "(bytes)" "The environment at the start of the episode, for a replay with the same bits."
    "qpos0" "(nq)" "Positions at the start: m, rad, quaternions."
    "qvel0" "(nv)" "Velocities at the start: m/s, rad/s."
    "activity0" "(na)" "Activities of the muscles at the start."
    "drawn" "(T)" "Numbers that the generator of random choices had drawn before each step."
    "time" "(T)" "Simulated time after each step, s, from the start of the episode."
    "actions" "(T, actions)" "Actions, as they were given."
    "qpos" "(T, nq)" "Positions after each step: m, rad, quaternions; rounded, exact in a replay."
    "qvel" "(T, nv)" "Velocities after each step: m/s, rad/s; rounded, exact in a replay."
    "checksum" "(T)" "Checksum of all bits of positions, velocities, observation and reward after each step."
    "touch_ptr" "(T + 1)" "Entries of step t are touch_ptr[t]..touch_ptr[t + 1] of touch_idx and touch_val."
    "touch_idx" "(N)" "Places in the touch observation whose values are not zero."
    "touch_val" "(N)" "Their values, N; rounded to 11 bits, exact in a replay."
    "touch_len" "()" "Length of the touch observation."
    "contact_ptr" "(T + 1)" "Contacts of step t are contact_ptr[t]..contact_ptr[t + 1] of the arrays of contacts."
    "contact_geom" "(C, 2)" "Geom ids of each contact; names are in the manifest."
    "contact_pos" "(C, 3)" "Positions, world, m."
    "contact_dist" "(C)" "Distances of the surfaces, m; negative is penetration."
    "contact_force" "(C, 3)" "Forces of the first geom on the second: along the normal and two tangents, N."
    "reward" "(T)" "Rewards of the task; 0 for BabyBench's behaviors."
    "terminated" "(T)" "Whether success or failure ended the episode."
    "truncated" "(T)" "Whether the episode was cut off."
    "first_touch_step" "(E)" "Steps, from 0, in which a palm touched a part for the first time in the episode."
    "first_touch_hand" "(E)" "The hands of these touches: 0 right, 1 left."
    "first_touch_geom" "(E)" "The geoms of these touches."
    "regards" "(T, 4)" "Steps so far with a hand in view: right eye right hand, right eye left hand, left eye right, left eye left."
    "gaze_angles" "(T, 4)" "How far each hand is off the axis of each eye, rad, in the same order."
    "is_success" "(T)" "Whether the task succeeded in the step."
    "is_failure" "(T)" "Whether the task failed in the step."
    "return" "(T)" "Sum of the rewards so far."
    "eye_steps" "(K)" "Steps, from 0, whose images were recorded."
    "eye_size" "()" "Width and height of the images, pixels, where both are squares of one size."
};
