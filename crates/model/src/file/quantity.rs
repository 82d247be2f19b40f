//! A number in the file, checked for dimension and sign, in SI.

use std::marker::PhantomData;

use super::diagnostic::DiagnosticCode as Code;
use super::dimension::{Dimension, Measure, name_of};
use super::log::Log;
use super::node::{Node, NodeValue, Span};
use super::read::Read;
use super::shape::Shape;
use super::units::{Powers, QuantityError, WrittenNumber, describe_powers, parse_quantity};

/// Largest magnitude of a number, in SI: products of a few such numbers stay finite.
const LARGEST: f64 = 1e30;
/// Smallest magnitude of a number other than zero, in SI: products of a few stay above zero.
const SMALLEST: f64 = 1e-30;

/// A number in SI with the place where it was written.
///
/// A number that could not be read is NaN: its error is already noted, and no check that compares
/// it reports another.
#[derive(Debug, Clone)]
pub(super) struct Quantity<M, S = AnySign> {
    /// Value in SI units.
    pub si: f64,
    /// Where it was written.
    pub span: Span,
    /// Powers of the unit that was written; `None` for a bare number.
    pub powers: Option<Powers>,
    marker: PhantomData<(M, S)>,
}

/// A number of any sign.
pub(super) type Real<M> = Quantity<M, AnySign>;
/// A number greater than zero.
pub(super) type Positive<M> = Quantity<M, AboveZero>;
/// A number that is zero or greater.
pub(super) type NonNegative<M> = Quantity<M, NotBelowZero>;

/// Which signs a number may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SignRule {
    /// Any.
    Any,
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NonNegative,
}

/// A sign rule as a type.
pub(super) trait Sign {
    /// The rule.
    const RULE: SignRule;
}

/// Marker of [`Real`].
#[derive(Debug, Clone)]
pub(super) struct AnySign;
/// Marker of [`Positive`].
#[derive(Debug, Clone)]
pub(super) struct AboveZero;
/// Marker of [`NonNegative`].
#[derive(Debug, Clone)]
pub(super) struct NotBelowZero;

impl Sign for AnySign {
    const RULE: SignRule = SignRule::Any;
}

impl Sign for AboveZero {
    const RULE: SignRule = SignRule::Positive;
}

impl Sign for NotBelowZero {
    const RULE: SignRule = SignRule::NonNegative;
}

impl<M: Measure, S: Sign> Read for Quantity<M, S> {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        let number = read_number(node, M::ACCEPTED, log);
        let number =
            number.filter(|number| sign_is_right(number.si, S::RULE, M::ACCEPTED, node, log));
        let (si, powers) = match number {
            Some(WrittenNumber { si, powers }) => (si, powers),
            None => (f64::NAN, None),
        };
        Some(Quantity {
            si,
            span: node.span.clone(),
            powers,
            marker: PhantomData,
        })
    }

    fn placeholder(table: &Node) -> Option<Self> {
        let span = table.key_span.clone();
        Some(Quantity {
            si: f64::NAN,
            span,
            powers: None,
            marker: PhantomData,
        })
    }

    fn shape() -> Shape {
        Shape::Quantity {
            dimensions: M::ACCEPTED,
            sign: S::RULE,
        }
    }
}

fn read_number(node: &Node, accepted: &[Dimension], log: &mut Log) -> Option<WrittenNumber> {
    let key = &node.key;
    let number = match &node.value {
        NodeValue::Integer(value) => WrittenNumber {
            si: *value as f64,
            powers: None,
        },
        NodeValue::Float(value) if value.is_finite() => WrittenNumber {
            si: *value,
            powers: None,
        },
        NodeValue::Float(value) => {
            let message = format!("`{key}` must be a finite number, but is {value}");
            log.error(Code::Number, &node.span, message, expectation(accepted));
            return None;
        }
        NodeValue::Text(text) => match parse_quantity(text) {
            Ok(number) => number,
            Err(QuantityError::Number(message, help)) => {
                let help = if help.is_empty() {
                    expectation(accepted)
                } else {
                    help
                };
                log.error(
                    Code::Number,
                    &node.span,
                    format!("`{key}`: {message}"),
                    help,
                );
                return None;
            }
            Err(QuantityError::Unit(message, help)) => {
                let help = format!("{help}\n{}", expectation(accepted));
                log.error(Code::Unit, &node.span, format!("`{key}`: {message}"), help);
                return None;
            }
        },
        other => {
            let message = format!("`{key}` must be a number, but is {}", other.kind());
            log.error(Code::WrongType, &node.span, message, expectation(accepted));
            return None;
        }
    };
    let magnitude = number.si.abs();
    if magnitude > LARGEST || (magnitude < SMALLEST && magnitude != 0.0) {
        let message = format!("`{key}` is out of any range, {} in SI units", number.si);
        log.error(Code::Number, &node.span, message, expectation(accepted));
        return None;
    }
    if let Some(powers) = number.powers
        && !accepted.is_empty()
        && !accepted.iter().any(|dimension| dimension.accepts(powers))
    {
        let found = match name_of(powers) {
            Some(name) => name.to_owned(),
            None => format!("in {}", describe_powers(powers)),
        };
        let expected: Vec<&str> = accepted.iter().map(|dimension| dimension.name).collect();
        let expected = expected.join(" or ");
        let message = format!("`{key}` must be {expected}, but {} is {found}", node.value);
        log.error(Code::Dimension, &node.span, message, expectation(accepted));
        return None;
    }
    Some(number)
}

fn sign_is_right(
    si: f64,
    rule: SignRule,
    accepted: &[Dimension],
    node: &Node,
    log: &mut Log,
) -> bool {
    let expected = match rule {
        SignRule::Positive if si <= 0.0 => "greater than zero",
        SignRule::NonNegative if si < 0.0 => "zero or greater",
        _ => return true,
    };
    let message = format!("`{}` must be {expected}, but is {}", node.key, node.value);
    log.error(Code::Value, &node.span, message, expectation(accepted));
    false
}

/// What to write instead.
fn expectation(accepted: &[Dimension]) -> String {
    let describe = |dimension: &Dimension| match dimension.si_unit {
        "" => format!(
            "write a number without unit, for example {}",
            dimension.example
        ),
        unit => format!(
            "write {}, for example \"{}\"; a bare number is in {unit}",
            dimension.name, dimension.example
        ),
    };
    match accepted {
        [] => "write a number with a unit, for example \"-22.5 m\"".to_owned(),
        several => several
            .iter()
            .map(describe)
            .collect::<Vec<_>>()
            .join("; or "),
    }
}
