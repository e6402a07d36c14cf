//! The way of a log: touches, outline, paths, modes, friction.

use super::choose::{choose, extent};
use super::error::PushesError;
use super::face::Face;
use super::fit::{Fitted, Problem, UNKNOWNS};
use super::friction::{Learned, learn};
use super::modes::{REFERENCE, Window, windows};
use super::outline::{PushedOutline, covariance};
use super::path::{PathStep, Table};
use super::result::{PushFriction, PushInstant, PushResult, PushesEstimate};
use super::shape::{MOST, Shape};
use super::slopes::Slopes;
use super::touches::{FEWEST_TOUCHED, NoTouch, Touch, Touched, quantile};
use glam::DVec2;
use nalgebra::SMatrix;
use object_dynamics::pushing::{Nearest, PushLog};

/// Share of pushes in which the force may go against the motion: poses and clocks that are off turn a short push about.
const AGAINST: f64 = 0.25;
/// Directions of normals that count as one place: of a polygon most often a face each.
const PLACES: usize = 12;

/// Estimates outline, friction and modes from pushes by a finger of a radius in m.
///
/// The outline is in the frame of the poses. Constants are those that `docs/pushes.md` of the repository calibrates on simulated
/// pushes.
///
/// # Errors
/// [`PushesError`]: a radius that is none, or too few pushes in which the object was touched.
pub fn estimate_pushes(log: &PushLog, finger_radius: f64) -> Result<PushesEstimate, PushesError> {
    let mut found = Vec::new();
    let mut untouched: Vec<(u32, NoTouch)> = Vec::new();
    for push in log.pushes() {
        match Touched::find(push) {
            Ok(touched) => found.push(touched),
            Err(why) => untouched.push((push.number, why)),
        }
    }
    if found.len() < FEWEST_TOUCHED {
        let (touched, pushes) = (found.len(), log.pushes().len());
        return Err(PushesError::TooFew { touched, pushes, first: untouched.first().copied() });
    }
    let against = found.iter().filter(|touched| !touched.is_pushed()).count();
    if against as f64 > AGAINST * found.len() as f64 {
        return Err(PushesError::Against { against, pushes: found.len() });
    }
    let compliance = quantile(found.iter().map(|t| t.compliance).collect(), 0.5);
    let touches: Vec<[Touch; 2]> = found.iter().map(|t| t.touches(compliance)).collect();
    let (_, size) = extent(&touches);
    if !(finger_radius > 0.0 && finger_radius < size) {
        return Err(PushesError::Radius { value: finger_radius, most: size });
    }
    let nothing = PushesError::NoOutline { touches: 2 * touches.len() };
    let (fitted, candidates) = choose(&touches, finger_radius).ok_or(nothing)?;
    let open = covariance(&fitted, &touches, finger_radius, size);
    let times = fitted.point.times;
    let outline = PushedOutline::new(&fitted, candidates, (&touches, times), &open, size);
    let face = Face { line: &outline.line, has_corners: !outline.corners.is_empty() };
    let table = Table { face, radius: finger_radius, compliance, times };
    let length = table.length(&found, size);
    let paths: Vec<_> = found.iter().map(|push| table.path(push, length)).collect();
    let cut: Vec<Vec<Window>> =
        paths.iter().zip(&found).map(|(path, push)| windows(&path.steps, push.velocity.length())).collect();
    let middles = paths.iter().map(|p| outline.line.nearest(p.steps[p.steps.len() / 2].point));
    let touched: Vec<Nearest> = middles.collect();
    let places: Vec<usize> = touched.iter().map(|at| place(at.normal)).collect();
    let learned = learn(&cut, &places);
    let speed = quantile(found.iter().map(|t| t.velocity.length()).collect(), 0.5);
    let slopes = Slopes::new(&fitted.point.shape, size);
    let friction = friction(&learned, &touched, (&slopes, &open), speed);
    let noise: Vec<f64> = found.iter().filter_map(|t| t.noise).collect();
    let missed =
        |pick: fn(&(f64, f64)) -> f64| quantile(paths.iter().map(|p| pick(&p.missed).abs()).collect(), 0.5);
    let clocks = [0, 1].map(|i| (times[i], super::fit::CLOCK * open[(MOST + i, MOST + i)].sqrt()));
    Ok(PushesEstimate {
        force_noise: (!noise.is_empty()).then(|| quantile(noise, 0.5)),
        compliance,
        clocks,
        touch_deviations: fitted.deviations,
        table_length: length,
        missed: (missed(|m| m.0), missed(|m| m.1)),
        friction,
        ratio_seen: quantile(cut.iter().flatten().map(|w| w.ratio.abs()).collect(), 0.95),
        spread: [learned.common.of_push, learned.common.ratio],
        pushes: results(
            &found,
            &paths.iter().map(|p| &p.steps[..]).collect::<Vec<_>>(),
            &cut,
            &learned,
            &gaps(&fitted, &touches, finger_radius, size),
        ),
        outline,
        untouched,
    })
}

