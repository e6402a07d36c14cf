//! Corners, edges and faces that contacts show: for programs, in words, as a table.

use super::bounds::{BoundsResult, own};
use super::views::views;
use crate::error::CliError;
use glam::{DMat3, DVec3};
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::features::{FeatureKind, Features, FoundPolyhedron};
use recon::shape_bounds::noise::NoisyContact;
use recon_io::{ShapeMarks, TriangleMesh, brief};
use serde_json::{Value, json};
use std::fmt::Write;

/// The table of what each contact is on.
pub(crate) const MARKS: &str = "contact_marks.csv";
/// The polyhedron, where corners and faces are all there is.
pub(crate) const POLYHEDRON: &str = "polyhedron.ply";

/// What contacts show of a body that is not smooth, with the contacts themselves.
#[derive(Clone, Debug)]
pub(crate) struct FoundFeatures {
    found: Features,
    curves: Vec<Vec<ContactSample>>,
    /// Of each contact its number from 1: in its curve, or of its sample in the log.
    numbers: Vec<Vec<usize>>,
    odds: f64,
    polyhedron: Option<FoundPolyhedron>,
}

impl FoundFeatures {
    pub(super) fn new(
        found: Features,
        curves: &[Vec<NoisyContact>],
        numbers: Vec<Vec<usize>>,
        odds: f64,
    ) -> Self {
        let polyhedron = found.polyhedron();
        let curves = curves.iter().map(|curve| curve.iter().map(|c| c.contact).collect()).collect();
        Self { found, curves, numbers, odds, polyhedron }
    }

    /// Whether nothing but smooth surface was found.
    pub(crate) fn is_smooth(&self) -> bool {
        self.found.is_smooth()
    }

    /// For the summary.
    pub(crate) fn figures(&self) -> Value {
        let found = &self.found;
        let corner = |c: &recon::shape_bounds::features::Corner| json!({ "point_m": c.point.to_array(), "std_m": deviations(c.covariance), "contacts": c.contacts, "touched": c.runs.len() });
        let edge = |e: &recon::shape_bounds::features::Edge| {
            let at = |s: f64| (e.point + s * e.direction.get()).to_array();
            json!({
                "from_m": at(e.extent[0]), "to_m": at(e.extent[1]), "std_m": deviations(e.covariance), "std_direction_rad": e.turn,
                "contacts": e.contacts, "touched": e.runs.len(),
            })
        };
        let face = |f: &recon::shape_bounds::features::Face| {
            json!({
                "point_m": f.point.to_array(), "normal": f.normal.get().to_array(), "std_m": deviations(f.covariance),
                "std_normal_rad": f.turn, "contacts": f.contacts, "touched": f.runs.len(),
            })
        };
        let counts: serde_json::Map<String, Value> =
            self.counts().into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect();
        let mut figures = json!({
            "odds": self.odds,
            "contacts": counts,
            "corners": found.corners.iter().map(corner).collect::<Vec<_>>(),
            "edges": found.edges.iter().map(edge).collect::<Vec<_>>(),
            "faces": found.faces.iter().map(face).collect::<Vec<_>>(),
        });
        if let Some(made) = &self.polyhedron {
            let by = if made.by_faces { "faces" } else { "corners" };
            figures["polyhedron"] = json!({ "volume_m3": made.volume, "by": by });
        }
        figures
    }

    /// How many contacts are on what.
    fn counts(&self) -> [(&'static str, usize); 5] {
        let of = |kind: FeatureKind| (kind.name(), self.found.contacts(Some(kind)));
        let [a, b, c, d] = FeatureKind::ALL.map(of);
        [a, b, c, d, ("open", self.found.contacts(None))]
    }

    /// Each contact with what it is on: a kind by its number (0 open, 1 smooth, 2 corner, 3 edge, 4 face), and which of them by its number
    /// in the summary, 0 for none.
    pub(crate) fn table(&self) -> Vec<u8> {
        let mut text = String::from("curve,contact,x,y,z,nx,ny,nz,kind,feature,log_odds\n");
        let of = self.found.run_of_each(self.curves.len());
        for (curve, contacts) in self.curves.iter().enumerate() {
            for ((contact, run), number) in contacts.iter().zip(&of[curve]).zip(&self.numbers[curve]) {
                let run = &self.found.runs[*run];
                let (p, n) = (contact.point, contact.normal.get());
                let kind = run.kind.map_or(0, |kind| 1 + kind as usize);
                let feature = run.feature.map_or(0, |feature| feature + 1);
                let _ = writeln!(
                    text,
                    "{},{number},{},{},{},{},{},{},{kind},{feature},{:.3}",
                    curve + 1,
                    p.x,
                    p.y,
                    p.z,
                    n.x,
                    n.y,
                    n.z,
                    run.log_odds
                );
            }
        }
        text.into_bytes()
    }

    /// Contacts by what they are on, for pictures; smooth and open ones together.
    fn dots(&self) -> Vec<(&'static str, Vec<DVec3>)> {
        let of = self.found.run_of_each(self.curves.len());
        let name = |kind: Option<FeatureKind>| match kind {
            None | Some(FeatureKind::Smooth) => "other",
            Some(kind) => kind.name(),
        };
        let points = |wanted: &'static str| {
            let pairs = self.curves.iter().zip(&of).flat_map(|(curve, runs)| curve.iter().zip(runs));
            let of_kind = pairs.filter(|(_, run)| name(self.found.runs[**run].kind) == wanted);
            (wanted, of_kind.map(|(contact, _)| contact.point).collect())
        };
        ["corner", "edge", "face", "other"].map(points).to_vec()
    }

