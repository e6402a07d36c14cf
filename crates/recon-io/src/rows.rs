//! Rows of CSV text, and whether the last of them is whole.

use std::io::{self, Read};
use thiserror::Error;

/// Whole rows that say how long a last field is: fewer say nothing.
const TELLING: u64 = 5;
/// Of the last fields of whole rows, so many in a hundred may be as short as that of a row that was cut.
const RARE: u64 = 1;
/// Characters that a last field is shorter than those by, so that it is clearly cut. What is lost with fewer of a number in full is
/// rounding.
const CLEARLY: usize = 3;
/// Digits of a number that stands in full: one whose exponent is lost has as many.
const IN_FULL: usize = 15;
/// Fields as long as this or longer are counted as one length.
const LONGEST: usize = 31;

/// A last row whose line has no end, with less in its last field than the rows before it have.
#[derive(Debug, Error)]
#[error(
    "the last line ({line}) ends in `{field}` without a newline, cut off as it seems: {why}; copy the file anew, or end the line if \
     the number is right"
)]
struct CutOff {
    line: u64,
    field: String,
    why: &'static str,
}

/// Reads rows of CSV text, the header among them.
///
/// A file that was copied in part ends anywhere: within a number it would be read as another one. A last line without its end is taken
/// where its last field looks like those above it, and is an error of the reader where it does not.
pub(crate) fn rows<R: Read>(text: R) -> csv::StringRecordsIntoIter<Whole<R>> {
    let mut reader = csv::ReaderBuilder::new();
    reader.has_headers(false).flexible(true).trim(csv::Trim::All);
    reader.from_reader(Whole { text, line: Vec::new(), lines: 0, seen: Seen::default() }).into_records()
}

/// An error of reading, or else of the text.
pub(crate) fn read_error(error: csv::Error) -> Result<io::Error, csv::Error> {
    if !error.is_io_error() {
        return Err(error);
    }
    Ok(match error.into_kind() {
        csv::ErrorKind::Io(io) => io,
        other => io::Error::other(format!("{other:?}")),
    })
}

/// Passes bytes on and looks at the end of each line.
pub(crate) struct Whole<R> {
    text: R,
    /// What has come of the line that has not ended.
    line: Vec<u8>,
    /// Lines that have ended.
    lines: u64,
    seen: Seen,
}

/// The last fields of rows that have ended.
#[derive(Default)]
struct Seen {
    count: u64,
    lengths: [u64; LONGEST + 1],
    /// Characters after the point, where all rows have as many.
    decimals: Option<usize>,
    uneven: bool,
    exponents: bool,
}

impl<R: Read> Read for Whole<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.text.read(buffer)?;
        if count == 0 && !buffer.is_empty() {
            return self.ended().map(|()| 0);
        }
        let mut parts = buffer[..count].split(|byte| *byte == b'\n');
        let last = parts.next_back().unwrap_or_default();
        for part in parts {
            self.line.extend_from_slice(part);
            // The first line is the header.
            if self.lines > 0 {
                self.seen.add(last_field(&self.line));
            }
            self.lines += 1;
            self.line.clear();
        }
        self.line.extend_from_slice(last);
        Ok(count)
    }
}

impl<R> Whole<R> {
    fn ended(&self) -> io::Result<()> {
        let field = last_field(&self.line);
        match self.seen.lacks(field).filter(|_| self.lines > 0) {
            None => Ok(()),
            Some(why) => {
                let field = String::from_utf8_lossy(field).into_owned();
                let cut = CutOff { line: self.lines + 1, field, why };
                Err(io::Error::new(io::ErrorKind::UnexpectedEof, cut))
            }
        }
    }
}

impl Seen {
    fn add(&mut self, field: &[u8]) {
        if !is_number(field) {
            return;
        }
        self.count += 1;
        self.lengths[field.len().min(LONGEST)] += 1;
        self.exponents |= has_exponent(field);
        let decimals = decimals(field);
        self.uneven |= self.decimals.is_some_and(|all| all != decimals);
        self.decimals = Some(decimals);
    }

