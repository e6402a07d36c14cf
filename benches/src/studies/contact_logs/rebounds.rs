//! Landings that a log's contacts rebound from, and runs from the log's own state after each.

use super::changes::{changes, matching, nearest};
use super::growth::Natural;
use super::log::{Anything, Change, Log};
use super::simulate;

/// A run takes a palm nearer to the body than this share of the body's size for touched at its start.
const NEAR: f64 = 1e-4;

/// A contact that closes and is open again within this many samples has rebounded.
const SOON: usize = 3;

/// A landing after which a contact is open again at once.
struct Rebound {
    palm: usize,
    /// The last sample before the landing, and the first after the blow.
    before: usize,
    after: usize,
    /// Speeds at which the gap closes before and opens after, m/s.
    comes: f64,
    leaves: f64,
}

/// A rebound, and the run from the log's state as soon after it as every contact is closed or clearly open.
pub(super) struct Restart {
    rebound: Rebound,
    /// Times of the landing, of the run's start, and of the next landing that is rebounded from (else the end), s.
    lands: f64,
    pub(super) from: f64,
    until: f64,
    theirs: Vec<Change>,
    ours: Vec<Change>,
    /// The largest until then, m.
    departure: f64,
}

/// A run from the log's state after each rebound in its first `count` samples.
pub(super) fn restarts(log: &Log, count: usize, tolerance: f64) -> Anything<Vec<Restart>> {
    let t = log.column("t")?;
    let found = rebounds(log, count)?;
    let ends: Vec<f64> = found.iter().skip(1).map(|next| t[next.before]).chain([t[count - 1]]).collect();
    let restart = |(rebound, until): (Rebound, f64)| -> Anything<Restart> {
        let first = clear(log, rebound.after, count)?;
        let (rest, from) = (log.from(first), t[first]);
        let run = simulate(&rest, &rest.scene()?, rest.body(0)?, t[count - 1] - from, tolerance)?;
        let within = |mut all: Vec<Change>| {
            all.iter_mut().for_each(|change| change.t += from);
            all.retain(|change| change.t <= until);
            all
        };
        let (natural, bodies) = (Natural::of(log), rest.bodies(run.instants.len())?);
        let apart = run.instants.iter().zip(&bodies).filter(|(now, _)| now.state.t + from <= until);
        let departures = apart.map(|(now, body)| natural.apart(&now.state.body, body));
        Ok(Restart {
            lands: t[rebound.before],
            rebound,
            from,
            until,
            theirs: within(rest.changes(run.instants.len())?),
            ours: within(changes(&rest, &run)),
            departure: departures.fold(0.0, f64::max),
        })
    };
    found.into_iter().zip(ends).map(restart).collect()
}

impl Restart {
    /// Palm, the landing, both speeds and their share, and how the run from there compares.
    pub(super) fn row(&self) -> String {
        let Rebound { palm, comes, leaves, .. } = self.rebound;
        let same = matching(&self.theirs, &self.ours).len();
        format!(
            "{} | {:.3} | {comes:.3} | {leaves:.3} | {:.2} | {:.3} to {:.3} | {} | {same} | {:.1e}",
            palm + 1,
            self.lands,
            leaves / comes,
            self.from,
            self.until,
            self.theirs.len(),
            self.departure,
        )
    }

    /// Whether a change lies between the landing and this run's start.
    fn is_within_rebound(&self, change: &Change) -> bool {
        change.t > self.lands && change.t <= self.from
    }
}

/// What the run after the last rebound before a change has of it.
pub(super) fn told_after_rebound(change: &Change, restarts: &[Restart]) -> String {
    match restarts.iter().rfind(|restart| restart.lands < change.t) {
        None => "no rebound before".to_owned(),
        Some(restart) if restart.is_within_rebound(change) => "part of the rebound".to_owned(),
        Some(restart) => match nearest(change, &restart.ours) {
            Some(ours) => format!("{:.0} ms apart", (ours.t - change.t) * 1e3),
            None => "none".to_owned(),
        },
    }
}

/// Contacts that are open, receive an impulse and are open again.
fn rebounds(log: &Log, count: usize) -> Anything<Vec<Rebound>> {
    let t = log.column("t")?;
    let mut found = Vec::new();
    for palm in 0..log.palm_count() {
        let (contact, impulse) = (log.contact(palm + 1)?, log.vectors("J", &format!("_{}", palm + 1))?);
        let pushed = |k: usize| impulse[k + 1] != impulse[k];
        // Of the second order in the step, from samples on one side.
        let slope = |[a, b, c]: [usize; 3]| {
            (3.0 * contact.gap[a] - 4.0 * contact.gap[b] + contact.gap[c]) / (t[a] - t[c])
        };
        for before in 2..count.saturating_sub(SOON + 3) {
            if contact.mode[before] > 0.5 || !pushed(before) || pushed(before - 1) {
                continue;
            }
            let open = |k: &usize| contact.mode[*k] < 0.5 && !pushed(*k);
            let Some(after) = (before + 1..=before + SOON).find(open) else { continue };
            let comes = -slope([before, before - 1, before - 2]);
            let leaves = slope([after, after + 1, after + 2]);
            if comes > 0.0 && leaves > 0.0 {
                found.push(Rebound { palm, before, after, comes, leaves });
            }
        }
    }
    found.sort_by_key(|rebound| rebound.before);
    Ok(found)
}

/// The first sample from `after` on at which no palm that the log does not touch is as near as one that a run takes for touched.
fn clear(log: &Log, after: usize, count: usize) -> Anything<usize> {
    let near = NEAR * log.semi_axes().element_sum() / 3.0;
    let palms = (1..=log.palm_count()).map(|i| log.contact(i)).collect::<Anything<Vec<_>>>()?;
    (after..count)
        .find(|&k| palms.iter().all(|palm| palm.mode[k] > 0.5 || palm.gap[k] > near))
        .ok_or_else(|| "no sample after a rebound at which each contact is closed or clearly open".into())
}
