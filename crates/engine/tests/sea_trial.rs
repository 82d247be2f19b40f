//! The six cases of the 1 km sea trial against the published numbers and three other codes.
//!
//! Input and references: examples/sea-trial-1km.toml. The paper (Li et al. 2011, section 4) does
//! not print the pipe, hose and hydrodynamic data; the input was calibrated on its numbers.

mod common;

use common::{Run, assert_near, model_of_case, run};

const SEA_TRIAL: &str = include_str!("../../../examples/sea-trial-1km.toml");

/// Mean of a channel over the last heave period.
fn mean(run: &Run, channel: &str) -> f64 {
    run.mean_since(channel, run.time[run.time.len() - 1] - 8.0 + 0.05)
}

struct Reference {
    case: &'static str,
    /// Published buffer x-offset [m].
    offset: Option<f64>,
    /// Published force on the miner, x [N].
    force: Option<f64>,
    /// Range of three codes: buffer x-offset [m].
    offsets: [f64; 2],
    /// Range of three codes: force on the miner, x and z [kN].
    forces: [[f64; 2]; 2],
    /// Mean of the three codes: smallest and largest vertical force at the top [kN].
    top: [f64; 2],
}

/// Rigid segments, EXUDYN's ANCF cable and MoorDyn, 90 + 200 elements, on this input.
const REFERENCES: [Reference; 6] = [
    Reference {
        case: "a",
        offset: Some(-22.5),
        force: Some(4031.0),
        offsets: [-22.9, -22.6],
        forces: [[4.14, 4.43], [18.9, 18.9]],
        top: [741.0, 1558.0],
    },
    Reference {
        case: "b",
        offset: None,
        force: Some(500.0),
        offsets: [-36.0, -35.8],
        forces: [[0.38, 0.62], [18.5, 18.5]],
        top: [741.0, 1557.0],
    },
    Reference {
        case: "c",
        offset: Some(-51.0),
        force: Some(-4133.0),
        offsets: [-51.6, -51.4],
        forces: [[-3.88, -3.66], [17.9, 18.0]],
        top: [740.0, 1556.0],
    },
    Reference {
        case: "d",
        offset: Some(-61.9),
        force: Some(-7789.0),
        offsets: [-61.9, -61.7],
        forces: [[-7.84, -7.63], [17.1, 17.1]],
        top: [740.0, 1557.0],
    },
    Reference {
        case: "e",
        offset: Some(-78.5),
        force: None,
        offsets: [-78.8, -78.5],
        forces: [[-12.0, -11.9], [16.0, 16.0]],
        top: [738.0, 1555.0],
    },
    Reference {
        case: "f",
        offset: Some(-96.2),
        force: None,
        offsets: [-96.2, -96.0],
        forces: [[-16.1, -16.0], [15.0, 15.0]],
        top: [734.0, 1552.0],
    },
];

fn assert_between(what: &str, found: f64, [low, high]: [f64; 2], tolerance: f64) {
    let nearest = found.clamp(low, high);
    assert_near(what, found, nearest, tolerance);
}

#[test]
fn val_li_2011_sea_trial() {
    let results: Vec<(Reference, Run)> = std::thread::scope(|scope| {
        let handles: Vec<_> = REFERENCES
            .into_iter()
            .map(|reference| {
                scope.spawn(|| {
                    let run = run(&model_of_case(SEA_TRIAL, reference.case));
                    (reference, run)
                })
            })
            .collect();
        handles
            .into_iter()
            .map(|handle| handle.join().expect("the case runs"))
            .collect()
    });
    for (reference, run) in results {
        let case = reference.case;
        let duration = if "abc".contains(case) { 320.0 } else { 160.0 };
        run.assert_sound(duration, 1e-3);
        let offset = mean(&run, "buffer.offset_x");
        let force = ["x", "z"].map(|axis| mean(&run, &format!("hose.end_b.force_{axis}")));
        let (low, high) = run.range_since("lift_pipe.end_a.force_z", 0.0);
        // The tolerances are those of the project's goal: half a per cent of the hose's reach for
        // the published numbers, to which the input was calibrated; between codes the spread of
        // their discretisations, since none of them resolves the bends of the hose at 2 m.
        if let Some(published) = reference.offset {
            assert_near(&format!("{case} offset"), offset, published, 1.0);
        }
        if let Some(published) = reference.force {
            assert_near(&format!("{case} force"), force[0], published, 500.0);
        }
        assert_between(
            &format!("{case} offset, codes"),
            offset,
            reference.offsets,
            0.4,
        );
        for (k, range) in reference.forces.into_iter().enumerate() {
            let range = range.map(|kilonewton| kilonewton * 1e3);
            assert_between(&format!("{case} force {k}, codes"), force[k], range, 400.0);
        }
        let [smallest, largest] = reference.top.map(|kilonewton| kilonewton * 1e3);
        assert_near(
            &format!("{case} least top"),
            -high,
            smallest,
            0.01 * smallest,
        );
        assert_near(&format!("{case} most top"), -low, largest, 0.01 * largest);
    }
}
