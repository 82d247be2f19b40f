//! The fast block solver: every chain is eliminated in vector registers, matrix and right-hand side
//! together, with pivots on the diagonal; where these are too small, the block is inverted with
//! exchange of rows. The factors take the place of the matrix.
//!
//! Source: docs/theory/solver.md, eqs. (1) to (4), (9) and (10).

use pulp::Simd;

use crate::block::{Block6, BlockLu};
use crate::chains::{BlockMatrix, FactorError, Factorisation, Topology};
use crate::column::{self, Column};
use crate::dispatch::{Columnwise, columnwise};
use crate::junctions::JunctionFactors;
use crate::order::Order;
use crate::{Chain, Vector6};

/// What a junction at the near end of a chain adds for each frame.
#[derive(Debug, Clone, Copy)]
struct BorderFactors {
    /// D^-1 E towards the near junction.
    solved: Block6,
    /// The near junction's row in this frame's column.
    row: Block6,
}

impl BorderFactors {
    const ZERO: BorderFactors = BorderFactors {
        solved: Block6::ZERO,
        row: Block6::ZERO,
    };
}

/// Eliminates a [`BlockMatrix`] in place, with what does not fit there. Of each frame of a chain the
/// matrix then holds D^-1 in place of the diagonal block, D^-1 U in place of the block that couples
/// it to the next one in elimination order, and the block that couples the next one back as it was.
#[derive(Debug, Clone)]
pub struct Elimination {
    /// Per chain: one entry per frame where its near end is at a junction, else none; none before
    /// the first factorisation.
    borders: Vec<Vec<BorderFactors>>,
    junctions: JunctionFactors,
    /// The pivoted factors, where rows are always exchanged.
    careful: Option<Box<Factorisation>>,
}

impl Elimination {
    /// Room for the elimination of matrices on `topology`.
    pub fn new(topology: &Topology) -> Elimination {
        Elimination {
            borders: vec![Vec::new(); topology.chains().len()],
            junctions: JunctionFactors::new(topology.junctions()),
            careful: None,
        }
    }

    /// Gives back memory until the next factorisation.
    pub fn rest(&mut self) {
        self.borders.fill(Vec::new());
    }

    /// Exchanges rows from now on, always: for matrices that may be nearly singular, where the
    /// inverses of blocks lose digits that their factors keep. These factors have a place of their
    /// own, and matrices stay as they are.
    pub fn exchange_rows(&mut self, topology: &Topology) {
        self.careful = Some(Box::new(Factorisation::new(topology)));
    }

    /// Factorises `matrix` in place and solves for a first right-hand side: x <- A^-1 x,
    /// (frame_count).
    ///
    /// # Errors
    /// [`FactorError`] with the frame whose pivot block is singular.
    pub fn factorise_and_solve(
        &mut self,
        topology: &Topology,
        matrix: &mut BlockMatrix,
        x: &mut [Vector6],
    ) -> Result<(), FactorError> {
        let base = topology.chain_frames();
        if let Some(pivoted) = &mut self.careful {
            pivoted.factorise(topology, matrix)?;
            pivoted.solve(topology, x);
            return Ok(());
        }
        self.junctions.load(&matrix.diagonal[base..]);
        for (chain, border) in topology.chains().iter().zip(&mut self.borders) {
            let len = Order::of(chain).near.map_or(0, |_| chain.len);
            border.resize(len, BorderFactors::ZERO);
        }
        columnwise(Forward {
            factors: &mut *self,
            topology,
            matrix: &mut *matrix,
            x: &mut *x,
        })?;
        let pattern = topology.junctions();
        let singular = |junction| FactorError {
            frame: base + junction,
        };
        self.junctions.factorise(pattern).map_err(singular)?;
        self.junctions.solve(pattern, &mut x[base..]);
        columnwise(Backward {
            factors: self,
            topology,
            matrix,
            x,
        });
        Ok(())
    }

    /// x <- A^-1 x with the factors that `matrix` holds since it was factorised.
    pub fn solve(&mut self, topology: &Topology, matrix: &BlockMatrix, x: &mut [Vector6]) {
        if let Some(pivoted) = &mut self.careful {
            pivoted.solve(topology, x);
            return;
        }
        columnwise(Again {
            factors: self,
            topology,
            matrix,
            x,
        });
        let base = topology.chain_frames();
        self.junctions.solve(topology.junctions(), &mut x[base..]);
        columnwise(Backward {
            factors: self,
            topology,
            matrix,
            x,
        });
    }
}

/// The inverse of a block with exchange of rows, if it has one.
#[cold]
#[inline(never)]
fn inverse_with_exchange(block: &Block6) -> Option<Block6> {
    let lu = BlockLu::factorise(block).ok()?;
    let mut inverse = Block6::ZERO;
    (0..6).for_each(|k| inverse.add_diagonal(k, 1.0));
    lu.solve_block(&mut inverse);
    Some(inverse)
}

