//! Contacts of flexes: with geoms, with each other and with themselves, in MuJoCo's order.

use super::boxes::OrientedBox;
use super::pairs::{ContactMaterial, mixed};
use super::placed;
use crate::contact::{
    ContactOptions, ContactPoint, FlexPart, Scratch, element_element, frame, geom_element, vertex_element,
};
use crate::detected::{Contact, ContactSide, FlexContact};
use crate::error::{EngineError, within};
use crate::limits::Limits;
use crate::math::*;
use crate::model::{Flex, FlexSelfCollide, GeomType, Model};
use crate::state::State;

/// Maximum number of pairs of elements that sweep and prune finds in a flex, as in MuJoCo.
const MOST_PAIRS: usize = 1_000_000;

/// Detection of flex contacts, with all working memory.
#[derive(Clone, Debug, Default)]
pub struct FlexSweep {
    /// Boxes around all elements, of one flex after another: centre and half sizes, m.
    boxes: Vec<[f64; 6]>,
    /// The first element of each flex.
    first: Vec<usize>,
    /// The box around all elements of each flex that take part.
    whole: Vec<[f64; 6]>,
    points: Vec<ContactPoint>,
    /// Ends of the boxes of elements along an axis: coordinate, number of the end, which is even for lower ends.
    ends: Vec<(f32, u32)>,
    active: Vec<u32>,
    pairs: Vec<[u32; 2]>,
}

/// Returns whether boxes, given by centres and half sizes, are farther apart along an axis than a margin.
fn boxes_apart(a: &[f64; 6], b: &[f64; 6], margin: f64) -> bool {
    (0..3).any(|k| a[k] + a[k + 3] + margin < b[k] - b[k + 3] || b[k] + b[k + 3] + margin < a[k] - a[k + 3])
}

/// Returns whether a ball, treated as a cube, is outside a box.
fn ball_apart(centre: Vec3, radius: f64, b: &[f64; 6]) -> bool {
    (0..3).any(|k| centre[k] + radius < b[k] - b[k + 3] || centre[k] - radius > b[k] + b[k + 3])
}

/// Returns the smallest box around two boxes.
fn joined(a: &[f64; 6], b: &[f64; 6]) -> [f64; 6] {
    let low = |k: usize| (a[k] - a[k + 3]).min(b[k] - b[k + 3]);
    let high = |k: usize| (a[k] + a[k + 3]).max(b[k] + b[k + 3]);
    std::array::from_fn(|k| match k {
        0..3 => 0.5 * (low(k) + high(k)),
        _ => 0.5 * (high(k - 3) - low(k - 3)),
    })
}

/// Returns whether an element takes part in contacts with others.
fn is_active(flex: &Flex, element: usize) -> bool {
    flex.dim < 3 || i64::try_from(flex.elemlayer[element]).is_ok_and(|layer| layer < i64::from(flex.activelayers))
}

/// Two sides of contacts, with everything that is the same for all of these contacts.
struct FlexPair<'a> {
    model: &'a Model,
    options: &'a ContactOptions,
    scratch: &'a mut Scratch,
    margin: f64,
    template: Contact,
    after: usize,
}

/// Adds a contact, given by its sides, distance, position and frame.
fn add(s: &mut State, pair: &FlexPair, sides: [ContactSide; 2], point: &ContactPoint) {
    let &ContactPoint { dist, pos, frame } = point;
    s.flex_contact.push(FlexContact {
        sides,
        contact: Contact {
            dist,
            pos,
            frame,
            ..pair.template
        },
        after: pair.after,
    });
}

