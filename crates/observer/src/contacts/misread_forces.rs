//! Forces that are off at a sample or two while the motion knows nothing of it: a sensor's misreadings, put where the forces around say.
//!
//! A force that is as large throws the centre of mass, and bends the way of the contacts. Where noise hides how far, it is left as it is: a motion hardly depends on
//! it then, or contradicts it.

use super::both::of_each;
use super::outliers::{steady, way};
use super::record::Contact;
use super::way::{Off, Told, Way};
use glam::DVec3;

/// Share of what a force would throw the centre of mass by, up to which contacts show nothing of it.
const SHOWN: f64 = 0.1;
/// Of a change of the slope at a sample, over the time between samples: what a cubic through two values on either side leaves of the value.
const OF_KINK: f64 = 1.0 / 3.0;
/// Deviations of a contact that its noise may hide.
const DEVIATIONS: f64 = 4.0;

/// A force that is off.
#[derive(Clone, Copy, Debug)]
pub(super) struct MisreadForce {
    pub(super) sample: usize,
    /// From 0.
    pub(super) palm: usize,
    /// What those around it say that it is, N.
    f: DVec3,
    /// By how much they are others than what those around them say, N.
    around: f64,
}

/// Forces of palms that are read at samples, by these. `deviation` is that of a contact, m, `gravity` in m/s^2.
pub(super) fn misread_forces(
    contacts: &[Vec<Contact>],
    times: &[f64],
    sampled: &[bool],
    deviation: f64,
    gravity: f64,
) -> Vec<MisreadForce> {
    let whole: DVec3 = contacts.iter().flatten().map(|contact| contact.f).sum();
    let mass = whole.length() / times.len() as f64 / gravity;
    if mass.is_nan() || mass <= 0.0 {
        return Vec::new();
    }
    let palms: Vec<usize> = (0..sampled.len()).filter(|&palm| sampled[palm]).collect();
    let steady = steady(contacts);
    let off = |palm: usize| -> Vec<(usize, Off)> {
        let (way, noise) = forces(contacts, times, palm, &steady);
        way.off(noise, false).into_iter().map(|off| (palm, off)).collect()
    };
    let off: Vec<_> = of_each(times.len(), &palms, off).into_iter().flatten().collect();
    if off.is_empty() {
        return Vec::new();
    }
    let still = vec![0.0; times.len()];
    let ways: Vec<Way> =
        (0..sampled.len()).map(|palm| way(contacts, times, palm, (&still, &steady))).collect();
    let one = |(palm, Off { sample: k, told: Told { value, .. }, around }): (usize, Off)| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(times.len() - 1));
        let h = 0.5 * (times[after] - times[before]);
        let read = contacts[k].iter().find(|contact| contact.palm == palm)?;
        let thrown = OF_KINK * read.f.distance(value) * h * h / mass;
        let bent = ways.iter().map(|way| way.left_at_sample(k)).fold(0.0, f64::max);
        let shows = DEVIATIONS * deviation + bent >= SHOWN * thrown;
        (read.repeated || !shows).then_some(MisreadForce { sample: k, palm, f: value, around })
    };
    let mut all: Vec<MisreadForce> = off.into_iter().filter_map(one).collect();
    all.sort_unstable_by_key(|of| (of.sample, of.palm));
    all
}

/// Forces of a palm, and the deviation of one, N.
fn forces(contacts: &[Vec<Contact>], times: &[f64], palm: usize, steady: &[bool]) -> (Way, f64) {
    let mut way = Way::default();
    let mut noise = 0.0;
    for k in 0..contacts.len() {
        if let Some(contact) = contacts[k].iter().find(|contact| contact.palm == palm) {
            way.add((k, times[k]), contact.f, 0.0, [steady[k], contact.repeated]);
            noise += contact.f_deviation;
        }
    }
    let count = way.samples.len().max(1);
    (way, noise / count as f64)
}

/// Makes them what those around them say.
pub(super) fn mend_forces(contacts: &mut [Vec<Contact>], misread: &[MisreadForce]) {
    for &MisreadForce { sample, palm, f, around } in misread {
        for contact in contacts[sample].iter_mut().filter(|contact| contact.palm == palm) {
            contact.f = f;
            contact.f_deviation = contact.f_deviation.max(around);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::outliers::tests::run;
    use super::*;

    /// A force of seven weights at a sample that throws the contact is one; with a contact that knows nothing of it, it is none, and where noise of the contact hides what it would
    /// do it stays.
    #[test]
    fn a_force_that_throws_a_contact_is_no_misreading() {
        const STEP: f64 = 0.005;
        const G: f64 = 9.81;
        let (peak, throw) = (7.0, 6.0 * G * STEP);
        let found = |throw: f64, deviation: f64| -> Vec<usize> {
            let mut contacts = run(peak, throw, 0.0);
            // Noise, as all that is judged is judged by its scatter.
            for (k, contacts) in contacts.iter_mut().enumerate() {
                contacts[0].f.z += 1e-3 * (5.1 * k as f64).sin();
            }
            let times: Vec<f64> = (0..contacts.len()).map(|k| k as f64 * STEP).collect();
            misread_forces(&contacts, &times, &[true], deviation, G).iter().map(|of| of.sample).collect()
        };
        assert_eq!(found(throw, 2e-6), []);
        assert_eq!(found(0.0, 2e-6), [30]);
        assert_eq!(found(0.0, 2e-5), []);
    }
}
