//! Pickles: logs of training and of evaluation.

use crate::bytes::{dict, list, pickle, text};
use crate::case::{Case, Content};

fn training(name: &str, log: impl Into<Content>) -> Case {
    Case::new(format!("log: {name}"), "score run").file("run/logs/training.pkl", log)
}

fn evaluation(name: &str, log: impl Into<Content>) -> Case {
    Case::new(format!("evaluation: {name}"), "report run").file("run/logs/evaluation_0.pkl", log)
}

/// A log of one record with these values.
fn record(right: &[u8], left: &[u8], steps: &[u8]) -> Vec<u8> {
    let record = dict(&[
        ("right_hand_touches", right),
        ("left_hand_touches", left),
        ("steps", steps),
    ]);
    pickle(&list(&[&record, &record]))
}

/// Opcodes of a call of a name of a module.
fn call(module: &str, name: &str) -> Vec<u8> {
    pickle(&[&text(module)[..], &text(name), b"\x93(", &text("true"), b"tR"].concat())
}

/// Opcodes of an array with any state.
fn array(dtype: &str, shape: &[u8], bytes: &[u8]) -> Vec<u8> {
    let types = [&b"cnumpy\ndtype\n("[..], &text(dtype), b"K\x00K\x01tR"].concat();
    let length = (bytes.len() as u32).to_le_bytes();
    let start: &[u8] = b"cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\n(K\x00tC\x01btR(K\x01";
    [start, shape, &types, b"\x89B", &length, bytes, b"tb"].concat()
}

fn episode(qpos: &[u8], info: &[u8]) -> Vec<u8> {
    pickle(&dict(&[("qpos", &list(&[qpos])), ("info", info)]))
}

