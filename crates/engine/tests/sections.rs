//! Cross sections with directions, naturally curved lines, and shear: published beams, closed
//! forms, and the orders of convergence.

mod common;

use std::f64::consts::PI;

use catenix_model::{LineQuantity, StepControl};
use common::{Statics, assert_near, distance, model, run, statics};

/// A beam from the origin of a wall at (0, 0, -100), weightless in its fluid.
struct Beam {
    /// Keys of the line type, its kind and mass included.
    line_type: String,
    /// Density of the water [kg/m3].
    fluid: f64,
    length: f64,
    elements: usize,
    /// More keys of the section, with a comma in front.
    natural: String,
    /// Weight at the tip [N].
    tip_weight: f64,
    /// Keys of the clamp.
    clamp: String,
}

impl Beam {
    fn text(&self) -> String {
        let Beam {
            line_type,
            fluid,
            length,
            elements,
            natural,
            tip_weight,
            clamp,
        } = self;
        let mass = tip_weight / common::G;
        let load = if mass > 0.0 {
            format!("attachments.load = {{ at = {length:?}, mass = {mass:?}, volume = 0 }}")
        } else {
            String::new()
        };
        format!(
            r#"
            environment.water = {{ density = {fluid:?}, depth = "1000 m" }}
            [line_types.bar]
            {line_type}
            [anchors.wall]
            position = [0, 0, -100]
            [lines.beam]
            sections = [{{ type = "bar", length = {length:?}, elements = {elements} {natural} }}]
            {load}
            end_a = {{ to = "wall", joint = "fixed", {clamp} }}
            "#
        )
    }

    fn solve(&self) -> Statics {
        statics(&model(&self.text()))
    }

    /// Tip against the wall's origin, global (3) [m].
    fn tip(&self) -> [f64; 3] {
        tip(&self.solve())
    }
}

fn tip(statics: &Statics) -> [f64; 3] {
    let fields = &statics.fields[0];
    let [x, y, z] = fields.position(fields.get(LineQuantity::X).len() - 1);
    [x, y, z + 100.0]
}

/// A bar of unit density in a fluid of unit density.
fn rectangle(width: f64, height: f64, youngs: f64, poisson: f64, more: &str) -> String {
    format!(
        r#"
        kind = "rectangle"
        width = {width:?}
        height = {height:?}
        density = 1
        youngs_modulus = {youngs:?}
        poisson_ratio = {poisson:?}
        {more}
        "#
    )
}

/// A general type without weight in a fluid of 4 / pi kg/m3.
fn general(stiffness: &str) -> String {
    format!("kind = \"general\"\nouter_diameter = 1\nmass = 1\n{stiffness}")
}

const GENERAL_FLUID: f64 = 4.0 / PI;

fn orders(errors: &[f64]) -> Vec<f64> {
    let pairs = errors.windows(2);
    pairs.map(|pair| (pair[0] / pair[1]).log2()).collect()
}

#[test]
fn val_bathe_and_bolourchi_1979_bend_of_45_degrees() {
    let tip = |torsion: &str, elements: usize| {
        Beam {
            line_type: rectangle(1.0, 1.0, 1e7, 0.0, torsion),
            fluid: 1.0,
            length: 25.0 * PI,
            elements,
            natural: ", natural_curvature_z = 0.01, natural_curvature_y = 0".into(),
            tip_weight: 300.0,
            clamp: "direction = [1, 0, 0], axis = [0, 1, 0]".into(),
        }
        .tip()
    };
    // Tips of converged beam computations with GJ = G/6 and with Saint-Venant's J = 0.1406.
    let cases = [
        (
            format!("torsion_constant = {}", 1.0 / 6.0),
            [58.779, 22.245, -40.192],
        ),
        (String::new(), [58.536, 22.113, -40.480]),
    ];
    for (torsion, expected) in cases {
        // Half a percent of the deflection is what the publication's element meshes differ by.
        let coarse = distance(tip(&torsion, 20), expected);
        assert!(coarse < 0.005 * 40.0, "20 elements: {coarse} m");
    }
}

