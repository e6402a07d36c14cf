//! What each contact does over time, as bands.

use super::super::page::section;
use super::spans::ModeSpan;
use crate::number::on_scale;
use crate::planar_figures::round_step;
use recon::object_dynamics::ContactMode;
use std::fmt::Write as _;

/// What the colours of modes mean, as entries of a legend.
const LEGEND: &str = "<span><svg><rect class=\"m0\"/></svg>off</span>
<span><svg><rect class=\"m1\"/></svg>slides</span>
<span><svg><rect class=\"m2\"/></svg>sticks (rolls)</span>
<span><svg><rect class=\"flight\"/></svg>touches nothing</span>
";
const MISSING: &str = "<span><svg><rect class=\"missing\"/></svg>no samples</span>\n";
const DOUBTFUL: &str = "<span><svg><rect class=\"doubtful\"/></svg>not relied on</span>\n";

/// Height of a palm's row and of the band in it, px. Along the time the picture is as wide as the page lets it, with text of one size.
const ROW: f64 = 26.0;
const BAND: f64 = 18.0;

/// The section of contact modes: bands, and what their colours mean.
pub(super) fn modes_section(
    all: &[Vec<ModeSpan>],
    marks: &[f64],
    doubtful: Option<&[[f64; 2]]>,
    gaps: &[[f64; 2]],
    caption: &str,
) -> String {
    let drawn = bands(all, marks, doubtful.unwrap_or_default(), gaps);
    let missing = if gaps.is_empty() { "" } else { MISSING };
    let doubt = if doubtful.is_some() { DOUBTFUL } else { "" };
    let shown = format!(
        "<div class=\"panel\">\n{drawn}<div class=\"modes\">\n{LEGEND}{missing}{doubt}</div>\n</div>\n"
    );
    section("Contact modes", &shown, caption)
}

/// Bands of the spans of each palm over the time, as opaque as they are probable, as one SVG element; marks at the times of the pictures, and a shade over stretches
/// of time that are not relied on.
fn bands(all: &[Vec<ModeSpan>], marks: &[f64], doubtful: &[[f64; 2]], gaps: &[[f64; 2]]) -> String {
    let (start, end) = (all.first().and_then(|s| s.first()), all.first().and_then(|s| s.last()));
    let (start, end) = start.zip(end).map_or((0.0, 1.0), |(first, last)| (first.start, last.end));
    let place = |t: f64| on_scale(100.0 * (t - start) / (end - start), 100.0, 5);
    let bottom = ROW * all.len() as f64 + 4.0;
    let mut out = format!("<svg class=\"bands\" height=\"{}\" role=\"img\">\n", bottom + 20.0);
    let bar = |look: &str, [from, to]: [f64; 2], y: f64, height: f64| {
        let (x, width) = (place(from), place(to) - place(from));
        format!("<rect {look} x=\"{x}%\" y=\"{y}\" width=\"{width:.3}%\" height=\"{height}\"/>\n")
    };
    for flight in flights(all) {
        out += &bar("class=\"flight\"", flight, 0.0, bottom);
    }
    for (i, spans) in all.iter().enumerate() {
        let y = ROW * i as f64 + 4.0;
        let _ = writeln!(
            out,
            "<text class=\"name p{0}\" x=\"-8\" y=\"{1}\" text-anchor=\"end\">palm {0}</text>",
            i + 1,
            y + 13.0
        );
        for span in spans.iter().filter(|span| span.mode != ContactMode::Off) {
            let mode = span.mode.number();
            // What is known for sure needs no word: it is opaque.
            let look = match span.sure {
                10.. => format!("class=\"m{mode}\""),
                tenths => format!("class=\"m{mode}\" fill-opacity=\".{tenths}\""),
            };
            out += &bar(&look, [span.start, span.end], y, BAND);
        }
        out += &bar("class=\"frame\"", [start, end], y, BAND);
    }
    for gap in gaps {
        out += &bar("class=\"missing\"", *gap, 0.0, bottom);
    }
    for [from, to] in doubtful {
        // Modes may be told later than the motion is looked for.
        let within = [from.max(start), to.min(end)];
        if within[0] < within[1] {
            out += &bar("class=\"doubtful\"", within, 0.0, bottom);
        }
    }
    for t in marks {
        let x = place(*t);
        let _ = writeln!(out, "<line class=\"mark\" x1=\"{x}%\" x2=\"{x}%\" y2=\"{bottom}\"/>");
    }
    for (k, t) in ticks(start, end).into_iter().enumerate() {
        // Every other one has no room on a narrow screen.
        let class = if k % 2 == 1 { " class=\"between\"" } else { "" };
        let (x, y) = (place(t), bottom + 15.0);
        let _ = writeln!(out, "<text{class} x=\"{x}%\" y=\"{y}\" text-anchor=\"middle\">{t}</text>");
    }
    out + "</svg>\n"
}

