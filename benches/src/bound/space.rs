//! Three frictionless planes in space: `n . (v + w x (c - p)) = n . W x c` at each.

use super::{KNOWN, Linear, ROUNDING, Scales, UNKNOWN, covariance};
use glam::{DMat3, DVec3};
use nalgebra::{DMatrix, DVector};
use recon::object_dynamics::{Instant, MassProperties, SensorNoise};

/// Where centre of mass, velocity, turn, angular velocity (world axes), logarithm of the mass and inertia (body axes) stand.
const PLACE: usize = 0;
const VELOCITY: usize = 3;
const TURN: usize = 6;
const SPIN: usize = 9;
const MASS: usize = 12;
const INERTIA: usize = 13;
const OWN: usize = 19;
/// Of each palm both coordinates of the contact, and the force.
const EACH: usize = 3;
const READ: usize = 3 * EACH;
/// Entries of an inertia: xx, yy, zz, xy, xz, yz.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Root of the least mean square of the error of the centre of mass at the last sample, m, of a body of which mass and inertia are known or not, from
/// contacts and forces at all of them. None of fewer than two samples, and where the equations are singular in double precision.
#[must_use]
pub fn least_place(
    samples: &[Instant],
    mass: MassProperties,
    known: bool,
    noise: SensorNoise,
    scales: Scales,
) -> Option<f64> {
    let own = least(samples.iter(), mass, known, noise, scales)?;
    Some((0..3).map(|i| own[(i, i)]).sum::<f64>().sqrt())
}

/// Least deviations at the first sample from all of them, as the filter has them that runs back from the last one: centre of mass (m), velocity (m/s) and
/// angular velocity (rad/s), world axes; then of a known body how its axes lie (rad), of an unknown one its mass (kg) and principal moments
/// (kg m^2), to which it is the same at which sample its axes are those of the world.
#[must_use]
pub fn least_at_start(
    samples: &[Instant],
    mass: MassProperties,
    known: bool,
    noise: SensorNoise,
    scales: Scales,
) -> Option<Vec<f64>> {
    let own = least(samples.iter().rev(), mass, known, noise, scales)?;
    let root = |i: usize| own[(i, i)].max(0.0).sqrt();
    let motion = (PLACE..TURN).chain(SPIN..MASS).map(root);
    if known {
        return Some(motion.chain((TURN..SPIN).map(root)).collect());
    }
    let moment = |axis: DVec3| {
        let by_entry = DVector::from_iterator(
            ENTRIES.len(),
            ENTRIES.iter().map(|(i, j)| axis[*i] * axis[*j] * if i == j { 1.0 } else { 2.0 }),
        );
        let of_inertia = own.view((INERTIA, INERTIA), (ENTRIES.len(), ENTRIES.len()));
        by_entry.dot(&(of_inertia * &by_entry)).max(0.0).sqrt()
    };
    let axes = mass.principal().axes;
    let moments = DVec3::AXES.map(|axis| moment(axes * axis));
    Some(motion.chain([root(MASS) * mass.mass()]).chain(moments).collect())
}

/// Covariance of what is unknown at the last of some samples, from all of them.
fn least<'a>(
    samples: impl Iterator<Item = &'a Instant>,
    mass: MassProperties,
    known: bool,
    noise: SensorNoise,
    scales: Scales,
) -> Option<DMatrix<f64>> {
    let Scales { length, time } = scales;
    let speed = length / time;
    let moment = mass.mass() * length * length;
    let [turn, constant] = if known { [1.0, KNOWN / UNKNOWN] } else { [KNOWN / UNKNOWN, 1.0] };
    let before = DVector::from_fn(OWN, |i, _| {
        UNKNOWN
            * match i {
                PLACE..VELOCITY => length,
                VELOCITY..TURN => speed,
                // The axes of a body of which nothing is known are those of the world at one sample.
                TURN..SPIN => turn,
                SPIN..MASS => time.recip(),
                MASS => constant,
                _ => constant * moment,
            }
    });
    let read = DVector::from_fn(READ, |i, _| if i % EACH == 2 { noise.force } else { noise.contact });
    let told: Vec<Told> = samples.map(|at| Told { at, mass }).collect();
    covariance(&told, &before, &read, ROUNDING * speed)
}

/// A sample with what is true of the body.
struct Told<'a> {
    at: &'a Instant,
    mass: MassProperties,
}

