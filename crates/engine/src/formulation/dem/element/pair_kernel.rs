//! The force and the tangent of a connector, for one pair of frames or several in lanes.
//!
//! What the connector is made of comes from outside: the stretching force, the moment and its
//! derivatives. Those of straight round linear lines are here too.
//!
//! Source: docs/theory/dem.md, eqs. (1) to (12).

use catenix_numerics::lanes::{Lane, Mat3, Vec3, angle_over_sine, atan2};

/// Four stiffnesses and the damping time of a connector.
#[derive(Debug, Clone, Copy)]
pub struct PairLaw<T> {
    /// Along the axis, at this extension [N/m].
    pub axial: T,
    /// Across the axis [N/m].
    pub shear: T,
    /// About the axis [N m/rad].
    pub torsion: T,
    /// About the normal axes [N m/rad].
    pub bending: T,
    /// Damping over stiffness [s].
    pub damping: T,
}

/// Where two frames are to each other, as a connector sees them.
#[derive(Debug, Clone, Copy)]
pub struct PairGeometry<T> {
    /// Axes of the two sides, unit, global (3).
    pub axes: [Vec3<T>; 2],
    /// From the first connection point to the second, global (3) [m].
    pub gap: Vec3<T>,
    /// Mean of the two axes, unit, global (3).
    pub mean: Vec3<T>,
    /// One over the length of the sum of the two axes.
    pub inverse: T,
    /// One plus the cosine of the angle between the axes.
    pub one_plus_cos: T,
}

/// Derivative of a vector by the increments of the pair: by the second frame's translation (that by
/// the first is its opposite), and by the rotations of both.
#[derive(Debug, Clone, Copy)]
pub struct PairDerivative<T> {
    /// By the second frame's translation.
    pub translation: Mat3<T>,
    /// By the first and the second frame's rotation.
    pub rotation: [Mat3<T>; 2],
}

/// Derivatives of the force on the second frame, and of the moments on both.
#[derive(Debug, Clone, Copy)]
pub struct PairTangents<T> {
    /// Of the force on the second frame; the first feels the opposite.
    pub force: PairDerivative<T>,
    /// Of the moments on the first and the second frame.
    pub moment: [PairDerivative<T>; 2],
}

impl<T: Lane> PairTangents<T> {
    /// Zeros.
    #[inline(always)]
    pub fn zeros(token: T::Token) -> Self {
        let zero = PairDerivative {
            translation: Mat3::zeros(token),
            rotation: [Mat3::zeros(token); 2],
        };
        PairTangents {
            force: zero,
            moment: [zero; 2],
        }
    }

    /// Adds what moments (3) [N m] on the two frames do when they turn with these.
    ///
    /// Source: docs/theory/solver.md, eq. (6b).
    #[inline(always)]
    pub fn turn_with(&mut self, moments: [Vec3<T>; 2]) {
        let [first, second] = &mut self.moment;
        first.rotation[0] = first.rotation[0].plus_hat(moments[0]);
        second.rotation[1] = second.rotation[1].plus_hat(moments[1]);
    }
}

/// Rates of a pair.
#[derive(Debug, Clone, Copy)]
pub struct PairRates<T> {
    /// Angular velocities (3) [rad/s].
    pub spins: [Vec3<T>; 2],
    /// Rate of the gap, less its turning with the mean spin (3) [m/s].
    pub gap: Vec3<T>,
    /// Difference of the angular velocities (3) [rad/s].
    pub bend: Vec3<T>,
}

/// How the rates of a pair follow increments.
#[derive(Debug, Clone, Copy)]
pub struct PairWeights<T> {
    /// d velocity / d increment [1/s].
    pub velocity: T,
    /// Factor on the rotation increments of the first and second frame.
    pub rotation: [Mat3<T>; 2],
}

