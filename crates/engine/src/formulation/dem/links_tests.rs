//! Links in lanes against connectors one by one.

use catenix_numerics::{
    Block6, BlockMatrix, Chain, Matrix3, TangentWeights, Topology, Vector3, Vector6,
};

use super::super::Situation;
use super::element::connector::Prediction;
use super::element::pair::RateWeights;
use super::element::stiffness::ConnectorStiffness;
use super::links::{LinkLaws, Links, link_of};
use super::pairs::{EvaluatedPair, scatter};
use super::{Carrier, Connector, ConnectorLaw, Mount, Place};
use crate::system::frame_kernel::{FrameBatch, put_frames};
use crate::system::tangent_test::moving_system;

/// A chain through all frames of a system, whatever these are.
fn chain(frames: usize) -> Vec<Connector> {
    let mount = |k: usize, x: f64| Mount {
        carrier: Carrier::Free(k),
        arm: Vector3::x() * x,
        axes: Matrix3::identity(),
    };
    let link = |k: usize| Connector {
        law: ConnectorLaw::Beam(ConnectorStiffness {
            axial: 3e5 + 1e4 * k as f64,
            shear: 8e5,
            torsion: if k.is_multiple_of(5) { 0.0 } else { 4e4 },
            bending: 6e4 - 1e3 * k as f64,
            shift: 0.0,
            damping: if k < frames / 2 { 0.04 } else { 0.0 },
            general: None,
        }),
        first: mount(k, 0.6 + 0.01 * k as f64),
        second: mount(k + 1, -0.5),
        place: Place::Link(k),
        slide: None,
    };
    (0..frames - 1).map(link).collect()
}

/// Residual, matrix and energies of links one by one, with predictions after an increment.
fn one_by_one(
    connectors: &[Connector],
    topology: &Topology,
    at: &Situation<'_>,
    weights: &TangentWeights<'_>,
    increment: Option<&[Vector6]>,
) -> (Vec<Vector6>, BlockMatrix, [f64; 2]) {
    let mut residual = vec![Vector6::zeros(); topology.frame_count()];
    let mut matrix = BlockMatrix::zeros(topology);
    let elements = FrameBatch::all(&at.system.frames, 0..topology.frame_count());
    put_frames(at, &elements, Some(weights), &mut residual, &mut matrix);
    let mut energy = [0.0; 2];
    for (k, connector) in connectors.iter().enumerate() {
        let mut pair = EvaluatedPair::new(connector, at);
        let forces = pair.forces();
        residual[k] += forces.first;
        residual[k + 1] += forces.second;
        energy[0] += pair.energy(&connector.law);
        energy[1] += pair.damping_power();
        let rates = RateWeights {
            velocity: weights.velocity,
            rotation: [weights.turn(k), weights.turn(k + 1)],
        };
        let predicted: Option<Prediction> =
            increment.map(|increment| pair.predicted(connector, increment));
        let tangent = pair.tangent(&connector.law, predicted.as_ref(), &rates);
        scatter(topology, connector, &tangent, &mut matrix);
    }
    (residual, matrix, energy)
}

#[test]
fn lanes_compute_what_single_connectors_do() {
    moving_system(|at, weights| {
        let frames = at.system.frame_count();
        let connectors = chain(frames);
        let whole = Chain {
            first: 0,
            len: frames,
            head: None,
            tail: None,
        };
        let topology = Topology::new(vec![whole], frames);
        let owned: Option<Vec<_>> = connectors.iter().map(link_of).collect();
        let owned = owned.expect("all of them are links");
        let laws = LinkLaws::batches(owned.iter().map(|(k, link)| (*k, link)), frames);
        let mut links = Links::new(&laws);
        let elements = FrameBatch::all(&at.system.frames, 0..frames);
        let increment: Vec<Vector6> = (0..frames)
            .map(|k| Vector6::from_fn(|row, _| 0.02 * ((7 * k + row) as f64).sin()))
            .collect();
        for increment in [None, Some(increment.as_slice())] {
            if let Some(increment) = increment {
                links.moving(&elements, increment);
            }
            let mut residual = vec![Vector6::zeros(); frames];
            let mut matrix = BlockMatrix::zeros(&topology);
            links.put(&elements, at, Some(weights), &mut residual, &mut matrix);
            let (want, want_matrix, energy) =
                one_by_one(&connectors, &topology, at, weights, increment);
            // Roundings, of the largest numbers of each block: the frames are far apart and far
            // turned, so that terms of different size cancel.
            for (got, want) in residual.iter().zip(&want) {
                assert!((got - want).norm() <= 1e-12 * want.norm());
            }
            let same = |got: &[Block6], want: &[Block6]| {
                for (got, want) in got.iter().zip(want) {
                    let size = want.0.iter().fold(0.0f64, |size, x| size.max(x.abs()));
                    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-12 * size;
                    assert!(got.0.iter().zip(&want.0).all(near));
                }
            };
            same(&matrix.diagonal, &want_matrix.diagonal);
            same(&matrix.upper, &want_matrix.upper);
            same(&matrix.lower, &want_matrix.lower);
            for (got, want) in links.energy().iter().zip(&energy) {
                assert!((got - want).abs() <= 1e-12 * want.abs());
            }
        }
    });
}
