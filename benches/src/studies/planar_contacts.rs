//! Planar bodies on one to five palms with friction, thrown and shaken: what a run keeps to, and what it refuses.
//!
//! `cargo xtask study planar_contacts [SCENES [FIRST SEED]]` writes docs/planar-contacts.md.

use glam::DVec2;
use recon::contact_kinematics::MotionLaw;
use recon::contact_kinematics::planar::{
    Circle, Ellipse, FourierBody, MotionPart, PalmSurface, RadiusFunction, RoundedPolygon, SurfaceMotion,
    SurfacePose,
};
use recon::object_dynamics::ContactMode;
use recon::object_dynamics::planar::*;
use shape_bounds::generators::Source;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;
type Body = Box<dyn RadiusFunction>;

const GRAVITY: f64 = 9.81;
const TOLERANCE: f64 = 1e-12;
/// Simulated time of each scene, s.
const DURATION: f64 = 1.0;

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let scenes: u64 = words.next().map_or(Ok(2000), |a| a.parse())?;
    let first: u64 = words.next().map_or(Ok(3_000_000), |a| a.parse())?;
    println!("# Planar bodies on any palms\n");
    println!(
        "Made by `cargo xtask study planar_contacts`: {scenes} scenes a row from seed {first} on, {DURATION} s each, \
         relative tolerance {TOLERANCE:.0e}. Circles, ellipses, Fourier bodies and rounded polygons of about 50 mm are \
         thrown at one to five lines, fingertips and cups that shift and turn, with friction from 0 to the coefficient of \
         the row; scenes whose palms overlap are left out. Worst of all samples (200 a second). What is not simulated is \
         named with its time: palms that close on the body jam it.\n"
    );
    println!(
        "| largest mu | simulated | two answers | none | no P-matrix | other | changes of modes | blows | overlap, um | \
         cone left, of the largest force | creep, m/s | energy | momentum | ms a scene |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for largest_mu in [0.0, 0.3, 0.6, 1.2] {
        crate::print_line(|| -> Result<String, Failure> {
            let mut row = Row::default();
            for seed in first..first + scenes {
                run(&mut Source::new(seed), largest_mu, &mut row)?;
            }
            Ok(row.line(largest_mu))
        })?;
    }
    Ok(())
}

fn swing(s: &mut Source, largest: f64) -> MotionLaw {
    let (amplitude, phase) = (s.between(0.0, largest), s.between(0.0, TAU));
    MotionLaw::Sinusoid { mean: -amplitude * phase.sin(), amplitude, frequency: s.between(3.0, 15.0), phase }
}

/// A body of about 50 mm with its squared radius of gyration, m^2: that of a disc, give or take.
fn body(s: &mut Source) -> Result<(Body, f64), Failure> {
    let offset = DVec2::new(s.between(-0.005, 0.005), s.between(-0.005, 0.005));
    let gyration = 0.05 * 0.05 * s.between(0.3, 0.6);
    let shape: Body = match (s.between(0.0, 4.0)) as u32 {
        0 => Box::new(Circle::new(0.05, offset)?),
        1 => Box::new(Ellipse::new(0.05, s.between(0.035, 0.05), offset)?),
        2 => {
            let (a, b) = (s.between(-0.006, 0.006), s.between(-0.002, 0.002));
            Box::new(FourierBody::new(&[0.05, offset.x, a, b], &[0.0, offset.y, 0.002, 0.0])?)
        }
        _ => {
            let sides = s.between(3.0, 7.0) as u32;
            let corner = |i: u32| 0.045 * DVec2::from_angle(TAU * f64::from(i) / f64::from(sides)) + offset;
            let corners: Vec<_> = (0..sides).map(corner).collect();
            Box::new(RoundedPolygon::new(&corners, 0.005, 0.2)?)
        }
    };
    Ok((shape, gyration))
}

/// A palm in the direction `towards` of the origin, clear of a body there; the only one may be a cup.
fn palm(s: &mut Source, towards: f64, alone: bool, largest_mu: f64) -> Result<ScenePalm, Failure> {
    let out = DVec2::from_angle(towards);
    let (clear, choice) = (0.06 + s.between(0.002, 0.03), s.between(0.0, 3.0));
    let (surface, p_WP, angle) = if choice < 1.0 {
        // Its normal looks back at the origin, within 0.4 rad: the line stays clear of it.
        let turned = s.between(-0.4, 0.4);
        (PalmSurface::Line, out * clear, towards + FRAC_PI_2 + turned)
    } else if alone && choice < 2.0 {
        (PalmSurface::Cup { radius: s.between(0.3, 0.5) }, out * -0.1, 0.0)
    } else {
        let radius = s.between(0.005, 0.04);
        (PalmSurface::Arc { radius }, out * (clear + radius), 0.0)
    };
    let shift = MotionPart::Shift { direction: s.between(0.0, TAU), law: swing(s, 0.015) };
    let turn = MotionPart::Turn { pivot: p_WP, law: swing(s, 0.3) };
    let motion = SurfaceMotion { pose: SurfacePose::new(p_WP, angle)?, parts: vec![turn, shift] };
    Ok(ScenePalm { surface, motion, friction: s.between(0.0, largest_mu.max(f64::MIN_POSITIVE)) })
}

