//! The order in which the frames of a chain are eliminated, and the blocks that this takes.

use crate::block::Block6;
use crate::chains::{BlockMatrix, Chain};

/// Elimination order of a chain: from the end without a junction, if there is one, since a
/// junction at the near end fills a border column all along the chain.
pub(crate) struct Order {
    first: usize,
    len: usize,
    reversed: bool,
    /// Junction before the first frame.
    pub(crate) near: Option<usize>,
    /// Junction behind the last frame.
    pub(crate) far: Option<usize>,
}

impl Order {
    pub(crate) fn of(chain: &Chain) -> Order {
        let reversed = chain.head.is_some() && chain.tail.is_none();
        let (near, far) = if reversed {
            (chain.tail, chain.head)
        } else {
            (chain.head, chain.tail)
        };
        Order {
            first: chain.first,
            len: chain.len,
            reversed,
            near,
            far,
        }
    }

    /// Number of frames.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(crate) fn frame(&self, step: usize) -> usize {
        if self.reversed {
            self.first + self.len - 1 - step
        } else {
            self.first + step
        }
    }

    /// (frame, near junction) and (near junction, frame) of the first frame in order.
    pub(crate) fn near_blocks<'m>(&self, chain: usize, matrix: &'m BlockMatrix) -> &'m [Block6; 2] {
        if self.reversed {
            &matrix.tail[chain]
        } else {
            &matrix.head[chain]
        }
    }

    /// Blocks (k, next) and (next, k), where next is the far junction after the last frame.
    #[inline(always)]
    pub(crate) fn link<'m>(
        &self,
        step: usize,
        chain: usize,
        matrix: &'m BlockMatrix,
    ) -> (&'m Block6, &'m Block6) {
        let k = self.frame(step);
        match (self.reversed, step + 1 == self.len) {
            (false, false) => (&matrix.upper[k], &matrix.lower[k]),
            (true, false) => (&matrix.lower[k - 1], &matrix.upper[k - 1]),
            (false, true) => (&matrix.tail[chain][0], &matrix.tail[chain][1]),
            (true, true) => (&matrix.head[chain][0], &matrix.head[chain][1]),
        }
    }

    /// As [`Order::link`], with the first block to be changed.
    #[inline(always)]
    pub(crate) fn link_mut<'m>(
        &self,
        step: usize,
        chain: usize,
        matrix: &'m mut BlockMatrix,
    ) -> (&'m mut Block6, &'m Block6) {
        let k = self.frame(step);
        if step + 1 == self.len {
            let ends = if self.reversed {
                &mut matrix.head
            } else {
                &mut matrix.tail
            };
            let [out, back] = &mut ends[chain];
            return (out, back);
        }
        match self.reversed {
            false => (&mut matrix.upper[k], &matrix.lower[k]),
            true => (&mut matrix.lower[k - 1], &matrix.upper[k - 1]),
        }
    }
}
