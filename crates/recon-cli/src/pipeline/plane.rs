//! Bounds of an outline in the plane, with what is drawn of them.

use super::doubts::{Doubts, doubtful_fit};
use super::fitted::{fitted_outline, relative_noise};
use super::sound::{Noise, largest, left_out, listed};
use super::views::touch_next;
use crate::cli::FitAs;
use crate::error::CliError;
use glam::DVec2;
use recon::contact_kinematics::planar::RadiusBounds;
use recon::shape_bounds::exact_hull::planar::{Direction, Hull, Intersection};
use recon::shape_bounds::planar::curvature::CurvatureBounds;
use recon::shape_bounds::planar::noise::{
    ContactNoise, NoiseError, NoisyContact, certain_lower_bound, correlated_noise, estimate_noise,
    independence_is_tested, with_noise_as_found, without_outliers,
};
use recon::shape_bounds::planar::{ContactSample, ShapeBounds};
use recon_io::{FigureCurve, FigurePanel, outline_stands_out};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::io::{self, Write};

/// Directions in which the gap is drawn.
const DIRECTIONS: u32 = 720;
/// Turning between points of a drawn arc, in rad.
const STEP: f64 = 0.01;

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlanarRequest {
    /// Known noise, and the confidence.
    pub(crate) noise: Option<(Noise, f64)>,
    /// Limits on the radius of curvature, for exact contacts.
    pub(crate) radii: Option<RadiusBounds>,
    /// A shape to fit.
    pub(crate) fit: Option<FitAs>,
}

/// Bounds of an outline.
pub(crate) struct PlanarBounds {
    /// The contact points that were used.
    pub(crate) points: Vec<DVec2>,
    /// Corners, or points along the arcs, of the lower and the upper bound; empty where there is none.
    pub(crate) outlines: [Vec<DVec2>; 2],
    /// The fitted outline; empty where none was asked for or the contacts refute it.
    pub(crate) fitted: Vec<DVec2>,
    /// Areas of both bounds in m^2; the second is infinite where the contacts leave a side open.
    pub(crate) areas: [f64; 2],
    /// Direction of the normal (rad) and how far the bounds are apart there (m).
    pub(crate) gaps: Vec<[f64; 2]>,
    /// Their Hausdorff distance, or somewhat more, m; `None` where a side is open.
    pub(crate) largest_gap: Option<f64>,
    /// Where a touch tells most: the corner of the upper bound that is farthest from the lower one.
    next: Option<DVec2>,
    /// How far the lower bound stands out of the upper one, m: for exact contacts at most rounding.
    pub(crate) contradiction: f64,
    /// What the reader must know.
    pub(crate) warnings: Vec<String>,
    /// Noise, limits and fit.
    pub(crate) about: Value,
}

impl PlanarBounds {
    /// The outlines that there are, by the names of their files.
    pub(crate) fn drawn_outlines(&self) -> Vec<(&'static str, &[DVec2])> {
        let named =
            ["lower_bound.csv", "upper_bound.csv"].into_iter().zip(self.outlines.iter().map(Vec::as_slice));
        named.filter(|(_, outline)| !outline.is_empty()).collect()
    }

    /// Numbers for summary.json.
    pub(crate) fn figures(&self) -> Value {
        let [lower, upper] = self.areas;
        json!({
            "lower_area_m2": lower,
            "upper_area_m2": upper,
            "lower_over_upper": lower / upper,
            "largest_gap_m": self.largest_gap,
            "contradiction_m": self.contradiction,
        })
    }

    /// Writes an outline, a corner a row.
    pub(crate) fn write_outline(outline: &[DVec2], to: &mut dyn Write) -> io::Result<()> {
        writeln!(to, "x,y")?;
        outline.iter().try_for_each(|p| writeln!(to, "{:?},{:?}", p.x, p.y))
    }