    /// What a last field lacks that those of the rows above have.
    fn lacks(&self, field: &[u8]) -> Option<&'static str> {
        if self.count < TELLING || !is_number(field) {
            return None;
        }
        if !self.uneven && self.decimals.is_some_and(|all| decimals(field) < all) {
            return Some("all rows above have more decimals there");
        }
        let shorter: u64 = self.lengths.iter().take(field.len() + CLEARLY).sum();
        if 100 * shorter <= RARE * self.count {
            return Some("those above it are longer");
        }
        let digits = field.iter().filter(|byte| byte.is_ascii_digit()).count();
        let in_full = digits >= IN_FULL && !has_exponent(field) && self.exponents;
        in_full.then_some("numbers as long as this one have exponents above it")
    }
}

fn last_field(line: &[u8]) -> &[u8] {
    let from = line.iter().rposition(|byte| *byte == b',').map_or(0, |comma| comma + 1);
    line[from..].trim_ascii()
}

fn is_number(field: &[u8]) -> bool {
    field.iter().any(u8::is_ascii_digit)
}

fn has_exponent(field: &[u8]) -> bool {
    field.iter().any(|byte| matches!(byte, b'e' | b'E'))
}

/// Characters after the point, an exponent among them.
fn decimals(field: &[u8]) -> usize {
    field.iter().position(|byte| *byte == b'.').map_or(0, |point| field.len() - 1 - point)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a text that comes in small pieces, or what is wrong with it.
    fn read(text: &str) -> Result<usize, String> {
        struct Pieces<'a>(&'a [u8]);
        impl Read for Pieces<'_> {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                let count = buffer.len().min(7).min(self.0.len());
                let (now, later) = self.0.split_at(count);
                buffer[..count].copy_from_slice(now);
                self.0 = later;
                Ok(count)
            }
        }
        let all: Result<Vec<_>, _> = rows(Pieces(text.as_bytes())).collect();
        all.map(|rows| rows.len())
            .map_err(|e| read_error(e).map_or_else(|e| e.to_string(), |e| e.to_string()))
    }

    fn table(column: impl Fn(f64) -> String) -> String {
        (1..=40).fold("t,x\n".to_owned(), |text, k| {
            let x = f64::from(k);
            format!("{text}{},{}\n", 0.1 * x, column(x))
        })
    }

    #[test]
    fn a_number_that_was_cut_is_told_at_every_length_that_matters() {
        // A bit each above rounding, in full: what may be lost unseen is rounding.
        let text = table(|x| format!("{}", (0.3 * x).sin() * 2.0));
        let start = text.trim_end().rfind(',').unwrap() + 1;
        let (whole, mut unseen) = (text[start..].trim().parse::<f64>().unwrap(), 0);
        for end in start + 1..text.len() {
            match (read(&text[..end]), text[start..end].parse::<f64>()) {
                (Ok(_), Ok(value)) => {
                    unseen += 1;
                    assert!((value / whole - 1.0).abs() < 1e-12, "{value} for {whole}");
                }
                (Ok(_), Err(_)) => assert_eq!(&text[start..end], "-", "not a number, and told later"),
                (Err(what), _) => assert!(what.contains("last line (41)") && what.contains("copy"), "{what}"),
            }
        }
        assert!((1..8).contains(&unseen), "{unseen}");
    }

    #[test]
    fn digits_of_even_columns_and_exponents_are_missed() {
        let even = table(|x| format!("{:.3}", 1.7 * x));
        assert!(read(&even[..even.len() - 2]).unwrap_err().contains("decimals"));
        let small = table(|x| format!("{:e}", (0.3 * x).sin() / 7e6));
        let point = small.rfind('e').unwrap();
        assert!(read(&small[..point]).unwrap_err().contains("exponents"));
    }

    #[test]
    fn a_last_line_that_is_whole_needs_no_end() {
        for column in
            [|x: f64| format!("{x}"), |x: f64| format!("{:.2}", 0.3 * x), |x: f64| format!("{}", x.sqrt())]
        {
            let text = table(column);
            assert_eq!(read(&text), Ok(41));
            assert_eq!(read(text.trim_end()), Ok(41));
            assert_eq!(read(&text.replace('\n', "\r\n")), Ok(41));
        }
        assert_eq!(read("t,x\n1,0.25\n2,0.5"), Ok(3));
        assert_eq!(read("t,x"), Ok(1));
        let some_are_none = table(|x| if x > 39.0 { "nan".to_owned() } else { format!("{}", x.sqrt()) });
        assert_eq!(read(some_are_none.trim_end()), Ok(41));
    }
}
