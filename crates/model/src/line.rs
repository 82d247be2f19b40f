//! Lines: cross sections, sections, attachments and ends.

/// Cross-section properties of a line, per metre of unstretched length.
#[derive(Debug, Clone, PartialEq)]
pub struct LineType {
    /// Name in the model file.
    pub name: String,
    /// Outer (hydrodynamic) diameter: sets buoyancy, drag and added mass [m].
    pub outer_diameter: f64,
    /// Inner diameter, the bore that the content fills [m].
    pub inner_diameter: f64,
    /// Mass with content [kg/m].
    pub mass: f64,
    /// Axial stiffness EA [N]; with an `axial_law`, its slope at no strain, in tension.
    pub axial_stiffness: f64,
    /// Strain [-] and tension [N], both strictly increasing, with (0, 0) among them, (n_points x 2);
    /// `None`: linear.
    pub axial_law: Option<Vec<[f64; 2]>>,
    /// Bending stiffness EI about the section's local y and z (2) [N m2]; 0 is a chain. With a
    /// `bending_law`, its slope at no curvature, twice.
    pub bending_stiffness: [f64; 2],
    /// Curvature [1/m] and moment [N m], the same about all axes, both strictly increasing from
    /// (0, 0) on, (n_points x 2); `None`: linear.
    pub bending_law: Option<Vec<[f64; 2]>>,
    /// Torsional stiffness GJ [N m2].
    pub torsional_stiffness: f64,
    /// Shear stiffness [N] (kappa G A); `None`: rigid in shear (Euler-Bernoulli).
    pub shear_stiffness: Option<f64>,
    /// Second moment of mass about the line's axis [kg m].
    pub polar_inertia: f64,
    /// Second moments of mass of the section about its local y and z (2) [kg m].
    pub rotary_inertia: [f64; 2],
    /// Stiffness-proportional structural damping time: damping = this x stiffness [s].
    pub structural_damping: f64,
    /// Normal drag coefficient, on the outer diameter [-].
    pub normal_drag: f64,
    /// Axial drag coefficient, on pi times the outer diameter [-].
    pub axial_drag: f64,
    /// Normal added-mass coefficient, on the displaced mass [-].
    pub normal_added_mass: f64,
    /// Axial added-mass coefficient, on the displaced mass [-].
    pub axial_added_mass: f64,
    /// Density of the content [kg/m3]; 0 for an empty bore. Already part of `mass`.
    pub content_density: f64,
    /// The stress-carrying wall; `None` when the type gives no geometry of a homogeneous wall, and
    /// then no stress is reported.
    pub wall: Option<PipeWall>,
}

/// A homogeneous round wall, for stresses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PipeWall {
    /// Outer diameter of the load-carrying wall [m].
    pub outer_diameter: f64,
    /// Inner diameter of the load-carrying wall [m].
    pub inner_diameter: f64,
}

/// A stretch of a line with constant properties.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Index into [`crate::Model::line_types`].
    pub line_type: usize,
    /// Unstretched length of each element from end A to end B, (n_elements) [m].
    pub element_lengths: Vec<f64>,
    /// Stress-free shape.
    pub natural: NaturalShape,
}

/// How a section is bent and twisted where no stress acts.
///
/// Going from A to B, the section's axes turn about their own x (along the line), y and z by twist
/// and curvatures per metre. Source: docs/theory/sections.md, eq. (1).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NaturalShape {
    /// Curvature about local y and z (2) [1/m].
    pub curvature: [f64; 2],
    /// Twist [rad/m].
    pub twist: f64,
}

impl NaturalShape {
    /// Straight and without twist.
    pub fn is_straight(&self) -> bool {
        *self == NaturalShape::default()
    }
}

/// A small rigid lump on a line: float, clump weight or pump.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// Name in the model file.
    pub name: String,
    /// Unstretched distance from end A [m].
    pub arc_length: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Displaced volume [m3].
    pub volume: f64,
    /// Drag coefficient times area, the same in all directions [m2].
    pub drag_area: f64,
    /// Added mass, the same in all directions [kg].
    pub added_mass: f64,
}

/// A run of pipe, hose or cable from end A to end B.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Name in the model file.
    pub name: String,
    /// Sections from end A to end B; at least one.
    pub sections: Vec<Section>,
    /// Lumps, by increasing arc length.
    pub attachments: Vec<Attachment>,
    /// End A (`[0]`) and end B (`[1]`).
    pub ends: [LineEnd; 2],
    /// Points of a polyline along which the elements are first laid, end A first, global, at least
    /// two (n x 3) [m]; empty: an arc between the ends.
    pub start_shape: Vec<[f64; 3]>,
}

impl Line {
    /// Moves nodes to the attachments, and those between them along: the number of elements stays.
    ///
    /// In each section an attachment takes the node that is nearest to it, unless that is the
    /// section's end or another attachment has it; then it stays inside an element.
    ///
    /// Source: docs/theory/dem.md, eq. (31).
    pub fn move_nodes_to_attachments(&mut self) {
        let mut start = 0.0;
        for section in &mut self.sections {
            let end = start + section.element_lengths.iter().sum::<f64>();
            let places = self.attachments.iter().map(|lump| lump.arc_length - start);
            move_nodes(&mut section.element_lengths, places);
            start = end;
        }
    }

    /// Unstretched length [m].
    pub fn length(&self) -> f64 {
        self.sections
            .iter()
            .flat_map(|section| &section.element_lengths)
            .sum()
    }

    /// Number of elements over all sections.
    pub fn element_count(&self) -> usize {
        self.sections
            .iter()
            .map(|section| section.element_lengths.len())
            .sum()
    }
}

