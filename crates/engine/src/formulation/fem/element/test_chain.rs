//! A chain of elements with a dense solver, for tests of the elements alone.

use catenix_numerics::{Configuration, Matrix3, Vector3, Vector6};
use nalgebra::{DMatrix, DVector};

use super::corotational::{Corotational, CorotationalState};
use super::ends::{ElementForces, ElementTangent, End, Prediction};
use super::exact::{Exact, ExactState};
use super::section::ElementSection;

/// Either element.
#[derive(Clone)]
pub enum Element {
    Corotational(Corotational),
    Exact(Exact),
    /// The exact element on an updated reference: strains count from the last equilibrium, whose
    /// stresses are there from the start.
    Updated(Exact, Stresses),
}

/// Stresses of a geometrically exact element.
#[derive(Debug, Clone, Copy)]
pub struct Stresses {
    /// Tension, and what an S stores (3) [N].
    pub force: Vector3,
    /// Torque and bending moments (3) [N m].
    pub moment: Vector3,
}

impl Stresses {
    /// The state between two ends, with these stresses added to it.
    pub fn on(&self, element: &Exact, ends: &[End; 2]) -> ExactState {
        let mut state = ExactState::new(element, ends);
        state.force += self.force;
        state.moment += self.moment;
        state
    }
}

impl Element {
    pub fn both(section: &ElementSection) -> [Element; 2] {
        [
            Element::Corotational(Corotational::new(section.clone())),
            Element::Exact(Exact::new(section.clone())),
        ]
    }

    fn evaluate(
        &self,
        ends: &[End; 2],
        prediction: Option<&Prediction>,
    ) -> (ElementForces, ElementTangent) {
        match self {
            Element::Corotational(element) => {
                let state = CorotationalState::new(element, ends);
                (state.forces(element), state.tangent(element, prediction))
            }
            Element::Exact(element) => {
                let state = ExactState::new(element, ends);
                (state.forces(element), state.tangent(element, prediction))
            }
            // Predictions know nothing of stresses that were there.
            Element::Updated(element, stresses) => {
                let state = stresses.on(element, ends);
                (state.forces(element), state.tangent(element, None))
            }
        }
    }

    fn predicted(&self, ends: &[End; 2], moves: &[(Vector3, Vector3); 2]) -> Prediction {
        match self {
            Element::Corotational(element) => {
                CorotationalState::new(element, ends).predicted(element, moves)
            }
            Element::Exact(element) | Element::Updated(element, _) => {
                ExactState::new(element, ends).predicted(element, moves)
            }
        }
    }
}

/// A chain from a clamped node to a free one, with a force and a moment on the free one.
pub struct Chain {
    /// One per span.
    pub elements: Vec<Element>,
    /// All nodes; the first is clamped.
    pub nodes: Configuration,
    /// Force on the last node (3) [N].
    pub force: Vector3,
    /// Moment on it, of fixed direction (3) [N m].
    pub moment: Vector3,
}

impl Chain {
    /// Ends of an element.
    pub fn ends(&self, k: usize) -> [End; 2] {
        [k, k + 1].map(|node| End {
            position: self.nodes.position[node],
            rotation: self.nodes.rotation[node],
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            angular_acceleration: Vector3::zeros(),
        })
    }

    /// Residual and matrix of all nodes.
    pub fn assemble(&self, predictions: Option<&[Prediction]>) -> (DVector<f64>, DMatrix<f64>) {
        let size = 6 * self.nodes.len();
        let mut residual = DVector::zeros(size);
        let mut matrix = DMatrix::zeros(size, size);
        for k in 0..3 {
            residual[size - 6 + k] -= self.force[k];
            residual[size - 3 + k] -= self.moment[k];
        }
        for (index, element) in self.elements.iter().enumerate() {
            let (forces, tangent) =
                element.evaluate(&self.ends(index), predictions.map(|list| &list[index]));
            // Row and column of (force, moments) and (span, spins), with the sign of each.
            let places = [
                vec![(6 * index, -1.0), (6 * index + 6, 1.0)],
                vec![(6 * index + 3, 1.0)],
                vec![(6 * index + 9, 1.0)],
            ];
            let parts = [forces.force, forces.moment[0], forces.moment[1]];
            for (row, part) in parts.iter().enumerate() {
                for &(at, sign) in &places[row] {
                    for k in 0..3 {
                        residual[at + k] += part[k] * sign;
                    }
                    let blocks: &[Matrix3; 3] = &tangent.configuration[row];
                    for (block, columns) in blocks.iter().zip(&places) {
                        for &(to, other) in columns {
                            for (k, j) in (0..9).map(|n| (n % 3, n / 3)) {
                                matrix[(at + k, to + j)] += block[(k, j)] * sign * other;
                            }
                        }
                    }
                }
            }
        }
        (residual, matrix)
    }

    /// Newton's method, in the mixed form, from the present shape; the number of iterations.
    pub fn solve(&mut self, tolerance: f64) -> usize {
        let mut predictions: Option<Vec<Prediction>> = None;
        for iteration in 0..60 {
            let (residual, matrix) = self.assemble(predictions.as_deref());
            let free = residual.len() - 6;
            let rest = residual.rows(6, free).into_owned();
            if rest.amax() < tolerance {
                return iteration;
            }
            let increment = matrix
                .view((6, 6), (free, free))
                .into_owned()
                .lu()
                .solve(&-rest)
                .expect("a clamped chain has no singular matrix");
            let mut all = vec![Vector6::zeros()];
            all.extend((0..free / 6).map(|k| increment.fixed_rows::<6>(6 * k).into_owned()));
            let moves = |k: usize| {
                let d = &all[k];
                (
                    d.fixed_rows::<3>(0).into_owned(),
                    d.fixed_rows::<3>(3).into_owned(),
                )
            };
            predictions = Some(
                (0..self.elements.len())
                    .map(|k| self.elements[k].predicted(&self.ends(k), &[moves(k), moves(k + 1)]))
                    .collect(),
            );
            self.nodes.retract(&all);
        }
        panic!("no equilibrium in 60 iterations");
    }

    /// Position of the last node.
    pub fn tip(&self) -> Vector3 {
        self.nodes.position[self.nodes.len() - 1]
    }
}

/// A straight chain of like elements along x.
pub fn straight(element: &Element, length: f64, count: usize) -> Chain {
    let at = |k: usize| Vector3::x() * (length * k as f64 / count as f64);
    Chain {
        elements: vec![element.clone(); count],
        nodes: Configuration::of_frames(
            (0..=count).map(at).collect(),
            vec![Matrix3::identity(); count + 1],
        ),
        force: Vector3::zeros(),
        moment: Vector3::zeros(),
    }
}
