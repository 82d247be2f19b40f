//! Citations of the theory manual: every equation that a source cites must exist, once.
//!
//! A citation reads `docs/theory/<file>.md, eq. (N)`, or `eqs. (N) and (M)`; it may run over a line
//! break of its comment. An equation carries its number as `\tag{N}`, or as `(N)` at the end of its
//! line.

use super::{TextFile, Violation};

const FOLDER: &str = "docs/theory/";

/// Checks the citations in all sources and documents, and the numbers in the manual.
pub(crate) fn check(files: &[TextFile]) -> Vec<Violation> {
    let manual: Vec<(&str, Vec<(String, usize)>)> = files
        .iter()
        .filter(|file| file.path.starts_with(FOLDER) && file.has_ending("md"))
        .map(|file| (file.path.as_str(), equation_numbers(&file.text)))
        .collect();
    let mut violations = duplicates(&manual);
    for file in files
        .iter()
        .filter(|file| file.has_ending("rs") || file.has_ending("md"))
    {
        // The checker's own tests cite equations that do not exist.
        if file.path != "xtask/src/tidy/theory.rs" {
            violations.extend(check_citations(file, &manual));
        }
    }
    violations
}

/// Numbers of a chapter's equations with their lines.
fn equation_numbers(text: &str) -> Vec<(String, usize)> {
    let mut numbers = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let mut push = |number: &str| numbers.push((number.to_owned(), index + 1));
        let mut tagged = false;
        for part in line.split("\\tag{").skip(1) {
            if let Some((number, _)) = part.split_once('}') {
                push(number.trim());
                tagged = true;
            }
        }
        if !tagged && let Some(number) = number_at_end(line) {
            push(number);
        }
    }
    numbers
}

/// The `N` of a line that ends in `(N)` and is not a sentence that cites an equation.
fn number_at_end(line: &str) -> Option<&str> {
    let line = line.trim_end();
    let before_close = line.strip_suffix(')')?;
    let (before, number) = before_close.rsplit_once('(')?;
    let cites = [
        "eq.",
        "eqs.",
        "and",
        "to",
        "or",
        "equation",
        "equations",
        ",",
    ]
    .iter()
    .any(|word| before.trim_end().to_lowercase().ends_with(word));
    let starts_with_digit = number.starts_with(|c: char| c.is_ascii_digit());
    let spaced = before.is_empty() || before.ends_with(char::is_whitespace);
    (starts_with_digit && spaced && !cites && is_number(number)).then_some(number)
}

/// `12`, `12a`, `H.3`, `2-1`.
fn is_number(label: &str) -> bool {
    label.len() <= 8
        && label.contains(|c: char| c.is_ascii_digit())
        && label
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || ".-'".contains(c))
}

fn duplicates(manual: &[(&str, Vec<(String, usize)>)]) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (file, numbers) in manual {
        for (index, (number, line)) in numbers.iter().enumerate() {
            if let Some((_, first)) = numbers[..index].iter().find(|(other, _)| other == number) {
                violations.push(Violation {
                    file: (*file).to_owned(),
                    line: *line,
                    rule: "theory-numbers",
                    message: format!(
                        "equation ({number}) is already on line {first}; a citation must find one \
                         equation. Give this one a number of its own."
                    ),
                });
            }
        }
    }
    violations
}

fn check_citations(file: &TextFile, manual: &[(&str, Vec<(String, usize)>)]) -> Vec<Violation> {
    let mut violations = Vec::new();
    for citation in citations(&prose(file)) {
        let mut push = |message| {
            let (file, line) = (file.path.clone(), citation.line);
            violations.push(Violation {
                file,
                line,
                rule: "theory-citations",
                message,
            });
        };
        let chapter = &citation.chapter;
        match manual.iter().find(|(path, _)| path == chapter) {
            None => push(format!(
                "cites {chapter}, which does not exist; every formula has its chapter and number."
            )),
            Some(_) if citation.numbers.is_none() => push(format!(
                "cites {chapter} with an equation whose number cannot be read; write \
                 `{chapter}, eq. (N)`."
            )),
            Some((_, known)) => {
                for number in citation.numbers.iter().flatten() {
                    if !known.iter().any(|(other, _)| other == number) {
                        push(format!(
                            "cites {chapter}, eq. ({number}), which does not exist; add the \
                             equation to the chapter, or correct the number."
                        ));
                    }
                }
            }
        }
    }
    violations
}

/// A mention of a chapter, with the equations named after it.
struct Citation {
    chapter: String,
    /// Empty when only the chapter is named; `None` when "eq." is followed by no `(N)`.
    numbers: Option<Vec<String>>,
    line: usize,
}

/// The text that people write in a file: comments of a source, all of a document. Each character
/// comes with its line; line breaks inside a block are spaces.
fn prose(file: &TextFile) -> Vec<(char, usize)> {
    let mut prose = Vec::new();
    for (index, line) in file.text.lines().enumerate() {
        let written = if file.has_ending("rs") {
            line.split_once("//")
                .map(|(_, comment)| comment.trim_start_matches(['/', '!']))
        } else {
            Some(line)
        };
        match written {
            Some(text) => prose.extend(text.chars().chain([' ']).map(|c| (c, index + 1))),
            None => prose.push(('\n', index + 1)),
        }
    }
    prose
}

