//! Errors of contacts as their conditions tell them, taken out of the moments that they are in.
//!
//! A contact that is read beside where it is by `e` is off in its condition by `z e`, of the spin `z` against the palm, and the moment of the impulse `J`
//! through it is off by `e x J`: one error, and not two. What a condition says of `e` (its foot) is taken out of the moment, and a link is as
//! much better as that is known.

use super::body::Body;
use super::equations::{Row, Split};
use super::impulses;
use super::link::LinkNoise;
use super::noise::WrenchNoise;
use super::problem::Problem;
use super::record::{Contact, Interval, Record};
use super::rows::Rows;
use super::search::fine;
use super::stage::Stage;
use super::state::{Motion, Tangent, Turn, tangent};
use super::windows::Window;
use glam::DVec3;
use nalgebra::{Matrix3, Vector3};
use object_dynamics::ContactLog;

/// A condition that tells of a contact by which the moment over a link is off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot<const P: usize> {
    /// The condition in its deviation, by the motions at both ends of the link and the body, and its value.
    pub(super) row: Split<P>,
    pub(super) value: f64,
    /// What moment over the link is off by for each of its deviations, and the motion at the end of it.
    pub(super) moment: Share,
    pub(super) by: Tangent,
}

/// A share of what the error of a contact does: that of one of the two links over which its impulses are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub(super) moment: DVec3,
    /// How often the square of it is its variance: both links have the same error, which counts as two.
    times: f64,
}

impl Share {
    pub(super) fn covariance(&self, deviation: f64) -> Matrix3<f64> {
        let column = Vector3::from(self.moment * deviation);
        column * column.transpose() * self.times
    }
}

impl Contact {
    /// Of a contact that is beside where it was read by `foot`, over the link with the impulse `J`, of those that it has.
    pub(super) fn share(&self, foot: DVec3, J: DVec3) -> Share {
        let all = (self.J_before + self.J_after).length();
        let times = if J == DVec3::ZERO { 1.0 } else { all / J.length() };
        Share { moment: foot.cross(J), times }
    }

    /// Covariance of the moment over a link, whose contact has the noise `deviation`, m, by how far it may be beside where it was read.
    fn unsure(&self, J: DVec3, deviation: f64) -> Matrix3<f64> {
        let along = self.tangents().into_iter().take(self.freedoms());
        along.map(|tangent| self.share(tangent, J).covariance(deviation / self.samples.sqrt())).sum()
    }
}

/// What conditions tell of the moment over a link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Told {
    /// What it is off by, N m s, and the covariance that it would have without that.
    moment: DVec3,
    explained: Matrix3<f64>,
}

impl Told {
    /// By `value` deviations of a condition, each of which is a share of the moment.
    pub(super) fn add(&mut self, share: &Share, value: f64) {
        self.moment += share.moment * value;
        self.explained += share.covariance(1.0);
    }

    /// What the motion at the end of a link of duration `h` is off by.
    pub(super) fn at_end(&self, h: f64, turn: &Turn) -> Tangent {
        at_end(self.moment, h, turn)
    }
}

/// What the motion at the end of a link of duration `h` is off by for a moment's impulse that is: in the mean as if it had acted all the time.
pub(super) fn at_end(moment: DVec3, h: f64, turn: &Turn) -> Tangent {
    tangent(&[DVec3::ZERO, DVec3::ZERO, moment, turn.K * moment * (0.5 * h)])
}