/// What a row of the table counts.
#[derive(Default)]
struct Row {
    simulated: u32,
    ambiguous: u32,
    inconsistent: u32,
    not_p: u32,
    other: u32,
    changes: usize,
    blows: usize,
    overlap: f64,
    cone: f64,
    creep: f64,
    energy: f64,
    momentum: f64,
    seconds: f64,
}

fn run(s: &mut Source, largest_mu: f64, row: &mut Row) -> Result<(), Failure> {
    let (shape, gyration) = body(s)?;
    let mass = PlanarMass::from_gyration(0.3, gyration)?;
    let count = s.between(1.0, 6.0) as usize;
    let mut palms = Vec::new();
    for i in 0..count {
        // The first one is below, the others around.
        let towards = -FRAC_PI_2 + TAU * i as f64 / count as f64 + s.between(-0.3, 0.3);
        let mut palm = palm(s, towards, count == 1, largest_mu)?;
        if largest_mu == 0.0 {
            palm.friction = 0.0;
        }
        palms.push(palm);
    }
    let scene = ContactScene::new(PlanarObject { shape: shape.as_ref(), mass, gravity: GRAVITY }, palms)?;
    let body = BodyState {
        phi0: s.between(0.0, TAU),
        v_WCm: DVec2::new(s.between(-0.5, 0.5), s.between(-0.5, 0.5)),
        omega0: s.between(-10.0, 10.0),
        ..BodyState::default()
    };
    let times: Vec<f64> = (0..=200).map(|k| DURATION * f64::from(k) / 200.0).collect();
    let begin = Instant::now();
    let simulation = scene.simulate(&ContactStart { body, contacts: vec![] }, &times, TOLERANCE);
    row.seconds += begin.elapsed().as_secs_f64();
    match simulation {
        Ok(simulation) => row.add(&scene, &simulation),
        Err(ContactSimulationError::Modes { source: ModeError::Ambiguous { .. }, .. }) => row.ambiguous += 1,
        Err(ContactSimulationError::Modes { source: ModeError::Inconsistent, .. }) => row.inconsistent += 1,
        Err(ContactSimulationError::Modes { source: ModeError::NotP { .. }, .. }) => row.not_p += 1,
        // Palms that overlap are no scene.
        Err(ContactSimulationError::PalmsOverlap { .. } | ContactSimulationError::Start(_)) => {}
        Err(error) => {
            eprintln!("{error}");
            row.other += 1;
        }
    }
    Ok(())
}

impl Row {
    fn add(&mut self, scene: &ContactScene<&dyn RadiusFunction>, simulation: &ContactSimulation) {
        self.simulated += 1;
        self.changes += simulation.events.len();
        self.blows += simulation.events.iter().filter(|e| e.blow_work.is_some()).count();
        let mass = scene.object().mass.mass();
        let largest = simulation.instants.iter().map(|s| scene.energy(&s.body).abs()).fold(0.0, f64::max);
        let balance =
            |s: &ContactInstant| scene.energy(&s.body) - s.palm_work - s.friction_work - s.blow_work;
        let momentum = |s: &ContactInstant| {
            s.body.v_WCm * mass - s.impulses.iter().sum::<DVec2>() + DVec2::new(0.0, mass * GRAVITY * s.t)
        };
        let first = &simulation.instants[0];
        for s in &simulation.instants {
            self.energy = self.energy.max((balance(s) - balance(first)).abs() / largest);
            self.momentum = self.momentum.max((momentum(s) - momentum(first)).length() / (mass * GRAVITY));
            let force = s.forces.iter().map(|f| f.length()).fold(mass * GRAVITY, f64::max);
            for (i, palm) in scene.palms().iter().enumerate() {
                let contact = &s.contacts[i];
                self.overlap = self.overlap.max(-contact.gap);
                let (normal, along) = (contact.n.dot(s.forces[i]), contact.t.dot(s.forces[i]));
                let beyond = (along.abs() - palm.friction * normal).max(-normal);
                self.cone = self.cone.max(beyond / force);
                match s.modes[i] {
                    ContactMode::Off => {}
                    ContactMode::Slide => self.overlap = self.overlap.max(contact.gap),
                    ContactMode::Stick => self.creep = self.creep.max(s.slip(i).length()),
                }
            }
        }
    }

    fn line(&self, largest_mu: f64) -> String {
        let scenes = self.simulated + self.ambiguous + self.inconsistent + self.not_p + self.other;
        format!(
            "| {largest_mu} | {} | {} | {} | {} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.2} |",
            self.simulated,
            self.ambiguous,
            self.inconsistent,
            self.not_p,
            self.other,
            self.changes,
            self.blows,
            1e6 * self.overlap,
            self.cone,
            self.creep,
            self.energy,
            self.momentum,
            1e3 * self.seconds / f64::from(scenes.max(1)),
        )
    }
}