impl FlexSweep {
    /// Fills `s.flex_contact`, once `s.contact` is filled.
    ///
    /// # Errors
    /// More contacts than [`Limits`] allow by default.
    #[inline(never)]
    pub fn contacts(
        &mut self,
        model: &Model,
        options: &ContactOptions,
        scratch: &mut Scratch,
        s: &mut State,
    ) -> Result<(), EngineError> {
        s.flex_contact.clear();
        self.place(model, s);
        for b in 0..model.nbody() {
            if model.body_geomnum[b] == 0 {
                continue;
            }
            let lower = |c: &Contact| model.geom_bodyid[c.geom[0]].min(model.geom_bodyid[c.geom[1]]);
            let after = s.contact.partition_point(|c| lower(c) <= b);
            for f in 0..model.nflex() {
                self.body_flex(model, options, scratch, s, (b, f, after));
                within(
                    Limits::DEFAULT.contacts,
                    s.flex_contact.len(),
                    "contacts of flexes",
                    s.step,
                )?;
            }
        }
        for f in 0..model.nflex() {
            for other in f + 1..model.nflex() {
                self.flex_flex(model, options, scratch, s, [f, other]);
                within(
                    Limits::DEFAULT.contacts,
                    s.flex_contact.len(),
                    "contacts of flexes",
                    s.step,
                )?;
            }
        }
        for f in 0..model.nflex() {
            let flex = &model.flexes[f];
            if flex.rigid || flex.contype & flex.conaffinity == 0 {
                continue;
            }
            if flex.internal {
                self.internal(model, options, scratch, s, f);
            }
            if flex.selfcollide != FlexSelfCollide::None {
                self.select_pairs(model, f);
                self.flex_pairs(model, options, scratch, s, [f, f]);
            }
            within(
                Limits::DEFAULT.contacts,
                s.flex_contact.len(),
                "contacts of flexes",
                s.step,
            )?;
        }
        Ok(())
    }

    /// Computes the boxes around elements and flexes.
    fn place(&mut self, model: &Model, s: &State) {
        self.boxes.clear();
        self.first.clear();
        self.whole.clear();
        for flex in &model.flexes {
            let first = self.boxes.len();
            self.first.push(first);
            let places = &s.flexvert_xpos[flex.vertadr..];
            let mut whole: Option<[f64; 6]> = None;
            for e in 0..flex.nelem() {
                let mut points = flex.element(e).iter().map(|&v| places[v]);
                let start = points.next().unwrap_or_default();
                let (low, high) = points.fold((start, start), |(low, high), point| {
                    (
                        std::array::from_fn::<f64, 3, _>(|k| low[k].min(point[k])),
                        std::array::from_fn::<f64, 3, _>(|k| high[k].max(point[k])),
                    )
                });
                let own = std::array::from_fn(|k| match k {
                    0..3 => 0.5 * (high[k] + low[k]),
                    _ => 0.5 * (high[k - 3] - low[k - 3]) + flex.radius,
                });
                self.boxes.push(own);
                if is_active(flex, e) || !model.opt.flags.midphase {
                    whole = Some(whole.map_or(own, |whole| joined(&whole, &own)));
                }
            }
            self.whole.push(whole.unwrap_or_default());
        }
    }

    /// Returns the box around an element.
    fn own(&self, flex: usize, element: usize) -> &[f64; 6] {
        &self.boxes[self.first[flex] + element]
    }

    /// Adds the contacts of the geoms of a body and a flex.
    fn body_flex(
        &mut self,
        model: &Model,
        options: &ContactOptions,
        scratch: &mut Scratch,
        s: &mut State,
        (b, f, after): (usize, usize, usize),
    ) {
        let flex = &model.flexes[f];
        let geoms = model.body_geomadr[b]..model.body_geomadr[b] + model.body_geomnum[b];
        let meets =
            |g: usize| model.geom_contype[g] & flex.conaffinity != 0 || flex.contype & model.geom_conaffinity[g] != 0;
        // bits of all geoms together let planes through, as in MuJoCo's tree of boxes
        let bits = |array: &[u32]| array[geoms.clone()].iter().fold(0, |all, bits| all | bits);
        if bits(&model.geom_contype) & flex.conaffinity == 0 && flex.contype & bits(&model.geom_conaffinity) == 0 {
            return;
        }
        let midphase = model.opt.flags.midphase;
        let material = ContactMaterial::of_flex(flex);
        for g in geoms {
            let margin = model.geom_margin[g].max(flex.margin);
            let plane = model.geom_type[g] == GeomType::Plane;
            let taken = if plane && midphase {
                model.body_weldid[b] == 0
            } else {
                meets(g)
            };
            let reach = s.params.geom_rbound[g] + margin;
            if !taken || !plane && ball_apart(s.geom_xpos[g], reach, &self.whole[f]) {
                continue;
            }
            let mut pair = FlexPair {
                model,
                options,
                scratch,
                margin,
                template: mixed(&ContactMaterial::of_geom(model, g), &material),
                after,
            };
            if plane {
                plane_flex(&pair, s, (g, f));
            } else {
                self.geom_flex(&mut pair, s, (g, f), reach);
            }
        }
    }

