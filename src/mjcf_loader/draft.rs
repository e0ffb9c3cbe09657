//! An MJCF document that a program can still change.

use crate::assets::AssetSource;
use crate::limits::Limits;
use crate::math::Vec3;
use crate::model::{BiasType, GeomType};

use super::document::{Body, Camera, TypedDocument};
use super::error::LoadError;
use super::spec::{Locations, Spec};
use super::words::AutoBool;
use super::xml::Tree;
use super::{compile, geom_volume, read};

/// An MJCF document that was read and checked, with its default classes applied, and not yet compiled: sizes, positions,
/// masses and strengths can be changed, as in MuJoCo's `mjSpec` before `mj_compile`. Names and ids stay.
///
/// ```
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::{mjcf_loader::Draft, physics};
///
/// let text = r#"<mujoco><worldbody><body name="ball"><freejoint/><geom size=".1" mass="2"/></body></worldbody></mujoco>"#;
/// let mut draft = Draft::read_str(text, "ball.xml", &MemoryAssets::new())?;
/// if let Some(geom) = draft.geom("ball", 0) {
///     geom.size[0] = 0.05;
/// }
/// let model = physics::compile(draft.compile(&MemoryAssets::new())?)?;
/// assert_eq!((model.geom_size[0][0], model.body_mass[1]), (0.05, 2.0));
/// # Ok::<(), mjcf_sim::mjcf_loader::LoadError>(())
/// ```
pub struct Draft {
    tree: Tree,
    document: TypedDocument,
    /// Prefix of all names.
    prefix: String,
}

/// A geom of a [`Draft`].
#[derive(Debug)]
pub struct DraftGeom<'a> {
    /// Shape.
    pub kind: GeomType,
    /// Size as in MJCF: radius, half lengths, m.
    pub size: &'a mut Vec3,
    /// Position in the body, m.
    pub pos: &'a mut Vec3,
    /// Mass, kg; `None` if it follows from the density.
    pub mass: &'a mut Option<f64>,
}

impl DraftGeom<'_> {
    /// Returns the volume, m^3; 0 for a plane.
    pub fn volume(&self) -> f64 {
        geom_volume(self.kind, self.size)
    }
}

/// An actuator of a [`Draft`].
#[derive(Debug)]
pub struct DraftActuator<'a> {
    /// Name.
    pub name: &'a str,
    /// Name of the joint that it drives.
    pub joint: &'a str,
    /// Ratio of the force on the joint to the actuator's force.
    pub gear: &'a mut f64,
    /// Range of the actuator's force; see [`DraftActuator::limit_force`].
    pub forcerange: &'a mut [f64; 2],
    forcelimited: &'a mut AutoBool,
    servo: bool,
    gainprm: &'a mut [f64],
    biasprm: &'a mut [f64],
    /// Numbers for programs.
    pub user: &'a mut [f64],
}

impl DraftActuator<'_> {
    /// Returns whether the actuator's force follows the position or velocity of its joint, as that of a servo does.
    pub fn is_servo(&self) -> bool {
        self.servo
    }

    /// Multiplies the actuator's force: the gear of a motor, or gain and bias of a servo, because its gear would also change its angles.
    pub fn strengthen(&mut self, factor: f64) {
        if self.servo {
            self.gainprm
                .iter_mut()
                .chain(&mut *self.biasprm)
                .for_each(|v| *v *= factor);
        } else {
            *self.gear *= factor;
        }
    }

    /// Sets the range of the actuator's force, and enforces it.
    pub fn limit_force(&mut self, range: [f64; 2]) {
        *self.forcerange = range;
        *self.forcelimited = AutoBool::Yes;
    }
}

/// A joint of a [`Draft`].
#[derive(Debug)]
pub struct DraftJoint<'a> {
    /// Name.
    pub name: &'a str,
    /// Stiffness of the spring, N m/rad or N/m.
    pub stiffness: &'a mut f64,
    /// Damping, N m s/rad or N s/m.
    pub damping: &'a mut f64,
}

impl std::fmt::Debug for Draft {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Draft")
            .field("path", &self.tree.file(0))
            .finish_non_exhaustive()
    }
}

impl Draft {
    /// Reads a document given as text, as if it were the file `virtual_path` of `source`.
    ///
    /// # Errors
    /// As [`super::load`].
    pub fn read_str(xml: &str, virtual_path: &str, source: &dyn AssetSource) -> Result<Self, LoadError> {
        Self::read_str_with(xml, virtual_path, source, &Limits::default())
    }

    /// Reads a document as [`Draft::read_str`] does, within the given limits.
    ///
    /// # Errors
    /// As [`super::load`].
    pub fn read_str_with(
        xml: &str,
        virtual_path: &str,
        source: &dyn AssetSource,
        limits: &Limits,
    ) -> Result<Self, LoadError> {
        let path = source
            .resolve("", virtual_path)
            .map_err(|e| LoadError::in_file(virtual_path, e))?;
        let (tree, _) = Tree::read(xml, &path, source, limits)?;
        let document = read::read(&tree)?;
        Ok(Self {
            tree,
            document,
            prefix: String::new(),
        })
    }

    /// Compiles the document, with all changes, into ids and arrays. Textures and meshes are looked up in `source`.
    ///
    /// # Errors
    /// As [`super::load`]; an element at fault is named with its place in the text.
    pub fn compile(self, source: &dyn AssetSource) -> Result<Spec, LoadError> {
        let Self { tree, mut document, .. } = self;
        // first, because `leave_out` also changes the flexes that come from this
        compile::expand_flexes(&tree, &mut document, source)?;
        compile::leave_out(&tree, &mut document)?;
        let (arrays, bodies) = compile::compile(&tree, &document, source)?;
        let places = Locations {
            bodies,
            tendons: document.tendons.iter().map(|tendon| tendon.at).collect(),
            actuators: document.actuators.iter().map(|actuator| actuator.at).collect(),
            tree,
        };
        let lengthrange = document.lengthrange;
        Ok(Spec {
            arrays,
            places,
            lengthrange,
        })
    }

