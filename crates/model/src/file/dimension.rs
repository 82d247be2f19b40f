//! Dimensions that values of the model file have.

use super::units::Powers;

/// A dimension with the words that messages use for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dimension {
    /// Name with its article: `a length`.
    pub name: &'static str,
    /// SI unit in which a bare number is taken; empty for a dimensionless number.
    pub si_unit: &'static str,
    /// Powers of the base dimensions.
    pub powers: Powers,
    /// How a value may be written.
    pub example: &'static str,
}

impl Dimension {
    /// Whether a unit of these powers measures this dimension.
    ///
    /// The radian may be left out of a compound unit (a rotational stiffness in N m), but an angle
    /// is never taken for a plain number, nor the other way round.
    pub fn accepts(&self, written: Powers) -> bool {
        let has_other = written.mass != 0 || written.length != 0 || written.time != 0;
        let same_but_angle = Powers {
            angle: self.powers.angle,
            ..written
        } == self.powers;
        same_but_angle && (written.angle == self.powers.angle || (has_other && written.angle == 0))
    }
}

/// The dimensions that a quantity may have; more than one where another key decides.
pub(super) trait Measure {
    /// The dimensions accepted; empty for any.
    const ACCEPTED: &'static [Dimension];
}

/// Any dimension: the value of a reference, which its channel decides.
#[derive(Debug, Clone)]
pub(super) struct AnyMeasure;

impl Measure for AnyMeasure {
    const ACCEPTED: &'static [Dimension] = &[];
}

/// Defines a marker type for each dimension, and the table of all of them.
macro_rules! dimensions {
    ($($type:ident: $name:literal, $unit:literal, [$mass:literal, $length:literal, $time:literal, $angle:literal], $example:literal;)*) => {
        $(
            #[doc = concat!("Measure of ", $name, " [", $unit, "].")]
            #[derive(Debug, Clone)]
            pub(super) struct $type;

            impl $type {
                const DIMENSION: Dimension = Dimension {
                    name: $name,
                    si_unit: $unit,
                    powers: Powers::new($mass, $length, $time, $angle),
                    example: $example,
                };
            }

            impl Measure for $type {
                const ACCEPTED: &'static [Dimension] = &[Self::DIMENSION];
            }
        )*

        const ALL: &[Dimension] = &[$($type::DIMENSION),*];
    };
}

dimensions! {
    Dimensionless: "a plain number", "", [0, 0, 0, 0], "1.2";
    Length: "a length", "m", [0, 1, 0, 0], "0.219 m";
    Area: "an area", "m^2", [0, 2, 0, 0], "4.4 m^2";
    Volume: "a volume", "m^3", [0, 3, 0, 0], "5.7 m^3";
    Mass: "a mass", "kg", [1, 0, 0, 0], "44.8 t";
    MassPerLength: "a mass per length", "kg/m", [1, -1, 0, 0], "57.7 kg/m";
    Density: "a density", "kg/m^3", [1, -3, 0, 0], "1025 kg/m^3";
    MassMoment: "a moment of inertia", "kg m^2", [1, 2, 0, 0], "1200 kg m^2";
    MassMomentPerLength: "a moment of inertia per length", "kg m", [1, 1, 0, 0], "0.4 kg m";
    Time: "a time", "s", [0, 0, 1, 0], "8 s";
    Frequency: "a frequency", "Hz", [0, 0, -1, 0], "0.5 Hz";
    Angle: "an angle", "rad", [0, 0, 0, 1], "90 deg";
    AngularFrequency: "an angular frequency", "rad/s", [0, 0, -1, 1], "20 rad/s";
    Speed: "a speed", "m/s", [0, 1, -1, 0], "0.5 m/s";
    Acceleration: "an acceleration", "m/s^2", [0, 1, -2, 0], "9.80665 m/s^2";
    Force: "a force", "N", [1, 1, -2, 0], "35.57 kN";
    Moment: "a moment", "N m", [1, 2, -2, 0], "80 kN m";
    Pressure: "a pressure", "Pa", [1, -1, -2, 0], "206 GPa";
    FlexuralStiffness: "a bending stiffness", "N m^2", [1, 3, -2, 0], "10 kN m^2";
    RotationalStiffness: "a rotational stiffness", "N m/rad", [1, 2, -2, -1], "50 kN m/deg";
    ContactDamping: "a damping per length", "N s/m^2", [1, -1, -1, 0], "1 kN s/m^2";
    InverseLength: "a curvature", "1/m", [0, -1, 0, 0], "0.01 m^-1";
    AnglePerLength: "a twist", "rad/m", [0, -1, 0, 1], "2 deg/m";
    TorsionConstant: "a torsion constant", "m^4", [0, 4, 0, 0], "2.2e-5 m^4";
}

/// A length or an angle: the amplitude of a motion, which its degree of freedom decides.
#[derive(Debug, Clone)]
pub(super) struct LengthOrAngle;

impl Measure for LengthOrAngle {
    const ACCEPTED: &'static [Dimension] = &[Length::DIMENSION, Angle::DIMENSION];
}

/// Contact stiffness is a force per length and depth, the same powers as a pressure.
pub(super) type ContactStiffness = Pressure;

/// What a unit of these powers measures, for messages.
pub(super) fn name_of(powers: Powers) -> Option<&'static str> {
    let with_article = |dimension: &&Dimension| dimension.powers == powers;
    ALL.iter()
        .find(with_article)
        .map(|dimension| dimension.name)
}
