//! Values that other keys exclude.

use super::*;

#[test]
fn compat_decides_which_touch_functions_exist() {
    check(
        "compat: reference\ntouch_function: normal_force",
        "compat=reference touch_function=normal_force",
    );
    check(
        "compat: reference\ntouch_active: off",
        "compat=reference touch_active=false",
    );
    check("compat: reference\ntouch_scale: 0", "compat=reference touch_scale=0.0");
    let unknown = "but the Python code that `compat: reference` follows does not have it; use force_vector, \
                   force_vector_global or normal_force";
    check_error(
        "touch_function: normal\ncompat: reference",
        &format!(":1:17: `touch_function` is normal, {unknown}"),
    );
    check_error(
        "seed: 1\ncompat: reference",
        &format!(":2:9: `touch_function` is normal, {unknown}"),
    );
    check_error(
        "touch_function: normal_force",
        ":1:17: `touch_function` is normal_force, but that is the Python code's name for another quantity; use normal, \
         force_vector or force_vector_global, or set `compat: reference`",
    );
}

#[test]
fn a_default_that_conflicts_is_blamed_on_the_key_that_excludes_it() {
    check_error(
        "seed: 1\nbehavior: mobile\nmobile_baseline: 0.95",
        ":3:18: `mobile_extinction` is 0.2, but with `mobile_baseline` it is more than the whole episode; both are shares that \
         add up to 1 at most",
    );
}

#[test]
fn compat_reference_refuses_what_the_reference_cannot_do() {
    let touch = "touch_function: force_vector\n";
    check_error(
        &format!("compat: reference\n{touch}vision_resolution: 128\nrender_size: 64"),
        ":3:20: `vision_resolution` is 128, but under `compat: reference` an eye's image cannot be larger than \
         `render_size`; raise `render_size`",
    );
    check_error(
        &format!("compat: reference\n{touch}vision_height_left: 128\nrender_size: 64"),
        ":3:21: `vision_height_left` is 128, but under `compat: reference` an eye's image cannot be larger than \
         `render_size`; raise `render_size`",
    );
    check_error(
        &format!("compat: reference\n{touch}vision_fovy_right: 45"),
        ":3:20: `vision_fovy_right` is 45.0, but the Python code that `compat: reference` follows draws what the cameras of \
         the scene see",
    );
    check(
        "compat: reference\ntouch_active: off\nvision_active: off\nrender_size: 32",
        "render_size=32 compat=reference vision_active=false touch_active=false",
    );
    check(
        "vision_resolution: 128\nrender_size: 64",
        "render_size=64 vision_resolution=128",
    );
    check_error(
        &format!("compat: reference\n{touch}behavior: hand_regard"),
        ":1:9: `touch_fingers` is true, but the Python code that `compat: reference` follows has no finger touch with \
         `behavior: hand_regard`; set `touch_fingers: false` or `touch_active: false`",
    );
    check(
        &format!("compat: reference\n{touch}behavior: hand_regard\ntouch_fingers: off"),
        "behavior=hand_regard compat=reference touch_function=force_vector touch_fingers=false",
    );
}

#[test]
fn what_shapes_a_sense_that_is_off_is_refused() {
    for (input, expect) in [
        (
            "vision_active: no\nvision_acuity: yes",
            ":2:16: `vision_acuity` is true, but it shapes what the eyes see, and they are off; set `vision_active: true`",
        ),
        (
            "vision_outputs: [depth]\nnoise_vision: 3",
            ":2:15: `noise_vision` is 3.0, but it changes images in colour and grey, and neither is observed; add rgb or gray \
             to `vision_outputs`",
        ),
        (
            "touch_scale: 0\npain_active: yes",
            ":2:14: `pain_active` is true, but it needs touch, which is off; set `touch_active: true` and a `touch_scale` \
             above 0",
        ),
        (
            "vestibular_active: no\ndelay_vestibular: 2",
            ":2:19: `delay_vestibular` is 2.0, but it shapes the sense of balance, which is off; set `vestibular_active: true`",
        ),
        (
            "actuation_model: positional\nnoise_motor: 0.1",
            ":2:14: `noise_motor` is 0.1, but it grows with the effort, and actions of `actuation_model: positional` are angles; \
             choose spring_damper or muscle",
        ),
        (
            "delay_by_age: yes",
            ":1:15: `delay_by_age` is true, but it is that of MIMo's age, and `age` is none; set `age`, 0 to 24 months",
        ),
        (
            "age: 2\ndelay_by_age: yes\ndelay_sensory: 4",
            ":3:16: `delay_sensory` is 4.0, but with `delay_by_age` each sense has the delay of MIMo's age; leave it out, or give \
             `delay_touch`, `delay_vision`, .. what they have instead",
        ),
        (
            "pain_slope: 2",
            ":1:13: `pain_slope` is 2.0, but it shapes pain, which is off; set `pain_active: true`",
        ),
        (
            "delay_motor: 2.5",
            ":1:14: `delay_motor` is 2.5, but it is counted in whole steps; use a whole number, or set `delay_unit: ms`",
        ),
        (
            "delay_touch: 1001",
            ":1:14: `delay_touch` is 1001.0, but that is 1001 steps of 5 ms, and a delay has at most 1000",
        ),
        (
            "delay_sensory: 100\nvision_resolution: 4096",
            ":1:16: `delay_sensory` is 100.0, but the delayed images would take 10066 MB; the limit is 1073 MB. Lower it, or \
             `vision_resolution`",
        ),
    ] {
        check_error(input, expect);
    }
    check(
        "delay_unit: ms\ndelay_motor: 2.5\nframe_skip: 2",
        "frame_skip=2 delay_unit=ms delay_motor=2.5",
    );
}

