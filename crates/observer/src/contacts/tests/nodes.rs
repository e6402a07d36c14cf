use super::*;

/// Of sensors whose forces carry the motion over several samples: contacts that slide between nodes, and none that sticks.
#[test]
fn each_sample_at_which_a_contact_sticks_is_a_node() {
    let noise = noise(4e-4, 1e-5);
    for (log, each) in [(rubbed(0.03, 3000.0, 0.1), false), (rocking(0.03, 3000.0), true)] {
        let log = noisy(&log, &noise, 3);
        let options = options(noise);
        let mut record = Record::new(&log, &options).unwrap();
        record.set_modes(&modes(&log));
        let nodes = |planar: bool, exact: bool| {
            let problem = search::problem(&record, &options, cold::units(&record, G, SIZE));
            search::fine_nodes(&Problem { planar, exact, ..problem }).len()
        };
        let samples = record.times.len();
        assert_eq!(nodes(false, false) == samples, each);
        assert!(nodes(false, true) < samples / 2, "exact ones carry a motion farther, whatever sticks");
        // In the plane a body rests and turns back while its contacts slide.
        assert_eq!(nodes(true, false), samples);
    }
}
