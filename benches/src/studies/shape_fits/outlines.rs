//! Outlines in the plane: how often right ones are refused, and how often wrong ones.

use super::Failure;
use glam::DVec2;
use recon::contact_kinematics::planar::{
    Circle, FourierBody, RadiusBounds, RadiusFunction, RadiusJet, RoundedPolygon,
};
use shape_bounds::exact_hull::planar::Direction;
use shape_bounds::fit::{FitOptions, NoiseLevel};
use shape_bounds::generators::Source;
use shape_bounds::planar::ContactSample;
use shape_bounds::planar::fit::{FitError, OutlineFamily, OutlineFit, TurnedEllipse};
use shape_bounds::planar::noise::{ContactNoise, NoisyContact, estimate_noise};
use std::f64::consts::TAU;

const UNKNOWN: FitOptions = FitOptions { noise_level: NoiseLevel::Estimated, smallest_radius: None };

type Body = Box<dyn RadiusFunction>;

/// Contacts at places all round, in their order, with the noise that they have stated.
fn measured(body: &dyn RadiusFunction, count: usize, noise: f64, s: &mut Source) -> Vec<NoisyContact> {
    let mut angles: Vec<f64> = (0..count).map(|_| s.between(0.0, TAU)).collect();
    angles.sort_by(f64::total_cmp);
    let contact = |angle: f64| {
        let point = body.point(angle) + DVec2::new(s.normal(), s.normal()) * noise;
        let normal = Direction::from_angle(angle + s.normal() * noise);
        NoisyContact {
            contact: ContactSample { point, normal },
            noise: ContactNoise::isotropic(noise, noise),
        }
    };
    angles.into_iter().map(contact).collect()
}

/// A seeded body of a family.
fn right(family: OutlineFamily, s: &mut Source) -> Result<Body, Failure> {
    let place = DVec2::new(s.normal(), s.normal());
    Ok(match family {
        OutlineFamily::Circle => Box::new(Circle::new(s.between(0.5, 2.0), place)?),
        OutlineFamily::Ellipse => {
            let squares = DVec2::new(s.between(0.5, 2.0), s.between(0.5, 2.0)).powf(2.0);
            let (mean, half) = (0.5 * (squares.x + squares.y), 0.5 * (squares.x - squares.y));
            let (sin, cos) = s.between(0.0, TAU).sin_cos();
            Box::new(TurnedEllipse::new(place, [mean + half * cos, half * sin, mean - half * cos])?)
        }
        // Radii of curvature of at least a tenth: 1 minus the swing of the waves.
        OutlineFamily::Fourier { order } => {
            let (mut cosines, mut sines) = (vec![1.0, place.x], vec![0.0, place.y]);
            for k in 2..=order {
                let swing = 0.6 / ((k * k - 1) * (order - 1)) as f64;
                cosines.push(s.between(-swing, swing));
                sines.push(s.between(-swing, swing));
            }
            Box::new(FourierBody::new(&cosines, &sines)?)
        }
    })
}

/// Whether the contacts refuse the family, which those that leave a parameter open do not; other errors stay errors.
fn refused<T>(fit: Result<T, FitError>) -> Result<bool, Failure> {
    match fit {
        Ok(_) | Err(FitError::Undetermined { .. }) => Ok(false),
        Err(
            FitError::Refuted { .. }
            | FitError::NoneFits { .. }
            | FitError::NotConverged { .. }
            | FitError::NoConvexBody { .. },
        ) => Ok(true),
        Err(error) => Err(error.into()),
    }
}

