//! Beams: elastica, tip deflections and frequencies, with the orders of convergence in the element.

mod common;

use std::f64::consts::PI;

use catenix_model::{LineQuantity, StepControl};
use common::{assert_near, lowest_modes, model, run, statics};

/// Observed order between successive halvings, from their errors.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors
        .windows(2)
        .map(|pair| (pair[0] / pair[1]).log2())
        .collect()
}

/// A cantilever from the origin along x, weightless in its fluid: no drag, no added mass.
struct Cantilever {
    /// Bending stiffness [N m2], length [m] and elements of each section.
    sections: Vec<(f64, f64, usize)>,
    /// Weight at the tip [N].
    tip_weight: f64,
}

impl Cantilever {
    const MASS_PER_LENGTH: f64 = 0.3744;

    fn text(&self) -> String {
        let density = Self::MASS_PER_LENGTH / (0.25 * PI * 0.01f64.powi(2));
        let mut types = String::new();
        let mut sections = Vec::new();
        let mut length = 0.0;
        for (k, (stiffness, span, elements)) in self.sections.iter().enumerate() {
            types += &format!(
                r#"
                [line_types.part_{k}]
                kind = "general"
                outer_diameter = "0.01 m"
                mass = {mass:?}
                axial_stiffness = "9.6 MN"
                bending_stiffness = {stiffness:?}
                normal_drag = 0
                axial_drag = 0
                normal_added_mass = 0
                "#,
                mass = Self::MASS_PER_LENGTH,
            );
            sections.push(format!(
                r#"{{ type = "part_{k}", length = {span:?}, elements = {elements} }}"#
            ));
            length += span;
        }
        let attachments = if self.tip_weight > 0.0 {
            format!(
                r#"attachments.load = {{ at = {length:?}, mass = {mass:?}, volume = 0 }}"#,
                mass = self.tip_weight / common::G,
            )
        } else {
            String::new()
        };
        format!(
            r#"
            environment.water = {{ density = {density:?}, depth = "100 m" }}
            {types}
            [motions.jerk]
            kind = "tow"
            legs = [
                {{ start = 0, ramp = 0.2, speed = 0.02, heading = "90 deg" }},
                {{ start = 0.2, ramp = 0.2, speed = 0 }},
            ]
            [vessels.wall]
            position = [0, 0, -2]
            motions = ["jerk"]
            [lines.beam]
            sections = [{sections}]
            {attachments}
            end_a = {{ to = "wall", joint = "fixed", direction = [1, 0, 0] }}
            "#,
            sections = sections.join(", "),
        )
    }

    /// Deflection and shortening of the tip.
    fn tip(&self) -> [f64; 2] {
        let statics = statics(&model(&self.text()));
        let (x, z) = (
            statics.fields[0].get(LineQuantity::X),
            statics.fields[0].get(LineQuantity::Z),
        );
        let length: f64 = self.sections.iter().map(|section| section.1).sum();
        [-2.0 - z[z.len() - 1], length - x[x.len() - 1]]
    }

    /// The elastica: M' = -P cos(theta), theta' = M / EI, by shooting from the wall.
    fn elastica(&self) -> [f64; 2] {
        let shoot = |moment: f64| {
            // theta, M, x, w.
            let mut state = [0.0, moment, 0.0, 0.0];
            for &(stiffness, length, _) in &self.sections {
                let rate = |s: [f64; 4]| {
                    let (sin, cos) = s[0].sin_cos();
                    [s[1] / stiffness, -self.tip_weight * cos, cos, sin]
                };
                let h = length / 500.0;
                let moved =
                    |s: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| s[i] + h * k[i]);
                for _ in 0..500 {
                    let k1 = rate(state);
                    let k2 = rate(moved(state, k1, 0.5 * h));
                    let k3 = rate(moved(state, k2, 0.5 * h));
                    let k4 = rate(moved(state, k3, h));
                    let mean = [0, 1, 2, 3].map(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
                    state = moved(state, mean, h);
                }
            }
            state
        };
        let length: f64 = self.sections.iter().map(|section| section.1).sum();
        let (mut low, mut high) = (0.0, self.tip_weight * length);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if shoot(middle)[1] > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let [_, _, x, w] = shoot(0.5 * (low + high));
        [w, length - x]
    }
}

const STIFF: f64 = 2e11 * 0.006 * 0.008 * 0.008 * 0.008 / 12.0;
const WEAK: f64 = 2e11 * 0.008 * 0.006 * 0.006 * 0.006 / 12.0;

