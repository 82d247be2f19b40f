//! Makes the result store of a study.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use catenix_model::{Figure, IntegratorSettings, LoadCase, StepControl, Study};
use serde::{Deserialize, Serialize};

use crate::date::utc_text;
use crate::layout::{self, STORE_FORMAT, STORE_NAME};
use crate::summary::Status;
use crate::zarr::{Attributes, Group, Place, write_atomically};
use crate::{CaseRecorder, Scene, StoreError, Summary};

/// Where results come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// Version of Catenix.
    pub version: String,
    /// Model file, as given by the user.
    pub model_file: String,
    /// Text of the model file.
    pub model_text: String,
}

impl Provenance {
    /// SHA-256 of the model file's text, in hexadecimal.
    pub fn model_sha256(&self) -> String {
        use sha2::Digest;
        sha2::Sha256::digest(self.model_text.as_bytes())
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }
}

/// The result store of a study while it is computed: `<output directory>/results.zarr`.
#[derive(Debug)]
pub struct ResultStore {
    directory: PathBuf,
    path: PathBuf,
    group: Group,
    attributes: Attributes,
}

impl ResultStore {
    /// Makes the store, with every case of `cases` pending. Earlier results in the same directory
    /// are removed; a directory that holds anything else is left alone.
    pub fn create(
        directory: &Path,
        study: &Study,
        cases: &[&LoadCase],
        provenance: &Provenance,
    ) -> Result<Self, StoreError> {
        clear(directory)?;
        let mut attributes = Attributes::new();
        let mut insert = |key: &str, value: String| attributes.insert(key.into(), value.into());
        insert(layout::VERSION_KEY, provenance.version.clone());
        insert("title", study.title.clone());
        insert("note", study.note.clone());
        insert(layout::CREATED_KEY, utc_text(SystemTime::now()));
        insert("model_file", provenance.model_file.clone());
        insert("model_sha256", provenance.model_sha256());
        insert("model_text", provenance.model_text.clone());
        let figures: Vec<StoredFigure> = study.figures.iter().map(StoredFigure::from).collect();
        insert(
            layout::FIGURES_KEY,
            serde_json::to_string(&figures).unwrap_or_default(),
        );
        attributes.insert(layout::FORMAT_KEY.into(), STORE_FORMAT.into());
        attributes.insert(layout::STATUS_KEY.into(), Status::Running.word().into());
        let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        attributes.insert("case_names".into(), names.into());
        let group = Group::create(Place::folder(directory.join(STORE_NAME)), &attributes)?;
        let path = directory.join(STORE_NAME);
        Group::create(Place::folder(layout::cases_path(&path)), &Attributes::new())?;
        let store = ResultStore {
            directory: directory.to_path_buf(),
            path,
            group,
            attributes,
        };
        for case in cases {
            let place = Place::folder(store.case_path(case));
            Group::create(place, &case_attributes(case))?;
        }
        Ok(store)
    }

    /// Path of the store.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Begins a load case. Cases may be recorded on several threads at once.
    pub fn record_case(&self, case: &LoadCase) -> CaseRecorder {
        let group = Group::at(Place::staged(self.case_path(case)));
        CaseRecorder::new(group, case_attributes(case), case)
    }

    /// Marks the study as ended, and writes `summary.json` beside the store.
    pub fn finish(mut self, summary: &Summary) -> Result<PathBuf, StoreError> {
        self.attributes
            .insert(layout::STATUS_KEY.into(), summary.status.word().into());
        self.group.set_attributes(&self.attributes)?;
        let path = self.directory.join("summary.json");
        let text = serde_json::to_string_pretty(summary).unwrap_or_default();
        write_atomically(&path, text.as_bytes())?;
        Ok(path)
    }

    fn case_path(&self, case: &LoadCase) -> PathBuf {
        layout::case_path(&self.path, &case.name)
    }
}

/// A figure of the study, as kept in the store.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoredFigure {
    /// Key in the model file and stem of the file name.
    pub name: String,
    /// Title above the axes.
    pub title: String,
    /// Channel that is drawn.
    pub channel: String,
    /// Unit of the channel.
    pub unit: String,
}

