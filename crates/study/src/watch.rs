//! What an adapter sees of a case while it is computed, and its way to stop it.

/// Looks on while a case is computed.
///
/// The methods are called now and then, some ten times a second at most, and do not disturb the
/// results.
pub trait Watch {
    /// The static solution is at an iteration, with this largest residual force [N].
    fn statics(&self, iteration: usize, residual_n: f64);
    /// So many natural modes were found.
    fn modes(&self, found: usize);
    /// A trial run towards a wanted accuracy begins: its number and its elements.
    fn trial(&self, number: usize, elements: usize);
    /// The motion is at a time [s] of its duration [s].
    fn motion(&self, time_s: f64, duration_s: f64);
    /// Whether the computation should stop at the next step; asked at every step.
    fn stop(&self) -> bool;
}

/// Nobody looks on.
impl Watch for () {
    fn statics(&self, _iteration: usize, _residual_n: f64) {}

    fn modes(&self, _found: usize) {}

    fn trial(&self, _number: usize, _elements: usize) {}

    fn motion(&self, _time_s: f64, _duration_s: f64) {}

    fn stop(&self) -> bool {
        false
    }
}
