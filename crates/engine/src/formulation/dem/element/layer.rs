//! Connectors beside which a line bends within a layer that is shorter than an element.
//!
//! Source: docs/theory/dem.md, eqs. (40) to (45).

use super::stiffness::{ConnectorStiffness, HalfElement};

impl ConnectorStiffness {
    /// The connector of a clamp, beside a line under this tension [N].
    ///
    /// Source: docs/theory/dem.md, eqs. (43) and (44).
    pub fn with_layer_at_clamp(mut self, element: HalfElement<'_>, tension: f64) -> Self {
        if let Some(ratio) = self.layer_ratio(&element, tension) {
            let (shift, stiffness) = clamp(ratio);
            self.shift *= shift;
            self.bending *= stiffness;
        }
        self
    }

    /// The connector between two elements at a place where a lump pulls at the line.
    ///
    /// Source: docs/theory/dem.md, eq. (45).
    pub fn with_layers_at_lump(mut self, sides: [HalfElement<'_>; 2], tension: f64) -> Self {
        let ratios = [
            self.layer_ratio(&sides[0], tension),
            self.layer_ratio(&sides[1], tension),
        ];
        if let [Some(first), Some(second)] = ratios {
            let half =
                |side: &HalfElement<'_>| 0.5 * side.length / side.line_type.bending_stiffness[0];
            let compliance = half(&sides[0]) * lump(first) + half(&sides[1]) * lump(second);
            self.bending = 1.0 / compliance;
        }
        self
    }

    /// Length of an element over that of the layer; `None` where there is none, or where the section
    /// is not the same in all directions.
    ///
    /// Source: docs/theory/dem.md, eq. (40).
    fn layer_ratio(&self, element: &HalfElement<'_>, tension: f64) -> Option<f64> {
        let [y, z] = element.line_type.bending_stiffness;
        let plain = self.general.is_none() && y == z && y > 0.0;
        (plain && tension > 0.0).then(|| element.length * (tension / y).sqrt())
    }
}

/// Factors on shift and bending stiffness of the connector at a clamp.
fn clamp(ratio: f64) -> (f64, f64) {
    let factor = 1.0 / (1.0 + ratio * ratio);
    let shift = factor / 6.0;
    let (half, root) = halves(ratio);
    // A / (1 - A), and 1 - q over the ratio, times it.
    let stiffness = (1.0 - shift * ratio) * (1.0 / (root + half) + ratio * (1.0 - shift))
        / (1.0 + half / (root + 1.0));
    (factor, stiffness.max(1.0))
}

/// Factor on the compliance of the half element beside a lump.
fn lump(ratio: f64) -> f64 {
    let (half, root) = halves(ratio);
    1.0 - half / (root + 1.0)
}

/// Hyperbolic sine and cosine of mu / 2.
///
/// Source: docs/theory/dem.md, eq. (42).
fn halves(ratio: f64) -> (f64, f64) {
    let half = 0.5 * ratio;
    (half, (1.0 + half * half).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A taut chain of elements whose first turns about a spring at `shift` from the clamp, and how
    /// far from there the line meets the clamp's direction that it has far away, over the length
    /// of the layer. Element length 1, EI = 1.
    fn hinge_place(ratio: f64, shift: f64, spring: f64) -> f64 {
        let tension = ratio * ratio;
        let n = 60;
        // Directions of the elements under a unit deflection of the far end's direction: a
        // tridiagonal system, solved by elimination from the far end, where the direction is 1.
        let (mut gain, mut offset) = (0.0, 1.0);
        for _ in 1..n {
            // (phi_next - 2 phi + phi_before) + tension (1 - phi) = 0, phi_next = gain phi + offset.
            let diagonal = 2.0 + tension - gain;
            (gain, offset) = (1.0 / diagonal, (tension + offset) / diagonal);
        }
        // (phi_1 - phi_0) + tension (1 - shift) (1 - phi_0) = spring phi_0.
        let lever = tension * (1.0 - shift);
        let first = (offset + lever) / (1.0 - gain + lever + spring);
        let (mut place, mut direction) = ((1.0 - shift) * first, first);
        for _ in 1..n {
            direction = gain * direction + offset;
            place += direction;
            // The recursion holds for all elements once the far end is far.
        }
        (n as f64 - place) * ratio
    }

    #[test]
    fn beyond_a_clamp_the_line_is_where_that_of_a_beam_is() {
        for ratio in [0.8f64, 1.0, 3.0, 10.0, 40.0] {
            let (shift, stiffness) = clamp(ratio);
            let place = hinge_place(ratio, shift / 6.0, 2.0 * stiffness);
            // Round-off of a sum of sixty.
            assert!((place - 1.0).abs() < 1e-9, "{ratio}: {place}");
        }
        // Without a layer the connector of dem.md, eq. (17), stays; there the place is right to
        // second order in the ratio.
        let (shift, stiffness) = clamp(0.05);
        assert!(stiffness == 1.0 && (shift - 1.0).abs() < 3e-3);
        // A tension that is nothing but round-off does nothing.
        for ratio in [0.0, 1e-300, 1e-12, 1e-7] {
            assert_eq!(clamp(ratio).1, 1.0, "{ratio}");
        }
    }

    #[test]
    fn beside_a_lump_the_line_is_where_that_of_a_beam_is() {
        for ratio in [0.5f64, 1.0, 3.0, 10.0, 40.0] {
            // By symmetry one side turns about half of the compliance.
            let place = hinge_place(ratio, 0.0, 2.0 / lump(ratio));
            assert!((place - 1.0).abs() < 1e-9, "{ratio}: {place}");
        }
        // Short elements have the compliance of dem.md, eq. (13).
        assert!((lump(1e-3) - 1.0).abs() < 1e-3);
    }
}
