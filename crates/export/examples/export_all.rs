//! Exports a store in every format, for tests/read_back.py:
//! `cargo run -p catenix-export --example export_all -- RESULTS DIR`.
// An example that fails may do so loudly.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::path::PathBuf;

use catenix_export::{ExportFormat, ExportRequest, ExportWatch, Thinning, export};
use catenix_results::StoredStudy;

struct Nobody;

impl ExportWatch for Nobody {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {}

    fn stop(&self) -> bool {
        false
    }
}

fn main() {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [results, directory] = arguments.as_slice() else {
        panic!("usage: export_all RESULTS DIR");
    };
    let study = StoredStudy::open(results).unwrap();
    for format in ExportFormat::ALL {
        let request = ExportRequest {
            format,
            directory: directory.join(format.word()),
            cases: Vec::new(),
            lines: Vec::new(),
            thinning: Thinning::All,
            fields: true,
            force: false,
        };
        export(&study, &request, &Nobody).unwrap();
    }
}
