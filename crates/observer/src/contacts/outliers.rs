//! Contacts that are off by far more than noise at one sample, or a few: a sensor's misreadings, put where the contacts around say.

use super::record::Contact;
use glam::DVec3;

/// Deviations from which on a contact is off: of what noise or, where that is more, the motion itself leaves of a cubic at most samples.
pub(super) const OFF: f64 = 8.0;
/// Contacts on either side that tell where one should be, and among how many samples they are looked for.
const BESIDE: usize = 2;
const AMONG: usize = 6;
/// Samples on either side over which the same palms must be touched: a landing bends the way of all contacts.
const STEADY: usize = 3;
/// Share of the spread of all contacts of a palm that it is off by at least: less harms nothing.
const NOTABLE: f64 = 3e-3;
/// Neighbours that may be off together: more are a motion that turns sharply.
pub(super) const TOGETHER: usize = 2;
/// Share of a palm's contacts beyond which they are not outliers but what the sensor is like.
pub(super) const MOST: f64 = 0.05;
/// Times what a peak of the force between samples moves the centre of mass by, that it may move a contact: that rolls, and the body turns too.
const ROLLS: f64 = 2.0;
/// Samples on either side of such a peak whose contacts it bends the way of.
const BENT: usize = 2;
/// Root of one and the squared weights of a cubic through two contacts on either side, evenly spaced: noise of what a contact is off it by over that of one.
const OF_CUBIC: f64 = 1.394;
/// Fewest contacts of a palm whose scatter can be told.
pub(super) const FEWEST: usize = 20;
/// Median of the length of a vector of two standard normal numbers.
pub(super) const MEDIAN_LENGTH: f64 = 1.177_410_022_515_474_7;

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

/// Where others say that a contact is, m, and the sum of the squares of what they count by.
#[derive(Clone, Copy, Debug)]
struct Told {
    c: DVec3,
    squares: f64,
}

