//! Moments in the axes of the frames that they act on: in these, the torque about an element's axis
//! does not depend on how the element is turned.
//!
//! Source: docs/theory/solver.md, eqs. (6a) to (6c).

use catenix_numerics::{BlockMatrix, Vector3, Vector6};

/// How far frames have turned since the matrix was built.
#[derive(Debug, Clone)]
pub(super) struct OwnAxes {
    /// Blocks that are pairs of points, which have no axes.
    pairs: usize,
    /// Sum of the increments since then, (n); of none as long as `still`.
    moved: Vec<Vector6>,
    still: bool,
}

impl OwnAxes {
    pub(super) fn new(frame_count: usize, pairs: usize) -> OwnAxes {
        OwnAxes {
            pairs,
            moved: vec![Vector6::zeros(); frame_count],
            still: true,
        }
    }

    /// Makes the derivatives of moments in global axes those of moments in own axes, and
    /// out <- -residual.
    ///
    /// Source: docs/theory/solver.md, eq. (6a).
    pub(super) fn turn(
        &mut self,
        residual: &[Vector6],
        matrix: &mut BlockMatrix,
        out: &mut [Vector6],
    ) {
        self.still = true;
        let blocks = matrix.diagonal.iter_mut().zip(residual).zip(out);
        for (k, ((block, residual), out)) in blocks.enumerate() {
            *out = -residual;
            if k >= self.pairs {
                block.add_quadrant(1, 1, &moment(residual).cross_matrix());
            }
        }
    }

    /// Adds an increment that is about to be applied.
    pub(super) fn moving(&mut self, increment: &[Vector6]) {
        if std::mem::take(&mut self.still) {
            self.moved.copy_from_slice(increment);
            return;
        }
        for (moved, increment) in self.moved.iter_mut().zip(increment) {
            *moved += increment;
        }
    }

    /// out <- -residual, with its moments in the axes that the frames had at the last matrix.
    ///
    /// Source: docs/theory/solver.md, eq. (6c).
    pub(super) fn opposite(&self, residual: &[Vector6], out: &mut [Vector6]) {
        for (out, residual) in out.iter_mut().zip(residual) {
            *out = -residual;
        }
        if self.still {
            return;
        }
        let frames = out.iter_mut().zip(residual).zip(&self.moved);
        for ((out, residual), moved) in frames.skip(self.pairs) {
            let turned: Vector3 = moved.fixed_rows::<3>(3).into();
            let back = turned.cross(&moment(residual));
            let mut own = out.fixed_rows_mut::<3>(3);
            own += back;
        }
    }
}

fn moment(residual: &Vector6) -> Vector3 {
    residual.fixed_rows::<3>(3).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_numerics::{Matrix3, Topology, so3};

    const RESIDUAL: Vector6 = Vector6::new(1.0, 2.0, 3.0, 40.0, -50.0, 60.0);

    #[test]
    fn the_matrix_is_that_of_moments_in_own_axes() {
        let topology = Topology::new(vec![], 2);
        let mut matrix = BlockMatrix::zeros(&topology);
        let mut axes = OwnAxes::new(2, 1);
        let mut opposite = [Vector6::zeros(); 2];
        axes.turn(&[RESIDUAL; 2], &mut matrix, &mut opposite);
        assert_eq!(opposite, [-RESIDUAL; 2]);
        let m = moment(&RESIDUAL);
        for column in 0..3 {
            let h = 1e-6;
            let turned = |sign: f64| {
                let theta = Vector3::ith(column, h * sign);
                so3::exp(&theta).transpose() * m
            };
            let numeric = (turned(1.0) - turned(-1.0)) / (2.0 * h);
            for row in 0..3 {
                let exact = matrix.diagonal[1].at(3 + row, 3 + column);
                // Error of the difference: h^2 times the moment.
                assert!((exact - numeric[row]).abs() < 1e-8);
                assert_eq!(matrix.diagonal[0].at(3 + row, 3 + column), 0.0);
            }
        }
    }

    #[test]
    fn moments_are_turned_back_with_their_frames() {
        let theta = Vector3::new(1e-4, -2e-4, 3e-4);
        let turn = so3::exp(&theta);
        let mut moved = Vector6::zeros();
        moved.fixed_rows_mut::<3>(3).copy_from(&theta);
        let mut axes = OwnAxes::new(2, 1);
        axes.moving(&[moved; 2]);
        let mut out = [Vector6::zeros(); 2];
        axes.opposite(&[RESIDUAL; 2], &mut out);
        assert_eq!(out[0], -RESIDUAL, "points have no axes");
        let back: Matrix3 = turn.transpose();
        // To first order: what is left is half of the angle's square.
        assert!((moment(&out[1]) + back * moment(&RESIDUAL)).norm() < 1e-7 * RESIDUAL.norm());
        assert_eq!(out[1].fixed_rows::<3>(0), -RESIDUAL.fixed_rows::<3>(0));
    }
}
