//! Many logs on one page.

use super::TABLE;
use super::one::{Row, State};
use recon_io::{BatchPage, FigureCurve, FigurePanel, Level, LogCard, SummaryOf, brief_to};
use std::path::Path;

/// What the page shows of the logs of a folder.
pub(super) fn page(folder: &Path, rows: &[Row]) -> BatchPage {
    let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy();
    let count = |state: State| rows.iter().filter(|row| row.state == state).count().to_string();
    BatchPage {
        title: format!("{name}: {} logs", rows.len()),
        facts: vec![
            ("Logs", rows.len().to_string(), ""),
            ("Relied on", count(State::ReliedOn), ""),
            ("Not relied on", count(State::Doubtful), ""),
            ("Skipped", count(State::Broken), ""),
        ],
        caption: "Where the centre of mass went from where it was first, with bands of two deviations."
            .to_owned(),
        table: TABLE,
        cards: rows.iter().map(card).collect(),
    }
}

fn card(row: &Row) -> LogCard {
    let level = match row.state {
        State::ReliedOn => Level::Good,
        State::Doubtful => Level::Caution,
        State::Broken => Level::Bad,
    };
    let mass = row.mass().map(|mass| {
        let deviation = row.std_mass().map_or(String::new(), |std| format!(" ± {}", brief_to(2, std)));
        format!("mass {}{deviation} kg", brief_to(4, mass))
    });
    let why = (row.state != State::ReliedOn).then(|| row.why.clone());
    LogCard {
        name: row.log.clone(),
        link: (row.state != State::Broken).then(|| format!("{}/report.html", row.folder)),
        level,
        word: row.state.word(),
        lines: mass.into_iter().chain(why).collect(),
        panel: picture(row),
    }
}

/// Where the centre of mass went.
fn picture(row: &Row) -> Option<FigurePanel> {
    let (first, _) = row.path.first()?;
    let in_plane = row.summary["schema"] == SummaryOf::PlaneReconstruction.schema();
    let curve = |axis: usize| FigureCurve {
        name: ["x", "y", "z"][axis - 1].to_owned(),
        points: row.path.iter().map(|(at, _)| [at[0], at[axis] - first[axis]]).collect(),
        half_heights: row.path.iter().map(|(_, std)| 2.0 * std[axis - 1].unwrap_or(f64::NAN)).collect(),
        ..FigureCurve::default()
    };
    Some(FigurePanel {
        axes: ["t in s".to_owned(), "way in m".to_owned()],
        curves: (1..if in_plane { 3 } else { 4 }).map(curve).collect(),
        ..FigurePanel::default()
    })
}
