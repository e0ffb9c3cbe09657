//! A spring between a point of a body and a point of the world, with a stiffness proportional to the mass, for the page and for Python's window.

use babybench::Env;
use babybench::math::{Vec3, add, mat_t_vec, mat_vec, norm, scale, sub};

/// The angular frequency of the pulled body, rad/s: stiffness is its square times the mass that the point feels.
const STRENGTH: f64 = 12.0;
/// The greatest force, in weights of the mass at the point, so that a distant pointer does not throw the infant out of the room.
const MOST: f64 = 40.0;

/// Pulls a body of an environment, or nothing.
#[derive(Default)]
pub struct Spring {
    held: Option<Held>,
}

struct Held {
    body: usize,
    /// The pulled point, in the frame of the body, m.
    point: Vec3,
    target: Vec3,
    /// The point's position before the last step, world, m.
    before: Option<Vec3>,
}

impl Held {
    /// Returns the current position of the body's point in the world, m.
    fn at(&self, env: &Env) -> Option<Vec3> {
        let (pos, mat) = (env.state().xpos.get(self.body)?, env.state().xmat.get(self.body)?);
        Some(add(*pos, mat_vec(mat, self.point)))
    }
}

impl Spring {
    /// Grabs a body at a point of the world, m, if the body can move. Returns whether it did.
    pub fn hold(&mut self, env: &Env, body: usize, place: Vec3) -> bool {
        let (model, state) = (env.model(), env.state());
        let moves = model.body_weldid.get(body).is_some_and(|&root| root != 0);
        self.held = match (state.xpos.get(body), state.xmat.get(body)) {
            (Some(&pos), Some(mat)) if moves => Some(Held {
                body,
                point: mat_t_vec(mat, sub(place, pos)),
                target: place,
                before: None,
            }),
            _ => None,
        };
        self.held.is_some()
    }

    /// Pulls towards another point of the world, m.
    pub fn aim(&mut self, target: Vec3) {
        if let Some(held) = &mut self.held {
            held.target = target;
        }
    }

    /// Releases the body and removes the force.
    pub fn let_go(&mut self, env: &mut Env) {
        if self.held.take().is_some() {
            env.state_mut().release_forces();
        }
    }

    /// Returns its two ends in the world, m, if it holds something.
    pub fn ends(&self, env: &Env) -> Option<[Vec3; 2]> {
        let held = self.held.as_ref()?;
        Some([held.at(env)?, held.target])
    }

    /// Sets the force of the next step; the last one took `seconds`.
    pub fn pull(&mut self, env: &mut Env, seconds: f64) {
        let Some(held) = &mut self.held else { return };
        let Some(at) = held.at(env) else { return };
        let inverse = env.model().body_invweight0.get(held.body).map_or(0.0, |w| w[0]);
        let mass = 1.0 / inverse.max(1e-9);
        let velocity = held
            .before
            .map_or([0.0; 3], |before| scale(sub(at, before), 1.0 / seconds));
        let to = scale(sub(held.target, at), STRENGTH * STRENGTH);
        let mut force = scale(sub(to, scale(velocity, 1.4 * STRENGTH)), mass);
        let (size, most) = (norm(force), MOST * mass * 9.81);
        if size > most {
            force = scale(force, most / size);
        }
        held.before = Some(at);
        let body = held.body;
        env.state_mut().release_forces();
        // a state that is not finite any more is an error of the next step
        let _ = env.state_mut().apply_force(body, force, [0.0; 3], at);
    }
}
