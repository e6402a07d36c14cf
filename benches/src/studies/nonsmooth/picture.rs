//! Contacts of a body, in the colours of what they are told to be.

use glam::DVec3;
use recon::shape_bounds::features::{FeatureKind, Features};
use recon_io::{FigureCurve, FigurePanel};
use shape_bounds::generators::{Touched, TouchedBody};

/// Looked at from aside and above, so that no face hides an edge.
fn seen(p: DVec3) -> [f64; 2] {
    let (right, up) = (DVec3::new(0.9, 0.43, 0.0).normalize(), DVec3::new(-0.2, 0.35, 0.91).normalize());
    [right.dot(p), up.dot(p)]
}

pub(super) fn panel(name: &str, body: &TouchedBody, touched: &Touched, found: &Features) -> FigurePanel {
    let of = found.run_of_each(touched.curves.len());
    let kinds = [
        Some(FeatureKind::Corner),
        Some(FeatureKind::Edge),
        Some(FeatureKind::Face),
        Some(FeatureKind::Smooth),
        None,
    ];
    let curve = |kind: Option<FeatureKind>| {
        let all = touched.curves.iter().flatten().zip(of.iter().flatten());
        let points =
            all.filter(|(_, run)| found.runs[**run].kind == kind).map(|(c, _)| seen(c.contact.point));
        FigureCurve {
            name: kind.map_or("open", FeatureKind::name).to_owned(),
            points: points.collect(),
            dots: true,
            ..FigureCurve::default()
        }
    };
    FigurePanel {
        title: format!("{name}, noise 1 %: {:.2} m", body.size()),
        axes: ["m".to_owned(), "m".to_owned()],
        equal: true,
        curves: kinds.map(curve).into_iter().filter(|curve| !curve.points.is_empty()).collect(),
        ..FigurePanel::default()
    }
}
