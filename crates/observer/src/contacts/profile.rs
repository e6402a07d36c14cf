//! How far motions that are nearly as probable are from the most probable one.

use super::body::CONSTANTS;
use super::equations::Gradient;
use super::problem::{Pin, Problem};
use super::samples::deviations;
use super::solve::{Covariances, Solved, solve};
use super::redrawn::departure;
use super::state::Tangent;
use nalgebra::SVector;
use glam::DVec3;

const SPIN: usize = 7;
const HELD: f64 = 1e4;
const MOST: usize = 20;
const ENOUGH: f64 = 0.05;

impl Covariances<CONSTANTS> {
    pub(super) fn profiled(mut self, problem: &mut Problem, solved: &Solved<CONSTANTS>) -> Self {
        let Ok(far) = std::env::var("PROFILE") else { return self };
        let far: Vec<f64> = far.split(',').map(|x| x.parse().unwrap()).collect();
        let own = &solved.unknowns;
        let last = own.motions.len() - 1;
        let known: Vec<_> = (0..=last).map(|j| deviations(&own.motions[j], &own.body, j, &self)).collect();
        self.beyond.resize(last + 1, [1.0; 4]);
        let mut all = vec![[1.0_f64; 4]; last + 1];
        for node in [0, last] {
            let mut pull = Gradient { motions: vec![Tangent::zeros(); last + 1], body: SVector::zeros() };
            pull.motions[node][SPIN] = -1.0;
            let step = self.chain.step(&pull);
            let variance = step.motions[node][SPIN].max(f64::MIN_POSITIVE);
            for off in &far {
                let scaled = step.scaled(off / variance.sqrt());
                let Some(start) = problem.trial(own, &scaled, &solved.equations) else { continue };
                let momentum = own.motions[node].L.y + off * variance.sqrt();
                problem.pinned = Some(Pin { node, momentum, information: HELD / variance });
                let found = solve::<CONSTANTS>(problem, start.unknowns, MOST, ENOUGH);
                let pin = problem.pinned.take();
                let (Some(found), Some(pin)) = (found, pin) else { continue };
                let cost = problem.trial_cost(&found.unknowns, pin, found.equations.cost) - solved.equations.cost;
                let allowed = (cost.max(0.0) + 1.0).sqrt();
                let mut most = 0.0_f64;
                for (j, known) in known.iter().enumerate() {
                    let away = departure(own, &found.unknowns, j);
                    for i in 0..4 {
                        let axes = [DVec3::X, DVec3::Z, DVec3::Y];
                        let wider = axes.iter().filter(|axis| known[i].dot(**axis) > 0.0 && (i < 2) == (axis.y == 0.0)).map(|axis| (away[i].dot(*axis) / known[i].dot(*axis)).abs() / allowed).fold(0.0, f64::max);
                        most = most.max(wider);
                        all[j][i] = all[j][i].max(wider);
                    }
                }
                if std::env::var("P37").is_ok() { eprintln!("profile node {node} off {off} cost {cost:.2} its {} w {:.3} -> {:.3} wider {most:.2}", found.iterations, own.body.spin(own.motions[node].q, own.motions[node].L).y, found.unknowns.body.spin(found.unknowns.motions[node].q, found.unknowns.motions[node].L).y); }
            }
        }
        self.beyond.iter_mut().zip(&all).for_each(|(of, by)| of.iter_mut().zip(by).for_each(|(of, by)| *of *= by));
        self
    }
}

impl Problem<'_> {
    fn trial_cost(&self, at: &super::problem::Unknowns, pin: Pin, cost: f64) -> f64 {
        cost - pin.cost(at)
    }
}
