//! Curves of a motion that was estimated, with their bands, and how far they are from the truth.

use super::super::page::Fact;
use super::super::thin::thin;
use super::super::{Departure, MotionState, PalmContact};
use super::estimate::EstimateData;
use super::estimate_page::{doubtful_spans, sample_gaps};
use crate::number::brief_to;
use crate::planar_figures::{FigureCurve, FigurePanel};
use glam::DVec3;
use recon::object_dynamics::LoggedPalm;

/// Half the height of bands of uncertainty in standard deviations: 95 % of a normal variable lie within.
pub(super) const BAND: f64 = 1.96;
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

impl EstimateData {
    /// The panels of curves: estimates with their bands, truth dashed.
    pub(super) fn panels(&self) -> Vec<FigurePanel> {
        let kept = thin(self.log.times().len());
        let curves = |of: fn(&MotionState) -> DVec3, deviation: usize| -> Vec<FigureCurve> {
            let axis = |i: usize| {
                let at = |k: usize, state: &MotionState| [self.log.times()[k], of(state)[i]];
                let states = &self.estimate.states;
                FigureCurve {
                    name: AXES[i].to_owned(),
                    points: kept.iter().map(|&k| at(k, &states[k].into())).collect(),
                    half_heights: kept
                        .iter()
                        .map(|&k| BAND * self.estimate.deviations[k][deviation][i])
                        .collect(),
                    reference: self
                        .truth
                        .iter()
                        .flat_map(|truth| kept.iter().map(|&k| at(k, &truth[k])))
                        .collect(),
                    ..FigureCurve::default()
                }
            };
            (0..3).map(axis).collect()
        };
        let panel = |title: &str, unit: &str, curves| FigurePanel {
            title: title.to_owned(),
            axes: ["t in s".to_owned(), unit.to_owned()],
            curves,
            shaded: doubtful_spans(self.log.times(), &self.estimate.relied_on),
            missing: sample_gaps(self.log.times()),
            ..FigurePanel::default()
        };
        let motion = [
            panel("Centre of mass", "m", curves(|s| s.p_WCm, 0)),
            panel("Velocity", "m/s", curves(|s| s.v_WCm, 1)),
            panel("Angular velocity", "rad/s", curves(|s| s.w_WO, 2)),
            panel("Turn since the start", "degrees", vec![self.turn(&kept)]),
            panel("Radius functions", "m", self.radii(&kept)),
            panel("Contact forces", "N", self.forces(&kept)),
        ];
        let departures = self.departures().filter(|of| !of.is_empty());
        let far = departures
            .map(|of| panel("Distance from the truth", "power of ten", distances(self.log.times(), &of)));
        // Radius functions have no point where nothing is relied on.
        let told =
            |panel: &FigurePanel| panel.curves.iter().flat_map(|of| &of.points).any(|[_, y]| y.is_finite());
        motion.into_iter().filter(told).chain(far).collect()
    }

    /// Size of the force of each palm, with the band of its noise; no number where it was not measured.
    fn forces(&self, kept: &[usize]) -> Vec<FigureCurve> {
        let size =
            |palm: &LoggedPalm, k: usize| palm.force(k).map_or(f64::NAN, |force| force.vector.length());
        let [fixed, share] = self.force_noise;
        let curve = |(i, palm): (usize, &LoggedPalm)| FigureCurve {
            name: format!("palm {}", i + 1),
            points: kept.iter().map(|&k| [self.log.times()[k], size(palm, k)]).collect(),
            half_heights: kept.iter().map(|&k| BAND * fixed.hypot(share * size(palm, k))).collect(),
            ..FigureCurve::default()
        };
        self.log.palms().iter().enumerate().map(curve).collect()
    }

    /// Distances of the planes that touch the object from its centre of mass, palm by palm. Where a palm is touched is known: what is not
    /// is the centre of mass along its normal.
    fn radii(&self, kept: &[usize]) -> Vec<FigureCurve> {
        let (times, found) = (self.log.times(), &self.estimate);
        let curve = |(i, contacts): (usize, &Vec<Option<PalmContact>>)| {
            let of =
                |k: usize, value: &dyn Fn(&PalmContact) -> f64| contacts[k].as_ref().map_or(f64::NAN, value);
            let wide = |k: usize| {
                of(k, &|c| BAND * (found.states[k].R_WO * c.normal * found.deviations[k][0]).length())
            };
            let truth = self.truth.iter().flat_map(|truth| {
                kept.iter().map(|&k| [times[k], of(k, &|c| self.true_radius(c, k, &truth[k]))])
            });
            FigureCurve {
                name: format!("palm {}", i + 1),
                points: kept.iter().map(|&k| [times[k], of(k, &|c| c.radius)]).collect(),
                half_heights: kept.iter().map(|&k| wide(k)).collect(),
                reference: truth.collect(),
                ..FigureCurve::default()
            }
        };
        self.curves.iter().enumerate().map(curve).collect()
    }

