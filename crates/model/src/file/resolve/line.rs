//! Lines: sections, attachments and ends.

use nalgebra::Vector3;

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::dimension::{Dimensionless, Force, Length, Volume};
use crate::file::log::Log;
use crate::file::node::Span;
use crate::file::quantity::{NonNegative, Real};
use crate::file::read::{NamedItem, Vector};
use crate::file::tables::{
    AttachmentTable, ConnectionTable, EndTable, JointChoice, LineTable, SectionTable,
};
use crate::{Attachment, EndConnection, Environment, Joint, Line, LineEnd, NaturalShape, Section};

use super::grading::element_lengths;
use super::names::Names;
use super::{ResolvedLineType, Slot};

/// A line with what the checks of the whole system need.
#[derive(Debug)]
pub(super) struct ResolvedLine {
    /// The line.
    pub line: Line,
    /// Length to which it stretches before a section counts as torn [m].
    pub stretched_length: f64,
    /// Where each end's connection point was written.
    pub point_spans: [Span; 2],
}

/// Resolves a line.
pub(super) fn resolve(
    table: &LineTable,
    name: &str,
    environment: &Environment,
    names: &Names,
    line_types: &[Slot<ResolvedLineType>],
    element_budget: &mut usize,
    log: &mut Log,
) -> Option<ResolvedLine> {
    if table.sections.is_empty() {
        let message = format!("the line `{name}` has no section");
        let help = "write sections = [ { type = \"...\", length = \"900 m\", elements = 90 } ]";
        log.error(Code::MissingKey, &table.key_span, message, help);
    }
    let mut stretched_length = 0.0;
    let mut written_length = 0.0;
    let mut sections = Vec::new();
    for section in &table.sections {
        let line_type = names.line_types.find(&section.r#type, log);
        let element_lengths = element_lengths(section, element_budget, log);
        let limit = line_type
            .and_then(|index| line_types.get(index)?.item.as_ref())
            .map_or(f64::NAN, |line_type| line_type.strain_limit);
        stretched_length += section.length.si * (1.0 + limit);
        written_length += section.length.si;
        if let (Some(line_type), Some(element_lengths)) = (line_type, element_lengths) {
            let natural = natural_shape(section, &element_lengths, log);
            let stiffness = line_types
                .get(line_type)
                .and_then(|slot| Some(slot.item.as_ref()?.line_type.bending_stiffness));
            if natural.curvature != [0.0; 2] && stiffness == Some([0.0; 2]) {
                let message = format!(
                    "`{}` has no bending stiffness and cannot have a natural curvature",
                    section.r#type.value
                );
                let help = "give the line type a bending stiffness, or remove the curvature";
                log.error(Code::ConflictingKeys, &section.r#type.span, message, help);
            }
            sections.push(Section {
                line_type,
                element_lengths,
                natural,
            });
        }
    }
    let mut attachments: Vec<Attachment> = table
        .attachments
        .0
        .iter()
        .filter_map(|item| attachment(item, name, written_length, environment, log))
        .collect();
    attachments.sort_by(|a, b| a.arc_length.total_cmp(&b.arc_length));
    let start_shape = start_shape(table, log);
    let end_a = end(table.end_a.as_ref(), names, log);
    let end_b = end(table.end_b.as_ref(), names, log);
    if sections.len() != table.sections.len() || sections.is_empty() {
        return None;
    }
    let mut line = Line {
        name: name.to_owned(),
        sections,
        attachments,
        ends: [end_a?, end_b?],
        start_shape: start_shape?,
    };
    line.move_nodes_to_attachments();
    let point_span = |end: &Option<EndTable>| match end {
        Some(EndTable::Connected(connection)) => connection.at.span.clone(),
        _ => table.key_span.clone(),
    };
    let point_spans = [point_span(&table.end_a), point_span(&table.end_b)];
    Some(ResolvedLine {
        line,
        stretched_length,
        point_spans,
    })
}

/// Points of the start shape; empty when there is none, `None` when it cannot be used.
fn start_shape(table: &LineTable, log: &mut Log) -> Option<Vec<[f64; 3]>> {
    let Some(points) = &table.start_shape else {
        return Some(Vec::new());
    };
    let help = "write start_shape = [ [x, y, z], [x, y, z], ... ] from end A to end B, no two \
                points that follow each other alike";
    let [first, .., _] = points.as_slice() else {
        let message = format!(
            "`start_shape` needs at least 2 points, but has {}",
            points.len()
        );
        let span = points.first().map_or(&table.key_span, |point| &point.span);
        log.error(Code::Value, span, message, help);
        return None;
    };
    let place = |point: &Vector<Real<Length>>| [0, 1, 2].map(|i| point.components[i].si);
    let mut before = place(first);
    for point in &points[1..] {
        let after = place(point);
        if after == before {
            let message = "two points of `start_shape` that follow each other are alike";
            log.error(Code::Value, &point.span, message, help);
            return None;
        }
        before = after;
    }
    Some(points.iter().map(place).collect())
}

/// Largest natural bend or twist of one element [rad]: with more, neighbours would be half a turn
/// apart before any load acts.
const MOST_NATURAL_TURN: f64 = 1.0;

fn natural_shape(section: &SectionTable, element_lengths: &[f64], log: &mut Log) -> NaturalShape {
    let longest = element_lengths.iter().copied().fold(0.0, f64::max);
    let (y, z) = (&section.natural_curvature_y, &section.natural_curvature_z);
    let twist = &section.natural_twist;
    let curved = if y.si == 0.0 { &z.span } else { &y.span };
    for (what, turn, span) in [
        ("bend", y.si.hypot(z.si), curved),
        ("twist", twist.si.abs(), &twist.span),
    ] {
        if turn * longest > MOST_NATURAL_TURN {
            let message = format!(
                "the natural {what} of an element is {:.0} deg; at most {:.0} deg can be computed",
                (turn * longest).to_degrees(),
                MOST_NATURAL_TURN.to_degrees()
            );
            let shorter = MOST_NATURAL_TURN / turn;
            let help = format!("use elements of {shorter:.3} m or less; 10 deg each are better");
            log.error(Code::Value, span, message, help);
        }
    }
    NaturalShape {
        curvature: [y.si, z.si],
        twist: twist.si,
    }
}

fn attachment(
    item: &NamedItem<AttachmentTable>,
    line: &str,
    line_length: f64,
    environment: &Environment,
    log: &mut Log,
) -> Option<Attachment> {
    let table = item.item.as_ref()?;
    // Lengths of sections add up with rounding; a millionth of the line is no error.
    if table.at.si > line_length * (1.0 + 1e-6) {
        let message = format!(
            "`{}` is at {} m, beyond the end of `{line}`, which is {line_length} m long",
            item.name, table.at.si
        );
        let help = "`at` is the unstretched distance from the line's end A";
        log.error(Code::Value, &table.at.span, message, help);
    }
    let buoyancy = Buoyancy {
        volume: table.volume.as_ref(),
        net_lift: table.net_lift.as_ref(),
        wet_weight: table.wet_weight.as_ref(),
    };
    let volume = buoyancy.volume(table.mass.si, &item.name, &table.key_span, environment, log)?;
    Some(Attachment {
        name: item.name.clone(),
        arc_length: table.at.si.min(line_length),
        mass: table.mass.si,
        volume,
        drag_area: table.drag_area.si,
        added_mass: table.added_mass.si,
    })
}

/// The keys that tell how much water an object displaces; exactly one is given.
pub(super) struct Buoyancy<'a> {
    /// Displaced volume.
    pub volume: Option<&'a NonNegative<Volume>>,
    /// Buoyancy less weight.
    pub net_lift: Option<&'a Real<Force>>,
    /// Weight less buoyancy.
    pub wet_weight: Option<&'a Real<Force>>,
}

impl Buoyancy<'_> {
    /// Displaced volume [m3] of an object of this mass [kg].
    pub fn volume(
        &self,
        mass: f64,
        name: &str,
        key_span: &Span,
        environment: &Environment,
        log: &mut Log,
    ) -> Option<f64> {
        let weight = mass * environment.gravity;
        let Some(water) = environment.water.filter(|_| environment.gravity != 0.0) else {
            return self.volume_without_buoyancy(name, environment, log);
        };
        let (force, span) = match (self.volume, self.net_lift, self.wet_weight) {
            (Some(volume), None, None) => return Some(volume.si),
            (None, Some(lift), None) => (weight + lift.si, &lift.span),
            (None, None, Some(wet)) => (weight - wet.si, &wet.span),
            (None, None, None) => {
                let message = format!("`{name}` does not say how much water it displaces");
                let help = "write volume = \"... m^3\", net_lift = \"... kN\" (buoyancy less \
                            weight) or wet_weight = \"... kN\" (weight less buoyancy)";
                log.error(Code::MissingKey, key_span, message, help);
                return None;
            }
            _ => {
                let message =
                    format!("`{name}` has more than one of `volume`, `net_lift` and `wet_weight`");
                log.error(Code::ConflictingKeys, key_span, message, "keep one of them");
                return None;
            }
        };
        if force < 0.0 {
            let message = format!(
                "`{name}` cannot be so heavy in water: its weight in air is {weight:.1} N, from its mass of {mass} kg"
            );
            let help = "raise the mass, or lower the weight in water";
            log.error(Code::Value, span, message, help);
            return None;
        }
        Some(force / (water.density * environment.gravity))
    }

    /// The same where nothing is buoyant: a volume may be given, and is not needed.
    fn volume_without_buoyancy(
        &self,
        name: &str,
        environment: &Environment,
        log: &mut Log,
    ) -> Option<f64> {
        let why = if environment.water.is_none() {
            "there is no water"
        } else {
            "there is no gravity"
        };
        let forces = [
            self.net_lift.map(|q| ("net_lift", &q.span)),
            self.wet_weight.map(|q| ("wet_weight", &q.span)),
        ];
        if let Some((key, span)) = forces.into_iter().flatten().next() {
            let message = format!("`{name}` has a `{key}`, but {why}");
            log.error(
                Code::ConflictingKeys,
                span,
                message,
                "write volume = \"... m^3\", or nothing",
            );
            return None;
        }
        Some(self.volume.map_or(0.0, |volume| volume.si))
    }
}

