//! Stiffness of a connector from the compliances of the half elements on its two sides.
//!
//! Source: docs/theory/dem.md, eqs. (13) to (17).

use catenix_model::LineType;
use catenix_numerics::Vector3;

use super::connector::Stress;

/// Shear compliance of a shear-rigid element over its bending compliance l^3 / 12 EI. The rotary
/// inertia makes up for it ([`rotary_share`]), so its dispersion is of fourth order.
const RIGID_SHEAR: f64 = 1e-3;
/// Largest shear stiffness over the axial one: over 100 times that of a real pipe, and low enough
/// that round-off in the positions stays below the tolerances with short elements in deep water.
const RIGID_SHEAR_LIMIT: f64 = 30.0;
/// Smallest share of the rotary inertia, for elements shorter than they are thick.
const LEAST_ROTARY_SHARE: f64 = 0.1;

/// Share of m l^2 / 12 that an element has as rotary inertia about its normal axes: what the
/// shear spring of a shear-rigid line takes away in frequency, the inertia gives back.
///
/// Source: docs/theory/dem.md, eq. (22a).
pub fn rotary_share(line_type: &LineType, length: f64) -> f64 {
    let bending = line_type.bending_stiffness;
    match line_type.shear_stiffness {
        Some(_) => 1.0,
        None => {
            let shear = rigid_shear(line_type, length);
            (1.0 - 12.0 * bending / (length * length * shear)).max(LEAST_ROTARY_SHARE)
        }
    }
}

/// Shear stiffness of a shear-rigid line [N]: stiffer than bending makes it, and than extension is
/// (a chain without bending stiffness still needs its elements held together).
fn rigid_shear(line_type: &LineType, length: f64) -> f64 {
    let by_bending = 12.0 * line_type.bending_stiffness / (RIGID_SHEAR * length * length);
    (by_bending + line_type.axial_stiffness).min(RIGID_SHEAR_LIMIT * line_type.axial_stiffness)
}

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
    /// How far beyond the elements' meeting point, towards end B, the connector acts [m]: zero
    /// between like neighbours.
    pub shift: f64,
    /// Damping time: damping = this x stiffness [s].
    pub damping: f64,
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
    /// l^2 / 12 EI: the end correction of the sum that stands for the integral of curvature.
    correction: f64,
    damping_time: f64,
}

impl HalfElement<'_> {
    fn compliance(&self) -> Compliance {
        let t = self.line_type;
        let l = self.length;
        let bending = 0.5 * l / t.bending_stiffness;
        let shear = 0.5 * l / t.shear_stiffness.unwrap_or_else(|| rigid_shear(t, l));
        Compliance {
            axial: 0.5 * l / t.axial_stiffness,
            shear,
            torsion: 0.5 * l / t.torsional_stiffness,
            bending,
            correction: l * l / (12.0 * t.bending_stiffness),
            damping_time: t.structural_damping,
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
        // Damping times, weighted with the axial compliance so that each half keeps its own.
        let damping = sum(|c| c.damping_time * c.axial) / sum(|c| c.axial);
        let shift = if bending.is_finite() {
            let correction = |side: Option<Compliance>| side.map_or(0.0, |c| c.correction);
            (correction(second) - correction(first)) / bending
        } else {
            0.0
        };
        ConnectorStiffness {
            axial: 1.0 / sum(|c| c.axial),
            shear: 1.0 / sum(|c| c.shear),
            torsion: 1.0 / sum(|c| c.torsion),
            bending: 1.0 / bending,
            shift,
            damping,
        }
    }

    /// Damping stress for the rates of gap and bend, with the mean axis of the connector.
    ///
    /// Source: docs/theory/dem.md, eq. (9).
    #[inline]
    pub(super) fn damping_stress(
        &self,
        axis: &Vector3,
        gap_rate: &Vector3,
        bend_rate: &Vector3,
    ) -> Stress {
        let force = gap_rate * self.shear + axis * ((self.axial - self.shear) * axis.dot(gap_rate));
        let moment =
            bend_rate * self.bending + axis * ((self.torsion - self.bending) * axis.dot(bend_rate));
        Stress {
            force: force * self.damping,
            moment: moment * self.damping,
        }
    }
}
