//! Of noise that lasts from sample to sample.

use super::frictionless::normal_only;
use super::*;

/// The log with the errors of its forces through a filter of first order that leaves their deviation as it is.
fn lasting(exact: &ContactLog, log: &ContactLog, correlation: f64) -> ContactLog {
    let fresh = (1.0 - correlation * correlation).sqrt();
    let force = |log: &ContactLog, i: usize, k: usize| log.palms()[i].force(k).unwrap().vector.length();
    with_records(log, |i, record| {
        let mut held = 0.0;
        let all = (0..log.times().len()).map(|k| {
            let error = force(log, i, k) - force(exact, i, k);
            held = if k == 0 { error } else { correlation * held + fresh * error };
            force(exact, i, k) + held
        });
        PalmRecord { force: ForceChannel::Normal(all.collect()), ..record }
    })
}

/// White noise is alike by chance alone, and nothing is wider for it. Of noise that lasts part is left, is alike, and makes deviations
/// wider.
#[test]
fn noise_that_lasts_makes_deviations_wider() {
    let exact = normal_only(&rubbed(0.4, 500.0, 0.0));
    let noise = noise(4e-6, 0.02);
    let (mut white, mut alike, runs) = (1.0_f64, f64::INFINITY, 3);
    let mut squares = [0.0; 2];
    for seed in 0..runs {
        let log = noisy(&exact, &noise, seed);
        if seed < crate::few_or_all(1, runs) {
            let clean = estimate_contacts(&log, None, &options(noise)).unwrap();
            white = white.max(clean.evidence.lasting);
        }
        let log = lasting(&exact, &log, 0.95);
        let found = estimate_contacts(&log, None, &options(noise)).unwrap();
        let lasts = found.evidence.lasting;
        alike = alike.min(lasts);
        for (squares, share) in squares.iter_mut().zip([1.0, lasts]) {
            *squares += share * errors(&found, &log).0 / (12.0 * runs as f64);
        }
    }
    assert!(white == 1.0 && alike > 2.0, "{white} {alike}");
    // The motion follows part of such noise, of which nothing is left: errors of 18 times what white noise would make are told as 5 times.
    assert!(squares[0] < 0.4 * squares[1], "{squares:?}");
}
