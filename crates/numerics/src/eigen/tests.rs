//! The eigensolver against dense matrices and closed forms.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, SymmetricEigen};
use proptest::prelude::*;

use super::*;
use crate::{Block6, BlockMatrix, Chain, Topology};

/// Dense copies of K and M, column by column.
fn dense(pencil: &Pencil<'_>, frames: usize) -> [DMatrix<f64>; 2] {
    let mut matrices = [(); 2].map(|()| DMatrix::zeros(6 * frames, 6 * frames));
    for column in 0..6 * frames {
        let mut x = vec![Vector6::zeros(); frames];
        x[column / 6][column % 6] = 1.0;
        let mut inertia = x.clone();
        pencil.mass_times(&x, &mut inertia);
        let stiffness = pencil.stiffness_times(&x);
        for row in 0..6 * frames {
            matrices[0][(row, column)] = stiffness[row / 6][row % 6];
            matrices[1][(row, column)] = inertia[row / 6][row % 6];
        }
    }
    matrices
}

/// All eigenvalues, ascending, by Cholesky factors of M and a dense solver.
fn dense_eigenvalues(pencil: &Pencil<'_>, frames: usize) -> Vec<f64> {
    let [stiffness, mass] = dense(pencil, frames);
    let factor = mass.cholesky().unwrap().l().try_inverse().unwrap();
    let standard = &factor * stiffness * factor.transpose();
    let symmetric = (&standard + standard.transpose()) * 0.5;
    let mut values: Vec<f64> = SymmetricEigen::new(symmetric)
        .eigenvalues
        .iter()
        .copied()
        .collect();
    values.sort_by(f64::total_cmp);
    values
}

/// A random pencil: positive mass, stiffness of either sign.
fn random_pencil(topology: &Topology, seed: u64) -> Pencil<'_> {
    let mut state = seed.wrapping_mul(2).wrapping_add(1);
    let mut random = move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut matrix = BlockMatrix::zeros(topology);
    let mut fill = |block: &mut Block6| block.0.iter_mut().for_each(|entry| *entry = random());
    matrix.diagonal.iter_mut().for_each(&mut fill);
    matrix.upper.iter_mut().for_each(&mut fill);
    matrix.lower.iter_mut().for_each(&mut fill);
    matrix.head.iter_mut().flatten().for_each(&mut fill);
    matrix.tail.iter_mut().flatten().for_each(&mut fill);
    // Coupled like the stiffness, and kept positive by its diagonal.
    let mut mass = BlockMatrix::zeros(topology);
    mass.diagonal.iter_mut().for_each(&mut fill);
    mass.upper.iter_mut().for_each(&mut fill);
    mass.head.iter_mut().flatten().for_each(&mut fill);
    mass.tail.iter_mut().flatten().for_each(&mut fill);
    let mut mass = mass.symmetric_part();
    for (k, block) in mass.diagonal.iter_mut().enumerate() {
        (0..6).for_each(|d| block.add_diagonal(d, 12.0 + k as f64));
    }
    Pencil::new(topology, &matrix, mass)
}

