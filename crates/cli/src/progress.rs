//! Progress bars, one per running load case, on standard error when that is a terminal.

use std::cell::Cell;

use catenix_study::Watch;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::interrupt::Interrupt;

/// The bars of all running cases.
#[derive(Debug)]
pub(crate) struct Progress {
    bars: MultiProgress,
    name_width: usize,
}

/// The bar of one case, and the way to stop it; the bar goes away with it.
#[derive(Debug)]
pub(crate) struct CaseProgress<'a> {
    bar: ProgressBar,
    in_motion: Cell<bool>,
    interrupt: &'a Interrupt,
}

impl Progress {
    /// No bars when `quiet`, or when nobody looks at a terminal.
    pub(crate) fn new(quiet: bool, case_names: impl Iterator<Item = usize>) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let name_width = case_names.max().unwrap_or(0).min(24);
        Progress {
            bars: MultiProgress::with_draw_target(target),
            name_width,
        }
    }

    /// Adds the bar of a case that begins.
    pub(crate) fn begin<'a>(&self, case: &str, interrupt: &'a Interrupt) -> CaseProgress<'a> {
        let bar = self.bars.add(ProgressBar::new(1000));
        bar.set_style(style("{prefix} {spinner} {msg}"));
        bar.set_prefix(format!("{case:<width$}", width = self.name_width));
        bar.set_message("statics");
        CaseProgress {
            bar,
            in_motion: Cell::new(false),
            interrupt,
        }
    }
}

impl Watch for CaseProgress<'_> {
    fn statics(&self, iteration: usize, residual_n: f64) {
        self.bar.set_message(format!(
            "statics: iteration {iteration}, residual {residual_n:.3e} N"
        ));
        self.bar.tick();
    }

    fn trial(&self, number: usize, elements: usize) {
        self.bar
            .set_message(format!("accuracy: trial {number} with {elements} elements"));
        self.bar.tick();
    }

    fn modes(&self, found: usize) {
        self.bar.set_message(format!("modes: {found} found"));
        self.bar.tick();
    }

    fn motion(&self, time_s: f64, duration_s: f64) {
        if !self.in_motion.replace(true) {
            self.bar
                .set_style(style("{prefix} [{bar:40}] {msg} {eta} left"));
            self.bar.reset_eta();
        }
        let fraction = if duration_s > 0.0 {
            (time_s / duration_s).clamp(0.0, 1.0)
        } else {
            1.0
        };
        self.bar.set_position((1000.0 * fraction) as u64);
        self.bar
            .set_message(format!("{time_s:.1} of {duration_s:.0} s"));
    }

    fn stop(&self) -> bool {
        self.interrupt.requested()
    }
}

impl Drop for CaseProgress<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn style(template: &str) -> ProgressStyle {
    // The templates are constants, and a test reads them.
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=> ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hidden_bar_goes_through_its_life() {
        let progress = Progress::new(true, [1].into_iter());
        let interrupt = Interrupt::default();
        let bar = progress.begin("a", &interrupt);
        bar.statics(3, 1.0);
        bar.modes(4);
        bar.motion(1.0, 0.0);
        assert!(!bar.stop());
        drop(bar);
        assert!(ProgressStyle::with_template("{prefix} [{bar:40}] {msg} {eta} left").is_ok());
        assert!(ProgressStyle::with_template("{prefix} {spinner} {msg}").is_ok());
    }
}
