//! Spatial tendons, muscles, and actuators on sites, slider-cranks and contacts, without MuJoCo.

use std::sync::Arc;

use babybench::Limits;
use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::{load_str, load_str_with};
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};

fn outcome(text: &str) -> Result<SoftEngine, String> {
    let model = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
    let model = model.map_err(|e| e.to_string())?;
    Ok(SoftEngine::new(Arc::new(model), SoftOptions::default()))
}

fn engine(text: &str) -> SoftEngine {
    outcome(text).unwrap_or_else(|e| panic!("{e}"))
}

/// An arm with a string from the wall over a pulley to its end.
fn arm(tendon: &str, actuators: &str) -> String {
    format!(
        r#"<mujoco><compiler angle="radian"/><option gravity="0 0 0"/><worldbody>
             <site name="wall" pos="-.5 0 .3"/><geom name="bulge" size=".1" contype="0" conaffinity="0"/>
             <body><joint name="j" axis="0 1 0" range="-1 1" damping=".1"/><geom type="capsule" fromto="0 0 0 .5 0 0" size=".03" mass="1"/>
               <site name="end" pos=".5 0 0"/></body>
             <body name="puck" pos="0 2 .1"><joint type="slide" axis="0 0 1"/><geom size=".1"/></body>
             <geom name="table" type="plane" size="1 1 1" pos="0 2 0"/>
           </worldbody><tendon>{tendon}</tendon><actuator>{actuators}</actuator></mujoco>"#
    )
}

const STRING: &str = r#"<spatial name="s" stiffness="100" springlength="0 .9"><site site="wall"/><geom geom="bulge"/><site site="end"/></spatial>"#;

fn forward(engine: &mut SoftEngine, edit: impl FnOnce(&mut State)) -> State {
    let mut state = engine.new_state();
    edit(&mut state);
    engine.forward(&mut state).expect("forces");
    state
}

#[test]
fn the_length_of_a_tendon_has_the_rate_that_its_jacobian_says() {
    let mut engine = engine(&arm(STRING, ""));
    // straight above, around the bulge below
    for (q, points) in [(-0.9, 2), (0.6, 4)] {
        let length = |engine: &mut SoftEngine, q: f64| forward(engine, |s| s.qpos[0] = q).ten_length[0];
        let state = forward(&mut engine, |s| (s.qpos[0], s.qvel[0]) = (q, 1.0));
        assert_eq!(state.ten_wrapnum, [points], "{q}");
        let slope = (length(&mut engine, q + 1e-6) - length(&mut engine, q - 1e-6)) / 2e-6;
        assert!(
            (state.ten_velocity[0] - slope).abs() < 1e-8,
            "{} {slope}",
            state.ten_velocity[0]
        );
        // the spring pulls where it is longer than its rest length
        let force = 100.0 * (0.9 - state.ten_length[0]).min(0.0);
        let expected = force * slope - 0.1;
        assert!((state.qfrc_passive[0] - expected).abs() < 1e-6);
    }
}

#[test]
fn a_pulley_divides_what_follows_it() {
    let text = arm(
        r#"<spatial name="s"><site site="wall"/><site site="end"/><pulley divisor="2"/><site site="wall"/><site site="end"/></spatial>"#,
        "",
    );
    let state = forward(&mut engine(&text), |_| ());
    let once = (1.0_f64 + 0.09).sqrt();
    assert!((state.ten_length[0] - 1.5 * once).abs() < 1e-15);
    assert_eq!(state.wrap_obj[..5], [-1, -1, -2, -1, -1]);
}

#[test]
fn a_muscle_pulls_as_its_curves_say() {
    let muscle = r#"<muscle joint="j" force="10" lengthrange="-1 1" range=".5 1.5" ctrlrange="0 1"/>"#;
    let mut engine = engine(&arm("", muscle));
    // at the optimal length and standing still it has its isometric force times the activation
    let state = forward(&mut engine, |s| s.act[0] = 0.4);
    assert!(
        (state.actuator_force[0] + 4.0).abs() < 1e-12,
        "{}",
        state.actuator_force[0]
    );
    // longer than the optimum it resists without activation
    let stretched = forward(&mut engine, |s| s.qpos[0] = 0.8);
    assert!(stretched.actuator_force[0] < 0.0);
    // faster on than off: time constants of 10 and 40 ms, at an activation of 0 half and twice as long
    let on = forward(&mut engine, |s| s.ctrl[0] = 1.0);
    assert!((on.act_dot[0] - 1.0 / 0.005).abs() < 1e-9);
    let off = forward(&mut engine, |s| s.act[0] = 1.0);
    assert!((off.act_dot[0] + 1.0 / 0.02).abs() < 1e-9);
}

