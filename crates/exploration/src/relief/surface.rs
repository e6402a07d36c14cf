//! Smooth surfaces that are given by an equation.

use contact_kinematics::Direction;
use glam::{DMat3, DVec3};

/// A function at a point: zero on the surface, growing outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Value, m.
    pub value: f64,
    /// Gradient by the point.
    pub gradient: DVec3,
    /// Second derivatives by the point, 1/m.
    pub hessian: DMat3,
}

impl Level {
    /// The outward unit normal; none where the gradient is zero or not finite.
    #[must_use]
    pub fn normal(&self) -> Option<Direction> {
        Direction::new(self.gradient).ok()
    }

    /// Principal curvatures of the level through the point, 1/m, the smaller one first, negative where it is hollow: of `P H P / |g|` in the tangent plane.
    /// None where there is no normal.
    #[must_use]
    pub fn curvatures(&self) -> Option<[f64; 2]> {
        let (e, f) = self.normal()?.tangent_basis();
        let length = self.gradient.length();
        let [a, b, c] = [(e, e), (e, f), (f, f)].map(|(u, v)| u.dot(self.hessian * v) / length);
        let (mean, bend) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
        Some([mean - bend, mean + bend])
    }
}

/// The closed surface of a body, twice differentiable, where a function with a gradient that is not zero there vanishes.
pub trait ImplicitSurface {
    /// The function near the surface, coordinates in m.
    fn at(&self, x: DVec3) -> Level;

    /// Some `count` points on it, spread over all of it.
    fn points(&self, count: usize) -> Vec<DVec3>;
}

/// One wave of [`WavedBody`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Its axis.
    pub axis: Direction,
    /// Its height over the mean radius.
    pub depth: f64,
    /// How many round the axis: `depth cos(waves theta)`, theta the angle from the axis.
    pub waves: u32,
}

/// Seen from its centre at the distance `r(u) = size (1 + sum depth_i cos(waves_i theta_i))` along the unit vector `u`, `theta_i` its angle from the axis `i`:
/// one wave makes a body of revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct WavedBody {
    /// Mean radius, m.
    pub size: f64,
    /// Waves; the sum of their depths is below 1.
    pub waves: Vec<Wave>,
}

impl WavedBody {
    /// Least of the principal radii of curvature over all hollows, m, where the radius is stationary and least along `bottom`: `r^2 / (r'' - r)`, `r''` by the angle
    /// along both principal directions. None where the radius is not bent enough for a hollow there.
    #[must_use]
    pub fn hollow(&self, bottom: Direction) -> Option<f64> {
        let x = bottom.get() * self.radius(bottom.get());
        let least = self.at(x).curvatures()?[0];
        (least < 0.0).then(|| -1.0 / least)
    }

    /// The distance of the surface from the centre along a unit vector, m.
    #[must_use]
    pub fn radius(&self, u: DVec3) -> f64 {
        let wave = |w: &Wave| w.depth * chebyshev(w.waves, w.axis.get().dot(u))[0];
        self.size * (1.0 + self.waves.iter().map(wave).sum::<f64>())
    }

    /// Volume, m^3: a third of the mean cube of the radius over `count` directions, times the area of the unit sphere.
    #[must_use]
    pub fn volume(&self, count: usize) -> f64 {
        let cubes = self.points(count).iter().map(|x| x.length().powi(3)).sum::<f64>();
        4.0 * std::f64::consts::PI / 3.0 * cubes / count.max(1) as f64
    }
}

impl ImplicitSurface for WavedBody {
    /// `|x| - r(x / |x|)`; without a gradient at the centre.
    fn at(&self, x: DVec3) -> Level {
        let far = x.length();
        if far <= f64::MIN_POSITIVE.sqrt() {
            return Level { value: -self.size, gradient: DVec3::ZERO, hessian: DMat3::ZERO };
        }
        let u = x / far;
        let across = (DMat3::IDENTITY - outer(u, u)) * (1.0 / far);
        let (mut value, mut gradient, mut hessian) = (far - self.size, u, across);
        for wave in &self.waves {
            let (d, height) = (wave.axis.get(), self.size * wave.depth);
            let w = d.dot(u);
            let [t, first, second] = chebyshev(wave.waves, w);
            // Of the cosine w of the angle from the axis.
            let g = (d - u * w) / far;
            let bent = (outer(u, g) + outer(g, u)) * (-1.0 / far) - across * (w / far);
            value -= height * t;
            gradient -= g * (height * first);
            hessian -= outer(g, g) * (height * second) + bent * (height * first);
        }
        Level { value, gradient, hessian }
    }

    fn points(&self, count: usize) -> Vec<DVec3> {
        let spread = <Direction as crate::Heading>::spread(count);
        spread.into_iter().map(|u| u.get() * self.radius(u.get())).collect()
    }
}

/// `a b^T`.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// `T_m(w) = cos(m arccos w)` with both derivatives, by their recursions.
fn chebyshev(m: u32, w: f64) -> [f64; 3] {
    let (mut before, mut here) = ([1.0, 0.0, 0.0], [w, 1.0, 0.0]);
    for _ in 0..m {
        let next = [
            2.0 * w * here[0] - before[0],
            2.0 * here[0] + 2.0 * w * here[1] - before[1],
            4.0 * here[1] + 2.0 * w * here[2] - before[2],
        ];
        (before, here) = (here, next);
    }
    before
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Source;

    fn body(source: &mut Source) -> WavedBody {
        let wave = |waves: u32| Wave { axis: source.direction(), depth: source.between(0.05, 0.3), waves };
        WavedBody { size: 1.3, waves: [2, 3].map(wave).to_vec() }
    }

    #[test]
    fn derivatives_are_those_of_the_function() {
        let mut source = Source::new(1);
        for _ in 0..50 {
            let (body, u, h) = (body(&mut source), source.direction().get(), 1e-5);
            let x = u * body.radius(u);
            let here = body.at(x);
            assert!(here.value.abs() < 1e-14);
            for e in [DVec3::X, DVec3::Y, DVec3::Z] {
                let [after, before] = [1.0, -1.0].map(|s| body.at(x + e * (s * h)));
                assert!(((after.value - before.value) / (2.0 * h) - here.gradient.dot(e)).abs() < 1e-8);
                let second = (after.gradient - before.gradient) / (2.0 * h);
                assert!((second - here.hessian * e).length() < 1e-7);
            }
        }
    }

    /// `r^2 / (r'' - r)` in both principal planes of a hollow whose radius is least at the bottom.
    #[test]
    fn radii_of_a_hollow_are_those_of_the_closed_form() {
        let wave = |axis, depth| Wave { axis, depth, waves: 2 };
        let body = WavedBody { size: 1.0, waves: vec![wave(Direction::X, 0.4), wave(Direction::Y, 0.2)] };
        let low = 1.0 - 0.6;
        let bottom = body.at(DVec3::Z * low).curvatures().unwrap();
        for (k, depth) in bottom.into_iter().zip([0.4, 0.2]) {
            assert!((-1.0 / k - low * low / (4.0 * depth - low)).abs() < 1e-12, "{k}");
        }
        assert!((body.hollow(Direction::Z).unwrap() - 0.16 / 1.2).abs() < 1e-12);
        assert_eq!(body.hollow(Direction::X), None);
    }

    #[test]
    fn the_centre_has_no_normal() {
        let body = body(&mut Source::new(2));
        assert_eq!(body.at(DVec3::ZERO).normal(), None);
        assert_eq!(body.at(DVec3::ZERO).curvatures(), None);
    }
}
