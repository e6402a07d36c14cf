//! Points of a surface as they are seen along a direction, in squares across it.

use super::lines::Line;
use contact_kinematics::Direction;
use glam::DVec3;

/// Points in squares, with the height of each square's highest.
pub(super) struct View {
    along: Direction,
    axes: [DVec3; 2],
    /// Least coordinates across, m, side of a square, m, and squares along both.
    low: [f64; 2],
    side: f64,
    count: [usize; 2],
    squares: Vec<(f64, Vec<u32>)>,
    radius: f64,
    gap: f64,
}

/// Places of a kind to begin from at most, and how far apart they are in gaps.
const STARTS: usize = 8;
const APART: f64 = 3.0;

impl View {
    /// Of points that are `gap` m apart, for balls of `radius` m.
    pub(super) fn of(points: &[DVec3], along: Direction, radius: f64, gap: f64) -> Self {
        let axes: [DVec3; 2] = along.tangent_basis().into();
        let range = axes.map(|e| {
            let of = points.iter().map(|x| x.dot(e));
            of.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| [low.min(c), high.max(c)])
        });
        let side = (0.25 * radius).max(2.0 * gap);
        let count = range.map(|[low, high]| ((high - low) / side) as usize + 1);
        let low = range.map(|[low, _]| low);
        let squares = vec![(f64::NEG_INFINITY, Vec::new()); count[0] * count[1]];
        let mut view = Self { along, axes, low, side, count, squares, radius, gap };
        for (k, x) in (0_u32..).zip(points) {
            let [i, j] = [0, 1].map(|e| view.place(e, x.dot(axes[e])));
            let square = &mut view.squares[i * count[1] + j];
            square.0 = square.0.max(x.dot(along.get()));
            square.1.push(k);
        }
        view
    }

    pub(super) fn along(&self) -> Direction {
        self.along
    }

    /// Number of the square along an axis that a coordinate is in, or the next one there is.
    fn place(&self, axis: usize, coordinate: f64) -> usize {
        // Conversion saturates: what is below all of them is in the first.
        (((coordinate - self.low[axis]) / self.side) as usize).min(self.count[axis] - 1)
    }

    /// Points that a ball coming down the line would touch first or next to first, highest first, and points beside its way that it may touch
    /// since it is known between points by `gap` alone.
    pub(super) fn starts(&self, points: &[DVec3], line: &Line) -> Vec<DVec3> {
        let (q, a) = (self.radius, self.along.get());
        let reach = q + 0.5 * self.gap;
        let span = [0, 1].map(|e| {
            let c = line.at.dot(self.axes[e]);
            [self.place(e, c - reach), self.place(e, c + reach)]
        });
        let (mut ahead, mut beside, mut best) = (Vec::new(), Vec::new(), f64::NEG_INFINITY);
        for i in span[0][0]..=span[0][1] {
            let row = i * self.count[1];
            for (top, square) in &self.squares[row + span[1][0]..=row + span[1][1]] {
                if top + q < best - self.gap {
                    continue;
                }
                for x in square.iter().map(|k| points[*k as usize]) {
                    let (off, high) = (line.off(x).length(), x.dot(a));
                    if off < q {
                        let t = high + (q * q - off * off).sqrt();
                        best = best.max(t);
                        ahead.push((t, x));
                    } else if off < reach {
                        // As high as it could be; nearer ones first among these.
                        beside.push((high - (off - q), x));
                    }
                }
            }
        }
        // Each kind for itself: many that are beside the way and higher are not to hide what is in it.
        let mut starts = Vec::new();
        for mut found in [ahead, beside] {
            found.retain(|(t, _)| *t >= best - self.gap);
            found.sort_by(|a, b| b.0.total_cmp(&a.0));
            starts.extend(self.apart(found));
        }
        starts
    }

    /// The first few that are well apart.
    fn apart(&self, found: Vec<(f64, DVec3)>) -> Vec<DVec3> {
        let mut starts: Vec<DVec3> = Vec::new();
        for (_, x) in found {
            if starts.len() >= STARTS {
                break;
            }
            if starts.iter().all(|s| s.distance(x) > APART * self.gap) {
                starts.push(x);
            }
        }
        starts
    }
}
