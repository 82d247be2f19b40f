//! JSON schema of the model file, for completion and checks in editors.
//!
//! It is made from the shapes of the tables rather than derived from Rust types (schemars), because
//! one definition must also carry units, defaults and signs, and read with all errors at once.
//! Everything is written out in place, without `$ref`: editors of TOML show the description beside
//! a key only then.

use serde_json::{Map, Value, json};

use super::dimension::Dimension;
use super::quantity::SignRule;
use super::read::ReadTable;
use super::shape::{Shape, TableShape};
use super::tables::{CaseTable, ModelTable, StudyTable};

/// A number with a unit, as text: the number, then a product of units.
const QUANTITY_PATTERN: &str =
    r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*([A-Za-z°µμ][^,()]*)?$";
/// A plain number as text.
const NUMBER_PATTERN: &str = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*$";
/// Names of objects.
const NAME_PATTERN: &str = "^[A-Za-z0-9_-]+$";

/// JSON schema (draft 7) of the model file.
pub fn json_schema() -> Value {
    let model = ModelTable::table_shape();
    let study = StudyTable::table_shape();
    let mut case = CaseTable::table_shape();
    let doc = case.doc.clone();
    case.fields.extend(ModelTable::table_shape().fields);
    // With load cases the base may leave out what every case gives.
    let mut properties = Map::new();
    for table in [&study, &model] {
        properties.extend(properties_of(table, Strictness::Override));
    }
    let cases = json!({
        "description": doc,
        "type": "object",
        "propertyNames": { "pattern": NAME_PATTERN },
        "additionalProperties": table_schema(&case, Strictness::Override),
    });
    properties.insert("cases".to_owned(), cases);
    let mut complete = table_schema(&model, Strictness::Complete);
    if let Some(complete) = complete.as_object_mut() {
        complete.remove("additionalProperties");
        complete.remove("description");
    }
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Catenix model file",
        "description": study.doc,
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
        "if": { "not": { "required": ["cases"] } },
        "then": complete,
    })
}

/// Whether a table must be complete, or overrides part of another.
#[derive(Clone, Copy, PartialEq)]
enum Strictness {
    Complete,
    Override,
}

fn schema(shape: &Shape, strictness: Strictness) -> Value {
    match shape {
        Shape::Quantity { dimensions, sign } => quantity_schema(dimensions, *sign),
        Shape::Count => json!({ "type": "integer", "minimum": 1 }),
        Shape::Boolean => json!({ "type": "boolean" }),
        Shape::Text => json!({ "type": "string" }),
        Shape::Choice(words) => {
            let option =
                |(word, doc): &(&str, &str)| json!({ "const": word, "description": doc.trim() });
            json!({ "oneOf": words.iter().map(option).collect::<Vec<_>>() })
        }
        // What stands in an array replaces the base's array and must be complete.
        Shape::Vector(item) => array_schema(item, 3),
        Shape::Pair(item) => array_schema(item, 2),
        Shape::List(item) => {
            json!({ "type": "array", "items": schema(item, Strictness::Complete) })
        }
        Shape::Table(table) => table_schema(table, strictness),
        Shape::Kinds(kinds) => {
            let kind_schema = |(kind, table): &(&str, TableShape)| {
                let mut schema = table_schema(table, strictness);
                schema["properties"]["kind"] = json!({ "const": kind, "description": table.doc });
                if strictness == Strictness::Complete
                    && let Some(required) = schema["required"].as_array_mut()
                {
                    required.insert(0, json!("kind"));
                }
                schema
            };
            json!({ "anyOf": kinds.iter().map(kind_schema).collect::<Vec<_>>() })
        }
        Shape::Named(item) => json!({
            "type": "object",
            "propertyNames": { "pattern": NAME_PATTERN },
            "additionalProperties": schema(item, strictness),
        }),
        Shape::WordOr(word, other) => {
            json!({ "anyOf": [{ "const": word }, schema(other, strictness)] })
        }
    }
}

/// An array of so many values.
fn array_schema(item: &Shape, length: usize) -> Value {
    json!({
        "type": "array",
        "items": schema(item, Strictness::Complete),
        "minItems": length,
        "maxItems": length,
    })
}

fn table_schema(table: &TableShape, strictness: Strictness) -> Value {
    let mut schema = json!({
        "description": table.doc,
        "type": "object",
        "properties": properties_of(table, strictness),
        "additionalProperties": false,
    });
    if strictness == Strictness::Complete {
        let required = table.fields.iter().filter(|field| field.required);
        schema["required"] = required.map(|field| json!(field.key)).collect();
    }
    schema
}

fn properties_of(table: &TableShape, strictness: Strictness) -> Map<String, Value> {
    let property = |field: &super::shape::FieldShape| {
        let mut property = schema(&field.shape, strictness);
        let mut description = field.doc.clone();
        if let Shape::Quantity { dimensions, sign } = &field.shape {
            description = format!("{description}\n{}", describe_quantity(dimensions, *sign));
        }
        if let Some(default) = field.default.as_ref().filter(|default| *default != "{}") {
            description = format!("{description}\nDefault: {default}.");
            if let Ok(value) = serde_json::from_str::<Value>(default) {
                property["default"] = value;
            }
        }
        property["description"] = json!(description);
        (field.key.to_owned(), property)
    };
    table.fields.iter().map(property).collect()
}

/// One sentence on how a quantity is written.
pub(super) fn describe_quantity(dimensions: &[Dimension], sign: SignRule) -> String {
    let describe = |dimension: &Dimension| match dimension.si_unit {
        "" => format!("{} without unit", dimension.name),
        unit => format!(
            "{}, for example \"{}\" (bare: {unit})",
            dimension.name, dimension.example
        ),
    };
    let measure = match dimensions {
        [] => "a number in the channel's unit, for example \"-22.5 m\" (bare: SI)".to_owned(),
        several => several
            .iter()
            .map(describe)
            .collect::<Vec<_>>()
            .join(" or "),
    };
    let sign = match sign {
        SignRule::Any => "",
        SignRule::Positive => "; greater than zero",
        SignRule::NonNegative => "; zero or greater",
    };
    let mut text = format!("{measure}{sign}.");
    text[..1].make_ascii_uppercase();
    text
}

fn quantity_schema(dimensions: &[Dimension], sign: SignRule) -> Value {
    let mut number = json!({ "type": "number" });
    match sign {
        SignRule::Any => {}
        SignRule::Positive => number["exclusiveMinimum"] = json!(0),
        SignRule::NonNegative => number["minimum"] = json!(0),
    }
    let dimensionless = matches!(dimensions, [only] if only.si_unit.is_empty());
    let pattern = if dimensionless {
        NUMBER_PATTERN
    } else {
        QUANTITY_PATTERN
    };
    let mut text = json!({ "type": "string", "pattern": pattern });
    if !dimensionless {
        text["examples"] = dimensions
            .iter()
            .map(|dimension| json!(dimension.example))
            .collect();
    }
    json!({ "anyOf": [number, text] })
}
