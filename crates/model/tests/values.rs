//! What a file says is what the model holds: defaults, derived values and overrides.

use std::path::Path;

use approx::assert_relative_eq;
use catenix_model::file::parse_study;
use catenix_model::{
    Appearance, ChannelTarget, EndConnection, IntegratorSettings, Joint, LineEnd, LineQuantity,
    Model, Motion, Statistic, StepControl, Study, SupportRef, VesselShape,
};

const BASE: &str = r#"
title = "Values"

[environment]
water.depth = "100 m"

[line_types.rope]
kind = "general"
outer_diameter = "0.1 m"
mass = "10 kg/m"
axial_stiffness = "10 MN"

[vessels.ship]
position = [0, 0, 0]
heading = "90 deg"

[anchors.anchor]
position = ["50 m", 0, "-90 m"]

[lines.rope]
sections = [
    { type = "rope", length = "60 m", elements = 6 },
    { type = "rope", length = "60 m", element_length = "7 m" },
]
end_a = { to = "ship" }
end_b = { to = "anchor" }
"#;

fn study(text: &str) -> Study {
    match parse_study(text, "folder/values.toml", Path::new("/nonexistent")) {
        Ok(study) => study,
        Err(errors) => panic!("{:#?}", errors.diagnostics),
    }
}

fn model(addition: &str) -> Model {
    study(&format!("{BASE}\n{addition}")).cases.remove(0).model
}

fn connection(end: &LineEnd) -> &EndConnection {
    match end {
        LineEnd::Connected(connection) => connection,
        LineEnd::Free => panic!("a free end"),
    }
}

#[test]
fn defaults_are_the_documented_ones() {
    let model = model("[dynamics]\nduration = \"200 s\"\n[environment.seabed]\n");
    assert_eq!(model.environment.gravity, 9.80665);
    assert_eq!(model.environment.fluid_density(), 1025.0);
    assert!(model.environment.current.profile.is_empty());
    let seabed = model.environment.seabed.unwrap();
    assert_eq!((seabed.normal_stiffness, seabed.normal_damping), (1e4, 1e3));
    assert_eq!((seabed.friction, seabed.friction_speed), (0.5, 0.05));
    let rope = &model.line_types[0];
    assert_eq!(
        (
            rope.inner_diameter,
            rope.bending_stiffness[0],
            rope.torsional_stiffness
        ),
        (0.0, 0.0, 0.0)
    );
    assert_eq!((rope.normal_drag, rope.axial_drag), (1.2, 0.02));
    assert_eq!((rope.normal_added_mass, rope.axial_added_mass), (1.0, 0.0));
    assert_relative_eq!(rope.polar_inertia, 10.0 * 0.01 / 8.0, max_relative = 1e-15);
    assert_eq!((rope.shear_stiffness, rope.wall), (None, None));
    assert!(model.statics.current);
    assert_eq!(
        (model.statics.tolerance, model.statics.max_iterations),
        (1e-7, 10000)
    );
    let dynamics = model.dynamics.unwrap();
    assert_eq!(
        dynamics.step,
        StepControl::Adaptive {
            accuracy: 1e-4,
            min: 1e-4,
            max: 1.0
        }
    );
    assert_eq!(
        dynamics.integrator,
        IntegratorSettings::GeneralisedAlpha {
            spectral_radius: 0.4
        }
    );
    assert_eq!(dynamics.tolerance, 1e-5);
    assert_eq!(dynamics.max_iterations, 12);
    assert_eq!(dynamics.statistics_window, 20.0);
    assert_eq!(
        (model.output.interval, model.output.field_interval),
        (0.1, 1.0)
    );
    let end = connection(&model.lines[0].ends[0]);
    assert_eq!(end.to, SupportRef::Vessel(0));
    assert_eq!(
        (end.point_local, end.direction_local),
        ([0.0; 3], [0.0, 0.0, -1.0])
    );
    assert_eq!(
        end.joint,
        Joint::Ball {
            rotational_stiffness: 0.0
        }
    );
}

