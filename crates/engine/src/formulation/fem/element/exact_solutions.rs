//! Both elements against solutions that are known, on a chain with a dense solver.

use std::f64::consts::PI;

use catenix_numerics::{Configuration, Matrix3, Vector3, so3};

use super::exact::{Exact, ExactState};
use super::section::ElementSection;
use super::test_chain::{Chain, Element, straight};

fn section(length: f64) -> ElementSection {
    ElementSection {
        length,
        axial: 1e6,
        torsion: 80.0,
        bending: [100.0; 2],
        shear: None,
        rest: Vector3::zeros(),
        damping: 0.0,
        laws: None,
    }
}

#[test]
fn patch_constant_strain_curvature_and_twist_are_exact_on_any_mesh() {
    // Unlike elements under tension, a moment and a torque, all small: each strain is load over
    // stiffness everywhere.
    let lengths = [0.3, 0.7, 0.45, 1.1];
    for kind in 0..2 {
        let elements: Vec<Element> = lengths
            .iter()
            .map(|&l| Element::both(&section(l))[kind].clone())
            .collect();
        let mut position = vec![Vector3::zeros()];
        for l in lengths {
            position.push(position[position.len() - 1] + Vector3::x() * l);
        }
        let (tension, torque, moment) = (50.0, 1e-4, 1e-4);
        let total: f64 = lengths.iter().sum();
        let mut chain = Chain {
            elements,
            nodes: {
                let rotation = vec![Matrix3::identity(); position.len()];
                Configuration::of_frames(position, rotation)
            },
            force: Vector3::x() * tension,
            moment: Vector3::new(torque, 0.0, 0.0),
        };
        chain.solve(1e-8);
        let stretched = total * (1.0 + tension / 1e6);
        // Rounding of the positions; the twist stands alone, so it is exact.
        assert!((chain.tip().x - stretched).abs() < 1e-13);
        let twist = so3::log(&chain.nodes.rotation[lengths.len()]);
        assert!((twist - Vector3::x() * (torque * total / 80.0)).norm() < 1e-14);

        chain.force = Vector3::zeros();
        chain.moment = Vector3::z() * moment;
        chain.solve(1e-8);
        let angle = moment * total / 100.0;
        let turned = so3::log(&chain.nodes.rotation[lengths.len()]);
        assert!((turned - Vector3::z() * angle).norm() < 1e-14);
        // A circle, whose tip is at (sin, 1 - cos) / curvature: to first order angle L / 2.
        assert!((chain.tip().y - 0.5 * angle * total).abs() < 1e-12);
    }
}

#[test]
fn a_cantilever_rolls_up_to_a_circle() {
    let (length, count) = (10.0, 20);
    let element_length = length / f64::from(count);
    for (kind, element) in Element::both(&section(element_length))
        .into_iter()
        .enumerate()
    {
        let mut chain = straight(&element, length, count as usize);
        let mut most = 0;
        for step in 1..=8 {
            let full = 2.0 * PI * 100.0 / length;
            chain.moment = Vector3::z() * (full * f64::from(step) / 8.0);
            most = most.max(chain.solve(1e-7));
        }
        // The moment is constant, so every element bends by l M / EI and stretches by nothing: the
        // polygon closes. Rounding of strains of 1e-16 in EA adds up over the 10 m.
        assert!(chain.tip().norm() < 1e-11, "{kind}: tip {}", chain.tip());
        // Eighths of a full circle, at EA l^2 / EI of 2500, in the mixed form.
        assert!(most <= 6, "{kind}: {most} iterations");
    }
}

/// Deflections of the elastica under a tip load, P L^2 / EI = 10 (Mattiasson 1981).
const ELASTICA: [f64; 2] = [0.554_996, 0.810_609];

/// An elastica under a tip load of P L^2 / EI = 10.
fn elastica(kind: usize, count: u32, axial: f64) -> Chain {
    let section = ElementSection {
        axial,
        ..section(1.0 / f64::from(count))
    };
    straight(&Element::both(&section)[kind], 1.0, count as usize)
}

#[test]
fn val_mattiasson_elastica_with_its_order_of_convergence() {
    let errors = |kind: usize| -> Vec<f64> {
        [8, 16, 32]
            .map(|count| {
                let mut chain = elastica(kind, count, 1e9);
                for step in 1..=10 {
                    chain.force = Vector3::y() * (100.0 * f64::from(step));
                    chain.solve(1e-3);
                }
                let tip = chain.tip();
                let [u, w] = ELASTICA;
                (1.0 - tip.x - u).hypot(tip.y - w)
            })
            .to_vec()
    };
    // Corotational: fourth order, until the six digits of the table.
    let corotational = errors(0);
    assert!(
        corotational[0] < 5e-4 && corotational[2] < 2e-6,
        "{corotational:?}"
    );
    assert!(corotational[0] / corotational[1] > 14.0, "{corotational:?}");
    // One point of integration, and an element that is rigid in shear: second order.
    let exact = errors(1);
    assert!(exact[0] < 2e-2 && exact[2] < 1e-3, "{exact:?}");
    assert!((exact[1] / exact[2] - 4.0).abs() < 0.2, "{exact:?}");
}

