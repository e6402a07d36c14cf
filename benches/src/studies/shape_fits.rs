//! Shapes fitted to contacts: errors against the Cramer-Rao bound, consistency, choice of the family, time.
//!
//! Usage: `shape_fits [RUNS]` (200 by default). Writes the page to standard output.

use cpu_time::ThreadTime;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{
    Direction, Ellipsoid, MinkowskiSum, PolynomialSupport, Sphere, SupportFunction, Translated,
};
use shape_bounds::generators::Source;
use shape_bounds::{
    ContactNoise, ContactSample, FitOptions, IncrementalFit, NoisyContact, ShapeFamily, ShapeFit,
    SkewEllipsoid, Superquadric,
};

type Failure = Box<dyn std::error::Error>;

/// Seeded bodies, one new for each run, all about 1 m in size.
#[derive(Clone, Copy, PartialEq)]
enum Truth {
    Sphere,
    Ellipsoid,
    Superquadric,
    Harmonics,
    RoundedBox,
}

impl Truth {
    const ALL: [(Self, &'static str, Option<ShapeFamily>); 5] = [
        (Self::Sphere, "ball", Some(ShapeFamily::Sphere)),
        (Self::Ellipsoid, "ellipsoid, axes 0.5 to 2", Some(ShapeFamily::Ellipsoid)),
        (Self::Superquadric, "superquadric, exponents 0.8, 1.25", Some(ShapeFamily::Superquadric)),
        (Self::Harmonics, "harmonics to degree 4", Some(ShapeFamily::Harmonics { degree: 4 })),
        (Self::RoundedBox, "superquadric 0.4 plus ball of 0.3", None),
    ];

    fn body(self, s: &mut Source) -> Result<Box<dyn SupportFunction>, Failure> {
        let turn = DMat3::from_quat(s.rotation());
        Ok(match self {
            Self::Sphere => {
                Box::new(Translated { body: Sphere::new(s.between(0.5, 2.0))?, offset: s.normal3() })
            }
            Self::Ellipsoid => {
                let axes = DVec3::new(s.between(0.5, 2.0), s.between(0.5, 2.0), s.between(0.5, 2.0));
                let matrix = turn * DMat3::from_diagonal(axes * axes) * turn.transpose();
                Box::new(SkewEllipsoid::new(s.normal3(), matrix)?)
            }
            Self::Superquadric => {
                let axes = DVec3::new(1.0, 0.8, 1.4);
                Box::new(Superquadric::new(s.normal3() * 0.2, axes, s.rotation(), [0.8, 1.25])?)
            }
            // Drawn again until it is convex.
            Self::Harmonics => loop {
                let mut rows = vec![vec![3.5], vec![0.1, -0.1, 0.05]];
                for l in 2..=4usize {
                    rows.push((0..=2 * l).map(|_| s.normal() * 0.25 / (l * l) as f64).collect());
                }
                let body = PolynomialSupport::from_harmonics(&rows)?;
                if body.curvature_radii().min > 0.1 {
                    break Box::new(body);
                }
            },
            Self::RoundedBox => {
                let core =
                    Superquadric::new(DVec3::ZERO, DVec3::new(0.8, 0.6, 1.0), s.rotation(), [0.4, 0.4])?;
                Box::new(MinkowskiSum(core, Sphere::new(0.3)?))
            }
        })
    }
}

/// Contacts with points off by `noise` (m per axis) and normals by as much (rad per tangent axis).
fn measured(
    body: &dyn SupportFunction,
    normals: &[DVec3],
    noise: f64,
    s: &mut Source,
) -> Result<Vec<NoisyContact>, Failure> {
    normals
        .iter()
        .map(|n| {
            let n = Direction::new(*n)?;
            let (a, b) = n.tangent_basis();
            let normal = Direction::new(n.get() + (a * s.normal() + b * s.normal()) * noise)?;
            let contact = ContactSample { point: body.point(n) + s.normal3() * noise, normal };
            Ok(NoisyContact { contact, noise: ContactNoise::isotropic(noise, noise) })
        })
        .collect()
}

/// Normals scattered over the sphere, or along three closed curves as three palms trace them.
fn normals(count: usize, curves: bool, s: &mut Source) -> Vec<DVec3> {
    if !curves {
        return (0..count).map(|_| s.direction()).collect();
    }
    let turns = [s.rotation(), s.rotation(), s.rotation()];
    (0..count)
        .map(|i| {
            let t = (i / 3) as f64 / count.div_ceil(3) as f64 * std::f64::consts::TAU;
            turns[i % 3] * DVec3::new(t.cos(), t.sin(), 0.6 * (2.0 * t).sin()).normalize()
        })
        .collect()
}

pub(crate) fn main() -> Result<(), Failure> {
    let runs: u64 = crate::words().next().map_or(Ok(200), |a| a.parse())?;
    println!("# Shapes fitted to contacts\n");
    println!(
        "`cargo xtask study shape_fits {runs}`: seeded runs, each with a new body, new contacts and new noise; points are off"
    );
    println!(
        "by the stated noise in m per axis, normals by as much in rad per tangent axis, on bodies about 1 m in size.\n"
    );
    accuracy(runs)?;
    choice(runs / 5)?;
    incremental()
}

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

fn accuracy(runs: u64) -> Result<(), Failure> {
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
            row(truth, name, family, count, curves, noise, runs)?;
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
) -> Result<(), Failure> {
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
    println!(
        "| {name} | {count} {place} | {noise:e} | {:.3} | {:.3} | {:.3} | {nees} | {} | {} | {:.2} |",
        rms * 1e3,
        bound * 1e3,
        rms / bound,
        sums.held,
        sums.failed,
        sums.milliseconds / n
    );
    Ok(())
}

fn choice(runs: u64) -> Result<(), Failure> {
    println!("\n## Choice of the family\n");
    println!(
        "Share of {runs} runs in which each family has the smallest Bayesian information criterion, out of sphere (4 parameters),"
    );
    println!(
        "ellipsoid (9), superquadric (11) and harmonics of degree 2 to 6 (9 to 49), as far as there are three equations for"
    );
    println!(
        "each parameter. The last body is in none of the families. Misfit is the mean over the runs of chi-squared of the chosen"
    );
    println!(
        "shape per degree of freedom: near 1 the shape explains its contacts, above it does not, and says so. Time is for all"
    );
    println!("fits of one choice.\n");
    println!(
        "| body | contacts | noise | sphere | ellipsoid | superquadric | harmonics, by degree | misfit | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (truth, name, _) in Truth::ALL {
        for (count, noise) in [(30, 1e-2), (100, 1e-2), (100, 1e-3), (300, 1e-3)] {
            let mut hits = [0.0; 12];
            let (mut milliseconds, mut misfit) = (0.0, 0.0);
            let mut families = ShapeFamily::candidates(count);
            families.retain(|family| family.parameters() <= 49);
            for seed in 0..runs {
                let mut s = Source::new(seed + 7000);
                let body = truth.body(&mut s)?;
                let normals = normals(count, false, &mut s);
                let contacts = measured(&body, &normals, noise, &mut s)?;
                let start = ThreadTime::now();
                let chosen = ShapeFit::choose(&contacts, &families, &FitOptions::default())?;
                milliseconds += start.elapsed().as_secs_f64() * 1e3;
                let statistics = chosen.best.statistics();
                misfit += statistics.chi_squared / statistics.degrees_of_freedom as f64 / runs as f64;
                let place = match chosen.best.family() {
                    ShapeFamily::Sphere => 0,
                    ShapeFamily::Ellipsoid => 1,
                    ShapeFamily::Superquadric => 2,
                    ShapeFamily::Harmonics { degree } => 1 + degree,
                };
                hits[place] += 1.0 / runs as f64;
            }
            let harmonics: Vec<String> = (2..=8)
                .filter(|degree| hits[1 + degree] > 0.0)
                .map(|degree| format!("{degree}: {:.2}", hits[1 + degree]))
                .collect();
            println!(
                "| {name} | {count} | {noise:e} | {:.2} | {:.2} | {:.2} | {} | {misfit:.2} | {:.0} |",
                hits[0],
                hits[1],
                hits[2],
                harmonics.join(", "),
                milliseconds / runs as f64
            );
        }
    }
    Ok(())
}

/// Cost of one more contact, and how far the running estimate is from the fit to all.
fn incremental() -> Result<(), Failure> {
    println!("\n## One contact at a time\n");
    println!(
        "1000 contacts on the ellipsoid 2.5, 2, 1 plus a ball of 0.3 (ellipsoid and superquadric: without the ball), noise 1e-3."
    );
    println!(
        "Cost per contact, with the fit from the start that it stands for, and the distance of the last running estimate from that"
    );
    println!("fit in the metric of its covariance (not for the superquadric, whose axes have many names).\n");
    println!("| family | us per contact | ms from the start | distance |");
    println!("|---|---|---|---|");
    let core = Ellipsoid::new(DVec3::new(2.5, 2.0, 1.0))?;
    let rounded = MinkowskiSum(core, Sphere::new(0.3)?);
    for family in [
        ShapeFamily::Sphere,
        ShapeFamily::Ellipsoid,
        ShapeFamily::Superquadric,
        ShapeFamily::Harmonics { degree: 4 },
        ShapeFamily::Harmonics { degree: 6 },
    ] {
        let harmonic = matches!(family, ShapeFamily::Harmonics { .. });
        let ball = Sphere::new(1.5)?;
        let body: &dyn SupportFunction = match family {
            ShapeFamily::Sphere => &ball,
            _ if harmonic => &rounded,
            _ => &core,
        };
        let mut s = Source::new(3);
        let normals = normals(1000, false, &mut s);
        let contacts = measured(body, &normals, 1e-3, &mut s)?;
        let start = ThreadTime::now();
        let mut running = IncrementalFit::new(family, FitOptions::default());
        let mut last = None;
        for contact in &contacts {
            last = running.insert(*contact)?.or(last);
        }
        let each = start.elapsed().as_secs_f64() * 1e6 / 1000.0;
        let start = ThreadTime::now();
        let fit = ShapeFit::of(&contacts, family, &FitOptions::default())?;
        let whole = start.elapsed().as_secs_f64() * 1e3;
        let error = last.ok_or("no estimate")? - fit.parameters();
        let distance =
            fit.covariance().clone().cholesky().map_or(f64::NAN, |c| error.dot(&c.solve(&error)).sqrt());
        let distance =
            if family == ShapeFamily::Superquadric { String::new() } else { format!("{distance:.4}") };
        println!("| {family} | {each:.0} | {whole:.1} | {distance} |");
    }
    Ok(())
}
