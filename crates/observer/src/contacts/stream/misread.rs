//! Contacts of the newest samples that are off by far more than noise, put where those before them lead: no later ones are there yet to tell.
//!
//! Windows put them between those on either side ([`outliers`](crate::contacts::outliers)). From a window's end on a motion is carried by moments about
//! contacts as they come, where one that is off by a fifth of the size turns the body as the noise of thousands does.

use super::sample::{Contacts, Felt};
use crate::contacts::record::{Contact, add_contact_noise};
use crate::contacts::way::{FEWEST, MEDIAN_LENGTH, MOST, OFF, TOGETHER};
use glam::{DMat3, DVec3};
use object_dynamics::MOST_PALMS;

/// Contacts by whose scatter one is judged.
const JUDGED: usize = 100;
/// Times from one of two contacts to the next within which the line through them leads on.
const LEADS: f64 = 3.5;

/// The newest contacts of all palms.
#[derive(Debug, Default)]
pub(super) struct Newest {
    palms: [Way; MOST_PALMS],
}

/// What was taken from the moment of a sample's forces, N m, because a contact seemed to be off there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken {
    pub(super) number: usize,
    pub(super) moment: DVec3,
}

/// The newest contacts of a palm.
#[derive(Debug)]
struct Way {
    /// The latest two that are not off, with their times; none of the time before the palm was touched.
    known: [Option<(f64, DVec3)>; 2],
    /// By how many metres of unit noise the latest contacts were off the line through two before them, and whether they were put on it.
    left: [f64; JUDGED],
    put: [bool; JUDGED],
    /// How many were judged so far.
    judged: usize,
    /// Contacts in a row that were: as they were read, and what that took.
    held: [(f64, DVec3, Taken); TOGETHER],
    together: usize,
}

impl Default for Way {
    fn default() -> Self {
        Self {
            known: [None; 2],
            left: [0.0; JUDGED],
            put: [false; JUDGED],
            judged: 0,
            held: Default::default(),
            together: 0,
        }
    }
}

impl Newest {
    /// Puts contacts that are off where those before them lead. What was taken by that from samples before is to be given back, where so many in a row
    /// were off that this is how the contact goes on. `deviation` is that of a contact, m.
    pub(super) fn judge(
        &mut self,
        contacts: &mut Contacts,
        felt: &mut Felt,
        deviation: f64,
        mut give_back: impl FnMut(Taken),
    ) {
        for (way, contact) in self.palms.iter_mut().zip(contacts) {
            match contact {
                // On a curved palm the normal would go along with the contact.
                Some(contact) if contact.shape == DMat3::ZERO => {
                    way.judge(contact, felt, deviation).into_iter().flatten().for_each(&mut give_back);
                }
                _ => (way.known, way.together) = ([None; 2], 0),
            }
        }
    }
}

impl Way {
    fn judge(&mut self, contact: &mut Contact, felt: &mut Felt, deviation: f64) -> Option<[Taken; TOGETHER]> {
        let read = (felt.t, contact.c);
        let [Some(a), Some(b)] = self.known else {
            self.known = [self.known[1], Some(read)];
            return None;
        };
        let further = (felt.t - b.0) / (b.0 - a.0);
        if further > LEADS {
            (self.known, self.together) = ([None, Some(read)], 0);
            return None;
        }
        let line = b.1 + (b.1 - a.1) * further;
        // Of what both count by in it.
        let squares = (1.0 + further).powi(2) + further * further;
        let left = line.distance(contact.c) / (1.0 + squares).sqrt();
        let at = self.judged % JUDGED;
        let seems_off = left > OFF * deviation && self.is_off(left);
        (self.left[at], self.put[at]) = (left, seems_off);
        self.judged += 1;
        if !seems_off {
            self.known = [Some(b), Some(read)];
            self.together = 0;
            return None;
        }
        if self.together == TOGETHER {
            // So many in a row are no misreadings.
            self.together = 0;
            let last = self.held[TOGETHER - 1];
            self.known = [Some((last.0, last.1)), Some(read)];
            return Some(self.held.map(|held| held.2));
        }
        let moment = (contact.c - line).cross(contact.f);
        self.held[self.together] = (read.0, read.1, Taken { number: felt.number, moment });
        self.together += 1;
        felt.wrench.moment -= moment;
        contact.move_to(line, squares.recip());
        // One sample's noise is in it already.
        let more = (1.0 - squares.recip()).max(0.0).sqrt();
        add_contact_noise(&mut felt.noise, contact, contact.f, deviation * more);
        None
    }

    /// Whether so much is far beyond what contacts scatter by, and few others are.
    fn is_off(&self, left: f64) -> bool {
        let count = self.judged.min(JUDGED);
        if count < FEWEST || self.put.iter().filter(|put| **put).count() as f64 > MOST * count as f64 {
            return false;
        }
        let mut scatter = self.left;
        let (_, median, _) = scatter[..count].select_nth_unstable_by(count / 2, f64::total_cmp);
        left > OFF / MEDIAN_LENGTH * *median
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::outliers::tests::run;
    use crate::contacts::record::wrench;
    use nalgebra::Matrix6;

    const STEP: f64 = 0.005;
    const DEVIATION: f64 = 2e-5;

    /// What becomes of contacts one by one: where they are put and what was given back, with the moments of their forces.
    fn judged(log: &[Vec<Contact>]) -> (Vec<usize>, Vec<Taken>, Vec<DVec3>) {
        let (mut newest, mut put, mut back, mut moments) =
            (Newest::default(), Vec::new(), Vec::new(), Vec::new());
        for (k, of) in log.iter().enumerate() {
            let mut contacts = [None; MOST_PALMS];
            contacts[0] = Some(of[0]);
            let mut felt = Felt {
                number: k,
                t: k as f64 * STEP,
                wrench: wrench(of),
                noise: Matrix6::zeros(),
                touching: [false; MOST_PALMS],
            };
            newest.judge(&mut contacts, &mut felt, DEVIATION, |taken| back.push(taken));
            if contacts[0].is_some_and(|contact| contact.c != of[0].c) {
                put.push(k);
                assert!(felt.noise.trace() > 0.0, "a place that is not read is known less well");
            }
            moments.push(felt.wrench.moment);
        }
        (put, back, moments)
    }

    #[test]
    fn a_contact_that_is_off_is_put_where_those_before_it_lead() {
        let (off, clean) = (run(1.0, 0.0, 2e-3), run(1.0, 0.0, 0.0));
        let (put, back, moments) = judged(&off);
        assert_eq!((put, back.len()), (vec![45], 0));
        // A line through two contacts is off by twice the noise of one, of which there is a quarter at most.
        let moment = wrench(&clean[45]).moment;
        assert!(moments[45].distance(moment) < 5.0 * DEVIATION * clean[45][0].f.length());
        assert_eq!(judged(&clean).0, []);
    }

    /// Two of them are held back; the third shows that this is how it goes on, and what was taken is given back.
    #[test]
    fn what_was_taken_is_given_back_where_a_contact_goes_on_elsewhere() {
        let mut log = run(1.0, 0.0, 0.0);
        log.iter_mut().skip(40).for_each(|contacts| contacts[0].c.y += 2e-3);
        let (put, back, moments) = judged(&log);
        assert_eq!(put, [40, 41]);
        assert_eq!(back.iter().map(|taken| taken.number).collect::<Vec<_>>(), [40, 41]);
        for Taken { number, moment } in back {
            let read = wrench(&log[number]).moment;
            assert!((moments[number] + moment).distance(read) < 1e-12 * read.length());
        }
    }
}
