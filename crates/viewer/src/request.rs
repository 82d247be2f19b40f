//! Reads one request, within bounds.

use std::io::{self, Read};
use std::time::{Duration, Instant};

/// Longest request line with headers [bytes]; browsers send about one thousand.
const MOST_HEAD_BYTES: usize = 16 * 1024;
/// Most headers in a request.
const MOST_HEADERS: usize = 64;
/// Longest time that a request may take to arrive once it has begun.
const HEAD_TIME: Duration = Duration::from_secs(10);

/// A request without a body: there is nothing to upload here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Request {
    /// `GET`, `HEAD` or what else was sent.
    pub(crate) method: String,
    /// Path with query, as sent.
    pub(crate) target: String,
    /// The `Host` header.
    pub(crate) host: String,
    /// Whether the connection stays open after the answer.
    pub(crate) keep_alive: bool,
}

/// Why there is no request.
#[derive(Debug)]
pub(crate) enum RequestFault {
    /// The connection ended, broke, or stayed silent.
    Gone,
    /// The request is longer than allowed, or has a body.
    TooLarge,
    /// This is not HTTP.
    Malformed,
}

impl From<io::Error> for RequestFault {
    fn from(_: io::Error) -> Self {
        RequestFault::Gone
    }
}

/// Reads a request. `rest` holds bytes that came with the one before, and gets those after this one.
pub(crate) fn read(stream: &mut impl Read, rest: &mut Vec<u8>) -> Result<Request, RequestFault> {
    let mut begun = None;
    loop {
        if let Some((request, length)) = parse(rest)? {
            rest.drain(..length);
            return Ok(request);
        }
        if rest.len() >= MOST_HEAD_BYTES {
            return Err(RequestFault::TooLarge);
        }
        if !rest.is_empty() {
            let begin: &mut Instant = begun.get_or_insert_with(Instant::now);
            if begin.elapsed() > HEAD_TIME {
                return Err(RequestFault::Gone);
            }
        }
        let mut buffer = [0; 4096];
        match stream.read(&mut buffer)? {
            0 => return Err(RequestFault::Gone),
            count => rest.extend_from_slice(&buffer[..count]),
        }
    }
}

/// The request at the beginning of `bytes` and its length; `None` until it is complete.
fn parse(bytes: &[u8]) -> Result<Option<(Request, usize)>, RequestFault> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let length = match parsed.parse(bytes) {
        Ok(httparse::Status::Complete(length)) => length,
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(httparse::Error::TooManyHeaders) => return Err(RequestFault::TooLarge),
        Err(_) => return Err(RequestFault::Malformed),
    };
    let header = |name: &str| {
        let found = parsed
            .headers
            .iter()
            .find(|h| h.name.eq_ignore_ascii_case(name));
        found.map(|header| String::from_utf8_lossy(header.value).trim().to_owned())
    };
    let has_body = header("content-length").is_some_and(|length| length != "0")
        || header("transfer-encoding").is_some();
    if length > MOST_HEAD_BYTES || has_body {
        return Err(RequestFault::TooLarge);
    }
    let connection = header("connection")
        .unwrap_or_default()
        .to_ascii_lowercase();
    let keep_alive = if parsed.version == Some(1) {
        connection != "close"
    } else {
        connection == "keep-alive"
    };
    let request = Request {
        method: parsed.method.unwrap_or_default().to_owned(),
        target: parsed.path.unwrap_or_default().to_owned(),
        host: header("host").unwrap_or_default(),
        keep_alive,
    };
    Ok(Some((request, length)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(text: &str) -> Result<Request, RequestFault> {
        read(&mut text.as_bytes(), &mut Vec::new())
    }

    #[test]
    fn two_requests_in_one_packet_come_one_after_the_other() {
        let text = "GET /a HTTP/1.1\r\nHost: x\r\n\r\nHEAD /b HTTP/1.0\r\n\r\n";
        let (mut stream, mut rest) = (text.as_bytes(), Vec::new());
        let first = read(&mut stream, &mut rest).unwrap();
        assert_eq!((first.target.as_str(), first.host.as_str()), ("/a", "x"));
        assert!(first.keep_alive);
        let second = read(&mut stream, &mut rest).unwrap();
        assert_eq!((second.method.as_str(), second.keep_alive), ("HEAD", false));
        assert!(matches!(
            read(&mut stream, &mut rest),
            Err(RequestFault::Gone)
        ));
    }

    #[test]
    fn bodies_endless_heads_and_noise_are_refused() {
        let body = "POST / HTTP/1.1\r\nContent-Length: 5\r\n\r\nhello";
        assert!(matches!(read_all(body), Err(RequestFault::TooLarge)));
        let chunked = "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n";
        assert!(matches!(read_all(chunked), Err(RequestFault::TooLarge)));
        let long = format!("GET /{} HTTP/1.1\r\n", "a".repeat(MOST_HEAD_BYTES));
        assert!(matches!(read_all(&long), Err(RequestFault::TooLarge)));
        let many = format!(
            "GET / HTTP/1.1\r\n{}\r\n",
            "A: b\r\n".repeat(MOST_HEADERS + 1)
        );
        assert!(matches!(read_all(&many), Err(RequestFault::TooLarge)));
        assert!(matches!(
            read_all("\u{1}\u{2}\r\n\r\n"),
            Err(RequestFault::Malformed)
        ));
    }
}