#[test]
fn a_file_without_cases_is_one_case() {
    let study = study(BASE);
    assert_eq!(study.cases.len(), 1);
    assert_eq!(
        (study.cases[0].name.as_str(), study.title.as_str()),
        ("base", "Values")
    );
    assert_eq!(study.cases[0].model.dynamics, None);
    let untitled = BASE.replace("title = \"Values\"", "");
    assert_eq!(self::study(&untitled).title, "values");
}

#[test]
fn overrides_merge_tables_and_replace_the_rest() {
    let text = format!(
        "{BASE}
[environment.current]
heading = \"90 deg\"
profile = [{{ depth = 0, speed = 1 }}, {{ depth = 50, speed = 0.5 }}]

[cases.first]
description = \"one point\"
environment.current.profile = [{{ depth = 10, speed = 2 }}]

[cases.second]
environment.water.density = \"1000 kg/m^3\"
lines.rope.end_b = \"free\"
vessels.ship.position = [1, 2, 3]

[cases.third]
bodies.buoy = {{ mass = 100, volume = 1 }}
lines.rope.end_b.to = \"buoy\"
lines.rope.end_b.at = [0, 0, 1]
"
    );
    let cases = study(&text).cases;
    let [first, second, third] = cases.as_slice() else {
        panic!()
    };
    assert_eq!(first.description, "one point");
    let profile = &first.model.environment.current.profile;
    assert_eq!(profile.len(), 1);
    assert_eq!(profile[0].velocity, [0.0, 2.0]);
    assert_eq!(first.model.environment.fluid_density(), 1025.0);
    let environment = &second.model.environment;
    let water = environment.water.unwrap();
    assert_eq!((water.density, water.depth), (1000.0, 100.0));
    assert_eq!(environment.current.profile.len(), 2);
    assert_eq!(second.model.lines[0].ends[1], LineEnd::Free);
    assert_eq!(second.model.vessels[0].position, [1.0, 2.0, 3.0]);
    let end = connection(&third.model.lines[0].ends[1]);
    assert_eq!(
        (end.to, end.point_local),
        (SupportRef::Body(0), [0.0, 0.0, 1.0])
    );
    assert_eq!(third.model.bodies[0].offset_vessel, Some(0));
}

#[test]
fn sections_are_divided_as_asked() {
    let line = model("").lines.remove(0);
    assert_eq!(line.sections[0].element_lengths, vec![10.0; 6]);
    assert_eq!(line.sections[1].element_lengths, vec![60.0 / 9.0; 9]);
    let graded = BASE.replace(
        "\"7 m\"",
        "\"5 m\", element_length_b = \"0.5 m\", growth = 0.3",
    );
    let lengths = &study(&graded).cases[0].model.lines[0].sections[1]
        .element_lengths
        .clone();
    assert_relative_eq!(lengths.iter().sum::<f64>(), 60.0, max_relative = 1e-12);
    assert!(
        lengths.first().unwrap() > &4.0 && lengths.last().unwrap() < &0.7,
        "{lengths:?}"
    );
    assert!(
        lengths
            .windows(2)
            .all(|pair| pair[1] <= pair[0] * (1.0 + 1e-12))
    );
}

#[test]
fn joints_have_unit_axes_normal_to_the_line() {
    for (keys, direction) in [
        ("", [0.0, 0.0, -1.0]),
        ("direction = [3, 0, 4],", [0.6, 0.0, 0.8]),
        ("direction = [0, 5, 0],", [0.0, 1.0, 0.0]),
        ("direction = [0, 0, 1], axis = [2, 0, 0],", [0.0, 0.0, 1.0]),
    ] {
        let end = format!("end_a = {{ {keys} joint = \"hinge\", to = \"ship\" }}");
        let model = study(&BASE.replace("end_a = { to = \"ship\" }", &end))
            .cases
            .remove(0)
            .model;
        let end = connection(&model.lines[0].ends[0]);
        for (found, expected) in end.direction_local.iter().zip(direction) {
            assert_relative_eq!(*found, expected, epsilon = 1e-15);
        }
        let Joint::Hinge { axis_local } = end.joint else {
            panic!()
        };
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        assert_relative_eq!(dot(axis_local, axis_local), 1.0, max_relative = 1e-14);
        assert_relative_eq!(dot(axis_local, end.direction_local), 0.0, epsilon = 1e-14);
    }
}

