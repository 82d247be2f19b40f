//! Typed reading of nodes: each error is noted in the [`Log`], and reading goes on.

use super::diagnostic::DiagnosticCode as Code;
use super::log::{Log, closest, one_of};
use super::node::{Entries, Node, NodeValue, Span};
use super::shape::{Shape, TableShape};

/// A value that can be read from a node.
pub(super) trait Read: Sized {
    /// Whether its key may be left out.
    const OPTIONAL: bool = false;

    /// Reads it; `None` after noting why not.
    fn read(node: &Node, log: &mut Log) -> Option<Self>;

    /// The value of a key that is left out, for optional values.
    fn absent() -> Option<Self> {
        None
    }

    /// A stand-in for a required value that is missing from `table`, which lets the other checks of
    /// the table go on without a second error about this value.
    fn placeholder(_table: &Node) -> Option<Self> {
        None
    }

    /// What may be written.
    fn shape() -> Shape;
}

/// A table that may stand among other keys: beside `kind`, or a load case's own keys.
pub(super) trait ReadTable: Read {
    /// The keys of the table.
    const KEYS: &'static [&'static str];

    /// Reads the table; `others` are keys that are read elsewhere.
    fn read_beside(node: &Node, others: &[&str], log: &mut Log) -> Option<Self>;

    /// The keys with their meanings.
    fn table_shape() -> TableShape;
}

/// A value with its place.
#[derive(Debug, Clone)]
pub(super) struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
}

/// A text with its place.
pub(super) type Text = Located<String>;
/// A whole number of at least 1 with its place.
pub(super) type Count = Located<usize>;

/// Three values: a vector along x, y, z.
#[derive(Debug, Clone)]
pub(super) struct Vector<T> {
    /// Along x, y, z.
    pub components: [T; 3],
    /// Where the array was written.
    pub span: Span,
}

/// Two values: a range.
#[derive(Debug, Clone)]
pub(super) struct Pair<T> {
    /// The two, as written.
    pub items: [T; 2],
    /// Where the array was written.
    pub span: Span,
}

/// Objects that the user named, in file order.
#[derive(Debug, Clone)]
pub(super) struct Named<T>(pub Vec<NamedItem<T>>);

/// One named object.
#[derive(Debug, Clone)]
pub(super) struct NamedItem<T> {
    /// The name.
    pub name: String,
    /// Where the name was written.
    pub name_span: Span,
    /// The object; `None` when it could not be read, which is already noted.
    pub item: Option<T>,
}

/// Reads the keys of one table.
pub(super) struct TableReader<'a> {
    node: &'a Node,
    entries: &'a Entries,
    /// Keys that a misspelt key was taken for: they are not reported as missing as well.
    misspelt: Vec<&'a str>,
}

impl<'a> TableReader<'a> {
    /// Opens a table and reports the keys that it cannot have.
    pub fn open(
        node: &'a Node,
        keys: &'a [&str],
        others: &'a [&str],
        log: &mut Log,
    ) -> Option<Self> {
        let Some(entries) = node.entries() else {
            let message = format!(
                "`{}` must be a table, but is {}",
                node.key,
                node.value.kind()
            );
            let help = format!(
                "write a table with the keys {}",
                one_of(keys.iter().copied())
            );
            log.error(Code::WrongType, &node.span, message, help);
            return None;
        };
        let mut misspelt = Vec::new();
        for (key, entry) in entries {
            if keys.contains(&key.as_str()) || others.contains(&key.as_str()) {
                continue;
            }
            let known = keys.iter().chain(others).copied();
            let free = known.filter(|known| !entries.contains_key(*known));
            let suggestion = closest(key, free);
            misspelt.extend(suggestion);
            let place = match node.key.as_str() {
                "" => String::new(),
                table => format!(" in `{table}`"),
            };
            let message = format!("unknown key `{key}`{place}");
            let allowed = one_of(others.iter().chain(keys).copied());
            let help = match suggestion {
                Some(known) => format!("did you mean `{known}`?\nkeys allowed here: {allowed}"),
                None => format!("keys allowed here: {allowed}"),
            };
            log.error(Code::UnknownKey, &entry.key_span, message, help);
        }
        Some(TableReader {
            node,
            entries,
            misspelt,
        })
    }

    /// Reads one key, or its default.
    pub fn field<T: Read>(
        &self,
        key: &str,
        default: Option<NodeValue>,
        log: &mut Log,
    ) -> Option<T> {
        if let Some(node) = self.entries.get(key) {
            return T::read(node, log);
        }
        if let Some(default) = default {
            return T::read(&Node::implied(key, self.node, default), log);
        }
        if T::OPTIONAL {
            return T::absent();
        }
        if !self.misspelt.contains(&key) {
            let (message, help) = match self.node.key.as_str() {
                "" => (
                    format!("`{key}` is missing"),
                    format!("write a table [{key}]"),
                ),
                table => (
                    format!("`{key}` is missing in `{table}`"),
                    format!("write {}", example_of(key, &T::shape())),
                ),
            };
            log.error(Code::MissingKey, &self.node.key_span, message, help);
        }
        T::placeholder(self.node)
    }
}

