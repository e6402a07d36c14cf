//! What a log departs from rigid bodies by itself.

use super::log::{Anything, Contact, Log};
use glam::{DMat3, DVec3};

/// What a log departs from a rigid motion by until a sample, m.
#[derive(Clone, Copy, Default)]
pub(super) struct Own {
    /// By its residuals of Newton and Euler, integrated twice, at the most distant contact.
    pub(super) laws: f64,
    /// By what its forces at sliding contacts are off Coulomb's law, in the same way.
    pub(super) coulomb: f64,
    /// By the creep of sticking contacts and the depth of all.
    pub(super) softness: f64,
}

/// A force and a moment that should not be there, integrated twice.
#[derive(Default)]
struct Twice {
    rates: [DVec3; 2],
    shifts: [DVec3; 2],
}

impl Twice {
    /// Adds accelerations over a step; what they come to at a lever, m.
    fn add(&mut self, accelerations: [DVec3; 2], h: f64, lever: f64) -> f64 {
        for (i, a) in accelerations.into_iter().enumerate() {
            self.shifts[i] += h * self.rates[i] + 0.5 * h * h * a;
            self.rates[i] += h * a;
        }
        self.shifts[0].length() + lever * self.shifts[1].length()
    }
}

/// At each of the first `count` samples, the largest until there.
pub(super) fn own_departures(log: &Log, count: usize) -> Anything<Vec<Own>> {
    let (t, bodies) = (log.column("t")?, log.bodies(count)?);
    let ((mass, inertia), gravity) = (log.mass(), log.gravity());
    let (a, alpha) = (log.vectors("a", "")?, log.vectors("al", "")?);
    let palms = (1..=log.palm_count()).map(|i| log.contact(i)).collect::<Anything<Vec<_>>>()?;
    let (mut laws, mut coulomb) = (Twice::default(), Twice::default());
    let mut creeps = vec![0.0; palms.len()];
    let (mut now, mut all) = (Own::default(), Vec::with_capacity(count));
    for k in 0..count {
        let (body, h) = (&bodies[k], t[(k + 1).min(count - 1)] - t[k]);
        let R = DMat3::from_quat(body.R_WO);
        let I = R * inertia * R.transpose();
        let (mut force, mut moment, mut off, mut twist, mut lever) =
            (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, 0.0_f64);
        for (palm, crept) in palms.iter().zip(&mut creeps).filter(|(palm, _)| palm.mode[k] > 0.5) {
            let b = palm.p[k] - body.p_WCm;
            let missing = off_coulomb(palm, k, body.v_WCm + body.w_WO.cross(b));
            (force, moment) = (force + palm.f[k], moment + b.cross(palm.f[k]));
            (off, twist) = (off + missing, twist + b.cross(missing));
            lever = lever.max(b.length());
            now.softness = now.softness.max(*crept + palm.gap[k].abs());
            *crept += if palm.mode[k] > 1.5 { h * palm.slip[k] } else { 0.0 };
        }
        all.push(now);
        let newton = a[k] + gravity * DVec3::Z - force / mass;
        let w = body.w_WO;
        let euler = alpha[k] - I.inverse() * (moment - w.cross(I * w));
        now.laws = now.laws.max(laws.add([newton, euler], h, lever));
        now.coulomb = now.coulomb.max(coulomb.add([off / mass, I.inverse() * twist], h, lever));
    }
    Ok(all)
}

/// What is too much in the force of a contact that slides, for a velocity of the body's material there.
fn off_coulomb(palm: &Contact, k: usize, v: DVec3) -> DVec3 {
    let n = palm.n[k];
    let slip = (v - palm.v[k]).reject_from_normalized(n);
    if palm.mode[k] > 1.5 {
        return DVec3::ZERO;
    }
    let along = palm.f[k].dot(n);
    palm.f[k] - along * n + palm.friction * along * slip.normalize_or_zero()
}
