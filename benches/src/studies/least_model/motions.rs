//! Simulations: the chosen model beside all.

use super::scenes::{Scene, World, scene};
use super::{Failure, Outcome};
use cpu_time::ThreadTime;
use recon::least_model::{Accuracy, Least, Model, Pose, Question, least_motion, least_tolerance};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{End, planar};
use recon_tests::Random;

/// Decades of the wanted accuracy.
const WANTED: [f64; 2] = [-8.0, -2.0];
/// Tolerances that are tried, by halves of decades.
const TRIED: std::ops::RangeInclusive<i32> = 4..=26;
/// Runs of which the fastest counts.
const REPEATED: usize = 3;

/// Of the scene that a seed draws, of the kind whose turn it is.
pub(super) fn one(turn: usize, seed: u64) -> Result<Option<Outcome>, Failure> {
    scene(turn % 3, seed)?.map_or(Ok(None), |of| judged(&of, seed))
}

fn judged(of: &Scene, seed: u64) -> Result<Option<Outcome>, Failure> {
    let decades = Random::new(seed ^ 0xACC).within(WANTED[0], WANTED[1]);
    let wanted = Accuracy::new(10_f64.powf(decades))?;
    // An oracle a hundred times tighter than the tightest that is chosen.
    let Ok(truth) = modes(of, (wanted.get() * 1e-4).clamp(3e-14, 1e-9)) else { return Ok(None) };
    let clock = ThreadTime::now();
    let Ok((poses, chosen_by, tolerance, choice)) = chosen(of, wanted) else { return Ok(None) };
    let all = 1e3 * clock.elapsed().as_secs_f64();
    let error = off(&poses, &truth, of.size);
    let ways: [(&str, Way); 2] = [("modes", modes), ("minimal", minimal)];
    let timed = |way: Way, tolerance: f64| -> Option<(f64, Vec<Pose>)> {
        let mut fastest = f64::INFINITY;
        let mut made = None;
        for _ in 0..REPEATED {
            let clock = ThreadTime::now();
            made = Some(way(of, tolerance).ok()?);
            fastest = fastest.min(1e3 * clock.elapsed().as_secs_f64());
        }
        made.map(|made| (fastest, made))
    };
    let own = ways.iter().find(|(name, _)| *name == chosen_by).and_then(|(_, way)| timed(*way, tolerance));
    let own = own.map_or(f64::NAN, |(fastest, _)| fastest);
    let mut cheapest = (own, format!("{chosen_by} {tolerance:.0e}"));
    if error > wanted.get() {
        cheapest.0 = f64::INFINITY;
    }
    for (name, way) in ways {
        for half in TRIED {
            let tolerance = 10_f64.powf(-0.5 * f64::from(half));
            let Some((fastest, poses)) = timed(way, tolerance) else { continue };
            if fastest < cheapest.0 && off(&poses, &truth, of.size) <= wanted.get() {
                cheapest = (fastest, format!("{name} {tolerance:.0e}"));
            }
        }
    }
    Ok(Some(Outcome {
        kind: of.kind.to_owned(),
        wanted: wanted.get(),
        error,
        stated: choice.reached,
        is_reached: choice.is_reached,
        chosen: own,
        all,
        cheapest: cheapest.0,
        what: [format!("{chosen_by} {tolerance:.0e}"), cheapest.1],
    }))
}

type Way = fn(&Scene, f64) -> Result<Vec<Pose>, Failure>;
type Chosen = (Vec<Pose>, &'static str, f64, recon::least_model::Choice);

fn chosen(of: &Scene, wanted: Accuracy) -> Result<Chosen, Failure> {
    match &of.world {
        World::Space { scene, start, .. } => {
            let found = least_motion(scene, start, of.times, wanted)?;
            let integrator = found.choice.decisions.iter().find(|of| of.question == Question::Integrator);
            let model = integrator.and_then(|of| of.alternatives.iter().find(|of| of.chosen));
            let minimal = model.is_some_and(|of| of.model == Model::MinimalCoordinates);
            let poses = found.states.into_iter().map(Pose::from).collect();
            Ok((poses, if minimal { "minimal" } else { "modes" }, found.tolerance, found.choice))
        }
        World::Plane { .. } => {
            let run = |tolerance: f64| modes(of, tolerance);
            let Least { run, tolerance, choice } = least_tolerance(wanted, of.size, run, Vec::clone)?;
            Ok((run, "modes", tolerance, choice))
        }
    }
}

fn modes(of: &Scene, tolerance: f64) -> Result<Vec<Pose>, Failure> {
    match &of.world {
        World::Space { scene, start, .. } => {
            let run = scene.simulate(start, of.times, tolerance)?;
            Ok(run.instants.iter().map(|now| Pose::from(now.state.body)).collect())
        }
        World::Plane { scene, start } => {
            let run = scene.simulate(start, &of.times.all()?, tolerance)?;
            let pose = |now: &planar::ContactInstant| Pose {
                p_WCm: planar::in_space(now.body.p_WCm),
                R_WO: planar::turn_in_space(now.body.phi0),
            };
            Ok(run.instants.iter().map(pose).collect())
        }
    }
}

/// Without friction and while all palms are touched.
fn minimal(of: &Scene, tolerance: f64) -> Result<Vec<Pose>, Failure> {
    let World::Space { scene, held, start } = &of.world else { return Err("in a plane".into()) };
    if scene.palms().iter().any(|palm| palm.friction > 0.0) {
        return Err("friction".into());
    }
    let motion = recon::object_dynamics::InitialMotion { R_WO: start.body.R_WO, w_WO: start.body.w_WO };
    let run = held.simulate(motion, of.times, Tolerance::uniform(tolerance))?;
    if run.end != End::Completed {
        return Err("contact is lost".into());
    }
    Ok(run.instants.iter().map(|now| Pose { p_WCm: now.touch.p_WCm, R_WO: now.R_WO }).collect())
}

fn off(a: &[Pose], b: &[Pose], size: f64) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    a.iter().zip(b).map(|(a, b)| a.off(b, size)).fold(0.0, f64::max)
}
