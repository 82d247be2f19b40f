//! The fast block solver: every chain is eliminated in vector registers, matrix and right-hand side
//! together, with pivots on the diagonal. Where these are too small it falls back on the solver that
//! exchanges rows ([`Factorisation`]).
//!
//! Source: docs/theory/solver.md, eqs. (1) to (4), (9) and (10).

use pulp::Simd;

use crate::block::Block6;
use crate::chains::{BlockMatrix, FactorError, Factorisation, Order, Topology};
use crate::column::{self, Column, Columns, ROOM};
use crate::dispatch::{Columnwise, columnwise};
use crate::junctions::JunctionFactors;
use crate::{Chain, Vector6};

/// What later right-hand sides need of one frame.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct FrameFactors {
    /// D^-1.
    inverse: Columns,
    /// D^-1 U towards the next frame in elimination order (towards the far junction at the end).
    ahead: Columns,
    /// The block that couples the next row back to this frame.
    back: Columns,
}

/// What a junction at the near end of a chain adds for each frame.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct BorderFactors {
    /// D^-1 E towards the near junction.
    solved: Columns,
    /// The near junction's row in this frame's column.
    row: Columns,
}

const NO_COLUMNS: Columns = [0.0; ROOM];

/// Factors of a [`BlockMatrix`], with room that is reused from one elimination to the next.
#[derive(Debug, Clone)]
pub struct Elimination {
    frames: Vec<FrameFactors>,
    /// Per chain: one entry per frame where its near end is at a junction, else none.
    borders: Vec<Vec<BorderFactors>>,
    junctions: JunctionFactors,
    /// The pivoted factors, once they were needed, and whether they are the last ones.
    pivoted: Option<Box<Factorisation>>,
    fell_back: bool,
    /// Whether rows are always exchanged.
    careful: bool,
}

impl Elimination {
    /// Room for the factors of matrices on `topology`.
    pub fn new(topology: &Topology) -> Elimination {
        let border = BorderFactors {
            solved: NO_COLUMNS,
            row: NO_COLUMNS,
        };
        let borders = topology.chains().iter().map(|chain| {
            let len = Order::of(chain).near.map_or(0, |_| chain.len);
            vec![border; len]
        });
        let frame = FrameFactors {
            inverse: NO_COLUMNS,
            ahead: NO_COLUMNS,
            back: NO_COLUMNS,
        };
        Elimination {
            frames: vec![frame; topology.chain_frames()],
            borders: borders.collect(),
            junctions: JunctionFactors::new(topology.junctions()),
            pivoted: None,
            fell_back: false,
            careful: false,
        }
    }

    /// Exchanges rows from now on, always: for matrices that may be nearly singular, where the
    /// inverses of blocks lose digits that their factors keep.
    pub fn exchange_rows(&mut self) {
        self.careful = true;
    }

    /// Factorises `matrix` and solves for a first right-hand side: x <- A^-1 rhs, both
    /// (frame_count).
    ///
    /// # Errors
    /// [`FactorError`] with the frame whose pivot block is singular.
    pub fn factorise_and_solve(
        &mut self,
        topology: &Topology,
        matrix: &BlockMatrix,
        rhs: &[Vector6],
        x: &mut [Vector6],
    ) -> Result<(), FactorError> {
        let base = topology.chain_frames();
        x.copy_from_slice(rhs);
        self.junctions.load(&matrix.diagonal[base..]);
        let safe = !self.careful
            && columnwise(Forward {
                factors: &mut *self,
                topology,
                matrix,
                x: &mut *x,
            });
        self.fell_back = !safe;
        if self.fell_back {
            let pivoted = self
                .pivoted
                .get_or_insert_with(|| Box::new(Factorisation::new(topology)));
            pivoted.factorise(topology, matrix)?;
            x.copy_from_slice(rhs);
            pivoted.solve(topology, x);
            return Ok(());
        }
        let pattern = topology.junctions();
        let singular = |junction| FactorError {
            frame: base + junction,
        };
        self.junctions.factorise(pattern).map_err(singular)?;
        self.junctions.solve(pattern, &mut x[base..]);
        columnwise(Backward {
            factors: self,
            topology,
            x,
        });
        Ok(())
    }

