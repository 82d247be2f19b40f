//! `[lines.*]`: sections, attachments and ends.

use crate::file::define::{choice, table};
use crate::file::dimension::{
    AnglePerLength, Area, Dimensionless, Force, InverseLength, Length, Mass, RotationalStiffness,
    Volume,
};
use crate::file::log::Log;
use crate::file::node::{Node, NodeValue};
use crate::file::quantity::{NonNegative, Positive, Real};
use crate::file::read::{Count, Named, Read, Text, Vector, wrong_type};
use crate::file::shape::Shape;

table! {
    /// A run of pipe, hose or cable from end A to end B.
    pub(super) struct LineTable {
        /// Sections from end A to end B; at least one.
        sections: Vec<SectionTable>,
        /// Floats, clump weights and pumps along the line.
        attachments: Named<AttachmentTable>,
        /// What holds end A; absent: nothing.
        end_a: Option<EndTable>,
        /// What holds end B; absent: nothing.
        end_b: Option<EndTable>,
        /// Points of a polyline in global axes, end A first, along which the elements are first
        /// laid; the line's length is spread evenly over it. Statics starts from there. Absent: an
        /// arc between the ends.
        start_shape: Option<Vec<Vector<Real<Length>>>>,
    }
}

table! {
    /// A stretch of a line with one cross section. Give `elements` for a number of equal elements,
    /// or `element_length`, which may be graded towards the ends of the section.
    pub(super) struct SectionTable {
        /// Cross section: a name from `line_types`.
        r#type: Text,
        /// Unstretched length.
        length: Positive<Length>,
        /// Number of elements, all of one length; where there are attachments, of one length
        /// between them.
        elements: Option<Count>,
        /// Length of an element; the nearest that divides the section evenly is used.
        element_length: Option<Positive<Length>>,
        /// Length of the elements at the section's end A, from which they grow to
        /// `element_length`.
        element_length_a: Option<Positive<Length>>,
        /// Length of the elements at the section's end B, from which they grow to
        /// `element_length`.
        element_length_b: Option<Positive<Length>>,
        /// Growth of the element length per metre of line away from a graded end: with 0.2 an
        /// element is about 20 % longer than the one before.
        growth: Option<Positive<Dimensionless>>,
        /// Curvature without stress about the section's local y: with a positive one the line bends
        /// towards its local -z on its way from A to B.
        natural_curvature_y: Real<InverseLength> = "0 m^-1",
        /// Curvature without stress about the section's local z: with a positive one the line bends
        /// towards its local y.
        natural_curvature_z: Real<InverseLength> = "0 m^-1",
        /// Twist without stress: local y turns towards local z on the way from A to B.
        natural_twist: Real<AnglePerLength> = "0 rad/m",
    }
}

table! {
    /// A small rigid lump on a line. Exactly one of `volume`, `net_lift` and `wet_weight` is given.
    pub(super) struct AttachmentTable {
        /// Unstretched distance from end A. The nearest node moves there, unless it is an end of its
        /// section or has moved to another attachment.
        at: NonNegative<Length>,
        /// Mass.
        mass: NonNegative<Mass>,
        /// Displaced volume.
        volume: Option<NonNegative<Volume>>,
        /// Buoyancy less weight.
        net_lift: Option<Real<Force>>,
        /// Weight less buoyancy.
        wet_weight: Option<Real<Force>>,
        /// Drag coefficient times area, the same in all directions.
        drag_area: NonNegative<Area> = "0 m^2",
        /// Added mass, the same in all directions.
        added_mass: NonNegative<Mass> = "0 kg",
    }
}

table! {
    /// The connection of a line's end.
    pub(super) struct ConnectionTable {
        /// A name from `vessels`, `anchors` or `bodies`.
        to: Text,
        /// The joint.
        joint: JointChoice = "ball",
        /// Connection point in the local axes of what the end is connected to.
        at: Vector<Real<Length>> = [0, 0, 0],
        /// Direction of the line from A to B at the connection, in local axes; need not be of
        /// length 1. It matters for joints that hold a direction.
        direction: Vector<Real<Dimensionless>> = [0, 0, -1],
        /// Bending stiffness of a ball joint (a flex joint); absent: none.
        rotational_stiffness: Option<NonNegative<RotationalStiffness>>,
        /// Axis of a hinge, or the axis of a universal joint that is fixed to what the end is
        /// connected to, or at a fixed end the direction in which it holds the section's local y;
        /// in local axes, across the direction. Absent: local y made normal to the direction (or
        /// local x, where the direction is close to y); an absent axis at a fixed end B follows
        /// end A, so that the line is not twisted.
        axis: Option<Vector<Real<Dimensionless>>>,
        /// Direction along which the joint's point slides without resistance, in the local axes of
        /// what the end is connected to: a roller, slip joint or guide. Absent: it does not slide.
        slides_along: Option<Vector<Real<Dimensionless>>>,
    }
}

choice! {
    /// Kinds of joint.
    pub(super) enum JointChoice {
        /// Holds the position only.
        Ball = "ball",
        /// Holds torsion as well (Hooke or "cross" joint).
        Universal = "universal",
        /// Leaves only the rotation about one axis free.
        Hinge = "hinge",
        /// Holds everything.
        Fixed = "fixed",
    }
}

/// What holds an end of a line.
#[derive(Debug, Clone)]
pub(in crate::file) enum EndTable {
    /// The word `"free"`.
    Free,
    /// A connection.
    Connected(Box<ConnectionTable>),
}

impl Read for EndTable {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        match &node.value {
            NodeValue::Text(word) if word == "free" => Some(EndTable::Free),
            NodeValue::Table(_) => {
                ConnectionTable::read(node, log).map(|table| EndTable::Connected(Box::new(table)))
            }
            _ => {
                let example = "\"free\", or a table such as { to = \"ship\", joint = \"ball\" }";
                wrong_type(node, "\"free\" or a table", example, log);
                None
            }
        }
    }

    fn shape() -> Shape {
        Shape::WordOr("free", Box::new(ConnectionTable::shape()))
    }
}
