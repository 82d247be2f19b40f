//! One source for every processor: kernels are compiled for several instruction sets, and the best
//! that the processor has is chosen while the program runs.

use pulp::{Arch, Simd, WithSimd};

/// Work on columns of 6 numbers in `N` registers of an instruction set.
pub(crate) trait Columnwise {
    /// What it gives.
    type Output;

    /// Does the work; everything that it calls must be inlined into it.
    fn run<S: Simd, const N: usize>(self, s: S) -> Self::Output;
}

/// Chooses the registers of a column.
pub(crate) struct Columns<W>(pub(crate) W);

impl<W: Columnwise> WithSimd for Columns<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) -> W::Output {
        match S::F64_LANES {
            8 => self.0.run::<S, 1>(s),
            4 => self.0.run::<S, 2>(s),
            2 => self.0.run::<S, 3>(s),
            _ => self.0.run::<S, 6>(s),
        }
    }
}

/// Does work on columns with the best instructions of this processor.
pub(crate) fn columnwise<W: Columnwise>(work: W) -> W::Output {
    Arch::new().dispatch(Columns(work))
}

/// Calls `f` with everything that this processor can compute with: plain numbers too.
#[cfg(test)]
pub(crate) fn on_every_instruction_set<W: WithSimd>(work: impl Fn() -> W) -> Vec<W::Output> {
    let mut outputs = vec![pulp::Scalar.vectorize(work())];
    #[cfg(target_arch = "x86_64")]
    {
        outputs.extend(pulp::x86::V3::try_new().map(|s| Simd::vectorize(s, work())));
        outputs.extend(pulp::x86::V4::try_new().map(|s| Simd::vectorize(s, work())));
    }
    #[cfg(target_arch = "aarch64")]
    outputs.push(Arch::new().dispatch(work()));
    outputs
}
