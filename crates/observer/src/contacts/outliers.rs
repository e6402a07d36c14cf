//! Contacts that are off by far more than noise at one sample, or a few: a sensor's misreadings, put where the contacts around say.

use super::both::of_each;
use super::record::Contact;
use super::way::{Off, STEADY, Told, Way};
use glam::DVec3;

/// Times what a peak of the force between samples moves the centre of mass by, that it may move a contact: that rolls, and the body turns too.
const ROLLS: f64 = 2.0;
/// Samples on either side of such a peak whose contacts it bends the way of.
const BENT: usize = 2;

/// A contact that is off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misread {
    pub(super) sample: usize,
    /// From 0.
    pub(super) palm: usize,
    /// Where those around it say that it is, from the record's origin, m, as well as so many contacts that are read do.
    c: DVec3,
    samples: f64,
}

/// Contacts on planes that are off, by their samples. `deviation` is that of a contact, m, `gravity` in m/s^2.
pub(super) fn misread(
    contacts: &[Vec<Contact>],
    times: &[f64],
    deviation: f64,
    gravity: f64,
) -> Vec<Misread> {
    let palms = contacts.iter().flatten().map(|contact| contact.palm + 1).max().unwrap_or(0);
    let (bends, steady) = (bends(contacts, times, gravity), steady(contacts));
    let of_palm = |palm: usize| {
        let way = way(contacts, times, palm, (&bends, &steady));
        let one = |Off { sample, told: Told { value, squares }, around }: Off| {
            // As good as what it is told by, and no better than what that leaves of those around it.
            let as_around =
                if around > 0.0 && deviation > 0.0 { (deviation / around).powi(2) } else { f64::INFINITY };
            Misread { sample, palm, c: value, samples: squares.recip().min(as_around) }
        };
        // Friction that sets in or lets go of a contact bends its way at once.
        let mut of_palm = contacts.iter().flatten().filter(|contact| contact.palm == palm);
        let slides = of_palm.all(|contact| contact.frictionless);
        way.off(deviation, slides).into_iter().map(one).collect()
    };
    let palms: Vec<usize> = (0..palms).collect();
    let of_palms: Vec<Vec<Misread>> = of_each(times.len(), &palms, of_palm);
    let mut all = of_palms.concat();
    all.sort_unstable_by_key(|of| (of.sample, of.palm));
    all
}

/// By how much the way of a contact may bend at each sample, since the force there is not that of the samples around, m. What the palms
/// carry in the mean is the weight.
fn bends(contacts: &[Vec<Contact>], times: &[f64], gravity: f64) -> Vec<f64> {
    let forces: Vec<DVec3> = contacts.iter().map(|of| of.iter().map(|contact| contact.f).sum()).collect();
    let mean = forces.iter().sum::<DVec3>().length() / forces.len() as f64;
    let peak = |k: usize| {
        let after = k + 1;
        let before = k.checked_sub(1)?;
        let bend = forces.get(after)? + forces[before] - 2.0 * forces[k];
        Some(bend.length() * (times[after] - times[k]) * (times[k] - times[before]))
    };
    let peaks: Vec<f64> = (0..forces.len()).map(|k| peak(k).unwrap_or(0.0)).collect();
    let around = |k: usize| &peaks[k.saturating_sub(BENT)..(k + BENT + 1).min(peaks.len())];
    let largest = |k: usize| around(k).iter().copied().fold(0.0, f64::max);
    let share = if mean > 0.0 { ROLLS * gravity / mean } else { 0.0 };
    (0..forces.len()).map(|k| share * largest(k)).collect()
}

/// Moves them to where those around them say.
pub(super) fn mend(contacts: &mut [Vec<Contact>], misread: &[Misread]) {
    for &Misread { sample, palm, c, samples } in misread {
        for contact in contacts[sample].iter_mut().filter(|contact| contact.palm == palm) {
            contact.move_to(c, samples);
        }
    }
}

