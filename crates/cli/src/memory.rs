//! The memory that a computation takes.

use catenix_study::MemoryMeter;
use peak_alloc::PeakAlloc;

/// Counts what is allocated; the hot loops allocate nothing, so it costs nothing there.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// The largest memory since the last start, of the whole process.
#[derive(Debug, Default)]
pub(crate) struct PeakMemory {
    before: std::cell::Cell<usize>,
}

impl MemoryMeter for PeakMemory {
    fn begin(&self) {
        ALLOCATOR.reset_peak_usage();
        self.before.set(ALLOCATOR.current_usage());
    }

    fn peak(&self) -> Option<usize> {
        Some(ALLOCATOR.peak_usage().saturating_sub(self.before.get()))
    }
}
