//! Reads a result store: finished, interrupted, or cut off at any moment.

use std::path::{Path, PathBuf};

use catenix_model::LineQuantity;
use serde::Serialize;
use serde_json::Value;

use crate::layout::{
    self, FORMAT_KEY, RANGE_SUFFIXES, RUN_SUFFIXES, STORE_FORMAT, STORE_NAME, component,
};
use crate::store::StoredFigure;
use crate::stored_statistics::StoredStatistics;
use crate::summarise::CaseLayout;
use crate::summary::Status;
use crate::zarr::{Array, Attributes, Group, Place};
use crate::{CaseSummary, Extremes, RangeGraph, StoreError, Summary};

/// A result store on disk, opened for reading.
#[derive(Debug)]
pub struct StoredStudy {
    path: PathBuf,
    attributes: Attributes,
    case_names: Vec<String>,
}

/// One load case of a store.
#[derive(Debug, Clone)]
pub struct StoredCase {
    group: Group,
    name: String,
}

/// A time history.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct History {
    /// Unit of the values.
    pub unit: String,
    /// Times (n) [s].
    pub times_s: Vec<f64>,
    /// Values (n).
    pub values: Vec<f64>,
}

/// A quantity along a line over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Unit of the values.
    pub unit: String,
    /// Times (n_times) [s].
    pub times_s: Vec<f64>,
    /// Unstretched distance of each node from end A (n_nodes) [m].
    pub arc_length_m: Vec<f64>,
    /// Values (n_times x n_nodes).
    pub values: Vec<f64>,
}

impl StoredStudy {
    /// Opens the store at `path`, which is a `results.zarr` or the directory that holds one.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let inside = path.join(STORE_NAME);
        let path = if inside.is_dir() {
            inside
        } else {
            path.to_path_buf()
        };
        if !path.join("zarr.json").is_file() {
            return Err(StoreError::NoStore { path });
        }
        let attributes = Group::at(Place::folder(path.clone())).attributes()?;
        let format = attributes.get(FORMAT_KEY).and_then(Value::as_u64);
        match format {
            None => return Err(StoreError::NoStore { path }),
            Some(found) if found > STORE_FORMAT => {
                return Err(StoreError::Newer {
                    path,
                    found,
                    supported: STORE_FORMAT,
                    written_by: text(&attributes, layout::VERSION_KEY),
                });
            }
            Some(_) => {}
        }
        let names = attributes.get("case_names").and_then(Value::as_array);
        let case_names: Option<Vec<String>> = names.and_then(|n| {
            n.iter()
                .map(|name| name.as_str().map(str::to_owned))
                .collect()
        });
        let case_names = case_names.ok_or_else(|| StoreError::Damaged {
            path: path.clone(),
            what: "it does not list its load cases".to_owned(),
        })?;
        Ok(StoredStudy {
            path,
            attributes,
            case_names,
        })
    }

    /// Path of the store.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names of the load cases, in file order.
    pub fn case_names(&self) -> &[String] {
        &self.case_names
    }

    /// Title of the study.
    pub fn title(&self) -> String {
        text(&self.attributes, "title")
    }

    /// The study's remark.
    pub fn note(&self) -> String {
        text(&self.attributes, "note")
    }

    /// How far the study came; `Running` also when its process was killed.
    pub fn status(&self) -> Status {
        status(&self.attributes)
    }

    /// Attributes of the study as text, empty where there is none.
    pub fn attribute(&self, key: &str) -> String {
        text(&self.attributes, key)
    }

    /// The figures that the model file asks for.
    pub fn figures(&self) -> Vec<StoredFigure> {
        serde_json::from_str(&text(&self.attributes, layout::FIGURES_KEY)).unwrap_or_default()
    }

    /// A load case.
    pub fn case(&self, name: &str) -> Result<StoredCase, StoreError> {
        if !self.case_names.iter().any(|case| case == name) {
            return Err(StoreError::UnknownCase {
                name: name.to_owned(),
                available: self.case_names.join(", "),
            });
        }
        let place = Place::stored(layout::case_path(&self.path, name))?;
        Ok(StoredCase::new(Group::at(place), name.to_owned()))
    }

    /// The summary of the study, also of one that was cut off.
    pub fn summary(&self) -> Result<Summary, StoreError> {
        let cases = self
            .case_names
            .iter()
            .map(|name| Ok((name.clone(), self.case(name)?.summary()?)))
            .collect::<Result<indexmap::IndexMap<_, _>, StoreError>>()?;
        let status = Status::from_word(&text(&self.attributes, layout::STATUS_KEY));
        Ok(Summary {
            catenix_version: text(&self.attributes, layout::VERSION_KEY),
            title: self.title(),
            note: self.note(),
            model_file: text(&self.attributes, "model_file"),
            model_sha256: text(&self.attributes, "model_sha256"),
            status: status.unwrap_or(Status::Running),
            cases,
        })
    }
}

