//! Changes of the model's numbers while an environment runs.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::changeable::{CHANGEABLE, parameters, parameters_mut, rows, rows_mut};
use super::{Blueprint, Env, EnvError, ModelChangeError};
use crate::config::ActuationModel;
use crate::model::{Arrays, Model};
use crate::physics::Params;

/// Arrays without negative numbers.
const AT_LEAST_ZERO: [&str; 14] = [
    "opt.tolerance",
    "opt.ls_tolerance",
    "body_mass",
    "body_inertia",
    "geom_size",
    "dof_armature",
    "dof_damping",
    "dof_frictionloss",
    "geom_friction",
    "pair_friction",
    "geom_rbound",
    "tendon_damping",
    "tendon_frictionloss",
    "tendon_stiffness",
];
/// Arrays in which positive numbers must stay positive.
const ABOVE_ZERO: [&str; 5] = [
    "opt.timestep",
    "opt.ccd_tolerance",
    "body_mass",
    "body_inertia",
    "geom_size",
];

/// A model before and after a change.
struct ModelChange {
    before: Arrays,
    after: Arrays,
}

impl ModelChange {
    /// Checks the changes.
    fn check(&self) -> Result<(), ModelChangeError> {
        let (before, after) = (rows(&self.before), rows(&self.after));
        if before.iter().zip(&after).any(|(a, b)| a.len() != b.len()) {
            return Err(ModelChangeError::Fixed);
        }
        for ((name, before), after) in CHANGEABLE.iter().zip(before).zip(after) {
            for (index, (&was, &is)) in before.iter().zip(after).enumerate() {
                let value = || is.to_string();
                if !is.is_finite() {
                    let value = value();
                    return Err(ModelChangeError::NotFinite { name, index, value });
                }
                let least = match () {
                    () if ABOVE_ZERO.contains(name) && was > 0.0 && is <= 0.0 => "above 0",
                    () if AT_LEAST_ZERO.contains(name) && is < 0.0 => "0 or more",
                    () => continue,
                };
                let value = value();
                return Err(ModelChangeError::TooSmall {
                    name,
                    index,
                    value,
                    least,
                });
            }
        }
        // undoing the allowed changes must give the earlier model; if not, something else was changed
        let mut rest = self.after.clone();
        for (to, from) in rows_mut(&mut rest).into_iter().zip(rows(&self.before)) {
            to.copy_from_slice(from);
        }
        if rest == self.before {
            Ok(())
        } else {
            Err(ModelChangeError::Fixed)
        }
    }

    /// Returns whether an array was changed.
    fn concerns(&self, name: &str) -> bool {
        let (before, after) = (rows(&self.before), rows(&self.after));
        let place = CHANGEABLE.iter().position(|known| *known == name);
        place.is_some_and(|k| before[k] != after[k])
    }

    /// Writes the changed numbers into rows of the same order. There may be fewer rows.
    fn apply(&self, to: Vec<&mut [f64]>) {
        let changed = rows(&self.before).into_iter().zip(rows(&self.after));
        for (to, (before, after)) in to.into_iter().zip(changed) {
            for ((to, was), is) in to.iter_mut().zip(before).zip(after) {
                // numbers that the program left alone keep what a task has made of them
                if was != is {
                    *to = *is;
                }
            }
        }
    }

    /// Writes the changed numbers into parameters.
    fn apply_to(&self, params: &mut Params, model: &Arrays) {
        self.apply(parameters_mut(params));
        if self.concerns("body_mass") {
            // the mass of a subtree is the sum of its bodies, as MuJoCo computes it in each step
            params.body_subtreemass.clone_from(&params.body_mass);
            for body in (1..model.nbody()).rev() {
                params.body_subtreemass[model.body_parentid[body]] += params.body_subtreemass[body];
            }
        }
    }
}

/// Copies the look of other arrays.
fn restore_look(arrays: &mut Arrays, look: &Arrays) {
    macro_rules! copy {
        ($($field:ident)*) => {
            $(arrays.$field.clone_from(&look.$field);)*
        };
    }
    copy!(geom_rgba geom_group geom_matid site_rgba site_group site_matid tendon_rgba tendon_group tendon_matid);
    copy!(materials lights cam_fovy vis);
}

/// Returns the arrays of a model with the values of its parameters.
fn shown(model: &Model, params: &Params) -> Arrays {
    let mut arrays = Arrays::clone(model);
    for (to, from) in rows_mut(&mut arrays).into_iter().zip(parameters(params)) {
        to.copy_from_slice(from);
    }
    arrays
}

