//! The sea-trial example holds exactly the reconstructed input.

use std::path::Path;

use approx::assert_relative_eq;
use catenix_model::file::read_study;
use catenix_model::{
    Joint, LineEnd, Model, Motion, Statistic, StepControl, Study, SupportRef, TowLeg, Water,
};

fn study() -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/sea-trial-1km.toml");
    read_study(&path).unwrap_or_else(|errors| panic!("{:#?}", errors.diagnostics))
}

#[test]
fn six_cases_differ_in_current_and_speed() {
    let study = study();
    let expected = [
        ("a", 0.0_f64, 0.5),
        ("b", 90.0, 0.5),
        ("c", 180.0, 0.5),
        ("d", 0.0, 1.0),
        ("e", 90.0, 1.0),
        ("f", 180.0, 1.0),
    ];
    assert_eq!(study.cases.len(), 6);
    for (case, (name, heading, speed)) in study.cases.iter().zip(expected) {
        assert_eq!(case.name, name);
        let model = &case.model;
        let profile = &model.environment.current.profile;
        let (cosine, sine) = (heading.to_radians().cos(), heading.to_radians().sin());
        for (point, (depth, current)) in profile.iter().zip([(0.0, 0.772), (313.0, 0.15)]) {
            assert_eq!(point.depth, depth);
            assert_relative_eq!(point.velocity[0], current * cosine, epsilon = 1e-15);
            assert_relative_eq!(point.velocity[1], current * sine, epsilon = 1e-15);
        }
        let leg = TowLeg {
            start: 0.0,
            ramp: 2.0,
            velocity: [speed, 0.0],
        };
        let tow = Motion::Tow { legs: vec![leg] };
        assert_eq!(model.vessels[0].motions[0], tow);
        assert_eq!(model.vessels[1].motions, [tow]);
        let dynamics = model.dynamics.as_ref().unwrap();
        assert_eq!(dynamics.duration, 160.0 / speed);
        assert_eq!(dynamics.step, StepControl::Fixed(0.1));
        assert_eq!(dynamics.statistics_window, 8.0);
    }
}

