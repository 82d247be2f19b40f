//! Names in the store: which group holds what. docs/results.md is the same list for readers.

use std::path::{Path, PathBuf};

use catenix_model::{LineQuantity, LoadCase};

use crate::summarise::{CaseLayout, LineLayout, ReferenceLayout};
use crate::zarr::{Attributes, Place};

/// Format number of the stores that this version writes, and the highest that it reads.
pub const STORE_FORMAT: u64 = 2;

/// Name of the store inside an output directory.
pub const STORE_NAME: &str = "results.zarr";

pub(crate) const FORMAT_KEY: &str = "catenix_store_format";
pub(crate) const VERSION_KEY: &str = "catenix_version";
pub(crate) const STATUS_KEY: &str = "status";
pub(crate) const SUMMARY_KEY: &str = "summary_json";
pub(crate) const LAYOUT_KEY: &str = "layout_json";
pub(crate) const SCENE_KEY: &str = "scene_json";
pub(crate) const MODES_KEY: &str = "modes_json";
pub(crate) const CREATED_KEY: &str = "created";
pub(crate) const FIGURES_KEY: &str = "figures_json";
pub(crate) const HISTORY_ROWS_KEY: &str = "history_rows";
pub(crate) const FIELD_ROWS_KEY: &str = "field_rows";

/// The four arrays of a range graph, as suffixes of the quantity's name.
pub(crate) const RANGE_SUFFIXES: [&str; 4] = ["min", "mean", "max", "std"];

/// The two arrays of the extremes over the whole run, as suffixes of the quantity's name.
pub(crate) const RUN_SUFFIXES: [&str; 2] = ["run_min", "run_max"];

/// Directory of the group that holds the load cases.
pub(crate) fn cases_path(store: &Path) -> PathBuf {
    store.join("cases")
}

/// Directory of a load case's group; when the case has ended, an archive stands in its place.
pub(crate) fn case_path(store: &Path, case: &str) -> PathBuf {
    cases_path(store).join(component(case))
}

/// The group that holds a case's lines.
pub(crate) fn lines_place(case: &Place) -> Place {
    case.join("lines")
}

/// A line's group.
pub(crate) fn line_place(case: &Place, line: &str) -> Place {
    lines_place(case).join(&component(line))
}

/// The group that holds a case's natural modes.
pub(crate) fn modes_place(case: &Place) -> Place {
    case.join("modes")
}

/// A name as one component of a path: what a file system or Zarr could take for more than a name
/// is written as `%` and two hexadecimal digits, as in a URL. A name does not end as those of
/// archives do.
pub fn component(name: &str) -> String {
    let mut encoded = String::with_capacity(name.len());
    for (index, character) in name.chars().enumerate() {
        let hostile = character.is_control()
            || "/\\%:*?\"<>|".contains(character)
            || (character == '.'
                && (index == 0
                    || name == "zarr.json"
                    || name.as_bytes()[index..].eq_ignore_ascii_case(b".zip")))
            || (character == '_' && index == 0);
        if hostile {
            let mut buffer = [0; 4];
            for byte in character.encode_utf8(&mut buffer).bytes() {
                encoded.push_str(&format!("%{byte:02X}"));
            }
        } else {
            encoded.push(character);
        }
    }
    encoded
}

/// What the summary of a case needs to know, out of the case.
pub(crate) fn case_layout(case: &LoadCase) -> CaseLayout {
    let model = &case.model;
    let vessel = |index: usize| model.vessels[index].name.clone();
    CaseLayout {
        description: case.description.clone(),
        window_s: model
            .dynamics
            .as_ref()
            .map_or(0.0, |dynamics| dynamics.statistics_window),
        bodies: model
            .bodies
            .iter()
            .map(|body| (body.name.clone(), body.offset_vessel.map(vessel)))
            .collect(),
        lines: model
            .lines
            .iter()
            .map(|line| LineLayout {
                name: line.name.clone(),
                length_m: line.length(),
                elements: line.element_count(),
            })
            .collect(),
        references: case
            .references
            .iter()
            .map(|reference| ReferenceLayout {
                channel: reference.channel.name.clone(),
                statistic: reference.statistic,
                unit: reference.channel.unit.to_owned(),
                low: reference.low,
                high: reference.high,
                source: reference.source.clone(),
            })
            .collect(),
    }
}

/// Attributes of an array: unit and what it is.
pub(crate) fn array_attributes(units: &str, long_name: &str) -> Attributes {
    let mut attributes = Attributes::new();
    attributes.insert("units".into(), units.into());
    attributes.insert("long_name".into(), long_name.into());
    attributes
}

/// The name of a line quantity with spaces, for axes and `long_name`.
pub(crate) fn long_name(quantity: LineQuantity) -> String {
    match quantity {
        LineQuantity::X | LineQuantity::Y | LineQuantity::Z => {
            format!("position, global {}", quantity.name())
        }
        _ => quantity.name().replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_one_component_of_a_path() {
        assert_eq!(
            component("hose.effective_tension@120m"),
            "hose.effective_tension@120m"
        );
        assert_eq!(component("../a/b%"), "%2E.%2Fa%2Fb%25");
        assert_eq!(component("软管"), "软管");
        assert_eq!(component("zarr.json"), "zarr%2Ejson");
        assert_eq!(component("a.zip.Zip"), "a.zip%2EZip");
    }
}
