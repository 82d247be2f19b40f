//! Cross sections: mass and stiffness per metre.

use std::f64::consts::PI;

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::dimension::Length;
use crate::file::log::Log;
use crate::file::quantity::{NonNegative, Positive};
use crate::file::tables::{GeneralTable, LineTypeTable, PipeTable};
use crate::{LineType, PipeWall};

use super::ResolvedLineType;

/// Resolves a cross section.
pub(super) fn resolve(
    table: &LineTypeTable,
    name: &str,
    log: &mut Log,
) -> Option<ResolvedLineType> {
    match table {
        LineTypeTable::Pipe(table) => pipe(table, name, log),
        LineTypeTable::General(table) => general(table, name, log),
    }
}

/// Source: docs/theory/dem.md, eq. (29).
fn pipe(table: &PipeTable, name: &str, log: &mut Log) -> Option<ResolvedLineType> {
    check_diameters(&table.outer_diameter, &table.inner_diameter, log)?;
    let poisson = table.poisson_ratio.si;
    if poisson <= -1.0 || poisson > 0.5 {
        let message = format!("`poisson_ratio` must lie above -1 and up to 0.5, but is {poisson}");
        log.error(
            Code::Value,
            &table.poisson_ratio.span,
            message,
            "steel has 0.3",
        );
        return None;
    }
    let (outer, inner) = (table.outer_diameter.si, table.inner_diameter.si);
    let bore_area = PI / 4.0 * inner.powi(2);
    let wall_area = PI / 4.0 * (outer.powi(2) - inner.powi(2));
    let polar_moment = PI / 32.0 * (outer.powi(4) - inner.powi(4));
    let (coating, content) = (table.coating_mass.si, table.content_density.si);
    let youngs = table.youngs_modulus.si;
    let shear_modulus = youngs / (2.0 * (1.0 + poisson));
    // The coating sits at the outer radius; the content does not turn with the pipe.
    let polar_inertia = table.density.si * polar_moment + coating * outer.powi(2) / 4.0;
    let line_type = LineType {
        name: name.to_owned(),
        outer_diameter: outer,
        inner_diameter: inner,
        mass: table.density.si * wall_area + content * bore_area + coating,
        axial_stiffness: youngs * wall_area,
        bending_stiffness: youngs * polar_moment / 2.0,
        torsional_stiffness: shear_modulus * polar_moment,
        shear_stiffness: table
            .shear_coefficient
            .as_ref()
            .map(|coefficient| coefficient.si * shear_modulus * wall_area),
        polar_inertia,
        rotary_inertia: match &table.shear_coefficient {
            Some(_) => 0.5 * polar_inertia,
            None => 0.0,
        },
        structural_damping: table.structural_damping.si,
        normal_drag: table.normal_drag.si,
        axial_drag: table.axial_drag.si,
        normal_added_mass: table.normal_added_mass.si,
        axial_added_mass: table.axial_added_mass.si,
        content_density: content,
        wall: Some(PipeWall {
            outer_diameter: outer,
            inner_diameter: inner,
        }),
    };
    Some(ResolvedLineType {
        line_type,
        strain_limit: table.strain_limit.si,
    })
}

fn general(table: &GeneralTable, name: &str, log: &mut Log) -> Option<ResolvedLineType> {
    check_diameters(&table.outer_diameter, &table.inner_diameter, log)?;
    let (outer, inner) = (table.outer_diameter.si, table.inner_diameter.si);
    let mass = table.mass.si;
    let bending = table.bending_stiffness.si;
    let content_mass = table.content_density.si * PI / 4.0 * inner.powi(2);
    if content_mass > mass {
        let message = format!(
            "the content alone weighs {content_mass:.2} kg/m, more than `mass`, {mass} kg/m with content"
        );
        let help = "`mass` includes the content; add it, or lower `content_density`";
        log.error(Code::Value, &table.content_density.span, message, help);
    }
    let optional = |value: Option<f64>, default: f64| value.unwrap_or(default);
    let polar_inertia = optional(
        table.polar_inertia.as_ref().map(|inertia| inertia.si),
        mass * (outer.powi(2) + inner.powi(2)) / 8.0,
    );
    let line_type = LineType {
        name: name.to_owned(),
        outer_diameter: outer,
        inner_diameter: inner,
        mass,
        axial_stiffness: table.axial_stiffness.si,
        bending_stiffness: bending,
        torsional_stiffness: optional(table.torsional_stiffness.as_ref().map(|q| q.si), bending),
        shear_stiffness: table.shear_stiffness.as_ref().map(|stiffness| stiffness.si),
        polar_inertia,
        rotary_inertia: optional(
            table.rotary_inertia.as_ref().map(|inertia| inertia.si),
            match &table.shear_stiffness {
                Some(_) => 0.5 * polar_inertia,
                None => 0.0,
            },
        ),
        structural_damping: table.structural_damping.si,
        normal_drag: table.normal_drag.si,
        axial_drag: table.axial_drag.si,
        normal_added_mass: table.normal_added_mass.si,
        axial_added_mass: table.axial_added_mass.si,
        content_density: table.content_density.si,
        wall: None,
    };
    Some(ResolvedLineType {
        line_type,
        strain_limit: table.strain_limit.si,
    })
}

fn check_diameters(
    outer: &Positive<Length>,
    inner: &NonNegative<Length>,
    log: &mut Log,
) -> Option<()> {
    if inner.si >= outer.si {
        let message = format!(
            "the inner diameter, {} m, is not smaller than the outer diameter, {} m",
            inner.si, outer.si
        );
        let help = "correct the diameters; they may have been exchanged";
        log.error(Code::Value, &inner.span, message, help);
        return None;
    }
    Some(())
}
