//! A body between two hinged palms in the plane, by length, rate and noise of the log.

use super::super::{Chart, Drawn};
use super::{DRAWS, Sweep};
use crate::bound::plane::ContactErrors;
use crate::planar::scene::{Scene, drawn};
use crate::{Axis, Budget, Method, WorkPrecision};
use recon::observer::planar::estimate_plane;

pub(in super::super) const CHART: Chart = Chart {
    name: "planar-reconstruction",
    about: "motion in the plane by length, rate and noise of the log, beside the least that is possible",
    draw,
};

/// Settings, of a chart that is kept and, the last ones, of a smoke test: the shortest logs are refused.
const SETTINGS: [usize; 2] = [usize::MAX, 2];
const SEED: u64 = 98_100;
/// Natural times, samples in one, and noise of contacts over the size, where they do not change.
const LASTS: f64 = 20.0;
const DENSITY: f64 = 25.0;
const NOISE: f64 = 1e-3;

/// How a log is sensed.
#[derive(Clone, Copy)]
struct Setting {
    /// Natural times.
    lasts: f64,
    /// Samples in a natural time.
    density: f64,
    noise: f64,
}

fn draw(budget: Budget) -> Drawn {
    let mut scenes = drawn(1, SEED).map_err(|error| error.to_string())?;
    let scene = scenes.first_mut().ok_or("no scene")?;
    let usual = Setting { lasts: LASTS, density: DENSITY, noise: NOISE };
    let by_window = [2.0, 4.0, 8.0, 14.0, 20.0].map(|lasts| (format!("{lasts}"), Setting { lasts, ..usual }));
    let by_rate =
        [5.0, 10.0, 25.0, 50.0, 100.0].map(|density| (format!("{density}"), Setting { density, ..usual }));
    let by_noise = [1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2]
        .map(|noise| (format!("{} %", 100.0 * noise), Setting { noise, ..usual }));
    let size = format!("{:.2} m", scene.length);
    let mut chart = |name: &str, title: &str, points: &str, settings: &[(String, Setting)]| {
        let methods = methods(scene, settings, budget)?;
        let subtitle = format!(
            "body of {size}, noise 0.1 % of the size and 1 % of the weight, {DENSITY} samples in each of {LASTS} natural times but for what changes; points: {points}; root mean square of forty draws at the last sample"
        );
        let axes = [Axis::log("error of the centre of mass", "sizes"), Axis::log("cost", "ms a log")];
        let [error, cost] = axes;
        Ok::<_, String>(
            WorkPrecision::new(name, title).subtitle(subtitle).axes(error, cost).methods(methods).into(),
        )
    };
    Ok(vec![
        chart(
            "planar-reconstruction-by-window",
            "In the plane, over the length of the log",
            "natural times",
            &by_window,
        )?,
        chart(
            "planar-reconstruction-by-rate",
            "In the plane, over the sample rate",
            "samples in a natural time",
            &by_rate,
        )?,
        chart(
            "planar-reconstruction-by-noise",
            "In the plane, over the noise",
            "noise of contacts over the size",
            &by_noise,
        )?,
    ])
}

/// Of a known body and of an unknown.
fn methods(scene: &mut Scene, settings: &[(String, Setting)], budget: Budget) -> Result<Vec<Method>, String> {
    let mut all = Vec::new();
    for (name, known) in [("known body", true), ("unknown body", false)] {
        let mut sweep = Sweep::new(name);
        for (words, Setting { lasts, density, noise }) in
            settings.iter().rev().take(budget.of(SETTINGS)).rev()
        {
            scene.lasts = *lasts;
            let told = |error: Box<dyn std::error::Error>| error.to_string();
            let exact = scene.log(density / scene.time).map_err(told)?;
            let least = scene.bound(&exact, known, *noise, ContactErrors::Once).ok();
            let least = least.map(|of| (of[(0, 0)] + of[(1, 1)]).sqrt());
            let truth = exact.truth().and_then(<[_]>::last).copied().ok_or("no truth")?;
            let level = scene.noise(*noise);
            let options = scene.options(level, known.then_some(scene.object.mass));
            sweep.at(words.clone(), budget.of(DRAWS), least, |seed| {
                let log = level.add_to(&exact, seed).contact_log([0.0; 2])?;
                let made = estimate_plane(&log, &options).ok()?;
                let relied = made.reliability.is_reliable() && made.relied_on.last() == Some(&true);
                let off = made.states.last()?.p_WCm.distance_squared(truth.p_WCm);
                relied.then_some(off / (scene.length * scene.length))
            });
        }
        all.extend(sweep.methods());
    }
    Ok(all)
}
