//! A small study and a made-up motion whose every value is known in closed form.
//!
//! tests/read_back.py holds the same formulas, to check what xarray reads.
#![allow(dead_code)]
// A panic is how a test fails, and this module is nothing but tests.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use catenix_model::{
    Appearance, Axis, Body, Channel, ChannelTarget, Current, DynamicsSettings, Environment, Figure,
    IntegratorSettings, Line, LineEnd, LineType, LoadCase, ModeRange, ModeSettings, Model,
    OutputSettings, PipeWall, Reference, Section, StaticsSettings, Statistic, StepControl, Study,
    Vessel, Water,
};
use catenix_results::{
    CaseModes, CaseOutcome, DynamicsFacts, ModeReport, ModeShapes, ModesReport, MotionShare,
    Provenance, ResultStore, Sample, StaticsFacts, Status, Summary,
};

/// Elements of the line.
pub const ELEMENTS: usize = 3;
/// End of the motion [s].
pub const DURATION_S: f64 = 20.0;
/// Step, and interval of the histories [s].
pub const STEP_S: f64 = 0.25;
/// Interval of the fields [s].
pub const FIELD_INTERVAL_S: f64 = 1.0;
/// Statistics window [s].
pub const WINDOW_S: f64 = 8.0;

/// Value of a channel: the same for all channels of one kind.
pub fn channel_value(target: ChannelTarget, time: f64) -> f64 {
    match target {
        ChannelTarget::BodyOffset(_, Axis::X) => -10.0 - time,
        ChannelTarget::EndForce(_, end, Axis::X) => 1000.0 * (end as f64 + 1.0) + 10.0 * time,
        _ => time,
    }
}

/// Value of a line quantity at a node.
pub fn line_value(quantity: usize, node: usize, time: f64) -> f64 {
    1000.0 * quantity as f64 + 100.0 * node as f64 + time
}

/// A moment of the motion.
pub struct Moment {
    /// Simulated time [s].
    pub time: f64,
}

impl Sample for Moment {
    fn time(&self) -> f64 {
        self.time
    }

    fn channel(&self, target: ChannelTarget) -> f64 {
        channel_value(target, self.time)
    }

    fn line_quantities(&self, _line: usize, out: &mut [f64]) {
        let nodes = ELEMENTS + 1;
        for (index, value) in out.iter_mut().enumerate() {
            *value = line_value(index / nodes, index % nodes, self.time);
        }
    }
}

/// Lays the archive of a case out as folders, which a store may have as well, and gives its folder.
pub fn unpack(out: &Path, case: &str) -> PathBuf {
    let folder = out.join("results.zarr/cases").join(case);
    let archive = folder.with_added_extension("zip");
    let bytes = fs::read(&archive).unwrap();
    fs::remove_file(&archive).unwrap();
    let mut rest = &bytes[..];
    // Files stand one after another, uncompressed, each behind a header of 30 bytes and its name.
    while rest.starts_with(b"PK\x03\x04") {
        let size = u32::from_le_bytes(rest[22..26].try_into().unwrap()) as usize;
        let name = usize::from(u16::from_le_bytes([rest[26], rest[27]]));
        let (header, content) = rest.split_at(30 + name);
        let file = folder.join(std::str::from_utf8(&header[30..]).unwrap());
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, &content[..size]).unwrap();
        rest = &content[size..];
    }
    folder
}

/// Where the results come from.
pub fn provenance() -> Provenance {
    Provenance {
        version: "0.1.0".into(),
        model_file: "synthetic.toml".into(),
        model_text: "title = \"synthetic\"\n".into(),
    }
}

