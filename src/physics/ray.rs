//! Rays against shapes.

use std::ops::Range;

use crate::MAXVAL;
use crate::error::EngineError;
use crate::math::*;
use crate::model::{GeomType, HField, Mesh, Model};
use crate::state::State;
use crate::table::length;

/// A geom that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The geom, by id.
    pub geom: usize,
    /// Distance from the origin of the ray, in lengths of its direction: m for a unit vector.
    pub distance: f64,
}

/// Returns the first geom that a ray meets from `origin` (m) along `direction`, both in the world frame: MuJoCo's `mj_ray`.
///
/// Geoms are where the last [`step`](crate::Engine::step) or [`forward`](crate::Engine::forward) of the state has placed them. As in MuJoCo,
/// invisible geoms are left out (those with an opacity of 0), planes are seen from above only, and a ray that starts inside a geom meets it
/// where it leaves. `without_body` leaves out the geoms of one body, for example that of the sensor. The result is `None` if the
/// direction is shorter than 1e-15, or if a number is not finite or beyond 1e10.
///
/// ```
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::physics::{Engine, SoftEngine, SoftOptions, compile, ray};
///
/// let text = "<mujoco><worldbody><geom type='plane' size='1 1 1'/><geom type='box' size='.1 .1 .1' pos='0 0 .3'/></worldbody></mujoco>";
/// let model = compile(mjcf_sim::mjcf_loader::load_str(text, "boxes.xml", &MemoryAssets::new())?)?;
/// let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
/// let mut state = engine.new_state();
/// engine.forward(&mut state)?;
/// let hit = ray(engine.model(), &state, [0.0, 0.0, 2.0], [0.0, 0.0, -1.0], None)?.ok_or("nothing is there")?;
/// assert_eq!(hit.geom, 1);
/// assert!((hit.distance - 1.6).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The state is of another model.
#[doc(alias = "mj_ray")]
pub fn ray(
    model: &Model,
    state: &State,
    origin: Vec3,
    direction: Vec3,
    without_body: Option<usize>,
) -> Result<Option<RayHit>, EngineError> {
    let expected = model.ngeom();
    length("geom_xpos", state.geom_xpos.len(), expected)?;
    length("geom_xmat", state.geom_xmat.len(), expected)?;
    length("params.geom_size", state.params.geom_size.len(), expected)?;
    length("params.geom_rbound", state.params.geom_rbound.len(), expected)?;
    // squares of greater numbers may overflow; NaN fails the comparison, too
    let usable = |v: Vec3| v.iter().all(|x| x.abs() <= MAXVAL);
    if !usable(origin) || !usable(direction) || norm(direction) < MINVAL {
        return Ok(None);
    }
    Ok(nearest_geom(model, state, origin, direction, without_body))
}

/// Returns the nearest visible geom that a ray meets, leaving out the geoms of one body.
pub(super) fn nearest_geom(
    model: &Model,
    s: &State,
    origin: Vec3,
    direction: Vec3,
    without_body: Option<usize>,
) -> Option<RayHit> {
    let mut nearest: Option<RayHit> = None;
    for g in 0..model.ngeom() {
        // only the material decides; the geom's own opacity does not count
        let opacity = match model.geom_matid[g] {
            Some(material) => model.materials[material].rgba[3],
            None => model.geom_rgba[g][3],
        };
        if Some(model.geom_bodyid[g]) == without_body || opacity == 0.0 {
            continue;
        }
        let (pos, mat, size) = (s.geom_xpos[g], &s.geom_xmat[g], s.params.geom_size[g]);
        let within = || (mat_t_vec(mat, sub(origin, pos)), mat_t_vec(mat, direction));
        let found = match (model.geom_type[g], model.geom_dataid[g]) {
            (GeomType::Mesh, Some(id)) => {
                let radius = s.params.geom_rbound[g];
                let mesh = model.meshes.get(id);
                mesh.and_then(|mesh| ray_mesh(mesh, radius, within()))
            }
            (GeomType::HField, Some(id)) => {
                let fields = model.hfields.get(id..).unwrap_or_default();
                ray_hfield(fields, within())
            }
            _ => ray_shape(model.geom_type[g], size, pos, mat, origin, direction),
        };
        if let Some(distance) = found
            && nearest.is_none_or(|least| distance < least.distance)
        {
            nearest = Some(RayHit { geom: g, distance });
        }
    }
    nearest
}

