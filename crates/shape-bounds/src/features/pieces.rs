//! Curves cut where the body is not smooth, for tests that take neighbours to lie on a smooth curve.

use super::found::{FeatureKind, Features};
use crate::noise::{NoiseDoubt, NoisyContact, Outlier};

/// Pieces of curves, each smooth, at one corner, on one edge or face.
#[derive(Clone, Debug)]
pub struct Pieces {
    /// The pieces, in their order.
    pub curves: Vec<Vec<NoisyContact>>,
    /// Of each: its curve, and its first contact there.
    from: Vec<(usize, usize)>,
    /// How many curves there were.
    count: usize,
}

impl Pieces {
    /// `curves` cut at the ends of what is not smooth; uncut where nothing but smooth surface was told. `features` are of the same curves.
    #[must_use]
    pub fn of(curves: &[Vec<NoisyContact>], features: &Features) -> Self {
        let mut made = Self { curves: Vec::new(), from: Vec::new(), count: curves.len() };
        let whole = features.is_smooth();
        for (curve, contacts) in curves.iter().enumerate() {
            let runs = features.runs.iter().filter(|run| run.curve == curve && !whole);
            let mut starts = vec![0];
            let mut smooth_before = true;
            for run in runs {
                let smooth = run.kind == Some(FeatureKind::Smooth);
                if run.first > 0 && !(smooth && smooth_before) {
                    starts.push(run.first);
                }
                smooth_before = smooth;
            }
            starts.push(contacts.len());
            for ends in starts.windows(2) {
                made.curves.push(contacts.get(ends[0]..ends[1]).unwrap_or_default().to_vec());
                made.from.push((curve, ends[0]));
            }
        }
        made
    }

    /// The curves again, of what was kept of each piece.
    #[must_use]
    pub fn joined(&self, kept: Vec<Vec<NoisyContact>>) -> Vec<Vec<NoisyContact>> {
        let mut curves = vec![Vec::new(); self.count];
        for (piece, (curve, _)) in kept.into_iter().zip(&self.from) {
            curves[*curve].extend(piece);
        }
        curves
    }

    /// An outlier of a piece as one of its curve.
    #[must_use]
    pub fn outlier(&self, of: Outlier) -> Outlier {
        let (curve, first) = self.from.get(of.curve).copied().unwrap_or_default();
        Outlier { curve, index: first + of.index, ..of }
    }

    /// A doubt about the noise of a piece as one about its curve.
    #[must_use]
    pub fn doubt(&self, of: NoiseDoubt) -> NoiseDoubt {
        let at = |piece: usize| self.from.get(piece).copied().unwrap_or_default();
        match of {
            NoiseDoubt::Level { curve: piece, what, stated, found, p_value } => {
                let (curve, first) = at(piece);
                let pieces = self.from.iter().filter(|of| of.0 == curve).count();
                if pieces == 1 {
                    return NoiseDoubt::Level { curve, what, stated, found, p_value };
                }
                let last = first + self.curves[piece].len().saturating_sub(1);
                NoiseDoubt::Changing { curve, first, last, what, stated, found, p_value }
            }
            NoiseDoubt::Changing { curve: piece, first, last, what, stated, found, p_value } => {
                let (curve, start) = at(piece);
                let (first, last) = (start + first, start + last);
                NoiseDoubt::Changing { curve, first, last, what, stated, found, p_value }
            }
            NoiseDoubt::Correlated { .. } => of,
        }
    }
}
