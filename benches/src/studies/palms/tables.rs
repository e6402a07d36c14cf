//! Tables of the page.

use super::row::Row;
use exploration::generators::Family;
use recon_benches::palms::{ESTIMATED, Interval, LOOKS, PalmKind, median_of, paired};

/// All runs, kind by kind, with the bodies in one order, and how far palms moved in them.
pub(super) struct Compared {
    pub(super) all: [Vec<Row>; PalmKind::ALL.len()],
    /// Radians of all palms together up to the end.
    pub(super) radians: f64,
    /// Up to the end, s.
    pub(super) seconds: f64,
}

/// A number of a run; none where it is not to count.
pub(super) type Of = fn(&Row) -> Option<f64>;

/// Coverage at the end of runs that were held.
pub(super) const COVERAGE_HELD: Of = |r| r.held().then_some(r.looks[LOOKS - 1][0]);
/// Coverage after half of the motion of runs that were held to the end.
const COVERAGE_HALF: Of = |r| r.held().then_some(r.looks[LOOKS / 2 - 1][0]);
/// Gap at the end of runs that were held.
const GAP_HELD: Of = |r| r.held().then_some(r.looks[LOOKS - 1][1]);
/// Coverage at the end or the loss.
pub(super) const COVERAGE_ALL: Of = |r| r.simulated().then_some(r.looks[LOOKS - 1][0]);
/// Gap at the end or the loss.
const GAP_ALL: Of = |r| r.simulated().then_some(r.looks[LOOKS - 1][1]);
/// Radians that a body turned through that was held.
const TURNED: Of = |r| r.held().then_some(r.turned);
/// Deviation of the motion.
pub(super) const MOTION: Of = |r| Some(r.told[0]).filter(|x| x.is_finite());
/// Of the mass.
const MASS: Of = |r| Some(r.told[1]).filter(|x| x.is_finite());
/// Of the inertia.
pub(super) const INERTIA: Of = |r| Some(r.told[2]).filter(|x| x.is_finite());
/// Condition number.
const CONDITION: Of = |r| Some(r.told[3]).filter(|x| x.is_finite());

impl Compared {
    /// Of each body on palms of the `kind`-th kind.
    pub(super) fn values(&self, kind: usize, of: Of) -> Vec<Option<f64>> {
        self.all[kind].iter().map(of).collect()
    }

    /// Of those that count.
    fn median(&self, kind: usize, of: Of) -> Interval {
        median_of(&self.values(kind, of).into_iter().flatten().collect::<Vec<_>>())
    }

    /// Kind less flat.
    pub(super) fn difference(&self, kind: usize, of: Of) -> Interval {
        paired(&self.values(0, of), &self.values(kind, of), |flat, curved| curved - flat)
    }

    /// Kind over flat.
    pub(super) fn ratio(&self, kind: usize, of: Of) -> Interval {
        paired(&self.values(0, of), &self.values(kind, of), |flat, curved| curved / flat)
    }
}

/// A median with its interval, times a factor.
fn cell(of: Interval, times: f64, digits: usize) -> String {
    let Interval { median, ends: [low, high], count } = of;
    if count == 0 {
        return "-".to_owned();
    }
    let [m, l, h] = [median, low, high].map(|x| format!("{:.digits$}", times * x));
    format!("{m} ({l} to {h})")
}

fn significant(of: Interval) -> String {
    if of.count == 0 {
        return "-".to_owned();
    }
    let [m, l, h] = [of.median, of.ends[0], of.ends[1]].map(|x| {
        let digits = (1.0 - x.abs().max(1e-12).log10().floor()).max(0.0) as usize;
        format!("{x:.digits$}")
    });
    format!("{m} ({l} to {h})")
}

