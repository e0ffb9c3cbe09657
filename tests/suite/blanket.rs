//! Cloths on MIMo: what his skin feels of them, and the scene `blanket`.

use babybench::assets::MemoryAssets;
use babybench::config::{Behavior, Scene, TouchFunction};
use babybench::env::BlueprintOptions;
use babybench::math::{norm, sub};
use babybench::physics::{ContactSide, FlexContact, State};
use babybench::render::{CpuRenderer, Element, Poses, Scenery, View};
use babybench::{Blueprint, Config, Env, Model, VectorEnv, VectorOptions};

use crate::allocations;
use crate::common::*;

/// Mass of the cloth, kg.
const MASS: f64 = 0.1;

/// A cloth on the belly of MIMo, who lies on the floor.
fn cloth() -> Env {
    let text = format!(
        "<mujoco model=\"room\"><worldbody>
           <body name=\"mimo_location\" pos=\"0 0 0.1\" euler=\"0 -90 0\">
             <freejoint name=\"mimo_location\"/>
             <include file=\"mimo.xml\"/>
           </body>
           <flexcomp name=\"cloth\" dim=\"2\" count=\"5 5 1\" spacing=\".02 .02 .02\" pos=\"-.04 0 .19\" mass=\"{MASS}\" radius=\".004\">
             <edge damping=\"0.05\"/>
             <elasticity young=\"1500\" poisson=\"0.1\" thickness=\"0.01\" damping=\"0.002\"/>
             <contact selfcollide=\"none\" internal=\"false\"/>
           </flexcomp>
         </worldbody>
         <include file=\"base.xml\"/><include file=\"mimo_settings.xml\"/><include file=\"mimo_actuators.xml\"/></mujoco>"
    );
    let mut assets = MemoryAssets::new();
    assets.insert("rooms/cloth.xml", text).expect("a path");
    let config = Config {
        touch_active: true,
        touch_function: TouchFunction::ForceVectorGlobal,
        scene: Scene::File("rooms/cloth.xml".to_string()),
        ..free(Behavior::None, Scene::Base)
    };
    Blueprint::with(config, BlueprintOptions::default().with_assets(assets))
        .and_then(|blueprint| blueprint.env())
        .expect("a room")
}

fn blanket() -> Config {
    Config {
        touch_active: true,
        ..free(Behavior::None, Scene::Blanket)
    }
}

/// Returns how much of a contact's force acts on the flex. MuJoCo 3.3.0 shares it among the vertices of an element by weights whose squares add
/// up to 1, so that the flex gets up to 1.73 times the force that the other side gets.
fn share(model: &Model, state: &State, contact: &FlexContact) -> f64 {
    let weights = |flex: usize, element: usize| {
        let flex = &model.flexes[flex];
        let places = flex
            .element(element)
            .iter()
            .map(|v| state.flexvert_xpos[flex.vertadr + v]);
        places
            .map(|place| 1.0 / norm(sub(place, contact.contact.pos)))
            .collect::<Vec<_>>()
    };
    let of_elements = contact.sides.iter().filter_map(|side| match *side {
        ContactSide::Element { flex, element } => Some(weights(flex, element)),
        _ => None,
    });
    of_elements.fold(1.0, |_, weights| {
        weights.iter().sum::<f64>() / weights.iter().map(|w| w * w).sum::<f64>().sqrt()
    })
}

/// The forces of contacts that hold a cloth at rest add up to its weight within 3 %. The skin feels the same contacts, with the forces on MIMo's
/// side, and its sensors share all of them.
#[test]
fn the_weight_of_a_cloth_is_felt() {
    let mut env = cloth();
    env.reset(Some(0)).expect("no divergence");
    let rest = vec![0.0; env.action_space().len()];
    repeat(&mut env, &rest, 300);
    let (mut felt, mut sensors, mut held, mut count) = ([0.0; 3], 0.0, 0.0, 0.0);
    for _ in 0..50 {
        repeat(&mut env, &rest, 1);
        let touch = env.senses().touch().expect("the skin");
        let of_cloth = |side: ContactSide| matches!(side, ContactSide::Vertex { .. } | ContactSide::Element { .. });
        for contact in touch.contacts().iter().filter(|c| of_cloth(c.other)) {
            assert_eq!(contact.other.name(env.model()), "cloth");
            for (sum, force) in felt.iter_mut().zip(contact.force) {
                *sum += force;
            }
        }
        for contact in touch.active() {
            sensors += f64::from(contact.value[2]);
        }
        for contact in touch.contacts().iter().filter(|c| !of_cloth(c.other)) {
            sensors -= contact.force[2];
        }
        let state = env.state();
        for contact in &state.flex_contact {
            let up = contact.contact.world_force()[2];
            let up = if contact.geoms()[1].is_some() { -up } else { up };
            held += share(env.model(), state, contact) * up;
        }
        count += 1.0;
    }
    let weight = MASS * 9.81;
    let ([x, y, z], sensors, held) = (felt.map(|force| force / count), sensors / count, held / count);
    testkit::show!(
        "{weight:.4} N of cloth are held by {held:.4} N, and felt as {x:.4} {y:.4} {z:.4} N, by sensors as {sensors:.4} N"
    );
    assert!((held - weight).abs() < 0.03 * weight, "{held}");
    assert!((sensors - z).abs() < 1e-3 * weight, "{sensors} instead of {z}");
    assert!(-z > weight / 3f64.sqrt() - 0.03 * weight && -z < weight, "{z}");
    assert!(x.abs() < 0.03 * weight && y.abs() < 0.03 * weight, "{x} {y}");
}