pub(super) fn false_alarms(runs: u64) -> Result<(), Failure> {
    let each = 10 * runs;
    println!("\n## Outlines: right families refused\n");
    println!(
        "Of {each} runs a row, a third each at noise 1e-3, 1e-2 and 3e-2, each with a new body about 1 m in size of the family that is"
    );
    println!("fitted. One in 10,000 is meant to be refused.\n");
    println!("| body | contacts | noise stated | noise unknown | noise estimated from the curve |");
    println!("|---|---|---|---|---|");
    for family in [OutlineFamily::Circle, OutlineFamily::Ellipse, OutlineFamily::Fourier { order: 4 }] {
        for count in [12, 60, 600] {
            crate::print_line(|| -> Result<String, Failure> {
                let mut alarms = [0; 3];
                for seed in 0..each {
                    let mut s = Source::new(seed + 50_000);
                    let body = right(family, &mut s)?;
                    let noise = [1e-3, 1e-2, 3e-2][seed as usize % 3];
                    let contacts = measured(body.as_ref(), count, noise, &mut s);
                    for (i, options) in [FitOptions::default(), UNKNOWN].iter().enumerate() {
                        alarms[i] += u32::from(refused(OutlineFit::of(&contacts, family, options))?);
                    }
                    let curve: Vec<ContactSample> = contacts.iter().map(|c| c.contact).collect();
                    if let Ok(estimated) = estimate_noise(&[curve], 0.95) {
                        let fit = OutlineFit::of(&estimated.concat(), family, &FitOptions::default());
                        alarms[2] += u32::from(refused(fit)?);
                    }
                }
                Ok(format!("| {family} | {count} | {} | {} | {} |", alarms[0], alarms[1], alarms[2]))
            })?;
        }
    }
    Ok(())
}

/// Two half ellipses with a common axis across.
struct Egg([TurnedEllipse; 2]);

impl RadiusFunction for Egg {
    fn jet(&self, theta: f64) -> RadiusJet {
        self.0[usize::from(theta.cos() < 0.0)].jet(theta)
    }
    fn radius_bounds(&self) -> RadiusBounds {
        let [a, b] = self.0.map(|half| half.radius_bounds());
        RadiusBounds { min: a.min.min(b.min), max: a.max.max(b.max) }
    }
}

/// Bodies of no family.
fn strangers() -> Result<[(&'static str, Body); 3], Failure> {
    let square = [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]].map(DVec2::from_array);
    let thin = [[0.7, 1e-3], [-0.7, 1e-3], [-0.7, -1e-3], [0.7, -1e-3]].map(DVec2::from_array);
    let half = |long: f64| TurnedEllipse::new(DVec2::ZERO, [long * long, 0.0, 0.49]);
    Ok([
        ("square of 1 grown by 0.2", Box::new(RoundedPolygon::new(&square, 0.2, 0.02)?)),
        ("egg: half ellipses 1 and 0.8 long, 0.7 wide", Box::new(Egg([half(1.0)?, half(0.8)?]))),
        ("stadium, 1.4 grown by 0.5", Box::new(RoundedPolygon::new(&thin, 0.5, 0.02)?)),
    ])
}

pub(super) fn power(runs: u64) -> Result<(), Failure> {
    println!("\n## Outlines: wrong families refused\n");
    println!(
        "Share of {runs} runs in which all families asked for are refused, with the noise stated and unknown. Auto: circle, ellipse"
    );
    println!("and waves to order 12, as far as there are two equations for each parameter.\n");
    println!("| body | contacts | noise | ellipse | waves to order 3 | auto |");
    println!("|---|---|---|---|---|---|");
    for (name, body) in strangers()? {
        for (count, noise) in [(12, 1e-2), (60, 1e-2), (60, 1e-3), (600, 1e-2), (600, 1e-3)] {
            crate::print_line(|| -> Result<String, Failure> {
                let mut row = format!("| {name} | {count} | {noise:e} |");
                let auto = OutlineFamily::candidates(count);
                for families in [&[OutlineFamily::Ellipse][..], &[OutlineFamily::Fourier { order: 3 }], &auto]
                {
                    let mut hits = [0; 2];
                    for seed in 0..runs {
                        let contacts = measured(body.as_ref(), count, noise, &mut Source::new(seed + 80_000));
                        for (i, options) in [FitOptions::default(), UNKNOWN].iter().enumerate() {
                            hits[i] += u32::from(refused(OutlineFit::choose(&contacts, families, options))?);
                        }
                    }
                    let [stated, unknown] = hits.map(|h| f64::from(h) / runs as f64);
                    row += &format!(" {stated:.2}, {unknown:.2} |");
                }
                Ok(row)
            })?;
        }
    }
    Ok(())
}
