//! What a model looks like: everything a renderer needs that does not move.

use crate::math::{Mat3, Vec3};
use crate::mjcf_loader::AssetSource;
use crate::model::{CameraId, GeomType, Model, TextureType};
use crate::render::mesh::Mesh;
use crate::render::texture::{Loader, Texture};
use crate::render::{MAX_SIZE, RenderError};

/// Groups of geoms and sites that are drawn.
const VISIBLE_GROUPS: std::ops::Range<usize> = 0..3;
/// A geom of this colour takes that of its material.
const DEFAULT_RGBA: [f32; 4] = [0.5, 0.5, 0.5, 1.0];
/// Lights that fixed-function OpenGL guarantees.
const MAX_LIGHTS: usize = 8;

/// A picture to draw: which camera, how many pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Camera of the model.
    pub camera: CameraId,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
}

impl View {
    /// Number of pixels; of a size that [`View::check`] refuses it may be the largest number.
    pub fn pixels(&self) -> usize {
        self.width.saturating_mul(self.height)
    }

    /// Whether the size is allowed.
    ///
    /// # Errors
    /// A width or height of 0 or above [`MAX_SIZE`].
    pub fn check(&self) -> Result<(), RenderError> {
        let fine = 1..=MAX_SIZE;
        if fine.contains(&self.width) && fine.contains(&self.height) {
            Ok(())
        } else {
            Err(RenderError::Size(self.width, self.height))
        }
    }

    /// Length of the buffer for red, green and blue.
    pub fn rgb_len(&self) -> usize {
        self.pixels().saturating_mul(3)
    }
}

/// Where everything is, in the world, indexed as in the model; positions in m, matrices row-major with the local axes as
/// columns. Cameras look along their -z.
#[derive(Clone, Copy, Debug)]
pub struct Poses<'a> {
    /// Positions of the geoms.
    pub geom_xpos: &'a [Vec3],
    /// Orientations of the geoms.
    pub geom_xmat: &'a [Mat3],
    /// Positions of the sites.
    pub site_xpos: &'a [Vec3],
    /// Orientations of the sites.
    pub site_xmat: &'a [Mat3],
    /// Positions of the cameras.
    pub cam_xpos: &'a [Vec3],
    /// Orientations of the cameras.
    pub cam_xmat: &'a [Mat3],
    /// Positions of the bodies, which carry the lights.
    pub xpos: &'a [Vec3],
    /// Orientations of the bodies.
    pub xmat: &'a [Mat3],
}

/// A picture to draw, of one environment.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// Where everything is.
    pub poses: Poses<'a>,
    /// From where, and how large.
    pub view: View,
}

/// Which element of the model a [`Drawable`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A geom.
    Geom(usize),
    /// A site.
    Site(usize),
}

/// Which mesh a [`Drawable`] uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// [`Mesh::plane`]
    Plane,
    /// [`Mesh::sphere`]
    Sphere,
    /// [`Mesh::capsule`]
    Capsule,
    /// [`Mesh::cylinder`]
    Cylinder,
    /// [`Mesh::cube`]
    Box,
}

impl Shape {
    /// All shapes, in the order of [`Visual::meshes`].
    pub const ALL: [Self; 5] = [Self::Plane, Self::Sphere, Self::Capsule, Self::Cylinder, Self::Box];
}

/// A visible geom or site.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawable {
    /// What it is in the model.
    pub element: Element,
    /// Its mesh.
    pub shape: Shape,
    /// Scale of the unit shape, m; a capsule's is radius, radius, half length.
    pub size: [f32; 3],
    /// Radius of a sphere around its origin that contains it, m.
    pub radius: f32,
    /// Colour and opacity.
    pub rgba: [f32; 4],
    /// Share of the colour that needs no light.
    pub emission: f32,
    /// Strength of highlights.
    pub specular: f32,
    /// Exponent of highlights.
    pub exponent: f32,
    /// Index into [`Visual::textures`].
    pub texture: Option<usize>,
    /// Texture coordinates are those of the unit shape times this, plus `texture_offset`.
    pub texture_scale: [f32; 3],
    /// See `texture_scale`.
    pub texture_offset: f32,
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// Body that carries it.
    pub body: usize,
    /// Position in the body, m; none for parallel light.
    pub pos: Option<Vec3>,
    /// Unit direction in the body.
    pub dir: Vec3,
    /// Ambient colour.
    pub ambient: [f32; 3],
    /// Diffuse colour.
    pub diffuse: [f32; 3],
    /// Colour of highlights.
    pub specular: [f32; 3],
    /// Constant, linear and quadratic attenuation.
    pub attenuation: [f32; 3],
    /// Cosine of the cutoff angle; -1 shines to all sides.
    pub cos_cutoff: f32,
    /// Softness.
    pub exponent: f32,
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Vertical field of view, degrees.
    pub fovy: f64,
}