impl<T: Lane> PairGeometry<T> {
    /// From the axes and the gap. Opposite axes have no mean; such a state is lost, and the step is
    /// cut.
    ///
    /// Source: docs/theory/dem.md, eqs. (1) and (2).
    #[inline(always)]
    pub fn new(axes: [Vec3<T>; 2], gap: Vec3<T>) -> Self {
        let total = axes[0] + axes[1];
        let sum = total.norm_squared().sqrt();
        let least = sum.same(1e-6);
        let sum = T::select(sum.less(least), least, sum);
        let inverse = sum.same(1.0) / sum;
        PairGeometry {
            axes,
            gap,
            mean: total * inverse,
            inverse,
            one_plus_cos: sum * sum * 0.5,
        }
    }

    /// Gap along the mean axis [m].
    #[inline(always)]
    pub fn extension(&self) -> T {
        self.mean.dot(self.gap)
    }

    /// Gap across the mean axis (3) [m].
    #[inline(always)]
    pub fn across(&self) -> Vec3<T> {
        self.gap.plus(-self.extension(), self.mean)
    }

    #[inline(always)]
    fn cross(&self) -> Vec3<T> {
        self.axes[0].cross(self.axes[1])
    }

    #[inline(always)]
    fn total(&self) -> Vec3<T> {
        self.axes[0] + self.axes[1]
    }

    /// Angle from the first section's direction, carried along to the second axis, to the second's
    /// [rad].
    ///
    /// Source: docs/theory/dem.md, eq. (3).
    #[inline(always)]
    pub fn twist(&self, directions: [Vec3<T>; 2]) -> T {
        let [start, end] = directions;
        let cross = self.cross();
        let turned = cross.cross(start);
        let share = turned.x.same(1.0) / self.one_plus_cos;
        let carried = (start + turned).plus(share, cross.cross(turned));
        atan2(self.axes[1].dot(carried.cross(end)), carried.dot(end))
    }

    /// Moment of a straight round section (3) [N m].
    ///
    /// Source: docs/theory/dem.md, eq. (4).
    #[inline(always)]
    pub fn round_moment(&self, law: &PairLaw<T>, twist: T) -> Vec3<T> {
        let one_plus_cos = self.one_plus_cos;
        let (ratio, _) = angle_over_sine(one_plus_cos - 1.0);
        let torque = law.torsion * twist / one_plus_cos;
        (self.cross() * (law.bending * ratio)).plus(torque, self.total())
    }

    /// Its derivatives by the rotations of the two frames.
    ///
    /// Source: docs/theory/dem.md, eq. (8).
    #[inline(always)]
    pub fn round_moment_by_rotations(&self, law: &PairLaw<T>, twist: T) -> [Mat3<T>; 2] {
        let [a, b] = self.axes;
        let one_plus_cos = self.one_plus_cos;
        let share = twist.same(1.0) / one_plus_cos;
        let cos = one_plus_cos - 1.0;
        let (ratio, slope) = angle_over_sine(cos);
        let (cross, total) = (self.cross(), self.total());
        let torque = law.torsion * twist * share;
        let bend = law.bending * ratio;
        let by_cos = (cross * (law.bending * slope)).plus(-(torque * share), total);
        let common = by_cos
            .outer(cross)
            .plus_outer(total * (-(law.torsion * share * share)), total)
            .plus_diagonal(-(bend * cos));
        // hat(b) hat(a) = a b^T - (a . b) I
        let first = common.plus_outer(a * bend, b).plus_hat(a * -torque);
        let second = (-common).plus_outer(b * -bend, a).plus_hat(b * -torque);
        [first, second]
    }

    /// Elastic energy of a straight round section [J].
    ///
    /// Source: docs/theory/dem.md, eq. (5).
    #[inline(always)]
    pub fn round_energy(&self, law: &PairLaw<T>, twist: T) -> T {
        let (extension, across) = (self.extension(), self.across());
        let (ratio, _) = angle_over_sine(self.one_plus_cos - 1.0);
        let angle_squared = ratio * ratio * self.cross().norm_squared();
        (law.axial * extension * extension
            + law.shear * across.norm_squared()
            + law.bending * angle_squared
            + law.torsion * twist * twist)
            * 0.5
    }