fn end(table: Option<&EndTable>, names: &Names, log: &mut Log) -> Option<LineEnd> {
    match table {
        None | Some(EndTable::Free) => Some(LineEnd::Free),
        Some(EndTable::Connected(table)) => connection(table, names, log).map(LineEnd::Connected),
    }
}

fn connection(table: &ConnectionTable, names: &Names, log: &mut Log) -> Option<EndConnection> {
    let to = names.find_support(&table.to, log);
    let direction = unit_vector("direction", &table.direction, log);
    check_joint_keys(table, log);
    let slides_along = match &table.slides_along {
        None => Some(None),
        Some(axis) => unit_vector("slides_along", axis, log).map(|unit| Some(unit.into())),
    };
    let direction = direction?;
    let axis = match &table.axis {
        None => Some(default_axis(direction)),
        Some(axis) => unit_vector("axis", axis, log).and_then(|unit| {
            // Written to three digits, an axis may be off by a thousandth; it is squared up.
            let along = unit.dot(&direction);
            if along.abs() > 1e-2 {
                let angle = along.clamp(-1.0, 1.0).acos().to_degrees();
                let message =
                    format!("the axis must be normal to `direction`, but is at {angle:.1} deg");
                let help = "the axis is the one about which the line turns";
                log.error(Code::Value, &axis.span, message, help);
            }
            (unit - direction * along).try_normalize(1e-6)
        }),
    }?;
    let joint = match table.joint {
        JointChoice::Ball => Joint::Ball {
            rotational_stiffness: table.rotational_stiffness.as_ref().map_or(0.0, |q| q.si),
        },
        JointChoice::Universal => Joint::Universal {
            axis_local: axis.into(),
        },
        JointChoice::Hinge => Joint::Hinge {
            axis_local: axis.into(),
        },
        JointChoice::Fixed => Joint::Fixed,
    };
    Some(EndConnection {
        to: to?,
        point_local: [0, 1, 2].map(|i| table.at.components[i].si),
        direction_local: direction.into(),
        axis_local: axis.into(),
        axis_given: table.axis.is_some(),
        joint,
        slides_along: slides_along?,
    })
}

