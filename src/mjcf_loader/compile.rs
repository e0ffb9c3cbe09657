//! Typed document -> [`Model`]: names become ids, angles radians, shapes masses.

use std::collections::BTreeMap;

use crate::model::{self, EqualityKind, JointType, Model, SameFrame, TextureType};

use super::assets::{AssetSource, resolve};
use super::body::{self, weld_pose};
use super::document::{self, Document, Tri};
use super::error::{ErrorKind, LoadError};
use super::read::single;
use super::relation::{Equality, Held, Tendon};
use super::surface;
use super::xml::Tree;

/// Ids by name for one kind of element.
pub(super) struct Names {
    kind: &'static str,
    ids: BTreeMap<String, usize>,
}

impl Names {
    /// Unnamed elements are left out; a name used twice is an error at its second place.
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

    /// The id behind a reference.
    pub fn find(&self, tree: &Tree, at: usize, attribute: &'static str, name: &str) -> Result<usize, LoadError> {
        self.ids.get(name).copied().ok_or_else(|| {
            tree.error(
                at,
                ErrorKind::UnknownName {
                    attribute,
                    kind: self.kind,
                    name: name.to_owned(),
                },
            )
        })
    }
}

/// What the stages of compilation share.
pub(super) struct Context<'a> {
    pub tree: &'a Tree,
    pub compiler: &'a document::Compiler,
}

impl Context<'_> {
    pub fn error(&self, at: usize, kind: impl Into<ErrorKind>) -> LoadError {
        self.tree.error(at, kind)
    }

    pub fn invalid(&self, at: usize, message: &'static str) -> LoadError {
        self.tree.error(at, ErrorKind::Invalid(message))
    }

    /// Whether a range applies, and that it is one if so.
    pub fn limited(
        &self,
        at: usize,
        attribute: &'static str,
        limited: Tri,
        range: [f64; 2],
    ) -> Result<bool, LoadError> {
        let proper = range[0] < range[1];
        match limited {
            Tri::No => Ok(false),
            Tri::Yes if proper => Ok(true),
            Tri::Yes => {
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
            Tri::Auto if self.compiler.autolimits => Ok(proper),
            Tri::Auto if range == [0.0; 2] => Ok(false),
            Tri::Auto => Err(self.invalid(at, "a range is given but not whether it limits, and autolimits is off")),
        }
    }
}

/// Names that other elements refer to.
pub(super) struct Ids {
    pub body: Names,
    pub joint: Names,
    pub geom: Names,
    pub site: Names,
    pub texture: Names,
    pub material: Names,
}

/// Compiles the document. Images are looked up in `source`, relative to `dir`, and not decoded.
pub(super) fn compile(
    tree: &Tree,
    mut document: Document,
    source: &dyn AssetSource,
    dir: &str,
) -> Result<Model, LoadError> {
    let mut model = empty_model(&document);
    let textures = std::mem::take(&mut document.textures);
    let context = Context {
        tree,
        compiler: &document.compiler,
    };
    for texture in &textures {
        model.textures.push(compile_texture(&context, texture, source, dir)?);
    }
    let ids = ids(tree, &document, &textures, &model)?;
    for material in &document.materials {
        model.materials.push(compile_material(&context, material, &ids)?);
    }
    body::compile(&context, &document, &ids, &mut model)?;
    same_frames(&mut model);
    contact(&context, &document, &ids, &mut model)?;
    for equality in &document.equalities {
        compile_equality(&context, equality, &ids, &mut model)?;
    }
    for tendon in &document.tendons {
        compile_tendon(&context, tendon, &ids, &mut model)?;
    }
    actuators(&context, &document, &ids, &mut model)?;
    for (index, sensor) in document.sensors.iter().enumerate() {
        model.sensor_name.push(sensor.name.clone());
        model.sensor_type.push(sensor.kind);
        model
            .sensor_objid
            .push(ids.site.find(tree, sensor.at, "site", &sensor.site)?);
        model.sensor_adr.push(3 * index);
    }
    Ok(model)
}