/// Returns the distance at which a ray meets a shape, in lengths of `direction`; from inside, the distance at which it leaves.
#[doc(alias = "mju_rayGeom")]
pub(super) fn ray_shape(
    kind: GeomType,
    size: Vec3,
    pos: Vec3,
    mat: &Mat3,
    origin: Vec3,
    direction: Vec3,
) -> Option<f64> {
    let (p, v) = (mat_t_vec(mat, sub(origin, pos)), mat_t_vec(mat, direction));
    match kind {
        GeomType::Plane => plane(size, p, v),
        GeomType::Sphere => first(quadratic(dot(v, v), dot(v, p), dot(p, p) - size[0] * size[0])),
        GeomType::Capsule => capsule(size, p, v),
        GeomType::Ellipsoid => {
            let weight = size.map(|r| 1.0 / (r * r));
            let form = |a: Vec3, b: Vec3| (0..3).map(|k| weight[k] * a[k] * b[k]).sum::<f64>();
            first(quadratic(form(v, v), form(v, p), form(p, p) - 1.0))
        }
        GeomType::Cylinder => cylinder(size, p, v),
        GeomType::Box => cuboid(size, p, v),
        // their triangles are with the model, and no site is one
        GeomType::HField | GeomType::Mesh => None,
    }
}

/// Returns the distance at which a ray meets a triangle of a mesh, from either side.
fn ray_mesh(mesh: &Mesh, radius: f64, (p, v): (Vec3, Vec3)) -> Option<f64> {
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - radius * radius))?;
    let basis = across(v);
    let mut nearest = None;
    for corners in &mesh.face {
        let corner = |k: usize| mesh.vert.get(corners[k] as usize).map(|v| sub(v.map(f64::from), p));
        if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2))
            && let Some(x) = ray_triangle([a, b, c], v, &basis)
        {
            keep(&mut nearest, x);
        }
    }
    nearest
}

/// Returns two directions perpendicular to a ray.
fn across(v: Vec3) -> [Vec3; 2] {
    let along = unit(v).0;
    let axis = (0..3).fold(
        0,
        |least, k| if along[k].abs() < along[least].abs() { k } else { least },
    );
    let mut e = [0.0; 3];
    e[axis] = 1.0;
    let across = unit(cross(along, e)).0;
    [across, cross(along, across)]
}

/// Returns the distance at which a ray meets the first of some height fields: its base, a triangle of its surface or a side (MuJoCo's
/// `mj_rayHfield`).
fn ray_hfield(fields: &[HField], (p, v): (Vec3, Vec3)) -> Option<f64> {
    let field = fields.first()?;
    let [x, y, top, base] = field.size;
    let part = |middle: f64, half: f64| sides([x, y, half], [p[0], p[1], p[2] - middle], v);
    let mut nearest = least(&part(-0.5 * base, 0.5 * base));
    let upper = part(0.5 * top, 0.5 * top);
    let Some(enters) = least(&upper) else { return nearest };
    let mut segment = [0.0, enters];
    for &found in upper.iter().flatten() {
        if found > segment[1] {
            segment = [enters, found];
        }
    }
    let steps = [2.0 * x / (field.ncol - 1) as f64, 2.0 * y / (field.nrow - 1) as f64];
    let over = HeightFieldRay {
        field,
        fields,
        p,
        v,
        steps,
    };
    over.surface(segment, &mut nearest);
    over.sides(&upper, &mut nearest);
    nearest
}

/// A ray over the grid of a height field, in the frame of the field.
struct HeightFieldRay<'a> {
    field: &'a HField,
    /// The field and the remaining ones.
    fields: &'a [HField],
    p: Vec3,
    v: Vec3,
    /// Distances of the columns and of the rows, m.
    steps: [f64; 2],
}

