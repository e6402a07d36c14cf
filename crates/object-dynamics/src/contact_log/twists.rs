//! Whether measured twists of a palm are those of its poses: another unit, sign or frame is none that noise makes.

use super::record::MeasuredMotion;
use crate::streams::Rhythm;
use glam::DVec3;

/// Samples from which on it is asked.
const FEWEST: usize = 8;
/// Twists carry a palm elsewhere than its poses do where they miss by more than this share of the way, and by more than so many
/// deviations that their noise would make.
const SHARE: f64 = 0.5;
const DEVIATIONS: f64 = 10.0;
/// A turn from sample to sample beyond which nothing is asked, rad: the poses do not show it.
const FAR: f64 = 1.0;
/// Squared change of a rate from sample to sample over its square, beyond which nothing is asked: it is noise, or too fast for the samples.
const RESOLVED: f64 = 0.25;
/// Times the median time between samples beyond which nothing was recorded between two: how the palm went there, twists at both ends do not say.
const GAP: f64 = 3.0;

/// Ways of a palm since the first sample, by its poses and by its twists, where these are farthest apart.
pub(super) struct Apart {
    pub(super) what: &'static str,
    pub(super) sample: usize,
    pub(super) posed: f64,
    pub(super) stated: f64,
    pub(super) distance: f64,
}

/// None where twists and poses agree.
pub(super) fn against_poses(times: &[f64], states: &[MeasuredMotion]) -> Option<Apart> {
    if states.len() < FEWEST {
        return None;
    }
    let usual = Rhythm::of(times).period?;
    let seen: Vec<bool> = times.windows(2).map(|pair| pair[1] - pair[0] <= GAP * usual).collect();
    let turn = |pair: &[MeasuredMotion]| {
        let turn = pair[1].pose.R_WP * pair[0].pose.R_WP.inverse();
        // The shorter way round.
        (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis()
    };
    let steps = |way: &dyn Fn(&[MeasuredMotion]) -> DVec3, rate: fn(&MeasuredMotion) -> DVec3| -> Vec<Step> {
        let step = |(k, pair): (usize, &[MeasuredMotion])| {
            let mean = 0.5 * (rate(&pair[0]) + rate(&pair[1]));
            match seen[k] {
                true => {
                    let h = times[k + 1] - times[k];
                    Step { h, posed: way(pair), stated: h * mean }
                }
                // As if it was one step like the others, as stated: it then speaks neither for nor against.
                false => Step { h: usual, posed: usual * mean, stated: usual * mean },
            }
        };
        states.windows(2).enumerate().map(step).collect()
    };
    let moved = steps(&|pair| pair[1].pose.p_WP - pair[0].pose.p_WP, |state| state.v_WP);
    let turned = steps(&turn, |state| state.w_WP);
    let far = turned.iter().any(|step| step.posed.length() > FAR);
    let velocities: Vec<DVec3> = states.iter().map(|state| state.v_WP).collect();
    let spins: Vec<DVec3> = states.iter().map(|state| state.w_WP).collect();
    let named = |what| {
        move |(sample, [posed, stated, distance]): (usize, [f64; 3])| Apart {
            what,
            sample,
            posed,
            stated,
            distance,
        }
    };
    apart(&moved, &velocities).map(named("velocity (V, m/s)")).or_else(|| {
        let turned = if far { None } else { apart(&turned, &spins) };
        turned.map(named("angular velocity (W, rad/s)"))
    })
}

/// What a palm does from one sample to the next, `h` s later, by its poses and by its twists: m or rad.
struct Step {
    h: f64,
    posed: DVec3,
    stated: DVec3,
}

/// The sample up to which the sum of `steps` and the integral of `rates` are farthest apart, their lengths there and the distance.
fn apart(steps: &[Step], rates: &[DVec3]) -> Option<(usize, [f64; 3])> {
    let (mut posed, mut stated, mut way) = (DVec3::ZERO, DVec3::ZERO, 0.0_f64);
    let mut worst = (0, [0.0; 3]);
    for (k, step) in steps.iter().enumerate() {
        posed += step.posed;
        stated += step.stated;
        way = way.max(posed.length()).max(stated.length());
        let distance = posed.distance(stated);
        if distance > worst.1[2] {
            worst = (k + 1, [posed.length(), stated.length(), distance]);
        }
    }
    let changes: f64 = rates.windows(2).map(|pair| (pair[1] - pair[0]).length_squared()).sum();
    let squares: f64 = rates.iter().map(|rate| rate.length_squared()).sum();
    if changes > RESOLVED * squares {
        return None;
    }
    // Noise makes six times its variance of a second difference. That of poses is felt at the ends, that of twists over every step.
    let of_poses =
        steps.windows(2).map(|pair| (pair[1].posed - pair[0].posed).length_squared() / 6.0).sum::<f64>();
    let second = |k: usize| rates[k - 1] - 2.0 * rates[k] + rates[k + 1];
    let of_rates = (1..steps.len()).map(|k| (second(k) * steps[k].h).length_squared() / 6.0).sum::<f64>();
    let distance = worst.1[2];
    let noise = (of_poses / (steps.len() - 1) as f64 + of_rates).sqrt();
    (distance > SHARE * way && distance > DEVIATIONS * noise).then_some(worst)
}
