//! Elements and attributes that MuJoCo added after 3.3.0, through 4.0. They are accepted if they change nothing or only have another name, and
//! refused by name otherwise.

/// The treatment of an attribute that MuJoCo added after 3.3.0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LaterAttribute {
    /// The value changes nothing: the attribute is dropped.
    Nothing,
    /// The attribute is replaced by this one with this value.
    As(&'static str, &'static str),
    /// It has no counterpart: an error.
    Refused,
}

/// Values with which an attribute changes nothing.
enum NeutralValue {
    /// One of these words.
    Words(&'static [&'static str]),
    /// Zeros.
    Zeros,
    /// Any number.
    Number,
    /// None.
    Never,
}

/// Elements, an attribute that they have in later versions, and the values with which it changes nothing.
const ATTRIBUTES: &[(&[&str], &str, NeutralValue)] = &[
    // MuJoCo writes these when it saves a model
    (&["compiler"], "savecanonical", FLAG),
    (&["compiler"], "savecompiled", FLAG),
    (&["compiler"], "saveinertial", FLAG),
    (&["compiler"], "conflict", NeutralValue::Never),
    (&["compiler"], "passthrough", NeutralValue::Never),
    // both together are what `passive` was
    (&["flag"], "damper", NeutralValue::Words(&["enable"])),
    (&["flag"], "spring", NeutralValue::Words(&["enable"])),
    (&["flag"], "diagexact", NeutralValue::Words(&["disable"])),
    (&["flag"], "ipc", NeutralValue::Words(&["disable"])),
    (&["flag"], "sleep", NeutralValue::Words(&["disable"])),
    (&["flag"], "speculative", NeutralValue::Words(&["disable"])),
    (&["option"], "sleep_tolerance", NeutralValue::Number), // of bodies that may sleep
    (&["global"], "cameraid", NeutralValue::Number),        // of the viewer
    (&["mesh"], "builtin", NeutralValue::Never),
    (&["mesh"], "material", NeutralValue::Never),
    (&["mesh"], "params", NeutralValue::Never),
    (&["texture"], "class", NeutralValue::Never),
    (&["texture"], "colorspace", NeutralValue::Words(&["auto"])),
    (&["texture"], "embed", NeutralValue::Never),
    (&["geom"], "castshadow", FLAG), // shadows are not drawn
    (&["geom", "pair"], "adhesion", NeutralValue::Zeros),
    (&["geom"], "surfacevel", NeutralValue::Zeros),
    (&["site"], "mesh", NeutralValue::Never),
    (&["camera"], "output", NeutralValue::Words(&["rgb"])),
    (&["camera"], "projection", NeutralValue::Words(&["perspective"])),
    (&["light"], "type", NeutralValue::Never), // but for those in `attribute`
    (&["light"], "intensity", NeutralValue::Never),
    (&["light"], "range", NeutralValue::Never),
    (&["light"], "softness", NeutralValue::Never),
    (&["light"], "texture", NeutralValue::Never),
    (
        &["joint", "spatial", "fixed", "tendon"],
        "springyield",
        NeutralValue::Never,
    ),
    (
        &["spatial", "fixed", "tendon"],
        "actuatorfrclimited",
        NeutralValue::Never,
    ),
    (&["spatial", "fixed", "tendon"], "actuatorfrcrange", NeutralValue::Never),
    (&["spatial", "fixed", "tendon"], "armature", NeutralValue::Zeros),
    (&["attach"], "frame", NeutralValue::Never),
    (&["general"], "inheritrange", NeutralValue::Zeros),
    (&["intvelocity"], "actlimited", NeutralValue::Words(&["true"])), // its activations always have a range
    (&["rangefinder"], "camera", NeutralValue::Never),
    (&["rangefinder"], "data", NeutralValue::Never),
    (&["key"], "plastic", NeutralValue::Never),
];

/// Of all actuators.
const ACTUATORS: &[(&str, NeutralValue)] = &[
    ("armature", NeutralValue::Zeros),
    ("damping", NeutralValue::Zeros),
    ("delay", NeutralValue::Zeros),
    ("nsample", NeutralValue::Zeros),
    ("ffrange", NeutralValue::Never),
    ("input", NeutralValue::Never),
    ("interp", NeutralValue::Never),
    ("velrange", NeutralValue::Never),
];

/// Of all sensors.
const SENSORS: &[(&str, NeutralValue)] = &[
    ("delay", NeutralValue::Zeros),
    ("interval", NeutralValue::Zeros),
    ("nsample", NeutralValue::Zeros),
    ("interp", NeutralValue::Never),
];

const FLAG: NeutralValue = NeutralValue::Words(&["true", "false"]);

/// Elements, each after its parent.
const ELEMENTS: &[(&str, &str)] = &[
    ("actuator", "dcmotor"),
    ("actuator", "orientation"),
    ("actuator", "pid"),
    ("equality", "flexstrain"),
    ("material", "layer"),
    ("sensor", "contact"),
    ("sensor", "insidesite"),
    ("sensor", "tactile"),
    ("sensor", "tendonactuatorfrc"),
];

