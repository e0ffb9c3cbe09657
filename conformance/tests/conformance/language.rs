//! Small documents of the language's corners, each beside MuJoCo 3.3.0: names, compiled arrays, and steps; and documents that neither takes.

use babybench::assets::MemoryAssets;
use conformance::differential::compare::{Sides, Stepped, Taken};
use conformance::differential::state::Recipe;
use conformance::loading::{Outcome, compare, difference};
use conformance::mujoco::{MUJOCO, Mujoco, needed};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: documents_mean_what_they_mean_in_mujoco, what_mujoco_refuses_is_refused, copies_of_random_elements_are_those_of_mujoco, bodies_may_be_nested_deeply]
}

/// A leg with everything that something may refer to.
const LEG: &str = "<body name='leg' pos='.3 0 0'><joint name='hip' axis='0 1 0' range='-1 1'/><geom name='shin' size='.1' pos='0 0 .1'/><site name='foot' pos='.1 0 0'/>\
    <body name='toe' pos='.1 0 .2'><joint name='bend' axis='0 0 1'/><geom name='nail' type='capsule' size='.03 .05' pos='.1 0 0'/><site name='tip' pos='.1 .1 0'/></body></body>";

/// What refers to legs by their plain names.
const OF_LEGS: &str = "<contact><pair geom1='shin' geom2='nail' condim='1'/><pair name='p' geom1='floor' geom2='nail'/><exclude name='e' body1='leg' body2='base'/></contact>\
    <tendon><fixed name='f'><joint joint='hip' coef='1'/><joint joint='bend' coef='-.5'/></fixed><fixed name='mixed'><joint joint='spin' coef='1'/><joint joint='hip' coef='2'/></fixed>\
        <spatial name='s' stiffness='5'><site site='eye'/><site site='tip'/></spatial><spatial name='w'><site site='eye'/><geom geom='shin' sidesite='foot'/><site site='tip'/></spatial></tendon>\
    <equality><joint name='q' joint1='hip' joint2='bend' polycoef='.1 .5'/><connect body1='toe' body2='leg' anchor='0 0 0'/><tendon tendon1='f' active='false'/></equality>\
    <actuator><motor name='m' joint='hip'/><position joint='bend' kp='3'/><motor name='pull' tendon='f'/><general name='push' site='tip' refsite='foot'/></actuator>\
    <sensor><rangefinder name='r' site='foot'/><jointpos joint='hip'/><framepos name='x' objtype='site' objname='tip' reftype='body' refname='base'/><framequat objtype='body' objname='toe' reftype='body' refname='leg'/>\
        <tendonpos name='t' tendon='f'/><actuatorfrc actuator='m'/><subtreecom body='leg'/><distance geom1='nail' geom2='floor' cutoff='1'/><jointpos name='own' joint='spin'/></sensor>";

/// A base with legs around it.
fn legs(copies: &str) -> String {
    format!(
        "<worldbody><geom name='floor' type='plane' size='3 3 1' pos='0 0 -.3'/><body name='base' pos='0 0 .2'><joint name='spin'/><geom name='hub' size='.1'/>\
         <site name='eye' pos='0 0 .3'/>{copies}</body></worldbody>{OF_LEGS}"
    )
}

