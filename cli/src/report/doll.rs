//! Pictures of MIMo with parts of the body in colour.

use babybench::assets::AssetSource;
use babybench::formats::png::{ColorType, png};
use babybench::math::*;
use babybench::mimo::{JOINT_PREFIX, upright_extent};
use babybench::model::Model;
use babybench::physics::{State, Topology, cameras, com_pos, kinematics};
use babybench::render::{CpuRenderer, Element, LightAim, LightSource, Poses, Scenery, View};

/// Width of a picture, pixels.
pub(super) const WIDTH: usize = 400;
/// Height of a picture, pixels.
pub(super) const HEIGHT: usize = 600;
/// Vertical field of view, degrees: nearly parallel.
const FOVY: f64 = 9.0;
/// Free space around MIMo, as a share of the picture's height.
const MARGIN: f64 = 0.05;
/// Angle of the arms from the body, rad, so that every part is visible, or so that there is space beside him.
const ARMS: [f64; 2] = [0.45, 0.12];
/// Those of MIMo's joints that move the arms away from the body.
const SHOULDERS: [&str; 2] = ["right_shoulder_ad_ab", "left_shoulder_ad_ab"];
/// Posture, rad; joints that are not here are at 0.
const POSTURE: [(&str, f64); 6] = [
    ("right_elbow", -0.3),
    ("left_elbow", -0.3),
    ("right_hip2", -0.12),
    ("left_hip2", -0.12),
    ("right_knee", -0.1),
    ("left_knee", -0.1),
];

/// Bodies that keep their textures: clothes would hide the colours.
const FACE: [&str; 3] = ["head", "left_eye", "right_eye"];

/// The side from which MIMo is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DollSide {
    Front,
    Back,
}

/// MIMo without the scene, standing with the arms away from the body.
pub(super) struct Doll {
    scenery: Scenery,
    state: State,
    hip: usize,
    center: Vec3,
    distance: f64,
    size: [usize; 2],
    renderer: CpuRenderer,
}

impl Doll {
    /// Draws MIMo alone, without clothes, so that he fills the picture; returns `None` if there is no MIMo or no camera. MIMo has a face if
    /// its textures are in `assets`.
    pub fn new(model: &Model, assets: &dyn AssetSource) -> Option<Self> {
        let mut doll = Self::posed(model, assets, [WIDTH, HEIGHT], ARMS[0])?;
        for drawable in &mut doll.scenery.drawables {
            let face = |g: usize| FACE.contains(&model.body_name[model.geom_bodyid[g]].as_str());
            if !matches!(drawable.element, Element::Geom(g) if face(g)) {
                drawable.texture = None;
            }
        }
        // the box around MIMo along the axes of the hip
        let frame = doll.state.xmat[doll.hip];
        let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
        for d in &doll.scenery.drawables {
            let Element::Geom(g) = d.element else { continue };
            let at = mat_t_vec(&frame, doll.state.geom_xpos[g]);
            let radius = model.geom_size[g].iter().fold(0.0, |m: f64, s| m.max(*s));
            for k in 0..3 {
                low[k] = low[k].min(at[k] - radius);
                high[k] = high[k].max(at[k] + radius);
            }
        }
        let size = sub(high, low);
        let half_height = size[2].max(size[1] * HEIGHT as f64 / WIDTH as f64) * (0.5 + MARGIN);
        doll.aim(mat_vec(&frame, scale(add(low, high), 0.5)), half_height);
        Some(doll)
    }

    /// Extracts MIMo from a scene in his current pose, with his soles at the lower edge of a picture of `size` (width and height,
    /// pixels) that is `span` m high.
    pub fn dressed(model: &Model, assets: &dyn AssetSource, size: [usize; 2], span: f64) -> Option<Self> {
        let mut doll = Self::posed(model, assets, size, ARMS[1])?;
        let [soles, _] = upright_extent(model, &doll.state, doll.hip);
        let (frame, hip) = (doll.state.xmat[doll.hip], doll.state.xpos[doll.hip]);
        let mut center = mat_t_vec(&frame, hip);
        center[2] = soles + 0.5 * span;
        doll.aim(mat_vec(&frame, center), 0.5 * span);
        Some(doll)
    }

