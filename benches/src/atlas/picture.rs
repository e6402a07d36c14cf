//! Heat maps as SVG: ways downwards, strengths to the right, each cell filled by the share of each outcome.

use super::plan::{Counts, Map};
use super::{Method, Outcome};
use std::fmt::Write;

const LABEL: f64 = 372.0;
const CELL: [f64; 2] = [74.0, 24.0];
const GAP: f64 = 3.0;
const TOP: f64 = 84.0;

/// Colours for light pages and for dark ones.
const STYLE: &str = "<style>text{font-family:'DejaVu Sans',Verdana,Helvetica,Arial,sans-serif;fill:#1f2933}.faint{fill:#616e7c}\
.page{fill:#fcfcfd}.Right{fill:#0072b2}.Reported{fill:#e69f00}.Error{fill:#a9bccf}.Silent{fill:#c8102e}.Crash{fill:#111}.NoScene{fill:#e4e7eb}\
.in{fill:#fff;font-size:10px}.dark{fill:#1f2933;font-size:10px}.ring{fill:none;stroke:#c8102e;stroke-width:2}\
@media(prefers-color-scheme:dark){text{fill:#e4e7eb}.faint{fill:#9aa5b1}.page{fill:#16191d}.Error{fill:#5c7187}.Crash{fill:#fff}.NoScene{fill:#2d333b}\
.Right{fill:#3391cc}.in{fill:#fff}.dark{fill:#111}}</style>";

fn class(outcome: Outcome) -> String {
    format!("{outcome:?}")
}

/// A number with as few digits as it needs.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

/// The picture of a method: its rows with what came of each strength.
#[must_use]
pub fn picture(method: &Method, rows: &[Vec<Counts>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = LABEL + columns as f64 * (CELL[0] + GAP) + 20.0;
    let height = TOP + rows.len() as f64 * (CELL[1] + GAP) + 16.0;
    let mut svg = head(
        width,
        height,
        method.name,
        "ways of failing downwards, strength to the right; figures in the cells: strength",
    );
    for (i, (way, counts)) in method.ways.iter().zip(rows).enumerate() {
        let y = TOP + i as f64 * (CELL[1] + GAP);
        let words = if way.unit() == "1" {
            way.words().to_owned()
        } else {
            format!("{}, {}", way.words(), way.unit())
        };
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"11\">{words}</text>",
            LABEL - 8.0,
            y + 16.0
        );
        for (k, (strength, counts)) in method.strengths(*way).iter().zip(counts).enumerate() {
            let title = format!("{} {} {}", way.words(), short(*strength), way.unit());
            cell(&mut svg, [LABEL + k as f64 * (CELL[0] + GAP), y], counts, &title, &short(*strength));
        }
    }
    svg + "</svg>\n"
}

/// The picture of a map: rows of counts, the first one lowest.
#[must_use]
pub fn map_picture(map: &Map, rows: &[Vec<Counts>]) -> String {
    let (right, up) = (map.right, map.up);
    let width = LABEL * 0.4 + right.2.len() as f64 * (CELL[0] + GAP) + 20.0;
    let height = TOP + up.2.len() as f64 * (CELL[1] + GAP) + 60.0;
    let axes =
        format!("upwards: {}, {}; to the right: {}, {}", up.0, up.1, right.0, right.1).replace(", 1;", ";");
    let axes = axes.strip_suffix(", 1").unwrap_or(&axes).to_owned();
    let mut svg = head(width.max(820.0), height, map.name, &axes);
    for (i, (value, counts)) in up.2.iter().zip(rows).enumerate() {
        let y = TOP + (up.2.len() - 1 - i) as f64 * (CELL[1] + GAP);
        let x = 0.4 * LABEL;
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"11\">{}</text>",
            x - 8.0,
            y + 16.0,
            short(*value)
        );
        for (k, (at, counts)) in right.2.iter().zip(counts).enumerate() {
            let title = format!("{} {}, {} {}", right.0, short(*at), up.0, short(*value));
            cell(&mut svg, [x + k as f64 * (CELL[0] + GAP), y], counts, &title, "");
        }
    }
    let y = TOP + up.2.len() as f64 * (CELL[1] + GAP) + 14.0;
    for (k, at) in right.2.iter().enumerate() {
        let x = 0.4 * LABEL + (k as f64 + 0.5) * (CELL[0] + GAP);
        let _ = write!(
            svg,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" font-size=\"11\">{}</text>",
            short(*at)
        );
    }
    svg + "</svg>\n"
}

