//! Of logs that go on after an estimate was made.

use super::frictionless::normal_only;
use super::*;

/// By how many of the stated deviations two estimates of a log are apart at most.
fn apart(a: &ContactEstimate, b: &ContactEstimate) -> f64 {
    let at = |k: usize| {
        let [p, v, w, _] = b.deviations[k];
        let (a, b) = (&a.states[k], &b.states[k]);
        let numbers = [(a.p_WCm - b.p_WCm) / p, (a.v_WCm - b.v_WCm) / v, (a.w_WO - b.w_WO) / w];
        numbers.into_iter().map(|of| of.abs().max_element()).fold(0.0, f64::max)
    };
    (0..a.states.len()).map(at).fold(0.0, f64::max)
}

/// From wherever it is begun the most probable motion is one: searches stop where a hundredth of chi-squared is left to gain, which is a tenth of a deviation.
#[test]
fn what_is_carried_on_is_what_is_found_from_nothing() {
    for (friction, seed) in [(0.0, 1), (0.1, 2)] {
        let noise = noise(4e-5, 0.004);
        let log = |seconds: f64| {
            let exact = rubbed(seconds, 300.0, friction);
            noisy(&if friction > 0.0 { exact } else { normal_only(&exact) }, &noise, seed)
        };
        let (short, long) = (log(0.5), log(0.8));
        let before = estimate_contacts(&short, None, &options(noise)).unwrap().beginning().unwrap();
        let cold = estimate_contacts(&long, None, &options(noise)).unwrap();
        let carried = estimate_contacts_from(&before, &long, &options(noise)).unwrap();
        assert!(carried.reliability.is_reliable(), "{:?}", carried.reliability);
        assert!(apart(&carried, &cold) < 0.2, "{} deviations", apart(&carried, &cold));
        assert!((carried.mass / cold.mass).ln().abs() < 0.1 * cold.mass_deviation);
        // No more linearisations than from nothing, all windows that are carried on counted.
        assert!(carried.evidence.iterations[1] <= cold.evidence.iterations[1]);
    }
}

/// Nothing is made of a beginning that is another motion.
#[test]
fn what_cannot_be_carried_on_is_lost() {
    let noise = noise(4e-5, 0.004);
    let log = noisy(&rubbed(0.5, 300.0, 0.1), &noise, 3);
    let cold = estimate_contacts(&log, None, &options(noise)).unwrap();
    let off = |state: &BodyState| BodyState { w_WO: -2.0 * state.w_WO, ..*state };
    let other = Beginning::new(cold.states[..80].iter().map(off).collect(), 2.0 * cold.mass, cold.inertia);
    let none = Beginning::new(Vec::new(), cold.mass, cold.inertia);
    let short = rubbed(0.1, 300.0, 0.1);
    let lost = |from: &Beginning, log: &ContactLog| {
        estimate_contacts_from(from, log, &options(noise)).err() == Some(ContactEstimateError::Lost)
    };
    assert!(lost(&none, &log) && lost(&cold.beginning().unwrap(), &short));
    // One that is off may still be a start that leads to the motion.
    let found = estimate_contacts_from(&other, &log, &options(noise));
    assert!(
        found.as_ref().is_err_and(|error| *error == ContactEstimateError::Lost)
            || found.is_ok_and(|found| !found.reliability.is_reliable() || apart(&found, &cold) < 0.2)
    );
}

#[test]
fn what_is_not_relied_on_is_no_beginning() {
    let noise = noise(4e-5, 0.004);
    let short =
        estimate_contacts(&noisy(&rubbed(0.1, 300.0, 0.1), &noise, 3), None, &options(noise)).unwrap();
    assert!(!short.reliability.is_reliable() && short.beginning().is_none());
}
