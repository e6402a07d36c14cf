//! Readings from logs of MuJoCo with truth: forces and slips with noise.

use super::{Moment, settle};
use crate::Random;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix2, Matrix2x6, Matrix6, Vector2, Vector6};
use recon::contact_kinematics::SurfacePose;
use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::{ContactReading, ContactSeen, ContactSlip};
use recon::observer::contacts::stream::{ForceReading, PalmSensed};
use std::collections::HashMap;

/// Of each component of a force, of its size.
const FORCE_NOISE: f64 = 0.02;
/// Of velocity and angular velocity of the body, in shares of `sqrt(g l)` and `sqrt(g / l)`.
const TWIST_NOISE: [f64; 2] = [3e-3, 1e-2];
/// Time constant of errors that are correlated, s.
pub const TWIST_CORRELATION: f64 = 0.05;
const GRAVITY: f64 = 9.81;
/// Own error of each slip beside that of the twist where the twist's is shared, in shares of `sqrt(g l)`.
const OWN_NOISE: f64 = 3e-4;

/// How errors of slips come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlipNoise {
    /// No slip is read.
    None,
    /// Independent from sample to sample.
    White,
    /// With a time constant of 50 ms.
    Correlated,
    /// The same, and the classifier knows that slips share it.
    Shared,
}

/// A sample of a stream.
#[derive(Clone, Debug)]
pub struct Sensed {
    /// s.
    pub t: f64,
    /// What is read.
    pub palms: Vec<PalmSensed>,
    /// Modes of all palms.
    pub truth: Vec<ContactMode>,
}

/// Columns of a log by name.
#[derive(Clone, Debug)]
pub struct LoggedContacts {
    columns: HashMap<String, Vec<f64>>,
    palms: usize,
    /// Mean semi-axis of the body, m.
    length: f64,
}

impl LoggedContacts {
    /// From a table with a header, of a body with these semi-axes, m.
    ///
    /// # Panics
    /// Where the text is no table of numbers.
    #[must_use]
    pub fn parse(text: &str, axes: [f64; 3]) -> Self {
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap().split(',').collect();
        let mut values = vec![Vec::new(); names.len()];
        for line in lines {
            line.split(',').zip(&mut values).for_each(|(text, column)| column.push(text.parse().unwrap()));
        }
        let palms = names.iter().filter(|name| name.starts_with("mode_")).count();
        let columns = names.into_iter().map(str::to_owned).zip(values).collect();
        Self { columns, palms, length: axes.iter().sum::<f64>() / 3.0 }
    }

    /// How many palms there are.
    #[must_use]
    pub fn palms(&self) -> usize {
        self.palms
    }

    /// `sqrt(g l)` with the mean semi-axis `l`, m/s.
    #[must_use]
    pub fn natural_speed(&self) -> f64 {
        (GRAVITY * self.length).sqrt()
    }

    fn vector(&self, stem: &str, tail: &str, k: usize) -> DVec3 {
        let at = |axis: &str| self.columns[&format!("{stem}{axis}{tail}")][k];
        DVec3::new(at("x"), at("y"), at("z"))
    }

    /// What palms whose frames stay at the origin sense, with contacts off by `contact` (m) in each direction along the palm and forces by a share of
    /// themselves, and what is true.
    #[must_use]
    pub fn sensed(&self, contact: f64, share: f64, seed: u64) -> Vec<Sensed> {
        let mut normal = super::drawn::Normal::new(Random::new(seed));
        let mut draw = || DVec3::new(normal.draw(), normal.draw(), normal.draw());
        let all = (0..self.columns["t"].len()).map(|k| {
            let palm = |i: usize| {
                let tail = format!("_{i}");
                let [p, f, w_WP] = ["p", "f", "W"].map(|stem| self.vector(stem, &tail, k));
                let v = self.vector("Q", &tail, k);
                let R_WP = DQuat::from_xyzw(v.x, v.y, v.z, self.columns[&format!("Qw{tail}")][k]);
                let off = (contact * draw()).reject_from(R_WP * DVec3::Z);
                PalmSensed {
                    pose: SurfacePose::new(DVec3::ZERO, R_WP.normalize()).unwrap(),
                    twist: Some([DVec3::ZERO, w_WP]),
                    contact: p.is_finite().then_some(p + off),
                    force: ForceReading::Three(f + share * f.length() * draw()),
                }
            };
            Sensed {
                t: self.columns["t"][k],
                palms: (1..=self.palms).map(palm).collect(),
                truth: (1..=self.palms).map(|i| self.mode(i, k)).collect(),
            }
        });
        all.collect()
    }

