//! The corotational beam element: a frame that moves with the element, and a small deformation
//! against it.
//!
//! The frame's first axis is the chord between the ends; its roll follows the mean of the two
//! sections. Against it the element bends as a cubic beam, with the shortening that a bent line
//! has, so that a tension stiffens it against rotations of its ends as well.
//!
//! Forces are the exact gradient of the stored energy; the tangent is exact.
//!
//! Source: docs/theory/fem.md, eqs. (5) to (16); Crisfield 1990, Battini and Pacoste 2002.

use catenix_numerics::{Matrix3, Vector3, so3};

use super::ends::{Blocks, ElementForces, ElementTangent, End, NO_BLOCKS, Prediction, turned};
use super::section::{ElementSection, radial};
use super::triad::{Triad, by_spin};
use so3::hat;

/// Constant numbers of an element, from its section.
#[derive(Debug, Clone, PartialEq)]
pub struct Corotational {
    section: ElementSection,
    /// Stiffness against the mean of the two end rotations, local y and z: 12 EI / l (2) [N m].
    pub(super) alike: [f64; 2],
    /// Stiffness against half of their difference, local y and z: 4 EI / l (2) [N m].
    pub(super) apart: [f64; 2],
    /// Shortening by the mean of the end rotations, squared, per length, local y and z (2) [-].
    pub(super) bow: [f64; 2],
    /// Turns of the two ends without stress (2 x 3) [rad].
    pub(super) rest: [Vector3; 2],
    /// Strain that the cubic shortening makes of the shape without stress [-].
    pub(super) rest_strain: f64,
}

/// An element at one configuration.
#[derive(Debug, Clone, Copy)]
pub struct CorotationalState {
    triad: Triad,
    /// Rotation vector of each section against the element axes (2 x 3) [rad].
    turn: [Vector3; 2],
    /// Strain, the shortening by bending made up for [-].
    strain: f64,
    /// Tension [N].
    pub tension: f64,
    /// Derivatives of the strain by the two turns (2 x 3).
    bow: [Vector3; 2],
    /// Moments of bending and torsion by the two turns, without the tension's (2 x 3) [N m].
    bending: [Vector3; 2],
    /// Damping: tension [N], and moments on the two ends in element axes (2 x 3) [N m].
    damping: Damping,
}

#[derive(Debug, Clone, Copy, Default)]
struct Damping {
    tension: f64,
    moment: [Vector3; 2],
    /// Velocity of the second end less that of the first, in element axes (3) [m/s].
    velocity: Vector3,
    /// Spins of the ends, in element axes (2 x 3) [rad/s].
    spin: [Vector3; 2],
    /// Spins against the chord (2 x 3) [rad/s].
    relative: [Vector3; 2],
}

impl Corotational {
    /// Source: docs/theory/fem.md, eqs. (2), (4) and (7).
    pub fn new(section: ElementSection) -> Corotational {
        let ratio = section.shear_ratio();
        let per_length = section.bending.map(|bending| bending / section.length);
        let alike = [0, 1].map(|k| 12.0 * per_length[k] / (1.0 + ratio[k]));
        let bow = |k: usize| {
            let share = ratio[k] / (1.0 + ratio[k]);
            let lengthened = alike[k] / (section.axial * section.length);
            0.1 * (1.0 - share).powi(2) - 0.5 * share * share + share * lengthened
        };
        let mut element = Corotational {
            alike,
            apart: per_length.map(|stiffness| 4.0 * stiffness),
            bow: [0, 1].map(bow),
            rest: [Vector3::zeros(); 2],
            rest_strain: 0.0,
            section,
        };
        let rest = element.section.rest;
        if rest != Vector3::zeros() {
            let length = element.section.length;
            let rotations = [Matrix3::identity(), so3::exp(&rest)];
            let span = so3::left_jacobian(&rest) * Vector3::x() * length;
            let triad = Triad::new(&rotations, &span);
            element.rest = triad.turns(&rotations);
            let shortening = element.shortening(&element.rest).0;
            element.rest_strain = (triad.chord - length) / length + shortening;
        }
        element
    }

    /// Its section.
    pub fn section(&self) -> &ElementSection {
        &self.section
    }

    /// Whether it can be computed side by side with others: its laws are linear.
    pub fn is_linear(&self) -> bool {
        self.section.laws.is_none()
    }

    /// Largest stiffness against a displacement, times the length [N]: of extension, or of the ends
    /// across the chord, 12 EI / l^2.
    pub fn stiffest(&self) -> f64 {
        let across = self.alike[0].max(self.alike[1]) / self.section.length;
        self.section.stiffest().max(across)
    }

