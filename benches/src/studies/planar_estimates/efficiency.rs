//! How near estimates are to the least deviations that the readings allow.

use super::Failure;
use crate::planar_tally::{SILENT, errors};
use cpu_time::ThreadTime;
use nalgebra::SMatrix;
use recon::object_dynamics::planar::PlanarTruth;
use recon::observer::planar::{PlaneEstimate, PlaneOptions, estimate_plane};
use recon_benches::bound::plane::ContactErrors;
use recon_benches::planar::scene::Scene;

/// Deviation of the place at the end, over the size, below which a run counts.
const KNOWN_TO: f64 = 0.01;
/// Deviations within which a normal number is 19 times of 20.
const USUAL: f64 = 1.96;
/// Numbers of a motion.
const NUMBERS: f64 = 5.0;

/// Microseconds; of a run that is relied on its largest error in deviations; least deviation of the place at the end over the size; sums of squared errors at the end over
/// the bound, over that of two errors, over the stated deviations and over those of noise alone, and the variance of the last two.
type Run = (f64, Option<f64>, [f64; 6]);

/// Over many runs.
#[derive(Default)]
pub(super) struct Efficiency {
    runs: usize,
    relied: usize,
    silent: usize,
    below: usize,
    right: usize,
    /// Over runs that count and are relied on: how many, sums as in a run.
    counted: f64,
    sums: [f64; 5],
    microseconds: f64,
    samples: f64,
}

impl Efficiency {
    pub(super) fn run(
        &mut self,
        scene: &Scene,
        rate: f64,
        noise: f64,
        known: bool,
        seed: u64,
    ) -> Result<(), Failure> {
        let exact = scene.log(rate)?;
        let truth = exact.truth().ok_or("no truth")?;
        let run = crate::rows::row(|| -> Result<Run, Failure> {
            let level = scene.noise(noise);
            let log = level.add_to(&exact, seed).contact_log([0.0; 2]).ok_or("no forces")?;
            let told = scene.options(level, known.then_some(scene.object.mass));
            let clock = ThreadTime::now();
            let made = estimate_plane(&log, &told)?;
            let microseconds = 1e6 * clock.elapsed().as_secs_f64();
            let least = scene.bound(&exact, known, noise, ContactErrors::Once)?;
            let of_two = scene.bound(&exact, known, noise, ContactErrors::Apart)?;
            let last = truth.last().ok_or("no sample")?;
            let relied = made.reliability.is_reliable() && made.relied_on.last() == Some(&true);
            let worst = relied.then(|| errors(&made, truth, scene.length)[0]);
            // The same motion, without what constants that may be wrong add to its deviations.
            let of_noise = estimate_plane(&log, &PlaneOptions { suspects: false, ..told })?;
            Ok((microseconds, worst, at_end(scene, [&made, &of_noise], last, [&least, &of_two])))
        })?;
        let Some((microseconds, worst, [place, sums @ ..])) = run else { return Ok(()) };
        self.microseconds += microseconds;
        self.samples += exact.samples().len() as f64;
        self.runs += 1;
        let counts = place < KNOWN_TO;
        self.below += usize::from(counts);
        let Some(worst) = worst else { return Ok(()) };
        self.relied += 1;
        self.silent += usize::from(worst > SILENT);
        if counts {
            self.right += usize::from(worst <= SILENT);
            self.counted += 1.0;
            self.sums.iter_mut().zip(sums).for_each(|(all, own)| *all += own);
        }
        Ok(())
    }

    /// With those of another one.
    pub(super) fn add(&mut self, other: &Self) {
        self.runs += other.runs;
        self.relied += other.relied;
        self.silent += other.silent;
        self.below += other.below;
        self.right += other.right;
        self.counted += other.counted;
        self.sums.iter_mut().zip(other.sums).for_each(|(all, own)| *all += own);
        self.microseconds += other.microseconds;
        self.samples += other.samples;
    }

    /// Cells of a row.
    pub(super) fn told(&self) -> String {
        let [least, of_two, stated, of_noise, variance] = self.sums;
        let all = NUMBERS * self.counted.max(1.0);
        let half = USUAL * variance.sqrt() / all;
        format!(
            "{} | {} | {} | {} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} to {:.2} | {:.0}",
            self.runs,
            self.relied,
            self.silent,
            self.below,
            self.right,
            (least / all).sqrt(),
            (of_two / all).sqrt(),
            stated / all,
            of_noise / all,
            1.0 - half,
            1.0 + half,
            self.microseconds / self.samples.max(1.0)
        )
    }
}

/// Deviation of the place over the size.
fn place(least: &SMatrix<f64, 5, 5>) -> f64 {
    (least[(0, 0)] + least[(1, 1)]).sqrt()
}

/// Whether the readings of a known body tell its place at the end well enough for a run to count.
pub(super) fn is_told(scene: &Scene, rate: f64, noise: f64) -> Result<bool, Failure> {
    let least = scene.bound(&scene.log(rate)?, true, noise, ContactErrors::Once)?;
    Ok(place(&least) < KNOWN_TO)
}

/// The least deviation of the place, and the sums of a run.
fn at_end(
    scene: &Scene,
    made: [&PlaneEstimate; 2],
    truth: &PlanarTruth,
    [least, of_two]: [&SMatrix<f64, 5, 5>; 2],
) -> [f64; 6] {
    let last = made[0].states.len() - 1;
    let state = &made[0].states[last];
    let (p, v) = (state.p_WCm - truth.p_WCm, state.v_WCm - truth.v_WCm);
    let errors = [p.x, p.y, v.x, v.y, state.omega0 - truth.omega0];
    let stated = made.map(|made| {
        let of = &made.deviations[last];
        [of.p_WCm.x, of.p_WCm.y, of.v_WCm.x, of.v_WCm.y, of.omega0]
    });
    let speed = scene.length / scene.time;
    let natural = [scene.length, scene.length, speed, speed, scene.time.recip()];
    let mut sums = [0.0; 4];
    for i in 0..5 {
        let own = errors[i] / natural[i];
        sums[0] += own * own / least[(i, i)];
        sums[1] += own * own / of_two[(i, i)];
        sums[2] += (errors[i] / stated[0][i]).powi(2);
        sums[3] += (errors[i] / stated[1][i]).powi(2);
    }
    // Of a sum of squares of normal numbers of unit variance with these correlations.
    let correlated = |i: usize, j: usize| least[(i, j)] * least[(i, j)] / (least[(i, i)] * least[(j, j)]);
    let variance: f64 = (0..5).flat_map(|i| (0..5).map(move |j| 2.0 * correlated(i, j))).sum();
    [place(least), sums[0], sums[1], sums[2], sums[3], variance]
}
