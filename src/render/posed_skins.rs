//! Skins and flexes in given poses, recomputed for every picture.

use super::drawable::Drawable;
use super::mesh::Mesh;
use super::scenery::Scenery;
use super::skin::{SkinLook, SkinPart};
use super::strip::LANES;
use super::view::Poses;
use crate::math::{Vec3, mat_mul, mat_vec, sub};

/// The skins and flexes of a scene in given poses. Its buffers are reused from one picture to the next.
#[derive(Clone, Debug, Default)]
pub struct PosedSkins {
    /// The meshes of all flexes and skins, in the order of the scenery.
    meshes: Vec<Mesh>,
    smooth: Vec<Vec3>,
    place: Vec<[f32; 3]>,
    normal: Vec<[f32; 3]>,
}

impl PosedSkins {
    /// Moves all flexes and skins.
    pub fn update(&mut self, scenery: &Scenery, poses: &Poses) {
        let parts = || scenery.soft_parts();
        // a renderer may be given another scenery for the next picture
        let same = |(mesh, part): (&Mesh, &SkinPart)| {
            mesh.x.len() == part.mesh.x.len()
                && mesh.triangles == part.mesh.triangles
                && mesh.texcoord == part.mesh.texcoord
        };
        if self.meshes.len() != parts().count() || !self.meshes.iter().zip(parts()).all(same) {
            self.meshes = parts().map(|part| part.mesh.clone()).collect();
        }
        let mut meshes = self.meshes.iter_mut();
        for flex in &scenery.flexes {
            flex.place(poses, &mut self.smooth, (&mut self.place, &mut self.normal));
            for (part, mesh) in flex.parts.iter().zip(&mut meshes) {
                dress(part, mesh, &self.place, &self.normal, 0.0);
            }
        }
        for skin in &scenery.skins {
            place(skin, poses, &mut self.place);
            normals(skin, &self.place, &mut self.normal);
            for (part, mesh) in skin.parts.iter().zip(&mut meshes) {
                dress(part, mesh, &self.place, &self.normal, skin.inflate);
            }
        }
    }

    /// Returns the mesh of a drawable: that of a flex or skin, or one of the scenery.
    #[inline(always)]
    pub fn mesh<'a>(&'a self, scenery: &'a Scenery, drawable: &Drawable) -> &'a Mesh {
        match drawable.mesh.checked_sub(scenery.meshes.len()) {
            Some(worn) => &self.meshes[worn],
            None => &scenery.meshes[drawable.mesh],
        }
    }

    /// Returns the meshes of all flexes and skins, in the order of their drawables.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }
}

/// Sums the contributions of the bones to each vertex, in single precision as in MuJoCo.
fn place(skin: &SkinLook, poses: &Poses, out: &mut Vec<[f32; 3]>) {
    out.clear();
    out.resize(skin.vert.len(), [0.0; 3]);
    for bone in &skin.bones {
        let rotation = mat_mul(&poses.xmat[bone.body], &bone.turned);
        let shift = sub(poses.xpos[bone.body], mat_vec(&rotation, bone.from));
        for &(vertex, weight) in &bone.pulls {
            let turned = mat_vec(&rotation, skin.vert[vertex as usize]);
            for (k, v) in out[vertex as usize].iter_mut().enumerate() {
                *v = (f64::from(*v) + weight * (turned[k] + shift[k])) as f32;
            }
        }
    }
}

/// Sums the normals of the faces at each vertex, by area.
fn normals(skin: &SkinLook, place: &[[f32; 3]], out: &mut Vec<[f32; 3]>) {
    out.clear();
    out.resize(place.len(), [0.0; 3]);
    for face in &skin.face {
        let [a, b, c] = face.map(|v| place[v as usize].map(f64::from));
        let normal = crate::math::cross(sub(b, a), sub(c, a));
        for &vertex in face {
            for (sum, x) in out[vertex as usize].iter_mut().zip(normal) {
                *sum = (f64::from(*sum) + x) as f32;
            }
        }
    }
    for normal in out {
        let wide = normal.map(f64::from);
        let length = crate::math::norm(wide);
        if length > 0.0 {
            *normal = wide.map(|x| (x / length) as f32);
        }
    }
}

/// Writes the vertices of a part, moved along their normals.
fn dress(part: &SkinPart, mesh: &mut Mesh, place: &[[f32; 3]], normal: &[[f32; 3]], inflate: f64) {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for (k, &vertex) in part.vertex.iter().enumerate() {
        let (at, n) = (place[vertex as usize], normal[vertex as usize]);
        let at = [0, 1, 2].map(|i| (f64::from(at[i]) + inflate * f64::from(n[i])) as f32);
        (mesh.x[k], mesh.y[k], mesh.z[k]) = (at[0], at[1], at[2]);
        mesh.normal[k] = n;
        for i in 0..3 {
            (low[i], high[i]) = (low[i].min(at[i]), high[i].max(at[i]));
        }
    }
    debug_assert!(part.vertex.len().is_multiple_of(LANES));
    for band in &mut mesh.bands {
        (band.low, band.high) = (low, high);
    }
}
