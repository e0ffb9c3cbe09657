//! Tables of what a document says to programs, and of the states that it names.

use super::attribute::Sign::Any;
use super::attribute::{Kind, TEXT, int, real, some};
use super::table::table;

/// The greatest number of values in one `<numeric>`.
const MAX_NUMERIC: usize = 500;

table! {
    /// `<custom><numeric>`.
    element Numeric {
        "name" name: String = String::new(), TEXT, required, "Name.";
        "size" size: Option<usize> = None, int(1, MAX_NUMERIC as i64), "Number of values; else as many as are given.";
        "data" data: Vec<f64> = Vec::new(), some(0, MAX_NUMERIC, Any), "Values; the rest are 0.";
    }
}

table! {
    /// `<custom><text>`.
    element Text {
        "name" name: String = String::new(), TEXT, required, "Name.";
        "data" data: String = String::new(), TEXT, required, "Text.";
    }
}

table! {
    /// `<keyframe><key>`.
    element Key {
        "name" name: String = String::new(), TEXT, own, "Name.";
        "time" time: f64 = 0.0, real(Any), "Time, s.";
        "qpos" qpos: Vec<f64> = Vec::new(), Kind::State, "Positions (nq); else `qpos0`.";
        "qvel" qvel: Vec<f64> = Vec::new(), Kind::State, "Velocities (nv); else 0.";
        "act" act: Vec<f64> = Vec::new(), Kind::State, "Activations (na); else 0.";
        "ctrl" ctrl: Vec<f64> = Vec::new(), Kind::State, "Controls (nu); else 0.";
        "mpos" mpos: Vec<f64> = Vec::new(), Kind::Poses, "Positions of mocap bodies (3 nmocap), m; else those in the document.";
        "mquat" mquat: Vec<f64> = Vec::new(), Kind::Poses, "Orientations of mocap bodies (4 nmocap); else those in the document.";
    }
}
