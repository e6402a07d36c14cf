//! Oracles: the two hinged palms of the frictionless case, closed forms of a disc, Painleve's rod, the cone of a peg.

use super::*;
use crate::planar::PlanarObject;
use contact_kinematics::planar::{
    BodyPlace, FourierBody, PairRates, PalmPair, PalmPairState, PalmSurface, SurfaceContact, SurfacePose,
    SurfaceState,
};
use std::f64::consts::PI;

const G: f64 = 9.81;

fn slide(sense: f64) -> PlanarMode {
    PlanarMode::Slide { sense }
}

/// A contact of a body at rest on a palm at rest.
fn resting(n: DVec2, b_W: DVec2, mu: f64) -> TouchingContact {
    TouchingContact { n, t: -n.perp(), b_W, biases: [0.0; 2], mu, sense: 0.0 }
}

fn problem(mass: f64, inertia: f64, contacts: &[TouchingContact]) -> ContactProblem {
    ContactProblem::new(PlanarMass::new(mass, inertia).unwrap(), (DVec2::new(0.0, -G), 0.0), contacts)
}

#[test]
fn two_lines_that_the_body_slides_along_are_the_hinged_pair() {
    let shape = FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008]).unwrap();
    let mass = PlanarMass::new(0.3, 2e-4).unwrap();
    let object = PlanarObject { shape: &shape, mass, gravity: G };
    let pair = PalmPair::new(0.3, 1.2).unwrap();
    let motion = PairRates { rates: [0.7, -0.4], accelerations: [3.0, 5.0] };
    let state = PalmPairState { pair, motion };
    for (mu, phi0, omega0) in [(0.0, 0.4, 2.0), (0.2, 0.4, 2.0), (0.2, 2.1, -3.0), (0.5, 4.0, 1.0)] {
        let reaction = match mu {
            0.0 => object.reaction(&state, phi0, omega0),
            // Of contacts that slip at a natural speed, a creep of a billionth of it takes half its square.
            mu => object.rubbing_reaction(&state, phi0, omega0, [mu, 1e-9]).unwrap(),
        };
        let place = BodyPlace { p_WCm: reaction.contact.p_WCm, phi0 };
        let contacts = [0, 1].map(|i| {
            let angle = pair.angles()[i] + if i == 1 { PI } else { 0.0 };
            let pose = SurfacePose::new(DVec2::ZERO, angle).unwrap();
            let (w_WP, alpha_WP) = (motion.rates[i], motion.accelerations[i]);
            let palm = SurfaceState { w_WP, alpha_WP, ..pose.at_rest() };
            let c = SurfaceContact::new(&shape, &place, PalmSurface::Line, &palm, None).unwrap();
            let rates = c.rates(&palm, reaction.v_WCm, omega0).unwrap();
            let biases = [rates.gap_bias, c.t.dot(rates.slip_bias)];
            let sense = c.slip(&palm, reaction.v_WCm, omega0).dot(c.t).signum();
            TouchingContact { n: c.n, t: c.t, b_W: c.b_W, biases, mu, sense }
        });
        let problem = ContactProblem::new(mass, (DVec2::new(0.0, -G), 0.0), &contacts);
        let modes = contacts.map(|contact| slide(if mu > 0.0 { contact.sense } else { 0.0 }));
        let response = problem.respond(&modes).unwrap();
        assert!((response.alpha0 / reaction.alpha0 - 1.0).abs() < 1e-12, "{response:?} {reaction:?}");
        for i in 0..2 {
            assert!((response.forces[i][0] / reaction.forces[i] - 1.0).abs() < 1e-12);
        }
    }
}

/// A body that palms squeeze in a narrow wedge with more friction than that lets out jams: there are no forces, and none are told.
#[test]
fn a_wedge_that_holds_the_body_by_friction_has_no_sliding_motion() {
    let shape = FourierBody::new(&[0.04], &[0.0]).unwrap();
    let object = PlanarObject { shape: &shape, mass: PlanarMass::new(0.3, 2e-4).unwrap(), gravity: G };
    let state = PalmPairState::at_rest(PalmPair::from_absolute(1.4, 1.8).unwrap());
    let closing = PairRates { rates: [1.0, -1.0], ..state.motion };
    let slides = |friction: f64| {
        object
            .rubbing_reaction(&PalmPairState { motion: closing, ..state }, 0.0, 0.0, [friction, 1e-9])
            .is_some()
    };
    // The body is pressed out: friction holds it from the tangent of half the wedge on.
    assert!(slides(0.9 * 0.2_f64.tan()) && !slides(1.1 * 0.2_f64.tan()));
}

