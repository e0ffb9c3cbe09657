//! Fixtures that measure what infants of an age can do: pull to sit, prone head lift, supported sitting, support by the legs.

use std::f64::consts::PI;

use babybench::config::{ActuationModel, Behavior, Proportions, Scene, SpringModel, StrengthModel};
use babybench::mimo::Version;
use babybench::{Config, Env};

/// A body that follows a program, to which MIMo is welded.
const TILTER: &str = "<body name='tilter' mocap='true'><geom type='sphere' size='0.005' contype='0' conaffinity='0'/></body>\
                      <equality><weld body1='tilter' body2='BODY' solref='0.01 1'/></equality>";

/// Seconds in which a pull to sit raises the trunk by 90 degrees.
const PULL: f64 = 4.0;

/// Returns MIMo at an age with the strength and the springs of infants, on the floor, without eyes and skin.
pub fn infant(version: Version, age: f64) -> Config {
    Config {
        behavior: match version {
            Version::V1 => Behavior::None,
            Version::V2 => Behavior::HandRegard,
        },
        scene: Scene::Base,
        age: Some(age),
        strength: StrengthModel::Infant,
        springs: SpringModel::Weight,
        touch_active: false,
        vision_active: false,
        vestibular_active: false,
        ..Config::default()
    }
}

/// The same with the body that the milestones are the same for: today's.
pub fn volume(version: Version, age: f64) -> Config {
    Config {
        strength: StrengthModel::Volume,
        springs: SpringModel::Fixed,
        proportions: Proportions::Mimo,
        ..infant(version, age)
    }
}

/// A MIMo whose actuators are driven by name.
struct Puppet {
    env: Env,
    action: Vec<f32>,
}

impl Puppet {
    /// Makes one whose `body` is welded to the tilter.
    fn new(config: &Config, welded: Option<&str>) -> Self {
        let scene_extra = welded.map_or(String::new(), |body| TILTER.replace("BODY", body));
        let config = Config {
            scene_extra,
            ..config.clone()
        };
        let mut env = Env::new(config).expect("a scene");
        env.reset(Some(0)).expect("resets");
        let action = vec![0.0; env.action_space().len()];
        Self { env, action }
    }

    fn qpos(&self, joint: &str) -> f64 {
        let model = self.env.model();
        let joint = model.joint(joint).expect("a joint");
        self.env.state().qpos[model.jnt_qposadr[joint]]
    }

    fn set(&self, qpos: &mut [f64], joint: &str, angle: f64) {
        let model = self.env.model();
        let joint = model.joint(joint).expect("a joint");
        qpos[model.jnt_qposadr[joint]] = angle;
    }

    /// Lets an actuator pull with a share of its torque, from -1 to 1; a servo aims at the end of its range.
    fn pull(&mut self, actuator: &str, share: f64) {
        let env = &self.env;
        let place = env
            .blueprint()
            .actuation()
            .actuators()
            .iter()
            .position(|&k| env.model().actuator_name[k] == actuator);
        let k = place.expect("an actuator");
        match env.config().actuation_model {
            ActuationModel::SpringDamper => self.action[k] = share as f32,
            ActuationModel::Muscle => {
                let n = env.blueprint().actuation().actuators().len();
                self.action[k] = (-share).max(0.0) as f32;
                self.action[n + k] = share.max(0.0) as f32;
            }
            ActuationModel::Positional => {
                let space = env.action_space();
                self.action[k] = if share < 0.0 { space.low()[k] } else { space.high()[k] } * share.abs() as f32;
            }
        }
    }

    fn step(&mut self) {
        self.env.step(&self.action).expect("steps");
    }

    /// Turns the tilter by an angle about the axis y through a point.
    fn tilt(&mut self, center: [f64; 3], angle: f64) {
        self.hold(center, center, angle);
    }

    /// Turns the tilter by an angle about the axis y and moves it, so that what was at one point is at another.
    fn hold(&mut self, from: [f64; 3], to: [f64; 3], angle: f64) {
        let (sin, cos) = angle.sin_cos();
        let [x, y, z] = from;
        let turned = [cos * x + sin * z, y, cos * z - sin * x];
        let pos = [0, 1, 2].map(|k| to[k] - turned[k]);
        let quat = [(0.5 * angle).cos(), 0.0, (0.5 * angle).sin(), 0.0];
        self.env.by_hand().set_mocap("tilter", pos, quat).expect("a tilter");
    }