    fn posed(model: &Model, assets: &dyn AssetSource, size: [usize; 2], arms: f64) -> Option<Self> {
        let hip = model.body("hip")?;
        if model.ncam() == 0 {
            return None;
        }
        let scenery = Scenery::new(model, assets).or_else(|_| Scenery::without_textures(model));
        let mut scenery = scenery.ok()?;
        scenery.sky = None;
        let own = |g: usize| model.in_subtree(model.geom_bodyid[g], hip);
        scenery
            .drawables
            .retain(|d| matches!(d.element, Element::Geom(g) if own(g)));
        for drawable in &mut scenery.drawables {
            (drawable.specular, drawable.exponent, drawable.emission) = (0.15, 20.0, 0.0);
        }
        scenery.cameras[0].fovy = FOVY;
        let mut state = State::new(model, &Topology::new(model));
        let shoulders = SHOULDERS.map(|joint| (joint, arms));
        for (joint, angle) in POSTURE.into_iter().chain(shoulders) {
            if let Some(j) = model.joint(&format!("{JOINT_PREFIX}{joint}")) {
                state.qpos[model.jnt_qposadr[j]] = angle;
            }
        }
        kinematics(model, &mut state);
        com_pos(model, &mut state);
        cameras(model, &mut state);
        Some(Self {
            scenery,
            state,
            hip,
            center: [0.0; 3],
            distance: 1.0,
            size,
            renderer: CpuRenderer::new(),
        })
    }

    /// Looks at a point from a distance at which half the picture's height is `half_height` m.
    fn aim(&mut self, center: Vec3, half_height: f64) {
        self.center = center;
        self.distance = half_height / pxfm::f_tan((0.5 * FOVY).to_radians());
        (self.scenery.near, self.scenery.far) = (0.2 * self.distance, 3.0 * self.distance);
    }

    /// Draws a PNG image with a transparent background, each geom in a colour.
    pub fn draw(&mut self, side: DollSide, color: &dyn Fn(usize) -> [f32; 3]) -> Option<Vec<u8>> {
        for drawable in &mut self.scenery.drawables {
            if let Element::Geom(g) = drawable.element {
                let [r, g, b] = match drawable.texture {
                    // a face stays one under its colour
                    Some(_) => color(g).map(|c| 0.5 + 0.5 * c),
                    None => color(g),
                };
                drawable.rgba = [r, g, b, 1.0];
            }
        }
        let [width, height] = self.size;
        png(&self.cut_out(side)?, width, height, ColorType::Rgba).ok()
    }

    /// Draws MIMo in his colours with a transparent background: red, green, blue and opacity.
    pub fn cut_out(&mut self, side: DollSide) -> Option<Vec<u8>> {
        let frame = self.state.xmat[self.hip];
        let turn = if side == DollSide::Front { 1.0 } else { -1.0 };
        let (forward, left, up) = (
            scale(column(&frame, 0), turn),
            scale(column(&frame, 1), turn),
            column(&frame, 2),
        );
        self.state.cam_xpos[0] = add_scaled(self.center, forward, self.distance);
        let columns = [left, up, forward];
        self.state.cam_xmat[0] = std::array::from_fn(|k| columns[k % 3][k / 3]);
        let light = |dir: Vec3, strength: f32| LightSource {
            body: self.hip,
            pos: None,
            dir: unit([turn * dir[0], turn * dir[1], dir[2]]).0,
            aim: LightAim::Body,
            ambient: [0.2; 3],
            diffuse: [strength; 3],
            specular: [0.3; 3],
            attenuation: [1.0, 0.0, 0.0],
            cos_cutoff: -1.0,
            exponent: 0.0,
        };
        self.scenery.headlight = None;
        self.scenery.lights = vec![light([-0.7, -0.5, -0.8], 0.5), light([-0.8, 0.9, -0.2], 0.22)];
        let light = self.picture()?;
        // the same all in white is how much of each pixel is covered
        self.scenery.lights.clear();
        let colors: Vec<_> = self.scenery.drawables.iter().map(|d| (d.rgba, d.texture)).collect();
        for drawable in &mut self.scenery.drawables {
            (drawable.rgba, drawable.emission, drawable.texture) = ([1.0; 4], 1.0, None);
        }
        let cover = self.picture()?;
        for (drawable, color) in self.scenery.drawables.iter_mut().zip(colors) {
            drawable.emission = 0.0;
            (drawable.rgba, drawable.texture) = color;
        }
        Some(cut_out(&light, &cover))
    }

    fn picture(&mut self) -> Option<Vec<u8>> {
        let [width, height] = self.size;
        let view = View {
            camera: 0,
            width,
            height,
        };
        let mut rgb = vec![0; view.rgb_len()];
        let poses = Poses::from(&self.state);
        self.renderer.rgb(&self.scenery, &poses, &view, &mut rgb).ok()?;
        Some(rgb)
    }
}

/// Makes the background of an RGB picture on black transparent; `cover` is the same scene all in white.
fn cut_out(picture: &[u8], cover: &[u8]) -> Vec<u8> {
    let pixels = picture.chunks_exact(3).zip(cover.chunks_exact(3));
    pixels
        .flat_map(|(c, a)| {
            let alpha = u32::from(a[0]);
            let over = |v: u8| (u32::from(v) * 255).checked_div(alpha).unwrap_or(0).min(255) as u8;
            [over(c[0]), over(c[1]), over(c[2]), a[0]]
        })
        .collect()
}
