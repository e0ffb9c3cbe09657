use super::*;
use crate::assets::MemoryAssets;

const ROOM: &str = r#"<mujoco model="room"><compiler angle="degree" autolimits="true"/>
  <default><geom rgba=".1 .2 .3 1" friction=".5"/><joint damping=".1"/><motor gear="3"/>
    <default class="leg"><geom size=".02" rgba="1 0 0 1"/><joint range="-30 40"/><position kp="7"/></default></default>
  <asset><texture name="sky" builtin="flat" type="2d" width="4" height="4"/><material name="skin" texture="sky"/></asset>
  <worldbody><geom name="floor" type="plane" size="1 1 .1"/>
    <body name="hip" pos="0 0 1" childclass="leg"><freejoint name="root"/><geom name="trunk" material="skin"/>
      <frame euler="0 30 0"><body name="shin" pos="0 0 -.2"><joint name="knee" axis="0 1 0"/><geom name="shank"/><site name="toe"/></body></frame>
    </body></worldbody>
  <contact><exclude body1="hip" body2="shin"/><pair geom1="floor" geom2="shank"/></contact>
  <tendon><fixed name="string"><joint joint="knee" coef="2"/></fixed></tendon>
  <actuator><motor name="pull" joint="knee"/><position name="hold" joint="knee" class="leg" kv="1"/><motor tendon="string"/></actuator>
  <sensor><touch name="touch" site="toe"/><actuatorfrc actuator="hold"/><clock/></sensor></mujoco>"#;

fn read(text: &str) -> Document {
    Document::read_str(text, "room.xml", &MemoryAssets::new()).unwrap()
}

fn arrays(document: &Document) -> crate::model::Arrays {
    document.compile(&MemoryAssets::new()).unwrap().into_parts().0
}

/// Returns all numbers and names of a compiled model, which print exactly.
fn model(document: &Document) -> String {
    format!("{:?}", arrays(document))
}

#[test]
fn a_document_that_is_read_and_written_compiles_to_the_same_bits() {
    let spec = crate::load_str(ROOM, "room.xml", &MemoryAssets::new()).unwrap();
    assert_eq!(model(&read(ROOM)), format!("{:?}", spec.into_parts().0));
    let again = read(&read(ROOM).write());
    assert_eq!(again.write(), read(ROOM).write());
}

#[test]
fn elements_are_found_added_changed_and_removed() {
    let mut room = read(ROOM);
    let shin = room.find(Kind::Body, "shin").unwrap();
    let toe = room.find(Kind::Site, "toe").unwrap();
    assert_eq!(room.parent(toe).unwrap(), Some(shin));
    assert_eq!(
        room.value(room.find(Kind::Geom, "shank").unwrap(), "rgba").unwrap(),
        "1 0 0 1"
    );
    assert_eq!(
        room.value(room.find(Kind::Geom, "shank").unwrap(), "friction").unwrap(),
        ".5"
    );
    assert_eq!(
        room.value(room.find(Kind::Geom, "floor").unwrap(), "rgba").unwrap(),
        ".1 .2 .3 1"
    );
    assert_eq!(room.value(toe, "size").unwrap(), "0.005 0.005 0.005");
    assert_eq!(room.class_of(toe).unwrap(), "leg");
    let ball = room.add(shin, "body").unwrap();
    let geom = room.add(ball, "geom").unwrap();
    room.set(geom, "size", "0.1").unwrap();
    room.set(ball, "euler", "0 0 90").unwrap();
    room.set(ball, "quat", "1 0 0 0").unwrap();
    assert_eq!(room.attribute(ball, "euler").unwrap(), None);
    room.set(geom, "name", "ball").unwrap();
    room.unset(geom, "name").unwrap();
    assert_eq!(arrays(&room).geom_type.len(), 4);
    let gone = room.remove(shin).unwrap();
    // exclude, pair, tendon, both motors, the servo, both sensors
    assert_eq!(gone.len(), 8);
    assert!(!room.contains(ball));
    let arrays = arrays(&room);
    assert_eq!(
        (
            arrays.body_name.len(),
            arrays.sensor_name.len(),
            arrays.actuator_name.len()
        ),
        (2, 1, 0)
    );
    room.remove_alone(room.find(Kind::Material, "skin").unwrap()).unwrap();
    let error = room.compile(&MemoryAssets::new()).unwrap_err().to_string();
    assert!(error.ends_with("material: there is no material \"skin\""), "{error}");
}

