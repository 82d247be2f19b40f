//! Cross sections: mass and stiffness per metre.

use std::f64::consts::PI;

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::dimension::{Dimensionless, Length};
use crate::file::log::Log;
use crate::file::quantity::{NonNegative, Positive, Real};
use crate::file::tables::{GeneralTable, LineTypeTable, PipeTable, RectangleTable};
use crate::{LineType, PipeWall};

use super::ResolvedLineType;
use super::section_law;

/// Resolves a cross section.
pub(super) fn resolve(
    table: &LineTypeTable,
    name: &str,
    log: &mut Log,
) -> Option<ResolvedLineType> {
    match table {
        LineTypeTable::Pipe(table) => pipe(table, name, log),
        LineTypeTable::Rectangle(table) => rectangle(table, name, log),
        LineTypeTable::General(table) => general(table, name, log),
    }
}

/// Source: docs/theory/dem.md, eq. (29).
fn pipe(table: &PipeTable, name: &str, log: &mut Log) -> Option<ResolvedLineType> {
    check_diameters(&table.outer_diameter, &table.inner_diameter, log)?;
    let poisson = poisson_ratio(&table.poisson_ratio, log)?;
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
        axial_law: None,
        bending_stiffness: [youngs * polar_moment / 2.0; 2],
        bending_law: None,
        torsional_stiffness: shear_modulus * polar_moment,
        shear_stiffness: table
            .shear_coefficient
            .as_ref()
            .map(|coefficient| coefficient.si * shear_modulus * wall_area),
        polar_inertia,
        rotary_inertia: match &table.shear_coefficient {
            Some(_) => [0.5 * polar_inertia; 2],
            None => [0.0; 2],
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

/// Source: docs/theory/sections.md, eqs. (15) and (16).
fn rectangle(table: &RectangleTable, name: &str, log: &mut Log) -> Option<ResolvedLineType> {
    let poisson = poisson_ratio(&table.poisson_ratio, log)?;
    let (width, height) = (table.width.si, table.height.si);
    let (area, youngs) = (width * height, table.youngs_modulus.si);
    let shear_modulus = youngs / (2.0 * (1.0 + poisson));
    // Second moments of area about local y and z.
    let moments = [area * height * height / 12.0, area * width * width / 12.0];
    let torsion_constant = match &table.torsion_constant {
        Some(given) => given.si,
        None => saint_venant_torsion(width, height),
    };
    let inertia = moments.map(|moment| table.density.si * moment);
    let line_type = LineType {
        name: name.to_owned(),
        outer_diameter: (4.0 * area / PI).sqrt(),
        inner_diameter: 0.0,
        mass: table.density.si * area,
        axial_stiffness: youngs * area,
        axial_law: None,
        bending_stiffness: moments.map(|moment| youngs * moment),
        bending_law: None,
        torsional_stiffness: shear_modulus * torsion_constant,
        shear_stiffness: table
            .shear_coefficient
            .as_ref()
            .map(|coefficient| coefficient.si * shear_modulus * area),
        polar_inertia: inertia[0] + inertia[1],
        rotary_inertia: match &table.shear_coefficient {
            Some(_) => inertia,
            None => [0.0; 2],
        },
        structural_damping: table.structural_damping.si,
        normal_drag: table.normal_drag.si,
        axial_drag: table.axial_drag.si,
        normal_added_mass: table.normal_added_mass.si,
        axial_added_mass: table.axial_added_mass.si,
        content_density: 0.0,
        wall: None,
    };
    Some(ResolvedLineType {
        line_type,
        strain_limit: table.strain_limit.si,
    })
}

/// Torsion constant of a solid rectangle by its two sides [m4].
///
/// Source: docs/theory/sections.md, eq. (16).
fn saint_venant_torsion(width: f64, height: f64) -> f64 {
    let (long, short) = (width.max(height), width.min(height));
    // The terms fall with the fifth power: the first one left out, n = 101, is 1e-10 of the sum.
    let sum: f64 = (1..100)
        .step_by(2)
        .map(f64::from)
        .map(|n| (0.5 * n * PI * long / short).tanh() / n.powi(5))
        .sum();
    long * short.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * short / long * sum)
}

fn poisson_ratio(ratio: &Real<Dimensionless>, log: &mut Log) -> Option<f64> {
    if ratio.si <= -1.0 || ratio.si > 0.5 {
        let message = format!(
            "`poisson_ratio` must lie above -1 and up to 0.5, but is {}",
            ratio.si
        );
        log.error(Code::Value, &ratio.span, message, "steel has 0.3");
        return None;
    }
    Some(ratio.si)
}

fn general(table: &GeneralTable, name: &str, log: &mut Log) -> Option<ResolvedLineType> {
    check_diameters(&table.outer_diameter, &table.inner_diameter, log)?;
    let (outer, inner) = (table.outer_diameter.si, table.inner_diameter.si);
    let mass = table.mass.si;
    let axial = section_law::axial(table, log);
    let bending = section_law::bending(table, log);
    let content_mass = table.content_density.si * PI / 4.0 * inner.powi(2);
    if content_mass > mass {
        let message = format!(
            "the content alone weighs {content_mass:.2} kg/m, more than `mass`, {mass} kg/m with content"
        );
        let help = "`mass` includes the content; add it, or lower `content_density`";
        log.error(Code::Value, &table.content_density.span, message, help);
    }
    let (axial, bending) = (axial?, bending?);
    let optional = |value: Option<f64>, default: f64| value.unwrap_or(default);
    let polar_inertia = optional(
        table.polar_inertia.as_ref().map(|inertia| inertia.si),
        mass * (outer.powi(2) + inner.powi(2)) / 8.0,
    );
    let mean_bending = 0.5 * (bending.stiffness[0] + bending.stiffness[1]);
    let line_type = LineType {
        name: name.to_owned(),
        outer_diameter: outer,
        inner_diameter: inner,
        mass,
        axial_stiffness: axial.stiffness,
        axial_law: axial.law,
        bending_stiffness: bending.stiffness,
        bending_law: bending.law,
        torsional_stiffness: optional(
            table.torsional_stiffness.as_ref().map(|q| q.si),
            mean_bending,
        ),
        shear_stiffness: table.shear_stiffness.as_ref().map(|stiffness| stiffness.si),
        polar_inertia,
        rotary_inertia: [optional(
            table.rotary_inertia.as_ref().map(|inertia| inertia.si),
            match &table.shear_stiffness {
                Some(_) => 0.5 * polar_inertia,
                None => 0.0,
            },
        ); 2],
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
