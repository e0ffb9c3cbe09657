//! The enumerations of the configuration, with the names they have in a file.

/// Defines an enumeration whose variants carry the name they have in a configuration file.
macro_rules! choices {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$variant_doc])* $variant,)* }

        impl $name {
            /// Every value, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];
            /// The names of [`Self::ALL`] in a configuration file.
            pub const NAMES: &'static [&'static str] = &[$($text),*];

            /// Returns the name in a configuration file.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),* }
            }

            /// Returns the value with this name, if it exists.
            pub fn from_name(name: &str) -> Option<Self> {
                match name { $($text => Some(Self::$variant),)* _ => None }
            }
        }

        #[cfg(feature = "eval")]
        #[automatically_derived]
        impl serde::Serialize for $name {
            /// Serializes the name.
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        #[cfg(feature = "eval")]
        #[automatically_derived]
        impl<'de> serde::Deserialize<'de> for $name {
            /// Deserializes a value from its name.
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let name = <String as serde::Deserialize>::deserialize(deserializer)?;
                Self::from_name(&name).ok_or_else(|| serde::de::Error::unknown_variant(&name, Self::NAMES))
            }
        }

        #[automatically_derived]
        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

choices! {
    /// The behavior that is trained and scored, or the task with a goal and a reward (`behavior`).
    Behavior {
        /// No score; MIMo v1.
        #[default]
        None = "none",
        /// Touching his own body with the palms; MIMo v1.
        SelfTouch = "self_touch",
        /// Looking at his own hands; MIMo v2.
        HandRegard = "hand_regard",
        /// Reaching for a hovering ball with the right hand; MIMo v1.
        Reach = "reach",
        /// Standing up at the railing of a crib; MIMo v1.
        Standup = "standup",
        /// Touching a part of his own body with the right hand; MIMo v1.
        SelfBody = "selfbody",
        /// Catching a falling ball with the right hand; MIMo v2.
        Catch = "catch",
        /// Rolling over on the floor; MIMo v1.
        RollOver = "roll_over",
        /// Moving a mobile by a ribbon at a limb; MIMo v1.
        Mobile = "mobile",
        /// Touching, grasping and moving toys; MIMo v2.
        Play = "play",
    }
}

choices! {
    /// The limb to which the ribbon of the mobile is tied (`mobile_limb`).
    Limb {
        /// The right ankle.
        #[default]
        RightFoot = "right_foot",
        /// The left ankle.
        LeftFoot = "left_foot",
        /// The right wrist.
        RightHand = "right_hand",
        /// The left wrist.
        LeftHand = "left_hand",
    }
}

choices! {
    /// MIMo's position at the start of `roll_over` (`starting_position`).
    StartingPosition {
        /// On his back.
        #[default]
        Supine = "supine",
        /// On his belly.
        Prone = "prone",
    }
}

choices! {
    /// The course of the strength of motors and muscles over age (`strength`).
    StrengthModel {
        /// The volume of the part that carries them.
        #[default]
        Volume = "volume",
        /// Ratios to the torque of gravity, calibrated on what infants can do.
        Infant = "infant",
    }
}

choices! {
    /// The course of the springs and dampers of joints over age (`springs`).
    SpringModel {
        /// Constant: those of the original proportions.
        #[default]
        Fixed = "fixed",
        /// The torque of gravity on the joint.
        Weight = "weight",
    }
}

choices! {
    /// The source of MIMo's proportions over age (`proportions`).
    Proportions {
        /// The formulas of MIMo's authors.
        #[default]
        Mimo = "mimo",
        /// The same length, divided between trunk and legs as in infants.
        Measured = "measured",
    }
}

choices! {
    /// The sex of an infant, by which the standards of growth differ (`sex`).
    Sex {
        /// Not given.
        #[default]
        None = "none",
        /// A boy.
        Boy = "boy",
        /// A girl.
        Girl = "girl",
    }
}

choices! {
    /// The infant that learns, of two in a custom scene (`learner`).
    Learner {
        /// The one in `mimo_location`.
        #[default]
        Mimo = "mimo",
        /// The one in `other_location`.
        Other = "other",
    }
}

choices! {
    /// The unit of delays (`delay_unit`).
    DelayUnit {
        /// Steps of the environment.
        #[default]
        Steps = "steps",
        /// Milliseconds, rounded to whole steps of the environment.
        Ms = "ms",
    }
}

