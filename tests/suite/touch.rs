//! The sense of touch: counts, layout, what `compat` decides, conservation, bad input.

mod skin;

use std::sync::Arc;

use crate::common::*;
use babybench::Config;
use babybench::assets::MemoryAssets;
use babybench::config::{Behavior, BodyParts, Compat, Part, Scene, TouchFunction, TouchResponse};
use babybench::math::*;
use babybench::mimo::{build_model, embedded};
use babybench::mjcf_loader::load_str;
use babybench::model::Model;
use babybench::physics::{Contact, compile};
use babybench::sensors::touch::SkinError;
use babybench::sensors::{SkinLayout, Touch};
use babybench::spaces::NumpyRng;

fn config(behavior: Behavior, touch_scale: f64) -> Config {
    Config {
        touch_active: true,
        touch_scale,
        ..free(behavior, Scene::Base)
    }
}

fn model(behavior: Behavior) -> Model {
    build_model(&free(behavior, Scene::Base), &embedded()).expect("the embedded assets load")
}

fn skin(model: &Model, config: &Config) -> SkinLayout {
    SkinLayout::new(model, config).expect("a valid scale")
}

fn contact(geom: [usize; 2], pos: Vec3, normal: Vec3, dist: f64, force: Vec3) -> Contact {
    let n = unit(normal).0;
    let t1 = unit(cross(
        n,
        if n[0].abs() < 0.5 {
            [1.0, 0.0, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        },
    ))
    .0;
    let t2 = cross(n, t1);
    Contact {
        geom,
        dist,
        pos,
        frame: [n[0], n[1], n[2], t1[0], t1[1], t1[2], t2[0], t2[1], t2[2]],
        dim: 3,
        friction: [0.0; 5],
        solref: [0.0; 2],
        solreffriction: [0.0; 2],
        solimp: [0.0; 5],
        includemargin: 0.0,
        efc_address: None,
        force: [force[0], force[1], force[2], 0.0, 0.0, 0.0],
    }
}

/// A model with poses, and a contact between the right foot's first geom and the upper body.
fn self_contact(m: &Model, force: Vec3) -> (Vec<Vec3>, Vec<Mat3>, Vec<Contact>) {
    let id = |name: &str| m.body(name).expect("a body of MIMo");
    let (foot, chest) = (id("right_foot"), id("upper_body"));
    let mut xpos = vec![[0.0; 3]; m.nbody()];
    let mut xmat = vec![MAT3_ID; m.nbody()];
    let turn = |axis: Vec3, angle| quat_to_mat(axis_angle_to_quat(unit(axis).0, angle));
    (xpos[foot], xmat[foot]) = ([0.3, 0.1, 0.2], turn([1.0, 2.0, 0.5], 0.8));
    (xpos[chest], xmat[chest]) = ([0.25, 0.1, 0.15], turn([-1.0, 0.3, 0.5], 2.1));
    let geoms = [m.body_geomadr[foot], m.body_geomadr[chest]];
    let c = contact(geoms, [0.29, 0.12, 0.17], [0.2, -0.5, 0.7], -0.02, force);
    (xpos, xmat, vec![c])
}

fn sense(m: &Model, function: TouchFunction, response: TouchResponse, compat: Compat, force: Vec3) -> Touch {
    let (xpos, xmat, contacts) = self_contact(m, force);
    let layout = Arc::new(skin(m, &config(Behavior::None, 1.0)));
    let mut touch = Touch::new(layout, function, response, compat);
    touch.sense(m, &contacts, &xpos, &xmat);
    touch
}

#[test]
fn compat_decides_the_frame_of_force_vectors() {
    let m = model(Behavior::None);
    let force = [5.0, 1.0, -2.0];
    let (function, response) = (TouchFunction::ForceVector, TouchResponse::Nearest);
    for compat in [Compat::Api, Compat::Reference] {
        let touch = sense(&m, function, response, compat, force);
        for c in touch.contacts() {
            let felt: Vec<_> = touch.active().filter(|a| a.body == c.body).collect();
            assert_eq!(felt.len(), 1);
            let skin = touch.layout().body(c.body).expect("feels");
            let geom = &skin.geoms[skin.geom_of(felt[0].index)];
            let expect = match compat {
                Compat::Api => mat_t_vec(&geom.mat, c.force_body),
                Compat::Reference => c.force_body,
            };
            for k in 0..3 {
                assert!((f64::from(felt[0].value[k]) - expect[k]).abs() < 1e-6);
            }
        }
        // the foot's first geom is turned in its body, so the frames differ
        let turned = touch.contacts().iter().any(|c| {
            let skin = touch.layout().body(c.body).expect("feels");
            skin.geoms
                .iter()
                .any(|g| norm(sub(mat_t_vec(&g.mat, c.force_body), c.force_body)) > 0.1)
        });
        assert!(turned);
    }
}

#[test]
fn compat_decides_the_place_of_the_second_side() {
    let m = model(Behavior::None);
    let place = |compat| {
        let t = sense(
            &m,
            TouchFunction::ForceVectorGlobal,
            TouchResponse::Nearest,
            compat,
            [5.0, 0.0, 0.0],
        );
        [t.contacts()[0].point, t.contacts()[1].point]
    };
    let (_, _, contacts) = self_contact(&m, [5.0, 0.0, 0.0]);
    let (c, n) = (contacts[0], row(&contacts[0].frame, 0));
    let [first, second] = [-1.0, 1.0].map(|sign| add_scaled(c.pos, n, sign * c.dist / 2.0));
    assert_eq!(place(Compat::Api), [first, second]);
    assert_eq!(place(Compat::Reference), [first, first]);
    // the surfaces of geoms that overlap: the first body reaches further along the normal than the second
    assert!(dot(n, sub(first, second)) > 0.0);
}

#[test]
fn compat_decides_about_forces_without_x_component() {
    let m = model(Behavior::None);
    let layout = Arc::new(skin(&m, &config(Behavior::None, 1.0)));
    let hip = m.body("hip").expect("a body of MIMo");
    let point = layout.sensor_positions(hip).expect("feels")[40];
    for (compat, lost) in [(Compat::Api, false), (Compat::Reference, true)] {
        let response = TouchResponse::SpreadLinear;
        let mut touch = Touch::new(layout.clone(), TouchFunction::ForceVector, response, compat);
        touch.press(hip, point, [0.0, 3.0, 4.0]);
        assert_eq!(touch.active().next().is_none(), lost, "{compat}");
        touch.press(hip, point, [1.0, 3.0, 4.0]);
        assert!(touch.active().next().is_some());
    }
}

#[test]
fn functions_are_scalar_normal_or_three_components() {
    let m = model(Behavior::None);
    let force = [5.0, 1.0, -2.0];
    let normal = sense(&m, TouchFunction::Normal, TouchResponse::Nearest, Compat::Api, force);
    assert_eq!((normal.width(), normal.len()), (1, 5723));
    let values: Vec<&[f32]> = normal.active().map(|a| a.value).collect();
    assert_eq!(values, [&[5.0], &[5.0]]);
    let global = sense(
        &m,
        TouchFunction::ForceVectorGlobal,
        TouchResponse::Nearest,
        Compat::Api,
        force,
    );
    assert_eq!((global.width(), global.len()), (3, 17169));
    let felt: Vec<&[f32]> = global.active().map(|a| a.value).collect();
    for k in 0..3 {
        assert!((felt[0][k] + felt[1][k]).abs() < 1e-6, "action and reaction");
    }
    let (_, _, c) = self_contact(&m, force);
    let reference = sense(
        &m,
        TouchFunction::NormalForce,
        TouchResponse::Nearest,
        Compat::Reference,
        force,
    );
    let (_, xmat, _) = self_contact(&m, force);
    let first = reference.contacts()[0].body;
    let expect = mat_t_vec(&xmat[first], scale(column(&c[0].frame, 0), -5.0));
    let value = reference.active().next().expect("felt").value;
    assert!((0..3).all(|k| (f64::from(value[k]) - expect[k]).abs() < 1e-6));
    // contacts without force are not felt
    let none = sense(
        &m,
        TouchFunction::Normal,
        TouchResponse::Nearest,
        Compat::Api,
        [1e-10, 0.0, 0.0],
    );
    assert!(none.active().next().is_none() && none.contacts().is_empty());
}

/// Over a run with self-touch: what the sensors of a body feel together is the force of its contacts.
#[test]
fn sensors_together_feel_the_contact_force() {
    let mut shared = example("self_touch");
    shared.vision_active = false;
    let blueprint = blueprint(shared);
    let mut env = blueprint.env().expect("available");
    let layout = blueprint.skin().expect("touch is on").clone();
    env.reset(Some(3)).expect("no divergence");
    let all = TouchFunction::ALL.iter().filter(|f| **f != TouchFunction::NormalForce);
    let mut senses: Vec<Touch> = all
        .flat_map(|&f| TouchResponse::ALL.iter().map(move |&r| (f, r)))
        .map(|(f, r)| Touch::new(layout.clone(), f, r, Compat::Api))
        .collect();
    let (mut worst, mut sides) = (0.0_f64, 0);
    for _ in 0..60 {
        held_steps(&mut env, 5, 5);
        let m = env.model().clone();
        for touch in &mut senses {
            touch.observe(&m, env.state());
            sides += touch.contacts().len();
            for body in layout.bodies() {
                let contacts = touch.contacts().iter().filter(|c| c.body == body.body);
                let (mut sum, mut scale) = ([0.0; 3], 1e-3_f64);
                let mut expect = match touch.function() {
                    TouchFunction::Normal => [contacts.clone().map(|c| c.normal).sum(), 0.0, 0.0],
                    _ => touch.force_on_body(body.body),
                };
                for c in contacts {
                    scale = scale.max(norm(c.force));
                }
                let geoms: Vec<Vec3> = body.geoms.iter().map(|g| touch.force_on_geom(g.geom)).collect();
                if touch.function() != TouchFunction::Normal {
                    let of_geoms = geoms.iter().fold([0.0; 3], |s, f| add(s, *f));
                    assert!(norm(sub(of_geoms, expect)) <= 1e-12 * scale);
                }
                for (i, v) in touch.body_values(body.body).chunks(touch.width()).enumerate() {
                    let v: Vec3 = std::array::from_fn(|k| v.get(k).map_or(0.0, |v| f64::from(*v)));
                    let v = match touch.function() {
                        TouchFunction::ForceVector => mat_vec(&body.geoms[body.geom_of(i)].mat, v),
                        _ => v,
                    };
                    sum = add(sum, v);
                }
                if touch.function() == TouchFunction::ForceVector {
                    expect = mat_t_vec(&env.state().xmat[body.body], expect);
                }
                worst = worst.max(norm(sub(sum, expect)) / scale);
            }
        }
    }
    println!("{sides} sides: sums are off by up to {worst:.1e} of the largest force");
    assert!(sides > 1000 && worst < 1e-5);
}

#[test]
fn nothing_beyond_two_scales_responds_and_shares_fall_linearly() {
    let m = model(Behavior::None);
    let layout = Arc::new(skin(&m, &config(Behavior::None, 1.0)));
    let mut touch = Touch::new(
        layout.clone(),
        TouchFunction::Normal,
        TouchResponse::SpreadLinear,
        Compat::Api,
    );
    let mut rng = NumpyRng::seed(5);
    let (mut most, mut lost) = (0, 0);
    for body in layout.bodies() {
        for _ in 0..300 {
            let on = (rng.uniform() * body.len() as f64) as usize;
            let point = add(
                body.positions()[on],
                std::array::from_fn(|_| 5.0 * body.spacing * (rng.uniform() - 0.5)),
            );
            touch.clear();
            touch.press(body.body, point, [10.0, 0.0, 0.0]);
            let weight = |p: &Vec3| (1.0 - norm(sub(*p, point)) / (2.0 * body.spacing)).max(0.0);
            let total: f64 = body.positions().iter().map(weight).sum();
            for (p, v) in body.positions().iter().zip(touch.body_values(body.body)) {
                let expect = if total > 0.0 { 10.0 * weight(p) / total } else { 0.0 };
                assert!((f64::from(*v) - expect).abs() < 1e-5, "{}", body.name);
            }
            most = most.max(touch.active().count());
            lost += usize::from(total == 0.0);
        }
    }
    println!("up to {most} sensors share a force; {lost} points are out of reach of all");
}

#[test]
fn turning_the_world_changes_no_reading_in_the_body() {
    let mut c = example("self_touch");
    c.vision_active = false;
    let mut env = env(c);
    env.reset(Some(1)).expect("no divergence");
    let m: Arc<Model> = env.model().clone();
    let layout = env.blueprint().skin().expect("touch is on").clone();
    let turn = quat_to_mat(axis_angle_to_quat(unit([0.3, -1.0, 0.7]).0, 1.9));
    let shift = [3.0, -2.0, 0.5];
    let (mut worst, mut n) = (0.0_f64, 0);
    for function in [TouchFunction::Normal, TouchFunction::ForceVector] {
        let mut here = Touch::new(layout.clone(), function, TouchResponse::SpreadLinear, Compat::Api);
        let mut there = here.clone();
        for _ in 0..20 {
            held_steps(&mut env, 5, 5);
            let s = env.state();
            here.observe(&m, s);
            let xpos: Vec<Vec3> = s.xpos.iter().map(|p| add(mat_vec(&turn, *p), shift)).collect();
            let xmat: Vec<Mat3> = s.xmat.iter().map(|r| mat_mul(&turn, r)).collect();
            let mut contacts = s.contact.clone();
            for c in &mut contacts {
                c.pos = add(mat_vec(&turn, c.pos), shift);
                c.frame = mat_mul(&c.frame, &transpose(&turn));
            }
            there.sense(&m, &contacts, &xpos, &xmat);
            let largest = here.values().iter().fold(1e-3_f32, |m, v| m.max(v.abs()));
            for (a, b) in here.values().iter().zip(there.values()) {
                worst = worst.max(f64::from((a - b).abs() / largest));
            }
            n += here.active().count();
        }
    }
    println!("{n} readings change by up to {worst:.1e} of the largest");
    assert!(n > 100 && worst < 1e-6);
}

#[test]
fn the_environment_observes_touch() {
    let mut c = example("self_touch");
    c.vision_active = false;
    let first = blueprint(c.clone());
    let mut env = first.env().expect("available");
    let spaces = env.observation_space();
    let keys: Vec<&str> = spaces.iter().map(|s| s.key).collect();
    assert_eq!(keys, ["observation", "touch", "vestibular"]);
    let n = spaces[1].shape[0];
    let observation = env.reset(Some(0)).expect("no divergence");
    assert_eq!(observation.touch.map(<[f32]>::len), Some(n));
    held_steps(&mut env, 50, 10);
    let touch = env.senses().touch().expect("on");
    assert_eq!(env.observation().touch, Some(touch.values()));
    assert!(touch.active().next().is_some(), "MIMo lies on a mattress");
    let nonzero = touch
        .values()
        .chunks(touch.width())
        .filter(|v| v.iter().any(|v| *v != 0.0))
        .count();
    assert_eq!(touch.active().count(), nonzero);
    assert!(
        Arc::ptr_eq(touch.layout(), first.skin().expect("on")),
        "the tables are shared"
    );
    // no state from one environment to the next
    c.touch_scale = 2.0;
    let sizes: Vec<usize> = (0..3).map(|_| blueprint(c.clone()).skin().expect("on").len()).collect();
    assert!(sizes[0] < n && sizes.iter().all(|s| *s == sizes[0]), "{sizes:?}");
    c.touch_scale = 0.0;
    let off = blueprint(c.clone());
    assert!(off.skin().is_none() && off.env().expect("available").observation().touch.is_none());
    c.touch_scale = 1.0;
    c.touch = BodyParts::all(false);
    let nothing = blueprint(c);
    assert_eq!(nothing.env().expect("available").observation().touch, Some(&[][..]));
}

#[test]
fn bad_input_is_named() {
    for (line, expect) in [
        (
            "touch_function: pressure",
            vec!["touch_function", "normal", "force_vector", "force_vector_global"],
        ),
        (
            "touch_response: gaussian",
            vec!["touch_response", "nearest", "spread_linear"],
        ),
        ("touch_scale: -1", vec!["touch_scale", "-1"]),
        ("touch_scale: .nan", vec!["touch_scale"]),
        ("touch_scale: .inf", vec!["touch_scale"]),
    ] {
        let error = Config::from_yaml(line, "bad.yml").expect_err(line).to_string();
        println!("{error}");
        for word in expect {
            assert!(error.contains(word), "{error} does not name {word}");
        }
    }
    let m = model(Behavior::None);
    for spacing in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let error = SkinLayout::with_spacing(&m, |b| (b == "head").then_some(spacing)).expect_err("not a distance");
        assert!(
            matches!(&error, SkinError::Spacing { body, .. } if body == "head"),
            "{error}"
        );
    }
    let error = SkinLayout::with_spacing(&m, |_| Some(1e-9)).expect_err("too many");
    println!("{error}");
    assert!(matches!(error, SkinError::TooMany { .. }));
    // a contact of bodies that do not feel, ids that are not there
    let layout = Arc::new(SkinLayout::with_spacing(&m, |_| None).expect("valid"));
    assert!(layout.is_empty() && layout.body(usize::MAX).is_none() && layout.locate(0).is_none());
    let mut touch = Touch::new(layout, TouchFunction::Normal, TouchResponse::Nearest, Compat::Api);
    let (xpos, xmat, contacts) = self_contact(&m, [1.0, 0.0, 0.0]);
    touch.sense(&m, &contacts, &xpos, &xmat);
    touch.press(3, [0.0; 3], [1.0; 3]);
    assert!(touch.is_empty() && touch.contacts().is_empty());
    assert_eq!(touch.force_on_geom(0), [0.0; 3]);
}
