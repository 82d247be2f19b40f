//! Exports of a result store: tables as CSV or Parquet, series of poly-data for ParaView, NetCDF.
//!
//! [`export`] does it all: it reads a [`StoredStudy`](catenix_results::StoredStudy) piece by piece,
//! writes every file beside its final name, and renames it when it is whole. A store that is still
//! written, or whose run was killed, gives what was flushed. docs/export.md is the guide for users.

mod contents;
mod csv;
mod error;
mod meter;
mod names;
mod netcdf;
mod output;
mod parquet;
mod provenance;
mod request;
mod select;
mod table;
mod tables;
mod vtk;

pub use error::ExportError;
pub use meter::ExportWatch;
pub use output::ExportedFile;
pub use request::{ExportFormat, ExportRequest, Exported, export};
pub use select::Thinning;
