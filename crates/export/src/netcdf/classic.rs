//! The classic NetCDF file format with 64-bit offsets (CDF-2), written from front to back.
//!
//! Written here because the fields of a long run are larger than the memory: they are records that
//! are written one after the other, straight from the store. The format is a header and big-endian
//! numbers, which takes less code than a library would take to feed.
//! Specification: "The NetCDF classic format specification", docs.unidata.ucar.edu/netcdf-c,
//! appendix B.

/// Bytes of a fixed-size variable, or of one record of a variable, above which the format has no
/// number for its size.
const MOST_BYTES: u64 = 0xFFFF_FFFC;

/// Largest length of a dimension, and largest number of records.
const MOST_LENGTH: usize = 0x7FFF_FFFF;

const TAG_DIMENSION: u32 = 0x0A;
const TAG_VARIABLE: u32 = 0x0B;
const TAG_ATTRIBUTE: u32 = 0x0C;
const TYPE_CHAR: u32 = 2;
const TYPE_FLOAT: u32 = 5;
const TYPE_DOUBLE: u32 = 6;

/// A dimension.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dimension {
    pub(crate) name: String,
    /// Length; none for the dimension of records, of which there is one at most.
    pub(crate) length: Option<usize>,
}

/// An attribute.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Attribute {
    pub(crate) name: String,
    pub(crate) value: AttributeValue,
}

/// Value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum AttributeValue {
    Text(String),
    Numbers(Vec<f64>),
}

impl Attribute {
    /// A text.
    pub(crate) fn text(name: &str, value: impl Into<String>) -> Self {
        Attribute {
            name: name.to_owned(),
            value: AttributeValue::Text(value.into()),
        }
    }

    /// Numbers.
    pub(crate) fn numbers(name: &str, values: &[f64]) -> Self {
        Attribute {
            name: name.to_owned(),
            value: AttributeValue::Numbers(values.to_vec()),
        }
    }
}

/// Width of a variable's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Width {
    Float,
    Double,
}

impl Width {
    fn size(self) -> u64 {
        match self {
            Width::Float => 4,
            Width::Double => 8,
        }
    }

    /// Appends numbers as they stand in the file.
    pub(crate) fn push(self, bytes: &mut Vec<u8>, values: &[f64]) {
        match self {
            Width::Float => values
                .iter()
                .for_each(|v| bytes.extend_from_slice(&(*v as f32).to_be_bytes())),
            Width::Double => values
                .iter()
                .for_each(|v| bytes.extend_from_slice(&v.to_be_bytes())),
        }
    }
}

/// A variable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Variable {
    pub(crate) name: String,
    /// Indices of its dimensions; that of the records can only be the first.
    pub(crate) dimensions: Vec<usize>,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) width: Width,
}

/// All that stands before the data. The data follow in the order of the variables: first those of
/// fixed size one by one, then record by record those with the dimension of records.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Header {
    pub(crate) dimensions: Vec<Dimension>,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) variables: Vec<Variable>,
    /// Number of records.
    pub(crate) records: usize,
}

impl Header {
    /// Whether a variable has the dimension of records.
    pub(crate) fn has_records(&self, variable: &Variable) -> bool {
        let first = variable.dimensions.first();
        first.is_some_and(|first| self.dimensions[*first].length.is_none())
    }

    /// Values of a variable of fixed size, or of one of its records.
    pub(crate) fn values(&self, variable: &Variable) -> u64 {
        let lengths = variable.dimensions.iter();
        lengths
            .filter_map(|index| self.dimensions[*index].length)
            .map(|length| length as u64)
            .product()
    }

