//! What is understood of a sensor log.

use super::{Readings, Understood};
use crate::error::CliError;
use crate::pipeline::{LoadedLog, LogOf, repeated, sorted_with_forces, with_palms};
use glam::DVec3;
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::planar::ContactLog as PlanarLog;
use recon::object_dynamics::{ContactLog, LoggedPalm, SensedAxes, TwistSource};
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::plane_noise;
use recon_io::{
    AnyLog, PlanarKnown, Scene, Sensors, brief, brief_to, implausibilities, implausible_contacts,
};
use serde_json::{Value, json};

const THREE_PALMS: &str = "contacts in the frame of each palm (t1 level, t2 up the palm), normals in the world's, z up; the palms go through its origin";
const ANY_PALMS: &str = "the world's, z up; what was measured in a palm's frame is turned into it";
const HINGED: &str = "x to the right, y up; contacts along each palm, from the hinge in the origin";
const IN_PLANE: &str = "the world's, x to the right, y up; angles are counter-clockwise";

/// Intervals longer than this many of the median are gaps: the samples between were left out.
const GAP: f64 = 1.5;
/// Gaps and spans that are told one by one.
const NAMED: usize = 5;

pub(super) fn told(loaded: LoadedLog, scene: &Scene) -> Result<Understood, CliError> {
    let (contacts, version, frames, odd) = match &loaded.log {
        AnyLog::ThreePalms(log) => (ContactLog::try_from(log)?, 1, THREE_PALMS, implausibilities(log, scene)),
        AnyLog::Contacts(log) => (log.clone(), 2, ANY_PALMS, implausible_contacts(log, scene)),
    };
    let mut warnings: Vec<String> = odd.iter().map(ToString::to_string).collect();
    warnings.extend(repeated(&contacts));
    warnings.extend(loaded.warnings.clone());
    let estimated_as = match sorted_with_forces(loaded, scene).log {
        LogOf::ThreePalms(_) => "three flat palms without friction".to_owned(),
        LogOf::AnyPalms(_, why) => format!("contacts of any palms ({why})"),
    };
    let read = Read {
        kind: format!("sensor log, version {version}"),
        version,
        in_plane: false,
        frames,
        noise: ContactNoiseLevel::by_roughness(&contacts, 0.0, false),
        contacts,
        sensors: scene.sensors,
        mass: scene.mass_properties().ok().flatten().map(|body| body.mass()),
        estimated_as,
        warnings,
    };
    Ok(read.told())
}

/// The same of a log in the plane.
pub(super) fn told_in_plane(log: &PlanarLog, known: PlanarKnown) -> Result<Understood, CliError> {
    let (version, frames) = if known.palms.is_empty() { (1, HINGED) } else { (2, IN_PLANE) };
    let known = with_palms(known);
    let friction: Vec<_> = known.palms.iter().map(|(_, friction)| *friction).collect();
    let contacts = log.in_space(&friction)?;
    let read = Read {
        kind: format!("planar sensor log, version {version}"),
        version,
        in_plane: true,
        frames,
        noise: plane_noise(log, &friction, 0.0)?,
        sensors: known.sensors,
        mass: known.mass.map(|body| body.mass()),
        estimated_as: "contacts of palms in the plane".to_owned(),
        warnings: repeated(&contacts),
        contacts,
    };
    Ok(read.told())
}

/// A log, and what is known beside it.
struct Read {
    kind: String,
    version: u32,
    in_plane: bool,
    frames: &'static str,
    contacts: ContactLog,
    /// By the roughness of the readings.
    noise: ContactNoiseLevel,
    sensors: Sensors,
    /// As stated, kg.
    mass: Option<f64>,
    estimated_as: String,
    warnings: Vec<String>,
}

