use super::super::equations::Equations;
use super::*;

/// Sums are rounded in another order: what they differ by is a few units of the last place of what is added.
#[test]
fn equations_of_two_halves_are_those_of_the_whole() {
    let noise = noise(4e-4, 0.02);
    let log = noisy(&rubbed(0.06, 1000.0, 0.1), &noise, 3);
    let options = options(noise);
    let mut record = Record::new(&log, &options).unwrap();
    record.set_modes(&modes(&log));
    let mut problem = search::problem(&record, &options, cold::units(&record, G, SIZE));
    let last = record.times.len() - 1;
    for stride in [1, 3] {
        problem.nodes = (0..last).step_by(stride).chain([last]).collect();
        let at = truth(&log, &problem);
        let count = problem.nodes.len();
        let some = |range| problem.linearised::<CONSTANTS>(&at, range).unwrap();
        let whole = some(0..count);
        for half in [1, count / 2, count - 1] {
            let mut joined = some(0..half);
            joined.take_on(&mut some(half..count));
            let told = |of: &Equations<CONSTANTS>| (of.nodes.len(), of.links.len(), of.conditions);
            assert_eq!(told(&joined), told(&whole));
            assert!((joined.cost - whole.cost).abs() < 1e-12 * whole.cost);
            assert!((joined.body - whole.body).norm() < 1e-12 * whole.body.norm());
            for (a, b) in joined.nodes.iter().zip(&whole.nodes) {
                assert!((a.own - b.own).norm() < 1e-12 * b.own.norm());
                assert_eq!(a.next, b.next);
                assert!((a.body - b.body).norm() < 1e-12 * b.body.norm());
                assert!((a.gradient - b.gradient).norm() < 1e-10 * b.gradient.norm());
            }
        }
    }
}
