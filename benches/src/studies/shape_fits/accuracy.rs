//! Errors against the Cramer-Rao bound, and consistency.

use super::Failure;
use super::bodies::{Truth, measured, normals};
use cpu_time::ThreadTime;
use recon::contact_kinematics::{Direction, SupportFunction};
use shape_bounds::fit::{FitOptions, ShapeFamily, ShapeFit};
use shape_bounds::generators::Source;
use shape_bounds::noise::ContactNoise;

/// Sums over the runs of one row.
#[derive(Default)]
struct Sums {
    square: f64,
    bound: f64,
    normalised: f64,
    nees: f64,
    held: usize,
    failed: usize,
    milliseconds: f64,
}

pub(super) fn accuracy(runs: u64) -> Result<(), Failure> {
    println!("## Error of the support function\n");
    println!(
        "Root mean square over 50 directions and the runs, against the Cramer-Rao bound at the true shape. NEES is the squared"
    );
    println!(
        "error of the parameters in units of the stated covariance, for each parameter: 1 for a true covariance, with its"
    );
    println!(
        "standard deviation in brackets; for the superquadric, whose axes have many names, the squared error of `h` in units of"
    );
    println!("its stated variance stands for it. Time is thread time of one fit.\n");
    println!(
        "| body | contacts | noise | rms error, mm | bound, mm | ratio | NEES | held convex | not fitted | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (truth, name, family) in Truth::ALL {
        let Some(family) = family else { continue };
        for (count, curves, noise) in
            [(60, false, 1e-3), (60, false, 1e-2), (300, false, 1e-3), (300, true, 1e-3), (300, true, 1e-2)]
        {
            crate::print_line(|| row(truth, name, family, count, curves, noise, runs))?;
        }
    }
    Ok(())
}

fn row(
    truth: Truth,
    name: &str,
    family: ShapeFamily,
    count: usize,
    curves: bool,
    noise: f64,
    runs: u64,
) -> Result<String, Failure> {
    let options = FitOptions { smallest_radius: Some(0.01), ..FitOptions::default() };
    let mut sums = Sums::default();
    let mut fitted = 0;
    for seed in 0..runs {
        let mut s = Source::new(seed + 1000);
        let body = truth.body(&mut s)?;
        let normals = normals(count, curves, &mut s);
        let mut exact = measured(&body, &normals, 0.0, &mut s)?;
        exact.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(noise, noise));
        let contacts = measured(&body, &normals, noise, &mut s)?;
        let Ok(bound) = ShapeFit::of(&exact, family, &options) else {
            sums.failed += 1;
            continue;
        };
        let start = ThreadTime::now();
        let Ok(fit) = ShapeFit::of(&contacts, family, &options) else {
            sums.failed += 1;
            continue;
        };
        sums.milliseconds += start.elapsed().as_secs_f64() * 1e3;
        fitted += 1;
        sums.held += usize::from(fit.statistics().active_constraints > 0);
        for _ in 0..50 {
            let n = Direction::new(s.direction())?;
            let error = fit.value(n) - body.value(n);
            sums.square += error * error / 50.0;
            sums.bound += bound.support_deviation(n).powi(2) / 50.0;
            sums.normalised += (error / fit.support_deviation(n)).powi(2) / 50.0;
        }
        let error = fit.parameters() - bound.parameters();
        if let Some(factor) = fit.covariance().clone().cholesky() {
            sums.nees += error.dot(&factor.solve(&error)) / family.parameters() as f64;
        }
    }
    let n = f64::from(fitted);
    let (rms, bound) = ((sums.square / n).sqrt(), (sums.bound / n).sqrt());
    let nees = if truth == Truth::Superquadric {
        format!("({:.3})", sums.normalised / n)
    } else {
        format!("{:.3} ({:.3})", sums.nees / n, (2.0 / n / family.parameters() as f64).sqrt())
    };
    let place = if curves { "3 curves" } else { "scattered" };
    Ok(format!(
        "| {name} | {count} {place} | {noise:e} | {:.3} | {:.3} | {:.3} | {nees} | {} | {} | {:.2} |",
        rms * 1e3,
        bound * 1e3,
        rms / bound,
        sums.held,
        sums.failed,
        sums.milliseconds / n
    ))
}
