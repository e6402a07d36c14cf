//! The reconstructed object as a model for simulators.

use crate::cli::{ExportAs, ShapeAs};
use crate::error::CliError;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::MassProperties;
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::fit::{FitOptions, FittedBody, NoiseLevel, ShapeFamily, ShapeFit, SkewEllipsoid};
use recon::shape_bounds::noise::{ContactNoise, NoisyContact};
use recon_io::{
    ExportError, ExportFormat, ExportShape, ExportedFile, MassDeviations, MotionState, ObjectModel,
    TriangleMesh,
};

/// Misfit up to which contacts are those of an ellipsoid: this share of its size, and this many deviations of the
/// contacts' noise. What is left then matters to no simulator.
const ELLIPSOIDAL: (f64, f64) = (1e-4, 5.0);
/// Contacts that the ellipsoid is fitted to, at most.
const FITTED: usize = 3000;

/// A reconstructed object.
pub(crate) struct Object<'a> {
    pub(crate) title: &'a str,
    pub(crate) verdict: &'a str,
    /// Mass and inertia in the body axes of the estimate.
    pub(crate) mass: MassProperties,
    /// How well they are known where they were estimated.
    pub(crate) deviations: Option<MassDeviations>,
    /// Surfaces of the bounds.
    pub(crate) lower: Option<&'a TriangleMesh>,
    pub(crate) upper: Option<&'a TriangleMesh>,
    /// All contacts, body axes, and the noise of their positions, m.
    pub(crate) contacts: Vec<ContactSample>,
    pub(crate) contact_noise: f64,
    /// Motion at the first sample.
    pub(crate) start: Option<MotionState>,
}

/// The files of the object in the given formats; none without formats.
pub(crate) fn exported(
    made: &Object<'_>,
    formats: &[ExportAs],
    shape: ShapeAs,
) -> Result<Vec<ExportedFile>, CliError> {
    if formats.is_empty() {
        return Ok(Vec::new());
    }
    let format = |format: &ExportAs| match format {
        ExportAs::Mjcf => ExportFormat::Mjcf,
        ExportAs::Urdf => ExportFormat::Urdf,
    };
    let (shape, words) = chosen(made, shape)?;
    let seen = [("inner", made.lower), ("outer", made.upper)];
    let seen = seen.into_iter().filter_map(|(name, mesh)| Some((name.to_owned(), mesh?.clone())));
    let model = ObjectModel {
        name: "object".to_owned(),
        notes: [made.title.to_owned(), made.verdict.to_owned(), words].into(),
        mass: made.mass,
        deviations: made.deviations,
        shape,
        seen: seen.collect(),
        start: made.start,
    };
    Ok(model.files(&formats.iter().map(format).collect::<Vec<_>>())?)
}

/// The shape, and what it is in words.
fn chosen(made: &Object<'_>, shape: ShapeAs) -> Result<(ExportShape, String), CliError> {
    let bound = |name: &'static str| {
        let (mesh, reason) = match name {
            "inner" => (made.lower, "the contacts span no volume"),
            _ => (made.upper, "the contacts leave the object unbounded on some side"),
        };
        let mesh = mesh.cloned().ok_or(ExportError::NoBound { name, reason })?;
        let words = format!("It collides with the {name} bound.");
        Ok((ExportShape::Mesh { name: name.to_owned(), mesh }, words))
    };
    match shape {
        ShapeAs::Inner => bound("inner"),
        ShapeAs::Outer => bound("outer"),
        ShapeAs::Ellipsoid => Ok(ellipsoid(&fit(made)?)),
        ShapeAs::Auto => match fit(made) {
            Ok(fit) if fit.is_good(made.contact_noise) => Ok(ellipsoid(&fit)),
            _ => bound("inner"),
        },
    }
}

/// The likeliest ellipsoid, and how far contacts are from its points with the same normals, root mean square, m.
struct EllipsoidFit {
    body: SkewEllipsoid,
    misfit: f64,
}

impl EllipsoidFit {
    fn is_good(&self, contact_noise: f64) -> bool {
        self.misfit <= ELLIPSOIDAL.0 * self.body.semi_axes().max_element() + ELLIPSOIDAL.1 * contact_noise
    }
}

fn fit(made: &Object<'_>) -> Result<EllipsoidFit, CliError> {
    let step = made.contacts.len().div_ceil(FITTED).max(1);
    let size = made.contacts.iter().map(|c| c.point.length()).fold(f64::MIN_POSITIVE, f64::max);
    // Only the share of points and normals in the noise matters: its size is estimated.
    let noise = ContactNoise::isotropic(size, 1.0);
    let some: Vec<_> =
        made.contacts.iter().step_by(step).map(|c| NoisyContact { contact: *c, noise }).collect();
    let options = FitOptions { noise_level: NoiseLevel::Estimated, ..FitOptions::default() };
    let fit = ShapeFit::nearest(&some, ShapeFamily::Ellipsoid, &options)?;
    let FittedBody::Ellipsoid(body) = fit.body() else {
        // The family that was asked for is the one that is fitted.
        return Err(ExportError::NoBound { name: "ellipsoid", reason: "the fit is no ellipsoid" }.into());
    };
    let off = |c: &NoisyContact| body.jet(c.contact.normal).point.distance_squared(c.contact.point);
    let misfit = (some.iter().map(off).sum::<f64>() / some.len() as f64).sqrt();
    Ok(EllipsoidFit { body: *body, misfit })
}

fn ellipsoid(fit: &EllipsoidFit) -> (ExportShape, String) {
    let words = format!(
        "It collides with the ellipsoid through its contacts, which they miss by {:.1e} m.",
        fit.misfit
    );
    let (centre, orientation, semi_axes) = (fit.body.centre(), fit.body.rotation(), fit.body.semi_axes());
    (ExportShape::Ellipsoid { centre, orientation, semi_axes }, words)
}
