//! The enumerations of the configuration, each with the names it has in a file.

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

            /// The name in a configuration file.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),* }
            }

            /// The value with this name, if there is one.
            pub fn from_name(name: &str) -> Option<Self> {
                match name { $($text => Some(Self::$variant),)* _ => None }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

choices! {
    /// What is trained and scored (`behavior`).
    Behavior {
        /// Nothing is scored; MIMo v1.
        #[default]
        None = "none",
        /// Touching one's own body with the palms; MIMo v1.
        SelfTouch = "self_touch",
        /// Looking at one's own hands; MIMo v2.
        HandRegard = "hand_regard",
    }
}

choices! {
    /// What stands around MIMo (`scene`).
    Scene {
        /// The floor alone; MIMo is free.
        #[default]
        Base = "base",
        /// MIMo lies on the mattress of a crib, its lower body fixed.
        Crib = "crib",
        /// MIMo sits among loose cubes and balls.
        Cubes = "cubes",
    }
}

choices! {
    /// How an action becomes joint torques (`actuation_model`).
    ActuationModel {
        /// Torque motors with linear, instant response.
        #[default]
        SpringDamper = "spring_damper",
        /// Two opposing muscles per actuator.
        Muscle = "muscle",
        /// The action is the desired joint angle.
        Positional = "positional",
    }
}

choices! {
    /// What a touch sensor reports (`touch_function`).
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
    /// How a contact force is shared among touch sensors (`touch_response`).
    TouchResponse {
        /// The nearest sensor takes all of it.
        #[default]
        Nearest = "nearest",
        /// Sensors within twice the sensor distance share it, with weights that fall linearly.
        SpreadLinear = "spread_linear",
    }
}

choices! {
    /// What holds where the API page and the Python code of BabyBench 2025 disagree (`compat`).
    Compat {
        /// The API page.
        #[default]
        Api = "api",
        /// The Python code, so that policies, scores and logs can be exchanged with it.
        Reference = "reference",
    }
}

choices! {
    /// What draws images (`renderer`).
    RendererKind {
        /// The renderer in pure Rust: the same bytes everywhere, no GPU, no driver.
        #[default]
        Cpu = "cpu",
        /// wgpu: GPUs, and many environments at once. Needs the cargo feature `wgpu`.
        Wgpu = "wgpu",
    }
}

choices! {
    /// What moves the bodies (`engine`).
    Engine {
        /// Joint-space dynamics with MuJoCo's soft constraints; Rapier holds the scene.
        #[default]
        Soft = "soft",
        /// Rapier's own pipeline with multibody joints.
        Rapier = "rapier",
    }
}
