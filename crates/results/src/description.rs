//! Where a case keeps what, for readers that fetch chunks on their own: the viewer in the browser.

use std::path::Path;

use catenix_model::LineQuantity;
use serde::Serialize;

use crate::layout::{self, FIELD_ROWS_KEY, HISTORY_ROWS_KEY, RANGE_SUFFIXES, component};
use crate::scene::Scene;
use crate::store_reader::{StoredCase, rows, status, text};
use crate::zarr::{Array, Group, Place};
use crate::{CaseError, CaseSummary, Status, StoreError, StoredStudy};

/// How far a case has come.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseProgress {
    /// Name.
    pub name: String,
    /// From the model file.
    pub description: String,
    /// How far it came; `Running` also when its process was killed.
    pub status: Status,
    /// Rows of the histories that are written.
    pub history_rows: usize,
    /// Rows of the fields that are written.
    pub field_rows: usize,
    /// Planned end of the motion [s]; null for statics alone.
    pub duration_s: Option<f64>,
    /// Why the solver gave up.
    pub error: Option<CaseError>,
}

/// Everything that a case has, and where.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseDescription {
    /// How far it has come.
    #[serde(flatten)]
    pub progress: CaseProgress,
    /// What it looks like; null in stores of earlier versions.
    pub scene: Option<Scene>,
    /// Statistics window [s]; null before the end.
    pub window_s: Option<[f64; 2]>,
    /// Times of the histories; null before the static state is found.
    pub time: Option<ArrayPlace>,
    /// Histories, by name.
    pub channels: Vec<ChannelPlace>,
    /// Lines, in the order of the model file where the scene gives it.
    pub lines: Vec<LinePlace>,
}

/// An array and its chunks: files `c/0`, `c/1`, ... (`c/0/0`, `c/1/0`, ... with columns) below
/// `path`, each `chunk_rows` x `columns` little-endian floats and a CRC-32C. [`stored_file`] reads
/// them, wherever they lie.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArrayPlace {
    /// Way from the store, with forward slashes: `cases`, the case as its folder is named, and so
    /// on.
    pub path: String,
    /// `float32` or `float64`.
    pub data_type: &'static str,
    /// Rows, planned ones included.
    pub rows: usize,
    /// Values per row; null for an array with one axis.
    pub columns: Option<usize>,
    /// Rows per chunk.
    pub chunk_rows: usize,
}

/// A time history.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelPlace {
    /// Name in the model file.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// Its values.
    pub array: ArrayPlace,
}

/// A line and its fields.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinePlace {
    /// Name in the model file.
    pub name: String,
    /// Unstretched distance of the nodes from end A [m].
    pub arc_length: ArrayPlace,
    /// Times of the fields [s].
    pub field_time: ArrayPlace,
    /// What is stored along it.
    pub quantities: Vec<QuantityPlace>,
}

/// A quantity along a line.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityPlace {
    /// Name of the quantity.
    pub name: &'static str,
    /// Unit of the values.
    pub unit: &'static str,
    /// For axes.
    pub long_name: String,
    /// (times x nodes).
    pub field: ArrayPlace,
    /// Static state (nodes).
    pub static_state: Option<ArrayPlace>,
    /// Whether the range graph has been written.
    pub has_range_graph: bool,
}

impl StoredStudy {
    /// How far each case has come, in file order.
    pub fn progress(&self) -> Result<Vec<CaseProgress>, StoreError> {
        let case = |name: &String| self.case(name)?.progress();
        self.case_names().iter().map(case).collect()
    }
}

/// The first `rows` values of an array with one axis; fewer where it is shorter, and `None` where
/// there is nothing. Its chunks are small and many, so that a run can write them as it goes:
/// whoever wants the whole array would have to ask for each of them.
///
/// `store` is the study's path, `way` that of the array from there, as in [`ArrayPlace::path`].
pub fn read_vector(
    store: &Path,
    way: &[String],
    rows: usize,
) -> Result<Option<Vec<f64>>, StoreError> {
    let place = place_of(store, way)?;
    if !place.is_node() {
        return Ok(None);
    }
    let array = Array::open(place)?;
    if array.shape().columns.is_some() {
        return Err(StoreError::Damaged {
            path: store.join(way.join("/")),
            what: "the array has two axes where one is expected".to_owned(),
        });
    }
    array.read_rows(0, rows).map(Some)
}

/// A file of a case, as its folder has or would have it; `None` where there is no such file.
///
/// `store` is the study's path, `way` that of the file from there.
pub fn stored_file(store: &Path, way: &[String]) -> Result<Option<Vec<u8>>, StoreError> {
    let place = place_of(store, way)?;
    // A whole archive, for one, is no file of a case.
    if way.last().is_none_or(|name| name.ends_with(".zip")) {
        return Ok(None);
    }
    place.read()
}

