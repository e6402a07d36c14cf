//! Which family is chosen, whether none is, and how long that takes.

use super::Failure;
use super::bodies::{Truth, exact, measured, normals};
use cpu_time::ThreadTime;
use shape_bounds::fit::{FitError, FitOptions, NoiseLevel, ShapeChoice, ShapeFamily, ShapeFit};
use shape_bounds::generators::Source;
use shape_bounds::noise::NoisyContact;

pub(super) fn choice(runs: u64) -> Result<(), Failure> {
    println!("\n## Choice of the family\n");
    println!(
        "Share of {runs} runs in which each family has the smallest Bayesian information criterion, out of sphere (4 parameters),"
    );
    println!(
        "ellipsoid (9), superquadric (11) and harmonics of degree 2 to 6 (9 to 49), as far as there are three equations for"
    );
    println!(
        "each parameter, and in which all are refused. The last body is in none of the families. Misfit is the mean over the runs"
    );
    println!(
        "of chi-squared of the chosen shape per degree of freedom: near 1 the shape explains its contacts. Time is for all fits"
    );
    println!("of one choice.\n");
    println!(
        "| body | contacts | noise | sphere | ellipsoid | superquadric | harmonics, by degree | refused | misfit | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (truth, name, _) in Truth::ALL {
        for (count, noise) in [(30, 1e-2), (100, 1e-2), (100, 1e-3), (300, 1e-3)] {
            crate::print_line(|| -> Result<String, Failure> {
                let tally = tally(truth, count, noise, runs)?;
                Ok(format!("| {name} | {count} | {noise:e} | {} |", tally.row(runs)))
            })?;
        }
    }
    Ok(())
}

/// Counts and sums over the runs of one row.
#[derive(Default)]
struct Tally {
    /// Sphere, ellipsoid, superquadric, and harmonics from degree 2 on.
    hits: [u64; 12],
    refused: u64,
    misfit: f64,
    milliseconds: f64,
}

impl Tally {
    fn row(&self, runs: u64) -> String {
        let share = |count: u64| count as f64 / runs as f64;
        let harmonics: Vec<String> = (2..=8)
            .filter(|degree| self.hits[1 + degree] > 0)
            .map(|degree| format!("{degree}: {:.2}", share(self.hits[1 + degree])))
            .collect();
        let chosen = runs - self.refused;
        let misfit = if chosen > 0 { format!("{:.2}", self.misfit / chosen as f64) } else { String::new() };
        let [sphere, ellipsoid, superquadric] = [0, 1, 2].map(|i| share(self.hits[i]));
        format!(
            "{sphere:.2} | {ellipsoid:.2} | {superquadric:.2} | {} | {:.2} | {misfit} | {:.0}",
            harmonics.join(", "),
            share(self.refused),
            self.milliseconds / runs as f64
        )
    }
}

fn tally(truth: Truth, count: usize, noise: f64, runs: u64) -> Result<Tally, Failure> {
    let mut tally = Tally::default();
    let mut families = ShapeFamily::candidates(count);
    families.retain(|family| family.parameters() <= 49);
    for seed in 0..runs {
        let mut s = Source::new(seed + 7000);
        let body = truth.body(&mut s)?;
        let normals = normals(count, false, &mut s);
        let contacts = measured(&body, &normals, noise, &mut s)?;
        let start = ThreadTime::now();
        let choice = ShapeFit::choose(&contacts, &families, &FitOptions::default());
        tally.milliseconds += start.elapsed().as_secs_f64() * 1e3;
        let Some(chosen) = unless_refused(choice)? else {
            tally.refused += 1;
            continue;
        };
        let statistics = chosen.best.statistics();
        tally.misfit += statistics.chi_squared / statistics.degrees_of_freedom as f64;
        let place = match chosen.best.family() {
            ShapeFamily::Sphere => 0,
            ShapeFamily::Ellipsoid => 1,
            ShapeFamily::Superquadric => 2,
            ShapeFamily::Harmonics { degree } => 1 + degree,
            // A family that the tally does not know yet.
            _ => continue,
        };
        tally.hits[place] += 1;
    }
    Ok(tally)
}

/// `None` where no family fits; other errors stay errors.
fn unless_refused(choice: Result<ShapeChoice, FitError>) -> Result<Option<ShapeChoice>, Failure> {
    match choice {
        Ok(choice) => Ok(Some(choice)),
        Err(FitError::NoneFits { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Time of a choice out of all families where it is longest.
pub(super) fn times() -> Result<(), Failure> {
    println!("\n## Time of a choice\n");
    println!(
        "Out of all families up to harmonics of degree 8, contacts on 3 curves of one seeded body; thread time.\n"
    );
    println!("| body | contacts | noise | chosen | s |");
    println!("|---|---|---|---|---|");
    let stated = FitOptions::default();
    let unknown = FitOptions { noise_level: NoiseLevel::Estimated, ..stated };
    let (ellipsoid, _, _) = Truth::ALL[1];
    let (stranger, _, _) = Truth::ALL[4];
    let mut s = Source::new(9000);
    for (truth, name, count, noise, options) in [
        (stranger, "none of the families", 150, 1e-3, stated),
        (stranger, "none of the families", 150, 1e-2, unknown),
        (stranger, "none of the families", 150, 0.0, unknown),
        (ellipsoid, "ellipsoid", 12_603, 0.0, unknown),
        (ellipsoid, "ellipsoid", 12_603, 1e-4, stated),
        (stranger, "none of the families", 12_603, 1e-4, stated),
        (stranger, "none of the families", 12_603, 1e-4, unknown),
    ] {
        let body = truth.body(&mut s)?;
        let normals = normals(count, true, &mut s);
        let contacts: Vec<NoisyContact> =
            if noise > 0.0 { measured(&body, &normals, noise, &mut s)? } else { exact(&body, &normals)? };
        crate::print_line(|| -> Result<String, Failure> {
            let start = ThreadTime::now();
            let choice = ShapeFit::choose(&contacts, &ShapeFamily::candidates(count), &options);
            let seconds = start.elapsed().as_secs_f64();
            let chosen =
                unless_refused(choice)?.map_or_else(|| "refused".to_owned(), |c| c.best.family().to_string());
            let level = if options.noise_level == NoiseLevel::Stated { "stated" } else { "unknown" };
            Ok(format!("| {name} | {count} | {noise:e}, {level} | {chosen} | {seconds:.2} |"))
        })?;
    }
    Ok(())
}