#[test]
fn val_exudyn_cantilever_with_a_large_load() {
    // Cowper's shear coefficient of a rectangle, 10 (1 + nu) / (12 + 11 nu), as in the example.
    let tip = Beam {
        line_type: rectangle(
            0.1,
            0.5,
            2.07e11,
            0.3,
            "shear_coefficient = 0.849_673_202_614_379",
        ),
        fluid: 1.0,
        length: 2.0,
        elements: 20,
        natural: String::new(),
        tip_weight: 6.25e7,
        clamp: "direction = [1, 0, 0], axis = [0, 1, 0]".into(),
    }
    .tip();
    assert_near("ux", 2.0 - tip[0], 0.150_971, 0.005 * 0.150_971);
    assert_near("uz", -tip[2], 0.710_568, 0.005 * 0.710_568);
}

#[test]
fn val_geradin_cantilever_that_shears() {
    let statics = Beam {
        line_type: general(
            "axial_stiffness = 4.8e8\nshear_stiffness = 3.231e8\nbending_stiffness = 9.346e6",
        ),
        fluid: GENERAL_FLUID,
        length: 5.0,
        elements: 20,
        natural: String::new(),
        tip_weight: 600e3,
        clamp: "direction = [1, 0, 0]".into(),
    }
    .solve();
    let tip = tip(&statics);
    let rotation = (statics.get("beam.end_b.declination") - 90.0)
        .abs()
        .to_radians();
    assert_near("drop", -tip[2], 2.159, 0.005 * 2.159);
    assert_near("shortening", 5.0 - tip[0], 0.596, 0.005 * 0.596);
    assert_near("rotation", rotation, 0.6720, 0.005 * 0.6720);
}

#[test]
fn timoshenko_s_deflection_by_shear_and_bending() {
    let (shear, bending, length, load) = (2e4, 1e4, 2.0f64, 1.0);
    let expected = load * length.powi(3) / (3.0 * bending) + load * length / shear;
    let beam = |elements: usize, tip_weight: f64| Beam {
        line_type: general(&format!(
            "axial_stiffness = 1e8\nshear_stiffness = {shear}\nbending_stiffness = {bending}"
        )),
        fluid: GENERAL_FLUID,
        length,
        elements,
        natural: String::new(),
        tip_weight,
        clamp: "direction = [1, 0, 0]".into(),
    };
    // A load on a body: the half element at the end shears too.
    let errors = [4, 8, 16].map(|elements| {
        let text = beam(elements, 0.0).text()
            + &format!(
                "end_b = {{ to = \"weight\" }}\n[bodies.weight]\nmass = {:?}\nvolume = 0\n\
                 initial_position = [{length:?}, 0, -100]",
                load / common::G
            );
        let drop = -tip(&statics(&model(&text)))[2];
        (drop / expected - 1.0).abs()
    });
    assert!(
        orders(&errors).iter().all(|&order| order > 1.9),
        "{errors:?}"
    );
    // A lump sits on the rigid element: the shear of half an element is missing, and no more.
    let elements = 16;
    let missing = expected + beam(elements, load).tip()[2];
    let half_element = load * 0.5 * length / elements as f64 / shear;
    assert_near(
        "missing",
        missing,
        half_element,
        2e-3 * half_element + 1e-4 * expected,
    );
}

#[test]
fn an_oblique_load_bends_a_rectangle_about_both_planes() {
    let (width, height, youngs, length, load) = (0.03f64, 0.01f64, 1e13, 4.0f64, 10.0);
    let moments = [width * height.powi(3) / 12.0, height * width.powi(3) / 12.0];
    for angle in [0.0f64, 0.6, 1.2, 2.5] {
        let (sin, cos) = angle.sin_cos();
        // Down is -sin along y and -cos along z; a force along z bends about y.
        let w = |force: f64, moment: f64| force * length.powi(3) / (3.0 * youngs * moment);
        let (along_y, along_z) = (w(-load * sin, moments[1]), w(-load * cos, moments[0]));
        let expected = [
            0.0,
            along_y * cos - along_z * sin,
            along_y * sin + along_z * cos,
        ];
        let errors = [4, 8].map(|elements| {
            // Local y at this angle above the horizontal; z follows.
            let tip = Beam {
                line_type: rectangle(width, height, youngs, 0.3, ""),
                fluid: 1.0,
                length,
                elements,
                natural: String::new(),
                tip_weight: load,
                clamp: format!("direction = [1, 0, 0], axis = [0, {cos}, {sin}]"),
            }
            .tip();
            distance([0.0, tip[1], tip[2]], expected) / expected[1].hypot(expected[2])
        });
        // The shifted hinge leaves 1 / 24 n^3 in both planes.
        assert!(orders(&errors)[0] > 2.8 && errors[1] < 1e-4, "{errors:?}");
    }
}

