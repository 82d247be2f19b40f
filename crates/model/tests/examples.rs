//! Every example passes the checks and the schema.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use catenix_model::file::{json_schema, parse_study, read_study, reference_markdown};

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let files = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = files
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    files.sort();
    assert!(files.len() >= 7, "{files:?}");
    files
}

#[test]
fn examples_pass_the_checks() {
    for path in examples() {
        if let Err(errors) = read_study(&path) {
            panic!("{}: {:#?}", path.display(), errors.diagnostics);
        }
    }
}

#[test]
fn examples_follow_the_schema() {
    let schema = json_schema();
    jsonschema::draft7::meta::validate(&schema).expect("the schema is a schema");
    let validator = jsonschema::draft7::new(&schema).unwrap();
    for path in examples() {
        let text = std::fs::read_to_string(&path).unwrap();
        let document = json_of(&text);
        let errors: Vec<String> = validator
            .iter_errors(&document)
            .map(|error| format!("{}: {error}", error.instance_path()))
            .collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", path.display());
    }
}

#[test]
fn schema_refuses_what_the_reader_refuses() {
    let validator = jsonschema::draft7::new(&json_schema()).unwrap();
    let good = "[environment]\nwater.depth = 100\n[dynamics]\nduration = \"1 s\"\n";
    assert!(validator.is_valid(&json_of(good)));
    for bad in [
        "titel = \"x\"\n",
        "[environment]\nwater.depth = \"m\"\n",
        "[environment]\nwater.depth = -1\n",
        "[environment]\ngravity = -9.81\n",
        "[environment]\nwater.depth = 100\n[dynamics]\n",
        "[environment]\nwater.depth = 100\n[lines.\"a b\"]\nsections = []\n",
        "[environment]\nwater.depth = 100\n[lines.a]\nsections = [{ type = \"x\" }]\n",
        "[environment]\nwater.depth = 100\n[line_types.a]\nkind = \"tube\"\n",
        "[environment]\nwater.depth = 100\n[cases.a]\nlines.x.end_a = \"fixed\"\n",
    ] {
        assert!(!validator.is_valid(&json_of(bad)), "{bad}");
    }
}

fn json_of(text: &str) -> serde_json::Value {
    let table = toml::de::DeTable::parse(text).unwrap();
    json_of_table(table.get_ref())
}

fn json_of_table(table: &toml::de::DeTable<'_>) -> serde_json::Value {
    table
        .iter()
        .map(|(key, value)| (key.get_ref().to_string(), json_of_value(value.get_ref())))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

fn json_of_value(value: &toml::de::DeValue<'_>) -> serde_json::Value {
    use toml::de::DeValue;
    match value {
        DeValue::String(text) => text.to_string().into(),
        DeValue::Integer(integer) => integer.as_str().parse::<i64>().unwrap().into(),
        DeValue::Float(float) => float.as_str().parse::<f64>().unwrap().into(),
        DeValue::Boolean(boolean) => (*boolean).into(),
        DeValue::Array(items) => items
            .iter()
            .map(|item| json_of_value(item.get_ref()))
            .collect(),
        DeValue::Table(table) => json_of_table(table),
        DeValue::Datetime(_) => panic!("no example has a date"),
    }
}

/// Separates the guide from the reference in `docs/model-file.md`.
const MARKER: &str = "<!-- Below: written by `UPDATE_DOCS=1 cargo test -p catenix-model`. -->\n";

#[test]
fn the_reference_page_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-file.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (guide, reference) = page.split_once(MARKER).expect("the page has the marker");
    let expected = format!("\n{}", reference_markdown().trim_end().to_owned() + "\n");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, format!("{guide}{MARKER}{expected}")).unwrap();
    } else {
        assert!(
            reference == expected,
            "run `UPDATE_DOCS=1 cargo test -p catenix-model`"
        );
    }
}

#[test]
fn snippets_of_the_guide_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-file.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let snippets: Vec<&str> = page
        .split("```toml\n")
        .skip(1)
        .map(|rest| rest.split_once("```").unwrap().0)
        .collect();
    assert!(!snippets.is_empty());
    let first = snippets[0];
    for (index, snippet) in snippets.iter().enumerate() {
        // The first snippet is a whole model; the others add to it.
        let text = if index == 0 {
            first.to_owned()
        } else {
            format!("{first}\n{snippet}")
        };
        if let Err(errors) = parse_study(&text, "guide.toml", path.parent().unwrap()) {
            panic!("{snippet}\n{:#?}", errors.diagnostics);
        }
    }
}
