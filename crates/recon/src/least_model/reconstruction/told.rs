//! What is said of a choice.

use super::{Alternative, Decision, Evidence, Model, Question};
use super::{ContactEstimate, Search, SensedAxes, Setting, Trial, out_of_balance};

impl Search<'_> {
    pub(super) fn decisions(&self, chosen: usize, estimate: &ContactEstimate) -> Vec<Decision> {
        let of = self.trials[chosen].setting;
        let two =
            |question, [one, other]: [Alternative; 2]| Decision { question, alternatives: vec![one, other] };
        let balance = out_of_balance(self.log, &self.options.noise, estimate.mass, self.options.gravity);
        let untold =
            |model, chosen, evidence| Alternative { model, chosen, seconds: None, accuracy: None, evidence };
        let three = self.log.palms().iter().any(|palm| palm.force_axes() == Some(SensedAxes::Three));
        let normal = of.frictionless || !three;
        let (axes, otherwise) = match three {
            true => (self.frictionless, Evidence::Needless),
            false => (Evidence::Stated, Evidence::Impossible),
        };
        let stated = self.is_stated_frictionless();
        vec![
            two(
                Question::Space,
                [
                    self.tried(Model::Planar, of.planar, self.planar, |s| s.planar),
                    self.tried(Model::Spatial, !of.planar, Evidence::Needless, |s| !s.planar),
                ],
            ),
            two(
                Question::Dynamics,
                [
                    untold(Model::Quasistatic, false, balance),
                    self.tried(Model::Dynamic, true, Evidence::Run, |_| true),
                ],
            ),
            two(
                Question::Friction,
                [
                    self.tried(Model::Frictionless, of.frictionless || stated, self.frictionless, |s| {
                        s.frictionless
                    }),
                    self.tried(Model::Friction, !of.frictionless && !stated, Evidence::Needless, |s| {
                        !s.frictionless && !stated
                    }),
                ],
            ),
            two(
                Question::Body,
                [self.tried(Model::EstimatedBody, !of.known, Evidence::Run, |s| !s.known), self.known(of)],
            ),
            two(
                Question::Forces,
                [
                    // An ellipsoid is fitted then, of an unknown mass and without deviations: it states no accuracy.
                    untold(Model::NoForces, false, Evidence::Impossible),
                    untold(Model::Forces, true, Evidence::Stated),
                ],
            ),
            two(
                Question::Axes,
                [
                    untold(Model::NormalForce, normal, axes),
                    self.tried(Model::ThreeAxes, !normal, otherwise, |s| three && !s.frictionless),
                ],
            ),
            Decision {
                question: Question::Window,
                // The motion is asked for at all times, and ends of a window are known worst.
                alternatives: vec![untold(Model::WholeLog, true, Evidence::Stated)],
            },
            self.thinning(chosen),
        ]
    }

    fn is_stated_frictionless(&self) -> bool {
        let of = |palm: &object_dynamics::LoggedPalm| palm.friction().or(self.options.friction);
        self.log.palms().iter().all(|palm| of(palm) == Some(0.0))
    }

    /// An alternative with what its best trial came to, if there was one.
    fn tried(
        &self,
        model: Model,
        chosen: bool,
        otherwise: Evidence,
        is: impl Fn(&Setting) -> bool,
    ) -> Alternative {
        let of = self.trials.iter().filter(|trial| is(&trial.setting));
        let best = of.min_by(|a, b| {
            let rank = |t: &Trial| (!t.reliable, t.accuracy.unwrap_or(f64::INFINITY));
            rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal)
        });
        let evidence = match (best, otherwise) {
            (_, Evidence::Stated | Evidence::Test { .. }) => otherwise,
            (Some(trial), _) if !trial.reliable => Evidence::Refused,
            (Some(_), _) => Evidence::Run,
            (None, _) => otherwise,
        };
        Alternative {
            model,
            chosen,
            seconds: best.map(|trial| trial.seconds),
            accuracy: best.and_then(|trial| trial.accuracy),
            evidence,
        }
    }

    fn known(&self, of: Setting) -> Alternative {
        let otherwise = if self.options.body.is_some() { Evidence::Needless } else { Evidence::Impossible };
        self.tried(Model::KnownBody, of.known, otherwise, |s| s.known)
    }

    /// All samples beside those that were tried.
    fn thinning(&self, chosen: usize) -> Decision {
        let mut alternatives: Vec<Alternative> = Vec::new();
        for (i, trial) in self.trials.iter().enumerate() {
            let evidence = if trial.reliable { Evidence::Run } else { Evidence::Refused };
            alternatives.push(Alternative {
                model: Model::Every(trial.setting.every),
                chosen: i == chosen,
                seconds: Some(trial.seconds),
                accuracy: trial.accuracy,
                evidence,
            });
        }
        let trial = &self.trials[chosen];
        if self.trials.iter().all(|trial| trial.setting.every > 1) {
            let every = trial.setting.every as f64;
            alternatives.push(Alternative {
                model: Model::Every(1),
                chosen: false,
                seconds: None,
                accuracy: trial.accuracy.map(|of| of / every.sqrt()),
                evidence: Evidence::Predicted,
            });
        }
        Decision { question: Question::Thinning, alternatives }
    }
}
