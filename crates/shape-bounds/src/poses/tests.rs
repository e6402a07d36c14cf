use super::*;
use crate::generators::Source;

/// Runs of a box that falls, hits the plane with some side, rocks and rests, with tracking noise of standard deviation `sd`.
fn tosses(count: usize, half: DVec3, sd: f64, seed: u64) -> Vec<Vec<BodyPose>> {
    let mut s = Source::new(seed);
    (0..count)
        .map(|_| {
            let start = s.rotation();
            // At rest one face is down: turn the box so that its lowest axis points along gravity.
            let down = start.inverse() * DVec3::NEG_Z;
            let axis = down.abs().max_position();
            let face = DVec3::from_array([0, 1, 2].map(|k| if k == axis { down[k].signum() } else { 0.0 }));
            let rest = start * DQuat::from_rotation_arc(face, down);
            (0..40)
                .map(|frame| {
                    let turned = ((frame as f64 - 12.0) / 14.0).clamp(0.0, 1.0);
                    let R_WO = start.slerp(rest, turned);
                    let lowest = (half * (R_WO.inverse() * DVec3::Z).abs()).element_sum();
                    let frames = (frame as f64).min(12.0);
                    let z = lowest + 0.0005 * (144.0 - frames * frames);
                    BodyPose { R_WO, p_WO: DVec3::new(0.0, 0.0, z) + s.normal3() * sd }
                })
                .collect()
        })
        .collect()
}

#[test]
fn a_tossed_box_is_contained_and_its_noise_is_found() {
    let half = DVec3::new(0.05, 0.04, 0.06);
    for (seed, sd) in [(1, 5e-5), (2, 1e-4), (3, 2e-4)] {
        let bounds = PoseBounds::above_plane(&tosses(60, half, sd, seed), 0.0, 0.99).unwrap();
        let corner = |i: u32| {
            DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE
        };
        assert!((0..8).all(|i| bounds.upper.contains(half * corner(i))), "sd {sd}");
        let lower = bounds.lower.as_ref().unwrap().solid().unwrap();
        assert!(lower.vertices().iter().all(|v| (v.abs() / half).max_element() <= 1.0), "sd {sd}");
        assert!(lower.volume() > 0.3 * 8.0 * half.element_product(), "sd {sd}");
        assert!(bounds.consistent_level < 5.0 * sd, "{sd} {}", bounds.consistent_level);
        assert!(
            bounds.upper.volume() < 8.0 * half.element_product() * (1.0 + 60.0 * sd / half.min_element())
        );
    }
}

/// How far the farthest corner of a box is beyond the bound, in m.
fn beyond(bounds: &PoseBounds, half: DVec3) -> f64 {
    let corner =
        |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE;
    (0..8).map(|i| bounds.upper.excess(half * corner(i))).fold(f64::NEG_INFINITY, f64::max)
}

fn raise(run: &mut [BodyPose], by: f64) {
    run.iter_mut().for_each(|pose| pose.p_WO.z += by);
}

#[test]
fn one_wrong_toss_costs_one_toss() {
    let half = DVec3::new(0.05, 0.04, 0.06);
    for (seed, wrong) in [(11, 7), (12, 20), (13, 33)] {
        let mut runs = tosses(60, half, 1e-4, seed);
        let right = PoseBounds::above_plane(&runs, 0.0, 0.95).unwrap();
        assert!(right.left_out.is_empty() && !right.propped, "{seed}: {:?}", right.left_out);
        raise(&mut runs[wrong], -0.02);
        let bounds = PoseBounds::above_plane(&runs, 0.0, 0.95).unwrap();
        let named: Vec<usize> = bounds.left_out.iter().map(|l| l.run).collect();
        assert_eq!(named, [wrong], "{seed}");
        assert!(bounds.left_out[0].against.len() > 1 && bounds.half_spaces[wrong].is_empty());
        assert!(beyond(&bounds, half) <= 0.0, "{seed}");
        assert!(bounds.margin < 1.5 * right.margin, "{seed}: {} {}", bounds.margin, right.margin);
    }
}

