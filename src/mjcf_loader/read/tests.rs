//! Elements that the rules allow have readers.

use super::*;
use crate::assets::MemoryAssets;
use crate::elements::MUJOCO;
use crate::limits::Limits;
use crate::schema::Rule;

/// Returns the rule under a path of names from the root.
fn rule(path: &[&str]) -> &'static Rule {
    path.iter().fold(&MUJOCO, |rule, name| {
        let child = rule.children.iter().copied().find(|child| child.name == *name);
        child.unwrap_or_else(|| panic!("{} in {path:?}", rule.name))
    })
}

fn is_read(parent: &str, child: &Rule, result: Result<(), LoadError>) {
    if let Err(LoadError {
        kind: ErrorKind::Invalid(UNREAD),
        ..
    }) = result
    {
        panic!("nothing reads <{}> in <{parent}>", child.name);
    }
}

#[test]
fn every_element_that_the_rules_allow_has_a_reader() {
    let (tree, _) = Tree::read("<mujoco/>", "m.xml", &MemoryAssets::new(), &Limits::default()).expect("XML");
    let classes = Classes {
        tree: &tree,
        by_name: BTreeMap::from([(MAIN.to_owned(), Class::default())]),
    };
    let wrong = |what| tree.error(0, ErrorKind::Invalid(what));
    let document = || TypedDocument::new(0, String::new());
    let mut count = 0;
    let mut each = |path: &[&str], read: &dyn Fn(&Element) -> Result<(), LoadError>| {
        let parent = rule(path);
        for child in parent.children {
            is_read(parent.name, child, read(&Element::bare(child)));
            count += 1;
        }
    };
    for section in [
        "asset",
        "contact",
        "equality",
        "tendon",
        "actuator",
        "sensor",
        "custom",
        "keyframe",
        "deformable",
    ] {
        each(&[section], &|e| add(e, section, &classes, &mut document()));
    }
    each(&[DEFAULT], &|e| Class::default().apply(e).map_err(wrong));
    each(&["visual"], &|e| Visual::default().apply(e).map_err(wrong));
    for path in [
        &["worldbody"][..],
        &["worldbody", "body"],
        &["worldbody", "frame"],
        &["worldbody", "replicate"],
    ] {
        let parent = rule(path);
        for child in parent.children {
            let (mut document, mut e) = (document(), Element::bare(parent));
            document.bodies.push(document.bodies[0].clone());
            e.children.push(Element::bare(child));
            let spot = Insertion {
                body: 1,
                ..Insertion::WORLD
            };
            is_read(parent.name, child, content(&e, spot, MAIN, &classes, &mut document));
            count += 1;
        }
    }
    for tendon in rule(&["tendon"]).children {
        for child in tendon.children {
            let mut e = Element::bare(tendon);
            e.children.push(Element::bare(child));
            is_read(tendon.name, child, Tendon::initial().thread(&e).map_err(wrong));
            count += 1;
        }
    }
    let composite = rule(&["worldbody", "composite"]);
    for child in composite.children {
        let mut e = Element::bare(composite);
        e.children.push(Element::bare(child));
        is_read("composite", child, cable::prototypes(&e).map(drop).map_err(wrong));
        count += 1;
    }
    for path in [&["deformable", "flex"][..], &["worldbody", "flexcomp"]] {
        let parent = rule(path);
        for child in parent.children {
            let mut e = Element::bare(parent);
            e.children.push(Element::bare(child));
            let read = match parent.name {
                "flex" => flex::flex(&e).map(drop).map_err(wrong),
                _ => flex::flexcomp(&e, Insertion::WORLD, &classes, &mut document()),
            };
            is_read(parent.name, child, read);
            count += 1;
        }
    }
    assert!(count > 130, "{count} elements");
}

#[test]
fn elements_that_hold_others_are_those_whose_contents_are_read() {
    const HOLDING: [&str; 26] = [
        "actuator",
        "asset",
        "body",
        "compiler",
        "composite",
        "contact",
        "custom",
        "default",
        "deformable",
        "equality",
        "fixed",
        "flex",
        "flexcomp",
        "frame",
        "keyframe",
        "material",
        "mujoco",
        "option",
        "replicate",
        "sensor",
        "skin",
        "spatial",
        "tendon",
        "tuple",
        "visual",
        "worldbody",
    ];
    let (mut open, mut seen) = (vec![&MUJOCO], Vec::new());
    while let Some(rule) = open.pop() {
        if !rule.children.is_empty() && !seen.contains(&rule.name) {
            seen.push(rule.name);
            open.extend(rule.children);
        }
    }
    seen.sort_unstable();
    assert_eq!(seen, HOLDING);
}
