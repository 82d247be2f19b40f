//! What can be measured: each section measures, and shows what it measured, in a file of its own.

use catenix_report::figure::Chart;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::context::Context;

pub(crate) mod commercial;
pub(crate) mod ensembles;
pub(crate) mod growth;
pub(crate) mod instructions;
pub(crate) mod kernels;
pub(crate) mod peers;
pub(crate) mod system;

/// Charts by the names of their files.
pub(crate) type Figures = Vec<(String, Chart)>;

/// One part of the results.
pub(crate) struct Section {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its title on the page.
    pub title: &'static str,
    /// Measures.
    pub measure: fn(&Context) -> Result<Value, String>,
    /// Tables and words about what was measured.
    pub markdown: fn(&Value) -> Result<String, String>,
    /// Figures of what was measured.
    pub charts: fn(&Value) -> Result<Figures, String>,
}

/// All sections, in the order of the page.
pub(crate) const SECTIONS: &[Section] = &[
    system::SECTION,
    peers::SECTION,
    commercial::SECTION,
    ensembles::SECTION,
    growth::SECTION,
    kernels::SECTION,
    instructions::SECTION,
];

/// Numbers as they are kept.
fn kept(data: &impl Serialize) -> Result<Value, String> {
    serde_json::to_value(data).map_err(|error| error.to_string())
}

/// Numbers as they were kept.
fn recalled<T: DeserializeOwned>(data: &Value) -> Result<T, String> {
    serde_json::from_value(data.clone())
        .map_err(|error| format!("the kept numbers are of another kind: {error}"))
}

/// For sections without figures.
fn no_charts(_: &Value) -> Result<Figures, String> {
    Ok(Vec::new())
}
