//! A record whose contacts are a little different, averaged over the windows it was averaged over: what a wrong constant of the sensors does to it.
//!
//! Modes, blows, gaps and what noise does stay as they were, so that a change is a sum over samples: no record of all of them is made anew.

use super::impulses;
use super::noise::ContactNoiseLevel;
use super::record::{Contact, Record, Wrench};
use super::windows::{weights, windows};
use glam::DVec3;
use object_dynamics::{ContactLog, LoggedPalm, MOST_PALMS};

/// What a contact is different by: its place, m, its normal and its force, N.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct ChangeBy {
    pub(super) c: DVec3,
    pub(super) n: DVec3,
    pub(super) f: DVec3,
}

/// How the samples of a record count in its averages.
pub(super) struct Averages<'a> {
    record: &'a Record,
    average: &'a Record,
    /// By sample.
    shares: Vec<Share>,
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

/// What acts otherwise at a sample: through forces there, and by where palms are touched whose impulses are read.
#[derive(Clone, Copy, Default)]
struct Acting {
    wrench: Wrench,
    moved: [Option<DVec3>; MOST_PALMS],
}

impl<'a> Averages<'a> {
    /// Of a `record` of all samples of `log` that was averaged over windows of at most `longest`, s.
    pub(super) fn new(
        log: &'a ContactLog,
        noise: &ContactNoiseLevel,
        [record, average]: [&'a Record; 2],
        longest: f64,
    ) -> Self {
        let mut shares = Vec::new();
        for (j, window) in windows(record, longest).iter().enumerate() {
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
        Self { record, average, shares, impulses }
    }

    /// What contacts are measured from, world.
    pub(super) fn origin(&self) -> DVec3 {
        self.record.origin
    }

    /// The average where each contact, with the number of its sample in the log, is different by so much, if it is.
    pub(super) fn changed(&self, by: impl Fn(usize, &Contact) -> Option<ChangeBy>) -> Record {
        let mut changed = self.average.clone();
        let (mut shares, mut node) = (self.shares.iter().peekable(), 0);
        // Most constants are of one palm: what the others feel is passed by.
        let (mut some, mut before) = (Vec::new(), None);
        for (k, contacts) in self.record.contacts.iter().enumerate() {
            some.clear();
            let of = |(i, contact)| Some((i, contact, by(self.record.samples[k], contact)?));
            some.extend(contacts.iter().enumerate().filter_map(of));
            let acting = (!some.is_empty()).then(|| self.acting(&some));
            while let Some(share) = shares.next_if(|share| share.sample == k) {
                let Some(acting) = &acting else { continue };
                let wrench = &mut changed.wrenches[share.window];
                *wrench = *wrench + acting.wrench * share.wrench;
                let to = &mut changed.contacts[share.window];
                for (i, _, by) in &some {
                    to.get_mut(*i).into_iter().for_each(|to| to.add(by, share.contact));
                }
            }
            if k > 0 {
                node += usize::from(changed.times[node + 1] < self.record.times[k]);
            }
            if k > 0 && (before.is_some() || acting.is_some()) {
                let since = self.record.times[k - 1] - changed.times[node];
                let none = Acting::default();
                let ends = [&before, &acting].map(|acting| acting.as_ref().unwrap_or(&none));
                let (impulse, first) = self.over(k, ends);
                let interval = &mut changed.intervals[node];
                interval.impulse = interval.impulse + impulse;
                interval.first += first + impulse.force * since;
            }
            before = acting;
        }
        changed
            .contacts
            .iter_mut()
            .flatten()
            .for_each(|contact| contact.n = contact.n.normalize_or(contact.n));
        changed
    }

    fn acting(&self, some: &[(usize, &Contact, ChangeBy)]) -> Acting {
        let mut all = Acting::default();
        for (_, contact, by) in some {
            if self.impulses[contact.palm].is_some() {
                all.moved[contact.palm] = Some(by.c);
            } else {
                let moment = (contact.c + by.c).cross(contact.f + by.f) - contact.c.cross(contact.f);
                all.wrench = all.wrench + Wrench { force: by.f, moment };
            }
        }
        all
    }

    /// Impulse over the interval that ends at sample `k`, and its integral over time.
    fn over(&self, k: usize, [before, after]: [&Acting; 2]) -> (Wrench, DVec3) {
        let h = self.record.intervals[k - 1].h;
        let mut impulse = (before.wrench + after.wrench) * (0.5 * h);
        let first = (before.wrench.force + 2.0 * after.wrench.force) * (h * h / 6.0);
        for (i, palm) in self.impulses.iter().enumerate() {
            let Some(J) = palm.and_then(|palm| palm.impulse(self.record.samples[k])) else { continue };
            let (sum, count) = [before, after]
                .iter()
                .filter_map(|acting| acting.moved[i])
                .fold((DVec3::ZERO, 0.0), |(sum, count), moved| (sum + moved, count + 1.0));
            if count > 0.0 {
                impulse.moment += (sum / count).cross(J.vector);
            }
        }
        (impulse, first)
    }
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
