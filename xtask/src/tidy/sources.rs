//! Rules on the words that a source file may use, on its length, and on paths of one machine.

use super::tokens::{self, Token};
use super::{TextFile, Violation};

/// What a rule looks for.
enum Pattern {
    /// A path that holds these segments next to each other.
    Path(&'static str),
    /// A type or function by name, in a path or alone.
    Word(&'static str),
    /// A macro call.
    Macro(&'static str),
    /// A method call, or the method's path.
    Method(&'static str),
    /// An attribute.
    Attribute(&'static str),
}

struct Rule {
    name: &'static str,
    /// Folders that the rule holds in; the empty folder is the whole workspace.
    folders: &'static [&'static str],
    /// Whether tests must keep it too.
    in_tests: bool,
    patterns: &'static [Pattern],
    /// Why, and what to do instead.
    why: &'static str,
}

use Pattern::{Attribute, Macro, Method, Path, Word};

const PURE: &[&str] = &["crates/numerics/src", "crates/engine/src"];
const MODEL: &[&str] = &["crates/model/src"];
const LIBRARIES: &[&str] = &[
    "crates/numerics/src",
    "crates/model/src",
    "crates/engine/src",
    "crates/results/src",
    "crates/report/src",
];

const RULES: &[Rule] = &[
    Rule {
        name: "no-files",
        folders: PURE,
        in_tests: false,
        patterns: &[
            Path("std::fs"),
            Path("std::io"),
            Path("std::net"),
            Word("File"),
        ],
        why: "numerics and engine compute from what they are given, so that a run can be repeated \
              anywhere; read in model, write in results.",
    },
    Rule {
        name: "no-clock",
        folders: &[
            "crates/numerics/src",
            "crates/engine/src",
            "crates/model/src",
        ],
        in_tests: false,
        patterns: &[Path("std::time"), Word("Instant"), Word("SystemTime")],
        why: "the same model must give the same bits whatever the time of day; measure time in the \
              caller.",
    },
    Rule {
        name: "no-environment",
        folders: &[
            "crates/numerics/src",
            "crates/engine/src",
            "crates/model/src",
        ],
        in_tests: false,
        patterns: &[Path("std::env"), Path("std::process")],
        why: "a setting that is not in the model file cannot be repeated; take it as an argument.",
    },
    Rule {
        name: "no-printing",
        folders: LIBRARIES,
        in_tests: false,
        patterns: &[
            Macro("println"),
            Macro("eprintln"),
            Macro("print"),
            Macro("eprint"),
        ],
        why: "libraries return values and errors; only the command line prints.",
    },
    Rule {
        name: "model-only-reads",
        folders: MODEL,
        in_tests: false,
        patterns: &[
            Path("fs::write"),
            Path("fs::rename"),
            Path("fs::copy"),
            Path("fs::remove_file"),
            Path("fs::remove_dir"),
            Path("fs::remove_dir_all"),
            Path("fs::create_dir"),
            Path("fs::create_dir_all"),
            Path("fs::*"),
            Path("File::create"),
            Path("File::create_new"),
            Word("OpenOptions"),
        ],
        why: "model turns files into a Model and leaves the disk as it was; write in results.",
    },
    Rule {
        name: "model-never-panics",
        folders: MODEL,
        in_tests: false,
        patterns: &[
            Method("unwrap"),
            Method("expect"),
            Macro("panic"),
            Macro("unreachable"),
        ],
        why: "everything here comes from a user's file; collect a diagnostic with the position and \
              the remedy instead.",
    },
    Rule {
        name: "no-unfinished-code",
        folders: &[""],
        in_tests: true,
        patterns: &[Macro("todo"), Macro("unimplemented"), Macro("dbg")],
        why: "what is committed works; finish it, or return an error that says what is missing.",
    },
    Rule {
        name: "no-ignored-tests",
        folders: &[""],
        in_tests: true,
        patterns: &[Attribute("ignore")],
        why: "a test that does not run proves nothing; make it fast enough, or remove it.",
    },
];

/// Above this, a file usually holds two ideas.
const MOST_LINES: usize = 600;

/// Beginnings of paths that exist on one machine only.
const MACHINE_ROOTS: [&str; 5] = ["home", "root", "Users", "work", "tmp"];

/// Checks all Rust sources, and every text file for machine paths.
pub(crate) fn check(files: &[TextFile]) -> Vec<Violation> {
    let mut violations: Vec<Violation> = files.iter().flat_map(machine_paths).collect();
    violations.extend(
        files
            .iter()
            .filter(|file| is_web(file))
            .flat_map(web_source),
    );
    let sources: Vec<(&TextFile, Result<Vec<Token>, String>)> = files
        .iter()
        .filter(|file| file.has_ending("rs"))
        .map(|file| (file, tokens::tokenize(&file.text)))
        .collect();
    let test_files: Vec<String> = sources
        .iter()
        .filter_map(|(file, tokens)| Some((file, tokens.as_ref().ok()?)))
        .flat_map(|(file, tokens)| {
            let folder = module_folder(&file.path);
            tokens::test_modules(tokens)
                .into_iter()
                .map(move |name| format!("{folder}/{name}"))
        })
        .collect();
    for (file, tokens) in sources {
        violations.extend(file_length(file));
        match tokens {
            Ok(tokens) => {
                let is_test = is_test_file(&file.path, &test_files);
                violations.extend(check_rules(&file.path, &tokens, is_test));
            }
            Err(message) => violations.push(Violation {
                file: file.path.clone(),
                line: 1,
                rule: "readable-source",
                message: format!("this is not Rust that can be read: {message}"),
            }),
        }
    }
    violations
}

/// Folder of the modules that the file at `path` declares: `a/lib.rs` and `a/mod.rs` give `a`,
/// `a/b.rs` gives `a/b`.
fn module_folder(path: &str) -> String {
    let stem = path.strip_suffix(".rs").unwrap_or(path);
    let folder = ["/lib", "/main", "/mod"]
        .iter()
        .find_map(|end| stem.strip_suffix(end));
    folder.unwrap_or(stem).to_owned()
}

fn is_test_file(path: &str, test_modules: &[String]) -> bool {
    let stem = path.strip_suffix(".rs").unwrap_or(path);
    path.split('/')
        .any(|part| part == "tests" || part == "benches")
        || test_modules.iter().any(|module| {
            stem.strip_prefix(module.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        })
}

fn check_rules(path: &str, tokens: &[Token], is_test_file: bool) -> Vec<Violation> {
    let mut violations = Vec::new();
    for rule in RULES {
        if !rule.folders.iter().any(|folder| path.starts_with(folder)) {
            continue;
        }
        for pattern in rule.patterns {
            for (line, in_test, found) in matches(pattern, tokens) {
                if rule.in_tests || !(in_test || is_test_file) {
                    violations.push(Violation {
                        file: path.to_owned(),
                        line,
                        rule: rule.name,
                        message: format!("`{found}`: {}", rule.why),
                    });
                }
            }
        }
    }
    violations
}

/// Line, whether it is in a test, and the text of every match.
fn matches(pattern: &Pattern, tokens: &[Token]) -> Vec<(usize, bool, String)> {
    let sequence = |words: &[&str], found: String| {
        let is_match = |window: &&[Token]| window.iter().zip(words).all(|(t, w)| t.text == **w);
        let hits = tokens.windows(words.len()).filter(is_match);
        hits.map(|window| (window[0].line, window[0].in_test, found.clone()))
            .collect::<Vec<_>>()
    };
    match pattern {
        Path(path) => in_paths(path, tokens),
        Word(word) => sequence(&[word], (*word).to_owned()),
        Macro(name) => sequence(&[name, "!"], format!("{name}!")),
        Attribute(name) => sequence(&["#", "[", name], format!("#[{name}]")),
        Method(name) => {
            let mut found = sequence(&[".", name, "("], format!(".{name}()"));
            found.extend(in_paths(&format!("Option::{name}"), tokens));
            found.extend(in_paths(&format!("Result::{name}"), tokens));
            found
        }
    }
}

fn in_paths(wanted: &str, tokens: &[Token]) -> Vec<(usize, bool, String)> {
    let wanted: Vec<&str> = wanted.split("::").collect();
    tokens::paths(tokens)
        .into_iter()
        .filter(|path| {
            path.segments
                .windows(wanted.len())
                .any(|window| window == wanted)
        })
        .map(|path| (path.line, path.in_test, path.segments.join("::")))
        .collect()
}

/// Sources of the viewer's page.
fn is_web(file: &TextFile) -> bool {
    file.path.starts_with("web/") && (file.has_ending("ts") || file.has_ending("mjs"))
}

/// The rules on length, unfinished code and ignored tests, for the page's sources.
fn web_source(file: &TextFile) -> Vec<Violation> {
    let words = [
        ("no-unfinished-code", "TODO"),
        ("no-unfinished-code", "@ts-ignore"),
        ("no-ignored-tests", "test.skip"),
        ("no-ignored-tests", "test.only"),
        ("no-ignored-tests", "skip: true"),
    ];
    let lines = file.text.lines().enumerate();
    let found = lines.flat_map(|(index, line)| {
        let broken = words.iter().filter(move |(_, word)| line.contains(word));
        broken.map(move |(rule, word)| Violation {
            file: file.path.clone(),
            line: index + 1,
            rule,
            message: format!("`{word}`: what is committed works, and every test runs."),
        })
    });
    found.chain(file_length(file)).collect()
}

fn file_length(file: &TextFile) -> Option<Violation> {
    let lines = file.text.lines().count();
    (lines > MOST_LINES).then(|| Violation {
        file: file.path.clone(),
        line: MOST_LINES + 1,
        rule: "file-length",
        message: format!(
            "{lines} lines, {MOST_LINES} at most: a file is one idea that fits in a head. Split it \
             where the second idea begins."
        ),
    })
}

fn machine_paths(file: &TextFile) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (index, line) in file.text.lines().enumerate() {
        if let Some(found) = machine_path(line) {
            violations.push(Violation {
                file: file.path.clone(),
                line: index + 1,
                rule: "no-machine-paths",
                message: format!(
                    "`{found}` exists on one machine only; write a path relative to the \
                     repository, or ask for a temporary folder."
                ),
            });
        }
    }
    violations
}

/// The first absolute path below a personal or temporary folder.
fn machine_path(line: &str) -> Option<&str> {
    for root in MACHINE_ROOTS {
        for slash in ['/', '\\'] {
            let start_of_path = format!("{slash}{root}{slash}");
            for (start, _) in line.match_indices(&start_of_path) {
                let before = line[..start].chars().next_back();
                let continues = |c: char| c.is_alphanumeric() || "._-/}>)*".contains(c);
                if !before.is_some_and(continues) {
                    let end =
                        line[start..].find(|c: char| c.is_whitespace() || "\"'`)".contains(c));
                    return Some(&line[start..end.map_or(line.len(), |end| start + end)]);
                }
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of the rules that a snippet at `path` breaks.
    fn broken(path: &str, text: &str) -> Vec<&'static str> {
        let file = TextFile {
            path: path.to_owned(),
            text: text.to_owned(),
        };
        let mut rules: Vec<_> = check(&[file])
            .iter()
            .map(|violation| violation.rule)
            .collect();
        rules.dedup();
        rules
    }

    const ENGINE: &str = "crates/engine/src/analysis/statics.rs";
    const MODEL_FILE: &str = "crates/model/src/file.rs";

    #[test]
    fn the_engine_has_no_files_clock_environment_or_print() {
        for (snippet, rule) in [
            ("use std::fs;", "no-files"),
            ("use std::{fmt, fs::File};", "no-files"),
            ("fn f() { std::fs::read(p); }", "no-files"),
            ("use std::time::Duration;", "no-clock"),
            ("fn f() { let t = Instant::now(); }", "no-clock"),
            ("fn f() { g(SystemTime::UNIX_EPOCH) }", "no-clock"),
            ("fn f() { std::env::var(\"A\") }", "no-environment"),
            ("use std::{env};", "no-environment"),
            ("fn f() { std::process::exit(1) }", "no-environment"),
            ("fn f() { println!(\"{x}\"); }", "no-printing"),
            ("fn f() { eprintln!(\"{x}\"); }", "no-printing"),
        ] {
            assert!(broken(ENGINE, snippet).contains(&rule), "{snippet}");
            let numerics = "crates/numerics/src/block.rs";
            assert!(broken(numerics, snippet).contains(&rule), "{snippet}");
            assert!(
                broken("crates/cli/src/main.rs", snippet).is_empty(),
                "{snippet}"
            );
        }
    }

    #[test]
    fn the_model_only_reads_and_never_panics() {
        for (snippet, rule) in [
            ("fn f() { std::fs::write(p, t); }", "model-only-reads"),
            ("use std::fs::{self, create_dir_all};", "model-only-reads"),
            ("fn f() { fs::remove_file(p); }", "model-only-reads"),
            ("fn f() { File::create(p); }", "model-only-reads"),
            ("use std::fs::*;", "model-only-reads"),
            ("fn f() { x.unwrap(); }", "model-never-panics"),
            ("fn f() { x.expect(\"y\"); }", "model-never-panics"),
            ("fn f() { x.map(Option::unwrap); }", "model-never-panics"),
            ("fn f() { panic!(); }", "model-never-panics"),
            ("fn f() { std::time::SystemTime::now(); }", "no-clock"),
        ] {
            assert_eq!(broken(MODEL_FILE, snippet), [rule], "{snippet}");
        }
        for fine in [
            "fn f() { std::fs::read(p)?; x.unwrap_or(1); }",
            "fn expect() {}",
        ] {
            assert!(broken(MODEL_FILE, fine).is_empty(), "{fine}");
        }
    }

    #[test]
    fn tests_may_do_what_libraries_may_not() {
        let snippet = "#[cfg(test)]\nmod tests { fn f() { std::fs::write(p, t).unwrap(); } }";
        assert!(broken(MODEL_FILE, snippet).is_empty());
        assert!(broken("crates/model/tests/files.rs", "fn f() { x.unwrap(); }").is_empty());
        let parent = TextFile {
            path: "crates/model/src/file/mod.rs".to_owned(),
            text: "#[cfg(test)] mod cases;".to_owned(),
        };
        let child = TextFile {
            path: "crates/model/src/file/cases.rs".to_owned(),
            text: "fn f() { x.unwrap(); }".to_owned(),
        };
        assert_eq!(check(&[parent, child.clone()]), []);
        assert_eq!(check(&[child]).len(), 1);
    }

    #[test]
    fn unfinished_code_and_ignored_tests_are_found_everywhere() {
        let ignored = concat!("#[test]\n#[", "ignore]\nfn f() {}");
        assert_eq!(
            broken("crates/cli/src/main.rs", ignored),
            ["no-ignored-tests"]
        );
        let ignored = concat!("#[test]\n#[", "ignore = \"slow\"]\nfn f() {}");
        assert_eq!(
            broken("crates/cli/tests/x.rs", ignored),
            ["no-ignored-tests"]
        );
        for name in ["todo", "unimplemented", "dbg"] {
            let snippet = format!("#[test]\nfn f() {{ {name}!() }}");
            assert_eq!(
                broken("xtask/src/x.rs", &snippet),
                ["no-unfinished-code"],
                "{name}"
            );
        }
    }

    #[test]
    fn long_files_are_reported_with_their_length() {
        let text = "// line\n".repeat(MOST_LINES);
        assert!(broken(ENGINE, &text).is_empty());
        let file = TextFile {
            path: ENGINE.to_owned(),
            text: text + "// one more\n",
        };
        let found = file_length(&file).expect("one line too many");
        assert!(found.message.starts_with("601 lines"), "{found}");
    }

    #[test]
    fn machine_paths_are_found() {
        for root in ["home", "root", "work", "tmp", "Users"] {
            let path = format!("/{root}/someone/file.toml");
            assert_eq!(
                machine_path(&format!("let p = \"{path}\";")),
                Some(path.as_str())
            );
            assert_eq!(machine_path(&format!("see {path}")), Some(path.as_str()));
            assert_eq!(machine_path(&format!("docs{path}")), None);
            assert_eq!(machine_path(&format!("https://example.org{path}")), None);
        }
        let windows = ["C:", "Users", "someone"].join("\\");
        assert!(machine_path(&windows).is_some());
        assert_eq!(machine_path("rate of work/time"), None);
    }

    #[test]
    fn text_that_is_not_rust_is_reported() {
        assert_eq!(broken(ENGINE, "fn f( {"), ["readable-source"]);
    }

    #[test]
    fn violations_name_the_line() {
        let file = TextFile {
            path: ENGINE.to_owned(),
            text: "//! Text.\n\nfn f() {\n    println!();\n}\n".to_owned(),
        };
        assert_eq!(check(&[file])[0].line, 4);
    }
}
