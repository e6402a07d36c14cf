//! When the motion was known, and when not.

use std::fmt;

/// Spans that are told one by one; beyond so many, how many there are.
const TOLD: usize = 4;

/// Times from and to which something held, s.
#[derive(Debug, Default)]
pub(super) struct Spans {
    spans: Vec<[f64; 2]>,
    holds: bool,
}

impl Spans {
    /// Whether it holds at the time `t`, s.
    pub(super) fn take(&mut self, t: f64, holds: bool) {
        match self.spans.last_mut() {
            Some(span) if holds && self.holds => span[1] = t,
            _ if holds => self.spans.push([t, t]),
            _ => {}
        }
        self.holds = holds;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }

    pub(super) fn all(&self) -> &[[f64; 2]] {
        &self.spans
    }

    /// When it held first, s.
    pub(super) fn first(&self) -> Option<f64> {
        self.spans.first().map(|span| span[0])
    }
}

impl fmt::Display for Spans {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let told: Vec<String> =
            self.spans.iter().take(TOLD).map(|[from, to]| format!("from {from:.3} to {to:.3} s")).collect();
        write!(f, "{}", told.join(", "))?;
        match self.spans.len() - told.len() {
            0 => Ok(()),
            more => write!(f, ", and {more} times more"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_begin_and_end_where_they_should() {
        let mut spans = Spans::default();
        for (t, holds) in [(0.0, false), (1.0, true), (2.0, true), (3.0, false), (4.0, true)] {
            spans.take(t, holds);
        }
        assert_eq!(spans.all(), [[1.0, 2.0], [4.0, 4.0]]);
        assert_eq!(spans.to_string(), "from 1.000 to 2.000 s, from 4.000 to 4.000 s");
        (5..15).for_each(|k| spans.take(f64::from(k), k % 2 == 0));
        assert!(spans.to_string().ends_with("and 3 times more"), "{spans}");
    }
}
