//! The part of the zip format that the store needs: files one after another, uncompressed, with a
//! directory at the end.
//!
//! Specification: PKWARE APPNOTE 6.3.10, sections 4.3 to 4.5. Names are UTF-8, dates are left at
//! the first that there is, and a directory that needs more than 32 bits has the 64-bit form.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::node::damaged;
use crate::StoreError;

const LOCAL: [u8; 4] = *b"PK\x03\x04";
const CENTRAL: [u8; 4] = *b"PK\x01\x02";
const END: [u8; 4] = *b"PK\x05\x06";
const END_64: [u8; 4] = *b"PK\x06\x06";
const LOCATOR_64: [u8; 4] = *b"PK\x06\x07";
/// Lengths of the fixed parts [bytes].
const LOCAL_LENGTH: usize = 30;
const CENTRAL_LENGTH: usize = 46;
const END_LENGTH: usize = 22;
const END_64_LENGTH: usize = 56;
const LOCATOR_64_LENGTH: usize = 20;
/// Longest comment behind the directory [bytes].
const LONGEST_COMMENT: usize = u16::MAX as usize;
/// What a field of 32 or 16 bits holds where the 64-bit form has the value.
const ELSEWHERE_32: u32 = u32::MAX;
const ELSEWHERE_16: u16 = u16::MAX;
/// The first day that a date can name.
const FIRST_DATE: u16 = 0x21;
/// Names are UTF-8.
const UTF_8: u16 = 1 << 11;

/// Writes the files of an archive one by one; [`Self::finish`] adds the directory.
pub(super) struct ArchiveWriter<W> {
    out: W,
    offset: u64,
    directory: Vec<u8>,
    count: u64,
}

impl<W: Write> ArchiveWriter<W> {
    pub(super) fn new(out: W) -> Self {
        ArchiveWriter {
            out,
            offset: 0,
            directory: Vec::new(),
            count: 0,
        }
    }

    /// Adds a file.
    pub(super) fn add(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        let too_large = |_| io::Error::new(io::ErrorKind::InvalidInput, "too large for a zip file");
        let size = u32::try_from(content.len()).map_err(too_large)?;
        let name_length = u16::try_from(name.len()).map_err(too_large)?;
        let checksum = crc32fast::hash(content);
        let wide = self.offset >= u64::from(ELSEWHERE_32);
        // Version that is needed, flags, method, time, date, checksum, both sizes, length of name.
        let mut common = Vec::with_capacity(26);
        for number in [if wide { 45 } else { 20 }, UTF_8, 0, 0, FIRST_DATE] {
            common.extend(number.to_le_bytes());
        }
        for number in [checksum, size, size] {
            common.extend(number.to_le_bytes());
        }
        common.extend(name_length.to_le_bytes());
        let header = [&LOCAL[..], &common, &[0; 2], name.as_bytes()].concat();
        self.out.write_all(&header)?;
        self.out.write_all(content)?;

        let directory = &mut self.directory;
        directory.extend(CENTRAL);
        directory.extend(45_u16.to_le_bytes());
        directory.extend(common);
        directory.extend((if wide { 12_u16 } else { 0 }).to_le_bytes());
        // No comment, first disk, attributes of a plain file.
        directory.extend([0; 10]);
        let near = u32::try_from(self.offset).unwrap_or(ELSEWHERE_32);
        directory.extend(near.to_le_bytes());
        directory.extend(name.as_bytes());
        if wide {
            directory.extend(1_u16.to_le_bytes());
            directory.extend(8_u16.to_le_bytes());
            directory.extend(self.offset.to_le_bytes());
        }
        self.offset += (header.len() + content.len()) as u64;
        self.count += 1;
        Ok(())
    }

