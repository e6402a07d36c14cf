//! Forces, slips and energy over time.

use super::super::encode::thin;
use crate::planar_figures::{FigureCurve, FigurePanel};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{ContactInstant, ContactMode, ContactScene};

/// The panels of the page.
pub(super) fn panels<S: SupportFunction>(
    scene: &ContactScene<S>,
    instants: &[ContactInstant],
) -> Vec<FigurePanel> {
    let kept: Vec<&ContactInstant> = thin(instants.len()).into_iter().map(|k| &instants[k]).collect();
    let curve = |name: String, value: &dyn Fn(&ContactInstant) -> f64| FigureCurve {
        name,
        points: kept.iter().map(|now| [now.state.t, value(now)]).collect(),
        dots: false,
    };
    let panel = |title: &str, unit: &str, curves| FigurePanel {
        title: title.to_owned(),
        axes: ["t in s".to_owned(), unit.to_owned()],
        equal: false,
        curves,
    };
    let of_palms = |value: &dyn Fn(&ContactInstant, usize) -> f64| -> Vec<FigureCurve> {
        let palms = 0..scene.palms().len();
        palms.map(|i| curve(format!("palm {}", i + 1), &|now| value(now, i))).collect()
    };
    let mut panels = vec![
        panel("Normal force", "N", of_palms(&|now, i| now.forces[i].dot(now.contacts[i].n))),
        panel("Speed of slip", "m/s", of_palms(&slip)),
    ];
    let first = instants.first().map_or(0.0, |now| scene.energy(&now.state.body));
    let gained = |now: &ContactInstant| scene.energy(&now.state.body) - first;
    panels.push(panel(
        "Energy since the start",
        "J",
        vec![
            curve("energy".to_owned(), &gained),
            curve("palms".to_owned(), &|now| now.palm_work),
            curve("friction".to_owned(), &|now| now.friction_work),
            curve("blows".to_owned(), &|now| now.blow_work),
        ],
    ));
    let turned = instants.first().map_or_else(Default::default, |now| now.state.body.R_WO);
    let angle = |now: &ContactInstant| turned.angle_between(now.state.body.R_WO).to_degrees();
    panels.push(panel("Turn since the start", "degrees", vec![curve("object".to_owned(), &angle)]));
    panels
}

/// Speed of the object over the material of a palm that it touches, m/s; no number where it does not touch.
fn slip(now: &ContactInstant, palm: usize) -> f64 {
    match now.modes[palm] {
        ContactMode::Off => f64::NAN,
        // What rounding leaves of it is no slip.
        ContactMode::Stick => 0.0,
        ContactMode::Slide => now.contacts[palm].in_tangent(now.rates[palm].slip).length(),
    }
}

/// Largest departure of the energy from the works that change it, J.
pub(super) fn energy_defect<S: SupportFunction>(scene: &ContactScene<S>, instants: &[ContactInstant]) -> f64 {
    let first = instants.first().map_or(0.0, |now| scene.energy(&now.state.body));
    let defect = |now: &ContactInstant| {
        scene.energy(&now.state.body) - first - now.palm_work - now.friction_work - now.blow_work
    };
    instants.iter().map(|now| defect(now).abs()).fold(0.0, f64::max)
}
