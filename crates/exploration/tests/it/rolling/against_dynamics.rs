use contact_kinematics::planar::{Ellipse, PairContact, PalmPair, RadiusFunction};
use exploration::rolling::{Balance, Rest, RollingBody, settle};
use glam::DVec2;
use object_dynamics::planar::{
    ConstantRates, Equilibrium, PlanarEquilibria, PlanarMass, PlanarObject, PlanarStart, simulate_prescribed,
};

/// A body of the dynamics, about its centre of mass, as one that rolls.
struct Centred<S>(S);

impl<S: RadiusFunction> RollingBody for Centred<S> {
    fn farthest(&self, theta: f64) -> DVec2 {
        self.0.point(theta)
    }

    fn centre(&self) -> DVec2 {
        DVec2::ZERO
    }
}

/// An ellipse, 50 by 40 mm, the centre of mass 6 mm off.
fn eccentric() -> Ellipse {
    Ellipse::new(0.05, 0.04, DVec2::new(-0.003, -0.0052)).unwrap()
}

/// Both palms turn by 0.3 rad, short of a fold.
fn pairs(count: u32) -> Vec<PalmPair> {
    let angle = |k: u32| 0.3 + 0.3 * f64::from(k) / f64::from(count);
    (0..=count).map(|k| PalmPair::new(angle(k), 1.4).unwrap()).collect()
}

/// A stable equilibrium that lasts until the last pair.
fn start(shape: Ellipse, palms: &[PalmPair]) -> Equilibrium {
    let equilibria = PlanarEquilibria::new(shape);
    let lasts = |e: &Equilibrium| e.stability > 0.0 && equilibria.follow(palms, e.phi0).is_ok();
    equilibria.all(&palms[0]).into_iter().find(lasts).unwrap()
}

#[test]
fn rests_are_the_equilibria_of_the_dynamics() {
    let (shape, palms) = (eccentric(), pairs(60));
    let stable = start(shape, &palms);
    let path = PlanarEquilibria::new(shape).follow(&palms, stable.phi0).unwrap();
    let mut rest = Rest { phi: stable.phi0 + 0.05, turned: 0.0 };
    for (pair, equilibrium) in palms.iter().zip(&path) {
        rest = settle(&Centred(shape), pair, rest.phi).unwrap();
        assert!((rest.phi - equilibrium.phi0).abs() < 1e-9, "{rest:?} {equilibrium:?}");
        let balance = Balance::at(&Centred(shape), pair, rest.phi);
        let contact = PairContact::new(&shape, pair, rest.phi);
        assert!((balance.p_WCm - contact.p_WCm).length() < 1e-14);
        assert!((0..2).all(|i| (balance.s[i] - contact.s[i]).abs() < 1e-14));
    }
}

/// The slower the palms, the nearer is the motion of the dynamics to the rests: contacts within a share of the body that falls with
/// the speed.
#[test]
fn slow_palms_roll_a_body_along_the_rests() {
    let shape = eccentric();
    let mass = PlanarMass::from_gyration(0.2, 5e-4).unwrap();
    let object = PlanarObject { shape, mass, gravity: 9.81 };
    let start = start(shape, &pairs(60));
    let worst = |rate: f64| {
        let motion = ConstantRates { angles: [0.3, 1.4], rates: [rate, 0.0] };
        let times: Vec<f64> = (0..=40).map(|k| 0.3 / rate * f64::from(k) / 40.0).collect();
        let start = PlanarStart { phi0: start.phi0, omega0: 0.0 };
        let run = simulate_prescribed(&object, &motion, start, &times, 1e-9).unwrap();
        assert!(run.lost.is_none());
        let mut phi = start.phi0;
        let mut worst = 0.0_f64;
        for sample in &run.samples {
            let pair = sample.sample.palms().unwrap();
            phi = settle(&Centred(shape), &pair, phi).unwrap().phi;
            let felt = Balance::at(&Centred(shape), &pair, phi).s;
            for i in 0..2 {
                worst = worst.max((felt[i] - sample.sample.contacts[i].unwrap()).abs() / 0.045);
            }
        }
        worst
    };
    let (slow, slower) = (worst(0.1), worst(0.02));
    // It rocks about the rest with the speed that the palms have taken it by.
    assert!(slow < 0.02 && slower < 0.3 * slow, "{slow} {slower}");
}