    /// Returns the place of the free joint in `qpos`.
    fn root(&self) -> usize {
        let model = self.env.model();
        model.jnt_qposadr[model.joint("mimo_location").expect("a root")]
    }

    /// Puts MIMo upright, his welded hip at a height, with joints at 0 but for some angles (rad).
    fn upright(&mut self, height: f64, angles: &[(String, f64)]) {
        let (root, model) = (self.root(), self.env.model().clone());
        let mut qpos = self.env.state().qpos.clone();
        for q in self.env.senses().proprioception().joints().qpos.clone() {
            qpos[q] = 0.0;
        }
        for (joint, angle) in angles {
            self.set(&mut qpos, joint, *angle);
        }
        let before = [0, 1, 2].map(|k| model.qpos0[root + k]);
        let hip = [before[0], before[1], height];
        qpos[root..root + 3].copy_from_slice(&hip);
        qpos[root + 3..root + 7].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
        // in the document he lies on his back
        self.hold(before, hip, 0.5 * PI);
        self.env
            .by_hand()
            .set_state(&qpos, &vec![0.0; model.nv])
            .expect("a pose");
    }

    fn place(&self, body: &str) -> [f64; 3] {
        self.env.state().xpos[self.env.model().body(body).expect("a body")]
    }

    fn dt(&self) -> f64 {
        self.env.blueprint().dt()
    }
}

/// Returns the controller of a neck or of a trunk: it pulls back an angle (rad).
fn controller(angle: f64) -> f64 {
    (-3.0 * angle).clamp(-1.0, 1.0)
}

/// Returns the head lag, degrees, at a trunk of 45 and of 90 degrees: MIMo lies on his back, his chest is turned about his hip by 90 degrees
/// in four seconds, and his neck pulls back the angle of the head.
pub fn pull_to_sit(config: &Config) -> [f64; 2] {
    let config = Config {
        lock: babybench::config::BodyParts {
            body: true,
            ..config.lock
        },
        ..config.clone()
    };
    let mut mimo = Puppet::new(&config, Some("upper_body"));
    let hip = mimo.place("hip");
    let steps = (PULL / mimo.dt()) as usize;
    let mut lags = [0.0; 2];
    for step in 0..steps {
        mimo.tilt(hip, 0.5 * PI * (step + 1) as f64 / steps as f64);
        let angle = mimo.qpos("robot:head_tilt");
        mimo.pull("act:head_tilt", controller(angle));
        mimo.step();
        for (k, at) in [steps / 2, steps].into_iter().enumerate() {
            if step + 1 == at {
                lags[k] = -mimo.qpos("robot:head_tilt").to_degrees();
            }
        }
    }
    lags
}

