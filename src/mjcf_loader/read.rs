//! Checked elements -> typed document: sections in MuJoCo's order, default classes applied.

use std::collections::BTreeMap;

use crate::model::{JointType, Options, SensorType, Statistic, Visual};

use super::MAX_CLASSES;
use super::document::{Body, Camera, Compiler, Document, Frame, Geom, Inertial, Joint, Light, Site, TRIS, Tri};
use super::error::{ErrorKind, LoadError};
use super::relation::{Actuator, Equality, Exclude, Pair, Sensor, Tendon};
use super::schema::Element;
use super::surface::{Material, Texture};
use super::xml::Tree;

/// Rounds as the reference does where it stores single precision.
pub(super) fn single(value: f64) -> f64 {
    f64::from(value as f32)
}

/// The defaults of a class: one prototype per kind of element.
#[derive(Clone, Default)]
struct Class {
    joint: Joint,
    geom: Geom,
    site: Site,
    camera: Camera,
    light: Light,
    pair: Pair,
    equality: Equality,
    tendon: Tendon,
    actuator: Actuator,
    material: Material,
}

impl Class {
    fn apply(&mut self, e: &Element) {
        match e.name {
            "joint" => self.joint.apply(e),
            "geom" => self.geom.apply(e),
            "site" => self.site.apply(e),
            "camera" => self.camera.apply(e),
            "light" => self.light.apply(e),
            "pair" => self.pair.apply(e),
            "equality" => self.equality.apply(e),
            "tendon" => self.tendon.apply(e),
            "motor" | "position" => self.actuator.apply(e),
            "material" => self.material.apply(e),
            _ => {}
        }
    }
}

const MAIN: &str = "main";

struct Classes<'t> {
    tree: &'t Tree,
    by_name: BTreeMap<String, Class>,
}

impl<'t> Classes<'t> {
    /// Reads a `default` section and those nested in it. A class starts as a copy of its parent, so the elements of a
    /// section come before the sections nested in it, whatever their order in the text.
    fn read(&mut self, section: &Element, parent: Option<&str>) -> Result<(), LoadError> {
        let name = self.declare(section, parent)?;
        section
            .children
            .iter()
            .filter(|e| e.name == "default")
            .try_for_each(|nested| self.read(nested, Some(&name)))
    }

    /// Adds the class of one section. Apart from `read`, whose frames pile up: a class is large.
    #[inline(never)]
    fn declare(&mut self, section: &Element, parent: Option<&str>) -> Result<String, LoadError> {
        let given = section.text("class").unwrap_or_default();
        let name = match parent {
            None if given.is_empty() || given == MAIN => MAIN,
            None => return Err(self.error(section, ErrorKind::Invalid("the top default class is \"main\""))),
            Some(_) if given.is_empty() => return Err(self.error(section, ErrorKind::MissingAttribute("class"))),
            Some(_) if self.by_name.contains_key(given) => {
                return Err(self.error(section, ErrorKind::DuplicateClass(given.to_owned())));
            }
            Some(_) => given,
        };
        if self.by_name.len() > MAX_CLASSES {
            return Err(self.error(
                section,
                ErrorKind::TooMuch {
                    what: "default classes",
                    limit: MAX_CLASSES,
                },
            ));
        }
        let mut class = self.by_name.get(parent.unwrap_or(MAIN)).cloned().unwrap_or_default();
        for element in &section.children {
            class.apply(element);
        }
        self.by_name.insert(name.to_owned(), class);
        Ok(name.to_owned())
    }

    /// The class of an element: its own, else that of the bodies around it.
    fn of(&self, element: &Element, around: &str) -> Result<&Class, LoadError> {
        let name = element.text("class").unwrap_or(around);
        self.by_name
            .get(name)
            .ok_or_else(|| self.error(element, ErrorKind::UnknownClass(name.to_owned())))
    }

