//! How far the middle line of a geometrically exact element reaches: stretch and S, and how they
//! follow from the two ends.
//!
//! Source: docs/theory/fem.md, eqs. (18), (22a), (23) and (23a).

use catenix_numerics::{Matrix3, Vector3};

/// How an element shares an S between shear and bending.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stance {
    /// Share of shear, in the planes of local y and z (2) [-].
    share: [f64; 2],
    /// How much an S takes up or gives of the stretch (2) [-].
    take: [f64; 2],
}

impl Stance {
    /// `ratio`: compliance in shear over that in bending, in the planes of local y and z (2) [-].
    pub(super) fn new(ratio: [f64; 2]) -> Stance {
        let share = ratio.map(|ratio| ratio / (1.0 + ratio));
        Stance {
            share,
            take: share.map(|share| 0.2 * (1.0 - share).powi(2) - share * share),
        }
    }
}

/// Stretch and S at one configuration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// Stretch, and S in the planes of local y and z (3) [-].
    pub strain: Vector3,
    /// Its derivatives by the reach, one column each.
    gradient: Matrix3,
    /// Direction of the reach, unit (3).
    direction: Vector3,
    /// Length of the reach, over that without strain [-].
    size: f64,
    /// Reach in the middle's axes (3) [-].
    reach: Vector3,
    stance: Stance,
}

impl Reach {
    /// `reach`: from end to end along the helix in the axes of its middle, over its length (3).
    #[inline]
    pub(super) fn new(stance: &Stance, reach: &Vector3) -> Reach {
        let size = reach.norm();
        let direction = reach / size;
        let base = size + reach.x;
        let by_base = direction + Vector3::x();
        let mut strain = Vector3::new(size - 1.0, 0.0, 0.0);
        let mut gradient = Matrix3::zeros();
        let mut stretch = direction;
        for k in 0..2 {
            let (share, take) = (stance.share[k], stance.take[k]);
            let across = reach[k + 1];
            let lean = across / base;
            let mut by_lean = by_base * (-lean / base);
            by_lean[k + 1] += 1.0 / base;
            strain.x += take * across * lean;
            stretch += by_lean * (take * across);
            stretch[k + 1] += take * lean;
            let bends = 2.0 * (1.0 - share);
            strain[k + 1] = share * across + bends * lean;
            let mut own = by_lean * bends;
            own[k + 1] += share;
            gradient.set_column(k + 1, &own);
        }
        gradient.set_column(0, &stretch);
        Reach {
            strain,
            gradient,
            direction,
            size,
            reach: *reach,
            stance: *stance,
        }
    }

    /// Force along the reach that belongs to stresses (3) [N].
    #[inline]
    pub(super) fn pull(&self, stress: &Vector3) -> Vector3 {
        self.gradient * stress
    }

    /// Strain after a small change of the reach, to first order.
    #[inline]
    pub(super) fn predicted(&self, change: &Vector3) -> Vector3 {
        self.strain + self.gradient.tr_mul(change)
    }

    /// Derivative of [`Self::pull`] by the reach, with the slopes of the stresses by the strains,
    /// and the stresses themselves.
    pub(super) fn pull_slope(&self, slopes: &Vector3, stress: &Vector3) -> Matrix3 {
        let mut slope = self.gradient * Matrix3::from_diagonal(slopes) * self.gradient.transpose();
        let across =
            (Matrix3::identity() - self.direction * self.direction.transpose()) / self.size;
        slope += across * stress.x;
        let base = self.size + self.reach.x;
        let by_base = self.direction + Vector3::x();
        for k in 0..2 {
            let (share, take) = (self.stance.share[k], self.stance.take[k]);
            let lean = self.reach[k + 1] / base;
            let mut by_lean = by_base * (-lean / base);
            by_lean[k + 1] += 1.0 / base;
            let both = by_lean * by_base.transpose();
            let lean_twice = (both + both.transpose() + across * lean) / -base;
            let weight = stress.x * take * self.reach[k + 1] + stress[k + 1] * 2.0 * (1.0 - share);
            slope += lean_twice * weight;
            for c in 0..3 {
                slope[(k + 1, c)] += stress.x * take * by_lean[c];
                slope[(c, k + 1)] += stress.x * take * by_lean[c];
            }
        }
        slope
    }
}