    /// Shortening by bending, per length, and its derivatives by the two turns.
    ///
    /// Source: docs/theory/fem.md, eq. (8).
    #[inline]
    fn shortening(&self, turn: &[Vector3; 2]) -> (f64, [Vector3; 2]) {
        let mut sum = 0.0;
        let mut by_turn = [Vector3::zeros(); 2];
        for k in 0..2 {
            let (alike, apart) = modes(turn, k);
            sum += self.bow[k] * alike * alike + apart * apart / 6.0;
            by_turn[0][k + 1] = self.bow[k] * alike - apart / 6.0;
            by_turn[1][k + 1] = self.bow[k] * alike + apart / 6.0;
        }
        (sum, by_turn)
    }

    /// Turns less those without stress.
    #[inline]
    fn change(&self, turn: &[Vector3; 2]) -> [Vector3; 2] {
        [turn[0] - self.rest[0], turn[1] - self.rest[1]]
    }

    /// Moments by the two turns, of bending and torsion.
    ///
    /// Source: docs/theory/fem.md, eqs. (7) and (9).
    #[inline]
    fn bending(&self, turn: &[Vector3; 2]) -> [Vector3; 2] {
        let change = &self.change(turn);
        let torque = self.section.torsion / self.section.length * (change[1].x - change[0].x);
        let mut moment = [Vector3::x() * -torque, Vector3::x() * torque];
        if let Some(law) = self.section.bending_law() {
            for (weights, curvature) in self.curvatures(change) {
                let stress = radial(law, curvature);
                for k in 0..2 {
                    for end in 0..2 {
                        moment[end][k + 1] += 0.5 * weights[end] * stress.moment[k];
                    }
                }
            }
            return moment;
        }
        for k in 0..2 {
            let (alike, apart) = modes(change, k);
            let (a, d) = (0.5 * self.alike[k] * alike, 0.5 * self.apart[k] * apart);
            moment[0][k + 1] = a - d;
            moment[1][k + 1] = a + d;
        }
        moment
    }

    /// The two points of integration of a bending law: how the bend there follows the turn of each
    /// end (2) [-], and the curvature less the one at rest, about local y and z (2) [1/m].
    ///
    /// Source: docs/theory/fem.md, eq. (9).
    #[inline]
    fn curvatures(&self, change: &[Vector3; 2]) -> [([f64; 2], [f64; 2]); 2] {
        let root = 3.0f64.sqrt();
        [-root, root].map(|root| {
            let weights = [root - 1.0, root + 1.0];
            let curvature = [1, 2].map(|k| {
                let bend = weights[0] * change[0][k] + weights[1] * change[1][k];
                bend / self.section.length
            });
            (weights, curvature)
        })
    }

    /// Derivatives of [`Self::bending`] by the two turns (2 x 2).
    #[inline]
    #[expect(
        clippy::needless_range_loop,
        reason = "blocks are told apart by their indices"
    )]
    fn bending_stiffness(&self, turn: Option<&[Vector3; 2]>) -> [[Matrix3; 2]; 2] {
        let mut stiffness = [[Matrix3::zeros(); 2]; 2];
        let torsion = self.section.torsion / self.section.length;
        let law = self.section.bending_law();
        for i in 0..2 {
            for j in 0..2 {
                let sign = if i == j { 1.0 } else { -1.0 };
                stiffness[i][j][(0, 0)] = sign * torsion;
                if law.is_none() || turn.is_none() {
                    for k in 0..2 {
                        stiffness[i][j][(k + 1, k + 1)] =
                            0.25 * (self.alike[k] + sign * self.apart[k]);
                    }
                }
            }
        }
        if let (Some(law), Some(turn)) = (law, turn) {
            for (weights, curvature) in self.curvatures(&self.change(turn)) {
                let [yy, yz, zz] = radial(law, curvature).stiffness;
                for i in 0..2 {
                    for j in 0..2 {
                        let factor = 0.5 * weights[i] * weights[j] / self.section.length;
                        stiffness[i][j][(1, 1)] += factor * yy;
                        stiffness[i][j][(1, 2)] += factor * yz;
                        stiffness[i][j][(2, 1)] += factor * yz;
                        stiffness[i][j][(2, 2)] += factor * zz;
                    }
                }
            }
        }
        stiffness
    }
}

/// Mean, and half of the difference, of the turns of the two ends about local y (0) or z (1).
#[inline]
fn modes(turn: &[Vector3; 2], k: usize) -> (f64, f64) {
    (
        0.5 * (turn[0][k + 1] + turn[1][k + 1]),
        0.5 * (turn[1][k + 1] - turn[0][k + 1]),
    )
}

