//! Contacts of a step on both sides.

use babybench::physics::{Contact, ContactSide, State};

use super::measured::Measured;
use crate::measure::{max_abs, relative};
use crate::mujoco::Contact as TheirContact;

/// Geom, flex, element and vertex of each side.
type Sides = [[Option<usize>; 4]; 2];

fn our_sides(sides: [ContactSide; 2]) -> Sides {
    sides.map(|side| match side {
        ContactSide::Geom(geom) => [Some(geom), None, None, None],
        ContactSide::Vertex { flex, vertex } => [None, Some(flex), None, Some(vertex)],
        ContactSide::Element { flex, element } => [None, Some(flex), Some(element), None],
    })
}

fn their_sides(c: &TheirContact) -> Sides {
    [0, 1].map(|side| {
        let [flex, element, vertex] = c.flex[side];
        let geom = Some(c.geom[side]).filter(|geom| *geom != usize::MAX);
        [geom, flex, element, vertex]
    })
}

/// Measures the contacts of a step. Those of flexes are compared by their sides, as MuJoCo's tree of boxes decides their order.
pub(super) fn contacts(state: &State, theirs: &[TheirContact]) -> Vec<Measured> {
    let of_geoms = state
        .contact
        .iter()
        .map(|c| (our_sides(c.geom.map(ContactSide::Geom)), c));
    let of_flexes = state.flex_contact.iter().map(|c| (our_sides(c.sides), &c.contact));
    let mut ours: Vec<(Sides, &Contact)> = of_geoms.chain(of_flexes).collect();
    let mut theirs: Vec<(Sides, &TheirContact)> = theirs.iter().map(|c| (their_sides(c), c)).collect();
    let flexes = !state.flex_contact.is_empty();
    if flexes {
        ours.sort_by_key(|(sides, _)| *sides);
        theirs.sort_by_key(|(sides, _)| *sides);
    }
    let sides = [
        ours.iter().map(|(sides, _)| *sides).collect::<Vec<_>>(),
        theirs.iter().map(|(sides, _)| *sides).collect(),
    ];
    let place = format!("{:?}, MuJoCo {:?}", sides[0], sides[1]);
    let other = f64::from(u8::from(sides[0].len() != sides[1].len()));
    let mut all = vec![Measured::new("contacts: number", other, 0.0, place.clone())];
    if other > 0.0 {
        return all;
    }
    let other = f64::from(u8::from(sides[0] != sides[1]));
    all.push(Measured::new("contacts: geoms in order", other, 0.0, place));
    if other > 0.0 || theirs.is_empty() {
        return all;
    }
    let mut worst = [
        ("contacts: dist", 0.0, String::new()),
        ("contacts: pos", 0.0, String::new()),
        ("contacts: frame", 0.0, String::new()),
    ];
    let mut rest = (0.0_f64, String::new());
    for ((sides, a), (_, b)) in ours.iter().zip(&theirs) {
        let errors = [
            (a.dist - b.dist).abs(),
            max_abs(&a.pos, &b.pos),
            max_abs(&a.frame, &b.frame),
        ];
        let place = || format!("of {sides:?}: {a:?}, MuJoCo {b:?}");
        for (worst, error) in worst.iter_mut().zip(errors) {
            if error.is_nan() || error > worst.1 {
                *worst = (worst.0, error, place());
            }
        }
        let alike = a.dim == b.dim
            && relative(&a.friction, &b.friction) <= 1e-12
            && (a.includemargin - b.includemargin).abs() <= 1e-12
            && if flexes {
                a.efc_address.is_some() == b.efc_address.is_some()
            } else {
                a.efc_address == b.efc_address
            };
        if !alike {
            rest = (1.0, place());
        }
    }
    all.extend(worst.map(|(name, error, place)| Measured::new(name, error, 1e-9, place)));
    all.push(Measured::new(
        "contacts: dim, friction, margin, row",
        rest.0,
        0.0,
        rest.1,
    ));
    all
}
