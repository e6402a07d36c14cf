//! Runs at one corner, on one edge or face are joined, whichever palm touched it and when.

use super::evidence::edge_direction;
use super::found::{Corner, Edge, Face, FeatureKind, FeatureOptions, FeatureRun, Features};
use super::moments::{Sums, Units};
use crate::matrix::outer;
use crate::noise::NoisyContact;
use crate::noise::quantile::{length2, length3};
use contact_kinematics::Direction;
use glam::{DMat3, DVec3};

/// Odds at which two runs at one place are taken for two places.
const APART: f64 = 1e-3;
/// Rounding, as a share of the size.
const ROUNDING: f64 = 1e-9;

/// What a run says of a place.
#[derive(Clone, Debug)]
struct Place {
    run: usize,
    count: f64,
    point: DVec3,
    covariance: DMat3,
    /// Deviation of one contact along a tangent, m.
    single: f64,
    /// Normal of a face, direction of an edge.
    axis: DVec3,
    /// Deviation of that about each axis across it, rad.
    turn: f64,
}

/// Places that are one.
#[derive(Clone, Debug)]
struct Group {
    places: Vec<Place>,
}

/// Joins `runs` of `curves`, and gives open runs the corner or face that they are at.
pub(super) fn joined(
    curves: &[Vec<NoisyContact>],
    mut runs: Vec<FeatureRun>,
    size: f64,
    options: &FeatureOptions,
) -> Features {
    let units = Units::of(curves);
    let place = |run: usize| Place::of(curves, &runs[run], run, &units);
    let groups = |kind: FeatureKind, same: &dyn Fn(&Place, &Place) -> bool| {
        let of_kind = (0..runs.len()).filter(|&run| runs[run].kind == Some(kind));
        grouped(of_kind.map(place).collect(), same)
    };
    let rounding = ROUNDING * size;
    let corners = groups(FeatureKind::Corner, &|a, b| a.is_one_point(b, rounding));
    let edges = groups(FeatureKind::Edge, &|a, b| a.is_one_line(b, rounding));
    let faces = groups(FeatureKind::Face, &|a, b| a.is_one_plane(b, rounding));
    let open: Vec<Place> = (0..runs.len()).filter(|&run| runs[run].kind.is_none()).map(place).collect();
    for list in [&corners, &edges, &faces] {
        for (feature, group) in list.iter().enumerate() {
            for place in &group.places {
                runs[place.run].feature = Some(feature);
            }
        }
    }
    let mut features = Features {
        corners: corners.iter().map(Group::corner).collect(),
        edges: edges.iter().map(|group| group.edge(curves, &runs)).collect(),
        faces: faces.iter().map(Group::face).collect(),
        runs,
    };
    for place in open {
        features.settle(&place, size, options.odds.ln());
    }
    features
}

/// Groups of places of which each is one with the mean of its group.
fn grouped(places: Vec<Place>, same: &dyn Fn(&Place, &Place) -> bool) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for place in places {
        let own = groups.iter_mut().find(|group| same(&group.mean(), &place));
        match own {
            Some(group) => group.places.push(place),
            None => groups.push(Group { places: vec![place] }),
        }
    }
    // Groups that grew towards each other.
    let mut k = 0;
    while k < groups.len() {
        let mean = groups[k].mean();
        match (k + 1..groups.len()).find(|&other| same(&mean, &groups[other].mean())) {
            Some(other) => {
                let more = groups.remove(other);
                groups[k].places.extend(more.places);
            }
            None => k += 1,
        }
    }
    groups
}

