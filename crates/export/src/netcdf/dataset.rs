//! The variables of a load case: histories, curves over arc length, and fields as records.

use std::ops::Range;

use catenix_results::{LinePlace, StoredRows};

use super::classic::{Attribute, Dimension, Header, Variable, Width, legal_name};
use crate::ExportError;
use crate::contents::CaseContents;
use crate::meter::Meter;
use crate::output::PartialFile;
use crate::provenance::Provenance;
use crate::tables::pieces;

/// Conventions that the metadata follow.
const CONVENTIONS: &str = "CF-1.11";

/// A header, and where the numbers of each variable come from.
pub(crate) struct Dataset {
    header: Header,
    /// Per variable.
    sources: Vec<Source>,
    history_pieces: Vec<Range<usize>>,
    history_rows: Vec<usize>,
    field_pieces: Vec<Range<usize>>,
    field_rows: Vec<usize>,
}

enum Source {
    /// A curve over arc length.
    Curve(Vec<f64>),
    /// The wanted rows of a history.
    History(StoredRows),
    /// The wanted rows of a field or of its times.
    Field(StoredRows),
}

impl Dataset {
    /// Opens everything that is stored of the wanted lines, and all histories.
    pub(crate) fn open(
        contents: &CaseContents,
        provenance: &Provenance,
    ) -> Result<Self, ExportError> {
        let mut builder = Builder::default();
        let chunk_rows = |rows: Option<&StoredRows>| rows.map_or(1, StoredRows::chunk_rows);
        builder.header.attributes = global_attributes(contents, provenance);
        let histories = builder.histories(contents)?;
        let fields = builder.fields(contents)?;
        builder.curves(contents)?;
        builder.header.records = contents.field_rows.len();
        Ok(Dataset {
            header: builder.header,
            sources: builder.sources,
            history_pieces: pieces(&contents.history_rows, chunk_rows(histories.as_ref())),
            history_rows: contents.history_rows.clone(),
            field_pieces: pieces(&contents.field_rows, chunk_rows(fields.as_ref())),
            field_rows: contents.field_rows.clone(),
        })
    }

    /// What the format has no room for, in words.
    pub(crate) fn too_large(&self) -> Option<String> {
        self.header.too_large()
    }

    /// Number of records: times of the fields.
    pub(crate) fn records(&self) -> usize {
        self.header.records
    }

    /// Number of variables.
    pub(crate) fn variables(&self) -> usize {
        self.header.variables.len()
    }

    /// Number of values.
    pub(crate) fn values(&self) -> u64 {
        let values = |variable: &Variable| {
            let records = match self.header.has_records(variable) {
                true => self.header.records as u64,
                false => 1,
            };
            records * self.header.values(variable)
        };
        self.header.variables.iter().map(values).sum()
    }

    /// Writes header, variables of fixed size, and records.
    pub(crate) fn write(
        &self,
        file: &mut PartialFile,
        meter: &Meter<'_>,
    ) -> Result<(), ExportError> {
        let path = file.path().to_path_buf();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        file.put(&self.header.to_bytes())?;
        let mut bytes = Vec::new();
        for (variable, source) in self.header.variables.iter().zip(&self.sources) {
            let mut put = |values: &[f64]| -> Result<(), ExportError> {
                bytes.clear();
                variable.width.push(&mut bytes, values);
                file.put(&bytes)?;
                meter.add(&name, values.len())
            };
            match source {
                Source::Curve(values) => put(values)?,
                Source::History(stored) => {
                    for piece in &self.history_pieces {
                        put(&stored.read(&self.history_rows[piece.clone()])?)?;
                    }
                }
                Source::Field(_) => {}
            }
        }
        for piece in &self.field_pieces {
            self.write_records(piece, file, meter, &name)?;
        }
        Ok(())
    }

