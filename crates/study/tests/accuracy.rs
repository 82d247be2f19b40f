//! Estimated errors of motions against a much finer computation.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use catenix_model::file::parse_study;
use catenix_results::{Discretisation, Provenance, ResultStore};
use catenix_study::{Equilibria, compute_case, in_parallel};

/// A pipe under a ship that moves, with a buffer at its lower end, and a slack hose from there to
/// the bottom, in a current.
const SYSTEM: &str = r#"
[environment]
water = { depth = "110 m" }

[environment.current]
profile = [{ depth = "0 m", speed = "0.6 m/s" }, { depth = "100 m", speed = "0.2 m/s" }]

[line_types.pipe]
kind = "pipe"
outer_diameter = "0.3 m"
inner_diameter = "0.26 m"

[line_types.hose]
kind = "general"
outer_diameter = "0.2 m"
mass = "40 kg/m"
axial_stiffness = "20 MN"
bending_stiffness = "20 kN m^2"

[motions.ship]
kind = "harmonic"
degree = "heave"
amplitude = "1 m"
period = "8 s"

[vessels.ship]
position = [0, 0, 0]
motions = ["ship"]

[anchors.bottom]
position = ["60 m", "10 m", "-105 m"]

[bodies.buffer]
mass = "4 t"
volume = "1 m^3"
drag_area = "4 m^2"
added_mass = "1 t"

[lines.pipe]
sections = [{ type = "pipe", length = "70 m", elements = 10 }]
end_a = { to = "ship", joint = "ball" }
end_b = { to = "buffer", joint = "ball" }

[lines.hose]
sections = [{ type = "hose", length = "90 m", elements = 10 }]
end_a = { to = "buffer", joint = "ball" }
end_b = { to = "bottom", joint = "ball" }

[dynamics]
duration = "24 s"

[output]
channels = ["hose.z@45 m"]

[cases.heave]

[cases.sway]
environment.current.heading = "90 deg"
motions.ship = { degree = "sway", amplitude = "2 m" }
"#;

#[test]
fn true_errors_of_a_motion_stay_within_twice_their_estimates() {
    let study =
        parse_study(SYSTEM, "model.toml", Path::new("")).unwrap_or_else(|e| panic!("{e:?}"));
    let directory = tempfile::tempdir().unwrap();
    let chosen = |case: usize, accuracy: f64| -> Discretisation {
        let case = &study.cases[case];
        let folder = directory.path().join(format!("{}-{accuracy}", case.name));
        let provenance = Provenance {
            version: String::new(),
            model_file: String::new(),
            model_text: SYSTEM.to_owned(),
        };
        let store = ResultStore::create(&folder, &study, &[case], &provenance).unwrap();
        let summary =
            compute_case(case, &store, Some(accuracy), &Equilibria::default(), &()).unwrap();
        assert_eq!(summary.error, None);
        summary.discretisation.unwrap()
    };
    let wanted = [
        (0, 1e-3),
        (1, 1e-3),
        (0, 0.05),
        (0, 0.01),
        (1, 0.05),
        (1, 0.01),
    ];
    let found = in_parallel(&wanted, None, |&(case, accuracy)| chosen(case, accuracy));
    let (mut count, mut exceptions) = (0, Vec::new());
    for (&(case, accuracy), coarse) in wanted.iter().zip(&found).skip(2) {
        assert!(coarse.reached, "{accuracy} is not reached");
        let truth = &found[case];
        for estimate in &coarse.estimates {
            // A range is a headline result only where it is not small.
            let mut exact = truth.estimates.iter();
            let Some(exact) = exact.find(|e| e.result == estimate.result) else {
                continue;
            };
            let error = (estimate.value - exact.value).abs() / estimate.scale;
            count += 1;
            // The finer computation has an error of its own.
            if error > 2.0 * estimate.relative() + exact.relative() {
                exceptions.push(format!(
                    "{} at {accuracy}: error {error:.1e}, estimate {:.1e}",
                    estimate.result,
                    estimate.relative()
                ));
            }
        }
    }
    assert!(count > 100, "{count}");
    assert!(
        20 * exceptions.len() <= count,
        "of {count}: {exceptions:#?}"
    );
}
