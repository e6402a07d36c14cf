//! How forces at the contacts change the motion at the contacts: one linear system for any mode set.

use super::MOST_PALMS;
use super::solve::{Dense, Unsolvable};
use crate::ContactMode;
use glam::{DMat3, DVec2, DVec3};

/// One contact of a [`ContactProblem`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProblemContact {
    /// Palm normal into the object, world.
    pub(crate) n: DVec3,
    /// Tangent axes, world.
    pub(crate) t: [DVec3; 2],
    /// Contact point from the centre of mass, world, m.
    pub(crate) b: DVec3,
    /// Coefficient of friction.
    pub(crate) friction: f64,
    /// Rate of the slip without contact forces, m/s^2.
    pub(crate) free: DVec3,
    /// What the second rate of the gap has beside the normal part of the slip's rate: `n' . slip`.
    pub(crate) normal_bias: f64,
    /// How the palm gives way.
    pub(crate) yields: Yields,
}

/// How a palm gives way to the force on it: its acceleration at the contact, per unit of force.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Yields {
    /// Not at all.
    No,
    /// In every direction, by the inverse of its mass, 1/kg.
    All(f64),
    /// Along one lever `axis x (c - pivot)`, with the inverse of its moment of inertia.
    Along(DVec3, f64),
}

impl Yields {
    /// The part of a force that moves the palm, as a vector of its size.
    pub(crate) fn direction(self, force: DVec3) -> DVec3 {
        match self {
            Self::No => DVec3::ZERO,
            Self::All(_) => force,
            Self::Along(lever, _) => lever.try_normalize().map_or(DVec3::ZERO, |unit| unit * unit.dot(force)),
        }
    }

    /// The same in the palm's coordinates: those of a hinge stand in `x`.
    pub(crate) fn coordinates(self, force: DVec3) -> DVec3 {
        match self {
            Self::No => DVec3::ZERO,
            Self::All(inverse) => inverse * force,
            Self::Along(lever, inverse) => DVec3::X * (inverse * lever.dot(force)),
        }
    }

    pub(crate) fn acceleration(self, force: DVec3) -> DVec3 {
        match self {
            Self::No => DVec3::ZERO,
            Self::All(inverse) => inverse * force,
            Self::Along(lever, inverse) => lever * (inverse * lever.dot(force)),
        }
    }
}

/// Contacts of one body at one instant. With velocities in place of accelerations it is the problem of a blow.
#[derive(Clone, Debug)]
pub(crate) struct ContactProblem {
    pub(crate) inverse_mass: f64,
    /// Inverse of the inertia, world axes.
    pub(crate) K: DMat3,
    /// Centre of mass and angular acceleration without contact forces.
    pub(crate) free_motion: [DVec3; 2],
    contacts: [ProblemContact; MOST_PALMS],
    count: usize,
}

/// Forces that keep a mode set, and what they do. World axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reaction {
    /// Force of each palm on the body, N (N s for a blow).
    pub(crate) forces: [DVec3; MOST_PALMS],
    /// Acceleration of the centre of mass, m/s^2.
    pub(crate) a: DVec3,
    /// Angular acceleration, rad/s^2.
    pub(crate) alpha: DVec3,
    /// Whether no other forces keep the modes. Else squeezes between sticking contacts, which move nothing, are free.
    pub(crate) unique: bool,
    /// By how much the sticking contacts contradict each other, as a share of what they ask for.
    pub(crate) unmet: f64,
}

/// Sticking contacts agree as long as they contradict each other by less than this share.
pub(crate) const FULFILLED: f64 = 1e-6;

/// Mode and slip direction of each contact (unit tangent; of sliding contacts alone).
pub(crate) type Modes = [ContactMode; MOST_PALMS];
pub(crate) type Directions = [DVec2; MOST_PALMS];

