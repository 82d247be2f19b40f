//! What the recorder needs to see of a solver.

use catenix_model::{Channel, ChannelTarget};

/// One accepted state of a simulation. The adapters implement it on the engine's view of a step, so
/// that results and engine do not know each other.
pub trait Sample {
    /// Simulated time [s].
    fn time(&self) -> f64;
    /// Value of a channel, in its unit.
    fn channel(&self, target: ChannelTarget) -> f64;
    /// Values of several channels (n_channels).
    fn channels(&self, channels: &[Channel], out: &mut [f64]) {
        for (value, channel) in out.iter_mut().zip(channels) {
            *value = self.channel(channel.target);
        }
    }
    /// Every quantity along a line: (quantities x nodes), in the order of
    /// [`catenix_model::LineQuantity::ALL`] and from end A to end B.
    fn line_quantities(&self, line: usize, out: &mut [f64]);
}