/// Six numbers with idle lanes behind them.
type Six = [f64; 8];

#[inline(always)]
fn six(x: &Vector6) -> Six {
    let mut room = [0.0; 8];
    room[..6].copy_from_slice(x.as_slice());
    room
}

/// x <- column
#[inline(always)]
fn put<S: Simd, const N: usize>(column: Column<S, N>, x: &mut Vector6) {
    let mut room = [0.0; 8];
    column.write(&mut room);
    x.as_mut_slice().copy_from_slice(&room[..6]);
}

/// A chain on the way through its elimination.
struct Sweep<S: Simd, const N: usize> {
    chain: usize,
    order: Order,
    step: usize,
    /// What is left of the diagonal block of the frame at `step`.
    pivot: [Column<S, N>; 6],
    /// What is left of its right-hand side.
    rhs: Six,
    /// Columns of the near junction in its row, and the junction's row in its column.
    border: Option<[Block6; 2]>,
    /// The frame whose block is singular, if one is.
    singular: Option<usize>,
}

impl<S: Simd, const N: usize> Sweep<S, N> {
    #[inline(always)]
    fn new(s: S, topology: &Topology, chain: usize, matrix: &BlockMatrix, x: &[Vector6]) -> Self {
        let own: &Chain = &topology.chains()[chain];
        let order = Order::of(own);
        let first = order.frame(0);
        Sweep {
            chain,
            step: 0,
            pivot: Column::all_of_block(s, &matrix.diagonal[first]),
            rhs: six(&x[first]),
            border: order.near.map(|_| *order.near_blocks(chain, matrix)),
            order,
            singular: None,
        }
    }

    /// Eliminates one frame; false when there is none left, or its block is singular.
    #[inline(always)]
    fn advance(
        &mut self,
        s: S,
        base: usize,
        factors: &mut Elimination,
        matrix: &mut BlockMatrix,
        x: &mut [Vector6],
    ) -> bool {
        if self.step == self.order.len() {
            return false;
        }
        let k = self.order.frame(self.step);
        let (mut inverse, safe) = column::invert(s, self.pivot);
        if !safe {
            let mut block = Block6::ZERO;
            Column::write_block(s, &self.pivot, &mut block);
            let Some(found) = inverse_with_exchange(&block) else {
                self.singular = Some(k);
                return false;
            };
            inverse = Column::all_of_block(s, &found);
        }
        Column::write_block(s, &inverse, &mut matrix.diagonal[k]);
        let value = column::times_six(s, &inverse, &self.rhs);
        let mut solved = [0.0; 8];
        value.write(&mut solved);
        put(value, &mut x[k]);
        self.step += 1;
        let last = self.step == self.order.len();
        if last && self.order.far.is_none() && self.border.is_none() {
            return false;
        }
        let (ahead_block, back_block) = self.order.link_mut(self.step - 1, self.chain, matrix);
        column::multiply(s, &inverse, ahead_block);
        let back = Column::all_of_block(s, back_block);
        if let (Some(border), Some(near)) = (&mut self.border, self.order.near) {
            let kept = &mut factors.borders[self.chain][self.step - 1];
            [kept.solved, kept.row] = *border;
            column::multiply(s, &inverse, &mut kept.solved);
            let row = Column::<S, N>::all_of_block(s, &kept.row);
            let diagonal = factors.junctions.diagonal_mut(near - base);
            column::subtract_product(s, diagonal, &row, &kept.solved);
            let left = Column::read(&six(&x[near]));
            put(column::minus_six(s, left, &row, &solved), &mut x[near]);
            *border = [Block6::ZERO; 2];
            column::subtract_product(s, &mut border[0], &back, &kept.solved);
            column::subtract_product(s, &mut border[1], &row, ahead_block);
        }
        if last {
            return false;
        }
        let next = self.order.frame(self.step);
        let diagonal = &matrix.diagonal[next];
        let (ahead_block, _) = self.order.link(self.step - 1, self.chain, matrix);
        let mut j = 0;
        while j < 6 {
            let from = Column::of_block(s, diagonal, j);
            self.pivot[j] = column::minus_six(s, from, &back, ahead_block.column(j));
            j += 1;
        }
        column::minus_six(s, Column::read(&six(&x[next])), &back, &solved).write(&mut self.rhs);
        true
    }
}

/// The first pass: all chains are eliminated, and the junctions get what comes of it.
struct Forward<'a> {
    factors: &'a mut Elimination,
    topology: &'a Topology,
    matrix: &'a mut BlockMatrix,
    x: &'a mut [Vector6],
}

