//! Frequencies of hanging and taut lines against closed forms, and the numbers of their modes.

mod common;

use std::f64::consts::{PI, TAU};

use catenix_engine::{Mode, ModeKind, Modes, Motion};
use catenix_model::{ModeRange, ModeSettings};
use common::{G, assert_near, lowest_modes, model, modes};

/// Water that is next to nothing: lines hang in vacuum.
const VACUUM: &str = r#"environment.water = { density = 1e-6, depth = "3 km" }"#;
const LENGTH: f64 = 100.0;
const MASS: f64 = 20.0;
const AXIAL: f64 = 4e9;

/// A line that hangs straight down, with a mass at its lower end.
fn hanging(elements: usize, bottom_mass: f64, more: &str, joint: &str) -> String {
    // A body, not an attachment: the half element above it then has its extension.
    let (body, end) = if bottom_mass > 0.0 {
        (
            format!("[bodies.clump]\nmass = {bottom_mass:?}\nvolume = 1e-6"),
            "end_b.to = \"clump\"",
        )
    } else {
        (String::new(), "")
    };
    format!(
        r#"
        {VACUUM}
        [line_types.line]
        kind = "general"
        outer_diameter = "0.05 m"
        mass = {MASS:?}
        axial_stiffness = {AXIAL:?}
        normal_added_mass = 0
        {more}
        [anchors.top]
        position = [0, 0, -10]
        {body}
        [lines.line]
        sections = [{{ type = "line", length = {LENGTH:?}, elements = {elements} }}]
        {end}
        end_a = {{ to = "top", joint = "{joint}", direction = [0, 0, -1] }}
        "#
    )
}

/// Frequencies of the vibrations that move mostly in one way.
fn frequencies(found: &Modes<'_>, motion: Motion) -> Vec<f64> {
    let moves = |mode: &&Mode| mode.kind == ModeKind::Vibration && mode.motions[0].0 == motion;
    let vibrations = found.modes.iter().filter(moves);
    vibrations.map(Mode::frequency_hz).collect()
}

/// J0, J1, Y0 and Y1 by their power series (Abramowitz and Stegun 9.1.10 and 9.1.13), good to nine
/// digits for arguments below 15.
fn bessel(x: f64) -> [f64; 4] {
    let y = 0.25 * x * x;
    let (mut j0, mut j1, mut sum0, mut sum1) = (0.0, 0.0, 0.0, 0.0);
    let (mut term0, mut term1, mut harmonic) = (1.0, 0.5 * x, 0.0);
    for k in 0..80 {
        let kf = f64::from(k);
        if k > 0 {
            term0 *= -y / (kf * kf);
            term1 *= -y / (kf * (kf + 1.0));
            harmonic += 1.0 / kf;
        }
        j0 += term0;
        j1 += term1;
        sum0 += term0 * harmonic;
        sum1 += term1 * (2.0 * harmonic + 1.0 / (kf + 1.0));
    }
    let log = (0.5 * x).ln() + 0.577_215_664_901_532_9;
    let y0 = 2.0 / PI * (log * j0 - sum0);
    let y1 = 2.0 / PI * log * j1 - 2.0 / (PI * x) - sum1 / PI;
    [j0, j1, y0, y1]
}

/// The first roots of a function of the frequency in hertz, by steps and bisection.
fn roots(count: usize, step: f64, value: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut at = step;
    while found.len() < count {
        let (mut low, mut high) = (at, at + step);
        if value(low) * value(high) < 0.0 {
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if value(middle) * value(low) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            found.push(low);
        }
        at += step;
    }
    found
}

/// Errors at two meshes, the finer with twice the elements, show second order, and the finer one
/// is within `within`.
#[track_caller]
fn assert_second_order(what: &str, coarse: &[f64], fine: &[f64], exact: &[f64], within: f64) {
    for (n, exact) in exact.iter().enumerate() {
        let errors = [coarse[n], fine[n]].map(|found| found / exact - 1.0);
        assert!(errors[1].abs() < within, "{what} {n}: {errors:?}");
        let order = (errors[0] / errors[1]).log2();
        assert_near(
            &format!("{what} {n}: order of {errors:?}"),
            order,
            2.0,
            0.15,
        );
    }
}

