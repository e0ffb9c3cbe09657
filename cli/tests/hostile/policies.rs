//! Programs as policies.

use crate::case::Case;
use crate::runs::quick;

/// Scripts for `sh`, by what is wrong with them.
const SCRIPTS: &[(&str, &str)] = &[
    ("ends at once", "exit 0"),
    ("fails at once", "exit 3"),
    ("ends by a signal", "kill -9 $$"),
    ("says nothing", "sleep 100"),
    ("reads nothing", "exec sleep 100 <&-"),
    ("closes its output", "exec >&-; read line; sleep 100"),
    ("answers twice", "while read line; do printf '[1]\n[1]\n'; done"),
    ("answers with an empty line", "while read line; do echo; done"),
    ("answers with words", "while read line; do echo hello; done"),
    (
        "answers with an object",
        "while read line; do echo '{\"action\": []}'; done",
    ),
    ("answers with null", "while read line; do echo null; done"),
    ("answers with one number", "while read line; do echo '[1]'; done"),
    (
        "answers with too many numbers",
        "while read line; do echo \"[0$(printf ',0%.0s' $(seq 99))]\"; done",
    ),
    ("answers with nan", "while read line; do echo '[NaN]'; done"),
    (
        "answers with infinity",
        "while read line; do echo '[1, -Infinity]'; done",
    ),
    (
        "answers with a number that is too large",
        "while read line; do echo '[1e999]'; done",
    ),
    (
        "answers with words in a list",
        "while read line; do echo '[\"1\"]'; done",
    ),
    (
        "answers with lists in lists",
        "while read line; do echo '[[[[1]]]]'; done",
    ),
    ("answers with an open list", "while read line; do echo '[1, 2'; done"),
    (
        "answers with escape sequences",
        "while read line; do printf '\\033[2J[1]\\n'; done",
    ),
    (
        "answers with what is not UTF-8",
        "while read line; do printf '\\377\\376\\n'; done",
    ),
    (
        "answers with zero bytes",
        "while read line; do printf '\\000\\000\\n'; done",
    ),
    ("answers without a line break and ends", "read line; printf '[1]'"),
    (
        "answers without a line break and waits",
        "read line; printf '[1'; sleep 100",
    ),
    (
        "writes 2 MB without a line break",
        "read line; head -c 2000000 /dev/zero; cat > /dev/null",
    ),
    ("writes without end", "exec cat /dev/zero"),
    ("lists in lists without end", "read line; yes '[' | tr -d '\\n'"),
    ("leaves a child behind that holds its output", "sleep 100 & exit 4"),
];

pub fn cases() -> Vec<Case> {
    let call = "evaluate --config c.yml --episodes 1 --duration 3 --no-render --quiet --policy-timeout 2 --policy";
    let named = |name: &str| quick(format!("policy: {name}"), call);
    let script = |(name, text): &(&str, &str)| named(name).argument("sh script.sh").file("script.sh", text);
    let words = [
        ("empty", ""),
        ("spaces", "   "),
        ("program that is not there", "no_such_program --fast"),
        ("file that is not a program", "./c.yml"),
        ("folder", "./"),
        ("open quote", "sh 'script.sh"),
        ("backslash at its end", "sh script.sh\\"),
        ("escape sequences", "\u{1b}[2J"),
        ("model that is not there", "none.onnx"),
        ("unknown word", "greedy"),
    ];
    let words = words.map(|(name, policy)| named(name).argument(policy));
    SCRIPTS.iter().map(script).chain(words).collect()
}
