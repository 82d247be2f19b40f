//! Element lengths of a section: equal, or graded towards its ends.
//!
//! Source: docs/theory/dem.md, eq. (30).

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::Log;
use crate::file::tables::SectionTable;

/// Most elements of a model.
///
/// A thousand times the largest model that makes sense to integrate; more is a slip of the unit.
pub(super) const MOST_ELEMENTS: usize = 1_000_000;

/// Growth of the element length per metre of line that holds where none is given.
const DEFAULT_GROWTH: f64 = 0.2;

/// Lengths of the elements of a section from end A to end B; `None` after reporting why not.
///
/// `budget` is the number of elements that the model may still have.
pub(super) fn element_lengths(
    section: &SectionTable,
    budget: &mut usize,
    log: &mut Log,
) -> Option<Vec<f64>> {
    let length = section.length.si;
    let graded = [&section.element_length_a, &section.element_length_b];
    match (&section.elements, &section.element_length) {
        (Some(count), None) => {
            if let Some(key) = graded.into_iter().flatten().next() {
                let message = "a section with `elements` has equal elements and cannot be graded";
                let help = "replace `elements` by `element_length`, the length between the ends";
                log.error(Code::ConflictingKeys, &key.span, message, help);
                return None;
            }
            let count = spend(count.value as f64, &count.span, budget, log)?;
            length
                .is_finite()
                .then(|| vec![length / count as f64; count])
        }
        (None, Some(middle)) => {
            if let Some(growth) = &section.growth
                && graded.iter().all(|key| key.is_none())
            {
                let message = "`growth` without `element_length_a` or `element_length_b`";
                let help = "give the element length at the end from which elements grow";
                log.error(Code::ConflictingKeys, &growth.span, message, help);
            }
            for key in graded.into_iter().flatten() {
                if key.si > middle.si {
                    let message = format!(
                        "elements at the end, {} m, are longer than `element_length`, {} m",
                        key.si, middle.si
                    );
                    let help = "elements are graded from short ends to a longer middle";
                    log.error(Code::Value, &key.span, message, help);
                    return None;
                }
            }
            let size = SizeFunction {
                length,
                middle: middle.si,
                ends: graded.map(|key| key.as_ref().map_or(middle.si, |key| key.si)),
                growth: section
                    .growth
                    .as_ref()
                    .map_or(DEFAULT_GROWTH, |growth| growth.si),
            };
            // A value that could not be read is NaN; it is already reported.
            let known = size.length + size.middle + size.growth + size.ends[0] + size.ends[1];
            if known.is_nan() {
                return None;
            }
            size.element_lengths(|count| spend(count, &middle.span, budget, log))
        }
        (Some(count), Some(_)) => {
            let message = "`elements` and `element_length` exclude each other";
            log.error(
                Code::ConflictingKeys,
                &count.span,
                message,
                "keep one of them",
            );
            None
        }
        (None, None) => {
            let message = "the section does not say how long its elements are";
            let help = "write elements = 90, or element_length = \"2 m\"";
            log.error(Code::MissingKey, &section.key_span, message, help);
            None
        }
    }
}

/// Takes `count` elements from the budget.
fn spend(
    count: f64,
    span: &std::ops::Range<usize>,
    budget: &mut usize,
    log: &mut Log,
) -> Option<usize> {
    if count.is_nan() {
        return None;
    }
    if count > *budget as f64 {
        let message = format!("{count} elements are too many: a model has at most {MOST_ELEMENTS}");
        log.error(Code::Value, span, message, "use fewer or longer elements");
        return None;
    }
    let count = count as usize;
    *budget -= count;
    Some(count)
}

/// Element length wanted at each place of a section:
/// h(s) = min(middle, end_a + growth s, end_b + growth (length - s)).
struct SizeFunction {
    length: f64,
    middle: f64,
    ends: [f64; 2],
    growth: f64,
}

