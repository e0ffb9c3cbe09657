//! Random legal documents.

mod defaults;
mod hanging;
mod sections;

use super::dice::{Dice, numbers};
use super::language::Language;
use super::node::Node;

/// Maximum number of bodies in a document.
const BODIES: usize = 10;

/// Maximum depth of a body below the world.
const DEPTH: usize = 5;

/// A joint that other elements may name.
#[derive(Clone)]
struct JointName {
    name: String,
    scalar: bool,
    /// Whether it is a ball joint.
    ball: bool,
    /// Whether it has its own limit.
    limited: bool,
}

/// Returns whether a joint or a tendon has its own limit.
fn has_limit(node: &Node) -> bool {
    node.get("range").is_some() && node.get("limited") != Some("false")
}

/// Writes one document.
struct Writer<'a> {
    language: &'a Language,
    dice: Dice,
    /// A radian in the unit of the document.
    radian: f64,
    autolimits: bool,
    /// Whether there are default classes, whose poses exclude `fromto`.
    defaults: bool,
    classes: Vec<String>,
    bodies: Vec<String>,
    joints: Vec<JointName>,
    geoms: Vec<String>,
    sites: Vec<String>,
    /// Geoms that a tendon may wrap around.
    rounds: Vec<String>,
    cameras: Vec<String>,
    /// The height field, if any.
    hfield: Option<Node>,
    /// Meshes, with the elements that define them.
    meshes: Vec<Node>,
    /// Materials, with and without opacity.
    materials: Vec<Node>,
    tendons: Vec<String>,
    limited_tendons: Vec<String>,
    actuators: Vec<String>,
    named: usize,
}

/// Returns the document of a seed.
pub fn document(language: &Language, seed: u64) -> Node {
    let mut dice = Dice::new(seed);
    let degree = dice.chance(0.5);
    let mut writer = Writer {
        language,
        radian: if degree { 180.0 / std::f64::consts::PI } else { 1.0 },
        autolimits: dice.chance(0.85),
        dice,
        defaults: false,
        classes: Vec::new(),
        bodies: Vec::new(),
        joints: Vec::new(),
        geoms: Vec::new(),
        sites: Vec::new(),
        rounds: Vec::new(),
        cameras: Vec::new(),
        hfield: None,
        meshes: Vec::new(),
        materials: Vec::new(),
        tendons: Vec::new(),
        limited_tendons: Vec::new(),
        actuators: Vec::new(),
        named: 0,
    };
    writer.root(degree)
}