impl Problem<'_> {
    /// Conditions of sample `k` at a motion there: gives their cost, and to `told` what they tell of the moment of `impulse`.
    pub(super) fn rows_cost(
        &self,
        k: usize,
        (motion, turn): (&Motion, &Turn),
        impulse: impl Fn(&Contact) -> DVec3,
        told: &mut Told,
    ) -> f64 {
        let noise = self.noise_at(k);
        let mut cost = 0.0;
        for contact in &self.record.contacts[k] {
            let Some(rows) = Rows::new(contact, motion, turn, &noise, self.friction) else { continue };
            cost += rows.cost();
            let J = self.shared(contact, &impulse);
            if J != DVec3::ZERO {
                rows.feet().for_each(|(foot, value)| told.add(&contact.share(foot, J), value));
            }
        }
        cost
    }

    /// The impulse by whose moment a contact is off as it is in its condition.
    pub(super) fn shared(&self, contact: &Contact, impulse: impl Fn(&Contact) -> DVec3) -> DVec3 {
        if self.shares { impulse(contact) } else { DVec3::ZERO }
    }

    /// What the conditions of the sample after a link tell of it.
    pub(super) fn feet_after<const P: usize>(
        &self,
        k: usize,
        motion: &Motion,
        body: &Body,
        mut visit: impl FnMut(Row<P>, Share),
    ) {
        let before = |contact: &Contact| self.shared(contact, |contact| contact.J_before);
        if self.record.contacts[k].iter().all(|contact| before(contact) == DVec3::ZERO) {
            return;
        }
        let turn = body.turn(motion.q, motion.L);
        self.rows(k, motion, &turn, body, |row, contact, foot| {
            visit(row, contact.share(foot, before(contact)))
        });
    }

    /// Noise of a link, of whose moment conditions tell that much.
    pub(super) fn link_noise(
        &self,
        noise: &WrenchNoise,
        (p, after): (DVec3, f64),
        told: &Told,
    ) -> Option<LinkNoise> {
        let mut noise = self.about(noise, p);
        let mut moment = noise.white.fixed_view_mut::<3, 3>(3, 3);
        moment -= told.explained;
        LinkNoise::new(&noise, after)
    }
}

/// Gives contacts the impulses after them by whose moments they are off, as their noise is counted in intervals.
pub(super) fn share(
    log: &ContactLog,
    intervals: &[Interval],
    sampled: &[bool],
    contacts: &mut [Vec<Contact>],
) {
    for (k, interval) in intervals.iter().enumerate() {
        let [now, after, ..] = &mut contacts[k..] else { return };
        for contact in now {
            let stays = after.iter().any(|other| other.palm == contact.palm);
            contact.J_after = match sampled[contact.palm] {
                true => contact.f * interval.h,
                false if stays => impulses::over(log, contact.palm, k + 1),
                false => DVec3::ZERO,
            };
        }
    }
}

impl Stage<'_> {
    /// With the error of a contact as one, in the plane. None where the equations are singular.
    pub(super) fn shared(mut self) -> Option<Self> {
        self.problem.shares = self.problem.planar && !self.problem.exact;
        if self.problem.shares { self.replaced(|problem, at| fine(problem, at.unknowns)) } else { Some(self) }
    }
}

impl Record {
    /// Of moments over its links the noise that the errors of contacts averaged over windows of `raw` make, in place of what those of its samples make from one
    /// node to the next: the mean of a window tells the sum of its errors, and what is left of them goes to the link after it.
    pub(super) fn share_errors(&mut self, raw: &Self, windows: &[Window]) {
        let deviation = self.deviation;
        let of_sample = |k: usize| -> Matrix3<f64> {
            raw.contacts[k].iter().map(|contact| contact.unsure(contact.J_after, deviation)).sum()
        };
        for (j, pair) in windows.windows(2).enumerate() {
            let [own, next] = [&self.contacts[j], &self.contacts[j + 1]];
            let removed = (pair[0].middle()..pair[1].middle()).map(of_sample).sum::<Matrix3<f64>>();
            let mut change = pair[0].own.clone().map(of_sample).sum::<Matrix3<f64>>() - removed;
            for contact in own {
                change += contact.unsure(contact.J_after, deviation)
                    - contact.unsure(contact.J_before + contact.J_after, deviation);
            }
            change +=
                next.iter().map(|contact| contact.unsure(contact.J_before, deviation)).sum::<Matrix3<f64>>();
            let mut moment = self.intervals[j].noise.white.fixed_view_mut::<3, 3>(3, 3);
            moment += change;
        }
    }
}
