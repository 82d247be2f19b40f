//! The store as a whole: what is written is what is read, however the run ends.

mod common;

use std::fs;

use catenix_model::LineQuantity;
use catenix_results::{ResultStore, Status, StoreError, StoredStudy};
use common::{
    DURATION_S, ELEMENTS, Moment, STEP_S, WINDOW_S, line_value, study, unpack, write_store,
};

#[test]
fn a_complete_run_reads_back_as_it_was_written() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let written = write_store(&out, &study(&["a", "b"]), DURATION_S, Status::Complete);
    let stored = StoredStudy::open(&out).unwrap();
    assert_eq!(stored.case_names(), ["a", "b"]);
    assert_eq!(stored.summary().unwrap(), written);

    let case = stored.case("b").unwrap();
    let history = case.channel("pipe.end_b.force_x").unwrap();
    assert_eq!(history.unit, "N");
    assert_eq!(history.times_s.len(), 81);
    assert_eq!(history.values[4], 2010.0);
    assert_eq!(case.line_names().unwrap(), ["pipe"]);
    assert_eq!(case.arc_length_m("pipe").unwrap(), [0.0, 10.0, 20.0, 30.0]);

    let tension = LineQuantity::EffectiveTension;
    let field = case.field("pipe", tension, 19.0).unwrap();
    assert_eq!(field.times_s, [19.0, 20.0]);
    assert_eq!(
        field.values[ELEMENTS + 1 + 2],
        line_value(tension.index(), 2, 20.0)
    );
    let graph = case.range_graph("pipe", tension).unwrap();
    assert_eq!(
        graph.min[1],
        line_value(tension.index(), 1, DURATION_S - WINDOW_S)
    );
    assert_eq!(graph.max[1], line_value(tension.index(), 1, DURATION_S));
    // A ramp of 8 s has the standard deviation 8 / sqrt(12); the trapezoidal rule on 32 steps is
    // off by a part in 32^2.
    assert!((graph.std[0] / (WINDOW_S / 12.0_f64.sqrt()) - 1.0).abs() < 1e-3);
    let run = case.run_extremes("pipe", tension).unwrap();
    assert_eq!(run.min[1], line_value(tension.index(), 1, 0.0));
    assert_eq!(run.max[1], line_value(tension.index(), 1, DURATION_S));
    assert_eq!(
        case.static_state("pipe", tension).unwrap()[3],
        line_value(tension.index(), 3, 0.0)
    );
}

#[test]
fn the_summary_reports_means_over_the_window_and_extremes_over_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let summary = write_store(dir.path(), &study(&["a"]), DURATION_S, Status::Complete);
    let case = &summary.cases["a"];
    assert_eq!(case.window_s, Some([12.0, 20.0]));
    // Mean of -10 - t over 12 to 20 s.
    assert!((case.bodies["buffer"].offset_x_m.unwrap() + 26.0).abs() < 1e-12);
    let force = case.lines["pipe"].end_b.force_x_n;
    assert_eq!((force.min, force.max), (2000.0, 2200.0));
    assert!((force.mean - 2160.0).abs() < 1e-9);
    let lowest = case.lines["pipe"].min_effective_tension_n.unwrap();
    assert_eq!((lowest.value, lowest.arc_length_m), (3000.0, 0.0));
    let highest = case.lines["pipe"].max_effective_tension_n.unwrap();
    assert_eq!((highest.value, highest.arc_length_m), (3320.0, 30.0));
    // 20 s in 0.5 s of processor time; the quarter of a second that elapsed does not matter.
    assert_eq!(case.real_time_factor, Some(40.0));
}

