//! Motion histories from CSV files.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::Motion;
use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::{Log, closest, one_of};
use crate::file::read::Text;

/// Largest CSV file that is read, in bytes.
const MOST_BYTES: u64 = 256 << 20;
/// Most errors reported for one CSV file.
const MOST_ERRORS: usize = 10;
/// Columns of a history, after `time_s`, in the order of [`Motion::History`].
const COLUMNS: [&str; 6] = [
    "surge_m",
    "sway_m",
    "heave_m",
    "roll_deg",
    "pitch_deg",
    "yaw_deg",
];
const TIME: &str = "time_s";

/// What is wrong with a CSV file, with its remedy.
type CsvError = (String, String);

/// The CSV files read so far; load cases share them.
pub(in crate::file) struct Histories {
    base_dir: PathBuf,
    read: HashMap<PathBuf, Result<Motion, Vec<CsvError>>>,
}

impl Histories {
    /// Files are found relative to `base_dir`, the folder of the model file.
    pub fn new(base_dir: &Path) -> Self {
        Histories {
            base_dir: base_dir.to_owned(),
            read: HashMap::new(),
        }
    }

    /// The history in a file; `None` after noting what is wrong with it.
    pub fn read(&mut self, file: &Text, log: &mut Log) -> Option<Motion> {
        let path = self.base_dir.join(&file.value);
        let read = || read_text(&path).and_then(|text| parse_history(&text));
        let result = self.read.entry(path.clone()).or_insert_with(read);
        match result {
            Ok(motion) => Some(motion.clone()),
            Err(errors) => {
                for (message, help) in errors {
                    log.error(
                        Code::Csv,
                        &file.span,
                        format!("{}: {message}", file.value),
                        &*help,
                    );
                }
                None
            }
        }
    }
}

fn read_text(path: &Path) -> Result<String, Vec<CsvError>> {
    let fail = |message: String, help: &str| Err(vec![(message, help.to_owned())]);
    let relative = "the path is relative to the folder of the model file";
    let metadata = match std::fs::metadata(path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return fail("there is no such file".to_owned(), relative);
        }
        Err(error) => return fail(format!("cannot be read: {error}"), relative),
    };
    if !metadata.is_file() {
        return fail("is not a file".to_owned(), relative);
    }
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    if let Err(error) = read {
        return fail(format!("cannot be read: {error}"), relative);
    }
    if bytes.len() as u64 > MOST_BYTES {
        return fail(
            format!("is larger than {} MiB", MOST_BYTES >> 20),
            "a history needs some twenty points per period",
        );
    }
    match String::from_utf8(bytes) {
        Ok(text) if !text.contains('\0') => Ok(text),
        _ => fail(
            "is not a text file".to_owned(),
            "write comma-separated text in UTF-8",
        ),
    }
}

/// Reads a history; every error names line and column.
fn parse_history(text: &str) -> Result<Motion, Vec<CsvError>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let Some((header_line, header)) = lines.next() else {
        let help = format!("the first row names the columns: {TIME},heave_m");
        return Err(vec![("is empty".to_owned(), help)]);
    };
    let columns = parse_header(header_line, header)?;
    let mut time: Vec<f64> = Vec::new();
    let mut values: [Vec<f64>; 6] = Default::default();
    let mut errors = Vec::new();
    for (number, line) in lines {
        match parse_row(number, line, &columns, header) {
            Ok(row) => {
                for (column, value) in columns.iter().zip(row) {
                    match column {
                        Column::Time => {
                            if let Some(before) = time.last()
                                && value <= *before
                            {
                                let message = format!(
                                    "line {number}: time {value} s does not come after {before} s"
                                );
                                errors.push((message, "times must increase".to_owned()));
                            }
                            time.push(value);
                        }
                        Column::Value(index) if *index >= 3 => {
                            values[*index].push(value.to_radians());
                        }
                        Column::Value(index) => values[*index].push(value),
                    }
                }
            }
            Err(error) => errors.push(error),
        }
        if errors.len() >= MOST_ERRORS {
            errors.push((
                "and possibly more".to_owned(),
                "correct the rows above first".to_owned(),
            ));
            break;
        }
    }
    if errors.is_empty() && time.len() < 2 {
        let message = format!(
            "has {} row of values, but a history needs at least 2",
            time.len()
        );
        errors.push((message, "add points in time".to_owned()));
    }
    if errors.is_empty() {
        Ok(Motion::History { time, values })
    } else {
        Err(errors)
    }
}

