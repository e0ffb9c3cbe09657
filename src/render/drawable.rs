//! Visible geoms, sites, tendons, flexes and skins: shape, size, colour.

use crate::lattice::Lattice;
use crate::math::{MAT3_ID, Mat3, Vec3, dot, sub};
use crate::model::{GeomType, Model, Skin};
use crate::single::single;
use crate::texture::TexturePixels;
use crate::view::Poses;

/// Default colour of a geom; a geom with this colour takes that of its material.
const DEFAULT_RGBA: [f32; 4] = [0.5, 0.5, 0.5, 1.0];
/// Least opacity of a drawable that is not blended.
pub(super) const OPAQUE: f32 = 0.995;
/// Factor on the opacity of a plane seen from behind.
pub(super) const BEHIND: f64 = 0.3;

/// The element of the model that a [`Drawable`] shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A geom, by id.
    Geom(usize),
    /// A site, by id.
    Site(usize),
    /// A straight piece of a spatial tendon.
    Tendon {
        /// The tendon, by id.
        tendon: usize,
        /// The index of the piece; the number of pieces changes as the tendon touches and leaves geoms.
        piece: usize,
    },
    /// An edge of a flex of lines.
    FlexEdge {
        /// The flex, by id.
        flex: usize,
        /// The edge in the flex.
        edge: usize,
    },
    /// A flex of triangles or tetrahedra, by id, or a part of a large one.
    Flex(usize),
    /// A skin, by id, or a part of a large one.
    Skin(usize),
}

/// The mesh that a [`Drawable`] uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// A rectangle: [`Mesh::plane`](crate::Mesh::plane).
    Plane,
    /// A sphere or ellipsoid: [`Mesh::sphere`](crate::Mesh::sphere).
    Sphere,
    /// A capsule: [`Mesh::capsule`](crate::Mesh::capsule).
    Capsule,
    /// A cylinder: [`Mesh::cylinder`](crate::Mesh::cylinder).
    Cylinder,
    /// A box: [`Mesh::cube`](crate::Mesh::cube).
    Box,
    /// A mesh, a height field, a flex or a skin of the model, or a part of a large one.
    Mesh,
}

impl Shape {
    /// The shapes that all scenes have, in the order of [`Scenery::meshes`](crate::Scenery::meshes).
    pub const ALL: [Self; 5] = [Self::Plane, Self::Sphere, Self::Capsule, Self::Cylinder, Self::Box];
}

/// A visible geom, site, flex or skin, or a piece of a tendon or flex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawable {
    /// Element of the model.
    pub element: Element,
    /// Shape.
    pub shape: Shape,
    /// Index into [`Scenery::meshes`](crate::Scenery::meshes), after which the parts of all flexes and skins are counted.
    pub mesh: usize,
    /// Scale of the unit shape in the model, m; 1 for meshes of the model; a capsule's is radius, radius, half length, which is 1
    /// for a piece of a tendon and an edge of a flex. Images use [`Drawable::placed`].
    pub size: [f32; 3],
    /// Radius of the bounding sphere around its origin, m.
    pub radius: f32,
    /// Colour and opacity.
    pub rgba: [f32; 4],
    /// Share of the colour that is emitted.
    pub emission: f32,
    /// Strength of highlights.
    pub specular: f32,
    /// Exponent of highlights.
    pub exponent: f32,
    /// Index into [`Scenery::textures`](crate::Scenery::textures).
    pub texture: Option<usize>,
    /// Scale of texture coordinates: they are those of the unit shape times this, plus `texture_offset`.
    pub texture_scale: [f32; 3],
    /// Offset of texture coordinates, see `texture_scale`.
    pub texture_offset: f32,
    /// The points at which the light on a plane is computed, if its corners are not enough.
    pub(super) lattice: Option<Lattice>,
    /// Type and size of the element in the model.
    kind: GeomType,
    measured: Vec3,
    /// The upward direction times the length of a tendon that hangs loose; zeros for everything else, m.
    pub(super) rope: Vec3,
    /// Vertices of an edge of a flex, among those of all flexes; zeros for everything else.
    pub(super) ends: [usize; 2],
    /// Half of each infinite side, m.
    far: [f32; 2],
    /// Whether the texture keeps its scale when the size changes.
    texuniform: bool,
}

