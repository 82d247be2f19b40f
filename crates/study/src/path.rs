//! Follows the equilibrium path of one load case.

use std::time::Instant;

use catenix_engine::{PathEnd, PathError, PathEvent, StaticsError, System, follow_path};
use catenix_model::{LoadCase, all_channels};
use catenix_results::{CasePath, PathPointFacts, Status};
use cpu_time::ThreadTime;

use crate::case::{EngineSample, PROGRESS_INTERVAL, UNUSABLE, case_error, flow};
use crate::watch::Watch;

/// Follows the path that the case's `[path]` describes.
///
/// A path that is lost, or has no beginning, makes a failed case with the points until then.
pub fn compute_path(case: &LoadCase, watch: &dyn Watch) -> CasePath {
    let cpu = ThreadTime::now();
    let mut path = CasePath::new(case);
    follow(case, watch, &mut path);
    path.cpu_seconds = Some(cpu.elapsed().as_secs_f64());
    path
}

fn follow(case: &LoadCase, watch: &dyn Watch, path: &mut CasePath) {
    let system = match System::new(&case.model) {
        Ok(system) => system,
        Err(error) => {
            path.status = Status::Failed;
            path.error = Some(case_error(UNUSABLE, &error));
            return;
        }
    };
    let channels = all_channels(&case.model);
    let mut last_shown = Instant::now();
    let result = follow_path(
        &system,
        &mut |state| {
            if last_shown.elapsed() >= PROGRESS_INTERVAL {
                watch.statics(state.iteration, state.residual_n);
                last_shown = Instant::now();
            }
            flow(watch.stop())
        },
        &mut |point, view| {
            let facts = PathPointFacts {
                factor: point.factor,
                distance: point.distance,
                event: point.event.map(|event| match event {
                    PathEvent::Limit => "limit",
                    PathEvent::Bifurcation => "bifurcation",
                }),
                unstable: point.unstable,
                iterations: point.iterations,
                residual_n: point.residual_n,
            };
            path.push(&facts, &channels, &EngineSample(view));
            flow(watch.stop())
        },
    );
    (path.status, path.end, path.error) = match result {
        Ok(report) => match report.end {
            PathEnd::Range => (Status::Complete, Some("range"), None),
            PathEnd::Channel => (Status::Complete, Some("channel"), None),
            PathEnd::Points => (Status::Complete, Some("points"), None),
            PathEnd::Interrupted => (Status::Interrupted, None, None),
        },
        Err(PathError::Start {
            source: StaticsError::Interrupted { .. },
            ..
        }) => (Status::Interrupted, None, None),
        Err(error) => {
            let code = match &error {
                PathError::NoPath => "path::no_path",
                PathError::Start { .. } => "path::no_start",
                PathError::Lost { .. } => "path::lost",
                _ => "path::other",
            };
            (Status::Failed, None, Some(case_error(code, &error)))
        }
    };
}