/// Finds frames that are the same as a body's own or its inertial frame.
fn same_frames(model: &mut Model) {
    let none = ([f64::INFINITY; 3], [f64::INFINITY; 4]);
    let bodies = model.body_ipos.iter().zip(&model.body_iquat);
    model.body_sameframe = bodies.map(|(&p, &q)| SameFrame::of(p, q, none.0, none.1)).collect();
    let in_body = |b: &[usize], pos: &[[f64; 3]], quat: &[[f64; 4]]| -> Vec<SameFrame> {
        let frame = |i: usize| SameFrame::of(pos[i], quat[i], model.body_ipos[b[i]], model.body_iquat[b[i]]);
        (0..b.len()).map(frame).collect()
    };
    let geoms = in_body(&model.geom_bodyid, &model.geom_pos, &model.geom_quat);
    let sites = in_body(&model.site_bodyid, &model.site_pos, &model.site_quat);
    (model.geom_sameframe, model.site_sameframe) = (geoms, sites);
}

fn ids(tree: &Tree, document: &Document, textures: &[surface::Texture], model: &Model) -> Result<Ids, LoadError> {
    let bodies = &document.bodies;
    // These are referred to by nothing, but their names must be unique all the same.
    Names::new(
        tree,
        "camera",
        bodies.iter().flat_map(|b| &b.cameras).map(|c| (c.at, &c.name)),
    )?;
    Names::new(
        tree,
        "light",
        bodies.iter().flat_map(|b| &b.lights).map(|l| (l.at, &l.name)),
    )?;
    Names::new(tree, "equality", document.equalities.iter().map(|e| (e.at, &e.name)))?;
    Names::new(tree, "tendon", document.tendons.iter().map(|t| (t.at, &t.name)))?;
    Names::new(tree, "actuator", document.actuators.iter().map(|a| (a.at, &a.name)))?;
    Names::new(tree, "sensor", document.sensors.iter().map(|s| (s.at, &s.name)))?;
    Names::new(tree, "pair", document.pairs.iter().map(|p| (p.at, &p.name)))?;
    Names::new(tree, "exclude", document.excludes.iter().map(|e| (e.at, &e.name)))?;
    Ok(Ids {
        body: Names::new(tree, "body", bodies.iter().map(|b| (b.at, &b.name)))?,
        joint: Names::new(
            tree,
            "joint",
            bodies.iter().flat_map(|b| &b.joints).map(|j| (j.at, &j.name)),
        )?,
        geom: Names::new(
            tree,
            "geom",
            bodies.iter().flat_map(|b| &b.geoms).map(|g| (g.at, &g.name)),
        )?,
        site: Names::new(
            tree,
            "site",
            bodies.iter().flat_map(|b| &b.sites).map(|s| (s.at, &s.name)),
        )?,
        texture: Names::new(
            tree,
            "texture",
            textures.iter().zip(&model.textures).map(|(t, m)| (t.at, &m.name)),
        )?,
        material: Names::new(tree, "material", document.materials.iter().map(|m| (m.at, &m.name)))?,
    })
}