impl CorotationalState {
    /// Measures the deformation between two ends and the stress that follows.
    #[inline]
    pub fn new(element: &Corotational, ends: &[End; 2]) -> CorotationalState {
        let section = &element.section;
        let span = ends[1].position - ends[0].position;
        let sections = [ends[0].rotation, ends[1].rotation];
        let triad = Triad::new(&sections, &span);
        let turn = triad.turns(&sections);
        let (shortening, bow) = element.shortening(&turn);
        let length = section.length;
        // The difference of the squares loses no digits to that of the lengths.
        let stretch = (span.norm_squared() - length * length) / (triad.chord + length);
        let strain = stretch / length + shortening - element.rest_strain;
        CorotationalState {
            turn,
            strain,
            tension: section.tension(strain).0,
            bow,
            bending: element.bending(&turn),
            damping: Damping::new(element, ends, &triad),
            triad,
        }
    }

    /// Forces on the two ends, elastic and damping.
    ///
    /// Source: docs/theory/fem.md, eqs. (11) and (14).
    #[inline]
    pub fn forces(&self, element: &Corotational) -> ElementForces {
        let local = self.local_forces(self.tension, &self.elastic_moments(element));
        ElementForces {
            force: self.triad.axes * local.force,
            moment: local.moment.map(|moment| self.triad.axes * moment),
        }
    }

    /// Moments by the spins of the two sections against the element axes.
    #[inline]
    fn elastic_moments(&self, element: &Corotational) -> [Vector3; 2] {
        let length = element.section.length;
        [0, 1].map(|k: usize| {
            let moment = self.bending[k] + self.bow[k] * (self.tension * length);
            by_spin(&self.turn[k], &moment).0
        })
    }

    /// Forces in element axes, damping included.
    #[inline]
    fn local_forces(&self, tension: f64, moments: &[Vector3; 2]) -> ElementForces {
        let triad = &self.triad;
        let sum = moments[0] + moments[1];
        let damped = self.damping.moment[0] + self.damping.moment[1];
        let inverse = 1.0 / triad.chord;
        ElementForces {
            force: Vector3::new(
                tension + self.damping.tension,
                -(sum.z + damped.z) * inverse,
                (triad.lean * sum.x + sum.y + damped.y) * inverse,
            ),
            moment: [0, 1].map(|k: usize| {
                moments[k] - triad.roll(&triad.directors[k]) * sum.x + self.damping.moment[k]
            }),
        }
    }