/// Returns the material of an element, by id.
pub(super) fn material(model: &Model, element: Element) -> Option<usize> {
    match element {
        Element::Geom(g) => model.geom_matid[g],
        Element::Site(s) => model.site_matid[s],
        Element::Tendon { tendon, .. } => model.tendon_matid[tendon],
        Element::FlexEdge { flex, .. } | Element::Flex(flex) => model.flexes[flex].material,
        Element::Skin(skin) => model.skins[skin].material,
    }
}

/// Returns the shape of an element of the model, its scale and the radius of its bounding sphere (m). `far` is half of each infinite side of a plane.
fn dimensions(kind: GeomType, size: Vec3, far: [f32; 2]) -> (Shape, [f32; 3], f32) {
    let [a, b, c] = single(size);
    let length = |v: [f32; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let extent = |half: f32, far: f32| if half > 0.0 { half } else { far };
    match kind {
        GeomType::Plane => {
            let [a, b] = [extent(a, far[0]), extent(b, far[1])];
            (Shape::Plane, [a, b, 1.0], length([a, b, 0.0]))
        }
        GeomType::Sphere => (Shape::Sphere, [a; 3], a),
        GeomType::Capsule => (Shape::Capsule, [a, a, b], a + b),
        GeomType::Ellipsoid => (Shape::Sphere, [a, b, c], a.max(b).max(c)),
        GeomType::Cylinder => (Shape::Cylinder, [a, a, b], length([a, b, 0.0])),
        GeomType::Box => (Shape::Box, [a, b, c], length([a, b, c])),
        GeomType::HField | GeomType::Mesh => (Shape::Mesh, [1.0; 3], length([a, b, c])),
    }
}

impl Drawable {
    pub(super) fn new(model: &Model, element: Element, far: f32) -> Self {
        let (kind, size, own) = match element {
            Element::Geom(g) => (model.geom_type[g], model.geom_size[g], model.geom_rgba[g]),
            Element::Site(s) => (model.site_type[s], model.site_size[s], model.site_rgba[s]),
            Element::Tendon { tendon, .. } => {
                let size = [model.tendon_width[tendon], 1.0, 0.0];
                (GeomType::Capsule, size, model.tendon_rgba[tendon])
            }
            Element::FlexEdge { flex, .. } => {
                let flex = &model.flexes[flex];
                (GeomType::Cylinder, [flex.radius, 1.0, 0.0], flex.rgba)
            }
            Element::Flex(flex) => (GeomType::Mesh, Skin::SIZE, model.flexes[flex].rgba),
            Element::Skin(skin) => (GeomType::Mesh, Skin::SIZE, model.skins[skin].rgba),
        };
        let far = [far; 2];
        let (shape, scale, radius) = dimensions(kind, size, far);
        let mut drawable = Self {
            element,
            shape,
            // for a mesh of the model, the caller sets the index
            mesh: shape as usize,
            size: scale,
            radius,
            rgba: single(own),
            emission: 0.0,
            specular: 0.5,
            exponent: 64.0,
            texture: None,
            texture_scale: [1.0; 3],
            texture_offset: 0.0,
            lattice: None,
            kind,
            measured: size,
            rope: [0.0; 3],
            ends: [0; 2],
            far,
            texuniform: false,
        };
        if let Element::Geom(g) = element
            && kind == GeomType::HField
        {
            drawable.radius = model.geom_rbound[g] as f32;
        }
        if let Element::Flex(_) | Element::Skin(_) = element {
            // its vertices are in the world: bands are culled by their boxes
            drawable.radius = f32::INFINITY;
            drawable.size = [1.0; 3];
        }
        if let Element::FlexEdge { flex, edge } = element {
            let flex = &model.flexes[flex];
            drawable.ends = flex.edge[edge].map(|v| flex.vertadr + v);
        }
        if let Some(m) = material(model, element).map(|m| &model.materials[m]) {
            if drawable.rgba == DEFAULT_RGBA {
                drawable.rgba = single(m.rgba);
            }
            drawable.emission = m.emission as f32;
            drawable.specular = m.specular as f32;
            drawable.exponent = m.shininess as f32 * 128.0;
            drawable.texuniform = m.texuniform;
        }
        drawable
    }

    /// Returns the drawable with another mesh.
    pub(super) fn showing(self, mesh: usize) -> Self {
        Self { mesh, ..self }
    }

    /// Returns the drawable with the size that it has in these poses, its position and its orientation; `None` for a piece of a tendon
    /// that does not exist.
    #[inline(always)]
    pub fn placed(&self, poses: &Poses) -> Option<(Self, Vec3, Mat3)> {
        match self.element {
            Element::Geom(g) => {
                let drawable = match poses.geom_size.get(g) {
                    Some(size) if *size != self.measured => self.resized(*size),
                    _ => *self,
                };
                Some((drawable, poses.geom_xpos[g], poses.geom_xmat[g]))
            }
            Element::Site(s) => Some((*self, poses.site_xpos[s], poses.site_xmat[s])),
            Element::Tendon { tendon, piece } => self.strung(poses, tendon, piece),
            Element::FlexEdge { .. } => self.stretched(poses),
            Element::Flex(_) | Element::Skin(_) => Some((*self, [0.0; 3], MAT3_ID)),
        }
    }

    /// Lights a plane as MuJoCo does, at the corners of a grid. `far` is the distance of the far plane, m.
    pub(super) fn divide(&mut self, model: &Model, far: f32) {
        if self.shape == Shape::Plane {
            let repeat = material(model, self.element).map(|m| model.materials[m].texrepeat);
            self.far = Lattice::new([0.0; 3], far, repeat).half();
            self.lattice = Some(Lattice::new(self.measured, far, repeat));
            let (_, size, radius) = dimensions(self.kind, self.measured, self.far);
            (self.size, self.radius) = (size, radius);
        }
    }

    /// Returns the position of a drawable for a camera: that of the element, except for endless planes that are lit on a lattice.
    pub(super) fn centred(&self, pos: Vec3, mat: &Mat3, eye: Vec3) -> Vec3 {
        let Some(lattice) = &self.lattice else { return pos };
        let mut centre = pos;
        for direction in 0..2 {
            let axis = [mat[direction], mat[3 + direction], mat[6 + direction]];
            let shift = lattice.shift(direction, dot(sub(eye, pos), axis));
            for k in 0..3 {
                centre[k] += shift * axis[k];
            }
        }
        centre
    }

    /// Returns the size of the element in the model.
    pub(super) fn measured(&self) -> Vec3 {
        self.measured
    }

    #[cold]
    pub(super) fn resized(&self, measured: Vec3) -> Self {
        let (_, size, radius) = dimensions(self.kind, measured, self.far);
        let mut other = Self {
            size,
            radius,
            measured,
            lattice: self.lattice.map(|lattice| lattice.resized(measured, self.far)),
            ..*self
        };
        if self.texuniform {
            for k in 0..3 {
                other.texture_scale[k] *= size[k] / self.size[k];
            }
        }
        other
    }

    /// Derives texture coordinates from the material's repetition and the kind of texture.
    pub(super) fn place_texture(&mut self, model: &Model, textures: &[TexturePixels]) {
        let (Some(texture), Some(m)) = (self.texture, material(model, self.element)) else {
            return;
        };
        let m = &model.materials[m];
        let scale = match (self.shape, m.texuniform) {
            _ if matches!(self.element, Element::Flex(_) | Element::Skin(_)) => {
                if m.texuniform {
                    single(self.measured)
                } else {
                    [1.0; 3]
                }
            }
            // its vertices are in metres already
            (Shape::Mesh, false) => single(self.measured).map(|x| 1.0 / x),
            (Shape::Mesh, true) | (_, false) => [1.0; 3],
            (_, true) => self.size,
        };
        match textures[texture] {
            TexturePixels::Flat(_) => {
                let [u, v] = single(m.texrepeat);
                self.texture_scale = [0.5 * u * scale[0], -0.5 * v * scale[1], 0.0];
                self.texture_offset = -0.5;
            }
            TexturePixels::Cube(_) if self.shape == Shape::Mesh => {}
            TexturePixels::Cube(_) => self.texture_scale = scale,
        }
    }
}
