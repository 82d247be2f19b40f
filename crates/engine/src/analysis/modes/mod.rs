//! Natural modes: small undamped motions about the static equilibrium.
//!
//! Source: docs/theory/modes.md, eqs. (1) to (5).

mod describe;
#[cfg(test)]
mod tests;

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use catenix_model::{ModeRange, ModeSettings};
use catenix_numerics::eigen::{Count, EigenError, Eigenpair, Pencil, Spectrum, dot};
use catenix_numerics::{BlockMatrix, MotionState, Vector6};
use thiserror::Error;

use super::statics::StaticSolution;
use crate::system::{FrameOwner, System, SystemSolver};
pub use describe::Motion;
use describe::{Describer, align_equal};

/// Squared frequency below which a motion counts as free [rad2/s2]: a period of two days.
const FREE: f64 = 1e-9;
/// Relative distance of the squared frequencies of modes that count as equal.
const EQUAL: f64 = 1e-6;
/// Share of the kinetic energy in spin beyond which a mode near zero is a free spin.
const SPIN_SHARE: f64 = 0.99;
/// Coupling of modes by the unsymmetric part of the stiffness beyond which the user is told.
const UNSYMMETRIC: f64 = 0.01;
/// First guess of the highest squared frequency asked for [rad2/s2].
const GUESS: f64 = 1.0;

/// How far the search for modes is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModesProgress {
    /// Modes found so far.
    pub found: usize,
}

/// What a mode is, by its squared frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeKind {
    /// Squared frequency below zero: the equilibrium is unstable, and this motion grows.
    Unstable,
    /// Nothing resists this motion.
    Free,
    /// A vibration.
    Vibration,
}

/// One natural mode.
#[derive(Debug, Clone)]
pub struct Mode {
    /// What it is.
    pub kind: ModeKind,
    /// Squared angular frequency [rad2/s2].
    pub omega_squared: f64,
    /// Damping ratio from structural damping; NaN for a motion that grows [-].
    pub damping_ratio: f64,
    /// Mass that moves with a shaking of the whole system along x, y and z (3) [kg].
    pub effective_mass_kg: [f64; 3],
    /// Whether its frequency is that of the mode before it.
    pub equals_previous: bool,
    /// Where the motion is largest.
    pub largest_at: FrameOwner,
    /// Shares of the kinetic energy, the largest first; they add up to 1.
    pub motions: Vec<(Motion, f64)>,
    /// Largest force and moment of K x - omega^2 M x over those of omega^2 M x [-].
    pub residual: f64,
    /// Small motion of each frame, translation and rotation (frame_count): the largest translation
    /// of a node or body is 1 m, or the largest rotation 1 rad where the mode is a rotation.
    pub shape: Vec<Vector6>,
}

impl Mode {
    /// Frequency [Hz]: 0 for a free motion, NaN for one that grows.
    pub fn frequency_hz(&self) -> f64 {
        match self.kind {
            ModeKind::Unstable => f64::NAN,
            ModeKind::Free => 0.0,
            ModeKind::Vibration => self.omega_squared.sqrt() / TAU,
        }
    }

    /// Whether the shape is scaled to the largest rotation instead of the largest translation.
    pub fn is_rotation(&self) -> bool {
        matches!(self.motions[0].0, Motion::Torsion | Motion::Rotation)
    }
}

/// The proof that no mode is missing: eigenvalues counted between two squared frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// Squared frequencies between which was counted (2) [rad2/s2].
    pub between: [f64; 2],
    /// Modes counted; as many were found.
    pub counted: usize,
}

impl Proof {
    /// The frequencies between which was counted (2) [Hz]; negative where motions grow.
    pub fn between_hz(&self) -> [f64; 2] {
        self.between.map(hertz)
    }
}

