//! The data that a page draws in each frame, in single precision.

use babybench::math::mat_t_vec;
use babybench::model::Model;
use babybench::physics::State;
use babybench::render::{PosedSkins, Poses, Scenery};
use babybench::sensors::Touch;

/// Poses, touch and contacts of one moment.
#[derive(Default)]
pub struct Frame {
    skins: PosedSkins,
    /// For each drawable (12): position, m, and rotation matrix, row by row. The lengths of its columns are the factors by which
    /// the drawable has grown since it was compiled.
    pub poses: Vec<f32>,
    /// For each body (7): position, m, and quaternion, w first.
    pub bodies: Vec<f32>,
    /// The magnitude of each touch sensor's force, N.
    pub felt: Vec<f32>,
    /// For each skin (6 for each vertex of its mesh): positions of all vertices, m, then their unit normals, in the world.
    pub worn: Vec<f32>,
    /// For each contact (8): point, m, force on the second body, N, the two bodies.
    pub contacts: Vec<f32>,
}

impl Frame {
    /// Copies the poses at the start of the last physics step, and the touch then.
    pub fn update(&mut self, model: &Model, scenery: &Scenery, s: &State, touch: Option<&Touch>) {
        self.poses.clear();
        let placed = Poses::from(s);
        for d in &scenery.drawables {
            // a piece of a tendon that does not exist has no extent
            let Some((now, pos, mat)) = d.placed(&placed) else {
                self.poses.extend([0.0; 12]);
                continue;
            };
            self.poses.extend(pos.iter().map(|&v| v as f32));
            let size = now.size;
            let grown = |i: usize| if size[i] == d.size[i] { 1.0 } else { size[i] / d.size[i] };
            self.poses
                .extend(mat.iter().enumerate().map(|(i, &v)| v as f32 * grown(i % 3)));
        }
        self.skins.update(scenery, &placed);
        self.worn.clear();
        for mesh in self.skins.meshes() {
            let places = mesh.x.iter().zip(&mesh.y).zip(&mesh.z);
            self.worn.extend(places.flat_map(|((x, y), z)| [x, y, z]));
            self.worn.extend(mesh.normal.as_flattened());
        }
        self.bodies.clear();
        for (pos, quat) in s.xpos.iter().zip(&s.xquat) {
            self.bodies.extend(pos.iter().chain(quat).map(|&v| v as f32));
        }
        self.felt.clear();
        if let Some(touch) = touch {
            let sizes = touch.values().chunks_exact(touch.width());
            self.felt
                .extend(sizes.map(|v| v.iter().map(|x| x * x).sum::<f32>().sqrt()));
        }
        self.contacts.clear();
        for c in s.contact.iter().filter(|c| c.efc_address.is_some()) {
            let force = mat_t_vec(&c.frame, [c.force[0], c.force[1], c.force[2]]);
            let bodies = c.geom.map(|g| model.geom_bodyid[g] as f64);
            let row = c.pos.into_iter().chain(force).chain(bodies);
            self.contacts.extend(row.map(|v| v as f32));
        }
    }
}
