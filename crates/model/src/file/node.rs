//! The TOML document as a tree of nodes that remember where they were written.

use std::fmt;
use std::ops::Range;

use indexmap::IndexMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Byte range in the model file.
pub(super) type Span = Range<usize>;

/// A value of the document with its key and where both stand.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// Key as written; `key[2]` for the items of an array; empty for the document itself.
    pub key: String,
    /// Where the key stands (the value itself for items of an array).
    pub key_span: Span,
    /// Where the value stands.
    pub span: Span,
    /// The value.
    pub value: NodeValue,
}

/// Entries of a table, in file order.
pub(super) type Entries = IndexMap<String, Node>;

/// A TOML value.
#[derive(Debug, Clone)]
pub(super) enum NodeValue {
    /// A string.
    Text(String),
    /// An integer that fits 64 bits.
    Integer(i64),
    /// A float, or an integer too large for 64 bits.
    Float(f64),
    /// `true` or `false`.
    Boolean(bool),
    /// A date or time, which no key accepts.
    Datetime,
    /// An array.
    Array(Vec<Node>),
    /// A table.
    Table(Entries),
}

impl Node {
    /// The whole document.
    pub fn document(table: &Spanned<DeTable<'_>>) -> Node {
        let value = NodeValue::Table(entries(table.get_ref()));
        Node {
            key: String::new(),
            key_span: 0..0,
            span: table.span(),
            value,
        }
    }

    /// A value that the file does not contain: a default, blamed on the table that lacks it.
    pub fn implied(key: &str, blame: &Node, value: NodeValue) -> Node {
        let key_span = blame.key_span.clone();
        Node {
            key: key.to_owned(),
            span: key_span.clone(),
            key_span,
            value,
        }
    }

    /// The entries, when this is a table.
    pub fn entries(&self) -> Option<&Entries> {
        match &self.value {
            NodeValue::Table(entries) => Some(entries),
            _ => None,
        }
    }
}

fn entries(table: &DeTable<'_>) -> Entries {
    table
        .iter()
        .map(|(key, value)| {
            let name = key.get_ref().to_string();
            let node = node(name.clone(), key.span(), value);
            (name, node)
        })
        .collect()
}

fn node(key: String, key_span: Span, spanned: &Spanned<DeValue<'_>>) -> Node {
    let span = spanned.span();
    let value = match spanned.get_ref() {
        DeValue::String(text) => NodeValue::Text(text.to_string()),
        DeValue::Integer(integer) => {
            match i64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(value) => NodeValue::Integer(value),
                // Too long for 64 bits: as a number it still means something.
                Err(_) => NodeValue::Float(integer.as_str().parse().unwrap_or(f64::NAN)),
            }
        }
        DeValue::Float(float) => NodeValue::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(value) => NodeValue::Boolean(*value),
        DeValue::Datetime(_) => NodeValue::Datetime,
        DeValue::Array(items) => NodeValue::Array(
            items
                .iter()
                .enumerate()
                .map(|(index, item)| node(format!("{key}[{index}]"), item.span(), item))
                .collect(),
        ),
        DeValue::Table(table) => NodeValue::Table(entries(table)),
    };
    Node {
        key,
        key_span,
        span,
        value,
    }
}

/// Lays `overrides` over `base`: tables merge key by key, everything else replaces.
pub(super) fn merge(base: &mut Entries, overrides: &Entries) {
    for (key, override_node) in overrides {
        match base.get_mut(key) {
            Some(Node {
                value: NodeValue::Table(base_entries),
                ..
            }) if matches!(override_node.value, NodeValue::Table(_)) => {
                if let NodeValue::Table(override_entries) = &override_node.value {
                    merge(base_entries, override_entries);
                }
            }
            Some(base_node) => *base_node = override_node.clone(),
            None => {
                base.insert(key.clone(), override_node.clone());
            }
        }
    }
}

impl NodeValue {
    /// What kind of value this is, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            NodeValue::Text(_) => "a text",
            NodeValue::Integer(_) => "an integer",
            NodeValue::Float(_) => "a number",
            NodeValue::Boolean(_) => "a boolean",
            NodeValue::Datetime => "a date or time",
            NodeValue::Array(_) => "an array",
            NodeValue::Table(_) => "a table",
        }
    }

    /// A table without entries, the default of tables whose keys all have defaults.
    pub fn empty_table() -> NodeValue {
        NodeValue::Table(Entries::new())
    }
}

/// As it would be written in the file (tables as `{}`; only defaults are printed).
impl fmt::Display for NodeValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NodeValue::Text(text) => write!(formatter, "\"{text}\""),
            NodeValue::Integer(value) => write!(formatter, "{value}"),
            NodeValue::Float(value) => write!(formatter, "{value:?}"),
            NodeValue::Boolean(value) => write!(formatter, "{value}"),
            NodeValue::Datetime => write!(formatter, "(date)"),
            NodeValue::Array(items) => {
                let items: Vec<String> = items.iter().map(|item| item.value.to_string()).collect();
                write!(formatter, "[{}]", items.join(", "))
            }
            NodeValue::Table(_) => write!(formatter, "{{}}"),
        }
    }
}

impl From<&str> for NodeValue {
    fn from(text: &str) -> Self {
        NodeValue::Text(text.to_owned())
    }
}

impl From<f64> for NodeValue {
    fn from(value: f64) -> Self {
        NodeValue::Float(value)
    }
}

impl From<i32> for NodeValue {
    fn from(value: i32) -> Self {
        NodeValue::Integer(i64::from(value))
    }
}

impl From<bool> for NodeValue {
    fn from(value: bool) -> Self {
        NodeValue::Boolean(value)
    }
}

impl<const N: usize> From<[i32; N]> for NodeValue {
    fn from(values: [i32; N]) -> Self {
        let item = |value: i32| Node {
            key: String::new(),
            key_span: 0..0,
            span: 0..0,
            value: value.into(),
        };
        NodeValue::Array(values.map(item).into())
    }
}