/// The natural modes of a system about its equilibrium.
#[derive(Debug, Clone)]
pub struct Modes<'a> {
    solver: SystemSolver<'a>,
    state: MotionState,
    /// Motions that grow or that nothing resists, then the vibrations that were asked for, by
    /// frequency.
    pub modes: Vec<Mode>,
    /// Counts, from the lowest squared frequency to the highest that was asked for.
    pub proof: Proof,
    /// Modes below the band that was asked for.
    pub below_band: usize,
    /// Whether added mass moves along.
    pub added_mass: bool,
    /// Mass of everything that moves, for a shaking along x, y and z (3) [kg].
    pub total_mass_kg: [f64; 3],
    /// Coupling of modes by the part of the stiffness that has no potential (drag of the
    /// current), which is left out, over their own stiffness [-].
    pub unsymmetric: f64,
    /// Factorisations that it took.
    pub factorisations: usize,
    /// Remarks for the user.
    pub warnings: Vec<String>,
}

impl Modes<'_> {
    /// Scales every shape: the largest translation of a node or body is 1, or the largest rotation.
    fn normalise(&mut self) {
        let model = self.solver.system().model();
        let (lines, bodies) = (model.lines.len(), model.bodies.len());
        for index in 0..self.modes.len() {
            let mode = &self.modes[index];
            let part = if mode.is_rotation() { 3 } else { 0 };
            let size = |d: &Vector6| d.fixed_rows::<3>(part).norm();
            let along = (0..lines)
                .flat_map(|line| self.line_shape(mode, line))
                .map(|d| size(&d));
            let of_bodies = (0..bodies).map(|body| size(&self.body_shape(mode, body)));
            let largest = along.chain(of_bodies).fold(f64::MIN_POSITIVE, f64::max);
            let shape = &mut self.modes[index].shape;
            shape.iter_mut().for_each(|d| *d /= largest);
        }
    }

    /// Small motion of a line's nodes in a mode, translation and rotation, (n_elements + 1)
    /// [m, rad].
    pub fn line_shape(&self, mode: &Mode, line: usize) -> Vec<Vector6> {
        self.solver.motion_at_nodes(&self.state, &mode.shape, line)
    }

    /// Small motion of a body in a mode, translation and rotation [m, rad].
    pub fn body_shape(&self, mode: &Mode, body: usize) -> Vector6 {
        mode.shape[self.solver.system().body_frame(body)]
    }
}

/// Why no modes were found.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum ModesError {
    /// More modes than the system has.
    #[error("the system has only {available} modes, {wanted} were asked for")]
    TooMany {
        /// Modes of the system.
        available: usize,
        /// Modes asked for.
        wanted: usize,
    },
    /// The iteration and the count do not agree.
    #[error(
        "{found} modes were found between {from_hz} and {to_hz} Hz where there are {counted}; \
         round-off spoils this system: look for extreme stiffness ratios or element lengths"
    )]
    Incomplete {
        /// Lower end of the slice [Hz].
        from_hz: f64,
        /// Upper end of the slice [Hz].
        to_hz: f64,
        /// Modes by count.
        counted: usize,
        /// Modes found.
        found: usize,
    },
    /// The matrix is singular at every shift.
    #[error("the stiffness and mass matrices are singular together near {at_hz} Hz")]
    Singular {
        /// Where [Hz].
        at_hz: f64,
    },
    /// The caller stopped the search.
    #[error("stopped by the user")]
    Interrupted,
}

