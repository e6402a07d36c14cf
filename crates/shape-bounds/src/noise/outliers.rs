//! Contacts that contradict the others by more than their noise explains.

use super::model::{NoiseError, NoisyContact};
use super::quantile;
use super::roughness::standing_out;
use super::traced::Traced;
use exact_hull::{Farthest, Hull};

/// Contacts against which the suspects are tried to tell which of a contradictory pair is wrong.
const WITNESSES: usize = 1000;
/// Share of what is found that may be good contacts, and rounds in which the limit follows it.
const FALSE_OF_FOUND: f64 = 0.25;
const ROUNDS: usize = 3;
/// Odds that a contact is called impossible where all are right.
const IMPOSSIBLE: f64 = 1e-3;
/// What exact contacts may contradict each other by, relative to their coordinates: rounding.
const ROUNDING: f64 = 1e-14;

/// A contact that was left out because it contradicts others or stands out of its own curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Its curve.
    pub curve: usize,
    /// Its place in that curve.
    pub index: usize,
    /// By how many standard deviations it contradicts another contact, at most, or stands out.
    pub deviations: f64,
    /// Share of the other contacts that it contradicts; zero for one that only stands out.
    pub share: f64,
}

/// `curves`, each in the order in which it was traced, without the contacts that cannot be right, and these.
///
/// First those that stand out of their own curve by more than noise and bending of the curve explain. Then those that
/// contradict others: two contacts of a convex body do when one lies beyond the other's half-space. Beyond what noise
/// does, at odds of a thousand for all pairs together, one of the two is wrong: the one that contradicts more
/// contacts; both, where the rest does not tell. Leaving a good contact out only widens the bounds, so that they stay
/// sound either way. Where some are found, the limit is lowered until one in four of what is found may be a good one: on the ground of
/// what contradicts, not of what stands out, as edges do. Errors of less than
/// about five to ten standard deviations may stay unnoticed, and larger ones at edges (docs/bounds.md).
///
/// # Errors
/// [`NoiseError`] for an impossible confidence or noise, a point that is not finite, and when half of the contacts or more
/// would have to go, so that which are the outliers is not decided.
pub fn without_outliers(
    curves: &[Vec<NoisyContact>],
    confidence: f64,
) -> Result<(Vec<Vec<NoisyContact>>, Vec<Outlier>), NoiseError> {
    NoiseError::check_confidence(confidence)?;
    NoiseError::check_contacts(curves)?;
    judged(curves, confidence, 3)
        .map_err(|Undecided { outliers, contacts }| NoiseError::Undecided { outliers, contacts })
}

/// Half of the contacts or more would have to go.
pub(crate) struct Undecided {
    pub(crate) outliers: usize,
    pub(crate) contacts: usize,
}

/// [`without_outliers`] of values that have been checked, in a space of two or three dimensions.
pub(crate) fn judged(
    curves: &[Vec<NoisyContact>],
    confidence: f64,
    dimension: usize,
) -> Result<(Vec<Vec<NoisyContact>>, Vec<Outlier>), Undecided> {
    let mut suspects = Suspects::new(curves, confidence, dimension);
    suspects.drop_contradicting()?;
    suspects.lower_limit();
    suspects.drop_contradicting()?;
    let mut alive = suspects.alive.iter();
    let kept = curves
        .iter()
        .map(|curve| {
            let of_curve = curve.iter().zip(alive.by_ref().take(curve.len()));
            of_curve.filter(|(_, alive)| **alive).map(|(contact, _)| *contact).collect()
        })
        .collect();
    let mut outliers = suspects.found;
    outliers.sort_unstable_by_key(|o| (o.curve, o.index));
    Ok((kept, outliers))
}

/// All contacts, which of them are left, and what has been found.
struct Suspects<'a> {
    all: Vec<&'a NoisyContact>,
    /// Curve and place of each.
    places: Vec<(usize, usize)>,
    /// Number of the first contact of each curve.
    firsts: Vec<usize>,
    alive: Vec<bool>,
    found: Vec<Outlier>,
    /// Standard deviations beyond which a pair contradicts.
    limit: f64,
}

