//! The data that a page needs only once: names, joints, actions, and the look of the scene.

use babybench::Env;
use babybench::mimo::joint_part;
use babybench::model::{JointType, Model};
use babybench::render::{Drawable, Element, LightSource, Mesh, MipChain, Scenery, Shape, TexturePixels};
use js_sys::{Float32Array, Uint16Array};
use wasm_bindgen::JsValue;

use crate::js::{id, list, numbers, object, optional};

/// Describes bodies, joints, geoms, cameras and actions.
pub fn model(env: &Env) -> JsValue {
    let m = env.model();
    let bodies = (0..m.nbody()).map(|b| {
        object([
            ("name", m.body_name[b].as_str().into()),
            ("parent", id(m.body_parentid[b])),
            ("mass", m.body_mass[b].into()),
            ("subtreemass", m.body_subtreemass[b].into()),
            ("invweight0", numbers(&m.body_invweight0[b])),
        ])
    });
    let geoms =
        (0..m.ngeom()).map(|g| object([("name", m.geom_name[g].as_str().into()), ("body", id(m.geom_bodyid[g]))]));
    let cameras = (0..m.ncam()).map(|c| {
        object([
            ("name", m.cam_name[c].as_str().into()),
            ("body", id(m.cam_bodyid[c])),
            ("fovy", m.cam_fovy[c].into()),
        ])
    });
    object([
        ("bodies", list(bodies)),
        ("joints", list((0..m.njnt()).map(|j| joint(m, j)))),
        ("geoms", list(geoms)),
        ("cameras", list(cameras)),
        ("actions", actions(env)),
        ("timestep", m.opt.timestep.into()),
        ("frame_skip", env.config().frame_skip.into()),
        ("nq", id(m.nq)),
        ("nv", id(m.nv)),
        ("nu", id(m.nu())),
    ])
}

fn joint(m: &Model, j: usize) -> JsValue {
    let kind = match m.jnt_type[j] {
        JointType::Free => "free",
        JointType::Ball => "ball",
        JointType::Slide => "slide",
        JointType::Hinge => "hinge",
    };
    let range = m.jnt_limited[j].then_some(m.jnt_range[j]);
    object([
        ("name", m.jnt_name[j].as_str().into()),
        ("body", id(m.jnt_bodyid[j])),
        ("type", kind.into()),
        ("qposadr", id(m.jnt_qposadr[j])),
        ("dofadr", id(m.jnt_dofadr[j])),
        ("range", optional(range, |r| numbers(&r))),
        ("part", part(m, j)),
    ])
}

/// Describes each number of an action; those of muscles come in two blocks of all actuators.
fn actions(env: &Env) -> JsValue {
    let (m, space) = (env.model(), env.action_space());
    let (names, driven) = (
        env.blueprint().actuation().action_names(m),
        env.blueprint().actuation().actuators(),
    );
    let entries = names.iter().enumerate().map(|(k, name)| {
        let actuator = driven[k % driven.len().max(1)];
        // MIMo's all act on joints
        let joint = m.actuator_joint(actuator).unwrap_or(0);
        object([
            ("name", name.as_str().into()),
            ("actuator", id(actuator)),
            ("joint", id(joint)),
            ("part", part(m, joint)),
            ("low", space.low()[k].into()),
            ("high", space.high()[k].into()),
        ])
    });
    list(entries)
}

fn part(m: &Model, joint: usize) -> JsValue {
    optional(joint_part(m, joint), |p| p.name().into())
}

/// Describes the drawables, in the order of the poses, and the light.
pub fn look(m: &Model, v: &Scenery) -> JsValue {
    object([
        ("drawables", list(v.drawables.iter().map(|d| drawable(m, v, d)))),
        ("textures", list(v.textures.iter().map(texture))),
        ("sky", optional(v.sky, id)),
        ("lights", list(v.lights.iter().map(light))),
        (
            "headlight",
            optional(v.headlight, |[ambient, diffuse, specular]| {
                object([
                    ("ambient", numbers(&ambient)),
                    ("diffuse", numbers(&diffuse)),
                    ("specular", numbers(&specular)),
                ])
            }),
        ),
        ("near", v.near.into()),
        ("far", v.far.into()),
    ])
}

fn drawable(m: &Model, v: &Scenery, d: &Drawable) -> JsValue {
    let (geom, body, name) = match d.element {
        Element::Geom(g) => (Some(g), m.geom_bodyid[g], &m.geom_name[g]),
        Element::Site(s) => (None, m.site_bodyid[s], &m.site_name[s]),
        Element::Tendon { tendon, .. } => (None, 0, &m.tendon_name[tendon]),
        Element::FlexEdge { flex, .. } | Element::Flex(flex) => (None, 0, &m.flexes[flex].name),
        Element::Skin(skin) => (None, 0, &m.skins[skin].name),
    };
    let shape = match d.shape {
        // which the page can stretch, unlike a capsule
        _ if matches!(d.element, Element::Tendon { .. }) => "cylinder",
        Shape::Plane => "plane",
        Shape::Sphere => "sphere",
        Shape::Capsule => "capsule",
        Shape::Cylinder => "cylinder",
        Shape::Box => "box",
        Shape::Mesh => "mesh",
    };
    let own = v.mesh_of(d).filter(|_| d.shape == Shape::Mesh);
    object([
        ("name", name.as_str().into()),
        ("geom", optional(geom, id)),
        ("body", id(body)),
        ("shape", shape.into()),
        ("mesh", optional(own, |own| mesh(d.mesh, own))),
        ("worn", matches!(d.element, Element::Flex(_) | Element::Skin(_)).into()),
        ("size", numbers(&d.size)),
        ("rgba", numbers(&d.rgba)),
        ("emission", d.emission.into()),
        ("specular", d.specular.into()),
        ("exponent", d.exponent.into()),
        ("texture", optional(d.texture, id)),
        ("texture_scale", numbers(&d.texture_scale)),
        ("texture_offset", d.texture_offset.into()),
    ])
}

/// Returns the triangles of a mesh, with a unique number.
fn mesh(number: usize, mesh: &Mesh) -> JsValue {
    let places: Vec<f32> = (0..mesh.x.len())
        .flat_map(|i| [mesh.x[i], mesh.y[i], mesh.z[i]])
        .collect();
    let texcoord = (!mesh.texcoord.is_empty()).then(|| mesh.texcoord.as_flattened());
    object([
        ("id", id(number)),
        ("position", Float32Array::from(&places[..]).into()),
        ("normal", Float32Array::from(mesh.normal.as_flattened()).into()),
        ("texcoord", optional(texcoord, |t| Float32Array::from(t).into())),
        ("index", Uint16Array::from(mesh.triangles.as_flattened()).into()),
    ])
}

/// Lists the images of a texture: one, or six sides of a cube.
fn texture(texture: &TexturePixels) -> JsValue {
    let faces = faces(texture).iter().filter_map(|face| face.first());
    list(faces.map(|level| object([("width", id(level.width)), ("height", id(level.height))])))
}

/// Returns the images of a texture.
pub fn faces(texture: &TexturePixels) -> &[MipChain] {
    match texture {
        TexturePixels::Flat(face) => std::slice::from_ref(face),
        TexturePixels::Cube(cube) => &cube.faces,
    }
}

fn light(light: &LightSource) -> JsValue {
    object([
        ("body", id(light.body)),
        ("pos", optional(light.pos, |p| numbers(&p))),
        ("dir", numbers(&light.dir)),
        ("ambient", numbers(&light.ambient)),
        ("diffuse", numbers(&light.diffuse)),
        ("specular", numbers(&light.specular)),
    ])
}
