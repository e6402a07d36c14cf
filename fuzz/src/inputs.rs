//! Seeds that are committed, and inputs made of them: bytes changed, cut, doubled and joined, and words that parsers stumble over.

use exact_hull::generators::Source;
use std::io;
use std::path::Path;

/// Words that are numbers, or nearly.
const WORDS: [&str; 20] = [
    "nan",
    "inf",
    "-0",
    "1e999",
    "1e-999",
    "-1",
    "0",
    "1",
    "18446744073709551616",
    "0x10",
    "1,5",
    "\"",
    "\n",
    "\r\n",
    "\u{feff}",
    ",,",
    "[[palm]]",
    "= {",
    "true",
    "\u{0}",
];
/// No input is longer.
const LONGEST: usize = 1 << 17;

/// The committed inputs of a target, good ones and bad, in the order of their names; one that is empty where there are none.
///
/// # Errors
/// Where the folder of a target that has one cannot be read.
pub fn seeds(target: &str) -> io::Result<Vec<Vec<u8>>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("seeds").join(target);
    let mut files: Vec<_> =
        folder.read_dir()?.collect::<Result<Vec<_>, _>>()?.into_iter().map(|file| file.path()).collect();
    files.sort();
    files.into_iter().map(std::fs::read).collect()
}

/// An input made of the seeds.
#[must_use]
pub fn made(seeds: &[Vec<u8>], s: &mut Source) -> Vec<u8> {
    if seeds.is_empty() || s.below(20) == 0 {
        return (0..s.below(1000)).map(|_| s.bits() as u8).collect();
    }
    let mut bytes = seeds[s.below(seeds.len())].clone();
    for _ in 0..s.below(5) {
        changed(&mut bytes, &seeds[s.below(seeds.len())], s);
    }
    bytes.truncate(LONGEST);
    bytes
}

/// One change; `other` is what a piece may come from.
fn changed(bytes: &mut Vec<u8>, other: &[u8], s: &mut Source) {
    let at = s.below(bytes.len() + 1);
    let end = (at + s.below(64)).min(bytes.len());
    match s.below(12) {
        0 if at < bytes.len() => bytes[at] = s.bits() as u8,
        1 if at < bytes.len() => bytes[at] ^= 1 << s.below(8),
        2 => drop(bytes.drain(at..end)),
        3 => {
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        4 => {
            let from = s.below(other.len() + 1);
            let to = (from + s.below(200)).min(other.len());
            bytes.splice(at..end, other[from..to].iter().copied());
        }
        5 => bytes.truncate(at),
        6..=8 => {
            let digit = bytes.iter().skip(at).position(u8::is_ascii_digit);
            if let Some(digit) = digit {
                bytes[at + digit] = b'0' + s.below(10) as u8;
            }
        }
        9 | 10 => {
            let length = bytes[at..].iter().take_while(|b| b.is_ascii_digit() || b".-+e".contains(b)).count();
            bytes.splice(at..at + length, WORDS[s.below(WORDS.len())].bytes());
        }
        _ => drop(bytes.splice(at..at, WORDS[s.below(WORDS.len())].bytes())),
    }
}
