//! Shares of states in which friction wedges sliding contacts, and whether the simulation names each of them.
//!
//! Arguments: states a field of the table, first seed. Random orientations of an ellipsoid (axes 5:4:3) on planes with random
//! normals (or three at 60 degrees, 120 apart), all sliding in random directions. Writes a Markdown table.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, PalmFrame, PalmSurface, SupportFunction, SurfaceMotion,
    SurfacePose,
};
use recon::object_dynamics::{
    BodyState, ContactMode, ContactScene, ContactSimulationError, ContactStart, MassProperties, PalmDrive,
    SampleTimes, ScenePalm, SceneState,
};
use shape_bounds::generators::Source;
use std::error::Error;

const FRICTIONS: [f64; 7] = [0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2];
const GRAVITY: f64 = 9.81;
/// How long each state is simulated, s.
const RUN: f64 = 1e-6;

/// How the palms stand.
#[derive(Clone, Copy)]
enum Palms {
    Random(usize),
    Funnel,
}

/// What was seen in one field of the table.
#[derive(Default)]
struct Tally {
    wedged: usize,
    integrated_through: usize,
    /// By the end of the run, and named.
    wedged_later: usize,
    stopped_otherwise: usize,
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mut words = crate::words();
    let states: usize = words.next().map_or(Ok(2900), |s| s.parse())?;
    let mut source = Source::new(words.next().map_or(Ok(1), |s| s.parse())?);
    println!("# States in which friction wedges sliding contacts");
    println!();
    println!("Share of {states} random states a field that have no P-matrix, with its standard deviation.");
    println!();
    println!("| palms | {} |", FRICTIONS.map(|mu| format!("mu {mu}")).join(" | "));
    println!("|---|{}", "---|".repeat(FRICTIONS.len()));
    let mut all = Tally::default();
    for (name, palms) in [
        ("one", Palms::Random(1)),
        ("two, random normals", Palms::Random(2)),
        ("three, random normals", Palms::Random(3)),
        ("three at 60 degrees", Palms::Funnel),
        ("four, random normals", Palms::Random(4)),
    ] {
        let mut row = Vec::new();
        for friction in FRICTIONS {
            let tally = field(palms, friction, states, &mut source)?;
            let share = tally.wedged as f64 / states as f64;
            let deviation = (share * (1.0 - share) / states as f64).sqrt();
            row.push(format!("{share:.4} ({deviation:.4})"));
            all.wedged += tally.wedged;
            all.integrated_through += tally.integrated_through;
            all.wedged_later += tally.wedged_later;
            all.stopped_otherwise += tally.stopped_otherwise;
        }
        println!("| {name} | {} |", row.join(" | "));
    }
    println!();
    println!(
        "Of {} states {} were wedged; {} of these were integrated through. Of the others {} were near to it and wedged within the \
         run of {:.0e} s, which was named; {} were stopped by another error.",
        states * FRICTIONS.len() * 5,
        all.wedged,
        all.integrated_through,
        all.wedged_later,
        RUN,
        all.stopped_otherwise
    );
    Ok(())
}

fn field(palms: Palms, friction: f64, states: usize, source: &mut Source) -> Result<Tally, Box<dyn Error>> {
    let mut tally = Tally::default();
    for _ in 0..states {
        let (scene, body) = sliding(palms, friction, source)?;
        let state = SceneState { t: 0.0, body, palms: scene.palms_at_start() };
        let modes = vec![ContactMode::Slide; scene.palms().len()];
        let wedged = scene.wedging(&state, &modes)? <= 0.0;
        let times = SampleTimes { duration: RUN, rate: RUN.recip() };
        let run = scene.simulate(&ContactStart::touching(body), times, 1e-8);
        tally.wedged += usize::from(wedged);
        match run {
            Ok(_) => tally.integrated_through += usize::from(wedged),
            Err(ContactSimulationError::Modes { .. }) if wedged => {}
            Err(ContactSimulationError::Modes { .. }) => tally.wedged_later += 1,
            Err(_) => tally.stopped_otherwise += 1,
        }
    }
    Ok(tally)
}

/// A body at rest on planes that slide under it, each in its own direction.
fn sliding(
    palms: Palms,
    friction: f64,
    source: &mut Source,
) -> Result<(ContactScene<Ellipsoid>, BodyState), Box<dyn Error>> {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let (body, mass) = (Ellipsoid::new(axes)?, MassProperties::uniform_ellipsoid(0.2, axes)?);
    let R_WO = source.rotation();
    let normals: Vec<DVec3> = match palms {
        Palms::Random(count) => (0..count).map(|_| source.direction()).collect(),
        Palms::Funnel => {
            let third = std::f64::consts::TAU / 3.0;
            let slope = std::f64::consts::FRAC_PI_3;
            (0..3).map(|k| PalmFrame::from_azimuth_slope(f64::from(k) * third, slope).n).collect()
        }
    };
    let palm = |n: &DVec3, source: &mut Source| -> Result<ScenePalm, Box<dyn Error>> {
        let c = R_WO * body.point(Direction::new(R_WO.inverse() * -*n)?);
        let pose = SurfacePose::new(c, DQuat::from_rotation_arc(DVec3::Z, *n))?;
        let law = MotionLaw::Steady { start: 0.0, rate: -1.0 };
        let angle = source.between(0.0, std::f64::consts::TAU);
        let (a, b) = Direction::new(*n)?.tangent_basis();
        let direction = Direction::new(a * angle.cos() + b * angle.sin())?;
        let motion = SurfaceMotion::Parts { pose, parts: vec![MotionPart::Shift { direction, law }] };
        Ok(ScenePalm { surface: PalmSurface::Plane, drive: PalmDrive::Prescribed(motion), friction })
    };
    let palms = normals.iter().map(|n| palm(n, source)).collect::<Result<Vec<_>, _>>()?;
    let start = BodyState { p_WCm: DVec3::ZERO, R_WO, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    Ok((ContactScene::new(body, mass, palms, GRAVITY)?, start))
}
