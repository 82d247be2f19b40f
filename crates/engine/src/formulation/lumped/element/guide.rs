//! What holds the direction of a line at its end: a clamp, a flex joint or a hinge. It sees one
//! vector of the support and the outermost segment.
//!
//! Source: docs/theory/lumped.md, eqs. (14) to (17).

use catenix_numerics::{Matrix3, Vector3, so3::hat};

use super::Segment;
use super::bend::{BendStiffness, CosineLaw};

/// How a vector of the support holds the outermost segment.
#[derive(Debug, Clone, PartialEq)]
pub enum Guide {
    /// Against the angle to the vector: a clamp or a flex joint.
    Along(BendStiffness),
    /// Against leaving the plane normal to the vector, moment per angle [N m/rad]: a hinge.
    Across(f64),
}

/// A guide at one state.
#[derive(Debug, Clone, Copy, Default)]
pub struct GuideState {
    law: CosineLaw,
    /// The support's vector, unit (3).
    held: Vector3,
    cosine: f64,
    /// The vector across the segment (3).
    across: Vector3,
    /// Vector x direction (3).
    turn: Vector3,
}

/// Derivatives of force and moment of a guide.
#[derive(Debug, Clone, Copy)]
pub struct GuideTangent {
    /// Force on the segment by its vector [N/m].
    pub force: Matrix3,
    /// Force on the segment by a rotation of the support [N].
    pub force_rotation: Matrix3,
    /// Moment on the support by the vector of the segment [N].
    pub moment: Matrix3,
    /// Moment on the support by its rotation [N m].
    pub moment_rotation: Matrix3,
}

impl GuideState {
    /// For the support's vector (unit, global) and the outermost segment.
    #[inline]
    pub fn new(guide: &Guide, held: &Vector3, segment: &Segment) -> GuideState {
        let cosine = held.dot(&segment.direction);
        let across = held - segment.direction * cosine;
        let law = match guide {
            Guide::Along(stiffness) => CosineLaw::of_angle(stiffness, cosine, across.norm()),
            Guide::Across(stiffness) => CosineLaw {
                slope: stiffness * cosine,
                curve: *stiffness,
                angle: cosine,
                energy: 0.5 * stiffness * cosine * cosine,
                moment: (stiffness * cosine).abs(),
            },
        };
        GuideState {
            law,
            held: *held,
            cosine,
            across,
            turn: held.cross(&segment.direction),
        }
    }

    /// Derivative of the energy by the vector of the segment (3) [N].
    ///
    /// Source: docs/theory/lumped.md, eq. (15).
    #[inline]
    pub fn force(&self, segment: &Segment) -> Vector3 {
        self.across * (self.law.slope / segment.length)
    }

    /// Derivative of the energy by a rotation of the support (3) [N m].
    ///
    /// Source: docs/theory/lumped.md, eq. (15).
    #[inline]
    pub fn moment(&self) -> Vector3 {
        self.turn * self.law.slope
    }

    /// Exact derivatives.
    ///
    /// Source: docs/theory/lumped.md, eqs. (16) and (17).
    pub fn tangent(&self, segment: &Segment) -> GuideTangent {
        let CosineLaw { slope, curve, .. } = self.law;
        let (n, t) = (&self.across, &segment.direction);
        let inverse = 1.0 / segment.length;
        let project = segment.across();
        let held = hat(&self.held);
        let bent = n * t.transpose() + t * n.transpose() + project * self.cosine;
        GuideTangent {
            force: (n * n.transpose() * curve - bent * slope) * (inverse * inverse),
            force_rotation: (n * self.turn.transpose() * curve - project * held * slope) * inverse,
            moment: (self.turn * n.transpose() * curve + held * project * slope) * inverse,
            moment_rotation: self.turn * self.turn.transpose() * curve + hat(t) * held * slope,
        }
    }

    /// Size of the moment [N m].
    pub fn moment_size(&self) -> f64 {
        self.law.moment
    }

    /// Angle to the support's vector, or out of the plane of a hinge [rad].
    pub fn angle(&self) -> f64 {
        self.law.angle
    }

    /// Stored energy [J].
    pub fn energy(&self) -> f64 {
        self.law.energy
    }
}
