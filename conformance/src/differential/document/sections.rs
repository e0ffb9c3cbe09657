//! The sections that name bodies, joints, geoms and sites.

use super::Writer;
use crate::differential::node::Node;

impl Writer<'_> {
    /// Returns two of some names.
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
            let mut node = if !joints.is_empty() && self.dice.chance(0.6) {
                let joint1 = &joints[self.dice.rng.usize(..joints.len())];
                let mut node = Node::new("joint").with("joint1", joint1.as_str());
                let joint2 = &joints[self.dice.rng.usize(..joints.len())];
                if joint2 != joint1 || self.dice.chance(0.02) {
                    node.set("joint2", joint2.as_str());
                }
                node
            } else if bodies.len() > 1 {
                let [body1, body2] = self.two(&bodies);
                let node = Node::new("weld").with("body1", body1);
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
        section
    }

    pub(super) fn actuator(&mut self) -> Node {
        let mut section = Node::new("actuator");
        let joints = self.scalar_joints();
        for _ in 0..if joints.is_empty() || self.dice.chance(0.4) {
            0
        } else {
            self.dice.rng.usize(1..5)
        } {
            let (kind, name) = (self.dice.pick(&["motor", "position"]), self.name("a"));
            let joint = joints[self.dice.rng.usize(..joints.len())].as_str();
            let mut node = Node::new(kind).with("name", name).with("joint", joint);
            self.class(&mut node, "class");
            self.language
                .dress(&mut node, &format!("actuator/{kind}"), false, &mut self.dice);
            self.decide_limits(&mut node);
            section.children.push(node);
        }
        section
    }

    pub(super) fn sensor(&mut self) -> Node {
        let mut section = Node::new("sensor");
        for site in self.sites.clone() {
            let kind = self.dice.pick(&["accelerometer", "gyro", "torque"]);
            if self.dice.chance(0.7) {
                section.children.push(Node::new(kind).with("site", site));
            }
        }
        section
    }
}
