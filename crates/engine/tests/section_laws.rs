//! Bending and axial laws given by points, against closed forms and integrated equations.

mod common;

use std::f64::consts::PI;

use catenix_model::LineQuantity;
use common::{Statics, assert_near, model, run, statics};

/// Weightless cantilever of 2 m along x with a weight at its tip.
const LENGTH: f64 = 2.0;
/// First slope of the bending law [N m2], moment and slope after the kink.
const FIRST: f64 = 1e4;
const KINK: f64 = 20.0;

struct Bilinear {
    /// Slope after the kink [N m2].
    second: f64,
    tip_weight: f64,
    elements: usize,
}

impl Bilinear {
    fn text(&self) -> String {
        let Bilinear {
            second,
            tip_weight,
            elements,
        } = self;
        let kink = KINK / FIRST;
        format!(
            r#"
            environment.water = {{ density = {fluid:?}, depth = "1000 m" }}
            [line_types.bar]
            kind = "general"
            outer_diameter = 1
            mass = 1
            axial_stiffness = {axial:?}
            bending_law = [
                {{ curvature = {kink:?}, moment = {KINK:?} }},
                {{ curvature = {after:?}, moment = {moment:?} }},
            ]
            [anchors.wall]
            position = [0, 0, -3]
            [lines.beam]
            sections = [{{ type = "bar", length = {LENGTH:?}, elements = {elements} }}]
            attachments.load = {{ at = {LENGTH:?}, mass = {mass:?}, volume = 0 }}
            end_a = {{ to = "wall", joint = "fixed", direction = [1, 0, 0] }}
            "#,
            fluid = 4.0 / PI,
            axial = 1e6 * tip_weight,
            after = 2.0 * kink,
            moment = KINK + second * kink,
            mass = tip_weight / common::G,
        )
    }

    fn solve(&self) -> Statics {
        statics(&model(&self.text()))
    }

    fn curvature(&self, moment: f64) -> f64 {
        if moment.abs() <= KINK {
            moment / FIRST
        } else {
            moment.signum() * (KINK / FIRST + (moment.abs() - KINK) / self.second)
        }
    }

    /// Small deflections: w = integral of curvature times distance from the tip. With the moment
    /// P s at the distance s from the tip and the kink at s_k = M_k / P,
    /// w = P L^3 / 3 B_1 + (1 / B_2 - 1 / B_1) (P (L^3 - s_k^3) / 3 - M_k (L^2 - s_k^2) / 2).
    fn linear_deflection(&self) -> f64 {
        let p = self.tip_weight;
        let kink = (KINK / p).min(LENGTH);
        let [l2, l3] = [2, 3].map(|n| LENGTH.powi(n));
        let more = 1.0 / self.second - 1.0 / FIRST;
        p * l3 / (3.0 * FIRST)
            + more * (p * (l3 - kink.powi(3)) / 3.0 - 0.5 * KINK * (l2 - kink * kink))
    }

    /// Large deflections: theta' = curvature(M), M' = -P cos(theta), by shooting for M = 0 at the
    /// tip. Returns drop and shortening.
    fn shoot(&self) -> [f64; 2] {
        let end = |moment: f64| {
            let mut state = [0.0, moment, 0.0, 0.0];
            let rate = |s: [f64; 4]| {
                let (sin, cos) = s[0].sin_cos();
                [self.curvature(s[1]), -self.tip_weight * cos, cos, sin]
            };
            let steps = 20_000;
            let h = LENGTH / f64::from(steps);
            let moved = |s: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| s[i] + h * k[i]);
            for _ in 0..steps {
                // The midpoint rule: the kink spoils higher orders, and steps are cheap.
                let middle = moved(state, rate(state), 0.5 * h);
                state = moved(state, rate(middle), h);
            }
            state
        };
        let (mut low, mut high) = (0.0, self.tip_weight * LENGTH);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if end(middle)[1] > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let [_, _, x, w] = end(0.5 * (low + high));
        [w, LENGTH - x]
    }
}

fn tip(statics: &Statics) -> [f64; 2] {
    let (x, z) = (
        statics.fields[0].get(LineQuantity::X),
        statics.fields[0].get(LineQuantity::Z),
    );
    [-3.0 - z[z.len() - 1], LENGTH - x[x.len() - 1]]
}

#[test]
fn a_bilinear_cantilever_under_a_small_load() {
    let errors = [20, 40, 80].map(|elements| {
        let beam = Bilinear {
            second: 2e3,
            tip_weight: 15.0,
            elements,
        };
        (tip(&beam.solve())[0] / beam.linear_deflection() - 1.0).abs()
    });
    // The kink of the curvature lies anywhere between two nodes: second order, with a factor that
    // depends on where.
    for (error, elements) in errors.iter().zip([20.0f64, 40.0, 80.0]) {
        assert!(*error < 0.3 / elements.powi(2), "{errors:?}");
    }
}

