//! The page of pushes: outline with what is left open of it, modes of each push over time, friction, residuals.

mod bands;
mod evidence;
mod outline;
mod panels;

use super::Verdict;
use super::figures_page::FiguresPage;
use super::notices::notices;
use super::page::{Fact, Page, curves_section, evidence_section, section, tiles};
use crate::number::brief_to;
use recon::observer::pushes::{PushFriction, PushesEstimate};
use std::io::{self, Write};

const BANDS: &str = "A row for each push, over the time since it began, in s. The paler, the less sure. Left and right as the finger looks at the object. \
    Before, the finger is under way to the object or loads it.";
const LEGEND: &str = "<div class=\"modes\">\n<span><svg><rect class=\"m2\"/></svg>sticks</span>\n\
    <span><svg><rect class=\"m1\"/></svg>slides to the left</span>\n<span><svg><rect class=\"mr\"/></svg>slides to the right</span>\n</div>\n";
const CURVES: &str = "Angles are those of the force against the inward normal, in windows of a tenth of a second; shaded is the edge of the friction cone, \
    the coefficient and twice the deviation from push to push. Each dot of the next two is the own coefficient of a push that slides; the line with its band is that of all \
    with twice its deviation. Last, what is left between finger and outline at the first and the last touch of each push.";

/// What the page shows of a log.
#[derive(Clone, Debug)]
pub struct PushedLog<'a> {
    /// Its number; none where it is the only one.
    pub number: Option<u32>,
    /// What was told of it.
    pub told: &'a PushesEstimate,
    /// Friction by the first and the second half of the pushes, where each of them tells it.
    pub halves: Option<[PushFriction; 2]>,
    /// Radius of the finger, m.
    pub finger_radius: f64,
    /// How far the result can be relied on.
    pub verdict: Verdict,
    /// What the reader must know.
    pub warnings: Vec<String>,
}

/// Writes what pushes tell as one HTML page that needs nothing else.
///
/// # Errors
/// Those of `to`.
pub fn write_pushes_report(title: &str, logs: &[PushedLog], to: impl Write) -> io::Result<()> {
    let body = logs.iter().map(of_log).collect();
    let (kicker, verdict) = ("What a finger that pushes an object on a table feels of it", String::new());
    Page { kicker, title, verdict, facts: &[], body }.write(to)
}

fn of_log(log: &PushedLog) -> String {
    let name = log.number.map_or_else(|| "Pushes".to_owned(), |number| format!("Log {number}"));
    let heading = log.number.map_or_else(String::new, |_| format!("<h2>{name}</h2>\n"));
    let verdict = notices(&log.verdict, ["Told", "With reservations", "Not to be relied on"], &log.warnings);
    let (outline, caption) = outline::drawn(log.told);
    let outline = section("Outline", &format!("<div class=\"panel\">\n{outline}</div>\n"), &caption);
    let bands = format!("<div class=\"panel\">\n{}{LEGEND}</div>\n", bands::bands(log.told));
    let bands = section("Sticking and sliding", &bands, BANDS);
    let curves = curves_section("Friction, and what the fit leaves", &panels::panels(log.told), CURVES);
    let (facts, evidence) =
        (tiles(&facts(log)), evidence_section(FiguresPage::RESTS_ON, &evidence::rows(log)));
    format!(
        "<section class=\"pushed\" aria-label=\"{name}\">\n{heading}{verdict}{facts}\
         <div class=\"pair\">\n{outline}{bands}</div>\n{curves}{evidence}</section>\n"
    )
}

/// The tiles.
fn facts(log: &PushedLog) -> Vec<Fact> {
    let told = log.told;
    let instants = || told.pushes.iter().flat_map(|p| &p.instants);
    let sticks = instants().map(|i| i.stick).sum::<f64>() / instants().count().max(1) as f64;
    let mut facts = Vec::new();
    match told.friction {
        Some(f) => {
            facts.push(("Friction coefficient", format!("{:.3} ± {:.3}", f.value, f.deviation), ""));
            facts.push(("It is told at a slip of", brief_to(2, 1e3 * f.at_slip), "mm/s"));
            facts.push(("It changes with slip by", format!("{:+.3}", 1e-3 * f.by_slip.0), "per mm/s"));
            facts.push(("Half angle of the cone", brief_to(3, f.value.atan().to_degrees()), "degrees"));
        }
        None => facts.push(("Friction coefficient", format!("above {:.2}", told.ratio_seen), "")),
    }
    facts.push(("Outline", told.outline.name.clone(), ""));
    let mut deviations: Vec<f64> = told.outline.points.iter().map(|p| p.deviation).collect();
    deviations.sort_by(f64::total_cmp);
    let at = |share: usize| deviations.get(deviations.len() * share / 100).copied().unwrap_or(f64::NAN);
    facts.push(("Its deviation, median", format!("{:.2}", 1e3 * at(50)), "mm"));
    facts.push(("Its deviation, largest", format!("{:.2}", 1e3 * at(100).max(at(99))), "mm"));
    facts.push(("Area", brief_to(4, told.outline.line.area() * 1e4), "cm²"));
    facts.push(("Pushes that touched", told.pushes.len().to_string(), ""));
    facts.push(("Sticking", format!("{:.0}", 100.0 * sticks), "% of the time"));
    facts
}