    /// Gap along and across the axis after a small move of the two frames: translations and
    /// rotations.
    ///
    /// Source: docs/theory/solver.md, eq. (6); Magisano, Leonetti and Garcea 2017.
    #[inline(always)]
    pub fn predicted(
        &self,
        levers: [Vec3<T>; 2],
        translation: Vec3<T>,
        rotations: [Vec3<T>; 2],
    ) -> (T, Vec3<T>) {
        let m = self.mean;
        let gap_move = translation + rotations[1].cross(levers[1]) - rotations[0].cross(levers[0]);
        let sum_move = rotations[0].cross(self.axes[0]) + rotations[1].cross(self.axes[1]);
        let axis_move = sum_move.plus(-m.dot(sum_move), m) * self.inverse;
        let (extension, across, along) = (self.extension(), self.across(), m.dot(gap_move));
        (
            extension + along + across.dot(axis_move),
            (across + gap_move.plus(-along, m)).plus(-extension, axis_move),
        )
    }

    /// The part of the moment on each frame that turns its axis towards the gap, over the axis: a
    /// frame feels its axis cross this (3) [N m].
    ///
    /// Source: docs/theory/dem.md, eq. (6).
    #[inline(always)]
    pub fn turning(&self, stretch: T) -> Vec3<T> {
        self.across() * (stretch * self.inverse)
    }

    /// The same for a predicted force with the tension and the shear force (3) [N].
    ///
    /// Source: docs/theory/dem.md, below eq. (7).
    #[inline(always)]
    fn turning_of(&self, tension: T, shear_force: Vec3<T>) -> Vec3<T> {
        (self.across() * tension).plus(-self.extension(), shear_force) * self.inverse
    }

    /// Moments on the two frames that come with a change of the elastic force (3) [N].
    ///
    /// Source: docs/theory/dem.md, eqs. (6) and (7).
    #[inline(always)]
    pub fn moments_by_force(&self, levers: [Vec3<T>; 2], change: Vec3<T>) -> [Vec3<T>; 2] {
        let tension = self.mean.dot(change);
        let turning = self.turning_of(tension, change.plus(-tension, self.mean));
        [
            self.axes[0].cross(turning) - levers[0].cross(change),
            self.axes[1].cross(turning) + levers[1].cross(change),
        ]
    }

    /// Derivative of the elastic force and moments. The connection points lie `levers` [m] along the
    /// axes from the origins of the frames. `force`: the one of the geometric part (3) [N];
    /// `moment_by`: derivatives of the moment by the rotations.
    ///
    /// Source: docs/theory/dem.md, eqs. (7), (8) and (8a).
    #[inline(always)]
    pub fn elastic_tangent(
        &self,
        law: &PairLaw<T>,
        force: Vec3<T>,
        levers: [T; 2],
        moment_by: &[Mat3<T>; 2],
    ) -> PairTangents<T> {
        let ([a, b], m, inverse) = (self.axes, self.mean, self.inverse);
        let [s, r] = levers;
        let (extension, across) = (self.extension(), self.across());
        let tension = m.dot(force);
        let shear_force = force.plus(-tension, m);
        let beyond = (across * law.axial) - shear_force;
        let along = law.axial - law.shear;
        let excess = (tension - law.shear * extension) * inverse;

        // K, Q, t and R of the theory.
        let by_gap = (m * along).outer(m).plus_diagonal(law.shear);
        let by_sum = m.outer(beyond * inverse - m * excess).plus_diagonal(excess);
        let turning = self.turning_of(tension, shear_force);
        let bent = extension * excess * inverse;
        let skewed = turning * inverse;
        let turning_by_sum = (beyond * (inverse * inverse))
            .outer(across)
            .plus_outer(m * bent - skewed, m)
            .plus_outer(-m, skewed)
            .plus_diagonal(-bent);

        let by_sum_transposed = by_sum.transposed();
        let first = (by_gap * s) - by_sum;
        let second = (by_gap * r) + by_sum;
        // Between the crosses of eq. (8a): rows of the moments, columns of the rotations.
        let first_first = turning_by_sum.plus(-s, by_sum_transposed).plus(s, first);
        let first_second = turning_by_sum.plus(r, by_sum_transposed).plus(-s, second);
        let second_first = turning_by_sum.plus(-s, by_sum_transposed).plus(-r, first);
        let second_second = turning_by_sum.plus(r, by_sum_transposed).plus(r, second);

        let by_first = first.crossing(a);
        let by_second = -second.crossing(b);
        let [bend_first, bend_second] = moment_by;
        PairTangents {
            force: PairDerivative {
                translation: by_gap,
                rotation: [by_first, by_second],
            },
            moment: [
                PairDerivative {
                    translation: by_first.transposed(),
                    rotation: [
                        two_crosses(turning.minus(s, force), a)
                            - first_first.crossing(a).crossed_by(a)
                            - *bend_first,
                        -first_second.crossing(b).crossed_by(a) - *bend_second,
                    ],
                },
                PairDerivative {
                    translation: by_second.transposed(),
                    rotation: [
                        *bend_first - second_first.crossing(a).crossed_by(b),
                        two_crosses(turning.plus(r, force), b)
                            - second_second.crossing(b).crossed_by(b)
                            + *bend_second,
                    ],
                },
            ],
        }
    }