#[test]
fn references_are_compared_with_the_statistic_that_they_name() {
    let dir = tempfile::tempdir().unwrap();
    let summary = write_store(dir.path(), &study(&["a"]), DURATION_S, Status::Complete);
    let [mean, min, max] = summary.cases["a"].references.as_slice() else {
        panic!("three references")
    };
    // The offset is -10 - t: a mean of -26 over 12 to 20 s against a single value of -25, a minimum
    // of -30 inside its range, a maximum of -10 at the start, two above the end of its range.
    assert!((mean.difference.unwrap() + 1.0).abs() < 1e-12);
    assert_eq!((min.computed, min.difference), (Some(-30.0), Some(0.0)));
    assert_eq!((max.computed, max.difference), (Some(-10.0), Some(2.0)));

    let summary = write_store(dir.path(), &study(&["a"]), 10.0, Status::Interrupted);
    for reference in &summary.cases["a"].references {
        // Half a motion has no mean and no extremes of the whole one.
        assert_eq!((reference.computed, reference.difference), (None, None));
    }
}

#[test]
fn an_interrupted_run_reports_the_stretch_that_it_reached() {
    let dir = tempfile::tempdir().unwrap();
    let summary = write_store(dir.path(), &study(&["a"]), 10.0, Status::Interrupted);
    let case = &summary.cases["a"];
    assert_eq!(case.window_s, Some([2.0, 10.0]));
    assert!((case.bodies["buffer"].offset_x_m.unwrap() + 16.0).abs() < 1e-12);
    let force = case.lines["pipe"].end_b.force_x_n;
    assert_eq!((force.min, force.max), (2000.0, 2100.0));
    let highest = case.lines["pipe"].max_effective_tension_n.unwrap();
    assert_eq!(highest.value, 3310.0);
    let stored = StoredStudy::open(dir.path()).unwrap();
    assert_eq!(stored.summary().unwrap(), summary);
    let case = stored.case("a").unwrap();
    assert_eq!(case.status().unwrap(), Status::Interrupted);
    assert_eq!(case.channel("ship.x").unwrap().times_s.len(), 41);
}

#[test]
fn a_killed_run_keeps_what_was_flushed() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&["a", "b"]);
    let cases: Vec<_> = study.cases.iter().collect();
    let store = ResultStore::create(dir.path(), &study, &cases, &common::provenance()).unwrap();
    let mut recorder = store.record_case(&study.cases[0]);
    recorder
        .record_static(&study.cases[0], &Moment { time: 0.0 })
        .unwrap();
    for step in 0..40 {
        recorder
            .record(&Moment {
                time: f64::from(step) * STEP_S,
            })
            .unwrap();
    }
    std::thread::sleep(std::time::Duration::from_millis(2100));
    recorder.record(&Moment { time: 10.0 }).unwrap();
    recorder.record(&Moment { time: 10.25 }).unwrap();
    std::mem::forget(recorder);
    std::mem::forget(store);

    let summary = StoredStudy::open(dir.path()).unwrap().summary().unwrap();
    assert_eq!(summary.status, Status::Running);
    assert_eq!(summary.cases["a"].status, Status::Running);
    assert_eq!(summary.cases["a"].simulated_s, Some(10.0));
    assert!((summary.cases["a"].bodies["buffer"].offset_x_m.unwrap() + 16.0).abs() < 1e-12);
    let pipe = &summary.cases["a"].lines["pipe"];
    assert_eq!(
        (pipe.end_a.force_x_n.min, pipe.end_a.force_x_n.max),
        (1000.0, 1100.0)
    );
    assert_eq!(pipe.min_effective_tension_n.unwrap().value, 3000.0);
    assert_eq!(pipe.max_effective_tension_n.unwrap().value, 3310.0);
    assert_eq!(summary.cases["b"].status, Status::Pending);
    assert!(summary.cases["b"].lines.is_empty());
}