impl Writer<'_> {
    fn root(&mut self, degree: bool) -> Node {
        self.dice.angle = self.radian;
        let mut compiler = Node::new("compiler").with("angle", if degree { "degree" } else { "radian" });
        if !self.autolimits {
            compiler.set("autolimits", "false");
        }
        self.language.dress(&mut compiler, "compiler", false, &mut self.dice);
        if self.dice.chance(0.1) {
            let mut settings = Node::new("lengthrange");
            self.language
                .dress(&mut settings, "compiler/lengthrange", false, &mut self.dice);
            compiler.children.push(settings);
        }
        let mut root = Node::new("mujoco");
        root.children.push(compiler);
        let option = self.option();
        root.children.push(option);
        if self.dice.chance(0.1) {
            let mut statistic = Node::new("statistic");
            self.language.dress(&mut statistic, "statistic", false, &mut self.dice);
            root.children.push(statistic);
        }
        if self.dice.chance(0.4) {
            self.defaults = true;
            let defaults = self.defaults(0);
            root.push_section(defaults);
        }
        let world = self.world();
        let mut asset = Node::new("asset");
        asset.children.append(&mut self.meshes);
        asset.children.append(&mut self.materials);
        asset.children.extend(self.hfield.take());
        root.push_section(asset);
        root.children.push(world);
        for section in [
            Self::contact,
            Self::tendon,
            Self::equality,
            Self::actuator,
            Self::sensor,
        ] {
            let section = section(self);
            let names = || {
                section
                    .children
                    .iter()
                    .filter_map(|node| node.get("name").map(str::to_owned))
            };
            match section.name.as_str() {
                "tendon" => {
                    self.tendons = names().collect();
                    let limited = section.children.iter().filter(|node| has_limit(node));
                    self.limited_tendons = limited.filter_map(|node| node.get("name").map(str::to_owned)).collect();
                }
                "actuator" => self.actuators = names().collect(),
                _ => {}
            }
            root.push_section(section);
        }
        root
    }

    /// Generates a name. It ends in a letter: in a document with a `<replicate>`, MuJoCo treats an element as a copy if its name is another
    /// one followed by the number of a copy.
    fn name(&mut self, kind: &str) -> String {
        self.named += 1;
        format!("{kind}{}n", self.named)
    }

    fn option(&mut self) -> Node {
        // Where the solvers are cut off, their steps are compared; elsewhere, where they end.
        let cut_off = self.dice.chance(0.1);
        let option = Node::new("option").with("tolerance", if cut_off { "1e-8" } else { "1e-14" });
        let (iterations, searches) = if cut_off {
            (
                self.dice.pick(&["1", "2", "3", "100"]),
                self.dice.pick(&["0", "1", "2", "3", "5", "50"]),
            )
        } else {
            ("300", "200")
        };
        let mut option = option.with("iterations", iterations).with("ls_iterations", searches);
        option.set(
            "ls_tolerance",
            if cut_off {
                self.dice.pick(&["0.01", "0.5"])
            } else {
                "1e-8"
            },
        );
        self.language.dress(&mut option, "option", false, &mut self.dice);
        if self.dice.chance(0.2) {
            let mut flag = Node::new("flag");
            self.language.dress(&mut flag, "option/flag", false, &mut self.dice);
            option.children.push(flag);
        }
        option
    }

    fn world(&mut self) -> Node {
        let mut world = Node::new("worldbody");
        if self.dice.chance(0.6) {
            let height = self.dice.uniform(-0.5, 0.2);
            let name = self.name("g");
            let mut plane = Node::new("geom")
                .with("name", name.as_str())
                .with("type", "plane")
                .with("size", "1 1 1")
                .with("pos", numbers(&[0.0, 0.0, height]));
            if self.dice.chance(0.8) {
                plane.set("quat", "1 0 0 0");
            }
            self.language
                .dress(&mut plane, "worldbody/body/geom", false, &mut self.dice);
            self.geoms.push(name);
            world.children.push(plane);
        }
        if self.dice.chance(0.3) {
            let terrain = self.terrain();
            world.children.push(terrain);
        }
        for _ in 0..self.dice.pick(&[0, 0, 1, 2]) {
            let geom = self.geom();
            world.children.push(geom);
        }
        for _ in 0..self.dice.pick(&[0, 1, 2]) {
            let site = self.site();
            world.children.push(site);
        }
        for _ in 0..self.dice.pick(&[1, 1, 2, 3]) {
            let body = self.body(0, false);
            world.children.push(body);
        }
        self.row(&mut world);
        self.replicate(&mut world);
        self.frame(&mut world);
        world
    }

    /// Adds a row of bodies that touch each other, at times hardly, at times in a turned frame.
    fn row(&mut self, world: &mut Node) {
        if self.dice.chance(0.95) {
            return;
        }
        let (shape, size) = (self.dice.pick(&["sphere", "sphere", "ellipsoid", "box"]), 0.1);
        let step = 2.0 * size - self.dice.pick(&[0.0, 0.0, 1e-8, 1e-7, 1e-6]);
        let start = self.dice.pick(&[0.0, 0.3, 3.0]);
        let mut row = Node::new("frame");
        if self.dice.chance(0.5) {
            row.set(
                "euler",
                [self.dice.coordinate(3.0), "0".to_owned(), "0".to_owned()].join(" "),
            );
        }
        for k in 0..self.dice.rng.usize(2..4) {
            let (body, joint, geom) = (self.name("b"), self.name("j"), self.name("g"));
            let place = numbers(&[start + step * k as f64, 0.0, 0.0]);
            let mut node = Node::new("body").with("name", body.as_str()).with("pos", place);
            let slide = Node::new("joint").with("name", joint.as_str()).with("type", "slide");
            node.children.push(slide.with("axis", "1 0 0"));
            let geom = Node::new("geom").with("name", geom).with("type", shape);
            node.children.push(geom.with("size", numbers(&[size; 3])));
            self.bodies.push(body);
            row.children.push(node);
        }
        world.children.push(row);
    }

    /// Returns the name of a material.
    fn material(&mut self) -> String {
        let name = self.name("o");
        let opacity = self.dice.pick(&["0", "1", "0.5"]);
        let material = Node::new("material").with("name", name.as_str());
        self.materials.push(material.with("rgba", format!("1 1 1 {opacity}")));
        name
    }

    fn body(&mut self, depth: usize, moves: bool) -> Node {
        let name = self.name("b");
        self.bodies.push(name.clone());
        let mut body = Node::new("body")
            .with("name", name)
            .with("pos", self.dice.reals(3, 0.5));
        self.class(&mut body, "childclass");
        self.language.dress(&mut body, "worldbody/body", false, &mut self.dice);
        let joints = self.joints(&mut body, depth);
        if depth == 0 && !joints && self.dice.chance(0.5) {
            body.set("mocap", "true");
        }
        if joints && self.dice.chance(0.3) {
            let mut inertial = Node::new("inertial").with("pos", self.dice.reals(3, 0.1));
            self.language
                .dress(&mut inertial, "worldbody/body/inertial", false, &mut self.dice);
            if ["diaginertia", "fullinertia"]
                .iter()
                .all(|kind| inertial.get(kind).is_none())
            {
                inertial.set("diaginertia", self.dice.diagonal_inertia());
            }
            if inertial.get("fullinertia").is_some() {
                ["quat", "axisangle", "xyaxes", "zaxis", "euler"]
                    .iter()
                    .for_each(|turn| inertial.unset(turn));
            }
            body.children.push(inertial);
        }
        let fewest = usize::from(joints || depth == 0);
        for _ in 0..self.dice.pick(&[0, 1, 1, 1, 2, 3, 4]).max(fewest) {
            let geom = self.geom();
            body.children.push(geom);
        }
        for _ in 0..self.dice.pick(&[0, 0, 0, 1, 1, 2]) {
            let site = self.site();
            body.children.push(site);
        }
        if self.dice.chance(0.1) {
            let name = self.name("v");
            let place = self.dice.reals(3, 0.5);
            let camera = Node::new("camera").with("name", name.as_str()).with("pos", place);
            body.children.push(camera.with("zaxis", self.dice.reals(3, 1.0)));
            self.cameras.push(name);
        }
        let moves = moves || joints;
        while depth < DEPTH && self.bodies.len() < BODIES && self.dice.chance(0.5) {
            let child = self.body(depth + 1, moves);
            body.children.push(child);
        }
        if depth < DEPTH {
            self.replicate(&mut body);
        }
        self.frame(&mut body);
        body
    }

    /// Adds copies of a geom or a body, at times copies of copies. Other elements refer to the contents by their written names, or to none of
    /// them.
    fn replicate(&mut self, parent: &mut Node) {
        if self.dice.chance(0.95) {
            return;
        }
        let named = self.dice.chance(0.5);
        let mut copies = Node::new("replicate");
        self.class(&mut copies, "childclass");
        self.language
            .dress(&mut copies, "worldbody/body/frame/replicate", false, &mut self.dice);
        let known = (
            self.bodies.len(),
            self.joints.len(),
            self.geoms.len(),
            self.sites.len(),
            self.rounds.len(),
            self.cameras.len(),
        );
        let held = if self.dice.chance(0.5) {
            self.geom()
        } else {
            self.body(DEPTH, false)
        };
        copies.children.push(held);
        if self.dice.chance(0.2) {
            let inner = std::mem::replace(&mut copies, Node::new("replicate"));
            self.language
                .dress(&mut copies, "worldbody/body/frame/replicate", false, &mut self.dice);
            copies.children.push(inner);
        }
        if !named {
            self.bodies.truncate(known.0);
            self.joints.truncate(known.1);
            self.geoms.truncate(known.2);
            self.sites.truncate(known.3);
            self.rounds.truncate(known.4);
            self.cameras.truncate(known.5);
        }
        let mut frame = Node::new("frame");
        frame.children.push(copies);
        parent.children.push(frame);
    }

    /// Moves some of a body's contents into a frame, sometimes into nested frames.
    fn frame(&mut self, body: &mut Node) {
        if body.children.is_empty() || self.dice.chance(0.85) {
            return;
        }
        let first = self.dice.rng.usize(..body.children.len());
        let last = self.dice.rng.usize(first..body.children.len());
        let mut frame = Node::new("frame");
        self.class(&mut frame, "childclass");
        self.language
            .dress(&mut frame, "worldbody/body/frame", false, &mut self.dice);
        frame.children = body.children.drain(first..=last).collect();
        self.frame(&mut frame);
        body.children.insert(first, frame);
    }
}
