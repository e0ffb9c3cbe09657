//! Skins: meshes whose vertices follow several bodies. [`PosedSkins`](super::PosedSkins) moves them.

use super::mesh::{MOST, Mesh, MeshPart};
use crate::math::{Mat3, Vec3, quat_to_mat, transpose};
use crate::model;

/// The parts of a skin that do not change with poses: faces, bones and weights.
#[derive(Clone, Debug)]
pub struct SkinLook {
    pub bones: Vec<Bone>,
    pub vert: Vec<Vec3>,
    pub face: Vec<[u32; 3]>,
    pub inflate: f64,
    pub parts: Vec<SkinPart>,
}

/// A body that pulls vertices of a skin.
#[derive(Clone, Debug)]
pub struct Bone {
    pub body: usize,
    /// Inverse of the body's orientation in the bind pose, and its position there, m.
    pub turned: Mat3,
    pub from: Vec3,
    /// Vertices that it pulls, and its weight for each.
    pub pulls: Vec<(u32, f64)>,
}

/// A subset of the faces of a skin or flex, small enough for vertex indices of 16 bits.
#[derive(Clone, Debug)]
pub struct SkinPart {
    /// Triangles and texture coordinates.
    pub mesh: Mesh,
    /// The vertex of the skin or flex that each vertex of the mesh is.
    pub vertex: Vec<u32>,
}

impl SkinLook {
    pub fn new(skin: &model::Skin) -> Self {
        let bones = skin.bones.iter().map(|bone| Bone {
            body: bone.body,
            turned: transpose(&quat_to_mat(bone.bindquat.map(f64::from))),
            from: bone.bindpos.map(f64::from),
            pulls: bone
                .vertid
                .iter()
                .zip(&bone.vertweight)
                .map(|(&vertex, &weight)| (vertex, f64::from(weight)))
                .collect(),
        });
        Self {
            bones: bones.collect(),
            vert: skin.vert.iter().map(|v| v.map(f64::from)).collect(),
            face: skin.face.clone(),
            inflate: skin.inflate,
            parts: parts(&skin.vert, &skin.face, &skin.texcoord),
        }
    }
}

/// Cuts faces into parts. If vertices lack texture coordinates, the parts have none.
pub fn parts(vert: &[[f32; 3]], mut faces: &[[u32; 3]], texcoord: &[[f32; 2]]) -> Vec<SkinPart> {
    let mut parts = Vec::new();
    while !faces.is_empty() {
        let (mut mesh, mut vertex) = (Mesh::default(), Vec::new());
        let mut known = vec![u16::MAX; vert.len()]; // the place of each vertex in this part
        mesh.band(MeshPart::Body);
        let mut count = 0;
        for face in faces {
            if mesh.x.len() + 3 > MOST {
                break;
            }
            let corners = face.map(|v| {
                let place = &mut known[v as usize];
                if *place == u16::MAX {
                    *place = mesh.x.len() as u16;
                    mesh.push((vert[v as usize], [0.0; 3]));
                    mesh.texcoord.extend(texcoord.get(v as usize));
                    vertex.push(v);
                }
                *place
            });
            mesh.triangles.push(corners);
            count += 1;
        }
        mesh.end_loose();
        // copies of the last vertex fill up a group
        vertex.resize(mesh.x.len(), vertex.last().copied().unwrap_or_default());
        parts.push(SkinPart { mesh, vertex });
        faces = &faces[count..];
    }
    parts
}
