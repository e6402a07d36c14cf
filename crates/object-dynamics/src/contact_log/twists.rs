//! Whether measured twists of a palm are those of its poses: another unit, sign or frame is none that noise makes.

use super::record::MeasuredMotion;
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
    let pairs = || states.windows(2);
    let shifts = || pairs().map(|pair| pair[1].pose.p_WP - pair[0].pose.p_WP);
    let turn = |pair: &[MeasuredMotion]| {
        let turn = pair[1].pose.R_WP * pair[0].pose.R_WP.inverse();
        // The shorter way round.
        (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis()
    };
    let velocities: Vec<DVec3> = states.iter().map(|state| state.v_WP).collect();
    let spins: Vec<DVec3> = states.iter().map(|state| state.w_WP).collect();
    let turns: Vec<DVec3> = pairs().map(turn).collect();
    let far = turns.iter().any(|turn| turn.length() > FAR);
    let moved = apart(times, &shifts().collect::<Vec<_>>(), &velocities);
    let named = |what| {
        move |(sample, [posed, stated, distance]): (usize, [f64; 3])| Apart {
            what,
            sample,
            posed,
            stated,
            distance,
        }
    };
    moved.map(named("velocity (V, m/s)")).or_else(|| {
        let turned = if far { None } else { apart(times, &turns, &spins) };
        turned.map(named("angular velocity (W, rad/s)"))
    })
}

/// The sample up to which the sum of `steps` and the integral of `rates` are farthest apart, their lengths there and the distance.
fn apart(times: &[f64], steps: &[DVec3], rates: &[DVec3]) -> Option<(usize, [f64; 3])> {
    let (mut posed, mut stated, mut way) = (DVec3::ZERO, DVec3::ZERO, 0.0_f64);
    let mut worst = (0, [0.0; 3]);
    for (k, step) in steps.iter().enumerate() {
        let h = times[k + 1] - times[k];
        posed += step;
        stated += 0.5 * h * (rates[k] + rates[k + 1]);
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
    let of_poses = steps.windows(2).map(|pair| (pair[1] - pair[0]).length_squared() / 6.0).sum::<f64>();
    let second = |k: usize| rates[k - 1] - 2.0 * rates[k] + rates[k + 1];
    let of_rates =
        (1..steps.len()).map(|k| (second(k) * (times[k + 1] - times[k])).length_squared() / 6.0).sum::<f64>();
    let distance = worst.1[2];
    let noise = (of_poses / (steps.len() - 1) as f64 + of_rates).sqrt();
    (distance > SHARE * way && distance > DEVIATIONS * noise).then_some(worst)
}