/// Two contacts of which the one is beyond the half-space of the other.
struct Contradiction {
    pair: [usize; 2],
    deviations: f64,
}

/// Deviations beyond which a pair of so many contacts contradicts, for so many false alarms that are allowed among all pairs.
fn limit(contacts: usize, allowed: f64) -> f64 {
    let pairs = (contacts as f64).powi(2).max(1.0);
    quantile::normal((allowed / pairs).min(0.1))
}

fn firsts(curves: &[Vec<NoisyContact>]) -> Vec<usize> {
    let first = |next: &mut usize, curve: &Vec<NoisyContact>| {
        let first = *next;
        *next += curve.len();
        Some(first)
    };
    curves.iter().scan(0, first).collect()
}

/// Contacts that stand out of their curves, where these are traced: neighbours in no order say nothing of each other.
fn standing_out_of_curves(curves: &[Vec<NoisyContact>], mut allowed: f64, dimension: usize) -> Vec<Outlier> {
    let mut found = Vec::new();
    for _ in 0..ROUNDS {
        let alpha = allowed / curves.len() as f64;
        let traced =
            curves.iter().enumerate().filter(|(_, contacts)| Traced { contacts, dimension }.is_followed());
        let of_curve = |(curve, contacts): (usize, &Vec<NoisyContact>)| {
            let all = standing_out(contacts, alpha, dimension).into_iter();
            all.map(move |(index, deviations)| Outlier { curve, index, deviations, share: 0.0 })
                .collect::<Vec<_>>()
        };
        found = traced.flat_map(of_curve).collect();
        // False alarms that are allowed among all contacts: one in so many of what is found.
        let enough = FALSE_OF_FOUND * found.len() as f64;
        if enough <= allowed {
            break;
        }
        allowed = enough;
    }
    found
}

impl<'a> Suspects<'a> {
    fn new(curves: &'a [Vec<NoisyContact>], confidence: f64, dimension: usize) -> Self {
        let all: Vec<_> = curves.iter().flatten().collect();
        let places =
            curves.iter().enumerate().flat_map(|(c, curve)| (0..curve.len()).map(move |k| (c, k))).collect();
        let found = standing_out_of_curves(curves, 1.0 - confidence, dimension);
        let mut alive = vec![true; all.len()];
        let firsts: Vec<usize> = firsts(curves);
        found.iter().for_each(|o| alive[firsts[o.curve] + o.index] = false);
        Self { limit: limit(all.len(), IMPOSSIBLE.min(1.0 - confidence)), places, firsts, alive, all, found }
    }

    /// Says which of those that stand out contradict others beyond the present limit, and lowers it where wrong contacts are found: there
    /// are others, and a good one more or less does no harm, one in so many of what is found. What only stands out may be an edge, and is
    /// no sign of wrong ones.
    fn lower_limit(&mut self) {
        let witnesses = self.witnesses();
        for k in 0..self.found.len() {
            let Outlier { curve, index, share, .. } = self.found[k];
            let contact = self.firsts[curve] + index;
            if share == 0.0 {
                let with = witnesses.iter().filter(|w| self.contradict(contact, **w)).count();
                self.found[k].share = with as f64 / witnesses.len().max(1) as f64;
            }
        }
        let wrong = self.found.iter().filter(|o| o.share > 0.0).count() as f64;
        self.limit = self.limit.min(limit(self.all.len(), FALSE_OF_FOUND * wrong));
    }

    /// Whether two contacts are further from each other's half-spaces than the limit.
    fn contradict(&self, a: usize, b: usize) -> bool {
        self.deviations(a, b).max(self.deviations(b, a)) > self.limit
    }

