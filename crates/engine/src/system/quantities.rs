//! From the results at the nodes of a line to the quantities that are reported: wall tension,
//! stress and declination, several nodes at a time.

use std::sync::Arc;

use catenix_model::Model;
use catenix_numerics::lanes::{Kernel, Lane, MOST_LANES, Row, atan2, lane_count, vectorised};

use super::LineLayout;

/// Numbers that a node takes, see [`WallFactors::new`].
const FACTORS: usize = 9;

/// What the quantities at the nodes of a line are computed with.
///
/// With the depth d the pressures are proportional to d, so equations (1) to (4) become products
/// of these factors with depth, tension, moment and torque.
#[derive(Debug, Clone)]
pub(crate) struct WallFactors {
    /// Per batch of nodes, shared by neighbours that are alike: wall tension per depth [N/m]; mean
    /// stress per depth [Pa/m]; one over the area of the wall [1/m2]; at the outer and then the
    /// inner radius: half the difference of hoop and radial stress per depth [Pa/m], axial stress
    /// per bending moment and shear stress per torque [1/m3]. NaN at nodes without a wall.
    factors: Vec<Arc<[Row; FACTORS]>>,
}

impl WallFactors {
    /// For a line. Without water there is no surface from which pressures could be reckoned.
    ///
    /// Source: docs/theory/results.md, eqs. (1) to (4).
    pub(super) fn new(model: &Model, layout: &LineLayout) -> WallFactors {
        let environment = &model.environment;
        let wet = f64::from(u8::from(environment.water.is_some()));
        let last = layout.element_count - 1;
        let mut factors: Vec<Arc<[Row; FACTORS]>> = Vec::new();
        let mut batch = [[0.0; MOST_LANES]; FACTORS];
        for node in 0..=layout.element_count {
            let line_type = &model.line_types[layout.element_types[node.min(last)]];
            let per_depth = |density: f64| wet * density * environment.gravity;
            let outer = per_depth(environment.fluid_density());
            let inner = per_depth(line_type.content_density);
            let area = |diameter: f64| 0.25 * std::f64::consts::PI * diameter * diameter;
            let wall_tension =
                inner * area(line_type.inner_diameter) - outer * area(line_type.outer_diameter);
            let mut values = [f64::NAN; FACTORS];
            if let Some(wall) = line_type.wall {
                let [ro, ri] = [wall.outer_diameter, wall.inner_diameter].map(|d| 0.5 * d);
                let span = ro * ro - ri * ri;
                let second_moment = 0.25 * std::f64::consts::PI * (ro.powi(4) - ri.powi(4));
                values[1] = (inner * ri * ri - outer * ro * ro) / span;
                values[2] = 1.0 / (std::f64::consts::PI * span);
                // A solid section has its outer radius twice.
                let radii = [ro, if ri > 0.0 { ri } else { ro }];
                for (side, radius) in radii.into_iter().enumerate() {
                    let other = ri * ro / radius;
                    values[3 + side] = (inner - outer) * other * other / span;
                    values[5 + side] = radius / second_moment;
                    values[7 + side] = radius / (2.0 * second_moment);
                }
            }
            values[0] = wall_tension;
            let lane = node % lane_count();
            for (row, value) in batch.iter_mut().zip(values) {
                row[lane] = value;
            }
            if lane + 1 == lane_count() || node == layout.element_count {
                // No number equals itself where there is no wall: the bits are compared.
                let bits = |batch: &[Row; FACTORS]| batch.map(|row| row.map(f64::to_bits));
                let own = match factors.last() {
                    Some(before) if bits(before) == bits(&batch) => before.clone(),
                    _ => Arc::new(batch),
                };
                factors.push(own);
            }
        }
        WallFactors { factors }
    }

    /// Puts wall tension, stress and declination into their rows, where the axis stands so far:
    /// (11 x nodes), see [`crate::formulation::NODE_ROWS`].
    pub(super) fn finish(&self, nodes: usize, rows: &mut [f64]) {
        vectorised(Finish {
            factors: &self.factors,
            nodes,
            rows,
        });
    }
}

