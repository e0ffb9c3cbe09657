//! The stage that users see and act on: the camera, the spring, the clock, and the picture.

use babybench::Env;
use babybench::env::EnvError;
use babybench::formats::jpeg::{ColorResolution, write_jpeg};
use babybench::math::{Vec3, add, add_scaled, mat_vec, row};
use babybench::render::{ImageBuffers, Poses, RenderRequest, Renderer, View};
use serde_json::json;

use super::orbit::{Lens, Orbit};
use super::server::Answer;
use super::spring::Spring;

/// Side of a picture, pixels.
const SIDE: std::ops::RangeInclusive<usize> = 16..=1600;
/// Quality of pictures, of 100.
const QUALITY: u8 = 88;
/// Maximum number of touch points in a picture.
const POINTS: usize = 4000;
/// Depth behind the visible surface up to which a point is drawn, m.
const BEHIND: f64 = 0.012;

/// The visitors' settings, and the renderer.
pub struct Stage {
    title: String,
    /// Whether time is paused, and whether it pauses after one more step.
    pub paused: bool,
    pub single: bool,
    /// Simulated seconds per second of real time.
    pub speed: f64,
    pub moves: bool,
    /// Whether a new episode was requested.
    pub reset: bool,
    pub spring: Spring,
    touch: bool,
    contacts: bool,
    /// A camera of the scene, by name; without one, users steer the view.
    camera: Option<String>,
    orbit: Option<Orbit>,
    renderer: Option<Renderer>,
    size: [usize; 2],
    /// Distance of the held point from the camera's plane, m.
    depth: f64,
    rgb: Vec<u8>,
    depths: Vec<f32>,
}

