//! A thin ellipse that leans on a floor and a wall: one coordinate, against a quadrature and an independent integration.

use super::*;
use crate::integrate::{FixedScheme, integrate_fixed};
use contact_kinematics::planar::{Ellipse, PairContact, PairRates, PalmPair, PalmPairState};
use std::convert::Infallible;
use std::f64::consts::FRAC_PI_2;

const INERTIA: f64 = 4e-4;

fn ladder(mu: f64) -> ContactScene<Ellipse> {
    // Long axis 0.12 m, thickness 0.01 m; its centre of mass is 5 mm off the middle.
    let shape = Ellipse::new(0.12, 0.01, DVec2::new(0.005, 0.0)).unwrap();
    let floor = line(DVec2::ZERO, 0.0, mu);
    let wall = line(DVec2::ZERO, -FRAC_PI_2, mu);
    scene(shape, INERTIA, vec![floor, wall])
}

/// Leaning at `angle` against the wall: its upper end is on the left.
fn leaning(scene: &ContactScene<Ellipse>, angle: f64) -> ContactStart {
    let guess = BodyState { phi0: -angle, ..at(0.07, 0.09) };
    // The contacts determine the place at this angle: the pair of lines is hinged.
    let contact = PairContact::new(&scene.object().shape, &corner(), guess.phi0);
    let state = BodyState { p_WCm: contact.p_WCm, ..guess };
    ContactStart { body: state, contacts: vec![0, 1] }
}

fn corner() -> PalmPair {
    PalmPair::new(0.0, FRAC_PI_2).unwrap()
}

/// Energy at rest, and kinetic energy per squared rate, at orientation `phi`.
fn energies(scene: &ContactScene<Ellipse>, phi: f64) -> [f64; 2] {
    let object = scene.object();
    let contact = PairContact::new(&object.shape, &corner(), phi);
    let v = contact.velocity(&PalmPairState::at_rest(corner()), 1.0).v_WCm;
    [object.energy(contact.p_WCm, DVec2::ZERO, 0.0), object.energy(DVec2::ZERO, v, 1.0)]
}

/// Time from rest at `from` to `to` by energy: `integral of dphi / omega` with `phi = from +- s^2`, Simpson on 2,000 intervals.
fn time_by_energy(scene: &ContactScene<Ellipse>, from: f64, to: f64) -> f64 {
    let [start, _] = energies(scene, from);
    let (sign, end) = ((to - from).signum(), (to - from).abs().sqrt());
    let integrand = |s: f64| {
        let [rest, kinetic] = energies(scene, from + sign * s * s);
        2.0 * s / ((start - rest) / kinetic).sqrt()
    };
    // Gauss-Legendre with three nodes on each of 2,000 intervals: the ends are not touched.
    let count = 2_000_u32;
    let half = 0.5 * end / f64::from(count);
    let nodes = [(-0.6_f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)];
    let middle = |i: u32| half * f64::from(2 * i + 1);
    (0..count).flat_map(|i| nodes.map(|(x, w)| w * half * integrand(middle(i) + half * x))).sum()
}

#[test]
fn a_frictionless_ladder_follows_its_energy_until_it_leaves_the_wall() {
    let scene = ladder(0.0);
    let start = leaning(&scene, 1.1);
    let run = scene.simulate(&start, &times(0.3, 300), 1e-13).unwrap();
    let event = &run.events[0];
    assert_eq!(event.kind, ContactEventKind::Lifts);
    for s in run.instants.iter().filter(|s| s.t > 0.01 && s.t < event.t).step_by(10) {
        let expected = time_by_energy(&scene, start.body.phi0, s.body.phi0);
        assert!((s.t - expected).abs() < 1e-10, "{} {expected}", s.t);
    }
    // Where the wall's force vanishes, told by the equations of the hinged pair along the energy's curve.
    let [rest, _] = energies(&scene, start.body.phi0);
    let force = |phi: f64| {
        let [here, kinetic] = energies(&scene, phi);
        let palms = PalmPairState { pair: corner(), motion: PairRates::default() };
        scene.object().reaction(&palms, phi, ((rest - here) / kinetic).sqrt()).forces[1]
    };
    let lost =
        crate::integrate::find_root(force, start.body.phi0 + 0.05, start.body.phi0 + 0.9, 1e-15).unwrap();
    let expected = time_by_energy(&scene, start.body.phi0, lost);
    assert!((event.t - expected).abs() < 1e-10, "{} {expected}", event.t);
    // From then on nothing pushes it sideways.
    let off: Vec<_> = run.instants.iter().filter(|s| s.modes[1] == ContactMode::Off).collect();
    assert!(off.len() > 20 && off.iter().all(|s| (s.body.v_WCm.x - off[0].body.v_WCm.x).abs() < 1e-13));
    check_run(&scene, &run);
}