/// Rows that are read, and those that are written.
const READ: [usize; 7] = [2, 3, 6, 8, 4, 9, 10];
const WRITTEN: [usize; 3] = [4, 9, 10];

struct Finish<'a> {
    factors: &'a [Arc<[Row; FACTORS]>],
    nodes: usize,
    rows: &'a mut [f64],
}

impl Kernel for Finish<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Finish {
            factors,
            nodes,
            rows,
        } = self;
        let zero = T::splat(token, 0.0);
        let mut node = 0;
        while node < nodes {
            let count = T::COUNT.min(nodes - node);
            let mut values = [zero; READ.len()];
            let mut k = 0;
            while k < READ.len() {
                let start = READ[k] * nodes + node;
                values[k] = if count == T::COUNT {
                    T::read_some(token, &rows[start..start + T::COUNT])
                } else {
                    let mut numbers = [0.0; MOST_LANES];
                    numbers[..count].copy_from_slice(&rows[start..start + count]);
                    T::read(token, &numbers)
                };
                k += 1;
            }
            let batch = &factors[node / T::COUNT];
            let mut own = [zero; FACTORS];
            let mut k = 0;
            while k < FACTORS {
                own[k] = T::read(token, &batch[k]);
                k += 1;
            }
            let results = quantities(values, own);
            let mut k = 0;
            while k < WRITTEN.len() {
                let start = WRITTEN[k] * nodes + node;
                if count == T::COUNT {
                    results[k].write_some(&mut rows[start..start + T::COUNT]);
                } else {
                    let mut numbers = [0.0; MOST_LANES];
                    results[k].write(&mut numbers);
                    rows[start..start + count].copy_from_slice(&numbers[..count]);
                }
                k += 1;
            }
            node += T::COUNT;
        }
    }
}

/// Wall tension [N], largest von Mises stress [Pa] and declination [deg].
///
/// Source: docs/theory/results.md, eqs. (1) to (5) and (8).
#[inline(always)]
fn quantities<T: Lane>(values: [T; READ.len()], factors: [T; FACTORS]) -> [T; 3] {
    let [z, tension, bend, torque, x, y, up] = values;
    let [
        wall,
        mean,
        per_area,
        swing,
        swing_in,
        bend_out,
        bend_in,
        turn,
        turn_in,
    ] = factors;
    let zero = z.same(0.0);
    let depth = T::select(z.less(zero), -z, zero);
    let wall_tension = wall.mul_add(depth, tension);
    // A formulation without torsion has no stress by it; its torque is no number.
    let torque = T::select(torque.abs().less(zero + f64::INFINITY), torque, zero);
    let axial = wall_tension * per_area;
    let mean = mean * depth;
    let side = |swing: T, bend_by: T, turn: T| (swing * depth, bend * bend_by, torque * turn);
    let (outer, inner) = (
        side(swing, bend_out, turn),
        side(swing_in, bend_in, turn_in),
    );
    let mut largest = equivalent(axial, mean, outer);
    let within = equivalent(axial, mean, inner);
    largest = T::select(largest.less(within), within, largest);
    let declination = atan2(x.mul_add(x, y * y).sqrt(), -up) * (180.0 / std::f64::consts::PI);
    [wall_tension, largest.sqrt(), declination]
}

/// Square of the von Mises stress at a radius, on the side of bending where it is larger.
#[inline(always)]
fn equivalent<T: Lane>(axial: T, mean: T, (swing, bend, shear): (T, T, T)) -> T {
    let (radial, hoop) = (mean - swing, mean + swing);
    let mut squares = [axial; 2];
    let mut k = 0;
    while k < 2 {
        let axial = if k == 0 { axial + bend } else { axial - bend };
        let (a, b, c) = (axial - hoop, hoop - radial, radial - axial);
        let sum = a.mul_add(a, b.mul_add(b, c * c));
        squares[k] = sum.mul_add(sum.same(0.5), shear * shear * 3.0);
        k += 1;
    }
    T::select(squares[0].less(squares[1]), squares[1], squares[0])
}
