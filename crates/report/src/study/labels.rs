//! Labels of a drawing: placed so that none covers another, and led to what they name.

use crate::figure::drawing::{Anchor, GREY, INK, Mark, PAPER, Stroke, Text};
use crate::figure::font::text_width;

/// Size of the texts [pixels].
pub(super) const SIZE: f64 = 12.5;
/// Height of a row of text [pixels].
pub(super) const ROW: f64 = 17.0;
/// Between a text and the line that leads to it [pixels].
const GAP: f64 = 5.0;

/// A text and the point that it is about.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    pub(super) text: String,
    pub(super) at: (f64, f64),
}

/// Labels in a column left or right of the drawing, which fills `top` to `bottom`.
pub(super) fn column(
    mut labels: Vec<Label>,
    x: f64,
    is_left: bool,
    (top, bottom): (f64, f64),
) -> Vec<Mark> {
    labels.sort_by(|a, b| a.at.1.total_cmp(&b.at.1));
    let wanted: Vec<f64> = labels.iter().map(|label| label.at.1).collect();
    let heights = spread(&wanted, ROW, (top + 0.5 * ROW, bottom - 0.5 * ROW));
    let side = if is_left { -1.0 } else { 1.0 };
    let mut marks = Vec::new();
    for (label, y) in labels.into_iter().zip(heights) {
        // Out of the drawing first, then to the height of the text.
        let elbow = (x - side * 14.0, y);
        marks.push(leader(vec![label.at, elbow, (x, y)]));
        let anchor = if is_left { Anchor::End } else { Anchor::Start };
        marks.push(text(label.text, (x + side * GAP, y + 0.36 * SIZE), anchor));
    }
    marks
}

/// Height of [`rows`] above their bottom.
pub(super) fn rows_height(labels: usize) -> f64 {
    labels as f64 * ROW
}

/// Labels in rows above the drawing; `bottom` is below the lowest row.
pub(super) fn rows(mut labels: Vec<Label>, (left, right): (f64, f64), bottom: f64) -> Vec<Mark> {
    labels.sort_by(|a, b| a.at.0.total_cmp(&b.at.0));
    let width = |label: &Label| text_width(&label.text, SIZE, false);
    // Texts that have room to the right of their line stand there, the leftmost highest, so that the
    // lines of the others pass them by; the last ones stand to the left of theirs.
    let fits = |label: &Label| label.at.0 + GAP + width(label) <= right;
    let (to_right, to_left): (Vec<Label>, Vec<Label>) = labels.into_iter().partition(fits);
    let order = to_left
        .into_iter()
        .map(|label| (label, true))
        .collect::<Vec<_>>();
    let order = to_right
        .into_iter()
        .rev()
        .map(|label| (label, false))
        .chain(order);
    let mut lines = Vec::new();
    let mut texts = Vec::new();
    for (row, (label, is_left)) in order.enumerate() {
        let y = bottom - (row as f64 + 0.5) * ROW;
        let (x, width) = (label.at.0, width(&label));
        lines.push(leader(vec![label.at, (x, y)]));
        let start = if is_left {
            (x - GAP - width).max(left)
        } else {
            x + GAP
        };
        texts.push(ground(start - 2.0, y, width + 4.0));
        texts.push(text(label.text, (start, y + 0.36 * SIZE), Anchor::Start));
    }
    lines.extend(texts);
    lines
}

/// Heights near the wanted ones (sorted), at least `gap` apart, within the limits where they fit.
fn spread(wanted: &[f64], gap: f64, (low, high): (f64, f64)) -> Vec<f64> {
    // Groups of labels that touch: their middle is where its labels are wanted on average.
    let mut groups: Vec<(f64, usize)> = Vec::new();
    let half = |count: usize| 0.5 * gap * (count as f64 - 1.0);
    let clamped = |middle: f64, count: usize| {
        let room = (low + half(count), high - half(count));
        match room.0 <= room.1 {
            true => middle.clamp(room.0, room.1),
            false => 0.5 * (low + high),
        }
    };
    for height in wanted {
        groups.push((clamped(*height, 1), 1));
        while let [.., (above, m), (below, n)] = groups[..] {
            if below - above >= half(m) + half(n) + gap - 1e-9 {
                break;
            }
            let middle = (above * m as f64 + below * n as f64) / (m + n) as f64;
            groups.truncate(groups.len() - 2);
            groups.push((clamped(middle, m + n), m + n));
        }
    }
    let heights = groups.into_iter().flat_map(|(middle, count)| {
        let first = middle - half(count);
        (0..count).map(move |index| first + index as f64 * gap)
    });
    heights.collect()
}

pub(super) fn text(content: String, at: (f64, f64), anchor: Anchor) -> Mark {
    Mark::Text(Text {
        at,
        anchor,
        size: SIZE,
        bold: false,
        colour: INK,
        upwards: false,
        content,
    })
}

fn leader(points: Vec<(f64, f64)>) -> Mark {
    Mark::Path {
        points,
        stroke: Stroke::solid(GREY, 0.7),
    }
}

/// Paper below a text, so that no line crosses it.
pub(super) fn ground(x: f64, y: f64, width: f64) -> Mark {
    let (top, bottom) = (y - 0.5 * ROW + 1.0, y + 0.5 * ROW - 1.0);
    Mark::Shape {
        points: vec![(x, top), (x + width, top), (x + width, bottom), (x, bottom)],
        fill: PAPER,
        stroke: Stroke::solid(PAPER, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_distance_and_stay_near_their_points() {
        let limits = (0.0, 200.0);
        assert_eq!(spread(&[50.0, 150.0], 20.0, limits), [50.0, 150.0]);
        assert_eq!(
            spread(&[100.0, 100.0, 100.0], 20.0, limits),
            [80.0, 100.0, 120.0]
        );
        assert_eq!(spread(&[0.0, 1.0, 199.0], 20.0, limits), [0.0, 20.0, 199.0]);
        let crowded = spread(&[10.0; 40], 20.0, limits);
        assert!(
            crowded
                .windows(2)
                .all(|pair| (pair[1] - pair[0] - 20.0).abs() < 1e-9)
        );
        assert!(spread(&[], 20.0, limits).is_empty());
    }
}