#[test]
fn references_are_the_paper_and_three_codes() {
    let study = study();
    let of_source = |case: usize, paper: bool| -> Vec<(&str, Statistic, f64, f64)> {
        let references = study.cases[case].references.iter();
        references
            .filter(|reference| reference.source.starts_with("Li et al. 2011") == paper)
            .map(|r| (r.channel.name.as_str(), r.statistic, r.low, r.high))
            .collect()
    };
    let (offset, force) = ("buffer.offset_x", "hose.end_b.force_x");
    let published: [&[(&str, f64)]; 6] = [
        &[(offset, -22.5), (force, 4031.0)],
        &[(force, 500.0)],
        &[(offset, -51.0), (force, -4133.0)],
        &[(offset, -61.9), (force, -7789.0)],
        &[(offset, -78.5)],
        &[(offset, -96.2)],
    ];
    for (case, values) in published.into_iter().enumerate() {
        let mean =
            |(channel, value): &(&'static str, f64)| (*channel, Statistic::Mean, *value, *value);
        let expected: Vec<_> = values.iter().map(mean).collect();
        assert_eq!(of_source(case, true), expected);
    }
    // Offset [m], force on the miner x and z [kN], least and largest vertical force on the ship
    // [kN].
    let codes = [
        [
            (-22.9, -22.6),
            (4.14, 4.43),
            (18.9, 18.9),
            (-1558.0, -741.0),
        ],
        [
            (-36.0, -35.8),
            (0.38, 0.62),
            (18.5, 18.5),
            (-1557.0, -741.0),
        ],
        [
            (-51.6, -51.4),
            (-3.88, -3.66),
            (17.9, 18.0),
            (-1556.0, -740.0),
        ],
        [
            (-61.9, -61.7),
            (-7.84, -7.63),
            (17.1, 17.1),
            (-1557.0, -740.0),
        ],
        [
            (-78.8, -78.5),
            (-12.0, -11.9),
            (16.0, 16.0),
            (-1555.0, -738.0),
        ],
        [
            (-96.2, -96.0),
            (-16.1, -16.0),
            (15.0, 15.0),
            (-1552.0, -734.0),
        ],
    ];
    for (case, [offsets, x, z, top]) in codes.into_iter().enumerate() {
        let top_force = "lift_pipe.end_a.force_z";
        let expected = [
            (offset, Statistic::Mean, offsets, 1.0),
            (force, Statistic::Mean, x, 1e3),
            ("hose.end_b.force_z", Statistic::Mean, z, 1e3),
            (top_force, Statistic::Min, (top.0, top.0), 1e3),
            (top_force, Statistic::Max, (top.1, top.1), 1e3),
        ];
        let found = of_source(case, false);
        assert_eq!(found.len(), expected.len());
        for (found, (channel, statistic, (low, high), unit)) in found.into_iter().zip(expected) {
            assert_eq!((found.0, found.1), (channel, statistic));
            assert_relative_eq!(found.2, low * unit, max_relative = 1e-14);
            assert_relative_eq!(found.3, high * unit, max_relative = 1e-14);
        }
    }
}

#[test]
fn figures_and_note() {
    let study = study();
    let figures: Vec<(&str, &str)> = study
        .figures
        .iter()
        .map(|f| (f.name.as_str(), f.channel.name.as_str()))
        .collect();
    assert_eq!(
        figures,
        [
            ("figure-5", "buffer.offset_x"),
            ("figure-6", "lift_pipe.end_a.force_x"),
            ("figure-7", "hose.end_b.force_x"),
            ("figure-8", "hose.end_b.force_z"),
        ]
    );
    assert!(study.note.contains("calibration, not a validation"));
}

#[test]
fn line_types_are_the_reconstructed_ones() {
    let model = first_model();
    let pi = std::f64::consts::PI;
    let [pipe, hose] = model.line_types.as_slice() else {
        panic!()
    };
    assert_eq!((pipe.outer_diameter, pipe.inner_diameter), (0.219, 0.179));
    let wall = pi / 4.0 * (0.219f64.powi(2) - 0.179f64.powi(2));
    let bore = pi / 4.0 * 0.179f64.powi(2);
    let second_moment = pi / 64.0 * (0.219f64.powi(4) - 0.179f64.powi(4));
    assert_relative_eq!(
        pipe.mass,
        7850.0 * wall + 1025.0 * bore,
        max_relative = 1e-14
    );
    assert_relative_eq!(pipe.axial_stiffness, 2.06e11 * wall, max_relative = 1e-14);
    assert_relative_eq!(
        pipe.bending_stiffness[0],
        2.06e11 * second_moment,
        max_relative = 1e-14
    );
    let torsional = 2.06e11 / 2.6 * 2.0 * second_moment;
    assert_relative_eq!(pipe.torsional_stiffness, torsional, max_relative = 1e-14);
    assert_eq!(pipe.shear_stiffness, None);
    assert_eq!((pipe.normal_drag, pipe.axial_drag), (1.44, 0.02));
    assert_eq!((pipe.normal_added_mass, pipe.axial_added_mass), (1.0, 0.0));
    assert_eq!(
        (pipe.content_density, pipe.structural_damping),
        (1025.0, 0.0)
    );

    assert_eq!((hose.outer_diameter, hose.inner_diameter), (0.20, 0.15));
    assert_eq!(hose.mass, 57.7);
    assert_eq!(hose.axial_stiffness, 5e6);
    assert_eq!(
        (hose.bending_stiffness[0], hose.torsional_stiffness),
        (1e4, 1e4)
    );
    assert_eq!(hose.structural_damping, 0.02);
    assert_eq!((hose.normal_drag, hose.axial_drag), (1.27, 0.02));
    assert_eq!((hose.normal_added_mass, hose.axial_added_mass), (1.0, 0.0));
}

#[test]
fn lines_bodies_and_vessels_are_the_reconstructed_ones() {
    let model = first_model();
    let g = 9.80665;
    let sea = &model.environment;
    assert_eq!(
        (sea.gravity, sea.water),
        (
            g,
            Some(Water {
                density: 1025.0,
                depth: 1000.0
            })
        )
    );
    assert_eq!(sea.seabed, None);
    assert!(!model.statics.current);

    let [pipe, hose] = model.lines.as_slice() else {
        panic!()
    };
    assert_eq!(pipe.sections[0].element_lengths, vec![10.0; 90]);
    assert_eq!(hose.sections[0].element_lengths, vec![2.0; 200]);
    let lifts = [35_570.0, 71_130.0];
    for (index, (float, at)) in hose.attachments.iter().zip([132.0, 264.0]).enumerate() {
        let lift = lifts[index];
        assert_eq!(float.arc_length, at);
        let net_lift = (1025.0 * float.volume - float.mass) * g;
        assert_relative_eq!(net_lift, lift, max_relative = 1e-12);
        // Written to 9 digits in the file.
        assert_relative_eq!(float.mass, 0.5 * lift / g, max_relative = 1e-8);
        assert_relative_eq!(float.added_mass, 0.75 * lift / g, max_relative = 1e-8);
        assert_eq!(float.drag_area, index as f64 + 1.0);
    }

    let [buffer] = model.bodies.as_slice() else {
        panic!()
    };
    assert_eq!((buffer.mass, buffer.length), (44_800.0, 5.0));
    let wet_weight = (buffer.mass - 1025.0 * buffer.volume) * g;
    assert_relative_eq!(wet_weight, 382e3, max_relative = 1e-12);
    assert_eq!(
        (buffer.normal_drag_area, buffer.axial_drag_area),
        (4.4, 4.4)
    );
    assert_eq!(
        (buffer.normal_added_mass, buffer.axial_added_mass),
        (19_500.0, 0.0)
    );
    assert_eq!(buffer.offset_vessel, Some(0));

    let [ship, miner] = model.vessels.as_slice() else {
        panic!()
    };
    assert_eq!(ship.position, [0.0; 3]);
    assert_eq!(miner.position, [-230.9, 0.0, -998.0]);
    let Motion::Harmonic {
        amplitude,
        period,
        phase,
        ramp,
        ..
    } = ship.motions[1]
    else {
        panic!()
    };
    assert_eq!((amplitude, period, phase, ramp), (4.0, 8.0, 0.0, 16.0));

    let ends = [&pipe.ends[0], &pipe.ends[1], &hose.ends[0], &hose.ends[1]];
    let ends = ends.map(|end| match end {
        LineEnd::Connected(connection) => connection,
        LineEnd::Free => panic!("a free end"),
    });
    use SupportRef::{Body, Vessel};
    assert_eq!(
        ends.map(|end| end.to),
        [Vessel(0), Body(0), Body(0), Vessel(1)]
    );
    assert_eq!(ends.map(|end| end.point_local[2]), [0.0, 2.5, -2.5, 0.0]);
    assert_eq!(ends.map(|end| end.direction_local), [[0.0, 0.0, -1.0]; 4]);
    assert_eq!(
        ends[0].joint,
        Joint::Ball {
            rotational_stiffness: 0.0
        }
    );
    assert_eq!((ends[1].joint, ends[2].joint), (Joint::Fixed, Joint::Fixed));
    assert!(matches!(ends[3].joint, Joint::Universal { .. }));
}

fn first_model() -> Model {
    study().cases.remove(0).model
}
