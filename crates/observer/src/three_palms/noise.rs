//! Sensor noise from the roughness of the readings themselves.

use super::covariance::NoiseLevel;
use super::track::Track;

/// Fourth differences of white noise of unit variance have this variance: 1 + 16 + 36 + 16 + 1.
const FOURTH_DIFFERENCE: f64 = 70.0;
/// Median of |x| for a standard normal x.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;

/// Standard deviations of white noise in contact coordinates and forces. Fourth differences remove what is smooth over
/// five samples, and their median is blind to a few outliers.
pub(super) fn noise_level(track: &Track) -> NoiseLevel {
    let contact = |i: usize, axis: usize| {
        track.nodes.iter().map(move |n| n.palms[i].frame.sensor_from_contact(n.p_WC[i])[axis])
    };
    let mut forces: Vec<f64> =
        (0..3).flat_map(|i| differences(track.nodes.iter().map(|n| n.forces[i]).collect())).collect();
    NoiseLevel {
        contact: roughness((0..6).map(|c| contact(c / 2, c % 2).collect())),
        force: deviation(&mut forces),
    }
}

/// Standard deviation of the white noise that is common to some series.
pub(super) fn roughness(series: impl Iterator<Item = Vec<f64>>) -> f64 {
    let mut rough: Vec<f64> = series.flat_map(differences).collect();
    deviation(&mut rough)
}

fn differences(values: Vec<f64>) -> Vec<f64> {
    values.windows(5).map(|w| w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).collect()
}

fn deviation(differences: &mut [f64]) -> f64 {
    if differences.is_empty() {
        return 0.0;
    }
    for value in differences.iter_mut() {
        *value = value.abs();
    }
    let middle = differences.len() / 2;
    let (_, median, _) = differences.select_nth_unstable_by(middle, f64::total_cmp);
    *median / MEDIAN_OF_NORMAL / FOURTH_DIFFERENCE.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_signal_is_not_noise_and_noise_has_its_deviation() {
        let smooth: Vec<f64> = (0..20_000).map(|k| (f64::from(k) * 1e-3).sin()).collect();
        assert!(deviation(&mut differences(smooth.clone())) < 1e-12);
        // Sums of twelve uniform numbers are near enough to normal, with unit variance.
        let mut seed = 7u64;
        let mut uniform = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let noisy = smooth.iter().map(|s| s + (0..12).map(|_| uniform()).sum::<f64>() - 6.0);
        let found = deviation(&mut differences(noisy.collect()));
        assert!((found - 1.0).abs() < 0.05, "{found}");
    }
}