    /// Adds the contacts of a geom, anything but a plane, and the elements of a flex.
    fn geom_flex(&mut self, pair: &mut FlexPair, s: &mut State, (g, f): (usize, usize), reach: f64) {
        let model = pair.model;
        let (flex, body, midphase) = (&model.flexes[f], model.geom_bodyid[g], model.opt.flags.midphase);
        // boxes are those of the model
        let boxed = midphase && s.params.geom_size[g] == model.geom_size[g];
        for e in 0..flex.nelem() {
            let own = &self.boxes[self.first[f] + e];
            if midphase && !is_active(flex, e) || ball_apart(s.geom_xpos[g], reach, own) {
                continue;
            }
            if flex.element(e).iter().any(|&v| flex.vertbodyid[v] == body) {
                continue;
            }
            if boxed {
                let around = OrientedBox::placed(&model.geom_aabb[g], s.geom_xpos[g], &s.geom_xmat[g]);
                if around.apart(&OrientedBox::placed(own, [0.0; 3], &MAT3_ID), pair.margin) {
                    continue;
                }
            }
            let part = element(flex, s, e);
            self.points.clear();
            geom_element(
                &placed(model, s, g),
                &part,
                pair.margin,
                pair.options,
                pair.scratch,
                &mut self.points,
            );
            let sides = [ContactSide::Geom(g), ContactSide::Element { flex: f, element: e }];
            self.points.iter().for_each(|point| add(s, pair, sides, point));
        }
    }

    /// Adds the contacts of two flexes.
    fn flex_flex(
        &mut self,
        model: &Model,
        options: &ContactOptions,
        scratch: &mut Scratch,
        s: &mut State,
        flexes: [usize; 2],
    ) {
        let [a, b] = flexes.map(|f| &model.flexes[f]);
        if a.contype & b.conaffinity == 0 && b.contype & a.conaffinity == 0 {
            return;
        }
        let margin = a.margin.max(b.margin);
        self.pairs.clear();
        if boxes_apart(&self.whole[flexes[0]], &self.whole[flexes[1]], margin) {
            return;
        }
        let takes_part = |flex: &Flex, e: usize| !model.opt.flags.midphase || is_active(flex, e);
        for e1 in (0..a.nelem()).filter(|&e| takes_part(a, e)) {
            if boxes_apart(self.own(flexes[0], e1), &self.whole[flexes[1]], margin) {
                continue;
            }
            self.pairs.extend(
                (0..b.nelem())
                    .filter(|&e| takes_part(b, e))
                    .map(|e2| [e1 as u32, e2 as u32]),
            );
        }
        self.flex_pairs(model, options, scratch, s, flexes);
    }

