//! Natural modes of a load case: the table that people read, and the shapes in the store.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::StoreError;
use crate::layout::{self, array_attributes};
use crate::zarr::{Array, ArrayShape, Attributes, FloatKind, Group};

/// Components of a shape: names of arrays, units, and what they are.
pub(crate) const COMPONENTS: [(&str, &str, &str); 6] = [
    ("displacement_x", "m", "displacement, global x"),
    ("displacement_y", "m", "displacement, global y"),
    ("displacement_z", "m", "displacement, global z"),
    ("rotation_x", "rad", "rotation about global x"),
    ("rotation_y", "rad", "rotation about global y"),
    ("rotation_z", "rad", "rotation about global z"),
];

/// The modes of a load case, without their shapes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModesReport {
    /// Whether added mass moves along.
    pub added_mass: bool,
    /// Mass that a shaking of everything along x, y and z moves (3) [kg].
    pub total_mass_kg: [f64; 3],
    /// Frequencies between which the modes were counted (2) [Hz]; negative where motions grow.
    pub counted_between_hz: [f64; 2],
    /// Modes counted there; as many were found.
    pub counted: usize,
    /// Vibrations below the band, where a band was asked for.
    pub below_band: usize,
    /// Coupling of the modes by forces without potential, which is left out [-].
    pub unsymmetric_coupling: f64,
    /// Factorisations that it took.
    pub factorisations: usize,
    /// The modes, by frequency.
    pub modes: Vec<ModeReport>,
}

/// One mode.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeReport {
    /// Number, from 1; free and growing motions come first.
    pub number: usize,
    /// `vibration`, `free` or `unstable`.
    pub kind: Cow<'static, str>,
    /// Frequency [Hz]; 0 for a free motion, none for one that grows.
    pub frequency_hz: Option<f64>,
    /// Period [s].
    pub period_s: Option<f64>,
    /// Squared angular frequency [rad2/s2].
    pub omega_squared_rad2_s2: f64,
    /// Whether the frequency is that of the mode before.
    pub equals_previous: bool,
    /// Line or body that moves most.
    pub moves_most: String,
    /// Distance from end A of where a line moves most [m].
    pub arc_length_m: Option<f64>,
    /// Shares of the kinetic energy by way to move, the largest first.
    pub motions: Vec<MotionShare>,
    /// Damping ratio by structural damping [-].
    pub damping_ratio: Option<f64>,
    /// Effective mass along x, y and z (3) [kg].
    pub effective_mass_kg: [f64; 3],
    /// Largest force that the mode leaves unbalanced, over its largest force of inertia [-].
    pub residual: f64,
}

/// Share of the kinetic energy of a mode.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionShare {
    /// `x`, `y`, `z`, `axial`, `torsion` or `rotation`.
    pub motion: Cow<'static, str>,
    /// Share [-].
    pub share: f64,
}

/// The shapes of the modes along one line, or of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeShapes {
    /// Name of the line or body.
    pub name: String,
    /// Unstretched distance of each node from end A (n_nodes) [m]; none for a body.
    pub arc_length: Option<Vec<f64>>,
    /// Per mode and node: translation and rotation, global, (n_modes x n_nodes); one node for a
    /// body.
    pub motion: Vec<Vec<[f64; 6]>>,
}

/// The modes of a load case with their shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseModes {
    /// The table.
    pub report: ModesReport,
    /// Along each line.
    pub lines: Vec<ModeShapes>,
    /// Of each body.
    pub bodies: Vec<ModeShapes>,
}

impl CaseModes {
    /// Writes the group `modes` of a case.
    pub(crate) fn write(&self, case: &Group) -> Result<(), StoreError> {
        let report = &self.report;
        let mut attributes = Attributes::new();
        attributes.insert("added_mass".into(), u8::from(report.added_mass).into());
        attributes.insert("counted".into(), report.counted.into());
        // Plain numbers and strings always become JSON.
        let table = serde_json::to_string(report).unwrap_or_default();
        attributes.insert(layout::MODES_KEY.into(), table.into());
        for (key, values) in [
            ("total_mass_kg", report.total_mass_kg.to_vec()),
            ("counted_between_hz", report.counted_between_hz.to_vec()),
        ] {
            attributes.insert(key.into(), values.into());
        }
        attributes.insert(
            "normalisation".into(),
            "the largest displacement of any node or body is 1 m, or the largest rotation 1 rad \
             where the mode is mostly torsion or rotation"
                .into(),
        );
        let group = Group::create(layout::modes_place(case.place()), &attributes)?;
        let modes = &report.modes;
        let column = |name: &str, units: &str, text: &str, value: &dyn Fn(&ModeReport) -> f64| {
            let values: Vec<f64> = modes.iter().map(value).collect();
            Array::create(
                group.place().join(name),
                FloatKind::F64,
                ArrayShape::vector(values.len(), "mode"),
                array_attributes(units, text),
            )?
            .write_all(&values)
        };
        let nan = f64::NAN;
        column("mode", "1", "number of the mode", &|m| m.number as f64)?;
        column("frequency", "Hz", "natural frequency", &|m| {
            m.frequency_hz.unwrap_or(nan)
        })?;
        column(
            "omega_squared",
            "rad2 s-2",
            "squared angular frequency",
            &|m| m.omega_squared_rad2_s2,
        )?;
        column(
            "damping_ratio",
            "1",
            "damping ratio by structural damping",
            &|m| m.damping_ratio.unwrap_or(nan),
        )?;
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let text = format!("effective mass, global {name}");
            column(&format!("effective_mass_{name}"), "kg", &text, &|m| {
                m.effective_mass_kg[axis]
            })?;
        }
        for (folder, shapes) in [("lines", &self.lines), ("bodies", &self.bodies)] {
            let folder = Group::create(group.place().join(folder), &Attributes::new())?;
            for shape in shapes {
                shape.write(&folder, modes)?;
            }
        }
        Ok(())
    }
}

impl ModeShapes {
    fn write(&self, folder: &Group, modes: &[ModeReport]) -> Result<(), StoreError> {
        let mut attributes = Attributes::new();
        attributes.insert("name".into(), self.name.as_str().into());
        let place = folder.place().join(&layout::component(&self.name));
        let group = Group::create(place, &attributes)?;
        let numbers: Vec<f64> = modes.iter().map(|mode| mode.number as f64).collect();
        let vector = |name: &str, values: &[f64], units: &str, text: &str| {
            Array::create(
                group.place().join(name),
                FloatKind::F64,
                ArrayShape::vector(values.len(), name),
                array_attributes(units, text),
            )?
            .write_all(values)
        };
        vector("mode", &numbers, "1", "number of the mode")?;
        if let Some(arc_length) = &self.arc_length {
            vector(
                "arc_length",
                arc_length,
                "m",
                "unstretched distance from end A",
            )?;
        }
        for (component, (name, units, text)) in COMPONENTS.into_iter().enumerate() {
            let values: Vec<f64> = self
                .motion
                .iter()
                .flatten()
                .map(|motion| motion[component])
                .collect();
            let mut shape = ArrayShape::vector(self.motion.len(), "mode");
            if let Some(arc_length) = &self.arc_length {
                shape.columns = Some(arc_length.len());
                shape.dimensions.push("arc_length".to_owned());
            }
            Array::create(
                group.place().join(name),
                FloatKind::F64,
                shape,
                array_attributes(units, &format!("{text}, of the mode")),
            )?
            .write_all(&values)?;
        }
        Ok(())
    }
}