/// The look of a model. It is immutable; environments of one blueprint share it in an [`std::sync::Arc`].
#[derive(Clone, Debug)]
pub struct Visual {
    /// What is drawn, in the order of the model.
    pub drawables: Vec<Drawable>,
    /// Meshes, in the order of [`Shape::ALL`].
    pub meshes: [Mesh; 5],
    /// Textures in use.
    pub textures: Vec<Texture>,
    /// Index of the background in `textures`.
    pub sky: Option<usize>,
    /// Lights; the headlight, if it is on, is not among them.
    pub lamps: Vec<Lamp>,
    /// Ambient, diffuse and specular colour of the light that shines along every camera, if it is on.
    pub headlight: Option<[[f32; 3]; 3]>,
    /// Cameras of the model.
    pub cameras: Vec<Camera>,
    /// Distance of the near plane, m.
    pub near: f64,
    /// Distance of the far plane, m.
    pub far: f64,
    /// Numbers of geoms, sites and bodies that poses must have.
    sizes: [usize; 3],
}

impl Visual {
    /// Decodes the textures that visible geoms use, from `assets`.
    ///
    /// # Errors
    /// Images that are missing, broken or of a shape that does not fit.
    pub fn new(model: &Model, assets: &dyn AssetSource) -> Result<Self, RenderError> {
        let mut loader = Loader::new(assets);
        let mut textures = Vec::new();
        let mut index = vec![None; model.textures.len()];
        let mut use_texture = |id: usize, textures: &mut Vec<Texture>| -> Result<Option<usize>, RenderError> {
            let Some(recipe) = model.textures.get(id) else {
                return Ok(None);
            };
            if index[id].is_none() {
                textures.push(loader.texture(recipe)?);
                index[id] = Some(textures.len() - 1);
            }
            Ok(index[id])
        };
        let far = model.vis.zfar * model.stat.extent;
        let mut drawables = Vec::new();
        for element in visible(model) {
            let mut drawable = Drawable::new(model, element, far as f32);
            if drawable.rgba[3] <= 0.0 {
                continue;
            }
            if let Some(texture) = material(model, element).and_then(|m| model.materials[m].texture) {
                drawable.texture = use_texture(texture, &mut textures)?;
            }
            drawables.push(drawable);
        }
        let sky = model.textures.iter().position(|t| t.kind == TextureType::Skybox);
        let sky = match sky {
            Some(id) => use_texture(id, &mut textures)?,
            None => None,
        };
        for drawable in &mut drawables {
            drawable.place_texture(model, &textures);
        }
        let vis = &model.vis;
        let headlight = vis
            .headlight_active
            .then(|| [vis.headlight_ambient, vis.headlight_diffuse, vis.headlight_specular].map(single));
        let room = MAX_LIGHTS - usize::from(headlight.is_some());
        Ok(Self {
            drawables,
            meshes: [
                Mesh::plane(),
                Mesh::sphere(),
                Mesh::capsule(),
                Mesh::cylinder(),
                Mesh::cube(),
            ],
            textures,
            sky,
            lamps: model.lights.iter().take(room).map(Lamp::new).collect(),
            headlight,
            cameras: model.cam_fovy.iter().map(|&fovy| Camera { fovy }).collect(),
            near: vis.znear * model.stat.extent,
            far,
            sizes: [model.ngeom(), model.nsite(), model.nbody()],
        })
    }

    /// Bytes of all textures.
    pub fn texture_bytes(&self) -> usize {
        let mut faces: Vec<_> = self
            .textures
            .iter()
            .flat_map(|t| match t {
                Texture::Flat(f) => std::slice::from_ref(f),
                Texture::Cube(f) => f.as_slice(),
            })
            .collect();
        faces.sort_by_key(|f| std::sync::Arc::as_ptr(f));
        faces.dedup_by_key(|f| std::sync::Arc::as_ptr(f));
        faces.iter().flat_map(|f| f.iter()).map(|l| 4 * l.pixels.len()).sum()
    }

