//! What MuJoCo's language has gained after 3.3.0, through 4.0: read where it changes nothing or has another name, refused by its name
//! otherwise.

use super::schema::Rule;

/// What becomes of an attribute of a later version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Later {
    /// With its value everything is as without it.
    Nothing,
    /// It is another attribute, with this value.
    As(&'static str, &'static str),
    /// It has no counterpart.
    Refused,
}

/// Values with which an attribute changes nothing.
enum Same {
    /// One of these words.
    Words(&'static [&'static str]),
    /// Zeros.
    Zeros,
    /// Any number.
    Number,
    /// None.
    Never,
}

/// Elements, an attribute that they have in later versions, and with which values it changes nothing.
const ATTRIBUTES: &[(&[&str], &str, Same)] = &[
    // what MuJoCo writes when it saves a model
    (&["compiler"], "savecanonical", FLAG),
    (&["compiler"], "savecompiled", FLAG),
    (&["compiler"], "saveinertial", FLAG),
    (&["compiler"], "conflict", Same::Never),
    (&["compiler"], "passthrough", Same::Never),
    // both together are what `passive` was
    (&["flag"], "damper", Same::Words(&["enable"])),
    (&["flag"], "spring", Same::Words(&["enable"])),
    (&["flag"], "diagexact", Same::Words(&["disable"])),
    (&["flag"], "ipc", Same::Words(&["disable"])),
    (&["flag"], "sleep", Same::Words(&["disable"])),
    (&["flag"], "speculative", Same::Words(&["disable"])),
    (&["option"], "sleep_tolerance", Same::Number), // of bodies that may sleep
    (&["global"], "cameraid", Same::Number),        // of the viewer
    (&["mesh"], "builtin", Same::Never),
    (&["mesh"], "material", Same::Never),
    (&["mesh"], "params", Same::Never),
    (&["texture"], "class", Same::Never),
    (&["texture"], "colorspace", Same::Words(&["auto"])),
    (&["texture"], "embed", Same::Never),
    (&["geom"], "castshadow", FLAG), // shadows are not drawn
    (&["geom", "pair"], "adhesion", Same::Zeros),
    (&["geom"], "surfacevel", Same::Zeros),
    (&["site"], "mesh", Same::Never),
    (&["camera"], "output", Same::Words(&["rgb"])),
    (&["camera"], "projection", Same::Words(&["perspective"])),
    (&["light"], "type", Same::Never), // but for those in `attribute`
    (&["light"], "intensity", Same::Never),
    (&["light"], "range", Same::Never),
    (&["light"], "softness", Same::Never),
    (&["light"], "texture", Same::Never),
    (&["joint", "spatial", "fixed", "tendon"], "springyield", Same::Never),
    (&["spatial", "fixed", "tendon"], "actuatorfrclimited", Same::Never),
    (&["spatial", "fixed", "tendon"], "actuatorfrcrange", Same::Never),
    (&["spatial", "fixed", "tendon"], "armature", Same::Zeros),
    (&["attach"], "frame", Same::Never),
    (&["general"], "inheritrange", Same::Zeros),
    (&["intvelocity"], "actlimited", Same::Words(&["true"])), // its activations always have a range
    (&["rangefinder"], "camera", Same::Never),
    (&["rangefinder"], "data", Same::Never),
    (&["key"], "plastic", Same::Never),
];

/// Of all actuators.
const ACTUATORS: &[(&str, Same)] = &[
    ("armature", Same::Zeros),
    ("damping", Same::Zeros),
    ("delay", Same::Zeros),
    ("nsample", Same::Zeros),
    ("ffrange", Same::Never),
    ("input", Same::Never),
    ("interp", Same::Never),
    ("velrange", Same::Never),
];

/// Of all sensors.
const SENSORS: &[(&str, Same)] = &[
    ("delay", Same::Zeros),
    ("interval", Same::Zeros),
    ("nsample", Same::Zeros),
    ("interp", Same::Never),
];

const FLAG: Same = Same::Words(&["true", "false"]);

/// Elements, each after what it stands in.
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

/// Tells what becomes of an attribute that 3.3.0 does not have; `None` where later versions do not have it either.
pub(super) fn attribute(rule: &Rule, name: &str, text: &str) -> Option<Later> {
    match (rule.name, name, text) {
        ("light", "type", "spot") => return Some(Later::As("directional", "false")),
        ("light", "type", "directional") => return Some(Later::As("directional", "true")),
        _ => {}
    }
    let has = |attribute: &str| rule.attributes().any(|attr| attr.name == attribute);
    let common = match rule.name {
        _ if has("noise") => SENSORS,
        _ if has("gear") || has("ctrlrange") => ACTUATORS,
        _ => &[],
    };
    let own = ATTRIBUTES.iter().filter(|(elements, ..)| elements.contains(&rule.name));
    let own = own.map(|(_, attribute, same)| (*attribute, same));
    let mut all = own.chain(common.iter().map(|(attribute, same)| (*attribute, same)));
    let (_, same) = all.find(|(attribute, _)| *attribute == name)?;
    let number = |word: &str| word.parse().unwrap_or(f64::NAN);
    let changes_nothing = match same {
        Same::Words(words) => words.contains(&text),
        Same::Zeros => text.split_whitespace().all(|word| number(word) == 0.0),
        Same::Number => number(text.trim()).is_finite(),
        Same::Never => false,
    };
    Some(if changes_nothing {
        Later::Nothing
    } else {
        Later::Refused
    })
}

/// Tells whether later versions have an element that 3.3.0 does not have.
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

    /// A scene with something in its world, and more behind it.
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
            let expected = format!("{what} is of a later MuJoCo than 3.3.0, whose language this is: remove it");
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