fn compile_texture(
    context: &Context,
    texture: &surface::Texture,
    source: &dyn AssetSource,
    dir: &str,
) -> Result<model::Texture, LoadError> {
    let path = |file: &String| {
        let file = match context.compiler.texturedir.trim_end_matches('/') {
            "" => file.clone(),
            texturedir => format!("{texturedir}/{file}"),
        };
        let path = resolve(dir, &file).map_err(|e| context.error(texture.at, e))?;
        if source.contains(&path) {
            Ok(path)
        } else {
            Err(context.error(texture.at, super::AssetError::NotFound(path)))
        }
    };
    let mut cube_files = [const { None }; 6];
    for (to, from) in cube_files.iter_mut().zip(&texture.cube_files) {
        *to = from.as_ref().map(path).transpose()?;
    }
    let file = texture.file.as_ref().map(path).transpose()?;
    // the faces of a builtin cube are as high as wide
    let flat = texture.kind == model::TextureType::Flat2d;
    let builtin = texture.builtin != model::Builtin::None;
    if !builtin {
        if file.is_none() && cube_files.iter().all(Option::is_none) {
            return Err(context.invalid(texture.at, "the texture has neither a builtin nor a file"));
        }
    } else if texture.width == 0 || flat && texture.height == 0 {
        return Err(context.invalid(
            texture.at,
            "a builtin texture needs a width, and if it is flat a height",
        ));
    }
    let mut name = texture.name.clone();
    if name.is_empty() {
        // An unnamed texture is called after its file, without directory and extension.
        let stem = texture
            .file
            .as_deref()
            .map(|file| file.rsplit('/').next().unwrap_or(file));
        name = stem
            .map(|stem| stem.rsplit_once('.').map_or(stem, |(name, _)| name))
            .unwrap_or_default()
            .to_owned();
        if name.is_empty() && texture.kind != TextureType::Skybox {
            return Err(context.error(texture.at, ErrorKind::MissingAttribute("name")));
        }
    }
    Ok(model::Texture {
        name,
        kind: texture.kind,
        builtin: texture.builtin,
        mark: texture.mark,
        rgb1: texture.rgb1,
        rgb2: texture.rgb2,
        markrgb: texture.markrgb,
        random: texture.random,
        width: texture.width,
        height: if builtin && !flat {
            6 * texture.width
        } else {
            texture.height
        },
        file,
        cube_files,
    })
}

fn compile_material(context: &Context, material: &surface::Material, ids: &Ids) -> Result<model::Material, LoadError> {
    let find = |name: &String| ids.texture.find(context.tree, material.at, "texture", name);
    Ok(model::Material {
        name: material.name.clone(),
        texture: material.texture.as_ref().map(find).transpose()?,
        rgba: material.rgba.map(single),
        specular: single(material.specular),
        shininess: single(material.shininess),
        reflectance: single(material.reflectance),
        emission: single(material.emission),
        texrepeat: material.texrepeat.map(single),
        texuniform: material.texuniform,
    })
}

/// Explicit pairs and excludes, both sorted by the pair of bodies.
fn contact(context: &Context, document: &Document, ids: &Ids, model: &mut Model) -> Result<(), LoadError> {
    let mut pairs = Vec::with_capacity(document.pairs.len());
    for pair in &document.pairs {
        if !matches!(pair.condim, 1 | 3 | 4 | 6) {
            return Err(context.invalid(pair.at, "condim must be 1, 3, 4 or 6"));
        }
        let mut geoms = [
            ids.geom.find(context.tree, pair.at, "geom1", &pair.geom1)?,
            ids.geom.find(context.tree, pair.at, "geom2", &pair.geom2)?,
        ];
        if geoms[0] == geoms[1] {
            return Err(context.invalid(pair.at, "a geom cannot pair with itself"));
        }
        let mut bodies = geoms.map(|geom| model.geom_bodyid[geom]);
        if bodies[0] > bodies[1] {
            geoms.swap(0, 1);
            bodies.swap(0, 1);
        }
        pairs.push((bodies, geoms, pair));
    }
    pairs.sort_by_key(|(bodies, ..)| *bodies);
    for (_, geoms, pair) in pairs {
        model.pair_geom.push(geoms);
        model.pair_dim.push(pair.condim);
        model.pair_solref.push(pair.solref);
        model.pair_solreffriction.push(pair.solreffriction);
        model.pair_solimp.push(pair.solimp);
        model.pair_friction.push(pair.friction);
        model.pair_margin.push(pair.margin);
        model.pair_gap.push(pair.gap);
    }
    for exclude in &document.excludes {
        let mut bodies = [
            ids.body.find(context.tree, exclude.at, "body1", &exclude.body1)?,
            ids.body.find(context.tree, exclude.at, "body2", &exclude.body2)?,
        ];
        bodies.sort_unstable();
        model.exclude.push(bodies);
    }
    model.exclude.sort_unstable();
    Ok(())
}

