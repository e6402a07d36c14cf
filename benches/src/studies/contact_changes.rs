//! Random changes of contact modes: whether gaps, friction cones, sticking and energy hold through all of them.
//!
//! Arguments: changes to see, first seed. An ellipsoid falls and spins into three planes at 55 degrees, with friction 0.02 to 0.4.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, PalmFrame, PalmSurface, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{
    BodyState, ContactInstant, ContactMode, ContactScene, ContactStart, MassProperties, PalmDrive,
    SampleTimes, ScenePalm,
};
use shape_bounds::generators::Source;
use std::error::Error;

const TOLERANCE: f64 = 1e-11;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mut words = crate::words();
    let wanted: usize = words.next().map_or(Ok(1000), |s| s.parse())?;
    let mut source = Source::new(words.next().map_or(Ok(1), |s| s.parse())?);
    let (mut changes, mut runs) = (0, 0);
    let mut worst = [0.0_f64; 4];
    let mut refused = Vec::new();
    while changes < wanted {
        let (scene, body) = falling(&mut source)?;
        let start = ContactStart { in_flight: true, ..ContactStart::touching(body) };
        runs += 1;
        match scene.simulate(&start, SampleTimes { duration: 2.0, rate: 500.0 }, TOLERANCE) {
            Err(error) => {
                refused.push(format!("run {runs}: {error}"));
            }
            Ok(run) => {
                changes += run.events.len();
                let first = scene.energy(&run.instants[0].state.body);
                for now in &run.instants {
                    let seen = violations(&scene, now, first);
                    worst = std::array::from_fn(|k| worst[k].max(seen[k]));
                }
            }
        }
    }
    println!("# Random changes of contact modes");
    println!();
    println!(
        "{changes} changes in {runs} runs of 2 s (tolerance {TOLERANCE:e}), {} of them refused.",
        refused.len()
    );
    println!();
    println!(
        "| worst overlap or gap in contact (m) | force beyond its cone (N) | slip of a sticking contact (m/s) | energy not accounted for (J of some 0.2) |"
    );
    println!("|---|---|---|---|");
    println!("| {:.1e} | {:.1e} | {:.1e} | {:.1e} |", worst[0], worst[1], worst[2], worst[3]);
    if !refused.is_empty() {
        println!();
        refused.iter().for_each(|line| println!("- {line}"));
    }
    Ok(())
}

fn violations(scene: &ContactScene<Ellipsoid>, now: &ContactInstant, first: f64) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for (i, mode) in now.modes.iter().enumerate() {
        let (contact, force) = (&now.contacts[i], now.forces[i]);
        let normal = contact.n.dot(force);
        let cone = contact.in_tangent(force).length() - scene.palms()[i].friction * normal;
        worst[0] = worst[0].max(if *mode == ContactMode::Off { -contact.gap } else { contact.gap.abs() });
        worst[1] = worst[1].max(cone).max(-normal);
        if *mode == ContactMode::Stick {
            worst[2] = worst[2].max(now.rates[i].slip.length());
        }
    }
    let energy = scene.energy(&now.state.body) - first - now.friction_work - now.palm_work - now.blow_work;
    worst[3] = energy.abs();
    worst
}

fn falling(source: &mut Source) -> Result<(ContactScene<Ellipsoid>, BodyState), Box<dyn Error>> {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let (body, mass) = (Ellipsoid::new(axes)?, MassProperties::uniform_ellipsoid(0.2, axes)?);
    let friction = source.between(0.02, 0.4);
    let mut palms = Vec::new();
    for k in 0..3 {
        let frame = PalmFrame::from_azimuth_slope(f64::from(k) * 2.1, 0.96);
        let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&frame.rotation()))?;
        let drive = PalmDrive::Prescribed(SurfaceMotion::immobile(pose));
        palms.push(ScenePalm { surface: PalmSurface::Plane, drive, friction });
    }
    let start = BodyState {
        p_WCm: DVec3::new(0.0, 0.0, 0.12),
        R_WO: source.rotation(),
        v_WCm: 0.2 * source.direction(),
        w_WO: source.between(0.0, 8.0) * source.direction(),
    };
    Ok((ContactScene::new(body, mass, palms, 9.81)?, start))
}
