//! The kernels that a run spends its time in, each alone, on states like those of the sea trial.
//!
//! `cargo bench -p catenix-bench --bench kernels -- NAME` runs those whose name holds NAME;
//! `cargo xtask bench kernels` runs all and writes the table.

// A benchmark that cannot be set up may say so loudly.
#![allow(clippy::expect_used, clippy::unwrap_used, missing_docs)]

mod side_by_side;

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Duration;

use catenix_engine::formulation::dem::element::connector::ConnectorState;
use catenix_engine::formulation::dem::element::pair::{RateWeights, Side};
use catenix_engine::formulation::dem::element::stiffness::{ConnectorStiffness, HalfElement};
use catenix_engine::hydro::current::CurrentField;
use catenix_engine::hydro::morison::StripDrag;
use catenix_engine::system::SystemSolver;
use catenix_engine::{System, solve_statics};
use catenix_model::file::read_study;
use catenix_model::{Model, NaturalShape};
use catenix_numerics::lanes::MOST_LANES;
use catenix_numerics::{
    Block6, BlockMatrix, Chain, Configuration, Elimination, Factorisation, ImplicitSystem, Matrix3,
    MotionState, TangentWeights, Topology, Vector3, Vector6, so3,
};
use cpu_time::ThreadTime;
use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};

use side_by_side::SideBySide;

/// Connectors or elements in one pass of a small kernel: enough to hide the loop around it.
const BATCH: usize = 256;
/// Iteration weights of generalised-alpha with a spectral radius of 0.8 and a step of 0.1 s, in
/// round numbers [1/s, 1/s2].
const WEIGHTS: (f64, f64) = (20.0, 370.0);

criterion_group!(
    name = kernels;
    config = Criterion::default().with_measurement(ProcessorTime(WallTime));
    targets = connectors, frame_loads, assembly, chains, configurations
);
criterion_main!(kernels);

/// Processor time of the thread: on a busy machine the clock on the wall runs on.
struct ProcessorTime(WallTime);

impl Measurement for ProcessorTime {
    type Intermediate = ThreadTime;
    type Value = Duration;

    fn start(&self) -> ThreadTime {
        ThreadTime::now()
    }

    fn end(&self, start: ThreadTime) -> Duration {
        start.elapsed()
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        self.0.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        self.0.formatter()
    }
}

type Bench = Criterion<ProcessorTime>;

/// Numbers that look like noise and are the same in every run, in -1 .. 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vector3 {
        Vector3::new(self.next(), self.next(), self.next()) * size
    }
}

fn sea_trial() -> Model {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    let file: PathBuf = root.unwrap().join("examples/sea-trial-1km.toml");
    let mut study = read_study(&file).expect("the example is right");
    study.cases.remove(0).model
}

/// Two neighbouring elements of the lifting pipe, 10 m long, bent and stretched a little.
fn sides(noise: &mut Noise) -> [Side; 2] {
    let base = so3::exp(&noise.vector(1.0));
    let along: Vector3 = base.column(0).into();
    let middle = noise.vector(100.0);
    [-1.0, 1.0].map(|sign| {
        let rotation = so3::exp(&noise.vector(0.01)) * base;
        let own: Vector3 = rotation.column(0).into();
        Side {
            point: middle + along * (sign * 1e-4) + noise.vector(1e-5),
            lever: own * (-5.0 * sign),
            rotation,
            velocity: noise.vector(1.0),
            spin: noise.vector(0.02),
        }
    })
}

