//! Scenes whose contacts come, go, slide and stick: in space and in the plane, each drawn from its own seed.

use super::super::tilting_palms;
use glam::{DVec2, DVec3};
use nalgebra::{Matrix2x6, Vector2};
use recon::contact_kinematics::planar::{self as plane, FourierBody, RadiusFunction};
use recon::contact_kinematics::{Direction, MotionLaw, MotionPart, SurfaceMotion};
use recon::object_dynamics::planar as in_plane;
use recon::object_dynamics::{
    ContactInstant, ContactMode, ContactScene, ContactStart, PalmDrive, SampleTimes, ScenePalm,
};
use recon_benches::planar::scene::outline;
use shape_bounds::generators::Source;
use std::error::Error;
use std::f64::consts::{PI, TAU};

type Anything<T> = Result<T, Box<dyn Error>>;

const GRAVITY: f64 = 9.81;
/// Samples a second.
const RATE: f64 = 1000.0;
/// Coefficients of friction, one for all palms of a scene.
const FRICTION: [f64; 2] = [0.15, 0.8];
/// Sizes of planar bodies, m; those in space are ellipsoids of 3 to 6 cm.
const SIZES: [f64; 2] = [0.03, 0.06];
/// Length of a run in the plane, natural times.
const LASTS: f64 = 30.0;
/// Slip below which a contact that slides by its force sticks by its slip, natural speeds: that of the reference logs.
const CREEPS: f64 = 8e-4;

/// What one contact truly does at one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact {
    pub(super) mode: ContactMode,
    /// Its force is at the edge of the cone and its slip next to nothing: it slides and it sticks.
    pub(super) either: bool,
    /// Force on the body along the palm's normal and across it, N.
    pub(super) normal: f64,
    pub(super) friction: Vector2<f64>,
    /// Slip, m/s, and how it changes with the body's velocity and angular velocity.
    pub(super) slip: Vector2<f64>,
    pub(super) slope: Matrix2x6<f64>,
}

/// A run.
pub(super) struct Run {
    pub(super) friction: f64,
    /// Mean extent, m.
    pub(super) length: f64,
    /// N.
    pub(super) weight: f64,
    /// Of each contact at each sample, `1 / RATE` apart.
    pub(super) samples: Vec<Vec<Exact>>,
}

impl Run {
    /// Time between samples, s.
    pub(super) const DT: f64 = 1.0 / RATE;

    /// m/s.
    pub(super) fn natural_speed(&self) -> f64 {
        (GRAVITY * self.length).sqrt()
    }

    /// rad/s.
    pub(super) fn natural_rate(&self) -> f64 {
        (GRAVITY / self.length).sqrt()
    }

    /// The first scene of this seed that can be simulated to its end, and has samples in which something slides and something sticks.
    pub(super) fn drawn(spatial: bool, seed: u64) -> Anything<Self> {
        let mut source = Source::new(seed);
        loop {
            let run = if spatial { in_space(&mut source)? } else { in_plane(&mut source)? };
            let has = |run: &Self, mode| run.samples.iter().flatten().any(|exact: &Exact| exact.mode == mode);
            if let Some(run) = run.filter(|run| has(run, ContactMode::Slide) && has(run, ContactMode::Stick))
            {
                return Ok(run);
            }
        }
    }
}

/// Velocity of the body's material against that of palm `i` at their contact, m/s.
fn slip(now: &ContactInstant, i: usize) -> DVec3 {
    let (contact, body, palm) = (&now.contacts[i], &now.state.body, &now.palms[i]);
    let material = palm.v_WP + palm.w_WP.cross(contact.p_WC - palm.p_WP);
    body.v_WCm + body.w_WO.cross(contact.b_W) - material
}

/// Whether a contact slides by its force and sticks by its slip, of a body of this natural speed, m/s.
pub(crate) fn slides_and_sticks(now: &ContactInstant, i: usize, speed: f64) -> bool {
    let across = slip(now, i).reject_from_normalized(now.contacts[i].n);
    creeps(now.modes[i], across.length(), speed)
}

/// The same by the speed of its slip along the palm, m/s.
fn creeps(mode: ContactMode, slip: f64, speed: f64) -> bool {
    mode == ContactMode::Slide && slip < CREEPS * speed
}

/// One contact in space: `n` into the body, `arm` from the centre of mass.
fn exact(mode: ContactMode, [n, force, slip, arm]: [DVec3; 4], speed: f64) -> Exact {
    let (t1, t2) = n.any_orthonormal_pair();
    let across = |v: DVec3| Vector2::new(t1.dot(v), t2.dot(v));
    let turned = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis.cross(arm));
    let columns = [DVec3::X, DVec3::Y, DVec3::Z, turned[0], turned[1], turned[2]];
    Exact {
        mode,
        either: creeps(mode, across(slip).norm(), speed),
        normal: n.dot(force),
        friction: across(force),
        slip: across(slip),
        slope: Matrix2x6::from_columns(&columns.map(across)),
    }
}

