//! What can be said of one surface: closed, turned outwards, convex, how large.

use glam::DVec3;
use robust::{Coord3D, orient3d};
use thiserror::Error;

/// Triangles, corners by number, counter-clockwise from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    corners: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Corners and triangles that are no surface.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// A coordinate is infinite or no number.
    #[error("corner {} is {position}; it must be finite", corner + 1)]
    NotFinite {
        /// The corner, from 0.
        corner: usize,
        /// Where it is said to be, m.
        position: DVec3,
    },
    /// A triangle has a corner that is not there.
    #[error("face {} names a corner that is not among its {corners}", triangle + 1)]
    NoSuchCorner {
        /// The triangle, from 0.
        triangle: usize,
        /// How many corners there are.
        corners: usize,
    },
}

/// Why a surface or an outline is not that of one convex body.
#[derive(Clone, Debug, PartialEq)]
pub enum Flaw {
    /// An edge, by its corners from 0, is not passed once forwards and once backwards.
    Open([u32; 2]),
    /// Another reason, in words that go after "it is not convex:".
    NotConvex(String),
}

/// Volume and area of a closed surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// m^3, negative where the triangles are turned inwards.
    pub volume: f64,
    /// m^2.
    pub area: f64,
    /// What rounding may make of the volume, m^3: of a needle or a sheet the products that it is a sum of are far larger than it.
    pub rounding: f64,
}

/// A pair of triangles at an edge.
pub(crate) struct Edge {
    pub(crate) ends: [u32; 2],
    /// The triangle that passes the edge forwards and the one that passes it backwards.
    pub(crate) beside: [u32; 2],
}