    /// x <- A^-1 x with the last factors.
    pub fn solve(&mut self, topology: &Topology, x: &mut [Vector6]) {
        if self.fell_back {
            if let Some(pivoted) = &mut self.pivoted {
                pivoted.solve(topology, x);
            }
            return;
        }
        columnwise(Again {
            factors: self,
            topology,
            x,
        });
        let base = topology.chain_frames();
        self.junctions.solve(topology.junctions(), &mut x[base..]);
        columnwise(Backward {
            factors: self,
            topology,
            x,
        });
    }
}

/// Columns of a block in memory as a block.
fn block_of(columns: &Columns) -> Block6 {
    let mut block = Block6::ZERO;
    block.0.copy_from_slice(&columns[..36]);
    block
}

/// Six numbers with idle lanes behind them.
type Six = [f64; 8];

#[inline(always)]
fn six(x: &Vector6) -> Six {
    let mut room = [0.0; 8];
    room[..6].copy_from_slice(x.as_slice());
    room
}

/// Columns that were written with [`Column::write_all`].
#[inline(always)]
fn read_all<S: Simd, const N: usize>(columns: &Columns) -> [Column<S, N>; 6] {
    std::array::from_fn(|k| Column::read(&columns[6 * k..]))
}

#[inline(always)]
fn of_block<S: Simd, const N: usize>(block: &Block6) -> [Column<S, N>; 6] {
    std::array::from_fn(|k| Column::of_block(block, k))
}

/// A chain on the way through its elimination.
struct Sweep<'m, S: Simd, const N: usize> {
    matrix: &'m BlockMatrix,
    chain: usize,
    order: Order,
    len: usize,
    step: usize,
    /// What is left of the diagonal block of the frame at `step`.
    pivot: [Column<S, N>; 6],
    /// What is left of its right-hand side.
    rhs: Six,
    /// Columns of the near junction in its row, and the junction's row in its column.
    border: Option<[Columns; 2]>,
    safe: bool,
}

impl<'m, S: Simd, const N: usize> Sweep<'m, S, N> {
    #[inline(always)]
    fn new(topology: &Topology, chain: usize, matrix: &'m BlockMatrix, x: &[Vector6]) -> Self {
        let own: &Chain = &topology.chains()[chain];
        let order = Order::of(own);
        let first = order.frame(0);
        let border = order.near.map(|_| {
            let mut border = [NO_COLUMNS; 2];
            for (columns, block) in border.iter_mut().zip(order.near_blocks(chain, matrix)) {
                columns[..36].copy_from_slice(&block.0);
            }
            border
        });
        Sweep {
            matrix,
            chain,
            len: own.len,
            step: 0,
            pivot: of_block(&matrix.diagonal[first]),
            rhs: six(&x[first]),
            order,
            border,
            safe: true,
        }
    }

