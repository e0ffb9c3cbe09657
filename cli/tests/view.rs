//! The viewer as a browser meets it.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use babybench::Config;
use babybench::config::{Behavior, Scene};
use common::*;
use program::*;
use serde_json::Value;

/// A viewer that runs, and where its page is.
struct Viewer {
    child: Child,
    host: String,
    path: String,
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Viewer {
    /// Starts the program, with Ctrl-C as it is by default.
    fn start(folder: &Folder, arguments: &[&str]) -> Self {
        let program = program(folder.path(), &[&["view"], arguments].concat());
        let mut command = Command::new("env");
        command
            // as in a terminal, and as under `nohup`
            .args(["--default-signal=INT", "--ignore-signal=HUP", "--"])
            .arg(program.get_program())
            .args(program.get_args());
        let mut child = command
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().expect("its output"));
        out.read_line(&mut line).expect("an address");
        child.stdout = Some(out.into_inner());
        let rest = line.trim().strip_prefix("http://").expect(&line);
        let (host, path) = rest.split_once('/').expect(&line);
        let (host, path) = (host.to_owned(), format!("/{path}"));
        Self { child, host, path }
    }

    /// Sends a request with headers of its own and returns the status, the head and the body of the answer.
    fn send(&self, start: &str, headers: &str, body: &str) -> (u16, String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a limit");
        let length = body.len();
        // at once: what is refused by its first line is answered before the rest is read
        let request = format!("{start} HTTP/1.1\r\n{headers}\r\nContent-Length: {length}\r\n\r\n{body}");
        stream.write_all(request.as_bytes()).expect("sent");
        let (mut bytes, mut more) = (Vec::new(), [0; 65536]);
        loop {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            if let Some((head, _)) = text.split_once("\r\n\r\n") {
                let length = head.lines().find_map(|l| l.strip_prefix("Content-Length: "));
                let whole = head.len() + 4 + length.expect("a length").parse::<usize>().expect("a number");
                if bytes.len() == whole {
                    let status = head[9..12].parse().expect("a status");
                    return (status, head.to_owned(), bytes.split_off(head.len() + 4));
                }
            }
            let n = stream.read(&mut more).expect("an answer");
            assert!(n > 0, "hung up after {text}");
            bytes.extend_from_slice(&more[..n]);
        }
    }

    fn get(&self, file: &str) -> (u16, String, Vec<u8>) {
        self.send(&format!("GET {}{file}", self.path), &format!("Host: {}", self.host), "")
    }

    /// Says what people do; returns what the program says and the picture. A program that is busy is asked again, with nothing new to do.
    fn ask(&self, words: &str) -> (Value, Vec<u8>) {
        let mut words = words.to_owned();
        loop {
            let (status, _, body) = self.send(
                &format!("POST {}frame", self.path),
                &format!("Host: {}", self.host),
                &words,
            );
            if status == 503 {
                words.clear();
                continue;
            }
            assert_eq!(status, 200, "{}", String::from_utf8_lossy(&body));
            let end = body.iter().position(|&b| b == b'\n').expect("a line");
            return (
                serde_json::from_slice(&body[..end]).expect("JSON"),
                body[end + 1..].to_vec(),
            );
        }
    }

    /// Asks until the program says so.
    fn until(&self, what: &str, fits: impl Fn(&Value) -> bool) -> Value {
        for _ in 0..2000 {
            let said = self.ask("").0;
            if fits(&said) {
                return said;
            }
        }
        panic!("never: {what}");
    }
}

/// MIMo on the floor, where nothing stands between him and the camera; episodes are long.
fn config(folder: &Folder, steps: u64) -> String {
    let config = Config {
        max_episode_steps: steps,
        touch_active: true,
        ..free(Behavior::None, Scene::Base)
    };
    folder.file("view.yml", config.to_yaml()).display().to_string()
}

fn number(said: &Value, key: &str) -> f64 {
    said[key]
        .as_f64()
        .unwrap_or_else(|| panic!("no number {key} in {said}"))
}

#[test]
fn a_page_and_pictures_of_an_infant_who_can_be_stopped() {
    let folder = Folder::new("view");
    let file = config(&folder, 1_000_000);
    let viewer = Viewer::start(&folder, &["--config", &file, "--port", "0"]);
    let (status, head, page) = viewer.get("");
    assert_eq!(status, 200);
    assert!(head.contains("Content-Security-Policy: default-src 'none'"), "{head}");
    assert!(String::from_utf8_lossy(&page).contains("page.js"));
    let (status, head, script) = viewer.get("page.js");
    assert!(status == 200 && head.contains("text/javascript") && script.len() > 1000);

    let (said, picture) = viewer.ask("size 160 120\npause 1");
    assert!(
        picture.starts_with(&[0xff, 0xd8]) && picture.ends_with(&[0xff, 0xd9]),
        "no JPEG"
    );
    assert!(said["paused"].as_bool().expect("a state"));
    assert_eq!(said["title"], "none in base, moved by held");
    let (stands, same) = viewer.ask("");
    assert_eq!(
        (number(&stands, "time"), &same),
        (number(&said, "time"), &picture),
        "time stands"
    );
    viewer.ask("step");
    let one = viewer.until("one step", |said| number(said, "steps") > number(&stands, "steps"));
    assert_eq!(number(&one, "steps"), number(&stands, "steps") + 1.0);
    assert!((number(&one, "time") - number(&stands, "time") - 0.005).abs() < 1e-9);
    let faster = viewer.ask("speed 4\npause 0").0;
    assert_eq!(
        (number(&faster, "speed"), &faster["paused"]),
        (4.0, &Value::Bool(false))
    );
    viewer.until("time goes on", |said| {
        number(said, "steps") > number(&one, "steps") + 3.0
    });
    let said = viewer.ask("pause 1\nreset").0;
    assert!(number(&said, "steps") > 0.0);
    viewer.until("a new episode", |said| number(said, "steps") == 0.0);
    let (turned, other) = viewer.ask("turn 30 5\nshift 0.1 0\nzoom 0.8");
    assert!(turned["camera"].is_null() && other != picture);
    assert_eq!(viewer.ask("camera top").0["camera"], "top");
    assert!(viewer.ask("home\ncontacts 1").0["camera"].is_null());
}

