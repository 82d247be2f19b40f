//! Model files that differ from an example in a few values.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::context::{Context, make_folder, read_text, write_text};

/// A model file with other values.
#[derive(Debug, Clone)]
pub(crate) struct Variant {
    table: Table,
    base: PathBuf,
}

impl Variant {
    /// As the example is.
    pub(crate) fn of(context: &Context, example: &str) -> Result<Variant, String> {
        Variant::read(&context.root.join(example))
    }

    /// As the file is.
    pub(crate) fn read(base: &Path) -> Result<Variant, String> {
        let table = read_text(base)?;
        let table = table
            .parse()
            .map_err(|error| format!("{}: {error}", base.display()))?;
        Ok(Variant {
            table,
            base: base.to_owned(),
        })
    }

    /// Sets the value at a path of keys, such as `lines.hose.sections.0.elements`.
    pub(crate) fn set(&mut self, path: &str, value: impl Into<Value>) -> Result<(), String> {
        let wrong = || format!("{} has no place `{path}`", self.base.display());
        let (parents, last) = path.rsplit_once('.').unwrap_or(("", path));
        let error = wrong();
        let table = parents
            .split('.')
            .filter(|key| !key.is_empty())
            .try_fold(Node::Table(&mut self.table), Node::child)
            .ok_or_else(|| error.clone())?;
        match table {
            Node::Table(table) => {
                table.insert(last.to_owned(), value.into());
                Ok(())
            }
            Node::Array(_) => Err(error),
        }
    }

    /// Takes a value away; one that is not there may stay away.
    pub(crate) fn remove(&mut self, table: &str, key: &str) {
        if let Some(Value::Table(table)) = self.table.get_mut(table) {
            table.remove(key);
        }
    }

    /// Takes a whole table away.
    pub(crate) fn remove_all(&mut self, table: &str) {
        self.table.remove(table);
    }

    /// The whole as text.
    pub(crate) fn text(&self) -> Result<String, String> {
        toml::to_string(&self.table).map_err(|error| error.to_string())
    }

    /// Writes it into the work folder.
    pub(crate) fn write(&self, context: &Context, name: &str) -> Result<PathBuf, String> {
        let folder = context.work.join("models");
        make_folder(&folder)?;
        let file = folder.join(format!("{name}.toml"));
        write_text(&file, &self.text()?)?;
        Ok(file)
    }
}

/// Where a path of keys leads.
enum Node<'a> {
    Table(&'a mut Table),
    Array(&'a mut Vec<Value>),
}

impl<'a> Node<'a> {
    fn child(self, key: &str) -> Option<Node<'a>> {
        let value = match self {
            Node::Table(table) => table.get_mut(key)?,
            Node::Array(array) => array.get_mut(key.parse::<usize>().ok()?)?,
        };
        match value {
            Value::Table(table) => Some(Node::Table(table)),
            Value::Array(array) => Some(Node::Array(array)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_set_in_tables_and_lists() {
        let mut variant = Variant {
            table: "[lines.a]\nsections = [{ elements = 3 }]"
                .parse()
                .expect("TOML"),
            base: PathBuf::from("test.toml"),
        };
        variant
            .set("lines.a.sections.0.elements", 7)
            .expect("the place is there");
        assert!(variant.text().expect("TOML").contains("elements = 7"));
        let error = variant.set("lines.b.length", 1).expect_err("no such line");
        assert_eq!(error, "test.toml has no place `lines.b.length`");
    }
}
