//! Documents of MJCF, mostly well-formed: existing documents with one change, or small random ones.

use fastrand::Rng;

/// Words that replace numbers.
const WORDS: [&str; 24] = [
    "nan", "inf", "-1", "0", "1", "2", "3", "1e400", "abc", "1e-320", "+.5", "1e", "", " ", "-0", "1e3", "90", ".1",
    "5.", "0x10", "1,2", "1 2 3", "true", "auto",
];

/// Attributes that may be added anywhere, with a value.
const ATTRIBUTES: [(&str, &str); 45] = [
    ("name", "extra"),
    ("pos", "0.1 0.2 0.3"),
    ("quat", "1 0.5 0 0"),
    ("quat", "0 0 0 0"),
    ("pos", "0 0 0"),
    ("euler", "0.3 0 0"),
    ("axisangle", "0 1 0 0.4"),
    ("axisangle", "0 0 0 0.4"),
    ("xyaxes", "1 0 0 0 1 0"),
    ("zaxis", "0 1 1"),
    ("zaxis", "0 0 -1"),
    ("size", "0.1 0.2 0.3"),
    ("size", "-0.1"),
    ("fromto", "0 0 0 0 0 1"),
    ("fromto", "0 0 0 0 0 0"),
    ("mass", "0"),
    ("mass", "3"),
    ("density", "0"),
    ("type", "box"),
    ("type", "capsule"),
    ("type", "slide"),
    ("type", "free"),
    ("range", "-1 1"),
    ("range", "1 -1"),
    ("limited", "true"),
    ("limited", "auto"),
    ("margin", "0.01"),
    ("gap", "0.005"),
    ("condim", "4"),
    ("condim", "2"),
    ("contype", "3"),
    ("priority", "-1"),
    ("friction", "0.5"),
    ("friction", "1 1 1 1"),
    ("solref", "0.01"),
    ("solref", "-100 -10"),
    ("solimp", "0.5 0.9 0.1 0.5 3"),
    ("damping", "-1"),
    ("armature", "0.01"),
    ("stiffness", "2"),
    ("ref", "0.2"),
    ("axis", "0 0 0"),
    ("class", "nowhere"),
    ("group", "7"),
    ("rgba", "2 0 0 1"),
];

/// The place of an attribute in a document.
struct Attribute {
    name: std::ops::Range<usize>,
    value: std::ops::Range<usize>,
}

/// A tag of a document.
struct Tag {
    whole: std::ops::Range<usize>,
    closed: bool,
    attributes: Vec<Attribute>,
}

/// Finds the opening and the empty tags of a well-formed document.
fn tags(text: &str) -> Vec<Tag> {
    let mut tags = Vec::new();
    let mut at = 0;
    while let Some(start) = text[at..].find('<').map(|k| at + k) {
        if text[start..].starts_with("<!--") {
            at = text[start..].find("-->").map_or(text.len(), |k| start + k + 3);
            continue;
        }
        let Some(end) = text[start..].find('>').map(|k| start + k + 1) else {
            break;
        };
        at = end;
        if text[start + 1..].starts_with(['/', '!', '?']) {
            continue;
        }
        let mut attributes = Vec::new();
        let mut from = start;
        while let Some(equal) = text[from..end].find("=\"").map(|k| from + k) {
            let Some(close) = text[equal + 2..end].find('"').map(|k| equal + 2 + k) else {
                break;
            };
            let name = text[..equal]
                .rfind(|c: char| c.is_ascii_whitespace())
                .map_or(start, |k| k + 1);
            attributes.push(Attribute {
                name: name..equal,
                value: equal + 2..close,
            });
            from = close + 1;
        }
        tags.push(Tag {
            whole: start..end,
            closed: text[..end].ends_with("/>"),
            attributes,
        });
    }
    tags
}

/// Changes one part of a document. The result is usually well-formed.
pub fn mutate(text: &str, rng: &mut Rng) -> String {
    let tags = tags(text);
    if tags.is_empty() {
        return text.to_string();
    }
    let mut out = text.to_string();
    let tag = &tags[rng.usize(..tags.len())];
    let kind = rng.u32(..30);
    if kind < 5 {
        change_tag(&mut out, tag, kind, rng);
        return out;
    }
    let with: Vec<&Tag> = tags.iter().filter(|t| !t.attributes.is_empty()).collect();
    if with.is_empty() {
        return out;
    }
    let tag = with[rng.usize(..with.len())];
    let attribute = &tag.attributes[rng.usize(..tag.attributes.len())];
    let (name, value) = (&text[attribute.name.clone()], &text[attribute.value.clone()]);
    match kind {
        5..7 => out.replace_range(attribute.name.start..attribute.value.end + 1, ""),
        7 => out.replace_range(attribute.name.clone(), &format!("{name}x")),
        // the value that the same attribute has elsewhere
        8..11 => {
            let all = tags.iter().flat_map(|t| &t.attributes);
            let same: Vec<&Attribute> = all.filter(|a| &text[a.name.clone()] == name).collect();
            let other = same[rng.usize(..same.len())].value.clone();
            out.replace_range(attribute.value.clone(), &text[other]);
        }
        _ => out.replace_range(attribute.value.clone(), &change_value(value, kind, rng)),
    }
    out
}

