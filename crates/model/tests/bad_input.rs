//! Bad input: every error has its place, says what is wrong, and what to write instead.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::Path;

use catenix_model::file::{DiagnosticCode, MOST_BYTES, ModelFileErrors, parse_study, read_study};

/// A good model that the tests spoil.
const GOOD: &str = r#"
[environment]
water.depth = "100 m"

[line_types.rope]
kind = "general"
outer_diameter = "0.1 m"
inner_diameter = "0.05 m"
mass = "10 kg/m"
axial_stiffness = "10 MN"

[line_types.steel]
kind = "pipe"
outer_diameter = "0.2 m"
inner_diameter = "0.18 m"

[motions.tow]
kind = "tow"
speed = "1 m/s"
ramp = "2 s"

[motions.heave]
kind = "harmonic"
degree = "heave"
amplitude = "1 m"
period = "8 s"

[vessels.ship]
position = [0, 0, 0]
motions = ["tow", "heave"]

[anchors.anchor]
position = ["50 m", 0, "-90 m"]

[bodies.buoy]
mass = "1 t"
volume = "2 m^3"

[lines.upper]
sections = [{ type = "rope", length = "60 m", elements = 6 }]
end_a = { to = "ship" }
end_b = { to = "buoy" }

[lines.lower]
sections = [{ type = "rope", length = "60 m", elements = 6 }]
attachments.float = { at = "30 m", mass = "10 kg", net_lift = "1 kN" }
end_a = { to = "buoy" }
end_b = { to = "anchor" }

[dynamics]
duration = "10 s"

[figures.tension]
channel = "upper.end_a.effective_tension"
"#;

fn check(text: &str) -> Result<(), ModelFileErrors> {
    parse_study(text, "model.toml", Path::new("/nonexistent")).map(|_| ())
}

/// What a plain-text front end would print.
fn report(errors: &ModelFileErrors) -> String {
    let mut text = String::new();
    for error in &errors.diagnostics {
        let code = error.code.as_str();
        writeln!(
            text,
            "{}:{} [{code}] {}",
            error.line, error.column, error.message
        )
        .unwrap();
        for line in error.help.iter().flat_map(|help| help.lines()) {
            writeln!(text, "    {line}").unwrap();
        }
    }
    text
}

/// The good model with one passage replaced.
fn spoilt(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    GOOD.replacen(from, to, 1)
}

#[test]
fn the_good_model_is_good() {
    if let Err(errors) = check(GOOD) {
        panic!("{}", report(&errors));
    }
}