choices! {
    /// An image that an eye sees (`vision_outputs`).
    VisionOutput {
        /// Red, green and blue.
        #[default]
        Rgb = "rgb",
        /// Brightness.
        Gray = "gray",
        /// Distance from the camera's plane.
        Depth = "depth",
        /// Ids of geoms.
        Segmentation = "segmentation",
    }
}

choices! {
    /// The model that turns actions into joint torques (`actuation_model`).
    ActuationModel {
        /// Torque motors with linear, instant response.
        #[default]
        SpringDamper = "spring_damper",
        /// Two opposing muscles per actuator.
        Muscle = "muscle",
        /// Position servos: the action is the desired joint angle.
        Positional = "positional",
    }
}

choices! {
    /// The quantity that a touch sensor reports (`touch_function`).
    TouchFunction {
        /// The normal force, one number per sensor, N, >= 0. Exists under [`Compat::Api`] only.
        #[default]
        Normal = "normal",
        /// Normal and friction force, three numbers per sensor, N, in the frame of the sensor's geom.
        ForceVector = "force_vector",
        /// Normal and friction force, three numbers per sensor, N, in the world frame.
        ForceVectorGlobal = "force_vector_global",
        /// The Python code's three-number normal force. Exists under [`Compat::Reference`] only.
        NormalForce = "normal_force",
    }
}

choices! {
    /// The way a contact force is shared among touch sensors (`touch_response`).
    TouchResponse {
        /// The nearest sensor takes the whole force.
        #[default]
        Nearest = "nearest",
        /// Sensors within twice the sensor distance share the force, with weights that fall linearly.
        SpreadLinear = "spread_linear",
    }
}

choices! {
    /// The source to follow where the API page and the Python code of BabyBench 2025 disagree (`compat`).
    Compat {
        /// The API page.
        #[default]
        Api = "api",
        /// The Python code, so that policies, scores and logs can be exchanged with it.
        Reference = "reference",
    }
}

choices! {
    /// The renderer of images (`renderer`).
    RendererKind {
        /// The renderer in pure Rust: the same bytes everywhere, no GPU, no driver.
        #[default]
        Cpu = "cpu",
        /// wgpu: draws on GPUs, for many environments at once. Needs the cargo feature `wgpu`.
        Wgpu = "wgpu",
    }
}

choices! {
    /// The physics engine (`engine`).
    EngineKind {
        /// Joint-space dynamics with MuJoCo's soft constraints.
        #[default]
        Soft = "soft",
        /// Rapier's own pipeline with multibody joints. Needs the cargo feature `rapier`.
        Rapier = "rapier",
    }
}

choices! {
    /// MIMo's face (`facial_expression`).
    FacialExpression {
        /// Neither happy nor sad.
        #[default]
        Default = "default",
        /// Happy.
        Happy = "happy",
        /// Sad.
        Sad = "sad",
        /// Surprised.
        Surprised = "surprised",
        /// Angry.
        Angry = "angry",
        /// Disgusted.
        Disgusted = "disgusted",
        /// Scared.
        Scared = "scared",
    }
}

choices! {
    /// A reflex of infants (`reflexes`).
    Reflex {
        /// Pressure in the palm bends the fingers.
        #[default]
        PalmarGrasp = "palmar_grasp",
        /// Pressure behind the toes bends them.
        PlantarGrasp = "plantar_grasp",
        /// A touch beside the mouth turns the head to it.
        Rooting = "rooting",
        /// A drop of the head spreads the arms, then closes them.
        Moro = "moro",
        /// A turned head stretches the arm and leg on the face's side and bends those on the other (the asymmetric tonic neck reflex).
        Atnr = "atnr",
        /// An upright infant with loaded soles steps.
        Stepping = "stepping",
        /// The eyes turn against the head (the vestibulo-ocular reflex).
        Vor = "vor",
        /// A muscle that is stretched pulls back.
        Stretch = "stretch",
    }
}

choices! {
    /// The effect of the vestibulo-ocular reflex on the action of the eyes (`reflex_vor`).
    ReflexVor {
        /// The eyes ignore their action.
        #[default]
        Replace = "replace",
        /// The action is added.
        Add = "add",
    }
}