/// Returns the greatest angle, degrees, by which MIMo on his belly holds his face up for a second, over how it lies limp. Neck and trunk bend
/// back with all their strength.
pub fn prone_head_lift(config: &Config) -> f64 {
    let mut mimo = Puppet::new(config, None);
    let (mut qpos, qvel) = (mimo.env.state().qpos.clone(), vec![0.0; mimo.env.model().nv]);
    let root = mimo.root();
    let half = (0.25 * PI).sin();
    qpos[root + 2] += 0.02;
    qpos[root + 3..root + 7].copy_from_slice(&[half, 0.0, half, 0.0]);
    mimo.env.by_hand().set_state(&qpos, &qvel).expect("a pose");
    let pitch = |mimo: &Puppet| {
        let head = mimo.env.model().body("head").expect("a head");
        // the face is along x of the head
        let up = mimo.env.state().xmat[head];
        90.0 + up[6].clamp(-1.0, 1.0).asin().to_degrees()
    };
    let second = (1.0 / mimo.dt()) as usize;
    for _ in 0..2 * second {
        mimo.step();
    }
    let limp = pitch(&mimo);
    for (actuator, share) in [("act:head_tilt", -1.0), ("act:hip_bend", -1.0)] {
        mimo.pull(actuator, share);
    }
    let mut angles = Vec::new();
    for _ in 0..4 * second {
        mimo.step();
        angles.push(pitch(&mimo) - limp);
    }
    // the angle that is held for a second
    let held = angles
        .windows(second)
        .map(|held| held.iter().copied().fold(f64::INFINITY, f64::min));
    held.fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the angle, degrees, by which the pelvis is tilted forward when the trunk above it gives way by 20 degrees; 45 if it never does.
/// He starts upright, and the trunk pulls back its angle.
pub fn supported_sitting(config: &Config) -> f64 {
    let mut mimo = Puppet::new(config, Some("hip"));
    let root = mimo.root();
    let before = [0, 1, 2].map(|k| mimo.env.model().qpos0[root + k]);
    let hip = [before[0], before[1], 1.0];
    mimo.upright(hip[2], &[]);
    // 10 degrees a second
    let steps = (4.5 / mimo.dt()) as usize;
    for step in 0..steps {
        let tilt = 45.0 * (step + 1) as f64 / steps as f64;
        mimo.hold(before, hip, 0.5 * PI + tilt.to_radians());
        let bend = |mimo: &Puppet| mimo.qpos("robot:hip_bend1") + mimo.qpos("robot:hip_bend2");
        mimo.pull("act:hip_bend", controller(bend(&mimo)));
        mimo.pull("act:head_tilt", controller(mimo.qpos("robot:head_tilt")));
        mimo.step();
        if bend(&mimo).abs().to_degrees() > 20.0 {
            return tilt;
        }
    }
    45.0
}

/// Returns the share of his weight by which MIMo presses on the floor more than limp legs do when his knees stretch with all their strength.
/// His hip is held upright above his feet, and his thighs are at 30 degrees from the vertical, so that the knees are before the feet by half
/// the length of a thigh.
pub fn leg_support(config: &Config) -> f64 {
    let mut mimo = Puppet::new(config, Some("hip"));
    let model = mimo.env.model().clone();
    let far = |a: &str, b: &str| {
        let (a, b) = (mimo.place(a), mimo.place(b));
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    };
    let (thigh, shank) = (
        far("left_upper_leg", "left_lower_leg"),
        far("left_lower_leg", "left_foot"),
    );
    // feet below the hips
    let (hip, back) = (PI / 6.0, (0.5 * thigh / shank).asin());
    let bent = |side: &str| {
        [("hip1", -hip), ("knee", -hip - back), ("foot1", back)].map(|(j, angle)| (format!("robot:{side}_{j}"), angle))
    };
    let angles = [bent("left"), bent("right")].concat();
    mimo.upright(1.0, &angles);
    let foot = model.body("left_foot").expect("a foot");
    let soles = (0..model.ngeom()).filter(|&g| model.geom_bodyid[g] == foot);
    let state = mimo.env.state();
    // the smallest size of a sole is its half thickness
    let thickness = |g: usize| {
        model.geom_size[g]
            .into_iter()
            .filter(|s| *s > 0.0)
            .fold(f64::INFINITY, f64::min)
    };
    let low = soles
        .map(|g| state.geom_xpos[g][2] - thickness(g))
        .fold(f64::INFINITY, f64::min);
    mimo.upright(1.0 - low - 0.0002, &angles);
    let trunk = model.body("hip").expect("a hip");
    let own = |b: usize| model.in_subtree(b, trunk);
    let weight: f64 = (0..model.nbody())
        .filter(|&b| own(b))
        .map(|b| 9.81 * model.body_mass[b])
        .sum();
    let press = |mimo: &mut Puppet| {
        let second = (1.0 / mimo.dt()) as usize;
        let mut pressed = 0.0;
        for step in 0..second {
            mimo.step();
            if step >= second / 2 {
                let contacts = mimo.env.state().contact.iter();
                let floor = contacts.filter(|c| c.geom.iter().filter(|&&g| own(model.geom_bodyid[g])).count() == 1);
                pressed += floor.map(|c| c.force[0] * c.frame[2].abs()).sum::<f64>();
            }
        }
        pressed / (second - second / 2) as f64 / weight
    };
    let limp = press(&mut mimo);
    mimo.pull("act:left_knee", 1.0);
    mimo.pull("act:right_knee", 1.0);
    press(&mut mimo) - limp
}
