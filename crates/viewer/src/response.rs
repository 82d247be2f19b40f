//! Answers, and how they are written.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::json;

/// An answer.
#[derive(Debug)]
pub(crate) struct Response {
    pub(crate) status: Status,
    pub(crate) content_type: &'static str,
    pub(crate) body: Body,
    /// Where to go instead.
    pub(crate) location: Option<String>,
}

/// What an answer brings.
#[derive(Debug)]
pub(crate) enum Body {
    Static(&'static [u8]),
    Bytes(Vec<u8>),
}

/// The status codes that are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    Ok = 200,
    Moved = 308,
    BadRequest = 400,
    Forbidden = 403,
    NotFound = 404,
    Method = 405,
    TooLarge = 413,
    Internal = 500,
    Busy = 503,
}

impl Status {
    fn reason(self) -> &'static str {
        match self {
            Status::Ok => "OK",
            Status::Moved => "Permanent Redirect",
            Status::BadRequest => "Bad Request",
            Status::Forbidden => "Forbidden",
            Status::NotFound => "Not Found",
            Status::Method => "Method Not Allowed",
            Status::TooLarge => "Content Too Large",
            Status::Internal => "Internal Server Error",
            Status::Busy => "Service Unavailable",
        }
    }
}

/// What a page from here may do: run its own script and style, and talk to this server.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; \
                      img-src 'self' blob: data:; media-src blob:; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

impl Response {
    /// A file that is part of the program.
    pub(crate) fn asset(content_type: &'static str, content: &'static [u8]) -> Self {
        Response {
            status: Status::Ok,
            content_type,
            body: Body::Static(content),
            location: None,
        }
    }

    /// A JSON document.
    pub(crate) fn json(document: &impl Serialize) -> Self {
        match serde_json::to_vec(document) {
            Ok(text) => Response {
                status: Status::Ok,
                content_type: "application/json",
                body: Body::Bytes(text),
                location: None,
            },
            Err(error) => Response::error(Status::Internal, "viewer::json", &error.to_string()),
        }
    }

    /// Numbers as they are in memory or in a file.
    pub(crate) fn numbers(bytes: Vec<u8>) -> Self {
        Response {
            status: Status::Ok,
            content_type: "application/octet-stream",
            body: Body::Bytes(bytes),
            location: None,
        }
    }

    /// An error that the page shows to its user.
    pub(crate) fn error(status: Status, code: &str, message: &str) -> Self {
        let text = json!({ "error": { "code": code, "message": message } });
        Response {
            status,
            content_type: "application/json",
            body: Body::Bytes(text.to_string().into_bytes()),
            location: None,
        }
    }

    /// Sends the browser elsewhere.
    pub(crate) fn moved(location: String) -> Self {
        Response {
            status: Status::Moved,
            content_type: "text/plain; charset=utf-8",
            body: Body::Static(b""),
            location: Some(location),
        }
    }

    /// Writes the answer; without its body for a `HEAD` request.
    pub(crate) fn write(
        self,
        stream: &mut impl Write,
        head_only: bool,
        keep_alive: bool,
    ) -> io::Result<()> {
        let length = match &self.body {
            Body::Static(bytes) => bytes.len() as u64,
            Body::Bytes(bytes) => bytes.len() as u64,
        };
        let location = self
            .location
            .map(|place| format!("Location: {place}\r\n"))
            .unwrap_or_default();
        let head = format!(
            "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {length}\r\n{location}\
             Connection: {}\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n\
             Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
             Content-Security-Policy: {POLICY}\r\n\r\n",
            self.status as u16,
            self.status.reason(),
            self.content_type,
            if keep_alive { "keep-alive" } else { "close" },
        );
        let mut bytes = head.into_bytes();
        if head_only {
            return stream.write_all(&bytes);
        }
        match self.body {
            Body::Static(body) => bytes.extend_from_slice(body),
            Body::Bytes(body) => bytes.extend_from_slice(&body),
        }
        stream.write_all(&bytes)
    }
}
