//! Bounds of an outline, touch by touch.

use crate::confidence::Confidence;
use crate::goal::Goal;
use crate::heading::Heading;
use crate::knowledge::{Knowledge, KnowledgeError, Measures};
use glam::DVec2;
use shape_bounds::exact_hull::planar::{Direction, Intersection};
use shape_bounds::noise::quantile;
use shape_bounds::planar::noise::{ContactNoise, NoiseError, NoisyContact};
use shape_bounds::planar::{BoundsError, ContactSample, IncrementalBounds, ShapeBounds};
use std::f64::consts::PI;

/// Standard deviations of every contact, the same along both axes, and the confidence that bounds are to hold at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of a point per axis, in m.
    pub point: f64,
    /// Of a normal, in rad.
    pub normal: f64,
    /// For all touches that may be made, together.
    pub confidence: Confidence,
}

/// Contacts with a body in the plane, and the bounds that they prove.
pub struct PlanarKnowledge {
    contacts: Vec<ContactSample>,
    noise: Option<Noise>,
    /// The level at which the bounds of an estimate are stated to hold; none where they come from touches.
    estimated: Option<f64>,
    exact: IncrementalBounds,
    bounds: Option<ShapeBounds>,
}

/// Normals closer than so many of their deviations are those of one place: a touch there repeats another.
const REPEATED: f64 = 4.0;

/// What a new contact is worth under noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prospects<'a> {
    /// How far its half-plane is expected to be moved out, in m; zero for exact contacts.
    pub(super) out: f64,
    /// How far its point is expected to be moved in, in m.
    pub(super) inwards: f64,
    /// Angle in rad below which two touches are at one place as far as can be told.
    alike: f64,
    contacts: &'a [ContactSample],
}

impl Prospects<'_> {
    /// Share of its score that a touch along `along` can have after all that were made there before: noise of the normals keeps a bound
    /// away from a flat, which looks like room to gain, and the next touch has the same noise.
    pub(super) fn worth(&self, along: Direction) -> f64 {
        if self.alike == 0.0 {
            return 1.0;
        }
        let repeats = self.contacts.iter().filter(|c| c.normal.angle_to(along) < self.alike).count();
        1.0 / ((1 + repeats) as f64).powi(2)
    }
}

impl PlanarKnowledge {
    /// Of no contacts, which are to be exact.
    #[must_use]
    pub fn exact() -> Self {
        let exact = IncrementalBounds::new();
        Self { contacts: Vec::new(), noise: None, estimated: None, exact, bounds: None }
    }

    /// What an estimator knows: contacts in the axes of the body, each with its noise and that of the pose. Bounds hold with probability `level`,
    /// and are stated to hold at `stated` for all looks together.
    ///
    /// # Errors
    /// [`KnowledgeError::Plane`] for noise that is none and contacts that contradict each other beyond it.
    pub fn estimated(curves: &[Vec<NoisyContact>], level: f64, stated: f64) -> Result<Self, KnowledgeError> {
        let contacts: Vec<ContactSample> = curves.iter().flatten().map(|c| c.contact).collect();
        let touch = contacts.len();
        let bounds = sound(curves, level).map_err(|reason| KnowledgeError::Plane { touch, reason })?;
        Ok(Self { contacts, estimated: Some(stated), bounds, ..Self::exact() })
    }

    /// Of no contacts, which are to have this noise, independent from contact to contact.
    #[must_use]
    pub fn noisy(noise: Noise) -> Self {
        Self { noise: Some(noise), ..Self::exact() }
    }

    /// The contacts as measured.
    #[must_use]
    pub fn contacts(&self) -> &[ContactSample] {
        &self.contacts
    }

    /// The bounds: none while there are fewer than three contacts, or noise leaves nothing certain.
    #[must_use]
    pub fn bounds(&self) -> Option<&ShapeBounds> {
        self.bounds.as_ref()
    }

