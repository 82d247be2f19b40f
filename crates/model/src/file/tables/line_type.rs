//! `[line_types.*]`: cross sections of lines.

use crate::file::define::{kinds, table};
use crate::file::dimension::{
    Density, Dimensionless, FlexuralStiffness, Force, Length, MassMomentPerLength, MassPerLength,
    Pressure, Time,
};
use crate::file::quantity::{NonNegative, Positive, Real};

kinds! {
    /// Cross section of a line.
    pub(super) enum LineTypeTable {
        "pipe" => Pipe(PipeTable),
        "general" => General(GeneralTable),
    }
}

table! {
    /// A homogeneous round pipe: mass and stiffness follow from geometry and material.
    pub(super) struct PipeTable {
        /// Outer diameter; also sets buoyancy, drag and added mass.
        outer_diameter: Positive<Length>,
        /// Inner diameter; 0 is a solid bar.
        inner_diameter: NonNegative<Length>,
        /// Density of the wall.
        density: Positive<Density> = "7850 kg/m^3",
        /// Young's modulus of the wall.
        youngs_modulus: Positive<Pressure> = "206 GPa",
        /// Poisson's ratio of the wall.
        poisson_ratio: Real<Dimensionless> = 0.3,
        /// Density of what fills the bore; 0 is an empty (air-filled) pipe. A pipe flooded with sea
        /// water has the density of sea water here.
        content_density: NonNegative<Density> = "0 kg/m^3",
        /// Mass of a coating or of equipment spread along the pipe, without stiffness.
        coating_mass: NonNegative<MassPerLength> = "0 kg/m",
        /// Shear coefficient of the section: shear stiffness is this times G A. Absent: rigid in
        /// shear.
        shear_coefficient: Option<Positive<Dimensionless>>,
        /// Stiffness-proportional structural damping: damping is this time times stiffness.
        structural_damping: NonNegative<Time> = "0 s",
        /// Normal drag coefficient, on the outer diameter.
        normal_drag: NonNegative<Dimensionless> = 1.2,
        /// Axial drag coefficient, on pi times the outer diameter.
        axial_drag: NonNegative<Dimensionless> = 0.02,
        /// Normal added-mass coefficient, on the displaced mass.
        normal_added_mass: NonNegative<Dimensionless> = 1.0,
        /// Axial added-mass coefficient, on the displaced mass.
        axial_added_mass: NonNegative<Dimensionless> = 0.0,
        /// Strain beyond which the pipe counts as torn when the distance between its ends is
        /// checked. The default, 1 %, is several times the yield strain of steel.
        strain_limit: NonNegative<Dimensionless> = 0.01,
    }
}

table! {
    /// A hose, rope, chain or umbilical given by its mass and stiffnesses.
    pub(super) struct GeneralTable {
        /// Outer diameter; sets buoyancy, drag and added mass.
        outer_diameter: Positive<Length>,
        /// Inner diameter, the bore that the content fills.
        inner_diameter: NonNegative<Length> = "0 m",
        /// Mass with content.
        mass: Positive<MassPerLength>,
        /// Axial stiffness EA.
        axial_stiffness: Positive<Force>,
        /// Bending stiffness EI, the same about both axes; 0 is a chain.
        bending_stiffness: NonNegative<FlexuralStiffness> = "0 N m^2",
        /// Torsional stiffness GJ; absent: equal to the bending stiffness.
        torsional_stiffness: Option<NonNegative<FlexuralStiffness>>,
        /// Shear stiffness; absent: rigid in shear.
        shear_stiffness: Option<Positive<Force>>,
        /// Density of the content, already part of the mass; it tells wall tension from effective
        /// tension.
        content_density: NonNegative<Density> = "0 kg/m^3",
        /// Second moment of mass about the line's axis; absent: mass (OD^2 + ID^2) / 8.
        polar_inertia: Option<Positive<MassMomentPerLength>>,
        /// Second moment of mass of the section about the axes across the line; absent: half the
        /// polar one where there is a `shear_stiffness` (Timoshenko), or else none (Euler-Bernoulli).
        rotary_inertia: Option<NonNegative<MassMomentPerLength>>,
        /// Stiffness-proportional structural damping: damping is this time times stiffness.
        structural_damping: NonNegative<Time> = "0 s",
        /// Normal drag coefficient, on the outer diameter.
        normal_drag: NonNegative<Dimensionless> = 1.2,
        /// Axial drag coefficient, on pi times the outer diameter.
        axial_drag: NonNegative<Dimensionless> = 0.02,
        /// Normal added-mass coefficient, on the displaced mass.
        normal_added_mass: NonNegative<Dimensionless> = 1.0,
        /// Axial added-mass coefficient, on the displaced mass.
        axial_added_mass: NonNegative<Dimensionless> = 0.0,
        /// Strain beyond which the line counts as torn when the distance between its ends is
        /// checked. The default, 10 %, is about what polyester rope bears before it breaks.
        strain_limit: NonNegative<Dimensionless> = 0.1,
    }
}
