//! Writes a store of any size with a made-up motion, to measure how fast it is written and viewed:
//! `cargo run --release -p catenix-results --example large_store -- DIR ELEMENTS STEPS`.
// An example that fails may do so loudly.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::path::PathBuf;

use catenix_model::{ChannelTarget, LineQuantity};
use catenix_results::{ResultStore, Sample, Status, Summary};

#[path = "../tests/common/mod.rs"]
mod common;

/// Interval of the stored steps [s].
const INTERVAL_S: f64 = 0.1;
/// Length of an element [m].
const ELEMENT_M: f64 = 0.5;

/// A line that hangs from a ship and swings in travelling waves.
struct Swing {
    step: usize,
    nodes: usize,
}

impl Sample for Swing {
    fn time(&self) -> f64 {
        self.step as f64 * INTERVAL_S
    }

    fn channel(&self, target: ChannelTarget) -> f64 {
        match target {
            ChannelTarget::BodyAngle(..) | ChannelTarget::VesselAngle(..) => 0.0,
            _ => (0.1 * self.time()).sin(),
        }
    }

    fn line_quantities(&self, _line: usize, out: &mut [f64]) {
        let length = ELEMENT_M * (self.nodes - 1) as f64;
        // One sine per node and step would take longer than the writing that is to be measured.
        let (turn, phase) = ((0.7 * self.time()).sin_cos(), 0.3 * self.time());
        for (quantity, values) in out.chunks_exact_mut(self.nodes).enumerate() {
            for (node, value) in values.iter_mut().enumerate() {
                let share = node as f64 / (self.nodes - 1) as f64;
                let wave = share * (turn.0 * (1.0 - share) + turn.1 * share * share);
                *value = match LineQuantity::ALL[quantity] {
                    LineQuantity::X => 0.2 * length * share * share + 0.05 * length * wave,
                    LineQuantity::Y => 0.03 * length * wave * (share - 0.5),
                    LineQuantity::Z => -length * share * (1.0 - 0.1 * share),
                    _ => 1e6 * (1.0 - 0.9 * share) + 1e5 * wave + phase,
                };
            }
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory, elements, steps] = arguments.as_slice() else {
        panic!("usage: large_store DIR ELEMENTS STEPS");
    };
    let (elements, steps): (usize, usize) = (elements.parse().unwrap(), steps.parse().unwrap());
    let mut study = common::study(&["large"]);
    study.figures.clear();
    let case = &mut study.cases[0];
    case.references.clear();
    let model = &mut case.model;
    model.lines[0].sections[0].element_lengths = vec![ELEMENT_M; elements];
    if let Some(water) = &mut model.environment.water {
        water.depth = ELEMENT_M * elements as f64;
    }
    model.output.interval = INTERVAL_S;
    model.output.field_interval = INTERVAL_S;
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.duration = (steps - 1) as f64 * INTERVAL_S;
    }
    let sample = |step| Swing {
        step,
        nodes: elements + 1,
    };
    let cases = [&study.cases[0]];
    let directory = PathBuf::from(directory);
    let store = ResultStore::create(&directory, &study, &cases, &common::provenance()).unwrap();
    let mut recorder = store.record_case(cases[0]);
    recorder.record_static(cases[0], &sample(0)).unwrap();
    for step in 0..steps {
        recorder.record(&sample(step)).unwrap();
    }
    let end_s = (steps - 1) as f64 * INTERVAL_S;
    let outcome = common::outcome(Status::Complete, end_s);
    let summary = recorder.finish(&outcome).unwrap();
    let mut summaries = indexmap::IndexMap::new();
    summaries.insert("large".to_owned(), summary);
    let provenance = common::provenance();
    store
        .finish(&Summary {
            catenix_version: provenance.version.clone(),
            title: study.title.clone(),
            note: study.note.clone(),
            model_file: provenance.model_file.clone(),
            model_sha256: provenance.model_sha256(),
            status: Status::Complete,
            cases: summaries,
        })
        .unwrap();
}
