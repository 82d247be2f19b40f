//! Progress bars, one per running load case, on standard error when that is a terminal.

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

/// The bars of all running cases.
#[derive(Debug)]
pub(crate) struct Progress {
    bars: MultiProgress,
    name_width: usize,
}

/// The bar of one case.
#[derive(Debug)]
pub(crate) struct CaseProgress(ProgressBar);

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
    pub(crate) fn begin(&self, case: &str) -> CaseProgress {
        let bar = self.bars.add(ProgressBar::new(1000));
        bar.set_style(style("{prefix} {spinner} {msg}"));
        bar.set_prefix(format!("{case:<width$}", width = self.name_width));
        bar.set_message("statics");
        CaseProgress(bar)
    }
}

impl CaseProgress {
    /// Shows the state of the static solution.
    pub(crate) fn statics(&self, iteration: usize, residual_n: f64) {
        self.0.set_message(format!(
            "statics: iteration {iteration}, residual {residual_n:.3e} N"
        ));
        self.0.tick();
    }

    /// Turns to the motion, which ends at `duration_s`.
    pub(crate) fn begin_motion(&self) {
        self.0
            .set_style(style("{prefix} [{bar:40}] {msg} {eta} left"));
        self.0.set_message("");
        self.0.reset_eta();
    }

    /// Shows how far the motion is.
    pub(crate) fn motion(&self, time_s: f64, duration_s: f64) {
        let fraction = if duration_s > 0.0 {
            (time_s / duration_s).clamp(0.0, 1.0)
        } else {
            1.0
        };
        self.0.set_position((1000.0 * fraction) as u64);
        self.0
            .set_message(format!("{time_s:.1} of {duration_s:.0} s"));
    }

    /// Takes the bar away.
    pub(crate) fn end(&self) {
        self.0.finish_and_clear();
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
        let bar = progress.begin("a");
        bar.statics(3, 1.0);
        bar.begin_motion();
        bar.motion(1.0, 0.0);
        bar.end();
        assert!(ProgressStyle::with_template("{prefix} [{bar:40}] {msg} {eta} left").is_ok());
        assert!(ProgressStyle::with_template("{prefix} {spinner} {msg}").is_ok());
    }
}