impl Told<'_> {
    /// Contact, normal and the two directions in which the contact is measured, of a palm.
    fn touch(&self, palm: usize) -> [DVec3; 4] {
        let frame = self.at.palms[palm].frame;
        [self.at.touch.contacts[palm].p_WC, frame.n, frame.t1, frame.t2]
    }

    /// Angular velocity of a palm, rad/s.
    fn turning(&self, palm: usize) -> DVec3 {
        self.at.palms[palm].frame.t1 * self.at.palms[palm].rate
    }
}

/// Of `v x` as a matrix.
fn cross(v: DVec3) -> DMat3 {
    DMat3::from_cols(v.cross(DVec3::X), v.cross(DVec3::Y), v.cross(DVec3::Z))
}

fn put(into: &mut DMatrix<f64>, (row, column): (usize, usize), block: DMat3) {
    (0..3).for_each(|i| (0..3).for_each(|j| into[(row + i, column + j)] = block.col(j)[i]));
}

fn put_column(into: &mut DMatrix<f64>, (row, column): (usize, usize), v: DVec3) {
    (0..3).for_each(|i| into[(row + i, column)] = v[i]);
}

impl Linear for Told<'_> {
    fn time(&self) -> f64 {
        self.at.t
    }

    fn rates(&self) -> [DMatrix<f64>; 2] {
        let (mut by_own, mut by_read) = (DMatrix::zeros(OWN, OWN), DMatrix::zeros(OWN, READ));
        let (w, R_WO) = (self.at.w_WO, DMat3::from_quat(self.at.R_WO));
        let inertia = R_WO * self.mass.inertia() * R_WO.transpose();
        let inverse = R_WO * self.mass.inverse_inertia() * R_WO.transpose();
        let alpha = self.at.accelerations.alpha_WO;
        put(&mut by_own, (PLACE, VELOCITY), DMat3::IDENTITY);
        // Of `exp(turn) R`: its rate is that of the angular velocity, and turns with the body.
        put(&mut by_own, (TURN, SPIN), DMat3::IDENTITY);
        put(&mut by_own, (TURN, TURN), cross(w));
        // Of `J alpha + w x J w = moment`.
        put(&mut by_own, (SPIN, SPIN), inverse * (cross(inertia * w) - cross(w) * inertia));
        let by_inertia = |change: DMat3| -(inverse * (change * alpha + w.cross(change * w)));
        for axis in 0..3 {
            let turned = cross(DVec3::AXES[axis]);
            put_column(&mut by_own, (SPIN, TURN + axis), by_inertia(turned * inertia - inertia * turned));
        }
        for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
            let mut entry = DMat3::ZERO;
            (entry.col_mut(j)[i], entry.col_mut(i)[j]) = (1.0, 1.0);
            put_column(&mut by_own, (SPIN, INERTIA + k), by_inertia(R_WO * entry * R_WO.transpose()));
        }
        let mut force = DVec3::ZERO;
        let mut lean = DMat3::ZERO;
        for palm in 0..3 {
            let [c, n, t1, t2] = self.touch(palm);
            let (arm, pressed) = (c - self.at.touch.p_WCm, n * self.at.accelerations.forces[palm]);
            (force, lean) = (force + pressed, lean + cross(pressed));
            put_column(&mut by_read, (SPIN, EACH * palm), inverse * t1.cross(pressed));
            put_column(&mut by_read, (SPIN, EACH * palm + 1), inverse * t2.cross(pressed));
            put_column(&mut by_read, (SPIN, EACH * palm + 2), inverse * arm.cross(n));
            put_column(&mut by_read, (VELOCITY, EACH * palm + 2), n / self.mass.mass());
        }
        // Of the moment `(c - p) x f`.
        put(&mut by_own, (SPIN, PLACE), inverse * lean);
        put_column(&mut by_own, (VELOCITY, MASS), -force / self.mass.mass());
        [by_own, by_read]
    }

    fn openings(&self) -> [DMatrix<f64>; 2] {
        let (mut by_own, mut by_read) = (DMatrix::zeros(3, OWN), DMatrix::zeros(3, READ));
        for palm in 0..3 {
            let [c, n, t1, t2] = self.touch(palm);
            let (w, arm) = (self.at.w_WO, c - self.at.touch.p_WCm);
            let against = w - self.turning(palm);
            for (at, by) in [(PLACE, w.cross(n)), (VELOCITY, n), (SPIN, arm.cross(n))] {
                (0..3).for_each(|i| by_own[(palm, at + i)] = by[i]);
            }
            by_read[(palm, EACH * palm)] = n.dot(against.cross(t1));
            by_read[(palm, EACH * palm + 1)] = n.dot(against.cross(t2));
        }
        [by_own, by_read]
    }
}

#[cfg(test)]
mod tests;