#[test]
fn a_bilinear_cantilever_under_a_large_load() {
    for (second, load) in [(2e3, 600.0), (50.0, 20.0), (10.0, 12.0), (1.0, 11.0)] {
        let errors = [20, 40, 80].map(|elements| {
            let beam = Bilinear {
                second,
                tip_weight: load,
                elements,
            };
            let statics = beam.solve();
            let expected = beam.shoot();
            let found = tip(&statics);
            println!(
                "{second} {load} {elements}: {found:?} {expected:?} {}",
                statics.iterations
            );
            let moment = statics.fields[0].get(LineQuantity::BendMoment);
            let curvature = statics.fields[0].get(LineQuantity::Curvature);
            for (m, k) in moment.iter().zip(curvature) {
                assert_near("curvature", *k, beam.curvature(*m), 1e-9 * (1.0 + k.abs()));
            }
            (found[0] - expected[0]).hypot(found[1] - expected[1])
        });
        // The trapezoidal rule errs by a kink of P / B_2 in the slope of the curvature, times
        // l^2 / 8, over an arm of at most L.
        for (error, elements) in errors.iter().zip([20.0, 40.0, 80.0]) {
            let kink = load / second * (LENGTH / elements).powi(2) / 8.0 * LENGTH;
            assert!(*error < kink, "{second} N m2, {load} N: {errors:?}");
        }
    }
}

#[test]
fn a_bar_with_a_tabulated_axial_law_hangs_under_its_own_weight() {
    // In air-like water: density 1e-3. w = 20 kg/m times g; T = w s at s above the free end.
    let (length, mass) = (100.0, 20.0);
    let text = |elements: usize| {
        format!(
            r#"
            environment.water = {{ density = 1e-9, depth = "1000 m" }}
            [line_types.rope]
            kind = "general"
            outer_diameter = "0.1 m"
            mass = {mass:?}
            axial_law = [
                {{ strain = 0.01, tension = "5 kN" }},
                {{ strain = 0.05, tension = "9 kN" }},
                {{ strain = 0.06, tension = "15 kN" }},
            ]
            [anchors.top]
            position = [0, 0, -100]
            [lines.rope]
            sections = [{{ type = "rope", length = {length:?}, elements = {elements} }}]
            end_a = {{ to = "top" }}
            "#
        )
    };
    let strain = |t: f64| {
        if t < 5e3 {
            0.01 * t / 5e3
        } else if t < 9e3 {
            0.01 + 0.04 * (t - 5e3) / 4e3
        } else {
            0.05 + 0.01 * (t - 9e3) / 6e3
        }
    };
    // Extension = integral of strain(w s) ds: trapezoids between the kinks, each exact.
    let weight = mass * common::G;
    let places = [0.0, 5e3 / weight, 9e3 / weight, length];
    let expected: f64 = places
        .windows(2)
        .map(|p| 0.5 * (strain(weight * p[0]) + strain(weight * p[1])) * (p[1] - p[0]))
        .sum();
    for elements in [10, 20, 40, 80] {
        let statics = statics(&model(&text(elements)));
        let z = statics.fields[0].get(LineQuantity::Z);
        // Two kinks in the strain over the length, of 8e-6 1/N times the weight, times l^2 / 8.
        let kinks = 2.0 * 8e-6 * weight * (length / elements as f64).powi(2) / 8.0;
        assert_near("extension", -100.0 - length - z[elements], expected, kinks);
        let tension = statics.fields[0].get(LineQuantity::EffectiveTension)[0];
        // The weight of the whole, less what is left in its thin water.
        assert_near("tension", tension, weight * length, 1e-6 * weight * length);
    }
}

#[test]
fn a_yielding_hose_in_motion_keeps_its_energy_account() {
    let text = r#"
        environment.water = { depth = "200 m" }
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.3 m"
        mass = "90 kg/m"
        axial_law = [
            { strain = -0.01, tension = "-10 kN" },
            { strain = 0.001, tension = "10 kN" },
            { strain = 0.03, tension = "100 kN" },
        ]
        bending_law = [
            { curvature = 0.02, moment = "2 kN m" },
            { curvature = 0.2, moment = "4 kN m" },
        ]
        structural_damping = "0.02 s"
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "3 m"
        period = "8 s"
        ramp = "8 s"
        [vessels.ship]
        position = [0, 0, -5]
        motions = ["heave"]
        [anchors.base]
        position = [40, 5, -45]
        [lines.hose]
        sections = [
            { type = "hose", length = "20 m", elements = 20, natural_curvature_y = 0.05, natural_twist = 0.02 },
            { type = "hose", length = "50 m", elements = 30 },
        ]
        end_a = { to = "ship", joint = "fixed", direction = [1, 0, 0] }
        end_b = { to = "base", joint = "universal", direction = [0, 0, -1] }
        [dynamics]
        duration = "40 s"
    "#;
    let run = run(&model(text));
    run.assert_sound(40.0, 1e-3);
}