#[test]
fn bodies_have_the_inertia_of_a_cylinder_or_sphere() {
    let body = |keys: &str| {
        let text = BASE.replace("to = \"anchor\"", "to = \"body\"");
        let text = format!("{text}\n[bodies.body]\nmass = 1000\n{keys}\n");
        study(&text).cases.remove(0).model.bodies.remove(0)
    };
    let pi = std::f64::consts::PI;
    let sphere = body(&format!("volume = {}", 4.0 / 3.0 * pi));
    assert_relative_eq!(sphere.inertia[0], 400.0, max_relative = 1e-12);
    let cylinder = body(&format!("length = 3\nvolume = {}", 3.0 * pi * 0.25));
    let across = 1000.0 * (3.0 * 0.25 + 9.0) / 12.0;
    assert_relative_eq!(cylinder.inertia[1], across, max_relative = 1e-12);
    assert_relative_eq!(cylinder.inertia[2], 125.0, max_relative = 1e-12);
    let heavy = body("volume = 0");
    assert!(heavy.inertia[2] > 0.0);
    let floating =
        body("net_lift = \"1 kN\"\ninertia = [1, 2, 3]\ndrag_area = 2\naxial_drag_area = 3");
    assert_relative_eq!(
        (1025.0 * floating.volume - 1000.0) * 9.80665,
        1000.0,
        max_relative = 1e-12
    );
    assert_eq!(floating.inertia, [1.0, 2.0, 3.0]);
    assert_eq!(
        (floating.normal_drag_area, floating.axial_drag_area),
        (2.0, 3.0)
    );
}

