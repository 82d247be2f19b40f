//! Equilibrium paths against closed forms: buckling, limit points, snap-through.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

mod common;

use std::f64::consts::PI;

use catenix_engine::{PathEnd, PathError, PathEvent};
use common::assert_near;
use common::path::follow;

/// Complete elliptic integrals K and E of the modulus k, by the arithmetic-geometric mean.
/// Source: Abramowitz and Stegun, 17.6.
fn elliptic(k: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0, (1.0 - k * k).sqrt(), k);
    let (mut sum, mut power) = (0.5 * c * c, 1.0);
    while c.abs() > 1e-16 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        sum += power * c * c;
        power *= 2.0;
    }
    let first = 0.5 * PI / a;
    (first, first * (1.0 - sum))
}

/// Euler load of a column that is clamped at its foot [N].
const EULER: f64 = PI * PI * COLUMN_STIFFNESS / (4.0 * COLUMN_LENGTH * COLUMN_LENGTH);
const COLUMN_STIFFNESS: f64 = 1000.0;
const COLUMN_LENGTH: f64 = 2.0;

/// A column on the origin, pressed down at its top by the Euler load times the factor, and pushed
/// aside by `nudge` of it.
fn column(elements: usize, nudge: f64, path: &str) -> String {
    format!(
        r#"
        title = "Column"
        environment.gravity = 0
        [line_types.column]
        kind = "general"
        outer_diameter = "0.02 m"
        mass = "3 kg/m"
        axial_stiffness = "400 MN"
        bending_stiffness = {COLUMN_STIFFNESS:?}
        [anchors.foot]
        position = [0, 0, 0]
        [lines.column]
        sections = [{{ type = "column", length = {COLUMN_LENGTH:?}, elements = {elements} }}]
        end_a = {{ to = "foot", joint = "fixed", direction = [0, 0, 1] }}
        [loads.press]
        on = "column"
        at = {COLUMN_LENGTH:?}
        force = [0, 0, {press:?}]
        [loads.nudge]
        on = "column"
        at = {COLUMN_LENGTH:?}
        force = [{aside:?}, 0, 0]
        [output]
        channels = ["column.x@2m", "column.z@2m"]
        [path]
        loads = ["press"]
        {path}
        "#,
        press = -EULER,
        aside = nudge * EULER,
    )
}

#[test]
fn val_elastica_a_column_buckles() {
    // With the slope alpha at the top and k = sin(alpha / 2): P / P_E = (2 K / pi)^2, height
    // L (2 E / K - 1), deflection L 2 k / K (Timoshenko and Gere, Theory of Elastic Stability, 2.7).
    let exact = [20.0f64, 60.0, 100.0, 140.0, 176.0].map(|angle| {
        let k = (0.5 * angle.to_radians()).sin();
        let (first, second) = elliptic(k);
        let factor = (2.0 * first / PI).powi(2);
        let aside = 2.0 * k / first * COLUMN_LENGTH;
        (factor, aside, (2.0 * second / first - 1.0) * COLUMN_LENGTH)
    });
    let at = exact.map(|(factor, ..)| format!("{factor:?}")).join(", ");
    let errors = |elements: usize| {
        let path = format!("range = [0, 10]\nat = [{at}]\nmax_step = 0.05");
        let found = follow(&column(elements, 1e-6, &path));
        assert_eq!(found.report.as_ref().unwrap().end, PathEnd::Range);
        exact.map(|(factor, x, z)| {
            let dx = found.at(factor, "column.x@2m") - x;
            dx.hypot(found.at(factor, "column.z@2m") - z)
        })
    };
    let (coarse, fine) = (errors(20), errors(40));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        // A polygon of rigid elements: second order, 2 m / 40^2 near the buckling load, where a
        // small change of the stiffness moves the top most, and less beyond.
        assert!(fine < 2.5e-3, "error {fine:.2e} m");
        // The nudge shifts the top by 4e-5 m at the first of the points.
        assert!(coarse / (fine - 4e-5) > 3.5, "{coarse:.2e} to {fine:.2e} m");
    }
}

#[test]
fn a_perfect_column_has_a_branch_point_at_the_euler_load() {
    let found = follow(&column(20, 0.0, "range = [0, 2]"));
    let branch = found
        .points
        .iter()
        .find(|point| point.event == Some(PathEvent::Bifurcation))
        .unwrap();
    // Closed in to a thousandth of the first step, 0.02 of the range, in shares of 0.4; the buckling
    // load of the chain is off by 0.2 / N^2.
    assert_near("factor", branch.factor, 1.0, 1e-3);
    // In both planes at once; the perfect column stays straight.
    assert_eq!(branch.unstable, 2);
    assert_near("aside", found.at(2.0, "column.x@2m"), 0.0, 1e-9);
    assert!(
        found
            .points
            .iter()
            .all(|p| (p.factor < branch.factor) == (p.unstable == 0))
    );
}

