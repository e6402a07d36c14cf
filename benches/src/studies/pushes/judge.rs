//! Estimates beside the truth of simulated pushes.

use super::outline_panel;
use super::shapes::Named;
use recon::object_dynamics::pushing::{ClosedLine, PushMode, PushScene, SimulatedPushes};
use recon::observer::pushes::{PushesError, PushesEstimate};
use recon_io::{FigureCurve, FigurePanel};
use std::fmt::Write as _;

pub(super) const HEAD: &str = "| shape | logs, refused | kind right | friction: error median, rms of error over deviation, within 2 | outline on touched stretches, mm: median, 99 % | within 2 deviations | all around: median, 99 % | corners: error median, 90 %, mm; rms over deviation | mode right | confident and wrong | s |\n\
     |---|---|---|---|---|---|---|---|---|---|---|";
/// Bins of probabilities.
const BINS: usize = 10;
/// A probability that counts as sure.
const SURE: f64 = 0.99;

/// What logs of a shape came to.
#[derive(Default)]
pub(super) struct Tally {
    logs: u32,
    refused: u32,
    kind: u32,
    friction: Vec<[f64; 2]>,
    /// True and told coefficients.
    coefficients: Vec<[f64; 2]>,
    /// The last outline of the last shape: told and true.
    last: Option<[ClosedLine; 2]>,
    touched: Vec<[f64; 2]>,
    around: Vec<f64>,
    corners: Vec<[f64; 2]>,
    samples: u64,
    right: u64,
    wrong_sure: u64,
    brier: f64,
    /// Sum of probabilities of sticking, times it did, count.
    bins: [[f64; 3]; BINS],
    seconds: f64,
}

impl Tally {
    pub(super) fn add(
        &mut self,
        shape: &Named,
        scene: &PushScene,
        made: &SimulatedPushes,
        told: Result<PushesEstimate, PushesError>,
        seconds: f64,
    ) {
        self.logs += 1;
        self.seconds += seconds;
        let Ok(told) = told else {
            self.refused += 1;
            return;
        };
        let corners = told.outline.corners.len();
        self.kind += u32::from(corners == shape.corners.unwrap_or(0));
        if let Some(friction) = told.friction {
            self.coefficients.push([scene.friction, friction.value]);
            self.friction.push([friction.value - scene.friction, friction.deviation]);
        }
        for p in &told.outline.points {
            let off = scene.outline.nearest(p.point).distance;
            self.around.push(off.abs() * 1e3);
            if p.to_touch == 0.0 {
                self.touched.push([off * 1e3, p.deviation * 1e3]);
            }
        }
        if Some(corners) == shape.corners {
            for corner in &told.outline.corners {
                let off = scene.outline.corners().iter().map(|c| c.distance(corner.point));
                self.corners.push([off.fold(f64::INFINITY, f64::min) * 1e3, corner.deviation() * 1e3]);
            }
        }
        self.count_modes(made, &told);
        self.last = Some([told.outline.line, scene.outline.clone()]);
    }

    /// Friction told against the true one, and an outline.
    pub(super) fn panels(&self) -> Vec<FigurePanel> {
        let told = FigureCurve {
            name: "a log each".to_owned(),
            points: self.coefficients.clone(),
            dots: true,
            reference: vec![[0.2, 0.2], [0.7, 0.7]],
            ..FigureCurve::default()
        };
        let friction = FigurePanel {
            title: "Friction (proof)".to_owned(),
            axes: ["true".to_owned(), "told".to_owned()],
            curves: vec![told],
            ..FigurePanel::default()
        };
        let outline = self.last.iter().map(|[told, truth]| outline_panel("Butterfly", told, truth));
        std::iter::once(friction).chain(outline).collect()
    }

