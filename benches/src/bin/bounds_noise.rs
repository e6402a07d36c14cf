//! Simulated noisy runs: how often the true ellipsoid lies between the bounds, and what the margins cost.
//!
//! Usage: `bounds_noise [RUNS]` (1000 by default). Three curves of 1000 contacts in all; points with a standard deviation of
//! `level` times the largest semi-axis, normals of `level` rad. Writes `docs/charts/bounds/noise.csv`.

use shape_bounds::generators::{AXES, ellipsoid_support, noisy_curves};
use shape_bounds::{ContactNoise, Intersection, NoisyContact, ShapeBounds};
use std::fmt::Write as _;

const CONTACTS: usize = 1000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let runs: u64 = std::env::args().nth(1).map_or(Ok(1000), |a| a.parse())?;
    let mut csv = String::from(
        "confidence,level,runs,lower_in_truth,truth_in_upper,both,plain_both,gap_ratio_median,gap_ratio_largest,\
         lower_volume_median,upper_volume_median\n",
    );
    for (confidence, level, runs) in
        [(0.95, 1e-3, runs), (0.99, 1e-3, runs), (0.95, 1e-4, runs / 5), (0.95, 3e-3, runs / 5)]
    {
        let line = study(confidence, level, runs)?;
        println!("{line}");
        writeln!(csv, "{line}")?;
    }
    std::fs::create_dir_all("docs/charts/bounds")?;
    std::fs::write("docs/charts/bounds/noise.csv", csv)?;
    Ok(())
}

fn study(confidence: f64, level: f64, runs: u64) -> Result<String, Box<dyn std::error::Error>> {
    let truth = 4.0 / 3.0 * std::f64::consts::PI * AXES.element_product();
    let (mut lower, mut upper, mut both, mut plain_both) = (0, 0, 0, 0);
    let (mut ratios, mut lowers, mut uppers) = (Vec::new(), Vec::new(), Vec::new());
    let noise = ContactNoise::isotropic(level * AXES.max_element(), level);
    for seed in 0..runs {
        let measured = noisy_curves(CONTACTS, level * AXES.max_element(), level, seed);
        let with = |contact| NoisyContact { contact, noise };
        let curves: Vec<Vec<NoisyContact>> =
            measured.iter().map(|curve| curve.iter().copied().map(with).collect()).collect();
        let bounds = ShapeBounds::from_noisy_curves(&curves, confidence)?;
        let (inside, around) = holds(&bounds);
        lower += usize::from(inside);
        upper += usize::from(around);
        both += usize::from(inside && around);
        plain_both += usize::from(
            ShapeBounds::from_contacts(&measured.concat()).is_ok_and(|b| holds(&b) == (true, true)),
        );
        let clean = ShapeBounds::from_contacts(&noisy_curves(CONTACTS, 0.0, 0.0, seed).concat())?;
        let gap = |b: &ShapeBounds| b.upper_volume() - b.lower_volume();
        ratios.push(gap(&bounds) / gap(&clean));
        lowers.push(bounds.lower_volume() / truth);
        uppers.push(bounds.upper_volume() / truth);
    }
    let worst = ratios.iter().copied().fold(0.0, f64::max);
    Ok(format!(
        "{confidence},{level},{runs},{lower},{upper},{both},{plain_both},{:.4},{worst:.4},{:.4},{:.4}",
        median(ratios),
        median(lowers),
        median(uppers)
    ))
}

/// Whether the lower bound is in the true ellipsoid, and that in the upper bound.
fn holds(bounds: &ShapeBounds) -> (bool, bool) {
    let inside =
        bounds.lower().solid().is_some_and(|s| s.vertices().iter().all(|v| (*v / AXES).length() <= 1.0));
    let around = match bounds.upper() {
        Intersection::Bounded(upper) => upper
            .face_half_spaces()
            .iter()
            .all(|h| ellipsoid_support(h.normal.get()) <= h.normal.get().dot(h.point) + h.margin),
        Intersection::Unbounded(_) => false,
    };
    (inside, around)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