#[test]
fn a_moment_rolls_a_beam_into_a_circle() {
    let (length, ei) = (10.0, 100.0);
    let text = format!(
        r#"
        environment.gravity = 0
        [line_types.beam]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "1 kg/m"
        axial_stiffness = "1 MN"
        bending_stiffness = {ei:?}
        [anchors.wall]
        position = [0, 0, 0]
        [lines.beam]
        sections = [{{ type = "beam", length = {length:?}, elements = 32 }}]
        end_a = {{ to = "wall", joint = "fixed", direction = [1, 0, 0] }}
        [loads.roll]
        on = "beam"
        at = {length:?}
        moment = [0, {moment:?}, 0]
        [output]
        channels = ["beam.x@10m", "beam.z@10m"]
        [path]
        range = [0, 1]
        at = [0.5]
        tolerance = 1e-12
        "#,
        moment = -2.0 * PI * ei / length,
    );
    let found = follow(&text);
    assert!(found.report.is_ok());
    // A polygon of 32 sides: closed at the full moment up to the half side at the wall and the
    // clamp's correction, second order: L / N^2.
    assert_near("x", found.at(1.0, "beam.x@10m"), 0.0, 1e-2);
    assert_near("z", found.at(1.0, "beam.z@10m"), 0.0, 1e-2);
    // At half of it, half a circle.
    let height = 2.0 * length / PI;
    assert_near("height", found.at(0.5, "beam.z@10m"), height, 1e-2);
}

#[test]
fn a_path_ends_where_it_is_told() {
    let ends = |path: &str| {
        let found = follow(&column(10, 1e-3, path));
        (found.report.unwrap().end, found.points.len())
    };
    assert_eq!(ends("range = [0, 2]\nmax_points = 5"), (PathEnd::Points, 5));
    let stop = "range = [0, 2]\nstop = { channel = \"column.x@2m\", range = [-1, 1] }";
    assert_eq!(ends(stop).0, PathEnd::Channel);
    // A pull to start with, and towards more of it.
    let found = follow(&column(10, 1e-3, "range = [-3, 0.2]"));
    let last = found.points.last().unwrap().factor;
    assert_eq!(found.report.unwrap().end, PathEnd::Range);
    assert_near("last factor", last, -3.0, 1e-12);
}

#[test]
fn a_load_that_nothing_bears_is_told() {
    // A moment about the axis of a shaft that spins freely on its ball joints.
    let text = r#"
        environment.gravity = 0
        [line_types.shaft]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "1 kg/m"
        axial_stiffness = "1 MN"
        bending_stiffness = "1 kN m^2"
        [anchors.left]
        position = [0, 0, 0]
        [anchors.right]
        position = [1, 0, 0]
        [lines.shaft]
        sections = [{ type = "shaft", length = 1, elements = 4 }]
        end_a = { to = "left" }
        end_b = { to = "right" }
        [loads.wind]
        on = "shaft"
        at = 0.6
        moment = [5, 0, 0]
        [path]
        range = [0, 2]
        start = 1
    "#;
    let found = follow(text);
    let error = found.report.unwrap_err();
    assert!(matches!(error, PathError::Start { .. }), "{error}");
    let message = error.to_string();
    assert!(
        message.contains("the first point of the path, at the factor 1"),
        "{message}"
    );
    assert!(message.contains("of line 'shaft'"), "{message}");
    assert!(found.points.is_empty());
}

#[test]
fn a_lost_path_keeps_its_points() {
    // No step may be shorter than a millionth of the first, and that is still far too long.
    let found = follow(&column(
        10,
        1e-3,
        "range = [0, 2]\nfirst_step = 1e9\nmax_step = 1e9",
    ));
    let error = found.report.unwrap_err();
    assert!(
        matches!(error, PathError::Lost { points: 1, .. }),
        "{error}"
    );
    assert!(
        error
            .to_string()
            .contains("the path is lost after the factor 0")
    );
    assert_eq!(found.points.len(), 1);
}

