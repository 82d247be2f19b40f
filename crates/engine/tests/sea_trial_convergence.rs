//! The sea trial against itself with more elements and smaller steps.

mod common;

use common::{Run, assert_near, model_of_case, run};

const SEA_TRIAL: &str = include_str!("../../../examples/sea-trial-1km.toml");
const PIPE_SECTIONS: &str = "elements = 90 }";
const HOSE_SECTIONS: &str = r#"sections = [{ type = "hose", length = "400 m", elements = 200 }]"#;
const CASES: [&str; 3] = ["a", "b", "f"];

/// The example with one piece of its text replaced by another.
fn replaced(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "the example has changed: no '{from}'");
    text.replace(from, to)
}

fn with_elements(pipe: usize, hose: usize) -> String {
    let text = replaced(SEA_TRIAL, PIPE_SECTIONS, &format!("elements = {pipe} }}"));
    let hose = HOSE_SECTIONS.replace("200", &hose.to_string());
    replaced(&text, HOSE_SECTIONS, &hose)
}

/// The hose graded towards the buffer, the floats and the miner: elements of `fine` there and of
/// `coarse` between.
fn with_graded_hose(fine: f64, coarse: f64) -> String {
    let section = |length: f64| {
        format!(
            r#"{{ type = "hose", length = {length}, element_length = {coarse}, element_length_a = {fine}, element_length_b = {fine} }}"#
        )
    };
    let sections = [132.0, 132.0, 136.0].map(section).join(", ");
    replaced(
        SEA_TRIAL,
        HOSE_SECTIONS,
        &format!("sections = [{sections}]"),
    )
}

/// Figures that users read off the sea trial.
#[derive(Debug, Clone, Copy)]
struct Figures {
    /// Mean offset of the buffer over the last heave period (2) [m].
    offset: [f64; 2],
    /// Mean force on the miner over the last heave period (3) [N].
    force: [f64; 3],
    /// Mean effective tension of the hose at the miner over the last heave period [N].
    hose_tension: f64,
    /// Smallest and largest vertical force on the ship [N].
    top_force: [f64; 2],
    /// Smallest and largest effective tension at the ship [N].
    top_tension: [f64; 2],
}

impl Figures {
    fn read(run: &Run) -> Figures {
        let last = run.time[run.time.len() - 1] - 8.0 + 0.01;
        let mean = |channel: &str| run.mean_since(channel, last);
        let (low, high) = run.range_since("lift_pipe.end_a.force_z", 0.0);
        let tension = run.range_since("lift_pipe.end_a.effective_tension", 0.0);
        Figures {
            offset: [mean("buffer.offset_x"), mean("buffer.offset_y")],
            force: ["x", "y", "z"].map(|axis| mean(&format!("hose.end_b.force_{axis}"))),
            hose_tension: mean("hose.end_b.effective_tension"),
            top_force: [-high, -low],
            top_tension: tension.into(),
        }
    }
}

/// Runs each text for each case, two at a time: (n_texts x n_cases).
fn figures(texts: &[String]) -> Vec<Vec<Figures>> {
    let jobs: Vec<(usize, &str)> = (0..texts.len())
        .flat_map(|text| CASES.map(|case| (text, case)))
        .collect();
    let next = std::sync::atomic::AtomicUsize::new(0);
    let found = std::sync::Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(&(text, case)) =
                    jobs.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed))
                {
                    let run = run(&model_of_case(&texts[text], case));
                    let mut found = found.lock().expect("no thread has failed");
                    found.push(((text, case), Figures::read(&run)));
                }
            });
        }
    });
    let mut found = found.into_inner().expect("no thread has failed");
    found.sort_by_key(|(job, _)| *job);
    let figures: Vec<Figures> = found.into_iter().map(|(_, figures)| figures).collect();
    figures
        .chunks(CASES.len())
        .map(<[Figures]>::to_vec)
        .collect()
}

fn assert_ranges(what: &str, found: &Figures, fine: &Figures) {
    for (what, found, fine) in [
        (format!("{what} top force"), found.top_force, fine.top_force),
        (
            format!("{what} top tension"),
            found.top_tension,
            fine.top_tension,
        ),
    ] {
        for k in 0..2 {
            assert_near(&what, found[k], fine[k], 0.01 * fine[k]);
        }
    }
}

#[test]
fn half_the_elements_keep_offsets_and_tensions() {
    let results = figures(&[with_elements(45, 100), with_elements(180, 400)]);
    for (k, case) in CASES.iter().enumerate() {
        let (coarse, fine) = (&results[0][k], &results[1][k]);
        for axis in 0..2 {
            // The goal of the project; a buffer offset is read to the decimetre.
            assert_near(case, coarse.offset[axis], fine.offset[axis], 0.4);
        }
        assert_ranges(case, coarse, fine);
    }
}

#[test]
fn graded_sections_settle_the_end_forces_of_the_hose() {
    let results = figures(&[with_graded_hose(0.25, 2.0), with_graded_hose(0.125, 1.0)]);
    for (k, case) in CASES.iter().enumerate() {
        let (graded, fine) = (&results[0][k], &results[1][k]);
        for axis in 0..3 {
            // The goal of the project: the hose bends over 0.8 m at its ends and floats, which
            // elements of 0.25 m resolve.
            let tolerance = 0.02 * fine.hose_tension;
            assert_near(case, graded.force[axis], fine.force[axis], tolerance);
        }
    }
}

#[test]
fn forty_steps_per_heave_period_are_enough() {
    let step = |step: &str| {
        let text = replaced(SEA_TRIAL, "step = \"0.1 s\"", &format!("step = \"{step}\""));
        // Steps end on output times.
        replaced(
            &text,
            "\ninterval = \"0.1 s\"",
            &format!("\ninterval = \"{step}\""),
        )
    };
    let results = figures(&[step("0.2 s"), step("0.1 s")]);
    for (k, case) in CASES.iter().enumerate() {
        let (large, small) = (&results[0][k], &results[1][k]);
        for axis in 0..2 {
            // (omega h)^2 / 12 is 0.2 %, of a mean that hardly swings.
            let tolerance = 1e-3 * small.offset[0].hypot(small.offset[1]);
            assert_near(case, large.offset[axis], small.offset[axis], tolerance);
        }
        assert_ranges(case, large, small);
    }
}