/// Contacts on planes that are off, by their samples. `deviation` is that of a contact, m, `gravity` in m/s^2.
pub(super) fn misread(
    contacts: &[Vec<Contact>],
    times: &[f64],
    deviation: f64,
    gravity: f64,
) -> Vec<Misread> {
    let palms = contacts.iter().flatten().map(|contact| contact.palm + 1).max().unwrap_or(0);
    let bends = bends(contacts, times, gravity);
    let mut all = Vec::new();
    for palm in 0..palms {
        let way = Way::new(contacts, times, palm, &bends);
        let off = way.off(deviation);
        let one = |(j, Told { c, squares }): (usize, Told)| Misread {
            sample: way.samples[j],
            palm,
            c,
            samples: squares.recip(),
        };
        all.extend(off.into_iter().map(one));
    }
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

/// The contacts of a palm.
struct Way {
    samples: Vec<usize>,
    times: Vec<f64>,
    points: Vec<DVec3>,
    /// What the motion may leave of them, m.
    bends: Vec<f64>,
    /// Whether the same palms are touched around, and this one is flat.
    steady: Vec<bool>,
}

impl Way {
    fn new(contacts: &[Vec<Contact>], times: &[f64], palm: usize, bends: &[f64]) -> Self {
        let touched = |k: usize| contacts[k].iter().map(|contact| contact.palm);
        let steady = |k: usize| {
            let around = k.saturating_sub(STEADY)..(k + STEADY + 1).min(contacts.len());
            around.into_iter().all(|other| touched(other).eq(touched(k)))
        };
        let one = |k: usize| {
            let contact = contacts[k].iter().find(|contact| contact.palm == palm)?;
            Some((k, contact.c, steady(k) && contact.shape == glam::DMat3::ZERO))
        };
        let found: Vec<_> = (0..contacts.len()).filter_map(one).collect();
        Self {
            samples: found.iter().map(|of| of.0).collect(),
            times: found.iter().map(|of| times[of.0]).collect(),
            points: found.iter().map(|of| of.1).collect(),
            bends: found.iter().map(|of| bends[of.0]).collect(),
            steady: found.iter().map(|of| of.2).collect(),
        }
    }

    /// Numbers of the contacts that are off, and where they should be.
    fn off(&self, deviation: f64) -> Vec<(usize, Told)> {
        let count = self.points.len();
        if count < FEWEST {
            return Vec::new();
        }
        let mean = self.points.iter().sum::<DVec3>() / count as f64;
        let square = self.points.iter().map(|point| point.distance_squared(mean)).sum::<f64>();
        let least = deviation.max(NOTABLE / OFF * (square / count as f64).sqrt());
        let limit = |left: &[f64]| {
            let mut scatter: Vec<f64> = left.iter().copied().filter(|left| *left > 0.0).collect();
            scatter.sort_by(f64::total_cmp);
            let usual = scatter.get(scatter.len() / 2).map_or(f64::INFINITY, |median| median / MEDIAN_LENGTH);
            OFF * usual.max(least)
        };
        // Medians are not misled by a few that are off, but by the bend of the way; cubics the other way round.
        let left: Vec<f64> = (0..count).map(|j| self.points[j].distance(self.usual(j))).collect();
        let most = limit(&left);
        let suspected: Vec<bool> = (0..count).map(|j| self.steady[j] && left[j] > most).collect();
        let left: Vec<f64> =
            (0..count).map(|j| self.told(j, &suspected).map_or(0.0, |told| self.left(j, &told))).collect();
        let most = limit(&left);
        let is_off = |&j: &usize| {
            let limit = most + self.bends[j];
            suspected[j] && left[j] > limit && !self.goes_on(j, OF_CUBIC * limit)
        };
        let off: Vec<usize> = (0..count).filter(is_off).collect();
        let together = off.chunk_by(|a, b| *b == a + 1).filter(|run| run.len() <= TOGETHER);
        let off: Vec<_> = together.flatten().filter_map(|&j| Some((j, self.told(j, &suspected)?))).collect();
        if off.len() as f64 > MOST * count as f64 { Vec::new() } else { off }
    }

    /// The median of the contacts around one, at an end carried on to it by the slope of medians.
    fn usual(&self, j: usize) -> DVec3 {
        let inner = |j: usize| j.clamp(STEADY, self.points.len() - 1 - STEADY);
        let centre = inner(j);
        let median = self.median(centre);
        if centre == j {
            return median;
        }
        let further = inner(2 * centre - j);
        let share = (j as f64 - centre as f64) / (further as f64 - centre as f64);
        median + (self.median(further) - median) * share
    }

    /// The median of each coordinate.
    fn median(&self, centre: usize) -> DVec3 {
        let around = &self.points[centre - STEADY..=centre + STEADY];
        let of = |axis: usize| {
            let mut values: Vec<f64> = around.iter().map(|point| point[axis]).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        DVec3::new(of(0), of(1), of(2))
    }

    /// Whether a contact is where the way from one side leads, to within so many metres, by the line through two contacts there or the parabola through three;
    /// where there is a fourth, by that with it in place of the third as well: a third that is off by as much as this one leads to it.
    ///
    /// Where the curvature of the object jumps, its contact changes its speed from one sample to the next: nothing that is smooth over both sides leads there.
    fn goes_on(&self, j: usize, within: f64) -> bool {
        let near = |other: &usize| self.samples[*other].abs_diff(self.samples[j]) <= AMONG;
        // Those that may be off themselves as well: so few in a row lead to no other one.
        let before: Vec<usize> = (0..j).rev().take(AMONG).filter(near).collect();
        let after: Vec<usize> = (j + 1..self.points.len()).take(AMONG).filter(near).collect();
        let leads = |few: &[usize]| self.through(few, j).0.distance(self.points[j]) <= within;
        [&before[..], &after].iter().any(|side| match *side {
            [a, b, c, d, ..] => leads(&[*a, *b]) || (leads(&[*a, *b, *c]) && leads(&[*a, *b, *d])),
            [a, b, c] => leads(&[*a, *b]) || leads(&[*a, *b, *c]),
            [a, b] => leads(&[*a, *b]),
            _ => false,
        })
    }

    /// The polynomial through some contacts at the time of another one, and its weights.
    fn through(&self, beside: &[usize], j: usize) -> (DVec3, Vec<f64>) {
        let weight = |i: &usize| -> f64 {
            let others = beside.iter().filter(|other| *other != i);
            others
                .map(|&other| (self.times[j] - self.times[other]) / (self.times[*i] - self.times[other]))
                .product()
        };
        let weights: Vec<f64> = beside.iter().map(weight).collect();
        (beside.iter().zip(&weights).map(|(&i, weight)| self.points[i] * *weight).sum(), weights)
    }

    /// By how many metres of unit noise a contact is elsewhere than it is told.
    fn left(&self, j: usize, told: &Told) -> f64 {
        told.c.distance(self.points[j]) / (1.0 + told.squares).sqrt()
    }

    /// Where the cubic through the contacts beside one leads, at an end the parabola; those that are `out` say nothing. None with too few of them.
    fn told(&self, j: usize, out: &[bool]) -> Option<Told> {
        let near = |other: &usize| !out[*other] && self.samples[*other].abs_diff(self.samples[j]) <= AMONG;
        let before: Vec<usize> = (0..j).rev().take(AMONG).filter(near).take(2 * BESIDE).collect();
        let after: Vec<usize> =
            (j + 1..self.points.len()).take(AMONG).filter(near).take(2 * BESIDE).collect();
        // At an end more of them on one side; a cubic that leads beyond all of them has eight times the noise of one.
        let most = if before.is_empty() || after.is_empty() { 2 * BESIDE - 1 } else { 2 * BESIDE };
        let from_before = before.len().min(most.saturating_sub(after.len()).max(BESIDE));
        let from_after = after.len().min(most - from_before);
        if from_before + from_after < most {
            return None;
        }
        let beside: Vec<usize> =
            before.into_iter().take(from_before).chain(after.into_iter().take(from_after)).collect();
        let (c, weights) = self.through(&beside, j);
        Some(Told { c, squares: weights.iter().map(|weight| weight * weight).sum() })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
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