    /// Adds the contacts of the selected pairs of elements of two flexes, or of one with itself.
    fn flex_pairs(
        &mut self,
        model: &Model,
        options: &ContactOptions,
        scratch: &mut Scratch,
        s: &mut State,
        flexes: [usize; 2],
    ) {
        let [a, b] = flexes.map(|f| &model.flexes[f]);
        let itself = flexes[0] == flexes[1];
        // margins would let a flex touch itself all the time
        let margin = if itself { 0.0 } else { a.margin.max(b.margin) };
        let mut template = mixed(&ContactMaterial::of_flex(a), &ContactMaterial::of_flex(b));
        if itself {
            template.includemargin = 0.0;
        }
        let pair = FlexPair {
            model,
            options,
            scratch,
            margin,
            template,
            after: s.contact.len(),
        };
        for k in 0..self.pairs.len() {
            let [e1, e2] = self.pairs[k].map(|e| e as usize);
            if boxes_apart(self.own(flexes[0], e1), self.own(flexes[1], e2), margin) {
                continue;
            }
            let bodies =
                |flex: &Flex, e: usize, body: usize| flex.element(e).iter().any(|&v| flex.vertbodyid[v] == body);
            if a.element(e1).iter().any(|&v| bodies(b, e2, a.vertbodyid[v])) {
                continue;
            }
            self.points.clear();
            let (first, second) = (element(a, s, e1), element(b, s, e2));
            element_element(&first, &second, margin, options, pair.scratch, &mut self.points);
            let [f1, f2] = flexes;
            let sides = [
                ContactSide::Element { flex: f1, element: e1 },
                ContactSide::Element { flex: f2, element: e2 },
            ];
            self.points.iter().for_each(|point| add(s, &pair, sides, point));
        }
    }

    /// Selects the pairs of elements of a flex that may touch each other. As in MuJoCo, sweep and prune decides their order; where MuJoCo traverses
    /// its tree of boxes, pairs are ordered by their elements.
    fn select_pairs(&mut self, model: &Model, f: usize) {
        let flex = &model.flexes[f];
        let sweeps = match flex.selfcollide {
            FlexSelfCollide::None | FlexSelfCollide::Narrow | FlexSelfCollide::Bvh => false,
            FlexSelfCollide::Sap => true,
            FlexSelfCollide::Auto => flex.dim < 3,
        };
        self.pairs.clear();
        let first = self.first[f];
        if sweeps && model.opt.flags.midphase {
            return self.sweep(flex, f);
        }
        for e1 in (0..flex.nelem()).filter(|&e| is_active(flex, e)) {
            let own = self.boxes[first + e1];
            let near = |e2: &usize| is_active(flex, *e2) && !boxes_apart(&own, &self.boxes[first + e2], 0.0);
            let others = (e1 + 1..flex.nelem()).filter(near);
            self.pairs.extend(others.map(|e2| [e1 as u32, e2 as u32]));
        }
    }

    /// Finds pairs of elements by sweep and prune along the longest axis of the flex, in single precision, as MuJoCo does.
    #[doc(alias = "mj_SAP")]
    fn sweep(&mut self, flex: &Flex, f: usize) {
        let [_, _, _, x, y, z] = self.whole[f];
        let axis = if x > y && x > z {
            0
        } else if y > z {
            1
        } else {
            2
        };
        let first = self.first[f];
        self.ends.clear();
        for e in (0..flex.nelem()).filter(|&e| is_active(flex, e)) {
            let own = &self.boxes[first + e];
            let end = |side: f64| (own[axis] + side * own[axis + 3]) as f32 + 0.0;
            self.ends.push((end(-1.0), 2 * e as u32));
            self.ends.push((end(1.0), 2 * e as u32 + 1));
        }
        self.ends
            .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let [a, b] = [[1, 2], [0, 2], [0, 1]][axis];
        let (low, high) = (
            |own: &[f64; 6], k: usize| own[k] - own[k + 3],
            |own: &[f64; 6], k: usize| own[k] + own[k + 3],
        );
        self.active.clear();
        for &(_, end) in &self.ends {
            let e = end / 2;
            if end % 2 == 1 {
                self.active.retain(|other| *other != e);
                continue;
            }
            let own = &self.boxes[first + e as usize];
            for &other in &self.active {
                let box1 = &self.boxes[first + other as usize];
                let apart = [a, b]
                    .iter()
                    .any(|&k| low(box1, k) > high(own, k) || low(own, k) > high(box1, k));
                if !apart {
                    self.pairs.push([other, e]);
                    if self.pairs.len() >= MOST_PAIRS {
                        return;
                    }
                }
            }
            self.active.push(e);
        }
    }

