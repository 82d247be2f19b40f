//! The block solver: chains of frames, each block tridiagonal, that meet at junction frames.
//!
//! A line is a chain, a body is a junction. Each chain is eliminated from one end to the other in
//! O(n); what remains is a system over the junctions, eliminated in [`crate::junctions`].
//! Blocks are unsymmetric and pivoted inside, never across.
//!
//! Source: docs/theory/solver.md, eqs. (1) to (4).

use crate::Vector6;
use crate::block::{Block6, BlockLu};
use crate::junctions::{JunctionFactors, JunctionPattern};
use crate::order::Order;

/// A run of frames `first .. first + len`, each coupled to the next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    /// Index of the first frame.
    pub first: usize,
    /// Number of frames, at least one.
    pub len: usize,
    /// Frame index of the junction that the first frame is coupled to.
    pub head: Option<usize>,
    /// Frame index of the junction that the last frame is coupled to.
    pub tail: Option<usize>,
}

/// Which frames are coupled: chains first, then junctions.
#[derive(Debug, Clone)]
pub struct Topology {
    chains: Vec<Chain>,
    chain_frames: usize,
    junctions: JunctionPattern,
}

impl Topology {
    /// `chains` cover the frames `0 .. m` in order; the frames `m .. frame_count` are junctions.
    ///
    /// # Panics
    /// When the chains leave gaps or name a junction that does not exist (a programming error).
    pub fn new(chains: Vec<Chain>, frame_count: usize) -> Topology {
        let mut chain_frames = 0;
        for chain in &chains {
            assert!(
                chain.first == chain_frames && chain.len > 0,
                "chains must tile the frames"
            );
            chain_frames += chain.len;
        }
        let junction = |frame: usize| {
            assert!(
                frame >= chain_frames && frame < frame_count,
                "junctions follow the chains"
            );
            frame - chain_frames
        };
        let pairs: Vec<(usize, usize)> = chains
            .iter()
            .filter_map(|chain| Some((junction(chain.head?), junction(chain.tail?))))
            .collect();
        let junctions = JunctionPattern::new(frame_count - chain_frames, &pairs);
        Topology {
            chains,
            chain_frames,
            junctions,
        }
    }

    /// The chains, in frame order.
    pub fn chains(&self) -> &[Chain] {
        &self.chains
    }

    /// Number of frames of chains; the junctions follow them.
    pub(crate) fn chain_frames(&self) -> usize {
        self.chain_frames
    }

    /// Which junctions are coupled.
    pub(crate) fn junctions(&self) -> &JunctionPattern {
        &self.junctions
    }

    /// Number of frames, junctions included.
    pub fn frame_count(&self) -> usize {
        self.chain_frames + self.junctions.len()
    }
}

/// The iteration matrix on a [`Topology`].
#[derive(Debug, Clone, Default)]
pub struct BlockMatrix {
    /// Diagonal block of each frame, (frame_count).
    pub diagonal: Vec<Block6>,
    /// Block (k, k + 1) of consecutive chain frames, (frame_count).
    pub upper: Vec<Block6>,
    /// Block (k + 1, k) of consecutive chain frames, (frame_count).
    pub lower: Vec<Block6>,
    /// Per chain: block (first frame, head junction) and block (head junction, first frame).
    pub head: Vec<[Block6; 2]>,
    /// Per chain: block (last frame, tail junction) and block (tail junction, last frame).
    pub tail: Vec<[Block6; 2]>,
}