pub fn cases() -> Vec<Case> {
    let none = list(&[]);
    let one = list(&[b"K\x05"]);
    let huge = b"\x8a\x08\xff\xff\xff\xff\xff\xff\xff\x7f"; // 2^63 - 1
    let regards = |n: &[u8], steps: &[u8]| {
        let keys = [
            "right_eye_right_hand",
            "right_eye_left_hand",
            "left_eye_right_hand",
            "left_eye_left_hand",
        ];
        let entries: Vec<(&str, &[u8])> = keys.map(|key| (key, n)).into_iter().chain([("steps", steps)]).collect();
        let record = dict(&entries);
        pickle(&list(&[&record[..]; 5]))
    };
    let steps = dict(&[("steps", b"K\x01")]);
    // one record, and how often it is told
    let shared = |n: usize| pickle(&[b"]", &steps[..], b"q\x00a(", &b"h\x00".repeat(n), b"e"].concat());
    let ids = |from: u32, n: u32| {
        let ids: Vec<u8> = (from..from + n)
            .flat_map(|id| [&b"J"[..], &id.to_le_bytes()].concat())
            .collect();
        [b"](", &ids[..], b"e"].concat()
    };
    let zeros = array("f8", b"(K\x02t", &[0; 16]);
    let logs = vec![
        training("empty", ""),
        training("text", "no pickle"),
        training("protocol 6", b"\x80\x06]."),
        training("only the protocol", b"\x80\x04"),
        training("cut", &record(&one, &one, b"K\x01")[..20]),
        training("stop without a value", b"\x80\x04."),
        training("two values", b"\x80\x04]]."),
        training(
            "bytes behind its end",
            [&record(&one, &one, b"K\x01")[..], b"more"].concat(),
        ),
        training("call of os.system", call("os", "system")),
        training("call of eval", call("builtins", "eval")),
        training("call of a name with escape sequences", call("\u{1b}[2J", "x")),
        training(
            "call of a long name",
            b"\x80\x02c"
                .iter()
                .copied()
                .chain(vec![b'a'; 100_000])
                .chain(*b"\nb\n.")
                .collect::<Vec<u8>>(),
        ),
        training("call by the old opcode", b"cos\nsystem\n(S'true'\ntR."),
        training("object of a class", b"(i__main__\nA\n."),
        training("persistent object", b"Pfile\n."),
        training("reduce of a list", pickle(b"](tR")),
        training("memo that is not there", pickle(b"h\x07")),
        training("list that holds itself", pickle(b"]q\x00h\x00a")),
        training("dictionary that holds itself", pickle(b"}q\x00X\x01\0\0\0ah\x00s")),
        training("items without a mark", pickle(b"]e")),
        training("pop of nothing", pickle(b"0")),
        training("odd number of items", pickle(b"}(K\x01u")),
        training("key that is a number", pickle(b"](}(K\x01K\x02ue")),
        training(
            "100,000 lists in lists",
            pickle(&[vec![b']'; 100_000], vec![b'a'; 99_999]].concat()),
        ),
        training("text of 4 GB", b"\x80\x04X\xff\xff\xff\xff."),
        training("bytes of 2^63", b"\x80\x04\x8e\xff\xff\xff\xff\xff\xff\xff\x7f."),
        training("text that is not UTF-8", b"\x80\x04\x8c\x01\xff."),
        training(
            "whole number of 255 bytes",
            [&b"\x80\x04\x8a\xff"[..], &[7; 255], b"."].concat(),
        ),
        training(
            "frame longer than the file",
            b"\x80\x04\x95\xff\xff\xff\xff\xff\xff\xff\xff].",
        ),
        training("no list", pickle(b"}")),
        training("number", pickle(b"K\x01")),
        training("no records", pickle(b"]")),
        training("records that are numbers", pickle(&list(&[b"K\x01"]))),
        training("record without steps", pickle(&list(&[b"}"]))),
        training("negative steps", record(&one, &one, b"J\xff\xff\xff\xff")),
        training("steps with a point", record(&one, &one, b"G?\xf8\0\0\0\0\0\0")),
        training("steps in words", record(&one, &one, &text("ten"))),
        training("touches that are a number", record(b"K\x05", &one, b"K\x01")),
        training("touches in words", record(&list(&[&text("head")]), &one, b"K\x01")),
        training("negative touch", record(&list(&[b"J\xff\xff\xff\xff"]), &one, b"K\x01")),
        training("touch beyond all geoms", record(&list(&[huge]), &one, b"K\x01")),
        training("touch of geom 20,000", record(&list(&[b"M \x4e"]), &one, b"K\x01")),
        training(
            "geoms that no hand can reach",
            record(&ids(0, 60), &ids(0, 60), b"K\x0a"),
        ),
        training("4,097 touches", record(&ids(0, 4097), &none, b"K\x01")),
        training("steps whose sum overflows", record(&one, &one, huge)),
        training("regards whose sum overflows", regards(huge, huge)),
        training("regards of more than there are steps", regards(b"M\xff\xff", b"K\x01")),
        training("no steps at all", record(&one, &one, b"K\x00")),
        training(
            "two behaviors",
            pickle(&list(&[
                &steps,
                &dict(&[
                    ("right_hand_touches", &one),
                    ("left_hand_touches", &one),
                    ("steps", b"K\x01"),
                ]),
            ])),
        ),
        training("neither behavior", pickle(&list(&[&steps, &steps]))),
        training("2,000,001 records in one", shared(2_000_001)),
        training("20 million records in one", shared(20_000_000)),
        training(
            "20 million lists",
            pickle(&[b"](".as_slice(), &vec![b']'; 20_000_000], b"e"].concat()),
        ),
        training(
            "70 million nothings",
            pickle(&[b"](".as_slice(), &vec![b'N'; 70_000_000], b"e"].concat()),
        ),
        training("evaluation for a training", episode(&zeros, &list(&[&steps]))),
        training("300 MB of zeros", Content::Zeros(300_000_000)),
        training("a pipe", Content::Pipe),
        training("a device", Content::Link("/dev/zero")),
        training("a link to nothing", Content::Link("nothing")),
        training("a link in a circle", Content::Link("training.pkl")),
    ];
    let episodes = vec![
        evaluation("empty", ""),
        evaluation("training for an evaluation", pickle(&list(&[&steps]))),
        evaluation("without positions", pickle(&dict(&[("info", &list(&[&steps]))]))),
        evaluation("without information", pickle(&dict(&[("qpos", &zeros)]))),
        evaluation("positions that are a list", episode(&one, &list(&[&steps]))),
        evaluation(
            "more information than positions",
            episode(&zeros, &list(&[&steps, &steps, &steps])),
        ),
        evaluation("information that is a number", episode(&zeros, b"K\x01")),
        evaluation(
            "positions nan",
            episode(&array("f8", b"(K\x02t", &[0xff; 16]), &list(&[&steps])),
        ),
        evaluation(
            "positions of two dimensions",
            episode(&array("f8", b"(K\x01K\x02t", &[0; 16]), &list(&[&steps])),
        ),
        evaluation(
            "positions of no numbers",
            episode(&array("f8", b"(K\x00t", &[]), &list(&[&steps])),
        ),
        evaluation(
            "fewer bytes than the shape",
            episode(&array("f8", b"(K\x09K\x09t", &[0; 16]), &list(&[&steps])),
        ),
        evaluation(
            "shape that is huge",
            episode(
                &array("f8", b"(J\xff\xff\xff\x7fJ\xff\xff\xff\x7ft", &[0; 16]),
                &list(&[&steps]),
            ),
        ),
        evaluation(
            "negative shape",
            episode(&array("f8", b"(J\xff\xff\xff\xffK\x02t", &[0; 16]), &list(&[&steps])),
        ),
        evaluation(
            "shape of nine dimensions",
            episode(
                &array("f8", b"(K\x01K\x01K\x01K\x01K\x01K\x01K\x01K\x01K\x02t", &[0; 16]),
                &list(&[&steps]),
            ),
        ),
        evaluation("objects", episode(&array("O8", b"(K\x02t", &[0; 16]), &list(&[&steps]))),
        evaluation(
            "numbers of 9 bytes",
            episode(&array("f9", b"(K\x02t", &[0; 18]), &list(&[&steps])),
        ),
        evaluation("a pipe", Content::Pipe),
        evaluation("number beyond 64 bits in its name", "").file("run/logs/evaluation_99999999999999999999999.pkl", ""),
    ];
    [logs, episodes].concat()
}