    /// Adds the contacts of elements with vertices of their neighbours, and those of flat tetrahedra with their own.
    #[doc(alias = "mj_collideFlexInternal")]
    fn internal(&mut self, model: &Model, options: &ContactOptions, scratch: &mut Scratch, s: &mut State, f: usize) {
        let flex = &model.flexes[f];
        let material = ContactMaterial::of_flex(flex);
        let mut template = mixed(&material, &material);
        template.includemargin = 0.0;
        let mut pair = FlexPair {
            model,
            options,
            scratch,
            margin: 0.0,
            template,
            after: s.contact.len(),
        };
        for &[e, vertex] in &flex.evpair {
            let place = s.flexvert_xpos[flex.vertadr + vertex];
            if ball_apart(place, flex.margin + flex.radius, self.own(f, e)) {
                continue;
            }
            self.points.clear();
            let ball = FlexPart::new(std::iter::once(place), flex.radius);
            vertex_element(&ball, &element(flex, s, e), options, pair.scratch, &mut self.points);
            let sides = [
                ContactSide::Vertex { flex: f, vertex },
                ContactSide::Element { flex: f, element: e },
            ];
            self.points.iter().for_each(|point| add(s, &pair, sides, point));
        }
        pair.template.dim = 1;
        for e in (0..flex.nelem()).filter(|_| flex.dim == 3) {
            for [a, b, c, other] in [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 3, 2, 0]] {
                let vertices = flex.element(e);
                let [a, b, c, d] = [a, b, c, other].map(|k: usize| s.flexvert_xpos[flex.vertadr + vertices[k]]);
                if let Some(point) = flattened([a, b, c], d, flex.radius) {
                    let vertex = vertices[other];
                    let sides = [
                        ContactSide::Element { flex: f, element: e },
                        ContactSide::Vertex { flex: f, vertex },
                    ];
                    add(s, &pair, sides, &point);
                }
            }
        }
    }
}

/// Returns the shape of an element.
fn element(flex: &Flex, s: &State, e: usize) -> FlexPart {
    let points = flex.element(e).iter().map(|&v| s.flexvert_xpos[flex.vertadr + v]);
    FlexPart::new(points, flex.radius)
}

/// Adds the contacts of a plane and the vertices of a flex.
#[doc(alias = "mj_collidePlaneFlex")]
fn plane_flex(pair: &FlexPair, s: &mut State, (g, f): (usize, usize)) {
    let flex = &pair.model.flexes[f];
    let (normal, centre) = (column(&s.geom_xmat[g], 2), s.geom_xpos[g]);
    for vertex in 0..flex.vert.len() {
        let place = s.flexvert_xpos[flex.vertadr + vertex];
        let height = dot(sub(place, centre), normal);
        if height > pair.margin + flex.radius {
            continue;
        }
        let dist = height - flex.radius;
        let point = ContactPoint {
            dist,
            pos: add_scaled(place, normal, -dist * 0.5 - flex.radius),
            frame: frame::from_normal(normal),
        };
        let sides = [ContactSide::Geom(g), ContactSide::Vertex { flex: f, vertex }];
        add(s, pair, sides, &point);
    }
}

/// Returns the contact of a face of a tetrahedron with the corner opposite, which is on the wrong side of it or nearly.
fn flattened([a, b, c]: [Vec3; 3], other: Vec3, radius: f64) -> Option<ContactPoint> {
    let normal = unit(cross(sub(b, a), sub(c, a))).0;
    let height = dot(sub(other, a), normal);
    (height > -2.0 * radius).then(|| ContactPoint {
        dist: -height - 2.0 * radius,
        pos: add_scaled(other, normal, -0.5 * height),
        frame: frame::from_normal(scale(normal, -1.0)),
    })
}
