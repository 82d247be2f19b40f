//! Element lengths: even ones, and those that follow what the lines do, short where they bend.
//!
//! Source: docs/theory/accuracy.md, eqs. (1) to (4) and (7).

use catenix_model::{Line, Model};

/// Most growth of the element length per metre of line.
const GROWTH: f64 = 0.25;
/// Fewest elements of a section on the coarsest mesh.
const FEWEST_ELEMENTS: usize = 3;
/// Elements of a section where nothing bends, on the coarsest mesh.
const PLAIN_ELEMENTS: f64 = 4.0;
/// Turning between neighbours that the coarsest mesh aims at [rad].
const COARSEST_TURN: f64 = 0.8;
/// Weight of the shape of the curvature, beside that of the turning.
const CURVATURE_SHAPE: f64 = 0.8;

/// Wanted elements per metre along a line, on the coarsest mesh.
#[derive(Debug, Clone)]
pub(super) struct Density {
    /// Unstretched distance from end A, increasing (n) [m].
    arc_length: Vec<f64>,
    /// Elements per metre there (n) [1/m].
    elements_per_metre: Vec<f64>,
}

impl Density {
    /// The same everywhere: `count` elements over the whole line.
    pub(super) fn uniform(line: &Line, count: f64) -> Density {
        let length = line.length();
        Density {
            arc_length: vec![0.0, length],
            elements_per_metre: vec![count / length; 2],
        }
    }

    /// From the curvature at the nodes of a mesh, one row per snapshot [1/m].
    ///
    /// Source: docs/theory/accuracy.md, eqs. (1) and (2).
    pub(super) fn from_curvature(line: &Line, curvatures: &[Vec<f64>]) -> Density {
        let arc_length = nodes(line);
        let mut density: Vec<f64> = vec![0.0; arc_length.len()];
        let largest = curvatures
            .iter()
            .flatten()
            .copied()
            .filter(|k| k.is_finite())
            .fold(0.0, f64::max);
        for curvature in curvatures {
            for k in 1..arc_length.len() - 1 {
                let before = arc_length[k] - arc_length[k - 1];
                let after = arc_length[k + 1] - arc_length[k];
                let slope_before = (curvature[k] - curvature[k - 1]) / before;
                let slope_after = (curvature[k + 1] - curvature[k]) / after;
                let slope = slope_before.abs().max(slope_after.abs());
                let second = 2.0 * (slope_after - slope_before) / (before + after);
                let turning = (slope + curvature[k].powi(2)).sqrt() / COARSEST_TURN;
                let shape = (second.abs() / largest.max(1e-300)).sqrt() / CURVATURE_SHAPE;
                let wanted = turning.max(shape);
                if wanted.is_finite() {
                    density[k] = density[k].max(wanted);
                }
            }
        }
        // Second differences miss the ends: they have what their neighbours have.
        let last = density.len() - 1;
        if last > 1 {
            density[0] = density[1];
            density[last] = density[last - 1];
        }
        let mut density = Density {
            arc_length,
            elements_per_metre: density,
        };
        density.raise_to_floor(line);
        density.limit_growth();
        density
    }

    /// No section has fewer than a few elements.
    fn raise_to_floor(&mut self, line: &Line) {
        let mut start = 0.0;
        for section in &line.sections {
            let length: f64 = section.element_lengths.iter().sum();
            let end = start + length;
            let slack = 1e-9 * length;
            for (s, density) in self.arc_length.iter().zip(&mut self.elements_per_metre) {
                if (start - slack..=end + slack).contains(s) {
                    *density = density.max(PLAIN_ELEMENTS / length);
                }
            }
            start = end;
        }
    }

    /// Element lengths grow by a quarter of the distance from a shorter one, at most.
    fn limit_growth(&mut self) {
        let last = self.arc_length.len() - 1;
        for k in 1..=last {
            self.limit_one(k, k - 1);
        }
        for k in (0..last).rev() {
            self.limit_one(k, k + 1);
        }
    }

