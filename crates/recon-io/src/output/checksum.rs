use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;

/// CRC-32 as in gzip and zip (IEEE 802.3, reflected): whatever is changed within four bytes that follow each other is
/// seen for certain, everything else but once in 2^32.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Checksum {
    state: u32,
    bytes: u64,
}

/// Eight bytes at once: table `k` holds the remainder of a byte that `k` others follow.
const TABLES: [[u32; 256]; 8] = {
    let mut tables = [[0; 256]; 8];
    let mut byte = 0;
    while byte < 256 {
        let mut remainder = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            remainder = (remainder >> 1) ^ (0xEDB8_8320 * (remainder & 1));
            bit += 1;
        }
        tables[0][byte] = remainder;
        byte += 1;
    }
    let mut table = 1;
    while table < 8 {
        let mut byte = 0;
        while byte < 256 {
            let before = tables[table - 1][byte];
            tables[table][byte] = (before >> 8) ^ tables[0][(before & 0xFF) as usize];
            byte += 1;
        }
        table += 1;
    }
    tables
};

/// Length of a file and CRC-32 of what it holds, as eight hexadecimal digits: a file whose fingerprint has not changed has not either, but once in
/// 2^32.
///
/// # Errors
/// Those of reading it.
pub fn fingerprint(path: impl AsRef<Path>) -> io::Result<(u64, String)> {
    let sum = Checksum::of(File::open(path)?)?;
    Ok((sum.bytes(), sum.hex()))
}

impl Default for Checksum {
    fn default() -> Self {
        Self { state: u32::MAX, bytes: 0 }
    }
}

impl Checksum {
    /// The checksum of everything that `from` gives.
    pub(crate) fn of(mut from: impl Read) -> io::Result<Self> {
        let (mut sum, mut buffer) = (Self::default(), vec![0; 1 << 16]);
        loop {
            match from.read(&mut buffer) {
                Ok(0) => return Ok(sum),
                Ok(count) => sum.add(&buffer[..count]),
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(e),
            }
        }
    }

    pub(crate) fn add(&mut self, bytes: &[u8]) {
        let of = |table: usize, word: u32, byte: u32| TABLES[table][(word >> (8 * byte) & 0xFF) as usize];
        let mut crc = self.state;
        let (words, rest) = bytes.as_chunks::<8>();
        for [a, b, c, d, e, f, g, h] in words {
            let (low, high) =
                (u32::from_le_bytes([*a, *b, *c, *d]) ^ crc, u32::from_le_bytes([*e, *f, *g, *h]));
            crc = (0..4).fold(0, |x, k| x ^ of(7 - k as usize, low, k) ^ of(3 - k as usize, high, k));
        }
        for byte in rest {
            crc = (crc >> 8) ^ of(0, crc ^ u32::from(*byte), 0);
        }
        self.state = crc;
        self.bytes += bytes.len() as u64;
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Eight hexadecimal digits, as `crc32` and `zlib.crc32` give them.
    pub(crate) fn hex(&self) -> String {
        format!("{:08x}", !self.state)
    }
}

/// A writer that sums up what goes through it.
#[derive(Debug)]
pub struct Summed<W> {
    to: W,
    sum: Checksum,
}

impl<W: Write> Summed<W> {
    pub(super) fn new(to: W) -> Self {
        Self { to, sum: Checksum::default() }
    }

    pub(super) fn finish(self) -> (W, Checksum) {
        (self.to, self.sum)
    }
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.to.write(bytes)?;
        self.sum.add(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_the_standard_comes_out_however_the_bytes_come() {
        let text = b"123456789";
        for cut in 0..text.len() {
            let mut sum = Checksum::default();
            sum.add(&text[..cut]);
            sum.add(&text[cut..]);
            assert_eq!((sum.hex().as_str(), sum.bytes()), ("cbf43926", 9));
        }
        let long = text.repeat(1000);
        // Python's zlib.crc32.
        assert_eq!(Checksum::of(&long[..]).unwrap().hex(), "407589cf");
    }
}
