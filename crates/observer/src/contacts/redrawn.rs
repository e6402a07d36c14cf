//! How far an estimate is from what a linear model makes of it: solutions of the same log with its noise drawn once more.
//!
//! Where little is known of a body the most probable motion lies on a curved valley, and noise carries it along that farther than the slopes at
//! the end of it say, by several of the deviations that they make. How far fresh noise of the same size carries the solution from where it is
//! tells: where the model is linear as far as its deviations claim, elsewhere farther. Deviations are widened by that (the randomised optimisation
//! of Bardsley and others, 2014, without its weights).

use super::body::CONSTANTS;
use super::feet::Share;
use super::problem::{Problem, Unknowns};
use super::record::{Contact, Interval, Record, Wrench};
use super::samples::at_nodes;
use super::solve::{Covariances, Solved, solve};
use crate::random::Normal;
use contact_kinematics::at_once;
use glam::DVec3;
use nalgebra::{Matrix3, SVector, Vector6};

/// Deviations of logarithms of constants, and of turns in rad, up to which nothing is looked at: what is beyond first order adds a hundredth to a
/// variance there.
pub(super) const SMALL: f64 = 0.02;
/// How often noise is drawn for what is reported of a whole log, and for what is asked on the way.
pub(super) const DRAWS: usize = 12;
pub(super) const FEW_DRAWS: usize = 4;
/// The same where there is friction, or blows: nearly each sample has a node then, and a solution takes long.
const DRAWS_OF_MANY_NODES: usize = 6;
const SEED: u64 = 0x2d0;
/// How much noise is drawn, of what there is: a part of it, as that which was there already has carried a body along a valley.
const AMOUNT: f64 = 0.7;
/// Linearisations of each solution, and what a step of it promises in units of chi-squared.
pub(super) const SOLVED: (usize, f64) = (20, 0.05);
/// Share of the trace of a covariance that is added to each of its variances, so that it has a factor.
const RIDGE: f64 = 1e-9;

impl Covariances<CONSTANTS> {
    /// Widened to what solutions with noise drawn so often spread by, where that is farther than deviations say.
    pub(super) fn redrawn(mut self, problem: &Problem, solved: &Solved<CONSTANTS>, draws: usize) -> Self {
        if self.body.diagonal().max() < SMALL * SMALL {
            return self;
        }
        let many = !problem.record.frictionless() || problem.record.has_blows();
        let draws = if many { draws.min(DRAWS_OF_MANY_NODES) } else { draws };
        let mut random = Normal::seeded(SEED);
        let one = |record: &Record| {
            let drawn = problem.on(record);
            let found = solve::<CONSTANTS>(&drawn, solved.unknowns.clone(), SOLVED.0, SOLVED.1)?.unknowns;
            Some(Unknowns { motions: drawn.at_samples(&found), ..found })
        };
        // Two at a time.
        let mut all: Vec<Unknowns> = Vec::with_capacity(draws);
        for _ in 0..draws / 2 {
            let [a, b] = std::array::from_fn(|_| problem.record.redrawn(problem, &mut random));
            let (a, b) = at_once(|| one(&a), || one(&b));
            all.extend([a, b].into_iter().flatten());
        }
        let own = &Unknowns { motions: problem.at_samples(&solved.unknowns), ..solved.unknowns.clone() };
        let mean = |of: &dyn Fn(&Unknowns) -> f64| all.iter().map(of).sum::<f64>() / all.len().max(1) as f64;
        let wider = SVector::<f64, CONSTANTS>::from_fn(|i, _| {
            let spread = mean(&|at| at.body.from(&own.body)[i].powi(2));
            (spread / (AMOUNT * AMOUNT) / self.body[(i, i)].max(f64::MIN_POSITIVE)).max(1.0).sqrt()
        });
        self.widen_body(&wider);
        let known = at_nodes(&own.motions, &own.body, &self);
        let beyond = |(j, known): (usize, &[DVec3; 4])| {
            let spread = |i: usize| mean(&|at| (departure(own, at, j)[i] / known[i]).length_squared());
            std::array::from_fn(|i| (spread(i) / (3.0 * AMOUNT * AMOUNT)).max(1.0).sqrt())
        };
        self.beyond = known.iter().enumerate().map(beyond).collect();
        self
    }
}

/// Centre of mass, velocity, angular velocity and turn of node `j` at some unknowns, from those at others.
pub(super) fn departure(from: &Unknowns, to: &Unknowns, j: usize) -> [DVec3; 4] {
    let (a, b) = (&from.motions[j], &to.motions[j]);
    let step = b.from(a);
    let spin = to.body.spin(b.q, b.L) - from.body.spin(a.q, a.L);
    [b.p - a.p, b.v - a.v, spin, DVec3::new(step[9], step[10], step[11])]
}

