//! Stiffness of a connector from the compliances of the half elements on its two sides.
//!
//! Source: docs/theory/dem.md, eqs. (13) to (17), and docs/theory/sections.md.

use catenix_model::{LineType, NaturalShape};
use catenix_numerics::{Matrix3, Vector3, so3};

use super::law::{BendLaw, GeneralLaw};
use super::pair::Side;
use crate::formulation::curve::Curve;

/// Shear compliance of a shear-rigid element over its bending compliance l^3 / 12 EI. The rotary
/// inertia makes up for it ([`rotary_share`]), so its dispersion is of fourth order.
const RIGID_SHEAR: f64 = 1e-3;
/// Largest shear stiffness over the axial one: over 100 times that of a real pipe, and low enough
/// that round-off in the positions stays below the tolerances with short elements in deep water.
const RIGID_SHEAR_LIMIT: f64 = 30.0;
/// Smallest share of the rotary inertia, for elements shorter than they are thick.
const LEAST_ROTARY_SHARE: f64 = 0.1;

/// Share of m l^2 / 12 that an element has as rotary inertia about its local y and z: what the
/// shear spring of a shear-rigid line takes away in frequency, the inertia gives back.
///
/// Source: docs/theory/dem.md, eq. (22a).
pub fn rotary_share(line_type: &LineType, length: f64) -> [f64; 2] {
    match line_type.shear_stiffness {
        Some(_) => [1.0; 2],
        None => {
            let shear = rigid_shear(line_type, length);
            line_type.bending_stiffness.map(|bending| {
                (1.0 - 12.0 * bending / (length * length * shear)).max(LEAST_ROTARY_SHARE)
            })
        }
    }
}

/// Shear stiffness of a shear-rigid line [N]: stiffer than bending makes it, and than extension is
/// (a chain without bending stiffness still needs its elements held together).
fn rigid_shear(line_type: &LineType, length: f64) -> f64 {
    let [y, z] = line_type.bending_stiffness;
    let by_bending = 12.0 * y.max(z) / (RIGID_SHEAR * length * length);
    let axial = match &line_type.axial_law {
        None => line_type.axial_stiffness,
        Some(points) => Curve::through(points, 1.0).largest_slope(),
    };
    (by_bending + axial).min(RIGID_SHEAR_LIMIT * axial)
}

/// Stiffness of a connector: the same about all normal axes, or more in its general part.
#[derive(Debug, Clone, PartialEq)]
pub struct ConnectorStiffness {
    /// Along the axis [N/m]; with a law, at no extension.
    pub axial: f64,
    /// Across the axis [N/m].
    pub shear: f64,
    /// About the axis [N m/rad].
    pub torsion: f64,
    /// About the two normal axes [N m/rad]; of a general connector the mean, at no moment.
    pub bending: f64,
    /// How far beyond the elements' meeting point, towards end B, the connector acts [m]: zero
    /// between like neighbours.
    pub shift: f64,
    /// Damping time: damping = this x stiffness [s].
    pub damping: f64,
    /// What four numbers do not say; `None` for straight round linear lines.
    pub general: Option<Box<GeneralLaw>>,
}

/// Half an element on one side of a connector.
#[derive(Debug, Clone, Copy)]
pub struct HalfElement<'a> {
    /// Cross section.
    pub line_type: &'a LineType,
    /// Length of the whole element [m].
    pub length: f64,
    /// Stress-free shape.
    pub natural: NaturalShape,
}

/// Compliances of one half element.
#[derive(Clone, Copy)]
struct Compliance {
    axial: f64,
    shear: f64,
    torsion: f64,
    /// About local y and z.
    bending: [f64; 2],
    /// l^2 / 12 EI: the end correction of the sum that stands for the integral of curvature.
    correction: [f64; 2],
    damping_time: f64,
}

impl HalfElement<'_> {
    fn compliance(&self) -> Compliance {
        let t = self.line_type;
        let l = self.length;
        let shear = 0.5 * l / t.shear_stiffness.unwrap_or_else(|| rigid_shear(t, l));
        Compliance {
            axial: 0.5 * l / t.axial_stiffness,
            shear,
            torsion: 0.5 * l / t.torsional_stiffness,
            bending: t.bending_stiffness.map(|stiffness| 0.5 * l / stiffness),
            correction: t
                .bending_stiffness
                .map(|stiffness| l * l / (12.0 * stiffness)),
            damping_time: t.structural_damping,
        }
    }

    /// Whether four numbers say all of it.
    fn is_plain(&self) -> bool {
        let t = self.line_type;
        self.natural.is_straight()
            && t.bending_law.is_none()
            && t.axial_law.is_none()
            && t.bending_stiffness[0] == t.bending_stiffness[1]
    }
}

impl ConnectorStiffness {
    /// Between two elements.
    ///
    /// Source: docs/theory/dem.md, eqs. (13) to (16).
    pub fn between(first: HalfElement<'_>, second: HalfElement<'_>) -> ConnectorStiffness {
        Self::in_series(Some(first), Some(second))
    }

    /// Between a clamp and the first element of a line (`at_a`), or its last element and a clamp.
    ///
    /// Source: docs/theory/dem.md, eq. (17): the clamp is the neighbour without compliance.
    pub fn clamp(element: HalfElement<'_>, at_a: bool) -> ConnectorStiffness {
        if at_a {
            Self::in_series(None, Some(element))
        } else {
            Self::in_series(Some(element), None)
        }
    }

