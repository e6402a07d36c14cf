//! A record whose contacts are a little different, averaged over the windows it was averaged over: what a wrong constant of the sensors does to it.
//!
//! Modes, blows, gaps and what noise does stay as they were, so that a change is a sum over samples: no record of all of them is made anew.

use super::impulses;
use super::noise::ContactNoiseLevel;
use super::record::{Contact, Record, Wrench};
use super::windows::{Window, weights};
use glam::DVec3;
use object_dynamics::{ContactLog, LoggedPalm, MOST_PALMS};

/// What a contact is different by: its place, m, its normal and its force, N.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct ChangeBy {
    pub(super) c: DVec3,
    pub(super) n: DVec3,
    pub(super) f: DVec3,
}

/// A contact at one sample, as far as a change of it goes by it.
pub(super) struct Felt {
    /// Number in the record, and place among the contacts there.
    k: usize,
    place: usize,
    /// Number of the sample in the log.
    pub(super) sample: usize,
    pub(super) palm: usize,
    pub(super) frictionless: bool,
    /// Contact point from the record's origin, m; normal; velocity of the palm's material there, m/s; and force, N.
    pub(super) c: DVec3,
    pub(super) n: DVec3,
    pub(super) u: DVec3,
    pub(super) f: DVec3,
}

/// How the samples of a record count in its averages.
pub(super) struct Averages<'a> {
    record: &'a Record,
    average: &'a Record,
    /// By palm, in order of time: most constants are of one.
    felt: Vec<Vec<Felt>>,
    /// By sample.
    shares: Vec<Share>,
    /// Of each sample the first of its shares, and the interval before it.
    first_shares: Vec<usize>,
    before: Vec<Before>,
    /// Palms whose impulses are read.
    impulses: [Option<&'a LoggedPalm>; MOST_PALMS],
}

/// Of one sample in one window.
struct Share {
    sample: usize,
    window: usize,
    /// In its contacts, and in its mean wrench.
    contact: f64,
    wrench: f64,
}

/// The interval before a sample.
struct Before {
    /// How long it is, s, and how long after the start of the average's interval that it lies in it begins.
    h: f64,
    since: f64,
    /// Number of that.
    node: usize,
}

/// What acts otherwise at a sample through one palm: a wrench, and where its impulse is read, by where it is touched.
#[derive(Clone, Copy, Default)]
struct Acting {
    wrench: Wrench,
    moved: Option<DVec3>,
}

