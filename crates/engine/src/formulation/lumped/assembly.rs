//! The matrix of one line: a band of 3 x 3 matrices between nodes, and its way into blocks of two.
//!
//! Source: docs/theory/lumped.md, "Two points in a block".

use catenix_numerics::{BlockMatrix, Matrix3};

use super::LumpedLine;

/// Derivatives of the forces at the nodes of a line by their positions, integrator's weights
/// included. The second neighbours are coupled by bending alone, which is symmetric.
#[derive(Debug, Clone, Default)]
pub(super) struct Band {
    /// By the own node (n_nodes).
    pub own: Vec<Matrix3>,
    /// Of node k by node k + 1 (n_nodes).
    pub next: Vec<Matrix3>,
    /// Of node k + 1 by node k (n_nodes).
    pub previous: Vec<Matrix3>,
    /// Of node k by node k + 2 (n_nodes).
    second: Vec<Matrix3>,
    /// Of the outermost springs by the rate of their vector (2).
    pub end_damping: [Matrix3; 2],
    /// Of the loads at the ends by velocity and acceleration (2).
    pub end_velocity: [Matrix3; 2],
    pub end_acceleration: [Matrix3; 2],
}

impl Band {
    /// Room for a line of so many nodes.
    pub fn with_nodes(nodes: usize) -> Band {
        let zeros = vec![Matrix3::zeros(); nodes];
        Band {
            own: zeros.clone(),
            next: zeros.clone(),
            previous: zeros.clone(),
            second: zeros,
            ..Band::default()
        }
    }

    /// Empties the room of the first nodes.
    pub fn clear(&mut self, nodes: usize) {
        for list in [
            &mut self.own,
            &mut self.next,
            &mut self.previous,
            &mut self.second,
        ] {
            list[..nodes].fill(Matrix3::zeros());
        }
    }

    /// Adds what depends on the vector of an element.
    #[inline]
    pub fn add_element(&mut self, element: usize, tangent: &Matrix3) {
        self.own[element] += tangent;
        self.own[element + 1] += tangent;
        self.next[element] -= tangent;
        self.previous[element] -= tangent;
    }

    /// Adds bending at a node: second derivatives by the vectors before and after it.
    #[inline]
    pub fn add_bend(&mut self, node: usize, [before, mixed, after]: &[Matrix3; 3]) {
        let turned = mixed.transpose();
        self.own[node - 1] += before;
        self.own[node] += before + after - mixed - turned;
        self.own[node + 1] += after;
        self.next[node - 1] += mixed - before;
        self.previous[node - 1] += turned - before;
        self.next[node] += mixed - after;
        self.previous[node] += turned - after;
        self.second[node - 1] -= mixed;
    }

    /// Adds the loads of a node of a line with `last` elements: by its motion, and by the chord
    /// from the node before to the node after.
    #[inline]
    pub fn add_node(&mut self, node: usize, last: usize, own: &Matrix3, chord: &Matrix3) {
        self.own[node] += own;
        if node == 0 {
            self.own[0] -= chord;
        } else {
            self.previous_of(node, chord, -1.0);
        }
        if node == last {
            self.own[node] += chord;
        } else {
            self.next[node] += chord;
        }
    }

    /// Derivative of a node's force by the node before it.
    #[inline]
    fn previous_of(&mut self, node: usize, value: &Matrix3, sign: f64) {
        self.previous[node - 1] += value * sign;
    }

    /// Derivative of the force at node `a` by the position of node `b`, at most two apart.
    pub fn between(&self, a: usize, b: usize) -> Matrix3 {
        match b as isize - a as isize {
            0 => self.own[a],
            1 => self.next[a],
            -1 => self.previous[b],
            2 => self.second[a],
            _ => self.second[b].transpose(),
        }
    }

    /// Adds the points' part to the matrix; idle points get a stiffness of their own.
    pub fn scatter(&self, line: &LumpedLine, idle: f64, matrix: &mut BlockMatrix) {
        let points = line.arrangement.points.clone();
        for node in points.clone() {
            let Some((block, half)) = line.slot(node) else {
                continue;
            };
            matrix.diagonal[block].add_quadrant(half, half, &self.own[node]);
            if node + 1 < points.end {
                let (next, previous) = (&self.next[node], &self.previous[node]);
                if half == 0 {
                    matrix.diagonal[block].add_quadrant(0, 1, next);
                    matrix.diagonal[block].add_quadrant(1, 0, previous);
                } else {
                    matrix.upper[block].add_quadrant(1, 0, next);
                    matrix.lower[block].add_quadrant(0, 1, previous);
                }
            }
            if node + 2 < points.end {
                let second = &self.second[node];
                matrix.upper[block].add_quadrant(half, half, second);
                matrix.lower[block].add_quadrant(half, half, &second.transpose());
            }
        }
        let own = Matrix3::identity() * idle;
        for slot in line.arrangement.idle() {
            let block = line.first_block + slot.block;
            matrix.diagonal[block].add_quadrant(slot.half, slot.half, &own);
        }
    }
}