    fn in_series(
        first: Option<HalfElement<'_>>,
        second: Option<HalfElement<'_>>,
    ) -> ConnectorStiffness {
        let halves: Vec<HalfElement<'_>> = [first, second].into_iter().flatten().collect();
        let [first, second] = [first, second].map(|half| half.map(|half| half.compliance()));
        let sum = |part: fn(&Compliance) -> f64| {
            first.as_ref().map_or(0.0, part) + second.as_ref().map_or(0.0, part)
        };
        let planes = [sum(|c| c.bending[0]), sum(|c| c.bending[1])];
        let bending = 0.5 * (planes[0] + planes[1]);
        // Damping times, weighted with the axial compliance so that each half keeps its own.
        let damping = sum(|c| c.damping_time * c.axial) / sum(|c| c.axial);
        let shift = if bending.is_finite() {
            // In unlike planes the mean, weighted with compliance.
            let correction = |side: Option<Compliance>| {
                side.map_or(0.0, |c| 0.5 * (c.correction[0] + c.correction[1]))
            };
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
            general: (!halves.iter().all(HalfElement::is_plain))
                .then(|| Box::new(general_law(&halves, planes))),
        }
    }

    /// Tension at an extension [N], and its slope [N/m].
    #[inline]
    pub(super) fn tension(&self, extension: f64) -> (f64, f64) {
        match self.axial_curve() {
            None => (self.axial * extension, self.axial),
            Some(curve) => {
                let point = curve.at(extension);
                (point.value, point.slope)
            }
        }
    }

    /// Energy of an extension [J].
    pub(super) fn axial_energy(&self, extension: f64) -> f64 {
        match self.axial_curve() {
            None => 0.5 * self.axial * extension * extension,
            Some(curve) => curve.at(extension).energy,
        }
    }

    #[inline]
    fn axial_curve(&self) -> Option<&Curve> {
        self.general.as_ref()?.axial.as_ref()
    }

    /// Rotation of the second section against the first without stress, in the first one's axes.
    ///
    /// Source: docs/theory/sections.md, eq. (4).
    pub fn rest_rotation(&self) -> Matrix3 {
        let Some(law) = &self.general else {
            return Matrix3::identity();
        };
        let half_twist = so3::exp(&Vector3::new(0.5 * law.rest_twist, 0.0, 0.0));
        let [y, z] = law.rest_bend;
        half_twist * so3::exp(&Vector3::new(0.0, y, z)) * half_twist
    }

    /// Twist of the second section against the first without stress [rad].
    pub fn rest_twist(&self) -> f64 {
        self.general.as_ref().map_or(0.0, |law| law.rest_twist)
    }

    /// Largest stiffness against any displacement [N/m].
    pub fn stiffest(&self) -> f64 {
        let axial = self.axial_curve().map_or(self.axial, Curve::largest_slope);
        axial.max(self.shear)
    }

    /// Stiffness against rotations in the axes of each side, turned to global axes.
    ///
    /// Source: docs/theory/sections.md, eq. (13).
    pub(super) fn turned_stiffness(&self, law: &GeneralLaw, sides: [&Side; 2]) -> [Matrix3; 2] {
        let [y, z] = law.initial_bending;
        let own = Matrix3::from_diagonal(&Vector3::new(self.torsion, y, z));
        sides.map(|side| side.rotation * own * side.rotation.transpose())
    }
}

/// The general part of a connector's law, from its halves. `planes`: compliances about local y and
/// z at no moment [rad/N m].
///
/// Source: docs/theory/sections.md, eqs. (4) and (11).
fn general_law(halves: &[HalfElement<'_>], planes: [f64; 2]) -> GeneralLaw {
    let rest = |part: fn(&NaturalShape) -> f64| {
        let of_half = |half: &HalfElement<'_>| 0.5 * half.length * part(&half.natural);
        halves.iter().map(of_half).sum::<f64>()
    };
    let axial = halves
        .iter()
        .any(|half| half.line_type.axial_law.is_some())
        .then(|| in_series(halves.iter().map(axial_curve)));
    GeneralLaw {
        rest_bend: [rest(|n| n.curvature[0]), rest(|n| n.curvature[1])],
        rest_twist: rest(|n| n.twist),
        bending: bend_law(halves, planes),
        initial_bending: planes.map(|compliance| 1.0 / compliance),
        axial: axial.flatten(),
    }
}

fn in_series(curves: impl Iterator<Item = Curve>) -> Option<Curve> {
    curves.reduce(|first, second| first.in_series(&second))
}

fn axial_curve(half: &HalfElement<'_>) -> Curve {
    match &half.line_type.axial_law {
        Some(points) => Curve::through(points, 0.5 * half.length),
        None => Curve::line(2.0 * half.line_type.axial_stiffness / half.length),
    }
}

fn bend_law(halves: &[HalfElement<'_>], planes: [f64; 2]) -> BendLaw {
    let laws = halves.iter().filter_map(|half| {
        let points = half.line_type.bending_law.as_ref()?;
        Some(Curve::through(points, 0.5 * half.length))
    });
    let radial = in_series(laws).filter(|_| planes.iter().all(|c| c.is_finite()));
    let Some(radial) = radial else {
        return BendLaw::Planes(planes.map(|compliance| 1.0 / compliance));
    };
    let mut compliance = [0.0; 2];
    for half in halves
        .iter()
        .filter(|half| half.line_type.bending_law.is_none())
    {
        let own = half.compliance().bending;
        compliance = [compliance[0] + own[0], compliance[1] + own[1]];
    }
    match compliance {
        [0.0, 0.0] => BendLaw::Radial(radial),
        [y, z] if y == z => BendLaw::Radial(radial.in_series(&Curve::line(1.0 / y))),
        _ => BendLaw::Mixed { radial, compliance },
    }
}