impl BlockMatrix {
    /// A zero matrix.
    pub fn zeros(topology: &Topology) -> BlockMatrix {
        let n = topology.frame_count();
        let chains = topology.chains.len();
        BlockMatrix {
            diagonal: vec![Block6::ZERO; n],
            upper: vec![Block6::ZERO; n],
            lower: vec![Block6::ZERO; n],
            head: vec![[Block6::ZERO; 2]; chains],
            tail: vec![[Block6::ZERO; 2]; chains],
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.diagonal.fill(Block6::ZERO);
        self.upper.fill(Block6::ZERO);
        self.lower.fill(Block6::ZERO);
        self.head.fill([Block6::ZERO; 2]);
        self.tail.fill([Block6::ZERO; 2]);
    }

    /// (A + A^T) / 2.
    pub fn symmetric_part(&self) -> BlockMatrix {
        let mean = |a: &Block6, b: &Block6| {
            let mut sum = a.plus(1.0, &b.transposed());
            sum.0.iter_mut().for_each(|entry| *entry *= 0.5);
            sum
        };
        let pairs = |list: &[[Block6; 2]]| -> Vec<[Block6; 2]> {
            list.iter()
                .map(|[out, back]| [mean(out, back), mean(back, out)])
                .collect()
        };
        let across = |a: &[Block6], b: &[Block6]| -> Vec<Block6> {
            a.iter().zip(b).map(|(a, b)| mean(a, b)).collect()
        };
        BlockMatrix {
            diagonal: across(&self.diagonal, &self.diagonal),
            upper: across(&self.upper, &self.lower),
            lower: across(&self.lower, &self.upper),
            head: pairs(&self.head),
            tail: pairs(&self.tail),
        }
    }

    /// self <- a + factor b, all on the same topology.
    pub fn set_sum(&mut self, a: &BlockMatrix, factor: f64, b: &BlockMatrix) {
        let sum = |out: &mut [Block6], a: &[Block6], b: &[Block6]| {
            for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                *out = a.plus(factor, b);
            }
        };
        sum(&mut self.diagonal, &a.diagonal, &b.diagonal);
        sum(&mut self.upper, &a.upper, &b.upper);
        sum(&mut self.lower, &a.lower, &b.lower);
        sum(
            self.head.as_flattened_mut(),
            a.head.as_flattened(),
            b.head.as_flattened(),
        );
        sum(
            self.tail.as_flattened_mut(),
            a.tail.as_flattened(),
            b.tail.as_flattened(),
        );
    }

    /// y <- A x
    pub fn times(&self, topology: &Topology, x: &[Vector6], y: &mut [Vector6]) {
        y.fill(Vector6::zeros());
        self.subtract_times(topology, x, y);
        y.iter_mut().for_each(|force| *force *= -1.0);
    }

    /// y <- y - A x, the residual of a solution.
    pub fn subtract_times(&self, topology: &Topology, x: &[Vector6], y: &mut [Vector6]) {
        for (k, block) in self.diagonal.iter().enumerate() {
            block.subtract_times(&x[k], &mut y[k]);
        }
        for (index, chain) in topology.chains.iter().enumerate() {
            let last = chain.first + chain.len - 1;
            for k in chain.first..last {
                self.upper[k].subtract_times(&x[k + 1], &mut y[k]);
                self.lower[k].subtract_times(&x[k], &mut y[k + 1]);
            }
            if let Some(head) = chain.head {
                self.head[index][0].subtract_times(&x[head], &mut y[chain.first]);
                self.head[index][1].subtract_times(&x[chain.first], &mut y[head]);
            }
            if let Some(tail) = chain.tail {
                self.tail[index][0].subtract_times(&x[tail], &mut y[last]);
                self.tail[index][1].subtract_times(&x[last], &mut y[tail]);
            }
        }
    }
}

/// The frame at which elimination met a singular block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FactorError {
    /// Frame index.
    pub frame: usize,
}

/// Factors of a [`BlockMatrix`], with room that is reused from one factorisation to the next.
#[derive(Debug, Clone)]
pub struct Factorisation {
    lu: Vec<BlockLu>,
    /// D^-1 U towards the next frame in elimination order (towards the far junction at the end).
    ahead: Vec<Block6>,
    /// The block that couples the next row back to this frame.
    back: Vec<Block6>,
    /// D^-1 E towards the near junction, where there is one; up to the last such frame.
    near: Vec<Block6>,
    /// The near junction's row in this frame's column; as long.
    near_row: Vec<Block6>,
    junctions: JunctionFactors,
}

impl Factorisation {
    /// Room for the factors of matrices on `topology`.
    pub fn new(topology: &Topology) -> Factorisation {
        let n = topology.chain_frames;
        let chains = topology.chains.iter();
        let bordered = chains.filter(|chain| Order::of(chain).near.is_some());
        let border = bordered.map(|chain| chain.first + chain.len).max();
        let border = vec![Block6::ZERO; border.unwrap_or(0)];
        Factorisation {
            lu: vec![BlockLu::EMPTY; n],
            ahead: vec![Block6::ZERO; n],
            back: vec![Block6::ZERO; n],
            near: border.clone(),
            near_row: border,
            junctions: JunctionFactors::new(&topology.junctions),
        }
    }

    /// Factorises `matrix`.
    ///
    /// # Errors
    /// [`FactorError`] with the frame whose pivot block is singular.
    pub fn factorise(
        &mut self,
        topology: &Topology,
        matrix: &BlockMatrix,
    ) -> Result<(), FactorError> {
        let base = topology.chain_frames;
        self.junctions.load(&matrix.diagonal[base..]);
        for index in 0..topology.chains.len() {
            self.eliminate_chain(topology, index, matrix)?;
        }
        self.junctions
            .factorise(&topology.junctions)
            .map_err(|junction| FactorError {
                frame: base + junction,
            })
    }

