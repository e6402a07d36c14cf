//! Numbers from named columns of a CSV text.

use super::error::TouchesErrorKind as Kind;
use crate::rows::{read_error, rows};
use std::io::Read;

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
