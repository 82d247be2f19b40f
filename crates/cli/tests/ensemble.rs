//! Load cases that are computed together have the results that each has alone.

mod common;

use std::fs;

use common::Bench;

const CASES: &str = r#"
[cases.strong]
environment.current.profile = [{ depth = "0 m", speed = "0.9 m/s" }]
[cases.calm]
motions.heave.amplitude = "0.2 m"
[cases.heavy]
bodies.pump.wet_weight = "18 kN"
[cases.slow]
motions.heave.period = "12 s"
"#;

#[test]
fn a_case_is_the_same_alone_and_among_others() {
    let bench = Bench::new(CASES);
    let cases = ["one", "strong", "calm", "heavy", "slow"];
    // Everything that is stored, to the last bit; processor times are attributes, and left out.
    let values = |out: &str, case: &str| {
        let store = catenix_results::StoredStudy::open(&bench.path(out)).ok()?;
        let case = store.case(case).ok()?;
        let channels = case.channel_names().ok()?;
        let histories = channels.iter().map(|name| case.channel(name).ok());
        let mut bits: Vec<u64> = Vec::new();
        for history in histories {
            bits.extend(history?.values.into_iter().map(f64::to_bits));
        }
        for quantity in catenix_model::LineQuantity::ALL {
            let run = case.run_extremes("pipe", quantity).ok()?;
            let window = case.range_graph("pipe", quantity).ok()?;
            let rest = case.static_state("pipe", quantity).ok()?;
            let all = [run.min, run.max, window.mean, window.std, rest];
            bits.extend(all.into_iter().flatten().map(f64::to_bits));
        }
        (bits.len() > 1000).then_some(bits)
    };
    for threads in ["1", "3"] {
        let arguments = ["run", "model.toml", "--out", "all", "--threads", threads];
        assert_eq!(bench.run(&arguments).0, 0);
        for case in cases {
            let arguments = ["run", "model.toml", "--out", "single", "--case", case];
            assert_eq!(bench.run(&arguments).0, 0);
            let (all, single) = (values("all", case), values("single", case));
            assert!(single.is_some() && all == single, "{case}, {threads}");
        }
    }
    let files = fs::read_dir(bench.path("all/results.zarr/cases"));
    // One file per case, and the metadata of the group.
    assert_eq!(files.map(Iterator::count).ok(), Some(cases.len() + 1));
}