impl ContactProblem {
    pub(crate) fn new(
        inverse_mass: f64,
        K: DMat3,
        free_motion: [DVec3; 2],
        contacts: &[ProblemContact],
    ) -> Self {
        let none = ProblemContact {
            n: DVec3::Z,
            t: [DVec3::X, DVec3::Y],
            b: DVec3::ZERO,
            friction: 0.0,
            free: DVec3::ZERO,
            normal_bias: 0.0,
            yields: Yields::No,
        };
        let mut all = [none; MOST_PALMS];
        all[..contacts.len()].copy_from_slice(contacts);
        Self { inverse_mass, K, free_motion, contacts: all, count: contacts.len() }
    }

    pub(crate) fn contacts(&self) -> &[ProblemContact] {
        &self.contacts[..self.count]
    }

    /// The same contacts with displacements or velocities `of` each in place of accelerations.
    pub(crate) fn of_motion(self, of: impl Fn(usize) -> DVec3) -> Self {
        self.after(0.0, of)
    }

    /// The same with velocities `of` each contact without impulses, after a time `h` of the body's free acceleration.
    pub(crate) fn after(mut self, h: f64, of: impl Fn(usize) -> DVec3) -> Self {
        self.free_motion = self.free_motion.map(|a| h * a);
        for (i, contact) in self.contacts[..self.count].iter_mut().enumerate() {
            (contact.free, contact.normal_bias) = (of(i), 0.0);
        }
        self
    }

    /// The same contacts without friction.
    pub(crate) fn smooth(mut self) -> Self {
        self.contacts.iter_mut().for_each(|contact| contact.friction = 0.0);
        self
    }

    /// Forces and accelerations of a mode set. Sliding contacts slide along `directions`.
    ///
    /// Rows: the normal's of a sliding contact, all three of a sticking one. Columns: `n - mu tau` of a sliding contact, all
    /// three axes of a sticking one.
    pub(crate) fn solve(&self, modes: &Modes, directions: &Directions) -> Result<Reaction, Unsolvable> {
        let mut system = Dense::default();
        let mut rows = [(0_usize, DVec3::ZERO); 3 * MOST_PALMS];
        let mut columns = [(0_usize, DVec3::ZERO); 3 * MOST_PALMS];
        let mut squeezes = [false; 3 * MOST_PALMS];
        let mut count = 0;
        for (i, contact) in self.contacts().iter().enumerate() {
            match modes[i] {
                ContactMode::Off => {}
                ContactMode::Slide => {
                    rows[count] = (i, contact.n);
                    columns[count] = (i, contact.sliding_force(directions[i]));
                    system.right[count] = -(contact.n.dot(contact.free) + contact.normal_bias);
                    count += 1;
                }
                ContactMode::Stick => {
                    for axis in [contact.n, contact.t[0], contact.t[1]] {
                        rows[count] = (i, axis);
                        columns[count] = (i, axis);
                        squeezes[count] = true;
                        system.right[count] = -axis.dot(contact.free);
                        count += 1;
                    }
                }
            }
        }
        for c in 0..count {
            let (j, force) = columns[c];
            for r in 0..count {
                let (i, e) = rows[r];
                system.matrix[r][c] = e.dot(self.moved_by(i, j, force));
            }
        }
        let solved = system.solve(count, &squeezes)?;
        let mut forces = [DVec3::ZERO; MOST_PALMS];
        for c in 0..count {
            forces[columns[c].0] += solved.x[c] * columns[c].1;
        }
        Ok(Reaction { unique: solved.unique, unmet: solved.unmet, ..self.reaction(forces) })
    }

    /// Accelerations under given forces.
    pub(crate) fn reaction(&self, forces: [DVec3; MOST_PALMS]) -> Reaction {
        let [mut a, mut alpha] = self.free_motion;
        for j in 0..self.count {
            let (da, dalpha) = self.by_force(j, forces[j]);
            a += da;
            alpha += dalpha;
        }
        Reaction { forces, a, alpha, unique: true, unmet: 0.0 }
    }