#[test]
fn keys_of_reflexes_that_are_off_are_refused() {
    check(
        "reflexes: [stretch, vor]\nreflex_vor: add",
        "reflexes=[vor, stretch] reflex_vor=add",
    );
    check("reflexes: by_age\nage: 1", "age=1.0 reflexes=[by_age]");
    check_error(
        "reflex_gain: 2",
        ":1:14: `reflex_gain` is 2.0, but it shapes reflexes, which are off; set `reflexes`",
    );
    check_error(
        "reflexes: moro\nreflex_delay_vor: 20",
        ":2:19: `reflex_delay_vor` is 20.0, but that reflex is off; add vor to `reflexes`, or leave this key out",
    );
    check_error(
        "reflexes: [moro]\nreflex_vor: add",
        ":2:13: `reflex_vor` is add, but that reflex is off; add vor to `reflexes`, or leave this key out",
    );
    check("reflexes: by_age", "reflexes=[by_age]");
    check_error(
        "age: 1\nreflexes: [by_age, moro]",
        ":2:11: `reflexes` is [moro, by_age], but `by_age` is all reflexes of MIMo's age; use it alone, or list names",
    );
    check_error(
        "compat: reference\ntouch_active: off\nreflexes: [vor]",
        ":3:11: `reflexes` is [vor], but the Python code that `compat: reference` follows does not have it; leave it out, or set \
         `compat: api`",
    );
}

#[test]
fn keys_of_an_individual_need_each_other_and_are_not_in_the_reference() {
    check(
        "age: 6\nsex: girl\nlength_z: 1\nweight_z: -0.5",
        "age=6.0 sex=girl length_z=1.0 weight_z=-0.5",
    );
    check("age: 1\nsex: boy\ngestation: 30.5", "age=1.0 sex=boy gestation=30.5");
    check(
        "age: 1\nbody_random: 1\nbody_number: 7",
        "age=1.0 body_random=1.0 body_number=7",
    );
    check_error(
        "sex: boy",
        ":1:6: `sex` is boy, but it changes MIMo at an age, and `age` is none; set `age`, 0 to 24 months",
    );
    let sex = "but the standards of growth are of boys or of girls; set `sex: boy` or `sex: girl`";
    check_error("age: 6\nlength_z: 1", &format!(":2:11: `length_z` is 1.0, {sex}"));
    check_error("age: 6\ngestation: 30", &format!(":2:12: `gestation` is 30.0, {sex}"));
    check_error(
        "age: 6\nbody_seed: 4",
        ":2:12: `body_seed` is 4, but it chooses an infant of a population, and there is none; set `body_random` above 0",
    );
    check_error(
        "age: 6\nsex: boy\nhead_z: 1\nhead_circumference: 44",
        ":3:9: `head_z` is 1.0, but `head_circumference` sets the same length; leave one of the two out",
    );
    for key in ["sex: boy", "body_random: 0.5"] {
        let (name, value) = key.split_once(": ").expect("a key");
        check_error(
            &format!("compat: reference\ntouch_active: off\nage: 6\n{key}"),
            &format!(
                ":4:{}: `{name}` is {value}, but the Python code that `compat: reference` follows does not have it; leave it out, or \
                 set `compat: api`",
                name.len() + 3
            ),
        );
    }
}
