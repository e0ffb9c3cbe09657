//! The positions of the hands in each eye's field of view, from evaluation logs.

use std::f64::consts::FRAC_1_SQRT_2;

use maud::{Markup, html};

use super::run::EvaluationEpisode;
use babybench::config::{Compat, Config};
use babybench::math::*;
use babybench::model::Model;
use babybench::physics::{State, Topology, cameras, com_pos, kinematics};

/// Side of a cell of the map, degrees.
const CELL: f64 = 3.0;
/// Half of the side of the map, degrees.
const REACH: f64 = 126.0;
/// Half of the scored field of view, degrees.
const SCORED: f64 = 15.0;
/// Maximum number of steps that are counted.
const MAX_STEPS: usize = 20_000;
/// Size of the drawing.
const SIZE: f64 = 300.0;

/// Directions of the hands, counted in cells: for each eye (right, left) and hand (right, left).
pub(super) struct Gaze {
    counts: [[Vec<u32>; 2]; 2],
    cells: usize,
    /// Half the field of view of the eye's camera, rad.
    /// Tangents of half the width and half the height of what the right and the left eye see.
    views: [[f64; 2]; 2],
    compat: Compat,
    pub steps: usize,
}

/// Returns the direction of `to` in the frame of a camera, as angles from its axis to the right and upwards, degrees.
fn direction(to: Vec3) -> [f64; 2] {
    let ahead = -to[2];
    let aside = (to[0] * to[0] + to[1] * to[1]).sqrt();
    let angle = pxfm::f_atan2(aside, ahead).to_degrees();
    match aside {
        0.0 => [angle, 0.0],
        _ => [angle * to[0] / aside, angle * to[1] / aside],
    }
}

impl Gaze {
    /// Width and height of a map.
    pub const SIZE: [f64; 2] = [SIZE, SIZE];

    /// Counts directions over evaluation logs; returns `None` if the model has no eyes or hands, or does not fit the
    /// logs.
    pub fn new(model: &Model, evaluations: &[EvaluationEpisode], config: &Config) -> Option<Self> {
        let eyes = [model.camera("eye_right")?, model.camera("eye_left")?];
        let hands = [model.body("right_hand")?, model.body("left_hand")?];
        let cells = (2.0 * REACH / CELL) as usize;
        let mut gaze = Self {
            counts: [0, 1].map(|_| [0, 1].map(|_| vec![0; cells * cells])),
            cells,
            views: [0, 1].map(|eye| {
                let [width, height] = config.eye_sizes()[1 - eye];
                let tangent = pxfm::f_tan(0.5 * model.cam_fovy[eyes[eye]].to_radians());
                [tangent * width as f64 / height as f64, tangent]
            }),
            compat: config.compat,
            steps: 0,
        };
        let all: usize = evaluations.iter().map(|e| e.log.len()).sum();
        let stride = all.div_ceil(MAX_STEPS).max(1);
        let mut s = State::new(model, &Topology::new(model));
        for log in evaluations.iter().map(|e| &e.log).filter(|log| log.nq == model.nq) {
            for qpos in log.qpos.chunks_exact(log.nq).step_by(stride) {
                s.qpos.copy_from_slice(qpos);
                kinematics(model, &mut s);
                com_pos(model, &mut s);
                cameras(model, &mut s);
                for (eye, counts) in eyes.iter().zip(&mut gaze.counts) {
                    for (&hand, counts) in hands.iter().zip(counts) {
                        let to = sub(s.xpos[hand], s.cam_xpos[*eye]);
                        let at = direction(mat_t_vec(&s.cam_xmat[*eye], to));
                        let cell = at.map(|a| ((a + REACH) / CELL).floor());
                        if cell.iter().all(|c| (0.0..cells as f64).contains(c)) {
                            counts[cell[1] as usize * cells + cell[0] as usize] += 1;
                        }
                    }
                }
                gaze.steps += 1;
            }
        }
        (gaze.steps > 0).then_some(gaze)
    }

