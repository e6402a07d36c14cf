//! Noise of the sensors from the roughness of their own readings.

use super::both::both;
use super::noise::{ContactNoiseLevel, ImpulseNoise};
use super::options::ContactOptions;
use super::problem::Units;
use crate::roughness::{Rough, SensedAlong};
use glam::{DQuat, DVec3};
use object_dynamics::{ContactLog, LoggedPalm, SensedAxes, SensedForce};

/// Creep as a share of the natural speed `sqrt(g l)`.
const CREEP: f64 = 3e-5;

impl ContactOptions {
    /// How many times as noisy as stated contacts and forces of a log are, where they are by more than chance makes: those of taxels, of a sensor that is
    /// worse than its sheet. Else 1.
    pub(super) fn rougher(&self, log: &ContactLog) -> [f64; 2] {
        let stated = self.noise;
        let contacts = || contacts(log, self.planar).over(|_| stated.contact).beyond_chance();
        let forces = || {
            let forces = forces(log, self.planar, LoggedPalm::force);
            forces.over(|f| stated.force(DVec3::X * f)).beyond_chance()
        };
        let (contacts, forces) = both(log.times().len(), contacts, forces);
        [contacts, forces].map(|rough| rough.unwrap_or(1.0))
    }

    /// With contacts and forces so many times as noisy, and how many: where noise is not what conditions are off by it counts as stated.
    pub(super) fn roughened(&self, times: [f64; 2], units: &Units) -> (Self, [f64; 2]) {
        let times = if self.noise.times(times).limits(units) { times } else { [1.0; 2] };
        (Self { noise: self.noise.times(times), ..*self }, times)
    }
}

impl ContactNoiseLevel {
    /// What contact conditions are taken to be off by at first where it is not known, m/s, under `gravity`, m/s^2, of a body of the size `length`,
    /// m: that by which contacts creep that stick in simulators.
    #[must_use]
    pub fn guessed_floor(gravity: f64, length: f64) -> f64 {
        CREEP * (gravity * length).sqrt()
    }

    /// The same of a body of the size `length`, m, or else of that of the contacts of a log. None where no two palms are touched at once and no size
    /// is stated.
    #[must_use]
    pub fn floor_of_log(log: &ContactLog, gravity: f64, length: Option<f64>) -> Option<f64> {
        Some(Self::guessed_floor(gravity, length.or_else(|| spread(log))?))
    }

    /// By the roughness of the readings of a log under `gravity`, m/s^2, with a guess of what conditions are off by, of a body of the size `length`,
    /// m, or else of that of its contacts. None where no two palms are touched at once and no size is stated.
    #[must_use]
    pub fn guessed(log: &ContactLog, gravity: f64, length: Option<f64>) -> Option<Self> {
        Some(Self::by_roughness(log, Self::floor_of_log(log, gravity, length)?, false))
    }

    /// Standard deviations of the white noise of a log's contacts, forces and impulses, by what of some readings in a row no polynomial explains.
    ///
    /// The median of it is blind to outliers and to changes of contact modes. A sensor that counts in steps has the noise of these at
    /// least. The noise of forces and impulses may grow with them. What of a smooth motion is rough between samples counts as noise.
    /// `floor` (m/s) is taken as it is. In a log of the plane of x and z nothing is felt along y.
    #[must_use]
    pub fn by_roughness(log: &ContactLog, floor: f64, planar: bool) -> Self {
        let pressed = || [LoggedPalm::force, LoggedPalm::impulse].map(|read| forces(log, planar, read));
        let ([forces, impulses], contact) =
            both(log.times().len(), pressed, || contacts(log, planar).deviation());
        let [force_fixed, force_share] = forces.growing();
        let [fixed, share] = impulses.growing();
        let impulse = (!impulses.least().is_empty()).then_some(ImpulseNoise { fixed, share });
        Self { contact, force_fixed, force_share, impulse, floor }
    }
}

/// What is rough about contact points as they are read: in the palms' own axes.
fn contacts(log: &ContactLog, planar: bool) -> Rough {
    let mut rough = Rough::default();
    for palm in log.palms() {
        let point = |k| Some(own(palm, k) * (palm.touch(k)?.p_WC - palm.motion(k).pose.p_WP));
        let tangents = |k| match planar {
            true => [own(palm, k) * normal(palm, k).cross(DVec3::Y)].into(),
            false => <[DVec3; 2]>::from((own(palm, k) * normal(palm, k)).any_orthonormal_pair()).into(),
        };
        rough.add(log.times(), point, tangents);
    }
    rough
}

/// What is rough about forces or impulses as they are read: in the palms' own axes.
fn forces(log: &ContactLog, planar: bool, read: impl Fn(&LoggedPalm, usize) -> Option<SensedForce>) -> Rough {
    let mut rough = Rough::default();
    for palm in log.palms() {
        let touched = |k: usize| read(palm, k).filter(|_| palm.touch(k).is_some());
        let axes = (0..log.times().len()).find_map(touched).map(|force| force.axes);
        let all = |k: usize| touched(k).map(|force| force.vector);
        // Without friction a force is along the normal, and across it nothing is rough.
        if axes == Some(SensedAxes::Three) && palm.friction() != Some(0.0) {
            let everywhere: SensedAlong =
                if planar { [DVec3::X, DVec3::Z].into() } else { DVec3::AXES.into() };
            rough.add(log.times(), |k| Some(own(palm, k) * all(k)?), |_| everywhere);
        } else {
            let along = |k: usize| Some(DVec3::X * all(k)?.dot(normal(palm, k)));
            rough.add(log.times(), along, |_| [DVec3::X].into());
        }
    }
    rough
}

/// To the palm's own axes.
fn own(palm: &LoggedPalm, k: usize) -> DQuat {
    palm.motion(k).pose.R_WP.inverse()
}

fn normal(palm: &LoggedPalm, k: usize) -> DVec3 {
    palm.touch(k).map_or(DVec3::Z, |touch| touch.n.get())
}

/// Root mean square of the distance of contacts from the mean of those at the same time, m: about the size of the object. None
/// where no two are touched at once.
fn spread(log: &ContactLog) -> Option<f64> {
    let (mut squares, mut count) = (0.0, 0.0);
    for k in 0..log.times().len() {
        let contacts: Vec<DVec3> = log.palms().iter().filter_map(|palm| Some(palm.touch(k)?.p_WC)).collect();
        if contacts.len() > 1 {
            let mean = contacts.iter().sum::<DVec3>() / contacts.len() as f64;
            squares += contacts.iter().map(|c| c.distance_squared(mean)).sum::<f64>();
            count += contacts.len() as f64;
        }
    }
    (squares > 0.0).then(|| f64::sqrt(squares / count))
}