fn connectors(criterion: &mut Bench) {
    let model = sea_trial();
    let half = HalfElement {
        line_type: &model.line_types[0],
        length: 10.0,
        natural: NaturalShape::default(),
    };
    let stiffness = ConnectorStiffness::between(half, half);
    let mut noise = Noise(1);
    let pairs: Vec<[Side; 2]> = (0..BATCH).map(|_| sides(&mut noise)).collect();
    let rates = RateWeights {
        velocity: WEIGHTS.0,
        rotation: [Matrix3::identity(); 2],
    };
    let mut group = criterion.benchmark_group("connector");
    group.throughput(Throughput::Elements(BATCH as u64));
    group.bench_function("force", |bencher| {
        bencher.iter(|| {
            for [first, second] in &pairs {
                let state = ConnectorState::new(&stiffness, first, black_box(second));
                black_box(state.forces(first, second));
            }
        });
    });
    group.bench_function("force and tangent", |bencher| {
        bencher.iter(|| {
            for [first, second] in &pairs {
                let state = ConnectorState::new(&stiffness, first, black_box(second));
                black_box(state.forces(first, second));
                black_box(state.tangent(&stiffness, first, second, None, &rates));
            }
        });
    });
    group.finish();
}

fn frame_loads(criterion: &mut Bench) {
    let model = sea_trial();
    let current = CurrentField::new(&model.environment.current);
    let mut noise = Noise(2);
    let motions: Vec<StripDrag<f64>> = (0..BATCH)
        .map(|_| {
            let axis = noise.vector(1.0).normalize();
            let (water, spin) = (noise.vector(1.0), noise.vector(0.02));
            let coefficients = [1600.0, 70.0, 10.0 / 12f64.sqrt()];
            StripDrag::new(
                coefficients,
                (&axis).into(),
                (&water).into(),
                (&spin).into(),
            )
        })
        .collect();
    let depths: Vec<f64> = (0..BATCH).map(|_| 500.0 * (noise.next() - 1.0)).collect();
    let mut group = criterion.benchmark_group("loads");
    group.throughput(Throughput::Elements(BATCH as u64));
    group.bench_function("drag", |bencher| {
        bencher.iter(|| {
            for motion in &motions {
                black_box(black_box(motion).load());
            }
        });
    });
    group.bench_function("drag tangent", |bencher| {
        bencher.iter(|| {
            for motion in &motions {
                let drag = black_box(motion);
                black_box(drag.derivatives(&drag.load()));
            }
        });
    });
    group.bench_function("current at a depth", |bencher| {
        bencher.iter(|| {
            for z in &depths {
                black_box(current.at(black_box(*z), 1.0));
            }
        });
    });
    group.finish();
}

/// Towed and swaying: every term of the loads and of their tangent has something to do.
fn in_motion(configuration: &Configuration) -> MotionState {
    let mut noise = Noise(3);
    let mut state = MotionState::at_rest(configuration.clone());
    for (velocity, acceleration) in state.velocity.iter_mut().zip(&mut state.acceleration) {
        let (v, w) = (noise.vector(0.5), noise.vector(0.01));
        *velocity = Vector6::new(0.5 + v.x, v.y, v.z, w.x, w.y, w.z);
        let (a, b) = (noise.vector(0.5), noise.vector(0.01));
        *acceleration = Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
    }
    state
}

fn assembly(criterion: &mut Bench) {
    let model = sea_trial();
    let system = System::new(&model).expect("the example can be assembled");
    let start = solve_statics(&system, &mut |_| std::ops::ControlFlow::Continue(()));
    let start = start.expect("the example has an equilibrium");
    let state = in_motion(start.configuration());
    let frames = system.frame_count();
    let mut residual = vec![Vector6::zeros(); frames];
    let mut increment = vec![Vector6::zeros(); frames];
    let weights = TangentWeights {
        velocity: WEIGHTS.0,
        acceleration: WEIGHTS.1,
        rotation: None,
    };
    let mut solver = SystemSolver::moving(&system);
    solver.begin();
    let mut group = criterion.benchmark_group("sea trial");
    group.throughput(Throughput::Elements(frames as u64));
    group.bench_function("residual", |bencher| {
        bencher.iter(|| solver.assemble(20.0, &state, None, black_box(&mut residual)));
    });
    group.bench_function("residual and tangent", |bencher| {
        bencher.iter(|| solver.assemble(20.0, &state, Some(&weights), black_box(&mut residual)));
    });
    // The matrix is eliminated in place, so each solution needs a new one.
    group.bench_function("residual and tangent, factorise and solve", |bencher| {
        bencher.iter(|| {
            solver.assemble(20.0, &state, Some(&weights), &mut residual);
            solver.solve(&residual, black_box(&mut increment)).unwrap();
        });
    });
    group.finish();
}

