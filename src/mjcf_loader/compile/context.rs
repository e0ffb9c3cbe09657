//! Context shared by the stages of compilation: names, their ids, errors with locations.

use std::collections::BTreeMap;

use super::asset_name::asset_name;
use super::geometry::orientation;
use crate::assets::{AssetError, AssetSource};
use crate::document::{AutoBool, Compiler, Frame, TypedDocument};
use crate::error::{ErrorKind, LoadError};
use crate::math::{Quat, Vec3, add, mat_vec, quat_mul, quat_rotate, quat_to_mat};
use crate::model::{Arrays, JointType};
use crate::surface::Texture;
use crate::text::nearest;
use crate::xml::Tree;

/// Ids by name for one kind of element.
pub(super) struct Names {
    kind: &'static str,
    ids: BTreeMap<String, usize>,
}

impl Names {
    /// Collects the ids of named elements, leaving out the unnamed; a name used twice is an error at its second place.
    pub fn new<'a>(
        tree: &Tree,
        kind: &'static str,
        named: impl Iterator<Item = (usize, &'a String)>,
    ) -> Result<Names, LoadError> {
        let mut ids = BTreeMap::new();
        for (id, (at, name)) in named.enumerate() {
            if !name.is_empty() && ids.insert(name.clone(), id).is_some() {
                return Err(tree.error(
                    at,
                    ErrorKind::DuplicateName {
                        kind,
                        name: name.clone(),
                    },
                ));
            }
        }
        Ok(Names { kind, ids })
    }

    /// Returns the id of the element that a reference names.
    pub fn find(&self, tree: &Tree, at: usize, attribute: &'static str, name: &str) -> Result<usize, LoadError> {
        self.ids.get(name).copied().ok_or_else(|| {
            let nearest = nearest(name, self.ids.keys().map(String::as_str)).map(str::to_owned);
            let (kind, name) = (self.kind, name.to_owned());
            let kind = ErrorKind::UnknownName {
                attribute,
                kind,
                name,
                nearest,
            };
            tree.error(at, kind)
        })
    }
}

/// The names and ids that the stages of compilation share.
pub(super) struct Context<'a> {
    pub tree: &'a Tree,
    /// Settings of the document, and of the models that it names.
    pub compilers: &'a [Compiler],
    /// The poses of the frames of the document in their bodies.
    pub frames: Vec<(Vec3, Quat)>,
}

/// The length of the user data of all elements of a kind.
pub(super) struct UserDataSize {
    /// The attribute of `<size>` that sets it.
    attribute: &'static str,
    length: usize,
}

impl UserDataSize {
    /// Uses the given length, or that of the longest of `users`.
    pub fn new<'a>(attribute: &'static str, given: Option<usize>, users: impl Iterator<Item = &'a Vec<f64>>) -> Self {
        let length = given.unwrap_or_else(|| users.map(Vec::len).max().unwrap_or(0));
        Self { attribute, length }
    }

    /// Returns user data padded with zeros to that length; longer data are an error.
    pub fn of(&self, context: &Context, at: usize, user: &[f64]) -> Result<Vec<f64>, LoadError> {
        if user.len() > self.length {
            let (attribute, count) = (self.attribute, user.len());
            return Err(context.error(at, ErrorKind::UserExcess { attribute, count }));
        }
        let mut user = user.to_vec();
        user.resize(self.length, 0.0);
        Ok(user)
    }
}

