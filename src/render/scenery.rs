//! The look of a model: everything a renderer needs that does not move.

use std::sync::Arc;

use crate::RenderError;
use crate::assets::AssetSource;
use crate::drawable::{Drawable, Element};
use crate::flex::FlexLook;
use crate::math::{Vec3, order, unit};
use crate::mesh::Mesh;
use crate::model::{CamLight, Model, Texture, TextureType};
use crate::single::single;
use crate::skin::{SkinLook, SkinPart};
use crate::texture::{TextureLoader, TexturePixels};
use crate::view::{Poses, View};
use crate::visible::{SceneryShapes, UsedTextures, drawables};

/// Number of lights that fixed-function OpenGL guarantees.
const MAX_LIGHTS: usize = 8;

/// A light of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSource {
    /// Body that carries it, by id.
    pub body: usize,
    /// Position in the body, m; `None` for directional light.
    pub pos: Option<Vec3>,
    /// Unit direction in the body.
    pub dir: Vec3,
    /// The body that it follows.
    pub aim: LightAim,
    /// Ambient colour.
    pub ambient: [f32; 3],
    /// Diffuse colour.
    pub diffuse: [f32; 3],
    /// Colour of highlights.
    pub specular: [f32; 3],
    /// Constant, linear and quadratic attenuation.
    pub attenuation: [f32; 3],
    /// Cosine of the cutoff angle; -1 for a light that shines in all directions.
    pub cos_cutoff: f32,
    /// Exponent of the falloff towards the cutoff.
    pub exponent: f32,
}

/// The way a light follows its body or another, by its [`CamLight`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightAim {
    /// Moves and turns with its body.
    Body,
    /// Keeps its direction and its offset from the origin of its body.
    Track {
        /// Offset in the world, m.
        offset: Vec3,
        /// Unit direction in the world.
        dir: Vec3,
    },
    /// Keeps its direction and its offset from the centre of mass of its body and those below it.
    TrackCom {
        /// Offset in the world, m.
        offset: Vec3,
        /// Unit direction in the world.
        dir: Vec3,
    },
    /// Moves with its body and shines at the origin of another.
    Target {
        /// The other body.
        body: usize,
        /// Position of the light in its body, m.
        pos: Vec3,
    },
    /// Moves with its body and shines at the centre of mass of another and those below it.
    TargetCom {
        /// The other body.
        body: usize,
        /// Position of the light in its body, m.
        pos: Vec3,
    },
}

/// A camera of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Vertical field of view, degrees.
    pub fovy: f64,
    /// Half the width of its sensor over its horizontal focal length. Without a sensor, the width of a picture follows from its height.
    pub half_width: Option<f64>,
    /// Whether the axis of its lens meets the middle of its sensor; other cameras cannot be drawn.
    pub centred: bool,
    /// Whether its rays are parallel; such cameras cannot be drawn.
    pub orthographic: bool,
}

impl Camera {
    fn new(model: &Model, camera: usize) -> Self {
        let ([wide, high], [focal, _, x, y]) = (model.cam_sensorsize[camera], model.cam_intrinsic[camera]);
        let sensor = wide != 0.0 && high != 0.0;
        Self {
            fovy: model.cam_fovy[camera],
            half_width: sensor.then(|| 0.5 * wide / focal),
            centred: !sensor || x == 0.0 && y == 0.0,
            orthographic: model.cam_orthographic[camera],
        }
    }
}

/// The look of a model: immutable, and shared by the environments of one blueprint in an [`std::sync::Arc`].
#[doc(alias = "mjvScene")]
#[derive(Clone, Debug)]
pub struct Scenery {
    /// Visible geoms, sites, tendons and edges of flexes of lines, in the order of the model, then the parts of other flexes and of skins.
    pub drawables: Vec<Drawable>,
    /// Meshes: those of [`Shape::ALL`](crate::Shape::ALL) in its order, then those of the model that are visible.
    pub meshes: Vec<Mesh>,
    /// Flexes of triangles and tetrahedra that are visible.
    pub(super) flexes: Vec<FlexLook>,
    /// Skins that are visible.
    pub(super) skins: Vec<SkinLook>,
    /// Textures in use.
    pub textures: Vec<TexturePixels>,
    /// Their recipes.
    pub(super) recipes: Vec<Texture>,
    /// Index of the background in `textures`.
    pub sky: Option<usize>,
    /// Lights, without the headlight.
    pub lights: Vec<LightSource>,
    /// Ambient, diffuse and specular colour of the headlight, which shines along every camera; `None` if it is off.
    pub headlight: Option<[[f32; 3]; 3]>,
    /// Vertical field of view of the free camera, degrees.
    pub fovy: f64,
    /// Cameras of the model.
    pub cameras: Vec<Camera>,
    /// Distance of the near plane, m.
    pub near: f64,
    /// Distance of the far plane, m.
    pub far: f64,
    /// Numbers of geoms, sites, bodies, tendons, points of tendons and vertices of flexes that poses must have.
    sizes: [usize; 6],
}

