//! Turns checked elements into the typed document: sections in MuJoCo's order, default classes applied.

mod attach;
mod cable;
mod cable_skin;
mod content;
mod flex;
mod insertion;
mod keys;
mod replicate;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use super::actuator::Actuator;
use super::custom::{Key, Numeric, Text, Tuple};
use super::document::{Camera, Compiler, Geom, Light, ModelAsset, Site, TypedDocument};
use super::elements;
use super::error::{ErrorKind, LoadError, UNREAD};
use super::joint::Joint;
use super::mesh::{HField, Mesh};
use super::relation::{Equality, Exclude, Pair, Tendon};
use super::schema::{self, DEFAULT, Element};
use super::sensor::Sensor;
use super::settings::{Root, Visual};
use super::skin::{Bone, Skin};
use super::surface::{Material, Texture};
use super::table::Table;
use super::xml::{ModelFile, Tree};
use crate::math::order;
use crate::text::nearest;
use content::content;
use insertion::Insertion;

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
    mesh: Mesh,
}

impl Class {
    /// Applies an element. An error describes the fault.
    fn apply(&mut self, e: &Element) -> Result<(), &'static str> {
        match e.name {
            "joint" => self.joint.apply(e),
            "geom" => self.geom.apply(e),
            "site" => self.site.apply(e),
            "camera" => {
                self.camera.look(e)?;
                // MuJoCo 3.3.0 reads no user data of cameras there
                self.camera.user.clear();
            }
            "light" => self.light.apply(e),
            "pair" => self.pair.apply(e),
            "equality" => self.equality.apply(e),
            "tendon" => self.tendon.string(e),
            "material" => self.material.look(e),
            "mesh" => self.mesh.apply(e),
            "general" | "motor" | "position" | "velocity" | "intvelocity" | "damper" | "cylinder" | "muscle"
            | "adhesion" => {
                return self.actuator.drive(e);
            }
            // a class of its own
            DEFAULT => {}
            _ => return Err(UNREAD),
        }
        Ok(())
    }
}

const MAIN: &str = "main";

struct Classes<'t> {
    tree: &'t Tree,
    by_name: BTreeMap<String, Class>,
}

impl<'t> Classes<'t> {
    /// Reads a `default` section and those nested in it. A class starts as a copy of its parent, so the elements of a
    /// section come before the sections nested in it, in whatever order the text has them.
    fn read(&mut self, section: &Element, parent: Option<&str>) -> Result<(), LoadError> {
        let name = self.declare(section, parent)?;
        section
            .children
            .iter()
            .filter(|e| e.name == DEFAULT)
            .try_for_each(|nested| self.read(nested, Some(&name)))
    }

    /// Adds the class of one section. It is separate from `read`, which recurses: a class is large, and stack space is limited.
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
        // a few bytes of text make another copy of all prototypes
        if self.by_name.len() > self.tree.limits.classes {
            return Err(self.error(
                section,
                ErrorKind::TooMuch {
                    what: "default classes",
                    limit: self.tree.limits.classes,
                },
            ));
        }
        // a second section at the top continues the main class
        let mut class = self.by_name.get(parent.unwrap_or(MAIN)).cloned().unwrap_or_default();
        for element in &section.children {
            let wrong = |what| self.error(element, ErrorKind::Invalid(what));
            class.apply(element).map_err(wrong)?;
        }
        self.by_name.insert(name.to_owned(), class);
        Ok(name.to_owned())
    }

    /// Returns the class of an element: its own, or else that of the bodies around it.
    fn of(&self, element: &Element, around: &str) -> Result<&Class, LoadError> {
        let name = element.text("class").unwrap_or(around);
        self.by_name.get(name).ok_or_else(|| self.unknown(element, name))
    }

    /// Returns the error for an element that names a nonexistent class.
    fn unknown(&self, element: &Element, name: &str) -> LoadError {
        let nearest = nearest(name, self.by_name.keys().map(String::as_str)).map(str::to_owned);
        let name = name.to_owned();
        self.error(element, ErrorKind::UnknownClass { name, nearest })
    }

    fn error(&self, element: &Element, kind: ErrorKind) -> LoadError {
        self.tree.error(element.at, kind)
    }
}

/// The document and the models that it includes by `<asset><model>`, with their elements.
struct Sources<'t> {
    tree: &'t Tree,
    roots: Vec<Element>,
    /// The index in the tree's list of models, by the element that names the model.
    named: BTreeMap<usize, usize>,
}

/// Reads the whole document.
pub(super) fn read(tree: &Tree) -> Result<TypedDocument, LoadError> {
    let root = |model: &ModelFile| {
        let name = &tree.nodes[model.root].name;
        if name != "mujoco" {
            return Err(tree.error(model.root, ErrorKind::WrongRoot(name.clone())));
        }
        schema::check(tree, model.root, &elements::MUJOCO)
    };
    let models = tree.models();
    let parts = Sources {
        tree,
        roots: models.iter().map(root).collect::<Result<_, _>>()?,
        named: order::map(models.iter().enumerate().map(|(index, model)| (model.of, index))),
    };
    let compiler = |root: &Element| {
        let mut compiler = Compiler::initial();
        let sections = root.children.iter().filter(|e| e.name == "compiler");
        sections.for_each(|section| compiler.section(section));
        compiler
    };
    let mut document = read_model(&parts, 0)?;
    document.compilers = parts.roots.iter().map(compiler).collect();
    Ok(document)
}

