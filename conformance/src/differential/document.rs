//! Random legal documents.

mod sections;

use super::dice::{Dice, numbers};
use super::language::Language;
use super::node::Node;

/// Most bodies of a document.
const BODIES: usize = 10;

/// Deepest body below the world.
const DEPTH: usize = 5;

/// A joint that other elements may name.
#[derive(Clone)]
struct JointName {
    name: String,
    scalar: bool,
    /// Whether it is a ball joint.
    ball: bool,
    /// Whether it has a limit of its own.
    limited: bool,
}

/// Tells whether a joint or a tendon gives itself a limit.
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
    /// Whether there are default classes, whose poses are no places for `fromto`.
    defaults: bool,
    classes: Vec<String>,
    bodies: Vec<String>,
    joints: Vec<JointName>,
    geoms: Vec<String>,
    sites: Vec<String>,
    /// Geoms that a tendon may wrap around.
    rounds: Vec<String>,
    cameras: Vec<String>,
    /// Whether there is a plane, which does not touch meshes: which corners touch depends on the order of the edges that Qhull finds.
    plane: bool,
    /// The height field, where there is one.
    hfield: Option<Node>,
    /// Meshes, with the elements that define them.
    meshes: Vec<Node>,
    /// Whether there are copies, beside which MuJoCo multiplies sensors of nothing.
    copies: bool,
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
        plane: false,
        hfield: None,
        meshes: Vec::new(),
        copies: false,
        tendons: Vec::new(),
        limited_tendons: Vec::new(),
        actuators: Vec::new(),
        named: 0,
    };
    writer.root(degree)
}