#[test]
fn lengths_of_muscles_are_found_by_simulation() {
    let found = engine(&arm("", r#"<muscle joint="j" gear="2"/>"#));
    let [low, high] = found.model().actuator_lengthrange[0];
    assert!((low + 2.0).abs() < 0.1 && (high - 2.0).abs() < 0.1, "{low} {high}");
    let by_limit = arm("", r#"<muscle joint="j" gear="2"/>"#).replace(
        r#"<compiler angle="radian"/>"#,
        r#"<compiler angle="radian"><lengthrange uselimit="true"/></compiler>"#,
    );
    assert_eq!(engine(&by_limit).model().actuator_lengthrange[0], [-1.0, 1.0]);
    let endless = arm("", r#"<muscle joint="j"/>"#).replace(r#" range="-1 1""#, "");
    let error = outcome(&endless).expect_err("nothing holds it");
    assert!(
        error.contains("mujoco/actuator/muscle: its length goes on changing"),
        "{error}"
    );
    let text = arm("", r#"<muscle joint="j"/>"#);
    let limits = Limits {
        lengthrange_steps: 100,
        ..Limits::default()
    };
    let spec = load_str_with(&text, "m.xml", &MemoryAssets::new(), &limits).expect("a document");
    let error = compile(spec).expect_err("too long").to_string();
    assert!(error.contains("has too many steps"), "{error}");
}

#[test]
fn sites_cranks_and_contacts_are_pushed() {
    let actuators = r#"<motor site="end" gear="0 0 2"/><position site="end" refsite="wall" gear="1 0 0" kp="1"/>
        <motor cranksite="end" slidersite="wall" cranklength="2"/><adhesion body="puck" ctrlrange="0 1" gain="5"/>"#;
    let mut engine = engine(&arm("", actuators));
    let state = forward(&mut engine, |s| (s.ctrl[0], s.qpos[1]) = (1.0, -0.001));
    // 2 N up at half a metre, about an axis that turns the end down; the servo pulls along the arm, which moves nothing
    assert!(
        (state.qfrc_actuator[0] + 1.0).abs() < 1e-12,
        "{}",
        state.qfrc_actuator[0]
    );
    assert!((state.actuator_length[1] - 1.0).abs() < 1e-15);
    // the slider is where a rod of 2 m along its axis reaches the end from: 0.3 below, 1 m aside
    assert!((state.actuator_length[2] + 0.3 + 3.0_f64.sqrt()).abs() < 1e-12);
    let stuck = forward(&mut engine, |s| (s.ctrl[3], s.qpos[1]) = (1.0, -0.001));
    assert!(
        (stuck.qfrc_actuator[1] + 5.0).abs() < 1e-12,
        "{}",
        stuck.qfrc_actuator[1]
    );
}

#[test]
fn what_is_no_tendon_is_refused() {
    let cases = [
        ("<spatial/>", "spatial: a spatial tendon runs along two sites or more"),
        (
            r#"<spatial width="0"><site site="wall"/><site site="end"/></spatial>"#,
            "spatial: width must be positive",
        ),
        (
            r#"<spatial><site site="wall"/><site site="wall"/></spatial>"#,
            "site: the tendon names this site twice in a row",
        ),
        (
            r#"<spatial><site site="wall"/><geom geom="table"/><site site="end"/></spatial>"#,
            "geom: a tendon wraps around spheres and cylinders only",
        ),
        (
            r#"<spatial><geom geom="bulge"/><site site="end"/></spatial>"#,
            "geom: a geom of a tendon must stand between two sites",
        ),
        (
            r#"<spatial><site site="wall"/><site site="end"/><pulley divisor="2"/></spatial>"#,
            "pulley: a tendon cannot end with a pulley: a site follows it",
        ),
        (
            r#"<spatial><site site="wall"/><pulley divisor="2"/><site site="end"/></spatial>"#,
            "site: a site of a tendon must have another site or a geom before or behind it, not pulleys alone",
        ),
        (r#"<fixed width=".1"/>"#, "fixed: unknown attribute \"width\""),
    ];
    for (tendon, expected) in cases {
        let error = outcome(&arm(tendon, "")).expect_err(tendon);
        assert!(error.ends_with(expected), "{error}");
    }
    let cases = [
        (
            r#"<motor joint="j" refsite="wall"/>"#,
            "refsite needs the attribute site",
        ),
        (
            r#"<motor joint="j" cranklength="1"/>"#,
            "slidersite and cranklength are for slider-cranks: give cranksite, too",
        ),
        (
            r#"<motor cranksite="end" cranklength="1"/>"#,
            "attribute \"slidersite\" is required",
        ),
        (
            r#"<motor cranksite="end" slidersite="wall"/>"#,
            "cranklength of a slider-crank must be positive",
        ),
        (
            r#"<adhesion body="puck" ctrlrange="-1 1"/>"#,
            "the ctrlrange of adhesion must not be negative",
        ),
        (
            r#"<muscle joint="j" range="1 .5"/>"#,
            "the second number of the range of a muscle must be the greater",
        ),
        (r#"<muscle joint="j" lmin="1.5"/>"#, "a muscle needs lmin < 1 < lmax"),
        (
            r#"<muscle joint="j" vmax="0"/>"#,
            "scale, vmax, fpmax and fvmax of a muscle must be positive",
        ),
    ];
    for (actuator, expected) in cases {
        let error = outcome(&arm("", actuator)).expect_err(actuator);
        assert!(error.ends_with(expected), "{error}");
    }
}

/// A copy of what decides how a run goes on holds the activations of muscles; strings have no memory.
#[test]
fn a_copied_state_continues_with_the_same_bits() {
    let actuators = r#"<muscle tendon="s" lengthrange=".7 1.3"/><motor site="end" refsite="wall" gear="1 0 1 0 1 0"/>"#;
    let mut engine = engine(&arm(STRING, actuators));
    let mut state = engine.new_state();
    state.ctrl.fill(0.7);
    for _ in 0..50 {
        engine.step(&mut state).expect("steps");
    }
    let mut copy = engine.new_state();
    copy.copy_dynamic_from(&state);
    for state in [&mut state, &mut copy] {
        (0..50).for_each(|_| engine.step(state).expect("steps"));
    }
    assert_eq!(
        (&state.qpos, &state.qvel, &state.act),
        (&copy.qpos, &copy.qvel, &copy.act)
    );
    assert!(state.act[0] > 0.5 && state.qpos[0] != 0.0);
}

#[test]
fn copies_stand_where_those_before_them_lead() {
    let text = r#"<mujoco><worldbody><replicate count="11" offset="1 0 0" euler="0 0 90"><body name="b" pos="0 2 0"><geom name="g" size=".1"/>
        <replicate count="2" sep="-" offset="0 0 1"><site name="s"/></replicate></body></replicate></worldbody></mujoco>"#;
    let mut engine = engine(text);
    let model = engine.model().clone();
    assert_eq!((model.nbody(), model.nsite()), (12, 22));
    assert_eq!(
        (model.body_name[1].as_str(), model.body_name[11].as_str()),
        ("b00", "b10")
    );
    assert_eq!(model.site_name[3], "s-101");
    let state = forward(&mut engine, |_| ());
    // a step to the right; the body is 2 m to the left of it, seen from the first copy, then in front
    for (copy, expected) in [(0, [0.0, 2.0]), (1, [-1.0, 0.0]), (2, [2.0, -2.0])] {
        let pos = state.xpos[1 + copy];
        let apart = (pos[0] - expected[0]).abs().max((pos[1] - expected[1]).abs());
        assert!(apart < 1e-14, "{copy}: {pos:?}");
    }
    let nested = "<replicate count='1000'>".repeat(4) + "<site/>" + &"</replicate>".repeat(4);
    let error = outcome(&format!("<mujoco><worldbody>{nested}</worldbody></mujoco>")).expect_err("too many");
    assert!(
        error.ends_with("more than 100000 frames and copies of elements"),
        "{error}"
    );
    let none = engine_of_copies(-3);
    assert_eq!(none.model().ngeom(), 0);
}

fn engine_of_copies(count: i32) -> SoftEngine {
    engine(&format!(
        "<mujoco><worldbody><replicate count='{count}'><geom size='.1'/></replicate></worldbody></mujoco>"
    ))
}

#[test]
fn what_refers_to_what_is_copied_is_copied() {
    let model = |text: &str| engine(text).model().clone();
    let copies = "<worldbody><replicate count='2'><geom size='.1'/></replicate></worldbody>";
    // what refers to nothing is copied with every copy, and so are its own copies
    let clocks = model(&format!("<mujoco>{copies}<sensor><clock name='c'/></sensor></mujoco>"));
    assert_eq!(clocks.sensor_name, ["c", "c0", "c1", "c01"]);
    let keys = model(&format!(
        "<mujoco>{copies}<keyframe><key name='k'/></keyframe></mujoco>"
    ));
    let names: Vec<_> = keys.keys.iter().map(|key| key.name.as_str()).collect();
    assert_eq!(names, ["k0", "k1", "k"]);
    let slides = "<body><joint name='x'/><geom size='.1'/></body><body><joint name='x0'/><geom size='.1'/></body>";
    let copies = "<replicate count='2'><body><joint name='y'/><geom size='.1'/></body></replicate>";
    let with = |joint: &str| {
        let motor = format!("<actuator><motor name='m' joint='{joint}'/></actuator>");
        model(&format!(
            "<mujoco><worldbody>{slides}{copies}</worldbody>{motor}</mujoco>"
        ))
        .actuator_name
        .clone()
    };
    // also where something else is called as a copy would be
    assert_eq!(with("x"), ["m", "m0"]);
    assert_eq!(with("x0"), ["m"]);
    assert_eq!(with("y1"), ["m"]);
    assert_eq!(with("y"), ["m0", "m1"]);
}
