//! Contacts whose noise is not what is stated: levels that change along a curve, correlation, wrong contacts.

use super::Body;
use glam::DVec3;
use recon::contact_kinematics::{Direction, DirectionError};
use shape_bounds::ContactSample;
use shape_bounds::generators::Source;
use std::f64::consts::TAU;

/// Stated noise relative to the size of the body (points) and to 1 rad (normals), in turn.
const LEVELS: [f64; 3] = [1e-3, 1e-2, 1e-4];

/// How the true standard deviation goes along a curve, in parts of the stated one.
#[derive(Clone, Copy, Debug)]
pub enum Course {
    /// The same everywhere.
    Constant(f64),
    /// From 1 to this and back, once in a sine of the logarithm.
    Smooth(f64),
    /// 1 over half of the curve, this over the other.
    Step(f64),
    /// From 1 to this in proportion to a force: a rectified sine, three times.
    Force(f64),
    /// This over an eighth (0.12) of the curve, 1 elsewhere.
    Burst(f64),
}

impl Course {
    /// At the share `t` of the curve.
    fn level(self, t: f64, phase: f64) -> f64 {
        match self {
            Self::Constant(level) => level,
            Self::Smooth(ratio) => ratio.powf(0.5 + 0.5 * (TAU * (t + phase)).sin()),
            Self::Step(ratio) => {
                if (t + phase).fract() < 0.5 {
                    1.0
                } else {
                    ratio
                }
            }
            Self::Force(ratio) => 1.0 + (ratio - 1.0) * (TAU * (1.5 * t + phase)).sin().abs(),
            Self::Burst(ratio) => {
                if (t + phase).fract() < 0.12 {
                    ratio
                } else {
                    1.0
                }
            }
        }
    }
}

/// Contacts that are off by more than noise: by 5 to 40 deviations in the point, the normal or both.
#[derive(Clone, Copy, Debug)]
pub struct WrongContacts {
    /// How many of all are, on the average.
    pub share: f64,
    /// Whether two neighbours each are off in the same way.
    pub pairs: bool,
}

const LEAST_OFF: f64 = 5.0;
const MOST_OFF: f64 = 40.0;

impl WrongContacts {
    /// By how many deviations each contact of a curve is off; none for a right one.
    fn marks(self, count: usize, s: &mut Source) -> Vec<Option<f64>> {
        let mut marks = vec![None; count];
        let share = if self.pairs { self.share / 2.0 } else { self.share };
        for k in 0..count {
            if s.unit() < share {
                let deviations = s.between(LEAST_OFF, MOST_OFF);
                marks[k] = Some(deviations);
                if self.pairs && k + 1 < count {
                    marks[k + 1] = Some(deviations);
                }
            }
        }
        marks
    }
}

/// Noise of one row of the table.
#[derive(Clone, Copy, Debug)]
pub struct TrueNoise {
    /// Of the level.
    pub course: Course,
    /// From one contact to the next.
    pub correlation: f64,
    /// Beside noise.
    pub wrong: Option<WrongContacts>,
}

/// What was measured, what is stated about it, and the truth.
pub struct Case {
    /// What is touched.
    pub body: Body,
    /// As measured.
    pub curves: Vec<Vec<ContactSample>>,
    /// Stated standard deviation per axis, m.
    pub point_sd: f64,
    /// Stated standard deviation about each tangent axis, rad.
    pub normal_sd: f64,
    /// By how many deviations each contact is off beside its noise, if it is wrong.
    pub wrong: Vec<Vec<Option<f64>>>,
}

impl Case {
    /// Body, curves and level depend on the seed alone and are the same in all rows of the table.
    ///
    /// # Errors
    /// None: normals of bodies have a direction.
    pub fn of_seed(noise: TrueNoise, count: usize, seed: u64) -> Result<Self, DirectionError> {
        let mut s = Source::new(seed.wrapping_mul(7919) ^ 0xBEEF);
        let body = Body::random(seed, &mut s);
        let exact = body.curves(count, &mut s);
        let level = LEVELS[(seed / 3 % 3) as usize];
        Self::measured(body, &exact, level, noise, &mut s)
    }

    /// Exact curves of a body, measured at a stated level.
    ///
    /// # Errors
    /// For noise that leaves a normal no direction.
    pub fn measured(
        body: Body,
        exact: &[Vec<(DVec3, DVec3)>],
        level: f64,
        noise: TrueNoise,
        s: &mut Source,
    ) -> Result<Self, DirectionError> {
        let mut case = Self {
            body,
            curves: Vec::new(),
            point_sd: level * body.size(),
            normal_sd: level,
            wrong: Vec::new(),
        };
        for curve in exact {
            case.measure(curve, noise, s)?;
        }
        Ok(case)
    }

    fn measure(
        &mut self,
        exact: &[(DVec3, DVec3)],
        noise: TrueNoise,
        s: &mut Source,
    ) -> Result<(), DirectionError> {
        let phase = s.unit();
        let wrong = noise.wrong.map_or_else(|| vec![None; exact.len()], |w| w.marks(exact.len(), s));
        let mut common = Common { point: s.normal3(), normal: s.normal3() };
        let mut fault = Fault::of_point(s);
        let mut curve = Vec::new();
        for (k, (point, normal)) in exact.iter().enumerate() {
            let level = noise.course.level(k as f64 / exact.len() as f64, phase);
            common.advance(noise.correlation, s);
            if wrong[k].is_some() && (k == 0 || wrong[k - 1] != wrong[k]) {
                fault = Fault::random(s);
            }
            let off = |deviations| fault.errors(*normal, deviations);
            let [point_off, normal_off] = wrong[k].map_or([DVec3::ZERO; 2], off);
            let (a, b) = normal.any_orthonormal_pair();
            let tilt = a * (common.normal.x * level) + b * (common.normal.y * level) + normal_off;
            curve.push(ContactSample {
                point: *point + (common.point * level + point_off) * self.point_sd,
                normal: Direction::new(*normal + tilt * self.normal_sd)?,
            });
        }
        self.curves.push(curve);
        self.wrong.push(wrong);
        Ok(())
    }
}

/// Errors in deviations that go on from one contact to the next: an autoregression of order 1 with unit variance.
struct Common {
    point: DVec3,
    normal: DVec3,
}

impl Common {
    fn advance(&mut self, correlation: f64, s: &mut Source) {
        let fresh = (1.0 - correlation * correlation).sqrt();
        self.point = self.point * correlation + s.normal3() * fresh;
        self.normal = self.normal * correlation + s.normal3() * fresh;
    }
}

/// Where a wrong contact is off to.
struct Fault {
    point: DVec3,
    normal: DVec3,
    /// 0 the point, 1 the normal, 2 both.
    kind: usize,
}

impl Fault {
    fn of_point(s: &mut Source) -> Self {
        Self { point: s.direction(), normal: s.direction(), kind: 0 }
    }

    fn random(s: &mut Source) -> Self {
        let directions = Self::of_point(s);
        Self { kind: s.below(3), ..directions }
    }

    /// Errors of the point and of the normal, in deviations.
    fn errors(&self, normal: DVec3, deviations: f64) -> [DVec3; 2] {
        let point = if self.kind == 1 { DVec3::ZERO } else { self.point * deviations };
        let across = normal.cross(self.normal).normalize() * deviations;
        [point, if self.kind == 0 { DVec3::ZERO } else { across }]
    }
}
