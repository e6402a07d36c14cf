use super::error::AlphaError;
use exact_hull::TriangleMesh;
use exact_hull::delaunay::{Tetrahedron, tetrahedra};
use glam::DVec3;

/// The alpha shapes of a set of points: unions of those Delaunay tetrahedra whose circumscribed sphere has at most a given
/// radius (Edelsbrunner and Muecke, "Three-dimensional alpha shapes", 1994, without the faces and edges that belong to no
/// tetrahedron).
///
/// An approximation of a body whose surface is sampled densely, and no bound: a hollow wider than the radius is cut out if
/// no sample is in it, a narrower one is filled, and where samples are further apart than the radius there is a hole.
#[derive(Clone, Debug)]
pub struct AlphaShape {
    points: Vec<DVec3>,
    tetrahedra: Vec<Tetrahedron>,
    /// Radius of the circumscribed sphere; infinite outside of the hull.
    radii: Vec<f64>,
}

impl AlphaShape {
    /// The tetrahedra of `points`, for all radii at once.
    ///
    /// # Errors
    /// [`AlphaError::Points`] for points that have no Delaunay tetrahedra.
    pub fn of(points: &[DVec3]) -> Result<Self, AlphaError> {
        let tetrahedra = tetrahedra(points)?;
        // In units of the size, products of extreme coordinates stay in range.
        let size = points.iter().map(|p| p.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
        let unit: Vec<DVec3> = points.iter().map(|p| *p / size).collect();
        let radii = tetrahedra.iter().map(|t| circumradius(t, &unit) * size).collect();
        Ok(Self { points: points.to_vec(), tetrahedra, radii })
    }

    fn corners(&self, t: usize) -> [DVec3; 4] {
        self.tetrahedra[t].corners.map(|c| self.points[c as usize])
    }

    /// Volume in m^3 of the shape of radius `alpha` (m); that of the hull for infinity.
    ///
    /// # Errors
    /// [`AlphaError::Alpha`] unless the radius is above zero.
    pub fn volume(&self, alpha: f64) -> Result<f64, AlphaError> {
        let kept = self.kept(alpha)?;
        let volume = |t: usize| {
            let [a, b, c, d] = self.corners(t);
            (b - a).cross(c - a).dot(d - a) / 6.0
        };
        Ok((0..kept.len()).filter(|t| kept[*t]).map(volume).sum())
    }

    /// Surface of the shape of radius `alpha` (m), facets anticlockwise seen from outside; vertices are the points as given.
    ///
    /// # Errors
    /// [`AlphaError::Alpha`] unless the radius is above zero.
    pub fn mesh(&self, alpha: f64) -> Result<TriangleMesh, AlphaError> {
        let kept = self.kept(alpha)?;
        let mut triangles = Vec::new();
        for (t, own) in self.tetrahedra.iter().enumerate().filter(|(t, _)| kept[*t]) {
            for k in 0..4 {
                if !kept[self.tetrahedra[t].neighbours[k] as usize] {
                    triangles.push(own.face(k));
                }
            }
        }
        Ok(TriangleMesh { vertices: self.points.clone(), triangles })
    }

    /// Whether the point is in the shape of radius `alpha` (m), but for rounding on its surface; in time O(n).
    ///
    /// # Errors
    /// [`AlphaError::Alpha`] unless the radius is above zero.
    pub fn contains(&self, alpha: f64, point: DVec3) -> Result<bool, AlphaError> {
        let kept = self.kept(alpha)?;
        let inside = |t: usize| (0..4).all(|k| self.tetrahedra[t].beyond(&self.points, k, point) <= 0.0);
        Ok((0..kept.len()).any(|t| kept[t] && inside(t)))
    }

    fn kept(&self, alpha: f64) -> Result<Vec<bool>, AlphaError> {
        if alpha.is_nan() || alpha <= 0.0 {
            return Err(AlphaError::Alpha(alpha));
        }
        let keep = |(t, r): (&Tetrahedron, &f64)| !t.is_outside() && *r <= alpha;
        Ok(self.tetrahedra.iter().zip(&self.radii).map(keep).collect())
    }

    /// The smallest radius in m for which the shape is in one piece and every point is a corner of it: what to try first.
    #[must_use]
    pub fn connecting_radius(&self) -> f64 {
        let mut order: Vec<usize> =
            (0..self.radii.len()).filter(|t| !self.tetrahedra[*t].is_outside()).collect();
        order.sort_by(|a, b| self.radii[*a].total_cmp(&self.radii[*b]));
        let mut parent: Vec<usize> = (0..self.radii.len()).collect();
        let mut used = vec![false; self.points.len()];
        let missing = |used: &[bool], tetrahedra: &[Tetrahedron]| {
            let mut corners: Vec<u32> =
                tetrahedra.iter().filter(|t| !t.is_outside()).flat_map(|t| t.corners).collect();
            corners.sort_unstable();
            corners.dedup();
            corners.iter().filter(|c| !used[**c as usize]).count()
        };
        let (mut left, mut pieces) = (missing(&used, &self.tetrahedra), 0_usize);
        let mut taken = vec![false; self.radii.len()];
        for t in order {
            taken[t] = true;
            pieces += 1;
            for k in 0..4 {
                let corner = self.tetrahedra[t].corners[k] as usize;
                left -= usize::from(!used[corner]);
                used[corner] = true;
                let other = self.tetrahedra[t].neighbours[k] as usize;
                if taken[other] {
                    let (a, b) = (root(&mut parent, t), root(&mut parent, other));
                    pieces -= usize::from(a != b);
                    parent[a] = b;
                }
            }
            if left == 0 && pieces == 1 {
                return self.radii[t];
            }
        }
        f64::INFINITY
    }
}

fn root(parent: &mut [usize], mut t: usize) -> usize {
    while parent[t] != t {
        parent[t] = parent[parent[t]];
        t = parent[t];
    }
    t
}

/// About the first corner, `centre = (|b|^2 c x d + |c|^2 d x b + |d|^2 b x c) / (2 b . c x d)`. A sliver whose volume is lost
/// in rounding has an infinite radius.
fn circumradius(t: &Tetrahedron, points: &[DVec3]) -> f64 {
    if t.is_outside() {
        return f64::INFINITY;
    }
    let [a, b, c, d] = t.corners.map(|k| points[k as usize]);
    let (b, c, d) = (b - a, c - a, d - a);
    let six_volumes = b.dot(c.cross(d)).abs();
    let sum =
        c.cross(d) * b.length_squared() + d.cross(b) * c.length_squared() + b.cross(c) * d.length_squared();
    let radius = sum.length() / (2.0 * six_volumes);
    if radius.is_nan() { f64::INFINITY } else { radius }
}