    /// What noise takes of the next touch.
    pub(super) fn prospects(&self) -> Prospects<'_> {
        let share = |n: Noise| n.confidence.share(self.contacts.len() + 1).map(|share| (n, share));
        match self.noise.map(share) {
            Some(Ok((noise, share))) => {
                let (out, inwards) = margins(noise, share);
                Prospects { out, inwards, alike: REPEATED * noise.normal, contacts: &self.contacts }
            }
            _ => Prospects { out: 0.0, inwards: 0.0, alike: 0.0, contacts: &self.contacts },
        }
    }

    fn of_noise(&self, noise: &Noise) -> Result<Option<ShapeBounds>, KnowledgeError> {
        let touch = self.contacts.len();
        let confidence = noise.confidence.of_touches(touch)?;
        let each = ContactNoise::isotropic(noise.point, noise.normal);
        // One list for each contact: means over neighbours in time are of nothing here.
        let single: Vec<Vec<NoisyContact>> =
            self.contacts.iter().map(|c| vec![NoisyContact { contact: *c, noise: each }]).collect();
        sound(&single, confidence).map_err(|reason| KnowledgeError::Plane { touch, reason })
    }

    /// The exact bounds without a contact that was refused after it was taken in: a contradiction may show only then.
    fn start_over(&mut self) {
        self.exact = IncrementalBounds::new();
        for contact in &self.contacts {
            // Each was taken before, and is again.
            if self.exact.insert(contact).is_err() {
                break;
            }
        }
    }

    fn update(&mut self, contact: &ContactSample) -> Result<(), KnowledgeError> {
        let touch = self.contacts.len();
        if let Some(noise) = self.noise {
            self.bounds = self.of_noise(&noise)?;
            return Ok(());
        }
        let plane = |reason: BoundsError| KnowledgeError::Plane { touch, reason: reason.into() };
        self.exact.insert(contact).map_err(plane)?;
        self.bounds = match self.exact.bounds() {
            Ok(bounds) => Some(bounds),
            Err(BoundsError::TooFew { .. }) => None,
            Err(error) => return Err(plane(error)),
        };
        Ok(())
    }
}

/// Bounds at a confidence; none while contacts are too few or noise leaves nothing certain.
fn sound(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<Option<ShapeBounds>, NoiseError> {
    match ShapeBounds::from_noisy_curves(curves, confidence) {
        Ok(bounds) => Ok(Some(bounds)),
        Err(
            NoiseError::NoLowerBound
            | NoiseError::NoUpperBound { .. }
            | NoiseError::Bounds(BoundsError::TooFew { .. }),
        ) => Ok(None),
        Err(reason) => Err(reason),
    }
}

/// Where touches are dense, the luckiest of them count: by this many deviations bounds may be closer than margins say.
const LUCK: f64 = 1.0;

/// What one contact is off by at most, with probability `share` of being off by more: `(outwards, inwards)`, as the bounds
/// share it out, without what its normal does.
fn margins(noise: Noise, share: f64) -> (f64, f64) {
    (quantile::normal(share / 8.0) * noise.point, quantile::length2(share / 4.0) * noise.point)
}

impl Knowledge for PlanarKnowledge {
    type Heading = Direction;
    type Contact = ContactSample;
    type Point = DVec2;

    fn insert(&mut self, contact: ContactSample) -> Result<(), KnowledgeError> {
        if self.estimated.is_some() {
            return Err(KnowledgeError::Estimated);
        }
        self.contacts.push(contact);
        let taken = self.update(&contact);
        if taken.is_err() {
            self.contacts.pop();
            self.start_over();
        }
        taken
    }

    fn touches(&self) -> usize {
        self.contacts.len()
    }

    fn measures(&self) -> Measures {
        let of = |b: &ShapeBounds| Measures { lower: b.lower_area(), upper: b.upper_area() };
        self.bounds.as_ref().map_or(Measures::NOTHING, of)
    }

    fn hausdorff(&self) -> f64 {
        match &self.bounds {
            Some(bounds) if matches!(bounds.upper(), Intersection::Bounded(_)) => {
                bounds.largest_gap().map_or(0.0, |gap| gap.distance)
            }
            _ => f64::INFINITY,
        }
    }

    fn support(&self, along: Direction) -> (f64, f64) {
        self.bounds.as_ref().map_or((f64::NEG_INFINITY, f64::INFINITY), |b| b.support(along))
    }

    fn confidence(&self) -> Option<f64> {
        self.estimated.or(self.noise.map(|noise| noise.confidence.level()))
    }

    /// As in space: the bounds lose what the margins, less a deviation for luck, take of a disc of diameter `width`, for which outline over area is least.
    fn noise_floor(&self, goal: &Goal<Direction>, width: f64) -> f64 {
        let Some(noise) = self.noise else { return 0.0 };
        let Ok(share) = noise.confidence.share(self.contacts.len().max(1)) else { return 0.0 };
        let (out, inwards) = margins(noise, share);
        let [out, inwards] = [out, inwards].map(|m| (m - LUCK * noise.point).max(0.0));
        match goal {
            Goal::Gap(_) => {
                let (lower, upper) = ((1.0 - 2.0 * inwards / width).max(0.0), 1.0 + 2.0 * out / width);
                1.0 - (lower / upper).powi(2)
            }
            Goal::Hausdorff(_) => out + inwards,
            Goal::Width { .. } => 2.0 * (out + inwards),
        }
    }

    /// By Cauchy: the outline's length over pi.
    fn mean_width(&self) -> f64 {
        match self.bounds.as_ref().map(ShapeBounds::upper) {
            Some(Intersection::Bounded(upper)) => upper.shape().perimeter() / PI,
            _ => f64::INFINITY,
        }
    }
}
