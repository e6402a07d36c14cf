//! Bodies in space that are not convex, touched by a round finger on lines: on either side of the radius that gets into their hollows.

use crate::rolling::few_or_all;
use contact_kinematics::Direction;
use exploration::contour::Margins;
use exploration::relief::{
    ImplicitSurface, Level, Line, Probing, ProbingError, ProbingFinger, Relief, ReliefBounds,
    ReliefBoundsError, ReliefEnd, SimulatedFinger, StuckFinger, Touch, Wave, WavedBody, probe,
};
use exploration::{Heading, Source};
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

fn probing(reach: f64, spacing: f64) -> Probing {
    Probing {
        directions: Direction::spread(16),
        reach,
        spacing,
        least: spacing / 256.0,
        turn: 0.2,
        margins: Margins::EXACT,
        readings: 1_000_000,
    }
}

/// A groove once round, and two hollows with different principal radii (0.133 m and 0.4 m), both about axes that no direction of approach is along; with a bottom.
fn bodies() -> [(WavedBody, Direction); 2] {
    let turned = Source::new(5).rotation();
    let axis = |v: DVec3| Direction::new(turned * v).unwrap();
    let wave = |v: DVec3, depth: f64| Wave { axis: axis(v), depth, waves: 2 };
    let groove = WavedBody { size: 1.0, waves: vec![wave(DVec3::Z, 0.35)] };
    let two = WavedBody { size: 1.0, waves: vec![wave(DVec3::X, 0.3), wave(DVec3::Y, 0.2)] };
    [(groove, axis(DVec3::X)), (two, axis(DVec3::Z))]
}

fn felt<S: ImplicitSurface>(surface: S, radius: f64, with: &Probing) -> Relief {
    probe(&mut SimulatedFinger::new(surface, radius).unwrap(), with).unwrap()
}

/// A ring: round the z axis at the distance `far`, of a tube of the radius `tube`.
#[derive(Clone, Copy)]
struct Ring {
    far: f64,
    tube: f64,
}

impl ImplicitSurface for Ring {
    fn at(&self, x: DVec3) -> Level {
        let around = x.with_z(0.0);
        let rho = around.length();
        let e = around / rho;
        let spine = e * self.far;
        let arm = x - spine;
        let s = arm.length();
        let n = arm / s;
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        // The spine's point moves about the axis alone.
        let turn = DVec3::Z.cross(e);
        let moved = outer(turn, turn) * (self.far / rho);
        let hessian = (DMat3::IDENTITY - moved - outer(n, n)) * (1.0 / s);
        Level { value: s - self.tube, gradient: n, hessian }
    }

    fn points(&self, count: usize) -> Vec<DVec3> {
        let side = (count as f64).sqrt() as usize;
        let at = |k: usize| {
            let (t, p) = (TAU * (k % side) as f64 / side as f64, TAU * (k / side) as f64 / side as f64);
            let rho = self.far + self.tube * p.cos();
            DVec3::new(rho * t.cos(), rho * t.sin(), self.tube * p.sin())
        };
        (0..side * side).map(at).collect()
    }
}

/// Balls, apart or not: a finger on a line touches the one that lets its centre least far down, in closed form.
#[derive(Clone, Debug)]
struct Balls {
    radius: f64,
    balls: Vec<(DVec3, f64)>,
}

impl ProbingFinger for Balls {
    type Error = Infallible;

    fn radius(&self) -> f64 {
        self.radius
    }

    fn approach(&mut self, line: &Line) -> Result<Option<Touch>, Infallible> {
        let a = line.along.get();
        let one = |(middle, r): &(DVec3, f64)| {
            let room = (r + self.radius).powi(2) - line.off(*middle).length_squared();
            (room > 0.0).then(|| (middle.dot(a) + room.sqrt(), *middle, *r))
        };
        let first = self.balls.iter().filter_map(one).max_by(|a, b| a.0.total_cmp(&b.0));
        Ok(first.map(|(t, middle, r)| {
            let normal = Direction::new(line.at + a * t - middle).unwrap();
            Touch { line: *line, point: middle + normal.get() * r, normal }
        }))
    }
}

