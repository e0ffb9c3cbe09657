//! MIMo in a Rapier world.

use thiserror::Error;

use super::{Blueprint, Env, EnvError, Observation, Snapshot, SnapshotError, Step};
use crate::config::{Config, EngineKind};
use crate::model::Model;
use crate::rapier::rapier3d_f64::prelude::Pose;
use crate::rapier::{Coupling, CouplingError, CouplingOptions, CouplingSnapshot, WorldSets};

/// MIMo in a Rapier world of your own, with his senses, solved by this library's engine, with contacts that push both ways.
///
/// Bodies of the world near him are bodies of his scene while they are near: he feels them, sees them and pushes them, and they push him.
/// [`Coupling`] describes how, the supported shapes, and what is left to Rapier.
///
/// ```
/// use babybench::Config;
/// use babybench::config::Behavior;
/// use babybench::env::Infant;
/// use babybench::rapier::rapier3d_f64::prelude::*;
/// use babybench::rapier::{CouplingOptions, WorldSets};
///
/// let mut world = PhysicsWorld::new();
/// world.gravity = Vector::new(0.0, 0.0, -9.81);
/// world.integration_parameters.dt = 0.005;
/// world.insert_collider(ColliderBuilder::new(SharedShape::halfspace(Vector::Z)), None); // the ground
/// let ball = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 1.0));
/// world.insert(ball, ColliderBuilder::ball(0.05).density(300.0));
///
/// let config = Config { behavior: Behavior::None, vision_active: false, ..Config::default() };
/// let (here, options) = (Pose::IDENTITY, CouplingOptions::default());
/// let mut infant = Infant::join(&mut WorldSets::from(&mut world), config, here, options)?;
/// let action = vec![0.0; infant.env().action_space().len()];
/// for _ in 0..20 {
///     let step = infant.step(&mut WorldSets::from(&mut world), &action)?;
///     assert!(step.observation.touch.is_some());
///     world.step();
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Infant {
    env: Env,
    coupling: Coupling,
}

/// A snapshot of an [`Infant`]. The program keeps the snapshot of its world.
#[derive(Clone, Debug, PartialEq)]
pub struct InfantSnapshot {
    /// The snapshot of the environment.
    pub env: Snapshot,
    /// The snapshot of the coupling, with the bodies of the world that are in his scene.
    pub coupling: CouplingSnapshot,
}

/// An error of an [`Infant`].
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InfantError {
    /// An error of his environment.
    #[error(transparent)]
    Env(#[from] EnvError),
    /// An error in coupling him with the world.
    #[error(transparent)]
    Coupling(#[from] CouplingError),
    /// An error in restoring a snapshot.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// The configuration selects an engine that cannot be coupled.
    #[error("`engine: rapier` cannot be coupled with a world: leave it out, or use Bridge")]
    Engine,
    /// The configuration lets MIMo grow.
    #[error(
        "MIMo cannot grow by `age_schedule` in a world: the bodies that stand for those of the world belong to one model"
    )]
    Growing,
}

impl Infant {
    /// Makes the environment of a configuration, resets it, and inserts MIMo into a world. `frame` is the frame of his scene in the world: he
    /// lies or sits on its plane z = 0 as in the scene of the configuration. In worlds whose y points up it turns z into y.
    ///
    /// A step of the environment takes the time step of the world: `frame_skip` follows from it. The bodies that stand for those of the
    /// world are added to `scene_extra`; a document of your own ([`Scene::File`](crate::config::Scene::File)) has to include
    /// [`CouplingOptions::slots`]. The scene's own fixed geoms, such as the floor, stay away unless [`CouplingOptions::scenery`].
    ///
    /// # Errors
    /// Errors of the configuration and the coupling; nothing is inserted then.
    pub fn join(
        sets: &mut WorldSets<'_>,
        config: Config,
        frame: Pose,
        options: CouplingOptions,
    ) -> Result<Self, InfantError> {
        if config.engine == EngineKind::Rapier {
            return Err(InfantError::Engine);
        }
        if !config.age_schedule.is_empty() {
            return Err(InfantError::Growing);
        }
        let mut config = config;
        if !matches!(config.scene, crate::config::Scene::File(_)) {
            config.scene_extra += &options.slots();
        }
        let mut blueprint = Blueprint::new(config)?;
        let steps = Coupling::steps(blueprint.model(), sets.dt)?;
        // only a compiled scene has a timestep to compare with that of the world
        if steps != blueprint.config().frame_skip {
            let config = Config {
                frame_skip: steps,
                ..blueprint.config().clone()
            };
            blueprint = Blueprint::new(config)?;
        }
        Self::insert(sets, blueprint.env()?, frame, options)
    }

    /// Inserts the MIMo of an environment, whose scene has [`CouplingOptions::slots`], into a world, and resets the environment.
    ///
    /// # Errors
    /// As [`Infant::join`]; a time step of the world that is not that of the environment.
    pub fn insert(
        sets: &mut WorldSets<'_>,
        mut env: Env,
        frame: Pose,
        options: CouplingOptions,
    ) -> Result<Self, InfantError> {
        check_steps(&env, sets)?;
        env.reset(Some(env.config().seed))?;
        let coupling = Coupling::join(
            env.model(),
            env.physics.reader().topology(),
            env.state(),
            sets,
            frame,
            options,
        )?;
        Ok(Self { env, coupling })
    }