/// How a missing key could be written.
fn example_of(key: &str, shape: &Shape) -> String {
    match shape {
        Shape::Quantity { dimensions, .. } => match dimensions {
            [only, ..] if only.si_unit.is_empty() => format!("{key} = {}", only.example),
            [first, ..] => format!("{key} = \"{}\"", first.example),
            [] => format!("{key} = \"1 m\""),
        },
        Shape::Count => format!("{key} = 90"),
        Shape::Boolean => format!("{key} = true"),
        Shape::Text => format!("{key} = \"...\""),
        Shape::Choice(words) => {
            let words: Vec<String> = words
                .iter()
                .map(|(word, _)| format!("\"{word}\""))
                .collect();
            format!("{key} = {}", words.join(" or "))
        }
        Shape::Vector(_) => format!("{key} = [\"0 m\", \"0 m\", \"0 m\"]"),
        Shape::Pair(_) => format!("{key} = [\"-1 m\", \"1 m\"]"),
        Shape::List(_) => format!("{key} = [ ... ]"),
        Shape::Table(_) | Shape::Kinds(_) | Shape::Named(_) => format!("a table `{key}`"),
        Shape::WordOr(word, _) => format!("{key} = \"{word}\""),
    }
}

/// Notes that a value has another type than expected.
pub(super) fn wrong_type(node: &Node, expected: &str, example: &str, log: &mut Log) {
    let message = format!(
        "`{}` must be {expected}, but is {}",
        node.key,
        node.value.kind()
    );
    log.error(
        Code::WrongType,
        &node.span,
        message,
        format!("write {example}"),
    );
}

impl<T: Read> Read for Option<T> {
    const OPTIONAL: bool = true;

    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        T::read(node, log).map(Some)
    }

    fn absent() -> Option<Self> {
        Some(None)
    }

    fn shape() -> Shape {
        T::shape()
    }
}

impl Read for bool {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        match node.value {
            NodeValue::Boolean(value) => Some(value),
            _ => {
                wrong_type(node, "true or false", "true or false, without quotes", log);
                None
            }
        }
    }

    fn shape() -> Shape {
        Shape::Boolean
    }
}

impl Read for Text {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        match &node.value {
            NodeValue::Text(text) => Some(Located {
                value: text.clone(),
                span: node.span.clone(),
            }),
            _ => {
                wrong_type(node, "a text", "it in quotes", log);
                None
            }
        }
    }

    fn shape() -> Shape {
        Shape::Text
    }
}

impl Read for Count {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        match node.value {
            NodeValue::Integer(value) => match usize::try_from(value) {
                Ok(value) if value > 0 => Some(Located {
                    value,
                    span: node.span.clone(),
                }),
                _ => {
                    let message = format!("`{}` must be at least 1, but is {value}", node.key);
                    log.error(
                        Code::Value,
                        &node.span,
                        message,
                        "write a positive whole number",
                    );
                    None
                }
            },
            NodeValue::Float(value) => {
                let message = format!("`{}` must be a whole number, but is {value}", node.key);
                log.error(
                    Code::WrongType,
                    &node.span,
                    message,
                    "write a positive whole number",
                );
                None
            }
            _ => {
                wrong_type(
                    node,
                    "a whole number",
                    "a positive whole number such as 90",
                    log,
                );
                None
            }
        }
    }

    fn shape() -> Shape {
        Shape::Count
    }
}

impl<T: Read> Read for Vector<T> {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        let NodeValue::Array(items) = &node.value else {
            wrong_type(node, "an array of three values", "[x, y, z]", log);
            return None;
        };
        let [x, y, z] = items.as_slice() else {
            let message = format!("`{}` must have 3 values, but has {}", node.key, items.len());
            log.error(Code::WrongType, &node.span, message, "write [x, y, z]");
            return None;
        };
        let components = [T::read(x, log), T::read(y, log), T::read(z, log)];
        let [Some(x), Some(y), Some(z)] = components else {
            return None;
        };
        Some(Vector {
            components: [x, y, z],
            span: node.span.clone(),
        })
    }

    fn shape() -> Shape {
        Shape::Vector(Box::new(T::shape()))
    }
}

impl<T: Read> Read for Pair<T> {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        let NodeValue::Array(items) = &node.value else {
            wrong_type(node, "an array of two values", "[low, high]", log);
            return None;
        };
        let [low, high] = items.as_slice() else {
            let message = format!("`{}` must have 2 values, but has {}", node.key, items.len());
            log.error(Code::WrongType, &node.span, message, "write [low, high]");
            return None;
        };
        let (low, high) = (T::read(low, log), T::read(high, log));
        Some(Pair {
            items: [low?, high?],
            span: node.span.clone(),
        })
    }

    fn shape() -> Shape {
        Shape::Pair(Box::new(T::shape()))
    }
}

impl<T: Read> Read for Vec<T> {
    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        let NodeValue::Array(items) = &node.value else {
            wrong_type(node, "an array", "[ ... ]", log);
            return None;
        };
        // All items are read before any failure counts, so that all errors are noted.
        let items: Vec<Option<T>> = items.iter().map(|item| T::read(item, log)).collect();
        items.into_iter().collect()
    }

    fn shape() -> Shape {
        Shape::List(Box::new(T::shape()))
    }
}

impl<T: Read> Read for Named<T> {
    const OPTIONAL: bool = true;

    fn read(node: &Node, log: &mut Log) -> Option<Self> {
        let Some(entries) = node.entries() else {
            wrong_type(node, "a table", &format!("[{}.some_name]", node.key), log);
            return Some(Named(Vec::new()));
        };
        let read_item = |(name, node): (&String, &Node)| {
            let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
            if name.is_empty() || !name.chars().all(allowed) {
                let message = format!("`{name}` cannot be a name");
                let help = "names consist of letters, digits, `_` and `-`";
                log.error(Code::Name, &node.key_span, message, help);
            }
            let item = T::read(node, log);
            NamedItem {
                name: name.clone(),
                name_span: node.key_span.clone(),
                item,
            }
        };
        Some(Named(entries.iter().map(read_item).collect()))
    }

    fn absent() -> Option<Self> {
        Some(Named(Vec::new()))
    }

    fn shape() -> Shape {
        Shape::Named(Box::new(T::shape()))
    }
}
