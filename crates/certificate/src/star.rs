//! Surfaces that are seen whole from a point within: of each ray from there one triangle decides what is inside.
//!
//! Bounds are such surfaces, and many of their triangles are slivers from one end to the other, whose boxes tell nothing apart. The
//! triangle on the ray through a point is walked to across edges; whether it is that one, and on which side of it the point is, are exact signs.

use super::surface::{Surface, side};
use glam::DVec3;

/// Edges that are passed on the way to a point at most; where the way is longer, another method decides.
const FARTHEST: usize = 10_000;

/// A surface that is seen whole from a point.
pub(crate) struct Star<'a> {
    surface: &'a Surface,
    from: DVec3,
    /// Of each triangle those beyond its edges, from each corner to the next one.
    beside: Vec<[u32; 3]>,
}

impl<'a> Star<'a> {
    /// None unless each edge is passed once forwards and once backwards, every triangle has the point `from` on its inner side, and
    /// `times`, how often the surface goes round that point, is once: every ray from there then leaves through one triangle.
    pub(crate) fn new(surface: &'a Surface, from: DVec3, times: impl FnOnce(DVec3) -> i32) -> Option<Self> {
        let sees = |k: usize| side(surface.at(k), from) < 0.0;
        if !(0..surface.triangles().len()).all(sees) || times(from) != 1 {
            return None;
        }
        let mut beside = vec![[0; 3]; surface.triangles().len()];
        for edge in surface.edges().ok()? {
            let [a, b] = edge.ends;
            let [forwards, backwards] = edge.beside;
            for (own, other, start) in [(forwards, backwards, a), (backwards, forwards, b)] {
                let place = surface.triangles()[own as usize].iter().position(|corner| *corner == start)?;
                beside[own as usize][place] = other;
            }
        }
        Some(Self { surface, from, beside })
    }

    /// Whether a point is inside or on the surface; `at` is any triangle to walk from, and where the walk ended. None where the way is too long.
    pub(crate) fn holds(&self, p: DVec3, at: &mut usize) -> Option<bool> {
        for step in 0..FARTHEST {
            let corners = self.surface.at(*at);
            // Edges in turn: the same order everywhere could lead round in a circle.
            let beyond = [0, 1, 2].map(|i| (i + step) % 3).into_iter().find(|&i| {
                let edge = [self.from, corners[i], corners[(i + 1) % 3]];
                side(edge, p) < 0.0
            });
            let Some(edge) = beyond else { return Some(side(corners, p) <= 0.0) };
            *at = self.beside[*at][edge] as usize;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::inside::Solid;
    use super::*;

    /// As the winding of all triangles has it, of a round body, of one of slivers and of one with dents.
    #[test]
    fn what_is_inside_is_what_the_surface_goes_round() {
        let bodies: [fn(DVec3) -> DVec3; 3] = [
            |n| n + DVec3::new(40.0, -3.0, 7.0),
            |n| n * DVec3::new(3.0, 0.02, 1.0),
            |n| n * (1.0 + 0.3 * (9.0 * n.x).sin() * n.y),
        ];
        for (which, body) in bodies.into_iter().enumerate() {
            let surface = crate::tests::net(11, 24, body);
            let solid = Solid::new(&surface);
            let middle = surface.corners().iter().sum::<DVec3>() / surface.corners().len() as f64;
            let star = Star::new(&surface, middle, |p| solid.winding(p)).unwrap();
            let (mut at, mut inside) = (0, 0);
            for (k, a) in surface.corners().iter().enumerate() {
                let b = surface.corners()[(17 * k + 5) % surface.corners().len()];
                for share in [-0.2, 0.0, 0.3, 0.5, 0.999, 1.001, 3.0] {
                    let p = middle + (*a - middle) * share + (b - *a) * (0.3 * share);
                    let holds = star.holds(p, &mut at).unwrap();
                    assert_eq!(holds, solid.winding(p) == 1, "{which} {p}");
                    inside += usize::from(holds);
                }
            }
            assert!(inside > surface.corners().len());
            // From a point outside it is not seen whole.
            assert!(Star::new(&surface, middle + DVec3::splat(9.0), |p| solid.winding(p)).is_none());
        }
    }

    #[test]
    fn what_is_open_or_goes_round_twice_is_no_star() {
        let surface = crate::tests::net(5, 12, |n| n);
        assert!(Star::new(&surface, DVec3::ZERO, |_| 2).is_none());
        let open = surface.triangles()[1..].to_vec();
        let surface = Surface::new(surface.corners().to_vec(), open).unwrap();
        assert!(Star::new(&surface, DVec3::ZERO, |_| 1).is_none());
    }
}
