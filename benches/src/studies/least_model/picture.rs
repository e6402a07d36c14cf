//! Cost over that of the cheapest model that serves, against the wanted accuracy.

use super::{Failure, Outcome};
use recon_benches::{Axis, Diagram, Method, WorkPrecision};
use std::path::Path;

/// Draws it into the folder of charts, as CSV, SVG and PNG.
pub(super) fn write(motions: &[Outcome], estimates: &[Outcome]) -> Result<(), Failure> {
    let mut chart =
        WorkPrecision::new("least-model", "The least model that serves beside the cheapest of all")
            .subtitle(
                "a point a scene: 1 is the cheapest that was found by trying all, 2 the most that is allowed",
            )
            .axes(Axis::log("wanted accuracy", "sizes, rad"), Axis::log("time over the cheapest", "1"));
    for (name, all) in [("simulations", motions), ("estimates", estimates)] {
        let mut sorted: Vec<&Outcome> = all.iter().filter(|of| of.cheapest.is_finite()).collect();
        sorted.sort_by(|a, b| a.wanted.total_cmp(&b.wanted));
        let point = |method: Method, of: &&Outcome| {
            method.point(of.what[0].clone(), of.wanted, of.chosen / of.cheapest)
        };
        chart = chart.method(sorted.iter().fold(Method::new(name).apart(), point));
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/charts");
    Diagram::from(chart).save(&folder)?;
    Ok(())
}