    fn limit_one(&mut self, k: usize, neighbour: usize) {
        let distance = (self.arc_length[k] - self.arc_length[neighbour]).abs();
        let longest = 1.0 / self.elements_per_metre[neighbour] + GROWTH * distance;
        self.elements_per_metre[k] = self.elements_per_metre[k].max(1.0 / longest);
    }

    /// Number of elements from end A up to each of `places`, by increasing place.
    fn count_up_to(&self, place: f64) -> f64 {
        let mut count = 0.0;
        for k in 1..self.arc_length.len() {
            let (a, b) = (self.arc_length[k - 1], self.arc_length[k]);
            if place <= a {
                break;
            }
            let share = ((place - a) / (b - a)).min(1.0);
            let (from, to) = (self.elements_per_metre[k - 1], self.elements_per_metre[k]);
            count += (b - a) * share * (from + 0.5 * share * (to - from));
        }
        count
    }

    /// The place up to which there are `count` elements.
    fn place_of(&self, count: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.arc_length[self.arc_length.len() - 1]);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.count_up_to(middle) < count {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// The line with elements after this density, each split in `split`.
    ///
    /// Source: docs/theory/accuracy.md, eqs. (3) and (4).
    fn mesh(&self, line: &Line, split: usize) -> Line {
        let mut line = line.clone();
        let mut start = 0.0;
        for section in &mut line.sections {
            let end = start + section.element_lengths.iter().sum::<f64>();
            let (first, last) = (self.count_up_to(start), self.count_up_to(end));
            let count = ((last - first).ceil() as usize).max(FEWEST_ELEMENTS) * split;
            let place = |k: usize| match k {
                0 => start,
                k if k == count => end,
                k => self.place_of(first + (last - first) * k as f64 / count as f64),
            };
            section.element_lengths = (0..count).map(|k| place(k + 1) - place(k)).collect();
            start = end;
        }
        line
    }
}

/// The model on a mesh of these densities, each element split in `split`.
pub(super) fn remeshed(model: &Model, densities: &[Density], split: usize) -> Model {
    let mut model = model.clone();
    for (line, density) in model.lines.iter_mut().zip(densities) {
        *line = density.mesh(line, split);
    }
    model
}

/// The line with about `count` elements of equal length between its lumps, each split in `split`.
///
/// There is a node at every lump that is half an element or more from the next.
///
/// Source: docs/theory/accuracy.md, eq. (7).
pub(super) fn evenly(line: &Line, count: f64, split: usize) -> Line {
    let mut line = line.clone();
    let wanted = line.length() / count;
    let lumps = line.attachments.iter().map(|lump| lump.arc_length);
    let lumps: Vec<f64> = lumps.collect();
    let mut start = 0.0;
    for section in &mut line.sections {
        let end = start + section.element_lengths.iter().sum::<f64>();
        let mut places = vec![start];
        for &lump in lumps.iter().filter(|lump| (start..end).contains(*lump)) {
            let before = lump - places[places.len() - 1];
            if before.min(end - lump) >= 0.5 * wanted {
                places.push(lump);
            }
        }
        places.push(end);
        section.element_lengths.clear();
        for pair in places.windows(2) {
            let length = pair[1] - pair[0];
            let count = ((length / wanted).round() as usize).max(1) * split;
            let lengths = std::iter::repeat_n(length / count as f64, count);
            section.element_lengths.extend(lengths);
        }
        start = end;
    }
    line
}

/// Unstretched distance of the nodes from end A (n_elements + 1) [m].
pub(super) fn nodes(line: &Line) -> Vec<f64> {
    let lengths = line.sections.iter().flat_map(|s| &s.element_lengths);
    std::iter::once(0.0)
        .chain(lengths.scan(0.0, |sum, length| {
            *sum += length;
            Some(*sum)
        }))
        .collect()
}
