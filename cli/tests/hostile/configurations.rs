//! Configurations.

use crate::case::Case;

/// Lines of configurations, by what is wrong with them.
const LINES: &[(&str, &str)] = &[
    ("tab", "scene: crib\n\tbehavior: none"),
    ("unknown key", "behaviour: none"),
    ("unknown key far from all", "xyzzy: 1"),
    ("key with a control character", "\"\\e[2J\": 1"),
    ("key twice", "scene: crib\nscene: base"),
    ("key without value", "scene:"),
    ("list for a choice", "scene: [crib, base]"),
    ("map for a choice", "scene: {a: 1}"),
    ("unknown choice", "scene: beach"),
    ("choice in capitals", "scene: CRIB"),
    ("empty choice", "scene: ''"),
    ("number for a choice", "actuation_model: 7"),
    ("number for a flag", "touch_active: 2"),
    ("text for a flag", "touch_active: maybe"),
    ("nan", "touch_scale: .nan"),
    ("infinity", "touch_scale: .inf"),
    ("negative infinity", "touch_scale: -.inf"),
    ("too large to be a number", "touch_scale: 1e999"),
    ("negative", "touch_scale: -1"),
    ("tiny scale", "touch_scale: 0.000001"),
    ("skin of more than a million points", "touch_scale: 0.01"),
    ("text for a number", "touch_scale: wide"),
    ("two numbers", "touch_scale: 1 2"),
    ("hexadecimal", "max_episode_steps: 0xffffffffffffffffff"),
    ("fraction for a count", "max_episode_steps: 1.5"),
    ("zero steps", "max_episode_steps: 0"),
    ("negative steps", "max_episode_steps: -1"),
    ("steps beyond 64 bits", "max_episode_steps: 99999999999999999999"),
    ("steps beyond numpy", "max_episode_steps: 9223372036854775808"),
    ("frames without end", "frame_skip: 4294967295"),
    ("no frames", "frame_skip: 0"),
    ("huge eyes", "vision_resolution: 1000000"),
    ("no eyes", "vision_resolution: 0"),
    ("huge video", "render_size: 65536"),
    ("no logs", "save_logs_every: 0"),
    ("negative seed", "seed: -1"),
    ("seed beyond 64 bits", "seed: 18446744073709551616"),
    ("empty folder", "save_dir: ''"),
    ("folder with a zero byte", "save_dir: \"a\\0b\""),
    ("unknown output of the eyes", "vision_outputs: [rgb, smell]"),
    ("output of the eyes twice", "vision_outputs: [rgb, rgb]"),
    ("no output of the eyes", "vision_outputs: []"),
    ("nested outputs of the eyes", "vision_outputs: [[rgb]]"),
    ("old age", "age: 25"),
    ("negative age", "age: -0.1"),
    ("age in words", "age: six"),
    ("age nan", "age: .nan"),
    ("no head", "head_circumference: 0"),
    ("tiny head", "head_circumference: 0.1"),
    ("huge head", "head_circumference: 1e9"),
    ("unknown compat", "compat: mujoco"),
    ("unknown engine", "engine: havok"),
    ("unknown renderer", "renderer: vulkan"),
    ("anchor", "scene: &a crib\nsave_dir: *a"),
    ("undefined alias", "scene: *a"),
    ("tag", "scene: !!python/object/apply:os.system ['true']"),
    ("merge key", "<<: {scene: crib}"),
    ("two documents", "scene: crib\n---\nscene: base"),
    ("directive", "%YAML 9.9\n---\nscene: crib"),
    ("block", "save_dir: |\n  a\n  b"),
    ("open quote", "save_dir: \"a"),
    ("open bracket", "vision_outputs: [rgb"),
    ("wrong escape", "save_dir: \"\\q\""),
    ("surrogate", "save_dir: \"\\ud800\""),
    ("indented key", "scene: crib\n  behavior: none"),
    ("list", "- scene: crib"),
    ("scalar", "crib"),
    ("number", "42"),
    ("null", "~"),
    ("key is a list", "[a, b]: 1"),
    ("key is null", "~: 1"),
    ("key is empty", "'': 1"),
    ("colon only", ":"),
    ("at sign", "@"),
    ("backtick", "`"),
    ("carriage returns", "scene: beach\r\rbehavior: none"),
    ("line separator", "scene: be\u{2028}ach"),
    ("right to left", "scene: \"\u{202e}birc\""),
];

fn case(name: &str, bytes: impl AsRef<[u8]>) -> Case {
    let call = "run --config c.yml --steps 1 --quiet";
    Case::new(format!("configuration: {name}"), call).file("c.yml", bytes.as_ref())
}

pub fn cases() -> Vec<Case> {
    let lines = LINES.iter().map(|(name, text)| case(name, text));
    let made = [
        case("not UTF-8", b"scene: \xff\xfe"),
        case("UTF-16", b"\xff\xfes\0c\0e\0n\0e\0"),
        case("zero bytes", b"scene: crib\0"),
        case("control character", b"scene: \x1b[2J"),
        case("long key", format!("{}: 1", "k".repeat(100_000))),
        case("long value", format!("scene: {}", "v".repeat(100_000))),
        case("long number", format!("seed: {}", "9".repeat(100_000))),
        case("deep list", format!("vision_outputs: {}", "[".repeat(100_000))),
        case("deep map", format!("scene: {}", "{a: ".repeat(50_000))),
        case(
            "deep block",
            (0..2000)
                .map(|k| format!("{}a:\n", " ".repeat(k % 500)))
                .collect::<String>(),
        ),
        case(
            "many keys",
            (0..50_000).map(|k| format!("k{k}: 1\n")).collect::<String>(),
        ),
        case(
            "many anchors",
            "- &a [x]\n- &b [*a, *a, *a]\n- &c [*b, *b, *b]\n- [*c, *c, *c]",
        ),
        case("many lines", "\n".repeat(1_000_000) + "x: 1"),
        case("more than a megabyte", "# ".repeat(600_000)),
        case(
            "long comment, then a mistake",
            format!("#{}\nscene: beach", "c".repeat(500_000)),
        ),
    ];
    lines.chain(made).collect()
}
