//! Numbers from named columns of a CSV text.

use super::error::TouchesErrorKind as Kind;
use crate::rows::{read_error, rows};
use std::io::Read;

/// Columns of which one numbers the curves of contacts, and those that number the runs of poses.
pub(super) const CURVES: [&str; 2] = ["palm", "curve"];
pub(super) const RUNS: [&str; 2] = ["toss", "run"];

/// Numbers of one row: `N` columns that must be there and one that may be.
pub(super) struct Numbers<const N: usize> {
    pub(super) line: u64,
    pub(super) values: [f64; N],
    pub(super) group: Option<f64>,
}

/// Reads the columns named `required`, and the first of `groups` that is there. Columns are found by name, in any order;
/// others are ignored.
pub(super) fn read_columns<const N: usize>(
    text: impl Read,
    required: [&'static str; N],
    groups: &[&'static str],
) -> Result<Vec<Numbers<N>>, Kind> {
    let csv_error = |error| read_error(error).map_or_else(Kind::Csv, Kind::Read);
    let mut rows = rows(text);
    let header = rows.next().ok_or(Kind::Empty)?.map_err(csv_error)?;
    let find =
        |column: &str| header.iter().position(|name| name.trim_start_matches('\u{feff}').trim() == column);
    let mut places = [0; N];
    for (place, column) in places.iter_mut().zip(required) {
        *place = find(column).ok_or_else(|| Kind::MissingColumn {
            column,
            found: header.iter().collect::<Vec<_>>().join(", "),
        })?;
    }
    let group = groups.iter().find_map(|name| find(name).map(|place| (*name, place)));
    let mut numbers = Vec::new();
    for row in rows {
        let row = row.map_err(csv_error)?;
        let line = row.position().map_or(0, csv::Position::line);
        let mut values = [0.0; N];
        for ((value, place), column) in values.iter_mut().zip(places).zip(required) {
            *value = number(&row, place, column, line)?;
        }
        let group = group.map(|(column, place)| number(&row, place, column, line)).transpose()?;
        numbers.push(Numbers { line, values, group });
    }
    if numbers.is_empty() { Err(Kind::Empty) } else { Ok(numbers) }
}

fn number(row: &csv::StringRecord, place: usize, column: &'static str, line: u64) -> Result<f64, Kind> {
    let text = row.get(place).unwrap_or_default();
    let finite = text.parse().ok().filter(|v: &f64| v.is_finite());
    finite.ok_or_else(|| Kind::NotANumber { line, column, text: text.to_owned() })
}

/// The same from columns in memory; lines are then rows, counted from 0.
pub(super) fn numbers<const N: usize>(
    names: &[String],
    columns: &[&[f64]],
    required: [&'static str; N],
    groups: &[&'static str],
) -> Result<Vec<Numbers<N>>, Kind> {
    let find =
        |column: &str| names.iter().position(|name| name.trim() == column).filter(|i| *i < columns.len());
    let mut places = [0; N];
    for (place, column) in places.iter_mut().zip(required) {
        *place = find(column).ok_or_else(|| Kind::MissingColumn { column, found: names.join(", ") })?;
    }
    let group = groups.iter().find_map(|name| find(name).map(|place| (*name, place)));
    let count = columns.first().map_or(0, |first| first.len());
    let number = |place: usize, column: &'static str, k: usize| match columns[place].get(k) {
        Some(value) if value.is_finite() => Ok(*value),
        other => {
            let text = other.map_or_else(|| "nothing".to_owned(), f64::to_string);
            Err(Kind::NotANumber { line: k as u64, column, text })
        }
    };
    let row = |k: usize| {
        let mut values = [0.0; N];
        for ((value, place), column) in values.iter_mut().zip(places).zip(required) {
            *value = number(place, column, k)?;
        }
        let group = group.map(|(column, place)| number(place, column, k)).transpose()?;
        Ok::<_, Kind>(Numbers { line: k as u64, values, group })
    };
    let rows = (0..count).map(row).collect::<Result<Vec<_>, Kind>>()?;
    if rows.is_empty() { Err(Kind::Empty) } else { Ok(rows) }
}

/// `items` split where the group changes.
pub(super) fn by_group<T>(items: impl IntoIterator<Item = (Option<f64>, T)>) -> Vec<Vec<T>> {
    let mut lists: Vec<(Option<f64>, Vec<T>)> = Vec::new();
    for (group, item) in items {
        match lists.last_mut() {
            Some((last, list)) if *last == group => list.push(item),
            _ => lists.push((group, vec![item])),
        }
    }
    lists.into_iter().map(|(_, list)| list).collect()
}