impl From<&Figure> for StoredFigure {
    fn from(figure: &Figure) -> Self {
        StoredFigure {
            name: figure.name.clone(),
            title: figure.title.clone(),
            channel: figure.channel.name.clone(),
            unit: figure.channel.unit.to_owned(),
        }
    }
}

/// Removes earlier results from an output directory, after making sure that they are results.
fn clear(directory: &Path) -> Result<(), StoreError> {
    let store = directory.join(STORE_NAME);
    let not_ours = || StoreError::NotOurs {
        path: directory.to_path_buf(),
    };
    if directory.exists() && !directory.is_dir() {
        return Err(not_ours());
    }
    if store.exists() {
        // A store whose very first write was cut off has no readable zarr.json, and nothing else.
        let ours = match Group::at(Place::folder(store.clone())).attributes() {
            Ok(attributes) => attributes.contains_key(layout::FORMAT_KEY),
            Err(_) => only_partial_files(&store),
        };
        if !ours {
            return Err(not_ours());
        }
        fs::remove_dir_all(&store).map_err(|source| StoreError::write(&store, source))?;
        for old in ["summary.json", "figures", "report.html"] {
            let path = directory.join(old);
            let removed = if path.is_dir() {
                fs::remove_dir_all(&path)
            } else {
                fs::remove_file(&path)
            };
            match removed {
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                    return Err(StoreError::write(&path, source));
                }
                _ => {}
            }
        }
    } else if directory.is_dir() {
        let mut entries =
            fs::read_dir(directory).map_err(|source| StoreError::read(directory, source))?;
        if entries.next().is_some() {
            return Err(not_ours());
        }
    }
    fs::create_dir_all(directory).map_err(|source| StoreError::write(directory, source))
}

fn only_partial_files(store: &Path) -> bool {
    let Ok(entries) = fs::read_dir(store) else {
        return false;
    };
    entries
        .flatten()
        .all(|entry| entry.file_name().to_string_lossy().ends_with(".partial"))
}

/// What is known of a case before it begins: names, settings and the layout of its summary.
fn case_attributes(case: &LoadCase) -> Attributes {
    let mut attributes = Attributes::new();
    let model = &case.model;
    attributes.insert("name".into(), case.name.as_str().into());
    attributes.insert("description".into(), case.description.as_str().into());
    attributes.insert(layout::STATUS_KEY.into(), Status::Pending.word().into());
    let layout_text = serde_json::to_string(&layout::case_layout(case)).unwrap_or_default();
    attributes.insert("formulation".into(), model.formulation.word().into());
    attributes.insert(layout::LAYOUT_KEY.into(), layout_text.into());
    let scene_text = serde_json::to_string(&Scene::new(model)).unwrap_or_default();
    attributes.insert(layout::SCENE_KEY.into(), scene_text.into());
    let mut insert = |key: &str, value: f64| attributes.insert(key.to_owned(), value.into());
    if let Some(water) = model.environment.water {
        insert("water_depth_m", water.depth);
    }
    insert("output_interval_s", model.output.interval);
    insert("field_interval_s", model.output.field_interval);
    insert("statics_tolerance", model.statics.tolerance);
    insert(
        "statics_max_iterations",
        model.statics.max_iterations as f64,
    );
    if let Some(dynamics) = &model.dynamics {
        insert("duration_s", dynamics.duration);
        insert("statistics_window_s", dynamics.statistics_window);
        match dynamics.integrator {
            IntegratorSettings::GeneralisedAlpha { spectral_radius } => {
                insert("spectral_radius", spectral_radius);
            }
            IntegratorSettings::Bdf { max_order } => {
                insert("max_order", max_order as f64);
            }
            IntegratorSettings::Explicit => {}
        }
        insert("dynamics_tolerance", dynamics.tolerance);
        insert("dynamics_max_iterations", dynamics.max_iterations as f64);
        match dynamics.step {
            StepControl::Fixed(step) => {
                insert("step_s", step);
            }
            StepControl::Adaptive { accuracy, min, max } => {
                insert("step_accuracy", accuracy);
                insert("step_min_s", min);
                insert("step_max_s", max);
            }
        }
        attributes.insert("integrator".into(), dynamics.integrator.word().into());
    }
    attributes
}