    /// What a force at contact `j` adds to the accelerations.
    fn by_force(&self, j: usize, force: DVec3) -> (DVec3, DVec3) {
        (self.inverse_mass * force, self.K * self.contacts[j].b.cross(force))
    }

    /// What a force at contact `j` adds to the rate of the slip at contact `i`.
    pub(crate) fn moved_by(&self, i: usize, j: usize, force: DVec3) -> DVec3 {
        let (a, alpha) = self.by_force(j, force);
        let contact = &self.contacts[i];
        let own = if i == j { contact.yields.acceleration(force) } else { DVec3::ZERO };
        a + alpha.cross(contact.b) + own
    }

    /// Rate of the slip at contact `i`, m/s^2.
    pub(crate) fn slip_rate(&self, i: usize, reaction: &Reaction) -> DVec3 {
        let contact = &self.contacts[i];
        let [a, alpha] = self.free_motion;
        contact.free
            + (reaction.a - a)
            + (reaction.alpha - alpha).cross(contact.b)
            + contact.yields.acceleration(reaction.forces[i])
    }

    /// Second rate of the gap at contact `i`, m/s^2.
    pub(crate) fn gap_acceleration(&self, i: usize, reaction: &Reaction) -> f64 {
        self.contacts[i].n.dot(self.slip_rate(i, reaction)) + self.contacts[i].normal_bias
    }

    /// How much of a unit normal force at each contact arrives at its own gap: a scale of accelerations per force.
    pub(crate) fn own_response(&self, i: usize) -> f64 {
        let contact = &self.contacts[i];
        let (a, alpha) = self.by_force(i, contact.n);
        contact.n.dot(a + alpha.cross(contact.b) + contact.yields.acceleration(contact.n))
    }

    /// The matrix of the sliding contacts' normal rows and columns, with sticking contacts eliminated; none where those
    /// cannot be.
    pub(crate) fn sliding_matrix(&self, modes: &Modes, directions: &Directions) -> Option<Vec<Vec<f64>>> {
        let sliding: Vec<usize> = (0..self.count).filter(|&i| modes[i] == ContactMode::Slide).collect();
        let mut others = *modes;
        for &i in &sliding {
            others[i] = ContactMode::Off;
        }
        let mut matrix = vec![vec![0.0; sliding.len()]; sliding.len()];
        for (c, &j) in sliding.iter().enumerate() {
            // A unit of force at contact j, and what the sticking ones answer to it alone.
            let force = self.contacts[j].sliding_force(directions[j]);
            let (a, alpha) = self.by_force(j, force);
            let mut alone = self.clone();
            alone.free_motion = [a, alpha];
            for i in 0..self.count {
                let own = if i == j { self.contacts[i].yields.acceleration(force) } else { DVec3::ZERO };
                alone.contacts[i].free = a + alpha.cross(self.contacts[i].b) + own;
                alone.contacts[i].normal_bias = 0.0;
            }
            let answer = alone.solve(&others, directions).ok()?;
            for (r, &i) in sliding.iter().enumerate() {
                matrix[r][c] = alone.gap_acceleration(i, &answer);
            }
        }
        Some(matrix)
    }
}

impl ProblemContact {
    /// Normal and tangents.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        [self.n, self.t[0], self.t[1]]
    }

    /// Force per unit of normal force while it slides along the unit tangent `tau`: `n - mu tau`.
    pub(crate) fn sliding_force(&self, tau: DVec2) -> DVec3 {
        self.n - self.friction * self.along_tangent(tau)
    }

    pub(crate) fn along_tangent(&self, x: DVec2) -> DVec3 {
        x.x * self.t[0] + x.y * self.t[1]
    }

    pub(crate) fn in_tangent(&self, x: DVec3) -> DVec2 {
        DVec2::new(self.t[0].dot(x), self.t[1].dot(x))
    }
}
