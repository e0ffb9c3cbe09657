//! The sensors of the skin.

use super::*;

/// Numbers per observation at three per sensor, as counted in the Python code.
#[test]
fn the_skin_has_as_many_sensors_as_the_references() {
    let (v1, v2) = (model(Behavior::None), model(Behavior::HandRegard));
    for (scale, all, without_fingers) in [
        (0.5, 68589, Some(20553)),
        (1.0, 17169, Some(5505)),
        (2.0, 4497, Some(1509)),
        (3.0, 2046, None),
        (4.0, 1203, Some(399)),
        (5.0, 753, None),
    ] {
        let mut c = config(Behavior::None, scale);
        let n = 3 * skin(&v1, &c).len();
        c.touch.fingers = false;
        let m = 3 * skin(&v1, &c).len();
        println!("touch_scale {scale}: {n} numbers, {m} without fingers");
        assert_eq!(n, all, "touch_scale {scale}");
        assert!(without_fingers.is_none_or(|w| w == m), "touch_scale {scale}");
    }
    let mut ten = config(Behavior::None, 10.0);
    ten.touch.fingers = false;
    assert_eq!(3 * skin(&v1, &ten).len(), 90);
    for (part, expect) in [
        (Part::Hands, 1032),
        (Part::Fingers, 11664),
        (Part::Arms, 606),
        (Part::Feet, 762),
        (Part::Legs, 702),
        (Part::Body, 1191),
        (Part::Head, 1212),
        (Part::Eyes, 6),
    ] {
        let mut c = config(Behavior::None, 1.0);
        c.touch = BodyParts::all(false);
        *c.touch.get_mut(part) = true;
        assert_eq!(3 * skin(&v1, &c).len(), expect, "{}", part.name());
    }
    assert_eq!(3 * skin(&v2, &config(Behavior::HandRegard, 1.0)).len(), 15891);
}

/// MIMo v2 under `compat: reference` has the table of v1.
#[test]
fn compat_decides_the_table_of_mimo_v2() {
    let v2 = model(Behavior::HandRegard);
    let mut c = config(Behavior::HandRegard, 1.0);
    let api = skin(&v2, &c);
    let toe = v2.body("left_big_toe").expect("a body of MIMo v2");
    let thumb = v2.body("left_thdistal").expect("a body of MIMo v2");
    assert_eq!(api.sensor_positions(toe).map(<[Vec3]>::len), Some(27));
    assert_eq!(api.sensor_positions(thumb).map(<[Vec3]>::len), Some(248));
    c.compat = Compat::Reference;
    c.touch.fingers = false;
    let reference = skin(&v2, &c);
    assert_eq!(3 * reference.len(), 5211);
    assert!(reference.body(toe).is_none() && reference.body(thumb).is_none());
}

#[test]
fn layouts_are_consistent_and_left_equals_right() {
    for behavior in [Behavior::None, Behavior::HandRegard] {
        let m = model(behavior);
        for scale in [0.7, 1.0, 1.5, 2.0, 3.7, 12.0] {
            let s = skin(&m, &config(behavior, scale));
            let mut offset = 0;
            for b in s.bodies() {
                assert_eq!(
                    (b.offset, b.geoms.last().map(|g| g.sensors.end)),
                    (offset, Some(b.len()))
                );
                for (i, _) in b.positions().iter().enumerate().take(3) {
                    let (found, index) = s.locate(offset + i).expect("a sensor");
                    assert_eq!((found.body, index), (b.body, i));
                }
                offset += b.len();
                if let Some(plain) = b.name.strip_prefix("left_") {
                    let right = m.body(&format!("right_{plain}")).expect("both sides");
                    let other = s.sensor_positions(right).expect("both sides feel");
                    assert_eq!(b.len(), other.len());
                    for (p, q) in b.positions().iter().zip(other) {
                        assert!(norm(sub(*p, *q)) < 1e-15, "{}", b.name);
                    }
                }
            }
            assert_eq!(s.len(), offset);
            assert_eq!(s.locate(offset), None);
        }
    }
}

#[test]
fn sensors_of_every_shape_on_any_model() {
    let xml = r#"<mujoco><worldbody><geom type="plane" size="1 1 1"/>
        <body name="egg"><freejoint/><geom type="ellipsoid" size=".03 .05 .02" pos="0 .1 0" euler="0 90 0"/></body>
        <body name="mixed"><freejoint/><geom type="box" size=".03 .03 .03"/><geom size=".02"/>
          <geom type="cylinder" size=".01 .06"/><geom type="capsule" size=".01 .05" pos=".2 0 0"/></body>
        <body name="empty" pos="0 0 1"/></worldbody></mujoco>"#;
    let m = load_str(xml, "any.xml", &MemoryAssets::new())
        .and_then(compile)
        .expect("valid");
    let s = SkinLayout::with_spacing(&m, |_| Some(0.008)).expect("valid");
    assert_eq!(s.bodies().len(), 4);
    let counts = |name: &str| {
        let b = s.body(m.body(name).expect("a body")).expect("feels");
        b.geoms.iter().map(|g| (g.points, g.sensors.len())).collect::<Vec<_>>()
    };
    assert!(counts("world").iter().all(|g| *g == (0, 0)));
    println!(
        "ellipsoid {:?}; box, sphere, cylinder, capsule {:?}",
        counts("egg"),
        counts("mixed")
    );
    assert_eq!(counts("egg")[0].0, counts("egg")[0].1);
    let mixed = counts("mixed");
    assert!(mixed[1].1 == 0, "the sphere is inside the box");
    assert!(0 < mixed[2].1 && mixed[2].1 < mixed[2].0, "the cylinder sticks out");
    assert!(mixed[0].1 < mixed[0].0, "the cylinder covers some of the box");
    assert_eq!(mixed[3].1, mixed[3].0);
    assert_eq!(counts("empty"), []);
    let egg = s.sensor_positions(m.body("egg").expect("a body")).expect("feels");
    let reach = |k: usize, c: f64| egg.iter().fold(0.0_f64, |max, p| max.max((p[k] - c).abs()));
    assert!((reach(0, 0.0) - 0.02).abs() < 0.002 && (reach(2, 0.0) - 0.03).abs() < 0.003);
}