/// Adds an attribute, removes or repeats an empty element.
fn change_tag(out: &mut String, tag: &Tag, kind: u32, rng: &mut Rng) {
    let text = out[tag.whole.clone()].to_string();
    match kind {
        0 if tag.closed => out.replace_range(tag.whole.clone(), ""),
        1 if tag.closed => out.insert_str(tag.whole.end, &text),
        _ => {
            let (name, value) = ATTRIBUTES[rng.usize(..ATTRIBUTES.len())];
            let end = tag.whole.end - if tag.closed { 2 } else { 1 };
            if !text.contains(&format!(" {name}=")) {
                out.insert_str(end, &format!(" {name}=\"{value}\""));
            }
        }
    }
}

fn change_value(value: &str, kind: u32, rng: &mut Rng) -> String {
    let mut words: Vec<String> = value.split_ascii_whitespace().map(str::to_string).collect();
    let k = rng.usize(..words.len().max(1));
    match kind {
        11..14 if !words.is_empty() => words[k] = WORDS[rng.usize(..WORDS.len())].to_string(),
        14 => drop(words.pop()),
        15 => words.push("0.5".to_string()),
        16 => words = vec![WORDS[rng.usize(..WORDS.len())].to_string()],
        _ => {
            let factors = [
                0.0,
                -1.0,
                0.5,
                2.0,
                1e-3,
                1e3,
                1e-9,
                0.5 + rng.f64(),
                1.0 + 0.1 * rng.f64(),
            ];
            if let Some(number) = words.get(k).and_then(|w| w.parse::<f64>().ok()) {
                words[k] = format!("{}", number * factors[rng.usize(..factors.len())]);
            }
        }
    }
    words.join(" ")
}

/// Generates a small random document of bodies, joints and geoms.
pub fn generate(rng: &mut Rng) -> String {
    let mut xml = String::from("<mujoco><option cone=\"elliptic\"/><compiler angle=\"radian\"/><worldbody>");
    let number = |rng: &mut Rng| match rng.u32(..200) {
        0 => 0.0,
        1 => -rng.f64(),
        2 => 1e-8 * rng.f64(),
        _ => 0.01 + rng.f64(),
    };
    let vector = |rng: &mut Rng, n: usize| (0..n).map(|_| format!("{}", number(rng))).collect::<Vec<_>>().join(" ");
    let mut open = 0;
    for k in 0..1 + rng.usize(..5) {
        xml += &format!("<body name=\"b{k}\" pos=\"{}\"", vector(rng, 3));
        xml += &match rng.u32(..4) {
            0 => format!(" quat=\"{}\">", vector(rng, 4)),
            1 => format!(" euler=\"{}\">", vector(rng, 3)),
            2 => format!(" zaxis=\"{}\">", vector(rng, 3)),
            _ => ">".to_string(),
        };
        open += 1;
        for j in 0..rng.usize(..3) {
            let kind = ["hinge", "slide"][rng.usize(..2)];
            xml += &format!(
                "<joint name=\"j{k}{j}\" type=\"{kind}\" axis=\"{}\" pos=\"{}\"",
                vector(rng, 3),
                vector(rng, 3)
            );
            if rng.bool() {
                let low = number(rng) - 0.5;
                xml += &format!(" range=\"{low} {}\"", low + number(rng));
            }
            xml += &format!(" armature=\"{}\" frictionloss=\"{}\"/>", number(rng).abs(), number(rng));
        }
        for g in 0..1 + rng.usize(..3) {
            let kind = ["sphere", "capsule", "ellipsoid", "cylinder", "box"][rng.usize(..5)];
            xml += &format!("<geom name=\"g{k}{g}\" type=\"{kind}\" size=\"{}\"", vector(rng, 3));
            xml += &match rng.u32(..3) {
                0 => format!(" fromto=\"{}\"", vector(rng, 6)),
                1 => format!(" pos=\"{}\" euler=\"{}\"", vector(rng, 3), vector(rng, 3)),
                _ => String::new(),
            };
            xml += &if rng.bool() {
                format!(" mass=\"{}\"/>", number(rng))
            } else {
                "/>".to_string()
            };
        }
        if rng.u32(..5) == 0 {
            let (pos, mass, diagonal) = (vector(rng, 3), number(rng), vector(rng, 3));
            xml += &format!("<inertial pos=\"{pos}\" mass=\"{mass}\" diaginertia=\"{diagonal}\"/>");
        }
        while open > 0 && rng.bool() {
            xml += "</body>";
            open -= 1;
        }
    }
    (0..open).for_each(|_| xml += "</body>");
    xml + "</worldbody></mujoco>"
}
