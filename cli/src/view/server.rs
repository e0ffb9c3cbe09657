//! The server for browsers on this machine: it serves a page and passes on requests, which the program answers.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Maximum size of a request's head, and of its body, bytes.
const HEAD: usize = 16 << 10;
const BODY: usize = 16 << 10;
/// Bytes of a refused request that are read so that its sender sees the answer.
const REST: u64 = 1 << 20;
/// Connections at once: a browser opens six.
const CONNECTIONS: usize = 24;
/// Time limits of a browser's request, and of a request's wait for the program.
const PATIENCE: Duration = Duration::from_secs(20);
const BUSY: Duration = Duration::from_secs(2);

const HTML: &str = include_str!("page.html");
const SCRIPT: &str = include_str!("page.js");

/// The answer to a request: the picture, or what is wrong with the request.
pub type Answer = Result<Vec<u8>, String>;

/// A request of a page: the visitor's actions, line by line. The answer is the resulting picture.
pub struct Ask {
    pub words: String,
    pub reply: SyncSender<Answer>,
    /// Whether the program has received it: a large picture may then take longer than a busy program has to receive it.
    received: Arc<AtomicBool>,
}

/// A server on the loopback interface.
pub struct Server {
    address: SocketAddr,
    path: String,
    asks: Receiver<Ask>,
    closed: Arc<AtomicBool>,
    listens: Option<JoinHandle<()>>,
}

/// State shared by all connections.
struct Shared {
    /// The path of the page, which cannot be guessed.
    path: String,
    asks: SyncSender<Ask>,
    open: AtomicUsize,
}

impl Server {
    /// Starts to listen on a port; 0 chooses any free one.
    ///
    /// # Errors
    /// The port is taken.
    pub fn open(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let address = listener.local_addr()?;
        // the keys of the standard library's hashes are the system's random numbers
        let word = || RandomState::new().build_hasher().finish();
        let path = format!("/{:016x}{:016x}/", word(), word());
        let (sender, asks) = sync_channel(64);
        let closed = Arc::new(AtomicBool::new(false));
        let shared = Arc::new(Shared {
            path: path.clone(),
            asks: sender,
            open: AtomicUsize::new(0),
        });
        let stop = closed.clone();
        let listens = thread::Builder::new()
            .name("view".to_owned())
            .spawn(move || accept(&listener, &shared, &stop))?;
        Ok(Self {
            address,
            path,
            asks,
            closed,
            listens: Some(listens),
        })
    }

    /// Returns the address of the page.
    pub fn url(&self) -> String {
        format!("http://{}{}", self.address, self.path)
    }

    /// Waits for a request, up to a time limit.
    pub fn ask(&self, wait: Duration) -> Option<Ask> {
        match self.asks.recv_timeout(wait) {
            Ok(ask) => {
                ask.received.store(true, Ordering::Relaxed);
                Some(ask)
            }
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                thread::sleep(wait);
                None
            }
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::Relaxed);
        // the connection wakes the listener; when it has gone, the port is free
        if TcpStream::connect_timeout(&self.address, Duration::from_secs(1)).is_ok()
            && let Some(listens) = self.listens.take()
        {
            let _ = listens.join();
        }
    }
}

