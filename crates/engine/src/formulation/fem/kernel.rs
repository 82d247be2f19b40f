//! What both beam elements offer, so that everything around them is written once.

use std::fmt::Debug;

use catenix_numerics::Vector3;

use super::element::corotational::{Corotational, CorotationalState};
use super::element::ends::{ElementForces, ElementTangent, End, Prediction};
use super::element::exact::{Exact, ExactState};
use super::element::section::ElementSection;

/// A beam element between two ends.
pub(super) trait Kernel: Debug + Clone + Send + Sync + 'static {
    /// The element at one configuration.
    type State: Debug + Clone + Copy + Send;

    fn new(section: ElementSection) -> Self;

    fn section(&self) -> &ElementSection;

    /// Largest stiffness against a displacement, times the length [N].
    fn stiffest(&self) -> f64;

    fn state(&self, ends: &[End; 2]) -> Self::State;

    fn forces(&self, state: &Self::State) -> ElementForces;

    fn tangent(&self, state: &Self::State, prediction: Option<&Prediction>) -> ElementTangent;

    fn predicted(&self, state: &Self::State, moves: &[(Vector3, Vector3); 2]) -> Prediction;

    fn energy(&self, state: &Self::State) -> f64;

    fn damping_power(state: &Self::State) -> f64;
}

macro_rules! kernel {
    ($element:ty, $state:ty) => {
        impl Kernel for $element {
            type State = $state;

            fn new(section: ElementSection) -> Self {
                <$element>::new(section)
            }

            fn section(&self) -> &ElementSection {
                self.section()
            }

            fn stiffest(&self) -> f64 {
                self.stiffest()
            }

            #[inline]
            fn state(&self, ends: &[End; 2]) -> Self::State {
                <$state>::new(self, ends)
            }

            #[inline]
            fn forces(&self, state: &Self::State) -> ElementForces {
                state.forces(self)
            }

            #[inline]
            fn tangent(
                &self,
                state: &Self::State,
                prediction: Option<&Prediction>,
            ) -> ElementTangent {
                state.tangent(self, prediction)
            }

            #[inline]
            fn predicted(
                &self,
                state: &Self::State,
                moves: &[(Vector3, Vector3); 2],
            ) -> Prediction {
                state.predicted(self, moves)
            }

            fn energy(&self, state: &Self::State) -> f64 {
                state.energy(self)
            }

            fn damping_power(state: &Self::State) -> f64 {
                state.damping_power()
            }
        }
    };
}

kernel!(Corotational, CorotationalState);
kernel!(Exact, ExactState);
