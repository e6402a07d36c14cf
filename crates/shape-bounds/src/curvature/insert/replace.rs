//! Putting the face of a new ball in the place of the corners that it cuts off.

use super::super::surface::{Corner, NONE};
use super::{Builder, RimEdge};
use glam::DVec3;

/// How far from a sphere a corner may be and still be taken for one on it, relative to what counts as rounding.
const TANGENT: f64 = 2.0;

impl Builder {
    /// Puts the face of ball `p`, with a corner on each edge of the rim, in the place of the lost corners; leaves the ball out
    /// where rounding has broken the rim.
    pub(super) fn replace_lost(&mut self, p: u32) {
        if self.rim.is_empty() {
            return self.replace_all(p);
        }
        if !self.find_fresh_corners(p) {
            self.skipped += 1;
            return;
        }
        for i in 0..self.lost.len() {
            self.surface.corners[self.lost[i] as usize].balls = [NONE; 3];
            self.free.push(self.lost[i]);
        }
        self.made.clear();
        for i in 0..self.rim.len() {
            let RimEdge { beyond, comes_back_from, from, to, .. } = self.rim[i];
            let new = self.add([from, to, p], self.fresh[i]);
            self.made.push(new);
            if comes_back_from.is_none() {
                self.surface.corners[new as usize].neighbours[0] = beyond.0;
                self.surface.corners[beyond.0 as usize].neighbours[beyond.1 as usize] = new;
            }
            if i > 0 {
                self.join(self.made[i - 1], new);
            }
        }
        self.join(self.made[self.made.len() - 1], self.made[0]);
        self.link_kept_middles();
        self.hint = self.made[0];
    }

    /// Corner `b` follows corner `a` around the new face.
    fn join(&mut self, a: u32, b: u32) {
        self.surface.corners[b as usize].neighbours[2] = a;
        self.surface.corners[a as usize].neighbours[1] = b;
    }

    /// Joins the two new corners on each edge that is kept in the middle.
    fn link_kept_middles(&mut self) {
        for i in 0..self.rim.len() {
            let Some(own) = self.rim[i].comes_back_from else { continue };
            let other = self.rim.iter().position(|e| e.comes_back_from.is_some() && e.beyond == own);
            if let Some(other) = other {
                self.surface.corners[self.made[i] as usize].neighbours[0] = self.made[other];
            }
        }
    }

    /// Computes the new corners; false where the rim is not one cycle or a corner does not exist, for rounding.
    fn find_fresh_corners(&mut self, p: u32) -> bool {
        self.fresh.clear();
        for (i, edge) in self.rim.iter().enumerate() {
            let follows = self.rim[(i + 1) % self.rim.len()].from == edge.to;
            let paired = edge.comes_back_from.is_none_or(|own| {
                self.rim.iter().any(|e| e.beyond == own && e.comes_back_from == Some(edge.beyond))
            });
            if !(follows && paired) {
                return false;
            }
            match self.crossing(edge, p) {
                Some(at) => self.fresh.push(at),
                None => return false,
            }
        }
        self.rim.len() > 1
    }

    /// Where ball `p` crosses an edge of the rim. Where its sphere is so nearly tangent to the edge that rounding moves the
    /// common point out of the edge, the end of the edge that is nearer to the sphere takes its place.
    fn crossing(&self, edge: &RimEdge, p: u32) -> Option<DVec3> {
        let surface = &self.surface;
        let [lost, kept] = [edge.lost, edge.beyond.0].map(|c| surface.corners[c as usize].at);
        let at = surface.common_point([edge.from, edge.to, p]);
        if let Some(at) = at
            && surface.is_between(at, lost, kept, [edge.from, edge.to])
        {
            return Some(at);
        }
        let off = |end: DVec3| (end.distance(surface.centre(p)) - surface.radius).abs();
        let end = if off(lost) < off(kept) { lost } else { kept };
        (off(end) <= TANGENT * surface.rounding).then_some(end)
    }

    pub(super) fn add(&mut self, balls: [u32; 3], at: DVec3) -> u32 {
        let corner = Corner { at, balls, neighbours: [NONE; 3], mark: 2 * self.insertions };
        let list = &mut self.surface.corners;
        let slot = match self.free.pop() {
            Some(slot) => {
                list[slot as usize] = corner;
                slot
            }
            None => {
                list.push(corner);
                (list.len() - 1) as u32
            }
        };
        balls.iter().for_each(|b| self.surface.corner_of[*b as usize] = slot);
        slot
    }
}
