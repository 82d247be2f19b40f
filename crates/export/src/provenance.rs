//! Where exported numbers come from, for the metadata of every file.

use catenix_results::StoredStudy;
use serde_json::{Map, Value, json};

use crate::contents::CaseContents;
use crate::table::Column;

/// Study, model file and load case behind a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Provenance {
    version: String,
    pairs: Vec<(&'static str, String)>,
}

impl Provenance {
    pub(crate) fn new(study: &StoredStudy, case: &CaseContents) -> Self {
        let version = study.attribute("catenix_version");
        let pairs = vec![
            ("title", study.title()),
            ("note", study.note()),
            ("case", case.name().to_owned()),
            ("description", case.description.progress.description.clone()),
            ("status", case.status().word().to_owned()),
            ("catenix_version", version.clone()),
            ("model_file", study.attribute("model_file")),
            ("model_sha256", study.attribute("model_sha256")),
        ];
        Provenance { version, pairs }
    }

    /// The program that computed the results.
    pub(crate) fn made_by(&self) -> String {
        format!("Catenix {}", self.version)
    }

    /// Keys and values, in a fixed order.
    pub(crate) fn pairs(&self) -> Vec<(&'static str, String)> {
        self.pairs.clone()
    }

    /// One of the values.
    pub(crate) fn get(&self, key: &str) -> &str {
        let pair = self.pairs.iter().find(|(name, _)| *name == key);
        pair.map_or("", |(_, value)| value.as_str())
    }

    /// A JSON document with what the columns of each file mean.
    pub(crate) fn with_tables(&self, tables: &[(String, &[Column])]) -> String {
        let mut document: Map<String, Value> = self
            .pairs
            .iter()
            .map(|(key, value)| ((*key).to_owned(), value.as_str().into()))
            .collect();
        let tables = tables
            .iter()
            .map(|(file, columns)| (file.clone(), json!(columns)));
        document.insert("tables".to_owned(), Value::Object(tables.collect()));
        serde_json::to_string_pretty(&document).unwrap_or_default() + "\n"
    }
}