    /// Applies an action for one time step of the world, and applies the impulses of contacts to the bodies that touch him. The program steps
    /// its world afterwards.
    ///
    /// # Errors
    /// Those of [`Coupling::update`] and of the action, which change nothing. A simulation that diverged, after which
    /// [`Infant::reset`] is needed.
    pub fn step(&mut self, sets: &mut WorldSets<'_>, action: &[f32]) -> Result<Step<'_>, InfantError> {
        self.env.check_action(action)?;
        check_steps(&self.env, sets)?;
        self.env.physics.check_shape().map_err(EnvError::from)?;
        let (env, coupling) = (&mut self.env, &mut self.coupling);
        if let Some(model) = coupling.update(&env.blueprint.model().clone(), env.physics.state(), sets)? {
            use_slots(env, coupling, model)?;
        }
        coupling.load(env.physics.state_mut(), sets);
        let model = env.model().clone();
        env.watched_step(action, &mut |state| coupling.record(&model, state))?;
        coupling.unload(&model, env.physics.state(), sets)?;
        Ok(self.env.last_step())
    }

    /// Applies the rest of the impulses to the bodies of the world after its step; see [`Coupling::unload`]. Otherwise the next
    /// [`Infant::step`] applies them.
    pub fn finish(&mut self, sets: &mut WorldSets<'_>) {
        self.coupling.finish(sets);
    }

    /// Starts an episode on the floor of his own scene, without the bodies of the world, and then puts him into the world.
    ///
    /// # Errors
    /// As [`Env::reset`].
    pub fn reset(&mut self, sets: &mut WorldSets<'_>, seed: Option<u64>) -> Result<Observation<'_>, InfantError> {
        let model = self.coupling.clear(self.env.model(), sets);
        use_slots(&mut self.env, &self.coupling, model)?;
        self.env.reset(seed)?;
        let model = self.env.model().clone();
        self.coupling.place(&model, self.env.physics.state(), sets)?;
        Ok(self.env.observation())
    }

    /// Returns his environment: senses, state, information.
    pub fn env(&self) -> &Env {
        &self.env
    }

    /// Returns his environment, to lock joints, apply forces or draw pictures. He is stepped and reset by [`Infant::step`] and
    /// [`Infant::reset`].
    pub fn env_mut(&mut self) -> &mut Env {
        &mut self.env
    }

    /// Returns the coupling: neighbors, impulses, colliders.
    pub fn coupling(&self) -> &Coupling {
        &self.coupling
    }

    /// Takes a snapshot. With a copy of the world, taken at the same time, it continues the run with the same bits.
    pub fn snapshot(&self) -> InfantSnapshot {
        InfantSnapshot {
            env: self.env.snapshot(),
            coupling: self.coupling.snapshot(),
        }
    }

    /// Restores a snapshot, after the program has restored the world.
    ///
    /// # Errors
    /// As [`Env::restore`] and [`Coupling::restore`].
    pub fn restore(&mut self, sets: &mut WorldSets<'_>, snapshot: &InfantSnapshot) -> Result<(), InfantError> {
        self.env.restore(&snapshot.env)?;
        let model = self.env.model().clone();
        Ok(self.coupling.restore(&snapshot.coupling, &model, sets)?)
    }

    /// Removes him from the world, and returns his environment, which needs a reset.
    ///
    /// # Errors
    /// Textures that cannot be read.
    pub fn leave(mut self, sets: &mut WorldSets<'_>) -> Result<Env, InfantError> {
        let model = self.coupling.clear(self.env.model(), sets);
        use_slots(&mut self.env, &self.coupling, model)?;
        self.coupling.leave(sets);
        self.env.end_episode();
        Ok(self.env)
    }
}

/// Checks that a step of the environment fits the time step of the world.
fn check_steps(env: &Env, sets: &WorldSets<'_>) -> Result<(), CouplingError> {
    let steps = Coupling::steps(env.model(), sets.dt)?;
    let frame_skip = env.config().frame_skip;
    if steps == frame_skip {
        return Ok(());
    }
    Err(CouplingError::Steps {
        dt: sets.dt,
        timestep: env.model().opt.timestep,
        steps: frame_skip,
    })
}

/// Continues with a model whose slots stand for other bodies.
fn use_slots(env: &mut Env, coupling: &Coupling, model: Model) -> Result<(), EnvError> {
    // a picture still to be drawn shows the bodies as they are
    env.senses_mut().look()?;
    env.blueprint = env
        .blueprint
        .with_slots(model, |model, params| coupling.adopt(model, params))?;
    let model = env.blueprint.model();
    coupling.adopt(model, &mut env.physics.base);
    coupling.adopt(model, &mut env.physics.state_mut().params);
    env.physics.use_engines(env.blueprint.engines());
    env.senses.use_tables(env.blueprint.tables());
    env.senses.use_eyes(&env.blueprint)
}
