//! The architecture test: what ARCHITECTURE.md promises, checked against manifests, sources and
//! documents.
//!
//! Every check is a function from text to violations, so that its own tests can feed it bad
//! snippets and see it fail.

mod architecture;
mod arrows;
mod dependencies;
mod files;
mod links;
mod readme;
mod sources;
mod strangers;
mod theory;
mod tokens;
mod web;

use std::fmt;
use std::path::Path;

pub(crate) use files::TextFile;

/// One broken rule at one place.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Violation {
    /// Path from the workspace root, with forward slashes.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Short name of the rule.
    pub rule: &'static str,
    /// What was found, why it is not allowed, and what to do instead.
    pub message: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Violation {
            file,
            line,
            rule,
            message,
        } = self;
        write!(formatter, "{file}:{line}: [{rule}]\n    {message}")
    }
}

/// All violations in the workspace at `root`, sorted by place.
pub(crate) fn check(root: &Path) -> Result<Vec<Violation>, String> {
    let files = files::read_all(root)?;
    let mut violations = arrows::check(root, &files)?;
    violations.extend(dependencies::check(root)?);
    violations.extend(sources::check(&files));
    violations.extend(strangers::check(&files));
    violations.extend(theory::check(&files));
    violations.extend(links::check(root, &files));
    violations.extend(architecture::check(&files));
    violations.extend(readme::check(&files));
    violations.extend(web::check(root)?);
    violations.sort();
    violations.dedup();
    Ok(violations)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The architecture test itself: it fails when the workspace breaks a rule.
    #[test]
    fn workspace_is_tidy() {
        let violations = check(&crate::workspace_root()).expect("the workspace can be read");
        let report: Vec<String> = violations.iter().map(Violation::to_string).collect();
        assert!(report.is_empty(), "\n{}\n", report.join("\n\n"));
    }
}
