//! Exports of stores of known content: what is written, what is refused, and what is left behind.
// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};

use catenix_export::{
    ExportError, ExportFormat, ExportRequest, ExportWatch, Exported, Thinning, export,
};
use catenix_results::{ResultStore, Status, StoredStudy};

#[path = "../../results/tests/common/mod.rs"]
mod common;

/// Lets an export go on for a number of pieces.
struct Patience {
    pieces: Cell<usize>,
}

impl Patience {
    fn endless() -> Self {
        Patience {
            pieces: Cell::new(usize::MAX),
        }
    }
}

impl ExportWatch for Patience {
    fn progress(&self, what: &str, done: u64, total: u64) {
        assert!(!what.is_empty());
        assert!(done <= total, "{what}: {done} of {total}");
        self.pieces.set(self.pieces.get().saturating_sub(1));
    }

    fn stop(&self) -> bool {
        self.pieces.get() == 0
    }
}

struct Bench {
    directory: tempfile::TempDir,
}

impl Bench {
    /// A complete store of the cases `a` and `b`.
    fn complete() -> Self {
        let bench = Bench::empty();
        let study = common::study(&["a", "b"]);
        common::write_store(&bench.path("results"), &study, 20.0, Status::Complete);
        bench
    }

    fn empty() -> Self {
        Bench {
            directory: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn request(&self, format: ExportFormat) -> ExportRequest {
        ExportRequest {
            format,
            directory: self.path("out"),
            cases: Vec::new(),
            lines: Vec::new(),
            thinning: Thinning::All,
            fields: false,
            force: false,
        }
    }

    fn export(&self, request: &ExportRequest) -> Result<Exported, ExportError> {
        let study = StoredStudy::open(&self.path("results"))?;
        export(&study, request, &Patience::endless())
    }

    /// Names of everything in the output directory, sorted.
    fn written(&self) -> Vec<String> {
        names(&self.path("out"))
    }
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(directory)
        .map(|entries| {
            entries
                .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
                .collect()
        })
        .unwrap_or_default();
    names.sort();
    names
}

#[test]
fn every_format_writes_what_it_lists() {
    let bench = Bench::complete();
    for (format, expected) in [
        (
            ExportFormat::Csv,
            &[
                "a_columns.json",
                "a_fields.csv",
                "a_histories.csv",
                "a_mode_shapes.csv",
                "a_modes.csv",
                "a_range_graphs.csv",
                "a_static_shape.csv",
            ][..],
        ),
        (
            ExportFormat::Parquet,
            &[
                "a_fields.parquet",
                "a_histories.parquet",
                "a_mode_shapes.parquet",
                "a_modes.parquet",
                "a_range_graphs.parquet",
                "a_static_shape.parquet",
            ],
        ),
        (ExportFormat::Vtk, &["a.pvd", "a_vtk"]),
        (ExportFormat::Netcdf, &["a.nc"]),
    ] {
        let request = ExportRequest {
            cases: vec!["a".into()],
            fields: true,
            directory: bench.path(format.word()),
            ..bench.request(format)
        };
        let exported = bench.export(&request).unwrap();
        assert_eq!(names(&bench.path(format.word())), expected);
        assert!(exported.notes.is_empty());
        assert_eq!(exported.cases[0].end_time_s, Some(20.0));
        for file in &exported.files {
            let mut size = file.path.metadata().unwrap().len();
            if file.files > 1 {
                let parts = bench.path(format.word()).join("a_vtk");
                let parts: Vec<u64> = fs::read_dir(parts)
                    .unwrap()
                    .map(|entry| entry.unwrap().metadata().unwrap().len())
                    .collect();
                assert_eq!(parts.len() + 1, file.files);
                size += parts.iter().sum::<u64>();
            }
            assert_eq!(size, file.bytes, "{}", file.path.display());
        }
    }
}

#[test]
fn comma_separated_values_are_those_of_the_store() {
    let bench = Bench::complete();
    let exported = bench.export(&bench.request(ExportFormat::Csv)).unwrap();
    let text = fs::read_to_string(bench.path("out/a_histories.csv")).unwrap();
    let mut lines = text.lines();
    let headings: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = headings
        .iter()
        .position(|heading| *heading == "buffer.offset_x [m]")
        .unwrap();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 81);
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(row[0], index as f64 * common::STEP_S);
        assert_eq!(row[column], -10.0 - row[0]);
    }
    let graphs = fs::read_to_string(bench.path("out/a_range_graphs.csv")).unwrap();
    assert!(graphs.starts_with(
        "line,quantity,unit,arc_length [m],min,mean,max,std,run_min,run_max\npipe,x,m,0,12,16,20,"
    ));
    let listed = &exported.files[0];
    assert_eq!((listed.rows, listed.columns), (81, headings.len()));
}

