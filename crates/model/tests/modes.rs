//! The `[modes]` table: what it means, and what is said where it is wrong.
// A panic is how a test fails, and this file is nothing but tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use catenix_model::file::parse_study;
use catenix_model::{ModeRange, ModeSettings};

const LINE: &str = r#"
    environment.water.depth = "100 m"
    anchors.top.position = [0, 0, -10]
    [line_types.rope]
    kind = "general"
    outer_diameter = "0.1 m"
    mass = "10 kg/m"
    axial_stiffness = "10 MN"
    [lines.rope]
    sections = [{ type = "rope", length = "20 m", elements = 4 }]
    end_a.to = "top"
"#;

/// Settings of a model with this `[modes]` table, or the first error: message and remedy.
fn settings(keys: &str) -> Result<ModeSettings, (String, String)> {
    let text = format!("{LINE}\n[modes]\n{keys}");
    match parse_study(&text, "test.toml", Path::new("")) {
        Ok(mut study) => Ok(study.cases.remove(0).model.modes),
        Err(errors) => {
            let error = &errors.diagnostics[0];
            assert_eq!(errors.diagnostics.len(), 1, "{errors:?}");
            Err((
                error.message.clone(),
                error.help.clone().unwrap_or_default(),
            ))
        }
    }
}

#[test]
fn a_count_a_band_or_ten() {
    let all = |range, added_mass| Ok(ModeSettings { range, added_mass });
    let band = |from_hz, to_hz| ModeRange::Band { from_hz, to_hz };
    assert_eq!(settings(""), all(ModeRange::Lowest(10), true));
    assert_eq!(settings("count = 3"), all(ModeRange::Lowest(3), true));
    assert!(!settings("added_mass = false").unwrap().added_mass);
    assert_eq!(
        settings("from = \"0.1 Hz\"\nto = \"2 Hz\""),
        all(band(0.1, 2.0), true)
    );
    assert_eq!(settings("to = \"60 min^-1\""), all(band(0.0, 1.0), true));
}

#[test]
fn each_mistake_has_its_remedy() {
    for (keys, message, help) in [
        (
            "from = \"2 Hz\"\nto = \"0.1 Hz\"",
            "ends at 0.1 Hz",
            "`to` above `from`",
        ),
        ("from = \"2 Hz\"", "needs its upper end", "to = \"2 Hz\""),
        (
            "count = 3\nto = \"1 Hz\"",
            "no meaning beside a band",
            "keep `count`",
        ),
        ("to = \"10 s\"", "must be a frequency", "0.5 Hz"),
        ("count = 0", "at least 1", "positive"),
        ("number = 3", "unknown key", "`count`"),
    ] {
        let (said, remedy) = settings(keys).unwrap_err();
        assert!(said.contains(message), "{keys}: {said}");
        assert!(remedy.contains(help), "{keys}: {remedy}");
    }
}
