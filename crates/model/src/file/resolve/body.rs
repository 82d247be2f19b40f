//! Bodies, vessels and anchors.

use std::f64::consts::PI;

use crate::file::dimension::Length;
use crate::file::log::Log;
use crate::file::quantity::Real;
use crate::file::read::Vector;
use crate::file::tables::{AnchorTable, BodyTable, ShapeChoice, VesselTable};
use crate::{Appearance, Body, Environment, Motion, Vessel, VesselShape};

use super::Slot;
use super::line::Buoyancy;
use super::names::Names;

/// Density of steel, for the size of bodies that displace less than their mass of steel [kg/m3].
const STEEL: f64 = 7850.0;

/// Resolves a free body.
pub(super) fn body(
    table: &BodyTable,
    name: &str,
    environment: &Environment,
    names: &Names,
    log: &mut Log,
) -> Option<Body> {
    let buoyancy = Buoyancy {
        volume: table.volume.as_ref(),
        net_lift: table.net_lift.as_ref(),
        wet_weight: table.wet_weight.as_ref(),
    };
    let mass = table.mass.si;
    let offset_vessel = match &table.offset_from {
        Some(reference) => names.vessels.find(reference, log),
        None => (names.moving_vessels > 0).then_some(0),
    };
    let volume = buoyancy.volume(mass, name, &table.key_span, environment, log)?;
    let length = table.length.si;
    let inertia = match &table.inertia {
        Some(inertia) => [0, 1, 2].map(|i| inertia.components[i].si),
        None => default_inertia(mass, volume, length),
    };
    let either = |specific: Option<f64>, both: f64| specific.unwrap_or(both);
    let (area, added) = (table.drag_area.si, table.added_mass.si);
    Some(Body {
        name: name.to_owned(),
        mass,
        inertia,
        volume,
        centre_of_buoyancy: components(&table.centre_of_buoyancy),
        length,
        normal_drag_area: either(table.normal_drag_area.as_ref().map(|q| q.si), area),
        axial_drag_area: either(table.axial_drag_area.as_ref().map(|q| q.si), area),
        normal_added_mass: either(table.normal_added_mass.as_ref().map(|q| q.si), added),
        axial_added_mass: either(table.axial_added_mass.as_ref().map(|q| q.si), added),
        initial_position: table.initial_position.as_ref().map(components),
        offset_vessel,
    })
}

/// Inertia of a solid cylinder along z of this length, or of a solid sphere when it is zero.
fn default_inertia(mass: f64, volume: f64, length: f64) -> [f64; 3] {
    let volume = volume.max(mass / STEEL);
    if length > 0.0 {
        let radius_squared = volume / (PI * length);
        let across = mass * (3.0 * radius_squared + length.powi(2)) / 12.0;
        [across, across, mass * radius_squared / 2.0]
    } else {
        let radius = (3.0 * volume / (4.0 * PI)).cbrt();
        [0.4 * mass * radius.powi(2); 3]
    }
}

/// Resolves a vessel.
pub(super) fn vessel(
    table: &VesselTable,
    name: &str,
    names: &Names,
    motions: &[Slot<Motion>],
    log: &mut Log,
) -> Option<Vessel> {
    let references = table.motions.as_deref().unwrap_or_default();
    let indices: Vec<Option<usize>> = references
        .iter()
        .map(|reference| names.motions.find(reference, log))
        .collect();
    // A motion that could not be resolved is reported where it is defined.
    let found = indices.into_iter().flatten();
    let motions = found
        .filter_map(|index| motions.get(index)?.item.clone())
        .collect();
    Some(Vessel {
        name: name.to_owned(),
        position: components(&table.position),
        heading: table.heading.si,
        motions,
        appearance: Appearance {
            shape: table.shape.as_ref().map(shape),
            length: table.length.as_ref().map(|length| length.si),
        },
    })
}

fn shape(choice: &ShapeChoice) -> VesselShape {
    match choice {
        ShapeChoice::Ship => VesselShape::Ship,
        ShapeChoice::Platform => VesselShape::Platform,
        ShapeChoice::Buoy => VesselShape::Buoy,
        ShapeChoice::Crawler => VesselShape::Crawler,
    }
}

/// An anchor is a vessel that does not move.
pub(super) fn anchor(table: &AnchorTable, name: &str) -> Vessel {
    let position = components(&table.position);
    Vessel {
        name: name.to_owned(),
        position,
        heading: 0.0,
        motions: Vec::new(),
        appearance: Appearance {
            shape: Some(VesselShape::Anchor),
            length: None,
        },
    }
}

fn components(vector: &Vector<Real<Length>>) -> [f64; 3] {
    [0, 1, 2].map(|i| vector.components[i].si)
}