    /// Sets a prefix: later calls see only bodies, joints, sites, cameras and actuators whose names begin with it, and take names without it.
    pub fn set_prefix(&mut self, prefix: &str) {
        self.prefix = prefix.to_string();
    }

    /// Returns the position of a body in its parent, m; `None` if there is no such body.
    pub fn body_pos(&mut self, name: &str) -> Option<&mut Vec3> {
        self.body(name).map(|body| &mut body.frame.pos)
    }

    /// Returns the anchor of a joint in its body, m; `None` if there is no such joint.
    pub fn joint_pos(&mut self, name: &str) -> Option<&mut Vec3> {
        let mut joints = self.document.bodies.iter_mut().flat_map(|body| &mut body.joints);
        let prefix = &self.prefix;
        joints
            .find(|joint| is_called(&joint.name, prefix, name))
            .map(|joint| &mut joint.pos)
    }

    /// Returns the joints, in the order of their bodies.
    pub fn joints(&mut self) -> impl Iterator<Item = DraftJoint<'_>> {
        let prefix = self.prefix.as_str();
        let joints = self.document.bodies.iter_mut().flat_map(|body| &mut body.joints);
        joints.filter_map(move |joint| {
            Some(DraftJoint {
                name: joint.name.strip_prefix(prefix)?,
                stiffness: &mut joint.stiffness,
                damping: &mut joint.damping,
            })
        })
    }

    /// Returns the position of a site in its body, m; `None` if there is no such site.
    pub fn site_pos(&mut self, name: &str) -> Option<&mut Vec3> {
        let mut sites = self.document.bodies.iter_mut().flat_map(|body| &mut body.sites);
        let prefix = &self.prefix;
        sites
            .find(|site| is_called(&site.name, prefix, name))
            .map(|site| &mut site.frame.pos)
    }

    /// Returns the position of a camera in its body, m; `None` if there is no such camera.
    pub fn camera_pos(&mut self, name: &str) -> Option<&mut Vec3> {
        self.camera(name).map(|camera| &mut camera.frame.pos)
    }

    /// Returns the vertical field of view of a camera, degrees, which replaces what its sensor gives; `None` if there is no such camera.
    pub fn camera_fovy(&mut self, name: &str) -> Option<&mut f64> {
        let camera = self.camera(name)?;
        camera.sensorsize = [0.0; 2];
        Some(&mut camera.fovy)
    }

    fn camera(&mut self, name: &str) -> Option<&mut Camera> {
        let mut cameras = self.document.bodies.iter_mut().flat_map(|body| &mut body.cameras);
        let prefix = &self.prefix;
        cameras.find(|camera| is_called(&camera.name, prefix, name))
    }

    /// Returns a geom by its body and its index among the geoms of that body; `None` if there is no such geom.
    pub fn geom(&mut self, body: &str, index: usize) -> Option<DraftGeom<'_>> {
        let geom = self.body(body)?.geoms.get_mut(index)?;
        Some(DraftGeom {
            kind: geom.kind,
            size: &mut geom.size,
            pos: &mut geom.frame.pos,
            mass: &mut geom.mass,
        })
    }

    /// Returns the actuators, by id.
    pub fn actuators(&mut self) -> impl Iterator<Item = DraftActuator<'_>> {
        let prefix = self.prefix.as_str();
        self.document.actuators.iter_mut().filter_map(move |actuator| {
            let joint = actuator
                .target
                .joint
                .as_ref()
                .or(actuator.target.jointinparent.as_ref());
            Some(DraftActuator {
                name: actuator.name.strip_prefix(prefix)?,
                joint: joint.map_or(Some(""), |joint| joint.strip_prefix(prefix))?,
                gear: &mut actuator.target.gear[0],
                forcerange: &mut actuator.forcerange,
                forcelimited: &mut actuator.forcelimited,
                servo: actuator.law.biastype == BiasType::Affine,
                gainprm: &mut actuator.law.gainprm,
                biasprm: &mut actuator.law.biasprm,
                user: &mut actuator.user,
            })
        })
    }

    /// Returns the name of a material's texture. The outer option is `None` if there is no such material, the inner one if it has no texture.
    pub fn material_texture(&mut self, name: &str) -> Option<&mut Option<String>> {
        let mut materials = self.document.materials.iter_mut();
        materials
            .find(|material| material.name == name)
            .map(|material| &mut material.texture)
    }

    /// Lists the names of the joints of a body and of all bodies below it.
    pub fn joints_below(&self, body: &str) -> Vec<String> {
        let bodies = &self.document.bodies;
        // a parent comes before its children
        let mut inside = Vec::with_capacity(bodies.len());
        for one in bodies {
            inside.push(is_called(&one.name, &self.prefix, body) || inside.get(one.parent).copied().unwrap_or(false));
        }
        let own = bodies.iter().zip(&inside).filter(|(_, inside)| **inside);
        own.flat_map(|(one, _)| &one.joints)
            .filter_map(|joint| joint.name.strip_prefix(&self.prefix))
            .map(str::to_string)
            .collect()
    }

    fn body(&mut self, name: &str) -> Option<&mut Body> {
        let prefix = &self.prefix;
        let mut bodies = self.document.bodies.iter_mut();
        bodies.find(|body| is_called(&body.name, prefix, name))
    }
}

/// Returns whether a full name consists of a prefix and a name.
fn is_called(whole: &str, prefix: &str, name: &str) -> bool {
    whole.strip_prefix(prefix) == Some(name)
}