/// Returns the treatment of an attribute that an element, which `has` others, does not have in 3.3.0; `None` if later versions do not have it either.
pub(super) fn attribute(element: &str, has: impl Fn(&str) -> bool, name: &str, text: &str) -> Option<LaterAttribute> {
    match (element, name, text) {
        ("light", "type", "spot") => return Some(LaterAttribute::As("directional", "false")),
        ("light", "type", "directional") => return Some(LaterAttribute::As("directional", "true")),
        _ => {}
    }
    // only sensors have noise, and every actuator has a gear or a ctrlrange
    let common = if has("noise") {
        SENSORS
    } else if has("gear") || has("ctrlrange") {
        ACTUATORS
    } else {
        &[]
    };
    let own = ATTRIBUTES.iter().filter(|(elements, ..)| elements.contains(&element));
    let own = own.map(|(_, attribute, same)| (*attribute, same));
    let mut all = own.chain(common.iter().map(|(attribute, same)| (*attribute, same)));
    let (_, same) = all.find(|(attribute, _)| *attribute == name)?;
    // NaN is neither 0 nor finite, so other text is refused
    let number = |word: &str| word.parse().unwrap_or(f64::NAN);
    let changes_nothing = match same {
        NeutralValue::Words(words) => words.contains(&text),
        NeutralValue::Zeros => text.split_whitespace().all(|word| number(word) == 0.0),
        NeutralValue::Number => number(text.trim()).is_finite(),
        NeutralValue::Never => false,
    };
    Some(if changes_nothing {
        LaterAttribute::Nothing
    } else {
        LaterAttribute::Refused
    })
}

/// Returns whether later versions have an element that 3.3.0 does not have.
pub(super) fn element(parent: &str, name: &str) -> bool {
    ELEMENTS.contains(&(parent, name))
}

#[cfg(test)]
mod tests {
    use crate::assets::MemoryAssets;
    use crate::{LoadError, Spec, load_str};

    fn load(content: &str) -> Result<Spec, LoadError> {
        let text = format!("<mujoco>{content}</mujoco>");
        load_str(&text, "m.xml", &MemoryAssets::new())
    }

    /// A scene with an element in its world and one after it.
    fn scene(inside: &str, behind: &str) -> String {
        format!("<worldbody><body><joint name='j'/><geom size='.1'/></body>{inside}</worldbody>{behind}")
    }

    #[test]
    fn what_changes_nothing_is_read() {
        for content in [
            "<compiler saveinertial='true' savecompiled='false' savecanonical='true'/>",
            "<option sleep_tolerance='1e-4'><flag spring='enable' damper='enable' sleep='disable' ipc='disable'/></option>",
            "<visual><global cameraid='-1'/></visual>",
            "<asset><texture name='t' builtin='flat' width='8' height='8' colorspace='auto'/></asset>",
            &scene(
                "<geom size='1' castshadow='false' adhesion='0' surfacevel='0 0 0'/>",
                "",
            ),
            &scene("<camera projection='perspective' output='rgb'/>", ""),
            &scene(
                "",
                "<actuator><motor joint='j' armature='0' damping='0' delay='0' nsample='0'/></actuator>",
            ),
            &scene(
                "",
                "<sensor><jointpos joint='j' delay='0' nsample='0' interval='0'/></sensor>",
            ),
        ] {
            assert!(
                load(content).is_ok(),
                "{content}: {}",
                load(content).err().map_or(String::new(), |e| e.to_string())
            );
        }
    }

    #[test]
    fn lights_have_a_type() {
        let directional = |attributes: &str| {
            let light = format!("<light {attributes}/>");
            load(&scene(&light, ""))
                .map(|spec| spec.arrays.lights[0].directional)
                .map_err(|e| e.to_string())
        };
        assert_eq!(directional("type='spot'"), Ok(false));
        assert_eq!(directional("type='directional'"), Ok(true));
        let both = directional("type='spot' directional='true'").expect_err("two names of one thing");
        assert!(both.contains("attribute \"directional\" is given twice"), "{both}");
    }

    #[test]
    fn the_rest_is_refused_by_its_name() {
        let later = |content: &str, what: &str| {
            let error = load(content).expect_err("of a later version").to_string();
            let expected = format!("{what} was added after MuJoCo 3.3.0, the version supported here: remove it");
            assert!(error.ends_with(&expected), "{error}");
        };
        later(&scene("<light type='point'/>", ""), "attribute \"type\"");
        later(
            &scene("<camera projection='orthographic'/>", ""),
            "attribute \"projection\"",
        );
        later(&scene("<geom size='1' adhesion='1'/>", ""), "attribute \"adhesion\"");
        later("<option><flag spring='disable'/></option>", "attribute \"spring\"");
        later(
            &scene("", "<actuator><motor joint='j' delay='.1'/></actuator>"),
            "attribute \"delay\"",
        );
        later(&scene("", "<actuator><pid joint='j'/></actuator>"), "element \"pid\"");
        later(&scene("", "<sensor><contact/></sensor>"), "element \"contact\"");
        // where no version has it
        let error = load(&scene("<geom size='1' delay='0'/>", ""))
            .expect_err("not of a geom")
            .to_string();
        assert!(error.ends_with("unknown attribute \"delay\""), "{error}");
    }
}
