//! Whether impulses and torques are those of the forces beside them: other units, signs or palms are none that blows or noise make.

use super::motor::slope;
use super::palm::LoggedPalm;
use super::record::SensedAxes;
use glam::DVec3;

/// Pairs from which on it is asked.
const FEWEST: usize = 8;
/// Two measures of one thing contradict each other where they differ, in the median, by more than this share of the larger: twice as
/// much, half as much or another direction.
const SHARE: f64 = 0.5;
/// And by more than so many deviations of that median by noise.
const DEVIATIONS: f64 = 10.0;
/// Deviation of a normal distribution over its median distance from the middle.
const OF_MEDIAN: f64 = 1.4826;

/// What is measured, and what the forces say that it is.
pub(super) type Pair = [DVec3; 2];

/// Impulses over intervals with a contact at both ends, and integrals of the forces there, N s, in the palm's axes. Along the normal
/// alone where one of the two is measured so.
pub(super) fn impulses(times: &[f64], palm: &LoggedPalm) -> Vec<Pair> {
    let whole = [palm.impulse_axes(), palm.force_axes()].iter().all(|axes| *axes == Some(SensedAxes::Three));
    let pair = |k: usize| {
        let touch = palm.touch(k - 1).and(palm.touch(k))?;
        let impulse = palm.impulse(k)?.vector;
        let force = palm.force(k - 1)?.vector + palm.force(k)?.vector;
        let pair = [impulse, force * (0.5 * (times[k] - times[k - 1]))];
        let to_palm = palm.motion(k).pose.R_WP.inverse();
        Some(pair.map(|v| if whole { to_palm * v } else { DVec3::Z * touch.n.get().dot(v) }))
    };
    (1..times.len()).filter_map(pair).collect()
}

/// What the motor's torque has left beside turning the palm, and the moment of the palm's force about the hinge, N m (along x).
/// None where the hinge, the torque or the force in three axes is not known.
pub(super) fn torques(times: &[f64], palm: &LoggedPalm) -> Vec<Pair> {
    let Some(hinge) = palm.hinge().filter(|_| palm.force_axes() == Some(SensedAxes::Three)) else {
        return Vec::new();
    };
    let rate = |k: usize| palm.motion(k).w_WP.dot(hinge.axis.get());
    let pair = |k: usize| {
        let (touch, force) = (palm.touch(k)?, palm.force(k)?.vector);
        let left = hinge.contact_moment(palm.torque(k)?, slope(times, k, rate));
        let moment = hinge.axis.get().dot((touch.p_WC - hinge.pivot).cross(force));
        Some([left, moment].map(|x| DVec3::X * x))
    };
    (0..times.len()).filter_map(pair).collect()
}

/// The medians of both, where they contradict each other. Blows, which samples of a force miss, do not count in a median.
pub(super) fn contradiction(pairs: &[Pair]) -> Option<Pair> {
    if pairs.len() < FEWEST {
        return None;
    }
    let [a, b] = [0, 1].map(|which| median(pairs.iter().map(|pair| pair[which])));
    let apart = |pair: &Pair| pair[0] - pair[1];
    let distance = median(pairs.iter().map(apart)).length();
    // Noise is what is not the same in neighbouring pairs. The median of n has a variance of pi / 2n.
    let changes = pairs.windows(2).map(|two| (apart(&two[1]) - apart(&two[0])).abs());
    let deviation = OF_MEDIAN * median(changes).length() / std::f64::consts::SQRT_2;
    let noise = deviation * (std::f64::consts::FRAC_PI_2 / pairs.len() as f64).sqrt();
    (distance > SHARE * a.length().max(b.length()) && distance > DEVIATIONS * noise).then_some([a, b])
}

/// Of each component.
fn median(values: impl Iterator<Item = DVec3>) -> DVec3 {
    let values: Vec<DVec3> = values.collect();
    let of = |axis: usize| {
        let mut sorted: Vec<f64> = values.iter().map(|value| value[axis]).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    };
    DVec3::new(of(0), of(1), of(2))
}