impl Read {
    fn told(self) -> Understood {
        let Self { contacts, noise, sensors, mut warnings, .. } = self;
        let (times, named) = (contacts.times(), |name: &str, value: String| (name.to_owned(), value));
        let Rate { rate, gaps } = Rate::of(times);
        let scale = Scale::of(&contacts);
        let truth = contacts.truth().is_some();
        let mut lines = vec![
            named("kind", format!("{}: {} palms", self.kind, contacts.palms().len())),
            named("units", scale.in_words()),
            named("frames", self.frames.to_owned()),
            named("samples", format!("{} over {} s", times.len(), brief(contacts.duration()))),
            named("rate", format!("{} samples a second", brief(rate))),
            named("gaps", in_words(&gaps)),
            named("truth", if truth { "there, and compared with alone" } else { "not there" }.to_owned()),
        ];
        let mut palms = Vec::new();
        for (i, palm) in contacts.palms().iter().enumerate() {
            let (line, figures) = of_palm(palm, times, self.in_plane);
            lines.push((format!("palm {}", i + 1), line));
            palms.push(figures);
        }
        let rough = json!({
            "contact_m": noise.contact, "force_n": noise.force_fixed, "force_share": noise.force_share,
            "stated_contact_m": sensors.contact_std, "stated_force_n": sensors.force_std,
        });
        lines.push(named("noise of contacts", stated("m", sensors.contact_std, noise.contact)));
        let force = stated("N", sensors.force_std, noise.force_fixed);
        let share = match sensors.force_share {
            Some(share) => format!("{} % as stated", brief_to(2, 100.0 * share)),
            None => format!("{} % by roughness", brief_to(2, 100.0 * noise.force_share)),
        };
        lines.push(named("noise of forces", format!("{force}; growing with the force: {share}")));
        if let Some(std) = sensors.contact_std
            && noise.contact > 3.0 * std
        {
            warnings.push(format!(
                "Contacts are rough by {} m, and the scene states noise of {} m: is contact_std in metres?",
                brief_to(2, noise.contact),
                brief_to(2, std)
            ));
        }
        let body = match self.mass {
            Some(mass) => format!("{} kg, as the scene states it", brief(mass)),
            None if self.in_plane => "not stated: it is estimated".to_owned(),
            None => "not stated: give --identify to recon reconstruct".to_owned(),
        };
        lines.push(named("object", body));
        lines.push(named("estimated as", self.estimated_as.clone()));
        let figures = json!({
            "kind": if self.in_plane { "planar log" } else { "log" }, "version": self.version, "frames": self.frames,
            "contacts_apart_m": scale.apart, "largest_force_n": scale.force,
            "samples": times.len(), "duration_s": contacts.duration(),
            "rate_hz": rate, "gaps": gaps, "truth": truth, "palms": palms, "noise": rough,
            "estimated_as": self.estimated_as,
        });
        let readings = Readings::Log(Box::new(contacts), gaps);
        Understood { lines, figures, warnings, readings }
    }
}

/// What tells a reader whether lengths and forces are in the units of the format.
struct Scale {
    /// Largest distance between contacts of one sample, m.
    apart: Option<f64>,
    /// Size of the largest force, N.
    force: Option<f64>,
}

impl Scale {
    fn of(log: &ContactLog) -> Self {
        let apart = |k: usize| {
            let at: Vec<DVec3> = log.palms().iter().filter_map(|palm| Some(palm.touch(k)?.p_WC)).collect();
            let pairs = at.iter().enumerate().flat_map(|(i, a)| at[..i].iter().map(|b| a.distance(*b)));
            pairs.reduce(f64::max)
        };
        let samples = 0..log.times().len();
        let force = |palm: &LoggedPalm| {
            samples.clone().filter_map(|k| Some(palm.force(k)?.vector.length())).reduce(f64::max)
        };
        let force = log.palms().iter().filter_map(force).reduce(f64::max);
        Self { apart: samples.clone().filter_map(apart).reduce(f64::max), force }
    }

    fn in_words(&self) -> String {
        let apart =
            self.apart.map(|of| format!("contacts of a sample are up to {} m apart", brief_to(3, of)));
        let force = self.force.map(|of| format!("forces are up to {} N", brief_to(3, of)));
        let seen: Vec<String> = [apart, force].into_iter().flatten().collect();
        format!("m, s, kg, N, rad{}{}", if seen.is_empty() { "" } else { ": " }, seen.join(", "))
    }
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
fn of_palm(palm: &LoggedPalm, times: &[f64], in_plane: bool) -> (String, Value) {
    let shape = match palm.surface() {
        PalmSurface::Plane if in_plane => "line".to_owned(),
        PalmSurface::Plane => "flat".to_owned(),
        PalmSurface::Sphere { radius } if in_plane => format!("arc of {} m", brief(radius)),
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
        Some(SensedAxes::Three) if in_plane => "both axes",
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