impl StoredCase {
    pub(crate) fn new(group: Group, name: String) -> Self {
        StoredCase { group, name }
    }

    pub(crate) fn group(&self) -> &Group {
        &self.group
    }

    /// Name of the case.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How far the case came; `Running` also when its process was killed.
    pub fn status(&self) -> Result<Status, StoreError> {
        Ok(status(&self.group.attributes()?))
    }

    /// The summary of the case: as written at its end, or from what was stored until its process
    /// was killed.
    pub fn summary(&self) -> Result<CaseSummary, StoreError> {
        let attributes = self.group.attributes()?;
        if let Some(text) = attributes.get(layout::SUMMARY_KEY).and_then(Value::as_str) {
            return serde_json::from_str(text).map_err(|error| self.damaged(&error.to_string()));
        }
        let layout: CaseLayout = serde_json::from_str(&text(&attributes, layout::LAYOUT_KEY))
            .map_err(|error| self.damaged(&error.to_string()))?;
        let mut summary = CaseSummary::empty(&layout.description, status(&attributes));
        if rows(&attributes, layout::HISTORY_ROWS_KEY) > 0 {
            let statistics = self.statistics_of_last(layout.window_s)?;
            summary.window_s = statistics.window_s();
            summary.simulated_s = statistics.window_s().map(|window| window[1]);
            summary.fill(&layout, &statistics);
        }
        Ok(summary)
    }

    /// Names of the channels, sorted.
    pub fn channel_names(&self) -> Result<Vec<String>, StoreError> {
        let mut names = Vec::new();
        for place in self.group.place().children()? {
            // The time axis and the group of the lines have no channel name.
            if let Ok(array) = Array::open(place)
                && let Some(name) = array.attributes().get("channel").and_then(Value::as_str)
            {
                names.push(name.to_owned());
            }
        }
        names.sort();
        Ok(names)
    }

    /// A time history, as far as it was written.
    pub fn channel(&self, name: &str) -> Result<History, StoreError> {
        let place = self.group.place().join(&component(name));
        if !place.is_node() {
            return Err(StoreError::UnknownChannel {
                case: self.name.clone(),
                name: name.to_owned(),
                similar: self.nearest_channel(name),
            });
        }
        let array = Array::open(place)?;
        let rows = rows(&self.group.attributes()?, layout::HISTORY_ROWS_KEY);
        let times = Array::open(self.group.place().join("time"))?;
        Ok(History {
            unit: text(array.attributes(), "units"),
            times_s: times.read_rows(0, rows)?,
            values: array.read_rows(0, rows)?,
        })
    }

    /// The quantity of that name, if the line has it.
    pub fn quantity(&self, line: &str, name: &str) -> Result<LineQuantity, StoreError> {
        let known = LineQuantity::ALL.into_iter().find(|q| q.name() == name);
        let quantity = known.ok_or_else(|| StoreError::UnknownLineResult {
            case: self.name.clone(),
            line: line.to_owned(),
            quantity: name.to_owned(),
        })?;
        self.line_array(line, quantity.name())?;
        Ok(quantity)
    }

    /// Names of the lines, sorted.
    pub fn line_names(&self) -> Result<Vec<String>, StoreError> {
        let mut names = Vec::new();
        for place in layout::lines_place(self.group.place()).children()? {
            names.push(text(&Group::at(place).attributes()?, "name"));
        }
        names.sort();
        Ok(names)
    }

    /// Unstretched distance of each node of a line from end A (n_elements + 1) [m].
    pub fn arc_length_m(&self, line: &str) -> Result<Vec<f64>, StoreError> {
        self.line_array(line, "arc_length")?.read()
    }

    /// Range graph of a quantity along a line over the statistics window; there is none before the
    /// case has ended.
    pub fn range_graph(
        &self,
        line: &str,
        quantity: LineQuantity,
    ) -> Result<RangeGraph, StoreError> {
        let [min, mean, max, std] = RANGE_SUFFIXES.map(|suffix| self.curve(line, quantity, suffix));
        Ok(RangeGraph {
            min: min?,
            mean: mean?,
            max: max?,
            std: std?,
        })
    }

