//! The geometrically exact beam element of Reissner and Simo: two nodes, total Lagrangian.
//!
//! Between the two sections the line is a helix: rotations follow the one-parameter group, which
//! turns with the sections (Crisfield and Jelenic), positions the strain that is constant along it
//! (Sonneville, Cardona and Bruls). An arc of any size is exact. What a helix cannot do is to bend
//! like an S; that deformation is the small one of a beam with shear, against the helix.
//!
//! Forces are the exact gradient of the stored energy; the tangent is exact.
//!
//! Source: docs/theory/fem.md, eqs. (17) to (24).

use catenix_numerics::{Matrix3, Vector3, so3};

use super::ends::{Blocks, ElementForces, ElementTangent, End, NO_BLOCKS, Prediction, turned};
use super::reach::{Reach, Stance};
use super::section::{ElementSection, radial};
use so3::hat;

/// Constant numbers of an element, from its section.
#[derive(Debug, Clone, PartialEq)]
pub struct Exact {
    section: ElementSection,
    stance: Stance,
    /// Stiffness of an S in the planes of local y and z, per length (2) [N].
    shear: [f64; 2],
}

/// An element at one configuration. All vectors in the axes of the section at its middle.
#[derive(Debug, Clone, Copy)]
pub struct ExactState {
    /// Axes of the section at the middle to global axes.
    axes: Matrix3,
    /// From the first end to the second (3) [m].
    span: Vector3,
    /// Half of the rotation vector from the first section to the second (3) [rad].
    half: Vector3,
    factors: Factors,
    /// How far the middle line reaches.
    reach: Reach,
    /// Tension, and what an S stores along local y and z (3) [N].
    pub force: Vector3,
    /// Torque and bending moments (3) [N m].
    pub moment: Vector3,
    damping: Damping,
}

#[derive(Debug, Clone, Copy, Default)]
struct Damping {
    force: Vector3,
    moment: Vector3,
    /// Velocity of the second end less that of the first (3) [m/s].
    velocity: Vector3,
    /// Mean spin (3) [rad/s].
    mean: Vector3,
    /// Spin of the second end less that of the first (3) [rad/s].
    apart: Vector3,
}

/// Scalar functions of the half rotation's squared angle, each with its derivative.
///
/// Source: docs/theory/fem.md, eq. (20).
#[derive(Debug, Clone, Copy)]
struct Factors {
    /// tan(x / 2) / x.
    lag: [f64; 2],
    /// (x / sin x - 1) / x^2, with its second derivative too.
    widen: [f64; 3],
}

impl Factors {
    #[inline]
    fn new(t: f64) -> Factors {
        if t < 0.01 {
            // The first dropped terms are under 1e-15.
            let lag = 0.5
                + t * (1.0 / 24.0
                    + t * (1.0 / 240.0
                        + t * (17.0 / 40_320.0
                            + t * (31.0 / 725_760.0 + t * (691.0 / 159_667_200.0)))));
            let lag_slope = 1.0 / 24.0
                + t * (1.0 / 120.0
                    + t * (17.0 / 13_440.0 + t * (31.0 / 181_440.0 + t * (691.0 / 31_933_440.0))));
            let widen = 1.0 / 6.0
                + t * (7.0 / 360.0
                    + t * (31.0 / 15_120.0 + t * (127.0 / 604_800.0 + t * (73.0 / 3_421_440.0))));
            let widen_slope = 7.0 / 360.0
                + t * (31.0 / 7560.0
                    + t * (127.0 / 201_600.0
                        + t * (73.0 / 855_360.0 + t * (1_414_477.0 / 130_767_436_800.0))));
            let widen_bend = 31.0 / 7560.0
                + t * (127.0 / 100_800.0
                    + t * (73.0 / 285_120.0
                        + t * (1_414_477.0 / 32_691_859_200.0 + t * (8191.0 / 1_245_404_160.0))));
            return Factors {
                lag: [lag, lag_slope],
                widen: [widen, widen_slope, widen_bend],
            };
        }
        let angle = t.sqrt();
        let tan = (0.5 * angle).tan();
        let lag = tan / angle;
        let ratio = angle / angle.sin();
        let ratio_slope = 0.5 * ratio * (1.0 - angle / angle.tan()) / t;
        let widen = (ratio - 1.0) / t;
        let widen_slope = (ratio_slope - widen) / t;
        let cotangent = 1.0 / angle.tan();
        let own = 1.0 - angle * cotangent;
        let own_slope = 0.5 * (1.0 + cotangent * cotangent - cotangent / angle);
        let ratio_bend = 0.5 * (ratio_slope * own + ratio * own_slope - ratio * own / t) / t;
        Factors {
            lag: [lag, (0.5 * (1.0 + tan * tan) - lag) / (2.0 * t)],
            widen: [widen, widen_slope, (ratio_bend - 2.0 * widen_slope) / t],
        }
    }
}