    /// What the format has no room for, in words.
    pub(crate) fn too_large(&self) -> Option<String> {
        let long = |length: usize| length > MOST_LENGTH;
        let mut dimensions = self.dimensions.iter();
        if let Some(dimension) =
            dimensions.find(|dimension| long(dimension.length.unwrap_or(self.records)))
        {
            return Some(format!(
                "the dimension `{}` is longer than {MOST_LENGTH}",
                dimension.name
            ));
        }
        let mut variables = self.variables.iter();
        let variable = variables.find(|variable| self.size(variable) > MOST_BYTES)?;
        Some(format!(
            "`{}` takes {:.1} GiB, and a variable may take 4",
            variable.name,
            self.size(variable) as f64 / (1_u64 << 30) as f64
        ))
    }

    /// The bytes of the header.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        // The header's length does not depend on the offsets in it.
        let length = self.with_offsets(&vec![0; self.variables.len()]).len() as u64;
        let mut offsets = vec![0; self.variables.len()];
        let mut next = length;
        for with_records in [false, true] {
            for (offset, variable) in offsets.iter_mut().zip(&self.variables) {
                if self.has_records(variable) == with_records {
                    *offset = next;
                    next += self.size(variable);
                }
            }
        }
        self.with_offsets(&offsets)
    }

    /// Bytes of a variable of fixed size, or of one of its records. All numbers have four or eight
    /// bytes, so there is no padding.
    fn size(&self, variable: &Variable) -> u64 {
        self.values(variable).saturating_mul(variable.width.size())
    }

    fn with_offsets(&self, offsets: &[u64]) -> Vec<u8> {
        let mut bytes = b"CDF\x02".to_vec();
        push_u32(&mut bytes, self.records as u32);
        push_tag(&mut bytes, TAG_DIMENSION, self.dimensions.len());
        for dimension in &self.dimensions {
            push_name(&mut bytes, &dimension.name);
            push_u32(&mut bytes, dimension.length.unwrap_or(0) as u32);
        }
        push_attributes(&mut bytes, &self.attributes);
        push_tag(&mut bytes, TAG_VARIABLE, self.variables.len());
        for (variable, offset) in self.variables.iter().zip(offsets) {
            push_name(&mut bytes, &variable.name);
            push_u32(&mut bytes, variable.dimensions.len() as u32);
            for dimension in &variable.dimensions {
                push_u32(&mut bytes, *dimension as u32);
            }
            push_attributes(&mut bytes, &variable.attributes);
            push_u32(
                &mut bytes,
                match variable.width {
                    Width::Float => TYPE_FLOAT,
                    Width::Double => TYPE_DOUBLE,
                },
            );
            push_u32(&mut bytes, self.size(variable).min(MOST_BYTES) as u32);
            bytes.extend_from_slice(&offset.to_be_bytes());
        }
        bytes
    }
}

fn push_u32(bytes: &mut Vec<u8>, value: u32) {
    bytes.extend_from_slice(&value.to_be_bytes());
}

/// The tag and length of a list; of an empty one both are zero.
fn push_tag(bytes: &mut Vec<u8>, tag: u32, len: usize) {
    push_u32(bytes, if len == 0 { 0 } else { tag });
    push_u32(bytes, len as u32);
}

fn push_name(bytes: &mut Vec<u8>, name: &str) {
    push_u32(bytes, name.len() as u32);
    push_padded(bytes, name.as_bytes());
}

