//! Why a command ends early, and with which exit code.

use catenix_export::ExportError;
use catenix_model::file::ModelFileErrors;
use catenix_report::ReportError;
use catenix_results::StoreError;
use catenix_study::VerificationError;
use catenix_viewer::ViewerError;
use serde::Serialize;
use serde_json::{Value, json};

/// Exit codes, as `--help` and docs/cli.md list them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    Success = 0,
    SolverFailed = 1,
    Usage = 2,
    Model = 3,
    InputOutput = 4,
    Interrupted = 130,
}

/// An error that ends a command before it has anything to print.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Model(#[from] Box<ModelFileErrors>),
    #[error("load case `{case}` cannot be assembled: {message}")]
    System { case: String, message: String },
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Verification(#[from] VerificationError),
    #[error("there is no verification case `{name}` in the suite; it has {available}")]
    UnknownVerification { name: String, available: String },
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    #[error("there is no load case `{name}` in the model file; it has {available}")]
    UnknownCase { name: String, available: String },
    #[error(
        "no figure can be drawn of the channel `{name}`: write --channel with the name of one, for \
         example `{example}`; `catenix path --json` lists them all"
    )]
    UnknownChannel { name: String, example: String },
    #[error("cannot read {path}: {source}")]
    Read {
        path: String,
        source: std::io::Error,
    },
    #[error("cannot start {what}: {message}")]
    Start { what: &'static str, message: String },
}

impl Failure {
    pub(crate) fn exit(&self) -> Exit {
        match self {
            // A file that cannot be read is trouble with the disk, not with the model.
            Failure::Model(errors) if is_unreadable(errors) => Exit::InputOutput,
            Failure::Model(_) | Failure::System { .. } => Exit::Model,
            Failure::Store(_)
            | Failure::Viewer(_)
            | Failure::Report(_)
            | Failure::Read { .. }
            | Failure::Start { .. } => Exit::InputOutput,
            Failure::Export(error) => match error {
                ExportError::UnknownName { .. } | ExportError::NoRows { .. } => Exit::Usage,
                ExportError::Interrupted => Exit::Interrupted,
                _ => Exit::InputOutput,
            },
            Failure::Verification(error) => match error {
                VerificationError::Spec { .. } | VerificationError::Model(_) => Exit::Model,
                _ => Exit::InputOutput,
            },
            Failure::UnknownCase { .. }
            | Failure::UnknownChannel { .. }
            | Failure::UnknownVerification { .. } => Exit::Usage,
        }
    }

    fn code(&self) -> &'static str {
        match self {
            Failure::Model(_) => "model::file",
            Failure::System { .. } => "model::system",
            Failure::Store(error) => error.code(),
            Failure::Viewer(error) => error.code(),
            Failure::Export(error) => error.code(),
            Failure::Report(error) => error.code(),
            Failure::UnknownCase { .. } => "usage::unknown_case",
            Failure::UnknownChannel { .. } => "usage::unknown_channel",
            Failure::UnknownVerification { .. } => "usage::unknown_case",
            Failure::Verification(_) => "verification::suite",
            Failure::Read { .. } => "io::read",
            Failure::Start { .. } => "io::start",
        }
    }

    /// The `error` object of a JSON document.
    pub(crate) fn to_json(&self) -> Value {
        let mut error =
            json!({ "code": self.code(), "message": self.to_string(), "diagnostics": [] });
        if let Failure::Model(errors) = self {
            // {"file": ..., "diagnostics": [...]}
            if let Ok(Value::Object(details)) = serde_json::to_value(errors) {
                for (key, value) in details {
                    error[key] = value;
                }
            }
        }
        error
    }

    /// Text for the terminal; errors of the model file with the lines that they are about.
    pub(crate) fn into_text(self) -> String {
        match self {
            Failure::Model(errors) => format!("{:?}", miette::Report::new(*errors)),
            other => format!("error: {other}"),
        }
    }
}

fn is_unreadable(errors: &ModelFileErrors) -> bool {
    let path = std::path::Path::new(&errors.file);
    !path.is_file() || std::fs::File::open(path).is_err()
}

/// A JSON document: the outcome, then what the command has to say.
#[derive(Debug, Serialize)]
pub(crate) struct Document<T: Serialize> {
    command: &'static str,
    ok: bool,
    exit_code: u8,
    error: Option<Value>,
    #[serde(flatten)]
    content: Option<T>,
}

impl<T: Serialize> Document<T> {
    pub(crate) fn new(command: &'static str, exit: Exit, content: T) -> Self {
        let ok = exit == Exit::Success;
        Document {
            command,
            ok,
            exit_code: exit as u8,
            error: None,
            content: Some(content),
        }
    }
}

impl Document<()> {
    pub(crate) fn of_failure(command: &'static str, failure: &Failure) -> Self {
        let exit_code = failure.exit() as u8;
        Document {
            command,
            ok: false,
            exit_code,
            error: Some(failure.to_json()),
            content: None,
        }
    }
}
