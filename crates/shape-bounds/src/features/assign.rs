//! Which of the corners, edges and faces that are known each contact is on.
//!
//! Runs are cut before it is known that the same corner is touched again, so that each pays for its own place. Once places are known, a
//! contact departs from each of them in three of its five coordinates (a corner leaves the normal free, a face the place in it, an
//! edge one of both), and the most probable sequence follows sample by sample (Viterbi).

use super::evidence::evidence;
use super::found::{FeatureKind, FeatureOptions, FeatureRun, Features};
use super::moments::{Sums, Units};
use crate::noise::NoisyContact;
use crate::noise::quantile::length3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Odds at which a contact on a place departs from it so far that it is taken to be on none.
const NOWHERE: f64 = 1e-3;

/// A corner, edge or face by its kind and number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct On {
    kind: FeatureKind,
    index: usize,
}

/// Runs again, with the contacts of those that are not smooth on what explains them best.
pub(super) fn assigned(
    curves: &[Vec<NoisyContact>],
    found: &Features,
    units: &Units,
    options: &FeatureOptions,
) -> Vec<FeatureRun> {
    let all = found.all();
    let mut runs = Vec::new();
    let mut k = 0;
    while k < found.runs.len() {
        let now = found.runs[k];
        if now.kind == Some(FeatureKind::Smooth) || all.is_empty() {
            runs.push(now);
            k += 1;
            continue;
        }
        let same = found.runs[k..]
            .iter()
            .take_while(|r| r.curve == now.curve && r.kind != Some(FeatureKind::Smooth));
        let (count, samples) = same.fold((0, 0), |(count, samples), r| (count + 1, samples + r.count));
        let stretch = &curves[now.curve][now.first..now.first + samples];
        let places = found.sequence(stretch, &all, units.size);
        let cut = found.runs_of(stretch, &places, &all, (units, options));
        runs.extend(cut.map(|run| FeatureRun { curve: now.curve, first: run.first + now.first, ..run }));
        k += count;
    }
    for k in 1..runs.len() {
        if let Some(border) = found.border(&curves[runs[k].curve], [runs[k - 1], runs[k]], units.size) {
            let end = runs[k].first + runs[k].count;
            runs[k - 1].count = border - runs[k - 1].first;
            (runs[k].first, runs[k].count) = (border, end - border);
        }
    }
    runs
}

impl Features {
    fn all(&self) -> Vec<On> {
        let list = |kind, count: usize| (0..count).map(move |index| On { kind, index });
        list(FeatureKind::Corner, self.corners.len())
            .chain(list(FeatureKind::Edge, self.edges.len()))
            .chain(list(FeatureKind::Face, self.faces.len()))
            .collect()
    }

    /// Half the squared deviations by which a contact departs from a place.
    fn departs(&self, contact: &NoisyContact, on: On, size: f64) -> f64 {
        let (p, n) = (contact.contact.point, contact.contact.normal.get());
        let [point_variance, normal_variance] = Sums::variances(contact, size);
        let along = |m: glam::DMat3, u: glam::DVec3| u.dot(m * u).max(0.0);
        0.5 * match on.kind {
            FeatureKind::Corner => {
                let of = &self.corners[on.index];
                let way = p - of.point;
                let u = way.normalize_or_zero();
                way.length_squared() / (point_variance + along(of.covariance, u))
            }
            FeatureKind::Edge => {
                let of = &self.edges[on.index];
                let (d, turn) = (of.direction.get(), of.turn * of.turn);
                let way = p - of.point;
                let (s, off) = (d.dot(way), way.reject_from_normalized(d));
                let variance = point_variance + along(of.covariance, off.normalize_or_zero()) + turn * s * s;
                off.length_squared() / variance + n.dot(d).powi(2) / (normal_variance + turn)
            }
            FeatureKind::Face | FeatureKind::Smooth => {
                let of = &self.faces[on.index];
                let (m, turn) = (of.normal.get(), of.turn * of.turn);
                let way = p - of.point;
                let variance = point_variance + along(of.covariance, m) + turn * way.length_squared();
                m.dot(way).powi(2) / variance + (n - m).length_squared() / (normal_variance + turn)
            }
        }
    }

