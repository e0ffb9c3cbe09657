//! Sites of MIMo 3, v1, at points of the skeleton BODY_25.

use super::leg_lengths::FootLengths;
use super::lengths::Lengths;
use super::shapes::{BodyShapes, PartPosition, Side, on_x, on_z};

/// Adds the sites that move with growth. Heels do not keep their ratio to the foot but lie at the end of the sole, as in the original.
///
/// The ears of the original document are 52.5 mm from the middle of the head, those of growth 62.5 mm times its ratio.
pub(super) fn add(now: &Lengths, base: &Lengths, foot: &FootLengths, out: &mut BodyShapes) {
    let k = now.head_circumference / base.head_circumference;
    let breadth = now.foot_breadth / base.foot_breadth;
    let (nose, ear) = ([0.0685 * k, 0.0, 0.0435 * k], [0.01, 0.0625 * k, 0.0575 * k]);
    let (big, small) = (
        [0.011 * foot.ratio, -0.012 * breadth, 0.0],
        [0.01 * foot.ratio, 0.012 * breadth, 0.0],
    );
    let (ankle, heel) = (on_z(1.5 * foot.thickness), on_x(-0.035 * foot.ratio));
    let right = |[x, y, z]: [f64; 3]| [x, -y, z];
    let sites = [
        ("BODY_25:Nose", nose),
        ("BODY_25:LEar", ear),
        ("BODY_25:REar", right(ear)),
        ("BODY_25:LAnkle", ankle),
        ("BODY_25:RAnkle", ankle),
        ("BODY_25:LHeel", heel),
        ("BODY_25:RHeel", heel),
        ("BODY_25:LBigToe", big),
        ("BODY_25:RBigToe", right(big)),
        ("BODY_25:LSmallToe", small),
        ("BODY_25:RSmallToe", right(small)),
    ];
    // names of sides are their own here, without `left_` and `right_`
    let side = Side::Middle;
    out.sites
        .extend(sites.into_iter().map(|(name, pos)| PartPosition { name, side, pos }));
}