/// A joint with one coordinate, which tendons, equalities and actuators need.
fn scalar_joint(
    context: &Context,
    ids: &Ids,
    model: &Model,
    at: usize,
    attribute: &'static str,
    name: &str,
) -> Result<usize, LoadError> {
    let joint = ids.joint.find(context.tree, at, attribute, name)?;
    if model.jnt_type[joint] == JointType::Free {
        return Err(context.invalid(at, "a free joint cannot be used here, only hinge and slide"));
    }
    Ok(joint)
}

fn compile_equality(context: &Context, equality: &Equality, ids: &Ids, model: &mut Model) -> Result<(), LoadError> {
    let at = equality.at;
    let kind = match &equality.held {
        Held::Joint {
            joint1,
            joint2,
            polycoef,
        } => {
            let find = |attribute, name: &String| {
                scalar_joint(context, ids, model, at, attribute, name).map(crate::model::JointId)
            };
            EqualityKind::Joint {
                joint1: find("joint1", joint1)?,
                joint2: joint2.as_ref().map(|name| find("joint2", name)).transpose()?,
                polycoef: *polycoef,
            }
        }
        Held::Weld {
            body1,
            body2,
            relpose,
            anchor,
            torquescale,
        } => {
            let body1 = ids.body.find(context.tree, at, "body1", body1)?;
            let body2 = match body2 {
                Some(name) => ids.body.find(context.tree, at, "body2", name)?,
                None => 0,
            };
            if body1 == body2 {
                return Err(context.invalid(at, "a body cannot be welded to itself"));
            }
            let (relpos, relquat) = weld_pose(model, body1, body2, *anchor, relpose);
            EqualityKind::Weld {
                body1: model::BodyId(body1),
                body2: model::BodyId(body2),
                anchor: *anchor,
                relpos,
                relquat,
                torquescale: *torquescale,
            }
        }
    };
    model.eq_name.push(equality.name.clone());
    model.eq_kind.push(kind);
    model.eq_active0.push(equality.active);
    model.eq_solref.push(equality.solref);
    model.eq_solimp.push(equality.solimp);
    Ok(())
}

/// MuJoCo takes such a tendon, but lets its length depend on both coefficients and its force on the last alone.
const JOINT_TWICE: &str = "the tendon names this joint twice";

fn compile_tendon(context: &Context, tendon: &Tendon, ids: &Ids, model: &mut Model) -> Result<(), LoadError> {
    if tendon.wrap.is_empty() {
        return Err(context.invalid(tendon.at, "the tendon has no joints"));
    }
    let mut wrap = Vec::with_capacity(tendon.wrap.len());
    for (at, joint, coef) in &tendon.wrap {
        let joint = scalar_joint(context, ids, model, *at, "joint", joint)?;
        if wrap.iter().any(|&(other, _)| other == joint) {
            return Err(context.error(*at, ErrorKind::Invalid(JOINT_TWICE)));
        }
        wrap.push((joint, *coef));
    }
    model.tendon_name.push(tendon.name.clone());
    model.tendon_wrap.push(wrap);
    model
        .tendon_limited
        .push(context.limited(tendon.at, "range", tendon.limited, tendon.range)?);
    model.tendon_range.push(tendon.range);
    model.tendon_margin.push(tendon.margin);
    model.tendon_solref_lim.push(tendon.solref_limit);
    model.tendon_solimp_lim.push(tendon.solimp_limit);
    model.tendon_invweight0.push(0.0);
    Ok(())
}

