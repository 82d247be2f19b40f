//! A small model, and how to run the command on it.
#![allow(dead_code)]
// A panic is how a test fails, and this module is nothing but tests.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A pipe of ten elements with a pump at its end, all of it below the surface: a fifth of a
/// second.
const MODEL: &str = r#"
title = "Hanging pipe"
note = "A test."

[environment.water]
density = "1025 kg/m^3"
depth = "200 m"

[environment.current]
heading = "0 deg"
profile = [{ depth = "0 m", speed = "0.5 m/s" }]

[line_types.pipe]
kind = "pipe"
outer_diameter = "0.219 m"
inner_diameter = "0.179 m"
density = "7850 kg/m^3"
youngs_modulus = "206 GPa"
poisson_ratio = 0.3
content_density = "1025 kg/m^3"
normal_drag = 1.2
axial_drag = 0.02
normal_added_mass = 1.0
axial_added_mass = 0.0

[motions.heave]
kind = "harmonic"
degree = "heave"
amplitude = "1 m"
period = "8 s"
ramp = "8 s"

[vessels.ship]
position = ["0 m", "0 m", "-5 m"]
motions = ["heave"]

[bodies.pump]
mass = "2 t"
wet_weight = "15 kN"
length = "2 m"
drag_area = "1 m^2"
normal_added_mass = "1 t"
axial_added_mass = "0 t"

[lines.pipe]
sections = [{ type = "pipe", length = "100 m", elements = 10 }]
end_a = { to = "ship", joint = "ball" }
end_b = { to = "pump", joint = "fixed", at = ["0 m", "0 m", "1 m"] }

[statics]
current = false

[dynamics]
duration = "16 s"
step = "0.1 s"
statistics_window = "8 s"

[output]
interval = "0.1 s"
field_interval = "1 s"

[figures.offset]
title = "Offset of the pump"
channel = "pump.offset_x"

[cases.one]
description = "as it is"
references = [
    { channel = "pump.offset_x", value = "1 m", source = "nobody" },
    { channel = "pipe.end_a.force_z", statistic = "max", range = ["-100 kN", "-50 kN"], source = "elsewhere" },
]
"#;

/// A directory with the model, plus what `more` adds to it.
pub struct Bench {
    directory: tempfile::TempDir,
}

impl Bench {
    /// Writes the model file.
    pub fn new(more: &str) -> Self {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(
            directory.path().join("model.toml"),
            format!("{MODEL}{more}"),
        )
        .unwrap();
        Bench { directory }
    }

    /// Path inside the directory.
    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// The command with its arguments, to be run in the directory.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_catenix"));
        command.args(arguments).current_dir(self.directory.path());
        command
    }

    /// Runs the command: exit code, standard output, standard error.
    pub fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        let Output {
            status,
            stdout,
            stderr,
        } = self.command(arguments).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (status.code().unwrap(), text(stdout), text(stderr))
    }

    /// Runs the command with `--json`: exit code and document.
    pub fn json(&self, arguments: &[&str]) -> (i32, Value) {
        let mut arguments = arguments.to_vec();
        arguments.push("--json");
        let (code, stdout, _) = self.run(&arguments);
        let document: Value = serde_json::from_str(&stdout)
            .unwrap_or_else(|error| panic!("{error} in the output of {arguments:?}:\n{stdout}"));
        assert_eq!(document["exit_code"], code);
        (code, document)
    }
}

/// All keys of a document, as paths with `*` for names that the user chose.
pub fn key_paths(value: &Value, path: &str, keys: &mut Vec<String>) {
    const NAMED: [&str; 4] = ["cases", "bodies", "lines", "vessels"];
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let last = path.rsplit('.').next().unwrap_or_default();
                let key = if NAMED.contains(&last) {
                    "*"
                } else {
                    key.as_str()
                };
                let path = if path.is_empty() {
                    key.to_owned()
                } else {
                    format!("{path}.{key}")
                };
                keys.push(path.clone());
                key_paths(value, &path, keys);
            }
        }
        Value::Array(values) => {
            for value in values.iter().filter(|value| value.is_object()) {
                key_paths(value, &format!("{path}[]"), keys);
            }
        }
        _ => {}
    }
    keys.sort();
    keys.dedup();
}

/// Text of a file of the repository.
pub fn repository_file(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
