//! What is understood of a sensor log.

use super::Understood;
use crate::error::CliError;
use crate::pipeline::{LoadedLog, LogOf, sorted_with_forces};
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::{ContactLog, LoggedPalm, SensedAxes, TwistSource};
use recon::observer::contacts::ContactNoiseLevel;
use recon_io::{AnyLog, Scene, brief, brief_to, implausibilities, implausible_contacts};
use serde_json::{Value, json};

/// Intervals longer than this many of the median are gaps: the samples between were left out.
const GAP: f64 = 1.5;
/// Gaps and spans that are told one by one.
const NAMED: usize = 5;

pub(super) fn told(loaded: LoadedLog, scene: &Scene) -> Result<Understood, CliError> {
    let (contacts, version, truth, odd) = match &loaded.log {
        AnyLog::ThreePalms(log) => {
            (ContactLog::try_from(log)?, 1, log.truth().is_some(), implausibilities(log, scene))
        }
        AnyLog::Contacts(log) => (log.clone(), 2, log.truth().is_some(), implausible_contacts(log, scene)),
    };
    let mut warnings: Vec<String> = odd.iter().map(ToString::to_string).collect();
    warnings.extend(loaded.warnings.clone());
    let Rate { rate, gaps } = Rate::of(contacts.times());
    let mut lines = vec![
        ("kind".to_owned(), format!("sensor log, version {version}: {} palms", contacts.palms().len())),
        ("samples".to_owned(), format!("{} over {} s", contacts.times().len(), brief(contacts.duration()))),
        ("rate".to_owned(), format!("{} samples a second", brief(rate))),
        ("gaps".to_owned(), in_words(&gaps)),
        ("truth".to_owned(), if truth { "there, and compared with alone" } else { "not there" }.to_owned()),
    ];
    let mut palms = Vec::new();
    for (i, palm) in contacts.palms().iter().enumerate() {
        let (line, figures) = of_palm(palm, contacts.times());
        lines.push((format!("palm {}", i + 1), line));
        palms.push(figures);
    }
    let noise = ContactNoiseLevel::by_roughness(&contacts, 0.0, false);
    let rough = json!({
        "contact_m": noise.contact, "force_n": noise.force_fixed, "force_share": noise.force_share,
        "stated_contact_m": scene.sensors.contact_std, "stated_force_n": scene.sensors.force_std,
    });
    lines.push(("noise of contacts".to_owned(), stated("m", scene.sensors.contact_std, noise.contact)));
    let force = stated("N", scene.sensors.force_std, noise.force_fixed);
    let share = match scene.sensors.force_share {
        Some(share) => format!("{} % as stated", brief_to(2, 100.0 * share)),
        None => format!("{} % by roughness", brief_to(2, 100.0 * noise.force_share)),
    };
    lines.push(("noise of forces".to_owned(), format!("{force}; growing with the force: {share}")));
    if let Some(std) = scene.sensors.contact_std
        && noise.contact > 3.0 * std
    {
        warnings.push(format!(
            "Contacts are rough by {} m, and the scene states noise of {} m: is contact_std in metres?",
            brief_to(2, noise.contact),
            brief_to(2, std)
        ));
    }
    let body = match scene.mass_properties() {
        Ok(Some(body)) => format!("{} kg, as the scene states it", brief(body.mass())),
        _ => "not stated: give --identify to recon reconstruct".to_owned(),
    };
    lines.push(("object".to_owned(), body));
    let estimator = match sorted_with_forces(loaded, scene).log {
        LogOf::ThreePalms(_) => "three flat palms without friction".to_owned(),
        LogOf::AnyPalms(_, why) => format!("contacts of any palms ({why})"),
    };
    lines.push(("estimated as".to_owned(), estimator.clone()));
    let figures = json!({
        "kind": "log", "version": version, "samples": contacts.times().len(), "duration_s": contacts.duration(),
        "rate_hz": rate, "gaps": gaps, "truth": truth, "palms": palms, "noise": rough, "estimated_as": estimator,
    });
    Ok(Understood { lines, figures, warnings })
}