/// Reads the document, or a model that it names. Recursion is bounded by the limit on models within models.
fn read_model(parts: &Sources, index: usize) -> Result<TypedDocument, LoadError> {
    let (tree, root) = (parts.tree, &parts.roots[index]);
    let mut document = TypedDocument::new(root.at, Root::read(root).model);
    let mut classes = Classes {
        tree,
        by_name: BTreeMap::from([(MAIN.to_owned(), Class::default())]),
    };
    let sections = |name: &'static str| root.children.iter().filter(move |e| e.name == name);
    for section in sections("compiler") {
        section.children.iter().for_each(|e| document.lengthrange.apply(e));
    }
    // before all elements, which copy the prototypes of their class when they are read
    for section in sections(DEFAULT) {
        classes.read(section, None)?;
    }
    // MuJoCo 3.3.0 knows the main class there only once others were derived from it
    if classes.by_name.len() > 1
        && let Some(main) = classes.by_name.get(MAIN)
    {
        document.mesh_density = main.geom.density;
    }
    let mut visual = Visual::default();
    for section in &root.children {
        match section.name {
            "option" => {
                document.option.apply(section);
                section
                    .children
                    .iter()
                    .for_each(|flags| document.option.flags.apply(flags));
            }
            "size" => document
                .size
                .section(section)
                .map_err(|what| tree.error(section.at, ErrorKind::Invalid(what)))?,
            "visual" => section.children.iter().try_for_each(|e| {
                let wrong = |what| tree.error(e.at, ErrorKind::Invalid(what));
                visual.apply(e).map_err(wrong)
            })?,
            "statistic" => document.statistic.apply(section),
            // read before this, or after all others
            "compiler" | DEFAULT | "worldbody" | "extension" => {}
            name @ ("asset" | "contact" | "equality" | "tendon" | "actuator" | "sensor" | "custom" | "keyframe"
            | "deformable") => section
                .children
                .iter()
                .try_for_each(|e| add(e, name, &classes, &mut document))?,
            _ => return Err(tree.error(section.at, ErrorKind::Invalid(UNREAD))),
        }
    }
    // before the world, whose <attach> elements copy from these models
    for model in sections("asset").flat_map(|section| &section.children) {
        if let Some(&index) = parts.named.get(&model.at).filter(|_| model.name == "model") {
            add_model(parts, index, model, &mut document)?;
        }
    }
    // as in MuJoCo, elements of attached models follow the document's own
    for section in sections("worldbody") {
        content(section, Insertion::WORLD, MAIN, &classes, &mut document)?;
    }
    document.visual = visual.compiled();
    attach::check_absent(tree, &document)?;
    Ok(document)
}

/// Adds a model from which `<attach>` may take bodies.
fn add_model(parts: &Sources, index: usize, e: &Element, document: &mut TypedDocument) -> Result<(), LoadError> {
    let model = read_model(parts, index)?;
    let given = ModelAsset::read(e).name;
    let name = if given.is_empty() { model.model.clone() } else { given };
    // copies within models count here, too: models within models multiply them
    document.copied.add(model.copied, e.at, parts.tree)?;
    let kind = "model";
    if document.models.contains_key(&name) {
        return Err(parts.tree.error(e.at, ErrorKind::DuplicateName { kind, name }));
    }
    document.models.insert(name, model);
    Ok(())
}

/// Adds an element of a section that is a plain list of elements.
fn add(e: &Element, section: &str, classes: &Classes, document: &mut TypedDocument) -> Result<(), LoadError> {
    let class = || classes.of(e, MAIN);
    let wrong = |what| classes.error(e, ErrorKind::Invalid(what));
    match (section, e.name) {
        ("asset", "texture") => document.textures.push(Texture::read(e)),
        ("asset" | "deformable", "skin") => {
            let bones = e.children.iter().map(Bone::read).collect();
            document.skins.push(Skin { bones, ..Skin::read(e) });
        }
        ("deformable", "flex") => document.flexes.push(flex::flex(e).map_err(wrong)?),
        ("asset", "hfield") => document.hfields.push(HField::read(e)),
        ("asset", "mesh") => document.meshes.push(with(&class()?.mesh, e, Mesh::apply)),
        ("asset", "model") => {} // once the document itself is read
        ("asset", "material") => document.materials.push(with(&class()?.material, e, Material::look)),
        ("contact", "pair") => document.pairs.push(with(&class()?.pair, e, Pair::apply)),
        ("contact", "exclude") => document.excludes.push(Exclude::read(e)),
        ("equality", _) => {
            let mut equality = class()?.equality.clone();
            equality.hold(e).map_err(wrong)?;
            document.equalities.push(equality);
        }
        ("tendon", _) => {
            let mut tendon = with(&class()?.tendon, e, Tendon::string);
            tendon.thread(e).map_err(wrong)?;
            document.tendons.push(tendon);
        }
        ("actuator", _) => {
            let mut actuator: Actuator = class()?.actuator.clone();
            actuator.drive(e).map_err(wrong)?;
            document.actuators.push(actuator);
        }
        ("sensor", _) => document.sensors.push(Sensor::of(e).map_err(wrong)?),
        ("custom", "numeric") => document.numerics.push(Numeric::read(e)),
        ("custom", "text") => document.texts.push(Text::read(e)),
        ("custom", "tuple") => document.tuples.push(Tuple::hold(e)),
        ("keyframe", "key") => document.keys.push(Key::read(e)),
        _ => return Err(wrong(UNREAD)),
    }
    Ok(())
}

/// Copies the class's prototype and applies the attributes of the element.
fn with<T: Clone>(prototype: &T, e: &Element, apply: fn(&mut T, &Element)) -> T {
    let mut copy = prototype.clone();
    apply(&mut copy, e);
    copy
}
