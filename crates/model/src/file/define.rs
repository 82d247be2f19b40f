//! Macros that define a table of the model file once: its struct, reader and shape.

/// Defines a table: a struct whose fields are the keys and whose doc comments are their meanings.
///
/// `field: Type` must be written (unless the type is optional); `field: Type = default` may be left
/// out.
macro_rules! table {
    (
        $(#[doc = $table_doc:literal])*
        pub(super) struct $name:ident {
            $(
                $(#[doc = $doc:literal])*
                $field:ident: $type:ty $(= $default:expr)?,
            )*
        }
    ) => {
        $(#[doc = $table_doc])*
        #[derive(Debug, Clone)]
        pub(in crate::file) struct $name {
            $( $(#[doc = $doc])* pub $field: $type, )*
            /// Where the table's key was written; not every table is blamed for anything.
            #[allow(dead_code)]
            pub key_span: $crate::file::node::Span,
        }

        impl $crate::file::read::ReadTable for $name {
            const KEYS: &'static [&'static str] =
                &[$($crate::file::define::key_of(stringify!($field))),*];

            fn read_beside(
                node: &$crate::file::node::Node,
                others: &[&str],
                log: &mut $crate::file::log::Log,
            ) -> Option<Self> {
                use $crate::file::define::key_of;
                let keys = <Self as $crate::file::read::ReadTable>::KEYS;
                let table = $crate::file::read::TableReader::open(node, keys, others, log)?;
                // Every field is read before any failure counts, so that all errors are noted.
                $(
                    let $field: Option<$type> = table.field(
                        key_of(stringify!($field)),
                        $crate::file::define::default_of!($($default)?),
                        log,
                    );
                )*
                Some($name { $($field: $field?,)* key_span: node.key_span.clone() })
            }

            fn table_shape() -> $crate::file::shape::TableShape {
                use $crate::file::{define, node::NodeValue, read::Read, shape};
                shape::TableShape {
                    doc: shape::join_doc(&[$($table_doc),*]),
                    fields: vec![$({
                        let default: Option<NodeValue> = define::default_of!($($default)?);
                        shape::FieldShape {
                            key: define::key_of(stringify!($field)),
                            doc: shape::join_doc(&[$($doc),*]),
                            required: default.is_none() && !<$type as Read>::OPTIONAL,
                            default: default.map(|value| value.to_string()),
                            shape: <$type as Read>::shape(),
                        }
                    }),*],
                }
            }
        }

        impl $crate::file::read::Read for $name {
            fn read(
                node: &$crate::file::node::Node,
                log: &mut $crate::file::log::Log,
            ) -> Option<Self> {
                <Self as $crate::file::read::ReadTable>::read_beside(node, &[], log)
            }

            fn shape() -> $crate::file::shape::Shape {
                $crate::file::shape::Shape::Table(
                    <Self as $crate::file::read::ReadTable>::table_shape(),
                )
            }
        }
    };
}

/// Defines a table whose keys depend on the word under `kind`.
macro_rules! kinds {
    (
        $(#[doc = $doc:literal])*
        pub(super) enum $name:ident { $($word:literal => $variant:ident($table:ty),)* }
    ) => {
        $(#[doc = $doc])*
        // A file has few of them, each read once: their size does not matter.
        #[allow(clippy::large_enum_variant)]
        #[derive(Debug, Clone)]
        pub(in crate::file) enum $name {
            $(#[doc = concat!("`kind = \"", $word, "\"`.")] $variant($table),)*
        }

        impl $crate::file::read::Read for $name {
            fn read(
                node: &$crate::file::node::Node,
                log: &mut $crate::file::log::Log,
            ) -> Option<Self> {
                use $crate::file::read::ReadTable;
                match $crate::file::define::read_kind(node, &[$($word),*], log)? {
                    $($word => <$table>::read_beside(node, &["kind"], log).map($name::$variant),)*
                    _ => None,
                }
            }

            fn shape() -> $crate::file::shape::Shape {
                use $crate::file::read::ReadTable;
                $crate::file::shape::Shape::Kinds(vec![$(($word, <$table>::table_shape())),*])
            }
        }
    };
}

/// Defines a choice among a few words.
macro_rules! choice {
    (
        $(#[doc = $doc:literal])*
        pub(super) enum $name:ident {
            $( #[doc = $variant_doc:literal] $variant:ident = $word:literal, )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub(in crate::file) enum $name {
            $( #[doc = $variant_doc] $variant, )*
        }

        impl $crate::file::read::Read for $name {
            fn read(
                node: &$crate::file::node::Node,
                log: &mut $crate::file::log::Log,
            ) -> Option<Self> {
                match $crate::file::define::read_word(node, &[$($word),*], log)? {
                    $($word => Some($name::$variant),)*
                    _ => None,
                }
            }

            fn shape() -> $crate::file::shape::Shape {
                $crate::file::shape::Shape::Choice(&[$(($word, $variant_doc)),*])
            }
        }
    };
}

/// The default of a field as a node, if it has one.
macro_rules! default_of {
    () => {
        None
    };
    ($default:expr) => {
        Some($crate::file::node::NodeValue::from($default))
    };
}

pub(super) use {choice, default_of, kinds, table};

use super::diagnostic::DiagnosticCode as Code;
use super::log::{Log, closest, one_of};
use super::node::{Node, NodeValue};
use super::read::wrong_type;

/// The key of a field: its name, without the `r#` of a Rust keyword.
pub(super) const fn key_of(field: &'static str) -> &'static str {
    match field.as_bytes() {
        [b'r', b'#', ..] => field.split_at(2).1,
        _ => field,
    }
}

/// Reads one of a few words.
pub(super) fn read_word<'a>(node: &Node, words: &[&'a str], log: &mut Log) -> Option<&'a str> {
    let all = one_of(words.iter().copied());
    let NodeValue::Text(text) = &node.value else {
        wrong_type(node, "a word in quotes", &format!("one of {all}"), log);
        return None;
    };
    let found = words.iter().find(|word| *word == text);
    if found.is_none() {
        let message = format!("`{}` cannot be `{text}`", node.key);
        let help = match closest(text, words.iter().copied()) {
            Some(word) => format!("did you mean `{word}`? It is one of {all}"),
            None => format!("write {all}"),
        };
        log.error(Code::Value, &node.span, message, help);
    }
    found.copied()
}

/// Reads the word under `kind`.
pub(super) fn read_kind<'a>(node: &Node, words: &[&'a str], log: &mut Log) -> Option<&'a str> {
    let Some(entries) = node.entries() else {
        wrong_type(node, "a table", &format!("[... .{}]", node.key), log);
        return None;
    };
    let Some(kind) = entries.get("kind") else {
        let message = format!("`kind` is missing in `{}`", node.key);
        let help = format!(
            "write kind = {}",
            one_of(words.iter().copied()).replace('`', "\"")
        );
        log.error(Code::MissingKey, &node.key_span, message, help);
        return None;
    };
    read_word(kind, words, log)
}