    /// Writes records that lie in one chunk of every field.
    fn write_records(
        &self,
        piece: &Range<usize>,
        file: &mut PartialFile,
        meter: &Meter<'_>,
        name: &str,
    ) -> Result<(), ExportError> {
        let rows = &self.field_rows[piece.clone()];
        let mut fields = Vec::new();
        for (variable, source) in self.header.variables.iter().zip(&self.sources) {
            if let Source::Field(stored) = source {
                fields.push((variable.width, stored.row_len(), stored.read(rows)?));
            }
        }
        let mut bytes = Vec::new();
        for record in 0..rows.len() {
            bytes.clear();
            let mut values = 0;
            for (width, len, field) in &fields {
                width.push(&mut bytes, &field[record * len..(record + 1) * len]);
                values += len;
            }
            file.put(&bytes)?;
            meter.add(name, values)?;
        }
        Ok(())
    }
}

#[derive(Default)]
struct Builder {
    header: Header,
    sources: Vec<Source>,
    /// Dimension of the arc length of each wanted line.
    nodes: Vec<usize>,
}

impl Builder {
    /// Adds times and channels; returns the times.
    fn histories(&mut self, contents: &CaseContents) -> Result<Option<StoredRows>, ExportError> {
        if contents.history_rows.is_empty() {
            return Ok(None);
        }
        let time = self.dimension("time", Some(contents.history_rows.len()));
        let stored = contents.stored.history_time()?;
        let mut attributes = attributes("s", "time");
        attributes.push(Attribute::text("axis", "T"));
        let source = Source::History(stored.clone());
        self.variable("time", &[time], Width::Double, attributes, source);
        for channel in &contents.description.channels {
            let rows = contents.stored.channel_rows(&channel.name)?;
            let attributes = self::attributes(&channel.unit, &rows.long_name());
            let source = Source::History(rows);
            self.variable(&channel.name, &[time], Width::Double, attributes, source);
        }
        Ok(Some(stored))
    }

    /// Adds arc lengths, times and fields; returns the times.
    fn fields(&mut self, contents: &CaseContents) -> Result<Option<StoredRows>, ExportError> {
        for line in &contents.lines {
            let name = format!("{}.arc_length", line.name);
            let nodes = self.dimension(&name, Some(line.arc_length.rows));
            self.nodes.push(nodes);
            let text = format!("{}: unstretched distance from end A", line.name);
            let values = contents.stored.arc_length_m(&line.name)?;
            let source = Source::Curve(values);
            self.variable(
                &name,
                &[nodes],
                Width::Double,
                attributes("m", &text),
                source,
            );
        }
        let Some(first) = contents.lines.first() else {
            return Ok(None);
        };
        let record = self.dimension("field_time", None);
        let times = contents.stored.field_time(&first.name)?;
        let mut time_attributes = attributes("s", "time of the fields");
        time_attributes.push(Attribute::text("axis", "T"));
        let source = Source::Field(times.clone());
        self.variable(
            "field_time",
            &[record],
            Width::Double,
            time_attributes,
            source,
        );
        for (line, nodes) in contents.lines.iter().zip(self.nodes.clone()) {
            for quantity in &line.quantities {
                let name = format!("{}.{}", line.name, quantity.name);
                let text = format!("{}: {}", line.name, quantity.long_name);
                let mut attributes = attributes(quantity.unit, &text);
                attributes.extend(coordinates(line, quantity.name));
                let rows = contents.stored.field_rows(&line.name, quantity.name)?;
                let source = Source::Field(rows);
                self.variable(&name, &[record, nodes], Width::Float, attributes, source);
            }
        }
        Ok(Some(times))
    }