#[test]
fn line_points_are_recorded_where_they_are_used() {
    let study = study(&format!(
        "{BASE}
[output]
channels = [\"rope.curvature@10 m\"]
[figures.bending]
channel = \"rope.bend_moment@0.0541 km\"
[cases.a]
references = [
    {{ channel = \"rope.declination@120\", value = \"3 deg\", source = \"nobody\" }},
    {{ channel = \"rope.curvature@0\", value = \"0.1 m^-1\", source = \"nobody\" }},
    {{ channel = \"rope.end_a.force_z\", statistic = \"min\", range = [\"-2 kN\", -1500], source = \"nobody\" }},
]
"
    ));
    assert_eq!(study.figures[0].title, "rope.bend_moment@54.1m");
    let case = &study.cases[0];
    let recorded: Vec<(&str, ChannelTarget)> = case
        .model
        .output
        .channels
        .iter()
        .map(|c| (c.name.as_str(), c.target))
        .collect();
    let point = |quantity, at| ChannelTarget::LinePoint(0, quantity, at);
    assert_eq!(
        recorded,
        [
            ("rope.curvature@10m", point(LineQuantity::Curvature, 10.0)),
            (
                "rope.declination@120m",
                point(LineQuantity::Declination, 120.0)
            ),
            ("rope.curvature@0m", point(LineQuantity::Curvature, 0.0)),
            (
                "rope.bend_moment@54.1m",
                point(LineQuantity::BendMoment, 54.1)
            ),
        ]
    );
    let [declination, curvature, force] = case.references.as_slice() else {
        panic!("three references")
    };
    assert_relative_eq!(declination.low, 3.0, max_relative = 1e-15);
    assert_eq!(declination.low, declination.high);
    assert_eq!((curvature.low, curvature.statistic), (0.1, Statistic::Mean));
    assert_eq!((force.low, force.high), (-2000.0, -1500.0));
    assert_eq!(force.statistic, Statistic::Min);
}

#[test]
fn a_vessel_looks_as_the_file_says_and_an_anchor_like_one() {
    let text = BASE.replace(
        "heading = \"90 deg\"",
        "heading = \"90 deg\"\nshape = \"platform\"\nlength = \"0.1 km\"",
    );
    let given = study(&text).cases.remove(0).model;
    assert_eq!(
        given.vessels[0].appearance,
        Appearance {
            shape: Some(VesselShape::Platform),
            length: Some(100.0)
        }
    );
    let plain = model("");
    assert_eq!(plain.vessels[0].appearance, Appearance::default());
    let anchor = plain.vessels[1].appearance;
    assert_eq!(anchor.shape, Some(VesselShape::Anchor));
}

#[test]
fn a_vessel_of_no_known_shape_or_of_no_length_is_told() {
    let text = BASE.replace("heading = \"90 deg\"", "shape = \"shipp\"\nlength = 0");
    let errors = parse_study(&text, "values.toml", Path::new("/nonexistent")).unwrap_err();
    let told: Vec<String> = errors
        .diagnostics
        .iter()
        .map(|error| {
            let help = error.help.as_deref().unwrap_or_default();
            format!("{}: {}; {help}", error.line, error.message)
        })
        .collect();
    let shape = "15: `shape` cannot be `shipp`; did you mean `ship`? It is one of `ship`, \
                 `platform`, `buoy` or `crawler`";
    let length = "16: `length` must be greater than zero, but is 0";
    assert_eq!(told.len(), 2, "{told:#?}");
    assert_eq!(told[0], shape);
    assert!(told[1].starts_with(length), "{}", told[1]);
}

#[test]
fn motions_take_defaults_and_units() {
    let model = study(&format!(
        "{}
[motions.roll]
kind = \"harmonic\"
degree = \"roll\"
amplitude = \"180 deg\"
period = \"8 s\"
phase = \"90 deg\"
[motions.turn]
kind = \"tow\"
legs = [
    {{ start = 0, ramp = 2, speed = \"1 m/s\" }},
    {{ start = 10, ramp = 2, speed = \"1 m/s\", heading = \"-90 deg\" }},
]
[dynamics]
duration = 100
",
        BASE.replace("heading = \"90 deg\"", "motions = [\"roll\", \"turn\"]")
    ))
    .cases
    .remove(0)
    .model;
    let [roll, turn] = model.vessels[0].motions.as_slice() else {
        panic!()
    };
    let Motion::Harmonic {
        amplitude,
        phase,
        ramp,
        ..
    } = *roll
    else {
        panic!()
    };
    let pi = std::f64::consts::PI;
    assert_eq!((amplitude, phase, ramp), (pi, pi / 2.0, 16.0));
    let Motion::Tow { legs } = turn else { panic!() };
    assert_eq!(
        (legs[0].velocity, legs[1].velocity),
        ([1.0, 0.0], [0.0, -1.0])
    );
    assert_eq!(model.dynamics.unwrap().statistics_window, 8.0);
}

/// Only lumped mass has a mass at each point for itself.
#[test]
fn the_explicit_integrator_belongs_to_lumped_mass() {
    let explicit = "integrator = \"explicit\"\n";
    let with = |top: &str| {
        let text = format!("{top}{BASE}\n[dynamics]\nduration = \"10 s\"\n{explicit}");
        parse_study(&text, "values.toml", Path::new(""))
    };
    let study = with("formulation = \"lumped\"\n").unwrap();
    let dynamics = study.cases[0].model.dynamics.as_ref().unwrap();
    assert_eq!(dynamics.integrator, IntegratorSettings::Explicit);
    let errors = with("").unwrap_err();
    let [error] = errors.diagnostics.as_slice() else {
        panic!("one error is expected: {errors}");
    };
    assert!(error.message.contains("`explicit`") && error.message.contains("`dem`"));
}
