//! Tables as Parquet: typed columns with their units in the metadata of the file.

use std::path::Path;
use std::sync::Arc;

use parquet::basic::{
    Compression, ConvertedType, Encoding, LogicalType, Repetition, Type as Storage,
};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnPath, Type};

use crate::ExportError;
use crate::meter::Meter;
use crate::output::PartialFile;
use crate::provenance::Provenance;
use crate::table::{Column, Kind, Table, Values};

/// Least rows of a row group, where the table has so many: few groups read fast, and one column of
/// one group is all that is in memory.
const GROUP_ROWS: usize = 1 << 17;

/// Writes a table and returns the size of the file.
pub(crate) fn write(
    table: &dyn Table,
    file: PartialFile,
    provenance: &Provenance,
    meter: &Meter<'_>,
) -> Result<u64, ExportError> {
    let path = file.path().to_path_buf();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let failed = |error| write_error(&path, error);
    let columns = table.columns();
    let schema = schema(columns).map_err(failed)?;
    let properties = Arc::new(properties(columns, provenance));
    let mut writer = SerializedFileWriter::new(file, schema, properties).map_err(failed)?;
    for group in groups(table.pieces()) {
        let mut row_group = writer.next_row_group().map_err(failed)?;
        let mut index = 0;
        while let Some(mut column) = row_group.next_column().map_err(failed)? {
            for piece in group.clone() {
                let values = table.read(index, piece)?;
                write_values(&mut column, columns[index].kind, &values).map_err(failed)?;
                meter.add(&name, table.pieces()[piece])?;
            }
            column.close().map_err(failed)?;
            index += 1;
        }
        row_group.close().map_err(failed)?;
    }
    writer.into_inner().map_err(failed)?.commit()
}

/// Pieces that make up each row group.
fn groups(pieces: &[usize]) -> Vec<std::ops::Range<usize>> {
    let mut groups = Vec::new();
    let (mut start, mut rows) = (0, 0);
    for (piece, piece_rows) in pieces.iter().enumerate() {
        rows += piece_rows;
        if rows >= GROUP_ROWS || piece + 1 == pieces.len() {
            groups.push(start..piece + 1);
            (start, rows) = (piece + 1, 0);
        }
    }
    groups
}

fn schema(columns: &[Column]) -> Result<Arc<Type>, ParquetError> {
    let fields = columns.iter().map(|column| {
        let storage = match column.kind {
            Kind::Float64 => Storage::DOUBLE,
            Kind::Float32 => Storage::FLOAT,
            Kind::Text => Storage::BYTE_ARRAY,
        };
        let builder = Type::primitive_type_builder(&column.column, storage)
            .with_repetition(Repetition::REQUIRED);
        let builder = match column.kind {
            Kind::Text => builder
                .with_converted_type(ConvertedType::UTF8)
                .with_logical_type(Some(LogicalType::String)),
            _ => builder,
        };
        Ok(Arc::new(builder.build()?))
    });
    let fields = fields.collect::<Result<Vec<_>, ParquetError>>()?;
    let schema = Type::group_type_builder("schema").with_fields(fields);
    Ok(Arc::new(schema.build()?))
}

fn properties(columns: &[Column], provenance: &Provenance) -> WriterProperties {
    let metadata = provenance
        .pairs()
        .into_iter()
        .map(|(key, value)| KeyValue::new(format!("catenix_{key}"), value))
        .chain([KeyValue::new(
            "catenix_columns".to_owned(),
            serde_json::to_string(columns).unwrap_or_default(),
        )]);
    let mut builder = WriterProperties::builder()
        .set_created_by(provenance.made_by())
        .set_key_value_metadata(Some(metadata.collect()))
        .set_compression(Compression::SNAPPY)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_dictionary_enabled(false);
    for column in columns {
        let path = ColumnPath::new(vec![column.column.clone()]);
        builder = match column.kind {
            // Words are few and come in long rows.
            Kind::Text => builder.set_column_dictionary_enabled(path, true),
            // Neighbouring floats share their leading bytes: beside each other these compress.
            _ => builder.set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT),
        };
    }
    builder.build()
}

fn write_values(
    column: &mut SerializedColumnWriter<'_>,
    kind: Kind,
    values: &Values<'_>,
) -> Result<usize, ParquetError> {
    match (kind, values) {
        (Kind::Float32, Values::Numbers(numbers)) => {
            let singles: Vec<f32> = numbers.iter().map(|value| *value as f32).collect();
            column
                .typed::<FloatType>()
                .write_batch(&singles, None, None)
        }
        (_, Values::Numbers(numbers)) => column
            .typed::<DoubleType>()
            .write_batch(numbers, None, None),
        (_, Values::Texts(texts)) => {
            let words: Vec<ByteArray> = texts.iter().map(|text| ByteArray::from(*text)).collect();
            column
                .typed::<ByteArrayType>()
                .write_batch(&words, None, None)
        }
    }
}

/// What the operating system said is inside of what the library says.
fn write_error(path: &Path, error: ParquetError) -> ExportError {
    let source = match error {
        ParquetError::External(inner) => match inner.downcast::<std::io::Error>() {
            Ok(source) => *source,
            Err(other) => std::io::Error::other(other.to_string()),
        },
        other => std::io::Error::other(other.to_string()),
    };
    ExportError::write(path, source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pieces_share_a_group_and_none_is_lost() {
        assert_eq!(groups(&[10, 10, GROUP_ROWS, 5]), [0..3, 3..4]);
        assert_eq!(groups(&[GROUP_ROWS, 1, GROUP_ROWS, 5]), [0..1, 1..3, 3..4]);
        assert!(groups(&[]).is_empty());
    }

    #[test]
    fn a_full_disk_is_told_in_the_words_of_the_operating_system() {
        let full = std::io::Error::from(std::io::ErrorKind::StorageFull);
        let error = write_error(
            Path::new("a.parquet"),
            ParquetError::External(Box::new(full)),
        );
        assert!(error.to_string().contains("free some space"), "{error}");
    }
}
