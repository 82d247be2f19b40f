//! Pages from templates.

use std::path::{Path, PathBuf};

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Error, ErrorKind, UndefinedBehavior, Value};
use serde::Serialize;

use crate::ReportError;
use crate::number::pieces;
use crate::words::Language;

/// The built-in templates: name and text.
const TEMPLATES: [(&str, &str); 7] = [
    (
        "verification.html",
        include_str!("../templates/verification.html"),
    ),
    (
        "verification-case.html",
        include_str!("../templates/verification-case.html"),
    ),
    (
        "verification-figure.html",
        include_str!("../templates/verification-figure.html"),
    ),
    ("report.html", include_str!("../templates/report.html")),
    (
        "report-figure.html",
        include_str!("../templates/report-figure.html"),
    ),
    (
        "report-table.html",
        include_str!("../templates/report-table.html"),
    ),
    ("style.css", include_str!("../templates/style.css")),
];
/// Templates of the report of results, which users may replace.
const REPLACEABLE: [&str; 4] = [
    "report.html",
    "report-figure.html",
    "report-table.html",
    "style.css",
];
/// Endings of files that are taken for templates.
const ENDINGS: [&str; 2] = ["html", "css"];

/// Templates, ready to be filled in.
pub(crate) struct Templates {
    environment: Environment<'static>,
    /// Where templates are read from instead of the program.
    folder: Option<PathBuf>,
    /// Names of the built-in templates that a user's replace, sorted.
    pub(crate) replaced: Vec<String>,
}

impl Templates {
    /// The built-in templates, and those of a folder over them.
    pub(crate) fn new(language: Language, folder: Option<&Path>) -> Result<Self, ReportError> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|name| match name.ends_with(".css") {
            true => AutoEscape::None,
            false => AutoEscape::Html,
        });
        // A name that nobody knows is an error with its line, not an empty place in the page.
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.add_filter("text", |text: &str| Value::from_safe_string(to_html(text)));
        environment.add_function("t", move |key: &str| -> Result<Value, Error> {
            let text = language.find(key).ok_or_else(|| {
                let what = format!("there is no text with the key `{key}`");
                Error::new(ErrorKind::InvalidOperation, what)
            })?;
            Ok(Value::from(text))
        });
        let mut templates = Templates {
            environment,
            folder: folder.map(Path::to_path_buf),
            replaced: Vec::new(),
        };
        // Tags on lines of their own leave no empty lines.
        let mut syntax = SyntaxConfig::builder();
        syntax.trim_blocks(true).lstrip_blocks(true);
        let syntax = syntax.build().map_err(|error| templates.fail("", error))?;
        templates.environment.set_syntax(syntax);
        for (name, text) in TEMPLATES {
            templates.add(name.to_owned(), text.to_owned())?;
        }
        if let Some(folder) = folder {
            templates.add_folder(folder)?;
        }
        Ok(templates)
    }

    fn add(&mut self, name: String, text: String) -> Result<(), ReportError> {
        let added = self.environment.add_template_owned(name.clone(), text);
        added.map_err(|error| self.fail(&name, error))
    }

    /// Adds every template of a folder; one of them has to replace a built-in one.
    fn add_folder(&mut self, folder: &Path) -> Result<(), ReportError> {
        let fail = |path: &Path, source| ReportError::Read {
            path: path.to_owned(),
            source,
        };
        let entries = std::fs::read_dir(folder).map_err(|source| fail(folder, source))?;
        let mut files: Vec<PathBuf> = entries
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| {
                let ending = path.extension().and_then(|ending| ending.to_str());
                path.is_file() && ending.is_some_and(|ending| ENDINGS.contains(&ending))
            })
            .collect();
        files.sort();
        for path in files {
            let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
                continue;
            };
            let text = std::fs::read_to_string(&path).map_err(|source| fail(&path, source))?;
            if REPLACEABLE.contains(&name) {
                self.replaced.push(name.to_owned());
            }
            self.add(name.to_owned(), text)?;
        }
        if self.replaced.is_empty() {
            return Err(ReportError::NoTemplates {
                path: folder.to_owned(),
                names: REPLACEABLE.join(", "),
            });
        }
        Ok(())
    }

    /// Fills in a template. Every text is escaped; HTML has to come as [`Value::from_safe_string`].
    pub(crate) fn render(
        &self,
        template: &str,
        content: &impl Serialize,
    ) -> Result<String, ReportError> {
        let page = self.environment.get_template(template);
        let page = page.map_err(|error| self.fail(template, error))?;
        let filled = page.render(Serde(content));
        filled.map_err(|error| self.fail(template, error))
    }

    /// The innermost error with a place: that of an included template, not of the one around it.
    fn fail(&self, template: &str, error: Error) -> ReportError {
        let mut innermost = &error;
        let mut next: Option<&dyn std::error::Error> = Some(&error);
        while let Some(error) = next {
            if let Some(found) = error.downcast_ref::<Error>()
                && found.line().is_some()
            {
                innermost = found;
            }
            next = error.source();
        }
        let name = innermost.name().unwrap_or(template);
        let file = match &self.folder {
            Some(folder) if folder.join(name).is_file() => folder.join(name),
            _ => PathBuf::from(name),
        };
        let what = match innermost.detail() {
            Some(detail) => format!("{}: {detail}", innermost.kind()),
            None => innermost.kind().to_string(),
        };
        ReportError::Template {
            file,
            line: innermost.line().unwrap_or(0),
            what,
        }
    }
}

/// Fills in a built-in template in English.
pub(crate) fn render(template: &str, content: &impl Serialize) -> Result<String, ReportError> {
    Templates::new(Language::English, None)?.render(template, content)
}

/// A line of text as HTML, with superscript characters raised.
fn to_html(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for (piece, raised) in pieces(text) {
        html.push_str(if raised { "<sup>" } else { "" });
        for character in piece.chars() {
            match character {
                '&' => html.push_str("&amp;"),
                '<' => html.push_str("&lt;"),
                '>' => html.push_str("&gt;"),
                '"' => html.push_str("&quot;"),
                '\'' => html.push_str("&#39;"),
                c if c.is_control() => html.push(' '),
                c => html.push(c),
            }
        }
        html.push_str(if raised { "</sup>" } else { "" });
    }
    html
}
