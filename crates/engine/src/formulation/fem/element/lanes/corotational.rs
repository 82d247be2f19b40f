//! The corotational beam, several elements at a time: those with linear laws. The formulas are those
//! of `corotational.rs`, arranged so that little is computed: everything happens in element axes,
//! where a roll has one component and a chord one direction.
//!
//! Source: docs/theory/fem.md, eqs. (5) to (16) and (48) to (55).

use catenix_numerics::lanes::{Lane, MOST_LANES, Mat3, Row, Vec3};

use super::super::corotational::Corotational;
use super::couples::Couples;
use super::damping::Damping;
use super::elastic::{Elastic, add_extension};
use super::frame::{Frame, Turned, left_jacobian_inverse};
use super::law::Law;
use super::{Assembled, Ends, Weights, turned};

const NO_ROW: Row = [0.0; MOST_LANES];

/// Elements that are computed side by side: what never changes, and what the last evaluation left.
#[derive(Debug, Clone)]
pub struct CorotationalLanes {
    length: Row,
    /// EA [N].
    axial: Row,
    /// GJ / l [N m].
    torsion: Row,
    /// Stiffness against the mean and half of the difference of the end rotations, local y and z.
    alike: [Row; 2],
    apart: [Row; 2],
    /// Shortening by the mean of the end rotations, squared.
    bow: [Row; 2],
    /// Turns of the two ends without stress (2 x 3).
    rest: [Row; 6],
    rest_strain: Row,
    /// Damping time [s].
    damping: Row,
    damped: bool,
    /// Element axes (9), one over the chord, lean, rolls (2 x 2), turns (6), strain, and b of
    /// both turns.
    kept: [Row; 24],
    /// Strain and turns (2 x 3) that the mixed form predicts.
    predicted: [Row; 7],
    /// Elastic energy [J] and power of the damping [W].
    energy: [Row; 2],
}

#[inline(always)]
fn two<T: Lane>(token: T::Token, [a, b]: &[Row; 2]) -> [T; 2] {
    [T::read(token, a), T::read(token, b)]
}

impl CorotationalLanes {
    /// Elements side by side; the last one fills idle lanes.
    pub fn new(elements: &[&Corotational]) -> CorotationalLanes {
        let mut own = CorotationalLanes {
            length: NO_ROW,
            axial: NO_ROW,
            torsion: NO_ROW,
            alike: [NO_ROW; 2],
            apart: [NO_ROW; 2],
            bow: [NO_ROW; 2],
            rest: [NO_ROW; 6],
            rest_strain: NO_ROW,
            damping: NO_ROW,
            damped: elements.iter().any(|e| e.section().damping > 0.0),
            kept: [NO_ROW; 24],
            predicted: [NO_ROW; 7],
            energy: [NO_ROW; 2],
        };
        for lane in 0..MOST_LANES {
            let element = elements[lane.min(elements.len() - 1)];
            let section = element.section();
            own.length[lane] = section.length;
            own.axial[lane] = section.axial;
            own.torsion[lane] = section.torsion / section.length;
            own.damping[lane] = section.damping;
            own.rest_strain[lane] = element.rest_strain;
            for k in 0..2 {
                own.alike[k][lane] = element.alike[k];
                own.apart[k][lane] = element.apart[k];
                own.bow[k][lane] = element.bow[k];
                for axis in 0..3 {
                    own.rest[3 * k + axis][lane] = element.rest[k][axis];
                }
            }
        }
        own
    }

    /// Elastic energy [J] and power of the damping [W] at the last evaluation, one row each.
    pub fn energy(&self) -> &[Row; 2] {
        &self.energy
    }

    #[inline(always)]
    fn law<T: Lane>(&self, token: T::Token) -> Law<T> {
        Law {
            length: T::read(token, &self.length),
            axial: T::read(token, &self.axial),
            torsion: T::read(token, &self.torsion),
            alike: two(token, &self.alike),
            apart: two(token, &self.apart),
            bow: two(token, &self.bow),
        }
    }

