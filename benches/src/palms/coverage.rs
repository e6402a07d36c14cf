//! How much of the sphere of normals was touched.

use exploration::Heading;
use recon::contact_kinematics::Direction;

/// A direction counts as seen within this angle of a touched normal, rad.
pub const NEAR: f64 = 0.2;
/// Directions that are asked.
const ASKED: usize = 2000;

/// Share of the sphere within [`NEAR`] of normals that come one after the other.
#[derive(Clone, Debug)]
pub struct Coverage {
    open: Vec<Direction>,
}

impl Default for Coverage {
    fn default() -> Self {
        Self { open: Direction::spread(ASKED) }
    }
}

impl Coverage {
    /// Takes a touched normal in.
    pub fn touch(&mut self, normal: Direction) {
        let near = NEAR.cos();
        self.open.retain(|u| u.get().dot(normal.get()) < near);
    }

    /// The share.
    #[must_use]
    pub fn share(&self) -> f64 {
        1.0 - self.open.len() as f64 / ASKED as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use exploration::Source;

    #[test]
    fn one_touch_covers_a_cap_and_random_ones_what_chance_says() {
        let cap = 0.5 * (1.0 - NEAR.cos());
        let mut one = Coverage::default();
        one.touch(Direction::X);
        assert!((one.share() - cap).abs() < 5e-4, "{} {cap}", one.share());
        // A direction is missed by each of n independent touches: (1 - cap)^n; the mean of ten draws.
        let (touches, mut mean, mut source) = (150, 0.0, Source::new(5));
        for _ in 0..10 {
            let mut some = Coverage::default();
            (0..touches).for_each(|_| some.touch(source.direction()));
            mean += some.share() / 10.0;
        }
        let theory = 1.0 - (1.0 - cap).powi(touches);
        assert!((mean - theory).abs() < 0.01, "{mean} {theory}");
    }

    #[test]
    fn an_even_spread_finer_than_the_angle_covers_all_and_a_half_one_half() {
        let (mut all, mut half) = (Coverage::default(), Coverage::default());
        for u in Direction::spread(1000) {
            all.touch(u);
            if u.get().z < -NEAR.sin() {
                half.touch(u);
            }
        }
        assert_eq!(all.share(), 1.0);
        assert!((half.share() - 0.5).abs() < 0.03, "{}", half.share());
    }
}
