//! The sections that name bodies, joints, geoms and sites.

use babybench::model::SensorType;

use super::{Dice, Writer};
use crate::differential::dice::numbers;
use crate::differential::node::Node;

impl Writer<'_> {
    /// Returns two of the given names.
    fn two(&mut self, names: &[String]) -> [String; 2] {
        let k = self.dice.rng.usize(..names.len());
        let other = self.dice.rng.usize(1..names.len());
        [names[k].clone(), names[(k + other) % names.len()].clone()]
    }

    pub(super) fn contact(&mut self) -> Node {
        let mut contact = Node::new("contact");
        if !self.dice.chance(0.4) {
            return contact;
        }
        let (geoms, bodies) = (self.geoms.clone(), self.bodies.clone());
        let mut pairs: Vec<[String; 2]> = Vec::new();
        for _ in 0..if geoms.len() > 1 { self.dice.rng.usize(..4) } else { 0 } {
            let mut two = self.two(&geoms);
            if !pairs.is_empty() && self.dice.chance(0.15) {
                two = pairs[self.dice.rng.usize(..pairs.len())].clone();
            }
            pairs.push(two.clone());
            let [geom1, geom2] = two;
            let mut pair = Node::new("pair").with("geom1", geom1).with("geom2", geom2);
            self.class(&mut pair, "class");
            self.language.dress(&mut pair, "contact/pair", false, &mut self.dice);
            contact.children.push(pair);
        }
        for _ in 0..if bodies.len() > 1 { self.dice.rng.usize(..4) } else { 0 } {
            let [body1, body2] = self.two(&bodies);
            contact
                .children
                .push(Node::new("exclude").with("body1", body1).with("body2", body2));
        }
        contact
    }

    /// Lists the joints of one coordinate.
    fn scalar_joints(&self) -> Vec<String> {
        let scalar = self.joints.iter().filter(|joint| joint.scalar);
        scalar.map(|joint| joint.name.clone()).collect()
    }

    pub(super) fn equality(&mut self) -> Node {
        let mut equality = Node::new("equality");
        let (joints, bodies) = (self.scalar_joints(), self.bodies.clone());
        for _ in 0..if self.dice.chance(0.5) {
            self.dice.rng.usize(..4)
        } else {
            0
        } {
            let mut node = if !self.tendons.is_empty() && self.dice.chance(0.3) {
                let tendons = self.tendons.clone();
                let first = self.dice.rng.usize(..tendons.len());
                let second = self.dice.rng.usize(..tendons.len());
                let mut node = Node::new("tendon").with("tendon1", tendons[first].as_str());
                if second != first || self.dice.chance(0.02) {
                    node.set("tendon2", tendons[second].as_str());
                }
                node
            } else if !joints.is_empty() && self.dice.chance(0.6) {
                let joint1 = &joints[self.dice.rng.usize(..joints.len())];
                let mut node = Node::new("joint").with("joint1", joint1.as_str());
                let joint2 = &joints[self.dice.rng.usize(..joints.len())];
                if joint2 != joint1 || self.dice.chance(0.02) {
                    node.set("joint2", joint2.as_str());
                }
                node
            } else if self.sites.len() > 1 && self.dice.chance(0.3) {
                let sites = self.sites.clone();
                let [site1, site2] = self.two(&sites);
                let node = Node::new(self.dice.pick(&["weld", "connect"]));
                node.with("site1", site1).with("site2", site2)
            } else if bodies.len() > 1 {
                let [body1, body2] = self.two(&bodies);
                let node = Node::new(self.dice.pick(&["weld", "connect"])).with("body1", body1);
                if self.dice.chance(0.7) {
                    node.with("body2", body2)
                } else {
                    node
                }
            } else {
                continue;
            };
            self.class(&mut node, "class");
            let path = format!("equality/{}", node.name);
            self.language.dress(&mut node, &path, false, &mut self.dice);
            equality.children.push(node);
        }
        equality
    }

    pub(super) fn tendon(&mut self) -> Node {
        let mut section = Node::new("tendon");
        let mut joints = self.scalar_joints();
        for _ in 0..if joints.is_empty() || self.dice.chance(0.6) {
            0
        } else {
            self.dice.rng.usize(1..3)
        } {
            let name = self.name("t");
            let mut tendon = Node::new("fixed").with("name", name);
            self.class(&mut tendon, "class");
            self.language.dress(&mut tendon, "tendon/fixed", false, &mut self.dice);
            self.decide_limits(&mut tendon);
            self.dice.rng.shuffle(&mut joints);
            for joint in joints.iter().take(self.dice.rng.usize(1..4)) {
                let mut wrap = Node::new("joint").with("joint", joint.as_str());
                self.language
                    .dress(&mut wrap, "tendon/fixed/joint", false, &mut self.dice);
                tendon.children.push(wrap);
            }
            section.children.push(tendon);
        }
        for _ in 0..if self.sites.len() < 2 || self.dice.chance(0.5) {
            0
        } else {
            self.dice.rng.usize(1..3)
        } {
            let tendon = self.spatial();
            section.children.push(tendon);
        }
        section
    }

    /// Draws the path of a spatial tendon: sites, sometimes with a geom between two of them or a pulley.
    fn spatial(&mut self) -> Node {
        let mut tendon = Node::new("spatial").with("name", self.name("t"));
        self.class(&mut tendon, "class");
        self.language
            .dress(&mut tendon, "tendon/spatial", false, &mut self.dice);
        self.decide_limits(&mut tendon);
        let (mut last, mut branch) = (self.sites.len(), 0);
        for left in (0..self.dice.rng.usize(2..6)).rev() {
            let mut next = self.dice.rng.usize(..self.sites.len());
            if next == last {
                next = (next + 1) % self.sites.len();
            }
            last = next;
            let site = Node::new("site").with("site", self.sites[next].as_str());
            tendon.children.push(site);
            branch += 1;
            if left > 0 && !self.rounds.is_empty() && self.dice.chance(0.5) {
                let geom = self.dice.rng.usize(..self.rounds.len());
                let mut geom = Node::new("geom").with("geom", self.rounds[geom].as_str());
                if self.dice.chance(0.5) {
                    let side = self.dice.rng.usize(..self.sites.len());
                    geom.set("sidesite", self.sites[side].as_str());
                }
                tendon.children.push(geom);
            } else if left > 1 && branch > 1 && self.dice.chance(0.2) {
                let mut pulley = Node::new("pulley");
                self.language
                    .dress(&mut pulley, "tendon/spatial/pulley", false, &mut self.dice);
                tendon.children.push(pulley);
                (last, branch) = (self.sites.len(), 0);
            }
        }
        tendon
    }

    pub(super) fn actuator(&mut self) -> Node {
        let mut section = Node::new("actuator");
        let joints: Vec<String> = self.joints.iter().map(|joint| joint.name.clone()).collect();
        for _ in 0..if joints.is_empty() || self.dice.chance(0.4) {
            0
        } else {
            self.dice.rng.usize(1..5)
        } {
            const KINDS: [&str; 12] = [
                "general",
                "general",
                "general",
                "motor",
                "position",
                "velocity",
                "intvelocity",
                "damper",
                "cylinder",
                "muscle",
                "muscle",
                "adhesion",
            ];
            let (kind, name) = (self.dice.pick(&KINDS), self.name("a"));
            let joint = joints[self.dice.rng.usize(..joints.len())].clone();
            let (target, object) = if !self.tendons.is_empty() && self.dice.chance(0.4) {
                (
                    "tendon",
                    self.tendons[self.dice.rng.usize(..self.tendons.len())].clone(),
                )
            } else {
                (self.dice.pick(&["joint", "joint", "joint", "jointinparent"]), joint)
            };
            let mut node = Node::new(kind).with("name", name);
            if !self.elsewhere(&mut node) {
                node.set(target, object);
            }
            self.class(&mut node, "class");
            self.language
                .dress(&mut node, &format!("actuator/{kind}"), false, &mut self.dice);
            if ["joint", "jointinparent", "tendon"]
                .iter()
                .all(|target| node.get(target).is_none())
            {
                node.unset("inheritrange");
            }
            self.fit_actuator(&mut node, false);
            self.decide_limits(&mut node);
            section.children.push(node);
        }
        section
    }

    /// Draws an object for an actuator that acts on neither a joint nor a tendon; returns whether it has one.
    fn elsewhere(&mut self, node: &mut Node) -> bool {
        let body = self.bodies[self.dice.rng.usize(..self.bodies.len())].clone();
        if node.name == "adhesion" || node.name == "general" && self.dice.chance(0.08) {
            node.set("body", body);
            return true;
        }
        if self.sites.len() < 2 || self.dice.chance(0.7) {
            return false;
        }
        let sites = self.sites.clone();
        let [site, other] = self.two(&sites);
        if node.name == "muscle" || self.dice.chance(0.3) {
            node.set("cranksite", site);
            node.set("slidersite", other);
            node.set("cranklength", self.dice.log(0.1, 2.0));
        } else {
            node.set("site", site);
            if self.dice.chance(0.5) {
                node.set("refsite", other);
            }
        }
        true
    }

    /// Sets the ranges and numbers that an actuator of its kind must have, and removes those that it may not have.
    pub(super) fn fit_actuator(&mut self, node: &mut Node, in_default: bool) {
        match node.name.as_str() {
            "damper" => {
                let ends = [self.dice.uniform(0.0, 0.5), self.dice.uniform(0.5, 2.0)];
                node.set("ctrlrange", numbers(&ends));
            }
            "intvelocity" if !in_default && node.get("actrange").is_none() && node.get("inheritrange").is_none() => {
                node.set("actrange", self.dice.range(1.0));
            }
            "adhesion" => {
                let ends = [self.dice.uniform(0.0, 0.5), self.dice.uniform(0.5, 2.0)];
                node.set("ctrlrange", numbers(&ends));
            }
            // MuJoCo hangs where it looks for the lengths of muscles and the simulation diverges
            "muscle" if !in_default => {
                // a default of another kind may have anything there
                if self.defaults && node.get("range").is_none() {
                    node.set("range", "0.7 1.1");
                }
                let ends = [self.dice.uniform(-1.0, 0.2), self.dice.uniform(0.3, 1.0)];
                node.set("lengthrange", numbers(&ends));
            }
            // what a default makes a muscle would have lengths to look for
            "general" if in_default => {
                for kind in ["gaintype", "biastype"] {
                    if node.get(kind) == Some("muscle") {
                        node.unset(kind);
                    }
                }
            }
            "general" => {
                for (kind, parameters) in [("gaintype", "gainprm"), ("biastype", "biasprm")] {
                    if node.get(kind) == Some("muscle") {
                        node.set(parameters, self.dice.muscle());
                    }
                }
                let ends = [self.dice.uniform(-1.0, 0.2), self.dice.uniform(0.3, 1.0)];
                node.set("lengthrange", numbers(&ends));
                let stateful = node.get("dyntype").is_some_and(|kind| kind != "none");
                if !stateful && self.dice.chance(0.95) {
                    node.unset("actrange");
                    node.set("actlimited", "false");
                }
                if self.dice.chance(0.1) {
                    node.set("actdim", if stateful { "1" } else { "0" });
                }
            }
            _ => {}
        }
    }

    pub(super) fn sensor(&mut self) -> Node {
        let mut section = Node::new("sensor");
        let (joints, some) = (self.scalar_joints(), self.dice.chance(0.6));
        // without a limit neither side takes a sensor of it
        let limited = self.joints.iter().filter(|joint| joint.limited);
        let limited: Vec<String> = limited.map(|joint| joint.name.clone()).collect();
        let balls = self.joints.iter().filter(|joint| joint.ball);
        let balls: Vec<String> = balls.map(|joint| joint.name.clone()).collect();
        for _ in 0..if some { self.dice.rng.usize(1..8) } else { 0 } {
            let k = self.dice.rng.usize(..SensorType::ALL.len());
            let kind = SensorType::ALL[k].name();
            let mut node = Node::new(kind);
            let of_limit = kind.contains("limit");
            let attribute = match kind {
                "clock" | "e_potential" | "e_kinetic" | "user" => None,
                "distance" | "normal" | "fromto" => Some("geom1"),
                _ if kind.starts_with("frame") => Some("objname"),
                _ if kind.starts_with("subtree") => Some("body"),
                _ if kind.starts_with("joint") || kind.starts_with("ball") => Some("joint"),
                _ if kind.starts_with("tendon") => Some("tendon"),
                _ if kind.starts_with("actuator") => Some("actuator"),
                _ => Some("site"),
            };
            let objects = match attribute {
                Some("joint") if of_limit => limited.clone(),
                Some("joint") if kind.starts_with("ball") => balls.clone(),
                Some("joint") => joints.clone(),
                Some("tendon") if of_limit => self.limited_tendons.clone(),
                Some("tendon") => self.tendons.clone(),
                Some("actuator") => self.actuators.clone(),
                Some("body") => self.bodies.clone(),
                _ => self.sites.clone(),
            };
            match attribute {
                None if kind == "user" => node.set("dim", self.dice.pick(&["0", "1", "3"])),
                None => {}
                Some("geom1") if self.between(&mut node) => {}
                Some("geom1") => continue,
                Some("objname") if self.framed(&mut node) => {}
                Some("objname") => continue,
                Some(_) if objects.is_empty() => continue,
                Some(attribute) => {
                    let object = objects[self.dice.rng.usize(..objects.len())].as_str();
                    node.set(attribute, object);
                }
            }
            if kind == "camprojection" {
                if self.cameras.is_empty() {
                    continue;
                }
                let camera = self.dice.rng.usize(..self.cameras.len());
                node.set("camera", self.cameras[camera].as_str());
            }
            self.language
                .dress(&mut node, &format!("sensor/{kind}"), false, &mut self.dice);
            section.children.push(node);
        }
        section
    }

    /// Draws the two geoms or bodies of a sensor; returns whether there are two.
    fn between(&mut self, node: &mut Node) -> bool {
        let (geoms, bodies) = (self.geoms.clone(), self.bodies.clone());
        if geoms.len() < 2 || bodies.len() < 2 {
            return false;
        }
        let ([geom1, geom2], [body1, body2]) = (self.two(&geoms), self.two(&bodies));
        for (geom, body, [of_geom, of_body]) in [(geom1, body1, ["geom1", "body1"]), (geom2, body2, ["geom2", "body2"])]
        {
            if self.dice.chance(0.7) {
                node.set(of_geom, geom);
            } else {
                node.set(of_body, body);
            }
        }
        true
    }

    /// Draws the object of a frame sensor, and sometimes the object in whose frame it measures; returns whether there is one.
    fn framed(&mut self, node: &mut Node) -> bool {
        let kinds = [
            ("body", self.bodies.clone()),
            ("xbody", self.bodies.clone()),
            ("geom", self.geoms.clone()),
            ("site", self.sites.clone()),
        ];
        let kinds: Vec<_> = kinds.into_iter().filter(|(_, names)| !names.is_empty()).collect();
        if kinds.is_empty() {
            return false;
        }
        let draw = |dice: &mut Dice| {
            let (kind, names) = &kinds[dice.rng.usize(..kinds.len())];
            (*kind, names[dice.rng.usize(..names.len())].clone())
        };
        let (kind, name) = draw(&mut self.dice);
        node.set("objtype", kind);
        node.set("objname", name);
        if !node.name.ends_with("acc") && self.dice.chance(0.5) {
            let (kind, name) = draw(&mut self.dice);
            node.set("reftype", kind);
            node.set("refname", name);
        }
        true
    }
}
