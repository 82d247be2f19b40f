//! The reference page of the model file, written from the same tables that read it.

use std::fmt::Write;

use super::read::ReadTable;
use super::schema::describe_quantity;
use super::shape::{FieldShape, Shape, TableShape};
use super::tables::{CaseTable, ModelTable, StudyTable};

/// Every table of the model file with its keys, units and defaults, in Markdown.
///
/// It is the second half of `docs/model-file.md`; a test keeps the two the same.
pub fn reference_markdown() -> String {
    let mut page = String::new();
    let model = ModelTable::table_shape();
    let mut top = StudyTable::table_shape();
    top.doc = "Keys at the top of the file.".to_owned();
    // What the model has beside tables.
    let plain = |field: &&FieldShape| matches!(field.shape, Shape::Choice(_));
    top.fields
        .extend(model.fields.iter().filter(plain).cloned());
    write_table(&mut page, "", &top);
    for field in &model.fields {
        write_shape(&mut page, field.key, &field.doc, &field.shape);
    }
    let mut case = CaseTable::table_shape();
    case.doc
        .push_str("\nBeside the tables of the base model, a load case has these keys:");
    write_table(&mut page, "cases.<name>", &case);
    page
}

/// Writes the tables of a shape under the path at which they stand.
fn write_shape(page: &mut String, path: &str, doc: &str, shape: &Shape) {
    match shape {
        Shape::Table(table) => write_table(page, path, table),
        Shape::Kinds(kinds) => {
            heading(page, path);
            let words: Vec<String> = kinds
                .iter()
                .map(|(kind, _)| format!("`\"{kind}\"`"))
                .collect();
            let _ = writeln!(page, "{doc} The key `kind` is {}.\n", words.join(" or "));
            for (kind, table) in kinds {
                let _ = writeln!(page, "**`kind = \"{kind}\"`** {}\n", paragraphs(&table.doc));
                write_keys(page, table);
                write_inner(page, path, table);
            }
        }
        Shape::Named(item) => write_shape(page, &format!("{path}.<name>"), doc, item),
        Shape::List(item) => write_shape(page, &format!("{path}[]"), doc, item),
        Shape::WordOr(_, item) => write_shape(page, path, doc, item),
        _ => {}
    }
}

fn write_table(page: &mut String, path: &str, table: &TableShape) {
    heading(page, path);
    let _ = writeln!(page, "{}\n", paragraphs(&table.doc));
    write_keys(page, table);
    write_inner(page, path, table);
}

fn heading(page: &mut String, path: &str) {
    let title = match path {
        "" => "Top of the file".to_owned(),
        path => format!("`[{path}]`"),
    };
    let _ = writeln!(page, "### {title}\n");
}

fn paragraphs(doc: &str) -> String {
    doc.replace('\n', "\n\n")
}

fn write_keys(page: &mut String, table: &TableShape) {
    page.push_str("| key | value | default | meaning |\n| --- | --- | --- | --- |\n");
    for field in &table.fields {
        let default = match &field.default {
            Some(default) if default == "{}" => "all defaults".to_owned(),
            Some(default) => format!("`{default}`"),
            None if field.required => "required".to_owned(),
            None => "none".to_owned(),
        };
        let value = describe(&field.shape);
        let doc = field.doc.replace('\n', " ");
        let _ = writeln!(page, "| `{}` | {value} | {default} | {doc} |", field.key);
    }
    page.push('\n');
}

/// Tables inside a table, each under its own heading; end B is written like end A.
fn write_inner(page: &mut String, path: &str, table: &TableShape) {
    for field in table.fields.iter().filter(|field| field.key != "end_b") {
        let path = if path.is_empty() {
            field.key.to_owned()
        } else {
            format!("{path}.{}", field.key)
        };
        write_shape(page, &path, &field.doc, &field.shape);
    }
}

fn describe(shape: &Shape) -> String {
    match shape {
        Shape::Quantity { dimensions, sign } => {
            let text = describe_quantity(dimensions, *sign);
            text.trim_end_matches('.').replace('"', "`")
        }
        Shape::Count => "Whole number, at least 1".to_owned(),
        Shape::Boolean => "`true` or `false`".to_owned(),
        Shape::Text => "Text".to_owned(),
        Shape::Choice(words) => {
            let word = |(word, doc): &(&str, &str)| {
                let doc = doc.trim().trim_end_matches('.');
                format!("`\"{word}\"` ({})", lower_first(doc))
            };
            words.iter().map(word).collect::<Vec<_>>().join(", ")
        }
        Shape::Vector(item) => format!("`[x, y, z]`; each {}", lower_first(&describe(item))),
        Shape::Pair(item) => format!("`[low, high]`; each {}", lower_first(&describe(item))),
        Shape::List(item) => format!("Array; each {}", lower_first(&describe(item))),
        Shape::Table(_) | Shape::Kinds(_) => "Table, below".to_owned(),
        Shape::Named(_) => "Tables by name, below".to_owned(),
        Shape::WordOr(word, other) => format!("`\"{word}\"` or {}", lower_first(&describe(other))),
    }
}

fn lower_first(text: &str) -> String {
    let mut text = text.to_owned();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_lowercase();
    }
    text
}
