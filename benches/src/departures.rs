//! What a simulation with friction must keep to, and by how much it does not.

use recon::contact_kinematics::Ellipsoid;
use recon::object_dynamics::{ContactInstant, ContactMode, ContactScene, ContactSimulation};

/// Largest departures over a run from what must hold.
#[derive(Clone, Copy, Debug, Default)]
pub struct Departures {
    /// Overlap, or gap in contact, m.
    pub gap: f64,
    /// Force beyond its cone, N.
    pub cone: f64,
    /// Slip of a sticking contact, m/s.
    pub creep: f64,
    /// Energy not accounted for, J.
    pub energy: f64,
}

impl Departures {
    /// Of a run; nothing of one without samples.
    #[must_use]
    pub fn of(scene: &ContactScene<Ellipsoid>, run: &ContactSimulation) -> Self {
        let mut worst = Self::default();
        // Less what forces and blows have done so far: the first of them may come before the first sample.
        let left = |now: &ContactInstant| {
            scene.energy(&now.state.body) - now.friction_work - now.palm_work - now.blow_work
        };
        let Some(first) = run.instants.first().map(left) else { return worst };
        for now in &run.instants {
            for (i, mode) in now.modes.iter().take(scene.palms().len()).enumerate() {
                worst = worst.or(of_contact(scene, now, i, *mode));
            }
            worst.energy = worst.energy.max((left(now) - first).abs());
        }
        worst
    }

    /// The larger ones.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            gap: self.gap.max(other.gap),
            cone: self.cone.max(other.cone),
            creep: self.creep.max(other.creep),
            energy: self.energy.max(other.energy),
        }
    }
}

fn of_contact(
    scene: &ContactScene<Ellipsoid>,
    now: &ContactInstant,
    i: usize,
    mode: ContactMode,
) -> Departures {
    let (contact, force) = (&now.contacts[i], now.forces[i]);
    let normal = contact.n.dot(force);
    let cone = contact.in_tangent(force).length() - scene.palms()[i].friction * normal;
    Departures {
        gap: if mode == ContactMode::Off { -contact.gap } else { contact.gap.abs() },
        cone: cone.max(-normal),
        creep: if mode == ContactMode::Stick { now.rates[i].slip.length() } else { 0.0 },
        energy: 0.0,
    }
}
