//! What lumped mass cannot do, and says so instead of giving a wrong number.

use catenix_model::{LoadPlace, Model};

use crate::system::SystemError;

/// Looks for what a line has that mass points and springs have no room for.
///
/// # Errors
/// [`SystemError::Unusable`] with the line, the reason, and what to do.
pub(super) fn check(model: &Model) -> Result<(), SystemError> {
    let refuse = |owner: String, what: &str| {
        Err(SystemError::Unusable {
            owner,
            what: format!("{what}; use formulation = \"dem\" or \"fem\" for this model"),
        })
    };
    for line in &model.lines {
        let owner = || format!("line '{}'", line.name);
        for (index, section) in line.sections.iter().enumerate() {
            let own = &model.line_types[section.line_type];
            let [y, z] = own.bending_stiffness;
            if y != z {
                return refuse(
                    owner(),
                    "lumped mass has no sections that could be turned about the line, so it cannot \
                     tell apart unlike bending stiffnesses in two planes",
                );
            }
            if section.natural.curvature != [0.0; 2] {
                return refuse(
                    owner(),
                    "lumped mass has no sections that could be turned about the line, so it cannot \
                     hold a natural curvature in its plane",
                );
            }
            if section.natural.twist != 0.0 {
                return refuse(
                    owner(),
                    "lumped mass has no torsion, and so no natural twist",
                );
            }
            if own.shear_stiffness.is_some() {
                return refuse(
                    owner(),
                    "lumped mass has no shear flexibility (shear_stiffness)",
                );
            }
            let before = index
                .checked_sub(1)
                .map(|k| &model.line_types[line.sections[k].line_type]);
            let changes = before.is_some_and(|before| before.bending_law != own.bending_law);
            if changes {
                return refuse(
                    owner(),
                    "lumped mass spreads the angle at a node over both elements beside it, which a \
                     bending_law on one side only, or another on each side, does not tell how to do",
                );
            }
        }
    }
    for load in &model.loads {
        let LoadPlace::Line { line, .. } = load.place else {
            continue;
        };
        let owner = || format!("load '{}' on line '{}'", load.name, model.lines[line].name);
        if load.moment != [0.0; 3] {
            return refuse(
                owner(),
                "the points of lumped mass do not turn, so a moment on a line finds no hold there",
            );
        }
        if load.follows {
            return refuse(
                owner(),
                "the points of lumped mass do not turn, so a load on a line has nothing to follow",
            );
        }
    }
    Ok(())
}