/// Writes the triangles of rings of vertices between two tips.
fn faces(rings: i32, around: i32) -> String {
    let last = 1 + rings * around;
    let at = |ring: i32, k: i32| 1 + ring * around + k % around;
    let mut all = Vec::new();
    for k in 0..around {
        all.push([0, at(0, k), at(0, k + 1)]);
        for ring in 1..rings {
            let (a, b) = (at(ring - 1, k), at(ring - 1, k + 1));
            let (c, d) = (at(ring, k), at(ring, k + 1));
            all.extend([[a, c, b], [c, d, b]]);
        }
        all.push([last, at(rings - 1, k + 1), at(rings - 1, k)]);
    }
    all.as_flattened()
        .iter()
        .map(i32::to_string)
        .collect::<Vec<_>>()
        .join(" ")
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

    /// Makes up a name. It ends in a letter: MuJoCo takes what stands beside a `<replicate>` for its contents where a name is another one with
    /// the number of a copy behind it.
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

    fn defaults(&mut self, depth: usize) -> Node {
        let mut class = Node::new("default");
        if depth > 0 {
            let name = self.name("c");
            class.set("class", name.as_str());
            self.classes.push(name);
        }
        const HOLDS: [(&str, &str); 15] = [
            ("joint", "worldbody/body/joint"),
            ("geom", "worldbody/body/geom"),
            ("site", "worldbody/body/site"),
            ("pair", "contact/pair"),
            ("equality", "equality/joint"),
            ("tendon", "tendon/fixed"),
            ("general", "actuator/general"),
            ("motor", "actuator/motor"),
            ("position", "actuator/position"),
            ("velocity", "actuator/velocity"),
            ("intvelocity", "actuator/intvelocity"),
            ("damper", "actuator/damper"),
            ("cylinder", "actuator/cylinder"),
            ("muscle", "actuator/muscle"),
            ("adhesion", "actuator/adhesion"),
        ];
        for (name, path) in HOLDS {
            // actuators share one default, of which each decides a part
            let odds = match name {
                "joint" | "geom" => 0.6,
                _ if path.starts_with("actuator") => 0.07,
                _ => 0.2,
            };
            if self.dice.chance(odds) {
                let mut node = Node::new(name);
                self.language.dress(&mut node, path, true, &mut self.dice);
                self.fit_actuator(&mut node, true);
                if !self.autolimits {
                    self.decide_limits(&mut node);
                }
                class.children.push(node);
            }
        }
        let nested = if depth < 3 { self.dice.rng.usize(..3 - depth) } else { 0 };
        for _ in 0..nested {
            let inner = self.defaults(depth + 1);
            class.children.push(inner);
        }
        class
    }

    /// Says of each range whether it limits, where MuJoCo asks for that.
    fn decide_limits(&mut self, node: &mut Node) {
        const RANGES: [(&str, &str); 6] = [
            ("range", "limited"),
            ("actuatorfrcrange", "actuatorfrclimited"),
            ("ctrlrange", "ctrllimited"),
            ("inheritrange", "ctrllimited"),
            ("forcerange", "forcelimited"),
            ("actrange", "actlimited"),
        ];
        for (range, limited) in RANGES {
            // that of a muscle is no limit
            if range == "range" && node.name == "muscle" {
                continue;
            }
            // the others are limited by their kind
            let always = match limited {
                "ctrllimited" => ["damper", "adhesion"].contains(&node.name.as_str()),
                "actlimited" => node.name != "general",
                _ => false,
            };
            if !always && node.get(range).is_some() && (!self.autolimits || self.dice.chance(0.2)) {
                let word = self.dice.pick(&["true", "true", "false"]);
                node.set(limited, word);
            }
        }
    }

    /// Names a default class, at times.
    fn class(&mut self, node: &mut Node, attribute: &str) {
        if !self.classes.is_empty() && self.dice.chance(0.2) {
            let k = self.dice.rng.usize(..self.classes.len());
            node.set(attribute, self.classes[k].as_str());
        }
    }

    fn world(&mut self) -> Node {
        let mut world = Node::new("worldbody");
        if self.dice.chance(0.6) {
            let height = self.dice.uniform(-0.5, 0.2);
            let name = self.name("g");
            let plane = Node::new("geom")
                .with("name", name.as_str())
                .with("type", "plane")
                .with("size", "1 1 1");
            let plane = plane.with("contype", "4").with("conaffinity", "1");
            let mut plane = plane.with("pos", numbers(&[0.0, 0.0, height]));
            self.plane = true;
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
        self.replicate(&mut world);
        self.frame(&mut world);
        world
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

    /// Adds copies of a geom or a body, to which nothing refers: their names are not those that are written.
    fn replicate(&mut self, parent: &mut Node) {
        if self.dice.chance(0.95) {
            return;
        }
        self.copies = true;
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
        self.bodies.truncate(known.0);
        self.joints.truncate(known.1);
        self.geoms.truncate(known.2);
        self.sites.truncate(known.3);
        self.rounds.truncate(known.4);
        self.cameras.truncate(known.5);
        let mut frame = Node::new("frame");
        frame.children.push(copies);
        parent.children.push(frame);
    }

    /// Puts some of what a body holds into a frame, at times into frames in each other.
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

    /// Adds joints; returns whether there are any.
    fn joints(&mut self, body: &mut Node, depth: usize) -> bool {
        if depth == 0 && self.dice.chance(0.35) {
            let name = self.name("j");
            let mut joint = if self.dice.chance(0.5) {
                Node::new("freejoint").with("name", name.as_str())
            } else {
                Node::new("joint").with("name", name.as_str()).with("type", "free")
            };
            if joint.name == "joint" {
                self.class(&mut joint, "class");
                self.language
                    .dress(&mut joint, "worldbody/body/joint", false, &mut self.dice);
                self.decide_limits(&mut joint);
            }
            self.joints.push(JointName {
                name,
                scalar: false,
                ball: false,
                limited: false,
            });
            body.children.push(joint);
            return true;
        }
        let n = self.dice.pick(&[0, 1, 1, 1, 1, 2, 2, 3, 4, 6]);
        // more of a kind would move the body as others do already, and so would hinges beside a ball
        let mut left = [3, 3];
        for k in 0..n {
            let ball = k + 1 == n && left[0] == 3 && self.dice.chance(0.33);
            let hinge = left[1] == 0 || left[0] > 0 && self.dice.chance(0.66);
            let (name, kind) = (
                self.name("j"),
                if ball {
                    "ball"
                } else {
                    ["slide", "hinge"][usize::from(hinge)]
                },
            );
            left[usize::from(!hinge)] -= 1;
            let mut joint = Node::new("joint").with("name", name.as_str()).with("type", kind);
            self.class(&mut joint, "class");
            self.dice.angle = if kind == "slide" { 1.0 } else { self.radian };
            self.language
                .dress(&mut joint, "worldbody/body/joint", false, &mut self.dice);
            self.dice.angle = self.radian;
            if k > 0 && kind != "ball" {
                joint.set("axis", numbers(&self.dice.vector(3, 1.0)));
            }
            if kind == "ball" && (self.defaults || joint.get("range").is_some()) {
                let most = self.dice.uniform(0.1, 3.3) * self.radian;
                joint.set("range", numbers(&[0.0, most]));
            }
            self.decide_limits(&mut joint);
            let limited = has_limit(&joint);
            self.joints.push(JointName {
                name,
                scalar: kind != "ball",
                ball: kind == "ball",
                limited,
            });
            body.children.push(joint);
        }
        n > 0
    }

    fn geom(&mut self) -> Node {
        let name = self.name("g");
        let shape = self.dice.pick(&[
            "sphere",
            "capsule",
            "box",
            "cylinder",
            "ellipsoid",
            "box",
            "capsule",
            "mesh",
        ]);
        let mut geom = Node::new("geom").with("name", name.as_str()).with("type", shape);
        if ["sphere", "cylinder"].contains(&shape) {
            self.rounds.push(name.clone());
        }
        if shape != "mesh" || !self.plane {
            self.geoms.push(name);
        }
        self.class(&mut geom, "class");
        // a mesh has its size, and so has what is fitted to one
        if shape == "mesh" || self.dice.chance(0.03) {
            let mesh = self.mesh();
            geom.set("mesh", mesh);
            if shape == "mesh" && self.plane {
                geom.set("contype", "2");
                geom.set("conaffinity", "3");
            }
            self.language
                .dress(&mut geom, "worldbody/body/geom", false, &mut self.dice);
            return geom;
        }
        let mut size = [0; 3].map(|_| self.dice.magnitude(0.03, 0.15));
        if self.dice.chance(0.1) {
            size = [size[0]; 3];
        }
        let entries = match shape {
            "sphere" => 1,
            "capsule" | "cylinder" => 2,
            _ => 3,
        };
        if shape != "sphere" && !self.defaults && self.dice.chance(0.3) {
            geom.set("fromto", numbers(&self.dice.vector(6, 0.2)));
            geom.set("size", numbers(&size[..entries - 1]));
        } else {
            geom.set("size", numbers(&size[..entries]));
        }
        self.language
            .dress(&mut geom, "worldbody/body/geom", false, &mut self.dice);
        geom
    }

    /// Writes a height field and the geom that is one.
    fn terrain(&mut self) -> Node {
        let (nrow, ncol) = (self.dice.pick(&[2, 3, 5, 8]), self.dice.pick(&[2, 3, 6, 9]));
        let size = [0.8, 0.8, 0.3, 0.2].map(|most| self.dice.magnitude(0.1 * most, most));
        let name = self.name("h");
        let mut hfield = Node::new("hfield").with("name", name.as_str());
        hfield.set("nrow", nrow.to_string());
        hfield.set("ncol", ncol.to_string());
        hfield.set("size", numbers(&size));
        if self.dice.chance(0.9) {
            hfield.set("elevation", self.dice.reals(nrow * ncol, 1.0));
        }
        self.hfield = Some(hfield);
        let (geom, height) = (self.name("g"), self.dice.uniform(-0.4, 0.0));
        let mut terrain = Node::new("geom").with("name", geom.as_str()).with("type", "hfield");
        terrain.set("hfield", name);
        terrain.set("pos", numbers(&[0.0, 0.0, height]));
        self.language
            .dress(&mut terrain, "worldbody/body/geom", false, &mut self.dice);
        self.geoms.push(geom);
        terrain
    }

    /// Returns the name of a mesh: of one that is there, or of a new one, rings of vertices between two tips.
    fn mesh(&mut self) -> String {
        if !self.meshes.is_empty() && self.dice.chance(0.3) {
            let k = self.dice.rng.usize(..self.meshes.len());
            return self.meshes[k].get("name").unwrap_or_default().to_owned();
        }
        let name = self.name("m");
        let mut mesh = Node::new("mesh").with("name", name.as_str());
        self.class(&mut mesh, "class");
        let (rings, around) = self
            .dice
            .pick(&[(1, 3), (1, 4), (1, 6), (2, 3), (2, 4), (2, 5), (3, 6), (4, 9)]);
        let (wide, high) = (self.dice.magnitude(0.03, 0.15), self.dice.magnitude(0.03, 0.15));
        let mut vertices = Vec::new();
        let mut point = |dice: &mut Dice, [x, y, z]: [f64; 3]| {
            let off = dice.vector(3, 0.1 * wide.min(high));
            vertices.extend([x + off[0], y + off[1], z + off[2]].map(|v| f64::from(v as f32)));
        };
        point(&mut self.dice, [0.0, 0.0, high]);
        for ring in 0..rings {
            let z = high * (1.0 - 2.0 * f64::from(ring + 1) / f64::from(rings + 1));
            let radius = wide * (1.0 - (z / high).powi(2)).sqrt();
            for k in 0..around {
                let angle = std::f64::consts::TAU * (f64::from(k) + 0.5 * f64::from(ring % 2)) / f64::from(around);
                point(&mut self.dice, [radius * angle.cos(), radius * angle.sin(), z]);
            }
        }
        point(&mut self.dice, [0.0, 0.0, -high]);
        mesh.set("vertex", numbers(&vertices));
        mesh.set("face", faces(rings, around));
        self.language.dress(&mut mesh, "asset/mesh", false, &mut self.dice);
        self.meshes.push(mesh);
        name
    }

    fn site(&mut self) -> Node {
        let name = self.name("s");
        let mut site = Node::new("site").with("name", name.as_str());
        if !self.defaults && self.dice.chance(0.2) {
            site.set("type", "capsule");
            site.set("fromto", numbers(&self.dice.vector(6, 0.1)));
        }
        self.class(&mut site, "class");
        self.language
            .dress(&mut site, "worldbody/body/site", false, &mut self.dice);
        self.sites.push(name);
        site
    }
}
