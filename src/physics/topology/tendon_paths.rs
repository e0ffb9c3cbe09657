//! The paths of spatial tendons, prepared for a step: sites in order, the geoms between them, and the degrees of freedom that move them.

use std::ops::Range;

use super::Topology;
use super::dof_rows::DofRows;
use crate::math::{Vec3, add, norm, quat_rotate, sub};
use crate::model::{Arrays, Wrap};

/// The paths of all tendons.
#[derive(Clone, Debug, Default)]
pub struct TendonPaths {
    /// First leg of each tendon, and one past the last.
    adr: Vec<usize>,
    legs: Vec<PathElement>,
    stretches: Vec<PathSegment>,
    moved: Vec<PathDof>,
}

/// An element of a path.
#[derive(Clone, Copy, Debug)]
enum PathElement {
    /// A pulley.
    Pulley,
    /// A segment from one site to another, by its index.
    Sites(usize),
}

/// A part of a path between two sites.
#[derive(Clone, Debug)]
pub struct PathSegment {
    pub sites: [usize; 2],
    /// Factor of its length.
    pub share: f64,
    /// The straight line from one site to the other.
    pub straight: StraightSegment,
    pub between: SegmentKind,
    /// Whether the path ends at the second site or continues after a pulley.
    pub ends: bool,
}

/// The course of a path between two sites.
#[derive(Clone, Debug)]
pub enum SegmentKind {
    /// A straight line.
    Nothing,
    /// A straight line of constant length, m: no degree of freedom moves the sites relative to each other.
    Constant(f64),
    /// A geom that may be in the way.
    Geom(Obstacle),
}

/// A geom between two sites.
#[derive(Clone, Debug)]
pub struct Obstacle {
    pub geom: usize,
    /// A site on whose side the tendon stays.
    pub side: Option<usize>,
    pub cylinder: bool,
    /// From the first site to the geom, and from there to the second one.
    pub spans: [StraightSegment; 2],
}

/// A straight part between points of two bodies.
#[derive(Clone, Debug)]
pub struct StraightSegment {
    /// The roots of the trees of both bodies.
    pub roots: [usize; 2],
    /// Degrees of freedom that move the first body and not the second.
    first: Range<usize>,
    /// Degrees of freedom that move the second body and not the first.
    second: Range<usize>,
    /// Whether anything moves at least one of the bodies.
    pub moves: bool,
}

/// A degree of freedom, and its place in the row of the tendon.
#[derive(Clone, Copy, Debug)]
pub struct PathDof {
    pub dof: u32,
    pub place: u32,
}

impl TendonPaths {
    /// Derives the paths of a model. `rows` are the degrees of freedom of each tendon.
    pub fn new(model: &Arrays, topology: &Topology, rows: &DofRows) -> Self {
        let mut all = Self::default();
        all.adr.push(0);
        for t in 0..model.ntendon() {
            if model.tendon_is_spatial(t) {
                all.add(model, topology, &model.tendon_wrap[t], rows.row(t));
            }
            all.adr.push(all.legs.len());
        }
        all
    }

    /// Adds a path, whose tendon depends on `dofs`.
    fn add(&mut self, model: &Arrays, topology: &Topology, path: &[Wrap], dofs: &[u32]) {
        let mut divisor = 1.0;
        let mut k = 0;
        while k + 1 < path.len() {
            if let Wrap::Pulley { divisor: next } = path[k] {
                divisor = next;
                self.legs.push(PathElement::Pulley);
            }
            let (first, between, second) = match (&path[k], &path[k + 1], path.get(k + 2)) {
                (Wrap::Site { site: first }, Wrap::Site { site }, _) => (*first, None, *site),
                (Wrap::Site { site: first }, Wrap::Sphere { geom, side }, Some(Wrap::Site { site })) => {
                    (*first, Some((*geom, *side, false)), *site)
                }
                (Wrap::Site { site: first }, Wrap::Cylinder { geom, side }, Some(Wrap::Site { site })) => {
                    (*first, Some((*geom, *side, true)), *site)
                }
                // a pulley, or the last site before one
                _ => {
                    k += 1;
                    continue;
                }
            };
            k += if between.is_some() { 2 } else { 1 };
            let [a, b] = [first, second].map(|site| model.site_bodyid[site]);
            let straight = self.span(model, topology, [a, b], dofs);
            let between = match between {
                Some((geom, side, cylinder)) => {
                    let body = model.geom_bodyid[geom];
                    let spans = [[a, body], [body, b]].map(|bodies| self.span(model, topology, bodies, dofs));
                    SegmentKind::Geom(Obstacle {
                        geom,
                        side,
                        cylinder,
                        spans,
                    })
                }
                None => rigid_distance(model, [first, second]).map_or(SegmentKind::Nothing, SegmentKind::Constant),
            };
            self.legs.push(PathElement::Sites(self.stretches.len()));
            self.stretches.push(PathSegment {
                sites: [first, second],
                share: 1.0 / divisor,
                straight,
                between,
                ends: matches!(path.get(k + 1), None | Some(Wrap::Pulley { .. })),
            });
        }
    }

