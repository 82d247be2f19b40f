//! Modes of whole systems: every example file, a band, and a bar on a hinge.

mod common;

use std::f64::consts::TAU;
use std::path::Path;

use catenix_engine::{ModeKind, Modes, Motion};
use catenix_model::file::read_study;
use catenix_model::{ModeRange, ModeSettings};
use common::{assert_near, lowest_modes, model, modes};

fn count(found: &Modes<'_>, kind: ModeKind) -> usize {
    found.modes.iter().filter(|mode| mode.kind == kind).count()
}

/// All modes are found by count (or `find_modes` fails), in order, balanced and with sane shapes.
#[test]
fn every_example_gives_all_of_its_modes() {
    for (file, free) in [
        // Three spins, and two bodies that may turn about the vertical.
        ("bridle.toml", 5),
        ("current-step.toml", 0),
        ("lazy-hose.toml", 1),
        ("mooring-line.toml", 1),
        ("sea-trial-1km.toml", 0),
        ("tow-reversal.toml", 1),
        ("two-hose-buffer.toml", 0),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let study = read_study(&path.join(file)).unwrap_or_else(|errors| panic!("{errors}"));
        let found = lowest_modes(&study.cases[0].model, 30);
        assert!(count(&found, ModeKind::Vibration) >= 30, "{file}");
        assert_eq!(count(&found, ModeKind::Free), free, "{file}");
        assert_eq!(count(&found, ModeKind::Unstable), 0, "{file}");
        for pair in found.modes[free..].windows(2) {
            assert!(pair[0].omega_squared <= pair[1].omega_squared, "{file}");
        }
        for mode in &found.modes[free..] {
            // Round-off of the stiff springs over the inertia of the slowest modes.
            assert!(mode.residual < 1e-3, "{file}: {:.1e}", mode.residual);
            let part = if mode.is_rotation() { 3 } else { 0 };
            let lines = 0..study.cases[0].model.lines.len();
            let bodies = 0..study.cases[0].model.bodies.len();
            let largest = lines
                .flat_map(|line| found.line_shape(mode, line))
                .chain(bodies.map(|body| found.body_shape(mode, body)))
                .map(|d| d.fixed_rows::<3>(part).norm())
                .fold(0.0, f64::max);
            assert_near("largest", largest, 1.0, 1e-12);
        }
    }
}

/// What is asked for as a band is what stands in it among the lowest.
#[test]
fn a_band_holds_what_the_lowest_modes_have_there() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bridle.toml");
    let study = read_study(&path).unwrap_or_else(|errors| panic!("{errors}"));
    let model = &study.cases[0].model;
    let all = lowest_modes(model, 40);
    let (from_hz, to_hz) = (0.06, 0.6);
    let band = modes(
        model,
        &ModeSettings {
            range: ModeRange::Band { from_hz, to_hz },
            added_mass: true,
        },
    );
    let vibrations = |found: &Modes<'_>| -> Vec<f64> {
        let all = found.modes.iter().map(|mode| mode.frequency_hz());
        all.filter(|hz| (from_hz..to_hz).contains(hz)).collect()
    };
    let (inside, want) = (vibrations(&band), vibrations(&all));
    assert_eq!(inside.len(), want.len());
    assert_eq!(inside.len(), band.proof.counted);
    assert_eq!(band.below_band, 3);
    for (found, want) in inside.iter().zip(&want) {
        assert_near("frequency", *found, *want, 1e-7);
    }
}

/// A bar on a hinge swings as a physical pendulum, in one direction only.
#[test]
fn a_bar_on_a_hinge_swings_in_one_plane() {
    let found = lowest_modes(
        &model(
            r#"
            environment.water = { density = 1e-6, depth = "100 m" }
            [line_types.bar]
            kind = "general"
            outer_diameter = "0.05 m"
            mass = 15
            axial_stiffness = "100 MN"
            bending_stiffness = "100 kN m^2"
            [anchors.top]
            position = [0, 0, -10]
            [lines.bar]
            sections = [{ type = "bar", length = "2 m", elements = 4 }]
            end_a = { to = "top", joint = "hinge", axis = [0, 1, 0], direction = [0, 0, -1] }
            "#,
        ),
        1,
    );
    let mode = &found.modes[0];
    assert_eq!(found.modes.len(), 1);
    assert_eq!(mode.motions[0].0, Motion::X);
    // omega^2 = 3 g / 2 L; the bar bends by 1e-4 of what it swings.
    let exact = (1.5 * common::G / 2.0).sqrt() / TAU;
    assert_near("frequency", mode.frequency_hz(), exact, 1e-4 * exact);
    // Three quarters of a swinging bar's mass move with a shaking of its hinge.
    let share = mode.effective_mass_kg[0] / found.total_mass_kg[0];
    assert_near("effective mass", share, 0.75, 1e-3);
}
