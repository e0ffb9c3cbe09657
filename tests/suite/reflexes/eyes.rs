//! The vestibulo-ocular reflex.

use super::*;
use babybench::config::ReflexVor;

/// What the left eye does against the head, as a sine of a frequency: gain, and lead in degrees.
struct Answer {
    gain: f64,
    lead: f64,
}

/// Returns the angular velocity of the head about its vertical axis, rad/s.
fn gyro(env: &Env) -> f64 {
    let model = env.model();
    let sensor = model
        .sensor_name
        .iter()
        .position(|name| name == "vestibular_gyro")
        .expect("a gyroscope");
    env.state().sensordata[model.sensor_adr[sensor] + 2]
}

/// Swivels the head by some degrees at a frequency, Hz, for some periods, and looks at the last two.
fn swivel(config: Config, degrees: f64, frequency: f64, periods: u32) -> Answer {
    let mut env = started(config);
    for joint in ["robot:head_tilt", "robot:head_tilt_side"] {
        env.mimo_mut().lock(joint, 0.0).expect("a lock");
    }
    let dt = 0.005;
    let steps = (f64::from(periods) / frequency / dt) as u32;
    let first = steps - (2.0 / frequency / dt) as u32;
    let (mut head, mut eye) = ([0.0; 2], [0.0; 2]);
    for k in 0..steps {
        let phase = std::f64::consts::TAU * frequency * dt * f64::from(k);
        env.mimo_mut()
            .lock("robot:head_swivel", degrees.to_radians() * phase.sin())
            .expect("a lock");
        rest(&mut env);
        if k >= first {
            // the body turns against the head, so that the head turns less than its joint
            for (sum, v) in [
                (&mut head, gyro(&env)),
                (&mut eye, velocity(&env, "robot:left_eye_horizontal")),
            ] {
                (sum[0], sum[1]) = (sum[0] + v * phase.cos(), sum[1] + v * phase.sin());
            }
        }
    }
    // eye over minus head, as complex numbers
    let square = head[0] * head[0] + head[1] * head[1];
    let re = -(eye[0] * head[0] + eye[1] * head[1]) / square;
    let im = -(eye[0] * head[1] - eye[1] * head[0]) / square;
    Answer {
        gain: re.hypot(im),
        lead: im.atan2(re).to_degrees(),
    }
}

#[test]
fn eyes_turn_against_the_head_with_the_gain_that_is_asked() {
    for model in MODELS {
        for age in [Some(0.0), Some(1.0), Some(4.0), None] {
            for (asked, degrees) in [(1.03, 15.0), (1.03, 5.0), (0.6, 15.0), (0.6, 5.0)] {
                let mut config = infant(&[Reflex::Vor]);
                (config.actuation_model, config.age) = (model, age);
                config.reflex_gains = ReflexGains {
                    vor: Some(asked),
                    ..ReflexGains::default()
                };
                let Answer { gain, lead } = swivel(config, degrees, 1.0, 5);
                let case = format!("{model}, {age:?} months, {degrees} degrees");
                assert!((gain - asked).abs() < 0.05, "{case}: {gain} for {asked}");
                assert!(lead.abs() < 12.0, "{case}: a lead of {lead}");
            }
        }
    }
}

#[test]
fn eyes_of_newborns_lead_at_slow_turns() {
    let mut config = infant(&[Reflex::Vor]);
    config.age = Some(0.0);
    let slow = swivel(config.clone(), 15.0, 0.25, 4);
    assert!(slow.lead > 20.0, "{}", slow.lead);
    config.age = Some(4.0);
    let later = swivel(config, 15.0, 0.25, 4);
    assert!(later.lead < slow.lead, "{}", later.lead);
}

#[test]
fn eyes_ignore_their_action_unless_it_is_added() {
    let gaze = |vor| {
        let mut config = infant(&[Reflex::Vor]);
        config.reflexes.vor = vor;
        let mut env = started(config);
        let names = env.blueprint().actuation().action_names(env.model());
        let action: Vec<f32> = names
            .iter()
            .map(|name| {
                if name.starts_with("act:left_eye_horizontal") {
                    0.5
                } else {
                    0.0
                }
            })
            .collect();
        for _ in 0..100 {
            env.step(&action).expect("a step");
        }
        angle(&env, "robot:left_eye_horizontal").abs()
    };
    assert!(gaze(ReflexVor::Replace) < 0.02);
    assert!(gaze(ReflexVor::Add) > 0.3);
}
