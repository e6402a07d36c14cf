//! Palm motions with the estimator in the loop, on seeded bodies: the runs behind the study `rolling_sensed`.

use crate::rolling::Timed;
use exploration::rolling::{
    HandsError, Look, RollEnd, RollPlanner, RollTask, SensedEnd, SensedError, SensedTask, SimulatedHands,
    Workspace, explore_sensed,
};
use exploration::{Goal, Heading, Knowledge, Source};
use glam::DVec2;
use recon::contact_kinematics::planar::{
    Ellipse, FourierBody, RadiusBounds, RadiusFunction, RadiusJet, RoundedPolygon,
};
use recon::object_dynamics::planar::{PlanarMass, PlanarObject};
use recon::shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::TAU;
use thiserror::Error;

/// Mean radius of the bodies, m.
const SIZE: f64 = 0.05;
/// Mass in kg.
const MASS: f64 = 0.2;
const GRAVITY: f64 = 9.81;
/// Samples a second: 36 in a natural time.
const RATE: f64 = 500.0;
/// Where the palms are at first, rad.
const PALMS: [f64; 2] = [0.7, 2.4];

/// A body about its centre of mass.
#[derive(Clone, Debug)]
pub enum Sensed {
    /// Axes to 2:1, the centre of mass off by up to 0.1 of the size.
    Ellipse(Ellipse),
    /// Three harmonics.
    Waves(FourierBody),
    /// 3 to 6 corners.
    Polygon(RoundedPolygon),
}

impl RadiusFunction for Sensed {
    fn jet(&self, theta: f64) -> RadiusJet {
        match self {
            Self::Ellipse(of) => of.jet(theta),
            Self::Waves(of) => of.jet(theta),
            Self::Polygon(of) => of.jet(theta),
        }
    }

    fn radius_bounds(&self) -> RadiusBounds {
        match self {
            Self::Ellipse(of) => of.radius_bounds(),
            Self::Waves(of) => of.radius_bounds(),
            Self::Polygon(of) => of.radius_bounds(),
        }
    }
}

/// Body number `seed`: the kinds take turns.
#[must_use]
pub fn sensed(seed: u64) -> Sensed {
    let s = &mut Source::new(seed);
    loop {
        let made = match seed % 3 {
            0 => {
                let axis = s.between(1.1, 2.0).sqrt();
                let off = DVec2::new(s.between(-0.1, 0.1), s.between(-0.1, 0.1)) * SIZE;
                Ellipse::new(SIZE * axis, SIZE / axis, off).ok().map(Sensed::Ellipse)
            }
            1 => {
                let mut waves = |first: f64| -> Vec<f64> {
                    let one = |k: u32| 0.25 * SIZE * s.normal() / f64::from(k * k + 1);
                    std::iter::once(first).chain((1..4).map(one)).collect()
                };
                let (cosines, sines) = (waves(SIZE), waves(0.0));
                let body = FourierBody::new(&cosines, &sines).ok();
                body.filter(|body| body.radius_bounds().min > 0.1 * SIZE).map(Sensed::Waves)
            }
            _ => {
                let count = 3 + (4.0 * s.unit()) as usize;
                let step = TAU / count as f64;
                let corners: Vec<DVec2> = (0..count)
                    .map(|k| {
                        DVec2::from_angle(step * (k as f64 + s.between(0.0, 0.5)))
                            * (SIZE * s.between(0.7, 0.9))
                    })
                    .collect();
                RoundedPolygon::new(&corners, 0.25 * SIZE, 0.1).ok().map(Sensed::Polygon)
            }
        };
        if let Some(body) = made {
            return body;
        }
    }
}

/// Noise of a run, and what palms are made of.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Standard deviation of a contact along its palm over the size of the body.
    pub contact: f64,
    /// Of a force along an axis over the weight; impulses over the time between samples likewise.
    pub force: f64,
    /// Coefficient of friction of both palms.
    pub friction: f64,
    /// Gap that is asked for.
    pub gap: f64,
    /// Motions at most.
    pub motions: usize,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The gap is proven.
    Proven,
    /// Radians or motions are spent.
    Budget,
    /// The planner found no motion.
    NotFound,
    /// The body left the palms.
    Lost,
    /// The simulation has no motion, or several.
    Stopped,
    /// Estimates are not relied on.
    Doubted,
}

