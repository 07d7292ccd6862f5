//! Rows as Apache Parquet, by the low interface of the crate `parquet`: columns of numbers, without Arrow.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::block::Block;
use super::error::SweepError;
use super::plan::Plan;

/// The file of a block.
pub(super) fn content(plan: &Plan, block: &Block) -> Result<Vec<u8>, SweepError> {
    written(plan, block).map_err(|error| SweepError::Parquet { source: Box::new(error) })
}

fn written(plan: &Plan, block: &Block) -> Result<Vec<u8>, ParquetError> {
    let all = plan.columns();
    let kind = |place: usize| match place {
        0 => (Physical::INT64, None),
        place if place + 1 == all.len() => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        _ => (Physical::DOUBLE, None),
    };
    let is_required = |place: usize| place <= plan.axes.len();
    let mut fields = Vec::new();
    for (place, column) in all.iter().enumerate() {
        let (physical, logical) = kind(place);
        let repetition = if is_required(place) { Repetition::REQUIRED } else { Repetition::OPTIONAL };
        let field = Type::primitive_type_builder(&column.name, physical)
            .with_repetition(repetition)
            .with_logical_type(logical);
        fields.push(Arc::new(field.build()?));
    }
    let schema = Arc::new(Type::group_type_builder("rows").with_fields(fields).build()?);
    let units = all.iter().filter(|column| !column.unit.is_empty());
    let mut metadata = vec![
        KeyValue::new("guen.sweep".to_owned(), plan.text.clone()),
        KeyValue::new("guen.digest".to_owned(), plan.digest.clone()),
        KeyValue::new("guen.declaration".to_owned(), plan.declaration.clone()),
    ];
    metadata
        .extend(units.map(|column| KeyValue::new(format!("guen.unit.{}", column.name), column.unit.clone())));
    // Doubles of motions have no two alike: a dictionary or a code would cost time and save nothing.
    let properties = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(metadata))
        .build();
    let mut out = Vec::with_capacity(8 * block.len() * all.len());
    let mut writer = SerializedFileWriter::new(&mut out, schema, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    let mut place = 0_usize;
    let levels: Vec<i16> = block.faults().map(|fault| fault.is_none().into()).collect();
    // The values of a kept column that are there, and of each row whether it has one.
    let good = |all: &[f64]| {
        let values = all.iter().zip(&levels).filter(|(_, there)| **there == 1).map(|(value, _)| *value);
        (values.collect(), levels.clone())
    };
    while let Some(mut column) = group.next_column()? {
        match column.untyped() {
            ColumnWriter::Int64ColumnWriter(column) => {
                let motions: Vec<i64> = block.motions.iter().map(|motion| *motion as i64).collect();
                column.write_batch(&motions, None, None)?;
            }
            ColumnWriter::DoubleColumnWriter(column) => {
                let axes = block.points.len();
                match (block.points.get(place - 1), place.checked_sub(axes + 1)) {
                    (Some(values), _) => column.write_batch(values, None, None)?,
                    (None, kept) => {
                        let values = kept.and_then(|kept| block.kept.get(kept));
                        let (values, levels) = values.map_or_else(|| times(block), |all| good(all));
                        column.write_batch(&values, Some(&levels), None)?
                    }
                };
            }
            ColumnWriter::ByteArrayColumnWriter(column) => {
                let causes: Vec<ByteArray> =
                    block.faults.iter().map(|(_, fault)| fault.cause.as_str().into()).collect();
                let levels: Vec<i16> = block.faults().map(|fault| fault.is_some().into()).collect();
                column.write_batch(&causes, Some(&levels), None)?;
            }
            _ => {}
        }
        column.close()?;
        place += 1;
    }
    group.close()?;
    writer.close()?;
    Ok(out)
}

/// The times of faults, and of each row whether it has one.
fn times(block: &Block) -> (Vec<f64>, Vec<i16>) {
    let times: Vec<Option<f64>> = block.faults().map(|fault| fault.and_then(|fault| fault.time)).collect();
    (times.iter().copied().flatten().collect(), times.iter().map(|time| time.is_some().into()).collect())
}
