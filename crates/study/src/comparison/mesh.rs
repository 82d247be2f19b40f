//! Finer and coarser meshes that keep the grading of the model file.

use catenix_model::{Line, Model};

/// The model with `factor` times the elements in every section, at least one.
///
/// A new node lies where the old mesh, taken as a smooth numbering of the section, has that share
/// of its elements: short elements stay short beside long ones. Attachments have their nodes again.
pub(super) fn scaled(model: &Model, factor: f64) -> Model {
    let mut model = model.clone();
    for line in &mut model.lines {
        scale(line, factor);
        line.move_nodes_to_attachments();
    }
    model
}

fn scale(line: &mut Line, factor: f64) {
    for section in &mut line.sections {
        let old = &section.element_lengths;
        let count = ((old.len() as f64 * factor).round() as usize).max(1);
        let mut ends = vec![0.0];
        for length in old {
            ends.push(ends[ends.len() - 1] + length);
        }
        let place = |k: usize| {
            let at = k as f64 * old.len() as f64 / count as f64;
            let before = (at.floor() as usize).min(old.len() - 1);
            ends[before] + (at - before as f64) * old[before]
        };
        section.element_lengths = (0..count).map(|k| place(k + 1) - place(k)).collect();
    }
}
