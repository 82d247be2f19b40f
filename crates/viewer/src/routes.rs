//! Which address leads to what.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use catenix_results::{CaseProgress, StoreError, StoredStudy, read_vector, stored_file};
use serde::Serialize;

use crate::assets;
use crate::request::Request;
use crate::response::{Response, Status};
use crate::{ViewerError, token};

/// Most values in one answer of `api/vectors`: 32 MB.
const MOST_VECTOR_VALUES: usize = 1 << 22;

/// Everything that can be asked for: the page, descriptions of the store, and its files.
#[derive(Debug)]
pub(crate) struct Site {
    store: PathBuf,
    token: String,
    loopback: bool,
}

/// What the page asks for again and again: how far the run is. It also shows that the server lives.
#[derive(Debug, Serialize)]
struct StudyReport {
    title: String,
    note: String,
    model_file: String,
    model_sha256: String,
    catenix_version: String,
    status: catenix_results::Status,
    /// Time since the last write of a case [s]: a run that goes on writes every few seconds.
    idle_s: Option<f64>,
    cases: Vec<CaseProgress>,
}

impl Site {
    /// A site for the store at `store`.
    pub(crate) fn new(store: &Path, token: String, loopback: bool) -> Result<Self, ViewerError> {
        let store = fs::canonicalize(store).map_err(|source| StoreError::Read {
            path: store.to_path_buf(),
            source,
        })?;
        Ok(Site {
            store,
            token,
            loopback,
        })
    }

    pub(crate) fn token(&self) -> &str {
        &self.token
    }

    /// The answer to a request.
    pub(crate) fn answer(&self, request: &Request) -> Response {
        if !["GET", "HEAD"].contains(&request.method.as_str()) {
            let message = "this server only shows; it takes GET and HEAD";
            return Response::error(Status::Method, "viewer::method", message);
        }
        if self.loopback && !is_loopback_name(&request.host) {
            // A foreign name that resolves to this machine is another site's attempt to read it.
            let message = "this server answers to 127.0.0.1 and localhost only";
            return Response::error(Status::Forbidden, "viewer::host", message);
        }
        let (path, query) = request
            .target
            .split_once('?')
            .unwrap_or((&request.target, ""));
        let mut parts = path.trim_start_matches('/').splitn(2, '/');
        let guess = parts.next().unwrap_or_default();
        if !token::matches(&self.token, guess) {
            let message = "this address has no valid token; use the link that catenix printed";
            return Response::error(Status::Forbidden, "viewer::token", message);
        }
        let Some(place) = parts.next() else {
            return Response::moved(format!("/{}/", self.token));
        };
        if let Some(file) = place.strip_prefix("store/") {
            return self.store_file(file);
        }
        let result = match place {
            "api/study" => self.study().map(|report| Response::json(&report)),
            "api/case" => self.case(query),
            "api/node" => self.node(query),
            "api/envelope" => self.envelope(query),
            "api/vectors" => self.vectors(query),
            _ => return assets::asset(place).unwrap_or_else(not_found),
        };
        result.unwrap_or_else(|error| {
            let status = match error {
                StoreError::UnknownCase { .. }
                | StoreError::UnknownChannel { .. }
                | StoreError::UnknownLineResult { .. } => Status::NotFound,
                _ => Status::Internal,
            };
            Response::error(status, error.code(), &error.to_string())
        })
    }

    fn study(&self) -> Result<StudyReport, StoreError> {
        let study = StoredStudy::open(&self.store)?;
        Ok(StudyReport {
            title: study.title(),
            note: study.note(),
            model_file: study.attribute("model_file"),
            model_sha256: study.attribute("model_sha256"),
            catenix_version: study.attribute("catenix_version"),
            status: study.status(),
            idle_s: last_write(&self.store).and_then(|time| {
                SystemTime::now()
                    .duration_since(time)
                    .ok()
                    .map(|age| age.as_secs_f64())
            }),
            cases: study.progress()?,
        })
    }

    fn case(&self, query: &str) -> Result<Response, StoreError> {
        let study = StoredStudy::open(&self.store)?;
        let case = study.case(&parameter(query, "case"))?;
        Ok(Response::json(&case.describe()?))
    }

    fn node(&self, query: &str) -> Result<Response, StoreError> {
        let study = StoredStudy::open(&self.store)?;
        let case = study.case(&parameter(query, "case"))?;
        let line = parameter(query, "line");
        let quantity = case.quantity(&line, &parameter(query, "quantity"))?;
        let Ok(node) = parameter(query, "node").parse() else {
            let message = "`node` is not a number";
            return Ok(Response::error(Status::BadRequest, "viewer::node", message));
        };
        Ok(Response::json(&case.node_history(&line, quantity, node)?))
    }

    fn envelope(&self, query: &str) -> Result<Response, StoreError> {
        let study = StoredStudy::open(&self.store)?;
        let case = study.case(&parameter(query, "case"))?;
        let line = parameter(query, "line");
        let quantity = case.quantity(&line, &parameter(query, "quantity"))?;
        Ok(Response::json(&case.envelope(&line, quantity)?))
    }

