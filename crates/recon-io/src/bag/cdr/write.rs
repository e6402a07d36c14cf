use super::HEADER;

/// A message into which values are put one after the other: plain CDR of the first version, little-endian.
#[derive(Clone, Debug)]
pub(crate) struct CdrWriter {
    bytes: Vec<u8>,
    #[cfg(test)]
    big: bool,
}

impl CdrWriter {
    pub(crate) fn new() -> Self {
        Self {
            bytes: vec![0, 1, 0, 0],
            #[cfg(test)]
            big: false,
        }
    }

    /// What other machines write; here it is only read.
    #[cfg(test)]
    pub(crate) fn big_endian() -> Self {
        Self { bytes: vec![0, 0, 0, 0], big: true }
    }

    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    pub(crate) fn u8(&mut self, value: u8) -> &mut Self {
        self.bytes.push(value);
        self
    }

    pub(crate) fn i32(&mut self, value: i32) -> &mut Self {
        self.number(value.to_le_bytes())
    }

    pub(crate) fn u32(&mut self, value: u32) -> &mut Self {
        self.number(value.to_le_bytes())
    }

    pub(crate) fn f32(&mut self, value: f32) -> &mut Self {
        self.number(value.to_le_bytes())
    }

    pub(crate) fn f64(&mut self, value: f64) -> &mut Self {
        self.number(value.to_le_bytes())
    }

    pub(crate) fn f64s(&mut self, values: &[f64]) -> &mut Self {
        values.iter().fold(self, |to, value| to.f64(*value))
    }

    /// A string with its zero byte. What is longer than a length can say is cut off.
    pub(crate) fn text(&mut self, text: &str) -> &mut Self {
        self.count(text.len() + 1);
        self.bytes.extend(text.bytes());
        self.u8(0)
    }

    /// The length of a sequence.
    pub(crate) fn count(&mut self, count: usize) -> &mut Self {
        self.u32(u32::try_from(count).unwrap_or(u32::MAX))
    }

    fn number<const N: usize>(&mut self, little: [u8; N]) -> &mut Self {
        let past = (self.bytes.len() - HEADER) % N;
        if past > 0 {
            self.bytes.resize(self.bytes.len() + N - past, 0);
        }
        #[cfg(test)]
        let little = if self.big {
            let mut turned = little;
            turned.reverse();
            turned
        } else {
            little
        };
        self.bytes.extend(little);
        self
    }
}