impl Context<'_> {
    /// Transforms a pose from the frame that an element is `within` to its body.
    pub fn placed(&self, within: Option<usize>, pos: Vec3, quat: Quat) -> (Vec3, Quat) {
        match within {
            None => (pos, quat),
            Some(frame) => (self.point(within, pos), quat_mul(self.frames[frame].1, quat)),
        }
    }

    /// Transforms a point from the frame that an element is `within` to its body.
    pub fn point(&self, within: Option<usize>, point: Vec3) -> Vec3 {
        match within {
            None => point,
            // by the matrix, not the quaternion, as in MuJoCo: the last bits decide whether a box touches the floor that it stands on
            Some(frame) => {
                let (pos, quat) = self.frames[frame];
                add(pos, mat_vec(&quat_to_mat(quat), point))
            }
        }
    }

    /// Transforms a direction from the frame that an element is `within` to its body.
    pub fn direction(&self, within: Option<usize>, direction: Vec3) -> Vec3 {
        match within {
            None => direction,
            Some(frame) => quat_rotate(self.frames[frame].1, direction),
        }
    }

    /// Returns the path in the source of a file in a folder that the document names. If it is not in the folder `probed`, it may be next
    /// to the included file that names it. The source must have it.
    pub fn asset_path(
        &self,
        at: usize,
        file: &str,
        [folder, probed]: [&str; 2],
        source: &dyn AssetSource,
    ) -> Result<String, LoadError> {
        let path = if self.settings().strippath {
            // documents written on Windows have backslashes
            let own = file.rsplit(['/', '\\']).next().unwrap_or(file);
            self.tree.named_file(at, own, folder, None, source)
        } else {
            self.tree.named_file(at, file, folder, Some(probed), source)
        };
        let path = path.map_err(|e| self.error(at, e))?;
        // checked before it is read, so that the error names the element
        if source.contains(&path) {
            Ok(path)
        } else {
            Err(self.error(at, AssetError::NotFound(path)))
        }
    }

    /// Returns the orientation of an element's frame.
    pub fn quat_of(&self, at: usize, frame: &Frame) -> Result<Quat, LoadError> {
        orientation(&frame.orientation, self.compiler(at)).map_err(|message| self.invalid(at, message))
    }

    /// Returns the settings of the document itself.
    pub fn settings(&self) -> &Compiler {
        &self.compilers[0]
    }

    /// Returns the compiler settings of an element: those of the model that it was read from.
    pub fn compiler(&self, at: usize) -> &Compiler {
        &self.compilers[self.tree.model_of(at)]
    }

    /// Returns the folder of meshes for an element.
    pub fn meshdir(&self, at: usize) -> &str {
        self.folder(at, |compiler| &compiler.meshdir)
    }

    /// Returns the folder of height fields and skins for an element, and where MuJoCo 3.3.0 looks whether an included file has its own.
    pub fn mesh_dirs(&self, at: usize) -> [&str; 2] {
        [self.meshdir(at), self.folder(at, |compiler| &compiler.assetdir)]
    }

    /// Returns the folder of textures for an element.
    pub fn texturedir(&self, at: usize) -> &str {
        self.folder(at, |compiler| &compiler.texturedir)
    }

    /// Returns a folder that the model of an element sets, or, as in MuJoCo, the next model around it that sets one.
    fn folder(&self, at: usize, folder: fn(&Compiler) -> &String) -> &str {
        let mut model = Some(self.tree.model_of(at));
        while let Some(one) = model {
            let folder = folder(&self.compilers[one]);
            if !folder.is_empty() {
                return folder;
            }
            model = self.tree.models()[one].within;
        }
        ""
    }

    pub fn error(&self, at: usize, kind: impl Into<ErrorKind>) -> LoadError {
        self.tree.error(at, kind)
    }

    /// Checks the number of elements of a kind so far. The last one is at `at`.
    pub fn within(&self, at: usize, what: &'static str, limit: usize, found: usize) -> Result<(), LoadError> {
        if found > limit {
            Err(self.error(at, ErrorKind::TooMuch { what, limit }))
        } else {
            Ok(())
        }
    }

    pub fn invalid(&self, at: usize, message: &'static str) -> LoadError {
        self.tree.error(at, ErrorKind::Invalid(message))
    }

    /// Returns whether a range applies; if so, checks that it is one.
    pub fn limited(
        &self,
        at: usize,
        attribute: &'static str,
        limited: AutoBool,
        range: [f64; 2],
    ) -> Result<bool, LoadError> {
        let proper = range[0] < range[1];
        match limited {
            AutoBool::No => Ok(false),
            AutoBool::Yes if proper => Ok(true),
            AutoBool::Yes => {
                let want = "greater than the lower end of the range";
                Err(self.error(
                    at,
                    ErrorKind::OutOfRange {
                        attribute,
                        value: range[1],
                        want,
                    },
                ))
            }
            // MuJoCo takes a range that is the wrong way round for none
            AutoBool::Auto if self.compiler(at).autolimits => Ok(proper),
            // zeros are the default, so no range was given
            AutoBool::Auto if range == [0.0; 2] => Ok(false),
            AutoBool::Auto => Err(self.invalid(
                at,
                match attribute {
                    "ctrlrange" => "a ctrlrange is given, but autolimits is off: set ctrllimited to true or false",
                    "forcerange" => "a forcerange is given, but autolimits is off: set forcelimited to true or false",
                    "actuatorfrcrange" => {
                        "an actuatorfrcrange is given, but autolimits is off: set actuatorfrclimited to true or false"
                    }
                    "actrange" => "an actrange is given, but autolimits is off: set actlimited to true or false",
                    _ => "a range is given, but autolimits is off: set limited to true or false",
                },
            )),
        }
    }
}

/// Returns a reference, or `None` if it is empty.
pub(super) fn named(reference: &Option<String>) -> Option<&String> {
    reference.as_ref().filter(|name| !name.is_empty())
}

/// The names, by kind, that other elements refer to.
pub(super) struct Ids {
    pub body: Names,
    pub joint: Names,
    pub geom: Names,
    pub site: Names,
    pub texture: Names,
    pub material: Names,
    pub mesh: Names,
    pub hfield: Names,
    pub camera: Names,
    pub tendon: Names,
    pub actuator: Names,
    pub flex: Names,
}

