//! Random variants of the scene of three tilting palms, with friction on all three: which share a simulation gets through, and
//! what it keeps to.
//!
//! Arguments: variants, first seed, tolerance. An ellipsoid at rest where it lies lowest on three flat palms through one point;
//! each palm in turn, in random order, is tilted about its own horizontal axis and back. Writes a Markdown table.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, PalmFrame, PalmSurface, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::{
    BodyState, ContactScene, ContactSimulation, ContactStart, MassProperties, PalmDrive, SampleTimes,
    ScenePalm,
};
use recon_benches::departures::Departures;
use shape_bounds::generators::Source;
use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

pub(crate) const FRICTION: f64 = 0.3;
const GRAVITY: f64 = 9.81;

/// Seconds; why it is refused, or how many changes of modes there are, the angle that it is turned by, and departures.
type Run = (f64, Option<String>, Option<(usize, f64, [f64; 4])>);

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mut words = crate::words();
    let wanted: usize = words.next().map_or(Ok(140), |s| s.parse())?;
    let mut source = Source::new(words.next().map_or(Ok(1), |s| s.parse())?);
    let tolerance: f64 = words.next().map_or(Ok(1e-8), |s| s.parse())?;
    let (mut through, mut refused, mut worst) = (0, Vec::new(), Departures::default());
    let (mut times, mut turns, mut changes) = (Vec::new(), Vec::new(), 0);
    for k in 0..wanted {
        let (scene, body, duration) = variant(&mut source)?;
        let run = crate::rows::row(|| -> Result<Run, Box<dyn Error>> {
            let started = Instant::now();
            let times_of_samples = SampleTimes { duration, rate: 500.0 };
            let run = scene.simulate(&ContactStart::touching(body), times_of_samples, tolerance);
            let seconds = started.elapsed().as_secs_f64();
            Ok(match run {
                Err(error) => (seconds, Some(error.to_string()), None),
                Ok(run) => {
                    let Departures { gap, cone, creep, energy } = Departures::of(&scene, &run);
                    (seconds, None, Some((run.events.len(), turn(&run), [gap, cone, creep, energy])))
                }
            })
        })?;
        let Some((seconds, error, run)) = run else { continue };
        times.push(seconds);
        refused.extend(error.map(|error| format!("variant {k}: {error}")));
        if let Some((events, turn, [gap, cone, creep, energy])) = run {
            through += 1;
            changes += events;
            turns.push(turn);
            worst = worst.or(Departures { gap, cone, creep, energy });
        }
    }
    for sorted in [&mut times, &mut turns] {
        sorted.sort_by(f64::total_cmp);
    }
    println!("# Three tilting palms with friction on all three");
    println!();
    println!(
        "{wanted} random variants (slopes of 35 to 55 degrees, tilts of 0.2 to 0.45 rad in 0.4 to 0.8 s, order of the palms, ellipsoids; \
         friction {FRICTION}) at tolerance {tolerance:e}: {through} are through, with {changes} changes of modes. Half of them turn the \
         object by more than {:.0} degrees. A run takes {:.2} s in the median, {:.2} s at most.",
        turns.get(turns.len() / 2).copied().unwrap_or(f64::NAN).to_degrees(),
        times.get(times.len() / 2).copied().unwrap_or(f64::NAN),
        times.last().copied().unwrap_or(f64::NAN),
    );
    println!();
    println!(
        "| overlap or gap in contact (m) | force beyond its cone (N) | slip of a sticking contact (m/s) | energy not accounted for (J) |"
    );
    println!("|---|---|---|---|");
    println!("| {:.1e} | {:.1e} | {:.1e} | {:.1e} |", worst.gap, worst.cone, worst.creep, worst.energy);
    if !refused.is_empty() {
        println!();
        refused.iter().for_each(|line| println!("- {line}"));
    }
    Ok(())
}

/// Angle between the first orientation and the last, rad.
fn turn(run: &ContactSimulation) -> f64 {
    let [first, last] =
        [run.instants.first(), run.instants.last()].map(|now| now.map_or(DQuat::NAN, |n| n.state.body.R_WO));
    first.angle_between(last)
}

/// A scene, its body at rest, and how long it lasts, s.
pub(crate) fn variant(
    source: &mut Source,
) -> Result<(ContactScene<Ellipsoid>, BodyState, f64), Box<dyn Error>> {
    let largest = source.between(0.03, 0.06);
    let axes = largest * DVec3::new(1.0, source.between(0.6, 1.0), source.between(0.5, 0.9));
    // Of the density of water.
    let mass = 1000.0 * TAU * 2.0 / 3.0 * axes.element_product();
    let (body, mass) = (Ellipsoid::new(axes)?, MassProperties::uniform_ellipsoid(mass, axes)?);
    let mut order = [0, 1, 2];
    for k in (1..3).rev() {
        order.swap(k, source.below(k + 1));
    }
    let (ramp, pause) = (source.between(0.4, 0.8), source.between(0.0, 0.2));
    let mut palms = Vec::new();
    for place in order {
        let slope = source.between(35.0, 55.0).to_radians();
        let azimuth = f64::from(palms.len() as u32) * TAU / 3.0 + source.between(-0.2, 0.2);
        palms.push(palm(azimuth, slope, source.between(0.2, 0.45), (place, ramp, pause))?);
    }
    let scene = ContactScene::new(body, mass, palms, GRAVITY)?;
    let normals = [0, 1, 2].map(|i| scene.palm_state(i, 0.0, &scene.palms_at_start()[i]).R_WP.z_axis);
    let start = recon_benches::palms::lowest(scene.body(), normals, source.rotation());
    Ok((scene, start, 4.0 * ramp + 3.0 * pause + 0.2))
}

/// A palm that is tilted flatter and back, as the `place`-th of three.
fn palm(
    azimuth: f64,
    slope: f64,
    tilt: f64,
    (place, ramp, pause): (usize, f64, f64),
) -> Result<ScenePalm, Box<dyn Error>> {
    let frame = PalmFrame::from_azimuth_slope(azimuth, slope);
    let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&frame.rotation()))?;
    // About the horizontal axis that takes the normal towards the vertical.
    let axis = Direction::new(frame.n.cross(DVec3::Z))?;
    let begins = place as f64 * (ramp + pause);
    let part = |height: f64, start: f64| MotionPart::Turn {
        pivot: DVec3::ZERO,
        axis,
        law: MotionLaw::Ramp { height, start, duration: ramp },
    };
    let parts = vec![part(tilt, begins), part(-tilt, begins + ramp + pause)];
    Ok(ScenePalm {
        surface: PalmSurface::Plane,
        drive: PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts }),
        friction: FRICTION,
    })
}