impl HeightFieldRay<'_> {
    /// Returns the column (`k` = 0) or row (1) over which the ray is at a distance.
    fn place(&self, k: usize, at: f64) -> f64 {
        (self.p[k] + at * self.v[k] + self.field.size[k]) / self.steps[k]
    }

    /// Returns the columns or rows below a part of the ray, and one more at each end.
    fn range(&self, part: [f64; 2], k: usize, count: usize) -> Range<usize> {
        let [a, b] = part.map(|at| self.place(k, at));
        let last = (count - 1) as f64;
        let first = (a.min(b).floor() - 1.0).clamp(0.0, last) as usize;
        first..(a.max(b).ceil() + 1.0).clamp(0.0, last) as usize
    }

    /// Returns a height, 0 to 1. Beyond the end of the field, MuJoCo 3.3.0 continues into the following fields.
    fn height(&self, place: usize) -> f64 {
        let mut left = place;
        for field in self.fields {
            match field.data.get(left) {
                Some(height) => return f64::from(*height),
                None => left -= field.data.len(),
            }
        }
        0.0
    }

    /// Keeps the nearest triangle that the ray meets in a part of it.
    ///
    /// MuJoCo looks at all squares of the rectangle that the ray crosses; it meets none but those near it, of each row those that it is
    /// over while it is over the row or an adjacent one.
    fn surface(&self, segment: [f64; 2], nearest: &mut Option<f64>) {
        let Self { field, p, v, steps, .. } = *self;
        let over_row = |r: usize| {
            let at = |row: f64| (steps[1] * row - field.size[1] - p[1]) / v[1];
            let (a, b) = (at(r as f64 - 1.0), at(r as f64 + 2.0));
            if v[1] == 0.0 {
                segment
            } else {
                [segment[0].max(a.min(b)), segment[1].min(a.max(b))]
            }
        };
        let corner = |r: usize, c: usize| {
            let [x, y] = [steps[0] * c as f64 - field.size[0], steps[1] * r as f64 - field.size[1]];
            sub([x, y, self.height(r * field.ncol + c) * field.size[2]], p)
        };
        let basis = across(v);
        for r in self.range(segment, 1, field.nrow) {
            let over = over_row(r);
            if over[0] > over[1] {
                continue;
            }
            for c in self.range(over, 0, field.ncol) {
                let (near, far) = (corner(r, c), corner(r + 1, c + 1));
                for third in [corner(r, c + 1), corner(r + 1, c)] {
                    if let Some(x) = ray_triangle([near, far, third], v, &basis) {
                        keep(nearest, x);
                    }
                }
            }
        }
    }

    /// Keeps the nearest side that the ray hits below the edge of the surface; `upper` are the distances of the planes of the sides.
    fn sides(&self, upper: &[Option<f64>; 6], nearest: &mut Option<f64>) {
        let Self { field, p, v, .. } = *self;
        let (rows, columns) = (field.nrow, field.ncol);
        for (side, found) in upper.iter().take(4).enumerate() {
            let Some(found) = found.filter(|found| nearest.is_none_or(|x| *found < x)) else {
                continue;
            };
            let (k, count) = if side < 2 { (1, rows) } else { (0, columns) };
            let at = self.place(k, found);
            let before = at.floor().clamp(0.0, count.saturating_sub(2) as f64);
            let n = before as usize;
            // MuJoCo takes rows for as long as there are rows
            let [low, high] = [n, n + 1].map(|n| match side {
                0 => self.height(n * rows),
                1 => self.height(n * rows + columns - 1),
                2 => self.height(n),
                _ => self.height((rows - 1) * columns + n),
            });
            let edge = low * (before + 1.0 - at) + high * (at - before);
            if (p[2] + found * v[2]) / field.size[2] < edge {
                *nearest = Some(found);
            }
        }
    }
}

/// Returns the distance at which a ray from the origin meets a triangle; `basis` is perpendicular to the ray.
fn ray_triangle([a, b, c]: [Vec3; 3], v: Vec3, basis: &[Vec3; 2]) -> Option<f64> {
    let plane = |p: Vec3| basis.map(|axis| dot(p, axis));
    let (pa, pb, pc) = (plane(a), plane(b), plane(c));
    for k in 0..2 {
        let all = [pa[k], pb[k], pc[k]];
        if all.iter().all(|x| *x > 0.0) || all.iter().all(|x| *x < 0.0) {
            return None;
        }
    }
    // the origin as a mean of the corners
    let (x, y) = ([pa[0] - pc[0], pa[1] - pc[1]], [pb[0] - pc[0], pb[1] - pc[1]]);
    let det = x[0] * y[1] - x[1] * y[0];
    if det.abs() < MINVAL {
        return None;
    }
    let (s, t) = ((y[0] * pc[1] - y[1] * pc[0]) / det, (x[1] * pc[0] - x[0] * pc[1]) / det);
    if s < 0.0 || t < 0.0 || s + t > 1.0 {
        return None;
    }
    let normal = cross(sub(a, c), sub(b, c));
    let slope = dot(v, normal);
    if slope.abs() < MINVAL {
        return None;
    }
    Some(dot(c, normal) / slope).filter(|x| *x >= 0.0)
}