fn push_padded(bytes: &mut Vec<u8>, content: &[u8]) {
    bytes.extend_from_slice(content);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

fn push_attributes(bytes: &mut Vec<u8>, attributes: &[Attribute]) {
    push_tag(bytes, TAG_ATTRIBUTE, attributes.len());
    for attribute in attributes {
        push_name(bytes, &attribute.name);
        match &attribute.value {
            AttributeValue::Text(text) => {
                push_u32(bytes, TYPE_CHAR);
                push_u32(bytes, text.len() as u32);
                push_padded(bytes, text.as_bytes());
            }
            AttributeValue::Numbers(numbers) => {
                push_u32(bytes, TYPE_DOUBLE);
                push_u32(bytes, numbers.len() as u32);
                Width::Double.push(bytes, numbers);
            }
        }
    }
}

/// A name as the format allows it: what it forbids is written as in a URL.
pub(crate) fn legal_name(name: &str) -> String {
    let first_is_legal = |c: char| c.is_ascii_alphanumeric() || c == '_' || !c.is_ascii();
    let mut legal = String::with_capacity(name.len());
    if !name.starts_with(first_is_legal) {
        legal.push('_');
    }
    for character in name.chars() {
        if character == '/' || character.is_control() {
            let mut buffer = [0; 4];
            for byte in character.encode_utf8(&mut buffer).bytes() {
                legal.push_str(&format!("%{byte:02X}"));
            }
        } else {
            legal.push(character);
        }
    }
    // A blank at the end is forbidden too.
    legal.truncate(legal.trim_end().len());
    legal
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(nodes: usize, records: usize) -> Header {
        Header {
            dimensions: vec![
                Dimension {
                    name: "t".into(),
                    length: None,
                },
                Dimension {
                    name: "nodes".into(),
                    length: Some(nodes),
                },
            ],
            attributes: vec![Attribute::text("a", "b")],
            variables: vec![
                Variable {
                    name: "field".into(),
                    dimensions: vec![0, 1],
                    attributes: Vec::new(),
                    width: Width::Float,
                },
                Variable {
                    name: "s".into(),
                    dimensions: vec![1],
                    attributes: Vec::new(),
                    width: Width::Double,
                },
            ],
            records,
        }
    }

    #[test]
    fn the_header_is_the_one_of_the_specification() {
        let bytes = header(3, 2).to_bytes();
        #[rustfmt::skip]
        let expected: Vec<u8> = [
            b"CDF\x02".to_vec(), vec![0, 0, 0, 2],
            vec![0, 0, 0, 0x0A, 0, 0, 0, 2],
            vec![0, 0, 0, 1], b"t\0\0\0".to_vec(), vec![0, 0, 0, 0],
            vec![0, 0, 0, 5], b"nodes\0\0\0".to_vec(), vec![0, 0, 0, 3],
            vec![0, 0, 0, 0x0C, 0, 0, 0, 1],
            vec![0, 0, 0, 1], b"a\0\0\0".to_vec(), vec![0, 0, 0, 2, 0, 0, 0, 1], b"b\0\0\0".to_vec(),
            vec![0, 0, 0, 0x0B, 0, 0, 0, 2],
            // (t, nodes) float: a record of 12 bytes, after the fixed variable of 24.
            vec![0, 0, 0, 5], b"field\0\0\0".to_vec(), vec![0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1],
            vec![0; 8], vec![0, 0, 0, 5, 0, 0, 0, 12], vec![0, 0, 0, 0, 0, 0, 0, 168 + 24],
            vec![0, 0, 0, 1], b"s\0\0\0".to_vec(), vec![0, 0, 0, 1, 0, 0, 0, 1],
            vec![0; 8], vec![0, 0, 0, 6, 0, 0, 0, 24], vec![0, 0, 0, 0, 0, 0, 0, 168],
        ].concat();
        assert_eq!(bytes, expected);
        assert_eq!(bytes.len(), 168);
    }

    #[test]
    fn what_does_not_fit_is_named() {
        assert_eq!(header(1 << 28, 5).too_large(), None);
        let text = header(1 << 29, 5).too_large().expect("4 GiB of doubles");
        assert!(text.contains("`s` takes 4.0 GiB"), "{text}");
        let text = header(3, 1 << 31).too_large().expect("too many records");
        assert!(text.contains("`t`"), "{text}");
    }

    #[test]
    fn names_are_legal_and_stay_readable() {
        assert_eq!(
            legal_name("hose.effective_tension@120m"),
            "hose.effective_tension@120m"
        );
        assert_eq!(legal_name("软管.x"), "软管.x");
        assert_eq!(legal_name("a/b\n "), "a%2Fb%0A");
        assert_eq!(legal_name("@x"), "_@x");
    }
}