/// Round times from `start` to `end`, at most nine. Both ends may be off by rounding: 0.3 is less than three times 0.1, and samples
/// are multiples of what is no binary fraction.
fn ticks(start: f64, end: f64) -> Vec<f64> {
    let slack = 1e-9 * (end - start);
    let step = round_step((end - start) / 8.0 - slack);
    let first = ((start - slack) / step).ceil();
    let all = (0..=8).map(|k| on_scale((first + f64::from(k)) * step, step, 1));
    all.filter(|t| *t <= end + slack).collect()
}

/// When nothing is touched: the gaps that all palms share.
fn flights(all: &[Vec<ModeSpan>]) -> Vec<[f64; 2]> {
    let off = |spans: &[ModeSpan]| -> Vec<[f64; 2]> {
        spans.iter().filter(|s| s.mode == ContactMode::Off).map(|s| [s.start, s.end]).collect()
    };
    let Some((first, others)) = all.split_first() else { return Vec::new() };
    others.iter().fold(off(first), |shared, spans| {
        let pairs =
            shared.iter().flat_map(|a| off(spans).into_iter().map(|b| [a[0].max(b[0]), a[1].min(b[1])]));
        pairs.filter(|[from, to]| from < to).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_times_reach_both_ends() {
        // As 0.3 = 3 / 10 and 0.1 + 0.2 are not the same number.
        for end in [0.3, 0.1 + 0.2, 0.3 - 1e-16] {
            assert_eq!(ticks(0.0, end), [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]);
        }
        assert_eq!(ticks(0.1 + 0.2, 0.7), [0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7]);
        assert_eq!(ticks(0.0, 3.4), [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
        assert_eq!(ticks(0.0, 0.8), ticks(0.0, 799.0 / 1000.0 + 1e-3));
    }

    #[test]
    fn flights_are_what_no_palm_touches() {
        let span = |start, end, mode| ModeSpan { start, end, mode, sure: 10 };
        let (off, stick) = (ContactMode::Off, ContactMode::Stick);
        let one = vec![span(0.0, 1.0, off), span(1.0, 2.0, stick), span(2.0, 4.0, off)];
        let two = vec![span(0.0, 0.5, stick), span(0.5, 3.0, off), span(3.0, 4.0, stick)];
        assert_eq!(flights(&[one.clone(), two]), [[0.5, 1.0], [2.0, 3.0]]);
        assert!(flights(&[one, vec![span(0.0, 4.0, stick)]]).is_empty());
    }

    #[test]
    fn gaps_are_marked_and_named() {
        let spans = vec![vec![ModeSpan { start: 0.0, end: 2.0, mode: ContactMode::Stick, sure: 10 }]];
        let drawn = |gaps: &[[f64; 2]]| modes_section(&spans, &[], None, gaps, "");
        assert!(!drawn(&[]).contains("missing") && !drawn(&[]).contains("no samples"));
        let with = drawn(&[[0.5, 1.0]]);
        assert!(with.contains("class=\"missing\" x=\"25%\" y=\"0\" width=\"25.000%\""), "{with}");
        assert!(with.contains("</svg>no samples</span>"));
    }
}