    /// Exact derivative of [`Self::forces`]. With a `prediction`, its stress takes the place of
    /// the true one in the geometric part (the mixed form).
    ///
    /// Source: docs/theory/fem.md, eqs. (12), (13), (15) and (16).
    pub fn tangent(
        &self,
        element: &Corotational,
        prediction: Option<&Prediction>,
    ) -> ElementTangent {
        let section = &element.section;
        let triad = &self.triad;
        let length = section.length;
        let inverse = 1.0 / triad.chord;
        let (tension, bending) = match prediction {
            // A law with kinks is no place to look ahead.
            Some(p) if section.bending_law().is_some() => {
                (section.tension(p.strain.x).0, self.bending)
            }
            Some(p) => (section.tension(p.strain.x).0, element.bending(&p.turn)),
            None => (self.tension, self.bending),
        };
        let slope = section.tension(self.strain).1;
        // By the spins of the sections against the element axes.
        let moved = [0, 1].map(|k: usize| {
            let moment = bending[k] + self.bow[k] * (tension * length);
            by_spin(&self.turn[k], &moment)
        });
        let moments = moved.map(|(moment, _, _)| moment);
        let pull = [0, 1].map(|k: usize| moved[k].1.transpose() * (self.bow[k] * slope));
        let mut stiffness = element.bending_stiffness(Some(&self.turn));
        for i in 0..2 {
            for j in 0..2 {
                let sign = if i == j { 1.0 } else { -1.0 };
                for k in 0..2 {
                    stiffness[i][j][(k + 1, k + 1)] +=
                        tension * length * (0.5 * element.bow[k] + sign / 12.0);
                }
                stiffness[i][j] += self.bow[i] * self.bow[j].transpose() * (slope * length);
                stiffness[i][j] = moved[i].1.transpose() * stiffness[i][j] * moved[j].1;
            }
            stiffness[i][i] += moved[i].2 * moved[i].1;
        }
        let turning = triad.turning();
        // Columns of a derivative by the relative spins, from distance and spins of the ends.
        let relative = |by: [&Matrix3; 2]| -> [Matrix3; 3] {
            let all = by[0] + by[1];
            [
                -(all * turning[0]),
                by[0] - all * turning[1],
                by[1] - all * turning[2],
            ]
        };
        let mut by_moment = [0, 1].map(|i: usize| relative([&stiffness[i][0], &stiffness[i][1]]));
        for i in 0..2 {
            let mut column = by_moment[i][0].column_mut(0);
            column += pull[i];
        }
        let mut by_tension = {
            let all = (pull[0] + pull[1]).transpose();
            [
                -(all * turning[0]),
                pull[0].transpose() - all * turning[1],
                pull[1].transpose() - all * turning[2],
            ]
        };
        by_tension[0][0] += slope / length;
        let lean = triad.lean_changes(&turning);
        let sum = moments[0] + moments[1];
        let by_sum = [0, 1, 2].map(|c: usize| by_moment[0][c] + by_moment[1][c]);
        let damped = self.damping.moment[0] + self.damping.moment[1];
        let across = [
            (sum.z + damped.z) * inverse * inverse,
            -(triad.lean * sum.x + sum.y + damped.y) * inverse * inverse,
        ];
        let local = self.local_forces(tension, &moments);
        let rows = [&local.force, &local.moment[0], &local.moment[1]].map(hat);
        let mut blocks = NO_BLOCKS;
        for c in 0..3 {
            let force = &mut blocks[0][c];
            force.set_row(0, &by_tension[c]);
            force.set_row(1, &(by_sum[c].row(2) * -inverse));
            let rolled = by_sum[c].row(0) * triad.lean + lean.mean[c].transpose() * sum.x;
            force.set_row(2, &((rolled + by_sum[c].row(1)) * inverse));
            if c == 0 {
                force[(1, 0)] += across[0];
                force[(2, 0)] += across[1];
            }
            for i in 0..2 {
                let roll = triad.roll(&triad.directors[i]);
                let mut moment = by_moment[i][c] - roll * by_sum[c].row(0);
                for axis in 0..2 {
                    let mut row = moment.row_mut(axis);
                    row -= lean.roll[i][axis][c].transpose() * sum.x;
                }
                blocks[i + 1][c] = moment;
            }
            for (row, hat) in blocks.iter_mut().zip(&rows) {
                row[c] -= hat * turning[c];
            }
        }
        let rates = (section.damping > 0.0).then(|| {
            self.add_damping_turn(element, &turning, &mut blocks);
            turned(&self.damping_by_rates(element), &triad.axes)
        });
        ElementTangent {
            configuration: turned(&blocks, &triad.axes),
            rates,
        }
    }

    /// The deformation after a small move, from the linear solution: the mixed unknowns. `moves`:
    /// translation and rotation of each end.
    ///
    /// Source: docs/theory/fem.md, eq. (16).
    pub fn predicted(&self, element: &Corotational, moves: &[(Vector3, Vector3); 2]) -> Prediction {
        let triad = &self.triad;
        let back = triad.axes.transpose();
        let span = back * (moves[1].0 - moves[0].0);
        let spins = [0, 1].map(|k: usize| back * moves[k].1);
        let turning = triad.turning();
        let own = turning[0] * span + turning[1] * spins[0] + turning[2] * spins[1];
        let turned =
            [0, 1].map(|k: usize| so3::left_jacobian_inverse(&self.turn[k]) * (spins[k] - own));
        let bowed = self.bow[0].dot(&turned[0]) + self.bow[1].dot(&turned[1]);
        Prediction {
            strain: Vector3::x() * (self.strain + span.x / element.section.length + bowed),
            turn: [self.turn[0] + turned[0], self.turn[1] + turned[1]],
        }
    }

    /// Elastic energy [J].
    ///
    /// Source: docs/theory/fem.md, eqs. (7) and (8).
    pub fn energy(&self, element: &Corotational) -> f64 {
        let section = &element.section;
        let change = element.change(&self.turn);
        let twist = change[1].x - change[0].x;
        let bending = match section.bending_law() {
            Some(law) => {
                let points = element.curvatures(&change);
                let energies = points.map(|(_, curvature)| radial(law, curvature).energy);
                0.5 * section.length * (energies[0] + energies[1])
            }
            None => (0..2)
                .map(|k| {
                    let (alike, apart) = modes(&change, k);
                    0.5 * (element.alike[k] * alike * alike + element.apart[k] * apart * apart)
                })
                .sum(),
        };
        section.axial_energy(self.strain) * section.length
            + 0.5 * section.torsion / section.length * twist * twist
            + bending
    }

