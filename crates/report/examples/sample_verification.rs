//! Writes the report of a made-up suite, to look at:
//! `cargo run -p catenix-report --example sample_verification -- DIR`.
// An example that fails may do so loudly.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::f64::consts::PI;
use std::path::PathBuf;

use catenix_report::write_verification;
use catenix_results::{
    Verification, VerifiedCase, VerifiedConvergence, VerifiedCurve, VerifiedNumber,
};

fn main() {
    let directory = std::env::args().nth(1);
    let directory = PathBuf::from(directory.expect("usage: sample_verification DIR"));
    let cases = vec![cantilever(), midspan(), elastica(), arch(), hose()];
    let report = Verification::new("0.0.0 (made up)", cases);
    write_verification(&report, &directory).unwrap();
}

fn case(name: &str, title: &str, topic: &str) -> VerifiedCase {
    VerifiedCase {
        name: name.into(),
        title: title.into(),
        topic: topic.into(),
        summary: String::new(),
        source: String::new(),
        passed: true,
        error: None,
        numbers: Vec::new(),
        curves: Vec::new(),
        convergences: Vec::new(),
        estimates: Vec::new(),
        formulation: "dem".into(),
        refused: Vec::new(),
        cpu_seconds: 3.21,
    }
}

fn number(name: &str, unit: &str, reference: f64, computed: f64, tolerance: f64) -> VerifiedNumber {
    let error = (computed - reference).abs() / reference.abs();
    VerifiedNumber {
        name: name.into(),
        unit: unit.into(),
        reference,
        computed: Some(computed),
        error: Some(error),
        scale: reference,
        tolerance,
        reason: "Twice the error of the mesh, which falls with its third power.".into(),
        passed: Some(error <= tolerance),
    }
}

fn convergence(name: &str, order: f64, least_order: f64) -> VerifiedConvergence {
    let x = vec![5.0, 10.0, 20.0, 40.0, 80.0];
    let wobble = [1.15, 0.97, 1.02, 0.99, 1.0];
    let error = |(n, wobble): (&f64, f64)| wobble * 0.8 * n.powf(-order);
    VerifiedConvergence {
        name: name.into(),
        x_label: "elements".into(),
        errors: x.iter().zip(wobble).map(error).collect(),
        x,
        order: order + 0.03,
        least_order,
        reason: "The half springs at a clamp lose one order against the interior.".into(),
        passed: order > least_order,
    }
}

fn cantilever() -> VerifiedCase {
    let frequencies = [2.9084, 18.2267, 51.0352, 100.0087, 165.3216, 246.9618];
    let numbers = frequencies.iter().zip(1..).map(|(hz, mode)| {
        let off = 2e-8 * f64::from(mode).powi(5);
        number(
            &format!("frequency {mode}, stiff plane"),
            "Hz",
            *hz,
            hz * (1.0 + off),
            1e-4,
        )
    });
    VerifiedCase {
        summary: "A steel cantilever of 1.5 m, 6 mm x 8 mm, vibrates in both planes. Six natural \
                  frequencies in each show the accuracy of the bending stiffness at a clamp."
            .into(),
        source: "Frequencies of the Euler-Bernoulli cantilever, `beta_n L` = 1.8751, 4.6941, \
                 7.8548 (Blevins, *Formulas for Natural Frequency and Mode Shape*, 1979, \
                 [table 8-1](https://example.org/blevins)).\n\n\
                 Given: E 2.0e11 Pa, L 1.5 m. Assumed: density 7800 kg/m3, which the paper does \
                 not print.\n\n| plane | EI [N m2] |\n| --- | --: |\n| stiff | 51.2 |\n| weak | 28.8 |\n"
            .into(),
        numbers: numbers.collect(),
        passed: false,
        convergences: vec![
            convergence("First frequency", 3.0, 2.8),
            convergence("Sixth frequency", 4.0, 2.8),
            convergence("Tip under a force, plain springs", 1.97, 2.8),
        ],
        ..case("cantilever-frequencies", "Frequencies of a cantilever", "Vibration")
    }
}

fn midspan() -> VerifiedCase {
    let t: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
    let response =
        |t: f64, off: f64| 1.1e-3 * ((44.0 * (1.0 + off) * t).sin() - 0.99 * (44.424 * t).sin());
    let curve = |name: &str, off: f64, passed| VerifiedCurve {
        name: name.into(),
        x_label: "time [s]".into(),
        y_label: "deflection at midspan [m]".into(),
        computed: t.iter().map(|t| response(*t, off)).collect(),
        reference: t.iter().map(|t| response(*t, 0.0)).collect(),
        x: t.clone(),
        error: 300.0 * off,
        tolerance: 1e-2,
        reason: "Twice the error of the step of 1 ms, which falls with its square.".into(),
        passed,
    };
    let mut shown = curve(
        "F = 1 N, 1 % off resonance, beyond linear theory",
        2e-3,
        None,
    );
    shown.reason = "The linear peak is 0.18 m on a span of 1.5 m, where stiffening by tension \
                    matters: the series does not hold, and the difference is physics."
        .into();
    VerifiedCase {
        summary: "A simply supported beam is shaken at midspan from rest, without damping.".into(),
        source: "Modal series, see *docs/theory*.".into(),
        curves: vec![
            curve("F = 0.01 N at 44 rad/s", 2e-5, Some(true)),
            curve("F = 0.01 N at 44 rad/s, coarse step", 8e-5, Some(false)),
            shown,
        ],
        passed: false,
        convergences: vec![VerifiedConvergence {
            x_label: "step [s]".into(),
            x: vec![0.004, 0.002, 0.001, 0.0005, 0.00025],
            errors: vec![8e-2, 2.1e-2, 5.2e-3, 1.3e-3, 3.2e-4],
            order: 1.99,
            ..convergence("Deflection after 10 s", 2.0, 1.9)
        }],
        ..case(
            "midspan-response",
            "Forced response at midspan",
            "Vibration",
        )
    }
}