/// The node or file at the end of a way, in the archive of its case where there is one.
fn place_of(store: &Path, way: &[String]) -> Result<Place, StoreError> {
    let cases = layout::cases_path(store);
    match way {
        [first, case, rest @ ..] if !rest.is_empty() && cases.ends_with(first) => {
            Ok(Place::stored(cases.join(case))?.join(&rest.join("/")))
        }
        _ => Ok(Place::folder(store.to_path_buf()).join(&way.join("/"))),
    }
}

impl StoredCase {
    /// How far the case has come.
    pub fn progress(&self) -> Result<CaseProgress, StoreError> {
        let attributes = self.group().attributes()?;
        let summary = text(&attributes, layout::SUMMARY_KEY);
        let error = serde_json::from_str::<CaseSummary>(&summary)
            .ok()
            .and_then(|summary| summary.error);
        Ok(CaseProgress {
            name: self.name().to_owned(),
            description: text(&attributes, "description"),
            status: status(&attributes),
            history_rows: rows(&attributes, HISTORY_ROWS_KEY),
            field_rows: rows(&attributes, FIELD_ROWS_KEY),
            duration_s: attributes
                .get("duration_s")
                .and_then(|value| value.as_f64()),
            error,
        })
    }

    /// Everything that the case has, and where.
    pub fn describe(&self) -> Result<CaseDescription, StoreError> {
        let progress = self.progress()?;
        let attributes = self.group().attributes()?;
        let scene: Option<Scene> = serde_json::from_str(&text(&attributes, layout::SCENE_KEY)).ok();
        let summary = text(&attributes, layout::SUMMARY_KEY);
        let window_s = serde_json::from_str::<CaseSummary>(&summary)
            .ok()
            .and_then(|summary| summary.window_s);
        let case = self.group().place();
        let mut lines = Vec::new();
        for place in layout::lines_place(case).children()? {
            if let Some(line) = self.line_place(&place)? {
                lines.push(line);
            }
        }
        lines.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(scene) = &scene {
            lines.sort_by_key(|place| scene.lines.iter().position(|l| l.name == place.name));
        }
        Ok(CaseDescription {
            progress,
            scene,
            window_s,
            time: self.optional_place(&case.join("time"))?,
            channels: self.channel_places()?,
            lines,
        })
    }

    fn channel_places(&self) -> Result<Vec<ChannelPlace>, StoreError> {
        let mut channels = Vec::new();
        for place in self.group().place().children()? {
            // The time axis and the group of the lines have no channel name; an array that is being
            // made has no metadata yet.
            let Ok(array) = Array::open(place.clone()) else {
                continue;
            };
            let name = text(array.attributes(), "channel");
            if !name.is_empty() {
                channels.push(ChannelPlace {
                    name,
                    unit: text(array.attributes(), "units"),
                    array: self.array_place(&place, &array),
                });
            }
        }
        channels.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(channels)
    }

    /// A line's arrays; `None` while they are being made.
    fn line_place(&self, line: &Place) -> Result<Option<LinePlace>, StoreError> {
        let arc_length = self.optional_place(&line.join("arc_length"))?;
        let field_time = self.optional_place(&line.join("field_time"))?;
        let (Some(arc_length), Some(field_time)) = (arc_length, field_time) else {
            return Ok(None);
        };
        let mut quantities = Vec::new();
        for quantity in LineQuantity::ALL {
            let name = quantity.name();
            let Some(field) = self.optional_place(&line.join(name))? else {
                continue;
            };
            let written = |suffix: &str| line.join(&format!("{name}_{suffix}/c/0")).is_file();
            let static_state = line.join(&format!("static_{name}"));
            quantities.push(QuantityPlace {
                name,
                unit: quantity.unit(),
                long_name: layout::long_name(quantity),
                field,
                static_state: self.optional_place(&static_state)?,
                has_range_graph: RANGE_SUFFIXES.into_iter().all(written),
            });
        }
        Ok(Some(LinePlace {
            name: text(&Group::at(line.clone()).attributes()?, "name"),
            arc_length,
            field_time,
            quantities,
        }))
    }

    fn optional_place(&self, place: &Place) -> Result<Option<ArrayPlace>, StoreError> {
        if !place.is_node() {
            return Ok(None);
        }
        let array = Array::open(place.clone())?;
        Ok(Some(self.array_place(place, &array)))
    }

    fn array_place(&self, place: &Place, array: &Array) -> ArrayPlace {
        let case = component(self.name());
        ArrayPlace {
            path: format!("cases/{case}/{}", place.inside()),
            data_type: array.kind().name(),
            rows: array.shape().rows,
            columns: array.shape().columns,
            chunk_rows: array.shape().chunk_rows,
        }
    }
}