/// Accepts connections until the server is closed.
fn accept(listener: &TcpListener, shared: &Arc<Shared>, closed: &AtomicBool) {
    for stream in listener.incoming() {
        if closed.load(Ordering::Relaxed) {
            return;
        }
        let Ok(stream) = stream else { continue };
        if shared.open.fetch_add(1, Ordering::Relaxed) >= CONNECTIONS {
            shared.open.fetch_sub(1, Ordering::Relaxed);
            continue;
        }
        let mine = shared.clone();
        let started = thread::Builder::new()
            .name("view connection".to_owned())
            .spawn(move || {
                // a browser that disconnects is not an error
                let _ = serve(stream, &mine);
                mine.open.fetch_sub(1, Ordering::Relaxed);
            });
        if started.is_err() {
            shared.open.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

/// The parts of a request that the server uses.
#[derive(Debug, Default, PartialEq)]
struct Request {
    method: String,
    path: String,
    host: String,
    origin: Option<String>,
    body: String,
}

/// Answer to a request that is refused: the status and its text.
type Refusal = (&'static str, &'static str);

/// Answers one request after the other.
fn serve(mut stream: TcpStream, shared: &Shared) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let mut bytes = Vec::new();
    loop {
        let request = match read(&mut stream, &mut bytes)? {
            Some(Ok(request)) => request,
            Some(Err((status, text))) => {
                respond(&mut stream, status, "text/plain; charset=utf-8", text.as_bytes())?;
                // closed with bytes unread, the connection would be reset, and the answer lost on its way
                stream.shutdown(Shutdown::Write)?;
                return io::copy(&mut stream.take(REST), &mut io::sink()).map(|_| ());
            }
            None => return Ok(()),
        };
        let (status, kind, body) = answer(&request, shared);
        respond(&mut stream, status, kind, &body)?;
    }
}

/// Reads a request, whose start may be in `bytes`. Bytes after the request stay there. `None` if the browser has disconnected.
fn read(stream: &mut impl Read, bytes: &mut Vec<u8>) -> io::Result<Option<Result<Request, Refusal>>> {
    let mut more = [0; 4096];
    loop {
        match parse(bytes) {
            Ok(Some((request, length))) => {
                bytes.drain(..length);
                return Ok(Some(Ok(request)));
            }
            Ok(None) => {}
            Err(refusal) => return Ok(Some(Err(refusal))),
        }
        match stream.read(&mut more)? {
            0 => return Ok(None),
            n => bytes.extend_from_slice(more.get(..n).unwrap_or_default()),
        }
    }
}

/// Parses a request with its body and returns its length; `None` if it is not complete.
fn parse(bytes: &[u8]) -> Result<Option<(Request, usize)>, Refusal> {
    const BAD: &str = "400 Bad Request";
    const LARGE: &str = "413 Content Too Large";
    let mut headers = [httparse::EMPTY_HEADER; 64];
    let mut parsed = httparse::Request::new(&mut headers);
    let head = match parsed.parse(bytes) {
        Ok(httparse::Status::Complete(head)) => head,
        Ok(httparse::Status::Partial) if bytes.len() <= HEAD => return Ok(None),
        Ok(httparse::Status::Partial) => return Err((LARGE, "the head of the request is too long")),
        Err(_) => return Err((BAD, "this is not an HTTP request")),
    };
    let text = |name: &str| {
        let found = parsed.headers.iter().find(|h| h.name.eq_ignore_ascii_case(name));
        found.map(|h| String::from_utf8_lossy(h.value).into_owned())
    };
    if text("transfer-encoding").is_some() {
        return Err(("501 Not Implemented", "a body needs a Content-Length"));
    }
    let length = text("content-length").map_or(Ok(0), |length| length.parse::<usize>());
    let length = length.map_err(|_| (BAD, "the length of the body is not a number"))?;
    if length > BODY {
        return Err((LARGE, "the body of the request is too long"));
    }
    let Some(body) = bytes.get(head..head + length) else {
        return Ok(None);
    };
    let request = Request {
        method: parsed.method.unwrap_or_default().to_owned(),
        path: parsed.path.unwrap_or_default().to_owned(),
        host: text("host").unwrap_or_default(),
        origin: text("origin"),
        body: String::from_utf8_lossy(body).into_owned(),
    };
    Ok(Some((request, head + length)))
}

/// Returns whether the request comes from a page of this server. Other pages in the same browser may not send any. A host name that only
/// resolves to this machine (DNS rebinding) is another host. Ports may differ, because of tunnels.
fn is_ours(request: &Request) -> bool {
    let name = request.host.rsplit_once(':').map_or(&*request.host, |(name, _)| name);
    let origin = request.origin.as_deref().map(|origin| origin.strip_prefix("http://"));
    ["127.0.0.1", "localhost"].contains(&name) && origin.is_none_or(|origin| origin == Some(&request.host))
}

/// Returns the status, the type and the body of the answer.
fn answer(request: &Request, shared: &Shared) -> (&'static str, &'static str, Vec<u8>) {
    const TEXT: &str = "text/plain; charset=utf-8";
    let say = |status, text: &str| (status, TEXT, text.as_bytes().to_vec());
    if !is_ours(request) {
        return say("403 Forbidden", "open the address that the viewer printed");
    }
    let Some(file) = request.path.strip_prefix(&*shared.path) else {
        return say(
            "404 Not Found",
            "open the address that the viewer printed, with all of its letters",
        );
    };
    match (&*request.method, file) {
        ("GET", "") => ("200 OK", "text/html; charset=utf-8", HTML.as_bytes().to_vec()),
        ("GET", "page.js") => ("200 OK", "text/javascript; charset=utf-8", SCRIPT.as_bytes().to_vec()),
        ("POST", "frame") => {
            let (reply, answers) = sync_channel(1);
            let words = request.body.clone();
            let received = Arc::new(AtomicBool::new(false));
            let ask = Ask {
                words,
                reply,
                received: received.clone(),
            };
            if shared.asks.try_send(ask).is_err() {
                return say("503 Service Unavailable", "the program is busy, or has ended");
            }
            let mut answer = answers.recv_timeout(BUSY);
            if answer == Err(RecvTimeoutError::Timeout) && received.load(Ordering::Relaxed) {
                answer = answers.recv_timeout(PATIENCE);
            }
            match answer {
                Ok(Ok(frame)) => ("200 OK", "application/octet-stream", frame),
                Ok(Err(text)) => say("400 Bad Request", &text),
                Err(_) => say("503 Service Unavailable", "the program is busy, or has ended"),
            }
        }
        (_, "" | "page.js" | "frame") => say("405 Method Not Allowed", "this cannot be asked so"),
        _ => say("404 Not Found", "there is no such file"),
    }
}

/// Sends an answer.
fn respond(stream: &mut impl Write, status: &str, kind: &str, body: &[u8]) -> io::Result<()> {
    let mut bytes = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Referrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\nContent-Security-Policy: default-src 'none'; \
         script-src 'self'; style-src 'unsafe-inline'; img-src data:; connect-src 'self'; base-uri 'none'\r\n\r\n",
        body.len()
    )
    .into_bytes();
    bytes.extend_from_slice(body);
    stream.write_all(&bytes)?;
    stream.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(text: &str) -> Result<Option<(Request, usize)>, Refusal> {
        parse(text.as_bytes())
    }

    #[test]
    fn requests_are_read_whole_or_refused() {
        let text = "POST /x/frame HTTP/1.1\r\nHost: 127.0.0.1:80\r\nContent-Length: 5\r\n\r\npause";
        for cut in 0..text.len() {
            assert_eq!(request(&text[..cut]), Ok(None), "{cut}");
        }
        let (read, length) = request(&format!("{text}GET /")).expect("a request").expect("complete");
        assert_eq!((length, &*read.method, &*read.path), (text.len(), "POST", "/x/frame"));
        assert_eq!((&*read.host, &*read.body), ("127.0.0.1:80", "pause"));
        for (bad, status) in [
            ("hello\r\n\r\n", "400"),
            ("GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n", "400"),
            ("GET / HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n", "413"),
            ("GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n", "501"),
        ] {
            let refused = request(bad).expect_err(bad);
            assert!(refused.0.starts_with(status), "{bad}: {refused:?}");
        }
        let long = format!("GET / HTTP/1.1\r\nA: {}", "a".repeat(2 * HEAD));
        assert!(request(&long).is_err());
    }

    #[test]
    fn other_pages_of_the_browser_may_not_ask() {
        let from = |host: &str, origin: Option<&str>| {
            is_ours(&Request {
                host: host.to_owned(),
                origin: origin.map(str::to_owned),
                ..Request::default()
            })
        };
        assert!(from("127.0.0.1:8000", None) && from("localhost:99", Some("http://localhost:99")));
        assert!(!from("127.0.0.1:8000", Some("http://elsewhere.example")) && !from("127.0.0.1:8000", Some("null")));
        assert!(!from("elsewhere.example:8000", None) && !from("", None));
    }
}
