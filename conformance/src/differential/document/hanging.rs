//! Elements that hang on bodies: joints, geoms, terrain, meshes, sites.

use super::*;

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
    /// Adds joints; returns whether there are any.
    pub(super) fn joints(&mut self, body: &mut Node, depth: usize) -> bool {
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
            } else {
                let path = "worldbody/body/freejoint";
                self.language.dress(&mut joint, path, false, &mut self.dice);
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

    pub(super) fn geom(&mut self) -> Node {
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
        self.geoms.push(name);
        self.class(&mut geom, "class");
        if self.dice.chance(0.08) {
            let material = self.material();
            geom.set("material", material);
        }
        // a mesh has its size, and so has what is fitted to one
        if shape == "mesh" || self.dice.chance(0.03) {
            let mesh = self.mesh();
            geom.set("mesh", mesh);
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
    pub(super) fn terrain(&mut self) -> Node {
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

    /// Returns the name of a mesh: an existing one, or a new one made of rings of vertices between two tips.
    pub(super) fn mesh(&mut self) -> String {
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
        if self.dice.chance(0.7) {
            mesh.set("face", faces(rings, around)); // else they are those of the hull
        }
        self.language.dress(&mut mesh, "asset/mesh", false, &mut self.dice);
        self.meshes.push(mesh);
        name
    }

    pub(super) fn site(&mut self) -> Node {
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
