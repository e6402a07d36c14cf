//! What is told and what is true.

use recon::shape_bounds::exact_hull::Hull;
use recon::shape_bounds::features::{FeatureKind, Features};
use recon::shape_bounds::noise::CertainBounds;
use shape_bounds::generators::{Touched, TouchedBody};

pub(super) const TOLD_HEAD: &str = "| body | noise | corners: contacts, told right, open | edges | faces | smooth | corners found | error, median, largest; rms over stated | polyhedra: right number of corners, volume off by | ms |\n|---|---|---|---|---|---|---|---|---|---|\n";
pub(super) const BOUNDS_HEAD: &str = "| body | noise | runs | both hold | without means over features | lower / true, with (without) | upper / true, with (without) |\n|---|---|---|---|---|---|---|\n";

/// One run.
pub(super) struct Judged {
    confusion: [[usize; 5]; 4],
    /// Corners that were touched, and distances of those found from the nearest true one with their stated deviations, m.
    corners: (usize, Vec<[f64; 2]>),
    /// Whether a polyhedron has as many corners as the body, and its volume over the true one; none where there is no polyhedron.
    polyhedron: Option<(bool, f64)>,
    holds: [bool; 2],
    /// Volumes of the bounds over the true one: lower and upper, without and with means over features.
    volumes: [[f64; 2]; 2],
    seconds: f64,
}

impl Judged {
    pub(super) fn new(
        body: &TouchedBody,
        touched: &Touched,
        features: &Features,
        bounds: [CertainBounds; 2],
        seconds: f64,
    ) -> Self {
        let volume = volume(body);
        let sizes = |bounds: &CertainBounds| {
            let lower = bounds.lower.as_ref().and_then(|l| l.solid()).map_or(0.0, |solid| solid.volume());
            let upper = bounds.upper.as_ref().map_or(f64::INFINITY, |upper| upper.volume());
            [lower / volume, upper / volume]
        };
        Self {
            confusion: confusion(touched, features),
            corners: corners(body, touched, features),
            polyhedron: features.polyhedron().map(|made| {
                let count = match body {
                    TouchedBody::Polytope(corners, _) => corners.len(),
                    TouchedBody::Ellipsoid(_) => 0,
                };
                (made.mesh.vertices.len() == count, made.volume / volume)
            }),
            holds: [holds(body, &bounds[0]), holds(body, &bounds[1])],
            volumes: [sizes(&bounds[0]), sizes(&bounds[1])],
            seconds,
        }
    }
}

/// Contacts by what they are (rows) and what they are told to be, the last one open.
pub(super) fn confusion(touched: &Touched, features: &Features) -> [[usize; 5]; 4] {
    let mut counts = [[0; 5]; 4];
    let of = features.run_of_each(touched.curves.len());
    for (kind, run) in touched.kinds.iter().flatten().zip(of.iter().flatten()) {
        counts[*kind as usize][features.runs[*run].kind.map_or(4, |told| told as usize)] += 1;
    }
    counts
}

fn corners(body: &TouchedBody, touched: &Touched, features: &Features) -> (usize, Vec<[f64; 2]>) {
    let TouchedBody::Polytope(all, _) = body else { return (0, Vec::new()) };
    let at = |v: &glam::DVec3| {
        let pairs = touched.exact.iter().flatten().zip(touched.kinds.iter().flatten());
        pairs.into_iter().any(|(c, kind)| *kind == FeatureKind::Corner && c.point.distance(*v) < 1e-9)
    };
    let found = features.corners.iter().map(|corner| {
        let off = all.iter().map(|v| v.distance(corner.point)).fold(f64::INFINITY, f64::min);
        let c = corner.covariance;
        [off, (c.x_axis.x + c.y_axis.y + c.z_axis.z).sqrt()]
    });
    (all.iter().filter(|v| at(v)).count(), found.collect())
}