    /// Eliminates one frame; false when there is none left, or a pivot was too small.
    #[inline(always)]
    fn advance(&mut self, s: S, base: usize, factors: &mut Elimination, x: &mut [Vector6]) -> bool {
        if self.step == self.len || !self.safe {
            return false;
        }
        let k = self.order.frame(self.step);
        let own = &mut factors.frames[k];
        let (inverse, safe) = column::invert(s, self.pivot);
        self.safe = safe;
        Column::write_all(&inverse, &mut own.inverse);
        let mut solved = [0.0; 8];
        column::times_six(s, &inverse, &self.rhs).write(&mut solved);
        x[k].as_mut_slice().copy_from_slice(&solved[..6]);
        self.step += 1;
        let last = self.step == self.len;
        if last && self.order.far.is_none() && self.border.is_none() {
            return false;
        }
        let (ahead_block, back_block) = self.order.link(self.step - 1, self.chain, self.matrix);
        for j in 0..6 {
            let ahead = column::times_six(s, &inverse, ahead_block.column(j));
            ahead.write(&mut own.ahead[6 * j..]);
        }
        let back = of_block(back_block);
        Column::write_all(&back, &mut own.back);
        if let (Some(border), Some(near)) = (&mut self.border, self.order.near) {
            let kept = &mut factors.borders[self.chain][self.step - 1];
            kept.row = border[1];
            for j in 0..6 {
                let column = column::times_six(s, &inverse, &border[0][6 * j..]);
                column.write(&mut kept.solved[6 * j..]);
            }
            let diagonal = factors.junctions.diagonal_mut(near - base);
            diagonal.subtract_product(&block_of(&kept.row), &block_of(&kept.solved));
            let own_part = x[k];
            block_of(&kept.row).subtract_times(&own_part, &mut x[near]);
            let (zero, row) = (Column::splat(s, 0.0), read_all(&kept.row));
            for j in 0..6 {
                let column = column::minus_six(s, zero, &back, &kept.solved[6 * j..]);
                column.write(&mut border[0][6 * j..]);
                let column = column::minus_six(s, zero, &row, &own.ahead[6 * j..]);
                column.write(&mut border[1][6 * j..]);
            }
        }
        if last {
            return false;
        }
        let next = self.order.frame(self.step);
        let diagonal = &self.matrix.diagonal[next];
        for (j, pivot) in self.pivot.iter_mut().enumerate() {
            let from = Column::of_block(diagonal, j);
            *pivot = column::minus_six(s, from, &back, &own.ahead[6 * j..]);
        }
        column::minus_six(s, Column::read(&six(&x[next])), &back, &solved).write(&mut self.rhs);
        true
    }
}

/// The first pass: all chains are eliminated, and the junctions get what comes of it.
struct Forward<'a> {
    factors: &'a mut Elimination,
    topology: &'a Topology,
    matrix: &'a BlockMatrix,
    x: &'a mut [Vector6],
}

impl Columnwise for Forward<'_> {
    /// Whether all pivots were large enough.
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd, const N: usize>(self, s: S) -> bool {
        let Forward {
            factors,
            topology,
            matrix,
            x,
        } = self;
        let base = topology.chain_frames();
        for chain in 0..topology.chains().len() {
            let mut sweep = Sweep::<S, N>::new(topology, chain, matrix, x);
            while sweep.advance(s, base, factors, x) {}
            if !sweep.safe {
                return false;
            }
            factors.reach_far(topology, chain, x);
        }
        true
    }
}

impl Elimination {
    /// What the last frame of a chain leaves to the junction behind it.
    fn reach_far(&mut self, topology: &Topology, chain: usize, x: &mut [Vector6]) {
        let order = Order::of(&topology.chains()[chain]);
        let Some(far) = order.far else { return };
        let base = topology.chain_frames();
        let last = order.frame(order.len() - 1);
        let own = &self.frames[last];
        let (ahead, back) = (block_of(&own.ahead), block_of(&own.back));
        let last_part = x[last];
        back.subtract_times(&last_part, &mut x[far]);
        self.junctions
            .diagonal_mut(far - base)
            .subtract_product(&back, &ahead);
        if let (Some(near), Some(border)) = (order.near, self.borders[chain].last()) {
            let (near, far) = (near - base, far - base);
            let pattern = topology.junctions();
            let pair = self.junctions.pair_mut(pattern, near, far);
            pair.subtract_product(&block_of(&border.row), &ahead);
            let pair = self.junctions.pair_mut(pattern, far, near);
            pair.subtract_product(&back, &block_of(&border.solved));
        }
    }
}

/// The first pass for another right-hand side.
struct Again<'a> {
    factors: &'a Elimination,
    topology: &'a Topology,
    x: &'a mut [Vector6],
}

impl Columnwise for Again<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const N: usize>(self, s: S) {
        let Again {
            factors,
            topology,
            x,
        } = self;
        for (chain, border) in topology.chains().iter().zip(&factors.borders) {
            let order = Order::of(chain);
            let mut rhs = six(&x[order.frame(0)]);
            for step in 0..chain.len {
                let k = order.frame(step);
                let own = &factors.frames[k];
                let inverse: [Column<S, N>; 6] = read_all(&own.inverse);
                let mut solved = [0.0; 8];
                column::times_six(s, &inverse, &rhs).write(&mut solved);
                x[k].as_mut_slice().copy_from_slice(&solved[..6]);
                if let (Some(border), Some(near)) = (border.get(step), order.near) {
                    let own_part = x[k];
                    block_of(&border.row).subtract_times(&own_part, &mut x[near]);
                }
                let next = if step + 1 < chain.len {
                    order.frame(step + 1)
                } else if let Some(far) = order.far {
                    far
                } else {
                    continue;
                };
                let back: [Column<S, N>; 6] = read_all(&own.back);
                let left = Column::read(&six(&x[next]));
                column::minus_six(s, left, &back, &solved).write(&mut rhs);
                if step + 1 == chain.len {
                    x[next].as_mut_slice().copy_from_slice(&rhs[..6]);
                }
            }
        }
    }
}