/// What is left of the touches: gaps between finger and outline at the beginning and at the end of each push, m.
fn gaps(fitted: &Fitted, touches: &[[Touch; 2]], radius: f64, size: f64) -> Vec<[f64; 2]> {
    let shape: Shape = fitted.point.shape.clone();
    let problem = Problem::new(touches, radius, size, fitted.deviations, shape);
    problem
        .parts(&fitted.line, fitted.point.times)
        .iter()
        .map(|[mean, half]| [mean + half, mean - half])
        .collect()
}

/// Places around the outline, by the direction of its normal: pushes at one place share its error.
fn place(normal: DVec2) -> usize {
    (PLACES as f64 * (normal.to_angle() / std::f64::consts::TAU + 0.5)) as usize
}

/// Friction with what the outline's directions leave open: a face that is turned shifts sliding to both sides against each other.
///
/// What differs from push to push is not taken as averaged out: it may be wear or another place, which all pushes of a stretch of time or of
/// a face share, and those slide that rub less.
fn friction(
    learned: &Learned,
    touched: &[Nearest],
    (slopes, open): (&Slopes, &SMatrix<f64, UNKNOWNS, UNKNOWNS>),
    speed: f64,
) -> Option<PushFriction> {
    let common = &learned.common;
    let value = common.friction;
    let rows = learned.shares.iter().zip(touched).filter(|(share, _)| **share != 0.0);
    let row = rows.map(|(share, at)| slopes.turn(at) * (share * (1.0 + value * value)));
    let row = row.fold(nalgebra::SVector::zeros(), |sum, row| sum + row);
    let of_outline: f64 = row.dot(&(open * row));
    let pushes = learned.own.iter().flatten().count();
    learned.variance.map(|own| PushFriction {
        value,
        deviation: (own + of_outline + common.of_push.powi(2)).sqrt(),
        by_slip: (common.by_slip / speed, learned.slope_variance.sqrt() / speed),
        at_slip: REFERENCE * speed,
        pushes,
    })
}

/// Instants of each push with their modes: those of the window that holds them.
fn results(
    found: &[Touched],
    paths: &[&[PathStep]],
    cut: &[Vec<Window>],
    learned: &Learned,
    gaps: &[[f64; 2]],
) -> Vec<PushResult> {
    let one = |i: usize| {
        let steps = paths[i];
        // Whatever clock the log has.
        let began = found[i].push.samples.first().map_or(0.0, |sample| sample.t);
        let mut instants = Vec::new();
        for (window, odds) in cut[i].iter().zip(&learned.odds[i]) {
            for step in &steps[window.steps[0]..window.steps[1]] {
                instants.push(PushInstant {
                    t: step.t - began,
                    pose: step.pose,
                    point: step.point,
                    ratio: step.ratio,
                    slip: window.slip * found[i].velocity.length(),
                    stick: odds[0],
                    left: odds[1],
                    right: odds[2],
                });
            }
        }
        let ends = [steps[0].point, steps[steps.len() - 1].point];
        PushResult { number: found[i].push.number, ends, gaps: gaps[i], friction: learned.own[i], instants }
    };
    (0..found.len()).map(one).collect()
}
