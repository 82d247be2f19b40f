//! One VTK poly-data file (.vtp): XML, with the numbers as raw little-endian bytes at the end.
//!
//! Format: "VTK XML formats" in the VTK documentation, docs.vtk.org; version 1.0 with 64-bit
//! headers.

use std::borrow::Cow;
use std::fmt::Write;

use super::collection::{comment, escape};

/// Values of an array.
#[derive(Debug, Clone)]
pub(crate) enum Data<'a> {
    Float32(Cow<'a, [f32]>),
    Float64(Cow<'a, [f64]>),
    Int32(Cow<'a, [i32]>),
    Int64(Cow<'a, [i64]>),
    Text(&'a [String]),
}

/// An array with a name.
#[derive(Debug, Clone)]
pub(crate) struct DataArray<'a> {
    pub(crate) name: &'a str,
    /// Values per point or cell.
    pub(crate) components: usize,
    pub(crate) data: Data<'a>,
}

impl<'a> DataArray<'a> {
    /// An array of one value per point or cell.
    pub(crate) fn scalars(name: &'a str, data: Data<'a>) -> Self {
        DataArray {
            name,
            components: 1,
            data,
        }
    }
}

/// What the cells are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cells {
    /// One polyline per cell.
    Lines,
    /// One point per cell.
    Vertices,
}

/// Points, cells over consecutive points, and arrays.
#[derive(Debug, Clone)]
pub(crate) struct PolyData<'a> {
    /// Time [s].
    pub(crate) time_s: f64,
    /// Global positions (n_points x 3) [m].
    pub(crate) points: Data<'a>,
    pub(crate) cells: Cells,
    /// End of each cell in the points (n_cells).
    pub(crate) cell_ends: &'a [i64],
    pub(crate) point_arrays: Vec<DataArray<'a>>,
    pub(crate) cell_arrays: Vec<DataArray<'a>>,
    /// Array of the points that is shown first.
    pub(crate) shown_first: Option<&'a str>,
}

impl PolyData<'_> {
    /// The file.
    pub(crate) fn to_bytes(&self, made_by: &str) -> Vec<u8> {
        let n_points = self.cell_ends.last().copied().unwrap_or(0);
        let n_cells = self.cell_ends.len();
        let (n_lines, n_verts) = match self.cells {
            Cells::Lines => (n_cells, 0),
            Cells::Vertices => (0, n_cells),
        };
        let mut file = Appended::new(format!(
            "<?xml version=\"1.0\"?>\n<!-- {} -->\n<VTKFile type=\"PolyData\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n",
            comment(made_by)
        ));
        file.open("FieldData");
        // The attribute is asked for in field data only.
        let time = Data::Float64(Cow::Owned(vec![self.time_s]));
        file.array("TimeValue", 1, &time, " NumberOfTuples=\"1\"");
        file.close("FieldData");
        file.open(&format!(
            "Piece NumberOfPoints=\"{n_points}\" NumberOfVerts=\"{n_verts}\" \
             NumberOfLines=\"{n_lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\""
        ));
        match self.shown_first {
            Some(name) => file.open(&format!("PointData Scalars=\"{}\"", escape(name))),
            None => file.open("PointData"),
        }
        for array in &self.point_arrays {
            file.array(array.name, array.components, &array.data, "");
        }
        file.close("PointData");
        file.open("CellData");
        for array in &self.cell_arrays {
            file.array(array.name, array.components, &array.data, "");
        }
        file.close("CellData");
        file.open("Points");
        file.array("Points", 3, &self.points, "");
        file.close("Points");
        let cells = match self.cells {
            Cells::Lines => "Lines",
            Cells::Vertices => "Verts",
        };
        file.open(cells);
        let connectivity: Vec<i64> = (0..n_points).collect();
        let connectivity = Data::Int64(Cow::Owned(connectivity));
        file.array("connectivity", 1, &connectivity, "");
        file.array(
            "offsets",
            1,
            &Data::Int64(Cow::Borrowed(self.cell_ends)),
            "",
        );
        file.close(cells);
        file.close("Piece");
        file.finish()
    }
}

