//! What may be written where: the one description from which the schema and the reference page are
//! made, and which the reader follows.

use super::dimension::Dimension;
use super::quantity::SignRule;

/// What a value may be.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    /// A number with a unit.
    Quantity {
        /// Dimensions accepted; empty for any.
        dimensions: &'static [Dimension],
        /// Signs accepted.
        sign: SignRule,
    },
    /// A whole number of at least 1.
    Count,
    /// `true` or `false`.
    Boolean,
    /// Any text.
    Text,
    /// One of a few words, each with its meaning.
    Choice(&'static [(&'static str, &'static str)]),
    /// Three values.
    Vector(Box<Shape>),
    /// Two values, the lower one first.
    Pair(Box<Shape>),
    /// Any number of values.
    List(Box<Shape>),
    /// A table of fixed keys.
    Table(TableShape),
    /// A table whose keys depend on the word under `kind`.
    Kinds(Vec<(&'static str, TableShape)>),
    /// A table whose keys are names that the user gives.
    Named(Box<Shape>),
    /// A word instead of the value that follows.
    WordOr(&'static str, Box<Shape>),
}

/// A table of fixed keys.
#[derive(Debug, Clone)]
pub(super) struct TableShape {
    /// What the table describes.
    pub doc: String,
    /// Its keys.
    pub fields: Vec<FieldShape>,
}

/// A key of a table.
#[derive(Debug, Clone)]
pub(super) struct FieldShape {
    /// The key.
    pub key: &'static str,
    /// What it means.
    pub doc: String,
    /// Whether it must be written.
    pub required: bool,
    /// Value that holds when it is not written, as it would be written.
    pub default: Option<String>,
    /// What may be written.
    pub shape: Shape,
}

/// Joins the lines of a doc comment into one paragraph per blank line.
pub(super) fn join_doc(lines: &[&str]) -> String {
    let mut text = String::new();
    for line in lines {
        match line.trim() {
            "" => text.push('\n'),
            line => {
                if !text.is_empty() && !text.ends_with('\n') {
                    text.push(' ');
                }
                text.push_str(line);
            }
        }
    }
    text
}
