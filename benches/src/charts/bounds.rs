//! Bounds by number of contacts, noise and time.

use super::{Chart, Drawn};
use crate::{Axis, Budget, Study, WorkPrecision};
use recon::contact_kinematics::CurvatureRadii;
use shape_bounds::curvature::SharpBounds;
use shape_bounds::generators::{AXES, curve_contacts, noisy_curves};
use shape_bounds::noise::{ContactNoise, NoisyContact};
use shape_bounds::{ContactSample, ShapeBounds};

pub(super) const CHART: Chart =
    Chart { name: "bounds", about: "bounds on a shape by number of contacts, noise and time", draw };

const COUNTS: [usize; 6] = [30, 60, 120, 300, 1000, 3000];
const NOISES: [(f64, &str); 2] = [(1e-3, "0.1 % noise"), (1e-2, "1 % noise")];
/// Limits on the radii of curvature: those of the ellipsoid, m.
const RADII: CurvatureRadii = CurvatureRadii { min: 0.4, max: 6.25 };
const CONFIDENCE: f64 = 0.95;
const SEED: u64 = 5;

fn draw(budget: Budget) -> Drawn {
    let truth = 4.0 / 3.0 * std::f64::consts::PI * AXES.element_product();
    let gap = |lower: f64, upper: f64| (upper - lower) / truth;
    let exact = COUNTS.map(|count| curve_contacts(count, SEED));
    let noisy: Vec<(usize, &str, Vec<Vec<NoisyContact>>)> = NOISES
        .iter()
        .flat_map(|(noise, name)| COUNTS.map(|count| (count, *name, stated(count, *noise))))
        .collect();
    let mut study = Study::new();
    for (contacts, count) in exact.iter().zip(COUNTS) {
        let setting = format!("{count}");
        let run = || ShapeBounds::from_contacts(contacts);
        study.fallible_case("no noise", setting.clone(), run, |b| gap(b.lower_volume(), b.upper_volume()));
        let run = || SharpBounds::from_contacts(contacts, RADII);
        study.fallible_case("no noise, limits on curvature", setting, run, |b| {
            gap(b.lower().volume(), b.upper().volume())
        });
    }
    for (count, name, curves) in &noisy {
        let setting = format!("{count}");
        let run = || ShapeBounds::from_noisy_curves(curves, CONFIDENCE);
        study.fallible_case(*name, setting.clone(), run, |b| gap(b.lower_volume(), b.upper_volume()));
        let run = || SharpBounds::from_noisy_curves(curves, RADII, CONFIDENCE);
        study.fallible_case(format!("{name}, limits on curvature"), setting, run, |b| {
            gap(b.lower().volume(), b.upper().volume())
        });
    }
    let chart = WorkPrecision::new("bounds-by-contacts", "Bounds on a shape: time against gap")
        .subtitle("ellipsoid 2.5, 2, 1 m touched along three curves, noise of the size and in rad, 95 %; points: contacts")
        .axes(Axis::log("volume between the bounds over the true one", "1"), Axis::log("time", "ms"))
        .methods(study.measure(budget, 1.0));
    Ok(vec![chart.into()])
}

fn stated(count: usize, level: f64) -> Vec<Vec<NoisyContact>> {
    let noise = ContactNoise::isotropic(level * AXES.max_element(), level);
    let with = |contact: &ContactSample| NoisyContact { contact: *contact, noise };
    let curves = noisy_curves(count, level * AXES.max_element(), level, SEED);
    curves.iter().map(|curve| curve.iter().map(with).collect()).collect()
}