/// He lies under the blanket: it touches his trunk and both of his legs, and stays above the floor.
#[test]
fn the_blanket_lies_on_him() {
    let mut env = env(blanket());
    env.reset(Some(0)).expect("no divergence");
    let rest = vec![0.0; env.action_space().len()];
    repeat(&mut env, &rest, 200);
    let model = env.model();
    assert_eq!((model.flexes.len(), model.nflexvert()), (1, 100));
    let touch = env.senses().touch().expect("the skin");
    let covered = |body: &str| {
        let body = model.body(body).expect(body);
        let contacts = touch.contacts().iter();
        contacts.filter(|c| c.body == body && c.other.geom().is_none()).count() > 0
    };
    for bodies in [
        &["lower_body", "upper_body"][..],
        &["left_upper_leg", "left_lower_leg", "left_foot"],
        &["right_upper_leg", "right_lower_leg", "right_foot"],
    ] {
        assert!(bodies.iter().any(|body| covered(body)), "{bodies:?}");
    }
    assert!(
        env.state()
            .flexvert_xpos
            .iter()
            .all(|place| place[2] > -0.01 && place[2] < 0.3)
    );
}

#[test]
fn snapshots_resets_and_vectors_have_the_blanket() {
    let blueprint = Blueprint::new(blanket()).expect("the room");
    let mut env = blueprint.env().expect("an environment");
    env.reset(Some(3)).expect("no divergence");
    random_steps(&mut env, 20);
    let snapshot = env.snapshot();
    let places = |env: &mut Env| {
        random_steps(env, 20);
        (
            env.state().flexvert_xpos.clone(),
            env.senses().touch().expect("the skin").values().to_vec(),
        )
    };
    let first = places(&mut env);
    env.restore(&snapshot).expect("restores");
    assert!(places(&mut env) == first, "a snapshot continues otherwise");
    let mut other = blueprint.env().expect("another");
    other.restore(&snapshot).expect("restores");
    assert!(places(&mut other) == first, "another environment continues otherwise");

    let mut envs = VectorEnv::new(&blueprint, 2, VectorOptions::default()).expect("memory");
    envs.reset(0).expect("resets");
    env.reset(Some(0)).expect("resets");
    let actions = vec![0.1; 2 * env.action_space().len()];
    for _ in 0..20 {
        envs.step(&actions).expect("steps");
        env.step(&actions[..env.action_space().len()]).expect("steps");
    }
    let qpos = envs.env(0).expect("it is here").state().qpos.clone();
    assert!(qpos == env.state().qpos, "a vector's environment is elsewhere");
}

#[test]
fn steps_under_the_blanket_allocate_nothing() {
    let mut env = env(blanket());
    env.reset(Some(0)).expect("no divergence");
    random_steps(&mut env, 100);
    let action = vec![0.0; env.action_space().len()];
    let before = allocations::of_this_thread();
    repeat(&mut env, &action, 20);
    assert_eq!(allocations::of_this_thread(), before);
}

/// The blanket is in pictures, which have the same bytes each time, and drawing it allocates nothing after the first.
#[test]
fn the_blanket_is_drawn() {
    let mut env = env(Config {
        vision_active: true,
        ..blanket()
    });
    env.reset(Some(0)).expect("no divergence");
    let scenery = env.blueprint().scenery().expect("it is drawn").clone();
    let camera = env.model().camera("blanket").expect("the camera of the room");
    let view = View {
        camera,
        width: 96,
        height: 64,
    };
    let mut renderer = CpuRenderer::new();
    let mut pictures = [vec![0; view.rgb_len()], vec![0; view.rgb_len()]];
    let [first, second] = &mut pictures;
    let poses = Poses::from(env.state());
    renderer.rgb(&scenery, &poses, &view, first).expect("a picture");
    let before = allocations::of_this_thread();
    renderer.rgb(&scenery, &poses, &view, second).expect("a picture");
    assert_eq!(allocations::of_this_thread(), before);
    assert!(first == second);
    let mut without = Scenery::clone(&scenery);
    without.drawables.retain(|d| !matches!(d.element, Element::Flex(_)));
    renderer.rgb(&without, &poses, &view, second).expect("a picture");
    let changed = first.iter().zip(second).filter(|(a, b)| a != b).count();
    assert!(
        changed > view.rgb_len() / 20,
        "the blanket is on {changed} of {} values",
        view.rgb_len()
    );
}