/// Contents of `<mujoco>`, each after what it is about.
fn documents() -> Vec<(&'static str, String)> {
    let owned = |(about, text): &(&'static str, &str)| (*about, (*text).to_owned());
    let mut all: Vec<_> = DOCUMENTS.iter().map(owned).collect();
    let around = |count: usize, inside: &str| format!("<replicate count='{count}' euler='0 0 70'>{inside}</replicate>");
    all.push(("plain names of what is copied", legs(&around(3, LEG))));
    all.push((
        "plain names of what is copied with a separator",
        legs(&around(3, LEG).replace("count", "sep='-' count")),
    ));
    all.push(("ten copies and more have two digits", legs(&around(11, LEG))));
    all.push(("plain names of copies of copies", legs(&around(2, &around(2, LEG)))));
    all.push((
        "no copies at all",
        legs(&around(0, LEG)).replace(OF_LEGS, "<sensor><jointpos joint='spin'/></sensor>"),
    ));
    all
}

const DOCUMENTS: &[(&str, &str)] = &[
    (
        "a ring of rangefinders",
        "<worldbody><geom type='plane' size='9 9 1'/><geom type='box' size='.2 .2 .2' pos='2 0 0'/><body pos='0 0 .1'><freejoint/><geom size='.05'/>\
         <replicate count='36' euler='0 0 10'><site name='ray' pos='.1 0 0' zaxis='1 0 0'/></replicate></body></worldbody><sensor><rangefinder name='lidar' site='ray'/></sensor>",
    ),
    (
        "a tendon around a geom without a side site is lost with the original",
        "<worldbody><site name='a' pos='0 0 1'/><replicate count='2' offset='1 0 0'><body name='b'><joint name='j'/><geom name='g' size='.1'/><site name='s' pos='.3 0 0'/></body></replicate></worldbody>\
         <tendon><spatial name='t'><site site='a'/><geom geom='g'/><site site='s'/></spatial></tendon><actuator><motor name='m' tendon='t'/><motor joint='j'/></actuator>",
    ),
    (
        "an equality of a copy and of something else is lost with the original",
        "<worldbody><body name='o'><joint name='k'/><geom size='.1'/></body><replicate count='2' offset='1 0 0'><body name='b'><joint name='j'/><geom name='g' size='.1'/></body></replicate></worldbody>\
         <equality><joint joint1='j' joint2='k'/><joint joint1='j'/></equality>",
    ),
    (
        "sensors of nothing are multiplied",
        "<worldbody><replicate count='3' offset='1 0 0'><body><joint/><geom size='.1'/></body></replicate></worldbody><sensor><clock name='c'/><user dim='2'/></sensor>",
    ),
    (
        "what is copied is called as something else with a number",
        "<worldbody><body name='b'><joint name='j'/><geom size='.1'/></body><replicate count='2' offset='1 0 0'><body><joint name='j' axis='0 1 0'/><geom size='.1'/></body></replicate></worldbody>\
         <sensor><jointpos name='s' joint='j'/></sensor>",
    ),
    (
        "a keyframe beside copies",
        "<worldbody><replicate count='3' offset='.5 0 0'><body pos='0 0 1'><freejoint/><geom size='.1'/></body></replicate></worldbody><keyframe><key name='high' time='2' qpos='0 0 2 1 0 0 0'/></keyframe>",
    ),
    (
        "a keyframe of everything beside copies",
        "<worldbody><body name='a'><joint name='k' ref='20'/><geom size='.1'/></body><replicate count='2' offset='.5 0 0'><body pos='0 0 1'><joint name='j' ref='30'/><geom size='.1'/></body>\
         <body mocap='true' pos='1 0 0'><geom size='.1'/></body></replicate></worldbody><actuator><motor joint='k'/><general name='m' joint='j' dyntype='filter' dynprm='.1'/></actuator>\
         <keyframe><key name='one' qpos='.1 .2' qvel='1 2' ctrl='3 4' act='5' mpos='1 2 3' mquat='0 1 0 0'/><key name='two' qpos='.3 .4'/></keyframe>",
    ),
    (
        "a keyframe beside two replicates",
        "<worldbody><replicate count='2' offset='.5 0 0'><body pos='0 0 1'><joint name='j'/><geom size='.1'/></body></replicate>\
         <replicate count='2' offset='.5 0 0'><body pos='0 0 1'><joint name='i'/><geom size='.1'/></body></replicate></worldbody><keyframe><key name='k' qpos='.2'/></keyframe>",
    ),
    (
        "keyframes that are asked for beside no copies",
        "<size nkey='2'/><worldbody><replicate count='0'><geom size='.1'/></replicate></worldbody><keyframe><key name='k'/></keyframe>",
    ),
    (
        "keyframes without names",
        "<worldbody><body><joint/><geom size='.1'/></body><replicate count='0'><geom size='.1'/></replicate></worldbody><keyframe><key/><key time='3'/></keyframe>",
    ),
    (
        "an inertial in a replicate is lost",
        "<worldbody><body><joint/><geom size='.1'/><replicate count='2'><inertial pos='0 0 0' mass='9' diaginertia='1 1 1'/></replicate></body></worldbody>",
    ),
    (
        "attributes without numbers are not given",
        "<default><geom user='5 6 7'/></default><worldbody><body pos='' quat=' '><freejoint/><geom size='.1' user='' rgba=''/></body></worldbody>",
    ),
    (
        "lights that are off",
        "<worldbody><light active='false'/><light/></worldbody>",
    ),
    (
        "cameras with parallel rays",
        "<worldbody><camera orthographic='true' fovy='2'/><camera orthographic='false'/></worldbody>",
    ),
    (
        "an extension that says nothing",
        "<extension/><worldbody><geom size='.1'/></worldbody>",
    ),
    (
        "groups beyond those of the viewer",
        "<worldbody><body><joint group='8'/><geom size='.1' group='6'/><geom size='.05'/><site group='7'/></body></worldbody>",
    ),
    (
        "all bits of collision",
        "<worldbody><geom size='.1' contype='-1'/><body><freejoint/><geom size='.1' contype='0' conaffinity='-2147483648'/></body></worldbody>",
    ),
    (
        "text of other kinds",
        "<!-- a --><worldbody><![CDATA[ text ]]><body>text<freejoint/><geom size='.1'/></body></worldbody>",
    ),
    (
        "weight is lifted where some body's is",
        "<worldbody><body gravcomp='-1'><freejoint/><geom size='.1'/></body></worldbody>",
    ),
    (
        "weight is added beside some that is lifted",
        "<worldbody><body gravcomp='-1'><freejoint/><geom size='.1'/></body><body pos='1 0 0' gravcomp='.5'><freejoint/><geom size='.1'/></body></worldbody>",
    ),
    (
        "rays pass what its material shows through",
        "<asset><material name='clear' rgba='1 1 1 0'/><material name='red' rgba='1 0 0 1'/></asset><worldbody><geom size='.1' pos='.5 0 0' material='clear' rgba='1 0 0 1'/><geom size='.1' pos='0 .5 0' material='red' rgba='0 0 0 0'/>\
         <geom size='.1' pos='0 0 .5' rgba='0 0 0 0'/><body><freejoint/><geom size='.01' contype='0' conaffinity='0'/><site name='x' zaxis='1 0 0'/><site name='y' zaxis='0 1 0'/><site name='z'/></body></worldbody>\
         <sensor><rangefinder site='x'/><rangefinder site='y'/><rangefinder site='z'/></sensor>",
    ),
    (
        "the extent of a world without geoms along x",
        "<worldbody><site/><site pos='3 .8 0'/></worldbody>",
    ),
    ("the extent of nothing", "<worldbody/>"),
    (
        "the extent of a world without geoms",
        "<worldbody><site/><site pos='0 .8 0'/><body pos='0 0 3'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody>",
    ),
    (
        "muscles with negative numbers",
        "<worldbody><body><joint name='j' axis='0 1 0'/><geom size='.1' pos='.1 0 0'/></body></worldbody><actuator><muscle joint='j' lengthrange='-1 1' lmin='-.5' force='-2'/><muscle joint='j' lengthrange='-1 1' range='-1 -.5'/>\
         <muscle joint='j' lengthrange='-1 1' range='-.5 .5' timeconst='-1 .02'/></actuator>",
    ),
    (
        "limits of a cable follow from its range",
        "<worldbody><body><composite type='cable' prefix='q' curve='s' count='4 1 1' size='1' initial='none'><joint kind='main' damping='.1' limited='true'/><geom type='capsule' size='.01'/></composite>\
         <composite type='cable' prefix='r' curve='s' count='4 1 1' size='1' initial='none'><joint kind='main' damping='.1' limited='false' range='0 20'/><geom type='capsule' size='.01'/></composite></body></worldbody>",
    ),
    (
        "user data of cameras by default",
        "<default><camera user='1 2 3'/></default><worldbody><camera/><camera user='4'/></worldbody>",
    ),
    (
        "sizes that a fitted shape does not use",
        "<default><geom size='1 2 3'/></default><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><geom type='sphere' mesh='m'/><geom type='capsule' mesh='m'/><geom type='box' mesh='m'/></worldbody>",
    ),
    (
        "a box in a turned frame on the floor",
        "<worldbody><geom type='plane' size='50 50 1'/><frame euler='0 0 12'><body pos='0 -15 2'><freejoint/><geom type='box' size='1 .5 2'/></body></frame></worldbody>",
    ),
    (
        "a box in turned frames on the floor",
        "<worldbody><geom type='plane' size='50 50 1'/><replicate count='9' euler='0 0 37' offset='.3 .1 0'><frame pos='1 2 0' euler='0 0 12'><body pos='0 -15 2'><freejoint/><geom type='box' size='1 .5 2'/></body></frame></replicate></worldbody>",
    ),
    (
        "no room for contacts",
        "<size nconmax='0'/><worldbody><geom type='plane' size='2 2 .1'/><body pos='0 0 .09'><freejoint/><geom size='.1'/></body></worldbody>",
    ),
    (
        "spheres that touch",
        "<worldbody><body pos='-.3 0 0'><freejoint/><geom size='.1'/></body><body pos='-.1 0 0'><freejoint/><geom size='.1'/></body></worldbody>",
    ),
    (
        "spheres that hardly overlap far away",
        "<worldbody><replicate count='6' offset='.1999999 0 0'><body pos='30 1 2'><freejoint/><geom size='.1'/></body></replicate><body><joint/><geom size='.1'/></body></worldbody>",
    ),
    (
        "spheres along a diagonal that hardly overlap",
        "<worldbody><replicate count='9' offset='.11999999 .16 0'><body pos='3 1 2'><freejoint/><geom size='.1'/></body></replicate></worldbody>",
    ),
    (
        "a ball at rest without friction",
        "<worldbody><geom type='plane' size='2 2 .1' friction='0 0 0'/><body pos='0 0 .0999'><freejoint/><geom size='.1' mass='.1' friction='0 0 0'/><site name='s' size='.2'/></body></worldbody><sensor><touch site='s'/></sensor>",
    ),
    (
        "rays at the sides of height fields",
        "<asset><hfield name='h' nrow='4' ncol='2' size='1 1 1 .1' elevation='1 0 1 .5 0 0 1 1'/><hfield name='i' nrow='2' ncol='3' size='1 1 1 .1' elevation='1 1 1 0 .3 0'/></asset><worldbody><geom type='hfield' hfield='h'/>\
         <body pos='-2 .6 .5'><freejoint/><geom size='.01'/><site name='s' zaxis='1 0 0'/><site name='t' zaxis='1 -.2 0'/><site name='u' zaxis='1 -.4 0'/></body></worldbody><sensor><rangefinder site='s'/><rangefinder site='t'/><rangefinder site='u'/></sensor>",
    ),
];

/// Documents that neither side takes.
const REFUSED: &[&str] = &[
    "<size memory='abc'/>",
    "<size memory='1M' nstack='100'/>",
    "<size memory='1M' njmax='100'/>",
    "<worldbody><geom size='.1' contype='2147483648'/></worldbody>",
    "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 2 1 0 1 3.0 0 3 2 1 2 3'/></asset>",
    "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' content_type='x'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody>",
    "<option o_margin='0 0'/>",
    "<option o_solref='0 0 0'/>",
    "<worldbody><body><inertial pos='0 0 0' mass='1' quat='1 0 0 0' fullinertia='1 1 1 0 0 0'/></body></worldbody>",
    "<asset><texture name='t' builtin='gradient' width='10923' height='2'/></asset>",
    "<worldbody><replicate count='2' offset='1 0 0'><body><joint/><geom size='.1' pos='.1 0 0'/></body></replicate></worldbody><keyframe><key name='k' qpos='1 2'/></keyframe>",
    "<worldbody><replicate count='2'><joint/></replicate></worldbody>",
    "<worldbody><replicate count='2'><body name='b'><joint name='j'/><geom size='.1'/></body></replicate></worldbody><contact><exclude body1='b' body2='nowhere'/></contact>",
    "<worldbody><replicate count='2' offset='1 0 0'><body><joint/><geom size='.1'/></body></replicate></worldbody><keyframe><key name='k'/><key name='k'/></keyframe>",
    "<worldbody><body><joint name='j'/><geom size='.1'/></body></worldbody><actuator><muscle joint='j' lengthrange='-1 1' scale='-3'/></actuator>",
    "<extension a='1'/>",
];

fn whole(content: &str) -> String {
    format!("<mujoco>{content}</mujoco>")
}

/// Returns where the sides differ.
fn differences(api: &'static Mujoco, content: &str) -> Vec<String> {
    let mut sides = match Sides::load(api, &whole(content)) {
        Taken::Both(sides) => sides,
        Taken::Refused(why) => return vec![format!("neither side takes it: {why}")],
        Taken::Stricter(why) => return vec![format!("ours refuses {why}")],
        Taken::ByOne(measured) => return vec![measured.place],
    };
    let model = sides.model.clone();
    let mut all: Vec<String> = difference(&model, sides.simulation()).into_iter().collect();
    // models with different elements have different states
    let states = if model.nv > 0 && all.is_empty() { 8 } else { 0 };
    for seed in 0..states {
        let start = sides.new_state();
        let stepped = if seed == 0 {
            sides.step_from(&start)
        } else {
            sides.step(&Recipe::new(seed))
        };
        if let Stepped::Compared { measured, why, .. } = stepped
            && why == conformance::differential::compare::Why::Ours
        {
            let far = measured.into_iter().filter(|one| one.error > one.limit);
            all.extend(far.map(|one| format!("state {seed}: {} {}", one.quantity, one.place)));
        }
    }
    all
}

fn documents_mean_what_they_mean_in_mujoco() {
    let api = needed();
    let mut faults = Vec::new();
    for (about, content) in documents() {
        faults.extend(
            differences(api, &content)
                .first()
                .map(|fault| format!("{about}: {fault}")),
        );
    }
    faults.iter().for_each(|fault| show!("{fault}"));
    assert!(faults.is_empty(), "{} faults, the first: {}", faults.len(), faults[0]);
}

fn what_mujoco_refuses_is_refused() {
    let api = needed();
    for content in REFUSED {
        let text = whole(content);
        let outcome = compare(api, "m.xml", &[("m.xml", &text)], &MemoryAssets::new());
        assert_eq!(outcome, Outcome::Rejected, "{content}");
    }
}

/// As many bodies in each other as MuJoCo takes, or nearly so.
fn bodies_may_be_nested_deeply() {
    let text = whole(&format!(
        "<worldbody>{}{}</worldbody>",
        "<body pos='0 0 .01'><geom size='.01'/>".repeat(400),
        "</body>".repeat(400)
    ));
    let outcome = compare(needed(), "m.xml", &[("m.xml", &text)], &MemoryAssets::new());
    assert_eq!(outcome, Outcome::Equal);
}

/// Random parts of the legs, in random copies.
fn copies_of_random_elements_are_those_of_mujoco() {
    let api = needed();
    let mut rng = testkit::Rng::with_seed(51);
    let referring: Vec<(&str, Vec<&str>)> = sections();
    let (mut taken, mut faults) = (0, Vec::new());
    for _ in 0..300 {
        let mut content = String::new();
        for (section, elements) in &referring {
            let some: String = elements.iter().filter(|_| rng.usize(..3) == 0).copied().collect();
            content += &format!("<{section}>{some}</{section}>");
        }
        let mut copies = LEG.to_owned();
        for _ in 0..rng.usize(1..3) {
            copies = format!(
                "<replicate count='{}' offset='.1 0 0' euler='0 0 {}'>{copies}</replicate>",
                rng.usize(..4),
                rng.usize(..90)
            );
        }
        let text = legs(&copies).replace(OF_LEGS, &content);
        let text = whole(&text);
        match compare(api, "m.xml", &[("m.xml", &text)], &MemoryAssets::new()) {
            Outcome::Equal => taken += 1,
            Outcome::Rejected => {}
            Outcome::Stricter(why) => faults.push(format!("{why}: {text}")),
            Outcome::Fault(fault) => faults.push(format!("{fault}: {text}")),
        }
    }
    faults.iter().take(5).for_each(|fault| show!("{fault}"));
    assert!(faults.is_empty(), "{} faults, the first: {}", faults.len(), faults[0]);
    assert!(taken > 100, "{taken}");
}

/// Returns the sections of [`OF_LEGS`] with their elements.
fn sections() -> Vec<(&'static str, Vec<&'static str>)> {
    let mut all = Vec::new();
    for section in ["contact", "tendon", "equality", "actuator", "sensor"] {
        let (start, end) = (format!("<{section}>"), format!("</{section}>"));
        let from = OF_LEGS.find(&start).expect("a section") + start.len();
        let to = from + OF_LEGS[from..].find(&end).expect("its end");
        let (mut elements, mut rest) = (Vec::new(), OF_LEGS[from..to].trim());
        while !rest.is_empty() {
            let name = rest[1..].split([' ', '>', '/']).next().expect("a name");
            let close = format!("</{name}>");
            let own = if section == "tendon" {
                rest.find(&close).expect("its end") + close.len()
            } else {
                rest.find("/>").expect("its end") + 2
            };
            elements.push(&rest[..own]);
            rest = rest[own..].trim();
        }
        all.push((section, elements));
    }
    all
}