    /// Whether a view of poses can be drawn.
    pub(super) fn check(&self, poses: &Poses, view: &View) -> Result<(), RenderError> {
        let camera = view.camera.0;
        if camera >= self.cameras.len() {
            return Err(RenderError::Camera(camera, self.cameras.len()));
        }
        view.check()?;
        let [geoms, sites, bodies] = self.sizes;
        for (what, positions, matrices, expected) in [
            ("geoms", poses.geom_xpos.len(), poses.geom_xmat.len(), geoms),
            ("sites", poses.site_xpos.len(), poses.site_xmat.len(), sites),
            (
                "cameras",
                poses.cam_xpos.len(),
                poses.cam_xmat.len(),
                self.cameras.len(),
            ),
            ("bodies", poses.xpos.len(), poses.xmat.len(), bodies),
        ] {
            let found = positions.min(matrices);
            if found != expected || positions != matrices {
                return Err(RenderError::Poses { what, found, expected });
            }
        }
        Ok(())
    }
}

/// Elements of visible groups, in the order in which MuJoCo draws them.
fn visible(model: &Model) -> impl Iterator<Item = Element> {
    let geoms = (0..model.ngeom()).filter(|&g| VISIBLE_GROUPS.contains(&model.geom_group[g]));
    let sites = (0..model.nsite()).filter(|&s| VISIBLE_GROUPS.contains(&model.site_group[s]));
    geoms.map(Element::Geom).chain(sites.map(Element::Site))
}

fn material(model: &Model, element: Element) -> Option<usize> {
    match element {
        Element::Geom(g) => model.geom_matid[g],
        Element::Site(s) => model.site_matid[s],
    }
}

fn single<const N: usize>(v: [f64; N]) -> [f32; N] {
    v.map(|x| x as f32)
}

impl Drawable {
    fn new(model: &Model, element: Element, far: f32) -> Self {
        let (kind, size, own) = match element {
            Element::Geom(g) => (model.geom_type[g], model.geom_size[g], model.geom_rgba[g]),
            Element::Site(s) => (model.site_type[s], model.site_size[s], model.site_rgba[s]),
        };
        let [a, b, c] = single(size);
        let length = |v: [f32; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let extent = |half: f32| if half > 0.0 { half } else { far };
        let (shape, size, radius) = match kind {
            GeomType::Plane => (
                Shape::Plane,
                [extent(a), extent(b), 1.0],
                length([extent(a), extent(b), 0.0]),
            ),
            GeomType::Sphere => (Shape::Sphere, [a; 3], a),
            GeomType::Capsule => (Shape::Capsule, [a, a, b], a + b),
            GeomType::Ellipsoid => (Shape::Sphere, [a, b, c], a.max(b).max(c)),
            GeomType::Cylinder => (Shape::Cylinder, [a, a, b], length([a, b, 0.0])),
            GeomType::Box => (Shape::Box, [a, b, c], length([a, b, c])),
        };
        let mut drawable = Self {
            element,
            shape,
            size,
            radius,
            rgba: single(own),
            emission: 0.0,
            specular: 0.5,
            exponent: 64.0,
            texture: None,
            texture_scale: [1.0; 3],
            texture_offset: 0.0,
        };
        if let Some(m) = material(model, element).map(|m| &model.materials[m]) {
            if drawable.rgba == DEFAULT_RGBA {
                drawable.rgba = single(m.rgba);
            }
            drawable.emission = m.emission as f32;
            drawable.specular = m.specular as f32;
            drawable.exponent = m.shininess as f32 * 128.0;
        }
        drawable
    }

    /// Texture coordinates follow from the material's repetition and the kind of texture.
    fn place_texture(&mut self, model: &Model, textures: &[Texture]) {
        let (Some(texture), Some(m)) = (self.texture, material(model, self.element)) else {
            return;
        };
        let m = &model.materials[m];
        let scale = if m.texuniform { self.size } else { [1.0; 3] };
        match textures[texture] {
            Texture::Flat(_) => {
                let [u, v] = single(m.texrepeat);
                self.texture_scale = [0.5 * u * scale[0], -0.5 * v * scale[1], 0.0];
                self.texture_offset = -0.5;
            }
            Texture::Cube(_) => self.texture_scale = scale,
        }
    }
}

impl Lamp {
    fn new(light: &crate::model::Light) -> Self {
        let all_round = light.directional || light.cutoff >= 180.0;
        Self {
            body: light.bodyid,
            pos: (!light.directional).then_some(light.pos),
            dir: crate::math::unit(light.dir).0,
            ambient: single(light.ambient),
            diffuse: single(light.diffuse),
            specular: single(light.specular),
            attenuation: if light.directional {
                [1.0, 0.0, 0.0]
            } else {
                single(light.attenuation)
            },
            cos_cutoff: if all_round {
                -1.0
            } else {
                pxfm::f_cos(light.cutoff.to_radians()) as f32
            },
            exponent: if all_round { 0.0 } else { light.exponent as f32 },
        }
    }
}
