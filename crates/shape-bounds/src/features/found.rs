//! What was found.

use contact_kinematics::Direction;
use glam::{DMat3, DVec3};

/// What a body is like where it was touched.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
#[non_exhaustive]
pub enum FeatureKind {
    /// Radii of curvature between nothing and no end.
    Smooth,
    /// One point under all normals of a cone: both radii are nothing.
    Corner,
    /// Points of a line, each under the normals across it: one radius is nothing, the other without end.
    Edge,
    /// Points of a plane under one normal: both radii are without end.
    Face,
}

impl FeatureKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Smooth, Self::Corner, Self::Edge, Self::Face];

    /// Its name, as it stands in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Corner => "corner",
            Self::Edge => "edge",
            Self::Face => "face",
        }
    }
}

/// When something is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureOptions {
    /// Odds that a kind must have against all others together before a run is told to be of it; above 1.
    pub odds: f64,
}

impl Default for FeatureOptions {
    /// Thirty to one: a curve has some tens of runs.
    fn default() -> Self {
        Self { odds: 30.0 }
    }
}

/// Contacts of a curve that follow each other and are of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureRun {
    /// Which curve, from 0.
    pub curve: usize,
    /// Its first contact in the curve, from 0.
    pub first: usize,
    /// How many contacts.
    pub count: usize,
    /// What they are; none where the odds leave it open.
    pub kind: Option<FeatureKind>,
    /// Natural logarithm of the evidence of each kind, in the order of [`FeatureKind::ALL`].
    pub log_evidence: [f64; 4],
    /// Natural logarithm of the odds for the most probable kind against all others together.
    pub log_odds: f64,
    /// Which corner, edge or face of [`Features`] it is on, from 0.
    pub feature: Option<usize>,
}

/// A corner, body axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Corner {
    /// Where it is, m.
    pub point: DVec3,
    /// Covariance of that, m^2.
    pub covariance: DMat3,
    /// Contacts that it rests on.
    pub contacts: usize,
    /// Indices of its runs.
    pub runs: Vec<usize>,
}

/// A straight edge, body axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Mean of its contacts, m.
    pub point: DVec3,
    /// Covariance of that, m^2.
    pub covariance: DMat3,
    /// Along it.
    pub direction: Direction,
    /// Standard deviation of the direction about each axis across it, rad.
    pub turn: f64,
    /// How far its contacts lie along it on either side of the point, m.
    pub extent: [f64; 2],
    /// Contacts that it rests on.
    pub contacts: usize,
    /// Indices of its runs.
    pub runs: Vec<usize>,
}

/// A flat face, body axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Mean of its contacts, m.
    pub point: DVec3,
    /// Covariance of that, m^2.
    pub covariance: DMat3,
    /// Outward normal.
    pub normal: Direction,
    /// Standard deviation of the normal about each tangent axis, rad.
    pub turn: f64,
    /// Contacts that it rests on.
    pub contacts: usize,
    /// Indices of its runs.
    pub runs: Vec<usize>,
}

/// Runs of all curves, and the corners, edges and faces that they show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// By curve, in their order.
    pub runs: Vec<FeatureRun>,
    /// Corners, in the order in which they were touched first.
    pub corners: Vec<Corner>,
    /// Edges, likewise.
    pub edges: Vec<Edge>,
    /// Faces, likewise.
    pub faces: Vec<Face>,
}

impl Features {
    /// The run of each contact of each curve: its index.
    #[must_use]
    pub fn run_of_each(&self, curves: usize) -> Vec<Vec<usize>> {
        let mut of = vec![Vec::new(); curves];
        for (index, run) in self.runs.iter().enumerate() {
            if let Some(list) = of.get_mut(run.curve) {
                list.extend(std::iter::repeat_n(index, run.count));
            }
        }
        of
    }

    /// How many contacts are of a kind; of none, with `None`.
    #[must_use]
    pub fn contacts(&self, kind: Option<FeatureKind>) -> usize {
        self.runs.iter().filter(|run| run.kind == kind).map(|run| run.count).sum()
    }

    /// Whether nothing but smooth surface was told.
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        self.corners.is_empty() && self.edges.is_empty() && self.faces.is_empty()
    }
}