#[test]
fn what_cannot_be_says_so_and_changes_nothing() {
    let mut room = read(ROOM);
    let before = room.write();
    let hip = room.find(Kind::Body, "hip").unwrap();
    let geom = room.find(Kind::Geom, "trunk").unwrap();
    let told = |result: Result<(), EditError>, expect: &str| assert_eq!(result.unwrap_err().to_string(), expect);
    told(
        room.add(hip, "goem").map(drop),
        "<body> cannot hold <goem>; did you mean \"geom\"?",
    );
    told(
        room.set(geom, "sizes", "1"),
        "<geom> has no attribute \"sizes\"; did you mean \"size\"?",
    );
    told(room.set(geom, "nonsense", "1"), "<geom> has no attribute \"nonsense\"");
    told(room.set(geom, "size", "-1"), "<geom>: size: -1 must be at least 0");
    told(
        room.remove(room.world()).map(drop),
        "<worldbody> cannot be removed: a document needs it",
    );
    told(
        room.set(ElementId(999), "name", "x"),
        "element 999 is not in this document: it was removed, or belongs to another document",
    );
    let other = room.clone();
    told(
        room.attach(room.world(), &other, hip, "", "").map(drop),
        "body name \"hip\" is used twice: attach with another prefix or suffix",
    );
    let floor = room.find(Kind::Geom, "floor").unwrap();
    told(
        room.attach(room.world(), &other, floor, "a", "").map(drop),
        "cannot attach: only bodies, frames and the world of another document can be attached",
    );
    let strict = read(&ROOM.replace("autolimits=\"true\"", "autolimits=\"false\""));
    told(
        room.attach(room.world(), &strict, hip, "a", "").map(drop),
        "cannot attach: compiler has autolimits=\"true\" here, and autolimits=\"false\" where the attached body is from: use the same value in \
         both documents",
    );
    let keyed = read(&ROOM.replace("<sensor>", "<keyframe><key ctrl='1 1 1'/></keyframe><sensor>"));
    let hip = keyed.find(Kind::Body, "hip").unwrap();
    assert!(
        room.attach(room.world(), &keyed, hip, "a", "")
            .unwrap_err()
            .to_string()
            .contains("keyframes")
    );
    assert_eq!(room.write(), before);
}

/// A body attached in the program and the same body attached by MJCF's own element give the same model.
#[test]
fn attaching_is_what_attach_of_a_document_does() {
    let parent = r#"<mujoco model="all"><compiler/><default><geom friction=".3" condim="4"/><motor gear="2"/></default><worldbody><geom size="1"/></worldbody>
      <actuator/><sensor><clock name="own"/></sensor></mujoco>"#;
    let by_element = parent
        .replace(
            "<worldbody>",
            "<asset><model name='part' file='part.xml'/></asset><worldbody>",
        )
        .replace(
            "<geom size=\"1\"/>",
            "<geom size=\"1\"/><frame pos='1 2 3' euler='0 0 20'><attach model='part' body='hip' prefix='b_'/></frame>",
        );
    let mut files = MemoryAssets::new();
    files.insert("part.xml", ROOM).unwrap();
    let expected = crate::load_str(&by_element, "all.xml", &files).unwrap().into_parts().0;
    let mut all = Document::read_str(parent, "all.xml", &files).unwrap();
    let part = read(ROOM);
    let frame = all.add(all.world(), "frame").unwrap();
    all.set(frame, "pos", "1 2 3").unwrap();
    all.set(frame, "euler", "0 0 20").unwrap();
    let root = all
        .attach(frame, &part, part.find(Kind::Body, "hip").unwrap(), "b_", "")
        .unwrap();
    assert_eq!(all.attribute(root, "name").unwrap(), Some("b_hip"));
    assert_eq!(model(&all), format!("{expected:?}"));
    // the same again, with a suffix, shares nothing and collides with nothing
    all.attach(frame, &part, part.find(Kind::Body, "hip").unwrap(), "", "_2")
        .unwrap();
    assert!(arrays(&all).body_name.contains(&"shin_2".to_owned()));
}

