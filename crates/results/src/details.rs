//! What a report says of a stored case besides its summary: scene, settings, energies, last shape.

use catenix_model::LineQuantity;
use serde_json::Value;

use crate::layout::{self, FIELD_ROWS_KEY, HISTORY_ROWS_KEY};
use crate::scene::Scene;
use crate::store_reader::{rows, text};
use crate::{RangeGraph, StoreError, StoredCase};

/// Settings that a store keeps of each case, by their names in it.
const SETTINGS: [&str; 16] = [
    "duration_s",
    "statistics_window_s",
    "integrator",
    "spectral_radius",
    "max_order",
    "step_s",
    "step_accuracy",
    "step_min_s",
    "step_max_s",
    "dynamics_tolerance",
    "dynamics_max_iterations",
    "statics_tolerance",
    "statics_max_iterations",
    "output_interval_s",
    "field_interval_s",
    "water_depth_m",
];

/// A setting of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Name in the store; a unit is part of it.
    pub name: &'static str,
    /// Its value.
    pub value: SettingValue,
}

/// The value of a setting.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingValue {
    /// In the unit that the name carries.
    Number(f64),
    /// A word of the model file.
    Word(String),
}

impl StoredCase {
    /// Whether the static state has been found and stored.
    pub fn has_results(&self) -> Result<bool, StoreError> {
        let attributes = self.group().attributes()?;
        let lines = layout::lines_place(self.group().place());
        Ok(rows(&attributes, HISTORY_ROWS_KEY) > 0 || lines.is_node())
    }

    /// What the case looks like; `None` in stores of earlier versions.
    pub fn scene(&self) -> Result<Option<Scene>, StoreError> {
        let scene = text(&self.group().attributes()?, layout::SCENE_KEY);
        if scene.is_empty() {
            return Ok(None);
        }
        let scene = serde_json::from_str(&scene);
        scene
            .map(Some)
            .map_err(|error| self.damaged(&error.to_string()))
    }

    /// Settings of the case that the store has got.
    pub fn settings(&self) -> Result<Vec<Setting>, StoreError> {
        let attributes = self.group().attributes()?;
        let setting = |name: &&'static str| {
            let value = match attributes.get(*name)? {
                Value::String(word) => SettingValue::Word(word.clone()),
                value => SettingValue::Number(value.as_f64()?),
            };
            Some(Setting { name, value })
        };
        Ok(SETTINGS.iter().filter_map(setting).collect())
    }

    /// The energy account at the end of the motion: name with unit, such as `kinetic_j`, and value.
    pub fn energies(&self) -> Result<Vec<(String, f64)>, StoreError> {
        let attributes = self.group().attributes()?;
        let energies = attributes.iter().filter_map(|(key, value)| {
            let name = key.strip_prefix("energy_")?;
            let is_energy = name.ends_with("_j");
            is_energy.then_some((name.to_owned(), value.as_f64()?))
        });
        Ok(energies.collect())
    }

    /// The last stored row of a quantity along a line: time [s] and values (n_nodes); `None` where
    /// no row was written.
    pub fn last_row(
        &self,
        line: &str,
        quantity: LineQuantity,
    ) -> Result<Option<(f64, Vec<f64>)>, StoreError> {
        let rows = rows(&self.group().attributes()?, FIELD_ROWS_KEY);
        let Some(last) = rows.checked_sub(1) else {
            return Ok(None);
        };
        let time = self
            .line_array(line, "field_time")?
            .read_rows(last, rows)?
            .first()
            .copied();
        let values = self
            .line_array(line, quantity.name())?
            .read_rows(last, rows)?;
        Ok(time.map(|time| (time, values)))
    }

    /// Statistics of the stored rows of the last `window_s` seconds, for cases that have no range
    /// graph: they run still, or their process was killed. `None` where no row was written.
    pub fn range_graph_of_last(
        &self,
        line: &str,
        quantity: LineQuantity,
        window_s: f64,
    ) -> Result<Option<RangeGraph>, StoreError> {
        let Some((end, _)) = self.last_row(line, quantity)? else {
            return Ok(None);
        };
        let field = self.field(line, quantity, end - window_s * (1.0 + 1e-9))?;
        let nodes = field.arc_length_m.len();
        let graph = RangeGraph::from_rows(&field.times_s, &field.values, nodes);
        Ok(Some(graph))
    }
}
