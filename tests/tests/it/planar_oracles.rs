//! Planar kinematics and simulation against the 40-digit oracle scenes.

use crate::planar_common::{number, oracle_file, pair, scene, shape, times};
use recon::contact_kinematics::planar::*;
use recon::object_dynamics::planar::*;

/// What the issue of the scenes asks for: relative to the largest value of the quantity over the scene.
const RELATIVE: f64 = 1e-11;
/// Local tolerance of the integrator; global errors stay below a hundred times this over a scene.
const TOLERANCE: f64 = 1e-14;

const PRESCRIBED: [&str; 6] = [
    "S1_tumble_immobile",
    "S2_rotating_pair",
    "S3_rocking_immobile",
    "S4_ellipse_both_palms_move",
    "F3_paper_scale_rotating",
    "N1_nondim_rotating",
];

struct Comparison {
    scene: &'static str,
    worst: f64,
}

impl Comparison {
    /// Compares a series of vectors, scaled by the largest entry of the expected ones.
    fn series(&mut self, what: &str, rows: &[(Vec<f64>, Vec<f64>)]) {
        let scale = rows.iter().flat_map(|(_, e)| e).fold(0.0_f64, |m, v| m.max(v.abs()));
        for (k, (got, expected)) in rows.iter().enumerate() {
            for (g, e) in got.iter().zip(expected) {
                let error = (g - e).abs() / scale;
                assert!(error < RELATIVE, "{} {what} sample {k}: {g} for {e}, {error:.1e}", self.scene);
                self.worst = self.worst.max(error);
            }
        }
    }
}

#[test]
fn kinematics_agree() {
    for name in PRESCRIBED {
        let file = oracle_file();
        let samples = file["scenes"][name]["samples"].as_array().unwrap();
        let (object, motion, _) = scene(name);
        let mut comparison = Comparison { scene: name, worst: 0.0 };
        for (what, pick) in [
            ("r", (|c: &PairContact| c.jets.map(|j| j.r)) as fn(&PairContact) -> [f64; 2]),
            ("d", |c| c.jets.map(|j| j.d)),
            ("rho", |c| c.jets.map(|j| j.rho)),
            ("s", |c| c.s),
            ("cm", |c| c.p_WCm.to_array()),
        ] {
            let rows: Vec<_> = samples
                .iter()
                .map(|s| {
                    let palms = motion.at(number(&s["t"])).unwrap();
                    let contact = PairContact::new(&object.shape, &palms.pair, number(&s["phi0"]));
                    (pick(&contact).to_vec(), pair(&s[what]).to_vec())
                })
                .collect();
            comparison.series(what, &rows);
        }
        println!("{name}: kinematics {:.1e}", comparison.worst);
    }
}

#[test]
fn prescribed_simulation_agrees() {
    for name in PRESCRIBED {
        let file = oracle_file();
        let samples = file["scenes"][name]["samples"].as_array().unwrap();
        let (object, motion, start) = scene(name);
        let times: Vec<f64> = samples.iter().map(|s| number(&s["t"])).collect();
        let run = simulate_prescribed(&object, &motion, start, &times, TOLERANCE).unwrap();
        assert_eq!(run.samples.len(), samples.len(), "{name}: {:?}", run.lost);
        let mut comparison = Comparison { scene: name, worst: 0.0 };
        type Pick = fn(&PlanarRunSample) -> Vec<f64>;
        let picks: [(&str, Pick); 6] = [
            ("phi0", |s| vec![s.truth.phi0]),
            ("omega0", |s| vec![s.truth.omega0]),
            ("alpha0", |s| vec![s.alpha0]),
            ("s", |s| s.sample.contacts.map(Option::unwrap).to_vec()),
            ("cm", |s| s.truth.p_WCm.to_array().to_vec()),
            ("v", |s| s.truth.v_WCm.to_array().to_vec()),
        ];
        for (what, pick) in picks {
            let expected = |s: &serde_json::Value| match s[what].as_array() {
                Some(list) => list.iter().map(number).collect(),
                None => vec![number(&s[what])],
            };
            let rows: Vec<_> = run.samples.iter().zip(samples).map(|(g, e)| (pick(g), expected(e))).collect();
            comparison.series(what, &rows);
        }
        let forces: Vec<_> = run
            .samples
            .iter()
            .zip(samples)
            .map(|(g, e)| {
                let expected = pair(&e["f_over_m"]).map(|f| f * object.mass.mass());
                (g.sample.forces.unwrap().to_vec(), expected.to_vec())
            })
            .collect();
        comparison.series("f", &forces);
        let drift = run.energy_drift();
        assert!(drift < 1e-12, "{name}: energy drift {drift:.1e}");
        println!("{name}: simulation {:.1e}, energy {drift:.1e}", comparison.worst);
    }
}