fn check_joint_keys(table: &ConnectionTable, log: &mut Log) {
    if let Some(stiffness) = &table.rotational_stiffness
        && table.joint != JointChoice::Ball
    {
        let message = "only a ball joint has a `rotational_stiffness`";
        log.error(
            Code::ConflictingKeys,
            &stiffness.span,
            message,
            "write joint = \"ball\"",
        );
    }
    if let Some(axis) = &table.axis
        && table.joint == JointChoice::Ball
    {
        let message = "a ball joint has no `axis`";
        let help = "remove it, or write joint = \"hinge\", \"universal\" or \"fixed\"";
        log.error(Code::ConflictingKeys, &axis.span, message, help);
    }
}

fn unit_vector(
    key: &str,
    vector: &Vector<Real<Dimensionless>>,
    log: &mut Log,
) -> Option<Vector3<f64>> {
    let [x, y, z] = &vector.components;
    let vector_3 = Vector3::new(x.si, y.si, z.si);
    let largest = vector_3.amax();
    if largest == 0.0 {
        let message = format!("`{key}` has no length");
        log.error(
            Code::Value,
            &vector.span,
            message,
            "write for example [0, 0, -1]",
        );
        return None;
    }
    // Scaled first, so that no component is too large or small to be squared.
    (vector_3 / largest).try_normalize(0.0)
}

/// Local y made normal to the direction, so that lines that hang in the x-z plane turn freely in
/// it; local x where the direction is within about 25 degrees of y.
fn default_axis(direction: Vector3<f64>) -> Vector3<f64> {
    let start = if direction.y.abs() > 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    (start - direction * start.dot(&direction)).normalize()
}
