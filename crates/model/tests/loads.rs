//! Point loads, systems in air or space, start shapes and sliding ends: what is read, and how bad
//! input is answered.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use catenix_model::file::{ModelFileErrors, parse_study};
use catenix_model::{LineEnd, LoadPlace, LoadVariation, Study};

/// A system in space with a load of each kind.
const GOOD: &str = r#"
environment.gravity = 0
[line_types.beam]
kind = "general"
outer_diameter = "0.1 m"
mass = "1 kg/m"
axial_stiffness = "10 kN"
shear_stiffness = "10 kN"
polar_inertia = "20 kg m"
[anchors.wall]
position = [0, 0, 0]
[bodies.tip]
mass = "2 kg"
initial_position = ["9 m", 0, 0]
[lines.beam]
sections = [{ type = "beam", length = "10 m", elements = 10 }]
start_shape = [[0, 0, 0], ["4 m", "3 m", 0], ["8 m", 0, 0]]
end_a = { to = "wall", joint = "fixed", slides_along = [0, 3, 4] }
end_b = { to = "tip" }
[loads.push]
on = "beam"
at = "5 m"
force = ["8 N", 0, 0]
factor = [{ time = 0, factor = 0 }, { time = "2.5 s", factor = 1 }]
[loads.swing]
on = "tip"
point = [0, "1 m", 0]
moment = [0, 0, "80 N m"]
follows = true
harmonic = { period = "4 s", phase = "90 deg" }
[path]
loads = ["push"]
range = [0, 9]
at = [5, 1]
stop = { channel = "tip.z", range = ["-2 m", "1 m"] }
"#;

fn read(text: &str) -> Result<Study, ModelFileErrors> {
    parse_study(text, "model.toml", Path::new("/nonexistent"))
}

#[test]
fn a_system_in_space_is_read() {
    let model = read(GOOD).unwrap().cases.remove(0).model;
    assert_eq!(model.environment.water, None);
    assert_eq!(model.environment.gravity, 0.0);
    assert_eq!(model.environment.fluid_density(), 0.0);
    assert_eq!(model.bodies[0].volume, 0.0);
    assert_eq!(model.line_types[0].rotary_inertia, [10.0; 2]);
    assert_eq!(
        model.lines[0].start_shape,
        [[0.0, 0.0, 0.0], [4.0, 3.0, 0.0], [8.0, 0.0, 0.0]]
    );
    let [LineEnd::Connected(wall), LineEnd::Connected(tip)] = &model.lines[0].ends else {
        panic!()
    };
    assert_eq!(wall.slides_along, Some([0.0, 0.6, 0.8]));
    assert_eq!(tip.slides_along, None);
    let [push, swing] = model.loads.as_slice() else {
        panic!()
    };
    assert_eq!(
        push.place,
        LoadPlace::Line {
            line: 0,
            arc_length: 5.0
        }
    );
    assert_eq!((push.force, push.moment), ([8.0, 0.0, 0.0], [0.0; 3]));
    assert_eq!(
        push.variation,
        LoadVariation::Table(vec![(0.0, 0.0), (2.5, 1.0)])
    );
    assert_eq!(
        swing.place,
        LoadPlace::Body {
            body: 0,
            point_local: [0.0, 1.0, 0.0]
        }
    );
    assert!(swing.follows && !push.follows);
    assert_eq!(
        swing.variation,
        LoadVariation::Harmonic {
            angular_frequency: TAU / 4.0,
            phase: TAU / 4.0,
            ramp: 0.0
        }
    );
}

#[test]
fn a_path_is_read() {
    let model = read(GOOD).unwrap().cases.remove(0).model;
    let path = model.path.unwrap();
    assert_eq!(path.loads, [0]);
    assert_eq!((path.start, path.range), (0.0, [0.0, 9.0]));
    assert_eq!(path.at, [1.0, 5.0]);
    assert_eq!(path.max_points, 200);
    let stop = path.stop.unwrap();
    assert_eq!(
        (stop.channel.name.as_str(), stop.range),
        ("tip.z", [-2.0, 1.0])
    );
    let all = GOOD.replace("loads = [\"push\"]\n", "");
    let model = read(&all).unwrap().cases.remove(0).model;
    assert_eq!(model.path.unwrap().loads, [0, 1]);
}

#[test]
fn load_cases_lay_over_loads() {
    let text = format!(
        "{GOOD}\n[cases.base]\n[cases.more]\nloads.push.force = [0, \"9 N\", 0]\n\
         loads.extra = {{ on = \"tip\", force = [1, 2, 3] }}\n"
    );
    let cases = read(&text).unwrap().cases;
    assert_eq!(cases[0].model.loads.len(), 2);
    let more = &cases[1].model.loads;
    assert_eq!(more[0].force, [0.0, 9.0, 0.0]);
    assert_eq!(more[0].variation, cases[0].model.loads[0].variation);
    assert_eq!(more[2].force, [1.0, 2.0, 3.0]);
    assert_eq!(more[2].variation, LoadVariation::Constant);
}