    /// Whole arrays with one axis, one after the other as little-endian doubles: `array=ROWS:PATH`,
    /// once for each, with the rows that the page knows to be written.
    fn vectors(&self, query: &str) -> Result<Response, StoreError> {
        let mut bytes = Vec::new();
        for wanted in query.split('&').filter_map(|p| p.strip_prefix("array=")) {
            let wanted = wanted.split_once(':').and_then(|(rows, path)| {
                let rows = rows.parse::<usize>().ok()?;
                Some((rows, self.way(path)?))
            });
            let Some((rows, way)) = wanted else {
                return Ok(not_found());
            };
            let room = MOST_VECTOR_VALUES - bytes.len() / size_of::<f64>();
            if rows > room {
                let message = "these arrays are longer than one answer may be";
                let code = "viewer::too_large";
                return Ok(Response::error(Status::TooLarge, code, message));
            }
            // An answer has the length that was asked for, or the page could not cut it apart.
            let Some(mut values) = read_vector(&self.store, &way, rows)? else {
                return Ok(not_found());
            };
            values.resize(rows, f64::NAN);
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
        Ok(Response::numbers(bytes))
    }

    /// The names on a way below the store: every one of them is plain, and what lies there, or the
    /// archive that it lies in, is below the store with symbolic links resolved.
    fn way(&self, path: &str) -> Option<Vec<String>> {
        let plain = |part: &str| decode(part).filter(|name| is_plain(name));
        let names = path.split('/').map(plain).collect::<Option<Vec<_>>>()?;
        let folder: PathBuf = names
            .iter()
            .fold(self.store.clone(), |path, name| path.join(name));
        let archive = match names.as_slice() {
            [cases, case, _, ..] => self.store.join(cases).join(format!("{case}.zip")),
            _ => folder.clone(),
        };
        let found = [archive, folder].into_iter().find(|path| path.exists())?;
        let found = fs::canonicalize(found).ok()?;
        found.starts_with(&self.store).then_some(names)
    }

    /// A regular file of the store, or of the archive of a case.
    fn store_file(&self, path: &str) -> Response {
        match self.way(path).map(|way| stored_file(&self.store, &way)) {
            Some(Ok(Some(content))) => Response::numbers(content),
            _ => not_found(),
        }
    }
}

fn not_found() -> Response {
    Response::error(
        Status::NotFound,
        "viewer::not_found",
        "there is nothing here",
    )
}

/// When a case of the store was written last.
fn last_write(store: &Path) -> Option<SystemTime> {
    let written = |path: PathBuf| fs::metadata(path).and_then(|data| data.modified()).ok();
    let cases = fs::read_dir(store.join("cases")).ok()?;
    cases
        .flatten()
        .filter_map(|entry| match entry.path() {
            path if path.is_dir() => written(path.join("zarr.json")),
            archive => written(archive),
        })
        .max()
}

/// Whether a `Host` header names this machine.
fn is_loopback_name(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    ["127.0.0.1", "localhost", "[::1]"].contains(&name)
}

/// Whether a name is one step down a path and nothing else, on any operating system.
fn is_plain(name: &str) -> bool {
    !name.is_empty()
        && name != "."
        && name != ".."
        && !name.contains(|c: char| c.is_control() || "/\\:".contains(c))
}

/// A parameter of a query; empty when it is not there.
fn parameter(query: &str, name: &str) -> String {
    query
        .split('&')
        .filter_map(|pair| pair.split_once('='))
        .find(|(key, _)| *key == name)
        .and_then(|(_, value)| decode(value))
        .unwrap_or_default()
}

/// Undoes percent-encoding; `None` when the result is no text.
fn decode(text: &str) -> Option<String> {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut index = 0;
    while let Some(&byte) = bytes.get(index) {
        if byte == b'%' {
            let digits = text.get(index + 1..index + 3)?;
            if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                return None;
            }
            decoded.push(u8::from_str_radix(digits, 16).ok()?);
            index += 3;
        } else {
            decoded.push(byte);
            index += 1;
        }
    }
    String::from_utf8(decoded).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_signs_are_decoded_once_and_nonsense_is_refused() {
        assert_eq!(decode("a%20b%252F").as_deref(), Some("a b%2F"));
        for bad in ["%", "%2", "%zz", "%+1", "%ff", "%é"] {
            assert_eq!(decode(bad), None, "{bad}");
        }
        assert_eq!(parameter("case=a%26b&line=x", "case"), "a&b");
        assert_eq!(parameter("case", "case"), "");
    }

    #[test]
    fn only_names_of_this_machine_are_hosts() {
        for good in [
            "127.0.0.1:80",
            "localhost",
            "localhost:1",
            "[::1]:5",
            "[::1]",
        ] {
            assert!(is_loopback_name(good), "{good}");
        }
        for bad in [
            "",
            "evil.example",
            "127.0.0.1.evil.example:80",
            "evil:localhost",
            "::1",
        ] {
            assert!(!is_loopback_name(bad), "{bad}");
        }
    }
}
