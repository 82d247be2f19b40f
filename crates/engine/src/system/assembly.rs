//! Residual and iteration matrix of the whole system.

use catenix_numerics::{Block6, BlockMatrix, TangentWeights, Vector6};

use super::frame_kernel::put_frames;
use super::frames::{self, FrameWeights};
use super::loads;
use crate::formulation::{Evaluation, Situation};

/// Evaluates everything in a situation: residual and, with `weights`, the matrix.
pub(super) fn assemble(
    at: &Situation<'_>,
    load_factors: &[f64],
    weights: Option<&TangentWeights<'_>>,
    lines: &mut dyn Evaluation,
    residual: &mut [Vector6],
    matrix: &mut BlockMatrix,
) {
    let system = at.system;
    // First the bodies, since ends of lines add to them.
    if weights.is_some() {
        matrix.head.fill([Block6::ZERO; 2]);
        matrix.tail.fill([Block6::ZERO; 2]);
    }
    put_frames(at, &system.body_batches, weights, residual, matrix);
    lines.assemble(at, weights, residual, matrix);
    for lump in &system.lumps {
        let k = lump.frame;
        let own = weights.map(|weights| FrameWeights::of(weights, k));
        let tangent = own.as_ref().map(|own| (&mut matrix.diagonal[k], own));
        let motion = frames::lump_carrier(at.state, lump);
        let add = if k < system.pair_count() {
            frames::add_point_lump
        } else {
            frames::add_lump
        };
        add(lump, &motion, &at.sea, &mut residual[k], tangent);
    }
    let loaded = weights.is_some().then_some(&mut *matrix);
    loads::add_loads(system, load_factors, at.state, residual, loaded);
}
