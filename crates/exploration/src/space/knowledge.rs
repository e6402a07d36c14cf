//! Bounds of a body in space, touch by touch.

use crate::confidence::Confidence;
use crate::goal::Goal;
use crate::heading::Heading;
use crate::knowledge::{Knowledge, KnowledgeError, Measures};
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::exact_hull::Intersection;
use shape_bounds::noise::{CertainBounds, ContactNoise, NoiseError, NoisyContact, quantile};
use shape_bounds::{BoundsError, ContactSample, IncrementalBounds, ShapeBounds};

/// Standard deviations of every contact, the same along all axes, and the confidence that bounds are to hold at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of a point per axis, in m.
    pub point: f64,
    /// Of a normal about each tangent axis, in rad.
    pub normal: f64,
    /// For all touches that may be made, together.
    pub confidence: Confidence,
}

/// Contacts with a body in space, and the bounds that they prove.
pub struct SpaceKnowledge {
    contacts: Vec<ContactSample>,
    noise: Option<Noise>,
    /// Of each contact, under noise.
    each: Vec<ContactNoise>,
    exact: IncrementalBounds,
    bounds: Option<ShapeBounds>,
}

/// Normals closer than so many of their deviations are those of one place: a touch there repeats another.
const REPEATED: f64 = 4.0;

/// What a new contact is worth under noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prospects<'a> {
    /// How far its half-space is expected to be moved out, in m; zero for exact contacts.
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

impl SpaceKnowledge {
    /// Of no contacts, which are to be exact.
    #[must_use]
    pub fn exact() -> Self {
        let exact = IncrementalBounds::new();
        Self { contacts: Vec::new(), noise: None, each: Vec::new(), exact, bounds: None }
    }

    /// Of exact contacts that agree, bounded once; none of what bounds nothing.
    pub(crate) fn of_exact(contacts: Vec<ContactSample>) -> Option<Self> {
        let bounds = ShapeBounds::from_contacts(&contacts).ok()?;
        Some(Self { contacts, bounds: Some(bounds), ..Self::exact() })
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

    /// The bounds: none while there are fewer than four contacts, or noise leaves nothing certain.
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
        // One list for each contact: means over neighbours in time are of nothing here.
        let one = |(contact, noise): (&ContactSample, &ContactNoise)| {
            vec![NoisyContact { contact: *contact, noise: *noise }]
        };
        let single: Vec<Vec<NoisyContact>> = self.contacts.iter().zip(&self.each).map(one).collect();
        let exact_poses = self.each.iter().all(|noise| noise.pose.is_none());
        let certain = if exact_poses {
            CertainBounds::from_curves_of_poses(&single, confidence, 0.0)
        } else {
            CertainBounds::from_noisy_curves(&single, confidence)
        };
        match certain {
            Ok(certain) => Ok(certain.both()),
            Err(NoiseError::Bounds(BoundsError::TooFew { .. })) => Ok(None),
            Err(reason) => Err(KnowledgeError::Space { touch, reason }),
        }
    }

    /// Takes a contact with noise of its own, and of the pose that it was made in; `noise` counts for nothing where contacts are to be exact.
    ///
    /// # Errors
    /// [`KnowledgeError`] where it contradicts those before; it is not taken then.
    pub fn insert_with(&mut self, contact: ContactSample, noise: ContactNoise) -> Result<(), KnowledgeError> {
        self.contacts.push(contact);
        self.each.push(noise);
        let taken = self.update(&contact);
        if taken.is_err() {
            self.contacts.pop();
            self.each.pop();
            self.start_over();
        }
        taken
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
        let space = |reason: BoundsError| KnowledgeError::Space { touch, reason: reason.into() };
        self.exact.insert(contact).map_err(space)?;
        self.bounds = match self.exact.bounds() {
            Ok(bounds) => Some(bounds),
            Err(BoundsError::TooFew { .. }) => None,
            Err(error) => return Err(space(error)),
        };
        Ok(())
    }
}

/// Where touches are dense, the luckiest of them count: by this many deviations bounds may be closer than margins say.
const LUCK: f64 = 1.0;

/// What one contact is off by at most, with probability `share` of being off by more: `(outwards, inwards)`, as the bounds
/// share it out, without what its normal does.
fn margins(noise: Noise, share: f64) -> (f64, f64) {
    (quantile::normal(share / 4.0) * noise.point, quantile::length3(share / 2.0) * noise.point)
}

impl Knowledge for SpaceKnowledge {
    type Heading = Direction;
    type Contact = ContactSample;
    type Point = DVec3;

    fn insert(&mut self, contact: ContactSample) -> Result<(), KnowledgeError> {
        let [point, normal] = self.noise.map_or([0.0; 2], |noise| [noise.point, noise.normal]);
        self.insert_with(contact, ContactNoise::isotropic(point, normal))
    }

    fn touches(&self) -> usize {
        self.contacts.len()
    }

    fn measures(&self) -> Measures {
        let of = |b: &ShapeBounds| Measures { lower: b.lower_volume(), upper: b.upper_volume() };
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
        self.noise.map(|noise| noise.confidence.level())
    }

    /// The half-spaces are moved out and the facets in by the two margins `m`, `e`, less a deviation for luck. For a gap: by that the bounds lose
    /// `S (m + e)` to first order, where surface over volume is least for a ball, `S / V >= 6 / D` (isoperimetry, and Urysohn's
    /// inequality for the mean width `D`); taken against a ball of diameter `D`, with what is beyond first order on the safe side.
    /// For distances: `m + e` itself, twice that for a width.
    fn noise_floor(&self, goal: &Goal<Direction>, width: f64) -> f64 {
        let Some(noise) = self.noise else { return 0.0 };
        // The least quantiles are those of now; with a budget they never change.
        let Ok(share) = noise.confidence.share(self.contacts.len().max(1)) else { return 0.0 };
        let (out, inwards) = margins(noise, share);
        let [out, inwards] = [out, inwards].map(|m| (m - LUCK * noise.point).max(0.0));
        match goal {
            Goal::Gap(_) => {
                let (lower, upper) = ((1.0 - 2.0 * inwards / width).max(0.0), 1.0 + 2.0 * out / width);
                1.0 - (lower / upper).powi(3)
            }
            Goal::Hausdorff(_) => out + inwards,
            Goal::Width { .. } => 2.0 * (out + inwards),
        }
    }

    /// As the mean over a lattice of directions.
    fn mean_width(&self) -> f64 {
        match self.bounds.as_ref().map(ShapeBounds::upper) {
            Some(Intersection::Bounded(upper)) => {
                let lattice = <Direction as crate::Heading>::spread(WIDTHS);
                2.0 * lattice.iter().map(|n| upper.support(*n)).sum::<f64>() / WIDTHS as f64
            }
            _ => f64::INFINITY,
        }
    }
}

/// Directions over which a width is averaged; pairs of opposite ones nearly, so that the origin is of no account.
const WIDTHS: usize = 200;
