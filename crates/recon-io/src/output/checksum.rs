use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;

/// CRC-32 as in gzip and zip (IEEE 802.3, reflected): whatever is changed within four bytes that follow each other is
/// seen for certain, everything else but once in 2^32.
#[derive(Clone, Debug, Default)]
pub(crate) struct Checksum {
    sum: crc32fast::Hasher,
    bytes: u64,
}

/// Length of a file and CRC-32 of what it holds, as eight hexadecimal digits: a file whose fingerprint has not changed has not either, but once in
/// 2^32.
///
/// # Errors
/// Those of reading it.
pub fn fingerprint(path: impl AsRef<Path>) -> io::Result<(u64, String)> {
    let sum = Checksum::of(File::open(path)?)?;
    Ok((sum.bytes(), sum.hex()))
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
        self.sum.update(bytes);
        self.bytes += bytes.len() as u64;
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Eight hexadecimal digits, as `crc32` and `zlib.crc32` give them.
    pub(crate) fn hex(&self) -> String {
        format!("{:08x}", self.sum.clone().finalize())
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