impl Record {
    /// With as much of its noise drawn once more.
    fn redrawn(&self, problem: &Problem, random: &mut Normal) -> Self {
        let mut record = self.clone();
        // A contact that is off is so in its condition and in the moments of impulses.
        let mut moments = vec![Shared::default(); self.intervals.len() + 1];
        for (k, contact) in
            record.contacts.iter_mut().enumerate().flat_map(|(k, of)| of.iter_mut().map(move |c| (k, c)))
        {
            let before = k.checked_sub(1).map(|before| (before, contact.J_before));
            let impulses = before.into_iter().chain([(k, contact.J_after)]);
            for (tangent, deviation) in contact.redraw(problem, random) {
                for (k, J) in impulses.clone() {
                    moments[k].add(
                        &contact.share(tangent, J),
                        deviation,
                        problem.noise.contact / contact.samples.sqrt(),
                    );
                }
            }
        }
        // What a blow does is open, unless it was measured.
        let open = |interval: &Interval| interval.blow && !self.all_impulses;
        let one = |(interval, shared): (&Interval, &Shared)| match open(interval) {
            true => Wrench::default(),
            false => interval.redrawn(shared, random),
        };
        let drawn: Vec<Wrench> = self.intervals.iter().zip(&moments).map(one).collect();
        // What the sample at the start of an interval has of its noise is felt in the one before it.
        let shares = problem.shares_of_samples();
        for (k, interval) in record.intervals.iter_mut().enumerate() {
            let next = drawn.get(k + 1).map_or(Wrench::default(), |next| *next * shares[k + 1]);
            let noise = drawn[k] * (1.0 - shares[k]) + next;
            interval.impulse = interval.impulse + noise;
            interval.first += noise.force * (0.5 * interval.h);
        }
        record
    }
}

/// What contacts do to the moment over an interval: what was drawn of it, and its covariance.
#[derive(Clone, Copy, Default)]
struct Shared {
    moment: DVec3,
    covariance: Matrix3<f64>,
}

impl Shared {
    fn add(&mut self, by: &Share, drawn: f64, deviation: f64) {
        self.moment += by.moment * drawn;
        self.covariance += by.covariance(deviation);
    }
}

impl Contact {
    /// Gives how far it moves along each of its tangents, m.
    fn redraw(&mut self, problem: &Problem, random: &mut Normal) -> Vec<(DVec3, f64)> {
        let deviation = AMOUNT * problem.noise.contact / self.samples.sqrt();
        let along = self.tangents().into_iter().take(self.freedoms());
        let moves: Vec<_> = along.map(|tangent| (tangent, deviation * random.draw())).collect();
        let moved = moves.iter().map(|(tangent, by)| *tangent * *by).sum::<DVec3>();
        self.c += moved;
        // Of the palm's material that is there then.
        self.u += self.W.cross(moved) + self.n * (AMOUNT * self.floor(problem.noise.floor) * random.draw());
        moves
    }
}

impl Interval {
    /// Noise of the impulse, with that of the moment which contacts make.
    fn redrawn(&self, shared: &Shared, random: &mut Normal) -> Wrench {
        let mut white = self.noise.white;
        let mut moment = white.fixed_view_mut::<3, 3>(3, 3);
        moment -= shared.covariance;
        white *= AMOUNT * AMOUNT;
        let ridge = RIDGE * white.trace();
        (0..6).for_each(|i| white[(i, i)] += ridge);
        let Some(factor) = white.cholesky() else { return Wrench::default() };
        let drawn = factor.l() * Vector6::from_fn(|_, _| random.draw());
        Wrench {
            force: DVec3::new(drawn[0], drawn[1], drawn[2]),
            moment: DVec3::new(drawn[3], drawn[4], drawn[5]) + shared.moment,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{G, SIZE, modes, noise, noisy, options, rubbed};
    use super::super::{cold, search};
    use super::*;

    /// Chi-squared of a solution with noise drawn once more is as much larger as its variance is: noise of samples is felt in the intervals before and
    /// after them, and drawn for each interval by itself it is 6.2 in place of 0.5.
    #[test]
    fn noise_drawn_once_more_is_what_conditions_and_links_take_it_for() {
        let noise = noise(2e-4, 0.02);
        let exact = rubbed(0.4, 300.0, 0.1);
        let log = noisy(&exact, &noise, 5).split_truth().0;
        let options = options(noise);
        let mut record = Record::new(&log, &options).unwrap();
        record.set_modes(&modes(&exact));
        let mut problem = search::problem(&record, &options, cold::units(&record, G, SIZE));
        let solved = search::search(&mut problem).unwrap().solved;
        let mut random = Normal::seeded(2);
        let draws = 3;
        let mut added = 0.0;
        for _ in 0..draws {
            let record = record.redrawn(&problem, &mut random);
            let drawn = problem.on(&record);
            let found = solve::<CONSTANTS>(&drawn, solved.unknowns.clone(), SOLVED.0, SOLVED.1).unwrap();
            added += (found.misfit() - solved.misfit()) / f64::from(draws);
        }
        // Deviation of the mean of so many conditions, whose residuals have both noises.
        let conditions = f64::from(draws) * solved.equations.conditions as f64;
        let scatter = (2.0 * (AMOUNT.powi(4) + 2.0 * AMOUNT.powi(2)) / conditions).sqrt();
        assert!((added - AMOUNT * AMOUNT).abs() < 4.0 * scatter, "{added} {scatter} {conditions}");
    }
}