/// Where a palm is touched, by what its way may bend at each sample and whether that is `steady`.
pub(super) fn way(
    contacts: &[Vec<Contact>],
    times: &[f64],
    palm: usize,
    (bends, steady): (&[f64], &[bool]),
) -> Way {
    let mut way = Way::default();
    for k in 0..contacts.len() {
        if let Some(contact) = contacts[k].iter().find(|contact| contact.palm == palm) {
            let flat = contact.shape == glam::DMat3::ZERO;
            way.add((k, times[k]), contact.c, bends[k], [steady[k] && flat, contact.repeated]);
        }
    }
    way
}

/// Whether the same palms are touched around each sample.
pub(super) fn steady(contacts: &[Vec<Contact>]) -> Vec<bool> {
    let palms = |of: &Vec<Contact>| of.iter().fold(0_u32, |palms, contact| palms | 1 << contact.palm);
    let touched: Vec<u32> = contacts.iter().map(palms).collect();
    let around = |k: usize| &touched[k.saturating_sub(STEADY)..(k + STEADY + 1).min(touched.len())];
    (0..touched.len()).map(|k| around(k).iter().all(|palms| *palms == touched[k])).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::random::Normal;
    use glam::DMat3;
    use object_dynamics::ContactMode;

    const STEP: f64 = 0.005;
    const G: f64 = 9.81;

    /// A palm whose contact runs at a steady rate, is thrown by a blow of `peak` weights at sample 30, and is elsewhere at sample 45 by `off`.
    pub(in crate::contacts) fn run(peak: f64, throw: f64, off: f64) -> Vec<Vec<Contact>> {
        let one = |k: u32| {
            let t = f64::from(k) * STEP;
            let after = (t - 30.0 * STEP).max(0.0);
            let off = if k == 45 { off } else { 0.0 };
            // With noise, as all that is judged is judged by its scatter.
            let noise = |by: f64| 2e-5 * (by * f64::from(k)).sin();
            let c = DVec3::new(0.1 * t + throw * after + noise(7.3), off + noise(2.9), 0.0);
            let weights = if k == 30 { peak } else { 1.0 };
            vec![Contact {
                palm: 0,
                c,
                n: DVec3::Z,
                u: DVec3::ZERO,
                W: DVec3::ZERO,
                u_deviation: 0.0,
                shape: DMat3::ZERO,
                f: DVec3::Z * weights,
                f_deviation: 0.01,
                frictionless: true,
                planar: false,
                mode: ContactMode::Slide,
                samples: 1.0,
                J_before: DVec3::ZERO,
                J_after: DVec3::ZERO,
                repeated: false,
            }]
        };
        (0..60).map(one).collect()
    }

    /// Where the curvature of the object jumps a contact changes its speed at once, and one that is elsewhere is still found next to it.
    #[test]
    fn a_contact_that_changes_its_speed_is_not_misread() {
        for speed in [-3.0, 0.5, 3.0] {
            // At some time between two samples.
            for part in [0.0, 0.3, 0.7] {
                let bent = |off: f64| {
                    let mut log = run(1.0, 0.0, off);
                    for (k, contacts) in log.iter_mut().enumerate() {
                        contacts[0].c.x += speed * (k as f64 - 30.0 - part).max(0.0) * STEP;
                    }
                    log
                };
                assert_eq!(found(&bent(0.0)), [], "{speed} {part}");
                assert_eq!(found(&bent(2e-3)), [45], "{speed} {part}");
                let mut beside = bent(0.0);
                beside[32][0].c.y += 2e-3;
                assert_eq!(found(&beside), [32], "{speed} {part}");
                // As two in a row are that are off together.
                beside[33][0].c.y += 2e-3;
                assert_eq!(found(&beside), [32, 33], "{speed} {part}");
            }
        }
    }

    #[test]
    fn misread_contacts_at_the_ends_are_told() {
        for k in [0, 1, 58, 59] {
            let mut log = run(1.0, 0.0, 0.0);
            log[k][0].c.y += 1e-3;
            assert_eq!(found(&log), [k]);
        }
        assert_eq!(found(&run(1.0, 0.0, 0.0)), []);
    }

    /// Noise alone has no tails: ten of its deviations are none of it, though they are 7.2 of those of what a cubic leaves.
    #[test]
    fn a_contact_that_is_off_by_little_is_told_where_noise_is_all() {
        const DEVIATION: f64 = 1e-4;
        let mut normal = Normal::seeded(4);
        let mut told = |off: f64, bend: f64| {
            let mut log = run(1.0, 0.0, off);
            for (k, contact) in log.iter_mut().enumerate().map(|(k, contacts)| (k, &mut contacts[0])) {
                contact.c += DVec3::new(normal.draw(), normal.draw(), 0.0) * DEVIATION;
                contact.c.x += bend * (2.0 * k as f64).sin();
            }
            let times: Vec<f64> = (0..log.len()).map(|k| k as f64 * STEP).collect();
            misread(&log, &times, DEVIATION, G).iter().map(|of| of.sample).collect::<Vec<_>>()
        };
        let mut of_fifty =
            |off: f64, bend: f64, as_these: &[usize]| (0..50).filter(|_| told(off, bend) == as_these).count();
        assert!(of_fifty(10.0 * DEVIATION, 0.0, &[45]) > 45);
        assert!(of_fifty(0.0, 0.0, &[]) == 50);
        // Where the way bends as much, it may be that.
        assert!(of_fifty(10.0 * DEVIATION, 4.0 * DEVIATION, &[]) > 45);
    }

    /// Of two that are off within three samples each puts the other's cubic, and the line that leads to it, elsewhere.
    #[test]
    fn contacts_that_are_off_side_by_side_are_told_by_noise_alone() {
        const DEVIATION: f64 = 1e-4;
        let mut normal = Normal::seeded(5);
        let mut told = |off: &[(usize, f64)]| {
            let mut log = run(1.0, 0.0, 0.0);
            for (k, contact) in log.iter_mut().enumerate().map(|(k, contacts)| (k, &mut contacts[0])) {
                // A parabola of 20 deviations a step at the end.
                let way = (k as f64).powi(2) / 6.0;
                contact.c = DVec3::new(way + normal.draw(), normal.draw(), 0.0) * DEVIATION;
            }
            off.iter().for_each(|&(k, off)| log[k][0].c.y += off * DEVIATION);
            let times: Vec<f64> = (0..log.len()).map(|k| k as f64 * STEP).collect();
            misread(&log, &times, DEVIATION, G).iter().map(|of| of.sample).collect::<Vec<_>>()
        };
        let mut of_fifty =
            |off: &[(usize, f64)], as_these: &[usize]| (0..50).filter(|_| told(off) == as_these).count();
        assert_eq!(of_fifty(&[], &[]), 50);
        assert!(of_fifty(&[(8, 12.0)], &[8]) > 45);
        assert!(of_fifty(&[(8, 16.0), (6, 12.0)], &[6, 8]) > 45);
    }

    /// A third sample that is off by as much leads to the first along a parabola.
    #[test]
    fn misread_contacts_three_samples_apart_are_told() {
        let mut log = run(1.0, 0.0, 2e-3);
        for k in [42, 48] {
            log[k][0].c.y += 2e-3;
        }
        assert_eq!(found(&log), [42, 45, 48]);
    }

    fn found(log: &[Vec<Contact>]) -> Vec<usize> {
        let times: Vec<f64> = (0..log.len()).map(|k| k as f64 * STEP).collect();
        misread(log, &times, 2e-5, G).iter().map(|of| of.sample).collect()
    }

    #[test]
    fn a_contact_that_a_peak_of_the_force_throws_is_not_misread() {
        // As far as the momentum of the peak throws the centre of mass.
        let (peak, off) = (7.0, 2e-3);
        let throw = (peak - 1.0) * G * STEP;
        assert_eq!(found(&run(peak, throw, off)), [45], "the contact that is elsewhere alone");
        assert_eq!(found(&run(1.0, 0.0, off)), [45]);
        // Without the force a contact that jumps back is no motion.
        let mut still = run(1.0, 0.0, 0.0);
        still[30][0].c.x += throw * STEP;
        assert_eq!(found(&still), [30]);
        still[30][0].f *= peak;
        assert_eq!(found(&still), []);
    }
}
