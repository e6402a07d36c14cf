//! What was felt of a body, and what was not.

use super::edges::{Edge, FACING};
use super::lines::{Line, Touch};
use super::probing::{Lattice, Probing};
use crate::contour::Margins;
use glam::{DVec3, IVec3};
use std::collections::HashMap;

/// Two contacts on lines next to each other between which the finger does not get.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// Both, by their places in [`Relief::touches`].
    pub touches: [usize; 2],
    /// How far apart they are, m.
    pub mouth: f64,
    /// Either what is between was not felt, or it is a hollow with a radius of curvature of no more than this, m: the finger's and the resolution.
    pub radius_at_most: f64,
}

/// How probing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReliefEnd {
    /// All lines.
    Done,
    /// All readings that were allowed for are used up.
    Budget,
}

/// A body as it was felt from several directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// First contacts.
    pub touches: Vec<Touch>,
    /// Lines on which the finger passed.
    pub misses: Vec<Line>,
    /// Jumps.
    pub bridges: Vec<Bridge>,
    /// Touches beyond which no direction sees how the surface goes on, by their places.
    pub rims: Vec<usize>,
    /// The smallest mean radius of curvature of a hollow between neighbours that was felt, m; none without hollows.
    pub least_hollow: Option<f64>,
    /// How it ended; where the budget was used up rims are not looked for.
    pub end: ReliefEnd,
    /// Radius of the finger, m.
    pub radius: f64,
    /// The body was said to be within this of the origin, m.
    pub reach: f64,
    /// Lines in all.
    pub readings: usize,
    margins: Margins,
    spacing: f64,
    /// Of each direction the touches of its lattice that face it, and whether it sees the surface all round them.
    patches: Vec<Vec<(usize, bool)>>,
}

/// Centres of neighbouring lines are apart by the spacing over the cosine of 60 degrees: a place between four of them is within `sqrt(2)` spacings of one.
const NEXT: f64 = 1.5;

impl Relief {
    pub(super) fn new(probing: &Probing, radius: f64) -> Self {
        Self {
            touches: Vec::new(),
            misses: Vec::new(),
            bridges: Vec::new(),
            rims: Vec::new(),
            least_hollow: None,
            end: ReliefEnd::Budget,
            radius,
            reach: probing.reach,
            readings: 0,
            margins: probing.margins,
            spacing: probing.spacing,
            patches: Vec::new(),
        }
    }

    /// Whether all of the surface that can be reached from outside was felt: no jump, and what each direction sees goes on in what another one sees.
    #[must_use]
    pub fn is_felt(&self) -> bool {
        self.end == ReliefEnd::Done
            && !self.touches.is_empty()
            && self.bridges.is_empty()
            && self.rims.is_empty()
    }

    /// How far touches may be off.
    #[must_use]
    pub fn margins(&self) -> Margins {
        self.margins
    }

    /// An edge that is as fine as it has to be.
    pub(super) fn judge(&mut self, touches: [usize; 2], edge: &Edge, most: f64, margins: &Margins) {
        let doubt = margins.of_turn();
        if edge.is_jump(most) {
            let bridge = |radius_at_most| Bridge { touches, mouth: edge.mouth, radius_at_most };
            self.bridges.extend(edge.radius_at_most(doubt).map(bridge));
        } else if let Some(radius) = edge.hollow(doubt) {
            self.least_hollow = Some(self.least_hollow.map_or(radius, |least| least.min(radius)));
        }
    }

    /// What a direction sees.
    pub(super) fn patch(&mut self, lattice: &Lattice, judged: &[Vec<[bool; 2]>]) {
        let mut patch = Vec::new();
        for (i, row) in lattice.rows.iter().enumerate() {
            for (j, touch) in row.iter().enumerate().filter_map(|(j, t)| t.map(|t| (j, t))) {
                if self.touches[touch].facing() >= FACING {
                    let before = |i: Option<usize>, j: Option<usize>, k: usize| {
                        i.zip(j).is_some_and(|(i, j)| judged[i][j][k])
                    };
                    let round = judged[i][j] == [true; 2]
                        && before(i.checked_sub(1), Some(j), 0)
                        && before(Some(i), j.checked_sub(1), 1);
                    patch.push((touch, round));
                }
            }
        }
        self.patches.push(patch);
    }

    /// The ends of what each direction sees that are in the midst of what no other one sees, by the place of the finger's centre, which moves on without a jump where
    /// contacts jump.
    pub(super) fn look_for_rims(&mut self) {
        let next = NEXT * self.spacing + 2.0 * self.margins.of_centre(self.radius);
        let cell = |c: DVec3| (c / next).floor().as_ivec3();
        let centre = |k: usize| self.touches[k].centre(self.radius);
        let mut inner: HashMap<IVec3, Vec<usize>> = HashMap::new();
        for (touch, _) in self.patches.iter().flatten().filter(|(_, round)| *round) {
            inner.entry(cell(centre(*touch))).or_default().push(*touch);
        }
        let around = (0..27_i32).map(|k| IVec3::new(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
        let around: Vec<IVec3> = around.collect();
        let goes_on = |rim: usize| {
            let (c, touch) = (centre(rim), &self.touches[rim]);
            let near = around.iter().filter_map(|d| inner.get(&(cell(c) + *d))).flatten();
            near.into_iter().any(|k| {
                let other = &self.touches[*k];
                other.line.along != touch.line.along
                    && other.normal.get().dot(touch.normal.get()) > 0.0
                    && centre(*k).distance(c) <= next
            })
        };
        let rims = self.patches.iter().flatten().filter(|(touch, round)| !round && !goes_on(*touch));
        self.rims = rims.map(|(touch, _)| *touch).collect();
    }
}
