//! Blueprints of the same configuration at other ages.

use std::sync::{Arc, Mutex, PoisonError};

use super::{Blueprint, BlueprintOptions};
use crate::config::Config;
use crate::env::EnvError;

/// The number of ages that are kept.
const CAPACITY: usize = 32;

/// The blueprints of a configuration at the ages that were needed last. A change of age compiles a scene; a change back does not.
#[derive(Clone, Default)]
pub(super) struct AgeCache(Arc<Mutex<Vec<AgeSlot>>>);

/// A blueprint at an age, locked while it is made, so that threads which need the same one make it once.
#[derive(Clone)]
struct AgeSlot {
    age: Option<f64>,
    blueprint: Arc<Mutex<Option<Blueprint>>>,
}

impl std::fmt::Debug for AgeCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AgeCache").finish_non_exhaustive()
    }
}

impl AgeCache {
    /// Returns the blueprint of an age, which `make` creates if it does not exist.
    fn get(&self, age: Option<f64>, make: impl FnOnce() -> Result<Blueprint, EnvError>) -> Result<Blueprint, EnvError> {
        let slot = self.slot(age);
        // the list is unlocked again, so other ages are found while this one compiles; a panic leaves `None` in the slot
        let mut made = slot.lock().unwrap_or_else(PoisonError::into_inner);
        let blueprint = match &*made {
            Some(blueprint) => blueprint.clone(),
            None => made.insert(make()?.without_ages()).clone(),
        };
        Ok(Blueprint {
            ages: self.clone(),
            ..blueprint
        })
    }

    /// Keeps a blueprint as that of its age.
    fn keep(&self, blueprint: &Blueprint) {
        let slot = self.slot(blueprint.config.age);
        *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(blueprint.clone().without_ages());
    }

    /// Returns the slot of an age, the last used at the end.
    fn slot(&self, age: Option<f64>) -> Arc<Mutex<Option<Blueprint>>> {
        let mut slots = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = match slots.iter().position(|slot| slot.age == age) {
            Some(at) => slots.remove(at),
            None => {
                if slots.len() >= CAPACITY {
                    slots.remove(0);
                }
                AgeSlot {
                    age,
                    blueprint: Arc::default(),
                }
            }
        };
        slots.push(slot.clone());
        slot.blueprint
    }
}

impl Blueprint {
    /// Returns a blueprint of the same configuration with MIMo at another age, months; `None` for the original proportions.
    ///
    /// Names and ids remain. So do the spaces, except for the length of touch, which follows the size of the body unless
    /// [`Config::touch_grows`]. A schedule of ages ends: MIMo keeps the age.
    ///
    /// The blueprints of the last 32 ages are kept, so that going back to one of them compiles nothing.
    ///
    /// # Errors
    /// As [`Blueprint::with`].
    pub fn with_age(&self, age: Option<f64>) -> Result<Self, EnvError> {
        if self.config.age_schedule.is_empty() {
            return self.at_age(age);
        }
        let mut config = Config::clone(&self.config);
        config.keep_age(age);
        self.with_config(config)
    }

    /// Returns the blueprint of the same configuration at another age, with its schedule.
    pub(crate) fn at_age(&self, age: Option<f64>) -> Result<Self, EnvError> {
        self.ages.get(age, || {
            self.with_config(Config {
                age,
                ..Config::clone(&self.config)
            })
        })
    }

    /// Compiles the scene with another configuration of the body.
    fn with_config(&self, config: Config) -> Result<Self, EnvError> {
        let options = BlueprintOptions {
            // the clone is bound to the old body, and binds again to the new one
            task: Some(self.task.clone_task()),
            assets: self.surface.given.clone(),
        };
        Self::with(config, options)
    }

    /// Starts to keep the blueprints of other ages, beginning with this one.
    pub(super) fn keeping_ages(self) -> Self {
        let ages = AgeCache::default();
        ages.keep(&self);
        Self { ages, ..self }
    }

    /// Returns the same blueprint without those of other ages, which would contain it.
    fn without_ages(self) -> Self {
        Self {
            ages: AgeCache::default(),
            ..self
        }
    }
}