impl Scenery {
    /// Decodes the textures that visible geoms use, from `assets`.
    ///
    /// # Errors
    /// Fails if an image is missing, broken or of a shape that does not fit, or if the textures together have more pixels than
    /// [`Limits::texture_pixels`](mjcf_sim_model::Limits::texture_pixels).
    pub fn new(model: &Model, assets: &dyn AssetSource) -> Result<Self, RenderError> {
        Self::build(model, Some(TextureLoader::new(assets)), None)
    }

    /// Decodes only the textures that `other`, a scenery of the same assets, does not have, and shares the others.
    ///
    /// # Errors
    /// As [`Scenery::new`].
    pub fn sharing(model: &Model, assets: &dyn AssetSource, other: &Self) -> Result<Self, RenderError> {
        Self::build(model, Some(TextureLoader::new(assets)), Some(other))
    }

    /// Leaves textures out, as if the model had none.
    ///
    /// # Errors
    /// None: only textures can fail.
    pub fn without_textures(model: &Model) -> Result<Self, RenderError> {
        Self::build(model, None, None)
    }

    fn build(model: &Model, loader: Option<TextureLoader>, known: Option<&Self>) -> Result<Self, RenderError> {
        let mut used = UsedTextures {
            model,
            loader,
            known,
            index: vec![None; model.textures.len()],
            textures: Vec::new(),
            recipes: Vec::new(),
        };
        let far = model.vis.zfar * model.stat.extent;
        let mut meshes = vec![
            Mesh::plane(),
            Mesh::sphere(),
            Mesh::capsule(),
            Mesh::cylinder(),
            Mesh::cube(),
        ];
        let SceneryShapes {
            mut drawables,
            flexes,
            skins,
        } = drawables(model, far as f32, &mut used, &mut meshes)?;
        let (headlight, lights) = lights(model);
        let near = lights.iter().any(|light| light.pos.is_some());
        let shines = headlight.is_some_and(|[.., specular]| specular != [0.0; 3])
            || lights.iter().any(|light| light.specular != [0.0; 3]);
        // parallel light without highlights is the same all over a plane
        for drawable in &mut drawables {
            if near || shines && drawable.specular > 0.0 {
                drawable.divide(model, far as f32);
            }
        }
        let sky = model.textures.iter().position(|t| t.kind == TextureType::Skybox);
        let sky = match sky {
            Some(id) => used.texture(id)?,
            None => None,
        };
        let (textures, recipes) = (used.textures, used.recipes);
        for drawable in &mut drawables {
            let explicit = match drawable.element {
                Element::Flex(flex) => !model.flexes[flex].texcoord.is_empty(),
                Element::Skin(skin) => !model.skins[skin].texcoord.is_empty(),
                _ => !meshes[drawable.mesh].texcoord.is_empty(),
            };
            if explicit && matches!(drawable.texture.map(|t| &textures[t]), Some(TexturePixels::Cube(_))) {
                // coordinates in an image have no meaning for a cube
                drawable.texture = None;
            }
            drawable.place_texture(model, &textures);
        }
        let vis = &model.vis;
        Ok(Self {
            drawables,
            meshes,
            flexes,
            skins,
            textures,
            recipes,
            sky,
            lights,
            headlight,
            fovy: vis.fovy,
            cameras: (0..model.cam_fovy.len())
                .map(|camera| Camera::new(model, camera))
                .collect(),
            near: vis.znear * model.stat.extent,
            far,
            sizes: [
                model.ngeom(),
                model.nsite(),
                model.nbody(),
                model.ntendon(),
                2 * model.nwrap(),
                model.nflexvert(),
            ],
        })
    }

    /// Returns the mesh of a drawable; that of a flex or skin is in the pose of the model and has no normals; [`PosedSkins`](crate::PosedSkins) has
    /// the mesh of a moment.
    pub fn mesh_of(&self, drawable: &Drawable) -> Option<&Mesh> {
        let soft = self.soft_parts().map(|part| &part.mesh);
        self.meshes.iter().chain(soft).nth(drawable.mesh)
    }

    /// Returns the parts of flexes and skins, whose meshes change with the poses.
    pub(super) fn soft_parts(&self) -> impl Iterator<Item = &SkinPart> {
        let flexes = self.flexes.iter().flat_map(|flex| &flex.parts);
        flexes.chain(self.skins.iter().flat_map(|skin| &skin.parts))
    }

    /// Returns the vertical field of view of a camera, degrees.
    pub(super) fn fovy_of(&self, camera: usize) -> f64 {
        self.cameras.get(camera).map_or(self.fovy, |c| c.fovy)
    }