    fn error(&self, element: &Element, kind: ErrorKind) -> LoadError {
        self.tree.error(element.at, kind)
    }
}

/// Reads the whole document.
pub(super) fn read(tree: &Tree, root: &Element) -> Result<Document, LoadError> {
    let mut document = Document {
        model: root.text("model").unwrap_or("MuJoCo Model").to_owned(),
        compiler: Compiler {
            degree: true,
            eulerseq: *b"xyz",
            inertiafromgeom: Tri::Auto,
            autolimits: true,
            texturedir: String::new(),
        },
        option: default_options(),
        visual: default_visual(),
        statistic: Statistic::default(),
        nuser_actuator: None,
        textures: Vec::new(),
        materials: Vec::new(),
        bodies: vec![Body::new(root.at, "world".to_owned(), 0)],
        pairs: Vec::new(),
        excludes: Vec::new(),
        equalities: Vec::new(),
        tendons: Vec::new(),
        actuators: Vec::new(),
        sensors: Vec::new(),
    };
    let mut classes = Classes {
        tree,
        by_name: BTreeMap::from([(MAIN.to_owned(), Class::default())]),
    };
    let sections = |name: &'static str| root.children.iter().filter(move |e| e.name == name);
    for section in sections("compiler") {
        compiler(tree, section, &mut document.compiler)?;
    }
    for section in sections("default") {
        classes.read(section, None)?;
    }
    for section in &root.children {
        match section.name {
            "option" => option(section, &mut document.option),
            "size" => {
                let mut count = -1i64;
                section.set_int("nuser_actuator", &mut count);
                document.nuser_actuator = usize::try_from(count).ok().or(document.nuser_actuator);
            }
            "visual" => section.children.iter().for_each(|e| visual(e, &mut document.visual)),
            "statistic" => statistic(section, &mut document.statistic),
            "asset" => asset(section, &classes, &mut document)?,
            "worldbody" => content(section, 0, MAIN, &classes, &mut document.bodies)?,
            "contact" => contact(section, &classes, &mut document)?,
            "equality" => {
                for e in &section.children {
                    let mut equality = classes.of(e, MAIN)?.equality.clone();
                    equality.apply(e);
                    document.equalities.push(equality);
                }
            }
            "tendon" => {
                for e in &section.children {
                    let mut tendon = classes.of(e, MAIN)?.tendon.clone();
                    tendon.apply(e);
                    document.tendons.push(tendon);
                }
            }
            "actuator" => {
                for e in &section.children {
                    let mut actuator = classes.of(e, MAIN)?.actuator.clone();
                    actuator.apply(e);
                    document.actuators.push(actuator);
                }
            }
            "sensor" => document.sensors.extend(section.children.iter().filter_map(sensor)),
            _ => {}
        }
    }
    Ok(document)
}

fn default_options() -> Options {
    Options {
        timestep: 0.002,
        gravity: [0.0, 0.0, -9.81],
        iterations: 100,
        tolerance: 1e-8,
        ls_iterations: 50,
        ls_tolerance: 0.01,
        impratio: 1.0,
        ccd_iterations: 50,
        ccd_tolerance: 1e-6,
    }
}

fn default_visual() -> Visual {
    Visual {
        fovy: 45.0,
        znear: single(0.01),
        zfar: 50.0,
        fogstart: 3.0,
        fogend: 10.0,
        haze: single(0.3),
        shadowclip: 1.0,
        force: single(0.005),
        shadowsize: 4096,
        offsamples: 4,
        offwidth: 640,
        offheight: 480,
        headlight_active: true,
        headlight_ambient: [single(0.1); 3],
        headlight_diffuse: [single(0.4); 3],
        headlight_specular: [0.5; 3],
    }
}