/// Solves `a x^2 + 2 b x + c = 0`: both solutions, ascending.
fn quadratic(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = b * b - a * c;
    if discriminant < MINVAL {
        return None;
    }
    let root = discriminant.sqrt();
    Some([(-b - root) / a, (-b + root) / a])
}

/// Returns the first solution that lies ahead.
fn first(solutions: Option<[f64; 2]>) -> Option<f64> {
    solutions?.into_iter().find(|x| *x >= 0.0)
}

/// Keeps the lesser of two distances.
fn keep(nearest: &mut Option<f64>, x: f64) {
    if nearest.is_none_or(|least| x < least) {
        *nearest = Some(x);
    }
}

fn plane(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    // it is seen from above only
    if v[2] > -MINVAL {
        return None;
    }
    let x = -p[2] / v[2];
    let within = |k: usize| size[k] <= 0.0 || (p[k] + x * v[k]).abs() <= size[k];
    (x >= 0.0 && within(0) && within(1)).then_some(x)
}

/// Returns where a ray meets the round side of a cylinder without ends.
fn round_side(radius: f64, p: Vec3, v: Vec3) -> Option<f64> {
    let a = v[0] * v[0] + v[1] * v[1];
    let b = v[0] * p[0] + v[1] * p[1];
    first(quadratic(a, b, p[0] * p[0] + p[1] * p[1] - radius * radius))
}

fn capsule(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    let reach = size[0] + size[1];
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - reach * reach))?;
    let mut nearest = round_side(size[0], p, v).filter(|x| (p[2] + x * v[2]).abs() <= size[1]);
    for side in [1.0, -1.0] {
        let from = [p[0], p[1], p[2] - side * size[1]];
        let met = quadratic(dot(v, v), dot(v, from), dot(from, from) - size[0] * size[0]);
        for x in met.into_iter().flatten() {
            // the outer half of the cap
            if x >= 0.0 && side * (p[2] + x * v[2]) >= size[1] {
                keep(&mut nearest, x);
            }
        }
    }
    nearest
}

fn cylinder(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    let reach = size[0] * size[0] + size[1] * size[1];
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - reach))?;
    let mut nearest = None;
    if v[2].abs() > MINVAL {
        for side in [-1.0, 1.0] {
            let x = (side * size[1] - p[2]) / v[2];
            let (a, b) = (p[0] + x * v[0], p[1] + x * v[1]);
            if x >= 0.0 && a * a + b * b <= size[0] * size[0] {
                keep(&mut nearest, x);
            }
        }
    }
    if let Some(x) = round_side(size[0], p, v).filter(|x| (p[2] + x * v[2]).abs() <= size[1]) {
        keep(&mut nearest, x);
    }
    nearest
}

fn cuboid(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    least(&sides(size, p, v))
}

/// Returns the smallest distance.
fn least(all: &[Option<f64>]) -> Option<f64> {
    let mut nearest = None;
    all.iter().flatten().for_each(|&x| keep(&mut nearest, x));
    nearest
}

/// Returns where a ray meets the sides of a box: the sides of x, y and z, the lower one first.
fn sides(size: Vec3, p: Vec3, v: Vec3) -> [Option<f64>; 6] {
    let mut all = [None; 6];
    if first(quadratic(dot(v, v), dot(v, p), dot(p, p) - dot(size, size))).is_none() {
        return all;
    }
    for k in (0..3).filter(|&k| v[k].abs() > MINVAL) {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        for (place, side) in [(2 * k, -1.0), (2 * k + 1, 1.0)] {
            let x = (side * size[k] - p[k]) / v[k];
            if x >= 0.0 && (p[i] + x * v[i]).abs() <= size[i] && (p[j] + x * v[j]).abs() <= size[j] {
                all[place] = Some(x);
            }
        }
    }
    all
}