    /// Writes the directory and gives the output back.
    pub(super) fn finish(mut self) -> io::Result<W> {
        let length = self.directory.len() as u64;
        let count = u16::try_from(self.count).unwrap_or(ELSEWHERE_16);
        let [near_length, near_offset] =
            [length, self.offset].map(|number| u32::try_from(number).unwrap_or(ELSEWHERE_32));
        let mut end = std::mem::take(&mut self.directory);
        if count == ELSEWHERE_16 || near_length.max(near_offset) == ELSEWHERE_32 {
            let place = self.offset + length;
            end.extend(END_64);
            end.extend((END_64_LENGTH as u64 - 12).to_le_bytes());
            end.extend([45, 0, 45, 0]);
            end.extend([0; 8]);
            for number in [self.count, self.count, length, self.offset] {
                end.extend(number.to_le_bytes());
            }
            end.extend(LOCATOR_64);
            end.extend([0; 4]);
            end.extend(place.to_le_bytes());
            end.extend(1_u32.to_le_bytes());
        }
        end.extend(END);
        end.extend([0; 4]);
        end.extend(count.to_le_bytes());
        end.extend(count.to_le_bytes());
        end.extend(near_length.to_le_bytes());
        end.extend(near_offset.to_le_bytes());
        end.extend([0; 2]);
        self.out.write_all(&end)?;
        Ok(self.out)
    }
}

/// An archive that is read.
#[derive(Debug)]
pub(super) struct Archive {
    path: PathBuf,
    file: Mutex<File>,
    /// By name: offset of the header and length of the content [bytes].
    entries: BTreeMap<String, (u64, u64)>,
}

impl Archive {
    /// Opens an archive and reads its directory; `None` where there is no such file.
    pub(super) fn open(path: &Path) -> Result<Option<Archive>, StoreError> {
        let read = |source| StoreError::read(path, source);
        let mut file = match File::open(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            other => other.map_err(read)?,
        };
        if !file.metadata().map_err(read)?.is_file() {
            return Ok(None);
        }
        let entries = directory(&mut file)
            .map_err(read)?
            .ok_or_else(|| damaged(path, "it is not a zip file in the form that is written"))?;
        Ok(Some(Archive {
            path: path.to_path_buf(),
            file: Mutex::new(file),
            entries,
        }))
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Names from `first` on, sorted.
    pub(super) fn names_from<'a>(&'a self, first: &str) -> impl Iterator<Item = &'a str> {
        let range = self.entries.range(first.to_owned()..);
        range.map(|(name, _)| name.as_str())
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.contains_key(name)
    }

    /// Content of a file; `None` where there is none of that name.
    pub(super) fn read(&self, name: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let Some(&(offset, length)) = self.entries.get(name) else {
            return Ok(None);
        };
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let content = content(&mut file, offset, length);
        let content = content.map_err(|source| StoreError::read(&self.path.join(name), source))?;
        let lost = || damaged(&self.path.join(name), "the zip file has lost it");
        content.ok_or_else(lost).map(Some)
    }
}

fn content(file: &mut File, offset: u64, length: u64) -> io::Result<Option<Vec<u8>>> {
    let mut header = [0; LOCAL_LENGTH];
    file.seek(SeekFrom::Start(offset))?;
    if !filled(file, &mut header)? || header[..4] != LOCAL {
        return Ok(None);
    }
    let beyond = i64::from(short(&header, 26)) + i64::from(short(&header, 28));
    file.seek_relative(beyond)?;
    let mut content = Vec::new();
    file.take(length).read_to_end(&mut content)?;
    Ok((content.len() as u64 == length).then_some(content))
}

/// Reads the directory; `None` where it makes no sense.
fn directory(file: &mut File) -> io::Result<Option<BTreeMap<String, (u64, u64)>>> {
    let length = file.seek(SeekFrom::End(0))?;
    let tail = length.min((END_LENGTH + LONGEST_COMMENT) as u64);
    let start = length - tail;
    let mut bytes = vec![0; usize::try_from(tail).unwrap_or(0)];
    file.seek(SeekFrom::Start(start))?;
    file.read_exact(&mut bytes)?;
    let Some(end) = bytes.windows(4).rposition(|bytes| bytes == END) else {
        return Ok(None);
    };
    if bytes.len() < end + END_LENGTH {
        return Ok(None);
    }
    let mut size = u64::from(long(&bytes, end + 12));
    let mut place = u64::from(long(&bytes, end + 16));
    let locator = (start + end as u64).checked_sub(LOCATOR_64_LENGTH as u64);
    if let Some(locator) = locator {
        let mut found = [0; LOCATOR_64_LENGTH];
        file.seek(SeekFrom::Start(locator))?;
        if filled(file, &mut found)? && found[..4] == LOCATOR_64 {
            let mut end = [0; END_64_LENGTH];
            file.seek(SeekFrom::Start(wide(&found, 8)))?;
            if !filled(file, &mut end)? || end[..4] != END_64 {
                return Ok(None);
            }
            (size, place) = (wide(&end, 40), wide(&end, 48));
        }
    }
    if size > length || place > length - size {
        return Ok(None);
    }
    let mut bytes = vec![0; usize::try_from(size).unwrap_or(0)];
    file.seek(SeekFrom::Start(place))?;
    file.read_exact(&mut bytes)?;
    Ok(entries(&bytes))
}