fn heads(names: &[&str]) {
    println!("| palms | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
}

fn each_kind(first: usize, line: impl Fn(usize) -> String) {
    for (k, kind) in PalmKind::ALL.iter().enumerate().skip(first) {
        println!("| {} | {} |", kind.name(), line(k));
    }
    println!();
}

pub(super) fn print(compared: &Compared) {
    ends(compared);
    seen(compared);
    against_flat(compared);
    known(compared);
    families(compared);
}

fn ends(compared: &Compared) {
    println!("## What is held\n");
    heads(&[
        "bodies",
        "held to the end",
        "lost",
        "refused by the simulation",
        "lost after, s",
        "palms touched, mean",
    ]);
    each_kind(0, |k| {
        let all = &compared.all[k];
        let count = |which: &dyn Fn(&Row) -> bool| all.iter().filter(|r| which(r)).count();
        let mut why: Vec<&str> = all.iter().filter(|r| !r.simulated()).map(|r| r.end.as_str()).collect();
        why.sort_unstable();
        let refused = why.chunk_by(|a, b| a == b).map(|same| format!("{} {}", same.len(), same[0]));
        let refused: Vec<String> = refused.collect();
        let refused = if refused.is_empty() { "0".to_owned() } else { refused.join(", ") };
        let lost = median_of(&all.iter().map(|r| r.lost).collect::<Vec<_>>());
        let lost = if lost.count == 0 { "-".to_owned() } else { format!("{:.1}", lost.median) };
        let touched = median_of(&all.iter().map(|r| r.touched).collect::<Vec<_>>()).median;
        let (held, gone) = (count(&Row::held), count(&|r| r.end == "lost"));
        format!("{} | {held} | {gone} | {refused} | {lost} | {touched:.2}", all.len())
    });
}

fn seen(compared: &Compared) {
    let Compared { radians, seconds, .. } = compared;
    println!(
        "## What is seen of bodies that are held to the end\n\nAfter {seconds:.1} s and {radians:.1} rad of palm motion, medians with their 95 % intervals.\n"
    );
    heads(&[
        "bodies",
        "coverage, %",
        "gap, %",
        "gap with balls, %",
        "% covered a rad",
        "% covered a s",
        "body turned, rad",
    ]);
    let in_balls: Of = |r| (r.held() && r.in_balls.is_finite()).then_some(r.in_balls);
    each_kind(0, |k| {
        let coverage = compared.median(k, COVERAGE_HELD);
        format!(
            "{} | {} | {} | {} | {} | {} | {}",
            coverage.count,
            cell(coverage, 100.0, 0),
            cell(compared.median(k, GAP_HELD), 100.0, 0),
            cell(compared.median(k, in_balls), 100.0, 0),
            cell(coverage, 100.0 / radians, 1),
            cell(coverage, 100.0 / seconds, 1),
            cell(compared.median(k, TURNED), 1.0, 1)
        )
    });
}

fn against_flat(compared: &Compared) {
    println!(
        "## Against flat palms, body by body\n\nMedian of the differences on the same bodies; left those that both hold to the end, right all that were simulated, with what was seen up to a loss.\n"
    );
    heads(&[
        "held by both",
        "coverage, points",
        "more on, less on",
        "coverage after half of the motion",
        "gap, points",
        "turn of the body, ratio",
        "simulated with both",
        "coverage, points",
        "gap, points",
    ]);
    each_kind(1, |k| {
        let (held, all) = (compared.difference(k, COVERAGE_HELD), compared.difference(k, COVERAGE_ALL));
        let pairs = compared.values(0, COVERAGE_HELD).into_iter().zip(compared.values(k, COVERAGE_HELD));
        let changes: Vec<f64> = pairs.filter_map(|(flat, curved)| Some(curved? - flat?)).collect();
        let more = changes.iter().filter(|x| **x > 0.0).count();
        let less = changes.iter().filter(|x| **x < 0.0).count();
        format!(
            "{} | {} | {more}, {less} | {} | {} | {} | {} | {} | {}",
            held.count,
            cell(held, 100.0, 1),
            cell(compared.difference(k, COVERAGE_HALF), 100.0, 1),
            cell(compared.difference(k, GAP_HELD), 100.0, 1),
            cell(compared.ratio(k, TURNED), 1.0, 2),
            all.count,
            cell(all, 100.0, 1),
            cell(compared.difference(k, GAP_ALL), 100.0, 1)
        )
    });
}

fn known(compared: &Compared) {
    println!(
        "## What the estimator knows\n\nOf an unknown body after the first {ESTIMATED} s, by the deviations that it states: the largest of the motion in natural units (median over the samples), of the mass, \
         and of the inertia along the axes of its covariance over the mean moment; condition: the largest of those over the least.\n"
    );
    heads(&[
        "estimates",
        "motion",
        "mass",
        "inertia",
        "condition",
        "relied on",
        "mass off by more than 3 deviations",
    ]);
    each_kind(0, |k| {
        let told: Vec<&Row> = compared.all[k].iter().filter(|r| r.told[2].is_finite()).collect();
        let relied: Vec<&&Row> = told.iter().filter(|r| r.judged[1] > 0.5).collect();
        let off = relied.iter().filter(|r| r.judged[0].abs() > 3.0).count();
        let [motion, mass, inertia, condition] =
            [MOTION, MASS, INERTIA, CONDITION].map(|of| significant(compared.median(k, of)));
        format!("{} | {motion} | {mass} | {inertia} | {condition} | {} | {off}", told.len(), relied.len())
    });
    println!(
        "Over those on flat palms, body by body. All kinds move by the same radians in the same time: information (one over the square) per radian and per second is that on flat palms over the square of this.\n"
    );
    heads(&[
        "estimates of both",
        "motion",
        "mass",
        "inertia",
        "condition",
        "information on the inertia, a rad and a s",
    ]);
    each_kind(1, |k| {
        let [motion, mass, inertia, condition] =
            [MOTION, MASS, INERTIA, CONDITION].map(|of| compared.ratio(k, of));
        let information =
            paired(&compared.values(0, INERTIA), &compared.values(k, INERTIA), |flat, curved| {
                (flat / curved).powi(2)
            });
        let cells = [motion, mass, inertia, condition, information].map(|of| cell(of, 1.0, 2));
        format!("{} | {}", inertia.count, cells.join(" | "))
    });
}

fn families(compared: &Compared) {
    println!(
        "## By family\n\nHeld to the end, and the median difference of coverage to flat palms (points) of all that were simulated.\n"
    );
    heads(&Family::ALL.map(Family::name));
    let each = compared.all[0].len() / Family::ALL.len();
    each_kind(0, |k| {
        let one = |f: usize| {
            let places = f * each..(f + 1) * each;
            let rows = compared.all[k].get(places.clone()).unwrap_or_default();
            let held = rows.iter().filter(|r| r.held()).count();
            let flat = compared.all[0].get(places).unwrap_or_default();
            let [a, b] = [flat, rows].map(|rows| rows.iter().map(COVERAGE_ALL).collect::<Vec<_>>());
            format!("{held}, {:+.0}", 100.0 * paired(&a, &b, |a, b| b - a).median)
        };
        [0, 1, 2, 3, 4].map(one).join(" | ")
    });
}