#[test]
fn each_kind_of_bad_input() {
    let rope = "outer_diameter = \"0.1 m\"";
    let section = "[{ type = \"rope\", length = \"60 m\", elements = 6 }]";
    let replacements = [
        // Keys.
        ("unknown key", rope, "outer_diamter = \"0.1 m\""),
        (
            "unknown key without likeness",
            rope,
            "outer_diameter = \"0.1 m\"\nwolf = 3",
        ),
        ("unknown table", "[dynamics]", "[dynamic]"),
        (
            "unknown key in an inline table",
            "{ to = \"ship\" }",
            "{ to = \"ship\", join = \"ball\" }",
        ),
        ("missing key", rope, ""),
        (
            "missing section",
            "[environment]\nwater.depth = \"100 m\"",
            "",
        ),
        ("missing kind", "kind = \"tow\"", ""),
        ("unknown kind", "kind = \"tow\"", "kind = \"two\""),
        (
            "duplicate key",
            rope,
            "outer_diameter = \"0.1 m\"\nouter_diameter = \"0.2 m\"",
        ),
        ("duplicate table", "[line_types.steel]", "[line_types.rope]"),
        ("syntax", rope, "outer_diameter = 0.1 m"),
        ("unclosed", rope, "outer_diameter = \"0.1 m"),
        // Numbers and units.
        ("wrong unit", rope, "outer_diameter = \"0.1 metres\""),
        ("unit in another case", "\"10 MN\"", "\"10 mn\""),
        ("wrong dimension", rope, "outer_diameter = \"0.1 kg\""),
        ("nameless dimension", rope, "outer_diameter = \"0.1 kg m\""),
        (
            "unit on a plain number",
            "mass = \"10 kg/m\"",
            "mass = \"10 kg/m\"\nnormal_drag = \"1.2 m\"",
        ),
        ("angle for a length", "\"1 m\"", "\"1 deg s\""),
        ("angle as heave", "\"1 m\"", "\"1 deg\""),
        ("no number", rope, "outer_diameter = \"thick\""),
        ("decimal comma", rope, "outer_diameter = \"0,1 m\""),
        ("a boolean", rope, "outer_diameter = true"),
        ("negative diameter", rope, "outer_diameter = \"-0.1 m\""),
        ("zero mass", "mass = \"10 kg/m\"", "mass = 0"),
        ("NaN", rope, "outer_diameter = nan"),
        ("infinity", "water.depth = \"100 m\"", "water.depth = inf"),
        ("NaN as text", rope, "outer_diameter = \"nan m\""),
        ("too large", rope, "outer_diameter = \"1e999 m\""),
        ("out of range", rope, "outer_diameter = 1e31"),
        ("a date", rope, "outer_diameter = 2020-01-01"),
        // Cross sections and lines.
        (
            "ID > OD",
            "inner_diameter = \"0.05 m\"",
            "inner_diameter = \"50 cm\"",
        ),
        ("no axial stiffness", "axial_stiffness = \"10 MN\"", ""),
        (
            "axial stiffness twice",
            "axial_stiffness = \"10 MN\"",
            "axial_stiffness = \"10 MN\"\naxial_law = [{ strain = 0.1, tension = 1 }]",
        ),
        (
            "empty axial law",
            "axial_stiffness = \"10 MN\"",
            "axial_law = []",
        ),
        (
            "slack compression",
            "axial_stiffness = \"10 MN\"",
            "axial_law = [{ strain = -0.1, tension = 0 }, { strain = 0.1, tension = \"1 MN\" }]",
        ),
        (
            "strains out of order",
            "axial_stiffness = \"10 MN\"",
            "axial_law = [{ strain = 0.1, tension = 1 }, { strain = 0.05, tension = 2 }]",
        ),
        (
            "bending stiffness thrice",
            "mass = \"10 kg/m\"",
            "mass = \"10 kg/m\"\nbending_stiffness = 1\nbending_stiffness_y = 1\n\
             bending_law = [{ curvature = 1, moment = 1 }]",
        ),
        (
            "falling moment",
            "mass = \"10 kg/m\"",
            "mass = \"10 kg/m\"\nbending_law = [{ curvature = 0.1, moment = 2 }, \
             { curvature = 0.2, moment = 2 }]",
        ),
        (
            "bending law in another dimension",
            "mass = \"10 kg/m\"",
            "mass = \"10 kg/m\"\nbending_law = [{ curvature = \"1 m\", moment = \"1 N\" }]",
        ),
        (
            "a curved chain",
            "elements = 6 }",
            "elements = 6, natural_curvature_y = 0.01 }",
        ),
        (
            "a tight coil",
            "elements = 6 }",
            "elements = 6, natural_curvature_z = 0.2, natural_twist = \"20 deg/m\" }",
        ),
        ("flat rectangle", "kind = \"pipe\"", "kind = \"rectangle\""),
        ("zero length", "length = \"60 m\"", "length = \"0 m\""),
        ("no element", "elements = 6", "elements = 0"),
        ("half an element", "elements = 6", "elements = 6.5"),
        (
            "absurd element count",
            "elements = 6",
            "elements = 60000000",
        ),
        (
            "absurd element length",
            "elements = 6",
            "element_length = \"1e-6 m\"",
        ),
        ("no element length", ", elements = 6", ""),
        (
            "two element lengths",
            "elements = 6",
            "elements = 6, element_length = \"1 m\"",
        ),
        (
            "graded count",
            "elements = 6",
            "elements = 6, element_length_a = \"1 m\"",
        ),
        ("no section", section, "[]"),
        ("sections missing", "sections = [", "section = ["),
        ("unknown line type", "type = \"rope\"", "type = \"rpoe\""),
        ("unknown end", "{ to = \"anchor\" }", "{ to = \"ancor\" }"),
        ("line to line", "{ to = \"anchor\" }", "{ to = \"upper\" }"),
        (
            "unknown joint",
            "{ to = \"ship\" }",
            "{ to = \"ship\", joint = \"balls\" }",
        ),
        (
            "axis of a ball",
            "{ to = \"ship\" }",
            "{ to = \"ship\", axis = [1, 0, 0] }",
        ),
        (
            "zero axis",
            "{ to = \"ship\" }",
            "{ to = \"ship\", joint = \"hinge\", axis = [0, 0, 0] }",
        ),
        (
            "axis along",
            "{ to = \"ship\" }",
            "{ to = \"ship\", joint = \"hinge\", axis = [0, 0, 1] }",
        ),
        (
            "stiff hinge",
            "{ to = \"ship\" }",
            "{ to = \"ship\", joint = \"hinge\", rotational_stiffness = 1 }",
        ),
        (
            "two components",
            "{ to = \"ship\" }",
            "{ to = \"ship\", at = [0, 0] }",
        ),
        ("text as end", "{ to = \"ship\" }", "\"ship\""),
        (
            "attachment beyond the end",
            "at = \"30 m\"",
            "at = \"61 m\"",
        ),
        ("attachment without volume", ", net_lift = \"1 kN\"", ""),
        (
            "attachment with two volumes",
            ", net_lift",
            ", volume = 1, net_lift",
        ),
        (
            "attachment too heavy",
            "net_lift = \"1 kN\"",
            "wet_weight = \"1 kN\"",
        ),
        // Bodies, vessels, motions.
        ("duplicate name", "[anchors.anchor]", "[anchors.ship]"),
        ("bad name", "[bodies.buoy]", "[bodies.\"bu oy\"]"),
        (
            "unknown motion",
            "motions = [\"tow\", \"heave\"]",
            "motions = [\"tow\", \"heavy\"]",
        ),
        ("tow without ramp", "ramp = \"2 s\"", ""),
        ("tow with ramp 0", "ramp = \"2 s\"", "ramp = \"0 s\""),
        ("tow without speed", "speed = \"1 m/s\"", ""),
        (
            "legs and speed",
            "speed = \"1 m/s\"",
            "speed = \"1 m/s\"\nlegs = []",
        ),
        (
            "unknown degree",
            "degree = \"heave\"",
            "degree = \"heaven\"",
        ),
        (
            "missing CSV file",
            "kind = \"tow\"\nspeed = \"1 m/s\"\nramp = \"2 s\"",
            "kind = \"history\"\nfile = \"no.csv\"",
        ),
        (
            "unknown offset vessel",
            "mass = \"1 t\"",
            "mass = \"1 t\"\noffset_from = \"shp\"",
        ),
        // The whole system.
        (
            "too far apart",
            "end_a = { to = \"buoy\" }",
            "end_a = { to = \"ship\" }",
        ),
        (
            "chain too short",
            "[\"50 m\", 0, \"-90 m\"]",
            "[\"150 m\", 0, \"-90 m\"]",
        ),
        (
            "nothing holds",
            "end_a = { to = \"ship\" }\nend_b = { to = \"buoy\" }",
            "",
        ),
        (
            "body without line",
            "[lines.upper]",
            "[bodies.lost]\nmass = 1\nvolume = 1\n[lines.upper]",
        ),
        (
            "below the seabed",
            "water.depth = \"100 m\"",
            "water.depth = \"80 m\"\nseabed = {}",
        ),
        (
            "end below the seabed",
            "{ to = \"anchor\" }\n",
            "{ to = \"anchor\", at = [0, 0, \"-11 m\"] }\n[environment.seabed]\n",
        ),
        // Analyses and output.
        ("zero duration", "duration = \"10 s\"", "duration = \"0 s\""),
        (
            "step and accuracy",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nstep = 0.1\naccuracy = 1e-3",
        ),
        (
            "steps crossed",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nmin_step = 1",
        ),
        (
            "window too long",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nstatistics_window = \"11 s\"",
        ),
        (
            "spectral radius",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nspectral_radius = 1.2",
        ),
        (
            "unknown integrator",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nintegrator = \"gear\"",
        ),
        (
            "spectral radius of bdf",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nintegrator = \"bdf\"\nspectral_radius = 0.8",
        ),
        (
            "order of generalised-alpha",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nmax_order = 2",
        ),
        (
            "order too high",
            "duration = \"10 s\"",
            "duration = \"10 s\"\nintegrator = \"bdf\"\nmax_order = 6",
        ),
        (
            "unknown channel object",
            "\"upper.end_a.effective_tension\"",
            "\"uper.end_a.effective_tension\"",
        ),
        (
            "unknown channel quantity",
            "\"upper.end_a.effective_tension\"",
            "\"upper.end_a.efective_tension\"",
        ),
        (
            "line quantity without place",
            "\"upper.end_a.effective_tension\"",
            "\"upper.bend_moment\"",
        ),
        (
            "place beyond the line",
            "\"upper.end_a.effective_tension\"",
            "\"upper.bend_moment@61 m\"",
        ),
        (
            "no place",
            "\"upper.end_a.effective_tension\"",
            "\"upper.bend_moment@61 kg\"",
        ),
        (
            "no channel",
            "\"upper.end_a.effective_tension\"",
            "\"tension\"",
        ),
        (
            "references",
            "[figures.tension]",
            "[cases.a]
references = [
    { channel = \"buoy.x\", value = \"3 N\", source = \"\" },
    { channel = \"buoy.x\", range = [\"3 m\", \"4 s\"], source = \"\" },
    { channel = \"buoy.x\", range = [\"-22.6 m\", \"-22.9 m\"], source = \"\" },
    { channel = \"buoy.x\", value = \"3 m\", range = [\"3 m\", \"4 m\"], source = \"\" },
    { channel = \"buoy.x\", source = \"\" },
]
[figures.tension]",
        ),
        (
            "statistic and length of a range",
            "[figures.tension]",
            "[cases.a]
references = [
    { channel = \"buoy.x\", statistic = \"maximum\", value = \"3 m\", source = \"\" },
    { channel = \"buoy.x\", range = [\"3 m\"], source = \"\" },
    { channel = \"buoy.x\", range = \"3 m\", source = \"\" },
]
[figures.tension]",
        ),
        (
            "unknown key of a case",
            "[figures.tension]",
            "[cases.a]\ntitle = \"a\"\n[figures.tension]",
        ),
    ];
    let mut reports = String::new();
    for (name, from, to) in replacements {
        let errors = check(&spoilt(from, to)).expect_err(name);
        writeln!(reports, "== {name} ==\n{}", report(&errors)).unwrap();
    }
    insta::assert_snapshot!(reports);
}

#[test]
fn several_errors_are_reported_together() {
    let text = spoilt("outer_diameter = \"0.1 m\"", "outer_diamter = \"0.1 m\"")
        .replace("axial_stiffness = \"10 MN\"", "axial_stiffness = \"10 kg\"")
        .replace("to = \"anchor\"", "to = \"ancor\"")
        .replace("mass = \"1 t\"", "mass = \"-1 t\"")
        .replace("duration = \"10 s\"", "duration = nan");
    let errors = check(&text).unwrap_err();
    let codes: Vec<DiagnosticCode> = errors.diagnostics.iter().map(|error| error.code).collect();
    use DiagnosticCode::*;
    assert_eq!(
        codes,
        [UnknownKey, Dimension, Value, UnknownName, Number],
        "{}",
        report(&errors)
    );
}

#[test]
fn an_error_of_a_case_points_at_its_override() {
    let text = format!(
        "{GOOD}\n[cases.good]\n[cases.bad]\nmotions.tow.speed = \"1 kg\"\n[cases.worse]\nbodies.buoy.mass = 0\n"
    );
    let errors = check(&text).unwrap_err();
    let [bad, worse] = errors.diagnostics.as_slice() else {
        panic!("{}", report(&errors))
    };
    assert!(bad.message.ends_with("(case bad)"), "{}", bad.message);
    assert_eq!(&text[bad.span.clone()], "\"1 kg\"");
    assert!(worse.message.ends_with("(case worse)"), "{}", worse.message);
    assert_eq!(&text[worse.span.clone()], "0");
}

#[test]
fn an_error_of_the_base_is_reported_once() {
    let text = spoilt("mass = \"1 t\"", "mass = \"1 m\"") + "\n[cases.a]\n[cases.b]\n[cases.c]\n";
    let errors = check(&text).unwrap_err();
    assert_eq!(errors.diagnostics.len(), 1, "{}", report(&errors));
    assert!(!errors.diagnostics[0].message.contains("case"));
}

#[test]
fn files_that_are_no_model_files() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, contents: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, contents).unwrap();
        let errors = read_study(&path).unwrap_err();
        assert_eq!(errors.diagnostics.len(), 1);
        assert_eq!(errors.diagnostics[0].code, DiagnosticCode::File);
        errors.diagnostics[0].message.clone()
    };
    assert_eq!(message("empty", b""), "the file is empty");
    assert_eq!(
        message("comments", b"# nothing\n\n  # at all\n"),
        "the file is empty"
    );
    assert_eq!(message("bom", "\u{feff}\n".as_bytes()), "the file is empty");
    assert_eq!(
        message("binary", b"\x7fELF\x00\x01\xff"),
        "the file is not text: byte 6 is not valid UTF-8"
    );
    assert_eq!(
        message("zeros", b"a = 1\x00"),
        "the file is not text: byte 5 is zero"
    );
    let errors = read_study(folder.path()).unwrap_err();
    assert_eq!(errors.diagnostics[0].message, "this is a folder");
    let errors = read_study(&folder.path().join("none.toml")).unwrap_err();
    assert_eq!(errors.diagnostics[0].message, "there is no such file");
}

#[test]
fn a_file_of_100_mb_is_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    // A sparse file: nothing is written, and nothing must be read.
    std::fs::File::create(&path)
        .unwrap()
        .set_len(100_000_000)
        .unwrap();
    let errors = read_study(&path).unwrap_err();
    let expected = "the file has 95.4 MiB, but a model file has at most 16 MiB";
    assert_eq!(errors.diagnostics[0].message, expected);
    let text = " ".repeat(MOST_BYTES as usize + 1);
    let errors = check(&text).unwrap_err();
    assert_eq!(errors.diagnostics[0].code, DiagnosticCode::File);
}

#[test]
fn a_bad_csv_row_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("ship.csv"),
        "time_s,heave_m\n0,0\n1,up\n2\n",
    )
    .unwrap();
    let history = "kind = \"history\"\nfile = \"ship.csv\"";
    let text = spoilt("kind = \"tow\"\nspeed = \"1 m/s\"\nramp = \"2 s\"", history);
    let errors = parse_study(&text, "model.toml", folder.path()).unwrap_err();
    let report = report(&errors);
    assert_eq!(errors.diagnostics.len(), 2, "{report}");
    assert!(report.contains("ship.csv: line 3, column 2 (heave_m): `up` is not a finite number"));
    assert!(report.contains("ship.csv: line 4: 1 values, but there are 2 columns"));
    assert_eq!(&text[errors.diagnostics[0].span.clone()], "\"ship.csv\"");
}

#[test]
fn errors_serialise_and_draw() {
    let text = spoilt("outer_diameter = \"0.1 m\"", "outer_diamter = \"0.1 m\"")
        .replace("mass = \"1 t\"", "mass = \"1 m\"");
    let errors = check(&text).unwrap_err();
    insta::assert_snapshot!(serde_json::to_string_pretty(&errors).unwrap());
    let theme = miette::GraphicalTheme::unicode_nocolor();
    let handler = miette::GraphicalReportHandler::new_themed(theme).with_width(80);
    let mut drawing = String::new();
    handler.render_report(&mut drawing, &errors).unwrap();
    insta::assert_snapshot!(drawing);
    let mut drawing = String::new();
    handler
        .render_report(&mut drawing, &check("").unwrap_err())
        .unwrap();
    insta::assert_snapshot!(drawing);
}

#[test]
fn many_errors_are_cut_off() {
    let keys: String = (0..1000)
        .map(|index| format!("wrong_{index} = 1\n"))
        .collect();
    let errors = check(&(keys + GOOD)).unwrap_err();
    assert_eq!(errors.diagnostics.len(), 101);
    assert_eq!(
        errors.diagnostics[100].message,
        "900 more errors are not shown"
    );
}