fn actuators(context: &Context, document: &Document, ids: &Ids, model: &mut Model) -> Result<(), LoadError> {
    let most = document
        .actuators
        .iter()
        .map(|actuator| actuator.user.len())
        .max()
        .unwrap_or(0);
    let nuser = document.nuser_actuator.unwrap_or(most);
    for actuator in &document.actuators {
        if actuator.user.len() > nuser {
            return Err(context.invalid(actuator.at, "user has more values than nuser_actuator"));
        }
        let limited = |attribute, limited, range| context.limited(actuator.at, attribute, limited, range);
        model.actuator_name.push(actuator.name.clone());
        model.actuator_trnid.push(scalar_joint(
            context,
            ids,
            model,
            actuator.at,
            "joint",
            &actuator.joint,
        )?);
        model.actuator_gear.push(actuator.gear);
        model
            .actuator_ctrllimited
            .push(limited("ctrlrange", actuator.ctrllimited, actuator.ctrlrange)?);
        model.actuator_ctrlrange.push(actuator.ctrlrange);
        model
            .actuator_forcelimited
            .push(limited("forcerange", actuator.forcelimited, actuator.forcerange)?);
        model.actuator_forcerange.push(actuator.forcerange);
        model.actuator_gainprm.push([actuator.gain, 0.0, 0.0]);
        model.actuator_biastype.push(actuator.biastype);
        model.actuator_biasprm.push(actuator.biasprm);
        let mut user = actuator.user.clone();
        user.resize(nuser, 0.0);
        model.actuator_user.push(user);
    }
    Ok(())
}

/// A model with the settings and no elements.
fn empty_model(document: &Document) -> Model {
    macro_rules! empty {
        ($($set:ident : $value:expr),* ; $($field:ident)*) => {
            Model { $($set: $value,)* $($field: Vec::new(),)* }
        };
    }
    empty! {
        name: document.model.clone(),
        opt: document.option.clone(),
        vis: document.visual.clone(),
        stat: document.statistic.clone(),
        nq: 0,
        nv: 0;
        body_name body_parentid body_rootid body_weldid body_jntadr body_jntnum body_dofadr body_dofnum body_geomadr
        body_geomnum body_pos body_quat body_ipos body_iquat body_sameframe body_mass body_subtreemass body_inertia body_invweight0
        jnt_name jnt_type jnt_bodyid jnt_qposadr jnt_dofadr jnt_pos jnt_axis jnt_limited jnt_range jnt_margin
        jnt_stiffness jnt_solref jnt_solimp jnt_group
        dof_bodyid dof_jntid dof_parentid dof_armature dof_damping dof_frictionloss dof_invweight0 dof_solref dof_solimp
        qpos0 qpos_spring
        geom_name geom_type geom_size geom_bodyid geom_pos geom_quat geom_sameframe geom_contype geom_conaffinity geom_condim
        geom_priority geom_friction geom_solmix geom_solref geom_solimp geom_margin geom_gap geom_rbound geom_group
        geom_rgba geom_matid
        site_name site_type site_bodyid site_size site_pos site_quat site_sameframe site_group site_rgba site_matid
        cam_name cam_mode cam_bodyid cam_pos cam_quat cam_fovy
        lights textures materials
        pair_geom pair_dim pair_solref pair_solreffriction pair_solimp pair_friction pair_margin pair_gap exclude
        eq_name eq_kind eq_active0 eq_solref eq_solimp
        tendon_name tendon_wrap tendon_limited tendon_range tendon_margin tendon_solref_lim tendon_solimp_lim
        tendon_invweight0
        actuator_name actuator_trnid actuator_gear actuator_ctrllimited actuator_ctrlrange actuator_forcelimited
        actuator_forcerange actuator_gainprm actuator_biastype actuator_biasprm actuator_user
        sensor_name sensor_type sensor_objid sensor_adr
    }
}
