//! Modes of each push over time, a row for each.

use super::outline::class;
use crate::number::on_scale;
use recon::observer::pushes::{PushInstant, PushesEstimate};
use std::fmt::Write as _;

/// Height of all rows together, px, and the most and the least of one.
const ALL: f64 = 440.0;
const ROW: [f64; 2] = [3.0, 18.0];
/// Names of rows, and of times, at most.
const NAMES: usize = 12;
const TIMES: f64 = 20.0;

/// The rows as one SVG element.
pub(super) fn bands(told: &PushesEstimate) -> String {
    let count = told.pushes.len().max(1);
    let row = (ALL / count as f64).clamp(ROW[0], ROW[1]);
    let last = told.pushes.iter().filter_map(|p| p.instants.last()).fold(0.0, |most: f64, i| most.max(i.t));
    let place = |t: f64| on_scale(100.0 * t / last.max(f64::MIN_POSITIVE), 100.0, 5);
    let bottom = row * count as f64 + 6.0;
    let mut out = format!("<svg class=\"bands\" height=\"{}\" role=\"img\">\n", bottom + 22.0);
    let every = count.div_ceil(NAMES);
    for (k, push) in told.pushes.iter().enumerate() {
        let y = on_scale(row * k as f64 + 4.0, 100.0, 3);
        let height = on_scale(0.8 * row, 100.0, 3);
        let _ = writeln!(out, "<rect class=\"row\" y=\"{y}\" width=\"100%\" height=\"{height}\"/>");
        if k % every == 0 {
            let below = y + 0.4 * row + 4.0;
            let _ =
                writeln!(out, "<text x=\"-8\" y=\"{below:.1}\" text-anchor=\"end\">{}</text>", push.number);
        }
        for piece in push.instants.chunk_by(alike) {
            let (Some(first), Some(last)) = (piece.first(), piece.last()) else { continue };
            let (x, to) = (place(first.t), place(last.t));
            let (class, odds) = (class(first.mode()), sureness(first));
            let _ = writeln!(
                out,
                "<rect class=\"{class}\" x=\"{x}%\" y=\"{y}\" width=\"{:.3}%\" height=\"{height}\" opacity=\"{odds:.1}\"/>",
                (to - x).max(0.07)
            );
        }
    }
    for t in (0..=last as u32).step_by((last / TIMES).ceil().max(1.0) as usize) {
        let (x, y) = (place(f64::from(t)), bottom + 14.0);
        let _ = writeln!(out, "<text x=\"{x}%\" y=\"{y:.1}\" text-anchor=\"middle\">{t}</text>");
    }
    out + "</svg>\n"
}

/// How sure the mode is, in steps of a fifth: 1 where it is certain, 0.2 where it is as likely as not.
fn sureness(instant: &PushInstant) -> f64 {
    let odds = instant.stick.max(instant.left).max(instant.right);
    ((10.0 * odds - 5.0).ceil() / 5.0).clamp(0.2, 1.0)
}

fn alike(a: &PushInstant, b: &PushInstant) -> bool {
    a.mode() == b.mode() && sureness(a) == sureness(b)
}