    /// Extremes of a quantity along a line over the whole run, of every step; there are none before
    /// the case has ended.
    pub fn run_extremes(&self, line: &str, quantity: LineQuantity) -> Result<Extremes, StoreError> {
        let [min, max] = RUN_SUFFIXES.map(|suffix| self.curve(line, quantity, suffix));
        Ok(Extremes::of(min?, max?))
    }

    /// A curve over arc length that was written at the end of the case.
    fn curve(
        &self,
        line: &str,
        quantity: LineQuantity,
        suffix: &str,
    ) -> Result<Vec<f64>, StoreError> {
        self.line_array(line, &format!("{}_{suffix}", quantity.name()))?
            .read()
    }

    /// Static state of a quantity along a line (n_elements + 1).
    pub fn static_state(&self, line: &str, quantity: LineQuantity) -> Result<Vec<f64>, StoreError> {
        self.line_array(line, &format!("static_{}", quantity.name()))?
            .read()
    }

    /// A quantity along a line, from time `from_s` [s] to the last row that was written.
    pub fn field(
        &self,
        line: &str,
        quantity: LineQuantity,
        from_s: f64,
    ) -> Result<Field, StoreError> {
        let rows = rows(&self.group.attributes()?, layout::FIELD_ROWS_KEY);
        let times = self.line_array(line, "field_time")?.read_rows(0, rows)?;
        let first = times.partition_point(|time| *time < from_s);
        let array = self.line_array(line, quantity.name())?;
        Ok(Field {
            unit: text(array.attributes(), "units"),
            times_s: times[first..].to_vec(),
            arc_length_m: self.arc_length_m(line)?,
            values: array.read_rows(first, rows)?,
        })
    }

    /// Extremes of a quantity along a line over the stored rows, of which there may be more than fit
    /// into memory at once.
    pub(crate) fn stored_extremes(
        &self,
        line: &str,
        quantity: LineQuantity,
    ) -> Result<Extremes, StoreError> {
        let nodes = self.line_array(line, quantity.name())?.shape().row_len();
        let mut extremes = Extremes::new(nodes);
        let rows = rows(&self.group.attributes()?, layout::FIELD_ROWS_KEY);
        let times = self.line_array(line, "field_time")?.read_rows(0, rows)?;
        let mut times = times.into_iter();
        self.for_each_stored_row(line, quantity, &mut |row| {
            extremes.add(times.next().unwrap_or(f64::NAN), row);
        })?;
        Ok(extremes)
    }

    /// Statistics of the stored rows: means of the last `window_s` seconds.
    pub(crate) fn statistics_of_last(
        &self,
        window_s: f64,
    ) -> Result<StoredStatistics<'_>, StoreError> {
        let rows = rows(&self.group.attributes()?, layout::HISTORY_ROWS_KEY);
        let times = Array::open(self.group.place().join("time"))?.read_rows(0, rows)?;
        Ok(StoredStatistics::new(self, &times, window_s))
    }

    pub(crate) fn line_array(&self, line: &str, name: &str) -> Result<Array, StoreError> {
        let place = layout::line_place(self.group.place(), line).join(name);
        if !place.is_node() {
            return Err(StoreError::UnknownLineResult {
                case: self.name.clone(),
                line: line.to_owned(),
                quantity: name.to_owned(),
            });
        }
        Array::open(place)
    }

    /// The channel whose name shares the longest beginning with `name`.
    fn nearest_channel(&self, name: &str) -> Option<String> {
        let shared = |other: &String| {
            other
                .chars()
                .zip(name.chars())
                .take_while(|(a, b)| a == b)
                .count()
        };
        self.channel_names()
            .ok()?
            .into_iter()
            .filter(|other| shared(other) > 0)
            .max_by_key(shared)
    }

    pub(crate) fn damaged(&self, what: &str) -> StoreError {
        StoreError::Damaged {
            path: self.group.place().path(),
            what: what.to_owned(),
        }
    }
}

pub(crate) fn status(attributes: &Attributes) -> Status {
    Status::from_word(&text(attributes, layout::STATUS_KEY)).unwrap_or(Status::Running)
}

pub(crate) fn rows(attributes: &Attributes, key: &str) -> usize {
    let rows = attributes.get(key).and_then(Value::as_u64).unwrap_or(0);
    usize::try_from(rows).unwrap_or(0)
}

pub(crate) fn text(attributes: &Attributes, key: &str) -> String {
    attributes
        .get(key)
        .and_then(Value::as_str)
        .unwrap_or_default()
        .to_owned()
}
