//! Free bodies whose size and mass a task changes.

use super::*;

/// A model with a ball of some mass and radius.
fn ball(mass: f64, radius: f64) -> Arc<Model> {
    let text = format!(
        "<mujoco><asset><texture name='squares' type='cube' builtin='checker' rgb1='1 0 0' rgb2='0 0 1' width='16' height='16'/>\
         <material name='skin' texture='squares' texuniform='true'/></asset>\
         <worldbody><geom type='plane' size='1 1 1'/><camera name='near' pos='0 -.1 1' xyaxes='1 0 0 0 0 1'/>\
         <body name='ball' pos='0 0 1'><freejoint/><geom size='{radius}' mass='{mass}' material='skin'/></body><body name='held' pos='1 0 1'><joint/><geom size='.1'/></body></worldbody></mujoco>"
    );
    let spec = load_str(&text, "ball.xml", &MemoryAssets::new()).expect("valid");
    Arc::new(compile(spec).expect("valid"))
}

fn engine(model: &Arc<Model>) -> SoftEngine {
    SoftEngine::new(model.clone(), SoftOptions::default())
}

#[test]
fn a_changed_ball_looks_like_a_ball_compiled_so() {
    let picture = |model: &Arc<Model>, change: Option<FreeBody>| {
        let mut engine = engine(model);
        let mut state = engine.new_state();
        if let Some(change) = change {
            let id = model.body("ball").expect("a ball");
            state.set_free_body(model, id, change).expect("it is free");
        }
        engine.forward(&mut state).expect("no divergence");
        let scenery = Scenery::new(model, &MemoryAssets::new()).expect("no files");
        let view = View {
            camera: model.camera("near").expect("a camera"),
            width: 40,
            height: 40,
        };
        let mut out = vec![0; view.rgb_len()];
        let drawn = CpuRenderer::new().rgb(&scenery, &Poses::from(&state), &view, &mut out);
        drawn.expect("it can be drawn");
        out
    };
    let (small, large) = (ball(0.07, 0.01), ball(0.5, 0.02));
    let (before, after) = (picture(&small, None), picture(&large, None));
    assert_ne!(before, after);
    assert_eq!(picture(&small, Some(FreeBody::sphere(0.5, 0.02))), after);
    assert_eq!(picture(&large, Some(FreeBody::sphere(0.07, 0.01))), before);
}

#[test]
fn a_changed_ball_is_a_ball_compiled_so() {
    let (small, large) = (ball(0.5, 0.025), ball(0.07, 0.011));
    let mut state = engine(&small).new_state();
    let id = small.body("ball").expect("a ball");
    state
        .set_free_body(&small, id, FreeBody::sphere(0.07, 0.011))
        .expect("it is free");
    let p = &state.params;
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-14 * b.abs(), "{a} {b}");
    near(p.body_mass[id], large.body_mass[id]);
    near(p.body_subtreemass[0], large.body_subtreemass[0]);
    (0..3).for_each(|k| near(p.body_inertia[id][k], large.body_inertia[id][k]));
    (0..2).for_each(|k| near(p.body_invweight0[id][k], large.body_invweight0[id][k]));
    (0..6).for_each(|d| near(p.dof_invweight0[d], large.dof_invweight0[d]));
    let geom = small.body_geomadr[id];
    assert_eq!(
        (p.geom_size[geom], p.geom_rbound[geom]),
        (large.geom_size[geom], large.geom_rbound[geom])
    );
    let mut other = engine(&large).new_state();
    let (mut one, mut two) = (engine(&small), engine(&large));
    for _ in 0..500 {
        one.step(&mut state).expect("no divergence");
        two.step(&mut other).expect("no divergence");
    }
    assert!(
        (state.qpos[2] - other.qpos[2]).abs() < 1e-9,
        "{} {}",
        state.qpos[2],
        other.qpos[2]
    );
    assert!(state.qpos[2] < 0.02, "it lies on the floor");
}

#[test]
fn only_free_bodies_change() {
    let model = ball(0.5, 0.025);
    let mut state = engine(&model).new_state();
    let before = state.params.clone();
    let held = model.body("held").expect("a body");
    let sphere = FreeBody::sphere(1.0, 0.1);
    assert!(matches!(
        state.set_free_body(&model, held, sphere),
        Err(EngineError::NotFree { .. })
    ));
    assert!(matches!(
        state.set_free_body(&model, 0, sphere),
        Err(EngineError::NotFree { .. })
    ));
    assert!(matches!(
        state.set_free_body(&model, 99, sphere),
        Err(EngineError::NoBody { .. })
    ));
    let free = model.body("ball").expect("a body");
    let mut rng = Rng::with_seed(0);
    for _ in 0..20 {
        let bad = [0.0, -1.0, f64::NAN, f64::INFINITY][rng.usize(..4)];
        let change = FreeBody {
            mass: Some(bad),
            ..sphere
        };
        assert!(matches!(
            state.set_free_body(&model, free, change),
            Err(EngineError::NotPositive { .. })
        ));
    }
    assert_eq!(state.params, before, "nothing was changed");
}
