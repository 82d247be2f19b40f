//! The spring between two mass points: tension along the line between them, and internal damping.
//!
//! Source: docs/theory/lumped.md, eqs. (1) to (6); Walton and Polachek 1960, Hall and Goupee 2015.

use catenix_numerics::{Matrix3, Vector3};

use super::{Segment, piecewise};

/// A spring, unstretched.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Unstretched length [m].
    pub rest: f64,
    /// EA / l [N/m]; with a law, its slope at no strain over the length.
    pub stiffness: f64,
    /// Strain [-] and tension [N] (n_points x 2); `None`: linear.
    pub law: Option<Vec<[f64; 2]>>,
    /// Damping over stiffness [s].
    pub damping: f64,
}

impl Spring {
    /// Tension [N], its slope [N/m] and the energy [J] at an extension [m].
    #[inline]
    pub fn tension(&self, extension: f64) -> (f64, f64, f64) {
        match &self.law {
            None => {
                let tension = self.stiffness * extension;
                (tension, self.stiffness, 0.5 * tension * extension)
            }
            Some(points) => {
                let (tension, slope, area) = piecewise(points, extension / self.rest);
                (tension, slope / self.rest, area * self.rest)
            }
        }
    }
}

/// A spring at one state.
#[derive(Debug, Clone, Copy, Default)]
pub struct SpringState {
    /// Direction and length.
    pub segment: Segment,
    /// Extension [m].
    pub extension: f64,
    /// Elastic tension [N].
    pub tension: f64,
    /// Slope of the tension [N/m].
    pub slope: f64,
    /// Tension of the internal damping [N].
    pub damping: f64,
}

impl SpringState {
    /// For the vector between the points (3) [m] and its rate (3) [m/s].
    ///
    /// Source: docs/theory/lumped.md, eqs. (1) to (3). The extension is a difference of squares
    /// over a sum, so that no more digits are lost than the points have.
    #[inline]
    pub fn new(spring: &Spring, between: &Vector3, rate: &Vector3) -> SpringState {
        let segment = Segment::new(between);
        let rest = spring.rest;
        let extension = (between.norm_squared() - rest * rest) / (segment.length + rest);
        let (tension, slope, _) = spring.tension(extension);
        SpringState {
            segment,
            extension,
            tension,
            slope,
            damping: spring.damping * spring.stiffness * segment.direction.dot(rate),
        }
    }

    /// Derivative of the energy by the vector between the points, damping included: the force that
    /// the spring passes on, (3) [N].
    #[inline]
    pub fn force(&self) -> Vector3 {
        self.segment.direction * (self.tension + self.damping)
    }

    /// Derivative of [`Self::force`] by the vector between the points; `velocity`: of its rate by
    /// itself [1/s]. With a `predicted` extension, its tension takes the place of the tension in
    /// the geometric part (the mixed form).
    ///
    /// Source: docs/theory/lumped.md, eqs. (5) and (6).
    #[inline]
    pub fn tangent(
        &self,
        spring: &Spring,
        rate: &Vector3,
        predicted: Option<f64>,
        velocity: f64,
    ) -> Matrix3 {
        let t = &self.segment.direction;
        let across = self.segment.across() / self.segment.length;
        let tension = match predicted {
            Some(extension) => spring.tension(extension).0,
            None => self.tension,
        };
        let viscous = spring.damping * spring.stiffness;
        let along = *t * (self.slope + velocity * viscous) + across * rate * viscous;
        t * along.transpose() + across * (tension + self.damping)
    }

    /// Extension after a move of the vector between the points, by its first-order change.
    #[inline]
    pub fn predicted(&self, change: &Vector3) -> f64 {
        self.extension + self.segment.direction.dot(change)
    }

    /// Power that the damping takes, not positive [W].
    #[inline]
    pub fn damping_power(&self, rate: &Vector3) -> f64 {
        -self.damping * self.segment.direction.dot(rate)
    }
}
