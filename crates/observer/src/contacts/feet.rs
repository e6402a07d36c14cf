//! Errors of contacts as their conditions tell them, taken out of the moments that they are in.
//!
//! A contact that is read beside where it is by `e` is off in its condition by `z e`, of the spin `z` against the palm, and the moment of the impulse `J`
//! through it is off by `e x J`: one error, and not two. What a condition says of `e` (its foot) is taken out of the moment, and a link is as
//! much better as that is known.

use super::equations::{Row, Split};
use super::link::LinkNoise;
use super::noise::WrenchNoise;
use super::problem::Problem;
use super::record::Contact;
use super::rows::Rows;
use super::state::{Motion, Tangent, Turn, tangent};
use glam::DVec3;
use nalgebra::Matrix3;

/// A condition that tells of a contact by which the moment over a link is off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot<const P: usize> {
    /// The condition in its deviation, by the motions at both ends of the link and the body, and its value.
    pub(super) row: Split<P>,
    pub(super) value: f64,
    /// What the motion at the end of the link is off by for each of its deviations.
    pub(super) by: Tangent,
}

/// What conditions tell of the moment over a link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Told {
    /// What it is off by, N m s, and the covariance that it would have without that.
    moment: DVec3,
    explained: Matrix3<f64>,
}

impl Told {
    /// By `value` deviations of a condition, each of which is `by` of the moment.
    pub(super) fn add(&mut self, by: DVec3, value: f64) {
        self.moment += by * value;
        let column = nalgebra::Vector3::from(by);
        self.explained.ger(1.0, &column, &column, 1.0);
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
                rows.feet().for_each(|(foot, value)| told.add(foot.cross(J), value));
            }
        }
        cost
    }

    /// The impulse by whose moment a contact is off as it is in its condition.
    pub(super) fn shared(&self, contact: &Contact, impulse: impl Fn(&Contact) -> DVec3) -> DVec3 {
        if self.exact { DVec3::ZERO } else { impulse(contact) }
    }

    /// What the conditions of the sample after a link tell of it.
    pub(super) fn feet_after<const P: usize>(
        &self,
        k: usize,
        motion: &Motion,
        body: &super::body::Body,
        mut visit: impl FnMut(Row<P>, DVec3),
    ) {
        let before = |contact: &Contact| self.shared(contact, |contact| contact.J_before);
        if self.record.contacts[k].iter().all(|contact| before(contact) == DVec3::ZERO) {
            return;
        }
        let turn = body.turn(motion.q, motion.L);
        self.rows(k, motion, &turn, body, |row, contact, foot| visit(row, foot.cross(before(contact))));
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