/// omega_n = (j0n / 2) sqrt(g / L). Source: docs/theory/modes.md, eq. (20).
#[test]
fn val_hanging_chain_bessel_zeros() {
    let zeros = [2.404_825_557_7, 5.520_078_110_3, 8.653_727_912_9];
    let exact = zeros.map(|zero| 0.5 * zero * (G / LENGTH).sqrt() / TAU);
    let [coarse, fine] = [20, 40].map(|elements| {
        let found = lowest_modes(&model(&hanging(elements, 0.0, "", "ball")), 6);
        let vibrates = |mode: &Mode| mode.kind == ModeKind::Vibration;
        assert!(found.modes.iter().all(vibrates));
        frequencies(&found, Motion::X)
    });
    // The first is a pendulum, to which equation (26) of docs/theory/dem.md leaves 1e-5.
    assert_near("first", fine[0], exact[0], 1e-4 * exact[0]);
    assert_second_order("chain", &coarse[1..], &fine[1..], &exact[1..], 3e-3);
}

/// A chain with a mass at its end: Bessel functions of both kinds.
/// Source: docs/theory/modes.md, eq. (21).
#[test]
fn val_lift_pipe_with_bottom_mass() {
    let clump = 3000.0;
    let (weight, lowest) = (MASS * G, clump * G);
    let exact = roots(3, 0.01, |hz| {
        let omega = TAU * hz;
        let at = |tension: f64| bessel(2.0 * omega * (MASS * tension).sqrt() / weight);
        let [top_j0, _, top_y0, _] = at(lowest + weight * LENGTH);
        let [j0, j1, y0, y1] = at(lowest);
        let root = (MASS * lowest).sqrt();
        let bottom_j = clump * omega * j0 - root * j1;
        let bottom_y = clump * omega * y0 - root * y1;
        top_j0 * bottom_y - top_y0 * bottom_j
    });
    let [coarse, fine] = [20, 40].map(|elements| {
        let found = lowest_modes(&model(&hanging(elements, clump, "", "ball")), 6);
        frequencies(&found, Motion::X)
    });
    assert_near("first", fine[0], exact[0], 1e-4 * exact[0]);
    assert_second_order("pipe", &coarse[1..], &fine[1..], &exact[1..], 3e-3);
}

/// beta tan beta = m L / M. Source: docs/theory/modes.md, eq. (22).
#[test]
fn val_axial_vibration_with_end_mass() {
    let clump = 3000.0;
    let speed = (AXIAL / MASS).sqrt();
    // The tangent jumps at odd quarters: written with sine and cosine.
    let exact = roots(3, 0.5, |hz| {
        let beta = TAU * hz * LENGTH / speed;
        beta * beta.sin() - MASS * LENGTH / clump * beta.cos()
    });
    let settings = ModeSettings {
        range: ModeRange::Band {
            from_hz: 0.8 * exact[0],
            to_hz: 1.05 * exact[2],
        },
        added_mass: true,
    };
    let [coarse, fine] = [20, 40].map(|elements| {
        let found = modes(&model(&hanging(elements, clump, "", "ball")), &settings);
        // The first is mostly that of the body, which moves along z.
        let mut axial = frequencies(&found, Motion::Z);
        axial.extend(frequencies(&found, Motion::Axial));
        axial
    });
    assert_eq!(fine.len(), 3);
    assert_near("first", fine[0], exact[0], 1e-4 * exact[0]);
    assert_second_order("axial", &coarse[1..], &fine[1..], &exact[1..], 5e-3);
}

/// f = (2 n - 1) / 4 L sqrt(GJ / j). Source: docs/theory/modes.md, eq. (22).
#[test]
fn val_torsion_of_a_clamped_line() {
    let more = r#"
        bending_stiffness = "200 kN m^2"
        torsional_stiffness = "100 kN m^2"
        polar_inertia = 2.0
        structural_damping = "0.02 s"
    "#;
    let exact = [1.0, 3.0, 5.0].map(|n| n / (4.0 * LENGTH) * (1e5f64 / 2.0).sqrt());
    let settings = ModeSettings {
        range: ModeRange::Band {
            from_hz: 0.3,
            to_hz: 3.0,
        },
        added_mass: true,
    };
    let [coarse, fine] = [20, 40].map(|elements| {
        let found = modes(&model(&hanging(elements, 0.0, more, "fixed")), &settings);
        let torsion: Vec<Mode> = found.modes.clone();
        for mode in torsion
            .iter()
            .filter(|mode| mode.motions[0].0 == Motion::Torsion)
        {
            // Damping in proportion to stiffness: zeta = tau omega / 2.
            let zeta = 0.5 * 0.02 * mode.omega_squared.sqrt();
            assert_near("damping ratio", mode.damping_ratio, zeta, 1e-6);
        }
        frequencies(&found, Motion::Torsion)
    });
    assert_second_order("torsion", &coarse, &fine, &exact, 2e-3);
}

