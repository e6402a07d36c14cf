use super::*;

/// Share of the samples of all palms at which the most probable mode is the true one, further than three samples from a change; and of those that are
/// sure and wrong.
fn right(told: &EstimatedModes, truth: &[[ContactMode; MOST_PALMS]]) -> [f64; 2] {
    let most = told.most_probable();
    let (mut all, mut right, mut wrong) = (0.0, 0.0, 0.0);
    for k in 3..truth.len() - 3 {
        for i in (0..3).filter(|&i| truth[k - 3..=k + 3].iter().all(|modes| modes[i] == truth[k][i])) {
            let odds = &told.odds[k][i];
            let is = f64::from(most[k][i] == truth[k][i]);
            all += 1.0;
            right += is;
            wrong += f64::from(odds.slide.max(odds.stick) > 0.99) * (1.0 - is);
        }
    }
    [right / all, wrong / all]
}

/// A body that spins between planes that rub, and stops after half of the time; the friction is not told.
#[test]
fn what_rubs_slides_until_it_stops_and_tells_its_friction() {
    let noise = noise(4e-5, 0.004);
    let exact = log(0.4, 500.0);
    let truth = modes(&exact);
    let log = noisy(&exact, &noise, 3).split_truth().0;
    let found = estimate_contacts(&log, None, &ContactOptions { mode_odds: true, ..options(noise) }).unwrap();
    let told = found.mode_odds.as_ref().unwrap();
    let count = log.times().len();
    assert_eq!((told.odds.len(), told.by_ratio.len(), found.modes.len()), (count, count, count));
    for palm in 0..3 {
        // A step of the grid is 1.6 %.
        let friction = told.frictions[palm].unwrap();
        assert!((friction.coefficient - 0.1).abs() < 1.6e-3, "{friction:?}");
    }
    let [right, wrong] = right(told, &truth);
    assert!(right > 0.97 && wrong < 2e-3, "{right} {wrong}");
    assert!(truth.iter().any(|modes| modes[..3] == [ContactMode::Stick; 3]));
    assert!(told.odds.iter().all(|odds| odds[3].off == 1.0 && odds[4].off == 1.0) && told.one_friction > 0.9);
    assert_eq!(found.modes, told.most_probable());
    assert!(told.unsure() < count / 10, "{}", told.unsure());
}

#[test]
fn modes_that_are_given_stay_and_none_are_told_unless_asked_for() {
    let noise = noise(4e-5, 0.004);
    let exact = log(0.4, 500.0);
    let given = modes(&exact);
    let log = noisy(&exact, &noise, 4).split_truth().0;
    let found =
        estimate_contacts(&log, Some(&given), &ContactOptions { mode_odds: true, ..options(noise) }).unwrap();
    assert_eq!(found.modes, given);
    let [right, wrong] = right(&found.mode_odds.unwrap(), &given);
    assert!(right > 0.97 && wrong < 2e-3, "{right} {wrong}");
    assert_eq!(estimate_contacts(&log, Some(&given), &options(noise)).unwrap().mode_odds, None);
}
