//! Where a body rests between two palms, in closed form from its support function.
//!
//! With the radius function `r` about the centre of mass and `d = -r'`, both contacts hold where `cm = (r_1 u_2 + r_2 u_1) / sin phi_2`, so that
//! the height of the centre of mass is `(r_1 sin P_2 + r_2 sin P_1) / sin phi_2`. Contact directions turn against the body
//! (`theta_i' = -1`), so that the height's slope over the orientation is `(d_1 sin P_2 + d_2 sin P_1) / sin phi_2`: it vanishes at rest, where
//! the lines of force and the weight meet, and grows through zero where the rest is stable. Only points of the body are needed, no
//! curvature: corners and flats are as good as arcs.

use contact_kinematics::planar::PalmPair;
use glam::DVec2;

/// A convex body by its farthest points.
pub trait RollingBody {
    /// The farthest point (m, body axes) along the outward normal at `theta` rad.
    fn farthest(&self, theta: f64) -> DVec2;

    /// Centre of mass in m, body axes.
    fn centre(&self) -> DVec2;
}

/// Both contacts of a body at an orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Slope of the centre of mass's height over the orientation, times `sin phi_2`, in m: zero at rest.
    pub slope: f64,
    /// Directions of the outward normals at the contacts in body axes, rad.
    pub thetas: [f64; 2],
    /// Contacts in body axes, m.
    pub points: [DVec2; 2],
    /// Distances of the contacts from the hinge, m.
    pub s: [f64; 2],
    /// Centre of mass in the world, from the hinge, m.
    pub p_WCm: DVec2,
}

impl Balance {
    /// Of `body` at the orientation `phi` (rad) between `palms`.
    #[must_use]
    pub fn at<B: RollingBody>(body: &B, palms: &PalmPair, phi: f64) -> Self {
        let thetas = palms.contact_directions(phi);
        let points = thetas.map(|theta| body.farthest(theta));
        let part = |i: usize| {
            let (x, (sin, cos)) = (points[i] - body.centre(), thetas[i].sin_cos());
            // r = x . n and d = x . t, with t = (sin, -cos).
            (x.x * cos + x.y * sin, x.x * sin - x.y * cos)
        };
        let ([(r1, d1), (r2, d2)], [sin1, sin2]) = ([part(0), part(1)], palms.angles().map(f64::sin));
        let p_WCm = palms.from_normal_parts(r1, r2);
        let [u1, u2] = palms.along();
        let s = [u1.dot(p_WCm) - d1, u2.dot(p_WCm) + d2];
        Self { slope: d1 * sin2 + d2 * sin1, thetas, points, s, p_WCm }
    }
}

/// A stable rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Orientation in rad, full turns counted.
    pub phi: f64,
    /// How far the body turned to get there, rad.
    pub turned: f64,
}

/// The way downhill is walked in steps of so many rad: two minima closer than that are one.
const STEP: f64 = 0.02;
/// An orientation is known to within this, rad.
const SETTLED: f64 = 1e-11;
/// Where it is predicted on a body that is drawn, this will do.
const ROUGHLY: f64 = 1e-4;
/// Halvings at most: the rule used also halves.
const HALVINGS: usize = 60;
/// A body that turns by more than so many rad while no palm turns by more than [`super::palms::SENSED`] falls.
pub(super) const FALL: f64 = 0.3;

/// Where a body at `phi` (rad) comes to rest, downhill without inertia: on the same branch of minima if palms moved little, and at
/// the foot of the fold where that has ended. None if it is at rest nowhere: no closed convex body does that.
#[must_use]
pub fn settle<B: RollingBody>(body: &B, palms: &PalmPair, phi: f64) -> Option<Rest> {
    settle_within(body, palms, phi, SETTLED)
}

/// The same, as near as predictions need it.
pub(super) fn settle_roughly<B: RollingBody>(body: &B, palms: &PalmPair, phi: f64) -> Option<Rest> {
    settle_within(body, palms, phi, ROUGHLY)
}

fn settle_within<B: RollingBody>(body: &B, palms: &PalmPair, phi: f64, within: f64) -> Option<Rest> {
    let slope = |phi: f64| Balance::at(body, palms, phi).slope;
    let here = slope(phi);
    if here == 0.0 {
        return Some(Rest { phi, turned: 0.0 });
    }
    let down = -here.signum();
    let (mut near, mut at_near) = (phi, here);
    // One turn and a step: minima recur.
    for _ in 0..=(std::f64::consts::TAU / STEP) as usize + 1 {
        let far = near + down * STEP;
        let at_far = slope(far);
        if at_far * here <= 0.0 {
            let root = bracketed(slope, [near, far], [at_near, at_far], within);
            return Some(Rest { phi: root, turned: (root - phi).abs() });
        }
        if at_far.is_nan() {
            return None;
        }
        (near, at_near) = (far, at_far);
    }
    None
}

/// The root between `ends`, where the values `at` have opposite signs: false position with halved values (Illinois).
fn bracketed(f: impl Fn(f64) -> f64, ends: [f64; 2], at: [f64; 2], within: f64) -> f64 {
    let ([mut a, mut b], [mut fa, mut fb]) = (ends, at);
    for round in 0..HALVINGS {
        if fb == 0.0 || (b - a).abs() <= within {
            break;
        }
        // Every third step halves: a corner's slope jumps, and false position alone creeps there.
        let c = if round % 3 == 2 { 0.5 * (a + b) } else { (a * fb - b * fa) / (fb - fa) };
        if (c - b).abs() <= within {
            return c;
        }
        let fc = f(c);
        if fc * fb <= 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    b
}
