use super::features::FoundFeatures;
use crate::error::CliError;
use recon::shape_bounds::exact_hull::{Hull, Intersection, Polyhedron, SolidHull};
use recon::shape_bounds::{ContactSample, ShapeBounds};
use recon_io::{Bound, Bounds, MeshError, TriangleMesh, stands_out};

/// Files of the bounds.
pub(super) const LOWER: &str = "lower_bound.ply";
pub(super) const UPPER: &str = "upper_bound.ply";

/// Contact noise above this share of the object's size is worth a warning beside the bounds.
pub(super) const NOTABLE_NOISE: f64 = 1e-6;
/// Confidence of bounds from noisy contacts.
pub(super) const CONFIDENCE: f64 = 0.95;

/// Most contacts that the bounds of a picture are made from: about 6000 triangles a body.
const DRAWN: usize = 1500;

/// Bounds from all contacts for measuring, and from some of them for drawing.
pub(crate) struct BoundsResult {
    /// Volumes of all, surfaces of [`DRAWN`].
    pub(crate) drawn: Bounds,
    /// Surface of the lower bound; none for contacts in one plane.
    pub(crate) lower: Option<TriangleMesh>,
    /// Surface of the upper bound; none where it is unbounded.
    pub(crate) upper: Option<TriangleMesh>,
    /// Further surfaces: file, comment, mesh.
    pub(crate) others: Vec<(&'static str, &'static str, TriangleMesh)>,
    /// Corners, edges and faces, where noise is known.
    pub(crate) features: Option<FoundFeatures>,
    /// How far the lower bound stands out of the upper one, m: for exact contacts of a convex body at most rounding,
    /// however they were moved.
    pub(crate) contradiction: f64,
    /// What the reader must know.
    pub(crate) warnings: Vec<String>,
}

impl BoundsResult {
    /// With how far the lower bound stands out of the upper one, and a warning where that is worth one.
    pub(super) fn compared(mut self) -> Self {
        let both = self.lower.as_ref().zip(self.upper.as_ref());
        self.contradiction = both.map_or(0.0, |(lower, upper)| stands_out(lower, upper));
        if self.contradicts() {
            self.warnings.push(format!(
                "The contacts contradict each other: the lower bound stands out of the upper one by {:.1e} m.",
                self.contradiction
            ));
        }
        self
    }

    /// The surfaces of the bounds by the names of their files.
    pub(crate) fn surfaces(&self) -> Vec<(&'static str, &TriangleMesh)> {
        let both = [(LOWER, self.lower.as_ref()), (UPPER, self.upper.as_ref())];
        both.into_iter().filter_map(|(name, mesh)| Some((name, mesh?))).collect()
    }

    /// Whether contacts contradict each other by more than is worth a warning.
    pub(crate) fn contradicts(&self) -> bool {
        let corners = self.upper.iter().flat_map(|mesh| &mesh.vertices);
        self.contradiction > NOTABLE_NOISE * corners.map(|corner| corner.length()).fold(0.0, f64::max)
    }
}

/// Lower and upper bound from exact contacts on a convex body.
pub(crate) fn exact_bounds(contacts: &[ContactSample]) -> Result<BoundsResult, CliError> {
    made(ShapeBounds::from_contacts(contacts)?, contacts)
}

/// Lower and upper bound from contacts that are taken as exact, but were moved by an estimate and may contradict each other.
pub(crate) fn bounds(contacts: &[ContactSample]) -> Result<BoundsResult, CliError> {
    made(ShapeBounds::from_contradicting_contacts(contacts)?, contacts)
}

fn made(whole: ShapeBounds, contacts: &[ContactSample]) -> Result<BoundsResult, CliError> {
    let (lower, upper) = meshes(&whole)?;
    let mut warnings = Vec::new();
    if lower.is_none() {
        warnings.push(flat(whole.lower()).to_owned());
    }
    warnings.extend(unbounded(&whole));
    let some = some_of(contacts, DRAWN);
    let few =
        if contacts.len() > some.len() { ShapeBounds::from_contradicting_contacts(&some).ok() } else { None };
    let few = few.as_ref().unwrap_or(&whole);
    // Fewer contacts may leave nothing to draw where all of them gave bounds; then all are drawn.
    let (few_lower, few_upper) = meshes(few)?;
    let drawn = Bounds {
        lower: Bound { mesh: few_lower.or(lower.clone()).unwrap_or_default(), volume: whole.lower_volume() },
        upper: upper
            .clone()
            .map(|all| Bound { mesh: few_upper.unwrap_or(all), volume: whole.upper_volume() }),
        largest_gap: whole.largest_gap(),
    };
    // Half-spaces were moved out to where no contact lies beyond them.
    Ok(BoundsResult { drawn, lower, upper, others: Vec::new(), features: None, contradiction: 0.0, warnings })
}

/// What to say where there is no upper bound.
pub(super) fn unbounded(bounds: &ShapeBounds) -> Option<String> {
    let Intersection::Unbounded(open) = bounds.upper() else { return None };
    let d = open.directions().first().map(|d| d.get());
    let side = d.map_or(String::new(), |d| format!(", for one towards ({:.2}, {:.2}, {:.2})", d.x, d.y, d.z));
    Some(format!("The contacts leave the object unbounded on some side{side}: there is no upper bound."))
}

/// At most so many of them, spread evenly.
fn some_of<T: Copy>(all: &[T], most: usize) -> Vec<T> {
    let count = all.len().min(most);
    (0..count).map(|k| all[k * all.len() / count]).collect()
}

/// Surfaces of bounds for drawing: of some of their corners and planes, where there are many.
pub(super) fn drawn_surfaces(
    lower: Option<&SolidHull>,
    upper: Option<&Polyhedron>,
) -> Result<(Option<TriangleMesh>, Option<TriangleMesh>), CliError> {
    let lower = lower.map(|all| match Hull::of(&some_of(all.vertices(), DRAWN)) {
        Ok(Hull::Solid(few)) => own(few.mesh()),
        _ => own(all.mesh()),
    });
    let upper = upper.map(|all| match Intersection::of(&some_of(all.face_half_spaces(), DRAWN)) {
        Ok(Intersection::Bounded(few)) => own(few.mesh()),
        _ => own(all.mesh()),
    });
    Ok((lower.transpose()?, upper.transpose()?))
}

/// A surface as the writer of meshes takes it.
pub(super) fn own(mesh: recon::shape_bounds::exact_hull::TriangleMesh) -> Result<TriangleMesh, MeshError> {
    TriangleMesh::new(mesh.vertices, mesh.triangles)
}

/// Surfaces of the bounds that have a volume.
pub(super) fn meshes(bounds: &ShapeBounds) -> Result<(Option<TriangleMesh>, Option<TriangleMesh>), CliError> {
    let lower = bounds.lower().solid().map(|solid| own(solid.mesh())).transpose()?;
    let upper = bounds.upper().bounded().map(|polyhedron| own(polyhedron.mesh())).transpose()?;
    Ok((lower, upper))
}

fn flat(hull: &Hull) -> &'static str {
    match hull {
        Hull::Point(_) => "All contacts are at one point: the lower bound has no volume.",
        Hull::Segment(_) => "All contacts lie on one line: the lower bound has no volume.",
        Hull::Polygon(_) | Hull::Solid(_) => "All contacts lie in one plane: the lower bound has no volume.",
    }
}