fn go_on(_: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn chain(first: usize, len: usize, head: Option<usize>, tail: Option<usize>) -> Chain {
    Chain {
        first,
        len,
        head,
        tail,
    }
}

/// Values, residuals and orthogonality of all pairs between the counts.
fn check(pencil: &mut Pencil<'_>, pairs: &[Eigenpair], want: &[f64], size: f64) {
    assert_eq!(pairs.len(), want.len());
    for (k, (pair, want)) in pairs.iter().zip(want).enumerate() {
        assert!(
            (pair.value - want).abs() < 1e-9 * size,
            "{k}: {} instead of {want}",
            pair.value
        );
        let residual = pencil.residual(pair.value, &pair.vector);
        assert!(dot(&residual, &residual).sqrt() < 1e-7 * size);
        for (j, other) in pairs.iter().enumerate() {
            let product = pencil.product(&pair.vector, &other.vector);
            let want = if j == k { 1.0 } else { 0.0 };
            assert!((product - want).abs() < 1e-8, "{j} {k}: {product:.2e}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn every_topology_gives_the_dense_spectrum(
        seed: u64,
        lengths in prop::collection::vec(1usize..5, 1..5),
        ends in prop::collection::vec((0usize..4, 0usize..4), 5),
    ) {
        let junctions = 3;
        let frames: usize = lengths.iter().sum();
        let mut first = 0;
        let chains = lengths.iter().zip(&ends).map(|(&len, &(a, b))| {
            let end = |j: usize| (j < junctions).then_some(frames + j);
            let chain = chain(first, len, end(a), end(b));
            first += len;
            chain
        }).collect();
        let topology = Topology::new(chains, frames + junctions);
        let mut pencil = random_pencil(&topology, seed);
        let values = dense_eigenvalues(&pencil, frames + junctions);
        let cut = |k: usize| 0.5 * (values[k - 1] + values[k]);
        for k in 1..values.len() {
            prop_assert_eq!(pencil.factorise(cut(k)), Some(k));
        }
        let (from, to) = (values.len() / 4, 3 * values.len() / 4);
        let mut progress = go_on;
        let mut spectrum = Spectrum::new(&mut pencil, &mut progress);
        let low = spectrum.count(cut(from)).unwrap();
        let high = spectrum.count(cut(to)).unwrap();
        let pairs = spectrum.between(low, high).unwrap();
        check(&mut pencil, &pairs, &values[from..to], 1.0);
    }
}

/// Six equal chains of masses and springs side by side, both ends held: each eigenvalue,
/// 4 sin^2(j pi / 2 (n + 1)), comes six times.
#[test]
fn equal_eigenvalues_are_found_whole() {
    let n = 60;
    let topology = Topology::new(vec![chain(0, n, None, None)], n);
    let mut matrix = BlockMatrix::zeros(&topology);
    let mut identity = Block6::ZERO;
    (0..6).for_each(|d| identity.add_diagonal(d, 1.0));
    for k in 0..n {
        matrix.diagonal[k] = Block6::ZERO.plus(2.0, &identity);
        matrix.upper[k] = Block6::ZERO.plus(-1.0, &identity);
        matrix.lower[k] = matrix.upper[k];
    }
    let mut mass = BlockMatrix::zeros(&topology);
    mass.diagonal.fill(identity);
    let mut pencil = Pencil::new(&topology, &matrix, mass);
    let mut progress = go_on;
    let mut spectrum = Spectrum::new(&mut pencil, &mut progress);
    let low = spectrum.count(0.0).unwrap();
    let high = spectrum.above_lowest(low, 50, 1.0).unwrap();
    let pairs = spectrum.between(low, high).unwrap();
    assert!(pairs.len() >= 50 && pairs.len().is_multiple_of(6));
    let want: Vec<f64> = (0..pairs.len())
        .map(|k| {
            let angle = 0.5 * std::f64::consts::PI * (k / 6 + 1) as f64 / (n + 1) as f64;
            4.0 * angle.sin().powi(2)
        })
        .collect();
    check(&mut pencil, &pairs, &want, want[want.len() - 1]);
}

#[test]
fn a_request_beyond_the_spectrum_says_how_much_there_is() {
    let topology = Topology::new(vec![chain(0, 2, None, None)], 2);
    let mut pencil = random_pencil(&topology, 7);
    let mut progress = go_on;
    let mut spectrum = Spectrum::new(&mut pencil, &mut progress);
    let low = spectrum.count(-1e3).unwrap();
    assert_eq!(
        spectrum.above_lowest(low, 13, 1.0),
        Err(EigenError::TooMany { available: 12 })
    );
    let all = spectrum.above_lowest(low, 12, 1.0).unwrap();
    assert_eq!(spectrum.between(low, all).unwrap().len(), 12);
}

#[test]
fn the_caller_may_stop_the_search() {
    let topology = Topology::new(vec![chain(0, 2, None, None)], 2);
    let mut pencil = random_pencil(&topology, 7);
    let mut progress = |_| ControlFlow::Break(());
    let mut spectrum = Spectrum::new(&mut pencil, &mut progress);
    assert_eq!(spectrum.count(0.0), Err(EigenError::Interrupted));
}