impl Balls {
    fn of(seed: u64, radius: f64) -> Self {
        let mut source = Source::new(seed);
        let count = 1 + (6.0 * source.unit()) as usize;
        let mut ball = |_| (source.direction().get() * source.between(0.0, 0.7), source.between(0.05, 0.3));
        Self { radius, balls: (0..count).map(&mut ball).collect() }
    }

    /// Points of them, on the outside and within.
    fn points(&self, seed: u64) -> Vec<DVec3> {
        let mut source = Source::new(seed);
        let one = |k: usize| {
            let (middle, r) = self.balls[k % self.balls.len()];
            middle + source.direction().get() * (r * if k.is_multiple_of(4) { source.unit() } else { 1.0 })
        };
        (0..400).map(one).collect()
    }

    fn holds(&self, x: DVec3) -> bool {
        self.balls.iter().any(|(middle, r)| middle.distance(x) <= *r)
    }

    /// The volume by points of a lattice, m^3.
    fn volume(&self) -> f64 {
        let side = 50;
        let place = |k: usize| (k as f64 + 0.5) / side as f64 * 2.0 - 1.0;
        let at = |k: usize| DVec3::new(place(k % side), place(k / side % side), place(k / (side * side)));
        let inside = (0..side.pow(3)).filter(|k| self.holds(at(*k))).count();
        inside as f64 * (2.0 / side as f64).powi(3)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Whatever is touched, in pieces and with holes, from few directions and on coarse lattices: no point of it is said to be swept, and its support function and volume are
    /// within their bounds.
    #[test]
    fn bounds_are_sound_for_whatever_is_touched(seed in 0_u64.., count in 1_usize..9, radius in 0.08..1.5) {
        let mut balls = Balls::of(seed, radius);
        let with = Probing { directions: Direction::spread(count), ..probing(1.0, 0.07) };
        let relief = probe(&mut balls, &with).unwrap();
        prop_assert_eq!(relief.end, ReliefEnd::Done);
        let bounds = ReliefBounds::of(&relief, 0.1).unwrap();
        for x in balls.points(seed) {
            prop_assert!(bounds.may_hold(x * (1.0 - 1e-9)), "{}", x);
        }
        for u in Direction::spread(12) {
            let far = |(middle, r): &(DVec3, f64)| middle.dot(u.get()) + r;
            let h = balls.balls.iter().map(far).fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = bounds.support(u);
            prop_assert!(low <= h + 1e-9 && h <= high, "{} {} {}", low, h, high);
        }
        // A lattice of points is off by 2 % of a body this small at most: of a ball of 0.3 m by less than 1 %.
        prop_assert!(bounds.volume_at_most() > 0.98 * balls.volume());
    }

    /// Where the finger stops it touches, and no place of the surface is within it; where it passes none was.
    #[test]
    fn the_first_contact_is_the_first(seed in 0_u64.., which in 0_usize..3, radius in 0.3..2.0) {
        match which {
            2 => first_contacts(&Ring { far: 0.7, tube: 0.25 }, seed, radius)?,
            _ => first_contacts(&bodies()[which].0, seed, radius)?,
        }
    }
}

fn first_contacts<S: ImplicitSurface + Clone>(
    surface: &S,
    seed: u64,
    radius: f64,
) -> Result<(), TestCaseError> {
    let mut source = Source::new(seed);
    let mut finger = SimulatedFinger::new(surface.clone(), radius).unwrap();
    let along = source.direction();
    let (e, f) = along.tangent_basis();
    let (dense, reach) = (surface.points(60_000), 1.2 + radius);
    for _ in 0..20 {
        let line = Line { along, at: e * source.between(-reach, reach) + f * source.between(-reach, reach) };
        let Some(touch) = finger.approach(&line).unwrap() else {
            prop_assert!(dense.iter().all(|x| line.off(*x).length() > radius * (1.0 - 1e-8)));
            continue;
        };
        let centre = touch.centre(radius);
        prop_assert!(line.off(centre).length() < 1e-8, "{}", line.off(centre).length());
        prop_assert!(surface.at(touch.point).value.abs() < 1e-10);
        let ahead = |x: &&DVec3| line.off(**x).length() < radius;
        let high = |x: &DVec3| x.dot(along.get()) + (radius.powi(2) - line.off(*x).length_squared()).sqrt();
        let first = dense.iter().filter(ahead).map(high).fold(f64::NEG_INFINITY, f64::max);
        prop_assert!(centre.dot(along.get()) > first - 1e-9, "{} {}", centre, first);
    }
    Ok(())
}

/// A finger that is smaller than every hollow feels all of the body; what is left of the reach is the body and little more.
#[test]
fn hollows_wider_than_the_finger_are_recovered() {
    for ((body, bottom), share) in bodies().into_iter().zip([0.5, 0.8]).skip(few_or_all(1, 0)) {
        let hollow = body.hollow(bottom).unwrap();
        let relief = felt(body.clone(), share * hollow, &probing(1.6, 0.06));
        assert!(relief.is_felt(), "{} {} {hollow}", relief.bridges.len(), relief.rims.len());
        let least = relief.least_hollow.unwrap();
        assert!((least / hollow - 1.0).abs() < 0.1, "{least} {hollow}");
        let bounds = ReliefBounds::of(&relief, 0.06).unwrap();
        let share = bounds.volume_at_most() / body.volume(50_000);
        assert!(share > 1.0 && share < 1.03, "{share}");
        // The hollow's bottom itself is bounded: a hundredth of the size outside of it is free.
        let x = bottom.get() * body.radius(bottom.get());
        assert!(bounds.may_hold(x) && !bounds.may_hold(x + bottom.get() * 0.015));
    }
}

/// A finger that is larger jumps in each hollow, and the data say that no larger radius is between; the hull is bounded as well as before.
#[test]
fn hollows_narrower_than_the_finger_are_named() {
    for ((body, bottom), share) in bodies().into_iter().zip([1.5, 1.15]).skip(few_or_all(1, 0)) {
        let hollow = body.hollow(bottom).unwrap();
        let radius = share * hollow;
        let relief = felt(body.clone(), radius, &Probing { least: 1e-3, ..probing(1.4, 0.1) });
        assert!(!relief.is_felt());
        let near = |side: f64| {
            relief.bridges.iter().any(|b| {
                let [p, q] = b.touches.map(|k| relief.touches[k].point);
                (0.5 * (p + q)).normalize().dot(bottom.get() * side) > 0.95
            })
        };
        assert!(near(1.0) && near(-1.0), "one on either side");
        for bridge in &relief.bridges {
            let centres = bridge.touches.map(|k| relief.touches[k].centre(radius));
            assert!(centres[0].distance(centres[1]) < 1e-2, "both are touched by one ball");
            assert!(hollow < bridge.radius_at_most && bridge.radius_at_most < radius + 0.02, "{bridge:?}");
        }
        let bounds = ReliefBounds::of(&relief, 0.1).unwrap();
        let dense = body.points(100_000);
        for u in Direction::spread(10) {
            let h = dense.iter().map(|x| x.dot(u.get())).fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = bounds.support(u);
            // The farthest of these points is short of the support function by some 1e-4.
            assert!(low <= h + 2e-4 && h <= high && high - low < 0.02, "{low} {h} {high}");
        }
    }
}

/// The hole of a ring is a hollow once round of the radius `far - tube`: a smaller finger goes through and feels all of it, a larger one jumps across.
#[test]
fn a_ring_is_felt_through_its_hole() {
    let ring = Ring { far: 0.7, tube: 0.25 };
    let inner = ring.at(DVec3::X * 0.45).curvatures().unwrap();
    assert!((inner[0] + 1.0 / 0.45).abs() < 1e-12 && (inner[1] - 4.0).abs() < 1e-12);
    // Down the hole the wall is seen from few directions: of sixteen no two see all of it, and that is told.
    let with = probing(1.0, 0.08);
    if few_or_all(false, true) {
        let few = felt(ring, 0.25, &with);
        assert!(few.bridges.is_empty() && !few.rims.is_empty());
        assert!(few.rims.iter().all(|k| few.touches[*k].point.with_z(0.0).length() < 0.7), "on the inside");
    }
    let through = felt(ring, 0.25, &Probing { directions: Direction::spread(40), ..probing(1.0, 0.06) });
    assert!(through.is_felt(), "{} {}", through.bridges.len(), through.rims.len());
    let bounds = ReliefBounds::of(&through, 0.06).unwrap();
    assert!(!bounds.may_hold(DVec3::ZERO) && !bounds.may_hold(DVec3::X * 0.4));
    let volume = 2.0 * PI * PI * 0.7 * 0.25 * 0.25;
    let share = bounds.volume_at_most() / volume;
    assert!(share > 1.0 && share < 1.05, "{share}");
    // A ball that hardly does not get in sits too steeply for any of sixteen directions: that what is below is not seen is told all the same.
    let over = felt(ring, 0.6, &with);
    assert!(!over.is_felt() && !over.rims.is_empty());
    let over = felt(ring, 0.9, &with);
    assert!(!over.bridges.is_empty() && over.bridges.iter().all(|b| b.radius_at_most > 0.45));
    let bounds = ReliefBounds::of(&over, 0.06).unwrap();
    assert!(bounds.may_hold(DVec3::ZERO) && bounds.volume_at_most() > volume);
}

/// Spacings and cubes halved: what the bounds give away falls with their square.
#[test]
fn bounds_converge_in_the_second_order() {
    let (body, bottom) = bodies()[0].clone();
    let radius = 0.7 * body.hollow(bottom).unwrap();
    let (volume, heights) = (body.volume(200_000), Direction::spread(8));
    let off = |spacing: f64| {
        let relief = felt(body.clone(), radius, &Probing { turn: 1.4, ..probing(1.5, spacing) });
        let bounds = ReliefBounds::of(&relief, spacing).unwrap();
        let widths = heights.iter().map(|u| bounds.support(*u)).map(|(low, high)| high - low);
        [bounds.volume_at_most() / volume - 1.0, widths.sum::<f64>()]
    };
    // Cubes are halves of halves of the reach: both spacings are sides of theirs.
    let (coarse, fine) = (off(3.0 / 32.0), off(3.0 / 64.0));
    for (k, what) in ["volume", "hull"].into_iter().enumerate() {
        let order = (coarse[k] / fine[k]).log2();
        assert!((1.6..2.6).contains(&order), "{what}: {order} {coarse:?} {fine:?}");
    }
}

/// What no direction sees is told: of a ball from above its lower half, of the same from everywhere nothing.
#[test]
fn what_no_direction_sees_is_told() {
    let mut ball = Balls { radius: 0.3, balls: vec![(DVec3::ZERO, 0.8)] };
    let all = probe(&mut ball, &probing(1.0, 0.1)).unwrap();
    assert!(all.is_felt() && all.least_hollow.is_none());
    let above = Direction::spread(16).into_iter().filter(|u| u.get().z > 0.3).collect();
    let some = probe(&mut ball, &Probing { directions: above, ..probing(1.0, 0.1) }).unwrap();
    assert!(!some.is_felt() && some.bridges.is_empty() && !some.rims.is_empty());
    assert!(some.rims.iter().all(|k| some.touches[*k].point.z < 0.1), "where the sight ends");
}

/// With noise the bounds hold at their confidence, jumps are told where they are, and nowhere else.
#[test]
fn bounds_under_noise_are_sound() {
    let noise = [1e-3, 2e-3];
    let readings = 200_000;
    let margins = Margins::of_noise_in_space(noise, 0.95, readings).unwrap();
    let (body, bottom) = bodies()[0].clone();
    let hollow = body.hollow(bottom).unwrap();
    for (seed, share) in [(1, 0.6), (2, 1.4)].into_iter().skip(few_or_all(1, 0)) {
        let finger = SimulatedFinger::new(body.clone(), share * hollow).unwrap();
        let mut finger = finger.with_noise(noise[0], noise[1], seed);
        let relief =
            probe(&mut finger, &Probing { margins, readings, least: 1e-3, ..probing(1.4, 0.1) }).unwrap();
        assert_eq!((relief.end, relief.bridges.is_empty()), (ReliefEnd::Done, share < 1.0));
        assert!(relief.bridges.iter().all(|b| b.radius_at_most > hollow));
        let bounds = ReliefBounds::of(&relief, 0.1).unwrap();
        assert!(bounds.hull().is_none());
        assert!(body.points(3000).into_iter().all(|x| bounds.may_hold(x)));
        for u in Direction::spread(8) {
            let h = body.points(30_000).iter().map(|x| x.dot(u.get())).fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = bounds.support(u);
            assert!(low <= h && h <= high, "{low} {h} {high}");
        }
        // Noise that is not stated is found out: contacts are not where their lines are.
        let mut finger =
            SimulatedFinger::new(body.clone(), share * hollow).unwrap().with_noise(0.01, 0.0, seed);
        let with = Probing { margins: Margins { point: 0.02, normal: 0.0 }, ..probing(1.5, 0.07) };
        assert!(matches!(probe(&mut finger, &with), Err(ProbingError::OffLine { .. })));
    }
}

/// The hull of the contacts has the farthest of them, and less volume than the other bound of a convex body.
#[test]
fn the_hull_is_that_of_the_contacts() {
    let mut ball = Balls { radius: 0.3, balls: vec![(DVec3::ZERO, 0.8)] };
    let bounds = ReliefBounds::of(&probe(&mut ball, &probing(1.0, 0.1)).unwrap(), 0.1).unwrap();
    let (hull, volume) = (bounds.hull().unwrap(), 4.0 * PI / 3.0 * 0.512);
    assert!(hull.volume() < volume && volume < bounds.volume_at_most());
    for u in Direction::spread(10) {
        assert!((hull.support(u) - bounds.support(u).0).abs() < 1e-12);
    }
}

#[test]
fn what_is_no_probing_is_named() {
    let (body, _) = bodies()[0].clone();
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 0.01] {
        assert!(matches!(SimulatedFinger::new(body.clone(), radius).err(), Some(StuckFinger::Radius { .. })));
    }
    let empty = WavedBody { size: f64::NAN, waves: Vec::new() };
    assert_eq!(SimulatedFinger::new(empty, 0.3).err(), Some(StuckFinger::NoSurface));
    let mut ball = Balls { radius: 0.3, balls: vec![(DVec3::X * 0.3, 0.5)] };
    let good = probing(1.0, 0.1);
    for (what, bad) in [
        ("reach", Probing { reach: 0.0, ..good.clone() }),
        ("spacing", Probing { spacing: 0.3, ..good.clone() }),
        ("spacing", Probing { spacing: f64::NAN, ..good.clone() }),
        ("least spacing", Probing { least: 0.2, ..good.clone() }),
        ("turn", Probing { turn: 1.6, ..good.clone() }),
        ("margin of points", Probing { margins: Margins { point: -1.0, normal: 0.0 }, ..good.clone() }),
        ("margin of normals", Probing { margins: Margins { point: 0.0, normal: f64::NAN }, ..good.clone() }),
    ] {
        let Err(ProbingError::Setting { what: named, .. }) = probe(&mut ball, &bad) else { panic!("{what}") };
        assert_eq!(named, what);
    }
    let none = Probing { directions: Vec::new(), ..good.clone() };
    assert_eq!(probe(&mut ball, &none), Err(ProbingError::NoDirections));
    let near = Probing { reach: 0.5, ..good.clone() };
    assert!(matches!(probe(&mut ball, &near), Err(ProbingError::BeyondReach { .. })));
    let few = probe(&mut ball, &Probing { readings: 300, ..good.clone() }).unwrap();
    assert_eq!((few.end, few.readings, few.is_felt()), (ReliefEnd::Budget, 300, false));
    assert!(ReliefBounds::of(&few, 0.1).is_ok(), "what was swept is free all the same");
    let none = probe(&mut ball, &Probing { readings: 0, ..good.clone() }).unwrap();
    assert_eq!(ReliefBounds::of(&none, 0.1).err(), Some(ReliefBoundsError::Untouched));
    for side in [0.0, f64::NAN, 1e-4] {
        assert!(matches!(ReliefBounds::of(&few, side).err(), Some(ReliefBoundsError::Side { .. })));
    }
    // A normal that is turned away puts the centre elsewhere than it came.
    struct Turned(Balls);
    impl ProbingFinger for Turned {
        type Error = Infallible;
        fn radius(&self) -> f64 {
            0.3
        }
        fn approach(&mut self, line: &Line) -> Result<Option<Touch>, Infallible> {
            let touch = self.0.approach(line)?;
            Ok(touch
                .map(|t| Touch { normal: Direction::new(t.normal.get() + DVec3::splat(0.01)).unwrap(), ..t }))
        }
    }
    assert!(matches!(probe(&mut Turned(ball), &good), Err(ProbingError::OffLine { .. })));
}
