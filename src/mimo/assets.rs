//! The MJCF and textures embedded in the library.

use crate::assets::EmbeddedAssets;

macro_rules! embed {
    ($($path:literal),* ; $($face:literal),* $(,)?) => {
        /// Paths and contents of the embedded files.
        const FILES: &[(&str, &[u8])] = &[
            $(($path, include_bytes!(concat!("../../assets/", $path))),)*
            // the documents name all faces, so faces that are left out must still exist by name
            $(($face, if cfg!(feature = "eval") { include_bytes!(concat!("../../assets/", $face)) } else { &[] }),)*
        ];
    };
}

embed![
    "babybench/base.xml",
    "babybench/blanket.xml",
    "babybench/catch.xml",
    "babybench/catch_arm.xml",
    "babybench/classes_common.xml",
    "babybench/classes_v1.xml",
    "babybench/classes_v2.xml",
    "babybench/crib.xml",
    "babybench/cubes.xml",
    "babybench/head_v2.xml",
    "babybench/left_arm_v2.xml",
    "babybench/legs_v2.xml",
    "babybench/looks.xml",
    "babybench/meta_common.xml",
    "babybench/meta_v1.xml",
    "babybench/meta_v2.xml",
    "babybench/mimo_v1.xml",
    "babybench/mimo_v2.xml",
    "babybench/mobile.xml",
    "babybench/motor_arms.xml",
    "babybench/motor_body.xml",
    "babybench/motor_eyes.xml",
    "babybench/motor_feet_v1.xml",
    "babybench/motor_feet_v2.xml",
    "babybench/motor_fingers_v1.xml",
    "babybench/motor_fingers_v2.xml",
    "babybench/motor_hands.xml",
    "babybench/motor_head.xml",
    "babybench/motor_left_arm.xml",
    "babybench/motor_legs.xml",
    "babybench/motor_right_arm.xml",
    "babybench/motor_spine.xml",
    "babybench/playroom.xml",
    "babybench/position_arms.xml",
    "babybench/position_body.xml",
    "babybench/position_eyes.xml",
    "babybench/position_feet_v1.xml",
    "babybench/position_feet_v2.xml",
    "babybench/position_fingers_v1.xml",
    "babybench/position_fingers_v2.xml",
    "babybench/position_hands.xml",
    "babybench/position_head.xml",
    "babybench/position_legs.xml",
    "babybench/reach.xml",
    "babybench/right_arm_v2.xml",
    "babybench/roll_over.xml",
    "babybench/selfbody.xml",
    "babybench/senses_task.xml",
    "babybench/senses_trunk.xml",
    "babybench/senses_v1.xml",
    "babybench/senses_v2.xml",
    "babybench/settings.xml",
    "babybench/standup.xml",
    "babybench/task_objects.xml",
    "babybench/task_world.xml",
    "mimo3/catch_arm.xml",
    "mimo3/mimo_v1.xml",
    "mimo3/mimo_v2.xml",
    "mimo3/motor_body.xml",
    "mimo3/motor_feet_v2.xml",
    "mimo3/position_body.xml",
    "mimo3/reference/catch_arm.xml",
    "mimo3/reference/senses_task.xml",
    "mimo3/reference/senses_trunk.xml",
    "mimo3/roll_over.xml",
    "mimo3/senses_task.xml",
    "mimo3/senses_trunk.xml",
    "tex/eye_left.png",
    "tex/eye_right.png",
    "tex/face_default.png",
    "tex/head_back.png",
    "tex/head_left.png",
    "tex/head_right.png",
    "tex/head_top.png",
    "tex/leg_back.png",
    "tex/leg_down.png",
    "tex/leg_front.png",
    "tex/leg_left.png",
    "tex/leg_right.png",
    "tex/leg_up.png",
    "tex/rug.png",
    "tex/sleeve_back.png",
    "tex/sleeve_down.png",
    "tex/sleeve_front.png",
    "tex/sleeve_left.png",
    "tex/sleeve_right.png",
    "tex/sleeve_up.png",
    "toys/cup_bottom.obj",
    "toys/cup_stave.obj",
    "toys/duck_beak.obj",
    "toys/duck_body.obj",
    "toys/lid_round_corner.obj",
    "toys/lid_round_side.obj",
    "toys/lid_wedge_0.obj",
    "toys/lid_wedge_1.obj",
    "toys/lid_wedge_2.obj",
    "toys/rattle_handle.obj",
    "toys/rattle_head.obj",
    "toys/ring_bow.obj",
    "toys/wedge.obj";
    "tex/face_angry.png",
    "tex/face_disgusted.png",
    "tex/face_happy.png",
    "tex/face_sad.png",
    "tex/face_scared.png",
    "tex/face_surprised.png",
];

/// Returns the embedded assets, laid out like the original: `babybench/*.xml`, `tex/*.png`; beside them `toys/*.obj` and, for MIMo 3,
/// `mimo3/*.xml`. Of MIMo's faces, `tex/face_*.png`, there is only the default one without the feature `faces`.
pub fn embedded() -> EmbeddedAssets {
    EmbeddedAssets(FILES)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    fn walk(dir: &Path, prefix: &str, out: &mut BTreeSet<String>) {
        for entry in std::fs::read_dir(dir).unwrap().map(Result::unwrap) {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.file_type().unwrap().is_dir() {
                walk(&entry.path(), &format!("{name}/"), out);
            } else {
                out.insert(name);
            }
        }
    }

    #[cfg(all(feature = "eval", feature = "npz"))] // all documents are in the library then
    #[test]
    fn every_asset_is_embedded() {
        let mut found = BTreeSet::new();
        walk(&Path::new(env!("CARGO_MANIFEST_DIR")).join("assets"), "", &mut found);
        let mut embedded: BTreeSet<String> = FILES.iter().map(|f| f.0.to_string()).collect();
        embedded.extend(crate::eval::protocol::Protocol::names().map(|name| format!("protocols/{name}.yml")));
        assert_eq!(found, embedded);
    }
}