impl Ids {
    /// Collects the names of all elements. `arrays` already holds the textures, because some are named after their files.
    pub fn new(tree: &Tree, document: &TypedDocument, textures: &[Texture], arrays: &Arrays) -> Result<Ids, LoadError> {
        check_unreferenced(tree, document)?;
        let bodies = &document.bodies;
        let joints = bodies.iter().flat_map(|b| &b.joints).map(|j| (j.at, &j.name));
        // geoms that `discardvisual` leaves out have no id
        let geoms = bodies.iter().flat_map(|b| &b.geoms).filter(|g| !g.left_out);
        let geoms = geoms.map(|g| (g.at, &g.name));
        let sites = bodies.iter().flat_map(|b| &b.sites).map(|s| (s.at, &s.name));
        let cameras = bodies.iter().flat_map(|b| &b.cameras).map(|c| (c.at, &c.name));
        let hfield_names = document
            .hfields
            .iter()
            .map(|hfield| asset_name(tree, hfield.at, &hfield.name, hfield.file.as_deref()))
            .collect::<Result<Vec<_>, _>>()?;
        let hfields = document.hfields.iter().zip(&hfield_names).map(|(h, name)| (h.at, name));
        let mesh_names = document
            .meshes
            .iter()
            .map(|mesh| asset_name(tree, mesh.at, &mesh.name, mesh.file.as_deref()))
            .collect::<Result<Vec<_>, _>>()?;
        let meshes = document.meshes.iter().zip(&mesh_names).map(|(m, name)| (m.at, name));
        let textures = textures.iter().zip(&arrays.textures).map(|(t, m)| (t.at, &m.name));
        Ok(Ids {
            body: Names::new(tree, "body", bodies.iter().map(|b| (b.at, &b.name)))?,
            joint: Names::new(tree, "joint", joints)?,
            geom: Names::new(tree, "geom", geoms)?,
            site: Names::new(tree, "site", sites)?,
            texture: Names::new(tree, "texture", textures)?,
            camera: Names::new(tree, "camera", cameras)?,
            tendon: Names::new(tree, "tendon", document.tendons.iter().map(|t| (t.at, &t.name)))?,
            flex: Names::new(tree, "flex", document.flexes.iter().map(|f| (f.at, &f.name)))?,
            actuator: Names::new(tree, "actuator", document.actuators.iter().map(|a| (a.at, &a.name)))?,
            hfield: Names::new(tree, "hfield", hfields)?,
            mesh: Names::new(tree, "mesh", meshes)?,
            material: Names::new(tree, "material", document.materials.iter().map(|m| (m.at, &m.name)))?,
        })
    }

    /// Finds a joint with one coordinate, which tendons, equalities and actuators need.
    pub fn scalar_joint(
        &self,
        context: &Context,
        arrays: &Arrays,
        at: usize,
        attribute: &'static str,
        name: &str,
    ) -> Result<usize, LoadError> {
        let joint = self.joint.find(context.tree, at, attribute, name)?;
        if !matches!(arrays.jnt_type[joint], JointType::Slide | JointType::Hinge) {
            return Err(context.invalid(
                at,
                "only hinge and slide joints can be used here, not ball and free joints",
            ));
        }
        Ok(joint)
    }
}

/// Refuses a name that is used twice by elements to which nothing refers.
fn check_unreferenced(tree: &Tree, document: &TypedDocument) -> Result<(), LoadError> {
    let lights = document.bodies.iter().flat_map(|b| &b.lights).map(|l| (l.at, &l.name));
    Names::new(tree, "light", lights)?;
    Names::new(tree, "equality", document.equalities.iter().map(|e| (e.at, &e.name)))?;
    Names::new(tree, "sensor", document.sensors.iter().map(|s| (s.at, &s.name)))?;
    Names::new(tree, "pair", document.pairs.iter().map(|p| (p.at, &p.name)))?;
    Names::new(tree, "exclude", document.excludes.iter().map(|e| (e.at, &e.name)))?;
    Names::new(tree, "skin", document.skins.iter().map(|s| (s.at, &s.name)))?;
    Names::new(tree, "numeric", document.numerics.iter().map(|n| (n.at, &n.name)))?;
    Names::new(tree, "text", document.texts.iter().map(|t| (t.at, &t.name)))?;
    Names::new(tree, "frame", document.frames.iter().map(|f| (f.at, &f.name)))?;
    let moved = document.moved_keys.iter().map(|k| (k.at, &k.name));
    Names::new(tree, "key", document.keys.iter().map(|k| (k.at, &k.name)).chain(moved))?;
    Ok(())
}