    fn count_modes(&mut self, made: &SimulatedPushes, told: &PushesEstimate) {
        for push in &told.pushes {
            let index = made.log.pushes().iter().position(|p| p.number == push.number).unwrap_or(0);
            let times = &made.log.pushes()[index].samples;
            for instant in &push.instants {
                let k = times.partition_point(|s| s.t < instant.t - 1e-9);
                let truth = made.truth[index][k.min(times.len() - 1)].mode;
                if truth == PushMode::Rest {
                    continue;
                }
                let odds = [instant.stick, instant.left, instant.right];
                let is = [PushMode::Stick, PushMode::Left, PushMode::Right].map(|m| f64::from(truth == m));
                self.samples += 1;
                self.right += u64::from(instant.mode() == truth);
                self.wrong_sure += u64::from(odds.iter().zip(is).any(|(p, is)| *p > SURE && is == 0.0));
                self.brier += odds.iter().zip(is).map(|(p, is)| (p - is).powi(2)).sum::<f64>();
                let bin = &mut self.bins[((odds[0] * BINS as f64) as usize).min(BINS - 1)];
                *bin = [bin[0] + odds[0], bin[1] + is[0], bin[2] + 1.0];
            }
        }
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.logs += other.logs;
        self.refused += other.refused;
        self.kind += other.kind;
        self.friction.extend(other.friction);
        self.coefficients.extend(other.coefficients);
        self.last = other.last.or(self.last.take());
        self.touched.extend(other.touched);
        self.around.extend(other.around);
        self.corners.extend(other.corners);
        self.samples += other.samples;
        self.right += other.right;
        self.wrong_sure += other.wrong_sure;
        self.brier += other.brier;
        for (bin, more) in self.bins.iter_mut().zip(other.bins) {
            *bin = [0, 1, 2].map(|i| bin[i] + more[i]);
        }
        self.seconds += other.seconds;
    }

    pub(super) fn row(&self, name: &str) -> String {
        let sizes = |of: &[[f64; 2]]| of.iter().map(|v| v[0].abs()).collect::<Vec<_>>();
        let within = |of: &[[f64; 2]]| {
            of.iter().filter(|[e, d]| e.abs() <= 2.0 * d).count() as f64 / of.len().max(1) as f64
        };
        let scaled = |of: &[[f64; 2]]| {
            (of.iter().map(|[e, d]| (e / d).powi(2)).sum::<f64>() / of.len().max(1) as f64).sqrt()
        };
        let share = |count: u64| count as f64 / self.samples.max(1) as f64;
        format!(
            "| {name} | {}, {} | {} | {} | {:.2}, {:.2} | {:.2} | {:.2}, {:.2} | {} | {:.3} | {:.4} | {:.1} |",
            self.logs,
            self.refused,
            self.kind,
            if self.friction.is_empty() {
                "not told".to_owned()
            } else {
                format!(
                    "{:.4}, {:.2}, {:.2}",
                    quantile(sizes(&self.friction), 0.5),
                    scaled(&self.friction),
                    within(&self.friction)
                )
            },
            quantile(sizes(&self.touched), 0.5),
            quantile(sizes(&self.touched), 0.99),
            within(&self.touched),
            quantile(self.around.clone(), 0.5),
            quantile(self.around.clone(), 0.99),
            if self.corners.is_empty() {
                "–".to_owned()
            } else {
                format!(
                    "{:.2}, {:.2}; {:.2}",
                    quantile(sizes(&self.corners), 0.5),
                    quantile(sizes(&self.corners), 0.9),
                    scaled(&self.corners)
                )
            },
            share(self.right),
            share(self.wrong_sure),
            self.seconds / f64::from(self.logs.max(1)),
        )
    }

    /// How probabilities of sticking turned out.
    pub(super) fn modes(&self) -> String {
        let mut text = format!(
            "Modes of all: Brier score {:.4} (three modes). Told probability of sticking, how often it stuck, share of samples:\n\n| told | stuck | share |\n|---|---|---|\n",
            self.brier / self.samples.max(1) as f64
        );
        for [told, stuck, count] in self.bins.iter().filter(|bin| bin[2] > 0.0) {
            let _ = writeln!(
                text,
                "| {:.3} | {:.3} | {:.4} |",
                told / count,
                stuck / count,
                count / self.samples as f64
            );
        }
        text
    }
}

/// The value below which a share of all lies.
pub(super) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get((share * values.len().saturating_sub(1) as f64).round() as usize).copied().unwrap_or(f64::NAN)
}