    fn eliminate_chain(
        &mut self,
        topology: &Topology,
        index: usize,
        matrix: &BlockMatrix,
    ) -> Result<(), FactorError> {
        let (chain, base) = (&topology.chains[index], topology.chain_frames);
        let order = Order::of(chain);
        let [mut near_column, mut near_row] = *order.near_blocks(index, matrix);
        let near = order.near.map(|frame| frame - base);
        let far = order.far.map(|frame| frame - base);
        let mut pivot_block = matrix.diagonal[order.frame(0)];
        for step in 0..chain.len {
            let k = order.frame(step);
            let lu = BlockLu::factorise(&pivot_block).map_err(|_| FactorError { frame: k })?;
            self.lu[k] = lu;
            let (&(mut ahead), &back) = order.link(step, index, matrix);
            lu.solve_block(&mut ahead);
            if let Some(near) = near {
                self.near_row[k] = near_row;
                let mut solved = near_column;
                lu.solve_block(&mut solved);
                self.junctions
                    .diagonal_mut(near)
                    .subtract_product(&near_row, &solved);
                self.near[k] = solved;
                if step + 1 < chain.len {
                    near_column = Block6::ZERO;
                    near_column.subtract_product(&back, &solved);
                    let mut next_row = Block6::ZERO;
                    next_row.subtract_product(&near_row, &ahead);
                    near_row = next_row;
                } else if let Some(far) = far {
                    let pattern = &topology.junctions;
                    let pair = self.junctions.pair_mut(pattern, near, far);
                    pair.subtract_product(&near_row, &ahead);
                    let pair = self.junctions.pair_mut(pattern, far, near);
                    pair.subtract_product(&back, &solved);
                }
            }
            if step + 1 < chain.len {
                pivot_block = matrix.diagonal[order.frame(step + 1)];
                pivot_block.subtract_product(&back, &ahead);
            } else if let Some(far) = far {
                self.junctions
                    .diagonal_mut(far)
                    .subtract_product(&back, &ahead);
            }
            self.ahead[k] = ahead;
            self.back[k] = back;
        }
        Ok(())
    }

    /// Number of negative eigenvalues of the symmetric matrix that was factorised last: a
    /// congruence takes it to its pivot blocks, so theirs are counted.
    ///
    /// Source: docs/theory/modes.md, eq. (8), and docs/theory/path.md, eq. (9).
    pub fn negative_eigenvalues(&self) -> usize {
        let pivots = self.lu.iter().chain(self.junctions.pivots());
        pivots.map(negative_eigenvalues_of).sum()
    }

    /// x <- A^-1 x with the last factors.
    pub fn solve(&mut self, topology: &Topology, x: &mut [Vector6]) {
        let base = topology.chain_frames;
        for chain in &topology.chains {
            let order = Order::of(chain);
            for step in 0..chain.len {
                let k = order.frame(step);
                self.lu[k].solve(&mut x[k]);
                let solved = x[k];
                if let Some(near) = order.near {
                    self.near_row[k].subtract_times(&solved, &mut x[near]);
                }
                if step + 1 < chain.len {
                    self.back[k].subtract_times(&solved, &mut x[order.frame(step + 1)]);
                } else if let Some(far) = order.far {
                    self.back[k].subtract_times(&solved, &mut x[far]);
                }
            }
        }
        self.junctions.solve(&topology.junctions, &mut x[base..]);
        for chain in &topology.chains {
            let order = Order::of(chain);
            for step in (0..chain.len).rev() {
                let k = order.frame(step);
                let mut value = x[k];
                if step + 1 < chain.len {
                    self.ahead[k].subtract_times(&x[order.frame(step + 1)], &mut value);
                } else if let Some(far) = order.far {
                    self.ahead[k].subtract_times(&x[far], &mut value);
                }
                if let Some(near) = order.near {
                    self.near[k].subtract_times(&x[near], &mut value);
                }
                x[k] = value;
            }
        }
    }
}

