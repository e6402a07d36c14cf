//! What each contact does over time.

use recon::object_dynamics::{ContactMode, ContactSimulation, MOST_PALMS, planar};
use recon::observer::contact_modes::ContactOdds;
use recon::observer::contacts::EstimatedModes;
use recon::observer::contacts::stream::{StreamEstimate, StreamModes};

/// A stretch of time over which a contact does the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeSpan {
    /// Its beginning, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
    /// What the contact does.
    pub mode: ContactMode,
    /// How probable that is, in tenths: 10 where it is known.
    pub sure: u8,
}

/// What the contact with palm `palm` (from 0) does from the first sample to the last: one span after the other, neighbours in
/// different modes.
#[must_use]
pub fn mode_spans(simulation: &ContactSimulation, palm: usize) -> Vec<ModeSpan> {
    let instants = &simulation.instants;
    let (Some(first), Some(last)) = (instants.first(), instants.last()) else { return Vec::new() };
    let changes = simulation.events.iter().map(|event| (event.t, event.modes[palm]));
    spans(first.modes[palm], [first.state.t, last.state.t], changes)
}

/// The same in the plane.
#[must_use]
pub fn planar_mode_spans(simulation: &planar::ContactSimulation, palm: usize) -> Vec<ModeSpan> {
    let instants = &simulation.instants;
    let (Some(first), Some(last)) = (instants.first(), instants.last()) else { return Vec::new() };
    let changes = simulation.events.iter().map(|event| (event.t, event.modes[palm]));
    spans(first.modes[palm], [first.t, last.t], changes)
}

/// The same of the modes of an estimate at the `times` of its log, and how sure they are.
#[must_use]
pub fn estimated_mode_spans(
    times: &[f64],
    modes: &[[ContactMode; MOST_PALMS]],
    odds: Option<&EstimatedModes>,
    palm: usize,
) -> Vec<ModeSpan> {
    let (Some(&start), Some(&end)) = (times.first(), times.last()) else { return Vec::new() };
    let sure = |k: usize| odds.map_or(10, |found| tenths(&found.odds[k][palm]));
    let mut all = modes.iter().enumerate().map(|(k, modes)| (modes[palm], sure(k))).peekable();
    let Some(first) = all.peek().copied() else { return Vec::new() };
    sure_spans(first, [start, end], times.iter().copied().zip(all))
}

/// The same of the modes that a stream acted on, from when they were told; none where they never are.
pub(super) fn followed_mode_spans(followed: &[StreamEstimate], palm: usize) -> Vec<ModeSpan> {
    let told = || followed.iter().filter_map(|of| Some((of.t, of.modes.as_ref()?)));
    let one = |(t, modes): (f64, &StreamModes)| (t, (modes.decided[palm], tenths(&modes.odds[palm])));
    let (Some((start, first)), Some((end, _))) = (told().next().map(one), told().next_back()) else {
        return Vec::new();
    };
    sure_spans(first, [start, end], told().map(one))
}

/// The probability of the most probable mode, in tenths; what is not nearly certain is less than ten.
fn tenths(odds: &ContactOdds) -> u8 {
    (10.0 * odds.off.max(odds.slide).max(odds.stick) + 0.1).floor().clamp(0.0, 10.0) as u8
}

/// Time over which spans are off, slide and stick, s.
#[must_use]
pub fn mode_times(spans: &[ModeSpan]) -> [f64; 3] {
    ContactMode::ALL.map(|mode| {
        let lasting = spans.iter().filter(|span| span.mode == mode);
        lasting.fold(0.0, |sum, span| sum + (span.end - span.start))
    })
}

/// From the mode at the start and the times at which modes follow.
fn spans(
    mode: ContactMode,
    ends: [f64; 2],
    changes: impl Iterator<Item = (f64, ContactMode)>,
) -> Vec<ModeSpan> {
    sure_spans((mode, 10), ends, changes.map(|(t, mode)| (t, (mode, 10))))
}

/// The same of modes and how sure they are, in tenths.
fn sure_spans(
    (mode, sure): (ContactMode, u8),
    [start, end]: [f64; 2],
    changes: impl Iterator<Item = (f64, (ContactMode, u8))>,
) -> Vec<ModeSpan> {
    let mut spans: Vec<ModeSpan> = Vec::new();
    let mut open = ModeSpan { start, end, mode, sure };
    for (t, (mode, sure)) in changes.filter(|change| change.0 <= end) {
        if (mode, sure) != (open.mode, open.sure) {
            spans.push(ModeSpan { end: t, ..open });
            open = ModeSpan { start: t, end, mode, sure };
        }
    }
    spans.push(open);
    // Modes that were passed through in no time, or before the first sample, were not lasting.
    spans.retain(|span| span.end > span.start);
    let mut joined: Vec<ModeSpan> = Vec::new();
    for span in spans {
        match joined.last_mut() {
            Some(last) if (last.mode, last.sure) == (span.mode, span.sure) => last.end = span.end,
            _ => joined.push(span),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactMode::{Off, Slide, Stick};

    #[test]
    fn spans_cover_the_time_once_and_what_takes_no_time_is_none() {
        let changes = [(0.0, Slide), (0.3, Slide), (0.5, Off), (0.5, Slide), (0.7, Stick)];
        let found = spans(Stick, [0.0, 1.0], changes.into_iter());
        let expected = [(0.0, 0.7, Slide), (0.7, 1.0, Stick)];
        assert_eq!(found, expected.map(|(start, end, mode)| ModeSpan { start, end, mode, sure: 10 }));
        let short = spans(Off, [0.0, 0.2], changes[1..].iter().copied());
        assert_eq!(short, [ModeSpan { start: 0.0, end: 0.2, mode: Off, sure: 10 }]);
    }
}