    /// Adds the forces of the elements and, with `weights`, their derivatives; also those of a
    /// vertical load per length [N/m], beyond the halves of it that go to the two ends. `predicts`:
    /// the stress that was predicted takes the place of the true one in the geometric part.
    #[inline(always)]
    pub fn add<T: Lane>(
        &mut self,
        token: T::Token,
        ends: &[Ends<T>; 2],
        load: T,
        predicts: bool,
        weights: Option<&Weights<T>>,
        out: &mut Assembled<T>,
    ) {
        let law = self.law::<T>(token);
        let frame = Frame::new(ends);
        let spun = [
            Turned::new(frame.sections[0]),
            Turned::new(frame.sections[1]),
        ];
        let turn = [spun[0].turn, spun[1].turn];
        let rest = [
            Vec3::read(token, &self.rest),
            Vec3::read(token, &self.rest[3..]),
        ];
        let change = [turn[0] - rest[0], turn[1] - rest[1]];
        let (bow, shortening) = law.shortening(turn);
        // The difference of the squares loses no digits to that of the lengths.
        let stretch = (frame.squared_chord - law.length * law.length) / (frame.chord + law.length);
        let strain = stretch / law.length + shortening - T::read(token, &self.rest_strain);
        let tension = law.axial * strain;
        let bending = law.bending(change);
        // Moments of a unit of tension times length by the spins of the sections.
        let bowed = [spun[0].moment(bow[0]), spun[1].moment(bow[1])];
        let pull = tension * law.length;
        let moments = [
            spun[0].moment(bending[0]).plus(pull, bowed[0]),
            spun[1].moment(bending[1]).plus(pull, bowed[1]),
        ];
        let couples = Couples::new(&frame, load * law.length * law.length * (1.0 / 12.0));
        let elastic = Elastic::new(&frame, tension, moments);
        let mut force = elastic.force + couples.force;
        let [first, second] = couples.moments();
        let mut on_ends = [elastic.moments[0] + first, elastic.moments[1] + second];
        let mut power = tension.same(0.0);
        let damping = if self.damped {
            Some(Damping::new(
                T::read(token, &self.damping),
                &law,
                &frame,
                ends,
            ))
        } else {
            None
        };
        if let Some(damping) = &damping {
            force += damping.force;
            on_ends[0] += damping.moments[0];
            on_ends[1] += damping.moments[1];
            power = damping.power;
        }
        let e = frame.axes;
        out.add_internal(e.times(force), [e.times(on_ends[0]), e.times(on_ends[1])]);
        self.keep(&frame, &spun, strain);
        law.energy(change, strain).write(&mut self.energy[0]);
        power.write(&mut self.energy[1]);

        let Some(weights) = weights else { return };
        let (elastic, by_turn) = if predicts {
            let tension = law.axial * T::read(token, &self.predicted[0]);
            let turn = [
                Vec3::read(token, &self.predicted[1..]),
                Vec3::read(token, &self.predicted[4..]),
            ];
            let bending = law.bending([turn[0] - rest[0], turn[1] - rest[1]]);
            let pull = tension * law.length;
            let by_turn = [bending[0].plus(pull, bow[0]), bending[1].plus(pull, bow[1])];
            let moments = [spun[0].moment(by_turn[0]), spun[1].moment(by_turn[1])];
            (Elastic::new(&frame, tension, moments), by_turn)
        } else {
            let by_turn = [bending[0].plus(pull, bow[0]), bending[1].plus(pull, bow[1])];
            (elastic, by_turn)
        };
        let mut local = elastic.tangent(&law, &frame, &spun, by_turn);
        add_extension(&law, &frame, bowed, &mut local);
        couples.add_tangent(&frame, &mut local);
        let by = match &damping {
            None => local.everywhere(e),
            Some(damping) => {
                let mut all = local.all();
                damping.add_tangent(&law, &frame, weights, &mut all);
                let mut r = 0;
                while r < 3 {
                    let mut c = 0;
                    while c < 3 {
                        all[r][c] = turned(e, all[r][c]);
                        c += 1;
                    }
                    r += 1;
                }
                all
            }
        };
        out.add_internal_tangent(&by);
    }

    #[inline(always)]
    fn keep<T: Lane>(&mut self, frame: &Frame<T>, spun: &[Turned<T>; 2], strain: T) {
        let kept = &mut self.kept;
        frame.axes.0[0].write(kept);
        frame.axes.0[1].write(&mut kept[3..]);
        frame.axes.0[2].write(&mut kept[6..]);
        frame.inverse.write(&mut kept[9]);
        frame.lean.write(&mut kept[10]);
        frame.roll[0].x.write(&mut kept[11]);
        frame.roll[0].y.write(&mut kept[12]);
        frame.roll[1].x.write(&mut kept[13]);
        frame.roll[1].y.write(&mut kept[14]);
        spun[0].turn.write(&mut kept[15..]);
        spun[1].turn.write(&mut kept[18..]);
        strain.write(&mut kept[21]);
        spun[0].b.write(&mut kept[22]);
        spun[1].b.write(&mut kept[23]);
    }

    /// Keeps the deformation after a small move, from the linear solution. `moves`: translation and
    /// rotation of both ends.
    ///
    /// Source: docs/theory/fem.md, eq. (16).
    #[inline(always)]
    pub fn predict<T: Lane>(&mut self, token: T::Token, moves: [[Vec3<T>; 2]; 2]) {
        let law = self.law::<T>(token);
        let kept = &self.kept;
        let axes = Mat3::<T>::read(token, kept);
        let inverse = T::read(token, &kept[9]);
        let lean = T::read(token, &kept[10]);
        let [first, second] = moves;
        let span = axes.led_by(second[0] - first[0]);
        let spins = [axes.led_by(first[1]), axes.led_by(second[1])];
        let rolled = T::read(token, &kept[11]) * spins[0].x
            + T::read(token, &kept[12]) * spins[0].y
            + T::read(token, &kept[13]) * spins[1].x
            + T::read(token, &kept[14]) * spins[1].y;
        let own = Vec3::new(
            rolled - lean * span.z * inverse,
            -(span.z * inverse),
            span.y * inverse,
        );
        let turn = [
            Vec3::read(token, &kept[15..]),
            Vec3::read(token, &kept[18..]),
        ];
        let changes = [
            left_jacobian_inverse(turn[0], T::read(token, &kept[22])).times(spins[0] - own),
            left_jacobian_inverse(turn[1], T::read(token, &kept[23])).times(spins[1] - own),
        ];
        let (bow, _) = law.shortening(turn);
        let bowed = bow[0].dot(changes[0]) + bow[1].dot(changes[1]);
        let strain = T::read(token, &kept[21]) + span.x / law.length + bowed;
        strain.write(&mut self.predicted[0]);
        (turn[0] + changes[0]).write(&mut self.predicted[1..]);
        (turn[1] + changes[1]).write(&mut self.predicted[4..]);
    }
}