#[test]
fn a_part_is_pulled_by_a_spring_until_it_is_let_go() {
    let folder = Folder::new("view_pull");
    let file = config(&folder, 1_000_000);
    let viewer = Viewer::start(&folder, &["--config", &file, "--policy", "zero"]);
    // the camera looks at the hip
    let held = viewer.ask("size 200 200\npause 1\nhold 0.5 0.5").0;
    let spring = held["over"]["spring"].as_array().expect("a spring").clone();
    assert_eq!(spring[0], spring[2], "it is not stretched yet");
    let pulled = viewer.ask("drag 0.5 0.2\npause 0\nspeed 8").0;
    assert_eq!(pulled["over"]["spring"][3], 0.2);
    let start = spring[1].as_f64().expect("a number");
    viewer.until("he is lifted", |said| {
        said["over"]["spring"][1].as_f64().is_some_and(|y| y < start - 0.05)
    });
    assert!(viewer.ask("release").0["over"]["spring"].is_null());
    // a wall is not pulled
    assert!(viewer.ask("pause 1\nhold 0.01 0.99").0["over"]["spring"].is_null());
    let (status, ..) = viewer.send(
        &format!("POST {}frame", viewer.path),
        &format!("Host: {}", viewer.host),
        "hold 7 -3",
    );
    assert_eq!(status, 200, "outside of the picture is nothing");
}

#[test]
fn strangers_and_nonsense_are_refused() {
    let folder = Folder::new("view_refused");
    let file = config(&folder, 1_000_000);
    let viewer = Viewer::start(&folder, &["--config", &file]);
    let host = format!("Host: {}", viewer.host);
    let page = format!("GET {}", viewer.path);
    for (start, headers, status) in [
        (&*page, "Host: elsewhere.example", 403),
        (&page, &format!("{host}\r\nOrigin: http://elsewhere.example"), 403),
        ("GET /", &host, 404),
        ("GET /0123456789abcdef0123456789abcdef/", &host, 404),
        (&format!("{page}../etc/passwd"), &host, 404),
        (&format!("{page}frame"), &host, 405),
        (&format!("POST {}", viewer.path), &host, 405),
        ("nonsense", &host, 400),
    ] {
        assert_eq!(viewer.send(start, headers, "").0, status, "{start} {headers}");
    }
    let ask = format!("POST {}frame", viewer.path);
    for words in [
        "fly",
        "size 3",
        "turn a b",
        "zoom NaN",
        "speed inf",
        "camera of the neighbours",
        "hold 1",
        "size 1 2 3",
    ] {
        let (status, _, body) = viewer.send(&ask, &host, words);
        let text = String::from_utf8_lossy(&body).into_owned();
        assert!(
            status == 400 && text.contains(words.split(' ').next_back().expect("a word")),
            "{words}: {status} {text}"
        );
    }
    // the largest and the smallest picture
    for size in ["1e30 1e30", "0 -5"] {
        assert!(
            viewer.ask(&format!("size {size}")).1.starts_with(&[0xff, 0xd8]),
            "{size}"
        );
    }
    let port = viewer.host.rsplit_once(':').expect("a port").1;
    let out = babybench(folder.path(), &["view", "--config", &file, "--port", port]);
    assert!(
        !out.status.success() && text(&out).contains(&format!("--port {port}")),
        "{}",
        text(&out)
    );
}

#[test]
fn it_ends_after_its_episodes_or_when_it_is_interrupted() {
    let folder = Folder::new("view_ends");
    let file = config(&folder, 5);
    let out = babybench(
        folder.path(),
        &["view", "--config", &file, "--episodes", "2", "--seed", "1"],
    );
    assert!(
        out.status.success() && text(&out).contains("http://127.0.0.1:"),
        "{}",
        text(&out)
    );
    let mut viewer = Viewer::start(&folder, &["--config", &file]);
    viewer.ask("pause 1");
    // the shell's own: a small system has no program `kill`
    let sent = Command::new("sh")
        .args(["-c", &format!("kill -INT {}", viewer.child.id())])
        .status();
    assert!(sent.expect("the signal is sent").success());
    assert_eq!(viewer.child.wait().expect("it ends").code(), Some(0));
}
