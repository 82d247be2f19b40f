//! The frame that moves with a corotational element, and rotation vectors against it.
//!
//! Source: docs/theory/fem.md, eqs. (5), (6), (10), (12) and (13).

use catenix_numerics::{Matrix3, Vector3, so3};

use so3::hat;

/// The element's own frame, and how it turns with the ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triad {
    /// Element axes to global axes.
    pub axes: Matrix3,
    /// Distance of the ends [m].
    pub chord: f64,
    /// Second axis of each section, in element axes (2 x 3).
    pub directors: [Vector3; 2],
    /// First over second component of the mean of the two.
    pub lean: f64,
    /// Second component of the mean of the two.
    upright: f64,
}

/// Derivatives by the distance and the spins of the ends, in element axes.
#[derive(Default)]
pub(super) struct LeanChanges {
    pub mean: [Vector3; 3],
    /// First and second component of the roll of each end.
    pub roll: [[[Vector3; 3]; 2]; 2],
}

impl Triad {
    /// Source: docs/theory/fem.md, eq. (5).
    #[inline]
    pub fn new(sections: &[Matrix3; 2], span: &Vector3) -> Triad {
        let chord = span.norm();
        let along = span / chord;
        let sides = [0, 1].map(|k: usize| -> Vector3 { sections[k].column(1).into() });
        let third = along.cross(&(sides[0] + sides[1]));
        // Sections that point along the chord leave no roll; such a state is lost.
        let third = third / third.norm().max(1e-9);
        let axes = Matrix3::from_columns(&[along, third.cross(&along), third]);
        let back = axes.transpose();
        let directors = sides.map(|side| back * side);
        let mean = (directors[0] + directors[1]) * 0.5;
        Triad {
            axes,
            chord,
            directors,
            lean: mean.x / mean.y,
            upright: mean.y,
        }
    }

    /// Rotation vectors of the two sections against the element axes (2 x 3) [rad].
    ///
    /// Source: docs/theory/fem.md, eq. (6).
    #[inline]
    pub fn turns(&self, sections: &[Matrix3; 2]) -> [Vector3; 2] {
        let back = self.axes.transpose();
        [0, 1].map(|k: usize| so3::log(&(back * sections[k])))
    }

    /// Turning of the element axes by the ends' distance (0) and spins (1, 2), in element axes.
    ///
    /// Source: docs/theory/fem.md, eq. (10).
    #[inline]
    pub fn turning(&self) -> [Matrix3; 3] {
        let inverse = 1.0 / self.chord;
        let by_spin = |director: &Vector3| {
            let mut turning = Matrix3::zeros();
            turning.set_row(0, &self.roll(director).transpose());
            turning
        };
        let mut by_span = Matrix3::zeros();
        by_span[(0, 2)] = -self.lean * inverse;
        by_span[(1, 2)] = -inverse;
        by_span[(2, 1)] = inverse;
        [
            by_span,
            by_spin(&self.directors[0]),
            by_spin(&self.directors[1]),
        ]
    }

    /// Roll of the element axes by the spin of a section (3).
    #[inline]
    pub fn roll(&self, director: &Vector3) -> Vector3 {
        Vector3::new(director.y, -director.x, 0.0) * (0.5 / self.upright)
    }

    /// How the lean of the mean director, and the roll factors of each section, change.
    #[expect(
        clippy::needless_range_loop,
        reason = "blocks are told apart by their indices"
    )]
    pub fn lean_changes(&self, turning: &[Matrix3; 3]) -> LeanChanges {
        // Directors in element axes by their spins against these.
        let by_relative = self.directors.map(|director| -hat(&director));
        let by_column = |end: usize, c: usize| -> Matrix3 {
            let own = if c == end + 1 {
                Matrix3::identity()
            } else {
                Matrix3::zeros()
            };
            by_relative[end] * (own - turning[c])
        };
        let each = [0, 1].map(|end: usize| [0, 1, 2].map(|c: usize| by_column(end, c)));
        let row = |m: &Matrix3, k: usize| -> Vector3 { m.row(k).transpose() };
        let inverse = 1.0 / self.upright;
        let mut changes = LeanChanges::default();
        for c in 0..3 {
            let mean = (each[0][c] + each[1][c]) * 0.5;
            let upright = row(&mean, 1);
            changes.mean[c] = (row(&mean, 0) - upright * self.lean) * inverse;
            for end in 0..2 {
                let roll = self.roll(&self.directors[end]);
                changes.roll[end][0][c] =
                    row(&each[end][c], 1) * (0.5 * inverse) - upright * (roll.x * inverse);
                changes.roll[end][1][c] =
                    row(&each[end][c], 0) * (-0.5 * inverse) - upright * (roll.y * inverse);
            }
        }
        changes
    }
}

/// A moment `m` by a rotation vector as a moment by the spin: the product with the inverse of the
/// left Jacobian, transposed; that inverse, and the derivative of the product by the vector.
///
/// Source: docs/theory/fem.md, eq. (12).
pub(super) fn by_spin(turn: &Vector3, m: &Vector3) -> (Vector3, Matrix3, Matrix3) {
    let s = turn.norm_squared();
    let (b, slope) = if s < 0.1 {
        // The first dropped terms are under 1e-13 of the sum.
        (
            1.0 / 12.0
                + s * (1.0 / 720.0
                    + s * (1.0 / 30_240.0
                        + s * (1.0 / 1_209_600.0
                            + s * (1.0 / 47_900_160.0 + s * (691.0 / 1_307_674_368_000.0))))),
            1.0 / 720.0
                + s * (1.0 / 15_120.0
                    + s * (1.0 / 403_200.0
                        + s * (1.0 / 11_975_040.0 + s * (691.0 / 261_534_873_600.0)))),
        )
    } else {
        let half = 0.5 * s.sqrt();
        let cot = 1.0 / half.tan();
        let b = (1.0 - half * cot) / s;
        // d(half cot half)/ds = (cot - half / sin^2) / (8 half)
        let by_s = (cot - half * (1.0 + cot * cot)) / (8.0 * half);
        (b, (-by_s - b) / s)
    };
    let h = hat(turn);
    let turned = turn.cross(m);
    let twice = turn.cross(&turned);
    let inverse = Matrix3::identity() - h * 0.5 + h * h * b;
    let derivative =
        hat(m) * -0.5 - (hat(&turned) + h * hat(m)) * b + twice * turn.transpose() * (2.0 * slope);
    (m + turned * 0.5 + twice * b, inverse, derivative)
}
