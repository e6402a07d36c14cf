//! Motion and contacts of a shape with given coefficients, and how they depend on these.

use super::model::{Contacts, PalmInstant, reaction};
use super::{MOTION, Problem};
use nalgebra::{DMatrix, DVector};

/// Normal equations about a point, in units of the prior's deviations; the prior is not in them.
pub(super) struct Normal {
    pub(super) matrix: DMatrix<f64>,
    pub(super) vector: DVector<f64>,
    pub(super) squares: f64,
    pub(super) motion: Vec<[f64; 2]>,
    pub(super) radii: Vec<[f64; 2]>,
}

/// State `(phi0, omega0)` and its sensitivities, one row a parameter.
struct State {
    values: [f64; 2],
    by: DMatrix<f64>,
}

impl State {
    fn moved(&self, rate: &State, h: f64) -> State {
        let mut by = self.by.clone();
        by.zip_apply(&rate.by, |a, b| *a += h * b);
        State { values: [0, 1].map(|i| self.values[i] + h * rate.values[i]), by }
    }
}

impl Problem<'_> {
    /// Integrates over `count` samples; none where the motion leaves the numbers.
    pub(super) fn normal(&self, x: &DVector<f64>, count: usize, noise: f64) -> Option<Normal> {
        let parameters = x.len();
        let mut out = Normal {
            matrix: DMatrix::zeros(parameters, parameters),
            vector: DVector::zeros(parameters),
            squares: 0.0,
            motion: Vec::with_capacity(count),
            radii: Vec::with_capacity(count),
        };
        let mut contacts = Contacts::new(self.options.order);
        let mut state = State { values: [0.0, x[0]], by: DMatrix::zeros(parameters, 2) };
        state.by[(0, 1)] = self.deviations[0];
        let mut rows = DMatrix::zeros(parameters, 2);
        for k in 0..count {
            if k > 0 {
                let h = self.samples[k].t - self.samples[k - 1].t;
                let stages = [self.palms[2 * k - 2], self.palms[2 * k - 1], self.palms[2 * k]];
                state = self.step(&state, x, h, &stages, &mut contacts);
            }
            contacts.set(&x.as_slice()[MOTION..], &self.palms[2 * k], state.values[0], state.values[1]);
            let here = reaction(&self.palms[2 * k], self.options.gravity, x[1].exp(), &contacts.values);
            for i in 0..2 {
                let measured = self.samples[k].contacts[i]?;
                let residual = (measured - here.contacts[i]) / noise;
                out.squares += residual * residual;
                let gradient = &here.contacts_by[i];
                let by_phi = gradient.dot(&contacts.by_phi);
                for j in 0..parameters {
                    let own = if j < MOTION { 0.0 } else { contacts.by_coefficient(gradient, j - MOTION) };
                    rows[(j, i)] = (own * self.deviations[j] + by_phi * state.by[(j, 0)]) / noise;
                }
                out.vector.axpy(residual, &rows.column(i), 1.0);
            }
            out.matrix.gemm(1.0, &rows, &rows.transpose(), 1.0);
            out.motion.push(state.values);
            out.radii.push([contacts.values[0], contacts.values[3]]);
        }
        out.squares.is_finite().then_some(out)
    }

    /// Rates of the state and of its sensitivities (in units of the prior's deviations).
    fn rate(&self, state: &State, x: &DVector<f64>, palms: &PalmInstant, contacts: &mut Contacts) -> State {
        contacts.set(&x.as_slice()[MOTION..], palms, state.values[0], state.values[1]);
        let gyration = x[1].exp();
        let here = reaction(palms, self.options.gravity, gyration, &contacts.values);
        let by_phi = here.by_contact.dot(&contacts.by_phi);
        let by_omega = here.by_contact[6];
        let by = DMatrix::from_fn(x.len(), 2, |j, part| {
            if part == 0 {
                return state.by[(j, 1)];
            }
            let own = match j {
                0 => 0.0,
                1 => here.by_gyration * gyration,
                _ => contacts.by_coefficient(&here.by_contact, j - MOTION),
            };
            own * self.deviations[j] + by_phi * state.by[(j, 0)] + by_omega * state.by[(j, 1)]
        });
        State { values: [state.values[1], here.alpha], by }
    }

    fn step(
        &self,
        state: &State,
        x: &DVector<f64>,
        h: f64,
        stages: &[PalmInstant; 3],
        contacts: &mut Contacts,
    ) -> State {
        let k1 = self.rate(state, x, &stages[0], contacts);
        let k2 = self.rate(&state.moved(&k1, 0.5 * h), x, &stages[1], contacts);
        let k3 = self.rate(&state.moved(&k2, 0.5 * h), x, &stages[1], contacts);
        let k4 = self.rate(&state.moved(&k3, h), x, &stages[2], contacts);
        state.moved(&k1, h / 6.0).moved(&k2, h / 3.0).moved(&k3, h / 3.0).moved(&k4, h / 6.0)
    }
}
