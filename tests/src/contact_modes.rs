//! What a classifier of contact modes reads: from logs with truth, and drawn contacts; and how right it is.

mod drawn;
mod logs;
mod score;

pub use drawn::drawn;
pub use logs::{LoggedContacts, Sensed, SlipNoise, TWIST_CORRELATION};
pub use score::Score;

use nalgebra::{Matrix2x6, Matrix6};
use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::{ContactModes, ContactModesError, ContactSeen, TwistError};

/// One sample: what is read and what is true.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Since the sample before, s.
    pub dt: f64,
    /// Of each contact.
    pub seen: Vec<ContactSeen>,
    /// How slips change with the twist; empty where errors of slips are their own.
    pub slopes: Vec<Matrix2x6<f64>>,
    /// Of the twist's error.
    pub covariance: Matrix6<f64>,
    /// Of each contact.
    pub truth: Vec<ContactMode>,
    /// Whether the sample is further than 5 ms from each switch of the contact.
    pub settled: Vec<bool>,
}

/// Pushes all samples, and scores every contact that truly touches, at samples away from its switches.
///
/// # Errors
/// What the classifier refuses.
pub fn classify(modes: &mut ContactModes, moments: &[Moment]) -> Result<Score, ContactModesError> {
    let mut score = Score::default();
    for moment in moments {
        if moment.slopes.is_empty() {
            modes.push(moment.dt, &moment.seen)?;
        } else {
            let twist = TwistError { slopes: &moment.slopes, covariance: &moment.covariance };
            modes.push_with_twist(moment.dt, &moment.seen, &twist)?;
        }
        for (i, truth) in moment.truth.iter().enumerate() {
            if moment.settled[i] && *truth != ContactMode::Off {
                score.take(i, *truth == ContactMode::Slide, modes.odds(i), modes.label(i));
            }
        }
    }
    Ok(score)
}

/// Marks what is further than 5 ms from each switch.
pub(crate) fn settle(moments: &mut [Moment]) {
    const NEAR: f64 = 0.005;
    let contacts = moments.first().map_or(0, |moment| moment.truth.len());
    for i in 0..contacts {
        for backward in [false, true] {
            let mut away = f64::INFINITY;
            for step in 1..moments.len() {
                let k = if backward { moments.len() - 1 - step } else { step };
                let before = if backward { k + 1 } else { k - 1 };
                away += if backward { moments[before].dt } else { moments[k].dt };
                if moments[k].truth[i] != moments[before].truth[i] {
                    away = 0.0;
                    moments[before].settled[i] = false;
                }
                // A sum of steps is not exact.
                moments[k].settled[i] &= away > NEAR - 1e-9;
            }
        }
    }
}