/// Finds natural modes about `equilibrium`.
///
/// The motion is undamped; the symmetric part of the tangent stiffness counts. A group of equal
/// frequencies is never cut, so there may be a few more modes than were asked for.
/// `progress` is called now and then and may stop the search.
///
/// # Errors
/// [`ModesError`]; fewer modes than there are is an error, never a warning.
pub fn find_modes<'a>(
    system: &'a System,
    equilibrium: &StaticSolution<'a>,
    settings: &ModeSettings,
    progress: &mut dyn FnMut(&ModesProgress) -> ControlFlow<()>,
) -> Result<Modes<'a>, ModesError> {
    let mut solver = equilibrium.solver.clone();
    let mut state = equilibrium.state.clone();
    let stiffness = solver.stiffness(&state).clone();
    let mass = solver.mass(&state, settings.added_mass);
    let mut pencil = Pencil::new(&system.topology, &stiffness, mass);
    let mut tell = |found: usize| progress(&ModesProgress { found });
    let mut spectrum = Spectrum::new(&mut pencil, &mut tell);
    let slow = [FREE, system.frequency_round_off(), system.spin_round_off()];
    let slow = slow.into_iter().fold(0.0, f64::max);
    let search = search(&mut spectrum, slow, settings.range)
        .map_err(|error| modes_error(error, settings.range))?;
    let factorisations = spectrum.factorisations;

    let mut pairs = search.pairs;
    align_equal(system, &pencil, &mut pairs, EQUAL);
    let unsymmetric = unsymmetric_coupling(system, &stiffness, &pencil, &pairs, slow);
    let describer = Describer::new(system, &state, &pencil);
    let total_mass_kg = describer.total_mass();
    let mut modes = Vec::new();
    let free = FREE.max(system.frequency_round_off());
    for pair in pairs {
        let damping = solver.structural_damping(&mut state, &pair.vector);
        let mut mode = describer.describe(pair, damping);
        let spins = (mode.motions[0].0 == Motion::Torsion && mode.motions[0].1 > SPIN_SHARE)
            && mode.omega_squared.abs() < slow;
        mode.kind = match mode.omega_squared {
            value if spins || value.abs() < free => ModeKind::Free,
            value if value < 0.0 => ModeKind::Unstable,
            _ => ModeKind::Vibration,
        };
        modes.push(mode);
    }
    keep_what_was_asked(&mut modes, settings.range);
    mark_equal(&mut modes);
    let mut found = Modes {
        solver,
        state,
        modes,
        proof: search.proof,
        below_band: search.below_band,
        added_mass: settings.added_mass,
        total_mass_kg,
        unsymmetric,
        factorisations,
        warnings: Vec::new(),
    };
    found.normalise();
    found.warnings = warnings(&found);
    Ok(found)
}

/// What the search found.
struct Search {
    pairs: Vec<Eigenpair>,
    proof: Proof,
    below_band: usize,
}

/// Everything up to `slow`, which may be unstable or free, and the range above it.
fn search(
    spectrum: &mut Spectrum<'_, '_, '_>,
    slow: f64,
    range: ModeRange,
) -> Result<Search, EigenError> {
    let mut bottom = spectrum.count(-slow)?;
    let mut step = slow.max(GUESS);
    let under_zero = bottom;
    while bottom.below > 0 && step.is_finite() {
        bottom = spectrum.count(bottom.at - step)?;
        step *= 16.0;
    }
    let above_zero = spectrum.count(slow)?;
    let mut pairs = spectrum.between(bottom, under_zero)?;
    pairs.extend(spectrum.between(under_zero, above_zero)?);
    let (low, high) = match range {
        ModeRange::Lowest(count) => {
            // What lies below may hold true modes; at worst a few more are found than needed.
            let high = spectrum.above_lowest(above_zero, count, GUESS)?;
            (above_zero, high)
        }
        ModeRange::Band { from_hz, to_hz } => {
            let at = |frequency: f64| (TAU * frequency).powi(2).max(above_zero.at);
            (spectrum.count(at(from_hz))?, spectrum.count(at(to_hz))?)
        }
    };
    pairs.extend(spectrum.between(low, high)?);
    Ok(Search {
        pairs,
        proof: proof(range, bottom, low, high),
        below_band: low.below - above_zero.below,
    })
}

fn proof(range: ModeRange, bottom: Count, low: Count, high: Count) -> Proof {
    let from = match range {
        ModeRange::Lowest(_) => bottom,
        ModeRange::Band { .. } => low,
    };
    Proof {
        between: [from.at, high.at],
        counted: high.below - from.below,
    }
}