#[test]
fn a_body_that_nothing_holds_may_fly() {
    let text = GOOD.replace(
        "end_a = { to = \"wall\", joint = \"fixed\", slides_along = [0, 3, 4] }",
        "",
    );
    let errors = read(&text).unwrap_err();
    assert!(errors.diagnostics[0].message.contains("nothing holds"));
    read(&format!("{text}[statics]\nequilibrium = false\n")).unwrap();
}

#[test]
fn each_kind_of_bad_input() {
    let replacements = [
        ("nothing to load", "on = \"beam\"", "on = \"bean\""),
        ("a load on an anchor", "on = \"beam\"", "on = \"wall\""),
        ("no place on a line", "at = \"5 m\"\n", ""),
        (
            "a point on a line",
            "at = \"5 m\"\n",
            "at = \"5 m\"\npoint = [0, 0, 0]\n",
        ),
        ("beyond the line", "at = \"5 m\"\n", "at = \"10.1 m\"\n"),
        (
            "a length along a body",
            "point = [0, \"1 m\", 0]",
            "at = \"1 m\"",
        ),
        ("neither force nor moment", "force = [\"8 N\", 0, 0]\n", ""),
        ("a force in metres", "\"8 N\"", "\"8 m\""),
        ("a moment in newtons", "\"80 N m\"", "\"80 N\""),
        (
            "times that decrease",
            "time = \"2.5 s\"",
            "time = \"-2.5 s\"",
        ),
        (
            "times out of order",
            "{ time = \"2.5 s\", factor = 1 }",
            "{ time = \"2.5 s\", factor = 1 }, { time = 1, factor = 1 }",
        ),
        (
            "no factors",
            "factor = [{ time = 0, factor = 0 }, { time = \"2.5 s\", factor = 1 }]",
            "factor = []",
        ),
        (
            "two variations",
            "follows = true",
            "factor = [{ time = 0, factor = 0 }]",
        ),
        ("no frequency", "period = \"4 s\", ", ""),
        (
            "two frequencies",
            "period = \"4 s\"",
            "period = \"4 s\", angular_frequency = \"2 rad/s\"",
        ),
        (
            "a frequency in metres",
            "period = \"4 s\"",
            "angular_frequency = \"2 m\"",
        ),
        (
            "one point of a shape",
            "[[0, 0, 0], [\"4 m\", \"3 m\", 0], [\"8 m\", 0, 0]]",
            "[[0, 0, 0]]",
        ),
        (
            "no point of a shape",
            "[[0, 0, 0], [\"4 m\", \"3 m\", 0], [\"8 m\", 0, 0]]",
            "[]",
        ),
        ("points alike", "[\"4 m\", \"3 m\", 0]", "[0, 0, 0]"),
        ("a slide without direction", "[0, 3, 4]", "[0, 0, 0]"),
        (
            "a seabed without water",
            "environment.gravity = 0",
            "environment.gravity = 0\nenvironment.seabed = {}",
        ),
        (
            "a current without water",
            "environment.gravity = 0",
            "environment.current.profile = [{ depth = 0, speed = 1 }]",
        ),
        (
            "lift without water",
            "mass = \"2 kg\"",
            "mass = \"2 kg\"\nnet_lift = \"5 N\"",
        ),
        (
            "weight in water without gravity",
            "environment.gravity = 0",
            "environment = { gravity = 0, water.depth = 9 }\ncases.a.bodies.tip.wet_weight = 3",
        ),
        (
            "a path without its load",
            "loads = [\"push\"]",
            "loads = [\"pull\"]",
        ),
        ("a path without loads", "loads = [\"push\"]", "loads = []"),
        ("a path without range", "range = [0, 9]\n", ""),
        ("a range upside down", "range = [0, 9]", "range = [9, 0]"),
        ("a start outside", "range = [0, 9]", "range = [1, 9]"),
        ("a factor outside", "at = [5, 1]", "at = [5, 10]"),
        ("a first step too long", "at = [5, 1]", "first_step = 0.2"),
        ("a stop in newtons", "\"-2 m\"", "\"-2 N\""),
        ("a stop upside down", "\"-2 m\"", "\"2 m\""),
        ("a stop by nothing", "\"tip.z\"", "\"tip.w\""),
        (
            "negative gravity",
            "environment.gravity = 0",
            "environment.gravity = -1",
        ),
    ];
    let mut reports = String::new();
    for (name, from, to) in replacements {
        assert!(GOOD.contains(from), "{from}");
        let errors = read(&GOOD.replacen(from, to, 1)).expect_err(name);
        writeln!(reports, "== {name} ==").unwrap();
        for error in &errors.diagnostics {
            let (code, line, column) = (error.code.as_str(), error.line, error.column);
            writeln!(reports, "{line}:{column} [{code}] {}", error.message).unwrap();
            for line in error.help.iter().flat_map(|help| help.lines()) {
                writeln!(reports, "    {line}").unwrap();
            }
        }
    }
    insta::assert_snapshot!(reports);
}