impl SizeFunction {
    /// Elements that follow the size function: as many as the integral of ds/h, each taking an
    /// equal share of it.
    fn element_lengths(&self, spend: impl FnOnce(f64) -> Option<usize>) -> Option<Vec<f64>> {
        let pieces = self.pieces();
        let total: f64 = pieces.iter().map(Piece::elements).sum();
        // The small allowance keeps 400 m / 2 m at 200 elements in spite of rounding.
        let count = spend((total - 1e-9).ceil().max(1.0))?;
        if self.ends.iter().all(|end| *end == self.middle) {
            return Some(vec![self.length / count as f64; count]);
        }
        let share = total / count as f64;
        let mut boundaries = Vec::with_capacity(count + 1);
        let (mut piece, mut before) = (0, 0.0);
        for boundary in 0..count {
            let wanted = share * boundary as f64;
            while piece + 1 < pieces.len() && before + pieces[piece].elements() < wanted {
                before += pieces[piece].elements();
                piece += 1;
            }
            boundaries.push(pieces.get(piece)?.place_after(wanted - before));
        }
        boundaries.push(self.length);
        Some(
            boundaries
                .windows(2)
                .map(|pair| pair[1] - pair[0])
                .collect(),
        )
    }

    /// The size function as straight pieces.
    fn pieces(&self) -> Vec<Piece> {
        let Self {
            length,
            middle,
            ends: [at_a, at_b],
            growth,
        } = *self;
        // Where the two ramps meet the plateau, or each other when there is none.
        let crossing = ((at_b - at_a) / growth + length) / 2.0;
        let ramp_a_end = ((middle - at_a) / growth).min(crossing).clamp(0.0, length);
        let ramp_b_start = (length - (middle - at_b) / growth)
            .max(crossing)
            .clamp(0.0, length);
        [
            (0.0, ramp_a_end, growth),
            (ramp_a_end, ramp_b_start, 0.0),
            (ramp_b_start, length, -growth),
        ]
        .into_iter()
        .filter(|(start, end, _)| end > start)
        .map(|(start, end, slope)| Piece {
            start,
            end,
            slope,
            size: self.size(start),
        })
        .collect()
    }

    fn size(&self, s: f64) -> f64 {
        let from_a = self.ends[0] + self.growth * s;
        let from_b = self.ends[1] + self.growth * (self.length - s);
        self.middle.min(from_a).min(from_b)
    }
}

/// A stretch over which the element length changes linearly from `size` at `start`.
struct Piece {
    start: f64,
    end: f64,
    slope: f64,
    size: f64,
}

impl Piece {
    /// Number of elements in the piece: the integral of ds / h.
    fn elements(&self) -> f64 {
        let length = self.end - self.start;
        if self.slope == 0.0 {
            length / self.size
        } else {
            (self.slope * length / self.size).ln_1p() / self.slope
        }
    }

    /// Where `elements` elements from the start of the piece end.
    fn place_after(&self, elements: f64) -> f64 {
        let length = if self.slope == 0.0 {
            elements * self.size
        } else {
            self.size * (self.slope * elements).exp_m1() / self.slope
        };
        (self.start + length).min(self.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graded(length: f64, middle: f64, ends: [f64; 2], growth: f64) -> Vec<f64> {
        let size = SizeFunction {
            length,
            middle,
            ends,
            growth,
        };
        size.element_lengths(|count| Some(count as usize)).unwrap()
    }

    #[test]
    fn equal_elements_divide_evenly() {
        assert_eq!(graded(400.0, 2.0, [2.0, 2.0], 0.2), vec![2.0; 200]);
        assert_eq!(graded(10.0, 3.0, [3.0, 3.0], 0.2), vec![2.5; 4]);
        assert_eq!(graded(1.0, 30.0, [30.0, 30.0], 0.2), vec![1.0]);
    }

    #[test]
    fn graded_elements_follow_the_size_function() {
        for (length, middle, ends, growth) in [
            (400.0, 4.0, [0.2, 0.2], 0.2),
            (400.0, 4.0, [0.2, 4.0], 0.1),
            (400.0, 4.0, [4.0, 0.5], 0.5),
            (10.0, 4.0, [0.2, 0.5], 0.2),
            (1.0, 4.0, [0.9, 0.1], 0.2),
        ] {
            let size = SizeFunction {
                length,
                middle,
                ends,
                growth,
            };
            let lengths = graded(length, middle, ends, growth);
            let sum: f64 = lengths.iter().sum();
            approx::assert_relative_eq!(sum, length, max_relative = 1e-12);
            let mut start = 0.0;
            for element in lengths {
                let wanted = size.size(start + element / 2.0);
                assert!(
                    element < 1.02 * wanted,
                    "{element} at {start}, wanted {wanted}"
                );
                assert!(
                    element > 0.6 * wanted,
                    "{element} at {start}, wanted {wanted}"
                );
                start += element;
            }
        }
    }
}
