//! Whether the search for a superquadric ends where the likelihood is largest.

use super::Failure;
use super::bodies::{measured, normals};
use cpu_time::ThreadTime;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use shape_bounds::fit::{FitOptions, NoiseLevel, ShapeFamily, ShapeFit, Superquadric};
use shape_bounds::generators::Source;
use shape_bounds::noise::NoisyContact;

/// Deviations that an error exceeds in some direction once in 10^6 fits of 11 parameters with a true covariance:
/// chi-squared of 11 degrees of freedom is above their square so often.
const FAR: f64 = 7.0;

pub(super) fn minima(runs: u64) -> Result<(), Failure> {
    println!("\n## Superquadrics in wrong minima\n");
    println!(
        "{runs} runs a row: axes 0.5 to 2, exponents 0.5 to 1.5, any pose, contacts on 3 curves. Refused: although the body is a"
    );
    println!(
        "superquadric (at most one in 10,000 should be). Beaten: the sum of squares is larger than that of the body itself, which no"
    );
    println!(
        "least one is. Off: `h` is wrong by more than {FAR} of its stated deviations in one of 100 directions (one fit in 10^6"
    );
    println!("would be). Thread time of one fit.\n");
    println!("| contacts | noise | refused | beaten | off | ms |");
    println!("|---|---|---|---|---|---|");
    for count in [60, 150] {
        for (noise, noise_level) in
            [(1e-3, NoiseLevel::Stated), (1e-2, NoiseLevel::Stated), (1e-2, NoiseLevel::Estimated)]
        {
            crate::print_line(|| row(count, noise, noise_level, runs))?;
        }
    }
    Ok(())
}

fn row(count: usize, noise: f64, noise_level: NoiseLevel, runs: u64) -> Result<String, Failure> {
    let options = FitOptions { noise_level, ..FitOptions::default() };
    let (mut refused, mut beaten, mut off, mut milliseconds) = (0, 0, 0, 0.0);
    for seed in 0..runs {
        let mut s = Source::new(seed + 600_000);
        let axes = DVec3::new(s.between(0.5, 2.0), s.between(0.5, 2.0), s.between(0.5, 2.0));
        let exponents = [s.between(0.5, 1.5), s.between(0.5, 1.5)];
        let body = Superquadric::new(s.normal3() * 0.3, axes, s.rotation(), exponents)?;
        let contacts = measured(&body, &normals(count, true, &mut s), noise, &mut s)?;
        let start = ThreadTime::now();
        let fit = ShapeFit::of(&contacts, ShapeFamily::Superquadric, &options);
        milliseconds += start.elapsed().as_secs_f64() * 1e3;
        let Ok(fit) = fit else {
            refused += 1;
            continue;
        };
        beaten += usize::from(fit.statistics().chi_squared > chi_squared(&body, &contacts, noise));
        let errors = (0..100).map(|_| Direction::new(s.direction()));
        let far = errors
            .map(|n| n.map(|n| (fit.value(n) - body.value(n)).abs() > FAR * fit.support_deviation(n)))
            .collect::<Result<Vec<_>, _>>()?;
        off += usize::from(far.contains(&true));
    }
    let level = if noise_level == NoiseLevel::Stated { "stated" } else { "unknown" };
    Ok(format!(
        "| {count} | {noise:e}, {level} | {refused} | {beaten} | {off} | {:.0} |",
        milliseconds / runs as f64
    ))
}

/// The sum of squares at a body, over points and normals, with the likeliest true normals by Gauss-Newton steps.
fn chi_squared(body: &Superquadric, contacts: &[NoisyContact], noise: f64) -> f64 {
    contacts.iter().map(|c| least(body, c) / noise.powi(2)).sum()
}

fn least(body: &Superquadric, contact: &NoisyContact) -> f64 {
    let (point, measured) = (contact.contact.point, contact.contact.normal.get());
    let mut normal = contact.contact.normal;
    let mut least = f64::INFINITY;
    for _ in 0..30 {
        let (n, jet) = (normal.get(), body.jet(normal));
        let e = point - jet.point;
        least = least.min(e.length_squared() + measured.distance_squared(n));
        let slope = jet.hessian * e + measured - n * measured.dot(n);
        let step = (jet.hessian * jet.hessian + DMat3::IDENTITY).inverse() * slope;
        let Ok(next) = Direction::new(n + step) else { break };
        normal = next;
    }
    least
}