/// A study of the given cases.
pub fn study(cases: &[&str]) -> Study {
    let offset = Channel {
        name: "buffer.offset_x".into(),
        unit: "m",
        target: ChannelTarget::BodyOffset(0, Axis::X),
    };
    let case = |name: &&str| LoadCase {
        name: (*name).to_owned(),
        description: format!("case {name}"),
        model: model(),
        references: vec![
            reference(&offset, Statistic::Mean, [-25.0, -25.0]),
            reference(&offset, Statistic::Min, [-31.0, -29.0]),
            reference(&offset, Statistic::Max, [-14.0, -12.0]),
        ],
    };
    Study {
        title: "Synthetic".into(),
        note: "Made up.".into(),
        cases: cases.iter().map(case).collect(),
        figures: vec![Figure {
            name: "offset".into(),
            title: "Offset".into(),
            channel: offset,
        }],
    }
}

fn reference(channel: &Channel, statistic: Statistic, [low, high]: [f64; 2]) -> Reference {
    Reference {
        channel: channel.clone(),
        statistic,
        low,
        high,
        source: "nobody".into(),
    }
}

fn model() -> Model {
    let pipe = LineType {
        name: "pipe".into(),
        outer_diameter: 0.2,
        inner_diameter: 0.15,
        mass: 50.0,
        axial_stiffness: 1e9,
        axial_law: None,
        bending_stiffness: [1e6; 2],
        bending_law: None,
        torsional_stiffness: 1e6,
        shear_stiffness: None,
        polar_inertia: 0.1,
        rotary_inertia: [0.0; 2],
        structural_damping: 0.0,
        normal_drag: 1.0,
        axial_drag: 0.0,
        normal_added_mass: 1.0,
        axial_added_mass: 0.0,
        content_density: 1025.0,
        wall: Some(PipeWall {
            outer_diameter: 0.2,
            inner_diameter: 0.15,
        }),
    };
    let body = Body {
        name: "buffer".into(),
        mass: 1e4,
        inertia: [1e4; 3],
        volume: 1.0,
        centre_of_buoyancy: [0.0; 3],
        length: 5.0,
        normal_drag_area: 1.0,
        axial_drag_area: 1.0,
        normal_added_mass: 0.0,
        axial_added_mass: 0.0,
        initial_position: None,
        offset_vessel: Some(0),
    };
    Model {
        formulation: catenix_model::FormulationKind::Dem,
        title: "Synthetic".into(),
        environment: Environment {
            gravity: 9.80665,
            water: Some(Water {
                density: 1025.0,
                depth: 1000.0,
            }),
            current: Current::default(),
            seabed: None,
        },
        line_types: vec![pipe],
        lines: vec![Line {
            name: "pipe".into(),
            sections: vec![Section {
                line_type: 0,
                element_lengths: vec![10.0; ELEMENTS],
                natural: catenix_model::NaturalShape::default(),
            }],
            attachments: Vec::new(),
            ends: [LineEnd::Free, LineEnd::Free],
            start_shape: Vec::new(),
        }],
        bodies: vec![body],
        vessels: vec![Vessel {
            name: "ship".into(),
            position: [0.0; 3],
            heading: 0.0,
            motions: Vec::new(),
            appearance: Appearance::default(),
        }],
        loads: Vec::new(),
        statics: StaticsSettings {
            equilibrium: true,
            current: false,
            tolerance: 1e-9,
            max_iterations: 100,
        },
        modes: ModeSettings {
            range: ModeRange::Lowest(3),
            added_mass: true,
        },
        dynamics: Some(DynamicsSettings {
            duration: DURATION_S,
            step: StepControl::Fixed(STEP_S),
            integrator: IntegratorSettings::GeneralisedAlpha {
                spectral_radius: 0.8,
            },
            tolerance: 1e-9,
            max_iterations: 20,
            statistics_window: WINDOW_S,
        }),
        path: None,
        output: OutputSettings {
            interval: STEP_S,
            field_interval: FIELD_INTERVAL_S,
            interpolate: true,
            channels: Vec::new(),
        },
    }
}