impl Place {
    fn of(curves: &[Vec<NoisyContact>], of: &FeatureRun, run: usize, units: &Units) -> Self {
        let contacts = &curves[of.curve][of.first..of.first + of.count];
        let count = contacts.len() as f64;
        let mean = |f: &dyn Fn(&NoisyContact) -> DVec3| contacts.iter().map(f).sum::<DVec3>() / count;
        let sum = |f: &dyn Fn(&NoisyContact) -> DMat3| contacts.iter().map(f).fold(DMat3::ZERO, |a, b| a + b);
        // What poses are off by may be alike in all.
        let own = sum(&|c| c.noise.point) * (1.0 / (count * count));
        let pose = sum(&|c| c.noise.pose.at(c.contact.point)) * (1.0 / count);
        let moments = Sums::new(contacts, units).of(0, contacts.len());
        let normal = mean(&|c| c.contact.normal.get()).normalize_or_zero();
        let (point_variance, normal_variance) = (moments.point_variance, moments.normal_variance);
        let (axis, turn) = if of.kind == Some(FeatureKind::Edge) {
            let axis = edge_direction(&moments).unwrap_or(normal.any_orthonormal_vector());
            let across = axis.cross(normal);
            let told = axis.dot(moments.points * axis) / point_variance
                + across.dot(moments.normals * across) / normal_variance;
            (axis, (1.0 / told.max(f64::MIN_POSITIVE)).max(normal_variance / count).sqrt().min(1.0))
        } else {
            (normal, (normal_variance / count).sqrt())
        };
        let single = point_variance.sqrt() * units.size;
        let point = mean(&|c| c.contact.point);
        Self { run, count, point, covariance: own + pose, single, axis, turn }
    }

    /// Squared deviations by which two places differ along `u`.
    fn apart(&self, other: &Self, u: DVec3, lever: f64, rounding: f64) -> f64 {
        let way = u.dot(self.point - other.point);
        let turned = lever * lever * (self.turn * self.turn + other.turn * other.turn);
        let variance =
            u.dot((self.covariance + other.covariance) * u).max(0.0) + turned + rounding * rounding;
        way * way / variance
    }

    /// Nearer than a contact can tell, or than noise explains.
    fn is_one_point(&self, other: &Self, rounding: f64) -> bool {
        let way = self.point - other.point;
        if way.length() <= self.single.max(other.single) {
            return true;
        }
        let covariance =
            self.covariance + other.covariance + DMat3::from_diagonal(DVec3::splat(rounding * rounding));
        let solved = covariance.inverse() * way;
        solved.is_finite() && way.dot(solved) <= length3(APART).powi(2)
    }

    fn is_parallel(&self, other: &Self, sign: f64) -> bool {
        let square = (self.axis - sign * other.axis).length_squared();
        square <= length2(APART).powi(2) * (self.turn.powi(2) + other.turn.powi(2) + ROUNDING)
    }

    fn is_one_plane(&self, other: &Self, rounding: f64) -> bool {
        let lever = self.point.distance(other.point);
        let n = (self.axis + other.axis).normalize_or_zero();
        self.is_parallel(other, 1.0) && self.apart(other, n, lever, rounding) <= length2(APART).powi(2)
    }

    fn is_one_line(&self, other: &Self, rounding: f64) -> bool {
        let sign = self.axis.dot(other.axis).signum();
        let way = self.point - other.point;
        let off = way.reject_from_normalized(self.axis);
        let u = off.normalize_or_zero();
        let near = off.length() <= self.single.max(other.single);
        self.is_parallel(other, sign)
            && (near || self.apart(other, u, way.length(), rounding) <= length2(APART).powi(2))
    }
}

impl Group {
    fn mean(&self) -> Place {
        let count: f64 = self.places.iter().map(|p| p.count).sum();
        let share = |p: &Place| p.count / count;
        let first = &self.places[0];
        let point = self.places.iter().map(|p| p.point * share(p)).sum::<DVec3>();
        let axis = self.places.iter().map(|p| p.axis * (share(p) * p.axis.dot(first.axis).signum()));
        let covariance =
            self.places.iter().map(|p| p.covariance * share(p).powi(2)).fold(DMat3::ZERO, |a, b| a + b);
        let turn = self.places.iter().map(|p| (p.turn * share(p)).powi(2)).sum::<f64>().sqrt();
        let single = self.places.iter().map(|p| p.single).fold(0.0, f64::max);
        let axis = axis.sum::<DVec3>().normalize_or(first.axis);
        Place {
            run: first.run,
            count,
            point,
            covariance: covariance + self.scatter(point),
            single,
            axis,
            turn,
        }
    }

    /// By how much the places of a group differ beyond what noise explains, m^2.
    fn scatter(&self, mean: DVec3) -> DMat3 {
        let count: f64 = self.places.iter().map(|p| p.count).sum();
        let found = self.places.iter().map(|p| outer(p.point - mean, p.point - mean) * (p.count / count));
        let explained = self.places.iter().map(|p| p.covariance * (p.count / count));
        let (found, explained) =
            (found.fold(DMat3::ZERO, |a, b| a + b), explained.fold(DMat3::ZERO, |a, b| a + b));
        let trace = |m: DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
        if trace(found) > length3(APART).powi(2) * trace(explained) { found } else { DMat3::ZERO }
    }