/// The model of an environment, to change its numbers: [`Env::model_mut`].
#[derive(Debug)]
pub struct ModelMut<'a> {
    env: &'a mut Env,
}

impl Env {
    /// Returns the model, to change its numbers while the environment runs.
    pub fn model_mut(&mut self) -> ModelMut<'_> {
        ModelMut { env: self }
    }
}

impl ModelMut<'_> {
    /// Changes numbers of the model from the next step, in this and in later episodes: gravity and timestep, mass, inertia, size,
    /// poses, joint axes, friction, damping, stiffness, armature, gears, the laws of actuators and tendons, softness. It has the same effect as
    /// writing into MuJoCo's `mjModel`: constants derived from these numbers (`body_invweight0`, `dof_invweight0`, `geom_rbound`) keep their values
    /// unless the program also writes them.
    ///
    /// A body whose mass or size a task has changed in an episode keeps the task's values until the episode ends. Snapshots of an
    /// environment fit others with the same changes only. [`MimoMut::set_age`](crate::env::MimoMut::set_age) rebuilds the model without
    /// them. Delays keep their number of steps, and so do the rates of senses.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.model_mut().change(|model| {
    ///     model.opt.gravity = [0.0, 0.0, -1.62]; // on the moon
    ///     model.geom_friction.iter_mut().for_each(|friction| friction[0] *= 0.5);
    /// })?;
    /// env.reset(Some(0))?;
    /// assert_eq!(env.state().params.gravity[2], -1.62);
    /// assert!(env.model_mut().change(|model| model.nq += 1).is_err());
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelChangeError`]: other changes, numbers that are not finite or too small, or an engine that cannot simulate the model. They
    /// change nothing.
    pub fn change(self, edit: impl FnOnce(&mut Arrays)) -> Result<(), EnvError> {
        let env = self.env;
        if env.grows() {
            return Err(EnvError::Schedule { what: "model" });
        }
        env.physics.check_shape()?;
        let before = env.blueprint.model_arrays();
        let mut after = before.clone();
        edit(&mut after);
        let change = ModelChange { before, after };
        change.check()?;
        // muscles would silently overwrite the gears in the next step
        if env.config().actuation_model == ActuationModel::Muscle && change.concerns("actuator_gear") {
            return Err(ModelChangeError::Muscles.into());
        }
        // complete before anything in the environment changes
        let blueprint = env.blueprint.changed(&change)?;
        // a picture still to be drawn shows the geoms as they are
        env.senses_mut().look()?;
        env.blueprint = blueprint;
        let model = env.blueprint.model();
        // twice: for later episodes, and for the one that runs, whose parameters a task may have changed
        change.apply_to(&mut env.physics.base, model);
        change.apply_to(&mut env.physics.state_mut().params, model);
        env.physics.use_engines(env.blueprint.engines());
        env.senses.use_tables(env.blueprint.tables());
        if let (Some(reflexes), Some(tables)) = (&mut env.reflexes, &env.blueprint.tables().reflexes) {
            reflexes.use_tables(tables);
        }
        Ok(())
    }

    /// Sets which equality constraints are active (neq), now and in later episodes: MuJoCo's `eq_active0`, with `eq_active`.
    ///
    /// # Errors
    /// [`ModelChangeError::Fixed`] for another number of constraints.
    pub fn set_equalities(self, active: &[bool]) -> Result<(), EnvError> {
        let physics = &mut self.env.physics;
        physics.check_shape()?;
        if active.len() != physics.base.eq_active.len() {
            return Err(ModelChangeError::Fixed.into());
        }
        physics.base.eq_active.copy_from_slice(active);
        physics.state_mut().params.eq_active.copy_from_slice(active);
        Ok(())
    }

    /// Changes the look of the model at any time: colours, groups, materials, lights, fields of view and the settings of `<visual>`. The
    /// next step has the same bits as without the change. Images of the eyes are redrawn. Snapshots fit environments with another look,
    /// and [`MimoMut::set_age`](crate::env::MimoMut::set_age) rebuilds the model without the changes.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// env.model_mut().paint(|model| model.geom_rgba[0] = [1.0, 0.0, 0.0, 1.0])?;
    /// assert!(env.model_mut().paint(|model| model.opt.timestep = 1.0).is_err());
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelChangeError::Fixed`] for other changes, and textures that cannot be read. They change nothing.
    pub fn paint(self, edit: impl FnOnce(&mut Arrays)) -> Result<(), EnvError> {
        let env = self.env;
        if env.grows() {
            return Err(EnvError::Schedule { what: "look" });
        }
        let painted = env.blueprint.model().edited(edit);
        let mut rest = Arrays::clone(&painted);
        let now: &Arrays = env.blueprint.model();
        restore_look(&mut rest, now);
        if rest != *now {
            return Err(ModelChangeError::Fixed.into());
        }
        env.become_painted(&env.blueprint.with_look(painted)?)
    }

    /// Sets the model to the numbers of the scene, except for those of `changes`, as [`Blueprint::changed_numbers`] returns them. Unknown
    /// names and arrays of another length are refused.
    ///
    /// # Errors
    /// As [`ModelMut::change`]. Nothing is changed then.
    pub fn set_changed_numbers(self, changes: &[(String, Vec<f64>)]) -> Result<(), EnvError> {
        let changed = self.env.blueprint.model_changes();
        let (model, params) = self.env.blueprint.origin();
        let first = shown(model, params);
        let known = CHANGEABLE.iter().zip(rows(&first));
        let fits = |(name, numbers): &(String, Vec<f64>)| {
            let found = known.clone().find(|(known, _)| **known == name.as_str());
            found.is_some_and(|(_, first)| first.len() == numbers.len())
        };
        if !changes.iter().all(fits) {
            return Err(ModelChangeError::Fixed.into());
        }
        if changes.is_empty() && changed.is_empty() {
            return Ok(());
        }
        // one change, so that the numbers are checked and the engines made once
        self.change(|arrays| {
            let all = CHANGEABLE.iter().zip(rows_mut(arrays).into_iter().zip(rows(&first)));
            for (name, (to, first)) in all {
                if let Some((_, numbers)) = changes.iter().find(|(changed, _)| changed == name) {
                    to.copy_from_slice(numbers);
                } else if changed.contains(name) {
                    to.copy_from_slice(first);
                }
            }
        })
    }
}