/// The solver's account at a time.
pub fn outcome(status: Status, end_time_s: f64) -> CaseOutcome {
    CaseOutcome {
        status,
        error: None,
        warnings: Vec::new(),
        statics: Some(StaticsFacts {
            iterations: 7,
            residual_n: 0.5,
        }),
        discretisation: None,
        dynamics: Some(DynamicsFacts {
            end_time_s,
            steps: (end_time_s / STEP_S) as usize,
            rejected_steps: 1,
            steps_of_order: [0, (end_time_s / STEP_S) as usize, 0, 0, 0],
            iterations: 160,
            factorisations: 160,
            residual_n: 0.25,
            energy: vec![("kinetic_j", 1.5), ("elastic_j", f64::NAN)],
            energy_imbalance: 1e-6,
        }),
        cpu_seconds: 0.5,
        wall_seconds: 0.25,
    }
}

/// Records every case up to `end_s` and ends it with `status`.
/// Three modes of the line of four nodes and of the body: component c of mode m at node n is
/// 100 m + 10 n + c.
pub fn modes() -> CaseModes {
    let numbers = 1..=3;
    let mode = |number: usize| ModeReport {
        number,
        kind: if number == 1 { "free" } else { "vibration" }.into(),
        frequency_hz: Some(0.5 * (number - 1) as f64),
        period_s: (number > 1).then(|| 2.0 / (number - 1) as f64),
        omega_squared_rad2_s2: number as f64,
        equals_previous: number == 3,
        moves_most: "pipe".to_owned(),
        arc_length_m: Some(10.0),
        motions: vec![MotionShare {
            motion: "y".into(),
            share: 1.0,
        }],
        damping_ratio: (number > 1).then_some(0.01),
        effective_mass_kg: [1.0, 2.0, 3.0].map(|mass| mass * number as f64),
        residual: 1e-9,
    };
    let motion = |mode: usize, node: usize| -> [f64; 6] {
        std::array::from_fn(|component| (100 * mode + 10 * node + component) as f64)
    };
    let shapes = |name: &str, nodes: usize, arc_length: Option<Vec<f64>>| ModeShapes {
        name: name.to_owned(),
        arc_length,
        motion: numbers
            .clone()
            .map(|mode| (0..nodes).map(|node| motion(mode, node)).collect())
            .collect(),
    };
    CaseModes {
        report: ModesReport {
            added_mass: true,
            total_mass_kg: [10.0, 20.0, 30.0],
            counted_between_hz: [-0.001, 2.0],
            counted: 3,
            below_band: 0,
            unsymmetric_coupling: 0.0,
            factorisations: 7,
            modes: numbers.clone().map(mode).collect(),
        },
        lines: vec![shapes("pipe", 4, Some(vec![0.0, 10.0, 20.0, 30.0]))],
        bodies: vec![shapes("buffer", 1, None)],
    }
}

pub fn write_store(directory: &Path, study: &Study, end_s: f64, status: Status) -> Summary {
    let cases: Vec<&LoadCase> = study.cases.iter().collect();
    let provenance = provenance();
    let store = ResultStore::create(directory, study, &cases, &provenance).unwrap();
    let mut summaries = indexmap::IndexMap::new();
    for case in &study.cases {
        let mut recorder = store.record_case(case);
        recorder.record_static(case, &Moment { time: 0.0 }).unwrap();
        recorder.record_modes(&modes()).unwrap();
        for step in 0..=(end_s / STEP_S) as usize {
            recorder
                .record(&Moment {
                    time: step as f64 * STEP_S,
                })
                .unwrap();
        }
        summaries.insert(
            case.name.clone(),
            recorder.finish(&outcome(status, end_s)).unwrap(),
        );
    }
    let summary = Summary {
        catenix_version: provenance.version.clone(),
        title: study.title.clone(),
        note: study.note.clone(),
        model_file: provenance.model_file.clone(),
        model_sha256: provenance.model_sha256(),
        status,
        cases: summaries,
    };
    store.finish(&summary).unwrap();
    summary
}