/// A taut string, weightless in water: added mass lowers all frequencies by one factor.
#[test]
fn a_strings_frequencies_fall_with_the_root_of_its_added_mass() {
    let density = 40.0 / (0.25 * PI * 0.2f64.powi(2));
    let text = format!(
        r#"
        environment.water = {{ density = {density:?}, depth = "100 m" }}
        [line_types.string]
        kind = "general"
        outer_diameter = "0.2 m"
        mass = 40
        axial_stiffness = "10 MN"
        normal_added_mass = 1.0
        [anchors]
        left.position = [0, 0, -50]
        right.position = [100.1, 0, -50]
        [lines.string]
        sections = [{{ type = "string", length = "100 m", elements = 30 }}]
        end_a.to = "left"
        end_b.to = "right"
        "#
    );
    let model = model(&text);
    let [water, air] = [true, false].map(|added_mass| {
        let settings = ModeSettings {
            range: ModeRange::Lowest(10),
            added_mass,
        };
        let found = modes(&model, &settings);
        assert_eq!(found.added_mass, added_mass);
        frequencies(&found, Motion::Y)
    });
    assert!(water.len() >= 4 && air.len() >= 4);
    for (water, air) in water.iter().zip(&air) {
        // Mass and added mass are both 40 kg/m; rounding in the stiff springs.
        assert_near("ratio", air / water, 2f64.sqrt(), 1e-6);
    }
    // T = EA 0.001; 30 elements are (k l)^2 / 24 too high.
    let exact = 0.5 / 100.1 * (1e7 * 1e-3 / (40.0 / 1.001_f64)).sqrt();
    assert_near(
        "first in air",
        air[0] / exact - 1.0,
        (PI / 30.0).powi(2) / 24.0,
        1e-5,
    );
}

/// Every bending mode of a round pipe comes twice; none of a hundred is missed among 10 000
/// elements.
#[test]
fn a_pipe_of_ten_thousand_elements_gives_its_modes_in_whole_pairs() {
    let text = r#"
        environment.water = { density = 1025, depth = "12 km" }
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.3 m"
        inner_diameter = "0.26 m"
        youngs_modulus = "206 GPa"
        density = 7850
        [anchors.ship]
        position = [0, 0, -2]
        [lines.pipe]
        sections = [{ type = "pipe", length = "10 km", elements = 10000 }]
        end_a = { to = "ship", joint = "ball" }
    "#;
    let found = lowest_modes(&model(text), 100);
    let vibrations: Vec<&Mode> = found
        .modes
        .iter()
        .filter(|mode| mode.kind == ModeKind::Vibration)
        .collect();
    // One free spin; the count holds what was asked for and a few more.
    assert_eq!(found.modes.len(), vibrations.len() + 1);
    assert!(vibrations.len() >= 100 && found.proof.counted >= found.modes.len());
    let along = |motion: Motion| frequencies(&found, motion);
    let (x, y, axial) = (along(Motion::X), along(Motion::Y), along(Motion::Axial));
    assert_eq!(x.len(), y.len());
    assert_eq!(
        x.len() + y.len() + axial.len() + along(Motion::Torsion).len(),
        vibrations.len()
    );
    let equal = vibrations
        .iter()
        .filter(|mode| mode.equals_previous)
        .count();
    assert_eq!(equal, x.len());
    // The chain with bending is the string of eq. (20) to a few parts in a thousand.
    let reduced = 1.0 - 1025.0 * 0.25 * PI * 0.09 / found.total_mass_kg[2] * 1e4;
    let in_water = found.total_mass_kg[2] / found.total_mass_kg[0];
    let first = 0.5 * 2.404_825_557_7 * (G * reduced * in_water / 1e4).sqrt() / TAU;
    assert_near("first", x[0], first, 5e-3 * first);
}