    /// Key figures of a page.
    fn facts(&self) -> Vec<(&'static str, String, &'static str)> {
        let found = &self.found;
        let counts =
            [("Corners", found.corners.len()), ("Edges", found.edges.len()), ("Faces", found.faces.len())];
        let mut facts: Vec<_> = counts.map(|(name, count)| (name, count.to_string(), "")).to_vec();
        facts.extend(self.polyhedron.as_ref().map(|made| ("Polyhedron, about", brief(made.volume), "m³")));
        facts
    }

    /// The polyhedron's surface.
    pub(super) fn mesh(&self) -> Result<Option<TriangleMesh>, CliError> {
        Ok(self.polyhedron.as_ref().map(|made| own(made.mesh.clone())).transpose()?)
    }
}

impl BoundsResult {
    /// With corners, edges and faces; where there are any, also the polyhedron that they make.
    pub(super) fn with_features(mut self, mut features: FoundFeatures) -> Result<Self, CliError> {
        // One that is smaller than what is certain lacks corners.
        features.polyhedron = features.polyhedron.filter(|made| made.volume >= self.drawn.lower.volume);
        if let Some(mesh) = features.mesh()? {
            self.others.push((POLYHEDRON, "polyhedron of corners and faces; an estimate; metres", mesh));
        }
        self.features = Some(features);
        Ok(self)
    }

    /// What a page shows of it: views of the contacts by what they are on, in the polyhedron or the lower bound.
    pub(super) fn marks(&self) -> Option<ShapeMarks> {
        let found = self.not_smooth()?;
        let made =
            self.others.iter().find(|(name, ..)| *name == POLYHEDRON).map(|(.., mesh)| ("polyhedron", mesh));
        let body = made.or(self.lower.as_ref().map(|lower| ("lower", lower)));
        let body: Vec<_> = body.iter().map(|(name, mesh)| (*name, &mesh.vertices[..])).collect();
        let dots = found.dots();
        let dots: Vec<_> = dots.iter().map(|(name, points)| (*name, &points[..])).collect();
        Some(ShapeMarks { facts: found.facts(), panels: views(&body, &dots, None) })
    }

    /// What was found that is not smooth.
    pub(crate) fn not_smooth(&self) -> Option<&FoundFeatures> {
        self.features.as_ref().filter(|features| !features.is_smooth())
    }
}

/// Standard deviations along the axes, m.
fn deviations(covariance: DMat3) -> [f64; 3] {
    [covariance.x_axis.x, covariance.y_axis.y, covariance.z_axis.z].map(|variance| variance.max(0.0).sqrt())
}

/// What a summary tells of corners, edges and faces, in lines for the console; nothing of a smooth body.
pub(crate) fn feature_lines(features: &Value) -> Vec<(&'static str, String)> {
    let count = |key: &str| features[key].as_array().map_or(0, Vec::len);
    let [corners, edges, faces] = ["corners", "edges", "faces"].map(count);
    if corners + edges + faces == 0 {
        return Vec::new();
    }
    let shares = features["contacts"].as_object().into_iter().flatten();
    let shares: Vec<String> = shares
        .filter(|(_, count)| count.as_u64() != Some(0))
        .map(|(name, count)| format!("{count} {name}"))
        .collect();
    let odds = features["odds"].as_f64().unwrap_or_default();
    let found =
        format!("{corners} corner(s), {edges} edge(s), {faces} face(s), at odds of {} to 1", brief(odds));
    let mut lines = vec![("not smooth", found), ("contacts", shares.join(", "))];
    let made = &features["polyhedron"];
    if let (Some(volume), Some(by)) = (made["volume_m3"].as_f64(), made["by"].as_str()) {
        lines.push(("polyhedron", format!("{} m^3, by its {by}: {POLYHEDRON}", brief(volume))));
    }
    lines
}
