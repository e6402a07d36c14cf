//! An estimate from contacts of any palms in words and numbers for people.

use super::evidence::{of_bounds, samples_together};
use super::sensor_words::{explained, suspects};
use glam::DVec3;
use recon::object_dynamics::MassProperties;
use recon::observer::contact_modes::LearnedFriction;
use recon::observer::contacts::{
    ContactEstimate, ContactEvidence, ContactNoiseLevel, ContactOptions, EstimatedModes,
};
use recon::observer::reliability::{Reason, Reliability};
use recon::shape_bounds::Gap;
use recon_io::EvidenceValue::{Number, Text};
use recon_io::{Evidence, EvidenceValue, INERTIA_LEARNED, Level, Verdict, brief_to};

/// Share of the samples whose motion must be relied on for a result without reservations.
const ENOUGH: f64 = 0.5;

/// What speaks for or against an estimate beside its own evidence.
pub(super) struct Checks {
    /// Something in the log does not go with the scene.
    pub(super) implausible: bool,
    /// How far the lower bound stands out of the upper one, m, where that is worth a word.
    pub(super) stands_out: Option<f64>,
    /// Confidence of the bounds where there are any.
    pub(super) bounds_at: Option<f64>,
    /// Samples of the log that were taken as one.
    pub(super) together: usize,
}

/// Whether the estimate can be relied on, in one sentence.
pub(super) fn verdict(estimate: &ContactEstimate, checks: &Checks) -> Verdict {
    let mut reasons: Vec<String> = match &estimate.reliability {
        Reliability::Reliable => Vec::new(),
        Reliability::Unreliable(reasons) => reasons.iter().map(ToString::to_string).collect(),
    };
    if checks.implausible {
        reasons.push("log and scene do not go together (see the warnings)".to_owned());
    }
    if let Some(stands_out) = checks.stands_out {
        reasons.push(format!(
            "the contacts contradict each other by {stands_out:.1e} m beyond their margins, so the motion is wrong or the object is not convex"
        ));
    }
    if !reasons.is_empty() {
        let text = format!("Do not rely on this result: {}.", reasons.join("; "));
        return Verdict { level: Level::Bad, text };
    }
    let (share, misfit) = (relied_on(estimate), estimate.evidence.misfit);
    let body = match estimate.axes_deviations {
        Some(axes) => format!("mass and inertia are taken as stated, and its axes are {}", axes_known(axes)),
        None => format!("of the three second moments of the inertia {} learned", learned(estimate)),
    };
    let text = format!(
        "The fit settled, noise explains what is left (chi-squared {misfit:.2} a condition), and {}; {body}.{}",
        relied(share),
        wider(&estimate.evidence),
    );
    Verdict { level: if share < ENOUGH { Level::Caution } else { Level::Good }, text }
}

/// At which share of the samples a motion is relied on that nothing contradicts; where it is at none, why.
pub(super) fn relied(share: f64) -> String {
    let why = if share > 0.0 {
        ""
    } else {
        ": at none is it known so well that its deviations hold (a longer log, or one in which the object turns, tells more)"
    };
    format!("the motion is relied on at {} of the samples{why}", percent(share))
}

/// What makes deviations wider than the stated noise does: words to add to a verdict, none where nothing does.
pub(super) fn wider(evidence: &ContactEvidence) -> String {
    let (lasting, between) = (evidence.lasting.sqrt(), evidence.unresolved.hypot(1.0));
    let mut words = String::new();
    if lasting > WIDER {
        words += &format!(
            " What is left of the readings lasts from sample to sample, which white noise does not: deviations are {lasting:.1} times wider for it."
        );
    }
    if between > WIDER {
        words += &format!(
            " Forces change faster than they are sampled: deviations are {between:.1} times wider for it, and a higher rate tells more."
        );
    }
    for (what, times) in ["Contacts", "Forces"].into_iter().zip(evidence.rougher) {
        if times > WIDER {
            words += &format!(
                " {what} count as {times:.1} times as noisy as stated: they scatter by more, or repeat themselves from sample to sample."
            );
        }
    }
    words
}

/// Share of the samples whose motion is relied on.
pub(super) fn relied_on(estimate: &ContactEstimate) -> f64 {
    let relied = estimate.relied_on.iter().filter(|relied| **relied).count();
    relied as f64 / estimate.relied_on.len().max(1) as f64
}

/// A share without the rounding that would make all of nearly all.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", brief_to(3, (1000.0 * share).floor() / 10.0))
}

/// Factor of all deviations that is worth words.
const WIDER: f64 = 1.1;

/// How well the axes of a known body are known.
fn axes_known(deviations: DVec3) -> String {
    match deviations.max_element() {
        most if most < 1.0 => format!("known to {} rad", brief_to(2, most)),
        _ => "not known".to_owned(),
    }
}

fn learned(estimate: &ContactEstimate) -> &'static str {
    match estimate.inertia_deviations.iter().filter(|deviation| **deviation < INERTIA_LEARNED).count() {
        0 => "none is",
        1 => "one is",
        2 => "two are",
        _ => "all are",
    }
}

