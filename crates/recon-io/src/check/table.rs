//! Tables: every row has all cells, every cell a finite number.

use super::Fault;
use glam::DVec2;
use std::io::{self, BufRead};

/// Columns in which `nan` says that there is nothing: radius functions of a palm that does not touch.
const MAY_BE_NAN: (&str, [&str; 5]) = ("radius_functions.csv", ["r_1", "r_2", "r_3", "r_4", "r_5"]);
/// Columns of a log that are empty or `nan` while a palm does not touch.
const LOG: &str = "log.csv";

/// How many rows a table has, and in how many of them the last number is 1.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LastColumn {
    pub(super) rows: usize,
    pub(super) ones: usize,
}

impl LastColumn {
    pub(super) fn count(&mut self, row: &[f64]) {
        self.rows += 1;
        self.ones += usize::from(row.last() == Some(&1.0));
    }
}

/// What the numbers of a column must be, and whether one is so.
type Must = (&'static str, fn(f64) -> bool);

/// By the names that columns of motions have: deviations, contact modes, their probabilities, and what is relied on.
fn must(column: &str) -> Option<Must> {
    if column.starts_with("std_") {
        return Some(("zero or above", |number| number >= 0.0));
    }
    if column.starts_with("mode_") {
        return Some(("0, 1 or 2", |number| [0.0, 1.0, 2.0].contains(&number)));
    }
    if column.starts_with("p_slide_") || column.starts_with("p_stick_") {
        return Some(("from 0 to 1", |number| (0.0..=1.0).contains(&number)));
    }
    (column == "relied_on").then_some(("0 or 1", |number| [0.0, 1.0].contains(&number)))
}

/// Reads a table of numbers and gives each row to `each`. Where not all are `asked` for, those of columns without a rule may be given as `nan`, but for the last
/// column: they are seen to be finite numbers, and not made ones.
pub(super) fn numbers(
    file: &str,
    mut from: impl BufRead,
    asked: Columns,
    mut each: impl FnMut(&[f64]),
) -> io::Result<Option<Fault>> {
    let mut text = String::new();
    from.read_line(&mut text)?;
    let columns: Vec<String> = text.trim_end().split(',').map(str::to_owned).collect();
    let musts: Vec<Option<Must>> = columns.iter().map(|column| must(column)).collect();
    let (mut line, mut row) = (1, Vec::with_capacity(columns.len()));
    loop {
        text.clear();
        if from.read_line(&mut text)? == 0 {
            return Ok(None);
        }
        line += 1;
        row.clear();
        for cell in Cells(Some(text.trim_end())) {
            let (k, column) = (row.len(), columns.get(row.len()).map_or("", String::as_str));
            let must = musts.get(k).copied().flatten();
            if asked == Columns::Last && must.is_none() && k + 1 < columns.len() && is_plain(cell) {
                row.push(f64::NAN);
                continue;
            }
            let absent = || {
                let empty = cell.is_empty() || cell == "nan";
                empty && (file == LOG || (MAY_BE_NAN.0 == file && MAY_BE_NAN.1.contains(&column)))
            };
            match cell.parse::<f64>() {
                Ok(number) if number.is_finite() => match must {
                    Some((must, is)) if !is(number) => {
                        let (file, column, text) = (file.to_owned(), column.to_owned(), cell.to_owned());
                        return Ok(Some(Fault::Range { file, line, column, text, must }));
                    }
                    _ => row.push(number),
                },
                _ if absent() => row.push(f64::NAN),
                _ => {
                    let (file, column, text) = (file.to_owned(), column.to_owned(), cell.to_owned());
                    return Ok(Some(Fault::Cell { file, line, column, text }));
                }
            }
        }
        if row.len() != columns.len() {
            let (expected, found) = (columns.len(), row.len());
            return Ok(Some(Fault::Row { file: file.to_owned(), line, expected, found }));
        }
        each(&row);
    }
}

/// Columns whose numbers are asked for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Columns {
    All,
    Last,
}

/// Cells of what is left of a line.
struct Cells<'a>(Option<&'a str>);

impl<'a> Iterator for Cells<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let left = self.0?;
        // Cells are short: a search that is made for long texts takes longer to begin than to find one.
        let end = left.bytes().position(|byte| byte == b',');
        self.0 = end.map(|end| &left[end + 1..]);
        Some(&left[..end.unwrap_or(left.len())])
    }
}

/// Whether a cell is a decimal number that is finite whatever its digits are: with a digit before the point, of at most twenty places, and an exponent of
/// at most two.
fn is_plain(cell: &str) -> bool {
    const PLACES: usize = 20;
    let digits = |of: &[u8]| of.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut left = cell.as_bytes();
    left = left.strip_prefix(b"-").unwrap_or(left);
    let whole = digits(left);
    left = &left[whole..];
    if let Some(part) = left.strip_prefix(b".") {
        left = &part[digits(part)..];
    }
    if let Some(exponent) = left.strip_prefix(b"e") {
        let exponent = exponent.strip_prefix(b"-").unwrap_or(exponent);
        let places = digits(exponent);
        left = &exponent[places..];
        if !(1..=2).contains(&places) {
            return false;
        }
    }
    (1..=PLACES).contains(&whole) && left.is_empty()
}

/// Reads the corners of an outline.
pub(super) fn corners(file: &str, from: impl BufRead) -> io::Result<Result<Vec<DVec2>, Fault>> {
    let mut corners = Vec::new();
    let fault = numbers(file, from, Columns::All, |row| {
        if let [x, y] = row {
            corners.push(DVec2::new(*x, *y));
        }
    })?;
    Ok(fault.map_or(Ok(corners), Err))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is seen to be a number is one that is finite, however it was written; what is none, or may not be, is left to be read.
    #[test]
    fn plain_cells_are_finite_numbers() {
        for cell in ["0", "-1.5", "3.", "1e-7", "-12.25e30", "99999999999999999999e99", "0.1e0"] {
            assert!(is_plain(cell) && cell.parse::<f64>().is_ok_and(f64::is_finite), "{cell}");
        }
        for cell in
            ["", "-", ".5", "1e", "1e400", "1e-", "1.2.3", "1e+5", "nan", "inf", "1 ", "0x1", "1e5x", "--1"]
        {
            assert!(!is_plain(cell), "{cell}");
        }
        for text in ["", ",", "a", "a,", ",a,,b"] {
            assert!(Cells(Some(text)).eq(text.split(',')), "{text}");
        }
    }
}
