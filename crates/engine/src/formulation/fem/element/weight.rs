//! A load that is the same all along an element, and does not turn: weight and buoyancy.
//!
//! Its moments on the nodes come from the deflection across the chord only. A field that also bends
//! the line along the chord would let the weight of a hanging line turn its free end over.
//!
//! Source: docs/theory/fem.md, eqs. (38) to (40).

use catenix_numerics::{Matrix3, Vector3, so3::hat};

use super::ends::{Blocks, ElementForces, End, NO_BLOCKS};

/// The part of the load's potential beyond its halves at the two ends.
#[derive(Debug, Clone, Copy)]
pub struct Couples {
    chord: f64,
    along: Vector3,
    /// Axes of the two sections (2 x 3).
    axes: [Vector3; 2],
    /// Load times the squared length over 12 (3) [N m].
    pull: Vector3,
    /// The same, across the chord.
    across: Vector3,
}

impl Couples {
    /// `load`: force per length on the line, global (3) [N/m].
    #[inline]
    pub fn new(ends: [&End; 2], length: f64, load: &Vector3) -> Couples {
        let span = ends[1].position - ends[0].position;
        let chord = span.norm();
        let along = span / chord;
        let pull = load * (length * length / 12.0);
        Couples {
            chord,
            along,
            axes: ends.map(|end| end.rotation.column(0).into()),
            pull,
            across: pull - along * along.dot(&pull),
        }
    }

    /// Potential [J].
    pub fn potential(&self) -> f64 {
        -self.across.dot(&(self.axes[0] - self.axes[1]))
    }

    /// Gradient of the potential.
    ///
    /// Source: docs/theory/fem.md, eq. (39).
    #[inline]
    pub fn forces(&self) -> ElementForces {
        let apart = self.axes[0] - self.axes[1];
        let r = &self.along;
        let apart_across = apart - r * r.dot(&apart);
        ElementForces {
            force: (self.across * r.dot(&apart) + apart_across * r.dot(&self.pull)) / self.chord,
            moment: [
                self.across.cross(&self.axes[0]),
                self.axes[1].cross(&self.across),
            ],
        }
    }

    /// Exact derivative of [`Self::forces`].
    ///
    /// Source: docs/theory/fem.md, eq. (40).
    pub fn tangent(&self) -> Blocks {
        let identity = Matrix3::identity();
        let (r, q) = (&self.along, &self.pull);
        let apart = self.axes[0] - self.axes[1];
        let project = (identity - r * r.transpose()) / self.chord;
        let (pulled, leant) = (r.dot(q), r.dot(&apart));
        let apart_across = apart - r * leant;
        let across_by_along = -(identity * pulled + r * q.transpose());
        let force_by_along = (self.across * apart.transpose()
            + across_by_along * leant
            + apart_across * q.transpose()
            - (identity * leant + r * apart.transpose()) * pulled)
            / self.chord;
        let force_by_apart = self.across * r.transpose() / self.chord + project * pulled;
        let axes = self.axes.each_ref().map(hat);
        let across = hat(&self.across);
        let across_by_span = across_by_along * project;
        let mut blocks = NO_BLOCKS;
        blocks[0][0] = force_by_along * project - self.forces().force * r.transpose() / self.chord;
        blocks[0][1] = -(force_by_apart * axes[0]);
        blocks[0][2] = force_by_apart * axes[1];
        blocks[1][0] = -(axes[0] * across_by_span);
        blocks[1][1] = -(across * axes[0]);
        blocks[2][0] = axes[1] * across_by_span;
        blocks[2][2] = across * axes[1];
        blocks
    }
}

impl ElementForces {
    /// The sum of two.
    #[inline]
    pub fn plus(&self, other: &ElementForces) -> ElementForces {
        ElementForces {
            force: self.force + other.force,
            moment: [0, 1].map(|k: usize| self.moment[k] + other.moment[k]),
        }
    }
}