fn entries(mut rest: &[u8]) -> Option<BTreeMap<String, (u64, u64)>> {
    let mut entries = BTreeMap::new();
    while !rest.is_empty() {
        let header = rest.get(..CENTRAL_LENGTH)?;
        let [name, extra, comment] = [28, 30, 32].map(|at| usize::from(short(header, at)));
        let stored = short(header, 10) == 0;
        let size = long(header, 24);
        if header[..4] != CENTRAL || !stored || size == ELSEWHERE_32 {
            return None;
        }
        let mut offset = u64::from(long(header, 42));
        let names = CENTRAL_LENGTH + name;
        if offset == u64::from(ELSEWHERE_32) {
            // The 64-bit offset comes first where nothing else is 64 bits long.
            let extra = rest.get(names..names + extra)?;
            if extra.len() < 12 || short(extra, 0) != 1 {
                return None;
            }
            offset = wide(extra, 4);
        }
        let name = String::from_utf8(rest.get(CENTRAL_LENGTH..names)?.to_vec()).ok()?;
        entries.insert(name, (offset, u64::from(size)));
        rest = rest.get(names + extra + comment..)?;
    }
    Some(entries)
}

/// Whether there was enough to fill the room.
fn filled(file: &mut File, room: &mut [u8]) -> io::Result<bool> {
    match file.read_exact(room) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        other => other.map(|()| true),
    }
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    let mut number = [0; N];
    number.copy_from_slice(&bytes[at..at + N]);
    number
}

fn short(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes(number(bytes, at))
}

fn long(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(number(bytes, at))
}

fn wide(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(number(bytes, at))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn archive(directory: &Path) -> PathBuf {
        let path = directory.join("a.zip");
        let mut writer = ArchiveWriter::new(File::create(&path).unwrap());
        writer.add("软管/zarr.json", b"{}").unwrap();
        writer.add("b/c/0", &[7; 1000]).unwrap();
        writer.finish().unwrap();
        path
    }

    #[test]
    fn files_come_back_and_others_are_not_there() {
        let directory = tempfile::tempdir().unwrap();
        let archive = Archive::open(&archive(directory.path())).unwrap().unwrap();
        assert_eq!(
            archive.names_from("").collect::<Vec<_>>(),
            ["b/c/0", "软管/zarr.json"]
        );
        assert_eq!(archive.read("软管/zarr.json").unwrap().unwrap(), b"{}");
        assert_eq!(archive.read("b/c/0").unwrap().unwrap(), [7; 1000]);
        assert!(archive.read("b/c").unwrap().is_none());
        let missing = directory.path().join("missing.zip");
        assert!(Archive::open(&missing).unwrap().is_none());
    }

    #[test]
    fn a_cut_or_spoilt_archive_is_noticed() {
        let directory = tempfile::tempdir().unwrap();
        let path = archive(directory.path());
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            assert!(Archive::open(&path).is_err(), "{length}");
        }
        for position in 0..whole.len() {
            let mut spoilt = whole.clone();
            spoilt[position] ^= 0x55;
            fs::write(&path, &spoilt).unwrap();
            // Whatever is wrong, it is said or harmless; nothing panics.
            if let Ok(Some(archive)) = Archive::open(&path) {
                for name in archive.names_from("") {
                    let _ = archive.read(name);
                }
            }
        }
    }

    #[test]
    fn beyond_four_gibibytes_offsets_are_64_bits_long() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("far.zip");
        let mut file = File::create(&path).unwrap();
        // A hole stands for the files before: it takes no room.
        let far = 5 << 30;
        file.seek(SeekFrom::Start(far)).unwrap();
        let mut writer = ArchiveWriter::new(file);
        writer.offset = far;
        writer.add("far", b"away").unwrap();
        writer.finish().unwrap();
        let archive = Archive::open(&path).unwrap().unwrap();
        assert_eq!(archive.read("far").unwrap().unwrap(), b"away");
    }
}
