//! Tables as comma-separated values: one row of headings, then numbers that read back as they were.

use std::io::Write;

use csv::{ErrorKind, Writer, WriterBuilder};

use crate::ExportError;
use crate::meter::Meter;
use crate::output::PartialFile;
use crate::table::{Kind, Table, Values};

/// Writes a table and returns the size of the file.
///
/// A number has the fewest digits that give the same number again, in its own precision; one that
/// does not exist is an empty cell.
pub(crate) fn write(
    table: &dyn Table,
    file: PartialFile,
    meter: &Meter<'_>,
) -> Result<u64, ExportError> {
    let path = file.path().to_path_buf();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let failed = |error: csv::Error| match error.into_kind() {
        ErrorKind::Io(source) => ExportError::write(&path, source),
        other => ExportError::write(&path, std::io::Error::other(format!("{other:?}"))),
    };
    let mut writer = WriterBuilder::new().from_writer(file);
    let columns = table.columns();
    let headings = columns.iter().map(|column| column.column.as_str());
    writer.write_record(headings).map_err(failed)?;
    let mut text = Vec::new();
    for (piece, rows) in table.pieces().iter().enumerate() {
        let values = (0..columns.len())
            .map(|column| table.read(column, piece))
            .collect::<Result<Vec<_>, _>>()?;
        for row in 0..*rows {
            for (column, values) in columns.iter().zip(&values) {
                match values {
                    Values::Numbers(numbers) => {
                        text.clear();
                        push_number(&mut text, numbers[row], column.kind);
                        writer.write_field(&text).map_err(failed)?;
                    }
                    Values::Texts(texts) => writer.write_field(texts[row]).map_err(failed)?,
                }
            }
            end_row(&mut writer).map_err(failed)?;
        }
        meter.add(&name, rows * columns.len())?;
    }
    match writer.into_inner() {
        Ok(file) => file.commit(),
        Err(error) => Err(ExportError::write(&path, error.into_error())),
    }
}

fn end_row(writer: &mut Writer<PartialFile>) -> Result<(), csv::Error> {
    writer.write_record(None::<&[u8]>)
}

fn push_number(text: &mut Vec<u8>, value: f64, kind: Kind) {
    // Far from 1 the plain notation would be a long row of zeros.
    let plain = value == 0.0 || (1e-5..1e16).contains(&value.abs());
    // Writing into memory does not fail.
    let _ = match (value.is_finite(), kind, plain) {
        (false, ..) if value.is_nan() => Ok(()),
        (false, ..) => write!(text, "{value}"),
        (_, Kind::Float32, true) => write!(text, "{}", value as f32),
        (_, Kind::Float32, false) => write!(text, "{:e}", value as f32),
        (_, _, true) => write!(text, "{value}"),
        (_, _, false) => write!(text, "{value:e}"),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(value: f64, kind: Kind) -> String {
        let mut text = Vec::new();
        push_number(&mut text, value, kind);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn numbers_come_back_to_the_last_bit() {
        for value in [
            0.1,
            -1.0 / 3.0,
            1e-300,
            f64::MAX,
            f64::MIN_POSITIVE,
            123_456.789e-9,
            9.87654321e15,
            -0.0,
        ] {
            let read: f64 = text(value, Kind::Float64).parse().unwrap();
            assert_eq!(read.to_bits(), value.to_bits());
            let single = value as f32;
            let read: f32 = text(f64::from(single), Kind::Float32).parse().unwrap();
            assert_eq!(read.to_bits(), single.to_bits());
        }
        assert_eq!(text(f64::from(0.1_f32), Kind::Float32), "0.1");
        assert_eq!(text(1e-9, Kind::Float64), "1e-9");
        assert_eq!(text(f64::NAN, Kind::Float64), "");
        assert_eq!(text(f64::NEG_INFINITY, Kind::Float64), "-inf");
    }
}