    /// Adds the degrees of freedom that change the distance of two bodies.
    fn span(&mut self, model: &Arrays, topology: &Topology, bodies: [usize; 2], dofs: &[u32]) -> StraightSegment {
        let [a, b] = bodies;
        let (first, second) = topology.apart(a, b);
        let mut add = |chain: &[u32]| {
            let start = self.moved.len();
            let place = |dof: u32| dofs.partition_point(|&other| other < dof) as u32;
            let moved = chain.iter().map(|&dof| PathDof { dof, place: place(dof) });
            self.moved.extend(moved);
            start..self.moved.len()
        };
        StraightSegment {
            roots: bodies.map(|body| model.body_rootid[body]),
            first: add(first),
            second: add(second),
            moves: a != b && bodies.iter().any(|&body| !topology.body_chain(body).is_empty()),
        }
    }

    /// Iterates over the path of a spatial tendon; `None` is a pulley.
    #[inline]
    pub fn path(&self, tendon: usize) -> impl Iterator<Item = Option<&PathSegment>> {
        let legs = &self.legs[self.adr[tendon]..self.adr[tendon + 1]];
        legs.iter().map(|leg| match *leg {
            PathElement::Pulley => None,
            PathElement::Sites(k) => Some(&self.stretches[k]),
        })
    }

    /// Returns the degrees of freedom that move only the first end of a span, and those that move only the second.
    #[inline]
    pub fn apart(&self, span: &StraightSegment) -> [&[PathDof]; 2] {
        [&self.moved[span.first.clone()], &self.moved[span.second.clone()]]
    }
}

/// Returns the distance of two sites of one body, or of bodies that are fixed to each other, m.
fn rigid_distance(model: &Arrays, sites: [usize; 2]) -> Option<f64> {
    let [(a, at_a), (b, at_b)] = sites.map(|site| carried(model, site));
    (a == b).then(|| norm(sub(at_b, at_a)))
}

/// Returns the body that moves a site, by its joints or because a program moves it, and the position of the site in its frame.
fn carried(model: &Arrays, site: usize) -> (usize, Vec3) {
    let (mut body, mut pos) = (model.site_bodyid[site], model.site_pos[site]);
    while body > 0 && model.body_jntnum[body] == 0 && model.body_mocapid[body].is_none() {
        pos = add(model.body_pos[body], quat_rotate(model.body_quat[body], pos));
        body = model.body_parentid[body];
    }
    (body, pos)
}

#[cfg(test)]
mod tests {
    use crate::assets::MemoryAssets;
    use crate::math::{norm, sub};
    use crate::mjcf_loader::load_str;
    use crate::{Engine, SoftEngine, SoftOptions, compile};

    #[test]
    fn lengths_are_those_between_sites_whatever_carries_them() {
        // one body, two that are fixed to each other, a moving one, a pulley, and one that a program moves
        let text = r#"<mujoco><worldbody><site name="a" pos="1 0 0"/><body pos="0 1 0" euler="0 0 30"><site name="b" pos=".2 0 0"/></body>
            <body pos="0 0 1"><joint axis="0 1 0"/><geom size=".1"/><site name="c"/><site name="d" pos=".1 .2 .3"/>
              <body pos=".1 0 0" euler="40 0 0"><site name="e" pos="0 .3 0"/></body></body>
            <body name="hand" mocap="true" pos="0 0 2"><site name="f"/></body></worldbody>
            <tendon><spatial><site site="a"/><site site="b"/><site site="c"/><site site="d"/><site site="e"/><pulley divisor="2"/>
            <site site="e"/><site site="f"/></spatial></tendon></mujoco>"#;
        let model = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
        let mut engine = SoftEngine::new(model.expect("valid").into(), SoftOptions::default());
        let mut s = engine.new_state();
        for turn in [0.0, 0.7] {
            (s.qpos[0], s.mocap_pos[0][0]) = (turn, turn);
            engine.forward(&mut s).expect("finite");
            let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|site| s.site_xpos[site]);
            let parts = [(a, b), (b, c), (c, d), (d, e)].map(|(from, to)| norm(sub(to, from)));
            let expected = parts.iter().sum::<f64>() + 0.5 * norm(sub(f, e));
            assert!(
                (s.ten_length[0] - expected).abs() < 1e-14,
                "{turn}: {} {expected}",
                s.ten_length[0]
            );
        }
    }
}