    /// The bounds with the contacts between them.
    pub(crate) fn panel(&self) -> FigurePanel {
        let closed = |name: &str, outline: &[DVec2]| FigureCurve {
            name: name.to_owned(),
            points: outline.iter().chain(outline.first()).map(|p| p.to_array()).collect(),
            filled: true,
            ..FigureCurve::default()
        };
        let [lower, upper] = &self.outlines;
        let contacts = FigureCurve {
            name: "contacts".to_owned(),
            points: self.points.iter().map(DVec2::to_array).collect(),
            dots: true,
            ..FigureCurve::default()
        };
        let mut curves = vec![closed("lower bound", lower), closed("upper bound", upper), contacts];
        curves.push(closed("fit", &self.fitted));
        curves.extend(self.next.map(|at| touch_next(at, upper)));
        curves.retain(|curve| !curve.points.is_empty());
        FigurePanel {
            title: "Bounds".to_owned(),
            axes: ["x in m".to_owned(), "y in m".to_owned()],
            equal: true,
            curves,
            ..FigurePanel::default()
        }
    }
}

/// Bounds of a convex outline from `curves` of contacts.
pub(crate) fn planar_bounds(
    curves: &[Vec<ContactSample>],
    request: &PlanarRequest,
) -> Result<PlanarBounds, CliError> {
    let all = curves.concat();
    let (kept, mut made) = match (request.radii, request.noise) {
        (Some(radii), _) => (relative_noise(&all), sharp(&all, radii)?),
        (None, Some((noise, confidence))) => {
            let Cleaned { kept, warnings, about } = cleaned(curves, noise, confidence)?;
            let mut made = noisy(&kept, confidence, about)?;
            made.warnings.extend(warnings);
            (kept.concat(), made)
        }
        (None, None) => {
            (relative_noise(&all), drawn(&ShapeBounds::from_contacts(&all)?, json!({ "noise": "none" })))
        }
    };
    made.points = kept.iter().map(|c| c.contact.point).collect();
    if let Some(family) = request.fit {
        let fitted = fitted_outline(&kept, request.noise.is_some(), family)?;
        made.about["fit"] = fitted.report;
        made.fitted = fitted.drawn.unwrap_or_default();
        made.warnings.extend(fitted.warning);
        made.warnings.extend(doubtful_fit(&made.about));
    }
    Ok(made)
}

/// Contacts with their noise, without outliers; each in a curve of its own where noise is alike from one to the next, because nothing
/// is gained by means then.
struct Cleaned {
    kept: Vec<Vec<NoisyContact>>,
    warnings: Vec<String>,
    about: Value,
}

fn cleaned(curves: &[Vec<ContactSample>], noise: Noise, confidence: f64) -> Result<Cleaned, CliError> {
    let (how, noisy): (_, Vec<Vec<NoisyContact>>) = match noise {
        Noise::Stated { point, normal } => {
            let noise = ContactNoise::isotropic(point, normal);
            let with_noise = |contact: &ContactSample| NoisyContact { contact: *contact, noise };
            ("stated", curves.iter().map(|curve| curve.iter().map(with_noise).collect()).collect())
        }
        Noise::Estimated => ("estimated", estimate_noise(curves, confidence)?),
    };
    let alike = (correlated_noise(&noisy), independence_is_tested(&noisy));
    let (noisy, levels) = with_noise_as_found(&noisy);
    let doubts = Doubts::new(levels, alike, noise)?;
    let (mut kept, outliers) = without_outliers(&noisy, confidence)?;
    if doubts.correlated {
        kept = kept.into_iter().flatten().map(|contact| vec![contact]).collect();
    }
    let levels: Vec<Value> = noisy.iter().map(|curve| largest(curve.iter().map(level))).collect();
    let mut about =
        json!({ "confidence": confidence, "noise": { how: levels }, "outliers": listed(&outliers) });
    doubts.add_to(&mut about);
    Ok(Cleaned {
        kept,
        warnings: doubts.warnings().chain(left_out(&outliers)).chain(doubts.untested()).collect(),
        about,
    })
}

/// Standard deviations of a contact across and along the outline (m) and of its normal (rad).
fn level(c: &NoisyContact) -> [f64; 3] {
    let n = c.contact.normal.get();
    let deviation = |u: DVec2| u.dot(c.noise.point * u).max(0.0).sqrt();
    [deviation(n), deviation(n.perp()), c.noise.normal]
}

/// The field of gaps of a pair of support functions; empty where the upper one has no end.
fn gaps(support: impl Fn(Direction) -> (f64, f64)) -> Vec<[f64; 2]> {
    let at = |k: u32| {
        let angle = TAU * f64::from(k) / f64::from(DIRECTIONS);
        let (lower, upper) = support(Direction::from_angle(angle));
        [angle, upper - lower]
    };
    let all: Vec<[f64; 2]> = (0..=DIRECTIONS).map(at).collect();
    if all.iter().all(|g| g[1].is_finite()) { all } else { Vec::new() }
}

