//! Turns the typed document into [`Arrays`]: names become ids, angles become radians, shapes become masses.

mod actuator;
mod align;
mod asset_name;
mod body;
mod camera;
mod constraint;
mod context;
mod custom;
mod discard;
mod equality;
mod flex;
mod fluid;
mod fuse;
mod geom;
mod geometry;
mod hfield;
mod joint;
mod mesh;
mod sensor;
mod shell;
mod skin;
mod surface;
mod tendon;

pub(super) use asset_name::stem;
use context::{Context, Ids, UserDataSize};
pub(super) use discard::leave_out;
pub(super) use flex::expand_flexes;
pub use geometry::bounding_radius;
pub(super) use geometry::{frame_to_quat, normalize, volume};

use super::document::TypedDocument;
use super::error::LoadError;
use super::xml::Tree;
use crate::assets::AssetSource;
use crate::math::Vec3;
use crate::model::{Arrays, SameFrame};

/// Compiles the document, except for the quantities that need dynamics. Images, meshes and heights are looked up in `source`, relative to the
/// folders of the models that name them; images are not decoded. Also returns the elements of the bodies.
pub(super) fn compile(
    tree: &Tree,
    document: &TypedDocument,
    source: &dyn AssetSource,
) -> Result<(Arrays, Vec<usize>), LoadError> {
    let (name, opt) = (document.model.clone(), document.option.clone());
    let (vis, stat) = (document.visual.clone(), document.statistic.clone());
    let mut arrays = Arrays::without_elements(name, opt, vis, stat);
    arrays.nuserdata = document.size.nuserdata;
    // MuJoCo looks for no contacts where there is no room for one
    arrays.opt.flags.contact &= document.size.nconmax != Some(0);
    let mut context = Context {
        tree,
        compilers: &document.compilers,
        frames: Vec::with_capacity(document.frames.len()),
    };
    // poses in the frames around them
    let mut own: Vec<Vec3> = Vec::with_capacity(document.frames.len());
    for frame in &document.frames {
        let (pos, quat) = match frame.copy {
            Some(copy) => body::copied(&context, frame, copy, &own)?,
            None => (frame.frame.pos, context.quat_of(frame.at, &frame.frame)?),
        };
        own.push(pos);
        let pose = context.placed(frame.within, pos, quat);
        context.frames.push(pose);
    }
    for texture in &document.textures {
        let texture = surface::compile_texture(&context, texture, source)?;
        arrays.textures.push(texture);
    }
    let ids = Ids::new(tree, document, &document.textures, &arrays)?;
    for material in &document.materials {
        let material = surface::compile_material(&context, material, &ids)?;
        arrays.materials.push(material);
    }
    mesh::compile_meshes(&context, document, &ids, source, &mut arrays)?;
    arrays.hfields = hfield::compile_hfields(&context, document, source)?;
    let bodies = body::compile(&context, document, &ids, &mut arrays)?;
    // after the bodies, because aligning a free body moves its frames
    same_frames(&mut arrays);
    // after the bodies, because geoms that are left out still weigh by their meshes
    if context.settings().discardvisual {
        discard::drop_meshes(&mut arrays);
    }
    flex::compile_flexes(&context, document, &ids, &mut arrays)?;
    constraint::compile_contacts(&context, document, &ids, &mut arrays)?;
    for equality in &document.equalities {
        equality::compile_equality(&context, equality, &ids, &mut arrays)?;
    }
    let users = document.tendons.iter().map(|tendon| &tendon.user);
    let user = UserDataSize::new("nuser_tendon", document.size.nuser_tendon, users);
    for tendon in &document.tendons {
        tendon::compile_tendon(&context, tendon, &user, &ids, &mut arrays)?;
    }
    actuator::compile_actuators(&context, document, &ids, &mut arrays)?;
    // after joints and tendons: a sensor of a limit is an error if they have none
    sensor::compile_sensors(&context, document, &ids, &mut arrays)?;
    arrays.skins = skin::compile_skins(&context, document, &ids, source)?;
    custom::compile_custom(&context, document, &ids, &mut arrays)?;
    custom::compile_keys(&context, document, &mut arrays)?;
    Ok((arrays, bodies))
}

/// Finds frames that are the same as a body's own or its inertial frame.
fn same_frames(arrays: &mut Arrays) {
    // equals no pose, so inertial frames are compared with the frame of the body alone
    let none = ([f64::INFINITY; 3], [f64::INFINITY; 4]);
    let bodies = arrays.body_ipos.iter().zip(&arrays.body_iquat);
    arrays.body_sameframe = bodies.map(|(&p, &q)| SameFrame::of(p, q, none.0, none.1)).collect();
    let in_body = |b: &[usize], pos: &[[f64; 3]], quat: &[[f64; 4]]| -> Vec<SameFrame> {
        let frame = |i: usize| SameFrame::of(pos[i], quat[i], arrays.body_ipos[b[i]], arrays.body_iquat[b[i]]);
        (0..b.len()).map(frame).collect()
    };
    let geoms = in_body(&arrays.geom_bodyid, &arrays.geom_pos, &arrays.geom_quat);
    let sites = in_body(&arrays.site_bodyid, &arrays.site_pos, &arrays.site_quat);
    (arrays.geom_sameframe, arrays.site_sameframe) = (geoms, sites);
}