/// What the estimate rests on, row by row.
pub(super) fn evidence(
    estimate: &ContactEstimate,
    options: &ContactOptions,
    checks: &Checks,
) -> Vec<Evidence> {
    let mut rows = body(estimate);
    rows.extend(fit(&estimate.evidence, &estimate.reliability, relied_on(estimate)));
    rows.extend(told(&options.noise));
    rows.extend(suspects(&estimate.suspects));
    rows.extend(explained(&estimate.explanations));
    rows.extend(estimate.mode_odds.as_ref().map(modes).into_iter().flatten());
    if checks.together > 1 {
        rows.push(samples_together(checks.together));
    }
    if let (Some(confidence), Some(errors)) = (checks.bounds_at, &estimate.pose_errors) {
        rows.extend(of_bounds(errors, confidence));
    }
    rows
}

/// Keys and names of the principal moments.
const MOMENTS: [(&str, &str); 3] = [("moment_x", "Least"), ("moment_y", "Middle"), ("moment_z", "Largest")];

/// Mass and inertia that were stated, and how its axes lie.
fn stated(estimate: &ContactEstimate, axes: DVec3) -> Vec<Evidence> {
    let lies = axes_known(axes);
    let deviations = axes.to_array().map(|of| brief_to(2, of)).join(", ");
    let meaning =
        "Standard deviations about the axes of the world at the first sample; beyond 1 nothing is known.";
    let mut rows = vec![neutral("mass", "Mass", Number(estimate.mass), "kg", "As the scene states it.")];
    if let Ok(mass) = MassProperties::new(estimate.mass, estimate.inertia) {
        let moments = MOMENTS.into_iter().zip(mass.principal().moments.to_array());
        rows.extend(moments.map(|((key, which), moment)| {
            let name = format!("{which} principal moment");
            neutral(key, &name, Number(moment), "kg m^2", "About the centre of mass, as the scene states it.")
        }));
    }
    rows.extend([
        Evidence {
            level: if axes.max_element() < 1.0 { Level::Good } else { Level::Caution },
            ..neutral(
                "axes",
                "Axes of the object",
                Text(lies),
                "",
                "From its inertia, up to half turns about its principal axes.",
            )
        },
        neutral("std_axes", "Uncertainty of the axes", Text(deviations), "rad", meaning),
    ]);
    rows
}

/// Mass and inertia.
fn body(estimate: &ContactEstimate) -> Vec<Evidence> {
    if let Some(axes) = estimate.axes_deviations {
        return stated(estimate, axes);
    }
    let (mass, deviation) = (Number(estimate.mass), Number(estimate.mass * estimate.mass_deviation));
    let mut rows = vec![
        neutral("mass", "Mass", mass, "kg", "As estimated from the log."),
        neutral("std_mass", "Uncertainty of the mass", deviation, "kg", "Standard deviation."),
    ];
    // A tensor that no body has, as rounding may leave one, has no moments to tell.
    if let Ok(mass) = MassProperties::new(estimate.mass, estimate.inertia) {
        let principal = mass.principal();
        for (i, (key, which)) in MOMENTS.into_iter().enumerate() {
            let (meaning, name) =
                ("About the centre of mass, as estimated from the log.", format!("{which} principal moment"));
            rows.push(neutral(key, &name, Number(principal.moments[i]), "kg m^2", meaning));
            let deviation = Number(estimate.moment_deviation(principal.axes * DVec3::AXES[i]));
            let (key, name) = (format!("std_{key}"), format!("Its uncertainty, {}", which.to_lowercase()));
            rows.push(neutral(&key, &name, deviation, "kg m^2", "Standard deviation."));
        }
    }
    let reliable = estimate.reliability.is_reliable();
    let all = reliable && estimate.inertia_deviations.iter().all(|d| *d < INERTIA_LEARNED);
    let roots: Vec<String> = estimate.inertia_deviations.iter().map(|d| brief_to(2, *d)).collect();
    let meaning = "Of the inertia. One is learned where the deviation of the logarithm of its root is below 0.5; else it is what any \
                   body of this size has.";
    let words = Text(format!("{} learned", learned(estimate)));
    rows.push(Evidence {
        level: if all { Level::Good } else { Level::Caution },
        ..neutral("inertia_learned", "Second moments", words, "", meaning)
    });
    let meaning = "Standard deviations of the logarithms of their roots.";
    rows.push(neutral("std_log_roots", "Uncertainty of second moments", Text(roots.join(", ")), "", meaning));
    rows
}

/// Where bounds are farthest apart, body axes, and by how much at least, m.
pub(super) fn touch_next(gap: &Gap) -> Evidence {
    let place = gap.outer.to_array().map(|of| brief_to(4, of)).join(", ");
    let meaning = format!(
        "Corner of the upper bound, body axes, that is farthest from the lower one: by {} m.",
        brief_to(3, gap.distance)
    );
    neutral("touch_next", "Where to touch next", Text(place), "m", &meaning)
}