#[test]
fn thinning_takes_stored_rows_and_nothing_between() {
    let bench = Bench::complete();
    let times = |request: ExportRequest| -> Vec<f64> {
        bench.export(&request).unwrap();
        let text = fs::read_to_string(bench.path("out/a_histories.csv")).unwrap();
        text.lines()
            .skip(1)
            .map(|line| line.split(',').next().unwrap().parse().unwrap())
            .collect()
    };
    let request = || ExportRequest {
        force: true,
        ..bench.request(ExportFormat::Csv)
    };
    let every = ExportRequest {
        thinning: Thinning::Every(40),
        ..request()
    };
    assert_eq!(times(every), [0.0, 10.0, 20.0]);
    let stretch = ExportRequest {
        thinning: "3:4:0.5".parse().unwrap(),
        ..request()
    };
    assert_eq!(times(stretch), [3.0, 3.5, 4.0]);
    let nothing = ExportRequest {
        thinning: "30:40".parse().unwrap(),
        ..request()
    };
    let message = bench.export(&nothing).unwrap_err().to_string();
    assert!(message.contains("from 0 s to 20 s"), "{message}");
}

#[test]
fn an_earlier_export_is_replaced_only_when_asked() {
    let bench = Bench::complete();
    for format in ExportFormat::ALL {
        let request = bench.request(format);
        bench.export(&request).unwrap();
        let before = bench.written();
        let error = bench.export(&request).unwrap_err();
        assert!(matches!(error, ExportError::Exists { .. }));
        assert!(error.to_string().contains("--force"), "{error}");
        let again = ExportRequest {
            force: true,
            ..request
        };
        bench.export(&again).unwrap();
        assert_eq!(bench.written(), before);
    }
}

#[test]
fn a_shorter_series_leaves_nothing_of_a_longer_one() {
    let bench = Bench::complete();
    let request = bench.request(ExportFormat::Vtk);
    bench.export(&request).unwrap();
    assert_eq!(names(&bench.path("out/a_vtk")).len(), 42);
    let thinned = ExportRequest {
        thinning: Thinning::Every(10),
        force: true,
        ..request
    };
    bench.export(&thinned).unwrap();
    assert_eq!(
        names(&bench.path("out/a_vtk")),
        [0, 1, 2]
            .map(|n| format!("bodies_{n}.vtp"))
            .into_iter()
            .chain([0, 1, 2].map(|n| format!("lines_{n}.vtp")))
            .collect::<Vec<_>>()
    );
}

#[test]
fn an_interruption_leaves_no_half_file() {
    let bench = Bench::complete();
    let study = StoredStudy::open(&bench.path("results")).unwrap();
    for format in ExportFormat::ALL {
        let mut request = bench.request(format);
        request.fields = true;
        // At the first pieces one by one, then ever further apart.
        for pieces in std::iter::successors(Some(1), |n| Some(n + 1 + n / 4)) {
            let patience = Patience {
                pieces: Cell::new(pieces),
            };
            fs::remove_dir_all(&request.directory).ok();
            let result = export(&study, &request, &patience);
            for name in bench.written() {
                assert!(!name.ends_with(".partial"), "{name} after {pieces} pieces");
            }
            match result {
                Ok(exported) => {
                    assert!(!exported.files.is_empty());
                    break;
                }
                Err(error) => assert!(matches!(error, ExportError::Interrupted)),
            }
        }
    }
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    let bench = Bench::complete();
    let case = ExportRequest {
        cases: vec!["c".into()],
        ..bench.request(ExportFormat::Csv)
    };
    let message = bench.export(&case).unwrap_err().to_string();
    assert!(message.contains("no load case `c`"), "{message}");
    assert!(message.contains("`a`, `b`"), "{message}");
    let line = ExportRequest {
        lines: vec!["pip".into()],
        ..bench.request(ExportFormat::Csv)
    };
    let message = bench.export(&line).unwrap_err().to_string();
    assert!(message.contains("did you mean `pipe`?"), "{message}");
    assert!(bench.written().is_empty());
}