/// Drops vibrations beyond the number that was asked for, but never part of an equal group.
fn keep_what_was_asked(modes: &mut Vec<Mode>, range: ModeRange) {
    let ModeRange::Lowest(count) = range else {
        return;
    };
    let vibrations = |mode: &Mode| mode.kind == ModeKind::Vibration;
    let others = modes.iter().filter(|mode| !vibrations(mode)).count();
    // Free spins stand among slow vibrations: the kinds first, then by frequency.
    modes.sort_by_key(vibrations);
    let mut keep = (others + count).min(modes.len());
    while keep > others && keep < modes.len() && equal(&modes[keep - 1], &modes[keep]) {
        keep += 1;
    }
    modes.truncate(keep);
}

fn equal(a: &Mode, b: &Mode) -> bool {
    (a.omega_squared - b.omega_squared).abs() <= EQUAL * a.omega_squared.abs()
}

fn mark_equal(modes: &mut [Mode]) {
    for k in 1..modes.len() {
        modes[k].equals_previous =
            modes[k].kind == modes[k - 1].kind && equal(&modes[k - 1], &modes[k]);
    }
}

/// Largest coupling of two modes by the unsymmetric part of the stiffness, over their own.
///
/// Source: docs/theory/modes.md, eq. (5).
fn unsymmetric_coupling(
    system: &System,
    stiffness: &BlockMatrix,
    pencil: &Pencil<'_>,
    pairs: &[Eigenpair],
    slow: f64,
) -> f64 {
    let pairs: Vec<&Eigenpair> = pairs.iter().filter(|pair| pair.value > slow).collect();
    let parts: Vec<Vec<Vector6>> = pairs
        .iter()
        .map(|pair| {
            let mut part = pencil.stiffness_times(&pair.vector);
            stiffness.subtract_times(&system.topology, &pair.vector, &mut part);
            part
        })
        .collect();
    // Nothing unsymmetric but round-off: the sums over all pairs of modes can be saved.
    let size = |vector: &[Vector6]| dot(vector, vector).sqrt();
    let bound = |k: usize| size(&parts[k]) * size(&pairs[k].vector) / pairs[k].value;
    let largest = (0..pairs.len()).map(bound).fold(0.0, f64::max);
    if largest < UNSYMMETRIC * 1e-3 {
        return largest;
    }
    let mut coupling = 0.0f64;
    for (pair, part) in pairs.iter().zip(&parts) {
        for other in &pairs {
            let own = (pair.value * other.value).sqrt();
            coupling = coupling.max(dot(&other.vector, part).abs() / own);
        }
    }
    coupling
}

fn warnings(found: &Modes<'_>) -> Vec<String> {
    let mut warnings = Vec::new();
    let unstable: Vec<&Mode> = found
        .modes
        .iter()
        .filter(|mode| mode.kind == ModeKind::Unstable)
        .collect();
    if let Some(worst) = unstable.first() {
        warnings.push(format!(
            "the equilibrium is unstable: {} motion(s) grow instead of vibrating, the fastest by a \
             factor e in {:.3} s, largest at {}; the line is buckled or stands on its head",
            unstable.len(),
            1.0 / (-worst.omega_squared).sqrt(),
            worst.largest_at,
        ));
    }
    if found.unsymmetric > UNSYMMETRIC {
        warnings.push(format!(
            "the drag of the current couples the modes by {:.1} % of their stiffness in a way that \
             has no energy; the modes leave this out (as they leave out damping)",
            100.0 * found.unsymmetric
        ));
    }
    warnings
}

fn modes_error(error: EigenError, range: ModeRange) -> ModesError {
    match error {
        EigenError::TooMany { available } => ModesError::TooMany {
            available,
            wanted: match range {
                ModeRange::Lowest(count) => count,
                ModeRange::Band { .. } => 0,
            },
        },
        EigenError::Incomplete {
            slice: [low, high],
            counted,
            found,
        } => ModesError::Incomplete {
            from_hz: hertz(low),
            to_hz: hertz(high),
            counted,
            found,
        },
        EigenError::Singular { shift } => ModesError::Singular {
            at_hz: hertz(shift),
        },
        _ => ModesError::Interrupted,
    }
}

/// Frequency of a squared angular frequency, with its sign [Hz].
fn hertz(omega_squared: f64) -> f64 {
    omega_squared.abs().sqrt().copysign(omega_squared) / TAU
}