#[test]
fn angles_are_converted_where_documents_differ() {
    let radians = read(
        &ROOM
            .replace("angle=\"degree\"", "angle=\"radian\"")
            .replace("-30 40", "-.5 .7")
            .replace("<pair geom1=\"floor\" geom2=\"shank\"/>", ""),
    );
    let hip = radians.find(Kind::Body, "hip").unwrap();
    let mut room = read(ROOM);
    let before = arrays(&room);
    room.attach(room.world(), &radians, hip, "other_", "").unwrap();
    let after = arrays(&room);
    assert_eq!(after.jnt_range[..2], before.jnt_range[..]);
    assert_eq!(after.jnt_range[3], [-0.5, 0.7]);
    assert_eq!(after.body_quat[..3], before.body_quat[..]);
}

#[test]
fn actuators_of_all_kinds_are_general_ones_that_act_the_same() {
    let kinds = r#"<mujoco><default><position kv="2"/><default class="a"><muscle force="5"/></default></default>
      <worldbody><body><joint name="j" range="-1 1"/><geom size="1"/></body></worldbody><actuator>
      <motor joint="j"/><position joint="j" kp="3" dampratio=".5"/><velocity joint="j" kv="2" ctrlrange="-1 1"/>
      <intvelocity joint="j" actrange="-1 1"/><damper joint="j" kv="1" ctrlrange="0 1"/><cylinder joint="j" area="2"/>
      <muscle joint="j" class="a" lengthrange="1 2"/><general joint="j"/></actuator></mujoco>"#;
    let mut document = read(kinds);
    let before = model(&document);
    for id in document.all(Kind::Actuator) {
        document.generalize(id).unwrap();
        assert_eq!(document.element(id).unwrap(), "general");
    }
    assert_eq!(model(&document), before);
}

#[test]
fn files_of_other_folders_are_found() {
    let quad = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";
    let mut files = MemoryAssets::new();
    let meshes = "<mujoco><compiler meshdir='shapes'/><asset><mesh file='a.obj'/></asset>";
    let part = format!("{meshes}<worldbody><body name='x'><geom type='mesh' mesh='a'/></body></worldbody></mujoco>");
    files.insert("toys/part.xml", part.as_str()).unwrap();
    files.insert("toys/shapes/a.obj", quad).unwrap();
    files
        .insert("toys/inner.xml", "<mujoco><asset><mesh file='b.obj'/></asset></mujoco>")
        .unwrap();
    files.insert("toys/b.obj", quad).unwrap();
    let text = "<mujoco><compiler meshdir='own'/><include file='toys/inner.xml'/>\
                <worldbody><geom type='mesh' mesh='b'/></worldbody></mujoco>";
    let mut room = Document::read_str(text, "room.xml", &files).unwrap();
    let part = Document::read(&files, "toys/part.xml").unwrap();
    room.attach(room.world(), &part, part.find(Kind::Body, "x").unwrap(), "p_", "")
        .unwrap();
    let arrays = room.compile(&files).unwrap().into_parts().0;
    assert_eq!((arrays.geom_type.len(), arrays.meshes.len()), (2, 2));
}
