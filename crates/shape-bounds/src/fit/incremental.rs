//! A fit that takes one contact at a time.

use super::data::{Data, check_contact};
use super::information::SquareRoot;
use super::levenberg::{ITERATIONS, Problem, iterate};
use super::search::Search;
use super::solve::{Spatial, linearise};
use super::{FitError, FitOptions, ShapeFamily, ShapeFit};
use crate::noise::NoisyContact;
use glam::DVec3;
use nalgebra::DVector;

/// A new linearisation is due when the contacts have grown by this factor ...
const GROWTH: f64 = 1.5;
/// ... or when the estimate has moved from it by this much, relative to the natural sizes of the parameters.
const MOVED: f64 = 0.02;

/// As long as the contacts determine nothing, every one is tried up to so many times the parameters, then every fifth more.
const PATIENCE: usize = 2;
const RETRY: f64 = 1.2;

/// Contacts so far, and the triangle of the equations linearised at one estimate.
///
/// A contact costs O(p^2): its three rows are rotated into the triangle. The weights, the true normals and, for ellipsoid
/// and superquadric, the derivatives are those of an earlier estimate; they are renewed when the contacts have grown by
/// half or the estimate has moved by a fiftieth, which costs O(n p^2) and is paid for by the contacts between.
pub struct IncrementalFit {
    family: ShapeFamily,
    options: FitOptions,
    contacts: Vec<NoisyContact>,
    linear: Option<Linear>,
    /// Contacts when a fit was last tried in vain.
    tried: usize,
}

struct Linear {
    at: DVector<f64>,
    root: SquareRoot,
    contacts: usize,
}

impl IncrementalFit {
    /// A fit from no contacts.
    #[must_use]
    pub fn new(family: ShapeFamily, options: FitOptions) -> Self {
        Self { family, options, contacts: Vec::new(), linear: None, tried: 0 }
    }

    /// Contacts so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Whether there are no contacts yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Takes a contact and returns the estimate, in the family's parameters, or `None` as long as the contacts do not
    /// determine one.
    ///
    /// # Errors
    /// [`FitError`] for a contact that is not finite or whose noise is no covariance; it is then not taken.
    pub fn insert(&mut self, contact: NoisyContact) -> Result<Option<DVector<f64>>, FitError> {
        check_contact(self.contacts.len(), &contact)?;
        self.contacts.push(contact);
        let count = self.contacts.len();
        let few = count <= PATIENCE * self.family.parameters();
        if self.linear.is_none() && !few && (count as f64) < RETRY * self.tried as f64 {
            return Ok(None);
        }
        let due = self.linear.as_ref().is_none_or(|l| count as f64 > GROWTH * l.contacts as f64);
        if due {
            self.tried = count;
            // Contacts that determine nothing yet are no error here; `fit` says what is missing.
            self.linear = self.relinearised().ok();
            return Ok(self.linear.as_ref().map(|l| l.at.clone()));
        }
        let Some((next, far)) = self.updated(&contact) else {
            self.linear = None;
            return Ok(None);
        };
        if far {
            self.linear = self.relinearised().ok();
            return Ok(self.linear.as_ref().map(|l| l.at.clone()));
        }
        Ok(Some(next))
    }

    /// Rotates a contact into the triangle: the new estimate, and whether it is far from where it was linearised.
    fn updated(&mut self, contact: &NoisyContact) -> Option<(DVector<f64>, bool)> {
        let model = self.family.model()?;
        let linear = self.linear.as_mut()?;
        let mut columns = vec![DVec3::ZERO; model.count()];
        let body = model.body(&linear.at)?;
        let own = linearise(
            model.as_ref(),
            &linear.at,
            body.as_ref(),
            contact,
            contact.contact.normal,
            &mut columns,
        )?;
        own.insert(&columns, &mut linear.root, &mut vec![0.0; columns.len() + 1]);
        let step = linear.root.solve(0.0)?;
        let size = extent(&self.contacts);
        let far = step.component_div(&model.scales(size)).amax() > MOVED;
        Some((model.moved(&linear.at, &step), far))
    }

    fn relinearised(&self) -> Result<Linear, FitError> {
        let fit = match &self.linear {
            None => ShapeFit::likeliest(&self.contacts, self.family, &self.options, Search::Nearest)?,
            Some(linear) => {
                let data = Data::check(&self.contacts, &self.options)?;
                let model = data.model(self.family, self.contacts.len())?;
                let problem = Spatial { model: model.as_ref(), contacts: &self.contacts, size: data.size };
                match iterate(&problem, linear.at.clone(), ITERATIONS) {
                    Ok(found) => {
                        return Ok(Linear {
                            at: found.theta,
                            root: found.system.root,
                            contacts: self.contacts.len(),
                        });
                    }
                    Err(_) => {
                        ShapeFit::likeliest(&self.contacts, self.family, &self.options, Search::Nearest)?
                    }
                }
            }
        };
        let open = FitError::NotConverged { family: self.family, iterations: 0 };
        let model = self.family.model().ok_or_else(|| open.clone())?;
        let problem = Spatial { model: model.as_ref(), contacts: &self.contacts, size: 1.0 };
        let system = problem.assemble(&fit.parameters, None).ok_or(open)?;
        Ok(Linear { at: fit.parameters, root: system.root, contacts: self.contacts.len() })
    }

    /// The fit to all contacts so far, at rest, with covariance and statistics; starts from the last estimate.
    ///
    /// # Errors
    /// Those of [`ShapeFit::of`].
    pub fn fit(&self) -> Result<ShapeFit, FitError> {
        let data = Data::check(&self.contacts, &self.options)?;
        let model = data.model(self.family, self.contacts.len())?;
        let start = self.linear.as_ref().and_then(|l| Some(model.moved(&l.at, &l.root.solve(0.0)?)));
        if let Some(start) = start
            && let Ok(found) = iterate(
                &Spatial { model: model.as_ref(), contacts: &self.contacts, size: data.size },
                start,
                ITERATIONS,
            )
        {
            return ShapeFit::finish(model.as_ref(), self.family, &self.contacts, found, &data)?.unrefuted();
        }
        ShapeFit::of(&self.contacts, self.family, &self.options)
    }
}

/// Largest distance of a contact from their mean, in m.
fn extent(contacts: &[NoisyContact]) -> f64 {
    let centre = contacts.iter().map(|c| c.contact.point).sum::<DVec3>() / contacts.len().max(1) as f64;
    contacts.iter().map(|c| c.contact.point.distance(centre)).fold(0.0, f64::max)
}