#[test]
fn a_body_that_is_propped_up_is_still_contained() {
    let half = DVec3::new(0.05, 0.04, 0.06);
    for seed in 21..24 {
        let mut runs = tosses(60, half, 1e-4, seed);
        // Every third run ends on something else, at heights of its own; two runs are seen too low.
        (0..20).for_each(|k| raise(&mut runs[3 * k], 0.02 + 0.003 * k as f64));
        raise(&mut runs[1], -0.006);
        raise(&mut runs[31], -0.01);
        let bounds = PoseBounds::above_plane(&runs, 0.0, 0.95).unwrap();
        assert!(bounds.propped && bounds.lower.is_none(), "{seed} {}", bounds.consistent_level);
        assert!(beyond(&bounds, half) <= 0.0, "{seed}: {}", beyond(&bounds, half));
        let volume = 8.0 * half.element_product();
        assert!(bounds.upper.volume() < 1.8 * volume, "{seed}: {}", bounds.upper.volume() / volume);
    }
}

#[test]
fn an_uncertain_height_widens_the_margin_and_is_contained() {
    let half = DVec3::new(0.05, 0.04, 0.06);
    let runs = tosses(60, half, 1e-4, 31);
    let at = |z, deviation, run_deviation| {
        PoseBounds::above_plane(&runs, PlaneHeight { z, deviation, run_deviation }, 0.95)
    };
    let exact = at(0.0, 0.0, 0.0).unwrap();
    // Two deviations too high: as likely as a miss of the whole.
    let wrong = at(2e-3, 1e-3, 0.0).unwrap();
    assert!(beyond(&wrong, half) <= 0.0 && wrong.margin > exact.margin + 1.9e-3);
    let of_runs = at(0.0, 0.0, 1e-3).unwrap();
    // 1 - 0.025 / 60 is the probability of 3.34 deviations.
    assert!(
        (of_runs.margin - exact.margin - 3.34e-3).abs() < 2e-4 * (1.0 + exact.margin),
        "{}",
        of_runs.margin
    );
    assert_eq!(at(0.0, -1.0, 0.0), Err(PoseError::Deviation(-1.0)));
}

#[test]
fn a_plane_stated_too_high_is_noticed_where_edges_tell() {
    let half = DVec3::new(0.05, 0.04, 0.06);
    for (seed, sd) in [(41, 2e-5), (42, 5e-5), (43, 1e-4)] {
        let runs = tosses(60, half, sd, seed);
        let seems = |z: f64| PoseBounds::above_plane(&runs, z, 0.95).unwrap().plane_seems_lower;
        assert_eq!((seems(0.0), seems(-1e-3)), (None, None), "sd {sd}");
        // The worst errors of the poses come on top: some five to seven deviations.
        let told = seems(1e-3).unwrap();
        assert!(told > 0.9e-3 && told < 1e-3 + 8.4 * sd, "sd {sd}: {told}");
    }
}

#[test]
fn bad_poses_are_named() {
    let mut runs = tosses(20, DVec3::splat(0.05), 1e-4, 4);
    runs[3][5].p_WO.z = f64::NAN;
    let error = PoseBounds::above_plane(&runs, 0.0, 0.95).unwrap_err();
    assert!(matches!(error, PoseError::Pose { run: 3, frame: 5, .. }), "{error}");
    let error = PoseBounds::above_plane(&[Vec::new()], 0.0, 0.95).unwrap_err();
    assert_eq!(error, PoseError::ShortRun { run: 0, frames: 0 });
    runs[3][5].p_WO.z = 0.3;
    assert_eq!(PoseBounds::above_plane(&runs, 0.0, 2.0), Err(PoseError::Confidence(2.0)));
    let error = PoseBounds::above_plane(&runs[..2], 0.0, 0.95).unwrap_err();
    assert!(matches!(error, PoseError::TooFewTouching { .. } | PoseError::Open { .. }), "{error}");
}