impl Stage {
    pub fn new(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            paused: false,
            single: false,
            speed: 1.0,
            moves: true,
            reset: false,
            spring: Spring::default(),
            touch: true,
            contacts: false,
            camera: None,
            orbit: None,
            renderer: None,
            size: [640, 480],
            depth: 1.0,
            rgb: Vec::new(),
            depths: Vec::new(),
        }
    }

    /// Carries out the lines, and draws the result: a line of JSON and a JPEG.
    pub fn answer(&mut self, env: &mut Env, lines: &str) -> Answer {
        for line in lines.lines() {
            self.obey(env, line)?;
        }
        self.picture(env).map_err(|e| e.to_string())
    }

    /// Carries out a line: a word and its arguments.
    fn obey(&mut self, env: &mut Env, line: &str) -> Result<(), String> {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        if word == "camera" {
            if !rest.is_empty() && env.model().camera(rest).is_none() {
                return Err(format!("the scene has no camera {rest:?}"));
            }
            self.camera = Some(rest.to_owned()).filter(|name| !name.is_empty());
            return Ok(());
        }
        let numbers: Result<Vec<f64>, _> = rest.split_whitespace().map(str::parse).collect();
        let numbers = numbers.ok().filter(|n| n.iter().all(|v| v.is_finite()));
        let no_sense = || format!("the viewer does not understand {line:?}");
        match (word, numbers.as_deref().ok_or_else(no_sense)?) {
            ("size", &[width, height]) => {
                self.size = [width, height].map(|v| (v as usize).clamp(*SIDE.start(), *SIDE.end()))
            }
            ("turn", &[across, down]) => self.steer(env).turn(across, down),
            ("zoom", &[factor]) => self.steer(env).zoom(factor.clamp(0.2, 5.0)),
            ("shift", &[across, down]) => {
                let fovy = self.fovy(env).map_err(|e| e.to_string())?;
                self.steer(env).shift(across, down, fovy).map_err(|e| e.to_string())?;
            }
            ("home", []) => (self.camera, self.orbit) = (None, None),
            ("hold", &[x, y]) => self.hold(env, [x, y]).map_err(|e| e.to_string())?,
            ("drag", &[x, y]) => {
                let lens = self.lens(env).map_err(|e| e.to_string())?;
                self.spring
                    .aim(lens.place([x, y].map(|v| v.clamp(-2.0, 3.0)), self.depth));
            }
            ("release", []) => self.spring.let_go(env),
            ("pause", &[on]) => (self.paused, self.single) = (on != 0.0, false),
            ("step", []) => (self.paused, self.single) = (true, true),
            ("speed", &[speed]) => self.speed = speed.clamp(0.01, 64.0),
            ("moves", &[on]) => self.moves = on != 0.0,
            ("touch", &[on]) => self.touch = on != 0.0,
            ("contacts", &[on]) => self.contacts = on != 0.0,
            ("reset", []) => self.reset = true,
            _ => return Err(no_sense()),
        }
        Ok(())
    }

    /// Returns the camera that users steer, and switches the view to it.
    fn steer(&mut self, env: &Env) -> &mut Orbit {
        self.camera = None;
        self.orbit.get_or_insert_with(|| Orbit::new(env))
    }

    fn renderer(&mut self, env: &Env) -> Result<&mut Renderer, EnvError> {
        Ok(match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(env.blueprint().renderer()?),
        })
    }

    fn fovy(&mut self, env: &Env) -> Result<f64, EnvError> {
        Ok(self.renderer(env)?.scenery().fovy)
    }

    fn lens(&mut self, env: &Env) -> Result<Lens, EnvError> {
        let fovy = self.fovy(env)?;
        let [width, height] = self.size;
        let orbit = self.orbit.get_or_insert_with(|| Orbit::new(env));
        Ok(orbit.lens(fovy, width as f64 / height as f64)?)
    }

    /// Grabs the body at a position in the picture, if there is one that can move.
    fn hold(&mut self, env: &Env, place: [f64; 2]) -> Result<(), EnvError> {
        let [width, height] = self.size;
        let (mut geoms, mut depths) = (vec![-1; width * height], vec![0.0; width * height]);
        let images = ImageBuffers {
            depth: Some(&mut depths),
            segmentation: Some(&mut geoms),
            ..ImageBuffers::default()
        };
        self.draw(env, images)?;
        let pixel = pixel(place, self.size);
        let geom = pixel.and_then(|at| usize::try_from(*geoms.get(at)?).ok());
        let body = geom.and_then(|geom| env.model().geom_bodyid.get(geom).copied());
        let depth = pixel.and_then(|at| depths.get(at).copied());
        if let (Some(body), Some(depth)) = (body, depth.filter(|d| d.is_finite())) {
            self.depth = f64::from(depth);
            let at = self.lens(env)?.place(place, self.depth);
            self.spring.hold(env, body, at);
        }
        Ok(())
    }

    /// Draws images from the current camera.
    fn draw(&mut self, env: &Env, images: ImageBuffers<'_>) -> Result<(), EnvError> {
        let mut poses = Poses::from(env.state());
        let named = self.camera.as_ref().and_then(|name| env.model().camera(name));
        if named.is_none() {
            poses.free = Some(self.orbit.get_or_insert_with(|| Orbit::new(env)).camera().pose()?);
        }
        let [width, height] = self.size;
        let view = View {
            camera: named.unwrap_or(View::FREE),
            width,
            height,
        };
        Ok(self.renderer(env)?.draw(&[RenderRequest { poses, view }], [images])?)
    }

    fn picture(&mut self, env: &Env) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let [width, height] = self.size;
        let (mut rgb, mut depths) = (std::mem::take(&mut self.rgb), std::mem::take(&mut self.depths));
        rgb.resize(3 * width * height, 0);
        depths.resize(width * height, 0.0);
        let free = self.camera.is_none();
        let images = ImageBuffers {
            rgb: Some(&mut rgb),
            depth: (free && self.touch).then_some(&mut *depths),
            ..ImageBuffers::default()
        };
        self.draw(env, images)?;
        let over = if free { self.over(env, &depths)? } else { json!({}) };
        let cameras: Vec<&String> = env.model().cam_name.iter().filter(|name| !name.is_empty()).collect();
        let said = json!({
            "title": self.title, "time": env.state().time, "steps": env.info().steps, "paused": self.paused && !self.single,
            "speed": self.speed, "moves": self.moves, "touch": self.touch, "contacts": self.contacts,
            "feels": env.senses().touch().is_some(), "camera": self.camera, "cameras": cameras, "over": over,
        });
        let mut out = said.to_string().into_bytes();
        out.push(b'\n');
        let size = [u16::try_from(width)?, u16::try_from(height)?];
        write_jpeg(&mut out, &rgb, size, QUALITY, ColorResolution::ByQuality)?;
        (self.rgb, self.depths) = (rgb, depths);
        Ok(out)
    }

    /// Returns what is drawn over the picture, in fractions of its width and height: where skin feels something, and how strongly; contacts with
    /// their forces; the spring.
    fn over(&mut self, env: &Env, depths: &[f32]) -> Result<serde_json::Value, EnvError> {
        let lens = self.lens(env)?;
        let short = |[x, y]: [f64; 2]| [x, y].map(|v| (v * 1e4).round() / 1e4);
        let mut touched = Vec::new();
        if self.touch {
            for (point, force) in felt(env).take(POINTS) {
                let Some((place, depth)) = lens.seen(point) else {
                    continue;
                };
                let surface = pixel(place, self.size).and_then(|at| depths.get(at));
                if surface.is_some_and(|&s| depth <= f64::from(s) + BEHIND) {
                    let [x, y] = short(place);
                    touched.push(json!([x, y, (force * 1e3).round() / 1e3]));
                }
            }
        }
        let line = |[from, to]: [Vec3; 2]| {
            let ([a, b], [c, d]) = (short(lens.seen(from)?.0), short(lens.seen(to)?.0));
            Some([a, b, c, d])
        };
        let mut arrows = Vec::new();
        if self.contacts {
            let ends = env.state().contact.iter().map(|contact| {
                // 5 mm for a newton
                let length = (contact.force[0] * 0.005).clamp(0.01, 0.5);
                [contact.pos, add_scaled(contact.pos, row(&contact.frame, 0), length)]
            });
            arrows.extend(ends.filter_map(line));
        }
        let spring = self.spring.ends(env).and_then(line);
        Ok(json!({ "touched": touched, "arrows": arrows, "spring": spring }))
    }
}

/// Returns the pixel at a position, if that is inside the picture.
fn pixel([x, y]: [f64; 2], [width, height]: [usize; 2]) -> Option<usize> {
    let inside = 0.0..1.0;
    let (column, line) = ((x * width as f64) as usize, (y * height as f64) as usize);
    (inside.contains(&x) && inside.contains(&y)).then_some(line * width + column)
}

/// Iterates over the sensors that feel something: where they are in the world, m, and the force, N.
fn felt(env: &Env) -> impl Iterator<Item = (Vec3, f64)> + '_ {
    let (state, touch) = (env.state(), env.senses().touch());
    touch.into_iter().flat_map(move |touch| {
        touch.active().filter_map(move |sensor| {
            let local = *touch.layout().sensor_positions(sensor.body)?.get(sensor.index)?;
            let (pos, mat) = (state.xpos.get(sensor.body)?, state.xmat.get(sensor.body)?);
            let force = sensor.value.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt();
            Some((add(*pos, mat_vec(mat, local)), force))
        })
    })
}
