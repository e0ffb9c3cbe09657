//! The body that holds MIMo and turns him.

use std::f64::consts::PI;

use super::controls::{angles, missing};
use super::sample::Sample;
use super::{Fixture, FixtureKind};
use crate::config::Config;
use crate::env::{Env, EnvError};
use crate::math::Vec3;
use crate::text::quoted;

/// Its name in a scene.
const NAME: &str = "protocol_holder";
/// Height at which MIMo is held upright, m.
const HEIGHT: f64 = 1.0;

impl Fixture {
    /// Adds the holder to the scene of a configuration.
    pub(super) fn add_to(&self, config: &mut Config) -> Result<(), String> {
        if !self.weld.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return Err(format!(
                "the fixture holds {:?}, which is not the name of a body",
                quoted(&self.weld)
            ));
        }
        config.scene_extra.push_str(&format!(
            "<body name='{NAME}' mocap='true'><geom type='sphere' size='0.005' contype='0' conaffinity='0'/></body>\
             <equality><weld body1='{NAME}' body2='{}' solref='0.01 1'/></equality>",
            self.weld
        ));
        Ok(())
    }
}

/// The holder in a trial.
#[derive(Debug)]
pub(super) struct Holder<'f> {
    fixture: &'f Fixture,
    joints: Vec<usize>,
    /// Points of MIMo before and after he is put into place, m; the holder turns him about the second.
    from: Vec3,
    to: Vec3,
    /// Angle at which the trial begins, rad.
    start: f64,
    /// The sum of the angles after the last step, degrees.
    sum: f64,
    found: Sample,
}

impl<'f> Holder<'f> {
    /// Holds MIMo after a reset, and puts him upright if the fixture does.
    pub fn hold(fixture: &'f Fixture, env: &mut Env) -> Result<Self, EnvError> {
        let model = env.model().clone();
        let mut holder = Self {
            fixture,
            joints: angles(&model, &fixture.joints)?,
            from: [0.0; 3],
            to: [0.0; 3],
            start: 0.0,
            sum: 0.0,
            found: Sample::default(),
        };
        match fixture.kind {
            FixtureKind::Pull => {
                let hip = model.body("hip").ok_or_else(|| missing("body", "hip"))?;
                holder.from = env.state().xpos[hip];
                holder.to = holder.from;
            }
            FixtureKind::Tilt => {
                let root = model
                    .joint("mimo_location")
                    .ok_or_else(|| missing("joint", "mimo_location"))?;
                let root = model.jnt_qposadr[root];
                holder.from = std::array::from_fn(|k| model.qpos0[root + k]);
                holder.to = [holder.from[0], holder.from[1], HEIGHT];
                // in the document he lies on his back
                holder.start = 0.5 * PI;
                let mut qpos = env.state().qpos.clone();
                for &q in &env.senses().proprioception().joints().qpos {
                    qpos[q] = 0.0;
                }
                qpos[root..root + 3].copy_from_slice(&holder.to);
                qpos[root + 3..root + 7].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
                holder.turn(env, 0.0)?;
                env.by_hand().set_state(&qpos, &vec![0.0; model.nv])?;
            }
        }
        Ok(holder)
    }

    /// Turns the holder to an angle of the fixture, rad, about the axis y.
    fn turn(&self, env: &mut Env, angle: f64) -> Result<(), EnvError> {
        let angle = self.start + angle;
        // correctly rounded, so that every machine has the same bits
        let (sin, cos) = (pxfm::f_sin(angle), pxfm::f_cos(angle));
        let [x, y, z] = self.from;
        let turned = [cos * x + sin * z, y, cos * z - sin * x];
        let pos = std::array::from_fn(|k| self.to[k] - turned[k]);
        let quat = [pxfm::f_cos(0.5 * angle), 0.0, pxfm::f_sin(0.5 * angle), 0.0];
        env.by_hand().set_mocap(NAME, pos, quat)
    }

    /// Returns the angle of the fixture after a share of the phase, degrees.
    fn angle(&self, share: f64) -> f64 {
        self.fixture.degrees * share
    }

    /// Moves the holder before step `step` of `steps`, from 0.
    pub fn before(&self, env: &mut Env, step: u64, steps: u64) -> Result<(), EnvError> {
        let share = (step + 1) as f64 / steps as f64;
        self.turn(env, self.angle(share) * PI / 180.0)
    }

    /// Measures after step `step` of `steps`, from 0.
    pub fn after(&mut self, env: &Env, step: u64, steps: u64) {
        self.sum = self.joints.iter().map(|&q| env.state().qpos[q]).sum::<f64>() * 180.0 / PI;
        let (before, now) = (
            self.angle(step as f64 / steps as f64),
            self.angle((step + 1) as f64 / steps as f64),
        );
        for &at in &self.fixture.at {
            // the first step at which the holder is there, within what rounding leaves of an angle
            let near = 1e-9 * self.fixture.degrees;
            if now + near >= at && before + near < at {
                self.found.put(&format!("at_{at}"), -self.sum);
            }
        }
        let gave_way = self.fixture.gives_way.is_some_and(|most| self.sum.abs() > most);
        if gave_way && !self.found.values.contains_key("gives_way") {
            self.found.put("gives_way", now);
        }
    }

    /// Returns the measures of the trial.
    pub fn end(mut self) -> Sample {
        if self.fixture.gives_way.is_some() && !self.found.values.contains_key("gives_way") {
            self.found.put("gives_way", self.fixture.degrees);
        }
        self.found
    }
}
