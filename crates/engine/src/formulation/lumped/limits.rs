//! The largest step that an explicit integrator can take.
//!
//! Source: docs/theory/lumped.md, eqs. (25) to (28).

use catenix_numerics::stability_limit;

use super::super::Situation;
use super::evaluation::LumpedEvaluation;
use super::loads::{NodeLoad, NodeProperties};

/// Smallest of the limits of all elements, each with the mass of half of itself at its ends: no
/// vibration of the whole is faster than the fastest of its parts.
pub(super) fn stable_step(own: &LumpedEvaluation, at: &Situation<'_>) -> f64 {
    let lumped = &own.lumped;
    let bed = at.sea.seabed.map_or(0.0, |bed| bed.normal_stiffness);
    let mut step = f64::INFINITY;
    for line in &lumped.lines {
        let share = |node: usize| {
            let properties = &lumped.nodes[line.nodes.start + node];
            NodeLoad::new(properties, &own.motion(line, node), &at.sea).share()
        };
        let mut wet = share(0);
        for e in 0..line.elements() {
            let (k, s) = (line.nodes.start + e, line.springs.start + e);
            let (law, state) = (&lumped.springs[s], &own.springs[s]);
            let wet_after = share(e + 1);
            // Half of the element with the lighter of its two ends' masses per metre.
            let lightest = |added: fn(&NodeProperties) -> f64| {
                let [a, b] = [(k, wet), (k + 1, wet_after)].map(|(node, wet)| {
                    let own = &lumped.nodes[node];
                    (own.mass + wet * added(own)) / own.length
                });
                0.5 * law.rest * a.min(b)
            };
            let along = lightest(|node| node.added_axial);
            let across = lightest(|node| node.added_normal);
            let axial = (2.0 * state.slope / along).sqrt();
            step = step.min(stability_limit(0.5 * law.damping * axial) / axial);

            let bend = |node: usize| {
                lumped.bends[node]
                    .as_ref()
                    .map_or(0.0, |bend| bend.initial())
            };
            let length = state.segment.length;
            let bending = bend(k).max(bend(k + 1)) / (length * length);
            let pull = state.tension.max(0.0) / length;
            let ground = 0.5 * bed * law.rest;
            let swing = (2.0 * pull + 8.0 * bending + ground) / across;
            step = step.min(2.0 / swing.sqrt());
            wet = wet_after;
        }
        for (end, held) in line.ends.iter().enumerate() {
            if let Some(tie) = held.as_ref().and_then(|held| held.tie.as_ref()) {
                let node = line.nodes.start + line.end_node(end);
                step = step.min(2.0 / (tie.stiffness / lumped.nodes[node].mass).sqrt());
            }
        }
    }
    step
}