/// Positive where `p` is on the outer side of the triangle; the sign is exact.
pub(crate) fn side([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let of = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    -orient3d(of(a), of(b), of(c), of(p))
}

impl Surface {
    /// Takes corners (m) and triangles (numbers of corners from 0).
    ///
    /// # Errors
    /// A coordinate that is not finite, or a triangle whose corner is not there.
    pub fn new(corners: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, SurfaceError> {
        if let Some(corner) = corners.iter().position(|corner| !corner.is_finite()) {
            return Err(SurfaceError::NotFinite { corner, position: corners[corner] });
        }
        let there = |corner: &u32| (*corner as usize) < corners.len();
        match triangles.iter().position(|t| !t.iter().all(there)) {
            Some(triangle) => Err(SurfaceError::NoSuchCorner { triangle, corners: corners.len() }),
            None => Ok(Self { corners, triangles }),
        }
    }

    /// The corners, m.
    #[must_use]
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The triangles, by the numbers of their corners.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle.
    pub(crate) fn at(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|corner| self.corners[corner as usize])
    }

    /// Distance of the farthest corner from the origin, m: what rounding of coordinates is measured by.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.corners.iter().map(|corner| corner.length()).fold(0.0, f64::max)
    }

    /// An edge, by its corners, that is not passed as often forwards as backwards; none on a closed surface.
    #[must_use]
    pub fn open_edge(&self) -> Option<[u32; 2]> {
        let passes = self.passes();
        passes.chunk_by(|a, b| a.0 == b.0).find_map(|edge| {
            let forwards = edge.iter().filter(|pass| pass.1).count();
            (2 * forwards != edge.len()).then_some(edge[0].0)
        })
    }

    /// Each edge by the numbers of its ends, with the direction in which a triangle passes it and the triangle.
    fn passes(&self) -> Vec<([u32; 2], bool, u32)> {
        let of = |(k, t): (u32, &[u32; 3])| {
            let [a, b, c] = *t;
            [(a, b), (b, c), (c, a)].map(|(from, to)| {
                let ends = if from < to { [from, to] } else { [to, from] };
                (ends, from < to, k)
            })
        };
        let all = || (0..).zip(&self.triangles).flat_map(of);
        // Those of a corner side by side, by counting, then by the other end: six on the average.
        let mut starts = vec![0; self.corners.len() + 1];
        all().for_each(|pass| starts[pass.0[0] as usize + 1] += 1);
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut passes = vec![([0; 2], false, 0); 3 * self.triangles.len()];
        for pass in all() {
            let place = &mut next[pass.0[0] as usize];
            passes[*place] = pass;
            *place += 1;
        }
        starts.windows(2).for_each(|ends| passes[ends[0]..ends[1]].sort_unstable());
        passes
    }

    /// Edges of a surface on which each edge belongs to two triangles; the first that does not.
    pub(crate) fn edges(&self) -> Result<Vec<Edge>, [u32; 2]> {
        let passes = self.passes();
        let pair = |edge: &[([u32; 2], bool, u32)]| match edge {
            [back, forth] if forth.1 && !back.1 => Ok(Edge { ends: back.0, beside: [forth.2, back.2] }),
            _ => Err(edge[0].0),
        };
        passes.chunk_by(|a, b| a.0 == b.0).map(pair).collect()
    }

    /// Signed volume and area, the volume about a corner of the surface.
    #[must_use]
    pub fn size(&self) -> Size {
        let about = self.corners.first().copied().unwrap_or_default();
        let mut size = Size { volume: 0.0, area: 0.0, rounding: 0.0 };
        for triangle in 0..self.triangles.len() {
            let [a, b, c] = self.at(triangle).map(|corner| corner - about);
            size.volume += a.dot(b.cross(c)) / 6.0;
            size.area += (b - a).cross(c - a).length() / 2.0;
        }
        // Of sums about any point of it.
        let extent = self.corners.iter().map(|corner| corner.distance(about)).fold(0.0, f64::max);
        size.rounding = self.triangles.len() as f64 * f64::EPSILON * extent.powi(3);
        size
    }

    /// Why this is not the surface of one convex body but for dents of depth `tolerance` (m).
    ///
    /// Each edge is in two triangles, corners, edges and faces are numbered as on a sphere (Euler), and no edge is
    /// dented: by the exact sign, or by less than `tolerance` as the smallest height of the four corners beside it.
    #[must_use]
    pub fn not_convex(&self, tolerance: f64) -> Option<Flaw> {
        let edges = match self.edges() {
            Err(edge) => return Some(Flaw::Open(edge)),
            Ok(edges) => edges,
        };
        let mut used = vec![false; self.corners.len()];
        self.triangles.iter().flatten().for_each(|&corner| used[corner as usize] = true);
        let corners = used.iter().filter(|used| **used).count();
        if corners + self.triangles.len() != edges.len() + 2 {
            return Some(Flaw::NotConvex("its faces are not joined as those of one body".to_owned()));
        }
        let worst = edges.iter().map(|edge| (self.dent(edge), edge.ends)).max_by(|a, b| a.0.total_cmp(&b.0));
        worst.filter(|(depth, _)| *depth > tolerance).map(|(depth, [a, b])| {
            Flaw::NotConvex(format!(
                "it is dented by {depth:.1e} m at the edge of corners {} and {}",
                a + 1,
                b + 1
            ))
        })
    }

    /// How deep the dent at an edge is; 0 where there is none.
    fn dent(&self, edge: &Edge) -> f64 {
        let [a, b] = edge.ends.map(|corner| self.corners[corner as usize]);
        let third =
            |t: u32| self.triangles[t as usize].into_iter().find(|corner| !edge.ends.contains(corner));
        // A triangle that has no third corner is a line, and dents nothing.
        let [Some(c), Some(d)] = edge.beside.map(third) else { return 0.0 };
        let [c, d] = [c, d].map(|corner| self.corners[corner as usize]);
        // Exact to its last digits, too: the product of differences is nothing but rounding where the four are nearly on a line.
        let volume = side([a, b, c], d);
        if volume <= 0.0 {
            return 0.0;
        }
        // A sliver has no plane to measure from: the face of the four corners with the largest area has one.
        let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).length();
        let largest = area(a, b, c).max(area(a, b, d)).max(area(a, c, d)).max(area(b, c, d));
        if largest > 0.0 { volume / largest } else { 0.0 }
    }
}
