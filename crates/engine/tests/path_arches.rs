//! Equilibrium paths of rings and arches against the elastica and published limits.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

mod common;

use std::f64::consts::PI;

use catenix_engine::PathEvent;
use common::assert_near;
use common::path::follow;

/// Distance of the loaded points of a ring of radius 1 and EI = 1 that is pulled apart by `load`:
/// an inextensible elastica. On a quarter, from the load, theta'' = -(P / 2) cos(theta), theta = 0 at
/// the load and pi / 2 at the side; by shooting on the curvature at the load. A ring that was bent
/// from a straight rod does the same in its plane: the turn of the closed ring is fixed, so its
/// natural curvature drops out of the energy.
fn ring_height(load: f64) -> f64 {
    let shoot = |curvature: f64| {
        let n = 2000;
        let h = 0.5 * PI / n as f64;
        let rate = |s: [f64; 3]| [s[1], -0.5 * load * s[0].cos(), s[0].sin()];
        let moved = |s: [f64; 3], k: [f64; 3], h: f64| [0, 1, 2].map(|i| s[i] + h * k[i]);
        let mut state = [0.0, curvature, 0.0];
        for _ in 0..n {
            let k1 = rate(state);
            let k2 = rate(moved(state, k1, 0.5 * h));
            let k3 = rate(moved(state, k2, 0.5 * h));
            let k4 = rate(moved(state, k3, h));
            let mean = [0, 1, 2].map(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
            state = moved(state, mean, h);
        }
        state
    };
    let (mut low, mut high) = (-5.0, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shoot(middle)[0] < 0.5 * PI {
            low = middle;
        } else {
            high = middle;
        }
    }
    2.0 * shoot(low)[2]
}

#[test]
fn val_elastica_a_ring_is_pulled_and_pinched() {
    // Linear theory for a small load: (pi / 4 - 2 / pi) P R^3 / EI.
    let small = (ring_height(1e-3) - 2.0) / 1e-3;
    assert_near("small load", small, 0.25 * PI - 2.0 / PI, 1e-4);
    let text = |elements: usize, range: &str, at: &str| {
        let points: Vec<String> = (0..=elements)
            .map(|k| {
                let (sin, cos) = (2.0 * PI * k as f64 / elements as f64).sin_cos();
                format!("[{sin:?}, 0, {:?}]", 1.0 - cos)
            })
            .collect();
        let shape = points.join(", ");
        let length = 2.0 * PI;
        format!(
            r#"
            environment.gravity = 0
            [line_types.strip]
            kind = "general"
            outer_diameter = "0.01 m"
            mass = "1 kg/m"
            axial_stiffness = 1e5
            bending_stiffness = 1
            [anchors.below]
            position = [0, 0, 0]
            [lines.ring]
            sections = [{{ type = "strip", length = {length:?}, elements = {elements} }}]
            start_shape = [{shape}]
            end_a = {{ to = "below", joint = "fixed", direction = [1, 0, 0] }}
            end_b = {{ to = "below", joint = "fixed", direction = [1, 0, 0] }}
            [loads.pull]
            on = "ring"
            at = {half:?}
            force = [0, 0, 1]
            [output]
            channels = ["ring.z@{half:?}m", "ring.x@{half:?}m"]
            [path]
            range = {range}
            at = {at}
            "#,
            half = PI,
        )
    };
    for (range, loads) in [("[0, 8]", [1.0, 4.0, 8.0]), ("[-4, 0]", [-1.0, -2.5, -4.0])] {
        let errors = |elements: usize| {
            let found = follow(&text(elements, range, &format!("{loads:?}")));
            assert!(found.report.is_ok(), "{:?}", found.report);
            let name = found.names.iter().find(|name| name.starts_with("ring.z@"));
            let name = name.unwrap().clone();
            loads.map(|load| (found.at(load, &name) - ring_height(load)).abs())
        };
        let (coarse, fine) = (errors(40), errors(80));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            // A polygon of 80 sides: second order, 8 / N^2 of the radius at the largest pinch.
            assert!(
                fine < 3e-3 && coarse / fine > 3.8,
                "{coarse:.2e} to {fine:.2e}"
            );
        }
    }
}

#[test]
fn val_dadeppo_schmidt_1975_deep_arch() {
    // D. A. DaDeppo, R. Schmidt, "Instability of clamped-hinged circular arches subjected to a point
    // load", Journal of Applied Mechanics 42 (1975) 894-896: an arch of 215 degrees, loaded at its
    // crown, has its limit at 8.97 EI / R^2. Once with its natural curvature, and once as a straight
    // strip with a constant moment EI / R at the hinge: in the plane both do the same, since the
    // curvature's part of the energy is EI / R times the turn from end to end.
    let (radius, ei): (f64, f64) = (100.0, 1e6);
    let half = 107.5f64.to_radians();
    let text = |elements: usize, curved: bool| {
        let place = |angle: f64| [radius * angle.sin(), 0.0, radius * angle.cos()];
        let points: Vec<String> = (0..=elements)
            .map(|k| {
                format!(
                    "{:?}",
                    place(half * (2.0 * k as f64 / elements as f64 - 1.0))
                )
            })
            .collect();
        let tangent = |angle: f64| [angle.cos(), 0.0, -angle.sin()];
        format!(
            r#"
            environment.gravity = 0
            [line_types.strip]
            kind = "general"
            outer_diameter = "0.1 m"
            mass = "1 kg/m"
            axial_stiffness = 1e8
            bending_stiffness = {ei:?}
            torsional_stiffness = 1e8
            [anchors.left]
            position = {left:?}
            [anchors.right]
            position = {right:?}
            [lines.arch]
            sections = [{{ type = "strip", length = {length:?}, elements = {elements}, natural_curvature_y = {natural:?} }}]
            start_shape = [{shape}]
            end_a = {{ to = "left", joint = "fixed", direction = {rise:?} }}
            end_b = {{ to = "right", joint = "hinge", direction = {fall:?} }}
            [loads.bend]
            on = "arch"
            at = {length:?}
            moment = [0, {moment:?}, 0]
            [loads.crown]
            on = "arch"
            at = {crown:?}
            force = [0, 0, {load:?}]
            [path]
            loads = ["crown"]
            range = [-5, 12]
            max_points = 150
            "#,
            left = place(-half),
            right = place(half),
            length = 2.0 * half * radius,
            crown = half * radius,
            shape = points.join(", "),
            rise = tangent(-half),
            fall = tangent(half),
            natural = if curved { 1.0 / radius } else { 0.0 },
            moment = if curved { 0.0 } else { ei / radius },
            load = -ei / (radius * radius),
        )
    };
    let limit = |elements: usize, curved: bool| {
        let found = follow(&text(elements, curved));
        let first = found
            .points
            .iter()
            .find(|p| p.event == Some(PathEvent::Limit));
        first.unwrap().factor
    };
    for curved in [false, true] {
        let (coarse, fine) = (limit(40, curved), limit(80, curved));
        // Second order, and 3e-4 off at 80 elements; the source has three digits.
        assert_near("limit", fine, 8.97, 0.005);
        assert_near("extrapolated", fine + (fine - coarse) / 3.0, 8.97, 0.005);
    }
}