#[test]
fn val_mattiasson_1981_elastica() {
    // P L^2 / EI, then w / L and u / L, six digits.
    for (load, w, u) in [
        (1.0, 0.301_721, 0.056_433),
        (2.0, 0.493_457, 0.160_642),
        (5.0, 0.713_792, 0.387_628),
        (10.0, 0.810_609, 0.554_996),
    ] {
        let beam = Cantilever {
            sections: vec![(STIFF, 1.5, 50)],
            tip_weight: load * STIFF / 2.25,
        };
        let tip = beam.tip();
        // 50 elements: an arc for each is (curvature l)^2 / 24 longer than its chord.
        assert_near("deflection", tip[0] / 1.5, w, 1e-3 * w);
        assert_near("shortening", tip[1] / 1.5, u, 1e-3 * u);
        let own = beam.elastica();
        assert_near("elastica of this file", own[0] / 1.5, w, 1e-6);
        assert_near("elastica of this file", own[1] / 1.5, u, 1e-6);
    }
}

#[test]
fn a_tip_load_is_of_third_order_while_deflections_are_small() {
    let errors = [5, 10, 20].map(|elements| {
        let beam = Cantilever {
            sections: vec![(STIFF, 1.5, elements)],
            tip_weight: 0.02 * STIFF / 2.25,
        };
        (beam.tip()[0] / beam.elastica()[0] - 1.0).abs()
    });
    // The shifted hinge leaves 1 / 24 n^3 at a clamp; large rotations leave second order.
    assert_near("error", errors[0], 1.0 / 3000.0, 0.1 / 3000.0);
    assert!(
        orders(&errors).iter().all(|&order| order > 2.7),
        "{errors:?}"
    );
}

#[test]
fn a_stepped_beam_is_of_third_order_while_deflections_are_small() {
    for swap in [false, true] {
        let errors = [2, 4, 8].map(|elements| {
            let mut sections = vec![(5.0 * STIFF, 0.75, elements), (STIFF, 0.75, 2 * elements)];
            if swap {
                sections.reverse();
            }
            let beam = Cantilever {
                sections,
                tip_weight: 0.02 * STIFF / 2.25,
            };
            (beam.tip()[0] / beam.elastica()[0] - 1.0).abs()
        });
        assert!(
            orders(&errors).iter().all(|&order| order > 2.7),
            "{errors:?}"
        );
    }
}

#[test]
fn large_deflections_are_of_second_order() {
    let errors = [20, 40].map(|elements| {
        let beam = Cantilever {
            sections: vec![(STIFF, 1.5, elements)],
            tip_weight: 2.0 * STIFF / 2.25,
        };
        (beam.tip()[1] / beam.elastica()[1] - 1.0).abs()
    });
    assert!(
        orders(&errors).iter().all(|&order| order > 1.9),
        "{errors:?}"
    );
}

#[test]
fn val_li_2011_cantilever_first_frequencies() {
    // Euler-Bernoulli with 7800 kg/m3: five digits.
    for (stiffness, expected) in [(STIFF, 2.9084), (WEAK, 2.1813)] {
        let beam = Cantilever {
            sections: vec![(stiffness, 1.5, 20)],
            tip_weight: 0.0,
        };
        let text = beam.text()
            + r#"
            [dynamics]
            duration = "8 s"
            [output]
            interval = "0.001 s"
            field_interval = "8 s"
            channels = ["beam.y@1.5m"]
            "#;
        let mut model = model(&text);
        if let Some(dynamics) = &mut model.dynamics {
            dynamics.step = StepControl::Fixed(1e-3);
        }
        let run = run(&model);
        let tip: Vec<f64> = run
            .since("beam.y@1.5m", 1.0)
            .iter()
            .map(|y| y - run.last("wall.y"))
            .collect();
        let crossings: Vec<f64> = (1..tip.len())
            .filter(|&k| tip[k - 1] < 0.0 && tip[k] >= 0.0)
            .map(|k| k as f64 - tip[k] / (tip[k] - tip[k - 1]))
            .collect();
        let spans = (crossings.len() - 1) as f64;
        let frequency = spans / ((crossings[crossings.len() - 1] - crossings[0]) * 1e-3);
        // The step lowers it by 0.18 (omega h)^2, with a spectral radius of 0.4 (1 / 12 and
        // half the square of alpha_f - alpha_m): 6e-5; 20 elements by 1e-5.
        assert_near("frequency", frequency, expected, 1e-4 * expected);
        // The same system by its modes, without the error of the element.
        let mode = lowest_modes(&model, 1).modes[0].frequency_hz();
        assert_near("natural mode", frequency, mode, 8e-5 * mode);
    }
}