/// What one run came to.
#[derive(Clone, Debug)]
pub struct Run {
    /// Radians, seconds and proven gap after each look.
    pub steps: Vec<[f64; 3]>,
    /// How it ended.
    pub end: End,
    /// Whether the body was between the bounds of every look.
    pub holds: bool,
    /// Motions.
    pub motions: usize,
    /// Looks that were not relied on.
    pub doubts: usize,
    /// Seconds of planning.
    pub planning: f64,
}

impl Run {
    /// Radians and seconds until the gap was `goal` or less.
    #[must_use]
    pub fn to(&self, goal: f64) -> Option<[f64; 2]> {
        self.steps.iter().find(|step| step[2] <= goal).map(|step| [step[0], step[1]])
    }
}

/// Why there is no run.
#[derive(Debug, Error)]
pub enum RunError {
    /// The scene.
    #[error(transparent)]
    Hands(#[from] HandsError),
    /// Constants of a body.
    #[error(transparent)]
    Mass(#[from] recon::object_dynamics::planar::PlanarMassError),
    /// The loop.
    #[error(transparent)]
    Loop(#[from] SensedError),
}

/// One run on body `seed`, which is let go at a seeded orientation.
///
/// # Errors
/// [`RunError`].
pub fn run(make: &dyn Fn(u64) -> Box<dyn RollPlanner>, seed: u64, of: Setting) -> Result<Run, RunError> {
    let (shape, mass) = (sensed(seed), PlanarMass::from_gyration(MASS, 0.45 * SIZE * SIZE)?);
    let workspace = Workspace::in_motion(2.0 * SIZE, GRAVITY);
    let object = PlanarObject { shape: shape.clone(), mass, gravity: GRAVITY };
    let phi = Source::new(seed).between(0.0, TAU);
    let hands = SimulatedHands::new(object, of.friction, workspace.length, PALMS, phi, RATE)?;
    let mut hands = hands.with_noise([of.contact * SIZE, of.force * MASS * GRAVITY], seed);
    let first = hands.start_phi();
    let sensors = hands.sensors(1e-6 * (SIZE * GRAVITY).sqrt());
    let roll = RollTask { motions: of.motions, radians: 40.0, ..RollTask::new(Goal::Gap(of.gap), workspace) };
    let task = SensedTask { roll, sensors, level: 0.95 };
    let mut planner = Timed { inner: make(seed), seconds: 0.0 };
    let (mut steps, mut holds, mut motions, mut doubts) = (Vec::new(), true, 0, 0);
    let ended = explore_sensed(&mut planner, &mut hands, &task, |step, look| {
        steps.push([step.radians, step.seconds, step.progress]);
        holds &= look.is_none_or(|look| contains(look, &shape, first));
        motions = step.motion;
        doubts += usize::from(step.doubt.is_some());
    })?;
    let end = match ended.short {
        None => End::Proven,
        Some(SensedEnd::Rolling(RollEnd::Budget)) => End::Budget,
        Some(SensedEnd::Rolling(RollEnd::NotFound { .. })) => End::NotFound,
        Some(SensedEnd::Rolling(RollEnd::Lost(_))) => End::Lost,
        Some(SensedEnd::Stopped(_)) => End::Stopped,
        Some(SensedEnd::Doubted { .. }) => End::Doubted,
    };
    Ok(Run { steps, end, holds, motions, doubts, planning: planner.seconds })
}

/// Whether the body, which stood at `first` rad at the first sample, is between the bounds, but for rounding, at 180 directions.
fn contains(look: &Look, shape: &Sensed, first: f64) -> bool {
    look.proven.bounds().is_none()
        || Direction::spread(180).into_iter().all(|u| {
            let (low, high) = look.proven.support(u);
            let h = shape.jet(u.angle() - first).r;
            low - 1e-9 <= h && h <= high + 1e-9
        })
}