    /// Rates of the pair from the angular velocities and the velocity of the second connection point
    /// against the first.
    ///
    /// Source: docs/theory/dem.md, eq. (9).
    #[inline(always)]
    pub fn rates(&self, spins: [Vec3<T>; 2], gap_velocity: Vec3<T>) -> PairRates<T> {
        let half = gap_velocity.x.same(0.5);
        PairRates {
            spins,
            gap: gap_velocity - ((spins[0] + spins[1]) * half).cross(self.gap),
            bend: spins[1] - spins[0],
        }
    }

    /// Damping force and the moment of a round section (3) [N], (3) [N m].
    ///
    /// Source: docs/theory/dem.md, eq. (9).
    #[inline(always)]
    pub fn damping(&self, law: &PairLaw<T>, rates: &PairRates<T>) -> [Vec3<T>; 2] {
        let m = self.mean;
        let along = (law.axial - law.shear) * m.dot(rates.gap);
        let about = (law.torsion - law.bending) * m.dot(rates.bend);
        [
            (rates.gap * law.shear).plus(along, m) * law.damping,
            (rates.bend * law.bending).plus(about, m) * law.damping,
        ]
    }

    /// Moments on the two frames for elastic force and moment, damping force and moment, and the
    /// turning part.
    ///
    /// Source: docs/theory/dem.md, eqs. (6) and (10).
    #[inline(always)]
    pub fn moments(
        &self,
        levers: [Vec3<T>; 2],
        force: Vec3<T>,
        moment: Vec3<T>,
        damping_force: Vec3<T>,
        turning: Vec3<T>,
    ) -> [Vec3<T>; 2] {
        let shared = self.gap.cross(damping_force) * turning.x.same(-0.5);
        [
            self.axes[0].cross(turning) + shared - levers[0].cross(force) - moment,
            self.axes[1].cross(turning) + shared + levers[1].cross(force) + moment,
        ]
    }

    /// Derivatives of the damping moment of a round section by its rates and by the rotations that
    /// turn it, over the damping time.
    ///
    /// Source: docs/theory/dem.md, eqs. (9) and (12).
    #[inline(always)]
    pub fn round_damping_by(
        &self,
        law: &PairLaw<T>,
        rates: &PairRates<T>,
    ) -> (Mat3<T>, [Mat3<T>; 2]) {
        let about = law.torsion - law.bending;
        let by_rate = (self.mean * about)
            .outer(self.mean)
            .plus_diagonal(law.bending);
        (by_rate, self.by_mean(rates.bend, about))
    }

