//! What an element's cross section opposes to deformation.
//!
//! Source: docs/theory/fem.md, eqs. (1) to (4).

use catenix_model::{LineType, NaturalShape};
use catenix_numerics::Vector3;

use crate::formulation::curve::Curve;

/// Stiffness of one element.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementSection {
    /// Length along the line without stress [m].
    pub length: f64,
    /// EA [N]; with a law, its slope at no strain.
    pub axial: f64,
    /// GJ [N m2].
    pub torsion: f64,
    /// EI about local y and z (2) [N m2]; with a law, its slope at no curvature, twice.
    pub bending: [f64; 2],
    /// kappa G A [N]; `None`: rigid in shear.
    pub shear: Option<f64>,
    /// Twist and curvature about local y and z without stress, times the length (3) [rad].
    pub rest: Vector3,
    /// Damping time: damping = this x stiffness [s].
    pub damping: f64,
    /// Laws given by points; `None`: linear.
    pub laws: Option<Box<SectionLaws>>,
}

/// Section laws given by points.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionLaws {
    /// Tension [N] against strain [-]; `None`: linear.
    pub axial: Option<Curve>,
    /// Moment [N m] against curvature [1/m], the same about all axes; `None`: linear.
    pub bending: Option<Curve>,
}

impl ElementSection {
    /// Of an element of a line.
    pub fn new(line_type: &LineType, length: f64, natural: &NaturalShape) -> ElementSection {
        let curve =
            |points: &Option<Vec<[f64; 2]>>| points.as_ref().map(|p| Curve::through(p, 1.0));
        let laws = SectionLaws {
            axial: curve(&line_type.axial_law),
            bending: curve(&line_type.bending_law),
        };
        let [y, z] = natural.curvature;
        ElementSection {
            length,
            axial: line_type.axial_stiffness,
            torsion: line_type.torsional_stiffness,
            bending: line_type.bending_stiffness,
            shear: line_type.shear_stiffness,
            rest: Vector3::new(natural.twist, y, z) * length,
            damping: line_type.structural_damping,
            laws: (laws.axial.is_some() || laws.bending.is_some()).then(|| Box::new(laws)),
        }
    }

    /// Tension at a strain [N], and its slope [N].
    #[inline]
    pub fn tension(&self, strain: f64) -> (f64, f64) {
        match self.axial_law() {
            None => (self.axial * strain, self.axial),
            Some(curve) => {
                let point = curve.at(strain);
                (point.value, point.slope)
            }
        }
    }

    /// Energy of a strain, per length [J/m].
    pub fn axial_energy(&self, strain: f64) -> f64 {
        match self.axial_law() {
            None => 0.5 * self.axial * strain * strain,
            Some(curve) => curve.at(strain).energy,
        }
    }

    /// Law of bending given by points.
    #[inline]
    pub fn bending_law(&self) -> Option<&Curve> {
        self.laws.as_ref()?.bending.as_ref()
    }

    #[inline]
    fn axial_law(&self) -> Option<&Curve> {
        self.laws.as_ref()?.axial.as_ref()
    }

    /// Largest slope of tension against strain [N].
    pub fn stiffest(&self) -> f64 {
        self.axial_law().map_or(self.axial, Curve::largest_slope)
    }

    /// Shear compliance over bending compliance, 12 EI / kappa G A l^2, about local y and z.
    ///
    /// Source: docs/theory/fem.md, eq. (4).
    pub fn shear_ratio(&self) -> [f64; 2] {
        match self.shear {
            None => [0.0; 2],
            Some(shear) => self
                .bending
                .map(|bending| 12.0 * bending / (shear * self.length * self.length)),
        }
    }
}

/// Moment and stiffness of a law that is the same about all axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radial {
    /// Energy per length [J/m].
    pub energy: f64,
    /// Moment about local y and z (2) [N m].
    pub moment: [f64; 2],
    /// By y twice, by y and z, by z twice (3) [N m2].
    pub stiffness: [f64; 3],
}

/// A law of the curvature's size, at a curvature (2) [1/m].
///
/// Source: docs/theory/fem.md, eq. (3).
pub fn radial(curve: &Curve, [y, z]: [f64; 2]) -> Radial {
    let size = y.hypot(z);
    let point = curve.at(size);
    if size == 0.0 {
        return Radial {
            energy: 0.0,
            moment: [0.0; 2],
            stiffness: [point.slope, 0.0, point.slope],
        };
    }
    let (u, v) = (y / size, z / size);
    let secant = point.value / size;
    let rest = point.slope - secant;
    Radial {
        energy: point.energy,
        moment: [point.value * u, point.value * v],
        stiffness: [secant + rest * u * u, rest * u * v, secant + rest * v * v],
    }
}
