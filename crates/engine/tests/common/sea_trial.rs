//! The sea trial in two formulations.

use catenix_model::FormulationKind;

use super::{Run, model_of_case, run};

/// The example's model file.
pub const SEA_TRIAL: &str = include_str!("../../../../examples/sea-trial-1km.toml");
const HOSE: &str = r#"sections = [{ type = "hose", length = "400 m", elements = 200 }]"#;

/// The hose graded towards the buffer, the floats and the miner: elements of 0.4 m there and of
/// 2 m between.
pub fn graded() -> String {
    let section = |length: f64| {
        format!(
            r#"{{ type = "hose", length = {length}, element_length = 2, element_length_a = 0.4, element_length_b = 0.4 }}"#
        )
    };
    let sections = [132.0, 132.0, 136.0].map(section).join(", ");
    assert!(SEA_TRIAL.contains(HOSE));
    SEA_TRIAL.replace(HOSE, &format!("sections = [{sections}]"))
}

/// Offset of the buffer [m], force on the miner (3) [N], tension of the hose there [N], smallest
/// and largest tension at the ship [N].
pub struct Figures {
    pub offset: f64,
    pub force: [f64; 3],
    pub hose_tension: f64,
    pub top: (f64, f64),
}

impl Figures {
    fn read(run: &Run) -> Figures {
        let last = run.time[run.time.len() - 1] - 8.0 + 0.01;
        let mean = |channel: &str| run.mean_since(channel, last);
        Figures {
            offset: mean("buffer.offset_x"),
            force: ["x", "y", "z"].map(|axis| mean(&format!("hose.end_b.force_{axis}"))),
            hose_tension: mean("hose.end_b.effective_tension"),
            top: run.range_since("lift_pipe.end_a.effective_tension", 0.0),
        }
    }
}

/// Two formulations on one text and case: discrete elements first.
pub fn both(text: &str, case: &str, other: FormulationKind) -> [Figures; 2] {
    [FormulationKind::Dem, other].map(|formulation| {
        let mut model = model_of_case(text, case);
        model.formulation = formulation;
        let run = run(&model);
        run.assert_sound(if case == "a" { 320.0 } else { 160.0 }, 1e-3);
        Figures::read(&run)
    })
}

/// Asserts that another formulation is within shares of discrete elements: of the offset, of the range of
/// the top tension, and of the hose's tension in each component of the force on the miner.
pub fn assert_close(what: &str, [dem, other]: &[Figures; 2], offset: f64, top: f64, force: f64) {
    let error = (other.offset / dem.offset - 1.0).abs();
    let range = |figures: &Figures| figures.top.1 - figures.top.0;
    let error_top = (range(other) / range(dem) - 1.0).abs();
    assert!(error < offset, "{what}: offset off by {error}");
    assert!(
        error_top < top,
        "{what}: range of the top tension off by {error_top}"
    );
    for (axis, (a, b)) in dem.force.iter().zip(&other.force).enumerate() {
        let error = (a - b).abs() / dem.hose_tension;
        assert!(
            error < force,
            "{what}: force {axis} off by {error} of the tension"
        );
    }
}