    /// Returns half the width of the view of a camera with a sensor at a distance of 1 m, m.
    pub(super) fn half_width_of(&self, camera: usize) -> Option<f64> {
        self.cameras.get(camera).and_then(|c| c.half_width)
    }

    /// Returns the memory used by all textures, bytes.
    pub fn texture_bytes(&self) -> usize {
        let mut faces: Vec<_> = self
            .textures
            .iter()
            .flat_map(|t| match t {
                TexturePixels::Flat(f) => std::slice::from_ref(f),
                TexturePixels::Cube(cube) => cube.faces.as_slice(),
            })
            .collect();
        // images are shared between textures, and count once
        order::sort_by(&mut faces, |a, b| Arc::as_ptr(a).cmp(&Arc::as_ptr(b)));
        faces.dedup_by_key(|f| Arc::as_ptr(f));
        let within: usize = faces.iter().flat_map(|f| f.iter()).map(|l| l.pixels.len()).sum();
        let around = |texture: &TexturePixels| match texture {
            TexturePixels::Flat(_) => 0,
            TexturePixels::Cube(cube) => cube.around(),
        };
        4 * (within + self.textures.iter().map(around).sum::<usize>())
    }

    /// Checks that a view of these poses can be drawn.
    pub(super) fn check(&self, poses: &Poses, view: &View) -> Result<(), RenderError> {
        let camera = view.camera;
        if camera == View::FREE {
            poses.free.ok_or(RenderError::FreeCamera)?;
        } else if camera >= self.cameras.len() {
            return Err(RenderError::Camera {
                camera,
                count: self.cameras.len(),
            });
        } else if !self.cameras[camera].centred {
            return Err(RenderError::OffCentre { camera });
        } else if self.cameras[camera].orthographic {
            return Err(RenderError::Orthographic { camera });
        }
        view.check()?;
        let [geoms, sites, bodies, tendons, points, vertices] = self.sizes;
        let flexes = poses.flexvert_xpos.len();
        for (what, positions, matrices, expected) in [
            ("geoms", poses.geom_xpos.len(), poses.geom_xmat.len(), geoms),
            ("geoms", poses.geom_size.len(), poses.geom_size.len(), geoms),
            ("sites", poses.site_xpos.len(), poses.site_xmat.len(), sites),
            (
                "cameras",
                poses.cam_xpos.len(),
                poses.cam_xmat.len(),
                self.cameras.len(),
            ),
            ("tendons", poses.ten_wrapadr.len(), poses.ten_wrapnum.len(), tendons),
            ("points of tendons", poses.wrap_xpos.len(), poses.wrap_obj.len(), points),
            ("vertices of flexes", flexes, flexes, vertices),
            ("bodies", poses.xpos.len(), poses.xmat.len(), bodies),
            ("bodies", poses.subtree_com.len(), poses.subtree_com.len(), bodies),
        ] {
            let found = positions.min(matrices);
            if found != expected || positions != matrices {
                return Err(RenderError::Poses { what, found, expected });
            }
        }
        Ok(())
    }
}

impl LightAim {
    fn new(light: &crate::model::Light) -> Self {
        let (pos, dir) = (light.pos, light.dir0);
        match (light.mode, light.targetbodyid) {
            (CamLight::Track, _) => Self::Track {
                offset: light.pos0,
                dir,
            },
            (CamLight::TrackCom, _) => Self::TrackCom {
                offset: light.poscom0,
                dir,
            },
            (CamLight::TargetBody, Some(body)) => Self::Target { body, pos },
            (CamLight::TargetBodyCom, Some(body)) => Self::TargetCom { body, pos },
            // Without a target a light shines along its frame.
            (CamLight::Fixed | CamLight::TargetBody | CamLight::TargetBodyCom, _) => Self::Body,
        }
    }
}

impl LightSource {
    fn new(light: &crate::model::Light) -> Self {
        let all_round = light.directional || light.cutoff >= 180.0;
        Self {
            body: light.bodyid,
            pos: (!light.directional).then_some(light.pos),
            dir: unit(light.dir).0,
            aim: LightAim::new(light),
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

/// Returns the colours of the headlight, if it is on, and the lights of a scene.
fn lights(model: &Model) -> (Option<[[f32; 3]; 3]>, Vec<LightSource>) {
    let vis = &model.vis;
    let headlight = vis
        .headlight_active
        .then(|| [vis.headlight_ambient, vis.headlight_diffuse, vis.headlight_specular].map(single));
    // the headlight takes one of OpenGL's lights
    let room = MAX_LIGHTS - usize::from(headlight.is_some());
    (
        headlight,
        model
            .lights
            .iter()
            .filter(|light| light.active)
            .take(room)
            .map(LightSource::new)
            .collect(),
    )
}