    fn runs(&self) -> Vec<usize> {
        self.places.iter().map(|p| p.run).collect()
    }

    fn corner(&self) -> Corner {
        let Place { count, point, covariance, .. } = self.mean();
        Corner { point, covariance, contacts: count as usize, runs: self.runs() }
    }

    fn face(&self) -> Face {
        let Place { count, point, covariance, axis, turn, .. } = self.mean();
        let normal = Direction::new_unchecked(axis);
        Face { point, covariance, normal, turn, contacts: count as usize, runs: self.runs() }
    }

    fn edge(&self, curves: &[Vec<NoisyContact>], runs: &[FeatureRun]) -> Edge {
        let Place { count, point, covariance, axis, turn, .. } = self.mean();
        let contacts = self.places.iter().flat_map(|p| {
            let run = &runs[p.run];
            &curves[run.curve][run.first..run.first + run.count]
        });
        let ways = contacts.map(|c| axis.dot(c.contact.point - point));
        let extent = ways.fold([0.0; 2], |[low, high]: [f64; 2], s| [low.min(s), high.max(s)]);
        let direction = Direction::new_unchecked(axis);
        Edge { point, covariance, direction, turn, extent, contacts: count as usize, runs: self.runs() }
    }
}

impl Features {
    /// Gives an open run the corner or face where it is rather than anywhere, at odds of which `needed` is the logarithm.
    fn settle(&mut self, place: &Place, size: f64, needed: f64) {
        let run = &self.runs[place.run];
        let most = run.log_evidence.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let may_be = |kind: usize| run.log_evidence[kind] >= most - needed;
        let floor = DMat3::from_diagonal(DVec3::splat((ROUNDING * size).powi(2)));
        let at_corner = self.corners.iter().map(|c| place.odds_at(c.point, c.covariance + floor, size));
        let on_face = self.faces.iter().map(|f| place.odds_on(f, size));
        let best = |odds: &mut dyn Iterator<Item = f64>| {
            odds.enumerate().fold((0, f64::NEG_INFINITY), |most, now| if now.1 > most.1 { now } else { most })
        };
        let (corner, face) = (best(&mut at_corner.into_iter()), best(&mut on_face.into_iter()));
        let found = if corner.1 >= needed && may_be(1) {
            Some((FeatureKind::Corner, corner.0))
        } else if face.1 >= needed && may_be(3) {
            Some((FeatureKind::Face, face.0))
        } else {
            None
        };
        if let Some((kind, feature)) = found {
            self.runs[place.run].kind = Some(kind);
            self.runs[place.run].feature = Some(feature);
        }
    }
}

impl Place {
    /// Logarithm of the odds for being at a point rather than anywhere in a ball of the size.
    fn odds_at(&self, point: DVec3, covariance: DMat3, size: f64) -> f64 {
        let way = self.point - point;
        let covariance = self.covariance + covariance;
        let solved = covariance.inverse() * way;
        if !solved.is_finite() {
            return f64::NEG_INFINITY;
        }
        let tau = std::f64::consts::TAU;
        let volume = 2.0 / 3.0 * tau * size.powi(3);
        -0.5 * way.dot(solved) - 1.5 * tau.ln() - 0.5 * covariance.determinant().ln() + volume.ln()
    }

    /// Logarithm of the odds for being on a face rather than under any normal, anywhere.
    fn odds_on(&self, face: &Face, size: f64) -> f64 {
        let tau = std::f64::consts::TAU;
        let turn = self.turn.powi(2) + face.turn.powi(2) + ROUNDING * ROUNDING;
        let n = face.normal.get();
        let way = n.dot(self.point - face.point);
        let lever = self.point.distance_squared(face.point);
        let variance = n.dot((self.covariance + face.covariance) * n).max(0.0)
            + turn * lever
            + (ROUNDING * size).powi(2);
        let turned = (self.axis - n).length_squared();
        let of_normal = (2.0 * tau).ln() - (tau * turn).ln() - 0.5 * turned / turn;
        let of_plane = (2.0 * size).ln() - 0.5 * (tau * variance).ln() - 0.5 * way * way / variance;
        of_normal + of_plane
    }
}
