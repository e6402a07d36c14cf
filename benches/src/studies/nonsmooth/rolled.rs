//! Cubes and wedges that three tilting palms with friction roll over, by the equations of motion; the motion is taken as known.

use super::Failure;
use super::tally::confusion;
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::{ContactMode, ContactSimulation};
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::features::{FeatureKind, FeatureOptions, Features};
use recon::shape_bounds::noise::{CertainBounds, ContactNoise, NoisyContact};
use recon_io::Scene;
use shape_bounds::generators::{Source, Touched, TouchedBody};
use std::fmt::Write as _;

/// The power by which sides bulge, and the rounding, m: a contact crosses a side while the normal turns by less than a mrad.
const SHARPNESS: f64 = 3000.0;
const ROUNDING: f64 = 1e-4;
/// Slope of the palms and how far each is tilted, rad.
const SLOPE: f64 = 0.7;
const TILT: f64 = 0.5;
/// Allowed local error of the simulation.
const TOLERANCE: f64 = 1e-6;
/// Weight over that of the nearest corner from which another one counts.
const ALONE: f64 = 1e-3;

pub(super) fn text(runs: u64, seed: u64) -> Result<String, Failure> {
    let mut text = String::from(include_str!("rolled.md"));
    text.push_str(
        "| body | noise | runs (no motion) | corners: contacts, told right, open | edges | faces | smooth told | corners found | both bounds hold |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    let cube = TouchedBody::cuboid(DVec3::splat(0.03), 0.0);
    let wedge = TouchedBody::wedge(0.08, 0.06, 0.03);
    for (name, body) in [("cube", cube), ("wedge", wedge)] {
        for noise in super::NOISE {
            let mut of = Row::default();
            for run in 0..runs {
                of.add(&body, noise, seed + run)?;
            }
            writeln!(text, "| {name} | {noise:e} | {}", of.text())?;
        }
    }
    Ok(text)
}

#[derive(Default)]
struct Row {
    confusion: [[usize; 5]; 4],
    runs: usize,
    without: usize,
    corners: usize,
    hold: usize,
}

impl Row {
    fn add(&mut self, body: &TouchedBody, noise: f64, seed: u64) -> Result<(), Failure> {
        let TouchedBody::Polytope(corners, _) = body else { return Ok(()) };
        let scene = Scene::parse(&scene(corners, seed)?)?;
        let (start, times) = scene.contact_start()?;
        // Rigid bodies with friction may have no motion, or several.
        let Ok(made) = scene.contact_scene()?.simulate(&start, times, TOLERANCE) else {
            self.without += 1;
            return Ok(());
        };
        let touched = touched(body, corners, &made, noise, seed);
        let features = Features::find(&touched.curves, &FeatureOptions::default())?;
        let bounds =
            CertainBounds::from_features(&touched.curves, &FeatureOptions::default(), super::CONFIDENCE)?;
        // The body that was simulated: between the polytope and what bulges.
        let inside = bounds.lower.as_ref().and_then(|lower| lower.solid()).is_none_or(|solid| {
            solid.vertices().iter().all(|v| body.outside(*v) <= ROUNDING + bulge(corners))
        });
        let around = bounds.upper.as_ref().is_none_or(|upper| {
            upper.face_half_spaces().iter().all(|h| {
                let n = h.normal.get();
                body.support(n) <= n.dot(h.point) + h.margin
            })
        });
        self.hold += usize::from(inside && around);
        self.runs += 1;
        self.corners += features.corners.len();
        for (sum, more) in
            self.confusion.iter_mut().flatten().zip(confusion(&touched, &features).as_flattened())
        {
            *sum += more;
        }
        Ok(())
    }

    fn text(&self) -> String {
        let row = |k: usize| {
            let all: usize = self.confusion[k].iter().sum();
            let share = |told: usize| 100.0 * self.confusion[k][told] as f64 / all.max(1) as f64;
            format!("{all}, {:.2} %, {:.2} %", share(k), share(4))
        };
        let smooth: usize = (1..4).map(|k| self.confusion[k][0]).sum();
        format!(
            "{} ({}) | {} | {} | {} | {smooth} | {} | {} |",
            self.runs,
            self.without,
            row(1),
            row(2),
            row(3),
            self.corners,
            self.hold
        )
    }
}

/// By how much the bulging polytope reaches beyond the other where most corners share a side, m.
fn bulge(corners: &[DVec3]) -> f64 {
    let size = corners.iter().map(|v| v.length()).fold(0.0, f64::max);
    size * ((corners.len() as f64).powf(1.0 / SHARPNESS) - 1.0)
}

fn list(v: &[f64]) -> String {
    let cells: Vec<String> = v.iter().map(|x| format!("{x:.17e}")).collect();
    format!("[{}]", cells.join(", "))
}

/// The scene: as `recon-cli/scenes/three-tilting-palms.toml`, with another body.
fn scene(corners: &[DVec3], seed: u64) -> Result<String, Failure> {
    let mut source = Source::new(seed ^ 0x0D1E);
    let turn: DQuat = source.rotation();
    let azimuth = |i: f64| (90.0 + 120.0 * i).to_radians();
    let normals = [0.0, 1.0, 2.0]
        .map(|i| DVec3::new(SLOPE.sin() * azimuth(i).cos(), SLOPE.sin() * azimuth(i).sin(), SLOPE.cos()));
    let body = recon::contact_kinematics::RoundedPolytope::new(corners.to_vec(), ROUNDING, SHARPNESS)?;
    let height = |n: DVec3| Ok::<f64, Failure>(body.value(Direction::new(-(turn.inverse() * n))?));
    let heights = DVec3::new(height(normals[0])?, height(normals[1])?, height(normals[2])?);
    let position = DMat3::from_cols(normals[0], normals[1], normals[2]).transpose().inverse() * heights;
    let mut text = String::from(
        "gravity = 9.81\n[object]\nmass = 0.2\nprincipal_moments = [1.2e-4, 1.3e-4, 1.4e-4]\n[palms]\nfriction = 0.3\n",
    );
    for (i, n) in normals.iter().enumerate() {
        let axis = DVec3::Z.cross(*n).normalize();
        writeln!(
            text,
            "[[palm]]\nkind = \"flat\"\npose = {{ position = [0.0, 0.0, 0.0], normal = {} }}\nmotion = [",
            list(&n.to_array())
        )?;
        let begin = 0.5 * i as f64;
        for (height, start) in
            [(TILT, begin), (-TILT, begin + 0.8), (TILT, begin + 1.5), (-TILT, begin + 2.3)]
        {
            writeln!(
                text,
                "  {{ turn = {}, pivot = [0.0, 0.0, 0.0], law = {{ kind = \"ramp\", height = {height:?}, start = {start:?}, duration = 0.8 }} }},",
                list(&axis.to_array())
            )?;
        }
        text += "]\n";
    }
    let shape: Vec<String> = corners.iter().map(|v| list(&v.to_array())).collect();
    writeln!(
        text,
        "[simulation]\nduration = 4.0\nsample_rate = 250.0\norientation = {}\nposition = {}\nshape = {{ kind = \"polytope\", corners = [{}], radius = {ROUNDING:e}, sharpness = {SHARPNESS:?} }}",
        list(&[turn.w, turn.x, turn.y, turn.z]),
        list(&position.to_array()),
        shape.join(", ")
    )?;
    Ok(text)
}

/// Contacts in body axes with noise (a share of the size, and as many rad), and the truth.
fn touched(
    body: &TouchedBody,
    corners: &[DVec3],
    made: &ContactSimulation,
    noise: f64,
    seed: u64,
) -> Touched {
    let mut source = Source::new(seed ^ 0x7011);
    let size = body.size();
    let stated = ContactNoise::isotropic(noise * size, noise);
    let mut all = Touched::default();
    for palm in 0..3 {
        let (mut curve, mut exact, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
        for now in made.instants.iter().filter(|now| now.modes[palm] != ContactMode::Off) {
            let (n, point) = (now.contacts[palm].n_O, now.contacts[palm].jet.point);
            let (a, b) = n.tangent_basis();
            let turned = n.get() + (a * source.normal() + b * source.normal()) * noise;
            let contact = ContactSample {
                point: point + source.normal3() * (noise * size),
                normal: Direction::new_unchecked(turned.normalize()),
            };
            curve.push(NoisyContact { contact, noise: stated });
            exact.push(ContactSample { point, normal: n });
            kinds.push(kind(corners, n.get()));
        }
        all.curves.push(curve);
        all.exact.push(exact);
        all.kinds.push(kinds);
    }
    all
}

/// By the corners that have a share in the contact.
fn kind(corners: &[DVec3], n: DVec3) -> FeatureKind {
    let top = corners.iter().map(|v| n.dot(*v)).fold(0.0, f64::max);
    let weights = corners.iter().map(|v| (n.dot(*v).max(0.0) / top).powf(SHARPNESS));
    match weights.filter(|weight| *weight > ALONE).count() {
        0 | 1 => FeatureKind::Corner,
        2 => FeatureKind::Edge,
        _ => FeatureKind::Face,
    }
}
