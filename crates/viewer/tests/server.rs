//! The server as a browser, and as somebody with bad intentions, sees it.
// A panic is how a test fails.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::io::{Read, Write};
use std::net::{IpAddr, Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::time::Duration;

use catenix_results::{ResultStore, Status};
use catenix_viewer::{Listen, Viewer, ViewerError};
use tempfile::TempDir;

#[path = "../../results/tests/common/mod.rs"]
mod common;

/// A viewer of a made-up study, and its address.
struct Bench {
    directory: TempDir,
    host: String,
    token: String,
}

impl Bench {
    fn new() -> Self {
        let directory = tempfile::tempdir().unwrap();
        let study = common::study(&["a", "b"]);
        common::write_store(
            &directory.path().join("out"),
            &study,
            20.0,
            Status::Complete,
        );
        Bench::of(directory, "out")
    }

    fn of(directory: TempDir, results: &str) -> Self {
        let viewer = Viewer::bind(&directory.path().join(results), Listen::default()).unwrap();
        let url = viewer.url();
        viewer.spawn();
        let rest = url.strip_prefix("http://").unwrap();
        let (host, token) = rest.trim_end_matches('/').split_once('/').unwrap();
        Bench {
            directory,
            host: host.to_owned(),
            token: token.to_owned(),
        }
    }

    fn raw(&self, request: &str) -> String {
        String::from_utf8_lossy(&self.raw_bytes(request)).into_owned()
    }

    fn raw_bytes(&self, request: &str) -> Vec<u8> {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(20)))
            .unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        // A server that refuses may close before everything was sent.
        let _ = stream.read_to_end(&mut answer);
        answer
    }

    fn get(&self, target: &str) -> (u16, String) {
        self.get_as("127.0.0.1", target)
    }

    fn get_as(&self, host: &str, target: &str) -> (u16, String) {
        let request = format!("GET {target} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        let answer = self.raw(&request);
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head
            .split(' ')
            .nth(1)
            .map_or(0, |code| code.parse().unwrap());
        (status, body.to_owned())
    }

    /// A path below the token.
    fn own(&self, path: &str) -> (u16, String) {
        self.get(&format!("/{}/{path}", self.token))
    }
}

#[test]
fn the_page_and_the_description_are_served() {
    let bench = Bench::new();
    for (file, part) in [
        ("", "<!doctype html>"),
        ("app.js", "catenix"),
        ("app.css", "body"),
        ("licenses.txt", "three"),
    ] {
        let (status, body) = bench.own(file);
        assert_eq!(status, 200, "{file}");
        assert!(body.to_lowercase().contains(part), "{file}");
    }
    let (status, body) = bench.own("api/study");
    assert_eq!(status, 200);
    for part in [
        "\"title\":\"Synthetic\"",
        "\"status\":\"complete\"",
        "\"field_rows\":21",
    ] {
        assert!(body.contains(part), "{part} is missing in {body}");
    }
    let (status, body) = bench.own("api/case?case=a");
    assert_eq!(status, 200);
    for part in [
        "\"water_depth_m\":",
        "\"buffer.offset_x\"",
        "\"cases/a/lines/pipe/x\"",
        "\"seabed\":",
    ] {
        assert!(body.contains(part), "{part} is missing in {body}");
    }
}

#[test]
fn numbers_are_those_of_the_store() {
    let bench = Bench::new();
    let (status, body) = bench.own("api/node?case=a&line=pipe&quantity=effective_tension&node=2");
    assert_eq!(status, 200, "{body}");
    assert!(
        body.starts_with("{\"unit\":\"N\",\"times_s\":[0.0,1.0,"),
        "{body}"
    );
    assert!(body.contains("\"values\":[3200.0,3201.0,"), "{body}");
    let (_, body) = bench.own("api/envelope?case=a&line=pipe&quantity=effective_tension");
    for part in [
        "\"every_step\":true",
        "\"window_s\":[12.0,20.0]",
        "\"min\":[3012.0,",
        "\"run_max\":[3020.0,",
    ] {
        assert!(body.contains(part), "{part} is missing in {body}");
    }
    // The mean of a straight line is its middle, but for the rounding of the running sum.
    let mean = body
        .split("\"mean\":[")
        .nth(1)
        .unwrap()
        .split(',')
        .next()
        .unwrap();
    assert!(
        (mean.parse::<f64>().unwrap() - 3016.0).abs() < 1e-9,
        "{mean}"
    );
}

