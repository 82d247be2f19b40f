//! How far an export is, and whether the user wants it to end.

use std::cell::Cell;

use crate::ExportError;

/// Who looks at an export while it runs.
pub trait ExportWatch {
    /// `done` of `total` values are written; `what` is the file that is being written.
    fn progress(&self, what: &str, done: u64, total: u64);

    /// Whether to stop at the next piece.
    fn stop(&self) -> bool;
}

/// Counts the values that are written.
pub(crate) struct Meter<'a> {
    watch: &'a dyn ExportWatch,
    done: Cell<u64>,
    total: u64,
}

impl<'a> Meter<'a> {
    pub(crate) fn new(watch: &'a dyn ExportWatch, total: u64) -> Self {
        Meter {
            watch,
            done: Cell::new(0),
            total,
        }
    }

    /// Notes that `values` more are written into the file `what`; an error when the user wants an
    /// end.
    pub(crate) fn add(&self, what: &str, values: usize) -> Result<(), ExportError> {
        self.done.set(self.done.get() + values as u64);
        self.watch.progress(what, self.done.get(), self.total);
        if self.watch.stop() {
            Err(ExportError::Interrupted)
        } else {
            Ok(())
        }
    }
}