    /// The radius function where the true centre of mass is, m.
    fn true_radius(&self, contact: &PalmContact, k: usize, truth: &MotionState) -> f64 {
        (self.estimate.states[k].R_WO * contact.normal).dot(contact.p_WC - truth.p_WCm)
    }

    /// Largest error of a radius function, m; none without truth.
    #[must_use]
    pub fn largest_radius_error(&self) -> Option<f64> {
        let truth = self.truth.as_ref()?;
        let error = |(k, c): (usize, &Option<PalmContact>)| {
            c.as_ref().map_or(0.0, |c| (c.radius - self.true_radius(c, k, &truth[k])).abs())
        };
        Some(self.curves.iter().flat_map(|curve| curve.iter().enumerate().map(error)).fold(0.0, f64::max))
    }

    /// How far the estimate is from the truth at each time that is relied on, with the sample; none without truth.
    pub(crate) fn departures(&self) -> Option<Vec<(usize, Departure)>> {
        let found = &self.estimate;
        let truth = self.truth.as_ref()?;
        let relied = (0..truth.len()).filter(|k| found.relied_on[*k]);
        Some(relied.map(|k| (k, Departure::between(&found.states[k].into(), &truth[k]))).collect())
    }

    /// The largest of them, as key figures.
    pub(super) fn largest_errors(&self) -> Vec<Fact> {
        let Some(all) = self.departures().filter(|all| !all.is_empty()) else { return Vec::new() };
        let most =
            |of: fn(&Departure) -> f64| brief_to(2, all.iter().map(|(_, d)| of(d)).fold(0.0, f64::max));
        vec![
            ("Largest position error", most(|d| d.position), "m"),
            ("Largest rate error", most(|d| d.angular_velocity), "rad/s"),
        ]
    }

    /// Angle of the turn since the start; its band is that of the axis that is known worst.
    fn turn(&self, kept: &[usize]) -> FigureCurve {
        let times = self.log.times();
        let states = &self.estimate.states;
        let angle = |k: usize| states[0].R_WO.angle_between(states[k].R_WO).to_degrees();
        let wide = |k: usize| BAND * self.estimate.deviations[k][3].max_element().to_degrees();
        let truth = self.truth.iter().flat_map(|truth| {
            kept.iter().map(|&k| [times[k], truth[0].R_WO.angle_between(truth[k].R_WO).to_degrees()])
        });
        FigureCurve {
            name: "object".to_owned(),
            points: kept.iter().map(|&k| [times[k], angle(k)]).collect(),
            half_heights: kept.iter().map(|&k| wide(k)).collect(),
            reference: truth.collect(),
            ..FigureCurve::default()
        }
    }
}

/// Powers of ten below its largest distance that a curve goes down: what is less is zero but for rounding, as is the turn of the first sample, from which
/// turns are counted.
const DOWN: f64 = 6.0;

/// Distances from the truth as powers of ten.
fn distances(times: &[f64], departures: &[(usize, Departure)]) -> Vec<FigureCurve> {
    type Of = fn(&Departure) -> f64;
    let curve = |(name, of): (&str, Of)| {
        let least = departures.iter().map(|(_, d)| of(d)).fold(0.0, f64::max).log10() - DOWN;
        let power = |of: f64| Some(of.log10()).filter(|power| *power >= least).unwrap_or(f64::NAN);
        let point = |i: usize| [times[departures[i].0], power(of(&departures[i].1))];
        FigureCurve {
            name: name.to_owned(),
            points: thin(departures.len()).into_iter().map(point).collect(),
            ..FigureCurve::default()
        }
    };
    let all: [(&str, Of); 3] =
        [("m", |d| d.position), ("rad", |d| d.angle), ("rad/s", |d| d.angular_velocity)];
    all.into_iter().map(curve).collect()
}
