//! The subset of Zarr v3 that the store needs: groups, and arrays of little-endian floats that grow
//! along their first axis, uncompressed, each chunk closed by a CRC-32C; in folders, or in the zip
//! file of a case that has ended.
//!
//! Written by hand rather than through a Zarr library for two reasons that docs/results.md gives in
//! full: every file must appear by an atomic rename, so that a killed run never leaves half a
//! chunk, and `cargo build` must stay free of C libraries. Specification: zarr-specs.readthedocs.io,
//! "Zarr core specification version 3", and its `bytes` and `crc32c` codecs.

mod archive;
mod array;
mod chunk;
mod node;
mod place;

pub(crate) use array::{Array, ArrayShape, FloatKind};
pub(crate) use node::{Attributes, Group, write_atomically};
pub(crate) use place::Place;