#[test]
fn whole_vectors_come_in_one_answer() {
    let bench = Bench::new();
    let doubles = |query: &str| -> Vec<f64> {
        let target = format!("/{}/api/vectors?{query}", bench.token);
        let request =
            format!("GET {target} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
        let answer = bench.raw_bytes(&request);
        let head = answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap();
        assert!(answer.starts_with(b"HTTP/1.1 200"));
        answer[head + 4..]
            .chunks_exact(8)
            .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()))
            .collect()
    };
    // Rows beyond the end of an array are missing, so that the next array begins where expected.
    let read = doubles(
        "array=3:cases/a/lines/pipe/field_time&array=300:cases/a/lines/pipe/arc_length&array=2:cases/b/time",
    );
    assert_eq!(read[..5], [0.0, 1.0, 2.0, 0.0, 10.0]);
    assert_eq!(read.len(), 305);
    assert!(read[302].is_nan() && read[303] == 0.0);
    assert!(doubles("").is_empty());

    for (query, expected) in [
        ("array=1:cases/a/lines/pipe/missing", 404),
        ("array=1:../secret", 404),
        ("array=1:cases/%2e%2e/%2e%2e/secret", 404),
        ("array=x:cases/a/time", 404),
        ("array=-1:cases/a/time", 404),
        ("array=cases/a/time", 404),
        ("array=1:", 404),
        ("array=1:cases/a", 404),
        // Fields have two axes.
        ("array=1:cases/a/lines/pipe/x", 500),
        ("array=99999999:cases/a/time", 413),
        ("array=18446744073709551615:cases/a/time", 413),
        ("array=4194000:cases/a/time&array=4194000:cases/b/time", 413),
    ] {
        let (status, body) = bench.own(&format!("api/vectors?{query}"));
        assert_eq!(status, expected, "{query}: {body}");
    }
}

#[test]
fn many_connections_and_slow_ones_do_not_stop_it() {
    let bench = Bench::new();
    // Half a request each: the server waits for the rest, but not for ever, and not alone.
    let slow: Vec<TcpStream> = (0..60)
        .map(|_| {
            let mut stream = TcpStream::connect(&bench.host).unwrap();
            stream.write_all(b"GET / HTTP/1.1\r\nHost").unwrap();
            stream
        })
        .collect();
    assert_eq!(bench.own("api/study").0, 200);
    let more: Vec<TcpStream> = (0..40)
        .filter_map(|_| TcpStream::connect(&bench.host).ok())
        .collect();
    drop((slow, more));
    let begin = std::time::Instant::now();
    while bench.own("api/study").0 != 200 {
        assert!(begin.elapsed() < Duration::from_secs(20), "it comes back");
    }
}

#[test]
fn without_the_token_there_is_nothing() {
    let bench = Bench::new();
    let wrong = "0".repeat(32);
    for target in [
        "/",
        "/api/study",
        &format!("/{wrong}/"),
        "//",
        "/%00/",
        "*",
        "/?token=1",
    ] {
        let (status, body) = bench.get(target);
        assert!(status == 403 || status == 400, "{target}: {status} {body}");
        assert!(
            !body.contains("Synthetic") && !body.contains("<script"),
            "{target}"
        );
    }
    let (status, _) = bench.get(&format!("/{}", bench.token));
    assert_eq!(
        status, 308,
        "the address without its last slash leads to the page"
    );
}

#[test]
fn nothing_outside_the_store_is_served() {
    let bench = Bench::new();
    let outside = bench.directory.path().join("secret");
    fs::write(&outside, "secret").unwrap();
    let store = bench.directory.path().join("out/results.zarr");
    fs::write(store.join("inside"), "inside").unwrap();
    assert_eq!(bench.own("store/inside"), (200, "inside".to_owned()));
    assert_eq!(bench.own("store/zarr.json").0, 200);
    assert_eq!(bench.own("store/cases/a/zarr.json").0, 200);
    assert_eq!(bench.own("store/cases/a/time/c/0").0, 200);
    for path in [
        "../secret",
        "../../secret",
        "..%2F..%2Fsecret",
        "%2e%2e/%2e%2e/secret",
        "cases/../../../secret",
        "cases/%2e%2e/%2e%2e/%2e%2e/secret",
        "..%5c..%5csecret",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "./inside",
        "cases//a/zarr.json",
        "inside%00",
        "",
        "cases",
        "cases/a",
        "cases/a.zip",
        "cases/a.zip/zarr.json",
        "cases/a/lines",
        "cases/a/../../inside",
        "missing",
        "%ff",
    ] {
        let (status, body) = bench.own(&format!("store/{path}"));
        assert_eq!(status, 404, "{path}: {body}");
        assert!(
            !body.contains("secret\u{0}") && !body.starts_with("secret"),
            "{path}"
        );
    }
    assert_eq!(bench.own("../secret").0, 404);
    for query in [
        "case=..%2F..&line=x",
        "case=a&line=..%2F..%2Fa&quantity=x",
        "case=a",
    ] {
        let (status, body) = bench.own(&format!("api/envelope?{query}"));
        assert_eq!(status, 404, "{query}: {body}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&outside, store.join("link")).unwrap();
        assert_eq!(
            bench.own("store/link").0,
            404,
            "a link out of the store is not followed"
        );
    }
}

#[test]
fn requests_are_bounded_and_only_read() {
    let bench = Bench::new();
    let long = format!("GET /{} HTTP/1.1\r\n", "a".repeat(1 << 20));
    assert!(bench.raw(&long).starts_with("HTTP/1.1 413"));
    let headers = format!("GET / HTTP/1.1\r\n{}", "X: y\r\n".repeat(1 << 16));
    assert!(bench.raw(&headers).starts_with("HTTP/1.1 413"));
    let body = "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\n";
    assert!(bench.raw(body).starts_with("HTTP/1.1 413"));
    assert!(bench.raw("\u{7f}\r\n\r\n").starts_with("HTTP/1.1 400"));
    for method in ["POST", "PUT", "DELETE", "OPTIONS"] {
        let request = format!(
            "{method} /{}/ HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
            bench.token
        );
        assert!(bench.raw(&request).starts_with("HTTP/1.1 405"), "{method}");
    }
    let request = format!(
        "HEAD /{}/ HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
        bench.token
    );
    let answer = bench.raw(&request);
    assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("\r\n\r\n"));
    assert!(answer.contains("Content-Security-Policy: default-src 'none'"));
    assert_eq!(bench.own("").0, 200, "the server still serves");
}