/// A chain whose blocks are dense and whose diagonal outweighs the rest.
fn chain_matrix(frames: usize) -> (Topology, BlockMatrix, Vec<Vector6>) {
    let chain = Chain {
        first: 0,
        len: frames,
        head: None,
        tail: None,
    };
    let topology = Topology::new(vec![chain], frames);
    let mut matrix = BlockMatrix::zeros(&topology);
    let mut noise = Noise(4);
    let mut block = || Block6(std::array::from_fn(|_| noise.next()));
    for k in 0..frames {
        matrix.diagonal[k] = block();
        for index in 0..6 {
            matrix.diagonal[k].add_diagonal(index, 20.0);
        }
        if k + 1 < frames {
            matrix.upper[k] = block();
            matrix.lower[k] = block();
        }
    }
    let right = (0..frames)
        .map(|_| Vector6::from_fn(|_, _| noise.next()))
        .collect();
    (topology, matrix, right)
}

fn chains(criterion: &mut Bench) {
    let mut group = criterion.benchmark_group("chain");
    for frames in [290, 10_000] {
        let (topology, matrix, right) = chain_matrix(frames);
        group.throughput(Throughput::Elements(frames as u64));
        let mut exchanged = Factorisation::new(&topology);
        group.bench_function(
            format!("factorise {frames} blocks, rows exchanged"),
            |bencher| {
                bencher.iter(|| exchanged.factorise(&topology, black_box(&matrix)).unwrap());
            },
        );
        let mut factors = Elimination::new(&topology);
        let mut x = right.clone();
        // It works in place, so each one has a matrix of its own, that is copied with no time kept.
        let mut in_place = matrix.clone();
        group.bench_function(format!("factorise and solve {frames} blocks"), |bencher| {
            bencher.iter_batched_ref(
                || matrix.clone(),
                |matrix| {
                    x.copy_from_slice(&right);
                    factors
                        .factorise_and_solve(&topology, black_box(matrix), &mut x)
                        .unwrap();
                },
                BatchSize::PerIteration,
            );
        });
        factors
            .factorise_and_solve(&topology, &mut in_place, &mut x)
            .unwrap();
        group.bench_function(format!("solve {frames} blocks again"), |bencher| {
            bencher.iter(|| {
                x.copy_from_slice(&right);
                factors.solve(&topology, &in_place, black_box(&mut x));
            });
        });
    }
    let frames = 290;
    let (_, matrix, right) = chain_matrix(frames);
    let mut chains = SideBySide::new(&matrix, &right);
    chains.eliminate();
    assert!(chains.error() < 1e-12, "the chains are not solved");
    group.throughput(Throughput::Elements((MOST_LANES * frames) as u64));
    group.bench_function(
        format!("factorise and solve {MOST_LANES} x {frames} blocks in lanes"),
        |bencher| {
            bencher.iter(|| black_box(&mut chains).eliminate());
        },
    );
    group.finish();
}

fn configurations(criterion: &mut Bench) {
    let frames = 291;
    let mut noise = Noise(5);
    let position = (0..frames).map(|_| noise.vector(100.0)).collect();
    let rotation = (0..frames).map(|_| so3::exp(&noise.vector(1.0)));
    let base = Configuration::of_frames(position, rotation.collect());
    let increment: Vec<Vector6> = (0..frames)
        .map(|_| Vector6::from_fn(|_, _| 0.01 * noise.next()))
        .collect();
    let mut moved = base.clone();
    let mut group = criterion.benchmark_group("configuration");
    group.throughput(Throughput::Elements(frames as u64));
    group.bench_function("retract", |bencher| {
        bencher.iter(|| {
            moved.copy_from(&base);
            moved.retract(black_box(&increment));
        });
    });
    group.bench_function("difference", |bencher| {
        bencher.iter(|| black_box(moved.difference(black_box(&base))));
    });
    group.finish();
}