/// Moves the nodes between elements of these lengths so that one lies at each of `places`, by
/// increasing distance from the first element's start, as far as there are nodes for them.
fn move_nodes(lengths: &mut [f64], places: impl Iterator<Item = f64>) {
    let mut nodes = vec![0.0];
    for length in &*lengths {
        nodes.push(nodes[nodes.len() - 1] + length);
    }
    let last = lengths.len();
    // Nodes that are where they shall be, with the place.
    let mut fixed = vec![(0, 0.0)];
    for place in places.filter(|place| (0.0..nodes[last]).contains(place)) {
        let after = nodes.partition_point(|node| *node < place).max(1);
        let nearest = if place - nodes[after - 1] < nodes[after] - place {
            after - 1
        } else {
            after
        };
        if nearest > fixed[fixed.len() - 1].0 && nearest < last {
            fixed.push((nearest, place));
        }
    }
    fixed.push((last, nodes[last]));
    for pair in fixed.windows(2) {
        let [(first, from), (end, to)] = [pair[0], pair[1]];
        let stretch = (to - from) / (nodes[end] - nodes[first]);
        // A node that already lies there leaves all lengths as they are, to the last bit.
        if (stretch - 1.0).abs() > 1e-12 {
            lengths[first..end]
                .iter_mut()
                .for_each(|length| *length *= stretch);
        }
    }
}

/// What holds an end of a line.
#[derive(Debug, Clone, PartialEq)]
pub enum LineEnd {
    /// Nothing.
    Free,
    /// A vessel, anchor or body, through a joint.
    Connected(EndConnection),
}

/// The connection of a line's end to a vessel or body.
#[derive(Debug, Clone, PartialEq)]
pub struct EndConnection {
    /// What the end is connected to.
    pub to: SupportRef,
    /// Connection point in the local axes of the vessel or body, from its origin (3) [m].
    pub point_local: [f64; 3],
    /// Direction of the line from A to B at the connection, in local axes, unit (3) [-]. Matters
    /// for joints that hold a direction.
    pub direction_local: [f64; 3],
    /// Local y of the line's sections at this end, in local axes, unit, normal to the direction
    /// (3) [-]. At hinges and universal joints it is their axis.
    pub axis_local: [f64; 3],
    /// Whether the user wrote the axis.
    pub axis_given: bool,
    /// The joint.
    pub joint: Joint,
    /// Direction along which the joint's point slides freely, in local axes, unit (3) [-].
    pub slides_along: Option<[f64; 3]>,
}

/// A vessel or a body, by index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SupportRef {
    /// Index into [`crate::Model::vessels`].
    Vessel(usize),
    /// Index into [`crate::Model::bodies`].
    Body(usize),
}

/// Kinematics of a line's end connection. All joints hold the end's position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Joint {
    /// All rotations free, or restrained by a linear spring `rotational_stiffness` [N m/rad] about
    /// the bending axes (a flex joint) when that is not zero.
    Ball {
        /// Bending stiffness of the joint [N m/rad]; 0 for a true ball.
        rotational_stiffness: f64,
    },
    /// Two rotations free, torsion held (Hooke or "cross" joint). The axis fixed to the support is
    /// `axis_local`, in the support's local axes, unit, normal to the line's direction (3).
    Universal {
        /// Axis of the cross on the support's side (3) [-].
        axis_local: [f64; 3],
    },
    /// One rotation free, about `axis_local` (support's local axes, unit, normal to the line's
    /// direction) (3).
    Hinge {
        /// Hinge axis (3) [-].
        axis_local: [f64; 3],
    },
    /// All rotations held.
    Fixed,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(sections: &[&[f64]], attachments: &[f64]) -> Line {
        let section = |lengths: &&[f64]| Section {
            line_type: 0,
            element_lengths: lengths.to_vec(),
            natural: NaturalShape::default(),
        };
        let attachment = |place: &f64| Attachment {
            name: String::new(),
            arc_length: *place,
            mass: 1.0,
            volume: 0.0,
            drag_area: 0.0,
            added_mass: 0.0,
        };
        Line {
            name: String::new(),
            sections: sections.iter().map(section).collect(),
            attachments: attachments.iter().map(attachment).collect(),
            ends: [LineEnd::Free, LineEnd::Free],
            start_shape: Vec::new(),
        }
    }

    fn moved(sections: &[&[f64]], attachments: &[f64]) -> Vec<Vec<f64>> {
        let mut line = line(sections, attachments);
        line.move_nodes_to_attachments();
        let lengths = line.sections.into_iter().map(|s| s.element_lengths);
        lengths.collect()
    }

    #[test]
    fn nodes_move_to_attachments_and_take_their_neighbours_along() {
        // 2.0 goes to 2.2, with two elements before it and two behind; the second section, from
        // 4.0 on, gets 5.5 from its node at 5.0, of elements of 1 and 2.
        let lengths = moved(&[&[1.0; 4], &[1.0, 2.0]], &[2.2, 5.5]);
        let expected = [vec![1.1, 1.1, 0.9, 0.9], vec![1.5, 1.5]];
        for (found, expected) in lengths.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() < 1e-12, "{lengths:?}");
        }
    }

    #[test]
    fn an_attachment_without_a_node_of_its_own_stays_inside_an_element() {
        // Near the ends, and beside one that has the node already.
        let lengths = moved(&[&[1.0; 4]], &[0.3, 2.0, 2.2, 3.9]);
        assert_eq!(lengths, [vec![1.0; 4]]);
        // At a node, at the ends, and where there is no node between the ends.
        assert_eq!(moved(&[&[0.1; 7]], &[0.0, 0.3, 0.7]), [vec![0.1; 7]]);
        assert_eq!(moved(&[&[5.0]], &[2.5]), [vec![5.0]]);
    }
}
