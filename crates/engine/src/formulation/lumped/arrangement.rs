//! Which nodes of a line are points of the state, and in which block each sits.
//!
//! Two points share a block. Bending couples a point with the second next, so that a line is block
//! tridiagonal; where it ends on a body, the body may be coupled to one block only.
//!
//! Source: docs/theory/lumped.md, "Two points in a block".

use std::ops::Range;

use catenix_model::{EndConnection, Joint, Line, LineEnd, SupportRef};

/// A point's place in the state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Slot {
    /// Block, counted from the line's first.
    pub block: usize,
    /// First (0) or second (1) point of the block.
    pub half: usize,
}

/// The points of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Arrangement {
    /// Nodes that are points of the state; the others sit on their supports.
    pub points: Range<usize>,
    /// Whether the first half of the first block is idle.
    idle_first: bool,
    /// Ends that are points, held to their supports by stiff springs.
    pub tied: [bool; 2],
}

/// What an end of a line means for the arrangement.
#[derive(Debug, Clone, Copy)]
struct EndKind {
    free: bool,
    body: bool,
    /// Whether the support holds the direction of the line.
    guided: bool,
    slides: bool,
}

impl EndKind {
    fn of(end: &LineEnd) -> EndKind {
        let LineEnd::Connected(EndConnection {
            to,
            joint,
            slides_along,
            ..
        }) = end
        else {
            return EndKind {
                free: true,
                body: false,
                guided: false,
                slides: false,
            };
        };
        EndKind {
            free: false,
            body: matches!(to, SupportRef::Body(_)),
            guided: match joint {
                Joint::Fixed | Joint::Hinge { .. } => true,
                Joint::Ball {
                    rotational_stiffness,
                } => *rotational_stiffness > 0.0,
                Joint::Universal { .. } => false,
            },
            slides: slides_along.is_some(),
        }
    }

    /// How many points the body at this end is coupled to.
    fn reach(&self, tied: bool, bends: bool) -> usize {
        match (self.body, tied) {
            (false, _) => 0,
            (true, false) => 1 + usize::from(bends),
            (true, true) => 1 + usize::from(self.guided),
        }
    }
}

impl Arrangement {
    /// For a line of `elements` elements, that has bending stiffness or not.
    pub fn new(line: &Line, elements: usize, bends: bool) -> Option<Arrangement> {
        let ends = [EndKind::of(&line.ends[0]), EndKind::of(&line.ends[1])];
        let mut tied = ends.map(|end| end.slides);
        if ends[0].body && ends[1].body {
            // Two bodies must not be coupled to each other: a point between them keeps them apart.
            match elements {
                1 => tied = [true, true],
                2 if tied == [false, false] => tied[1] = true,
                _ => {}
            }
        }
        let points = |tied: [bool; 2]| {
            let held = |end: usize| usize::from(!ends[end].free && !tied[end]);
            held(0)..(elements + 1 - held(1)).max(held(0))
        };
        let reach = |end: usize| ends[end].reach(tied[end], bends);
        let mut idle_first = false;
        if points(tied).len() % 2 == 1 && reach(1) > 1 {
            if reach(0) <= 1 {
                idle_first = true;
            } else {
                // No end can do with half a block: one more point makes the number even.
                let end = [1, 0].into_iter().find(|&end| !tied[end])?;
                tied[end] = true;
            }
        }
        Some(Arrangement {
            points: points(tied),
            idle_first,
            tied,
        })
    }

    /// Number of blocks; at least one.
    pub fn block_count(&self) -> usize {
        let slots = self.points.len() + usize::from(self.idle_first);
        slots.div_ceil(2).max(1)
    }

    /// Where a node is; `None` when it sits on its support.
    #[inline]
    pub fn slot(&self, node: usize) -> Option<Slot> {
        self.points.contains(&node).then(|| {
            let slot = node - self.points.start + usize::from(self.idle_first);
            Slot {
                block: slot / 2,
                half: slot % 2,
            }
        })
    }

    /// The slots that no node has.
    pub fn idle(&self) -> impl Iterator<Item = Slot> {
        let first = usize::from(self.idle_first);
        let used = first..first + self.points.len();
        let slots = (0..2 * self.block_count()).filter(move |slot| !used.contains(slot));
        slots.map(|slot| Slot {
            block: slot / 2,
            half: slot % 2,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(to: Option<SupportRef>, joint: Joint, slides: bool) -> LineEnd {
        let Some(to) = to else { return LineEnd::Free };
        LineEnd::Connected(EndConnection {
            to,
            point_local: [0.0; 3],
            direction_local: [0.0, 0.0, -1.0],
            axis_local: [1.0, 0.0, 0.0],
            axis_given: false,
            joint,
            slides_along: slides.then_some([1.0, 0.0, 0.0]),
        })
    }

    /// Every topology that a line can have: the rules that the block solver needs.
    #[test]
    fn a_body_meets_one_block_and_bodies_never_meet() {
        let ball = Joint::Ball {
            rotational_stiffness: 0.0,
        };
        let supports = [None, Some(SupportRef::Vessel(0)), Some(SupportRef::Body(0))];
        let kinds: Vec<LineEnd> = supports
            .into_iter()
            .flat_map(|to| {
                [(ball, false), (Joint::Fixed, false), (ball, true)].map(|(j, s)| (to, j, s))
            })
            .map(|(to, joint, slides)| end(to, joint, slides))
            .collect();
        for a in &kinds {
            for b in &kinds {
                for elements in 1..9 {
                    for bends in [false, true] {
                        let line = Line {
                            name: String::new(),
                            sections: Vec::new(),
                            attachments: Vec::new(),
                            ends: [a.clone(), b.clone()],
                            start_shape: Vec::new(),
                        };
                        let own = Arrangement::new(&line, elements, bends).unwrap();
                        check(&own, &line, elements, bends);
                    }
                }
            }
        }
    }

    fn check(own: &Arrangement, line: &Line, elements: usize, bends: bool) {
        let blocks = own.block_count();
        let used = own.points.len() + own.idle().count();
        assert_eq!(used, 2 * blocks);
        let kinds = [0, 1].map(|end| EndKind::of(&line.ends[end]));
        for end in 0..2 {
            let kind = kinds[end];
            let reach = kind.reach(own.tied[end], bends);
            // Nodes that are coupled to the support, from the end on.
            let node = |step: usize| if end == 0 { step } else { elements - step };
            let first = usize::from(!own.tied[end]);
            let met = (first..first + reach).take_while(|&step| step <= elements);
            for step in met {
                match own.slot(node(step)) {
                    Some(slot) => {
                        let wanted = if end == 0 { 0 } else { blocks - 1 };
                        assert_eq!(slot.block, wanted, "{own:?} {elements} {bends}");
                    }
                    None => assert!(!kinds[1 - end].body, "{own:?} {elements} {bends}"),
                }
            }
        }
        // Neighbours and second neighbours are in the same block or in the next.
        for node in own.points.clone() {
            for next in [node + 1, node + 2] {
                if let (Some(a), Some(b)) = (own.slot(node), own.slot(next)) {
                    assert!(b.block - a.block <= 1);
                }
            }
        }
    }
}
