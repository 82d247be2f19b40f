//! The sea trial with default steps, and with the mesh and steps of a wanted accuracy, against finer
//! computations.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use catenix_model::file::parse_study;
use catenix_results::{CaseSummary, Provenance, ResultStore};
use catenix_study::{Equilibria, compute_case, in_parallel};

const SEA_TRIAL: &str = include_str!("../../../examples/sea-trial-1km.toml");
const STEP: &str = "step = \"0.1 s\"\n";

/// The example with other pieces of text in it.
fn with(replacements: &[(&str, &str)]) -> String {
    let mut text = SEA_TRIAL.to_owned();
    for (from, to) in replacements {
        assert!(text.contains(from), "the example has changed: no '{from}'");
        text = text.replace(from, to);
    }
    text
}

/// Computes one case as `catenix run` does.
fn run(text: &str, case: &str, accuracy: Option<f64>) -> CaseSummary {
    let study = parse_study(text, "model.toml", Path::new("")).unwrap_or_else(|e| panic!("{e:?}"));
    let case = study.cases.iter().find(|known| known.name == case).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let provenance = Provenance {
        version: String::new(),
        model_file: String::new(),
        model_text: text.to_owned(),
    };
    let store = ResultStore::create(directory.path(), &study, &[case], &provenance).unwrap();
    let summary = compute_case(case, &store, accuracy, &Equilibria::default(), &()).unwrap();
    assert_eq!(summary.error, None);
    summary
}

/// Offset of the buffer (2) [m], range of the tension at the ship [N], force on the miner (3) and
/// tension there [N].
struct Figures {
    offset: [f64; 2],
    range: f64,
    force: [f64; 3],
    tension: f64,
}

impl Figures {
    fn of(summary: &CaseSummary) -> Figures {
        let buffer = &summary.bodies["buffer"];
        let top = summary.lines["lift_pipe"].end_a.effective_tension_n;
        let miner = &summary.lines["hose"].end_b;
        Figures {
            offset: [buffer.offset_x_m.unwrap(), buffer.offset_y_m.unwrap()],
            range: top.max - top.min,
            force: [miner.force_x_n, miner.force_y_n, miner.force_z_n].map(|force| force.mean),
            tension: miner.effective_tension_n.mean,
        }
    }

    /// Relative errors: of the offset, of the tension range, and of the force on the miner over the
    /// tension there.
    fn errors(&self, exact: &Figures) -> [f64; 3] {
        let apart = |a: &[f64], b: &[f64]| -> f64 {
            let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
            squares.sum::<f64>().sqrt()
        };
        [
            apart(&self.offset, &exact.offset) / exact.offset[0].hypot(exact.offset[1]),
            (self.range / exact.range - 1.0).abs(),
            apart(&self.force, &exact.force) / exact.tension,
        ]
    }
}

#[test]
fn default_steps_are_long_and_keep_one_per_cent_in_all_six_cases() {
    let free = with(&[(STEP, "")]);
    let fine = with(&[(STEP, "step = \"0.05 s\"\n")]);
    let cases = ["a", "b", "c", "d", "e", "f"];
    let found = in_parallel(&cases, None, |case| {
        [&free, &fine].map(|text| run(text, case, None))
    });
    for (case, [free, fine]) in cases.iter().zip(&found) {
        // Steps of 0.05 s have a hundredth of the error of those of 0.5 s, where these are smooth.
        let errors = Figures::of(free).errors(&Figures::of(fine));
        assert!(
            errors.iter().all(|error| *error < 0.01),
            "{case}: {errors:?}"
        );
        let per_second = |count: Option<usize>| count.unwrap() as f64 / free.simulated_s.unwrap();
        // Steps of 0.5 to 0.6 s, but for the first ten seconds.
        assert!(per_second(free.steps) < 2.4, "{case}: {:?}", free.steps);
        // Three iterations each, of which two with a new matrix; nearly all with the current across.
        assert!(
            per_second(free.iterations) < 7.0,
            "{case}: {:?}",
            free.iterations
        );
        assert!(per_second(free.factorisations) < 6.5, "{case}");
        assert!(free.energy_imbalance.unwrap().abs() < 1e-3, "{case}");
    }
}

#[test]
fn an_accuracy_of_one_per_cent_holds_and_is_cheap() {
    let fine = with(&[
        ("elements = 90 }", "elements = 180 }"),
        ("elements = 200 }", "elements = 400 }"),
        (STEP, "step = \"0.05 s\"\n"),
    ]);
    let jobs = ["a", "e", "f"].map(|case| [(case, false), (case, true)]);
    let found = in_parallel(jobs.as_flattened(), None, |&(case, exact)| {
        if exact {
            run(&fine, case, None)
        } else {
            run(SEA_TRIAL, case, Some(0.01))
        }
    });
    for (jobs, found) in jobs.iter().zip(found.chunks(2)) {
        let ((case, _), chosen, fine) = (jobs[0], &found[0], &found[1]);
        let discretisation = chosen.discretisation.as_ref().unwrap();
        assert!(discretisation.reached, "{case}");
        let errors = Figures::of(chosen).errors(&Figures::of(fine));
        // The finer computation has an error of its own, of some 0.1 %.
        let allowed = [0.011, 0.011, 0.02];
        for (error, allowed) in errors.iter().zip(allowed) {
            assert!(*error < allowed, "{case}: {errors:?}");
        }
        let elements = discretisation.elements as f64;
        let iterations = chosen.iterations.unwrap() as f64 / chosen.simulated_s.unwrap();
        assert!(
            elements * iterations < MOST_WORK,
            "{case}: {elements} elements, {iterations} iterations a second"
        );
    }
}

/// Elements times iterations per simulated second: 35 elements with steps of 0.6 s and three
/// iterations each are 175, and a plan that misses once and buys more is allowed for.
const MOST_WORK: f64 = 250.0;