    /// Drops contacts until none contradicts another.
    fn drop_contradicting(&mut self) -> Result<(), Undecided> {
        while self.drop_worst() {
            let (outliers, contacts) = (self.found.len(), self.all.len());
            if 2 * outliers >= contacts {
                return Err(Undecided { outliers, contacts });
            }
        }
        Ok(())
    }

    /// Drops contacts until the contradictions that are found now are gone; `false` when there are none.
    fn drop_worst(&mut self) -> bool {
        let contradictions = self.contradictions();
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); self.all.len()];
        for (k, c) in contradictions.iter().enumerate() {
            c.pair.iter().for_each(|contact| of[*contact].push(k));
        }
        let witnesses = self.witnesses();
        let count = |c: usize| {
            let with = witnesses.iter().filter(|w| self.contradict(c, **w));
            with.count().max(of[c].len())
        };
        let counts: Vec<usize> = (0..of.len()).map(|c| if of[c].is_empty() { 0 } else { count(c) }).collect();
        let mut ranked: Vec<usize> = (0..of.len()).filter(|c| counts[*c] > 0).collect();
        ranked.sort_unstable_by_key(|c| (std::cmp::Reverse(counts[*c]), *c));
        let mut open = vec![true; contradictions.len()];
        for contact in ranked {
            let left: Vec<usize> = of[contact].iter().copied().filter(|k| open[*k]).collect();
            let Some(deviations) = left.iter().map(|k| contradictions[*k].deviations).reduce(f64::max) else {
                // All that it contradicted is gone.
                continue;
            };
            for k in left {
                let [a, b] = contradictions[k].pair;
                // Of two that are contradicted by equally many, both go.
                open[k] = counts[a] == counts[b] && self.alive[a] && self.alive[b];
            }
            self.alive[contact] = false;
            let (curve, index) = self.places[contact];
            let share = counts[contact] as f64 / witnesses.len().max(counts[contact]) as f64;
            self.found.push(Outlier { curve, index, deviations, share });
        }
        !contradictions.is_empty()
    }

    /// For each half-space that is left, the farthest point beyond it, if that is too far.
    fn contradictions(&self) -> Vec<Contradiction> {
        let left: Vec<usize> = (0..self.all.len()).filter(|c| self.alive[*c]).collect();
        let points: Vec<_> = left.iter().map(|c| self.all[*c].contact.point).collect();
        let Ok(hull) = Hull::of(&points) else { return Vec::new() };
        let mut farthest = Farthest::new(&hull, &points);
        let mut found = Vec::new();
        for (own, half_space) in left.iter().enumerate() {
            let n = self.all[*half_space].contact.normal.get();
            let point = left[farthest.along(n, own)];
            let deviations = self.deviations(*half_space, point);
            if deviations > self.limit {
                found.push(Contradiction { pair: [*half_space, point], deviations });
            }
        }
        found
    }

    /// How far contact `j` lies beyond the half-space of contact `i`, in standard deviations.
    fn deviations(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (self.all[i], self.all[j]);
        let n = a.contact.normal.get();
        let reach = b.contact.point - a.contact.point;
        let excess = n.dot(reach);
        if excess <= 0.0 {
            return 0.0;
        }
        let independent =
            n.dot((a.noise.point + b.noise.point) * n) + (a.noise.normal * n.cross(reach).length()).powi(2);
        // Errors of the poses may be correlated in any way: at worst they add.
        let of_plane = a.noise.pose.along(n).deviation(b.contact.point, 0.0);
        let pose = of_plane + n.dot(b.noise.pose.at(b.contact.point) * n).max(0.0).sqrt();
        let rounding = ROUNDING * (a.contact.point.abs().max_element() + b.contact.point.abs().max_element());
        excess / (independent.max(0.0).sqrt() + pose + rounding)
    }

    fn witnesses(&self) -> Vec<usize> {
        let left: Vec<usize> = (0..self.all.len()).filter(|c| self.alive[*c]).collect();
        let stride = left.len().div_ceil(WITNESSES).max(1);
        left.into_iter().step_by(stride).collect()
    }
}
