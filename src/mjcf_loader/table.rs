//! One table per element. A line of a table describes an attribute: name, field, default, form, meaning.
//!
//! ```text
//! table! {
//!     /// A camera.
//!     element Camera {
//!         also  targets: bool = false;                                    a field that no attribute of its own fills
//!         set   "mode" => targets, CAMERA_MODES, "How it is aimed.";      an attribute that goes into such a field
//!               "fovy" fovy: f64 = 45.0, real(Positive), "Angle of view.";    an attribute with its field
//!         check "model" | "lens", TEXT, "Name of the optics.";            attributes that are checked and not kept
//!         with  frame: Frame;                                             a field that has a table itself
//!     }
//! }
//! ```
//!
//! Sections come in this order, and each may be absent. Between form and meaning of a `set` or a field may stand `own` (not
//! allowed in default classes), `required`, `orientation`, `inertia` or `transmission` (an element may have one of those so marked).
//! `element` makes a struct that also keeps its place in the text, `at`; `group` makes a struct without; `fields` fills a struct that is declared elsewhere.

use super::attribute::{Attr, FieldVisitor};
use super::schema::Element;

/// A struct whose fields are the attributes of an element.
pub(super) trait Table: Sized {
    /// The attributes, those of the table itself first. Of two with the same name, the first counts.
    const ATTRIBUTES: &'static [&'static [Attr]];

    /// Returns the default values of the attributes.
    fn initial() -> Self;

    /// Visits the field that an attribute fills, if it has one; returns whether the table has the attribute.
    fn field(&mut self, name: &str, visit: FieldVisitor) -> bool;

    /// Returns the default of an attribute as a document would write it.
    fn default_of(name: &str) -> String {
        let mut text = String::new();
        Self::initial().field(name, &mut |field| text = field.show());
        text
    }

    /// Stores the place in the text.
    fn locate(&mut self, _at: usize) {}

    /// Stores the place and the attributes of an element. Other fields keep their values.
    fn apply(&mut self, e: &Element) {
        self.locate(e.at);
        for (name, value) in e.values() {
            self.field(name, &mut |field| field.store(value));
        }
    }

    /// Reads an element without a default class.
    fn read(e: &Element) -> Self {
        let mut table = Self::initial();
        table.apply(e);
        table
    }
}

macro_rules! table {
    ($(#[$meta:meta])* element $T:ident { $($body:tt)* }) => {
        table! { @struct [$(#[$meta])*] $T [at] { $($body)* } }
        table! { @impl $T [at] { $($body)* } }
    };
    ($(#[$meta:meta])* group $T:ident { $($body:tt)* }) => {
        table! { @struct [$(#[$meta])*] $T [] { $($body)* } }
        table! { @impl $T [] { $($body)* } }
    };
    (fields $T:ident { $($body:tt)* }) => {
        table! { @impl $T [] { $($body)* } }
    };

    (@struct [$(#[$meta:meta])*] $T:ident [$($at:ident)?] {
        $(also $extra:ident: $extra_ty:ty = $extra_default:expr;)*
        $(set $set:literal => $to:ident $(.$sub:ident)* $([$k:literal])?, $set_form:expr, $($set_flag:ident,)* $set_meaning:literal;)*
        $($name:literal $field:ident: $ty:ty = $default:expr, $form:expr, $($flag:ident,)* $meaning:literal;)*
        $(check $($check:literal)|+, $check_form:expr, $check_meaning:literal;)*
        $(with $group:ident: $Group:ty;)*
    }) => {
        $(#[$meta])*
        #[derive(Clone)]
        pub(super) struct $T {
            $(pub $at: usize,)?
            $(pub $extra: $extra_ty,)*
            $(#[doc = $meaning] pub $field: $ty,)*
            $(pub $group: $Group,)*
        }

        impl Default for $T {
            fn default() -> Self {
                <Self as $crate::table::Table>::initial()
            }
        }
    };

    (@impl $T:ident [$($at:ident)?] {
        $(also $extra:ident: $extra_ty:ty = $extra_default:expr;)*
        $(set $set:literal => $to:ident $(.$sub:ident)* $([$k:literal])?, $set_form:expr, $($set_flag:ident,)* $set_meaning:literal;)*
        $($name:literal $field:ident: $ty:ty = $default:expr, $form:expr, $($flag:ident,)* $meaning:literal;)*
        $(check $($check:literal)|+, $check_form:expr, $check_meaning:literal;)*
        $(with $group:ident: $Group:ty;)*
    }) => {
        impl $crate::table::Table for $T {
            const ATTRIBUTES: &'static [&'static [$crate::attribute::Attr]] = &[
                &[
                    $($crate::attribute::Attr::new(
                        $set, $set_form.kind(), $set_meaning, Self::default_of
                    )$(.$set_flag())*,)*
                    $($crate::attribute::Attr::new(
                        $name, $form.kind(), $meaning, Self::default_of
                    )$(.$flag())*,)*
                    $($($crate::attribute::Attr::new(
                        $check, $check_form.kind(), $check_meaning, Self::default_of
                    ),)+)*
                ],
                $(<$Group as $crate::table::Table>::ATTRIBUTES[0],)*
            ];

            #[inline(never)]
            fn initial() -> Self {
                Self {
                    $($at: 0,)?
                    $($extra: $extra_default,)*
                    $($field: { let default: $ty = $default; default },)*
                    $($group: <$Group as $crate::table::Table>::initial(),)*
                }
            }

            fn field(&mut self, name: &str, visit: $crate::attribute::FieldVisitor) -> bool {
                let _ = &visit;
                match name {
                    $($set => $set_form.visit(&mut self.$to $(.$sub)* $([$k])?, visit),)*
                    $($name => $form.visit(&mut self.$field, visit),)*
                    $($($check)|+ => {})*
                    _ => return false $(|| <$Group as $crate::table::Table>::field(&mut self.$group, name, visit))*,
                }
                true
            }

            $(fn locate(&mut self, at: usize) {
                self.$at = at;
            })?
        }
    };
}
pub(super) use table;
