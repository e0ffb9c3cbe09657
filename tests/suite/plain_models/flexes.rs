//! Flexes: deformable bodies of lines, triangles and tetrahedra.

use super::*;

const ALONE: &str = "<contact contype='0' conaffinity='0'/>";

fn comp(attributes: &str, inside: &str) -> String {
    format!(
        "<mujoco><worldbody><body name='p' pos='0 0 1'><flexcomp name='c' mass='1' spacing='.1 .1 .1' {attributes}>{ALONE}{inside}</flexcomp>
         </body></worldbody></mujoco>"
    )
}

/// A rope of seven bodies whose first point is held hangs straight down, and no edge is longer than it was.
#[test]
fn a_rope_hangs() {
    let inside = "<edge equality='true' damping='.5'/><pin id='0'/>";
    let damped = "<mujoco><default><joint damping='.05'/></default>";
    let text = comp("dim='1' count='8 1 1'", inside).replace("<mujoco>", damped);
    let mut engine = engine(&text);
    let model = engine.model().clone();
    assert_eq!(
        (model.nv, model.nflex(), model.nflexvert(), model.nflexedge()),
        (21, 1, 8, 7)
    );
    assert_eq!((model.body("c_1"), model.body("c_0")), (Some(2), None));
    let mut state = engine.new_state();
    for _ in 0..20_000 {
        engine.step(&mut state).expect("steps");
    }
    let [top, bottom] = [state.flexvert_xpos[0], state.flexvert_xpos[7]];
    assert_eq!(top[2], 1.0);
    assert!((top[0] - bottom[0]).abs() < 0.05, "{bottom:?}");
    assert!((top[2] - bottom[2] - 0.7).abs() < 0.01, "{bottom:?}");
    for length in &state.flexedge_length {
        assert!((length - 0.1).abs() < 2e-3, "{length}");
    }
}

/// A soft cube in free fall keeps its momentum, and its elastic forces vanish in its rest configuration.
#[test]
fn elastic_forces_are_internal() {
    let soft = "<elasticity young='1e3' poisson='.3' damping='.01'/>";
    let mut engine = engine(&comp("dim='3' count='3 3 3'", soft));
    let mut state = engine.new_state();
    engine.forward(&mut state).expect("computes");
    assert!(state.qfrc_passive.iter().all(|f| f.abs() < 1e-12));
    state
        .qvel
        .iter_mut()
        .enumerate()
        .for_each(|(i, v)| *v = 0.1 * ((i * 7) % 5) as f64);
    let sum = |values: &[f64]| [0, 1, 2].map(|k| values.iter().skip(k).step_by(3).sum::<f64>());
    for _ in 0..50 {
        engine.step(&mut state).expect("steps");
    }
    assert!(state.qfrc_passive.iter().any(|f| f.abs() > 1e-2));
    assert!(
        sum(&state.qfrc_passive).iter().all(|f| f.abs() < 1e-9),
        "{:?}",
        sum(&state.qfrc_passive)
    );
}

/// A copy of a state continues with the same bits.
#[test]
fn a_copy_of_a_cloth_continues_alike() {
    let inside = "<edge equality='true' damping='.01'/><pin id='0 3'/>";
    let mut engine = engine(&comp("dim='2' count='4 4 1'", inside));
    let mut state = engine.new_state();
    for _ in 0..20 {
        engine.step(&mut state).expect("steps");
    }
    let mut copy = engine.new_state();
    copy.copy_dynamic_from(&state);
    for _ in 0..20 {
        engine.step(&mut state).expect("steps");
        engine.step(&mut copy).expect("steps");
    }
    assert_eq!(state.qpos, copy.qpos);
}

/// What is not simulated is refused with advice.
#[test]
fn refused_flexes_say_why() {
    let refused = |text: &str, why: &str| {
        let error = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
        let error = error.expect_err("refused").to_string();
        assert!(error.contains(why), "{error}");
    };
    refused(
        &comp("dof='trilinear' count='3 3 3' type='box'", ""),
        "give each vertex a body",
    );
    refused(&comp("type='gmsh' file='a.msh'", ""), "convert the file");
    refused(
        "<mujoco><worldbody><replicate count='2'><body name='b'><flexcomp name='c' count='3 3 1'/></body></replicate></worldbody></mujoco>",
        "is not copied",
    );
    refused(
        "<mujoco><deformable><flex body='world' node='world' element='0 1'/></deformable></mujoco>",
        "between nodes",
    );
    let plugin = "<plugin plugin='mujoco.elasticity.shell'/>";
    refused(&comp("count='3 3 1'", plugin), "mujoco.elasticity.shell");
}
