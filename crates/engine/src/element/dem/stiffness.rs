//! Stiffness of a connector from the compliances of the half elements on its two sides.
//!
//! Source: docs/theory/dem.md, eqs. (13) to (17).

use catenix_model::LineType;
use catenix_numerics::{Matrix3, Vector3};

use super::connector::Stress;

/// Fraction of the bending compliance l^3 / 12 EI that the shear spring of a shear-rigid line has.
/// Small enough that its dispersion, this x (k l)^2 / 24, hides below the chain's own error.
const RIGID_SHEAR: f64 = 1e-4;

/// Margin by which the shear compliance keeps the corrected connector positive definite.
const DEFINITE_MARGIN: f64 = 1.2;

/// Transversely isotropic stiffness of a connector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConnectorStiffness {
    /// Along the axis [N/m].
    pub axial: f64,
    /// Across the axis [N/m].
    pub shear: f64,
    /// About the axis [N m/rad].
    pub torsion: f64,
    /// About the two normal axes [N m/rad].
    pub bending: f64,
    /// Shear-bending coupling [N/rad]: zero between like neighbours.
    pub coupling: f64,
    /// Damping time: damping = this x stiffness [s].
    pub damping: f64,
}

/// The four 3 x 3 parts of the stiffness in global axes.
pub(super) struct StiffnessMatrices {
    pub force_gap: Matrix3,
    pub force_bend: Matrix3,
    pub moment_gap: Matrix3,
    pub moment_bend: Matrix3,
}

/// Half an element on one side of a connector.
#[derive(Debug, Clone, Copy)]
pub struct HalfElement<'a> {
    /// Cross section.
    pub line_type: &'a LineType,
    /// Length of the whole element [m].
    pub length: f64,
}

/// Compliances of one half element.
#[derive(Clone, Copy)]
struct Compliance {
    axial: f64,
    shear: f64,
    torsion: f64,
    bending: f64,
    /// l^2 / 12 EI: the end correction of the trapezoidal curvature sum.
    correction: f64,
    stiff_damping: f64,
}

impl HalfElement<'_> {
    fn compliance(&self) -> Compliance {
        let t = self.line_type;
        let l = self.length;
        let bending = 0.5 * l / t.bending_stiffness;
        let shear = match t.shear_stiffness {
            Some(stiffness) => 0.5 * l / stiffness,
            // Rigid in shear: stiffer than bending makes it, and than extension is (a chain
            // without bending stiffness still needs its elements held together).
            None => {
                0.5 / (12.0 * t.bending_stiffness / (RIGID_SHEAR * l.powi(3))
                    + t.axial_stiffness / l)
            }
        };
        Compliance {
            axial: 0.5 * l / t.axial_stiffness,
            shear,
            torsion: 0.5 * l / t.torsional_stiffness,
            bending,
            correction: l * l / (12.0 * t.bending_stiffness),
            stiff_damping: t.structural_damping,
        }
    }
}

impl ConnectorStiffness {
    /// Between two elements.
    ///
    /// Source: docs/theory/dem.md, eqs. (13) to (16).
    pub fn between(first: HalfElement<'_>, second: HalfElement<'_>) -> ConnectorStiffness {
        Self::in_series(Some(first.compliance()), Some(second.compliance()))
    }

    /// Between a clamp and the first element of a line (`at_a`), or its last element and a clamp.
    ///
    /// Source: docs/theory/dem.md, eq. (17): the clamp is the neighbour without compliance.
    pub fn clamp(element: HalfElement<'_>, at_a: bool) -> ConnectorStiffness {
        let half = Some(element.compliance());
        if at_a {
            Self::in_series(None, half)
        } else {
            Self::in_series(half, None)
        }
    }

    fn in_series(first: Option<Compliance>, second: Option<Compliance>) -> ConnectorStiffness {
        let sum = |part: fn(&Compliance) -> f64| {
            first.as_ref().map_or(0.0, part) + second.as_ref().map_or(0.0, part)
        };
        let bending = sum(|c| c.bending);
        let mut shear = sum(|c| c.shear);
        // Damping times, weighted with the axial compliance so that each half keeps its own.
        let damping = sum(|c| c.stiff_damping * c.axial) / sum(|c| c.axial);
        let (mut bending_stiffness, mut coupling) = (0.0, 0.0);
        if bending.is_finite() {
            let correction =
                second.map_or(0.0, |c| c.correction) - first.map_or(0.0, |c| c.correction);
            shear = shear.max(DEFINITE_MARGIN * correction * correction / bending);
            let determinant = shear * bending - correction * correction;
            bending_stiffness = shear / determinant;
            coupling = correction / determinant;
            shear = determinant / bending;
        }
        ConnectorStiffness {
            axial: 1.0 / sum(|c| c.axial),
            shear: 1.0 / shear,
            torsion: 1.0 / sum(|c| c.torsion),
            bending: bending_stiffness,
            coupling,
            damping,
        }
    }

    /// Stress for a gap and a bend, global components, with the axis of the middle frame.
    ///
    /// Source: docs/theory/dem.md, eq. (4).
    #[inline]
    pub fn stress(&self, axis: &Vector3, gap: &Vector3, bend: &Vector3) -> Stress {
        let extension = axis.dot(gap);
        let twist = axis.dot(bend);
        Stress {
            force: gap * self.shear + axis * ((self.axial - self.shear) * extension)
                - axis.cross(bend) * self.coupling,
            moment: bend * self.bending
                + axis * ((self.torsion - self.bending) * twist)
                + axis.cross(gap) * self.coupling,
        }
    }

    #[inline]
    pub(super) fn matrices(&self, axis: &Vector3) -> StiffnessMatrices {
        let outer = axis * axis.transpose();
        let cross = catenix_numerics::so3::hat(axis) * self.coupling;
        StiffnessMatrices {
            force_gap: Matrix3::identity() * self.shear + outer * (self.axial - self.shear),
            force_bend: -cross,
            moment_gap: cross,
            moment_bend: Matrix3::identity() * self.bending + outer * (self.torsion - self.bending),
        }
    }
}
