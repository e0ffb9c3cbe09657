//! The flag `multiccd`: pairs of convex collision with several contacts.

use babybench::physics::Engine;

use super::engine;

/// What lies on a box of half a metre: its contacts with it, at rest, in the order of their places.
fn contacts(flag: &str, geom: &str) -> Vec<[f64; 3]> {
    let mut engine = engine(&format!(
        r#"<mujoco><option timestep=".005"><flag multiccd="{flag}"/></option>
             <asset>
               <mesh name="brick" vertex="-.1 -.1 -.05 .1 -.1 -.05 -.1 .1 -.05 .1 .1 -.05 -.1 -.1 .05 .1 -.1 .05 -.1 .1 .05 .1 .1 .05"/>
               <mesh name="eight" vertex="{}"/>
             </asset>
             <worldbody>
               <geom type="box" size=".5 .5 .1" pos="0 0 -.1"/>
               <body pos="0 0 .0499"><freejoint/>{geom}</body>
             </worldbody></mujoco>"#,
        octagon()
    ));
    let mut state = engine.new_state();
    engine.forward(&mut state).expect("finite");
    let mut places: Vec<[f64; 3]> = state.contact.iter().map(|contact| contact.pos).collect();
    places.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    let start = state.qpos[2];
    (0..200).for_each(|_| engine.step(&mut state).expect("steps"));
    assert!(
        (state.qpos[2] - start).abs() < 0.01,
        "it has moved by {}",
        state.qpos[2] - start
    );
    places
}

/// The corners of a prism with eight sides.
fn octagon() -> String {
    let corner = |k: usize| {
        let (y, x) = (k as f64 * std::f64::consts::FRAC_PI_4).sin_cos();
        format!("{} {} -.05 {0} {1} .05 ", 0.1 * x, 0.1 * y)
    };
    (0..8).map(corner).collect()
}

#[test]
fn faces_touch_at_the_corners_that_they_share() {
    let brick = "<geom type='mesh' mesh='brick'/>";
    assert_eq!(contacts("disable", brick).len(), 1);
    let corners = contacts("enable", brick);
    let expected = [[-0.1, -0.1], [-0.1, 0.1], [0.1, -0.1], [0.1, 0.1]];
    assert_eq!(corners.len(), 4);
    for (corner, expected) in corners.iter().zip(expected) {
        assert!(
            (corner[0] - expected[0]).abs() < 1e-6 && (corner[1] - expected[1]).abs() < 1e-6,
            "{corner:?}"
        );
        assert!((corner[2] + 0.000_05).abs() < 1e-6, "halfway into both: {corner:?}");
    }
}

#[test]
fn of_many_corners_four_far_apart_are_kept() {
    let corners = contacts("enable", "<geom type='mesh' mesh='eight'/>");
    assert_eq!(corners.len(), 4);
    for k in [0, 1] {
        let along = corners.iter().map(|corner| corner[k]);
        let (least, most) = (along.clone().fold(1.0, f64::min), along.fold(-1.0, f64::max));
        assert!(most - least > 0.16, "{corners:?}");
    }
    assert!(
        corners.iter().all(|p| (p[0].hypot(p[1]) - 0.1).abs() < 1e-6),
        "{corners:?}"
    );
}

#[test]
fn what_is_round_is_tilted_to_find_where_else_it_touches() {
    let lying = "<geom type='cylinder' size='.05 .2' euler='90 0 0'/>";
    assert_eq!(contacts("disable", lying).len(), 1);
    let line = contacts("enable", lying);
    assert!(line.len() >= 2, "{line:?}");
    assert!(
        line.iter().any(|p| p[1] < -0.19) && line.iter().any(|p| p[1] > 0.19),
        "both ends: {line:?}"
    );
    assert_eq!(
        contacts("enable", "<geom type='ellipsoid' size='.06 .06 .05'/>").len(),
        1
    );
    // margins round the corners of faces, so that these are tilted, too
    let grown = contacts("enable", "<geom type='mesh' mesh='brick' margin='.001'/>");
    assert!((2..=5).contains(&grown.len()), "{grown:?}");
}
