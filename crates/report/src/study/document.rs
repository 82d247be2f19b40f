//! What a template gets: the report as sections of blocks. docs/report.md describes the names.

use minijinja::Value;
use serde::Serialize;

/// The whole report.
#[derive(Debug, Serialize)]
pub(super) struct Page {
    /// Code of the language for HTML: `en` or `zh-CN`.
    pub(super) language: &'static str,
    pub(super) title: String,
    /// The remark of the model file; may be empty.
    pub(super) note: String,
    /// Word of the store: `complete`, `failed`, ...
    pub(super) status: &'static str,
    pub(super) status_text: String,
    /// Version of Catenix that computed the results.
    pub(super) version: String,
    /// When the store was made; may be empty.
    pub(super) created: String,
    pub(super) model_file: String,
    pub(super) case_count: usize,
    /// What a reader must know before any number.
    pub(super) notices: Vec<String>,
    pub(super) sections: Vec<Section>,
}

/// A section of the report.
#[derive(Debug, Serialize)]
pub(super) struct Section {
    pub(super) id: &'static str,
    pub(super) number: usize,
    pub(super) title: String,
    pub(super) blocks: Vec<Block>,
}

/// One thing in a section.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(super) enum Block {
    /// A heading below that of the section.
    Heading {
        text: String,
    },
    /// A paragraph.
    Text {
        text: String,
    },
    /// A paragraph that must not be missed.
    Notice {
        text: String,
    },
    /// Text to be taken literally.
    Code {
        text: String,
    },
    Table(Table),
    Figure(Figure),
}

/// A figure in the page.
#[derive(Debug, Serialize)]
pub(super) struct Figure {
    pub(super) id: String,
    pub(super) number: usize,
    /// Name of its files, without ending.
    pub(super) name: String,
    pub(super) title: String,
    /// What there is to know besides; may be empty.
    pub(super) caption: String,
    pub(super) svg: Value,
}

/// A table.
#[derive(Debug, Default, Serialize)]
pub(super) struct Table {
    pub(super) id: String,
    pub(super) number: usize,
    pub(super) title: String,
    /// What there is to know besides; may be empty.
    pub(super) caption: String,
    pub(super) columns: Vec<Column>,
    pub(super) groups: Vec<Group>,
}

/// Head of a column.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Column {
    pub(super) text: String,
    pub(super) is_number: bool,
}

/// Rows that belong together.
#[derive(Debug, Default, Serialize)]
pub(super) struct Group {
    /// May be empty.
    pub(super) name: String,
    pub(super) rows: Vec<Vec<Cell>>,
}

/// A cell.
#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct Cell {
    pub(super) text: String,
    /// Smaller, below the text; may be empty.
    pub(super) remark: String,
}

impl Column {
    pub(super) fn text(text: &str) -> Self {
        Column {
            text: text.to_owned(),
            is_number: false,
        }
    }

    pub(super) fn number(text: &str) -> Self {
        Column {
            text: text.to_owned(),
            is_number: true,
        }
    }
}

impl Group {
    pub(super) fn new(name: &str, rows: Vec<Vec<Cell>>) -> Self {
        Group {
            name: name.to_owned(),
            rows,
        }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Cell {
            text: text.into(),
            remark: String::new(),
        }
    }
}
