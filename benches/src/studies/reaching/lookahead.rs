//! What looking ahead could gain, in the plane.

use super::Failure;
use exploration::generators::Family;
use recon_benches::reaching::Bodies;
use recon_benches::reaching::hindsight::{GAPS, Hindsight, hindsight};
use recon_benches::reaching::statistics::quantile;

pub(super) fn table(bodies: Bodies) -> Result<(), Failure> {
    let all = hindsight(bodies)?;
    println!("{}\n", include_str!("lookahead.md").trim_end());
    println!(
        "| body | to | best pattern | path-aware | bodies where it takes no more | rad | shortest way through the same touches |\n|---|---|---|---|---|---|---|"
    );
    for family in Family::ALL.into_iter().map(Some).chain([None]) {
        let of: Vec<&Hindsight> =
            all.iter().filter(|of| family.is_none_or(|family| of.family == family)).collect();
        for (k, gap) in GAPS.iter().enumerate() {
            println!("{}", row(family.map_or("all", |family| family.name()), &of, (k, *gap)));
        }
    }
    println!();
    Ok(())
}

fn row(name: &str, of: &[&Hindsight], (k, gap): (usize, f64)) -> String {
    let count = |n: Option<usize>| n.map(|n| n as f64);
    let pair = |values: Vec<Option<f64>>, digits: usize| {
        format!("{:.digits$} / {:.digits$}", quantile(&values, 0.5), quantile(&values, 0.9))
    };
    let touches = |which: fn(&Hindsight) -> [Option<usize>; 3]| {
        pair(of.iter().map(|of| count(which(of)[k])).collect(), 0)
    };
    let no_more = of.iter().filter(|of| of.made[k].is_some() && of.made[k] <= of.fewest[k]).count();
    let last = k + 1 == GAPS.len();
    let way = |which: usize| {
        if last { pair(of.iter().map(|of| Some(of.way[which])).collect(), 1) } else { "".to_owned() }
    };
    format!(
        "| {name} | {:.0} % | {} | {} | {no_more} of {} | {} | {} |",
        100.0 * gap,
        touches(|of| of.fewest),
        touches(|of| of.made),
        of.len(),
        way(0),
        way(1)
    )
}