struct Rate {
    /// Samples a second: the median.
    rate: f64,
    /// Times between which samples are missing, s.
    gaps: Vec<[f64; 2]>,
}

impl Rate {
    fn of(times: &[f64]) -> Self {
        let mut intervals: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        intervals.sort_by(f64::total_cmp);
        let median = intervals.get(intervals.len() / 2).copied().unwrap_or(f64::NAN);
        let gap = |w: &&[f64]| w[1] - w[0] > GAP * median;
        let gaps = times.windows(2).filter(gap).map(|w| [w[0], w[1]]).collect();
        Self { rate: 1.0 / median, gaps }
    }
}

/// One palm: what it is, what it measures, how noisily, and when it is touched.
fn of_palm(palm: &LoggedPalm, times: &[f64]) -> (String, Value) {
    let shape = match palm.surface() {
        PalmSurface::Plane => "flat".to_owned(),
        PalmSurface::Sphere { radius } => format!("fingertip of {} m", brief(radius)),
        PalmSurface::Cup { radius } => format!("cup of {} m", brief(radius)),
        PalmSurface::Cylinder { radius } => format!("cylinder of {} m", brief(radius)),
    };
    let motion = match palm.twist_source() {
        TwistSource::Immobile => "at rest",
        TwistSource::Stated => "moves as measured",
        TwistSource::FromPoses => "moves as its poses tell",
    };
    let axes = |axes: Option<SensedAxes>| match axes {
        Some(SensedAxes::Three) => "three axes",
        Some(SensedAxes::Normal) => "normal alone",
        None => "none",
    };
    let touched: Vec<bool> = (0..times.len()).map(|k| palm.touch(k).is_some()).collect();
    let share = touched.iter().filter(|t| **t).count() as f64 / times.len().max(1) as f64;
    let mut spans: Vec<[f64; 2]> = Vec::new();
    for (k, t) in times.iter().enumerate().filter(|(k, _)| touched[*k]) {
        match spans.last_mut() {
            Some(span) if k > 0 && touched[k - 1] => span[1] = *t,
            _ => spans.push([*t, *t]),
        }
    }
    let friction =
        palm.friction().map_or("friction not stated".to_owned(), |mu| format!("friction {}", brief(mu)));
    let line = format!(
        "{shape}, {motion}, {friction}; force: {}, impulse: {}{}; touched at {} % of the samples, {}",
        axes(palm.force_axes()),
        axes(palm.impulse_axes()),
        if palm.has_torque() { ", torque" } else { "" },
        brief_to(3, 100.0 * share),
        in_words(&spans)
    );
    let figures = json!({
        "shape": shape, "motion": motion, "friction": palm.friction(), "force_axes": axes(palm.force_axes()),
        "impulse_axes": axes(palm.impulse_axes()), "torque": palm.has_torque(), "touched_share": share, "touched_s": spans,
    });
    (line, figures)
}

/// Spans of time, a few of them one by one.
fn in_words(spans: &[[f64; 2]]) -> String {
    let told: Vec<String> = spans
        .iter()
        .take(NAMED)
        .map(|[from, to]| format!("from {} to {} s", brief(*from), brief(*to)))
        .collect();
    match (spans.len(), spans.len() - told.len()) {
        (0, _) => "none".to_owned(),
        (_, 0) => told.join(", "),
        (_, more) => format!("{}, and {more} more", told.join(", ")),
    }
}

fn stated(unit: &str, stated: Option<f64>, rough: f64) -> String {
    let rough = format!("{} {unit} by the roughness of the readings", brief_to(2, rough));
    stated.map_or(rough.clone(), |std| format!("{} {unit} as stated, {rough}", brief_to(2, std)))
}
