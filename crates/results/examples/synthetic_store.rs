//! Writes stores of known content for tests/read_back.py: a complete one, an interrupted one and
//! one whose writer died.
// An example that fails may do so loudly.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::path::PathBuf;

use catenix_results::{ResultStore, Status};

#[path = "../tests/common/mod.rs"]
mod common;

fn main() {
    let directory = PathBuf::from(std::env::args().nth(1).expect("usage: synthetic_store DIR"));
    let study = common::study(&["a", "b"]);
    common::write_store(&directory.join("complete"), &study, 20.0, Status::Complete);
    common::write_store(
        &directory.join("interrupted"),
        &study,
        10.0,
        Status::Interrupted,
    );
    let cases: Vec<_> = study.cases.iter().collect();
    let killed = directory.join("killed");
    let store = ResultStore::create(&killed, &study, &cases, &common::provenance()).unwrap();
    let mut recorder = store.record_case(&study.cases[0]);
    recorder
        .record_static(&study.cases[0], &common::Moment { time: 0.0 })
        .unwrap();
    recorder.record(&common::Moment { time: 0.0 }).unwrap();
    std::thread::sleep(std::time::Duration::from_millis(2100));
    recorder.record(&common::Moment { time: 0.25 }).unwrap();
    std::process::abort();
}
