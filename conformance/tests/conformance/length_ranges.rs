//! Lengths of actuators that are found while a document is compiled, beside MuJoCo 3.3.0: every attribute of `<lengthrange>`.

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::physics::compile;
use conformance::loading::distances;
use conformance::mujoco::{MUJOCO, Simulation, needed};
use testkit::harness::Trial;
use testkit::{Rng, show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: settings_of_lengthrange_mean_the_same]
}

/// Two segments with limits: muscles on a joint, and on a tendon over a ball; a motor on each; one range that is given.
fn document(settings: &str, steps: &str) -> String {
    format!(
        r#"<mujoco><compiler><lengthrange {settings}/></compiler><option {steps}/>
        <worldbody><site name="s" pos="0.05 0 0.1"/>
        <body><joint name="j" axis="0 1 0" range="-70 40" damping="0.1"/><geom type="capsule" size="0.03" fromto="0 0 0 0.2 0 0"/>
        <geom name="ball" size="0.02" pos="0.2 0 0" contype="0" conaffinity="0"/><site name="top" pos="0.2 0 0.1"/>
        <body pos="0.2 0 0"><joint name="k" axis="0 1 0.2" range="-50 60" solimplimit="0.9 0.95 0.01"/><geom type="capsule" size="0.02" fromto="0 0 0 0.15 0 0"/>
        <site name="e" pos="0.1 0 0.03"/></body></body></worldbody>
        <tendon><spatial name="t"><site site="s"/><geom geom="ball" sidesite="top"/><site site="e"/></spatial>
        <fixed name="f"><joint joint="j" coef="0.7"/><joint joint="k" coef="-0.2"/></fixed></tendon>
        <actuator><muscle name="mj" joint="j" force="5"/><muscle name="mt" tendon="t" force="5"/>
        <muscle name="mf" tendon="f" force="5" gear="-2"/>
        <muscle name="given" joint="k" force="5" lengthrange="-0.4 0.7"/><motor name="motor" joint="k" gear="1.5"/></actuator></mujoco>"#
    )
}

/// The simulations end where the solver's tolerance leaves them: the worst was 1.1e-9 when written.
const LIMIT: f64 = 1e-8;

/// Compares the compiled arrays. Returns whether both take it.
fn taken(settings: &str, steps: &str, worst: &mut f64) -> bool {
    let text = document(settings, steps);
    let ours = load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile);
    let theirs = Simulation::new(needed(), "m.xml", &[("m.xml", text.as_bytes())]);
    let (model, simulation) = match (ours, theirs) {
        (Ok(model), Ok(simulation)) => (model, simulation),
        (Err(_), Err(_)) => return false,
        (Ok(_), Err(e)) => panic!("{settings} {steps}: MuJoCo refuses it: {e}"),
        (Err(e), Ok(_)) => panic!("{settings} {steps}: we refuse it: {e}"),
    };
    for distance in distances(&model, &simulation) {
        let found = distance.name == "actuator_lengthrange";
        let limit = if found { LIMIT } else { distance.limit };
        assert!(distance.error <= limit, "{settings} {steps}: {}", distance.place);
        if found {
            *worst = worst.max(distance.error);
        }
    }
    true
}

/// Every setting with several values alone, and 60 draws of all together: the same lengths, or the same refusal.
fn settings_of_lengthrange_mean_the_same() {
    const SETTINGS: [(&str, &[&str]); 10] = [
        ("mode", &["none", "muscle", "muscleuser", "all"]),
        ("useexisting", &["true", "false"]),
        ("uselimit", &["true", "false"]),
        ("accel", &["1", "20", "60"]),
        ("maxforce", &["0", "0.02", "0.3"]),
        ("timeconst", &["0.005", "0.1", "1", "3"]),
        ("timestep", &["0", "0.002", "0.01", "0.015"]),
        ("inttotal", &["0.5", "4", "10"]),
        ("interval", &["0.1", "2", "20"]),
        ("tolrange", &["-1", "0.001", "0.05", "0.5"]),
    ];
    let (mut documents, mut both, mut worst) = (0, 0, 0.0);
    let mut try_one = |settings: &str, steps: &str| {
        documents += 1;
        both += usize::from(taken(settings, steps, &mut worst));
    };
    for (name, values) in SETTINGS {
        for value in values {
            try_one(&format!(r#"{name}="{value}""#), "");
        }
    }
    for integrator in ["Euler", "RK4", "implicit", "implicitfast"] {
        try_one("", &format!(r#"integrator="{integrator}" gravity="0 3 1""#));
    }
    let mut rng = Rng::with_seed(11);
    for _ in 0..60 {
        let drawn = SETTINGS.iter().filter_map(|(name, values)| {
            let value = values[rng.usize(..values.len())];
            rng.bool().then(|| format!(r#"{name}="{value}""#))
        });
        let settings = drawn.collect::<Vec<_>>().join(" ");
        try_one(&settings, r#"timestep="0.004""#);
    }
    show!("{documents} documents, {both} of which both take, lengths within {worst:.1e}");
    assert!(both > 50 && documents - both > 5, "{both} of {documents}");
}