/// Meaning of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Column {
    Time,
    Value(usize),
}

fn parse_header(number: usize, header: &str) -> Result<Vec<Column>, Vec<CsvError>> {
    let known = || std::iter::once(TIME).chain(COLUMNS);
    let mut errors = Vec::new();
    let mut columns = Vec::new();
    for (index, name) in header.split(',').map(str::trim).enumerate() {
        let column = match COLUMNS.iter().position(|column| *column == name) {
            Some(position) => Column::Value(position),
            None if name == TIME => Column::Time,
            None => {
                let message = format!(
                    "line {number}, column {}: unknown column `{name}`",
                    index + 1
                );
                let help = match closest(name, known()) {
                    Some(column) => format!("did you mean `{column}`?"),
                    None => format!("columns are {}", one_of(known())),
                };
                errors.push((message, help));
                continue;
            }
        };
        if columns.contains(&column) {
            let message = format!(
                "line {number}, column {}: `{name}` is there twice",
                index + 1
            );
            errors.push((message, "remove one of them".to_owned()));
        }
        columns.push(column);
    }
    if !columns.contains(&Column::Time) && errors.is_empty() {
        let message = format!("line {number}: there is no column `{TIME}`");
        errors.push((
            message,
            format!("the first row names the columns: {TIME},heave_m"),
        ));
    }
    if columns.len() < 2 && errors.is_empty() {
        let message = format!("line {number}: there is no motion beside the time");
        errors.push((message, format!("add one of {}", one_of(COLUMNS))));
    }
    if errors.is_empty() {
        Ok(columns)
    } else {
        Err(errors)
    }
}

fn parse_row(
    number: usize,
    line: &str,
    columns: &[Column],
    header: &str,
) -> Result<Vec<f64>, CsvError> {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    if cells.len() != columns.len() {
        let message = format!(
            "line {number}: {} values, but there are {} columns",
            cells.len(),
            columns.len()
        );
        return Err((message, format!("write one value for each of {header}")));
    }
    let parse = |(index, cell): (usize, &&str)| match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => {
            let name = header.split(',').nth(index).unwrap_or("").trim();
            let message = format!(
                "line {number}, column {} ({name}): `{cell}` is not a finite number",
                index + 1
            );
            Err((
                message,
                "write a plain decimal number; the unit is in the column's name".to_owned(),
            ))
        }
    };
    cells.iter().enumerate().map(parse).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(text: &str) -> Vec<String> {
        let errors = parse_history(text).unwrap_err();
        errors.into_iter().map(|(message, _)| message).collect()
    }

    #[test]
    fn reads_columns_in_any_order() {
        let text = "\u{feff}# recorded\nheave_m, time_s ,yaw_deg\n0.5,0,0\r\n1.5,1,90\n\n";
        let Motion::History { time, values } = parse_history(text).unwrap() else {
            panic!()
        };
        assert_eq!(time, [0.0, 1.0]);
        assert_eq!(values[2], [0.5, 1.5]);
        assert_eq!(values[5], [0.0, 90f64.to_radians()]);
        assert!(values[0].is_empty());
    }

    #[test]
    fn errors_name_line_and_column() {
        let text = "time_s,heave_m\n0,0\n1,abc\n2\n1.5,0\n1.2,nan\n1.1,0\n";
        assert_eq!(
            errors(text),
            [
                "line 3, column 2 (heave_m): `abc` is not a finite number",
                "line 4: 1 values, but there are 2 columns",
                "line 6, column 2 (heave_m): `nan` is not a finite number",
                "line 7: time 1.1 s does not come after 1.5 s",
            ]
        );
        assert_eq!(
            errors("time_s,heave\n"),
            ["line 1, column 2: unknown column `heave`"]
        );
        assert_eq!(
            errors("surge_m,heave_m\n0,0\n"),
            ["line 1: there is no column `time_s`"]
        );
        assert_eq!(
            errors("time_s\n0\n"),
            ["line 1: there is no motion beside the time"]
        );
        assert_eq!(errors("time_s,heave_m\n0,0\n").len(), 1);
        assert_eq!(errors("time_s,heave_m,heave_m\n0,0,0\n").len(), 1);
        assert_eq!(errors(""), ["is empty"]);
        assert_eq!(
            errors(&format!("time_s,heave_m\n{}", "x,y\n".repeat(100))).len(),
            MOST_ERRORS + 1
        );
    }
}