    /// Derivatives of (m . v) m, times a factor, by the rotations that turn the mean axis m.
    #[inline(always)]
    fn by_mean(&self, v: Vec3<T>, factor: T) -> [Mat3<T>; 2] {
        let m = self.mean;
        let along = m.dot(v);
        let flat = v.plus(-(along + along), m);
        let scale = -(factor * self.inverse);
        let [a, b] = self.axes;
        let (scaled, turned) = (m * scale, along * scale);
        [
            Mat3::hat(a * turned).plus_outer(scaled, flat.cross(a)),
            Mat3::hat(b * turned).plus_outer(scaled, flat.cross(b)),
        ]
    }

    /// Adds the derivatives of the damping force and moment, about the origins of the frames.
    /// `force`: the damping force; `by`: of the moment, see [`Self::round_damping_by`].
    ///
    /// Source: docs/theory/dem.md, eqs. (10) to (12).
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a struct would only rename them")]
    pub fn add_damping_tangent(
        &self,
        law: &PairLaw<T>,
        levers: [Vec3<T>; 2],
        rates: &PairRates<T>,
        force: Vec3<T>,
        by: &(Mat3<T>, [Mat3<T>; 2]),
        weights: &PairWeights<T>,
        tangents: &mut PairTangents<T>,
    ) {
        let (m, w) = (self.mean, weights.velocity);
        let half = w.same(0.5);
        let along = law.axial - law.shear;
        let mean_spin = (rates.spins[0] + rates.spins[1]) * half;
        // Arms of the frames about the middle of the gap.
        let arms = [
            levers[0].plus(half, self.gap),
            levers[1].plus(-half, self.gap),
        ];
        // Of the rate of the gap.
        let half_bend = rates.bend * -half;
        let rate_by = [
            two_crosses(half_bend, levers[0]) + weights.rotation[0].crossed_by(arms[0] * w),
            two_crosses(half_bend, levers[1]) - weights.rotation[1].crossed_by(arms[1] * w),
        ];
        let stiff = Stiff {
            shear: law.shear,
            along,
            mean: m,
        };
        let by_axis = self.by_mean(rates.gap, along);
        let tau = law.damping;
        let translation = stiff.times(Mat3::hat(-mean_spin).plus_diagonal(w)) * tau;
        let rotation = [
            (stiff.times(rate_by[0]) + by_axis[0]) * tau,
            (stiff.times(rate_by[1]) + by_axis[1]) * tau,
        ];
        let (by_rate, by_turn) = by;
        let spin = *by_rate * (w * tau);
        let moment_by = [
            by_turn[0] * tau - spin.product(weights.rotation[0]),
            by_turn[1] * tau + spin.product(weights.rotation[1]),
        ];
        let half_force = force * half;
        let couple = [
            two_crosses(half_force, levers[0]),
            two_crosses(half_force, levers[1]),
        ];
        let [first, second] = &mut tangents.moment;
        first.translation =
            first.translation.plus_hat(half_force) - translation.crossed_by(arms[0]);
        second.translation =
            second.translation.plus_hat(half_force) + translation.crossed_by(arms[1]);
        for k in 0..2 {
            first.rotation[k] =
                first.rotation[k] - rotation[k].crossed_by(arms[0]) - moment_by[k] - couple[k];
            second.rotation[k] =
                second.rotation[k] + rotation[k].crossed_by(arms[1]) + moment_by[k] + couple[k];
            tangents.force.rotation[k] = tangents.force.rotation[k] + rotation[k];
        }
        tangents.force.translation = tangents.force.translation + translation;
    }
}

/// The matrix of v x (a x ...): a v^T - (a . v) I.
#[inline(always)]
fn two_crosses<T: Lane>(v: Vec3<T>, a: Vec3<T>) -> Mat3<T> {
    a.outer(v).plus_diagonal(-a.dot(v))
}

/// A stiffness along one axis and another across it.
struct Stiff<T> {
    shear: T,
    /// Along the axis, beyond the one across it.
    along: T,
    mean: Vec3<T>,
}

impl<T: Lane> Stiff<T> {
    #[inline(always)]
    fn times(&self, x: Mat3<T>) -> Mat3<T> {
        (x * self.shear).plus_outer(self.mean * self.along, x.led_by(self.mean))
    }
}
