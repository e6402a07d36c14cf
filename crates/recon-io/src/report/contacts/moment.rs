//! What the page of a simulated motion is made of, in space and in the plane alike.

use super::super::thin::thin;
use super::picture::Pictures;
use super::spans::ModeSpan;
use crate::planar_figures::{FigureCurve, FigurePanel};

/// A simulated motion as it is shown.
pub(super) struct Shown {
    /// What is said of the pictures.
    pub(super) caption: &'static str,
    pub(super) moments: Vec<Moment>,
    pub(super) pictures: Pictures,
    /// What each palm's contact does.
    pub(super) spans: Vec<Vec<ModeSpan>>,
    /// How often modes change.
    pub(super) changes: usize,
}

/// Numbers of one sample.
pub(super) struct Moment {
    /// s.
    pub(super) t: f64,
    /// Normal force of each palm, N.
    pub(super) forces: Vec<f64>,
    /// Speed of slip at each palm, m/s; no number where it does not touch.
    pub(super) slips: Vec<f64>,
    /// J.
    pub(super) energy: f64,
    /// What the palms' motion, friction and blows have done since the start, J.
    pub(super) works: [f64; 3],
    /// Since the start, rad.
    pub(super) turn: f64,
}

impl Shown {
    /// The panels of curves.
    pub(super) fn panels(&self) -> Vec<FigurePanel> {
        let kept: Vec<&Moment> = thin(self.moments.len()).into_iter().map(|k| &self.moments[k]).collect();
        let curve = |name: &str, value: &dyn Fn(&Moment) -> f64| FigureCurve {
            name: name.to_owned(),
            points: kept.iter().map(|now| [now.t, value(now)]).collect(),
            ..FigureCurve::default()
        };
        let panel = |title: &str, unit: &str, curves| FigurePanel {
            title: title.to_owned(),
            axes: ["t in s".to_owned(), unit.to_owned()],
            curves,
            ..FigurePanel::default()
        };
        let of_palms = |value: &dyn Fn(&Moment, usize) -> f64| -> Vec<FigureCurve> {
            let palms = 0..self.spans.len();
            palms.map(|i| curve(&format!("palm {}", i + 1), &|now| value(now, i))).collect()
        };
        let first = self.moments.first().map_or(0.0, |now| now.energy);
        let energy = vec![
            curve("energy", &|now| now.energy - first),
            curve("palms", &|now| now.works[0]),
            curve("friction", &|now| now.works[1]),
            curve("blows", &|now| now.works[2]),
        ];
        vec![
            panel("Normal force", "N", of_palms(&|now, i| now.forces[i])),
            panel("Speed of slip", "m/s", of_palms(&|now, i| now.slips[i])),
            panel("Energy since the start", "J", energy),
            panel("Turn since the start", "degrees", vec![curve("object", &|now| now.turn.to_degrees())]),
        ]
    }

    /// Largest departure of the energy from the works that change it, J.
    pub(super) fn energy_defect(&self) -> f64 {
        let first = self.moments.first().map_or(0.0, |now| now.energy);
        let defect = |now: &Moment| now.energy - first - now.works.iter().sum::<f64>();
        self.moments.iter().map(|now| defect(now).abs()).fold(0.0, f64::max)
    }
}
