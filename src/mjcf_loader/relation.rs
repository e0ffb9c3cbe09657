//! Tables of elements that refer to bodies, joints, geoms and sites: contact, equalities, tendons.

use crate::math::Vec3;

use super::attribute::Sign::{Any, NonNegative, Positive};
use super::attribute::{AttributeField, AttributeKind, FLAG, RANGE, TEXT, Value, int, real, reals, some};
use super::error::UNREAD;
use super::schema::Element;
use super::table::{Table, table};
use super::words::{AutoBool, GREY, MAX_GROUP, MIN_GROUP, SOLIMP, SOLREF, TRI};

table! {
    /// `<pair>`.
    element Pair {
        "name" name: String = String::new(), TEXT, own, "Name.";
        "geom1" geom1: String = String::new(), TEXT, required, "First geom.";
        "geom2" geom2: String = String::new(), TEXT, required, "Second geom.";
        "condim" condim: usize = 3, int(1, 6), "Dimension of the contacts: 1, 3, 4 or 6.";
        "friction" friction: [f64; 5] = [1.0, 1.0, 0.005, 0.0001, 0.0001], some(1, 5, NonNegative), "Friction: two sliding, one torsional, two rolling.";
        "solref" solref: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of the normal force.";
        "solreffriction" solreffriction: [f64; 2] = [0.0; 2], some(1, 2, Any), "`solref` of friction; zeros for that of the normal force.";
        "solimp" solimp: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of the contacts.";
        "margin" margin: f64 = 0.0, real(NonNegative), "Distance at which contacts are found, m.";
        "gap" gap: f64 = 0.0, real(NonNegative), "Part of the margin in which contacts exert no force, m.";
    }
}

table! {
    /// `<exclude>`.
    element Exclude {
        "name" name: String = String::new(), TEXT, own, "Name.";
        "body1" body1: String = String::new(), TEXT, required, "First body.";
        "body2" body2: String = String::new(), TEXT, required, "Second body.";
    }
}

table! {
    /// Attributes of `<equality><joint>`.
    group JointEquality {
        "joint1" joint1: String = String::new(), TEXT, required, "Joint that is held.";
        "joint2" joint2: Option<String> = None, TEXT, own, "Joint that it follows; none for a constant.";
        "polycoef" polycoef: [f64; 5] = [0.0, 1.0, 0.0, 0.0, 0.0], some(1, 5, Any), own, "Coefficients of the polynomial in the second joint.";
    }
}

table! {
    /// Attributes of `<equality><tendon>`.
    group TendonEquality {
        "tendon1" tendon1: String = String::new(), TEXT, required, "Tendon that is held.";
        "tendon2" tendon2: Option<String> = None, TEXT, own, "Tendon that it follows; none for a constant.";
        "polycoef" polycoef: [f64; 5] = [0.0, 1.0, 0.0, 0.0, 0.0], some(1, 5, Any), own, "Coefficients of the polynomial in the length of the second tendon.";
    }
}

table! {
    /// The two bodies or sites that a connection or a weld holds together.
    group Ends {
        "body1" body1: Option<String> = None, TEXT, own, "First body.";
        "body2" body2: Option<String> = None, TEXT, own, "Second body; else the world.";
        "anchor" anchor: Option<Vec3> = None, reals(3, Any), own, "Point that is held, m: of the first body in a connection, of the second in a weld.";
        "site1" site1: Option<String> = None, TEXT, own, "First site, in place of bodies.";
        "site2" site2: Option<String> = None, TEXT, own, "Second site.";
    }
}

table! {
    /// Attributes of `<equality><weld>`.
    group WeldEquality {
        "relpose" relpose: Option<[f64; 7]> = None, reals(7, Any), own, "Pose of the second body in the first; that at `qpos0` if the quaternion is zero.";
        "torquescale" torquescale: f64 = 1.0, real(NonNegative), own, "Scale of rotational errors, m.";
        with ends: Ends;
    }
}

table! {
    /// Attributes of `<equality><flex>`.
    group FlexEquality {
        "flex" flex: String = String::new(), TEXT, required, "Flex of which the lengths of the edges are held.";
    }
}

/// The elements of an equality, by name.
#[derive(Clone)]
pub(super) enum EqualityElements {
    Joint(JointEquality),
    Tendon(TendonEquality),
    Connect(Ends),
    Weld(WeldEquality),
    Flex(FlexEquality),
}

table! {
    /// Attributes of all equalities.
    element Equality {
        also held: EqualityElements = EqualityElements::Joint(JointEquality::initial());
        "name" name: String = String::new(), TEXT, own, "Name.";
        "active" active: bool = true, FLAG, "Whether it holds after a reset.";
        "solref" solref: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of the constraint.";
        "solimp" solimp: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of the constraint.";
    }
}

impl Equality {
    /// Reads the element with its children. An error describes the fault.
    pub fn hold(&mut self, e: &Element) -> Result<(), &'static str> {
        self.apply(e);
        self.held = match e.name {
            "connect" => EqualityElements::Connect(Ends::read(e)),
            "tendon" => EqualityElements::Tendon(TendonEquality::read(e)),
            "weld" => EqualityElements::Weld(WeldEquality::read(e)),
            "flex" => EqualityElements::Flex(FlexEquality::read(e)),
            "joint" => EqualityElements::Joint(JointEquality::read(e)),
            _ => return Err(UNREAD),
        };
        Ok(())
    }
}

