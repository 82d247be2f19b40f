//! Relative links and repository paths in documents must lead somewhere.

use std::path::Path;

use super::{TextFile, Violation};

/// Folders whose paths are checked when a document names them.
const ROOTS: [&str; 8] = [
    "crates",
    "xtask",
    "docs",
    "examples",
    "verification",
    "bench",
    ".ci",
    ".cargo",
];

/// Checks every document but the changelog, which tells of files that are gone; and in sources and
/// model files, the documents that their comments send the reader to.
pub(crate) fn check(root: &Path, files: &[TextFile]) -> Vec<Violation> {
    let exists = |path: &str| root.join(path).exists();
    let mut violations = Vec::new();
    for file in files.iter().filter(|file| file.path != "CHANGELOG.md") {
        if file.has_ending("md") {
            violations.extend(check_links(file, files, &exists));
            violations.extend(check_paths(file, files, &ROOTS, &exists));
        } else if !file.path.starts_with("xtask/src/tidy") {
            // Citations of the theory manual have a rule of their own; the checker's own tests name
            // documents that do not exist.
            let found = check_paths(file, files, &["docs"], &exists);
            violations.extend(
                found
                    .into_iter()
                    .filter(|v| !v.message.contains("docs/theory/")),
            );
        }
    }
    violations
}

fn check_links(
    file: &TextFile,
    files: &[TextFile],
    exists: &dyn Fn(&str) -> bool,
) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (line, target) in links(&file.text) {
        let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
        let resolved = match path {
            "" => Some(file.path.clone()),
            _ => resolve(file.folder(), path),
        };
        let mut push = |message| {
            let file = file.path.clone();
            violations.push(Violation {
                file,
                line,
                rule: "links",
                message,
            });
        };
        match resolved {
            Some(path) if path == file.path || exists(&path) => {
                let document = files.iter().find(|other| other.path == path);
                if let Some(document) = document
                    && !anchor.is_empty()
                    && document.has_ending("md")
                    && !headings(&document.text)
                        .iter()
                        .any(|heading| heading == anchor)
                {
                    push(format!("`{target}`: {path} has no heading `#{anchor}`."));
                }
            }
            _ => push(format!(
                "`{target}` leads to no file; links are relative to the document."
            )),
        }
    }
    violations
}

/// Relative link targets with their lines, code left out.
fn links(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    for (line, text) in lines_outside_code(text) {
        for (index, part) in text.split("](").enumerate() {
            if index > 0 {
                let target = part.split([')', ' ']).next().unwrap_or(part);
                if !target.contains(':') && !target.is_empty() {
                    found.push((line, target));
                }
            }
        }
    }
    found
}

/// Numbered lines outside fenced code.
fn lines_outside_code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut in_code = false;
    text.lines().enumerate().filter_map(move |(index, line)| {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
            return None;
        }
        (!in_code).then_some((index + 1, line))
    })
}