impl Exact {
    /// Source: docs/theory/fem.md, eq. (23).
    pub fn new(section: ElementSection) -> Exact {
        let [by_y, by_z] = section.shear_ratio();
        // An S that moves along y bends about z.
        let ratio = [by_z, by_y];
        let bending = [section.bending[1], section.bending[0]];
        let length = section.length;
        let shear = |k: usize| 12.0 * bending[k] / (length * length * (1.0 + ratio[k]));
        Exact {
            stance: Stance::new(ratio),
            shear: [0, 1].map(shear),
            section,
        }
    }

    /// Its section.
    pub fn section(&self) -> &ElementSection {
        &self.section
    }

    /// Largest stiffness against any strain [N].
    pub fn stiffest(&self) -> f64 {
        let [y, z] = self.shear;
        self.section.stiffest().max(y).max(z)
    }

    /// Tension, and what an S stores, at a strain.
    #[inline]
    fn force(&self, strain: &Vector3) -> Vector3 {
        Vector3::new(
            self.section.tension(strain.x).0,
            self.shear[0] * strain.y,
            self.shear[1] * strain.z,
        )
    }

    /// Torque and bending moments at a rotation vector from end to end.
    #[inline]
    fn moment(&self, turn: &Vector3) -> Vector3 {
        let section = &self.section;
        let curvature = (turn - section.rest) / section.length;
        let [y, z] = match section.bending_law() {
            Some(law) => radial(law, [curvature.y, curvature.z]).moment,
            None => [
                section.bending[0] * curvature.y,
                section.bending[1] * curvature.z,
            ],
        };
        Vector3::new(section.torsion * curvature.x, y, z)
    }

    /// Derivative of the moment by the rotation vector.
    #[inline]
    fn moment_stiffness(&self, turn: &Vector3) -> Matrix3 {
        let section = &self.section;
        let mut stiffness = self.initial_bending();
        if let Some(law) = section.bending_law() {
            let curvature = (turn - section.rest) / section.length;
            let [yy, yz, zz] = radial(law, [curvature.y, curvature.z]).stiffness;
            let inverse = 1.0 / section.length;
            stiffness[(1, 1)] = yy * inverse;
            stiffness[(1, 2)] = yz * inverse;
            stiffness[(2, 1)] = yz * inverse;
            stiffness[(2, 2)] = zz * inverse;
        }
        stiffness
    }

    /// Slopes of tension and S at no strain (3) [N].
    #[inline]
    fn initial_stretch(&self) -> Vector3 {
        Vector3::new(self.section.axial, self.shear[0], self.shear[1])
    }

    #[inline]
    fn initial_bending(&self) -> Matrix3 {
        let section = &self.section;
        let [y, z] = section.bending;
        Matrix3::from_diagonal(&(Vector3::new(section.torsion, y, z) / section.length))
    }
}

impl ExactState {
    /// Measures the deformation between two ends and the stress that follows.
    ///
    /// Source: docs/theory/fem.md, eqs. (17) and (18).
    #[inline]
    pub fn new(element: &Exact, ends: &[End; 2]) -> ExactState {
        let section = &element.section;
        let turn = so3::log(&(ends[0].rotation.transpose() * ends[1].rotation));
        let half = turn * 0.5;
        let axes = ends[0].rotation * so3::exp(&half);
        let back = axes.transpose();
        let span = back * (ends[1].position - ends[0].position);
        let factors = Factors::new(half.norm_squared());
        let reach = Reach::new(
            &element.stance,
            &(widened(&half, &factors, &span) / section.length),
        );
        ExactState {
            axes,
            span,
            half,
            factors,
            force: element.force(&reach.strain),
            reach,
            moment: element.moment(&turn),
            damping: Damping::new(element, ends, &back, &span),
        }
    }