/// A 45 degree bend of radius 100 in the plane, clamped, to be pulled out of it at the tip.
fn bend(count: usize, kind: usize) -> Chain {
    let angle = 0.25 * PI / count as f64;
    let length = 100.0 * angle;
    let section = ElementSection {
        length,
        axial: 1e7,
        torsion: 1e7 * 0.5 / 6.0,
        bending: [1e7 / 12.0; 2],
        shear: Some(5.0 / 6.0 * 0.5e7),
        rest: Vector3::z() * angle,
        damping: 0.0,
        laws: None,
    };
    let element = Element::both(&section)[kind].clone();
    let at = |k: usize| {
        let angle = angle * k as f64;
        Vector3::new(angle.sin(), 1.0 - angle.cos(), 0.0) * 100.0
    };
    Chain {
        elements: vec![element; count],
        nodes: Configuration::of_frames(
            (0..=count).map(at).collect(),
            (0..=count)
                .map(|k| so3::exp(&(Vector3::z() * (angle * k as f64))))
                .collect(),
        ),
        force: Vector3::zeros(),
        moment: Vector3::zeros(),
    }
}

#[test]
fn val_bathe_bolourchi_bend_of_45_degrees() {
    // Bathe and Bolourchi 1979 with GJ = G / 6, solved to all digits as the equations of the exact
    // rod: verification/bend-45-degrees/SOURCE.md.
    let want = Vector3::new(58.779, 22.245, 40.192);
    // Both are of second order here. A chord of an element of 0.025 rad lies beside its arc by
    // 100 x 0.025^2 / 8 = 7.5e-3, which the corotational element halves at its ends by bending as a
    // cubic, and the exact one, a polygon, doubles.
    for (kind, allowed) in [(0, 0.0075), (1, 0.015)] {
        let mut chain = bend(32, kind);
        for step in 1..=6 {
            chain.force = Vector3::z() * (50.0 * f64::from(step));
            let iterations = chain.solve(1e-4);
            assert!(iterations <= 8, "{kind}: {iterations} iterations");
        }
        let tip = chain.tip();
        assert!((tip - want).norm() < allowed, "{kind}: {tip}");
    }
}

/// Takes the present shape of every element as its new reference: lengths, curvatures and stresses
/// are those of now, and strains from here on are per present length.
fn update_reference(chain: &mut Chain, axial: f64) {
    let stiffness = Vector3::new(80.0, 100.0, 100.0);
    for k in 0..chain.elements.len() {
        let ends = chain.ends(k);
        let Element::Exact(element) = &chain.elements[k] else {
            panic!("the check is made with the exact element");
        };
        let state = ExactState::new(element, &ends);
        let now = (ends[1].position - ends[0].position).norm();
        let turn = so3::log(&(ends[0].rotation.transpose() * ends[1].rotation));
        // N = N_n + EA (l - l_n) / l_n, as one linear law: its zero is at the length l_n less
        // N_n l_n / EA, and its slope is EA / l_n. Likewise for the curvature.
        let length = now * (1.0 - state.force.x / axial);
        let share = length / now;
        let section = ElementSection {
            length,
            axial: axial * share,
            bending: [stiffness.y * share; 2],
            torsion: stiffness.x * share,
            rest: turn - state.moment.component_div(&stiffness) * now,
            ..element.section().clone()
        };
        chain.elements[k] = Element::Exact(Exact::new(section));
    }
}

#[test]
fn an_updated_reference_reaches_the_same_equilibrium() {
    let solve = |axial: f64, updated: bool| {
        let mut chain = elastica(1, 16, axial);
        for step in 1..=20 {
            chain.force = Vector3::new(-0.3, 1.0, 0.4) * (50.0 * f64::from(step));
            chain.solve(1e-6);
            if updated {
                update_reference(&mut chain, axial);
            }
        }
        chain.tip()
    };
    let apart = [1e5, 1e6].map(|axial| (solve(axial, false) - solve(axial, true)).norm());
    // The same stiffness per present, in place of original, length: strains of up to 1100 / EA make
    // stiffnesses that differ by as much, and so may deflections of up to 0.9.
    assert!(apart[0] < 1.1e-2 && apart[1] < 1.1e-3, "{apart:?}");
    // Nothing else differs: a tenth of the strain makes a tenth of the difference, to leading order
    // in a strain of a percent and the curvature that it changes.
    assert!((apart[0] / apart[1] - 10.0).abs() < 3.0, "{apart:?}");
}
