//! Pages from templates.

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value};
use serde::Serialize;

use crate::ReportError;
use crate::number::pieces;

/// The templates: name and text.
const TEMPLATES: [(&str, &str); 4] = [
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
    ("style.css", include_str!("../templates/style.css")),
];

/// Fills in a template. Every text is escaped; HTML has to come as [`Value::from_safe_string`].
pub(crate) fn render(template: &str, content: &impl Serialize) -> Result<String, ReportError> {
    let fail = |error: minijinja::Error| ReportError::Template {
        template: template.to_owned(),
        what: format!("{error:#}"),
    };
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|name| match name.ends_with(".css") {
        true => AutoEscape::None,
        false => AutoEscape::Html,
    });
    // Tags on lines of their own leave no empty lines.
    let mut syntax = SyntaxConfig::builder();
    syntax.trim_blocks(true).lstrip_blocks(true);
    environment.set_syntax(syntax.build().map_err(fail)?);
    environment.add_filter("text", |text: &str| Value::from_safe_string(to_html(text)));
    for (name, text) in TEMPLATES {
        environment.add_template(name, text).map_err(fail)?;
    }
    let page = environment.get_template(template).map_err(fail)?;
    page.render(Serde(content)).map_err(fail)
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