    /// Forces on the two ends, elastic and damping.
    ///
    /// Source: docs/theory/fem.md, eqs. (21) and (24).
    #[inline]
    pub fn forces(&self, _element: &Exact) -> ElementForces {
        let local = self.local_forces(&self.force, &self.moment);
        ElementForces {
            force: self.axes * (local.force + self.damping.force),
            moment: [0, 1].map(|k: usize| {
                let sign = if k == 0 { -1.0 } else { 1.0 };
                let damping =
                    self.damping.moment * sign - self.span.cross(&self.damping.force) * 0.5;
                self.axes * (local.moment[k] + damping)
            }),
        }
    }

    /// Elastic forces for stresses in the element.
    #[inline]
    fn local_forces(&self, force: &Vector3, moment: &Vector3) -> ElementForces {
        let along = self.reach.pull(force);
        let force = self.widened(&along);
        let moment = moment + self.straightening(&along);
        let couple = self.span.cross(&force);
        let bend = self.widened(&moment) - self.half.cross(&couple) * (0.5 * self.factors.lag[0]);
        ElementForces {
            force,
            moment: [couple * -0.5 - bend, couple * -0.5 + bend],
        }
    }

    /// What a pull on the helix, V x / L, does to the turn of its ends.
    ///
    /// Source: docs/theory/fem.md, eq. (23a).
    #[inline]
    fn straightening(&self, pull: &Vector3) -> Vector3 {
        let [widen, slope, _] = self.factors.widen;
        let (by_span, by_pull) = (self.half.cross(&self.span), self.half.cross(pull));
        let apart = pull.cross(&by_span) + self.span.cross(&by_pull);
        self.half * (slope * by_pull.dot(&by_span)) + apart * (0.5 * widen)
    }

    /// Source: docs/theory/fem.md, eq. (19).
    #[inline]
    fn widened(&self, v: &Vector3) -> Vector3 {
        widened(&self.half, &self.factors, v)
    }

    /// Derivative of [`Self::widened`] by the half turn: X of eq. (22).
    #[inline]
    fn widened_by_half(&self, v: &Vector3) -> Matrix3 {
        let [widen, slope, _] = self.factors.widen;
        let once = self.half.cross(v);
        let twice = self.half.cross(&once);
        (hat(&once) + hat(&self.half) * hat(v)) * widen
            - twice * self.half.transpose() * (2.0 * slope)
    }

    /// Second derivative by the half turn of the product of `pull` and the widened span.
    ///
    /// Source: docs/theory/fem.md, eq. (22a).
    fn pull_by_half_twice(&self, pull: &Vector3) -> Matrix3 {
        let [widen, slope, bend] = self.factors.widen;
        let (half, span) = (&self.half, &self.span);
        let (by_span, by_pull) = (half.cross(span), half.cross(pull));
        let product = by_pull.dot(&by_span);
        let own = (pull.cross(&by_span) + span.cross(&by_pull)) * 0.5;
        let mixed = pull * span.transpose();
        Matrix3::identity() * (2.0 * (slope * product + widen * pull.dot(span)))
            - (mixed + mixed.transpose()) * widen
            + half * half.transpose() * (4.0 * bend * product)
            + (half * own.transpose() + own * half.transpose()) * (4.0 * slope)
    }