fn compiler(tree: &Tree, e: &Element, compiler: &mut Compiler) -> Result<(), LoadError> {
    e.set_word("angle", &[false, true], &mut compiler.degree);
    e.set_word("inertiafromgeom", TRIS, &mut compiler.inertiafromgeom);
    e.set_flag("autolimits", &mut compiler.autolimits);
    e.set_text("texturedir", &mut compiler.texturedir);
    if let Some(text) = e.text("eulerseq") {
        let letters: Option<[u8; 3]> = text.as_bytes().try_into().ok();
        match letters.filter(|letters| letters.iter().all(|letter| b"xyzXYZ".contains(letter))) {
            Some(letters) => compiler.eulerseq = letters,
            None => return Err(tree.error(e.at, ErrorKind::Invalid("eulerseq must be three letters of xyzXYZ"))),
        }
    }
    Ok(())
}

fn option(e: &Element, option: &mut Options) {
    e.set_real("timestep", &mut option.timestep);
    e.fill("gravity", &mut option.gravity);
    e.set_int("iterations", &mut option.iterations);
    e.set_real("tolerance", &mut option.tolerance);
    e.set_int("ls_iterations", &mut option.ls_iterations);
    e.set_real("ls_tolerance", &mut option.ls_tolerance);
    e.set_real("impratio", &mut option.impratio);
    e.set_int("ccd_iterations", &mut option.ccd_iterations);
    e.set_real("ccd_tolerance", &mut option.ccd_tolerance);
}

fn visual(e: &Element, visual: &mut Visual) {
    match e.name {
        "global" => {
            e.set_real("fovy", &mut visual.fovy);
            e.set_int("offwidth", &mut visual.offwidth);
            e.set_int("offheight", &mut visual.offheight);
        }
        "map" => {
            e.set_real("znear", &mut visual.znear);
            e.set_real("zfar", &mut visual.zfar);
            e.set_real("fogstart", &mut visual.fogstart);
            e.set_real("fogend", &mut visual.fogend);
            e.set_real("haze", &mut visual.haze);
            e.set_real("shadowclip", &mut visual.shadowclip);
            e.set_real("force", &mut visual.force);
        }
        "quality" => {
            e.set_int("shadowsize", &mut visual.shadowsize);
            e.set_int("offsamples", &mut visual.offsamples);
        }
        _ => {
            let mut active = i64::from(visual.headlight_active);
            e.set_int("active", &mut active);
            visual.headlight_active = active != 0;
            e.fill("ambient", &mut visual.headlight_ambient);
            e.fill("diffuse", &mut visual.headlight_diffuse);
            e.fill("specular", &mut visual.headlight_specular);
        }
    }
    let scalars = [
        &mut visual.fovy,
        &mut visual.znear,
        &mut visual.zfar,
        &mut visual.fogstart,
        &mut visual.fogend,
        &mut visual.haze,
        &mut visual.shadowclip,
        &mut visual.force,
    ];
    let colours = [
        &mut visual.headlight_ambient,
        &mut visual.headlight_diffuse,
        &mut visual.headlight_specular,
    ];
    scalars
        .into_iter()
        .chain(colours.into_iter().flatten())
        .for_each(|value| *value = single(*value));
}

fn statistic(e: &Element, statistic: &mut Statistic) {
    e.set_real("meaninertia", &mut statistic.meaninertia);
    e.set_real("meanmass", &mut statistic.meanmass);
    e.set_real("meansize", &mut statistic.meansize);
    e.set_real("extent", &mut statistic.extent);
    e.fill("center", &mut statistic.center);
}

fn asset(section: &Element, classes: &Classes, document: &mut Document) -> Result<(), LoadError> {
    for e in &section.children {
        if e.name == "texture" {
            document.textures.push(Texture::read(e));
        } else {
            let mut material = classes.of(e, MAIN)?.material.clone();
            material.apply(e);
            document.materials.push(material);
        }
    }
    Ok(())
}

