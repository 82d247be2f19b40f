//! Bytes of one chunk: the `bytes` codec (little endian) followed by the `crc32c` codec.

use super::FloatKind;

/// Why the bytes of a chunk are not what was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ChunkFault {
    /// The file has another size than the chunk's shape asks for.
    Size,
    /// The checksum at the end does not fit the data.
    Checksum,
}

/// Encodes `values`, padded with NaN to `chunk_len`, and appends the checksum.
pub(crate) fn encode(values: &[f64], chunk_len: usize, kind: FloatKind) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(chunk_len * kind.size() + 4);
    let padding = chunk_len.saturating_sub(values.len());
    let padded = values
        .iter()
        .copied()
        .chain(std::iter::repeat_n(f64::NAN, padding));
    match kind {
        FloatKind::F32 => padded.for_each(|v| bytes.extend_from_slice(&(v as f32).to_le_bytes())),
        FloatKind::F64 => padded.for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())),
    }
    let checksum = crc32c::crc32c(&bytes);
    bytes.extend_from_slice(&checksum.to_le_bytes());
    bytes
}

/// Checks a chunk of `chunk_len` values and gives its data.
fn check(bytes: &[u8], chunk_len: usize, kind: FloatKind) -> Result<&[u8], ChunkFault> {
    if bytes.len() != chunk_len * kind.size() + 4 {
        return Err(ChunkFault::Size);
    }
    let (data, checksum) = bytes.split_at(bytes.len() - 4);
    if crc32c::crc32c(data).to_le_bytes() != checksum {
        return Err(ChunkFault::Checksum);
    }
    Ok(data)
}

/// Checks a chunk of `chunk_len` values and decodes every `step`-th from the one at `first` on.
pub(crate) fn decode_every(
    bytes: &[u8],
    chunk_len: usize,
    kind: FloatKind,
    first: usize,
    step: usize,
) -> Result<Vec<f64>, ChunkFault> {
    let data = check(bytes, chunk_len, kind)?;
    Ok(match kind {
        FloatKind::F32 => {
            let values = data.as_chunks::<4>().0.iter().skip(first).step_by(step);
            values
                .map(|value| f64::from(f32::from_le_bytes(*value)))
                .collect()
        }
        FloatKind::F64 => {
            let values = data.as_chunks::<8>().0.iter().skip(first).step_by(step);
            values.map(|value| f64::from_le_bytes(*value)).collect()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decode(bytes: &[u8], len: usize, kind: FloatKind) -> Result<Vec<f64>, ChunkFault> {
        decode_every(bytes, len, kind, 0, 1)
    }

    #[test]
    fn a_chunk_survives_the_round_trip_with_nan_padding() {
        let bytes = encode(&[1.0, -2.5], 3, FloatKind::F64);
        let values = decode(&bytes, 3, FloatKind::F64).unwrap();
        assert_eq!(values[..2], [1.0, -2.5]);
        assert!(values[2].is_nan());
    }

    #[test]
    fn one_flipped_bit_or_a_cut_file_is_noticed() {
        let mut bytes = encode(&[1.0, 2.0], 2, FloatKind::F32);
        assert_eq!(
            decode(&bytes[..7], 2, FloatKind::F32),
            Err(ChunkFault::Size)
        );
        bytes[5] ^= 1;
        assert_eq!(decode(&bytes, 2, FloatKind::F32), Err(ChunkFault::Checksum));
    }
}