    /// Exact derivative of [`Self::forces`]. With a `prediction`, its stress takes the place of the
    /// true one in the geometric part (the mixed form).
    ///
    /// Source: docs/theory/fem.md, eq. (22).
    pub fn tangent(&self, element: &Exact, prediction: Option<&Prediction>) -> ElementTangent {
        let section = &element.section;
        let identity = Matrix3::identity();
        let force = prediction.map_or(self.force, |p| element.force(&p.strain));
        let moment = match prediction {
            // A law with kinks is no place to look ahead.
            Some(p) if section.bending_law().is_none() => element.moment(&p.turn[0]),
            _ => self.moment,
        };
        let half = &self.half;
        let half_hat = hat(half);
        let [lag, lag_slope] = self.factors.lag;
        let slope = section.tension(self.reach.strain.x).1;
        let [shear_y, shear_z] = element.shear;
        let slopes = Vector3::new(slope, shear_y, shear_z);
        let pull = self.reach.pull(&force);
        let by_reach = self.reach.pull_slope(&slopes, &force) / section.length;
        let span_hat = hat(&self.span);
        // By the mean of the spins and by their difference: the middle's spin, and its half turn.
        let middle = [identity, half_hat * (-0.5 * lag)];
        let wide = identity - half_hat * half_hat * self.factors.widen[0];
        let span = [identity, span_hat, span_hat * middle[1]];
        // Of the stored energy, by the span and by the half turn.
        let reach_by_half = self.widened_by_half(&self.span);
        let by_span = wide * by_reach * wide;
        let mixed = wide * by_reach * reach_by_half + self.widened_by_half(&pull);
        let by_half =
            reach_by_half.transpose() * by_reach * reach_by_half + self.pull_by_half_twice(&pull);
        let mut by_force = span.map(|span| by_span * span);
        let mut by_moment = span.map(|span| mixed.transpose() * span * 0.5);
        by_force[2] += mixed * wide * 0.5;
        by_moment[2] += by_half * wide * 0.25 + element.moment_stiffness(&(half * 2.0)) * wide;
        let local = self.local_forces(&force, &moment);
        let force = local.force;
        let moment = moment + self.straightening(&pull);
        let couple = self.span.cross(&force);
        let by_couple = [0, 1, 2].map(|c: usize| span_hat * by_force[c] - hat(&force) * span[c]);
        let turned_couple = half.cross(&couple);
        let bend_by_half = self.widened_by_half(&moment) + hat(&couple) * (0.5 * lag)
            - turned_couple * half.transpose() * lag_slope;
        let bend = (local.moment[1] - local.moment[0]) * 0.5;
        let mut force_rows = by_force;
        let mut couple_rows = by_couple.map(|by| by * -0.5);
        let mut bend_rows =
            [0, 1, 2].map(|c: usize| wide * by_moment[c] + half_hat * by_couple[c] * (-0.5 * lag));
        bend_rows[2] += bend_by_half * wide * 0.5;
        for c in 1..3 {
            force_rows[c] -= hat(&force) * middle[c - 1];
            couple_rows[c] += hat(&couple) * 0.5 * middle[c - 1];
            bend_rows[c] -= hat(&bend) * middle[c - 1];
        }
        let mut rates = None;
        if section.damping > 0.0 {
            let (by_turn, by_rates) = self.damping_blocks(element, &span, &middle);
            for c in 0..3 {
                force_rows[c] += by_turn[0][c];
                couple_rows[c] += by_turn[1][c];
                bend_rows[c] += by_turn[2][c];
            }
            rates = Some(turned(&by_ends(&by_rates), &self.axes));
        }
        let rows = [force_rows, couple_rows, bend_rows];
        ElementTangent {
            configuration: turned(&by_ends(&rows), &self.axes),
            rates,
        }
    }

