//! How much of a slender body is under the still-water surface.

/// Share under water, between 0 and 1, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Submergence {
    /// Share of the length under water [-].
    pub share: f64,
    /// By the height of the centre [1/m].
    pub by_height: f64,
    /// By the vertical component of the axis [-].
    pub by_slope: f64,
}

impl Submergence {
    /// Fully under water.
    pub const FULL: Submergence = Submergence {
        share: 1.0,
        by_height: 0.0,
        by_slope: 0.0,
    };

    /// For a centre at height `z`, an axis with vertical component `slope`, a length and a
    /// diameter.
    ///
    /// Source: docs/theory/hydrodynamics.md, eq. (8).
    #[inline]
    pub fn new(z: f64, slope: f64, length: f64, diameter: f64) -> Submergence {
        let height = length * slope.abs() + diameter;
        if z <= -0.5 * height {
            return Submergence::FULL;
        }
        if z >= 0.5 * height {
            return Submergence {
                share: 0.0,
                by_height: 0.0,
                by_slope: 0.0,
            };
        }
        Submergence {
            share: 0.5 - z / height,
            by_height: -1.0 / height,
            by_slope: z * length * slope.signum() / (height * height),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_dry_to_wet_with_exact_slopes() {
        assert_eq!(Submergence::new(3.0, 1.0, 4.0, 0.2).share, 0.0);
        assert_eq!(Submergence::new(-3.0, 1.0, 4.0, 0.2), Submergence::FULL);
        assert_eq!(Submergence::new(0.0, 0.3, 4.0, 0.2).share, 0.5);
        let (z, slope, h) = (0.4, -0.6, 1e-6);
        let at = |z: f64, slope: f64| Submergence::new(z, slope, 4.0, 0.2).share;
        let exact = Submergence::new(z, slope, 4.0, 0.2);
        assert!((exact.by_height - (at(z + h, slope) - at(z - h, slope)) / (2.0 * h)).abs() < 1e-8);
        assert!((exact.by_slope - (at(z, slope + h) - at(z, slope - h)) / (2.0 * h)).abs() < 1e-8);
    }
}