/// Three palms that tilt in turn; in half of the scenes one of them also draws back and returns.
fn in_space(source: &mut Source) -> Anything<Option<Run>> {
    let (scene, body, duration) = tilting_palms::variant(source)?;
    let friction = source.between(FRICTION[0], FRICTION[1]);
    let mut palms: Vec<ScenePalm> =
        scene.palms().iter().map(|palm| ScenePalm { friction, ..palm.clone() }).collect();
    if source.between(0.0, 1.0) < 0.5 {
        let (which, away) = (source.below(3), source.between(0.002, 0.01));
        let begins = source.between(0.1, 0.6) * duration;
        draw_back(&mut palms[which], away, begins, source.between(0.03, 0.1))?;
    }
    let length = scene.body().semi_axes().element_sum() / 3.0;
    let (mass, speed) = (*scene.mass(), (GRAVITY * length).sqrt());
    let scene = ContactScene::new(*scene.body(), mass, palms, GRAVITY)?;
    let times = SampleTimes { duration, rate: RATE };
    let Ok(run) = scene.simulate(&ContactStart::touching(body), times, 1e-8) else { return Ok(None) };
    let samples = run.instants.iter().map(|now| {
        let one = |i: usize| {
            let contact = &now.contacts[i];
            exact(now.modes[i], [contact.n, now.forces[i], slip(now, i), contact.b_W], speed)
        };
        (0..now.modes.len()).map(one).collect()
    });
    Ok(Some(Run { friction, length, weight: mass.mass() * GRAVITY, samples: samples.collect() }))
}

fn draw_back(palm: &mut ScenePalm, away: f64, begins: f64, duration: f64) -> Anything<()> {
    if let PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts }) = &mut palm.drive {
        let direction = Direction::new(-(pose.R_WP * DVec3::Z))?;
        let part = |height: f64, start: f64| MotionPart::Shift {
            direction,
            law: MotionLaw::Ramp { height, start, duration },
        };
        parts.extend([part(away, begins), part(-away, begins + duration)]);
    }
    Ok(())
}

/// A body on two lines that swing about their hinge.
fn in_plane(source: &mut Source) -> Anything<Option<Run>> {
    let length = source.between(SIZES[0], SIZES[1]);
    let (drawn, mut cosines, mut sines) = outline(&mut |a: f64, b: f64| source.between(a, b));
    cosines.iter_mut().chain(&mut sines).for_each(|term| *term *= length / drawn);
    let gyration = length * length * source.between(0.3, 0.6);
    let mass =
        in_plane::PlanarMass::from_gyration(200.0 * length * length * source.between(0.5, 2.0), gyration)?;
    let (time, speed) = ((length / GRAVITY).sqrt(), (GRAVITY * length).sqrt());
    let friction = source.between(FRICTION[0], FRICTION[1]);
    let (wedge, middle) =
        (source.between(60.0, 120.0).to_radians(), source.between(-20.0, 20.0).to_radians());
    let first = PI / 2.0 + middle - wedge / 2.0;
    let mut palm = |angle: f64| -> Anything<in_plane::ScenePalm> {
        let (amplitude, phase) = (source.between(0.05, 0.4), source.between(0.0, TAU));
        let frequency = source.between(0.05, 0.5) / time;
        let law = MotionLaw::Sinusoid { mean: -amplitude * phase.sin(), amplitude, frequency, phase };
        let turn = plane::MotionPart::Turn { pivot: DVec2::ZERO, law };
        let pose = plane::SurfacePose::new(DVec2::ZERO, angle)?;
        let motion = plane::SurfaceMotion { pose, parts: vec![turn] };
        Ok(in_plane::ScenePalm { surface: plane::PalmSurface::Line, motion, friction })
    };
    let palms = vec![palm(first)?, palm(first + wedge - PI)?];
    let start = in_plane::BodyState {
        p_WCm: DVec2::from_angle(first + wedge / 2.0) * (length / (wedge / 2.0).sin()),
        phi0: source.between(0.0, TAU),
        omega0: source.between(-1.0, 1.0) / time,
        ..in_plane::BodyState::default()
    };
    let Ok(shape) = FourierBody::new(&cosines, &sines) else { return Ok(None) };
    if shape.radius_bounds().min < 0.1 * length {
        return Ok(None);
    }
    let object = in_plane::PlanarObject { shape, mass, gravity: GRAVITY };
    let scene = in_plane::ContactScene::new(object, palms)?;
    let Ok(body) = scene.place(0.0, start, &[0, 1]) else { return Ok(None) };
    let times: Vec<f64> = (0..=(LASTS * time * RATE) as usize).map(|k| k as f64 / RATE).collect();
    let start = in_plane::ContactStart { body, contacts: vec![0, 1] };
    let Ok(run) = scene.simulate(&start, &times, 1e-10) else { return Ok(None) };
    let lift = in_plane::in_space;
    let samples = run.instants.iter().map(|now| {
        let one = |i: usize| {
            let contact = &now.contacts[i];
            exact(now.modes[i], [contact.n, now.forces[i], now.slip(i), contact.b_W].map(lift), speed)
        };
        (0..now.modes.len()).map(one).collect()
    });
    Ok(Some(Run { friction, length, weight: mass.mass() * GRAVITY, samples: samples.collect() }))
}
