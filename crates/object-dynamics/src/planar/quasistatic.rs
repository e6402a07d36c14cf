//! Quasistatic equilibria of an object between two palms: where the centre of mass is lowest.

use contact_kinematics::planar::{PairContact, PalmPair, RadiusFunction};
use thiserror::Error;

/// Grid on which all equilibria are looked for; a pair closer than one cell (0.6 degrees) is missed.
const GRID: u32 = 600;
/// Newton steps allowed from one pair of palms to the next; quadratic convergence needs five.
const NEWTON_STEPS: u32 = 20;
/// Newton's last step in rad: convergence is quadratic, so the error after it is far below rounding; the torque balance
/// itself is only known to 1e-17 m, which limits the step to 1e-13 where the stability is 1e-4 m.
const SETTLED_STEP: f64 = 1e-12;
/// Largest Newton step in rad: a longer one has left the branch.
const LONGEST_STEP: f64 = 0.3;

/// An orientation at which forces and torque balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Orientation in rad.
    pub phi0: f64,
    /// `(rho_1 - r_1) sin P_2 + (rho_2 - r_2) sin P_1` in m: positive where the equilibrium is stable, zero at a fold.
    pub stability: f64,
    /// Contacts.
    pub contact: PairContact,
}

/// Why a branch of equilibria cannot be followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FollowError {
    /// The stable branch ends in a fold: the object would jump.
    #[error(
        "stable branch ends before palm pair {index}: stability fell to {stability:.3e} m at orientation {phi0:.4} rad"
    )]
    Fold {
        /// Index of the first pair of palms without this branch.
        index: usize,
        /// Last stability seen, m.
        stability: f64,
        /// Orientation in rad.
        phi0: f64,
    },
}

/// Equilibria of one shape.
#[derive(Clone, Copy, Debug)]
pub struct PlanarEquilibria<S> {
    shape: S,
}

impl<S: RadiusFunction> PlanarEquilibria<S> {
    /// For a shape about its centre of mass; mass and inertia do not matter.
    pub fn new(shape: S) -> Self {
        Self { shape }
    }

    /// Torque balance `d_1 sin P_2 + d_2 sin P_1` (m) and contacts at an orientation.
    fn balance(&self, palms: &PalmPair, phi0: f64) -> (f64, Equilibrium) {
        let contact = PairContact::new(&self.shape, palms, phi0);
        let [j1, j2] = contact.jets;
        let [sin1, sin2] = palms.angles().map(f64::sin);
        let stability = (j1.rho - j1.r) * sin2 + (j2.rho - j2.r) * sin1;
        (j1.d * sin2 + j2.d * sin1, Equilibrium { phi0, stability, contact })
    }

    /// All equilibria between given palms, stable and not, in `[0, 2 pi)`.
    #[must_use]
    pub fn all(&self, palms: &PalmPair) -> Vec<Equilibrium> {
        let step = std::f64::consts::TAU / f64::from(GRID);
        let value = |phi0: f64| self.balance(palms, phi0).0;
        (0..GRID)
            .map(|i| (f64::from(i) * step, f64::from(i + 1) * step))
            .filter(|&(a, b)| (value(a) < 0.0) != (value(b) < 0.0))
            .filter_map(|(a, b)| crate::integrate::find_root(value, a, b, 1e-15).ok())
            .map(|phi0| self.balance(palms, phi0).1)
            .collect()
    }

    /// The stable equilibrium nearest to `phi0` for each pair of palms in turn.
    ///
    /// # Errors
    /// [`FollowError::Fold`] at the first pair for which the branch is gone.
    pub fn follow(&self, palms: &[PalmPair], mut phi0: f64) -> Result<Vec<Equilibrium>, FollowError> {
        let mut path = Vec::with_capacity(palms.len());
        for (index, pair) in palms.iter().enumerate() {
            let equilibrium = self.nearest(pair, phi0).map_err(|last| FollowError::Fold {
                index,
                stability: last.stability,
                phi0: last.phi0,
            })?;
            phi0 = equilibrium.phi0;
            path.push(equilibrium);
        }
        Ok(path)
    }

    /// Newton's method on the torque balance; the last iterate when it leaves the stable branch.
    fn nearest(&self, palms: &PalmPair, mut phi0: f64) -> Result<Equilibrium, Equilibrium> {
        for _ in 0..NEWTON_STEPS {
            let (balance, here) = self.balance(palms, phi0);
            // d(balance)/d(phi0) is the stability itself; the test also keeps it from being divided by at zero.
            if here.stability.is_nan() || here.stability <= 0.0 {
                return Err(here);
            }
            let step = balance / here.stability;
            if step.abs() > LONGEST_STEP {
                return Err(here);
            }
            phi0 -= step;
            if step.abs() <= SETTLED_STEP {
                return Ok(self.balance(palms, phi0).1);
            }
        }
        Err(self.balance(palms, phi0).1)
    }
}