impl<'a> Averages<'a> {
    /// Of a `record` of all samples of `log` that was averaged over `windows`.
    pub(super) fn new(
        log: &'a ContactLog,
        noise: &ContactNoiseLevel,
        [record, average]: [&'a Record; 2],
        windows: &[Window],
    ) -> Self {
        let mut shares = Vec::with_capacity(windows.iter().map(|window| window.around.len()).sum());
        for (j, window) in windows.iter().enumerate() {
            let (among, weights) = weights(window, &record.times);
            let contact = |k: usize| k.checked_sub(among.start).and_then(|i| weights.get(i).copied());
            let wrench = |k: usize| if window.own.contains(&k) { 1.0 / window.own.len() as f64 } else { 0.0 };
            let of =
                |k| Share { sample: k, window: j, contact: contact(k).unwrap_or(0.0), wrench: wrench(k) };
            shares.extend(window.around.clone().map(of));
        }
        shares.sort_by_key(|share| share.sample);
        let mut impulses = [None; MOST_PALMS];
        for (read, palm) in impulses.iter_mut().zip(log.palms()) {
            *read = impulses::read(palm, noise).map(|_| palm);
        }
        let (mut first, mut node) = (0, 0);
        let first_share = |k: usize| {
            first += shares[first..].iter().take_while(|share| share.sample < k).count();
            first
        };
        let first_shares = (0..=record.times.len()).map(first_share).collect();
        let before = |k: usize| {
            node += usize::from(average.times.get(node + 1).is_some_and(|end| *end < record.times[k]));
            let start = k.saturating_sub(1);
            let h = record.intervals.get(start).map_or(0.0, |interval| interval.h);
            Before { h, since: record.times[start] - average.times[node], node }
        };
        let before = (0..record.times.len()).map(before).collect();
        let felt = felt(record, log.palms().len());
        Self { record, average, felt, shares, first_shares, before, impulses }
    }

    /// What contacts are measured from, world.
    pub(super) fn origin(&self) -> DVec3 {
        self.record.origin
    }

    /// The average where each contact, of one palm alone where that is said, is different by so much, if it is.
    pub(super) fn changed(&self, palm: Option<usize>, by: impl Fn(&Felt) -> Option<ChangeBy>) -> Record {
        let mut changed = self.average.clone();
        let palms = self.felt.iter().enumerate().filter(|(i, _)| palm.is_none_or(|palm| palm == *i));
        for (palm, felt) in palms {
            let mut before: Option<(usize, Acting)> = None;
            for felt in felt {
                let acting = by(felt).map(|by| self.acted(&mut changed, felt, &by));
                let next = before.is_some_and(|(at, _)| at + 1 == felt.k);
                if let Some((at, acting)) = before.filter(|_| !next) {
                    self.over(&mut changed, (palm, at + 1), [Some(acting), None]);
                }
                let before_it = before.filter(|_| next).map(|(_, acting)| acting);
                self.over(&mut changed, (palm, felt.k), [before_it, acting]);
                before = acting.map(|acting| (felt.k, acting));
            }
            if let Some((at, acting)) = before {
                self.over(&mut changed, (palm, at + 1), [Some(acting), None]);
            }
        }
        changed
            .contacts
            .iter_mut()
            .flatten()
            .for_each(|contact| contact.n = contact.n.normalize_or(contact.n));
        changed
    }

    /// Changes the windows that a contact counts in; gives what acts otherwise.
    fn acted(&self, changed: &mut Record, felt: &Felt, by: &ChangeBy) -> Acting {
        let mut acting = Acting::default();
        if self.impulses[felt.palm].is_some() {
            acting.moved = Some(by.c);
        } else {
            let moment = (felt.c + by.c).cross(felt.f + by.f) - felt.c.cross(felt.f);
            acting.wrench = Wrench { force: by.f, moment };
        }
        for share in &self.shares[self.first_shares[felt.k]..self.first_shares[felt.k + 1]] {
            if share.wrench > 0.0 {
                let wrench = &mut changed.wrenches[share.window];
                *wrench = *wrench + acting.wrench * share.wrench;
            }
            if let Some(to) = changed.contacts[share.window].get_mut(felt.place) {
                to.add(by, share.contact);
            }
        }
        acting
    }

    /// Changes the impulse over the interval that ends at sample `k`, and its integral over time, by what acts otherwise at its ends through a palm.
    fn over(&self, changed: &mut Record, (palm, k): (usize, usize), ends: [Option<Acting>; 2]) {
        if k == 0 || k >= self.record.times.len() || ends.iter().all(Option::is_none) {
            return;
        }
        let Before { h, since, node } = self.before[k];
        let [before, after] = ends.map(|acting| acting.unwrap_or_default().wrench);
        let mut impulse = (before + after) * (0.5 * h);
        let read = self.impulses[palm].and_then(|palm| palm.impulse(self.record.samples[k]));
        let moved = ends.iter().flatten().filter_map(|acting| acting.moved);
        let (sum, count) = moved.fold((DVec3::ZERO, 0.0), |(sum, count), moved| (sum + moved, count + 1.0));
        if let Some(J) = read.filter(|_| count > 0.0) {
            impulse.moment += (sum / count).cross(J.vector);
        }
        let interval = &mut changed.intervals[node];
        interval.impulse = interval.impulse + impulse;
        interval.first += (before.force + 2.0 * after.force) * (h * h / 6.0) + impulse.force * since;
    }
}

/// The contacts of a record, by palm.
fn felt(record: &Record, palms: usize) -> Vec<Vec<Felt>> {
    let mut all: Vec<Vec<Felt>> = (0..palms).map(|_| Vec::with_capacity(record.contacts.len())).collect();
    for (k, contacts) in record.contacts.iter().enumerate() {
        for (place, contact) in contacts.iter().enumerate() {
            let Contact { palm, c, n, u, f, frictionless, .. } = *contact;
            all[palm].push(Felt { k, place, sample: record.samples[k], palm, frictionless, c, n, u, f });
        }
    }
    all
}

impl Contact {
    /// Different by a share of that, its normal not yet of unit length; its palm's material is as fast as it is where it then is.
    fn add(&mut self, by: &ChangeBy, share: f64) {
        let moved = by.c * share;
        self.c += moved;
        self.u += self.W.cross(moved);
        self.n += by.n * share;
        self.f += by.f * share;
    }
}
