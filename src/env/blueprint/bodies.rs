//! Blueprints of the same configuration with other bodies: other ages, and other infants of its population.

use std::sync::{Arc, Mutex, PoisonError};

use super::{Blueprint, BlueprintOptions};
use crate::config::Config;
use crate::env::EnvError;

/// The number of bodies that are kept.
const CAPACITY: usize = 32;
/// The number of bodies of a population that are kept.
const POPULATION: usize = 128;

/// The blueprints of a configuration with the bodies that were needed last. A change of body compiles a scene; a change back does not.
#[derive(Clone, Default)]
pub(super) struct BodyCache(Arc<Mutex<Vec<BodySlot>>>);

/// What distinguishes the bodies of a configuration: the age, and the number of the infant.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BodyKey {
    age: Option<f64>,
    number: u64,
}

impl BodyKey {
    fn of(config: &Config) -> Self {
        let (age, number) = (config.age, config.individual.number);
        Self { age, number }
    }
}

/// A blueprint with a body, locked while it is made, so that threads which need the same one make it once.
#[derive(Clone)]
struct BodySlot {
    body: BodyKey,
    blueprint: Arc<Mutex<Option<Blueprint>>>,
}

impl std::fmt::Debug for BodyCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BodyCache").finish_non_exhaustive()
    }
}

impl BodyCache {
    /// Returns the blueprint of a configuration, which `make` creates if it does not exist.
    fn get(
        &self,
        config: Config,
        make: impl FnOnce(Config) -> Result<Blueprint, EnvError>,
    ) -> Result<Blueprint, EnvError> {
        let slot = self.slot(&config);
        // the list is unlocked again, so other bodies are found while this one compiles; a panic leaves `None` in the slot
        let mut made = slot.lock().unwrap_or_else(PoisonError::into_inner);
        let blueprint = match &*made {
            Some(blueprint) => blueprint.clone(),
            None => made.insert(make(config)?.without_bodies()).clone(),
        };
        Ok(Blueprint {
            bodies: self.clone(),
            ..blueprint
        })
    }

    /// Keeps a blueprint as that of its body.
    fn keep(&self, blueprint: &Blueprint) {
        let slot = self.slot(&blueprint.config);
        *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(blueprint.clone().without_bodies());
    }

    /// Returns the slot of a configuration's body, the last used at the end.
    fn slot(&self, config: &Config) -> Arc<Mutex<Option<Blueprint>>> {
        let body = BodyKey::of(config);
        let capacity = if config.individual.random > 0.0 {
            POPULATION
        } else {
            CAPACITY
        };
        let mut slots = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = match slots.iter().position(|slot| slot.body == body) {
            Some(at) => slots.remove(at),
            None => {
                if slots.len() >= capacity {
                    slots.remove(0);
                }
                BodySlot {
                    body,
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
    /// The blueprints of the last 32 ages are kept (of a population, 128 bodies), so that going back to one of them compiles nothing.
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
        let config = Config {
            age,
            ..Config::clone(&self.config)
        };
        self.bodies.get(config, |config| self.with_config(config))
    }

    /// Returns a blueprint of the same configuration with another infant of its population (`body_number`): row i of a vector has the i-th after that
    /// of the configuration.
    ///
    /// The blueprints of the last 128 bodies of a population are kept.
    ///
    /// ```
    /// use babybench::{Blueprint, Config};
    /// use babybench::mimo::BodyFigures;
    ///
    /// let mut config = Config { age: Some(3.0), touch_active: false, vision_active: false, ..Config::default() };
    /// config.individual.random = 1.0;
    /// let first = Blueprint::new(config)?;
    /// let second = first.with_body_number(1)?;
    /// assert_ne!(BodyFigures::of(first.model()), BodyFigures::of(second.model()));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Blueprint::with`]; a configuration without a population (`body_random`).
    pub fn with_body_number(&self, number: u64) -> Result<Self, EnvError> {
        let mut config = Config::clone(&self.config);
        config.individual.number = number;
        self.bodies.get(config, |config| self.with_config(config))
    }

    /// Compiles the scene with another configuration of the body.
    fn with_config(&self, config: Config) -> Result<Self, EnvError> {
        let options = BlueprintOptions {
            // the clone is bound to the old body, and binds again to the new one
            task: Some(self.task.clone_task()),
            assets: self.surface.given.clone(),
        };
        // the bodies of a scene have the same textures
        Self::made(config, options, self.surface.scenery.get().map(|scenery| &**scenery))
    }

    /// Starts to keep the blueprints of other bodies, beginning with this one.
    pub(super) fn keeping_bodies(self) -> Self {
        let bodies = BodyCache::default();
        bodies.keep(&self);
        Self { bodies, ..self }
    }

    /// Returns the same blueprint without those of other bodies, which would contain it.
    fn without_bodies(self) -> Self {
        Self {
            bodies: BodyCache::default(),
            ..self
        }
    }
}
