//! The viewer's page is built from `web` and committed, so that `cargo build` needs no node. This
//! rule sees without node when sources and built files have drifted apart; the test step `web`
//! builds the page again and compares every byte.

use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::Violation;

const STAMP: &str = "crates/viewer/assets/sources.sha256";

/// Sources beside those in `web/src`; `web/build.mjs` has the same list.
const SINGLE: [&str; 6] = [
    "build.mjs",
    "icon.svg",
    "index.html",
    "package-lock.json",
    "package.json",
    "tsconfig.json",
];

/// Compares the hash of the sources with the one that the build left.
pub(crate) fn check(root: &Path) -> Result<Vec<Violation>, String> {
    let sources = read(root)?;
    let stamp = fs::read_to_string(root.join(STAMP)).unwrap_or_default();
    Ok(compare(sources, &stamp))
}

fn compare(sources: Vec<(String, String)>, stamp: &str) -> Vec<Violation> {
    if hash(sources) == stamp.trim() {
        return Vec::new();
    }
    vec![Violation {
        file: STAMP.to_owned(),
        line: 1,
        rule: "web-assets",
        message: "the built page is not made from the sources in `web`; build it again: in `web`, \
                  `npm ci --ignore-scripts` and `npm run build`, and commit what it writes."
            .to_owned(),
    }]
}

/// SHA-256 over the names and contents of the sources, in order of name; line ends count as one
/// character.
fn hash(mut sources: Vec<(String, String)>) -> String {
    sources.sort();
    let mut hash = Sha256::new();
    for (name, text) in sources {
        let text = text.replace("\r\n", "\n");
        hash.update(format!("{name}\n{}\n{text}", text.len()));
    }
    let bytes = hash.finalize();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn read(root: &Path) -> Result<Vec<(String, String)>, String> {
    let web = root.join("web");
    let mut sources = Vec::new();
    for name in SINGLE {
        sources.push((name.to_owned(), read_file(&web.join(name))?));
    }
    read_folder(&web.join("src"), "src", &mut sources)?;
    Ok(sources)
}

fn read_folder(
    folder: &Path,
    name: &str,
    sources: &mut Vec<(String, String)>,
) -> Result<(), String> {
    let failed = |error| format!("cannot read {}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let inside = format!("{name}/{file}");
        if path.is_dir() {
            read_folder(&path, &inside, sources)?;
        } else {
            sources.push((inside, read_file(&path)?));
        }
    }
    Ok(())
}

fn read_file(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(text: &str) -> Vec<(String, String)> {
        vec![
            ("b.ts".to_owned(), text.to_owned()),
            ("a.ts".to_owned(), "x".to_owned()),
        ]
    }

    #[test]
    fn a_changed_source_is_noticed_and_line_ends_are_not() {
        let stamp = format!("{}\n", hash(sources("1\n2")));
        assert_eq!(compare(sources("1\n2"), &stamp), []);
        assert_eq!(compare(sources("1\r\n2"), &stamp), []);
        assert_eq!(compare(sources("1\n3"), &stamp).len(), 1);
        assert_eq!(compare(sources("1\n2"), "").len(), 1);
    }
}