fn holds(body: &TouchedBody, bounds: &CertainBounds) -> bool {
    let lower = bounds.lower.as_ref().and_then(|lower| lower.solid());
    let inside = lower.is_none_or(|solid| solid.vertices().iter().all(|v| body.outside(*v) <= 0.0));
    let around = bounds.upper.as_ref().is_none_or(|upper| {
        upper.face_half_spaces().iter().all(|h| {
            let n = h.normal.get();
            body.support(n) <= n.dot(h.point) + h.margin
        })
    });
    inside && around
}

/// By so many points of the surface that it is right to a ten-thousandth.
fn volume(body: &TouchedBody) -> f64 {
    match body {
        TouchedBody::Ellipsoid(axes) => 4.0 / 3.0 * std::f64::consts::PI * axes.element_product(),
        TouchedBody::Polytope(corners, rounding) => {
            let solid = |points: &[glam::DVec3]| {
                Hull::of(points)
                    .ok()
                    .and_then(|hull| hull.solid().map(|solid| solid.volume()))
                    .unwrap_or(f64::NAN)
            };
            if *rounding == 0.0 {
                return solid(corners);
            }
            let mut source = shape_bounds::generators::Source::new(7);
            let points: Vec<_> = (0..20_000)
                .map(|_| source.direction())
                .flat_map(|n| corners.iter().map(move |v| *v + *rounding * n))
                .collect();
            solid(&points)
        }
    }
}

/// All runs of a row.
#[derive(Default)]
pub(super) struct Tally(Vec<Judged>);

impl Tally {
    pub(super) fn add(&mut self, run: Judged) {
        self.0.push(run);
    }

    pub(super) fn told_row(&self, name: &str, noise: f64) -> String {
        let row = |k: usize| {
            let of = |told: usize| self.0.iter().map(|run| run.confusion[k][told]).sum::<usize>();
            let all: usize = (0..5).map(of).sum();
            if all == 0 {
                return "-".to_owned();
            }
            let share = |count: usize| 100.0 * count as f64 / all as f64;
            format!("{all}, {:.2} %, {:.2} %", share(of(k)), share(of(4)))
        };
        let touched: usize = self.0.iter().map(|run| run.corners.0).sum();
        let mut off: Vec<[f64; 2]> = self.0.iter().flat_map(|run| run.corners.1.clone()).collect();
        off.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let errors = off.get(off.len() / 2).map_or("-".to_owned(), |median| {
            let rms =
                (off.iter().map(|[off, std]| (off / std).powi(2)).sum::<f64>() / off.len() as f64).sqrt();
            format!("{:.1e}, {:.1e} m; {rms:.2}", median[0], off[off.len() - 1][0])
        });
        let made: Vec<_> = self.0.iter().filter_map(|run| run.polyhedron).collect();
        let right = made.iter().filter(|made| made.0);
        let worst = right.clone().map(|made| (made.1 - 1.0).abs()).fold(0.0, f64::max);
        let milliseconds = median(self.0.iter().map(|run| 1e3 * run.seconds).collect());
        format!(
            "| {name} | {noise:e} | {} | {} | {} | {} | {} of {touched} | {errors} | {}: {}, {:.2} % | {milliseconds:.0} |",
            row(1),
            row(2),
            row(3),
            row(0),
            off.len(),
            made.len(),
            right.count(),
            100.0 * worst,
        )
    }

    pub(super) fn bounds_row(&self, name: &str, noise: f64) -> String {
        let hold = |with: usize| self.0.iter().filter(|run| run.holds[with]).count();
        let ratio =
            |with: usize, upper: usize| median(self.0.iter().map(|run| run.volumes[with][upper]).collect());
        format!(
            "| {name} | {noise:e} | {} | {} | {} | {:.4} ({:.4}) | {:.4} ({:.4}) |",
            self.0.len(),
            hold(1),
            hold(0),
            ratio(1, 0),
            ratio(0, 0),
            ratio(1, 1),
            ratio(0, 1)
        )
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