impl Columnwise for Forward<'_> {
    type Output = Result<(), FactorError>;

    #[inline(always)]
    fn run<S: Simd, const N: usize>(self, s: S) -> Result<(), FactorError> {
        let Forward {
            factors,
            topology,
            matrix,
            x,
        } = self;
        let base = topology.chain_frames();
        for chain in 0..topology.chains().len() {
            let mut sweep = Sweep::<S, N>::new(s, topology, chain, matrix, x);
            while sweep.advance(s, base, factors, matrix, x) {}
            if let Some(frame) = sweep.singular {
                return Err(FactorError { frame });
            }
            factors.reach_far(topology, chain, matrix, x);
        }
        Ok(())
    }
}

impl Elimination {
    /// What the last frame of a chain leaves to the junction behind it.
    fn reach_far(
        &mut self,
        topology: &Topology,
        chain: usize,
        matrix: &BlockMatrix,
        x: &mut [Vector6],
    ) {
        let order = Order::of(&topology.chains()[chain]);
        let Some(far) = order.far else { return };
        let base = topology.chain_frames();
        let last = order.frame(order.len() - 1);
        let (ahead, back) = order.link(order.len() - 1, chain, matrix);
        let last_part = x[last];
        back.subtract_times(&last_part, &mut x[far]);
        self.junctions
            .diagonal_mut(far - base)
            .subtract_product(back, ahead);
        if let (Some(near), Some(border)) = (order.near, self.borders[chain].last()) {
            let (near, far) = (near - base, far - base);
            let pattern = topology.junctions();
            let pair = self.junctions.pair_mut(pattern, near, far);
            pair.subtract_product(&border.row, ahead);
            let pair = self.junctions.pair_mut(pattern, far, near);
            pair.subtract_product(back, &border.solved);
        }
    }
}

/// The first pass for another right-hand side.
struct Again<'a> {
    factors: &'a Elimination,
    topology: &'a Topology,
    matrix: &'a BlockMatrix,
    x: &'a mut [Vector6],
}

impl Columnwise for Again<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const N: usize>(self, s: S) {
        let Again {
            factors,
            topology,
            matrix,
            x,
        } = self;
        for (index, (chain, border)) in topology.chains().iter().zip(&factors.borders).enumerate() {
            let order = Order::of(chain);
            let mut rhs = six(&x[order.frame(0)]);
            for step in 0..chain.len {
                let k = order.frame(step);
                let inverse = Column::<S, N>::all_of_block(s, &matrix.diagonal[k]);
                let value = column::times_six(s, &inverse, &rhs);
                let mut solved = [0.0; 8];
                value.write(&mut solved);
                put(value, &mut x[k]);
                if let (Some(border), Some(near)) = (border.get(step), order.near) {
                    let row = Column::<S, N>::all_of_block(s, &border.row);
                    let left = Column::read(&six(&x[near]));
                    put(column::minus_six(s, left, &row, &solved), &mut x[near]);
                }
                let next = if step + 1 < chain.len {
                    order.frame(step + 1)
                } else if let Some(far) = order.far {
                    far
                } else {
                    continue;
                };
                let back = Column::<S, N>::all_of_block(s, order.link(step, index, matrix).1);
                let left = Column::read(&six(&x[next]));
                let value = column::minus_six(s, left, &back, &solved);
                value.write(&mut rhs);
                if step + 1 == chain.len {
                    put(value, &mut x[next]);
                }
            }
        }
    }
}

/// The last pass: from the junctions back through the chains.
struct Backward<'a> {
    factors: &'a Elimination,
    topology: &'a Topology,
    matrix: &'a BlockMatrix,
    x: &'a mut [Vector6],
}

impl Columnwise for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const N: usize>(self, s: S) {
        let Backward {
            factors,
            topology,
            matrix,
            x,
        } = self;
        for (index, (chain, border)) in topology.chains().iter().zip(&factors.borders).enumerate() {
            let order = Order::of(chain);
            let mut next = order.far.map_or([0.0; 8], |far| six(&x[far]));
            for step in (0..chain.len).rev() {
                let k = order.frame(step);
                let mut value = Column::<S, N>::read(&six(&x[k]));
                if step + 1 < chain.len || order.far.is_some() {
                    let ahead = Column::all_of_block(s, order.link(step, index, matrix).0);
                    value = column::minus_six(s, value, &ahead, &next);
                }
                if let (Some(border), Some(near)) = (border.get(step), order.near) {
                    let solved = Column::all_of_block(s, &border.solved);
                    value = column::minus_six(s, value, &solved, &six(&x[near]));
                }
                value.write(&mut next);
                put(value, &mut x[k]);
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
        let mut factors = matrix.clone();
        elimination
            .factorise_and_solve(&topology, &mut factors, &mut x)
            .unwrap();
        check(&x);
        x.copy_from_slice(&rhs);
        elimination.solve(&topology, &factors, &mut x);
        check(&x);
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
        let mut x = vec![Vector6::repeat(1.0); 2];
        let error = Elimination::new(&topology)
            .factorise_and_solve(&topology, &mut matrix, &mut x)
            .unwrap_err();
        assert_eq!(error.frame, 1);
    }
}
