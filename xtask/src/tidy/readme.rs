//! README.md and its Chinese counterpart have the same commands, and the same numbers in the table of
//! the sea trial.

use super::{TextFile, Violation};

const ENGLISH: &str = "README.md";
const CHINESE: &str = "README.zh-CN.md";
const TABLE: [&str; 2] = [
    "<!-- sea-trial table: begin -->",
    "<!-- sea-trial table: end -->",
];

/// Checks the two pages against each other.
pub(crate) fn check(files: &[TextFile]) -> Vec<Violation> {
    let find = |path: &str| files.iter().find(|file| file.path == path);
    let violation = |line, message| Violation {
        file: CHINESE.to_owned(),
        line,
        rule: "readme-languages",
        message,
    };
    let Some(english) = find(ENGLISH) else {
        return Vec::new();
    };
    let Some(chinese) = find(CHINESE) else {
        let message = format!("does not exist; it is the Chinese counterpart of {ENGLISH}.");
        return vec![violation(1, message)];
    };
    let mut violations = Vec::new();
    let (wanted, found) = (commands(&english.text), commands(&chinese.text));
    for index in 0..wanted.len().max(found.len()) {
        let [wanted, found] = [wanted.get(index), found.get(index)];
        if wanted.map(|(_, command)| command) != found.map(|(_, command)| command) {
            let text = |command: Option<&(usize, String)>| {
                command.map_or_else(|| "nothing".to_owned(), |(_, text)| format!("`{text}`"))
            };
            let line = found.map_or(1, |(line, _)| *line);
            let message = format!(
                "has {} where {ENGLISH} has {}; the commands of both pages must be equal.",
                text(found),
                text(wanted)
            );
            violations.push(violation(line, message));
            break;
        }
    }
    if numbers(&english.text) != numbers(&chinese.text) {
        let message = format!("has other numbers in the sea-trial table than {ENGLISH}.");
        violations.push(violation(1, message));
    }
    violations
}

/// Lines of code with their numbers, without comments.
fn commands(text: &str) -> Vec<(usize, String)> {
    let mut in_code = false;
    let lines = text.lines().zip(1..).filter(|(line, _)| {
        let is_fence = line.starts_with("```");
        in_code ^= is_fence;
        in_code && !is_fence
    });
    let commands = lines.map(|(line, number)| {
        let command = line.split_once(" #").map_or(line, |(command, _)| command);
        (number, command.trim_end().to_owned())
    });
    commands
        .filter(|(_, command)| !command.is_empty())
        .collect()
}

/// Numbers of the rows of the sea-trial table.
fn numbers(text: &str) -> Vec<String> {
    let [begin, end] = TABLE;
    let table = text.split_once(begin).map_or("", |(_, rest)| rest);
    let table = table.split_once(end).map_or(table, |(table, _)| table);
    let rows = table.lines().filter(|line| line.starts_with('|'));
    let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let parts = rows.flat_map(|row| row.split(move |c| !is_part(c)));
    let has_digit = |part: &&str| part.chars().any(|c| c.is_ascii_digit());
    parts.filter(has_digit).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pages(english: &str, chinese: &str) -> Vec<TextFile> {
        [(ENGLISH, english), (CHINESE, chinese)]
            .map(|(path, text)| TextFile {
                path: path.to_owned(),
                text: text.to_owned(),
            })
            .into()
    }

    #[test]
    fn commands_may_differ_in_their_comments_only() {
        let page = "a\n```sh\ncargo run x   # one\n\n```\nb\n";
        assert!(check(&pages(page, "甲\n```sh\ncargo run x # 一\n```\n")).is_empty());
        let found = check(&pages(page, "```sh\ncargo run y # 一\n```\n"));
        assert_eq!((found.len(), found[0].line), (1, 2));
        assert_eq!(check(&pages(page, "no commands")).len(), 1);
        assert_eq!(check(&pages(page, "")[..1]).len(), 1);
        assert_eq!(check(&[]), []);
    }

    #[test]
    fn the_numbers_of_the_table_are_the_same() {
        let [begin, end] = TABLE;
        let page = |row: &str| format!("{begin}\n1 2 3\n| a | {row} |\n{end}\n9");
        let english = page("-22.8 (1 to 2)");
        assert!(check(&pages(&english, &page("-22.8 (1 至 2)"))).is_empty());
        assert_eq!(check(&pages(&english, &page("-22.9 (1 至 2)"))).len(), 1);
    }
}
