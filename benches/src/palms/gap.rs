//! The gap between bounds from exact contacts.

use exploration::Heading;
use recon::contact_kinematics::Direction;
use recon::shape_bounds::palms::{PalmContact, PalmIntersection};
use recon::shape_bounds::{BoundsError, ContactSample, IncrementalBounds};

/// Normals nearer than this to one that was taken are left out, rad: bounds from thousands of contacts would cost more than they tell.
const APART: f64 = 0.04;
/// How well the intersection of balls is told, over its size.
const FACETS: f64 = 2e-3;

/// Contacts that were taken, and their bounds.
#[derive(Default)]
pub struct GapOfContacts {
    taken: Vec<PalmContact>,
    bounds: IncrementalBounds,
}

impl GapOfContacts {
    /// Takes a contact in, unless one with nearly its normal was taken before. `hollow` is the radius of a palm that the body lies inside of,
    /// infinite of others.
    ///
    /// # Errors
    /// [`BoundsError`], for a contact that contradicts those before.
    pub fn touch(&mut self, contact: ContactSample, hollow_radius: f64) -> Result<(), BoundsError> {
        if self.taken.iter().any(|old| old.contact.normal.angle_to(contact.normal) < APART) {
            return Ok(());
        }
        self.bounds.insert(&contact)?;
        self.taken.push(PalmContact { contact, hollow_radius });
        Ok(())
    }

    /// `1 - lower / upper` by volume, the upper bound by half-spaces alone: 1 while it has no end.
    #[must_use]
    pub fn gap(&self) -> f64 {
        let Ok(bounds) = self.bounds.bounds() else { return 1.0 };
        gap(bounds.lower_volume(), bounds.upper_volume())
    }

    /// The same with the balls of hollow palms; none where they give no bound.
    #[must_use]
    pub fn gap_in_balls(&self, size: f64) -> Option<f64> {
        let lower = self.bounds.bounds().ok()?.lower_volume();
        let upper = PalmIntersection::of(&self.taken).ok()?.faceted(FACETS * size).ok()?;
        // Of the two polytopes around its surface the outer one: the bound stays sound.
        Some(gap(lower, upper.upper_volume()))
    }
}

fn gap(lower: f64, upper: f64) -> f64 {
    if upper.is_finite() && upper > 0.0 { 1.0 - lower / upper } else { 1.0 }
}

/// A contact where a body has the normal.
#[must_use]
pub fn contact_at(
    body: &impl recon::contact_kinematics::SupportFunction,
    normal: Direction,
) -> ContactSample {
    ContactSample { point: body.point(normal), normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recon::contact_kinematics::Sphere;

    #[test]
    fn the_gap_of_a_ball_touched_everywhere_tends_to_nothing_and_as_theory_says()
    -> Result<(), Box<dyn std::error::Error>> {
        let ball = Sphere::new(0.04)?;
        let mut gaps = Vec::new();
        for count in [40, 160, 640] {
            let mut known = GapOfContacts::default();
            for u in Direction::spread(count) {
                known.touch(contact_at(&ball, u), f64::INFINITY)?;
            }
            gaps.push(known.gap());
        }
        // The gap falls as one over the number of touches.
        assert!(gaps[2] < 0.03 && gaps[0] < 0.5, "{gaps:?}");
        assert!((gaps[0] / gaps[2] - 16.0).abs() < 4.0, "{gaps:?}");
        Ok(())
    }

    #[test]
    fn nothing_is_bounded_by_a_few_half_spaces_and_hollow_palms_bound_at_once()
    -> Result<(), Box<dyn std::error::Error>> {
        let ball = Sphere::new(0.04)?;
        let [mut flat, mut hollow] = [GapOfContacts::default(), GapOfContacts::default()];
        // Contacts on one half alone.
        for u in Direction::spread(100).into_iter().filter(|u| u.get().z < -0.2) {
            flat.touch(contact_at(&ball, u), f64::INFINITY)?;
            hollow.touch(contact_at(&ball, u), 0.16)?;
        }
        assert_eq!(flat.gap(), 1.0);
        let closed = hollow.gap_in_balls(0.04).ok_or("no bound")?;
        assert!(closed > 0.3 && closed < 0.95, "{closed}");
        Ok(())
    }
}
