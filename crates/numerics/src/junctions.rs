//! Sparse block elimination over the junctions that remain when the chains are eliminated.
//!
//! The order (fewest neighbours first) and the fill are found once per topology.

use std::collections::BTreeSet;

use crate::Vector6;
use crate::block::{Block6, BlockLu};

/// Order and fill of the elimination, fixed by the topology.
#[derive(Debug, Clone)]
pub(crate) struct JunctionPattern {
    /// Junctions in elimination order.
    order: Vec<usize>,
    /// Per junction: the junctions eliminated later that it is coupled to, fill included.
    later: Vec<Vec<usize>>,
    /// Per junction: position of its first off-diagonal pair in the pair storage.
    offset: Vec<usize>,
    pair_count: usize,
}

impl JunctionPattern {
    pub(crate) fn new(count: usize, pairs: &[(usize, usize)]) -> JunctionPattern {
        let mut neighbours = vec![BTreeSet::new(); count];
        for &(a, b) in pairs {
            if a != b {
                neighbours[a].insert(b);
                neighbours[b].insert(a);
            }
        }
        let mut remaining: BTreeSet<usize> = (0..count).collect();
        let mut order = Vec::with_capacity(count);
        let mut later = vec![Vec::new(); count];
        while let Some(pivot) = remaining
            .iter()
            .copied()
            .min_by_key(|&j| neighbours[j].len())
        {
            remaining.remove(&pivot);
            let adjacent: Vec<usize> = std::mem::take(&mut neighbours[pivot]).into_iter().collect();
            for &a in &adjacent {
                neighbours[a].remove(&pivot);
                neighbours[a].extend(adjacent.iter().copied().filter(|&b| b != a));
            }
            order.push(pivot);
            later[pivot] = adjacent;
        }
        let mut pair_count = 0;
        let offset = later
            .iter()
            .map(|list| {
                let offset = pair_count;
                pair_count += list.len();
                offset
            })
            .collect();
        JunctionPattern {
            order,
            later,
            offset,
            pair_count,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.order.len()
    }

    /// Where the pair of `pivot` and the later `other` is stored.
    fn position(&self, pivot: usize, other: usize) -> Option<usize> {
        let place = self.later[pivot].iter().position(|&j| j == other)?;
        Some(self.offset[pivot] + place)
    }
}

/// Matrix and factors over the junctions.
#[derive(Debug, Clone)]
pub(crate) struct JunctionFactors {
    diagonal: Vec<Block6>,
    /// Blocks (pivot, later) and (later, pivot) for every stored pair.
    pairs: Vec<[Block6; 2]>,
    lu: Vec<BlockLu>,
}

impl JunctionFactors {
    pub(crate) fn new(pattern: &JunctionPattern) -> JunctionFactors {
        JunctionFactors {
            diagonal: vec![Block6::ZERO; pattern.len()],
            pairs: vec![[Block6::ZERO; 2]; pattern.pair_count],
            lu: vec![BlockLu::EMPTY; pattern.len()],
        }
    }

    /// Starts a new matrix: the given diagonal, no coupling.
    pub(crate) fn load(&mut self, diagonal: &[Block6]) {
        self.diagonal.copy_from_slice(diagonal);
        self.pairs.fill([Block6::ZERO; 2]);
    }

    /// Factors of the pivot blocks, one per junction.
    pub(crate) fn pivots(&self) -> &[BlockLu] {
        &self.lu
    }

    pub(crate) fn diagonal_mut(&mut self, junction: usize) -> &mut Block6 {
        &mut self.diagonal[junction]
    }

    /// Block (row, column); the pair must be in the pattern or on the diagonal.
    pub(crate) fn pair_mut(
        &mut self,
        pattern: &JunctionPattern,
        row: usize,
        column: usize,
    ) -> &mut Block6 {
        if row == column {
            return &mut self.diagonal[row];
        }
        match pattern.position(row, column) {
            Some(place) => &mut self.pairs[place][0],
            None => {
                let place = pattern.position(column, row);
                &mut self.pairs[place.expect("the pattern holds every coupled pair")][1]
            }
        }
    }

    /// Factorises in place; the error is the junction with a singular pivot.
    pub(crate) fn factorise(&mut self, pattern: &JunctionPattern) -> Result<(), usize> {
        for &pivot in &pattern.order {
            let lu = BlockLu::factorise(&self.diagonal[pivot]).map_err(|_| pivot)?;
            self.lu[pivot] = lu;
            let offset = pattern.offset[pivot];
            for place in 0..pattern.later[pivot].len() {
                lu.solve_block(&mut self.pairs[offset + place][0]);
            }
            for (place_row, &row) in pattern.later[pivot].iter().enumerate() {
                let below = self.pairs[offset + place_row][1];
                for (place_column, &column) in pattern.later[pivot].iter().enumerate() {
                    let right = self.pairs[offset + place_column][0];
                    self.pair_mut(pattern, row, column)
                        .subtract_product(&below, &right);
                }
            }
        }
        Ok(())
    }

    /// x <- A^-1 x over the junctions.
    pub(crate) fn solve(&self, pattern: &JunctionPattern, x: &mut [Vector6]) {
        for &pivot in &pattern.order {
            self.lu[pivot].solve(&mut x[pivot]);
            let solved = x[pivot];
            for (place, &row) in pattern.later[pivot].iter().enumerate() {
                self.pairs[pattern.offset[pivot] + place][1].subtract_times(&solved, &mut x[row]);
            }
        }
        for &pivot in pattern.order.iter().rev() {
            let mut value = x[pivot];
            for (place, &column) in pattern.later[pivot].iter().enumerate() {
                let pair = &self.pairs[pattern.offset[pivot] + place][0];
                pair.subtract_times(&x[column], &mut value);
            }
            x[pivot] = value;
        }
    }
}