/// Negative eigenvalues of one symmetric pivot block.
fn negative_eigenvalues_of(lu: &BlockLu) -> usize {
    let block = lu.product();
    // Rows scaled alike: forces and moments have different units, and signs do not mind.
    let scale: [f64; 6] = std::array::from_fn(|row| {
        let largest = (0..6).map(|column| block.at(row, column).abs());
        1.0 / largest.fold(f64::MIN_POSITIVE, f64::max).sqrt()
    });
    let scaled = nalgebra::Matrix6::from_fn(|row, column| {
        0.5 * (block.at(row, column) + block.at(column, row)) * scale[row] * scale[column]
    });
    let eigenvalues = scaled.symmetric_eigenvalues();
    eigenvalues.iter().filter(|&&value| value < 0.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Elimination;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    /// Dense copy of a matrix, for comparison.
    fn dense(topology: &Topology, matrix: &BlockMatrix) -> DMatrix<f64> {
        let n = topology.frame_count();
        let mut a = DMatrix::zeros(6 * n, 6 * n);
        for column in 0..6 * n {
            let mut x = vec![Vector6::zeros(); n];
            let mut y = vec![Vector6::zeros(); n];
            x[column / 6][column % 6] = 1.0;
            matrix.subtract_times(topology, &x, &mut y);
            for row in 0..6 * n {
                a[(row, column)] = -y[row / 6][row % 6];
            }
        }
        a
    }

    fn random_matrix(topology: &Topology, seed: u64) -> BlockMatrix {
        let mut state = seed.wrapping_mul(2).wrapping_add(1);
        let mut random = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut matrix = BlockMatrix::zeros(topology);
        let mut fill = |block: &mut Block6| block.0.iter_mut().for_each(|entry| *entry = random());
        matrix.diagonal.iter_mut().for_each(&mut fill);
        matrix.upper.iter_mut().for_each(&mut fill);
        matrix.lower.iter_mut().for_each(&mut fill);
        matrix.head.iter_mut().flatten().for_each(&mut fill);
        matrix.tail.iter_mut().flatten().for_each(&mut fill);
        for block in &mut matrix.diagonal {
            (0..6).for_each(|k| block.add_diagonal(k, 6.0));
        }
        matrix
    }

    fn check(chains: Vec<Chain>, frame_count: usize, seed: u64) {
        let topology = Topology::new(chains, frame_count);
        let matrix = random_matrix(&topology, seed);
        let mut factors = Factorisation::new(&topology);
        factors.factorise(&topology, &matrix).unwrap();
        let rhs: Vec<Vector6> = (0..frame_count)
            .map(|k| Vector6::repeat(1.0 + k as f64))
            .collect();
        let mut x = rhs.clone();
        factors.solve(&topology, &mut x);
        let b = DVector::from_fn(6 * frame_count, |row, _| rhs[row / 6][row % 6]);
        let want = dense(&topology, &matrix).lu().solve(&b).unwrap();
        let near = |x: &[Vector6]| {
            for (k, got) in x.iter().enumerate() {
                assert!(
                    (got - want.fixed_rows::<6>(6 * k)).norm() < 1e-8,
                    "frame {k}"
                );
            }
        };
        near(&x);
        let mut fast = Elimination::new(&topology);
        let mut in_place = matrix.clone();
        x.copy_from_slice(&rhs);
        fast.factorise_and_solve(&topology, &mut in_place, &mut x)
            .unwrap();
        near(&x);
        x.copy_from_slice(&rhs);
        fast.solve(&topology, &in_place, &mut x);
        near(&x);
    }

    fn chain(first: usize, len: usize, head: Option<usize>, tail: Option<usize>) -> Chain {
        Chain {
            first,
            len,
            head,
            tail,
        }
    }

    #[test]
    fn every_kind_of_end() {
        for head in [None, Some(5)] {
            for tail in [None, Some(5), Some(6)] {
                check(vec![chain(0, 5, head, tail)], 7, 3);
                check(vec![chain(0, 1, head, tail), chain(1, 4, None, None)], 7, 4);
            }
        }
    }

    #[test]
    fn no_chain_and_no_junction() {
        check(vec![], 2, 1);
        check(vec![chain(0, 3, None, None)], 3, 1);
    }

    proptest! {
        #[test]
        fn loops_and_trees_match_a_dense_solution(
            seed in 0u64..1000,
            lengths in prop::collection::vec(1usize..4, 1..8),
            ends in prop::collection::vec((0usize..6, 0usize..6), 8),
        ) {
            let junction_count = 5;
            let frames: usize = lengths.iter().sum();
            let mut first = 0;
            let chains = lengths.iter().zip(&ends).map(|(&len, &(a, b))| {
                let end = |j: usize| (j < junction_count).then_some(frames + j);
                let chain = chain(first, len, end(a), end(b));
                first += len;
                chain
            }).collect();
            check(chains, frames + junction_count, seed);
        }
    }

    #[test]
    fn a_singular_chain_names_its_frame() {
        let topology = Topology::new(vec![chain(0, 3, None, None)], 3);
        let mut matrix = random_matrix(&topology, 1);
        matrix.diagonal[0] = Block6::ZERO;
        let error = Factorisation::new(&topology)
            .factorise(&topology, &matrix)
            .unwrap_err();
        assert_eq!(error.frame, 0);
    }
}