#[test]
fn val_li_2011_rectangle_first_frequencies_in_both_planes() {
    // The paper's cantilever, 8 x 6 mm, hangs and is jerked askew; Euler-Bernoulli, five digits.
    let text = Beam {
        line_type: rectangle(0.008, 0.006, 2e11, 0.3, "")
            .replace("density = 1\n", "density = 7800\n")
            + "normal_drag = 0\naxial_drag = 0\nnormal_added_mass = 0",
        fluid: 7800.0,
        length: 1.5,
        elements: 20,
        natural: String::new(),
        tip_weight: 0.0,
        clamp: "direction = [0, 0, -1], axis = [1, 0, 0]".into(),
    }
    .text()
    .replace("[anchors.wall]", "[vessels.wall]\nmotions = [\"jerk\"]")
        + r#"
        [motions.jerk]
        kind = "tow"
        legs = [
            { start = 0, ramp = 0.2, speed = 0.02, heading = "40 deg" },
            { start = 0.2, ramp = 0.2, speed = 0 },
        ]
        [dynamics]
        duration = "8 s"
        [output]
        interval = "0.001 s"
        field_interval = "8 s"
        channels = ["beam.x@1.5m", "beam.y@1.5m"]
        "#;
    let mut model = model(&text);
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.step = StepControl::Fixed(1e-3);
    }
    let run = run(&model);
    // Width along x: bending along x is stiffer.
    for (axis, expected) in [("x", 2.9084), ("y", 2.1813)] {
        let tip: Vec<f64> = run
            .since(&format!("beam.{axis}@1.5m"), 1.0)
            .iter()
            .map(|tip| tip - run.last(&format!("wall.{axis}")))
            .collect();
        let crossings: Vec<f64> = (1..tip.len())
            .filter(|&k| tip[k - 1] < 0.0 && tip[k] >= 0.0)
            .map(|k| k as f64 - tip[k] / (tip[k] - tip[k - 1]))
            .collect();
        let spans = (crossings.len() - 1) as f64;
        let frequency = spans / ((crossings[crossings.len() - 1] - crossings[0]) * 1e-3);
        // The step lowers it by (omega h)^2 / 12 and a little more: 3e-5; 20 elements by 1e-5.
        assert_near(axis, frequency, expected, 1e-4 * expected);
    }
}

/// A beam of 4 m with unlike planes between an end A to be written and an anchor, with 100 N in
/// its middle; how far that sinks.
fn middle_sinks(end_a: &str, end_b: &str, elements: usize) -> f64 {
    let text = format!(
        r#"
        environment.water = {{ density = {GENERAL_FLUID:?}, depth = "1000 m" }}
        [line_types.bar]
        {line_type}
        [anchors.wall]
        position = [0, 0, -2]
        [anchors.far]
        position = [4, 0, -2]
        [lines.beam]
        sections = [{{ type = "bar", length = 4, elements = {elements} }}]
        attachments.load = {{ at = 2, mass = {mass:?}, volume = 0 }}
        end_a = {{ to = "wall", direction = [1, 0, 0], {end_a} }}
        end_b = {{ to = "far", direction = [1, 0, 0], {end_b} }}
        "#,
        line_type = general(
            "axial_stiffness = 1e8\nbending_stiffness_y = 1e5\nbending_stiffness_z = 3e5\n\
             torsional_stiffness = 1e5"
        ),
        mass = 100.0 / common::G,
    );
    -2.0 - statics(&model(&text)).fields[0].position(elements / 2)[2]
}