impl Blueprint {
    /// Returns the current arrays of the model, with the changes of [`ModelMut::change`] and the actuation model's parameters after a
    /// reset.
    pub fn model_arrays(&self) -> Arrays {
        shown(self.model(), self.params())
    }

    /// Returns the names of the arrays that differ from the model of the scene.
    pub fn model_changes(&self) -> Vec<&'static str> {
        self.changed_numbers().into_iter().map(|(name, _)| name).collect()
    }

    /// Returns the numbers that differ from the model of the scene: names as in [`CHANGEABLE`], and whole arrays, row by row.
    pub fn changed_numbers(&self) -> Vec<(&'static str, Vec<f64>)> {
        let (model, params) = self.origin();
        let (first, now) = (shown(model, params), self.model_arrays());
        let both = CHANGEABLE.iter().zip(rows(&first).into_iter().zip(rows(&now)));
        both.filter(|(_, (first, now))| first != now)
            .map(|(name, (_, now))| (*name, now.to_vec()))
            .collect()
    }

    /// Returns the blueprint of environments with the changed model.
    fn changed(&self, change: &ModelChange) -> Result<Self, EnvError> {
        let model = Arc::new(self.model().edited(|arrays| change.apply(rows_mut(arrays))));
        let mut params = self.params().clone();
        change.apply_to(&mut params, &model);
        let (first, now) = (shown(self.origin().0, self.origin().1), shown(&model, &params));
        let mut changes = BTreeMap::new();
        for ((name, first), now) in CHANGEABLE.iter().zip(rows(&first)).zip(rows(&now)) {
            if first != now {
                changes.insert(*name, now);
            }
        }
        self.with_model(model, params, &changes)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::{Config, Env};

    #[test]
    fn an_environment_works_with_the_tables_of_its_changed_model() {
        let config = Config {
            touch_active: false,
            vision_active: false,
            ..Config::default()
        };
        let mut env = Env::new(config).expect("embedded assets");
        let before = env.blueprint.tables().clone();
        env.model_mut()
            .change(|model| model.opt.timestep *= 2.0)
            .expect("it can be changed");
        let now = env.blueprint.tables();
        assert!(!Arc::ptr_eq(&before.proprioception, &now.proprioception));
        assert!(Arc::ptr_eq(&env.senses.proprioception, &now.proprioception));
        let vestibular = env.senses.vestibular.as_ref().zip(now.vestibular.as_ref());
        assert!(vestibular.is_some_and(|(used, made)| Arc::ptr_eq(used, made)));
        let mut anew = env.blueprint.env().expect("a blueprint carries the changes");
        for env in [&mut env, &mut anew] {
            env.reset(Some(3)).expect("no divergence");
            env.step(&vec![0.4; env.action_space().len()]).expect("no divergence");
        }
        assert_eq!(env.observation(), anew.observation());
    }
}