    /// Where the later one of two runs begins, a face and a smooth piece beside each other on a `curve`: they were cut when the face was known by this run alone. At most half of
    /// a run changes sides.
    fn border(&self, curve: &[NoisyContact], runs: [FeatureRun; 2], size: f64) -> Option<usize> {
        let smooth = |run: FeatureRun| run.kind == Some(FeatureKind::Smooth);
        let [before, after] = runs;
        let (face, sign) = match runs {
            [face, other] if smooth(other) => (face, 1.0),
            [other, face] if smooth(other) => (face, -1.0),
            _ => return None,
        };
        if before.curve != after.curve || face.kind != Some(FeatureKind::Face) {
            return None;
        }
        let on = On { kind: FeatureKind::Face, index: face.feature? };
        let gain = |contact: &NoisyContact| {
            let [_, variance] = Sums::variances(contact, size);
            // Beforehand a normal of the smooth piece is anywhere in a quarter turn.
            let anywhere = (FRAC_PI_2 / (TAU * variance).sqrt()).ln().max(0.0);
            sign * (anywhere - self.departs(contact, on, size))
        };
        let (low, high) = (before.first + before.count.div_ceil(2), after.first + after.count / 2);
        let (mut gained, mut best) = (0.0, (0.0, low));
        for k in low..high {
            gained += gain(&curve[k]);
            if gained > best.0 {
                best = (gained, k + 1);
            }
        }
        Some(best.1)
    }

    /// The most probable place of each contact, by number in `all`; that number's end where it is on none.
    fn sequence(&self, stretch: &[NoisyContact], all: &[On], size: f64) -> Vec<usize> {
        let change = ((stretch.len() * (all.len() + 1)) as f64).ln();
        let nowhere = 0.5 * length3(NOWHERE).powi(2);
        let mut cost = vec![0.0; all.len() + 1];
        let mut from: Vec<Vec<usize>> = Vec::with_capacity(stretch.len());
        for contact in stretch {
            let best = (0..cost.len()).fold(0, |best, k| if cost[k] < cost[best] { k } else { best });
            let (reached, before) =
                (0..cost.len())
                    .map(|k| {
                        if cost[best] + change < cost[k] { (cost[best] + change, best) } else { (cost[k], k) }
                    })
                    .unzip::<_, _, Vec<_>, Vec<_>>();
            cost = reached
                .into_iter()
                .enumerate()
                .map(|(k, c)| c + all.get(k).map_or(nowhere, |on| self.departs(contact, *on, size)))
                .collect();
            from.push(before);
        }
        let mut now = (0..cost.len()).fold(0, |best, k| if cost[k] < cost[best] { k } else { best });
        let mut places = Vec::with_capacity(stretch.len());
        for before in from.iter().rev() {
            places.push(now);
            now = before[now];
        }
        places.reverse();
        places
    }

    /// Runs of contacts on one place; their curve is left 0.
    fn runs_of(
        &self,
        stretch: &[NoisyContact],
        places: &[usize],
        all: &[On],
        (units, options): (&Units, &FeatureOptions),
    ) -> impl Iterator<Item = FeatureRun> {
        let sums = Sums::new(stretch, units);
        let mut runs = Vec::new();
        let mut first = 0;
        for group in places.chunk_by(|a, b| a == b) {
            let contacts = &stretch[first..first + group.len()];
            let on = all.get(group[0]).copied();
            let log_odds = on.map_or(0.0, |on| self.log_odds(contacts, on, all, units.size));
            let kind = on.filter(|_| log_odds >= options.odds.ln()).map(|on| on.kind);
            runs.push(FeatureRun {
                curve: 0,
                first,
                count: group.len(),
                kind,
                log_evidence: evidence(&sums.of(first, first + group.len())).0,
                log_odds,
                feature: on.filter(|_| kind.is_some()).map(|on| on.index),
            });
            first += group.len();
        }
        runs.into_iter()
    }

    /// Logarithm of the odds for the kind of a place against the best places of all other kinds.
    fn log_odds(&self, contacts: &[NoisyContact], on: On, all: &[On], size: f64) -> f64 {
        let cost = |of: On| contacts.iter().map(|c| self.departs(c, of, size)).sum::<f64>();
        let own = cost(on);
        let others = all.iter().filter(|of| of.kind != on.kind).map(|of| (own - cost(*of)).exp());
        -others.sum::<f64>().max(f64::MIN_POSITIVE).ln()
    }
}
