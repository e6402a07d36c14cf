//! Contacts that can be fitted to, and where the fits start.

use super::family::{HarmonicModel, Model};
use super::information::SquareRoot;
use super::refute::coincide;
use super::{FitError, FitOptions, NoiseLevel, ShapeFamily};
use crate::noise::NoisyContact;
use glam::DVec3;
use nalgebra::DVector;

/// What is common to all fits of the same contacts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Data {
    pub(super) size: f64,
    pub(super) centre: DVec3,
    pub(super) noise_level: NoiseLevel,
    pub(super) smallest_radius: f64,
    /// Whether a shape is given up as soon as the contacts refute it.
    pub(super) refusing: bool,
}

impl Data {
    pub(super) fn check(contacts: &[NoisyContact], options: &FitOptions) -> Result<Self, FitError> {
        for (index, contact) in contacts.iter().enumerate() {
            check_contact(index, contact)?;
        }
        let centre = contacts.iter().map(|c| c.contact.point).sum::<DVec3>() / contacts.len().max(1) as f64;
        let size = contacts.iter().map(|c| c.contact.point.distance(centre)).fold(0.0, f64::max);
        let squares = contacts.iter().map(|c| {
            let off = c.contact.point - centre;
            off.dot(c.noise.point.inverse() * off)
        });
        let equations = 3 * contacts.len().saturating_sub(1);
        let one = coincide(options.noise_level, squares.sum(), equations);
        if contacts.len() > 1 && (size == 0.0 || !size.is_finite() || one) {
            return Err(FitError::NoExtent { found: contacts.len() });
        }
        let smallest_radius = options.smallest_radius.unwrap_or(0.01 * size);
        if !(smallest_radius >= 0.0 && smallest_radius.is_finite()) {
            return Err(FitError::Radius(smallest_radius));
        }
        Ok(Self { size, centre, noise_level: options.noise_level, smallest_radius, refusing: true })
    }

    pub(super) fn model(&self, family: ShapeFamily, found: usize) -> Result<Box<dyn Model>, FitError> {
        let needed = family.parameters().div_ceil(3);
        if found < needed.max(2) {
            return Err(FitError::TooFew { family, found, needed: needed.max(2) });
        }
        match (family.model(), family) {
            (Some(model), _) => Ok(model),
            (None, ShapeFamily::Harmonics { degree }) => Err(FitError::Shape(
                HarmonicModel::new(degree).err().unwrap_or(contact_kinematics::ShapeError::Degree {
                    index: 0,
                    degree: u32::try_from(degree).unwrap_or(u32::MAX),
                    limit: 32,
                }),
            )),
            (None, _) => Err(FitError::NoFamily),
        }
    }
}

pub(super) fn check_contact(index: usize, contact: &NoisyContact) -> Result<(), FitError> {
    let point = contact.contact.point;
    if !point.is_finite() {
        return Err(FitError::NotFinite { index, point });
    }
    let noise = &contact.noise;
    if !(noise.normal >= 0.0 && noise.normal.is_finite()) {
        return Err(FitError::Noise { index, name: "normal", value: noise.normal });
    }
    if !noise.pose.is_none() {
        return Err(FitError::PoseNoise { index });
    }
    let matrix = nalgebra::Matrix3::from_fn(|i, j| noise.point.col(j)[i]);
    if matrix.iter().any(|v| !v.is_finite()) || matrix.cholesky().is_none() {
        let value = matrix.diagonal().min();
        return Err(FitError::Noise { index, name: "point", value });
    }
    Ok(())
}

/// The ball nearest to the contacts in unweighted least squares, in the parameters of `model`: where every fit starts.
pub(super) fn ball(model: &dyn Model, contacts: &[NoisyContact], data: &Data) -> DVector<f64> {
    let mut root = SquareRoot::new(4);
    for contact in contacts {
        let (x, n) = (contact.contact.point - data.centre, contact.contact.normal.get());
        for i in 0..3 {
            let axis = DVec3::AXES[i];
            root.insert(&mut [axis.x, axis.y, axis.z, n[i], x[i]]);
        }
    }
    // Where all normals agree, centre and radius cannot be told apart.
    let found = root.solve(0.0).unwrap_or_else(|| DVector::zeros(4));
    // A radius that is not positive, or a ball far away, is no start for the others; the size of the data is.
    let centre = DVec3::new(found[0], found[1], found[2]);
    let near = found[3] > 0.01 * data.size && found[3] < 100.0 * data.size;
    let (centre, radius) = if near { (centre, found[3]) } else { (DVec3::ZERO, data.size) };
    model.ball(data.centre + centre, radius)
}
