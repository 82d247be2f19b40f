//! The page, built from the folder `web` and part of the program.

use crate::response::Response;

/// A file of the page by its name.
pub(crate) fn asset(name: &str) -> Option<Response> {
    let (content_type, content): (&str, &[u8]) = match name {
        "" => (
            "text/html; charset=utf-8",
            include_bytes!("../assets/index.html"),
        ),
        "app.js" => (
            "text/javascript; charset=utf-8",
            include_bytes!("../assets/app.js"),
        ),
        "app.css" => (
            "text/css; charset=utf-8",
            include_bytes!("../assets/app.css"),
        ),
        "icon.svg" => ("image/svg+xml", include_bytes!("../assets/icon.svg")),
        "licenses.txt" => (
            "text/plain; charset=utf-8",
            include_bytes!("../assets/licenses.txt"),
        ),
        _ => return None,
    };
    Some(Response::asset(content_type, content))
}