    /// Power of the damping on the two ends, negative [W].
    pub fn damping_power(&self) -> f64 {
        let d = &self.damping;
        -(d.tension * d.velocity.x
            + d.moment[0].dot(&d.relative[0])
            + d.moment[1].dot(&d.relative[1]))
    }

    /// Strain, the shortening by bending made up for [-].
    pub fn strain(&self) -> f64 {
        self.strain
    }

    /// Element axes to global axes.
    pub fn axes(&self) -> &Matrix3 {
        &self.triad.axes
    }
}

impl Damping {
    /// Source: docs/theory/fem.md, eq. (14).
    #[inline]
    fn new(element: &Corotational, ends: &[End; 2], triad: &Triad) -> Damping {
        let section = &element.section;
        if section.damping == 0.0 {
            return Damping::default();
        }
        let back = triad.axes.transpose();
        let velocity = back * (ends[1].velocity - ends[0].velocity);
        let spin = [0, 1].map(|k: usize| back * ends[k].spin);
        let chord = Vector3::new(0.0, -velocity.z, velocity.y) / triad.chord;
        let relative = spin.map(|spin| spin - chord);
        let stiffness = element.bending_stiffness(None);
        Damping {
            tension: section.damping * section.axial / section.length * velocity.x,
            moment: [0, 1].map(|i: usize| {
                (stiffness[i][0] * relative[0] + stiffness[i][1] * relative[1]) * section.damping
            }),
            velocity,
            spin,
            relative,
        }
    }
}

impl CorotationalState {
    /// Adds how the damping changes as the element axes turn and the chord grows, with the
    /// velocities held; the turning of the forces themselves is in `blocks` already.
    ///
    /// Source: docs/theory/fem.md, eq. (15).
    fn add_damping_turn(
        &self,
        element: &Corotational,
        turning: &[Matrix3; 3],
        blocks: &mut Blocks,
    ) {
        let d = &self.damping;
        let tau = element.section.damping;
        let inverse = 1.0 / self.triad.chord;
        let stiffness = element.bending_stiffness(None);
        let across = across_chord(inverse);
        let axial = tau * element.section.axial / element.section.length;
        let velocity_hat = hat(&d.velocity);
        for c in 0..3 {
            // Components of a held vector change by hat(v) times the turning of the axes.
            let by_velocity = velocity_hat * turning[c];
            let mut chord = across * by_velocity;
            if c == 0 {
                chord[(1, 0)] += d.velocity.z * inverse * inverse;
                chord[(2, 0)] -= d.velocity.y * inverse * inverse;
            }
            let relative = [0, 1].map(|k: usize| hat(&d.spin[k]) * turning[c] - chord);
            let moment = [0, 1].map(|i: usize| {
                (stiffness[i][0] * relative[0] + stiffness[i][1] * relative[1]) * tau
            });
            let sum = moment[0] + moment[1];
            let mut force = across * sum;
            force.set_row(0, &(by_velocity.row(0) * axial));
            blocks[0][c] += force;
            blocks[1][c] += moment[0];
            blocks[2][c] += moment[1];
        }
    }

    /// Derivatives of the damping by velocities and spins, in element axes.
    ///
    /// Source: docs/theory/fem.md, eq. (15).
    #[expect(
        clippy::needless_range_loop,
        reason = "blocks are told apart by their indices"
    )]
    fn damping_by_rates(&self, element: &Corotational) -> Blocks {
        let section = &element.section;
        let stiffness = element.bending_stiffness(None);
        let across = across_chord(1.0 / self.triad.chord);
        let mut blocks = NO_BLOCKS;
        for c in 0..3 {
            let relative = [0, 1].map(|k: usize| match c {
                0 => -across,
                _ if c == k + 1 => Matrix3::identity(),
                _ => Matrix3::zeros(),
            });
            let moment = [0, 1].map(|i: usize| {
                (stiffness[i][0] * relative[0] + stiffness[i][1] * relative[1]) * section.damping
            });
            blocks[0][c] = across * (moment[0] + moment[1]);
            blocks[1][c] = moment[0];
            blocks[2][c] = moment[1];
        }
        blocks[0][0][(0, 0)] += section.damping * section.axial / section.length;
        blocks
    }
}

/// The spin of the chord by the relative velocity of its ends, in element axes. It is minus its
/// transpose, so this times the sum of the moments is the force that they need across the chord.
#[inline]
fn across_chord(inverse: f64) -> Matrix3 {
    Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -inverse, 0.0, inverse, 0.0)
}
