//! A scene in Rapier, for queries.

use super::{Blueprint, EnvError};
use crate::physics::State;
use crate::physics::contact::Quirks;
use crate::rapier::RapierScene;

impl Blueprint {
    /// Creates a mirror of the scene in Rapier, at a state ([`Env::state`](crate::Env::state)), for ray casts and shape queries. After a step,
    /// [`RapierScene::sync`] updates it at much lower cost than creating it.
    ///
    /// ```
    /// use babybench::rapier::rapier3d_f64::prelude::{QueryFilter, Ray, Vector};
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let mut scene = env.blueprint().rapier_scene(env.state())?;
    ///
    /// let [x, y, z] = env.state().xpos[env.model().body("head").ok_or("MIMo has a head")?];
    /// let from_above = Ray::new(Vector::new(x, y, z + 1.0), -Vector::Z);
    /// let (collider, distance) = scene.queries(QueryFilter::default()).cast_ray(&from_above, 10.0, true).ok_or("a hit")?;
    /// let body = env.model().geom_bodyid[scene.geom_of(collider).ok_or("a geom")?];
    /// println!("{} is {distance:.2} m below", env.model().body_name[body]);
    ///
    /// env.step(&vec![0.0; env.action_space().len()])?;
    /// scene.sync(env.state())?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`RapierScene::sync`].
    pub fn rapier_scene(&self, state: &State) -> Result<RapierScene, EnvError> {
        // the peculiarities of contact geometry that both engines share
        let mut scene = RapierScene::new(self.model().clone(), Quirks::default());
        scene.sync(state)?;
        Ok(scene)
    }
}
