//! Stiffness of a general cross section: numbers, or laws given by points.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::Log;
use crate::file::node::Span;
use crate::file::tables::GeneralTable;

/// Stiffness against extension.
pub(super) struct AxialLaw {
    /// EA, or the slope of the law at no strain, in tension [N].
    pub stiffness: f64,
    /// Strain [-] and tension [N], (0, 0) among them.
    pub law: Option<Vec<[f64; 2]>>,
}

/// Stiffness against bending.
pub(super) struct BendingLaw {
    /// EI about local y and z, or the slope of the law at no curvature [N m2].
    pub stiffness: [f64; 2],
    /// Curvature [1/m] and moment [N m], from (0, 0) on.
    pub law: Option<Vec<[f64; 2]>>,
}

/// A point of a law with its places in the file.
struct Point<'a> {
    at: f64,
    value: f64,
    at_span: &'a Span,
    value_span: &'a Span,
}

/// What a law is called in messages.
struct Words {
    key: &'static str,
    at: &'static str,
    value: &'static str,
}

pub(super) fn axial(table: &GeneralTable, log: &mut Log) -> Option<AxialLaw> {
    let Some(points) = &table.axial_law else {
        let Some(stiffness) = &table.axial_stiffness else {
            let message = "the line type has neither `axial_stiffness` nor `axial_law`";
            let help = "write axial_stiffness = \"35.57 kN\", or axial_law = [{ strain = 0.01, \
                        tension = \"10 kN\" }, ...]";
            log.error(Code::MissingKey, &table.key_span, message, help);
            return None;
        };
        return Some(AxialLaw {
            stiffness: stiffness.si,
            law: None,
        });
    };
    if let Some(stiffness) = &table.axial_stiffness {
        conflict("axial_stiffness", "axial_law", &stiffness.span, log);
    }
    let points: Vec<Point<'_>> = points
        .iter()
        .map(|point| Point {
            at: point.strain.si,
            value: point.tension.si,
            at_span: &point.strain.span,
            value_span: &point.tension.span,
        })
        .collect();
    let words = Words {
        key: "axial_law",
        at: "strain",
        value: "tension",
    };
    let law = through_origin(&points, &words, &table.key_span, log)?;
    let origin = law.iter().position(|point| point[0] == 0.0)?;
    let (low, high) = if origin + 1 < law.len() {
        (law[origin], law[origin + 1])
    } else {
        (law[origin - 1], law[origin])
    };
    Some(AxialLaw {
        stiffness: (high[1] - low[1]) / (high[0] - low[0]),
        law: Some(law),
    })
}

pub(super) fn bending(table: &GeneralTable, log: &mut Log) -> Option<BendingLaw> {
    let planes = [
        (&table.bending_stiffness_y, "bending_stiffness_y"),
        (&table.bending_stiffness_z, "bending_stiffness_z"),
    ];
    for (stiffness, key) in planes {
        let Some(stiffness) = stiffness else { continue };
        if table.bending_stiffness.is_some() {
            conflict(key, "bending_stiffness", &stiffness.span, log);
        }
        if table.bending_law.is_some() {
            conflict(key, "bending_law", &stiffness.span, log);
        }
    }
    if let [(Some(given), key), (None, other)] | [(None, other), (Some(given), key)] = planes {
        let message = format!("`{key}` is given, but not `{other}`");
        let help = "write both, or `bending_stiffness` for a section that bends alike in all \
                    directions";
        log.error(Code::MissingKey, &given.span, message, help);
    }
    let Some(points) = &table.bending_law else {
        let stiffness = match planes {
            [(Some(y), _), (Some(z), _)] => [y.si, z.si],
            _ => [table.bending_stiffness.as_ref().map_or(0.0, |q| q.si); 2],
        };
        return Some(BendingLaw {
            stiffness,
            law: None,
        });
    };
    if let Some(stiffness) = &table.bending_stiffness {
        conflict("bending_stiffness", "bending_law", &stiffness.span, log);
    }
    let points: Vec<Point<'_>> = points
        .iter()
        .map(|point| Point {
            at: point.curvature.si,
            value: point.moment.si,
            at_span: &point.curvature.span,
            value_span: &point.moment.span,
        })
        .collect();
    let words = Words {
        key: "bending_law",
        at: "curvature",
        value: "moment",
    };
    let law = through_origin(&points, &words, &table.key_span, log)?;
    Some(BendingLaw {
        stiffness: [law[1][1] / law[1][0]; 2],
        law: Some(law),
    })
}

fn conflict(key: &str, other: &str, span: &Span, log: &mut Log) {
    let message = format!("`{key}` and `{other}` exclude each other");
    log.error(Code::ConflictingKeys, span, message, "keep one of them");
}

/// The points of a law with the origin among them; `None` after noting what is wrong.
fn through_origin(
    points: &[Point<'_>],
    words: &Words,
    key_span: &Span,
    log: &mut Log,
) -> Option<Vec<[f64; 2]>> {
    let Words { key, at, value } = words;
    let mut sound = true;
    if points.iter().any(|p| p.at.is_nan() || p.value.is_nan()) {
        return None;
    }
    if points.iter().all(|point| point.at == 0.0) {
        let message = format!("`{key}` has no point away from zero");
        let help = format!("write {key} = [{{ {at} = ..., {value} = ... }}, ...]");
        log.error(Code::MissingKey, key_span, message, help);
        return None;
    }
    for point in points {
        // On the axes only the origin, and elsewhere on its own side of both.
        if point.at * point.value <= 0.0 && (point.at != 0.0 || point.value != 0.0) {
            let message = format!(
                "`{key}` must pass through zero and increase, but has the {value} {} at the {at} {}",
                point.value, point.at
            );
            let help = format!("the {value} has the sign of the {at}, and is 0 only where that is");
            log.error(Code::Value, point.value_span, message, help);
            sound = false;
        }
    }
    for pair in points.windows(2) {
        if pair[1].at <= pair[0].at {
            let message = format!(
                "each {at} in `{key}` must be larger than the one before, but {} follows {}",
                pair[1].at, pair[0].at
            );
            let help = format!("order the points by {at}");
            log.error(Code::Value, pair[1].at_span, message, help);
            sound = false;
        } else if pair[1].value <= pair[0].value {
            let message = format!(
                "each {value} in `{key}` must be larger than the one before, but {} follows {}",
                pair[1].value, pair[0].value
            );
            let help = format!("a small slope may stand for none: let the {value} rise a little");
            log.error(Code::Value, pair[1].value_span, message, help);
            sound = false;
        }
    }
    if !sound {
        return None;
    }
    let mut law: Vec<[f64; 2]> = points.iter().map(|p| [p.at, p.value]).collect();
    let origin = law.partition_point(|point| point[0] < 0.0);
    if law.get(origin).is_none_or(|point| point[0] != 0.0) {
        law.insert(origin, [0.0, 0.0]);
    }
    Some(law)
}
