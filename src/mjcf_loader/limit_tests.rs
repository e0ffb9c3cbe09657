//! Limits on untrusted documents, as default and as a caller sets them.

use super::tests::{check, outcome, source};
use super::*;
use crate::assets::MemoryAssets;

#[test]
fn default_limits_hold() {
    let limits = Limits::default();
    let nested = |depth: usize| {
        let body = format!("{}{}", "<body>".repeat(depth - 2), "</body>".repeat(depth - 2));
        outcome(&format!("<mujoco><worldbody>{body}</worldbody></mujoco>"))
    };
    assert_eq!(nested(limits.depth), "");
    assert!(nested(limits.depth + 1).ends_with(": more than 500 nested elements"));
    assert!(nested(100_000).ends_with(": more than 500 nested elements"));
    assert!(outcome(&"<a>".repeat(1_000_000)).ends_with(": more than 500 nested elements"));
    let many = format!(
        "<mujoco><worldbody>{}</worldbody></mujoco>",
        "<body/>".repeat(limits.elements)
    );
    assert!(outcome(&many).ends_with(": more than 100000 elements"));
    let long = format!("<mujoco>{}</mujoco>", " ".repeat(limits.document_bytes));
    assert_eq!(outcome(&long), "m.xml: more than 4194304 bytes of XML in total");
    let attributes: String = (0..=limits.attributes).map(|k| format!(" a{k}='1'")).collect();
    assert_eq!(
        outcome(&format!("<mujoco{attributes}/>")),
        "m.xml:1:1: mujoco: more than 64 attributes of an element"
    );
    let name = "x".repeat(limits.text_bytes + 1);
    check(
        &format!("<asset><texture name='{name}'/></asset>"),
        "mujoco/asset/texture: more than 1024 bytes in a name or path",
    );
    let classes: String = (0..=limits.classes)
        .map(|k| format!("<default class='{k}'/>"))
        .collect();
    let message = "mujoco/default/default: more than 5000 default classes";
    check(&format!("<default>{classes}</default>"), message);
}

/// Each limit that a caller sets takes effect, whatever its default.
#[test]
fn limits_are_the_callers() {
    let other = source(&[
        ("a.xml", "<a><include file='b.xml'/></a>"),
        ("b.xml", "<a><option/></a>"),
    ]);
    let told = |text: &str, limits: &Limits| {
        load_str_with(text, "m.xml", &other, limits).map_or_else(|error| error.kind.to_string(), |_| String::new())
    };
    type Case = (&'static str, fn(&mut Limits), &'static str);
    let two = "<worldbody><body><freejoint/><geom name='a' size='1'/></body><geom name='b' size='1'/></worldbody>\
               <contact><pair geom1='a' geom2='b'/></contact>";
    let cases: [Case; 14] = [
        (two, |l| l.bodies = 1, "more than 1 bodies"),
        (two, |l| l.geoms = 1, "more than 1 geoms"),
        (two, |l| l.dofs = 5, "more than 5 degrees of freedom"),
        (two, |l| l.pairs = 0, "more than 0 contact pairs"),
        ("", |l| l.document_bytes = 16, "more than 16 bytes of XML in total"),
        ("<option/>", |l| l.elements = 1, "more than 1 elements"),
        ("<option/>", |l| l.depth = 1, "more than 1 nested elements"),
        (
            "<option timestep='1' tolerance='1'/>",
            |l| l.attributes = 1,
            "more than 1 attributes of an element",
        ),
        (
            "<include file='a.xml'/>",
            |l| l.include_depth = 1,
            "more than 1 nested includes",
        ),
        (
            "<asset><material name='long'/></asset>",
            |l| l.text_bytes = 3,
            "more than 3 bytes in a name or path",
        ),
        (
            "<default><default class='a'/></default>",
            |l| l.classes = 0,
            "more than 0 default classes",
        ),
        (
            "<default><motor user='1 2'/></default>",
            |l| l.user = 1,
            "user: 2 values, expected 0 to 1",
        ),
        (
            "<size nuser_actuator='2'/>",
            |l| l.user = 1,
            "nuser_actuator: 2 must be from -1 to 1",
        ),
        (
            "<option timestep='11'/>",
            |l| l.real = 10.0,
            "timestep: 11 must be at most 1e1 in magnitude",
        ),
    ];
    for (content, limit, expect) in cases {
        let text = format!("<mujoco>{content}</mujoco>");
        let mut limits = Limits::default();
        assert_eq!(told(&text, &limits), "", "{text}");
        limit(&mut limits);
        assert_eq!(told(&text, &limits), expect, "{text}");
    }
    let bodies = ["<body>", "</body>"].map(|tag| tag.repeat(550)).concat();
    let deep = format!("<mujoco><worldbody>{bodies}</worldbody></mujoco>");
    let more = Limits {
        depth: 600,
        ..Limits::default()
    };
    assert_eq!(told(&deep, &more), "");
}

#[test]
fn deep_documents_fit_a_small_stack() {
    let depth = Limits::default().depth;
    let bodies = format!("{}{}", "<body>".repeat(depth - 2), "</body>".repeat(depth - 2));
    let classes: String = (0..depth - 2).map(|k| format!("<default class='{k}'>")).collect();
    let classes = format!("<default>{classes}{}", "</default>".repeat(depth - 1));
    let text = format!("<mujoco>{classes}<worldbody>{bodies}</worldbody></mujoco>");
    let run = move || {
        load_str(&text, "m.xml", &MemoryAssets::new())
            .map(|spec| spec.nbody())
            .unwrap()
    };
    // Frames are largest without optimisation; two thirds of what a thread has by default pass there.
    let thread = std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap();
    assert_eq!(thread.join().unwrap(), depth - 1);
}