#[test]
fn interrupted_and_killed_runs_give_what_they_have_and_say_so() {
    let bench = Bench::empty();
    let study = common::study(&["a"]);
    common::write_store(&bench.path("results"), &study, 10.0, Status::Interrupted);
    let exported = bench.export(&bench.request(ExportFormat::Netcdf)).unwrap();
    assert_eq!(exported.cases[0].end_time_s, Some(10.0));
    assert!(exported.notes[0].contains("interrupted: its rows end at 10 s"));

    let bench = Bench::empty();
    let study = common::study(&["a", "b"]);
    let cases: Vec<_> = study.cases.iter().collect();
    let store = ResultStore::create(
        &bench.path("results"),
        &study,
        &cases,
        &common::provenance(),
    )
    .unwrap();
    let message = bench
        .export(&bench.request(ExportFormat::Csv))
        .unwrap_err()
        .to_string();
    assert!(message.contains("nothing to export"), "{message}");
    assert!(message.contains("`a` is pending"), "{message}");
    assert!(bench.written().is_empty());

    // The static state is flushed, and the process dies in the first step.
    let mut recorder = store.record_case(&study.cases[0]);
    let start = common::Moment { time: 0.0 };
    recorder.record_static(&study.cases[0], &start).unwrap();
    recorder.flush().unwrap();
    std::mem::forget(recorder);
    let exported = bench.export(&bench.request(ExportFormat::Csv)).unwrap();
    assert_eq!(exported.cases.len(), 1);
    assert!(
        exported.notes[0].contains("still running"),
        "{:?}",
        exported.notes
    );
    assert!(exported.notes[1].contains("`b` is pending"));
    assert_eq!(bench.written(), ["a_columns.json", "a_static_shape.csv"]);
    for format in [ExportFormat::Vtk, ExportFormat::Netcdf] {
        bench.export(&bench.request(format)).unwrap();
    }
}

#[test]
fn damage_is_an_error_and_leaves_nothing() {
    let bench = Bench::complete();
    let line = common::unpack(&bench.path("results"), "a").join("lines/pipe");
    let chunk = line.join("curvature/c/0/0");
    let good = fs::read(&chunk).unwrap();
    let mut flipped = good.clone();
    flipped[7] ^= 1;
    for bad in [&flipped[..], &good[..9]] {
        fs::write(&chunk, bad).unwrap();
        for format in [ExportFormat::Vtk, ExportFormat::Netcdf] {
            let error = bench.export(&bench.request(format)).unwrap_err();
            assert_eq!(error.code(), "results::damaged");
            assert!(bench.written().is_empty());
        }
    }
    fs::remove_file(&chunk).unwrap();
    let error = bench.export(&bench.request(ExportFormat::Vtk)).unwrap_err();
    assert!(error.to_string().contains("the file is missing"), "{error}");
    fs::write(line.join("curvature/zarr.json"), "{").unwrap();
    let error = bench.export(&bench.request(ExportFormat::Csv)).unwrap_err();
    assert_eq!(error.code(), "results::damaged");
    assert!(bench.written().is_empty());
}

#[test]
fn names_that_no_file_may_have_are_escaped() {
    let bench = Bench::empty();
    let mut study = common::study(&["矿 / 1"]);
    study.cases[0].model.lines[0].name = "软管 \"<&>\"".into();
    common::write_store(&bench.path("results"), &study, 2.0, Status::Complete);
    for format in ExportFormat::ALL {
        bench.export(&bench.request(format)).unwrap();
    }
    let written = bench.written();
    assert!(written.contains(&"矿 %2F 1.pvd".to_owned()), "{written:?}");
    let table = fs::read_to_string(bench.path("out/矿 %2F 1_static_shape.csv")).unwrap();
    assert!(table.contains("\n\"软管 \"\"<&>\"\"\",0,"), "{table}");
}