fn contact(section: &Element, classes: &Classes, document: &mut Document) -> Result<(), LoadError> {
    let owned = |e: &Element, name: &str| e.text(name).unwrap_or_default().to_owned();
    for e in &section.children {
        if e.name == "pair" {
            let mut pair = classes.of(e, MAIN)?.pair.clone();
            pair.apply(e);
            document.pairs.push(pair);
        } else {
            document.excludes.push(Exclude {
                at: e.at,
                name: owned(e, "name"),
                body1: owned(e, "body1"),
                body2: owned(e, "body2"),
            });
        }
    }
    Ok(())
}

fn sensor(e: &Element) -> Option<Sensor> {
    let kind = match e.name {
        "accelerometer" => SensorType::Accelerometer,
        "gyro" => SensorType::Gyro,
        "torque" => SensorType::Torque,
        _ => return None,
    };
    let owned = |name: &str| e.text(name).unwrap_or_default().to_owned();
    Some(Sensor {
        at: e.at,
        name: owned("name"),
        kind,
        site: owned("site"),
    })
}

/// Reads what hangs on a body, and its child bodies depth first.
fn content(
    parent: &Element,
    body: usize,
    around: &str,
    classes: &Classes,
    bodies: &mut Vec<Body>,
) -> Result<(), LoadError> {
    for e in &parent.children {
        if e.name == "body" {
            let inner = e.text("childclass").unwrap_or(around);
            let id = child(e, body, inner, classes, bodies)?;
            content(e, id, inner, classes, bodies)?;
        } else {
            hang(e, body, around, classes, bodies)?;
        }
    }
    Ok(())
}

/// Adds a child body. Apart from `content`, whose frames pile up.
#[inline(never)]
fn child(
    e: &Element,
    parent: usize,
    inner: &str,
    classes: &Classes,
    bodies: &mut Vec<Body>,
) -> Result<usize, LoadError> {
    if !classes.by_name.contains_key(inner) {
        return Err(classes.error(e, ErrorKind::UnknownClass(inner.to_owned())));
    }
    let mut body = Body::new(e.at, e.text("name").unwrap_or_default().to_owned(), parent);
    body.frame.apply(e);
    bodies.push(body);
    Ok(bodies.len() - 1)
}

/// Adds anything else to a body. Apart from `content`, whose frames pile up.
#[inline(never)]
fn hang(e: &Element, body: usize, around: &str, classes: &Classes, bodies: &mut [Body]) -> Result<(), LoadError> {
    let body = &mut bodies[body];
    match e.name {
        "inertial" => body.inertial = Some(inertial(e)),
        "freejoint" => {
            // Takes no defaults: only `<joint type="free">` has a class.
            let mut joint = Joint {
                kind: JointType::Free,
                ..Joint::default()
            };
            joint.apply(e);
            body.joints.push(joint);
        }
        "joint" => body.joints.push(with(&classes.of(e, around)?.joint, e, Joint::apply)),
        "geom" => body.geoms.push(with(&classes.of(e, around)?.geom, e, Geom::apply)),
        "site" => body.sites.push(with(&classes.of(e, around)?.site, e, Site::apply)),
        "camera" => body
            .cameras
            .push(with(&classes.of(e, around)?.camera, e, Camera::apply)),
        "light" => body.lights.push(with(&classes.of(e, around)?.light, e, Light::apply)),
        _ => {}
    }
    Ok(())
}

/// A copy of the class's prototype with the attributes of the element.
fn with<T: Clone>(prototype: &T, e: &Element, apply: fn(&mut T, &Element)) -> T {
    let mut copy = prototype.clone();
    apply(&mut copy, e);
    copy
}

fn inertial(e: &Element) -> Inertial {
    let mut frame = Frame::IDENTITY;
    frame.apply(e);
    Inertial {
        at: e.at,
        frame,
        mass: e.array("mass").map_or(0.0, |[mass]| mass),
        diaginertia: e.array("diaginertia").unwrap_or([0.0; 3]),
        fullinertia: e.array("fullinertia"),
    }
}
