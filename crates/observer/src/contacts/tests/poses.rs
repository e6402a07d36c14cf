use super::*;
use nalgebra::{Matrix6, Vector6};

/// Covariances have the squares of the deviations on their diagonals, at nodes and between, and errors of poses are as large as they say: of the six numbers
/// together, which hang together.
#[test]
fn covariances_of_poses_are_those_of_their_errors() {
    let noise = noise(4e-4, 0.02);
    let exact = log(0.4, 1000.0);
    let (mut sum, mut count, mut apart) = (0.0, 0.0, 0.0_f64);
    for seed in 0..6 {
        let log = noisy(&exact, &noise, seed);
        let options = ContactOptions { pose_covariances: true, ..options(noise) };
        let found = estimate_contacts(&log, Some(&modes(&log)), &options).unwrap();
        assert_eq!(found.pose_covariances.len(), log.times().len());
        let truth = log.truth().unwrap();
        for (k, of) in found.pose_covariances.iter().enumerate() {
            let covariance = Matrix6::from(*of);
            let [place, _, _, turn] = found.deviations[k];
            let deviations = Vector6::from_iterator(place.to_array().into_iter().chain(turn.to_array()));
            for i in 0..6 {
                let square = deviations[i] * deviations[i];
                assert!((covariance[(i, i)] - square).abs() <= 1e-9 * square, "{seed} {k} {i}");
            }
            if k == 0 {
                // Its axes are the world's there.
                continue;
            }
            let Some(factor) = covariance.cholesky() else { panic!("{seed} {k}: not positive definite") };
            let since = |at: glam::DQuat, first: glam::DQuat| at * first.conjugate();
            let [by, true_by] =
                [since(found.states[k].R_WO, found.states[0].R_WO), since(truth[k].R_WO, truth[0].R_WO)];
            let turned = crate::rigid::logarithm((by * true_by.conjugate()).normalize());
            let shift = found.states[k].p_WCm - truth[k].p_WCm;
            let error = Vector6::from_iterator(shift.to_array().into_iter().chain(turned.to_array()));
            sum += error.dot(&factor.solve(&error)) / 6.0;
            count += 1.0;
            let beside = covariance.component_div(&(deviations * deviations.transpose()));
            apart = apart.max((beside - Matrix6::from_diagonal(&beside.diagonal())).amax());
        }
    }
    // Six runs of six numbers that hang together along a run: a third of that is the scatter.
    let mean = sum / count;
    assert!((0.4..2.0).contains(&mean), "squared errors are {mean} of what is said");
    assert!(apart > 0.5, "they hang together: {apart}");
}

#[test]
fn covariances_of_poses_are_told_where_they_are_asked_for() {
    let log = noisy(&log(0.2, 500.0), &noise(4e-5, 0.004), 1);
    let found = estimate_contacts(&log, Some(&modes(&log)), &options(noise(4e-5, 0.004))).unwrap();
    assert!(found.pose_covariances.is_empty());
}
