//! The document: the base model, its figures and load cases.

use crate::file::define::table;
use crate::file::node::NodeValue;
use crate::file::read::{Named, Text};

use super::{
    AnchorTable, BodyTable, DynamicsTable, EnvironmentTable, FigureTable, FormulationChoice,
    LineTable, LineTypeTable, LoadTable, ModesTable, MotionTable, OutputTable, PathTable,
    ReferenceTable, StaticsTable, VesselTable,
};

table! {
    /// A Catenix model file. Numbers carry a unit in quotes (`"0.219 m"`, `"10 kN m^2"`); bare
    /// numbers are SI and radians. Global axes: x and y horizontal, z up, origin in the mean sea
    /// surface.
    pub(super) struct StudyTable {
        /// Title of the study; absent: the file's name.
        title: Option<Text>,
        /// Remark printed under tables and figures.
        note: Option<Text>,
        /// Figures over all load cases.
        figures: Named<FigureTable>,
    }
}

table! {
    /// A load case: any table of the base model, written here again, is laid over the base. Tables
    /// merge key by key; numbers, texts and arrays replace.
    pub(super) struct CaseTable {
        /// One sentence for tables and legends.
        description: Option<Text>,
        /// Results from elsewhere that the results of this case are compared with.
        references: Option<Vec<ReferenceTable>>,
    }
}

table! {
    /// The model.
    pub(super) struct ModelTable {
        /// How lines become unknowns. All formulations reach the same answers on fine meshes.
        formulation: FormulationChoice = "dem",
        /// The sea around the system.
        environment: EnvironmentTable,
        /// Cross sections of lines.
        line_types: Named<LineTypeTable>,
        /// Prescribed motions that vessels refer to.
        motions: Named<MotionTable>,
        /// Bodies with prescribed motion.
        vessels: Named<VesselTable>,
        /// Fixed points.
        anchors: Named<AnchorTable>,
        /// Free rigid bodies.
        bodies: Named<BodyTable>,
        /// Pipes, hoses, cables and moorings.
        lines: Named<LineTable>,
        /// Forces and moments on lines and bodies.
        loads: Named<LoadTable>,
        /// How static equilibrium is sought.
        statics: StaticsTable = NodeValue::empty_table(),
        /// Which natural modes are sought.
        modes: ModesTable = NodeValue::empty_table(),
        /// How the motion is integrated; without this table only statics can be computed.
        dynamics: Option<DynamicsTable>,
        /// The equilibrium path that `catenix path` follows.
        path: Option<PathTable>,
        /// What is recorded.
        output: OutputTable = NodeValue::empty_table(),
    }
}
