//! A table that is read piece by piece and column by column.

use serde::Serialize;

use crate::ExportError;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// Numbers that are stored in double precision.
    Float64,
    /// Numbers that are stored in single precision.
    Float32,
    /// Words.
    Text,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Column {
    /// Heading: the name, and the unit in brackets.
    pub(crate) column: String,
    /// Name, as in the model file and the store.
    pub(crate) name: String,
    /// Unit; none for words.
    pub(crate) unit: Option<String>,
    /// What it is.
    pub(crate) long_name: String,
    pub(crate) kind: Kind,
}

impl Column {
    /// A column of numbers.
    pub(crate) fn number(name: &str, unit: &str, long_name: &str, kind: Kind) -> Self {
        Column {
            column: format!("{name} [{unit}]"),
            name: name.to_owned(),
            unit: Some(unit.to_owned()),
            long_name: long_name.to_owned(),
            kind,
        }
    }

    /// A column of numbers whose unit stands in another column.
    pub(crate) fn plain_number(name: &str, long_name: &str) -> Self {
        Column {
            unit: None,
            kind: Kind::Float64,
            ..Column::text(name, long_name)
        }
    }

    /// A column of words.
    pub(crate) fn text(name: &str, long_name: &str) -> Self {
        Column {
            column: name.to_owned(),
            name: name.to_owned(),
            unit: None,
            long_name: long_name.to_owned(),
            kind: Kind::Text,
        }
    }
}

/// Values of one column in one piece.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Values<'a> {
    /// Numbers; those of single precision are widened.
    Numbers(Vec<f64>),
    /// Words.
    Texts(Vec<&'a str>),
}

/// A table of which only a piece is in memory at a time.
pub(crate) trait Table {
    /// What it holds, in one word.
    fn content(&self) -> &'static str;

    /// The columns.
    fn columns(&self) -> &[Column];

    /// Rows of each piece.
    fn pieces(&self) -> &[usize];

    /// Reads a column of a piece.
    fn read(&self, column: usize, piece: usize) -> Result<Values<'_>, ExportError>;

    /// Rows of all pieces.
    fn rows(&self) -> usize {
        self.pieces().iter().sum()
    }
}

/// A table that is small enough for the memory.
#[derive(Debug)]
pub(crate) struct SmallTable {
    content: &'static str,
    columns: Vec<Column>,
    cells: Vec<Cells>,
    rows: [usize; 1],
}

#[derive(Debug)]
enum Cells {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

impl SmallTable {
    /// A table without rows.
    pub(crate) fn new(content: &'static str, columns: Vec<Column>) -> Self {
        let cells = columns.iter().map(|column| match column.kind {
            Kind::Text => Cells::Texts(Vec::new()),
            _ => Cells::Numbers(Vec::new()),
        });
        SmallTable {
            content,
            cells: cells.collect(),
            columns,
            rows: [0],
        }
    }

    /// Appends numbers to a column.
    pub(crate) fn push_numbers(&mut self, column: usize, values: impl IntoIterator<Item = f64>) {
        if let Cells::Numbers(cells) = &mut self.cells[column] {
            cells.extend(values);
            self.rows = [cells.len()];
        }
    }

    /// Appends a word `count` times to a column.
    pub(crate) fn push_text(&mut self, column: usize, text: &str, count: usize) {
        if let Cells::Texts(cells) = &mut self.cells[column] {
            cells.extend(std::iter::repeat_n(text.to_owned(), count));
        }
    }
}

impl Table for SmallTable {
    fn content(&self) -> &'static str {
        self.content
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn pieces(&self) -> &[usize] {
        &self.rows
    }

    fn read(&self, column: usize, _piece: usize) -> Result<Values<'_>, ExportError> {
        Ok(match &self.cells[column] {
            Cells::Numbers(cells) => Values::Numbers(cells.clone()),
            Cells::Texts(cells) => Values::Texts(cells.iter().map(String::as_str).collect()),
        })
    }
}
