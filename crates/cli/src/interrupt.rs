//! Ctrl-C: the first asks the solvers to stop at the next step, the second ends the process.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::{Exit, Failure};
use crate::print;

/// Whether the user wants to stop.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interrupt {
    requested: Arc<AtomicBool>,
    /// Whether a signal needs no explanation, because nothing is being computed.
    quiet: Arc<AtomicBool>,
}

impl Interrupt {
    /// Listens to Ctrl-C, and to the signals that ask a process to end.
    pub(crate) fn listen() -> Result<Self, Failure> {
        let interrupt = Interrupt::default();
        let Interrupt { requested, quiet } = interrupt.clone();
        ctrlc::set_handler(move || {
            if requested.swap(true, Ordering::SeqCst) {
                std::process::exit(Exit::Interrupted as i32);
            }
            if !quiet.load(Ordering::SeqCst) {
                print::error("stopping at the next step; once more to stop at once");
            }
        })
        .map_err(|error| Failure::Start {
            what: "listening to Ctrl-C",
            message: error.to_string(),
        })?;
        Ok(interrupt)
    }

    /// Whether a signal has come.
    pub(crate) fn requested(&self) -> bool {
        self.requested.load(Ordering::SeqCst)
    }

    /// From now on a signal ends the waiting, and needs no words.
    pub(crate) fn computing_is_over(&self) {
        self.quiet.store(true, Ordering::SeqCst);
    }
}