#[test]
fn a_rule_grows_with_confidence_and_with_want_of_runs_and_bad_ones_are_named() {
    let rule = PoseRule::tight();
    let [low, high] = CONFIDENCES.map(|c| rule.factor(c, CALIBRATED_RUNS));
    assert!((low - rule.factors[0]).abs() < 1e-12 && (high - rule.factors[1]).abs() < 1e-12 * high);
    assert_eq!(rule.factor(0.6, 200), rule.factors[0]);
    assert!(low < rule.factor(0.97, 100) && rule.factor(0.97, 100) < high && high < rule.factor(0.999, 100));
    assert!((rule.factor(0.95, 25) / low - 4.0_f64.powf(rule.scarcity)).abs() < 1e-12);
    let runs = tosses(3, DVec3::splat(0.05), 1e-4, 5);
    let refused = |rule: PoseRule| PoseBounds::by_rule(&runs, 0.0, 0.95, &rule).unwrap_err();
    let named = |rule: PoseRule, expected: &str| {
        let error = refused(rule);
        assert!(matches!(error, PoseError::Rule { name, .. } if name == expected), "{error}");
    };
    named(PoseRule { kink: -1.0, ..rule }, "kink");
    named(PoseRule { trusted: 0.0, ..rule }, "trusted");
    named(PoseRule { factors: [2.0, 1.0], ..rule }, "factors[1]");
    named(PoseRule { scarcity: f64::NAN, ..rule }, "scarcity");
}

/// The real cube of `../shared/data/cube_tosses.csv` (edge 0.1048 m), which is not part of this repository: the default
/// rule contains it; the tight one misses ideal corners by what the documentation says.
#[test]
fn the_real_cube_lies_where_it_is_said_to() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/cube_tosses.csv");
    let Ok(text) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is not there");
        return;
    };
    let mut runs: Vec<(u32, Vec<BodyPose>)> = Vec::new();
    for line in text.lines().skip(1) {
        let [toss, _, w, x, y, z, px, py, pz] =
            <[f64; 9]>::try_from(line.split(',').map(|c| c.parse().unwrap()).collect::<Vec<f64>>()).unwrap();
        let pose = BodyPose { R_WO: DQuat::from_xyzw(x, y, z, w), p_WO: DVec3::new(px, py, pz) };
        match runs.last_mut() {
            Some((last, run)) if *last == toss as u32 => run.push(pose),
            _ => runs.push((toss as u32, vec![pose])),
        }
    }
    let runs: Vec<Vec<BodyPose>> = runs.into_iter().map(|(_, run)| run).collect();
    // The table's height as calibrated; the cube's size is used to judge alone.
    let table = -1.87e-3;
    let half = 0.0524;
    let volume = 8.0 * half * half * half;
    let rules = [PoseRule::default(), PoseRule::tight()];
    let all = rules.iter().flat_map(|rule| CONFIDENCES.map(|c| (rule, c)));
    for (rule, confidence) in all.take(crate::few_or_all(1, usize::MAX)) {
        // Two disjoint hundreds, and one across both.
        for &first in crate::few_or_all(&[50][..], &[0, 50, 100]) {
            let bounds = PoseBounds::by_rule(&runs[first..first + 100], table, confidence, rule).unwrap();
            let corner = |i: u32| {
                DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE
            };
            let cut = (0..8).map(|i| bounds.upper.excess(corner(i) * half)).fold(f64::NEG_INFINITY, f64::max);
            let lower = bounds.lower.as_ref().unwrap().solid().unwrap();
            let outside = lower
                .vertices()
                .iter()
                .map(|v| v.abs().max_element() - half)
                .fold(f64::NEG_INFINITY, f64::max);
            println!(
                "share {}, {confidence}, tosses {}..: margin {:.2} mm, upper {:.3}, lower {:.3} of the cube's volume; corners {:+.2} mm \
                 beyond the upper bound, lower bound {:+.2} mm beyond the cube; {} of {} touching disagree",
                rule.trusted,
                first + 1,
                bounds.margin * 1e3,
                bounds.upper.volume() / volume,
                lower.volume() / volume,
                cut * 1e3,
                outside * 1e3,
                bounds.outliers.len(),
                bounds.touching
            );
            assert!(outside <= 0.0);
            if *rule == PoseRule::default() {
                let most = if confidence == CONFIDENCES[0] { 1.25 } else { 1.35 };
                assert!(cut <= 0.0 && bounds.upper.volume() < most * volume);
            } else {
                let missed = if confidence == CONFIDENCES[0] { 1.2e-3 } else { 0.5e-3 };
                assert!(cut < missed && bounds.upper.volume() < 1.18 * volume);
            }
        }
    }
}