/// Of `upper` what lies farthest in the direction in which the bounds are farthest apart.
fn next(gaps: &[[f64; 2]], upper: &[DVec2]) -> Option<DVec2> {
    let [angle, _] = *gaps.iter().max_by(|a, b| a[1].total_cmp(&b[1]))?;
    let n = DVec2::from_angle(angle);
    upper.iter().copied().max_by(|a, b| n.dot(*a).total_cmp(&n.dot(*b)))
}

/// Bounds as they are drawn.
fn drawn(bounds: &ShapeBounds, about: Value) -> PlanarBounds {
    let lower = bounds.lower().polygon().map(|p| p.shape().vertices().to_vec());
    let upper = bounds.upper().bounded().map(|r| r.shape().vertices().to_vec());
    let mut warnings = Vec::new();
    if lower.is_none() {
        warnings.push("All contacts lie on one line: the lower bound has no area.".to_owned());
    }
    if let Intersection::Unbounded(_) = bounds.upper() {
        warnings.push(
            "The contacts leave the object unbounded on some side: there is no upper bound.".to_owned(),
        );
    }
    let outlines = [lower, upper].map(Option::unwrap_or_default);
    let largest = bounds.largest_gap();
    PlanarBounds {
        points: Vec::new(),
        contradiction: outline_stands_out(&outlines[0], &outlines[1]),
        outlines,
        fitted: Vec::new(),
        areas: [bounds.lower_area(), bounds.upper_area()],
        gaps: gaps(|n| bounds.support(n)),
        largest_gap: bounds.upper().bounded().map(|_| largest.map_or(0.0, |gap| gap.distance)),
        next: largest.map(|gap| gap.outer),
        warnings,
        about,
    }
}

/// Bounds that hold at `confidence`, or the lower one alone.
pub(super) fn noisy(
    curves: &[Vec<NoisyContact>],
    confidence: f64,
    about: Value,
) -> Result<PlanarBounds, NoiseError> {
    match ShapeBounds::from_noisy_curves(curves, confidence) {
        Ok(bounds) => Ok(drawn(&bounds, about)),
        Err(NoiseError::NoUpperBound { .. }) => Ok(open(&certain_lower_bound(curves, confidence)?, about)),
        Err(error) => Err(error),
    }
}

/// The lower bound alone, where nothing finite is certain to be around the object.
fn open(lower: &Hull, about: Value) -> PlanarBounds {
    let outline = lower.polygon().map(|p| p.shape().vertices().to_vec()).unwrap_or_default();
    let area = lower.polygon().map_or(0.0, |polygon| polygon.shape().area());
    PlanarBounds {
        points: Vec::new(),
        contradiction: 0.0,
        outlines: [outline, Vec::new()],
        fitted: Vec::new(),
        areas: [area, f64::INFINITY],
        gaps: Vec::new(),
        largest_gap: None,
        next: None,
        warnings: vec![
            "Nothing finite is certain to contain the object: the contacts leave a side of it open, or their normals are too uncertain. There is no upper bound."
                .to_owned(),
        ],
        about,
    }
}

fn sharp(contacts: &[ContactSample], radii: RadiusBounds) -> Result<PlanarBounds, CliError> {
    let bounds = CurvatureBounds::from_contacts(contacts, radii)?;
    let outlines = [bounds.lower().outline(STEP), bounds.upper().outline(STEP)];
    // The height of an arc above its chord, which is no longer than the outline is wide.
    let (low, high) =
        outlines[1].iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let height = (radii.max * (1.0 - (STEP / 2.0).cos())).min((high - low).length() * STEP / 8.0);
    let gaps = gaps(|n| bounds.support(n));
    Ok(PlanarBounds {
        points: Vec::new(),
        contradiction: 0.0,
        fitted: Vec::new(),
        areas: [bounds.lower().area(), bounds.upper().area()],
        next: next(&gaps, &outlines[1]),
        gaps,
        largest_gap: Some(bounds.largest_gap()),
        outlines,
        warnings: Vec::new(),
        about: json!({ "noise": "none", "radii_of_curvature_m": [radii.min, radii.max], "outline_tolerance_m": height }),
    })
}