    fn mode(&self, palm: usize, k: usize) -> ContactMode {
        match self.columns[&format!("mode_{palm}")][k] as u8 {
            0 => ContactMode::Off,
            1 => ContactMode::Slide,
            _ => ContactMode::Stick,
        }
    }

    /// Readings with noise of this seed.
    #[must_use]
    pub fn moments(&self, slips: SlipNoise, seed: u64) -> Vec<Moment> {
        let mut normal = super::drawn::Normal::new(Random::new(seed));
        let times = &self.columns["t"];
        let rate = (GRAVITY / self.length).sqrt();
        let deviations = Vector6::from_fn(|i, _| {
            if i < 3 { TWIST_NOISE[0] * self.natural_speed() } else { TWIST_NOISE[1] * rate }
        });
        let covariance = Matrix6::from_diagonal(&deviations.map(|d| d * d));
        let mut error = Vector6::from_fn(|i, _| deviations[i] * normal.draw());
        let mut moments = Vec::new();
        for k in 0..times.len() {
            let dt = if k == 0 { 1e-3 } else { times[k] - times[k - 1] };
            let fresh = Vector6::from_fn(|i, _| deviations[i] * normal.draw());
            let kept = if slips == SlipNoise::White { 0.0 } else { (-dt / TWIST_CORRELATION).exp() };
            error = kept * error + (1.0 - kept * kept).sqrt() * fresh;
            let (mut seen, mut slopes, mut truth) = (Vec::new(), Vec::new(), Vec::new());
            for i in 1..=self.palms {
                let tail = format!("_{i}");
                let mode = self.mode(i, k);
                truth.push(mode);
                if mode == ContactMode::Off {
                    seen.push(ContactSeen::Off);
                    slopes.push(Matrix2x6::zeros());
                    continue;
                }
                let (reading, slope) = self.reading(k, &tail, &error, &covariance, slips, &mut normal);
                seen.push(ContactSeen::Read(reading));
                slopes.push(slope);
            }
            if slips != SlipNoise::Shared {
                slopes.clear();
            }
            let settled = vec![true; self.palms];
            moments.push(Moment { dt, seen, slopes, covariance, truth, settled });
        }
        settle(&mut moments);
        moments
    }

    fn reading(
        &self,
        k: usize,
        tail: &str,
        error: &Vector6<f64>,
        covariance: &Matrix6<f64>,
        slips: SlipNoise,
        normal: &mut super::drawn::Normal,
    ) -> (ContactReading, Matrix2x6<f64>) {
        let of = |stem| self.vector(stem, tail, k);
        let (n, p, f) = (of("n"), of("p"), of("f"));
        let (t1, t2) = n.any_orthonormal_pair();
        let across = |v: DVec3| Vector2::new(t1.dot(v), t2.dot(v));
        let b = p - self.vector("cm", "", k);
        let palm = of("V") + of("W").cross(p - of("P"));
        let slip = self.vector("v", "", k) + self.vector("w", "", k).cross(b) - palm;
        // The slip of the twist (v, w) is T (v - b x w).
        let turns = DMat3::from_cols(b.cross(DVec3::X), b.cross(DVec3::Y), b.cross(DVec3::Z));
        let columns = [DVec3::X, DVec3::Y, DVec3::Z, -turns.x_axis, -turns.y_axis, -turns.z_axis];
        let slope = Matrix2x6::from_columns(&columns.map(across));
        let force_deviation = FORCE_NOISE * f.length();
        let force = f + force_deviation * DVec3::new(normal.draw(), normal.draw(), normal.draw());
        let own = OWN_NOISE * self.natural_speed();
        let mut velocity = across(slip) + slope * error;
        let mut of_slip = Matrix2::identity() * (own * own);
        if slips == SlipNoise::Shared {
            velocity += own * Vector2::new(normal.draw(), normal.draw());
        } else {
            of_slip += slope * covariance * slope.transpose();
        }
        let slip = (slips != SlipNoise::None).then_some(ContactSlip { velocity, covariance: of_slip });
        let reading = ContactReading {
            normal_force: force.dot(n),
            friction: across(force),
            force_deviation,
            slip,
            touches: true,
        };
        (reading, slope)
    }
}