/// XML in which arrays refer to bytes that follow it.
struct Appended {
    xml: String,
    bytes: Vec<u8>,
}

impl Appended {
    fn new(xml: String) -> Self {
        Appended {
            xml,
            bytes: Vec::new(),
        }
    }

    fn open(&mut self, element: &str) {
        self.xml.push_str(&format!("<{element}>\n"));
    }

    fn close(&mut self, element: &str) {
        self.xml.push_str(&format!("</{element}>\n"));
    }

    fn array(&mut self, name: &str, components: usize, data: &Data<'_>, more: &str) {
        let (element, kind) = match data {
            Data::Float32(_) => ("DataArray", "Float32"),
            Data::Float64(_) => ("DataArray", "Float64"),
            Data::Int32(_) => ("DataArray", "Int32"),
            Data::Int64(_) => ("DataArray", "Int64"),
            Data::Text(_) => ("Array", "String"),
        };
        let components = match components {
            1 => String::new(),
            n => format!(" NumberOfComponents=\"{n}\""),
        };
        // Writing into a string does not fail.
        let _ = writeln!(
            self.xml,
            "<{element} type=\"{kind}\" Name=\"{}\"{components}{more} format=\"appended\" \
             offset=\"{}\"/>",
            escape(name),
            self.bytes.len()
        );
        // The number of bytes stands before them.
        let start = self.bytes.len();
        self.bytes.extend_from_slice(&[0; 8]);
        let bytes = &mut self.bytes;
        match data {
            Data::Float32(v) => v
                .iter()
                .for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())),
            Data::Float64(v) => v
                .iter()
                .for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())),
            Data::Int32(v) => v
                .iter()
                .for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())),
            Data::Int64(v) => v
                .iter()
                .for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())),
            // Words end with a zero.
            Data::Text(words) => words.iter().for_each(|word| {
                bytes.extend(word.bytes().filter(|byte| *byte != 0));
                bytes.push(0);
            }),
        }
        let len = (bytes.len() - start - 8) as u64;
        bytes[start..start + 8].copy_from_slice(&len.to_le_bytes());
    }

    fn finish(mut self) -> Vec<u8> {
        self.xml
            .push_str("</PolyData>\n<AppendedData encoding=\"raw\">\n_");
        let mut file = self.xml.into_bytes();
        file.reserve(self.bytes.len() + 40);
        file.extend_from_slice(&self.bytes);
        file.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_point_at_the_length_of_each_array() {
        let names = ["软管".to_owned()];
        let data = PolyData {
            time_s: 1.5,
            points: Data::Float32(Cow::Owned(vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0])),
            cells: Cells::Lines,
            cell_ends: &[2],
            point_arrays: vec![DataArray::scalars(
                "a<b",
                Data::Float64(Cow::Owned(vec![1.0, 2.0])),
            )],
            cell_arrays: vec![DataArray::scalars("line", Data::Text(&names))],
            shown_first: Some("a<b"),
        };
        let file = data.to_bytes("Catenix");
        let text = String::from_utf8_lossy(&file);
        assert!(text.contains("Scalars=\"a&lt;b\""), "{text}");
        let start = 1
            + file
                .windows(2)
                .position(|pair| pair == b"\n_")
                .expect("the bytes begin after an underscore")
            + 1;
        let block = |offset: usize| -> &[u8] {
            let at = start + offset;
            let len = u64::from_le_bytes(file[at..at + 8].try_into().unwrap());
            &file[at + 8..at + 8 + usize::try_from(len).unwrap()]
        };
        let offset = |name: &str| -> usize {
            let rest = text.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
            let rest = rest.split("offset=\"").nth(1).unwrap();
            rest.split('"').next().unwrap().parse().unwrap()
        };
        assert_eq!(block(offset("TimeValue")), 1.5_f64.to_le_bytes());
        assert_eq!(block(offset("a&lt;b")).len(), 16);
        assert_eq!(block(offset("line")), "软管\0".as_bytes());
        assert_eq!(block(offset("Points")).len(), 24);
        assert_eq!(block(offset("offsets")), 2_i64.to_le_bytes());
    }
}
