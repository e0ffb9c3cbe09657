//! The MJCF that is understood: every element and attribute, with the form of its value. What is not here is an error.

use super::MAX_USER;
use super::schema::{Attr, Kind, Sign, Spec};

const fn attr(name: &'static str, kind: Kind) -> Attr {
    Attr {
        name,
        kind,
        required: false,
    }
}
const fn text(name: &'static str) -> Attr {
    attr(name, Kind::Text)
}
const fn flag(name: &'static str) -> Attr {
    attr(name, Kind::Flag)
}
const fn word(name: &'static str, words: &'static [&'static str]) -> Attr {
    attr(name, Kind::Word(words))
}
const fn int(name: &'static str, min: i64, max: i64) -> Attr {
    attr(name, Kind::Int { min, max })
}
const fn real(name: &'static str, sign: Sign) -> Attr {
    attr(name, Kind::Reals { min: 1, max: 1, sign })
}
/// Exactly `n` values.
const fn reals(name: &'static str, n: usize, sign: Sign) -> Attr {
    attr(name, Kind::Reals { min: n, max: n, sign })
}
/// Up to `n` values; the others keep their defaults.
const fn some(name: &'static str, n: usize, sign: Sign) -> Attr {
    attr(name, Kind::Reals { min: 1, max: n, sign })
}
const fn required(attr: Attr) -> Attr {
    Attr { required: true, ..attr }
}
const fn spec(name: &'static str, attrs: &'static [&'static [Attr]], children: &'static [&'static Spec]) -> Spec {
    Spec { name, attrs, children }
}

use Sign::{Any, NonNegative, Positive, Unit};

pub(super) const TRI: &[&str] = &["false", "true", "auto"];
/// In the order of `document::SHAPES`.
pub(super) const SHAPE_WORDS: &[&str] = &["plane", "sphere", "capsule", "ellipsoid", "cylinder", "box"];
const SITE_WORDS: &[&str] = &["sphere", "capsule", "ellipsoid", "cylinder", "box"];

const NAME: &[Attr] = &[text("name")];
const CLASS: &[Attr] = &[text("class")];
const ORIENTATION: &[Attr] = &[
    reals("quat", 4, Any),
    reals("axisangle", 4, Any),
    reals("xyaxes", 6, Any),
    reals("zaxis", 3, Any),
    reals("euler", 3, Any),
];
const POS: &[Attr] = &[reals("pos", 3, Any)];
const MAX_GROUP: i64 = 5;
const MAX_BITS: i64 = u32::MAX as i64;
const MAX_COUNT: i64 = 1 << 30;
const MAX_PIXELS: i64 = 16384;

/// Attributes of which an element may have one at most.
pub(super) const EXCLUSIVE: &[&[&str]] = &[
    &["quat", "axisangle", "xyaxes", "zaxis", "euler"],
    &["fullinertia", "diaginertia"],
];

const JOINT_ATTRS: &[Attr] = &[
    word("type", &["free", "slide", "hinge"]),
    int("group", 0, MAX_GROUP),
    reals("pos", 3, Any),
    reals("axis", 3, Any),
    word("limited", TRI),
    reals("range", 2, Any),
    real("margin", NonNegative),
    real("stiffness", NonNegative),
    real("damping", NonNegative),
    real("armature", NonNegative),
    real("frictionloss", NonNegative),
    real("ref", Any),
    real("springref", Any),
    some("solreflimit", 2, Any),
    some("solimplimit", 5, Any),
    some("solreffriction", 2, Any),
    some("solimpfriction", 5, Any),
];
const GEOM_ATTRS: &[Attr] = &[
    word("type", SHAPE_WORDS),
    some("size", 3, NonNegative),
    int("contype", 0, MAX_BITS),
    int("conaffinity", 0, MAX_BITS),
    int("condim", 1, 6),
    int("priority", i32::MIN as i64, i32::MAX as i64),
    int("group", 0, MAX_GROUP),
    some("friction", 3, NonNegative),
    real("solmix", NonNegative),
    some("solref", 2, Any),
    some("solimp", 5, Any),
    real("margin", NonNegative),
    real("gap", NonNegative),
    real("mass", NonNegative),
    real("density", NonNegative),
    reals("fromto", 6, Any),
    reals("rgba", 4, Unit),
    text("material"),
];
const SITE_ATTRS: &[Attr] = &[
    word("type", SITE_WORDS),
    some("size", 3, NonNegative),
    int("group", 0, MAX_GROUP),
    reals("fromto", 6, Any),
    reals("rgba", 4, Unit),
    text("material"),
];
const CAMERA_ATTRS: &[Attr] = &[word("mode", &["fixed", "targetbody"]), real("fovy", Positive)];
const LIGHT_ATTRS: &[Attr] = &[
    word("mode", &["fixed"]),
    flag("directional"),
    flag("castshadow"),
    reals("pos", 3, Any),
    reals("dir", 3, Any),
    reals("ambient", 3, Unit),
    reals("diffuse", 3, Unit),
    reals("specular", 3, Unit),
    reals("attenuation", 3, NonNegative),
    real("cutoff", NonNegative),
    real("exponent", NonNegative),
];
const PAIR_ATTRS: &[Attr] = &[
    int("condim", 1, 6),
    some("friction", 5, NonNegative),
    some("solref", 2, Any),
    some("solreffriction", 2, Any),
    some("solimp", 5, Any),
    real("margin", NonNegative),
    real("gap", NonNegative),
];
const EQUALITY_ATTRS: &[Attr] = &[flag("active"), some("solref", 2, Any), some("solimp", 5, Any)];
const TENDON_ATTRS: &[Attr] = &[
    word("limited", TRI),
    reals("range", 2, Any),
    real("margin", NonNegative),
    some("solreflimit", 2, Any),
    some("solimplimit", 5, Any),
];
const ACTUATOR_ATTRS: &[Attr] = &[
    word("ctrllimited", TRI),
    word("forcelimited", TRI),
    reals("ctrlrange", 2, Any),
    reals("forcerange", 2, Any),
    real("gear", Any),
    attr(
        "user",
        Kind::Reals {
            min: 0,
            max: MAX_USER,
            sign: Any,
        },
    ),
];
const POSITION_ATTRS: &[Attr] = &[real("kp", NonNegative), real("kv", NonNegative)];
const MATERIAL_ATTRS: &[Attr] = &[
    text("texture"),
    reals("rgba", 4, Unit),
    real("specular", Unit),
    real("shininess", Unit),
    real("reflectance", Unit),
    real("emission", NonNegative),
    reals("texrepeat", 2, Any),
    flag("texuniform"),
];

static COMPILER: Spec = spec(
    "compiler",
    &[&[
        word("angle", &["radian", "degree"]),
        text("eulerseq"),
        word("coordinate", &["local"]),
        word("inertiafromgeom", TRI),
        flag("autolimits"),
        text("texturedir"),
    ]],
    &[],
);
static OPTION: Spec = spec(
    "option",
    &[&[
        real("timestep", Positive),
        reals("gravity", 3, Any),
        word("integrator", &["Euler"]),
        word("cone", &["elliptic"]),
        word("jacobian", &["dense", "sparse", "auto"]),
        word("solver", &["Newton"]),
        int("iterations", 0, MAX_COUNT),
        real("tolerance", NonNegative),
        int("ls_iterations", 0, MAX_COUNT),
        real("ls_tolerance", NonNegative),
        real("impratio", Positive),
        int("ccd_iterations", 0, MAX_COUNT),
        real("ccd_tolerance", NonNegative),
    ]],
    &[],
);
static SIZE: Spec = spec(
    "size",
    &[&[
        int("nuser_actuator", -1, MAX_USER as i64),
        // Reservations of memory, which have no meaning here.
        int("nconmax", -1, i64::MAX),
        int("njmax", -1, i64::MAX),
        int("nstack", -1, i64::MAX),
        text("memory"),
    ]],
    &[],
);
static GLOBAL: Spec = spec(
    "global",
    &[&[
        real("fovy", Positive),
        int("offwidth", 1, MAX_PIXELS),
        int("offheight", 1, MAX_PIXELS),
    ]],
    &[],
);
static MAP: Spec = spec(
    "map",
    &[&[
        real("force", NonNegative),
        real("fogstart", NonNegative),
        real("fogend", NonNegative),
        real("znear", Positive),
        real("zfar", Positive),
        real("haze", NonNegative),
        real("shadowclip", NonNegative),
    ]],
    &[],
);
static QUALITY: Spec = spec(
    "quality",
    &[&[int("shadowsize", 0, MAX_PIXELS), int("offsamples", 0, 64)]],
    &[],
);
static HEADLIGHT: Spec = spec(
    "headlight",
    &[&[
        int("active", 0, 1),
        reals("ambient", 3, Unit),
        reals("diffuse", 3, Unit),
        reals("specular", 3, Unit),
    ]],
    &[],
);
static VISUAL: Spec = spec("visual", &[], &[&GLOBAL, &MAP, &QUALITY, &HEADLIGHT]);
static STATISTIC: Spec = spec(
    "statistic",
    &[&[
        real("meaninertia", Positive),
        real("meanmass", Positive),
        real("meansize", Positive),
        real("extent", Positive),
        reals("center", 3, Any),
    ]],
    &[],
);

static DEFAULT_JOINT: Spec = spec("joint", &[JOINT_ATTRS], &[]);
static DEFAULT_GEOM: Spec = spec("geom", &[GEOM_ATTRS, POS, ORIENTATION], &[]);
static DEFAULT_SITE: Spec = spec("site", &[SITE_ATTRS, POS, ORIENTATION], &[]);
static DEFAULT_CAMERA: Spec = spec("camera", &[CAMERA_ATTRS, POS, ORIENTATION], &[]);
static DEFAULT_LIGHT: Spec = spec("light", &[LIGHT_ATTRS], &[]);
static DEFAULT_PAIR: Spec = spec("pair", &[PAIR_ATTRS], &[]);
static DEFAULT_EQUALITY: Spec = spec("equality", &[EQUALITY_ATTRS], &[]);
static DEFAULT_TENDON: Spec = spec("tendon", &[TENDON_ATTRS], &[]);
static DEFAULT_MOTOR: Spec = spec("motor", &[ACTUATOR_ATTRS], &[]);
static DEFAULT_POSITION: Spec = spec("position", &[ACTUATOR_ATTRS, POSITION_ATTRS], &[]);
static DEFAULT_MATERIAL: Spec = spec("material", &[MATERIAL_ATTRS], &[]);
static DEFAULT: Spec = spec(
    "default",
    &[CLASS],
    &[
        &DEFAULT,
        &DEFAULT_JOINT,
        &DEFAULT_GEOM,
        &DEFAULT_SITE,
        &DEFAULT_CAMERA,
        &DEFAULT_LIGHT,
        &DEFAULT_PAIR,
        &DEFAULT_EQUALITY,
        &DEFAULT_TENDON,
        &DEFAULT_MOTOR,
        &DEFAULT_POSITION,
        &DEFAULT_MATERIAL,
    ],
);

static TEXTURE: Spec = spec(
    "texture",
    &[
        NAME,
        &[
            word("type", &["2d", "cube", "skybox"]),
            word("builtin", &["none", "gradient", "checker", "flat"]),
            word("mark", &["none", "edge", "cross", "random"]),
            reals("rgb1", 3, Unit),
            reals("rgb2", 3, Unit),
            reals("markrgb", 3, Unit),
            real("random", Unit),
            int("width", 0, MAX_PIXELS),
            int("height", 0, MAX_PIXELS),
            text("file"),
            text("fileright"),
            text("fileleft"),
            text("fileup"),
            text("filedown"),
            text("filefront"),
            text("fileback"),
        ],
    ],
    &[],
);
static MATERIAL: Spec = spec("material", &[&[required(text("name"))], CLASS, MATERIAL_ATTRS], &[]);
static ASSET: Spec = spec("asset", &[], &[&TEXTURE, &MATERIAL]);

static INERTIAL: Spec = spec(
    "inertial",
    &[
        &[
            required(reals("pos", 3, Any)),
            required(real("mass", NonNegative)),
            reals("diaginertia", 3, NonNegative),
            reals("fullinertia", 6, Any),
        ],
        ORIENTATION,
    ],
    &[],
);
static JOINT: Spec = spec("joint", &[NAME, CLASS, JOINT_ATTRS], &[]);
static FREEJOINT: Spec = spec("freejoint", &[NAME, &[int("group", 0, MAX_GROUP)]], &[]);
static GEOM: Spec = spec("geom", &[NAME, CLASS, GEOM_ATTRS, POS, ORIENTATION], &[]);
static SITE: Spec = spec("site", &[NAME, CLASS, SITE_ATTRS, POS, ORIENTATION], &[]);
static CAMERA: Spec = spec(
    "camera",
    &[NAME, CLASS, CAMERA_ATTRS, &[text("target")], POS, ORIENTATION],
    &[],
);
static LIGHT: Spec = spec("light", &[NAME, CLASS, LIGHT_ATTRS], &[]);
static BODY: Spec = spec(
    "body",
    &[NAME, &[text("childclass")], POS, ORIENTATION],
    &[&BODY, &INERTIAL, &JOINT, &FREEJOINT, &GEOM, &SITE, &CAMERA, &LIGHT],
);
static WORLDBODY: Spec = spec("worldbody", &[], &[&BODY, &GEOM, &SITE, &CAMERA, &LIGHT]);

static PAIR: Spec = spec(
    "pair",
    &[
        NAME,
        CLASS,
        &[required(text("geom1")), required(text("geom2"))],
        PAIR_ATTRS,
    ],
    &[],
);
static EXCLUDE: Spec = spec(
    "exclude",
    &[NAME, &[required(text("body1")), required(text("body2"))]],
    &[],
);
static CONTACT: Spec = spec("contact", &[], &[&PAIR, &EXCLUDE]);

static EQUALITY_JOINT: Spec = spec(
    "joint",
    &[
        NAME,
        CLASS,
        &[required(text("joint1")), text("joint2"), some("polycoef", 5, Any)],
        EQUALITY_ATTRS,
    ],
    &[],
);
static EQUALITY_WELD: Spec = spec(
    "weld",
    &[
        NAME,
        CLASS,
        &[
            required(text("body1")),
            text("body2"),
            reals("relpose", 7, Any),
            reals("anchor", 3, Any),
            real("torquescale", NonNegative),
        ],
        EQUALITY_ATTRS,
    ],
    &[],
);
static EQUALITY: Spec = spec("equality", &[], &[&EQUALITY_JOINT, &EQUALITY_WELD]);

static TENDON_JOINT: Spec = spec("joint", &[&[required(text("joint")), required(real("coef", Any))]], &[]);
static FIXED: Spec = spec("fixed", &[NAME, CLASS, TENDON_ATTRS], &[&TENDON_JOINT]);
static TENDON: Spec = spec("tendon", &[], &[&FIXED]);

const TRANSMISSION: &[Attr] = &[required(text("joint"))];
static MOTOR: Spec = spec("motor", &[NAME, CLASS, TRANSMISSION, ACTUATOR_ATTRS], &[]);
static POSITION: Spec = spec(
    "position",
    &[NAME, CLASS, TRANSMISSION, ACTUATOR_ATTRS, POSITION_ATTRS],
    &[],
);
static ACTUATOR: Spec = spec("actuator", &[], &[&MOTOR, &POSITION]);

const AT_SITE: &[Attr] = &[required(text("site"))];
static ACCELEROMETER: Spec = spec("accelerometer", &[NAME, AT_SITE], &[]);
static GYRO: Spec = spec("gyro", &[NAME, AT_SITE], &[]);
static TORQUE: Spec = spec("torque", &[NAME, AT_SITE], &[]);
static SENSOR: Spec = spec("sensor", &[], &[&ACCELEROMETER, &GYRO, &TORQUE]);

/// The root.
pub(super) static MUJOCO: Spec = spec(
    "mujoco",
    &[&[text("model")]],
    &[
        &COMPILER, &OPTION, &SIZE, &VISUAL, &STATISTIC, &DEFAULT, &ASSET, &WORLDBODY, &CONTACT, &EQUALITY, &TENDON,
        &ACTUATOR, &SENSOR,
    ],
);
