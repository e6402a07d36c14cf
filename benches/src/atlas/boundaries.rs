//! Where each method goes from right to reported, refused or wrong along each way, from the counts of the atlas.

use super::picture::short;
use super::{METHODS, Method, Way};
use std::fmt::Write;

/// What came of the runs at one strength.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cell {
    at: f64,
    right: usize,
    /// Reported in words, or a typed error.
    told: usize,
    silent: usize,
    crash: usize,
}

impl Cell {
    fn judged(&self) -> usize {
        self.right + self.told + self.silent + self.crash
    }

    /// From a row of the counts after method and way.
    fn read(row: &str) -> Option<Self> {
        let mut cells = row.split(',');
        let at = cells.next()?.parse().ok()?;
        let mut number = || cells.next()?.parse::<usize>().ok();
        let (right, reported, error, silent, crash) = (number()?, number()?, number()?, number()?, number()?);
        Some(Self { at, right, told: reported + error, silent, crash })
    }
}

/// The page, from `docs/atlas.csv`; none where that is no such table. Rows of maps of two causes are left out.
#[must_use]
pub fn boundaries(csv: &str) -> Option<String> {
    let mut text = "# Boundaries of the atlas\n\nMade by `cargo xtask atlas boundaries` from [atlas.csv](atlas.csv), and by `cargo xtask atlas` with it; what the methods and ways are, and how they are judged, is in the \
        [atlas of failures](atlas.md).\n\nOf each way of failing, in the order from harmless to hopeless: the strength up to which all runs are right, up to which half of them are, from which on some are told \
        (reported as not relied on, or refused by a typed error), from which on all are, and the strengths at which runs are wrong without a warning, with how many of how many. \"Its end\": the strongest that was tried.\n"
        .to_owned();
    let row_of = |line: &str| {
        let (name, rest) = line.strip_prefix('"')?.split_once("\",")?;
        let (way, rest) = rest.split_once(',')?;
        Some((name.to_owned(), way.to_owned(), rest.to_owned()))
    };
    let rows: Vec<_> = csv.lines().skip(1).map(row_of).collect::<Option<_>>()?;
    for method in METHODS {
        let own = |way: Way| -> Option<Vec<Cell>> {
            let of_way = rows.iter().filter(|(name, of, _)| name == method.name && of == way.word());
            of_way.map(|(.., rest)| Cell::read(rest)).collect()
        };
        text += &section(method, own)?;
    }
    Some(text)
}

fn section(method: &Method, own: impl Fn(Way) -> Option<Vec<Cell>>) -> Option<String> {
    let mut text = format!(
        "\n## {}\n\n| way | all right up to | half right up to | some told from | all told from | silent at |\n|---|---|---|---|---|---|\n",
        method.name
    );
    for way in method.ways {
        let cells: Vec<Cell> = own(*way)?.into_iter().filter(|cell| cell.judged() > 0).collect();
        let unit = if way.unit() == "1" { String::new() } else { format!(" ({})", way.unit()) };
        let _ = writeln!(text, "| {}{unit} | {} |", way.words(), boundary(&cells).join(" | "));
    }
    Some(text)
}

/// The cells of a way's row.
fn boundary(cells: &[Cell]) -> [String; 5] {
    let is_right = |cell: &Cell| cell.right == cell.judged();
    let last = |place: Option<usize>| match place {
        None => "nowhere".to_owned(),
        Some(k) if k + 1 == cells.len() => format!("{}, its end", short(cells[k].at)),
        Some(k) => short(cells[k].at),
    };
    let all = cells.iter().position(|cell| !is_right(cell)).unwrap_or(cells.len()).checked_sub(1);
    let half = cells.iter().rposition(|cell| 2 * cell.right >= cell.judged());
    let first = |place: Option<usize>| place.map_or("nowhere".to_owned(), |k| short(cells[k].at));
    let some_told = cells.iter().position(|cell| cell.told > 0);
    let all_told = cells.iter().rposition(|cell| cell.told < cell.judged()).map_or(0, |k| k + 1);
    let wrong = |(word, count): (&str, fn(&Cell) -> usize)| {
        cells
            .iter()
            .filter(|cell| count(cell) > 0)
            .map(|cell| format!("{}{word} ({} of {})", short(cell.at), count(cell), cell.judged()))
            .collect::<Vec<_>>()
    };
    let mut silent = wrong(("", |cell| cell.silent));
    silent.extend(wrong((" crash", |cell| cell.crash)));
    let silent = if silent.is_empty() { "nowhere".to_owned() } else { silent.join(", ") };
    [last(all), last(half), first(some_told), first((all_told < cells.len()).then_some(all_told)), silent]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boundaries_are_where_outcomes_change() {
        let cell = |at, right, told, silent| Cell { at, right, told, silent, crash: 0 };
        let way = [cell(0.1, 4, 0, 0), cell(0.2, 3, 1, 0), cell(0.3, 2, 1, 1), cell(0.4, 0, 4, 0)];
        assert_eq!(boundary(&way), ["0.1", "0.3", "0.2", "0.4", "0.3 (1 of 4)"]);
        assert_eq!(boundary(&way[..1]), ["0.1, its end", "0.1, its end", "nowhere", "nowhere", "nowhere"]);
        assert_eq!(boundary(&way[3..]), ["nowhere", "nowhere", "0.4", "0.4", "nowhere"]);
    }

    #[test]
    fn the_committed_counts_have_a_row_for_each_way_of_each_method() {
        let page = boundaries(include_str!("../../../docs/atlas.csv")).expect("it is such a table");
        let ways: usize = METHODS.iter().map(|method| method.ways.len()).sum();
        let rows = page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| way")).count();
        assert_eq!(rows, ways);
        assert!(boundaries("head\nno row of it\n").is_none());
    }
}
