//! Collects what is wrong with a file while it is read, so that all of it is reported at once.

use super::diagnostic::DiagnosticCode;
use super::node::Span;

/// Most findings kept: a file with more is wrong throughout, and memory is finite.
const MOST_FINDINGS: usize = 10_000;
/// Longest misspelt word that is compared with the words that exist [bytes].
const LONGEST_WORD: usize = 100;

/// One thing that is wrong, at a place in the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Finding {
    /// Where.
    pub span: Span,
    /// Kind of error.
    pub code: DiagnosticCode,
    /// What is wrong.
    pub message: String,
    /// What to write instead.
    pub help: Option<String>,
}

/// The findings so far.
#[derive(Debug, Default)]
pub(super) struct Log {
    /// In the order of discovery.
    pub findings: Vec<Finding>,
}

impl Log {
    /// Notes an error with its remedy.
    pub fn error(
        &mut self,
        code: DiagnosticCode,
        span: &Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        if self.findings.len() == MOST_FINDINGS {
            return;
        }
        let (message, help) = (message.into(), help.into());
        let help = (!help.is_empty()).then_some(help);
        self.findings.push(Finding {
            span: span.clone(),
            code,
            message,
            help,
        });
    }

    /// Whether nothing is wrong so far.
    pub fn is_empty(&self) -> bool {
        self.findings.is_empty()
    }
}

/// Joins the findings of the load cases: what is wrong in every case is reported once, what is
/// wrong in some of them names these.
pub(super) fn join_cases(cases: Vec<(String, Log)>) -> Vec<Finding> {
    let case_count = cases.len();
    let mut joined: Vec<(Finding, Vec<String>)> = Vec::new();
    let mut positions = std::collections::HashMap::new();
    for (case, log) in cases {
        for finding in log.findings {
            let key = (
                finding.span.start,
                finding.span.end,
                finding.message.clone(),
            );
            let position = *positions.entry(key).or_insert_with(|| {
                joined.push((finding, Vec::new()));
                joined.len() - 1
            });
            let names: &mut Vec<String> = &mut joined[position].1;
            if names.last() != Some(&case) {
                names.push(case.clone());
            }
        }
    }
    let name_cases = |(mut finding, names): (Finding, Vec<String>)| {
        if names.len() < case_count {
            let label = if names.len() == 1 { "case" } else { "cases" };
            finding.message = format!("{} ({label} {})", finding.message, names.join(", "));
        }
        finding
    };
    joined.into_iter().map(name_cases).collect()
}

/// The candidate that a misspelt `word` most likely means.
pub(super) fn closest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if word.len() > LONGEST_WORD {
        return None;
    }
    let plain = |text: &str| text.to_lowercase().replace(['-', ' '], "_");
    let word = plain(word);
    candidates
        .into_iter()
        .map(|candidate| {
            let distance = strsim::damerau_levenshtein(&word, &plain(candidate));
            (distance, candidate)
        })
        .filter(|(distance, candidate)| *distance <= 1 + candidate.len().min(word.len()) / 4)
        .filter(|(distance, candidate)| *distance < candidate.chars().count())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// `` `a`, `b` or `c` ``.
pub(super) fn one_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
    }
}
