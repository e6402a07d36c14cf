//! What each contact does over time.

use recon::object_dynamics::{ContactEvent, ContactMode, ContactSimulation};

/// A stretch of time over which a contact does the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeSpan {
    /// Its beginning, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
    /// What the contact does.
    pub mode: ContactMode,
}

/// What the contact with palm `palm` (from 0) does from the first sample to the last: one span after the other, neighbours in
/// different modes.
#[must_use]
pub fn mode_spans(simulation: &ContactSimulation, palm: usize) -> Vec<ModeSpan> {
    let instants = &simulation.instants;
    let (Some(first), Some(last)) = (instants.first(), instants.last()) else { return Vec::new() };
    spans(first.modes[palm], [first.state.t, last.state.t], &simulation.events, palm)
}

fn spans(mode: ContactMode, [start, end]: [f64; 2], events: &[ContactEvent], palm: usize) -> Vec<ModeSpan> {
    let mut spans: Vec<ModeSpan> = Vec::new();
    let mut open = ModeSpan { start, end, mode };
    for event in events.iter().filter(|event| event.t <= end) {
        let mode = event.modes[palm];
        if mode != open.mode {
            spans.push(ModeSpan { end: event.t, ..open });
            open = ModeSpan { start: event.t, end, mode };
        }
    }
    spans.push(open);
    // Modes that were passed through in no time, or before the first sample, were not lasting.
    spans.retain(|span| span.end > span.start);
    let mut joined: Vec<ModeSpan> = Vec::new();
    for span in spans {
        match joined.last_mut() {
            Some(last) if last.mode == span.mode => last.end = span.end,
            _ => joined.push(span),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactMode::{Off, Slide, Stick};
    use recon::object_dynamics::ContactEventKind;

    #[test]
    fn spans_cover_the_time_once_and_what_takes_no_time_is_none() {
        let event =
            |t, mode| ContactEvent { t, palm: 0, kind: ContactEventKind::SlipEnds, modes: vec![mode] };
        let events =
            [event(0.0, Slide), event(0.3, Slide), event(0.5, Off), event(0.5, Slide), event(0.7, Stick)];
        let found = spans(Stick, [0.0, 1.0], &events, 0);
        let expected = [(0.0, 0.7, Slide), (0.7, 1.0, Stick)];
        assert_eq!(found, expected.map(|(start, end, mode)| ModeSpan { start, end, mode }));
        assert_eq!(spans(Off, [0.0, 0.2], &events[1..], 0), [ModeSpan { start: 0.0, end: 0.2, mode: Off }]);
    }
}
