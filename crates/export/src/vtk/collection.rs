//! The collection file (.pvd): which poly-data belongs to which time.

use std::fmt::Write;

/// Files with their times.
#[derive(Debug)]
pub(crate) struct Collection {
    folder: String,
    entries: String,
}

impl Collection {
    /// A collection of files in a folder beside it.
    pub(crate) fn new(folder: &str) -> Self {
        Collection {
            folder: escape(folder),
            entries: String::new(),
        }
    }

    /// Adds a file.
    pub(crate) fn add(&mut self, time_s: f64, part: usize, part_name: &str, file: &str) {
        let folder = &self.folder;
        // Writing into a string does not fail.
        let _ = writeln!(
            self.entries,
            "    <DataSet timestep=\"{time_s}\" group=\"\" part=\"{part}\" name=\"{part_name}\" \
             file=\"{folder}/{file}\"/>"
        );
    }

    /// The text of the file.
    pub(crate) fn text(&self, made_by: &str) -> String {
        format!(
            "<?xml version=\"1.0\"?>\n<!-- {} -->\n<VTKFile type=\"Collection\" version=\"1.0\" \
             byte_order=\"LittleEndian\">\n  <Collection>\n{}  </Collection>\n</VTKFile>\n",
            comment(made_by),
            self.entries
        )
    }
}

/// Text for an attribute.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Text for a comment, which must not hold two hyphens.
pub(crate) fn comment(text: &str) -> String {
    text.replace("--", "- -")
}
