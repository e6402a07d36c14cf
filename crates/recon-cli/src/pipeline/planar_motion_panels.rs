//! Curves of a motion that was estimated in the plane.

use super::planar_motion::PlanarMotion;
use glam::DVec2;
use recon::observer::planar::PlaneContact;
use recon_io::{FigureCurve, FigurePanel, doubtful_spans, sample_gaps};

impl PlanarMotion {
    /// The paper's Figs. 2b and 3a (contact points), 2c (orientation) and 3b (errors, where the truth is known); bands of two deviations,
    /// shaded where the motion is not relied on.
    pub(crate) fn panels(&self) -> Vec<FigurePanel> {
        let times: Vec<f64> = self.log.samples().iter().map(|sample| sample.t).collect();
        let shaded = doubtful_spans(&times, &self.estimate.relied_on);
        let missing = sample_gaps(&times);
        let panel = |title: &str, unit: &str, curves| FigurePanel {
            title: title.to_owned(),
            axes: ["t in s".to_owned(), unit.to_owned()],
            curves,
            shaded: shaded.clone(),
            missing: missing.clone(),
            ..FigurePanel::default()
        };
        let line = |name: String, points: Vec<[f64; 2]>, half_heights: Vec<f64>| FigureCurve {
            name,
            points,
            half_heights,
            ..FigureCurve::default()
        };
        let relied = |k: &usize| self.estimate.relied_on[*k];
        let shape = self.estimate.contacts.iter().enumerate().map(|(i, contacts)| FigureCurve {
            name: format!("palm {}", i + 1),
            points: (0..times.len())
                .filter(relied)
                .filter_map(|k| contacts[k].map(|c| c.p_OC.to_array()))
                .collect(),
            dots: true,
            ..FigureCurve::default()
        });
        let shape: Vec<FigureCurve> = shape.filter(|curve| !curve.points.is_empty()).collect();
        let over =
            |pick: &dyn Fn(usize) -> f64| (0..times.len()).map(|k| [times[k], pick(k)]).collect::<Vec<_>>();
        let turn = FigureCurve {
            reference: self.log.truth().map_or_else(Vec::new, |truth| {
                truth.iter().zip(&times).map(|(at, t)| [*t, at.phi0 - truth[0].phi0]).collect()
            }),
            ..line(
                "phi0".to_owned(),
                over(&|k| self.estimate.states[k].phi0),
                self.estimate.deviations.iter().map(|of| 2.0 * of.phi0).collect(),
            )
        };
        let place = ["x", "y"].into_iter().enumerate().map(|(i, name)| {
            let bands = self.estimate.deviations.iter().map(|of| 2.0 * of.p_WCm[i]).collect();
            line(name.to_owned(), over(&|k| self.estimate.states[k].p_WCm[i]), bands)
        });
        let radii = self.estimate.contacts.iter().enumerate().map(|(i, contacts)| {
            let radius = |k: usize| contacts[k].map_or(f64::NAN, |contact| contact.radius);
            // Where a palm is touched is known: what is not is the centre of mass along its normal.
            let wide = |k: usize| {
                let along = |contact: PlaneContact| {
                    let n = DVec2::from_angle(self.estimate.states[k].phi0).rotate(contact.normal);
                    2.0 * (n * self.estimate.deviations[k].p_WCm).length()
                };
                contacts[k].map_or(f64::NAN, along)
            };
            line(format!("r{}", i + 1), over(&radius), (0..times.len()).map(wide).collect())
        });
        let forces = (0..self.estimate.contacts.len()).map(|i| {
            let size = |k: usize| self.log.samples()[k].palms[i].force.length();
            let wide = |k: usize| 2.0 * self.noise.force_fixed.hypot(self.noise.force_share * size(k));
            line(format!("palm {}", i + 1), over(&size), (0..times.len()).map(wide).collect())
        });
        let mut panels = vec![
            FigurePanel {
                title: "Shape: contact points on the object".to_owned(),
                axes: ["x in m".to_owned(), "y in m".to_owned()],
                equal: true,
                curves: shape,
                ..FigurePanel::default()
            },
            panel("Orientation, with two deviations", "phi0 in rad", vec![turn]),
            panel("Centre of mass, with two deviations", "m", place.collect()),
            panel("Radius functions, with two deviations", "r in m", radii.collect()),
            panel("Contact forces, with two deviations", "N", forces.collect()),
        ];
        if let Some(errors) = self.errors().filter(|errors| !errors.is_empty()) {
            let names = ["error in x (m)", "error in y (m)", "error in phi0 (rad)"];
            let curves = names.into_iter().enumerate().map(|(i, name)| {
                line(name.to_owned(), errors.iter().map(|e| [e[0], e[i + 1]]).collect(), Vec::new())
            });
            panels.push(panel("Errors", "m, rad", curves.collect()));
        }
        panels
    }
}