/// How the fit went.
pub(super) fn fit(e: &ContactEvidence, reliability: &Reliability, share: f64) -> Vec<Evidence> {
    let good_if = |good| if good { Level::Good } else { Level::Bad };
    let explained = match reliability {
        Reliability::Reliable => true,
        Reliability::Unreliable(reasons) => !reasons.iter().any(|r| matches!(r, Reason::Inconsistent { .. })),
    };
    let nodes = "Motions that were solved for: contacts are averaged over the samples between them.";
    let misfit = "About 1 where the stated noise explains what is left; all deviations are widened by its root above that.";
    let count = |n: usize| EvidenceValue::Count(n as u64);
    let settled = Text(if e.settled { "yes" } else { "no" }.to_owned());
    vec![
        neutral("samples", "Samples", count(e.samples), "", "Rows of the log."),
        neutral("nodes", "Nodes", count(e.nodes), "", nodes),
        neutral(
            "conditions",
            "Contact conditions",
            count(e.conditions),
            "",
            "One a contact that slides, three a contact that sticks.",
        ),
        Evidence {
            level: good_if(explained),
            ..neutral("misfit", "Chi-squared a condition", Number(e.misfit), "", misfit)
        },
        neutral(
            "iterations",
            "Linearisations",
            count(e.iterations[1]),
            "",
            "Of the coarse solution from nothing and the last one.",
        ),
        Evidence {
            level: good_if(e.settled),
            ..neutral(
                "settled",
                "Settled",
                settled,
                "",
                "Whether less than half a standard deviation was left to gain.",
            )
        },
        Evidence {
            level: if share < ENOUGH { Level::Caution } else { Level::Good },
            ..neutral(
                "relied_on",
                "Samples relied on",
                Number(share),
                "",
                "Share of the samples whose motion is known to within its deviations.",
            )
        },
    ]
}

/// What is known of the friction, and how sure contact modes are.
pub(super) fn modes(found: &EstimatedModes) -> Vec<Evidence> {
    let learned = |(i, of): (usize, &Option<LearnedFriction>)| {
        let of = (*of)?;
        let [mean, deviation] = [brief_to(3, of.coefficient), brief_to(2, of.deviation)];
        Some(format!("palm {} {mean} +- {deviation}", i + 1))
    };
    let learned: Vec<String> = found.frictions.iter().enumerate().filter_map(learned).collect();
    let learned = if learned.is_empty() { "not learned".to_owned() } else { learned.join(", ") };
    let friction =
        "Of the palms that slid, or have one friction with a palm that did, as the whole log has it.";
    let unsure = "At which some palm's mode is less probable than 0.99: close to the cone it takes tens of milliseconds to tell.";
    let count = EvidenceValue::Count(found.unsure() as u64);
    vec![
        neutral("friction", "Coefficients of friction", Text(learned), "", friction),
        neutral("unsure_modes", "Samples of unsure modes", count, "", unsure),
    ]
}

/// What to say where readings contradict what contact modes rest on.
pub(super) fn mode_doubts(found: &EstimatedModes) -> Option<String> {
    let all: Vec<String> = found.doubts.iter().map(ToString::to_string).collect();
    (!all.is_empty()).then(|| {
        format!(
            "Contact modes can be sure and wrong, for their readings are not as stated: {}.",
            all.join("; ")
        )
    })
}

/// What the estimator was told of the sensors.
pub(super) fn told(noise: &ContactNoiseLevel) -> Vec<Evidence> {
    let of_impulse = noise.impulse.map(|noise| {
        let [fixed, share] = [noise.fixed, noise.share].map(Number);
        [
            neutral(
                "noise_impulse",
                "Noise of impulses, fixed",
                fixed,
                "N s",
                "Of each axis, from sample to sample, from the scene or from the roughness of the readings.",
            ),
            neutral(
                "noise_impulse_share",
                "Noise of impulses, growing",
                share,
                "",
                "As a share of the impulse, from the scene or from the roughness of the readings.",
            ),
        ]
    });
    let tangent =
        "In each tangent direction of the palm, from the scene or from the roughness of the readings.";
    let speed =
        "What a contact condition may be off by beside noise: from the scene, or 3e-5 of the natural speed.";
    let mut rows = vec![
        neutral("noise_contact", "Noise of contact positions", Number(noise.contact), "m", tangent),
        neutral(
            "noise_force",
            "Noise of forces, fixed",
            Number(noise.force_fixed),
            "N",
            "Of each axis, from the scene or from the roughness of the readings.",
        ),
        neutral(
            "noise_force_share",
            "Noise of forces, growing",
            Number(noise.force_share),
            "",
            "As a share of the force, from the scene or from the roughness of the readings.",
        ),
    ];
    rows.extend(of_impulse.into_iter().flatten());
    rows.push(neutral("contact_speed", "Speed of contacts", Number(noise.floor), "m/s", speed));
    rows
}

/// A row that speaks neither for nor against the result.
pub(super) fn neutral(key: &str, name: &str, value: EvidenceValue, unit: &str, meaning: &str) -> Evidence {
    let [key, name, unit, meaning] = [key, name, unit, meaning].map(str::to_owned);
    Evidence { key, name, value, unit, meaning, level: Level::Neutral }
}
