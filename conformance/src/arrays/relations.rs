//! Contact pairs, equalities, tendons and sensors.

use babybench::Model;
use babybench::model::{EqualityKind, Wrap};

use super::{Named, flags, flat, ids, optional};

pub(super) fn of_contacts(m: &Model) -> Named {
    vec![
        ("pair_geom1", m.pair_geom.iter().map(|g| g[0] as f64).collect()),
        ("pair_geom2", m.pair_geom.iter().map(|g| g[1] as f64).collect()),
        ("pair_dim", ids(&m.pair_dim)),
        ("pair_solref", flat(&m.pair_solref)),
        ("pair_solreffriction", flat(&m.pair_solreffriction)),
        ("pair_solimp", flat(&m.pair_solimp)),
        ("pair_friction", flat(&m.pair_friction)),
        ("pair_margin", m.pair_margin.clone()),
        ("pair_gap", m.pair_gap.clone()),
        (
            "exclude_signature",
            m.exclude.iter().map(|[a, b]| ((a << 16) + b) as f64).collect(),
        ),
    ]
}

pub(super) fn of_equalities(m: &Model) -> Named {
    let rows: Vec<_> = m.eq_kind.iter().map(EqualityKind::numbers).collect();
    let id = |k: usize| rows.iter().map(|(ids, _)| f64::from(ids[k])).collect();
    vec![
        ("eq_type", id(0)),
        ("eq_obj1id", id(2)),
        ("eq_obj2id", id(3)),
        ("eq_data", rows.iter().flat_map(|(_, data)| *data).collect()),
        ("eq_active0", flags(&m.eq_active0)),
        ("eq_solref", flat(&m.eq_solref)),
        ("eq_solimp", flat(&m.eq_solimp)),
    ]
}

pub(super) fn of_tendons(m: &Model) -> Named {
    let wraps: Vec<[f64; 3]> = m.tendon_wrap.iter().flatten().map(wrap).collect();
    let starts = m.tendon_wrap.iter().scan(0, |next, wrap| {
        *next += wrap.len();
        Some((*next - wrap.len()) as f64)
    });
    vec![
        ("tendon_adr", starts.collect()),
        (
            "tendon_num",
            m.tendon_wrap.iter().map(|wrap| wrap.len() as f64).collect(),
        ),
        ("tendon_limited", flags(&m.tendon_limited)),
        ("tendon_range", flat(&m.tendon_range)),
        ("tendon_margin", m.tendon_margin.clone()),
        ("tendon_solref_lim", flat(&m.tendon_solref_lim)),
        ("tendon_solimp_lim", flat(&m.tendon_solimp_lim)),
        ("tendon_lengthspring", flat(&m.tendon_lengthspring)),
        ("tendon_stiffness", m.tendon_stiffness.clone()),
        ("tendon_damping", m.tendon_damping.clone()),
        ("wrap_objid", wraps.iter().map(|wrap| wrap[1]).collect()),
        ("wrap_prm", wraps.iter().map(|wrap| wrap[2]).collect()),
    ]
}

/// Returns MuJoCo's type, object and parameter of the elements that a tendon runs along.
pub(super) fn wrap(wrap: &Wrap) -> [f64; 3] {
    let side = |side: Option<usize>| side.map_or(-1.0, |site| site as f64);
    match *wrap {
        Wrap::Joint { joint, coef } => [1.0, joint as f64, coef],
        Wrap::Pulley { divisor } => [2.0, -1.0, divisor],
        Wrap::Site { site } => [3.0, site as f64, 0.0],
        Wrap::Sphere { geom, side: site } => [4.0, geom as f64, side(site)],
        Wrap::Cylinder { geom, side: site } => [5.0, geom as f64, side(site)],
    }
}

pub(super) fn of_sensors(m: &Model) -> Named {
    vec![
        (
            "sensor_type",
            m.sensor_type.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("sensor_objid", optional(&m.sensor_objid)),
        ("sensor_adr", ids(&m.sensor_adr)),
    ]
}
