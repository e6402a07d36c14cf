//! Triangles as they stand in a file: a reader of its own, for the layouts that recon writes.

use certificate::Surface;
use glam::DVec3;
use std::io::{self, BufRead, Read};

/// What a header may hold at most, and how many corners or triangles are made room for before they are read.
const LONGEST_HEADER: usize = 4096;
const ROOM: usize = 1 << 20;

/// Reads binary little-endian PLY of double coordinates and triangles.
pub(super) fn from_ply(mut from: impl BufRead) -> io::Result<Surface> {
    let (mut lines, mut length) = (Vec::new(), 0);
    while lines.last().is_none_or(|line| line != "end_header") {
        let mut line = Vec::new();
        length += from.by_ref().take((LONGEST_HEADER - length) as u64).read_until(b'\n', &mut line)?;
        if line.last() != Some(&b'\n') || length >= LONGEST_HEADER {
            return Err(wrong("its header does not end"));
        }
        lines.push(String::from_utf8_lossy(&line).trim_end().to_owned());
    }
    let expected = ["ply", "format binary_little_endian 1.0", "property list uchar int vertex_indices"];
    if let Some(missing) = expected.iter().find(|line| !lines.iter().any(|l| l == *line)) {
        return Err(wrong(&format!("its header lacks `{missing}`")));
    }
    let count = |of: &str| -> io::Result<usize> {
        let found = lines.iter().find_map(|line| line.strip_prefix(of)?.trim().parse().ok());
        found.ok_or_else(|| wrong(&format!("its header lacks `{of} NUMBER`")))
    };
    let (corners, triangles) = (count("element vertex")?, count("element face")?);
    let mut read = (Vec::with_capacity(corners.min(ROOM)), Vec::with_capacity(triangles.min(ROOM)));
    for _ in 0..corners {
        let mut number = || -> io::Result<f64> {
            let mut bytes = [0; 8];
            from.read_exact(&mut bytes).map_err(short)?;
            Ok(f64::from_le_bytes(bytes))
        };
        read.0.push(DVec3::new(number()?, number()?, number()?));
    }
    for _ in 0..triangles {
        let mut bytes = [0; 13];
        from.read_exact(&mut bytes).map_err(short)?;
        if bytes[0] != 3 {
            return Err(wrong(&format!("a face has {} corners", bytes[0])));
        }
        let corner = |k: usize| u32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]);
        read.1.push([corner(1), corner(5), corner(9)]);
    }
    if from.read(&mut [0])? != 0 {
        return Err(wrong("it goes on after its last face"));
    }
    checked(read)
}

/// Reads Wavefront OBJ of lines `v x y z` and `f a b c`.
pub(super) fn from_obj(from: impl BufRead) -> io::Result<Surface> {
    let mut read = (Vec::new(), Vec::new());
    for line in from.lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let bad = || wrong(&format!("`{line}` is not three numbers"));
        match words.as_slice() {
            ["v", rest @ ..] => {
                let numbers: Result<Vec<f64>, _> = rest.iter().map(|word| word.parse()).collect();
                let numbers = numbers.ok().and_then(|n| <[f64; 3]>::try_from(n).ok()).ok_or_else(bad)?;
                read.0.push(numbers.into());
            }
            ["f", rest @ ..] => {
                let first = |word: &&str| word.split('/').next()?.parse::<u32>().ok()?.checked_sub(1);
                let numbers: Option<Vec<u32>> = rest.iter().map(first).collect();
                let numbers = numbers.and_then(|n| <[u32; 3]>::try_from(n).ok()).ok_or_else(bad)?;
                read.1.push(numbers);
            }
            _ => {}
        }
    }
    checked(read)
}

fn checked((corners, triangles): (Vec<DVec3>, Vec<[u32; 3]>)) -> io::Result<Surface> {
    Surface::new(corners, triangles).map_err(|error| wrong(&error.to_string()))
}

fn wrong(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

fn short(error: io::Error) -> io::Error {
    if error.kind() == io::ErrorKind::UnexpectedEof { wrong("it ends too early") } else { error }
}