    /// Draws the map of one eye: right (0) or left (1).
    pub fn map(&self, eye: usize) -> Markup {
        let place = |angle: f64| (angle / REACH + 1.0) * 0.5 * SIZE;
        let side = CELL / REACH * 0.5 * SIZE;
        let most = f64::from(*self.counts[eye].iter().flatten().max().unwrap_or(&1)).max(1.0);
        let cells = |hand: usize| {
            let counts = self.counts[eye][hand].iter().enumerate().filter(|(_, n)| **n > 0);
            counts.map(move |(k, &n)| {
                let (x, y) = ((k % self.cells) as f64, (k / self.cells) as f64);
                let strength = 0.18 + 0.82 * (f64::from(n) / most).sqrt();
                (x * side, SIZE - (y + 1.0) * side, strength)
            })
        };
        let radius = |angle: f64| angle / REACH * 0.5 * SIZE;
        let down = if self.compat == Compat::Reference { -90.0 } else { 0.0 };
        let middle = 0.5 * SIZE;
        html! {
            svg viewBox=(format!("0 0 {SIZE} {SIZE}")) role="img" aria-label="directions of the hands seen from the eye" {
                @for (hand, class) in ["right", "left"].into_iter().enumerate() {
                    g class=(class) {
                        @for (x, y, strength) in cells(hand) {
                            rect x=(format!("{x:.1}")) y=(format!("{y:.1}")) width=(format!("{side:.2}"))
                                height=(format!("{side:.2}")) fill-opacity=(format!("{strength:.2}")) {}
                        }
                    }
                }
                @for angle in [30.0, 60.0, 90.0] {
                    circle class="grid" cx=(middle) cy=(middle) r=(format!("{:.1}", radius(angle))) {}
                    text class="tick" x=(format!("{:.1}", middle + radius(angle) * FRAC_1_SQRT_2 + 2.0))
                        y=(format!("{:.1}", middle - radius(angle) * FRAC_1_SQRT_2 - 2.0)) { (angle) "°" }
                }
                text class="tick" x=(middle) y="13" text-anchor="middle" { "up" }
                text class="tick" x=(SIZE - 4.0) y=(middle + 4.0) text-anchor="end" { "right" }
                polygon class="view" points=(self.view(eye)) {}
                circle class="scored" cx=(middle) cy=(format!("{:.1}", place(-down))) r=(format!("{:.1}", radius(SCORED))) {}
            }
        }
    }

    /// Returns the border of the camera's field of view, as points of a polygon.
    fn view(&self, eye: usize) -> String {
        let tangents = self.views[eye];
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let mut points = String::new();
        for pair in corners.windows(2) {
            for step in 0..12 {
                let t = f64::from(step) / 12.0;
                let at = [0, 1].map(|k| tangents[k] * (pair[0][k] * (1.0 - t) + pair[1][k] * t));
                let [x, y] = direction([at[0], at[1], -1.0]);
                let place = |angle: f64| (angle / REACH + 1.0) * 0.5 * SIZE;
                points.push_str(&format!("{:.1},{:.1} ", place(x), place(-y)));
            }
        }
        points
    }

    /// Returns the share of the steps in which the hand was inside the eye's scored field of view, to the precision of a cell; for tests.
    #[cfg(test)]
    fn inside(&self, eye: usize, hand: usize) -> f64 {
        let center = |k: usize| (k as f64 + 0.5) * CELL - REACH;
        let down = if self.compat == Compat::Reference { -90.0 } else { 0.0 };
        let counts = self.counts[eye][hand].iter().enumerate();
        let near = counts.filter(|(k, _)| {
            let (x, y) = (center(k % self.cells), center(k / self.cells) - down);
            (x * x + y * y).sqrt() < SCORED
        });
        near.map(|(_, n)| f64::from(*n)).sum::<f64>() / self.steps as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use babybench::config::{Behavior, Config, Scene};
    use babybench::env::{Blueprint, EYE_HAND_PAIRS};
    use babybench::runs::logs::EvaluationLog;

    #[test]
    fn directions_are_angles_from_the_axis() {
        let near = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(near(direction([0.0, 0.0, -2.0]), [0.0, 0.0]));
        assert!(near(direction([1.0, 0.0, -1.0]), [45.0, 0.0]));
        assert!(near(direction([0.0, -1.0, 0.0]), [0.0, -90.0]));
        assert!(near(direction([-1.0, 0.0, 1.0]), [-135.0, 0.0]));
    }

    /// The hand comes into view by turning the head and lifting the arm at random.
    #[test]
    fn the_map_agrees_with_the_counters() {
        let config = Config {
            behavior: Behavior::HandRegard,
            scene: Scene::Crib,
            touch_active: false,
            vision_active: false,
            ..Config::default()
        };
        let blueprint = Blueprint::new(config).expect("a scene");
        let mut env = blueprint.env().expect("an environment");
        let (mut log, mut action) = (EvaluationLog::default(), Vec::new());
        env.reset(Some(1)).expect("no divergence");
        for k in 0..3000 {
            if k % 40 == 0 {
                env.sample_action(&mut action);
            }
            env.step(&action).expect("no divergence");
            log.push(&env.state().qpos, env.info());
        }
        let counted = env.info().behavior.regards().expect("hand_regard");
        let evaluated = EvaluationEpisode {
            episode: 0,
            log,
            video: None,
        };
        let gaze = Gaze::new(blueprint.model(), &[evaluated], blueprint.config()).expect("eyes and hands");
        assert_eq!(gaze.steps, 3000);
        for (k, (eye, hand)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
            let (map, counter) = (gaze.inside(eye, hand), counted[k] as f64 / 3000.0);
            println!("{}: {map:.4} in the map, {counter:.4} counted", EYE_HAND_PAIRS[k]);
            // cells at the border are in or out as a whole
            assert!((map - counter).abs() <= 0.02 + 0.25 * counter);
        }
    }
}