table! {
    /// A `<joint>` of a fixed tendon.
    element TendonJoint {
        "joint" joint: String = String::new(), TEXT, required, "Joint.";
        "coef" coef: f64 = 0.0, real(Any), required, "Length of the tendon per coordinate of the joint.";
    }
}

table! {
    /// A `<site>` of a spatial tendon.
    element TendonSite {
        "site" site: String = String::new(), TEXT, required, "Site that the tendon passes through.";
    }
}

table! {
    /// A `<geom>` of a spatial tendon.
    element TendonGeom {
        "geom" geom: String = String::new(), TEXT, required, "Sphere or cylinder that the tendon wraps around, between two sites.";
        "sidesite" sidesite: Option<String> = None, TEXT, own, "Site on whose side of the geom the tendon stays; one inside of it makes the tendon pass inside.";
    }
}

table! {
    /// A `<pulley>` of a spatial tendon.
    element Pulley {
        "divisor" divisor: f64 = 0.0, real(Positive), required, "What the length after the pulley is divided by.";
    }
}

/// The elements on the path of a tendon, by name.
#[derive(Clone)]
pub(super) enum TendonElements {
    Joint(TendonJoint),
    Site(TendonSite),
    Geom(TendonGeom),
    Pulley(Pulley),
}

impl TendonElements {
    fn read(e: &Element) -> Result<Self, &'static str> {
        Ok(match e.name {
            "site" => Self::Site(TendonSite::read(e)),
            "geom" => Self::Geom(TendonGeom::read(e)),
            "pulley" => Self::Pulley(Pulley::read(e)),
            "joint" => Self::Joint(TendonJoint::read(e)),
            _ => return Err(UNREAD),
        })
    }

    /// Returns the place in the text.
    pub fn at(&self) -> usize {
        match self {
            Self::Joint(joint) => joint.at,
            Self::Site(site) => site.at,
            Self::Geom(geom) => geom.at,
            Self::Pulley(pulley) => pulley.at,
        }
    }
}

/// The lengths between which a tendon's spring is slack.
#[derive(Clone, Copy)]
pub(super) struct SpringLength(pub [f64; 2]);

impl SpringLength {
    /// The length in the springs' rest configuration.
    pub const AT_REST: Self = Self([-1.0; 2]);
}

impl AttributeField for SpringLength {
    /// Stores both lengths; a single number sets both.
    fn store(&mut self, value: &Value) {
        if let Value::Reals(lengths) = value {
            match lengths[..] {
                [length] => self.0 = [length; 2],
                _ => self.0.store(value),
            }
        }
    }

    fn show(&self) -> String {
        self.0.show()
    }
}

table! {
    /// Attributes of `<tendon><fixed>` and `<tendon><spatial>`.
    element Tendon {
        also path: Vec<TendonElements> = Vec::new();
        also spatial: bool = false;
        also looks: TendonLooks = TendonLooks::initial();
        "name" name: String = String::new(), TEXT, own, "Name.";
        "limited" limited: AutoBool = AutoBool::Auto, TRI, "Whether the limit is enforced.";
        "range" range: [f64; 2] = [0.0; 2], RANGE, "Shortest and longest length.";
        "margin" margin: f64 = 0.0, real(NonNegative), "Distance to the limit at which it becomes active.";
        "solreflimit" solref_limit: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of the limit.";
        "solimplimit" solimp_limit: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of the limit.";
        "springlength" springlength: SpringLength = SpringLength::AT_REST, some(1, 2, Any), "Shortest and longest length without a spring force; a single one is both. -1 for that of the springs' rest configuration.";
        "frictionloss" frictionloss: f64 = 0.0, real(NonNegative), "Dry friction.";
        "solreffriction" solref_friction: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of dry friction.";
        "solimpfriction" solimp_friction: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of dry friction.";
        "stiffness" stiffness: f64 = 0.0, real(NonNegative), "Stiffness of the spring.";
        "damping" damping: f64 = 0.0, real(NonNegative), "Damping.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
        "group" group: i32 = 0, int(MIN_GROUP, MAX_GROUP), "Visual group.";
    }
}

table! {
    /// Attributes that only spatial tendons have, in addition to those of all tendons.
    group TendonLooks {
        "width" width: f64 = 0.003, real(Any), "Radius that the tendon is drawn with, m, which must be positive.";
        "rgba" rgba: [f64; 4] = GREY, reals(4, Any), "Colour and opacity.";
        "material" material: Option<String> = None, TEXT, "Material.";
    }
}

impl Tendon {
    /// Reads the element, `<fixed>`, `<spatial>` or a default, without its path.
    pub fn string(&mut self, e: &Element) {
        self.apply(e);
        self.looks.apply(e);
    }

    /// Reads its path. An error describes the fault.
    pub fn thread(&mut self, e: &Element) -> Result<(), &'static str> {
        self.spatial = match e.name {
            "fixed" => false,
            "spatial" => true,
            _ => return Err(UNREAD),
        };
        self.path = e.children.iter().map(TendonElements::read).collect::<Result<_, _>>()?;
        Ok(())
    }
}
