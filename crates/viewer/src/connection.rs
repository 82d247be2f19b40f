//! One connection: request, answer, and again.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

use crate::request::{self, RequestFault};
use crate::response::{Response, Status};
use crate::routes::Site;

/// Longest silence between two requests, and longest wait for a reader that does not take its
/// answer.
const IDLE: Duration = Duration::from_secs(30);
/// Longest time for which the rest of a refused request is read.
const DISCARD_TIME: Duration = Duration::from_secs(1);
/// Most bytes of a refused request that are read.
const DISCARD_BYTES: usize = 8 << 20;

/// Answers requests until the other side ends, stays silent, or sends what is not allowed.
pub(crate) fn serve(mut stream: TcpStream, site: &Site) {
    let ready = stream.set_read_timeout(Some(IDLE)).is_ok()
        && stream.set_write_timeout(Some(IDLE)).is_ok()
        && stream.set_nodelay(true).is_ok();
    if !ready {
        return;
    }
    let mut rest = Vec::new();
    loop {
        let request = match request::read(&mut stream, &mut rest) {
            Ok(request) => request,
            Err(fault) => return end(stream, &fault),
        };
        let answer = site.answer(&request);
        let head_only = request.method == "HEAD";
        let written = answer.write(&mut stream, head_only, request.keep_alive);
        if written.is_err() || !request.keep_alive {
            return;
        }
    }
}

/// Turns a connection away when there are too many.
pub(crate) fn refuse(mut stream: TcpStream) {
    let message = "too many connections at once; close other pages of this viewer";
    let _ = stream.set_write_timeout(Some(Duration::from_secs(1)));
    let _ = Response::error(Status::Busy, "viewer::busy", message).write(&mut stream, false, false);
}

fn end(mut stream: TcpStream, fault: &RequestFault) {
    let (status, code, message) = match fault {
        RequestFault::Gone => return,
        RequestFault::TooLarge => (
            Status::TooLarge,
            "viewer::too_large",
            "the request is longer than this server reads",
        ),
        RequestFault::Malformed => (
            Status::BadRequest,
            "viewer::malformed",
            "this is not an HTTP request",
        ),
    };
    let _ = Response::error(status, code, message).write(&mut stream, false, false);
    let _ = stream.flush();
    let _ = stream.shutdown(Shutdown::Write);
    discard_rest(&mut stream);
}

/// Reads what is still on its way, for a while: closed with unread bytes, the connection would be
/// reset, and the answer lost.
fn discard_rest(stream: &mut TcpStream) {
    let until = Instant::now() + DISCARD_TIME;
    let mut discarded = 0;
    let mut bytes = [0; 16 * 1024];
    let _ = stream.set_read_timeout(Some(DISCARD_TIME));
    while discarded < DISCARD_BYTES && Instant::now() < until {
        match stream.read(&mut bytes) {
            Ok(0) | Err(_) => return,
            Ok(count) => discarded += count,
        }
    }
}