/// The ladder that slides at both ends, from three equations in (omega', f_floor, f_wall), as rates of (phi, omega).
fn sliding_ladder(scene: &ContactScene<Ellipse>, mu: f64, y: &[f64; 2]) -> [f64; 2] {
    let [phi, omega] = *y;
    let contact = PairContact::new(&scene.object().shape, &corner(), phi);
    let [floor, wall] = contact.jets;
    // n_i . a = d_i alpha + (rho_i - r_i) omega^2, n_floor = Y, n_wall = X; the lower end slides out, the upper one down.
    let (k1, k2) = ((floor.rho - floor.r) * omega * omega, (wall.rho - wall.r) * omega * omega);
    // m a_x = f2 - mu f1, m (a_y + g) = f1 + mu f2: solved for the forces at alpha = 0 and per alpha.
    let forces = |ax: f64, ay: f64| {
        let f1 = MASS * (ay - mu * ax) / (1.0 + mu * mu);
        [f1, MASS * ax + mu * f1]
    };
    let (still, per) = (forces(k2, k1 + G), forces(wall.d, floor.d));
    // I alpha = -f1 (d1 + mu r1) - f2 (d2 - mu r2), friction along -X on the floor and +Y on the wall.
    let moment = |f: [f64; 2]| -f[0] * (floor.d + mu * floor.r) - f[1] * (wall.d + mu * wall.r);
    [omega, moment(still) / (INERTIA - moment(per))]
}

#[test]
fn a_ladder_with_friction_agrees_with_an_independent_integration() {
    let mu = 0.15;
    let scene = ladder(mu);
    let start = leaning(&scene, 1.0);
    let end = 0.12;
    let run = scene.simulate(&start, &times(end, 60), 1e-13).unwrap();
    let sliding = |m: &ContactMode| *m == ContactMode::Slide;
    assert!(run.events.is_empty() && run.instants[0].modes.iter().all(sliding), "{:?}", run.events);
    let field = |_: f64, y: &[f64; 2]| Ok::<_, Infallible>(sliding_ladder(&scene, mu, y));
    let y = integrate_fixed(FixedScheme::Rk4, field, 0.0, [start.body.phi0, 0.0], end, 2_000).unwrap();
    let last = run.instants.last().unwrap().body;
    assert!((last.phi0 - y[0]).abs() < 1e-10 && (last.omega0 - y[1]).abs() < 1e-10, "{last:?} {y:?}");
    assert!(run.instants.last().unwrap().friction_work < -1e-3);
    check_run(&scene, &run);
}

#[test]
fn an_instant_gives_the_forces_of_any_modes() {
    let (mu, omega0) = (0.15, 2.0);
    let scene = ladder(mu);
    let start = leaning(&scene, 1.0).body;
    let contact = PairContact::new(&scene.object().shape, &corner(), start.phi0);
    let v_WCm = contact.velocity(&PalmPairState::at_rest(corner()), omega0).v_WCm;
    let body = BodyState { v_WCm, omega0, ..start };
    let now = scene.instant(0.0, &body, &[ContactMode::Slide; 2]).unwrap();
    let [_, alpha0] = sliding_ladder(&scene, mu, &[body.phi0, omega0]);
    assert!((now.alpha0 - alpha0).abs() < 1e-11, "{} {alpha0}", now.alpha0);
    // The wall off: what pushes is the floor alone; it may hold with a force that pulls as well.
    let free = scene.instant(0.0, &body, &[ContactMode::Slide, ContactMode::Off]).unwrap();
    assert!(free.forces[1] == DVec2::ZERO && free.a_WCm.x != now.a_WCm.x);
    assert!(scene.wedging(0.0, &body, &[ContactMode::Slide; 2]).unwrap() > 0.0);
    assert_eq!(scene.wedging(0.0, &body, &[ContactMode::Stick; 2]).unwrap(), f64::INFINITY);
    let found = scene.instant(0.0, &body, &[ContactMode::Off]).unwrap_err();
    assert_eq!(found, ContactInstantError::ModeCount { expected: 2, found: 1 });
}

#[test]
fn a_steep_rough_ladder_stands_and_a_flatter_one_falls() {
    let scene = ladder(0.4);
    for (angle, stands) in [(1.4, true), (0.7, false)] {
        let start = leaning(&scene, angle);
        let run = scene.simulate(&start, &times(10.0, 20), 1e-11).unwrap();
        let last = run.instants.last().unwrap();
        assert_eq!(last.body == run.instants[0].body, stands, "{angle}: {:?}", run.events);
        check_run(&scene, &run);
    }
}
