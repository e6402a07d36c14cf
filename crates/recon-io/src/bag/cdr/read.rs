use super::HEADER;
use thiserror::Error;

/// Bytes that may be left over: some writers fill up the last four.
const PADDING: usize = 3;

/// Why bytes are no message of the kind that their schema names. Places are bytes from the start of the message.
#[derive(Clone, Debug, Error, Eq, PartialEq)]
#[non_exhaustive]
pub enum CdrError {
    /// The header is missing, or names another representation.
    #[error(
        "its representation is {found:02x?}; read are 00 00 and 00 01 (CDR, big- and little-endian), 00 06 and 00 07 (the same of version 2)"
    )]
    Representation {
        /// The first bytes, of which the second says the byte order.
        found: Vec<u8>,
    },
    /// The message ends within a value.
    #[error("byte {place}: {needed} more byte(s) are needed for {what}, and {left} are left")]
    Ends {
        /// Where the value begins.
        place: usize,
        /// What it is.
        what: &'static str,
        /// Bytes that it takes.
        needed: u64,
        /// Bytes that there are.
        left: usize,
    },
    /// A string that is none.
    #[error("byte {place}: the text there {fault}")]
    Text {
        /// Where it begins.
        place: usize,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// The message goes on after its last field.
    #[error("it has {left} byte(s) after its last field, which ends at byte {place}")]
    Goes {
        /// Where the last field ends.
        place: usize,
        /// Bytes after it.
        left: usize,
    },
}

/// A message from which values are taken one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Cdr<'a> {
    bytes: &'a [u8],
    place: usize,
    little: bool,
    /// Numbers are aligned to their size, but to no more than this.
    most_alignment: usize,
}

impl<'a> Cdr<'a> {
    /// Reads the header.
    pub(crate) fn new(bytes: &'a [u8]) -> Result<Self, CdrError> {
        let unknown = || CdrError::Representation { found: bytes.iter().take(2).copied().collect() };
        let (little, most_alignment) = match bytes {
            [0, 0, _, _, ..] => (false, 8),
            [0, 1, _, _, ..] => (true, 8),
            [0, 6, _, _, ..] => (false, 4),
            [0, 7, _, _, ..] => (true, 4),
            _ => return Err(unknown()),
        };
        Ok(Self { bytes, place: HEADER, little, most_alignment })
    }

    /// The message must end here, but for bytes that fill it up.
    pub(crate) fn end(&self) -> Result<(), CdrError> {
        let left = self.bytes.len() - self.place;
        if left > PADDING { Err(CdrError::Goes { place: self.place, left }) } else { Ok(()) }
    }

    pub(crate) fn u8(&mut self, what: &'static str) -> Result<u8, CdrError> {
        Ok(self.take(1, what)?[0])
    }

    pub(crate) fn i32(&mut self, what: &'static str) -> Result<i32, CdrError> {
        self.number(what, i32::from_le_bytes, i32::from_be_bytes)
    }

    pub(crate) fn u32(&mut self, what: &'static str) -> Result<u32, CdrError> {
        self.number(what, u32::from_le_bytes, u32::from_be_bytes)
    }

    pub(crate) fn f32(&mut self, what: &'static str) -> Result<f32, CdrError> {
        self.number(what, f32::from_le_bytes, f32::from_be_bytes)
    }

    pub(crate) fn f64(&mut self, what: &'static str) -> Result<f64, CdrError> {
        self.number(what, f64::from_le_bytes, f64::from_be_bytes)
    }

    pub(crate) fn f64s<const N: usize>(&mut self, what: &'static str) -> Result<[f64; N], CdrError> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.f64(what)?;
        }
        Ok(values)
    }

    /// A string, which ends in a zero byte that counts in its length; some writers give an empty one the length 0.
    pub(crate) fn text(&mut self, what: &'static str) -> Result<&'a str, CdrError> {
        let count = self.u32(what)?;
        let place = self.place;
        let bytes = self.many(count, 1, what)?;
        let text = match bytes {
            [] => bytes,
            [text @ .., 0] => text,
            _ => return Err(CdrError::Text { place, fault: "does not end in a zero byte" }),
        };
        std::str::from_utf8(text).map_err(|_| CdrError::Text { place, fault: "is not UTF-8" })
    }

    /// A sequence of bytes.
    pub(crate) fn blob(&mut self, what: &'static str) -> Result<&'a [u8], CdrError> {
        let count = self.u32(what)?;
        self.many(count, 1, what)
    }

    /// How many elements a sequence has, each of at least so many bytes: more than there can be is an error, so that nobody
    /// sets memory aside for them.
    pub(crate) fn count(&mut self, least_bytes: usize, what: &'static str) -> Result<usize, CdrError> {
        let count = self.u32(what)?;
        let mut ahead = self.clone();
        ahead.many(count, least_bytes, what).map(|_| count as usize)
    }

    fn many(&mut self, count: u32, bytes: usize, what: &'static str) -> Result<&'a [u8], CdrError> {
        let needed = u64::from(count) * bytes as u64;
        match usize::try_from(needed) {
            Ok(needed) => self.take(needed, what),
            Err(_) => Err(self.ends(needed, what)),
        }
    }

    fn number<T, const N: usize>(
        &mut self,
        what: &'static str,
        little: fn([u8; N]) -> T,
        big: fn([u8; N]) -> T,
    ) -> Result<T, CdrError> {
        // Alignment counts from the end of the header.
        let past = (self.place - HEADER) % N.min(self.most_alignment);
        if past > 0 {
            self.take(N.min(self.most_alignment) - past, what)?;
        }
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.take(N, what)?);
        Ok(if self.little { little(bytes) } else { big(bytes) })
    }

    fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], CdrError> {
        let end = self.place.checked_add(count).filter(|end| *end <= self.bytes.len());
        let Some(end) = end else { return Err(self.ends(count as u64, what)) };
        let taken = &self.bytes[self.place..end];
        self.place = end;
        Ok(taken)
    }

    fn ends(&self, needed: u64, what: &'static str) -> CdrError {
        CdrError::Ends { place: self.place, what, needed, left: self.bytes.len() - self.place }
    }
}