#[test]
fn a_hinge_holds_the_line_with_the_plane_that_it_holds() {
    // The hinge's axis is local y. Level, it lets the line bend about y freely; upright, it clamps
    // the line, which bends about z.
    for (axis, expected) in [
        ("[0, 1, 0]", 100.0 * 64.0 / (48.0 * 1e5)),
        ("[0, 0, 1]", 7.0 * 100.0 * 64.0 / (768.0 * 3e5)),
    ] {
        let errors = [16, 32].map(|elements| {
            let end_a = format!(r#"joint = "hinge", axis = {axis}"#);
            middle_sinks(&end_a, r#"joint = "ball""#, elements) / expected - 1.0
        });
        // The load's kink in the curvature is at a node, where the trapezoidal rule leaves
        // l^2 / 12 of it; the hinge holds without the shift. Both are of second order.
        assert!(errors[1].abs() < 0.01, "{axis}: {errors:?}");
        assert!(orders(&errors.map(f64::abs))[0] > 1.8, "{axis}: {errors:?}");
    }
}

#[test]
fn a_flex_joint_holds_the_line_in_both_planes() {
    // Clamped at B; at A the spring k: 4 EI / L + k turns by P L / 8, and the middle sinks by
    // P L^3 / 192 EI + turn L / 8.
    for (axis, stiffness) in [("[0, 1, 0]", 1e5f64), ("[0, 0, 1]", 3e5)] {
        let turn = 100.0 * 4.0 / 8.0 / (4.0 * stiffness / 4.0 + 2e5);
        let expected = 100.0 * 64.0 / (192.0 * stiffness) + turn * 4.0 / 8.0;
        let errors = [16, 32].map(|elements| {
            let end_b = format!(r#"joint = "fixed", axis = {axis}"#);
            middle_sinks(r#"rotational_stiffness = 2e5"#, &end_b, elements) / expected - 1.0
        });
        // As at the hinge.
        assert!(errors[1].abs() < 0.01, "{axis}: {errors:?}");
        assert!(orders(&errors.map(f64::abs))[0] > 1.8, "{axis}: {errors:?}");
    }
}

#[test]
fn natural_curvature_and_twist_make_a_helix() {
    // A curve with curvature k and torsion t is a helix of radius k / (k^2 + t^2). Local axes that
    // turn with the twist see the curvature in a fixed direction.
    let (curvature, twist) = (0.8f64, 0.5f64);
    let total = (curvature * curvature + twist * twist).sqrt();
    let (radius, climb) = (curvature / total.powi(2), twist / total);
    let length = 2.0 * 2.0 * PI / total;
    let errors = [32, 64, 128].map(|elements| {
        let statics = Beam {
            line_type: general("axial_stiffness = 1e6\nbending_stiffness = 1e4"),
            fluid: GENERAL_FLUID,
            length,
            elements,
            natural: format!(", natural_curvature_z = {curvature}, natural_twist = {twist}"),
            tip_weight: 0.0,
            clamp: "direction = [1, 0, 0], axis = [0, 1, 0]".into(),
        }
        .solve();
        // Darboux: the axis is along twist x + curvature z, the radius along y.
        let axis = [twist / total, 0.0, curvature / total];
        let fields = &statics.fields[0];
        let mut worst = 0.0f64;
        for (node, s) in statics.arc_length[0].iter().enumerate() {
            let [x, y, z] = fields.position(node);
            let angle = total * s;
            let forward = radius * angle.sin() * curvature / total;
            let expected = [
                axis[0] * climb * s + forward,
                radius * (1.0 - angle.cos()),
                axis[2] * climb * s - radius * angle.sin() * twist / total - 100.0,
            ];
            worst = worst.max(distance([x, y, z], expected));
        }
        assert_near(
            "curvature",
            fields.get(LineQuantity::Curvature)[5],
            curvature,
            1e-9,
        );
        assert!(
            fields
                .get(LineQuantity::BendMoment)
                .iter()
                .all(|m| m.abs() < 1e-3)
        );
        worst
    });
    assert!(
        orders(&errors).iter().all(|&order| order > 1.9),
        "{errors:?}"
    );
}

#[test]
fn a_straight_beam_bent_to_a_full_circle() {
    // The arc from which statics starts runs along -x first. Both ends held at one place in one direction: a ring with the moment 2 pi EI / L and no force.
    let (length, bending) = (10.0, 1e4);
    let errors = [16, 32, 64].map(|elements| {
        let beam = Beam {
            line_type: general(&format!(
                "axial_stiffness = 1e7\nbending_stiffness = {bending}"
            )),
            fluid: GENERAL_FLUID,
            length,
            elements,
            natural: String::new(),
            tip_weight: 0.0,
            clamp: "direction = [-1, 0, 0]".into(),
        };
        let end = "end_b = { to = \"wall\", joint = \"fixed\", direction = [-1, 0, 0] }";
        let statics = statics(&model(&(beam.text() + end)));
        let fields = &statics.fields[0];
        let moment = 2.0 * PI * bending / length;
        let moments = fields.get(LineQuantity::BendMoment).iter();
        let of_moment = moments
            .map(|m| (m / moment - 1.0).abs())
            .fold(0.0, f64::max);
        let across = distance(fields.position(0), fields.position(elements / 2));
        [of_moment, (across / (length / PI) - 1.0).abs()]
    });
    for errors in [0, 1].map(|k| errors.map(|of| of[k])) {
        assert!(
            orders(&errors).iter().all(|&order| order > 1.9),
            "{errors:?}"
        );
    }
}

#[test]
fn a_ring_that_is_unrolled_bears_the_moment_of_its_curvature() {
    let (length, bending) = (10.0, 1e4);
    let curvature = 2.0 * PI / length;
    // Held straight, with a pull that keeps it from winding out of its plane.
    let beam = Beam {
        line_type: general(&format!(
            "axial_stiffness = 1e6\nbending_stiffness = {bending}"
        )),
        fluid: GENERAL_FLUID,
        length,
        elements: 20,
        natural: format!(", natural_curvature_y = {curvature}"),
        tip_weight: 0.0,
        clamp: "direction = [1, 0, 0], axis = [0, 1, 0]".into(),
    };
    let text = beam.text()
        + "end_b = { to = \"far\", joint = \"fixed\", direction = [1, 0, 0] }\n\
           [anchors.far]\nposition = [10.2, 0, -100]";
    let statics = statics(&model(&text));
    let fields = &statics.fields[0];
    let moment = bending * curvature;
    for node in 0..=20 {
        assert_near(
            "moment",
            fields.get(LineQuantity::BendMoment)[node],
            moment,
            1e-6 * moment,
        );
        assert_near(
            "curvature",
            fields.get(LineQuantity::Curvature)[node],
            0.0,
            1e-6,
        );
        assert_near(
            "tension",
            fields.get(LineQuantity::EffectiveTension)[node],
            2e4,
            0.1,
        );
        assert_near("height", fields.position(node)[2], -100.0, 1e-6);
    }
    assert_near(
        "moment on the wall",
        statics.get("beam.end_a.moment_y").abs(),
        moment,
        1e-5 * moment,
    );
}

#[test]
fn an_end_moment_bends_a_straight_beam_to_a_full_circle() {
    // M = 2 pi EI / L closes the beam: every section turns by 2 pi s / L, and the end comes back.
    let (length, bending) = (10.0, 1e4);
    let errors = [20, 40, 80].map(|elements| {
        let beam = Beam {
            line_type: general(&format!(
                "axial_stiffness = 1e7\nbending_stiffness = {bending}"
            )),
            fluid: GENERAL_FLUID,
            length,
            elements,
            natural: String::new(),
            tip_weight: 0.0,
            clamp: "direction = [1, 0, 0]".into(),
        };
        let load = format!(
            "[loads.end]\non = \"beam\"\nat = {length:?}\nmoment = [0, {:?}, 0]",
            -2.0 * PI * bending / length
        );
        let statics = statics(&model(&(beam.text() + &load)));
        let fields = &statics.fields[0];
        let moment = 2.0 * PI * bending / length;
        for found in &fields.get(LineQuantity::BendMoment)[..elements] {
            // The wall lies 100 m deep: round-off in positions leaves 1e-3 N, over 10 m.
            assert_near("moment", *found, moment, 1e-5 * moment);
        }
        // A quarter of the way the beam is a radius from the wall along x and z.
        let radius = length / (2.0 * PI);
        let quarter = distance(fields.position(elements / 4), [radius, 0.0, radius - 100.0]);
        let closed = distance(fields.position(elements), [0.0, 0.0, -100.0]);
        quarter.max(closed)
    });
    assert!(
        orders(&errors).iter().all(|&order| order > 1.9),
        "{errors:?}"
    );
}