#[test]
fn torque_driven_simulation_agrees() {
    let file = oracle_file();
    let t1 = &file["scenes"]["T1_torque_driven"];
    let samples = t1["samples"].as_array().unwrap();
    let mass = PlanarMass::new(number(&t1["m"]), number(&t1["I0"])).unwrap();
    let object = PlanarObject { shape: shape(t1), mass, gravity: number(&t1["g"]) };
    let palms = DrivenPalms::new(["I1", "I2"].map(|k| number(&t1[k]))).unwrap();
    let torques = ["tau1", "tau2"].map(|k| number(&t1[k]));
    let start = TorqueStart {
        phi0: number(&t1["phi0"]),
        palm_angles: ["P1_deg", "P2_deg"].map(|k| number(&t1[k]).to_radians()),
        omega0: number(&t1["omega0"]),
        palm_rates: ["W1", "W2"].map(|k| number(&t1[k])),
    };
    let times: Vec<f64> = samples.iter().map(|s| number(&s["t"])).collect();
    let run = simulate_torque_driven(&object, &palms, |_| torques, start, &times, TOLERANCE).unwrap();
    let mut comparison = Comparison { scene: "T1", worst: 0.0 };
    type Pick = fn(&PlanarRunSample) -> Vec<f64>;
    let picks: [(&[&str], Pick); 7] = [
        (&["phi0", "P1", "P2"], |s| {
            let [p1, p2] = s.sample.angles;
            vec![s.truth.phi0, p1, p1 + p2]
        }),
        (&["omega0", "W1", "W2"], |s| vec![s.truth.omega0, s.palm_rates[0], s.palm_rates[1]]),
        (&["s"], |s| s.sample.contacts.map(Option::unwrap).to_vec()),
        (&["cm"], |s| s.truth.p_WCm.to_array().to_vec()),
        (&["v"], |s| s.truth.v_WCm.to_array().to_vec()),
        (&["f"], |s| s.sample.forces.unwrap().to_vec()),
        (&["alpha0"], |s| vec![s.alpha0]),
    ];
    for (keys, pick) in picks {
        let expected = |s: &serde_json::Value| match keys {
            ["alpha0"] => vec![number(&s["alpha"][0])],
            [key] => pair(&s[*key]).to_vec(),
            _ => keys.iter().map(|k| number(&s[*k])).collect(),
        };
        let rows: Vec<_> = run.samples.iter().zip(samples).map(|(g, e)| (pick(g), expected(e))).collect();
        comparison.series(keys[0], &rows);
    }
    assert!(run.energy_drift() < 1e-12, "energy drift {:.1e}", run.energy_drift());
    println!("T1: simulation {:.1e}, energy {:.1e}", comparison.worst, run.energy_drift());
}

/// A spin that throws the object off: the located instant does not depend on the samples, and the force there is zero.
#[test]
fn loss_of_contact_is_located() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let start = PlanarStart { omega0: 14.0, ..start };
    let mut found = Vec::new();
    for rate in [1000.0, 37.0] {
        let run = simulate_prescribed(&object, &motion, start, &times(rate, 2.0), 1e-13).unwrap();
        let lost = run.lost.expect("at 14 rad/s the object leaves a palm");
        assert!(run.samples.iter().all(|s| s.sample.t <= lost.t));
        let at = simulate_prescribed(&object, &motion, start, &[0.0, lost.t * (1.0 - 1e-9)], 1e-13).unwrap();
        let force = at.samples[1].sample.forces.unwrap()[lost.palm];
        // The force falls through zero with a finite slope, some 100 N/s here.
        assert!(force > 0.0 && force < 1e-6, "{force}");
        found.push(lost.t);
    }
    assert!((found[0] - found[1]).abs() < 1e-10, "{found:?}");
    let bad = simulate_prescribed(&object, &motion, start, &[0.0, 1.0, 1.0], 1e-13);
    assert!(matches!(bad, Err(PlanarSimulationError::Times { index: 2, .. })));
}

/// Prescribed and torque-driven dynamics are one: feed the torques that a prescribed motion needs to heavy palms.
#[test]
fn both_dynamics_agree() {
    let (object, _, start) = scene("S2_rotating_pair");
    let motion = HarmonicPalms {
        centres: [0.8, 1.5],
        amplitudes: [0.05, 0.08],
        frequencies: [5.0, 7.0],
        phases: [0.3, 1.0],
    };
    let inertias = [4e-4, 3e-4];
    let palms = DrivenPalms::new(inertias).unwrap();
    let run = simulate_prescribed(&object, &motion, start, &times(50.0, 0.2), 1e-13).unwrap();
    assert!(run.energy_drift() < 1e-12);
    for s in &run.samples {
        let state = motion.at(s.sample.t).unwrap();
        let ([f1, f2], s12) = (s.sample.forces.unwrap(), s.sample.contacts.map(Option::unwrap));
        let a = state.motion.accelerations;
        let torques = [inertias[0] * a[0] + f1 * s12[0], inertias[1] * a[1] - f2 * s12[1]];
        let at = TorqueState::new(&object, state.pair, state.motion.rates, s.truth.phi0, s.truth.omega0);
        let reaction = palms.reaction(&object, &at, torques).unwrap();
        for (got, expected) in reaction.accelerations.iter().zip([s.alpha0, a[0], a[1]]) {
            assert!((got - expected).abs() < 1e-11 * 100.0, "{got} {expected}");
        }
        for (got, expected) in reaction.forces.iter().zip([f1, f2]) {
            assert!((got - expected).abs() < 1e-12, "{got} {expected}");
        }
    }
}