fn citations(prose: &[(char, usize)]) -> Vec<Citation> {
    let text: Vec<char> = prose.iter().map(|(c, _)| *c).collect();
    let start_mark: Vec<char> = FOLDER.chars().collect();
    let mut found = Vec::new();
    for start in 0..text.len() {
        if !text[start..].starts_with(&start_mark) {
            continue;
        }
        let name_start = start + start_mark.len();
        let in_name = |c: &char| c.is_ascii_alphanumeric() || "_-/.".contains(*c);
        let name: String = text[name_start..]
            .iter()
            .take_while(|c| in_name(c))
            .collect();
        let Some(name_length) = name.find(".md").map(|end| end + ".md".len()) else {
            continue;
        };
        let after: String = text[name_start + name_length..].iter().take(200).collect();
        found.push(Citation {
            chapter: format!("{FOLDER}{}", &name[..name_length]),
            numbers: numbers_after(&after),
            line: prose[start].1,
        });
    }
    found
}

/// Reads `, eq. (3)`, `, eqs. (3), (4a) and (7)`.
fn numbers_after(text: &str) -> Option<Vec<String>> {
    let mut rest = skip(text, &["`", ")", ",", "]"]);
    let opening = ["equations", "equation", "eqs.", "eq.", "Eqs.", "Eq."];
    let Some(after) = opening.iter().find_map(|word| rest.strip_prefix(word)) else {
        return Some(Vec::new());
    };
    rest = after;
    let mut numbers: Vec<String> = Vec::new();
    loop {
        let separated = skip(
            rest,
            &[",", ";", "and", "or", "to", "-", "\u{2013}", "eqs.", "eq."],
        );
        let separator = rest[..rest.len() - separated.len()].trim();
        let Some((number, after)) = separated.strip_prefix('(').and_then(|r| r.split_once(')'))
        else {
            break;
        };
        if !is_number(number) {
            break;
        }
        if ["to", "-", "\u{2013}"].contains(&separator) {
            numbers.extend(between(numbers.last(), number));
        }
        numbers.push(number.to_owned());
        rest = after;
    }
    (!numbers.is_empty()).then_some(numbers)
}

/// The whole numbers between two ends of a range.
fn between(first: Option<&String>, last: &str) -> Vec<String> {
    match (
        first.and_then(|number| number.parse::<u32>().ok()),
        last.parse::<u32>().ok(),
    ) {
        (Some(first), Some(last)) => (first + 1..last).map(|number| number.to_string()).collect(),
        _ => Vec::new(),
    }
}

/// `text` without leading blanks and the given words.
fn skip<'a>(text: &'a str, words: &[&str]) -> &'a str {
    let mut rest = text.trim_start_matches(' ');
    while let Some(after) = words.iter().find_map(|word| rest.strip_prefix(word)) {
        rest = after.trim_start_matches(' ');
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAPTER: &str = "# Drag\n\n$$ F = v^2 \\tag{1} $$\n\n    M = a b      (2)\n\n\
                           as follows from eq. (1)\nand from eqs. (1) and (2)\n";

    fn violations(source: &str) -> Vec<String> {
        let chapter = TextFile {
            path: format!("{FOLDER}drag.md"),
            text: CHAPTER.to_owned(),
        };
        let source = TextFile {
            path: "crates/engine/src/x.rs".to_owned(),
            text: source.to_owned(),
        };
        let found = check(&[chapter, source]);
        found
            .into_iter()
            .map(|v| format!("{}: {}", v.line, v.message))
            .collect()
    }

    #[test]
    fn numbers_are_tags_and_line_ends_but_not_citations() {
        let numbers: Vec<String> = equation_numbers(CHAPTER)
            .into_iter()
            .map(|(n, _)| n)
            .collect();
        assert_eq!(numbers, ["1", "2"]);
        for prose in [
            "the year was (about 2011)",
            "the function f(2)",
            "of the paper, eq. (3)",
        ] {
            assert_eq!(equation_numbers(prose), [], "{prose}");
        }
    }

    #[test]
    fn citations_of_existing_equations_pass() {
        for source in [
            "/// Source: docs/theory/drag.md, eq. (1).",
            "// docs/theory/drag.md, eqs. (1) and (2)",
            "//! See docs/theory/drag.md.",
            "    /// Source: docs/theory/drag.md,\n    /// eq. (2).",
        ] {
            assert!(violations(source).is_empty(), "{source}");
        }
    }

    #[test]
    fn citations_of_missing_equations_fail() {
        for source in [
            "/// Source: docs/theory/drag.md, eq. (3).",
            "/// Source: docs/theory/drag.md, eqs. (1) and (3).",
            "/// Source: docs/theory/drag.md, eqs. (1)-(3).",
            "/// Source: docs/theory/drag.md,\n/// eq. (1a).",
            "/// Source: docs/theory/drag.md, eq. 1.",
            "/// Source: docs/theory/lift.md, eq. (1).",
            "fn f() {} // docs/theory/lift.md",
        ] {
            assert_eq!(violations(source).len(), 1, "{source}");
        }
    }

    #[test]
    fn a_range_cites_everything_in_it() {
        let found = violations("/// Source: docs/theory/drag.md, eqs. (2) to (5).");
        assert_eq!(found.len(), 3, "{found:?}");
    }

    #[test]
    fn the_line_of_the_citation_is_named() {
        let found = violations("fn f() {}\n\n/// docs/theory/drag.md,\n/// eq. (9)\nfn g() {}");
        assert!(found[0].starts_with("3: "), "{found:?}");
    }

    #[test]
    fn a_number_twice_in_a_chapter_fails() {
        let text = "a \\tag{1}\nb \\tag{2}\nc \\tag{1}\n".to_owned();
        let found = check(&[TextFile {
            path: format!("{FOLDER}drag.md"),
            text,
        }]);
        assert_eq!((found.len(), found[0].line), (1, 3));
    }
}
