use super::error::BagErrorKind as Kind;
use crate::output::Checksum;
use mcap::records::{ChunkHeader, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::io::Read;

/// A record before its contents: operation code and length.
const HEAD: usize = 9;
/// Largest chunk and record that is unpacked, bytes: what claims to be larger is damaged, and no memory is set aside for it.
const LARGEST: usize = 1 << 28;

/// One record of a bag, and where it begins, bytes from the start of the file.
pub(super) struct Raw {
    pub(super) place: u64,
    pub(super) operation: u8,
    pub(super) contents: Vec<u8>,
}

/// How the records of a file end.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum End {
    /// With a footer.
    Whole,
    /// Within the record that begins at this byte, or after the last one where a footer should be.
    Cut { place: u64 },
}

/// Walks over the records of a file, chunks as a whole; attachments and indexes are passed by.
///
/// # Errors
/// [`Kind::Read`], [`Kind::NoBag`], and those of `each`.
pub(super) fn walk(mut from: impl Read, mut each: impl FnMut(Raw) -> Result<(), Kind>) -> Result<End, Kind> {
    let mut magic = Vec::new();
    take(&mut from, mcap::MAGIC.len() as u64, &mut magic)?;
    if magic != mcap::MAGIC {
        return Err(Kind::NoBag { found: magic });
    }
    let (mut place, mut data_ended) = (magic.len() as u64, false);
    loop {
        let mut head = Vec::with_capacity(HEAD);
        take(&mut from, HEAD as u64, &mut head)?;
        let Some((&[operation], Ok(length))) = head.split_first_chunk().map(|(o, l)| (o, l.try_into()))
        else {
            return Ok(if data_ended { End::Whole } else { End::Cut { place } });
        };
        let length = u64::from_le_bytes(length);
        let wanted =
            [op::SCHEMA, op::CHANNEL, op::MESSAGE, op::CHUNK, op::METADATA, op::HEADER].contains(&operation);
        let mut contents = Vec::new();
        let read = if wanted {
            take(&mut from, length, &mut contents)?
        } else {
            std::io::copy(&mut from.by_ref().take(length), &mut std::io::sink())?
        };
        if read < length {
            // Summary and indexes are not needed: all messages stand before them.
            return Ok(if data_ended { End::Whole } else { End::Cut { place } });
        }
        match operation {
            op::FOOTER => return Ok(End::Whole),
            op::DATA_END => data_ended = true,
            _ if wanted => each(Raw { place, operation, contents })?,
            _ => {}
        }
        place = place.saturating_add(HEAD as u64).saturating_add(length);
    }
}

/// So many bytes, or as many as there are.
fn take(from: &mut impl Read, length: u64, to: &mut Vec<u8>) -> Result<u64, Kind> {
    Ok(from.by_ref().take(length).read_to_end(to)? as u64)
}

/// Unpacks chunks, one after the other.
pub(super) struct Unpacker {
    reader: LinearReader,
}

impl Unpacker {
    pub(super) fn new() -> Self {
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(LARGEST);
        Self { reader: LinearReader::new_with_options(options) }
    }

    /// The records in a chunk, in their order; none of a chunk whose checksum is not that of its contents.
    pub(super) fn unpack(
        &mut self,
        chunk: &Raw,
        mut each: impl FnMut(u8, &[u8]) -> Result<(), Kind>,
    ) -> Result<(), Kind> {
        let damaged = |detail: String| Kind::Chunk { place: chunk.place, detail };
        let (header, data) = match mcap::parse_record(op::CHUNK, &chunk.contents) {
            Ok(Record::Chunk { header, data }) => (header, data),
            Ok(_) => return Err(damaged("it is no chunk".to_owned())),
            Err(error) => return Err(damaged(error.to_string())),
        };
        if header.compression.is_empty() {
            return plain(&header, &data, &damaged, each);
        }
        let mut bytes = Vec::with_capacity(HEAD + chunk.contents.len());
        bytes.push(op::CHUNK);
        bytes.extend((chunk.contents.len() as u64).to_le_bytes());
        bytes.extend(&chunk.contents);
        let mut left = &bytes[..];
        while let Some(event) = self.reader.next_event() {
            match event.map_err(|error| damaged(error.to_string()))? {
                // All is read, and the next record is asked for.
                LinearReadEvent::ReadRequest(_) if left.is_empty() => return Ok(()),
                LinearReadEvent::ReadRequest(need) => {
                    let (now, later) = left.split_at(need.min(left.len()));
                    self.reader.insert(now.len()).copy_from_slice(now);
                    self.reader.notify_read(now.len());
                    left = later;
                }
                LinearReadEvent::Record { data, opcode } => each(opcode, data)?,
            }
        }
        Ok(())
    }
}

/// A chunk that is not packed: its records stand as they are.
fn plain(
    header: &ChunkHeader,
    mut data: &[u8],
    damaged: &impl Fn(String) -> Kind,
    mut each: impl FnMut(u8, &[u8]) -> Result<(), Kind>,
) -> Result<(), Kind> {
    let (mut sum, stated) = (Checksum::default(), format!("{:08x}", header.uncompressed_crc));
    sum.add(data);
    if header.uncompressed_crc != 0 && sum.hex() != stated {
        return Err(damaged(format!("its checksum is {stated}, that of its contents {}", sum.hex())));
    }
    while !data.is_empty() {
        let short = || damaged("it ends within a record".to_owned());
        let (head, rest) = data.split_at_checked(HEAD).ok_or_else(short)?;
        let length = head[1..].try_into().map(u64::from_le_bytes).ok();
        let length = length.and_then(|length| usize::try_from(length).ok()).ok_or_else(short)?;
        let (contents, rest) = rest.split_at_checked(length).ok_or_else(short)?;
        each(head[0], contents)?;
        data = rest;
    }
    Ok(())
}
