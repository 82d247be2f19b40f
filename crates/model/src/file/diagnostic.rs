//! Errors of a model file, each with its position and a remedy.

use std::fmt;
use std::ops::Range;

use miette::{LabeledSpan, NamedSource, SourceCode};
use serde::Serialize;

use super::log::Finding;

/// Most diagnostics reported for one file; a last one tells how many more there were.
const MOST_DIAGNOSTICS: usize = 100;

/// What kind of error a [`Diagnostic`] reports; stable, for scripts and editors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DiagnosticCode {
    /// The file cannot be read, is too large, empty or not text.
    File,
    /// Not valid TOML; a key written twice is among these.
    Syntax,
    /// A key that does not exist there.
    UnknownKey,
    /// A key that must be there.
    MissingKey,
    /// Keys that exclude each other, or do not belong together.
    ConflictingKeys,
    /// A value of another TOML type, or an array of another length.
    WrongType,
    /// A number that cannot be read, or is not finite.
    Number,
    /// A unit that does not exist or cannot be read.
    Unit,
    /// A unit of another dimension than expected.
    Dimension,
    /// A value outside its range, or a word that is not among the choices.
    Value,
    /// A reference to a name that does not exist.
    UnknownName,
    /// Two objects of one name, or a name with characters that names cannot have.
    Name,
    /// A motion history that cannot be read from its CSV file.
    Csv,
    /// A system that cannot be in equilibrium, or lies outside the water.
    Geometry,
    /// A channel that does not exist.
    Channel,
}

impl DiagnosticCode {
    /// The code as it is written in JSON.
    pub fn as_str(self) -> &'static str {
        match self {
            DiagnosticCode::File => "file",
            DiagnosticCode::Syntax => "syntax",
            DiagnosticCode::UnknownKey => "unknown_key",
            DiagnosticCode::MissingKey => "missing_key",
            DiagnosticCode::ConflictingKeys => "conflicting_keys",
            DiagnosticCode::WrongType => "wrong_type",
            DiagnosticCode::Number => "number",
            DiagnosticCode::Unit => "unit",
            DiagnosticCode::Dimension => "dimension",
            DiagnosticCode::Value => "value",
            DiagnosticCode::UnknownName => "unknown_name",
            DiagnosticCode::Name => "name",
            DiagnosticCode::Csv => "csv",
            DiagnosticCode::Geometry => "geometry",
            DiagnosticCode::Channel => "channel",
        }
    }
}

/// One error in a model file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, thiserror::Error)]
#[error("{message}")]
pub struct Diagnostic {
    /// Kind of error.
    pub code: DiagnosticCode,
    /// What is wrong.
    pub message: String,
    /// What to write instead.
    pub help: Option<String>,
    /// Line in the file, from 1; 0 when the error concerns the file as a whole.
    pub line: usize,
    /// Column in the line in characters, from 1; 0 when the error concerns the file as a whole.
    pub column: usize,
    /// Byte range in the file.
    pub span: Range<usize>,
}

impl miette::Diagnostic for Diagnostic {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.code.as_str()))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help
            .as_ref()
            .map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        if self.line == 0 {
            return None;
        }
        Some(Box::new(std::iter::once(LabeledSpan::underline(
            self.span.clone(),
        ))))
    }
}

/// All errors of one model file.
///
/// It is a [`miette::Diagnostic`], so that a command line can draw every error under the line that
/// it concerns, and serialises as `{"file": ..., "diagnostics": [...]}`.
#[derive(Debug, Clone, Serialize)]
pub struct ModelFileErrors {
    /// The file, as the user named it.
    pub file: String,
    /// The errors, by position; at least one.
    pub diagnostics: Vec<Diagnostic>,
    /// Contents of the file for drawing; empty when it could not be read.
    #[serde(skip)]
    text: NamedSource<String>,
}

impl ModelFileErrors {
    /// An error that concerns the file as a whole.
    pub(super) fn of_file(file: &str, message: String, help: Option<String>) -> Self {
        let diagnostic = Diagnostic {
            code: DiagnosticCode::File,
            message,
            help,
            line: 0,
            column: 0,
            span: 0..0,
        };
        let text = NamedSource::new(file, String::new());
        ModelFileErrors {
            file: file.to_owned(),
            diagnostics: vec![diagnostic],
            text,
        }
    }

    /// Places findings in the text.
    pub(super) fn new(file: &str, text: &str, mut findings: Vec<Finding>) -> Self {
        findings.sort_by_key(|finding| (finding.span.start, finding.span.end));
        let left_out = findings.len().saturating_sub(MOST_DIAGNOSTICS);
        findings.truncate(MOST_DIAGNOSTICS);
        let lines = LineStarts::new(text);
        let mut diagnostics: Vec<Diagnostic> = findings
            .into_iter()
            .map(|finding| lines.place(text, finding))
            .collect();
        if left_out > 0 {
            diagnostics.push(Diagnostic {
                code: DiagnosticCode::File,
                message: format!("{left_out} more errors are not shown"),
                help: Some("correct the errors above and check again".to_owned()),
                line: 0,
                column: 0,
                span: 0..0,
            });
        }
        let text = NamedSource::new(file, text.to_owned());
        ModelFileErrors {
            file: file.to_owned(),
            diagnostics,
            text,
        }
    }

    /// Contents of the file; empty when it could not be read.
    pub fn text(&self) -> &str {
        self.text.inner()
    }
}

impl fmt::Display for ModelFileErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.diagnostics.as_slice() {
            [only] if only.line == 0 => write!(formatter, "{}: {}", self.file, only.message),
            [_] => write!(formatter, "1 error in {}", self.file),
            several => write!(formatter, "{} errors in {}", several.len(), self.file),
        }
    }
}

impl std::error::Error for ModelFileErrors {}

impl ModelFileErrors {
    /// The only error, when it concerns the file as a whole; it then is the headline.
    fn only_of_file(&self) -> Option<&Diagnostic> {
        match self.diagnostics.as_slice() {
            [only] if only.line == 0 => Some(only),
            _ => None,
        }
    }
}

impl miette::Diagnostic for ModelFileErrors {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.text)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.only_of_file().and_then(miette::Diagnostic::help)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn miette::Diagnostic> + 'a>> {
        if self.only_of_file().is_some() {
            return None;
        }
        let as_dyn = |diagnostic: &'a Diagnostic| diagnostic as &dyn miette::Diagnostic;
        Some(Box::new(self.diagnostics.iter().map(as_dyn)))
    }
}

/// Where each line of a text starts, to turn byte offsets into lines and columns.
struct LineStarts(Vec<usize>);

impl LineStarts {
    fn new(text: &str) -> Self {
        let after_breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        LineStarts(
            std::iter::once(0)
                .chain(after_breaks.map(|(at, _)| at + 1))
                .collect(),
        )
    }

    fn place(&self, text: &str, finding: Finding) -> Diagnostic {
        let Finding {
            span,
            code,
            message,
            help,
        } = finding;
        let start = span.start.min(text.len());
        let line = self
            .0
            .partition_point(|&line_start| line_start <= start)
            .max(1);
        let before = text.get(self.0[line - 1]..start).unwrap_or("");
        let column = before.chars().count() + 1;
        let span = start..span.end.clamp(start, text.len());
        Diagnostic {
            code,
            message,
            help,
            line,
            column,
            span,
        }
    }
}
