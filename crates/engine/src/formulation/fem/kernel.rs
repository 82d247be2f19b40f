//! What both beam elements offer, so that everything around them is written once.

use std::fmt::Debug;

use catenix_numerics::Vector3;
use catenix_numerics::lanes::{Lane, Row, Vec3};

use super::element::corotational::{Corotational, CorotationalState};
use super::element::ends::{ElementForces, ElementTangent, End, Prediction};
use super::element::exact::{Exact, ExactState};
use super::element::lanes::corotational::CorotationalLanes;
use super::element::lanes::{Assembled, Ends, Weights};
use super::element::section::ElementSection;

/// A beam element between two ends.
pub(super) trait Kernel: Debug + Clone + Send + Sync + 'static {
    /// The element at one configuration.
    type State: Debug + Clone + Copy + Send;

    /// Elements that are computed side by side.
    type Lanes: Lanes;

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

    /// Whether the element is of the kind that can be computed beside others.
    fn fits_in_lanes(&self) -> bool;

    /// Elements of that kind side by side; `None` where there is no such kernel.
    fn side_by_side(elements: &[&Self]) -> Option<Self::Lanes>;
}

/// Beam elements side by side, one per lane.
pub(super) trait Lanes: Debug + Clone + Send + 'static {
    /// Adds their forces and those of a vertical load per length [N/m], and with `weights` the
    /// derivatives; see [`CorotationalLanes::add`].
    fn add<T: Lane>(
        &mut self,
        token: T::Token,
        ends: &[Ends<T>; 2],
        load: T,
        predicts: bool,
        weights: Option<&Weights<T>>,
        out: &mut Assembled<T>,
    );

    /// Keeps the deformation after a small move of both ends: translations and rotations.
    fn predict<T: Lane>(&mut self, token: T::Token, moves: [[Vec3<T>; 2]; 2]);

    /// Elastic energy [J] and power of the damping [W] at the last evaluation, one row each.
    fn energy(&self) -> &[Row; 2];
}

impl Lanes for CorotationalLanes {
    #[inline(always)]
    fn add<T: Lane>(
        &mut self,
        token: T::Token,
        ends: &[Ends<T>; 2],
        load: T,
        predicts: bool,
        weights: Option<&Weights<T>>,
        out: &mut Assembled<T>,
    ) {
        self.add(token, ends, load, predicts, weights, out);
    }

    #[inline(always)]
    fn predict<T: Lane>(&mut self, token: T::Token, moves: [[Vec3<T>; 2]; 2]) {
        self.predict(token, moves);
    }

    fn energy(&self) -> &[Row; 2] {
        self.energy()
    }
}

/// No elements: what the geometrically exact ones are computed with side by side.
#[derive(Debug, Clone, Copy)]
pub(super) enum OneByOne {}

impl Lanes for OneByOne {
    #[inline(always)]
    fn add<T: Lane>(
        &mut self,
        _: T::Token,
        _: &[Ends<T>; 2],
        _: T,
        _: bool,
        _: Option<&Weights<T>>,
        _: &mut Assembled<T>,
    ) {
        match *self {}
    }

    #[inline(always)]
    fn predict<T: Lane>(&mut self, _: T::Token, _: [[Vec3<T>; 2]; 2]) {
        match *self {}
    }

    fn energy(&self) -> &[Row; 2] {
        match *self {}
    }
}

macro_rules! kernel {
    ($element:ty, $state:ty, $lanes:ty, $fits:expr, $many:expr) => {
        impl Kernel for $element {
            type State = $state;
            type Lanes = $lanes;

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

            fn fits_in_lanes(&self) -> bool {
                $fits(self)
            }

            fn side_by_side(elements: &[&Self]) -> Option<$lanes> {
                $many(elements)
            }
        }
    };
}

kernel!(
    Corotational,
    CorotationalState,
    CorotationalLanes,
    Corotational::is_linear,
    |elements: &[&Corotational]| Some(CorotationalLanes::new(elements))
);
kernel!(
    Exact,
    ExactState,
    OneByOne,
    |_: &Exact| false,
    |_: &[&Exact]| None
);
