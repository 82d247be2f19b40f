//! `[line_types.*]`: cross sections of lines.

use crate::file::define::{kinds, table};
use crate::file::dimension::{
    Density, Dimensionless, FlexuralStiffness, Force, InverseLength, Length, MassMomentPerLength,
    MassPerLength, Moment, Pressure, Time, TorsionConstant,
};
use crate::file::quantity::{NonNegative, Positive, Real};

kinds! {
    /// Cross section of a line.
    pub(super) enum LineTypeTable {
        "pipe" => Pipe(PipeTable),
        "rectangle" => Rectangle(RectangleTable),
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
    /// A homogeneous solid bar with a rectangular section: mass and stiffness follow from geometry
    /// and material. For water it is a round bar of the same area.
    pub(super) struct RectangleTable {
        /// Width along the section's local y.
        width: Positive<Length>,
        /// Height along the section's local z.
        height: Positive<Length>,
        /// Density of the material.
        density: Positive<Density> = "7850 kg/m^3",
        /// Young's modulus of the material.
        youngs_modulus: Positive<Pressure> = "206 GPa",
        /// Poisson's ratio of the material.
        poisson_ratio: Real<Dimensionless> = 0.3,
        /// Shear coefficient of the section (5/6 for a rectangle): shear stiffness is this times
        /// G A. Absent: rigid in shear.
        shear_coefficient: Option<Positive<Dimensionless>>,
        /// Torsion constant J: torsional stiffness is G J. Absent: Saint-Venant's, which for a
        /// square of side a is 0.1406 a^4.
        torsion_constant: Option<Positive<TorsionConstant>>,
        /// Stiffness-proportional structural damping: damping is this time times stiffness.
        structural_damping: NonNegative<Time> = "0 s",
        /// Normal drag coefficient, on the diameter of a round bar of the same area.
        normal_drag: NonNegative<Dimensionless> = 1.2,
        /// Axial drag coefficient, on pi times that diameter.
        axial_drag: NonNegative<Dimensionless> = 0.02,
        /// Normal added-mass coefficient, on the displaced mass.
        normal_added_mass: NonNegative<Dimensionless> = 1.0,
        /// Axial added-mass coefficient, on the displaced mass.
        axial_added_mass: NonNegative<Dimensionless> = 0.0,
        /// Strain beyond which the bar counts as torn when the distance between its ends is
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
        /// Axial stiffness EA; required unless there is an `axial_law`.
        axial_stiffness: Option<Positive<Force>>,
        /// Tension against strain, in place of `axial_stiffness`: points by increasing strain, with
        /// tension increasing too; straight from point to point and through (0, 0), which need not
        /// be written, and on with the last slope. Without points in compression it is as stiff
        /// there as in the first stretch.
        axial_law: Option<Vec<TensionPointTable>>,
        /// Bending stiffness EI, the same about all axes; absent: 0, a chain.
        bending_stiffness: Option<NonNegative<FlexuralStiffness>>,
        /// Bending stiffness about the section's local y, with `bending_stiffness_z` in place of
        /// `bending_stiffness`.
        bending_stiffness_y: Option<Positive<FlexuralStiffness>>,
        /// Bending stiffness about the section's local z.
        bending_stiffness_z: Option<Positive<FlexuralStiffness>>,
        /// Bending moment against curvature, the same about all axes, in place of
        /// `bending_stiffness`: points by increasing curvature, with the moment increasing too;
        /// straight from (0, 0), which need not be written, through the points and on with the
        /// last slope.
        bending_law: Option<Vec<BendingPointTable>>,
        /// Torsional stiffness GJ; absent: equal to the bending stiffness (the mean of the two).
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

table! {
    /// One point of a bending law.
    pub(super) struct BendingPointTable {
        /// Curvature, of either sign of bending.
        curvature: NonNegative<InverseLength>,
        /// Bending moment at this curvature.
        moment: NonNegative<Moment>,
    }
}

table! {
    /// One point of an axial law.
    pub(super) struct TensionPointTable {
        /// Strain; negative in compression.
        strain: Real<Dimensionless>,
        /// Effective tension at this strain; negative in compression.
        tension: Real<Force>,
    }
}