#[test]
fn a_case_that_has_ended_is_one_file() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&["a", "b.zip"]);
    write_store(dir.path(), &study, DURATION_S, Status::Complete);
    let names = |folder: &str| {
        let entries = fs::read_dir(dir.path().join(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(
        names("results.zarr/cases"),
        ["a.zip", "b%2Ezip.zip", "zarr.json"]
    );
    // Laid out as folders it is the same.
    let read = || {
        let stored = StoredStudy::open(dir.path()).unwrap();
        let case = stored.case("a").unwrap();
        let channels = case.channel_names().unwrap();
        let histories = channels.iter().map(|name| case.channel(name).unwrap());
        let graph = case.range_graph("pipe", LineQuantity::X).unwrap();
        (
            stored.summary().unwrap(),
            case.line_names().unwrap(),
            histories.collect::<Vec<_>>(),
            graph,
            serde_json::to_string(&case.describe().unwrap()).unwrap(),
        )
    };
    let packed = read();
    assert!(packed.2.len() > 20 && packed.4.contains("\"cases/a/lines/pipe/x\""));
    unpack(dir.path(), "a");
    assert_eq!(read(), packed);
}

#[test]
fn rows_beyond_the_planned_ones_extend_the_arrays() {
    let dir = tempfile::tempdir().unwrap();
    write_store(dir.path(), &study(&["a"]), 30.0, Status::Complete);
    let case = StoredStudy::open(dir.path()).unwrap().case("a").unwrap();
    let history = case.channel("ship.x").unwrap();
    assert_eq!(history.times_s.len(), 121);
    assert_eq!(history.values, history.times_s);
    let field = case.field("pipe", LineQuantity::X, 0.0).unwrap();
    assert_eq!(field.times_s.last(), Some(&30.0));
    assert_eq!(field.values.last(), Some(&line_value(0, 3, 30.0)));
}

#[test]
fn only_earlier_results_are_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&["a"]);
    write_store(dir.path(), &study, DURATION_S, Status::Complete);
    fs::write(dir.path().join("my notes.txt"), "keep").unwrap();
    write_store(dir.path(), &study, DURATION_S, Status::Complete);
    assert!(dir.path().join("my notes.txt").exists());

    let other = dir.path().join("other");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("thesis.tex"), "keep").unwrap();
    let error = ResultStore::create(&other, &study, &[], &common::provenance()).unwrap_err();
    assert!(matches!(error, StoreError::NotOurs { .. }), "{error}");
    fs::create_dir(other.join("results.zarr")).unwrap();
    fs::write(
        other.join("results.zarr/zarr.json"),
        r#"{"zarr_format":3,"node_type":"group"}"#,
    )
    .unwrap();
    let error = ResultStore::create(&other, &study, &[], &common::provenance()).unwrap_err();
    assert!(matches!(error, StoreError::NotOurs { .. }), "{error}");
}

#[test]
fn stores_that_cannot_be_read_say_why() {
    let dir = tempfile::tempdir().unwrap();
    let open = || StoredStudy::open(dir.path());
    assert!(matches!(open(), Err(StoreError::NoStore { .. })));

    write_store(dir.path(), &study(&["a"]), DURATION_S, Status::Complete);
    let case = open().unwrap().case("a").unwrap();
    let error = case.channel("buffer.offset_w").unwrap_err().to_string();
    assert!(error.contains("did you mean `buffer.offset_"), "{error}");
    let error = open().unwrap().case("z").unwrap_err().to_string();
    assert!(error.contains("no load case `z`"), "{error}");

    let store = dir.path().join("results.zarr");
    let chunk = unpack(dir.path(), "a").join("ship.x/c/0");
    let case = open().unwrap().case("a").unwrap();
    let mut bytes = fs::read(&chunk).unwrap();
    bytes[11] ^= 4;
    fs::write(&chunk, &bytes).unwrap();
    let error = case.channel("ship.x").unwrap_err().to_string();
    assert!(error.contains("checksum"), "{error}");
    fs::write(&chunk, &bytes[..50]).unwrap();
    assert!(
        case.channel("ship.x")
            .unwrap_err()
            .to_string()
            .contains("size")
    );

    let root = store.join("zarr.json");
    let text = fs::read_to_string(&root).unwrap();
    fs::write(
        &root,
        text.replace("\"catenix_store_format\":2", "\"catenix_store_format\":9"),
    )
    .unwrap();
    let error = open().unwrap_err().to_string();
    assert!(
        error.contains("store format 9") && error.contains("Catenix 0.1.0"),
        "{error}"
    );
    fs::write(&root, &text[..text.len() / 2]).unwrap();
    assert!(open().unwrap_err().to_string().contains("damaged"));
}