#[test]
fn it_listens_on_this_machine_and_answers_to_its_names_only() {
    let viewer_directory = Bench::new();
    let host: std::net::SocketAddr = viewer_directory.host.parse().unwrap();
    assert!(host.ip().is_loopback());
    let page = format!("/{}/", viewer_directory.token);
    assert_eq!(viewer_directory.get_as("localhost:99", &page).0, 200);
    assert_eq!(viewer_directory.get_as("evil.example", &page).0, 403);
    assert_eq!(viewer_directory.get_as("", &page).0, 403);
}

#[test]
fn a_port_in_use_is_told() {
    let bench = Bench::new();
    let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let listen = Listen {
        address: IpAddr::V4(Ipv4Addr::LOCALHOST),
        port: taken.local_addr().unwrap().port(),
    };
    let error = Viewer::bind(&bench.directory.path().join("out"), listen).unwrap_err();
    assert!(matches!(error, ViewerError::PortInUse { .. }), "{error}");
    assert!(error.to_string().contains("--port"), "{error}");
}

#[test]
fn stores_that_cannot_be_shown_are_told() {
    let bench = Bench::new();
    let out = bench.directory.path().join("out");
    let bind = |path: &Path| Viewer::bind(path, Listen::default()).unwrap_err();
    let error = bind(bench.directory.path());
    assert_eq!(error.code(), "results::no_store");
    let root = out.join("results.zarr/zarr.json");
    let text = fs::read_to_string(&root).unwrap();

    let newer = text.replace("\"catenix_store_format\":2", "\"catenix_store_format\":99");
    assert_ne!(newer, text);
    fs::write(&root, newer).unwrap();
    let error = bind(&out);
    assert_eq!(error.code(), "results::newer");
    assert!(error.to_string().contains("store format 99"), "{error}");
    let (status, body) = bench.own("api/study");
    assert_eq!(status, 500);
    assert!(body.contains("results::newer"), "{body}");

    fs::write(&root, &text[..text.len() / 2]).unwrap();
    assert_eq!(bind(&out).code(), "results::damaged");

    let empty = text.replace("\"case_names\":[\"a\",\"b\"]", "\"case_names\":[]");
    assert_ne!(empty, text);
    fs::write(&root, empty).unwrap();
    assert_eq!(bind(&out).code(), "viewer::empty");

    fs::write(&root, text).unwrap();
    let chunk = common::unpack(&out, "a").join("lines/pipe/x/c/0/0");
    let mut bytes = fs::read(&chunk).unwrap();
    bytes[3] ^= 1;
    fs::write(&chunk, bytes).unwrap();
    let (status, body) = bench.own("api/node?case=a&line=pipe&quantity=x&node=0");
    assert_eq!(status, 500);
    assert!(body.contains("checksum"), "{body}");
    fs::remove_dir_all(out.join("results.zarr")).unwrap();
    let (status, body) = bench.own("api/study");
    assert_eq!((status, body.contains("no_store")), (500, true), "{body}");
}

#[test]
fn a_case_that_has_not_begun_is_described() {
    let directory = tempfile::tempdir().unwrap();
    let study = common::study(&["a"]);
    let cases: Vec<_> = study.cases.iter().collect();
    let out = directory.path().join("out");
    let store = ResultStore::create(&out, &study, &cases, &common::provenance()).unwrap();
    let bench = Bench::of(directory, "out");
    let (status, body) = bench.own("api/case?case=a");
    assert_eq!(status, 200, "{body}");
    assert!(
        body.contains("\"status\":\"pending\"") && body.contains("\"lines\":[]"),
        "{body}"
    );

    let mut recorder = store.record_case(&study.cases[0]);
    let moment = common::Moment { time: 0.0 };
    recorder.record_static(&study.cases[0], &moment).unwrap();
    recorder.flush().unwrap();
    let (_, body) = bench.own("api/case?case=a");
    assert!(
        body.contains("\"status\":\"running\"") && body.contains("\"field_rows\":0"),
        "{body}"
    );
    let (status, body) = bench.own("api/envelope?case=a&line=pipe&quantity=x");
    assert_eq!(status, 200, "{body}");
    assert!(body.contains("\"every_step\":false"), "{body}");
}