fn head(width: f64, height: f64, title: &str, subtitle: &str) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" role=\"img\">{STYLE}\
         <title>{title}</title><rect class=\"page\" width=\"100%\" height=\"100%\"/>\
         <text x=\"14\" y=\"24\" font-size=\"16\">{title}</text><text class=\"faint\" x=\"14\" y=\"42\" font-size=\"11\">{subtitle}</text>"
    );
    let mut x = 14.0;
    for outcome in Outcome::ALL {
        let words = outcome.words();
        let _ = write!(
            svg,
            "<rect class=\"{}\" x=\"{x:.0}\" y=\"54\" width=\"13\" height=\"13\" rx=\"2\"/><text x=\"{:.0}\" y=\"65\" font-size=\"11\">{words}</text>",
            class(outcome),
            x + 18.0
        );
        x += 34.0 + 6.8 * words.chars().count() as f64;
    }
    svg
}

/// A cell: bars side by side, as wide as their shares.
fn cell(svg: &mut String, [x, y]: [f64; 2], counts: &Counts, title: &str, label: &str) {
    let all: usize = counts.of.iter().sum();
    let [width, height] = CELL;
    let told: Vec<String> = Outcome::ALL
        .iter()
        .zip(counts.of)
        .filter(|(_, n)| *n > 0)
        .map(|(outcome, n)| format!("{} {n}", outcome.words()))
        .collect();
    let _ = write!(svg, "<g><title>{title}: {}</title>", told.join(", "));
    let mut from = x;
    for (outcome, n) in Outcome::ALL.into_iter().zip(counts.of).filter(|(_, n)| *n > 0) {
        let share = width * n as f64 / all as f64;
        let _ = write!(
            svg,
            "<rect class=\"{}\" x=\"{from:.1}\" y=\"{y:.1}\" width=\"{share:.1}\" height=\"{height:.0}\"/>",
            class(outcome)
        );
        from += share;
    }
    if counts.count(Outcome::Silent) + counts.count(Outcome::Crash) > 0 {
        let _ = write!(
            svg,
            "<rect class=\"ring\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.0}\" height=\"{height:.0}\"/>"
        );
    }
    if !label.is_empty() {
        // The middle of the cell decides which ink is seen on it.
        let bright = in_the_middle(counts)
            .is_none_or(|of| matches!(of, Outcome::Reported | Outcome::Error | Outcome::NoScene));
        let ink = if bright { "dark" } else { "in" };
        let _ = write!(
            svg,
            "<text class=\"{ink}\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
            x + 0.5 * width,
            y + 16.0
        );
    }
    svg.push_str("</g>");
}

fn in_the_middle(counts: &Counts) -> Option<Outcome> {
    let all: usize = counts.of.iter().sum();
    let mut sum = 0;
    Outcome::ALL.into_iter().zip(counts.of).find_map(|(outcome, n)| {
        sum += n;
        (2 * sum > all).then_some(outcome)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::METHODS;

    #[test]
    fn a_cell_is_filled_by_shares_and_ringed_where_something_was_wrong() {
        let good = Counts { of: [3, 1, 0, 0, 0, 0], ..Counts::default() };
        let mut bad = good.clone();
        bad.of[3] = 1;
        let mut svg = String::new();
        cell(&mut svg, [0.0, 0.0], &good, "t", "0.1");
        assert!(svg.contains("width=\"55.5\"") && svg.contains("width=\"18.5\"") && !svg.contains("ring"));
        let mut svg = String::new();
        cell(&mut svg, [0.0, 0.0], &bad, "t", "0.1");
        assert!(svg.contains("ring"));
    }

    #[test]
    fn a_picture_has_a_row_for_each_way_and_ends() {
        let method = &METHODS[0];
        let rows = vec![vec![Counts::default(); 8]; method.ways.len()];
        let svg = picture(method, &rows);
        assert!(svg.ends_with("</svg>\n") && method.ways.iter().all(|way| svg.contains(way.words())));
    }
}