#[test]
fn a_pinned_column_on_a_slide_buckles_at_its_euler_load() {
    let (ei, l) = (1000.0, 2.0);
    let euler = PI * PI * ei / (l * l);
    let text = format!(
        r#"
        environment.gravity = 0
        [line_types.column]
        kind = "general"
        outer_diameter = "0.02 m"
        mass = "3 kg/m"
        axial_stiffness = "40 MN"
        bending_stiffness = {ei:?}
        [anchors.foot]
        position = [0, 0, 0]
        [anchors.guide]
        position = [0, 0, {l:?}]
        [lines.column]
        sections = [{{ type = "column", length = {l:?}, elements = 20 }}]
        end_a = {{ to = "foot", joint = "hinge", direction = [0, 0, 1] }}
        end_b = {{ to = "guide", joint = "hinge", direction = [0, 0, 1], slides_along = [0, 0, 1] }}
        [loads.press]
        on = "column"
        at = {l:?}
        force = [0, 0, {press:?}]
        [path]
        range = [0, 1.5]
        "#,
        press = -euler,
    );
    let found = follow(&text);
    let branch = found
        .points
        .iter()
        .find(|point| point.event == Some(PathEvent::Bifurcation))
        .unwrap();
    // The hinges let it buckle in one plane. A pinned chain of N links buckles at
    // (2 N / pi)^2 sin^2(pi / 2 N) of the Euler load; the last shortened step leaves 1e-4.
    let links: f64 = 20.0;
    let chain = (2.0 * links / PI * (0.5 * PI / links).sin()).powi(2);
    assert_near("factor", branch.factor, chain, 1e-4);
    assert_eq!(branch.unstable, 1);
    assert_near(
        "foot",
        found.at(1.5, "column.end_a.force_z"),
        -1.5 * euler,
        1e-6 * euler,
    );
    assert_near(
        "guide",
        found.at(1.5, "column.end_b.force_z"),
        0.0,
        1e-6 * euler,
    );
}

/// Two stiff bars that meet at a body above the middle of their feet: half span b, rise h.
fn two_bars(b: f64, h: f64, ea: f64, load: f64, path: &str) -> String {
    let length = b.hypot(h);
    format!(
        r#"
        environment.gravity = 0
        [line_types.bar]
        kind = "general"
        outer_diameter = "0.05 m"
        mass = "10 kg/m"
        axial_stiffness = {ea:?}
        bending_stiffness = {ei:?}
        [anchors.left]
        position = [{left:?}, 0, 0]
        [anchors.right]
        position = [{b:?}, 0, 0]
        [bodies.top]
        mass = "1 kg"
        initial_position = [0, 0, {h:?}]
        [lines.first]
        sections = [{{ type = "bar", length = {length:?}, elements = 3 }}]
        end_a = {{ to = "left", joint = "hinge", direction = [{b:?}, 0, {h:?}] }}
        end_b = {{ to = "top", joint = "hinge", direction = [{b:?}, 0, {h:?}] }}
        [lines.second]
        sections = [{{ type = "bar", length = {length:?}, elements = 3 }}]
        end_a = {{ to = "top", joint = "hinge", direction = [{b:?}, 0, {down:?}] }}
        end_b = {{ to = "right", joint = "hinge", direction = [{b:?}, 0, {down:?}] }}
        [loads.weight]
        on = "top"
        force = [0, 0, {force:?}]
        {path}
        "#,
        left = -b,
        down = -h,
        ei = 10.0 * ea,
        force = -load,
    )
}

#[test]
fn val_two_bars_snap_through() {
    let (b, h, ea) = (2.0, 0.5, 1e6);
    let length = f64::hypot(b, h);
    // Each bar keeps its line and its force EA (L0 - L) / L0: P(z) = 2 EA (1/L - 1/L0) z.
    let load = |z: f64| 2.0 * ea * (1.0 / b.hypot(z) - 1.0 / length) * z;
    // dP/dz = 0 where L^3 = L0 b^2.
    let critical = (length * b * b).cbrt();
    let top = (critical * critical - b * b).sqrt();
    let limit = load(top);
    let found = follow(&two_bars(b, h, ea, limit, "[path]\nrange = [-1.5, 1.5]"));
    let z = found.channel("top.z");
    for (point, z) in found.points.iter().zip(&z) {
        assert_near("factor", point.factor, load(*z) / limit, 1e-6);
    }
    let limits: Vec<(f64, f64)> = found
        .points
        .iter()
        .zip(&z)
        .filter(|(point, _)| point.event == Some(PathEvent::Limit))
        .map(|(point, z)| (point.factor, *z))
        .collect();
    assert_eq!(limits.len(), 2, "{limits:?}");
    for (found, sign) in limits.iter().zip([1.0, -1.0]) {
        // The factor is flat there: a slope of 1e-7 is a factor within 1e-12.
        assert_near("limit load", found.0, sign, 1e-8);
        assert_near("height", found.1, sign * top, 1e-5);
    }
    assert!(
        found
            .points
            .iter()
            .all(|p| p.event != Some(PathEvent::Bifurcation))
    );
    assert_eq!(found.report.unwrap().end, PathEnd::Range);
    // It ends below, hanging, under the full load.
    assert_near("end", found.points.last().unwrap().factor, 1.5, 1e-12);
    assert!(z[z.len() - 1] < -h);
}