/// `path` as seen from `folder`; `None` when it leaves the repository.
fn resolve(folder: &str, path: &str) -> Option<String> {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            _ => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

/// Anchors of a document's headings, made as GitHub makes them.
fn headings(text: &str) -> Vec<String> {
    lines_outside_code(text)
        .filter(|(_, line)| line.starts_with('#'))
        .map(|(_, line)| {
            let title = line.trim_start_matches('#').trim().to_lowercase();
            let kept = title
                .chars()
                .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// Paths below `roots` that a file names in its text or code, such as `crates/engine/src/lib.rs`, and the
/// functions named behind them with `::`.
fn check_paths(
    file: &TextFile,
    files: &[TextFile],
    roots: &[&str],
    exists: &dyn Fn(&str) -> bool,
) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (line, path, function) in named_paths(&file.text, roots) {
        let mut push = |message| {
            let file = file.path.clone();
            violations.push(Violation {
                file,
                line,
                rule: "named-paths",
                message,
            });
        };
        if !exists(path) {
            push(format!(
                "names `{path}`, which does not exist; the map must match the ground."
            ));
        } else if let Some(function) = function {
            let source = files.iter().find(|other| other.path == path);
            let declares = |source: &TextFile| {
                source.text.contains(&format!("fn {function}("))
                    || source.text.contains(&format!("fn {function}<"))
            };
            if !source.is_some_and(declares) {
                push(format!(
                    "names `{path}::{function}`, but the file has no such function."
                ));
            }
        }
    }
    violations
}

/// Line, path and function of every named path; patterns such as `docs/<name>.md` are left out.
fn named_paths<'a>(text: &'a str, roots: &[&str]) -> Vec<(usize, &'a str, Option<&'a str>)> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        for word in line.split(|c: char| c.is_whitespace() || "`()[]|,;\"'".contains(c)) {
            let word = word.trim_end_matches(['.', ':', '/']);
            let word = word.split_once('#').map_or(word, |(path, _)| path);
            let (path, function) = match word.split_once("::") {
                Some((path, function)) => (path, Some(function)),
                None => (word, None),
            };
            let is_pattern = path.contains(['<', '>', '*', '{', '}', '\u{2026}', '=']);
            let root = path.split_once('/').map(|(root, _)| root);
            if !is_pattern && root.is_some_and(|root| roots.contains(&root)) {
                found.push((index + 1, path.trim_end_matches('/'), function));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> TextFile {
        TextFile {
            path: "docs/guide.md".to_owned(),
            text: text.to_owned(),
        }
    }

    fn broken(text: &str) -> Vec<String> {
        let source = TextFile {
            path: "crates/engine/src/lib.rs".to_owned(),
            text: "fn equilibrium_holds() {}".to_owned(),
        };
        let files = [document(text), source];
        let exists = |path: &str| {
            [
                "README.md",
                "docs",
                "docs/guide.md",
                "crates/engine/src/lib.rs",
            ]
            .contains(&path)
        };
        let mut found = check_links(&files[0], &files, &exists);
        found.extend(check_paths(&files[0], &files, &ROOTS, &exists));
        found
            .into_iter()
            .map(|violation| format!("{violation}"))
            .collect()
    }

    #[test]
    fn good_links_and_paths_pass() {
        for text in [
            "[home](../README.md), [web](https://example.org/x), [here](guide.md)",
            "# Two words, `code`\n[up](#two-words-code)",
            "```\n[in code](nowhere.md)\n```",
            "see `crates/engine/src/lib.rs`, crates/engine/src/lib.rs::equilibrium_holds.",
            "copy `verification/<case>/model.toml` and `crates/*/Cargo.toml`",
        ] {
            assert_eq!(broken(text), [""; 0], "{text}");
        }
    }

    #[test]
    fn links_to_nothing_fail() {
        for text in [
            "[home](README.md)",
            "[out](../../elsewhere.md)",
            "[up](#no-such-heading)",
            "[up](guide.md#no-such-heading)",
            "text\n[a](../README.md) and [b](gone.md)",
        ] {
            assert_eq!(broken(text).len(), 1, "{text}");
        }
        assert!(broken("one\ntwo\n[b](gone.md)")[0].starts_with("docs/guide.md:3:"));
    }

    #[test]
    fn comments_send_readers_to_documents_that_exist() {
        let source = |text: &str| TextFile {
            path: "crates/model/src/lib.rs".to_owned(),
            text: text.to_owned(),
        };
        let root = crate::workspace_root();
        assert_eq!(check(&root, &[source("//! See docs/README.md.")]), []);
        assert_eq!(check(&root, &[source("//! See docs/gone.md.")]).len(), 1);
    }

    #[test]
    fn named_paths_to_nothing_fail() {
        for text in [
            "the drag is in `crates/engine/src/hydro/gone.rs`.",
            "| drag | crates/engine/src/hydro/ |",
            "```\ncargo run -- run examples/gone.toml\n```",
            "`crates/engine/src/lib.rs::no_such_function`",
        ] {
            assert_eq!(broken(text).len(), 1, "{text}");
        }
    }
}
