//! Simulated noisy runs: how often the true ellipsoid lies between the bounds, and what the margins cost.
//!
//! Usage: `bounds_noise [RUNS]` (1000 by default). Prints a table in Markdown.

use recon::contact_kinematics::{CurvatureRadii, Direction};
use shape_bounds::curvature::SharpBounds;
use shape_bounds::exact_hull::Intersection;
use shape_bounds::generators::{AXES, Source, ellipsoid_support, noisy_curves};
use shape_bounds::noise::{ContactNoise, NoisyContact, estimate_noise};
use shape_bounds::{ContactSample, ShapeBounds};

const CONTACTS: usize = 1000;
/// Limits on the radii of curvature: those of the ellipsoid.
const RADII: CurvatureRadii = CurvatureRadii { min: 0.4, max: 6.25 };
/// Directions in which curved bounds are compared with the ellipsoid.
const DIRECTIONS: usize = 500;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let runs: u64 = crate::words().next().map_or(Ok(1000), |a| a.parse())?;
    println!("# Bounds under noise\n");
    println!(
        "Made by `cargo xtask study bounds_noise {runs}`. Ellipsoid with semi-axes 2.5, 2, 1 m, {CONTACTS} contacts on three \
         curves; points off by `level` times 2.5 m per axis, normals by `level` rad (standard deviations). Between: runs \
         in which the body lies between the bounds. Plain: the same for bounds that take the contacts as exact. Gap: \
         volume between the bounds over that of exact contacts, median (largest).\n"
    );
    println!(
        "| bounds | confidence | level | noise | runs | between | plain | gap | lower / true | upper / true |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let few = runs.div_ceil(5);
    for (confidence, level, runs) in
        [(0.95, 1e-3, runs), (0.99, 1e-3, runs), (0.95, 1e-4, few), (0.95, 3e-3, few)]
    {
        println!("{}", plain_study(confidence, level, runs, false)?);
    }
    println!("{}", plain_study(0.95, 1e-3, few, true)?);
    for level in [1e-4, 1e-3, 3e-3] {
        println!("{}", sharp_study(0.95, level, few)?);
    }
    Ok(())
}

/// Whether the body lies between the bounds, and between those of contacts taken as exact; volumes of the bounds, and between those of exact contacts.
type Run = (bool, bool, [f64; 2], f64);

/// What became of the runs of one row.
#[derive(Default)]
struct Tally {
    between: usize,
    plain: usize,
    ratios: Vec<f64>,
    lowers: Vec<f64>,
    uppers: Vec<f64>,
}

impl Tally {
    fn add(&mut self, run: Option<Run>) {
        let Some((between, plain, [lower, upper], clean_gap)) = run else { return };
        let truth = 4.0 / 3.0 * std::f64::consts::PI * AXES.element_product();
        self.between += usize::from(between);
        self.plain += usize::from(plain);
        self.ratios.push((upper - lower) / clean_gap);
        self.lowers.push(lower / truth);
        self.uppers.push(upper / truth);
    }

    fn row(self, name: &str, confidence: f64, level: f64, noise: &str) -> String {
        let worst = self.ratios.iter().copied().fold(0.0, f64::max);
        format!(
            "| {name} | {:.0} % | {level:e} | {noise} | {} | {} | {} | {:.3} ({worst:.3}) | {:.4} | {:.4} |",
            100.0 * confidence,
            self.ratios.len(),
            self.between,
            self.plain,
            median(self.ratios),
            median(self.lowers),
            median(self.uppers)
        )
    }
}

fn measured(level: f64, seed: u64) -> Vec<Vec<ContactSample>> {
    noisy_curves(CONTACTS, level * AXES.max_element(), level, seed)
}

fn stated(curves: &[Vec<ContactSample>], level: f64) -> Vec<Vec<NoisyContact>> {
    let noise = ContactNoise::isotropic(level * AXES.max_element(), level);
    let with = |contact: &ContactSample| NoisyContact { contact: *contact, noise };
    curves.iter().map(|curve| curve.iter().map(with).collect()).collect()
}

/// Hull and half-spaces.
fn plain_study(
    confidence: f64,
    level: f64,
    runs: u64,
    estimated: bool,
) -> Result<String, Box<dyn std::error::Error>> {
    let mut tally = Tally::default();
    for seed in 0..runs {
        tally.add(crate::rows::row(|| -> Result<Run, Box<dyn std::error::Error>> {
            let curves = measured(level, seed);
            let noisy = if estimated { estimate_noise(&curves, confidence)? } else { stated(&curves, level) };
            let bounds = ShapeBounds::from_noisy_curves(&noisy, confidence)?;
            let plain = ShapeBounds::from_contacts(&curves.concat()).is_ok_and(|b| holds(&b));
            let clean = ShapeBounds::from_contacts(&measured(0.0, seed).concat())?;
            let clean_gap = clean.upper_volume() - clean.lower_volume();
            Ok((holds(&bounds), plain, [bounds.lower_volume(), bounds.upper_volume()], clean_gap))
        })?);
    }
    Ok(tally.row("(a), (b)", confidence, level, if estimated { "estimated" } else { "stated" }))
}

/// With limits on the curvature.
fn sharp_study(confidence: f64, level: f64, runs: u64) -> Result<String, Box<dyn std::error::Error>> {
    let mut tally = Tally::default();
    for seed in 0..runs {
        tally.add(crate::rows::row(|| -> Result<Run, Box<dyn std::error::Error>> {
            let curves = measured(level, seed);
            let bounds = SharpBounds::from_noisy_curves(&stated(&curves, level), RADII, confidence)?;
            let plain = SharpBounds::from_contacts(&curves.concat(), RADII).is_ok();
            let clean = SharpBounds::from_contacts(&measured(0.0, seed).concat(), RADII)?;
            let clean_gap = clean.upper().volume() - clean.lower().volume();
            let volumes = [bounds.lower().volume(), bounds.upper().volume()];
            Ok((sharp_holds(&bounds, seed), plain, volumes, clean_gap))
        })?);
    }
    Ok(tally.row("with limits on the curvature", confidence, level, "stated"))
}

fn sharp_holds(bounds: &SharpBounds, seed: u64) -> bool {
    let mut source = Source::new(seed);
    (0..DIRECTIONS).all(|_| {
        let n = source.direction();
        let (lower, upper) = bounds.support(Direction::new_unchecked(n));
        (lower..=upper).contains(&ellipsoid_support(n))
    })
}

/// Whether the true ellipsoid lies between the bounds.
fn holds(bounds: &ShapeBounds) -> bool {
    let inside =
        bounds.lower().solid().is_some_and(|s| s.vertices().iter().all(|v| (*v / AXES).length() <= 1.0));
    let Intersection::Bounded(upper) = bounds.upper() else { return false };
    let held = |n: glam::DVec3, offset: f64| ellipsoid_support(n) <= offset;
    let faces = upper.face_half_spaces();
    inside && faces.iter().all(|h| held(h.normal.get(), h.normal.get().dot(h.point) + h.margin))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
