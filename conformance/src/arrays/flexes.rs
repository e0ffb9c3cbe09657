//! Flexes.

use babybench::Model;
use babybench::model::{Flex, FlexSelfCollide};

use super::Named;

/// Returns the arrays of flexes.
pub fn of_flexes(m: &Model) -> Named {
    let each = |of: fn(&Flex) -> f64| m.flexes.iter().map(of).collect::<Vec<_>>();
    let all = |of: fn(&Flex) -> Vec<f64>| m.flexes.iter().flat_map(of).collect::<Vec<_>>();
    let adr = |of: fn(&Flex) -> usize| {
        let ends = m.flexes.iter().scan(0, |end, flex| {
            let first = *end;
            *end += of(flex);
            Some(if of(flex) == 0 { -1.0 } else { first as f64 })
        });
        ends.collect::<Vec<_>>()
    };
    vec![
        ("nflex", vec![m.nflex() as f64]),
        ("nflexvert", vec![m.nflexvert() as f64]),
        ("nflexedge", vec![m.nflexedge() as f64]),
        ("flex_contype", each(|f| f64::from(f.contype.cast_signed()))),
        ("flex_conaffinity", each(|f| f64::from(f.conaffinity.cast_signed()))),
        ("flex_condim", each(|f| f.condim as f64)),
        ("flex_priority", each(|f| f64::from(f.priority))),
        ("flex_solmix", each(|f| f.solmix)),
        ("flex_solref", all(|f| f.solref.to_vec())),
        ("flex_solimp", all(|f| f.solimp.to_vec())),
        ("flex_friction", all(|f| f.friction.to_vec())),
        ("flex_margin", each(|f| f.margin)),
        ("flex_gap", each(|f| f.gap)),
        ("flex_internal", each(|f| f64::from(f.internal))),
        (
            "flex_selfcollide",
            each(|f| match f.selfcollide {
                FlexSelfCollide::None => 0.0,
                FlexSelfCollide::Narrow => 1.0,
                FlexSelfCollide::Bvh => 2.0,
                FlexSelfCollide::Sap => 3.0,
                FlexSelfCollide::Auto => 4.0,
            }),
        ),
        ("flex_activelayers", each(|f| f64::from(f.activelayers))),
        ("flex_dim", each(|f| f.dim as f64)),
        ("flex_matid", each(|f| f.material.map_or(-1.0, |m| m as f64))),
        ("flex_group", each(|f| f64::from(f.group))),
        ("flex_interp", each(|_| 0.0)),
        ("flex_vertadr", each(|f| f.vertadr as f64)),
        ("flex_vertnum", each(|f| f.vert.len() as f64)),
        ("flex_edgeadr", each(|f| f.edgeadr as f64)),
        ("flex_edgenum", each(|f| f.edge.len() as f64)),
        ("flex_elemadr", adr(Flex::nelem)),
        ("flex_elemnum", each(|f| f.nelem() as f64)),
        ("flex_elemdataadr", adr(|f| f.elem.len())),
        ("flex_elemedgeadr", adr(|f| f.elemedge.len())),
        ("flex_shellnum", each(|f| (f.shell.len() / f.dim) as f64)),
        ("flex_shelldataadr", adr(|f| f.shell.len())),
        ("flex_evpairadr", adr(|f| f.evpair.len())),
        ("flex_evpairnum", each(|f| f.evpair.len() as f64)),
        ("flex_texcoordadr", adr(|f| f.texcoord.len())),
        ("flex_vertbodyid", all(|f| super::ids(&f.vertbodyid))),
        ("flex_edge", all(|f| super::ids(f.edge.as_flattened()))),
        ("flex_elem", all(|f| super::ids(&f.elem))),
        ("flex_elemedge", all(|f| super::ids(&f.elemedge))),
        ("flex_elemlayer", all(|f| super::ids(&f.elemlayer))),
        ("flex_shell", all(|f| super::ids(&f.shell))),
        ("flex_evpair", all(|f| super::ids(f.evpair.as_flattened()))),
        ("flex_vert", all(|f| super::flat(&f.vert))),
        ("flexedge_length0", all(|f| f.edge_length0.clone())),
        ("flex_radius", each(|f| f.radius)),
        (
            "flex_stiffness",
            all(|f| {
                if f.stiffness.is_empty() {
                    vec![0.0; 21 * f.nelem()]
                } else {
                    super::flat(&f.stiffness)
                }
            }),
        ),
        ("flex_damping", each(|f| f.damping)),
        ("flex_edgestiffness", each(|f| f.edgestiffness)),
        ("flex_edgedamping", each(|f| f.edgedamping)),
        ("flex_edgeequality", each(|f| f64::from(f.edgeequality))),
        ("flex_rigid", each(|f| f64::from(f.rigid))),
        ("flexedge_rigid", all(|f| super::flags(&f.edge_rigid))),
        ("flex_centered", each(|f| f64::from(f.centered))),
        ("flex_flatskin", each(|f| f64::from(f.flatskin))),
        ("flex_rgba", all(|f| f.rgba.to_vec())),
        (
            "flex_texcoord",
            all(|f| f.texcoord.as_flattened().iter().map(|&x| f64::from(x)).collect()),
        ),
    ]
}
