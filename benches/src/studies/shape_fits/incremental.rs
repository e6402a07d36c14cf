//! Contacts one at a time.

use super::Failure;
use super::bodies::{measured, normals};
use cpu_time::ThreadTime;
use glam::DVec3;
use recon::contact_kinematics::{Ellipsoid, MinkowskiSum, Sphere, SupportFunction};
use shape_bounds::fit::{FitOptions, IncrementalFit, ShapeFamily, ShapeFit};
use shape_bounds::generators::Source;

/// Cost of one more contact, and how far the running estimate is from the fit to all.
pub(super) fn incremental() -> Result<(), Failure> {
    println!("\n## One contact at a time\n");
    println!(
        "1000 contacts on the ellipsoid 2.5, 2, 1 plus a ball of 0.3 (ellipsoid and superquadric: without the ball), noise 1e-3."
    );
    println!(
        "Cost per contact, with the fit from the start that it stands for, and the distance of the last running estimate from that"
    );
    println!(
        "fit in the metric of its covariance (not for the superquadric, whose axes have many names). Harmonics are the nearest ones.\n"
    );
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
        crate::print_line(|| -> Result<String, Failure> {
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
            let fit = ShapeFit::nearest(&contacts, family, &FitOptions::default())?;
            let whole = start.elapsed().as_secs_f64() * 1e3;
            let error = last.ok_or("no estimate")? - fit.parameters();
            let distance =
                fit.covariance().clone().cholesky().map_or(f64::NAN, |c| error.dot(&c.solve(&error)).sqrt());
            let distance =
                if family == ShapeFamily::Superquadric { String::new() } else { format!("{distance:.4}") };
            Ok(format!("| {family} | {each:.0} | {whole:.1} | {distance} |"))
        })?;
    }
    Ok(())
}