/// The last pass: from the junctions back through the chains.
struct Backward<'a> {
    factors: &'a Elimination,
    topology: &'a Topology,
    x: &'a mut [Vector6],
}

impl Columnwise for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const N: usize>(self, s: S) {
        let Backward {
            factors,
            topology,
            x,
        } = self;
        for (chain, border) in topology.chains().iter().zip(&factors.borders) {
            let order = Order::of(chain);
            let mut next = order.far.map_or([0.0; 8], |far| six(&x[far]));
            for step in (0..chain.len).rev() {
                let k = order.frame(step);
                let mut value = Column::<S, N>::read(&six(&x[k]));
                if step + 1 < chain.len || order.far.is_some() {
                    let ahead = read_all(&factors.frames[k].ahead);
                    value = column::minus_six(s, value, &ahead, &next);
                }
                if let (Some(border), Some(near)) = (border.get(step), order.near) {
                    let solved = read_all(&border.solved);
                    value = column::minus_six(s, value, &solved, &six(&x[near]));
                }
                value.write(&mut next);
                x[k].as_mut_slice().copy_from_slice(&next[..6]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of frames whose blocks are regular, but have no entry on their diagonal.
    #[test]
    fn blocks_without_a_diagonal_are_solved_with_exchanged_rows() {
        let chain = Chain {
            first: 0,
            len: 3,
            head: None,
            tail: None,
        };
        let topology = Topology::new(vec![chain], 3);
        let mut matrix = BlockMatrix::zeros(&topology);
        for (k, block) in matrix.diagonal.iter_mut().enumerate() {
            for row in 0..6 {
                block.0[(5 - row) + 6 * row] = 2.0 + k as f64;
            }
        }
        matrix.upper[0].add_diagonal(2, 0.5);
        matrix.lower[1].add_diagonal(3, -0.5);
        let rhs: Vec<Vector6> = (0..3).map(|k| Vector6::repeat(1.0 + k as f64)).collect();
        let mut elimination = Elimination::new(&topology);
        let check = |x: &[Vector6]| {
            let mut left = rhs.clone();
            matrix.subtract_times(&topology, x, &mut left);
            assert!(left.iter().all(|force| force.norm() < 1e-13));
        };
        let mut x = rhs.clone();
        elimination
            .factorise_and_solve(&topology, &matrix, &rhs, &mut x)
            .unwrap();
        check(&x);
        x.copy_from_slice(&rhs);
        elimination.solve(&topology, &mut x);
        check(&x);
        // A regular diagonal again: the fast way is taken again.
        for block in &mut matrix.diagonal {
            (0..6).for_each(|k| block.add_diagonal(k, 9.0));
        }
        elimination
            .factorise_and_solve(&topology, &matrix, &rhs, &mut x)
            .unwrap();
        assert!(!elimination.fell_back);
    }

    #[test]
    fn a_singular_frame_is_named() {
        let chain = Chain {
            first: 0,
            len: 2,
            head: None,
            tail: None,
        };
        let topology = Topology::new(vec![chain], 2);
        let mut matrix = BlockMatrix::zeros(&topology);
        (0..6).for_each(|k| matrix.diagonal[0].add_diagonal(k, 1.0));
        let rhs = vec![Vector6::repeat(1.0); 2];
        let mut x = rhs.clone();
        let error = Elimination::new(&topology)
            .factorise_and_solve(&topology, &matrix, &rhs, &mut x)
            .unwrap_err();
        assert_eq!(error.frame, 1);
    }
}
