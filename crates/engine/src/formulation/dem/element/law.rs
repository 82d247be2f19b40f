//! What a connector does beyond four numbers: stress-free bend and twist, unlike stiffness about
//! the two normal axes, and laws given by points.
//!
//! Source: docs/theory/sections.md, eqs. (5) to (12).

use crate::formulation::curve::Curve;

/// The general part of a connector's law. A connector without it is straight, linear and the same
/// about all normal axes.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneralLaw {
    /// Bend without moment, about the local y and z half way in twist (2) [rad].
    pub rest_bend: [f64; 2],
    /// Twist without torque [rad].
    pub rest_twist: f64,
    /// Moment by the change of bend.
    pub bending: BendLaw,
    /// Stiffness about local y and z at no moment, for damping and estimates (2) [N m/rad].
    pub initial_bending: [f64; 2],
    /// Tension [N] against extension [m]; `None`: linear.
    pub axial: Option<Curve>,
}

/// Moment by the change of bend.
#[derive(Debug, Clone, PartialEq)]
pub enum BendLaw {
    /// Linear, with stiffness about local y and z (2) [N m/rad].
    Planes([f64; 2]),
    /// The same about all axes: moment [N m] against angle [rad].
    Radial(Curve),
    /// A radial law and a linear one, of unlike planes, in a row.
    Mixed {
        /// Moment [N m] against angle [rad].
        radial: Curve,
        /// Compliance of the linear part about local y and z (2) [rad/N m].
        compliance: [f64; 2],
    },
}

/// Energy of bending with its first and second derivatives by the bend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendStress {
    /// [J]
    pub energy: f64,
    /// Moment about local y and z (2) [N m].
    pub moment: [f64; 2],
    /// By y twice, by y and z, by z twice (3) [N m/rad].
    pub stiffness: [f64; 3],
}

impl BendLaw {
    /// Energy, moment and stiffness at a change of bend (2) [rad].
    pub fn at(&self, [y, z]: [f64; 2]) -> BendStress {
        match self {
            BendLaw::Planes([ky, kz]) => BendStress {
                energy: 0.5 * (ky * y * y + kz * z * z),
                moment: [ky * y, kz * z],
                stiffness: [*ky, 0.0, *kz],
            },
            BendLaw::Radial(curve) => {
                let size = y.hypot(z);
                let point = curve.at(size);
                if size == 0.0 {
                    return BendStress {
                        energy: 0.0,
                        moment: [0.0; 2],
                        stiffness: [point.slope, 0.0, point.slope],
                    };
                }
                let (u, v) = (y / size, z / size);
                let secant = point.value / size;
                let rest = point.slope - secant;
                BendStress {
                    energy: point.energy,
                    moment: [point.value * u, point.value * v],
                    stiffness: [secant + rest * u * u, rest * u * v, secant + rest * v * v],
                }
            }
            BendLaw::Mixed { radial, compliance } => mixed(radial, compliance, [y, z]),
        }
    }
}

/// A radial law and a linear one in a row: the moment is sought at which both bends add up.
///
/// Source: docs/theory/sections.md, eq. (12).
fn mixed(radial: &Curve, compliance: &[f64; 2], bend: [f64; 2]) -> BendStress {
    let moment_at = |ratio: f64| [0, 1].map(|k| bend[k] / (compliance[k] + ratio));
    let size_of = |m: [f64; 2]| m[0].hypot(m[1]);
    let ratio_at = |size: f64| {
        if size > 0.0 {
            radial.inverse(size) / size
        } else {
            1.0 / radial.initial_slope()
        }
    };
    // The moment's size lies between none and what the linear part alone would carry; bisection
    // in it, because the law has kinks.
    let (mut low, mut high) = (0.0, size_of(moment_at(0.0)));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if size_of(moment_at(ratio_at(middle))) > middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    let size = 0.5 * (low + high);
    let ratio = ratio_at(size);
    let moment = moment_at(ratio);
    // Compliance at this moment: linear, secant across and tangent along the moment.
    let (u, v) = if size > 0.0 {
        (moment[0] / size, moment[1] / size)
    } else {
        (1.0, 0.0)
    };
    let angle = radial.inverse(size);
    let point = radial.at(angle);
    let rest = 1.0 / point.slope - ratio;
    let c = [
        compliance[0] + ratio + rest * u * u,
        rest * u * v,
        compliance[1] + ratio + rest * v * v,
    ];
    let determinant = c[0] * c[2] - c[1] * c[1];
    let linear = [0, 1].map(|k| compliance[k] * moment[k] * moment[k]);
    BendStress {
        energy: point.energy + 0.5 * (linear[0] + linear[1]),
        moment,
        stiffness: [c[2], -c[1], c[0]].map(|c| c / determinant),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<BendLaw> {
        let points = [[0.0, 0.0], [0.1, 5.0], [0.4, 8.0], [0.6, 20.0]];
        let radial = Curve::through(&points, 1.0);
        vec![
            BendLaw::Planes([30.0, 80.0]),
            BendLaw::Radial(radial.clone()),
            BendLaw::Mixed {
                radial,
                compliance: [0.01, 0.04],
            },
        ]
    }

    #[test]
    fn moments_and_stiffness_are_derivatives_of_the_energy() {
        for law in laws() {
            for bend in [[0.03, 0.02], [0.2, -0.25], [-0.5, 0.1], [0.4, 0.9]] {
                let stress = law.at(bend);
                let h = 1e-6;
                let moved = |k: usize, h: f64| {
                    let mut bend = bend;
                    bend[k] += h;
                    law.at(bend)
                };
                for k in 0..2 {
                    let (plus, minus) = (moved(k, h), moved(k, -h));
                    let slope = (plus.energy - minus.energy) / (2.0 * h);
                    assert!((slope - stress.moment[k]).abs() < 1e-7, "{law:?} {bend:?}");
                    for i in 0..2 {
                        let slope = (plus.moment[i] - minus.moment[i]) / (2.0 * h);
                        let found = stress.stiffness[k + i];
                        assert!(
                            (slope - found).abs() < 1e-5 * (1.0 + found.abs()),
                            "{law:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn bends_add_up_in_a_row() {
        let laws = laws();
        let [_, BendLaw::Radial(radial), mixed] = laws.as_slice() else {
            panic!("as made above");
        };
        for bend in [[0.03, 0.02], [0.2, -0.25], [-0.5, 0.1]] {
            let moment = mixed.at(bend).moment;
            let size = moment[0].hypot(moment[1]);
            for (k, c) in [0.01, 0.04].into_iter().enumerate() {
                let sum = c * moment[k] + radial.inverse(size) * moment[k] / size;
                assert!((sum - bend[k]).abs() < 1e-12);
            }
        }
        assert_eq!(mixed.at([0.0; 2]).moment, [0.0; 2]);
    }
}
