//! Default classes, and their effects.

use super::*;

impl Writer<'_> {
    pub(super) fn defaults(&mut self, depth: usize) -> Node {
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

    /// Sets for each range whether it limits, if MuJoCo requires that.
    pub(super) fn decide_limits(&mut self, node: &mut Node) {
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

    /// Sometimes names a default class.
    pub(super) fn class(&mut self, node: &mut Node, attribute: &str) {
        if !self.classes.is_empty() && self.dice.chance(0.2) {
            let k = self.dice.rng.usize(..self.classes.len());
            node.set(attribute, self.classes[k].as_str());
        }
    }
}