    /// Adds the static state and the range graphs.
    fn curves(&mut self, contents: &CaseContents) -> Result<(), ExportError> {
        for (line, nodes) in contents.lines.iter().zip(self.nodes.clone()) {
            for place in &line.quantities {
                let quantity = contents.stored.quantity(&line.name, place.name)?;
                let mut add = |name: String, text: &str, method: Option<&str>, curve: Vec<f64>| {
                    let name = format!("{}.{name}", line.name);
                    let text = format!("{}: {}, {text}", line.name, place.long_name);
                    let mut attributes = attributes(place.unit, &text);
                    let method = method.map(|method| format!("time: {method}"));
                    attributes.extend(method.map(|method| Attribute::text("cell_methods", method)));
                    self.variable(
                        &name,
                        &[nodes],
                        Width::Double,
                        attributes,
                        Source::Curve(curve),
                    );
                };
                let name = place.name;
                if place.static_state.is_some() {
                    let values = contents.stored.static_state(&line.name, quantity)?;
                    add(format!("static_{name}"), "static", None, values);
                }
                if contents.description.progress.field_rows == 0 {
                    continue;
                }
                let envelope = contents.stored.envelope(&line.name, quantity)?;
                let window = match envelope.every_step {
                    true => "over the statistics window",
                    false => "of the stored rows",
                };
                let run = "over the whole run";
                let (min, max) = (Some("minimum"), Some("maximum"));
                let words = |curve: &str, over: &str| format!("{curve} {over}");
                add(
                    format!("{name}_min"),
                    &words("smallest", window),
                    min,
                    envelope.min,
                );
                add(
                    format!("{name}_mean"),
                    &words("mean", window),
                    Some("mean"),
                    envelope.mean,
                );
                add(
                    format!("{name}_max"),
                    &words("largest", window),
                    max,
                    envelope.max,
                );
                if place.has_range_graph {
                    let graph = contents.stored.range_graph(&line.name, quantity)?;
                    let method = Some("standard_deviation");
                    let text = words("standard deviation", window);
                    add(format!("{name}_std"), &text, method, graph.std);
                }
                add(
                    format!("{name}_run_min"),
                    &words("smallest", run),
                    min,
                    envelope.run_min,
                );
                add(
                    format!("{name}_run_max"),
                    &words("largest", run),
                    max,
                    envelope.run_max,
                );
            }
        }
        Ok(())
    }

    fn dimension(&mut self, name: &str, length: Option<usize>) -> usize {
        self.header.dimensions.push(Dimension {
            name: legal_name(name),
            length,
        });
        self.header.dimensions.len() - 1
    }

    fn variable(
        &mut self,
        name: &str,
        dimensions: &[usize],
        width: Width,
        attributes: Vec<Attribute>,
        source: Source,
    ) {
        self.header.variables.push(Variable {
            name: legal_name(name),
            dimensions: dimensions.to_vec(),
            attributes,
            width,
        });
        self.sources.push(source);
    }
}

fn global_attributes(contents: &CaseContents, provenance: &Provenance) -> Vec<Attribute> {
    let mut attributes = vec![
        Attribute::text("Conventions", CONVENTIONS),
        Attribute::text("source", provenance.made_by()),
        Attribute::text("comment", provenance.get("note")),
    ];
    let pairs = provenance.pairs().into_iter();
    attributes.extend(pairs.map(|(key, value)| Attribute::text(key, value)));
    if let Some(window_s) = contents.description.window_s {
        attributes.push(Attribute::numbers("statistics_window_s", &window_s));
    }
    // The format has no empty text that every reader takes.
    attributes
        .retain(|attribute| attribute.value != super::classic::AttributeValue::Text(String::new()));
    attributes
}

fn attributes(units: &str, long_name: &str) -> Vec<Attribute> {
    vec![
        Attribute::text("units", cf_units(units)),
        Attribute::text("long_name", long_name),
    ]
}

/// Where in space the values of a field are.
fn coordinates(line: &LinePlace, quantity: &str) -> Option<Attribute> {
    // Names with blanks cannot stand in a list that blanks divide.
    if ["x", "y", "z"].contains(&quantity) || line.name.contains(char::is_whitespace) {
        return None;
    }
    let names = ["x", "y", "z"].map(|axis| legal_name(&format!("{}.{axis}", line.name)));
    Some(Attribute::text("coordinates", names.join(" ")))
}

/// A unit as UDUNITS, which CF refers to, spells it.
fn cf_units(unit: &str) -> &str {
    match unit {
        "deg" => "degree",
        "1/m" => "m-1",
        other => other,
    }
}