fn elastica() -> VerifiedCase {
    let loads: Vec<f64> = (0..=20).map(|i| 0.5 * f64::from(i)).collect();
    let deflection = |load: f64| 0.82 * (1.0 - (-load / 2.4).exp());
    let mut no_value = number("drop at P L2 / E I = 10", "m", 0.810609, 0.8, 1e-6);
    no_value.computed = None;
    no_value.error = None;
    no_value.passed = Some(false);
    let mut shown = number("rotation of the tip", "rad", 0.461352, 0.461352, 1e-6);
    shown.passed = None;
    shown.reason = "Shown for comparison with other programs.".into();
    let mut scaled = number("sideways motion", "m", 1e-7, 3e-7, 1e-6);
    scaled.scale = 1.5;
    scaled.error = Some(1.4e-7);
    scaled.passed = Some(true);
    scaled.reason = "Rounding: the motion is zero by symmetry.".into();
    VerifiedCase {
        summary: "A cantilever bends under a force at its tip that keeps its direction.".into(),
        source: "Mattiasson (1981), *Numerical results from large deflection beam and frame \
                 problems analysed by means of elliptic integrals*, doi \
                 <https://doi.org/10.1002/nme.1620170113>.\n\n- w/L: table 1\n- u/L: table 1\n"
            .into(),
        error: Some("The load case `p10` ended at the load factor 0.83: no equilibrium.".into()),
        passed: false,
        numbers: vec![
            number("drop at P L2 / E I = 1", "m", 0.301721, 0.3017214, 1e-5),
            number("drop at P L2 / E I = 2", "m", 0.493457, 0.493471, 1e-5),
            no_value,
            shown,
            scaled,
        ],
        curves: vec![VerifiedCurve {
            name: "Drop of the tip".into(),
            x_label: "load P L2 / (E I) [-]".into(),
            y_label: "drop over length [-]".into(),
            computed: loads
                .iter()
                .map(|p| deflection(*p) + 4e-6 * (9.0 * p).sin())
                .collect(),
            reference: loads.iter().map(|p| deflection(*p)).collect(),
            x: loads,
            error: 4.9e-6,
            tolerance: 1e-5,
            reason: "Rounding of the table in its sixth digit.".into(),
            passed: Some(true),
        }],
        ..case(
            "elastica-tip-load",
            "Elastica under a tip load",
            "Large deflections",
        )
    }
}

fn arch() -> VerifiedCase {
    let angle: Vec<f64> = (0..=200).map(|i| 0.01 * PI * f64::from(i)).collect();
    VerifiedCase {
        summary: "A deep arch, clamped at one end and hinged at the other, under a load at its \
                  crown, through two limit points."
            .into(),
        numbers: vec![number("limit load", "N", 897.0, 897.29, 1e-3)],
        curves: vec![VerifiedCurve {
            name: "Equilibrium path".into(),
            x_label: "drop of the crown [m]".into(),
            y_label: "load [N]".into(),
            x: angle
                .iter()
                .map(|a| 40.0 * a + 30.0 * (2.0 * a).sin())
                .collect(),
            computed: angle.iter().map(|a| 897.3e3 * a.sin()).collect(),
            reference: angle.iter().map(|a| 897.0e3 * a.sin()).collect(),
            error: 3.3e-4,
            tolerance: 1e-3,
            reason: "Digits of the publication.".into(),
            passed: Some(true),
        }],
        estimates: Vec::new(),
        formulation: "dem".into(),
        refused: Vec::new(),
        cpu_seconds: 125.7,
        ..case(
            "deep-arch",
            "Deep arch through its limit points",
            "Large deflections",
        )
    }
}

fn hose() -> VerifiedCase {
    VerifiedCase {
        summary: "Nothing has a verdict here.".into(),
        source: "Lowe and Langley (2006).".into(),
        numbers: vec![VerifiedNumber {
            passed: None,
            reason: "Another program, another drag: shown, not judged.".into(),
            ..number("largest tension at the top, surge", "kN", 52.24, 52.31, 0.0)
        }],
        ..case(
            "hose-in-waves",
            "Flexible hose with a moved top",
            "Risers and hoses",
        )
    }
}