    /// Derivatives of the damping by the configuration and by the rates; rows: force, half of the
    /// sum of the moments, half of their difference; columns: distance, mean spin, difference.
    #[expect(
        clippy::needless_range_loop,
        reason = "blocks are told apart by their indices"
    )]
    fn damping_blocks(
        &self,
        element: &Exact,
        span: &[Matrix3; 3],
        middle: &[Matrix3; 2],
    ) -> (Blocks, Blocks) {
        let section = &element.section;
        let d = &self.damping;
        let factor = section.damping / section.length;
        let by_rate = Matrix3::from_diagonal(&(element.initial_stretch() * factor));
        let by_apart = element.initial_bending() * section.damping;
        let span_hat = hat(&self.span);
        let mut by_turn = NO_BLOCKS;
        for c in 0..3 {
            let turn = if c == 0 {
                Matrix3::zeros()
            } else {
                middle[c - 1]
            };
            let rate = (hat(&d.velocity) + span_hat * hat(&d.mean)) * turn - hat(&d.mean) * span[c];
            let force = by_rate * rate;
            let couple = span_hat * force - hat(&d.force) * span[c];
            by_turn[0][c] = force - hat(&d.force) * turn;
            by_turn[1][c] = (couple - hat(&self.span.cross(&d.force)) * turn) * -0.5;
            by_turn[2][c] = by_apart * hat(&d.apart) * turn - hat(&d.moment) * turn;
        }
        let mut by_rates = NO_BLOCKS;
        by_rates[0][0] = by_rate;
        by_rates[0][1] = by_rate * span_hat;
        for c in 0..2 {
            by_rates[1][c] = span_hat * by_rates[0][c] * -0.5;
        }
        by_rates[2][2] = by_apart;
        (by_turn, by_rates)
    }

    /// The strain after a small move, from the linear solution: the mixed unknown. `moves`:
    /// translation and rotation of each end.
    ///
    /// Source: docs/theory/fem.md, eq. (22).
    pub fn predicted(&self, element: &Exact, moves: &[(Vector3, Vector3); 2]) -> Prediction {
        let back = self.axes.transpose();
        let apart = back * (moves[1].1 - moves[0].1);
        let mean = back * (moves[1].1 + moves[0].1) * 0.5;
        let middle = mean - self.half.cross(&apart) * (0.5 * self.factors.lag[0]);
        let span = back * (moves[1].0 - moves[0].0) - middle.cross(&self.span);
        let turn = self.widened(&apart);
        let reach = self.widened(&span) + self.widened_by_half(&self.span) * turn * 0.5;
        Prediction {
            strain: self.reach.predicted(&(reach / element.section.length)),
            turn: [self.half * 2.0 + turn, Vector3::zeros()],
        }
    }

    /// Elastic energy [J].
    ///
    /// Source: docs/theory/fem.md, eq. (18).
    pub fn energy(&self, element: &Exact) -> f64 {
        let section = &element.section;
        let curvature = (self.half * 2.0 - section.rest) / section.length;
        let bending = match section.bending_law() {
            Some(law) => radial(law, [curvature.y, curvature.z]).energy,
            None => {
                0.5 * (section.bending[0] * curvature.y * curvature.y
                    + section.bending[1] * curvature.z * curvature.z)
            }
        };
        let strain = &self.reach.strain;
        let [y, z] = element.shear;
        let shear = y * strain.y * strain.y + z * strain.z * strain.z;
        section.length
            * (section.axial_energy(strain.x)
                + 0.5 * shear
                + 0.5 * section.torsion * curvature.x * curvature.x
                + bending)
    }

    /// Power of the damping on the two ends, negative [W].
    pub fn damping_power(&self) -> f64 {
        let d = &self.damping;
        let rate = d.velocity - d.mean.cross(&self.span);
        -(d.force.dot(&rate) + d.moment.dot(&d.apart))
    }

    /// Stretch, and S in the planes of local y and z (3) [-].
    pub fn strain(&self) -> Vector3 {
        self.reach.strain
    }

    /// Axes of the section at the middle to global axes.
    pub fn axes(&self) -> &Matrix3 {
        &self.axes
    }
}

/// V v with the half turn's V.
#[inline]
fn widened(half: &Vector3, factors: &Factors, v: &Vector3) -> Vector3 {
    v - half.cross(&half.cross(v)) * factors.widen[0]
}

impl Damping {
    /// Source: docs/theory/fem.md, eq. (24).
    #[inline]
    fn new(element: &Exact, ends: &[End; 2], back: &Matrix3, span: &Vector3) -> Damping {
        let section = &element.section;
        if section.damping == 0.0 {
            return Damping::default();
        }
        let velocity = back * (ends[1].velocity - ends[0].velocity);
        let mean = back * (ends[0].spin + ends[1].spin) * 0.5;
        let apart = back * (ends[1].spin - ends[0].spin);
        let stiffness = element.initial_stretch();
        let rate = (velocity - mean.cross(span)) * (section.damping / section.length);
        Damping {
            force: stiffness.component_mul(&rate),
            moment: element.initial_bending() * apart * section.damping,
            velocity,
            mean,
            apart,
        }
    }
}

/// From rows of sum and difference of the moments, and columns of mean and difference of the
/// spins, to those of the two ends.
fn by_ends(rows: &Blocks) -> Blocks {
    let ends = rows.map(|[span, mean, apart]| {
        let mean = mean * 0.5;
        [span, mean - apart, mean + apart]
    });
    let [force, sum, difference] = ends;
    let add = |sign: f64| [0, 1, 2].map(|c: usize| sum[c] + difference[c] * sign);
    [force, add(-1.0), add(1.0)]
}