#[test]
fn a_disc_on_an_incline_rolls_or_slides() {
    let (slope, radius, mass): (f64, f64, f64) = (0.4, 0.05, 0.3);
    let n = DVec2::new(-slope.sin(), slope.cos());
    for (mu, sticks) in [(0.15, true), (0.13, false)] {
        // A uniform disc sticks up to mu = tan(slope) / 3 = 0.1409.
        let p = problem(mass, 0.5 * mass * radius * radius, &[resting(n, -radius * n, mu)]);
        let choice = p.choose(&[PlanarMode::Stick], &[]).unwrap();
        let down = choice.response.a_WCm.dot(n.perp());
        let (expected, mode) = if sticks {
            (2.0 / 3.0 * G * slope.sin(), PlanarMode::Stick)
        } else {
            (G * (slope.sin() - mu * slope.cos()), slide(-1.0))
        };
        assert_eq!(choice.modes, [mode]);
        assert!((down - expected).abs() < 1e-14, "{down} {expected}");
    }
}

/// A thin rod leaning at `angle` with its lower end sliding left on the ground: Painleve's example.
fn rod(mu: f64, spin: f64, angle: f64) -> ContactProblem {
    let (mass, half): (f64, f64) = (1.0, 0.5);
    let b_W = -half * DVec2::from_angle(angle);
    let mut contact = resting(DVec2::Y, b_W, mu);
    contact.sense = -1.0;
    contact.biases = [-spin * spin * b_W.y, 0.0];
    problem(mass, mass * half * half / 3.0, &[contact])
}

#[test]
fn painleves_rod_is_inconsistent_or_ambiguous() {
    // With b = half (-cos, -sin): m s = 1 + 3 cos^2 - 3 mu sin cos; it is negative from 4/3 on at tan = 2.
    let angle = 2f64.atan();
    let fine = rod(1.3, 0.0, angle);
    let set = [slide(-1.0)];
    let minor = fine.smallest_minor(&set, &fine.respond(&set).unwrap());
    assert!(fine.choose(&set, &[]).is_ok() && minor > 0.0);
    let expected = (1.0 + 3.0 * 0.2 - 3.0 * 1.3 * 0.4) / (1.0 + 3.0 * 0.2);
    assert!((minor - expected).abs() < 1e-15);
    // Beyond it: the free gap closes, and no force can stop it; or it opens, and a force may do worse.
    assert!(matches!(rod(1.4, 0.0, angle).choose(&[slide(-1.0)], &[]), Err(ModeError::Inconsistent)));
    let fast = rod(1.4, 6.0, angle).choose(&[slide(-1.0)], &[]);
    assert!(matches!(fast, Err(ModeError::Ambiguous { .. })), "{fast:?}");
}

#[test]
fn a_pinched_body_squeezes_itself_within_its_cones() {
    // A bar of half length 1 lies level between two walls that lean in: pinched, its weight is carried by friction
    // alone.
    for (mu, holds) in [(0.6, true), (0.5, false)] {
        let lean: f64 = 0.5;
        let left = DVec2::new(lean.cos(), -lean.sin());
        let right = DVec2::new(-left.x, left.y);
        let contacts = [resting(left, -DVec2::X, mu), resting(right, DVec2::X, mu)];
        let p = problem(2.0, 0.7, &contacts);
        let both = [PlanarMode::Stick; 2];
        let response = p.respond(&both).unwrap();
        assert!(response.redundant && response.a_WCm == DVec2::ZERO && response.alpha0 == 0.0);
        // tan(0.5) = 0.5463: below it the walls' normals push the bar out, and no squeeze helps.
        assert_eq!(p.margin(&both, &response) > -1e-12, holds, "{}", p.margin(&both, &response));
        let sum: DVec2 = (0..2)
            .map(|i| contacts[i].n * response.forces[i][0] + contacts[i].t * response.forces[i][1])
            .sum();
        assert!((sum - DVec2::new(0.0, 2.0 * G)).length() < 1e-12);
    }
}

#[test]
fn palms_that_move_apart_tear_sticking_contacts() {
    let mut contacts = [resting(DVec2::X, -DVec2::X, 0.9), resting(-DVec2::X, DVec2::X, 0.9)];
    contacts[1].biases = [1.0, 0.0];
    let p = problem(2.0, 0.7, &contacts);
    let torn = p.respond(&[PlanarMode::Stick; 2]).unwrap();
    assert!((torn.torn - 0.5).abs() < 1e-12 && p.margin(&[PlanarMode::Stick; 2], &torn) < -0.04, "{torn:?}");
    // The pinched normals alone leave their squeeze, and so the friction of a slide, undetermined.
    contacts[1].biases = [0.0; 2];
    let jam = problem(2.0, 0.7, &contacts).respond(&[slide(1.0), slide(-1.0)]);
    assert_eq!(jam, Err(Jammed));
}
