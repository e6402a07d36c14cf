//! The bodies, and one corner of many radii.

use super::Failure;
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::features::{FeatureKind, FeatureOptions, Features};
use recon::shape_bounds::noise::{ContactNoise, NoisyContact};
use recon_io::{FigureCurve, FigurePanel};
use shape_bounds::generators::{Source, TouchedBody};
use std::fmt::Write as _;

/// A kind of body, of which each seed makes one.
pub(super) struct Named {
    pub(super) name: &'static str,
    make: fn(&mut Source) -> TouchedBody,
}

impl Named {
    pub(super) fn body(&self, seed: u64) -> TouchedBody {
        (self.make)(&mut Source::new(seed ^ 0xB0D1))
    }
}

fn axes(s: &mut Source) -> DVec3 {
    DVec3::new(s.between(0.3, 0.6), s.between(0.3, 0.6), s.between(0.3, 0.6))
}

/// Cubes, wedges, rounded boxes (radius of a fifth of the least half edge or more), and ellipsoids, which have none.
pub(super) const BODIES: [Named; 4] = [
    Named { name: "cube", make: |s| TouchedBody::cuboid(DVec3::splat(s.between(0.3, 0.6)), 0.0) },
    Named {
        name: "wedge",
        make: |s| TouchedBody::wedge(s.between(0.8, 1.3), s.between(0.6, 1.0), s.between(0.3, 0.6)),
    },
    Named {
        name: "rounded box",
        make: |s| {
            let half = axes(s);
            TouchedBody::cuboid(half, half.min_element() * s.between(0.2, 0.4))
        },
    },
    Named { name: "ellipsoid", make: |s| TouchedBody::Ellipsoid(axes(s)) },
];

/// Contacts of the corner whose radius varies, and how far its normals sweep in two directions, rad.
const SWEPT: (u32, f64) = (100, 0.4);
/// Radii over the deviation to which the contacts tell one.
const RADII: [f64; 9] = [0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0];

/// Deviation to which a radius is told along one direction, as a share of the size.
fn resolved(noise: f64) -> f64 {
    noise / (SWEPT.1 * (0.5 * f64::from(SWEPT.0)).sqrt())
}

fn corner(radius: f64, noise: f64, seed: u64) -> Vec<Vec<NoisyContact>> {
    let mut source = Source::new(seed);
    let stated = ContactNoise::isotropic(noise, noise);
    let turn = source.rotation();
    let mut contact = |k: u32| {
        let t = f64::from(k) * 0.12;
        let n = turn * DVec3::new(SWEPT.1 * t.sin(), SWEPT.1 * (1.3 * t).cos(), 1.0).normalize();
        let turned = (n + source.normal3().reject_from_normalized(n) * noise).normalize();
        let point = turn * DVec3::Z + radius * n + source.normal3() * noise;
        NoisyContact {
            contact: ContactSample { point, normal: Direction::new_unchecked(turned) },
            noise: stated,
        }
    };
    let curve = (0..SWEPT.0).map(&mut contact).collect();
    let far =
        ContactSample { point: -(turn * DVec3::Z), normal: Direction::new_unchecked(-(turn * DVec3::Z)) };
    vec![curve, vec![NoisyContact { contact: far, noise: stated }]]
}

/// Of corners of radii about what noise lets tell: how many are told to be corners, and smooth; four times as many runs.
pub(super) fn rounding_table(runs: u64, seed: u64) -> Result<(String, FigurePanel), Failure> {
    let mut text = String::from(
        "One corner, swept by 100 contacts over ±0.4 rad in two directions; its radius in deviations to which these contacts tell \
         one along one direction (0.35 of the noise of a point).\n\n| noise | radius, deviations | corner | smooth | edge | face | open |\n|---|---|---|---|---|---|---|\n",
    );
    let mut lines = [("corner", Vec::new()), ("smooth", Vec::new()), ("open", Vec::new())];
    for noise in super::NOISE {
        for radius in RADII {
            let counts = crate::rows::row(|| -> Result<[u64; 5], Failure> {
                let mut counts = [0; 5];
                for run in 0..4 * runs {
                    let curves = corner(radius * resolved(noise), noise, seed + 10_000 + run);
                    let found = Features::find(&curves, &FeatureOptions::default())?;
                    // The kind that most of the curve is told to be.
                    let most = found.runs.iter().filter(|r| r.curve == 0).max_by_key(|r| r.count);
                    let kind = most.and_then(|run| run.kind);
                    counts[kind.map_or(4, |kind: FeatureKind| kind as usize)] += 1;
                }
                Ok(counts)
            })?;
            let Some(counts) = counts else { continue };
            let share = |k: usize| 100.0 * counts[k] as f64 / (4 * runs) as f64;
            writeln!(
                text,
                "| {noise:e} | {radius} | {:.1} % | {:.1} % | {:.1} % | {:.1} % | {:.1} % |",
                share(1),
                share(0),
                share(2),
                share(3),
                share(4)
            )?;
            if noise == super::NOISE[1] {
                for ((_, points), k) in lines.iter_mut().zip([1, 0, 4]) {
                    points.push([radius, share(k)]);
                }
            }
        }
    }
    let curves =
        lines.map(|(name, points)| FigureCurve { name: name.to_owned(), points, ..FigureCurve::default() });
    let panel = FigurePanel {
        title: "A corner with a radius, noise 1 %".to_owned(),
        axes: ["radius, deviations".to_owned(), "told, %".to_owned()],
        curves: curves.to_vec(),
        ..FigurePanel::default()
    };
    Ok((text, panel))
}
