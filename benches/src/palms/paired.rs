//! Medians and paired differences with bootstrap intervals.

use exploration::Source;

/// Draws of a bootstrap.
const DRAWS: usize = 4000;

/// A median with its 95 % interval, and of how many numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The median.
    pub median: f64,
    /// 95 % interval by a bootstrap over the numbers.
    pub ends: [f64; 2],
    /// How many numbers.
    pub count: usize,
}

/// Median of sorted numbers: the mean of the middle two.
fn median(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    if n == 0 { f64::NAN } else { 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]) }
}

/// The median of finite numbers with its interval; NaN of none.
#[must_use]
pub fn median_of(values: &[f64]) -> Interval {
    let mut all: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    let mut source = Source::new(1);
    let mut medians: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let mut drawn: Vec<f64> =
                all.iter().map(|_| all[(source.unit() * all.len() as f64) as usize]).collect();
            drawn.sort_by(f64::total_cmp);
            median(&drawn)
        })
        .collect();
    medians.sort_by(f64::total_cmp);
    let at = |share: f64| medians[(share * (DRAWS - 1) as f64).round() as usize];
    Interval { median: median(&all), ends: [at(0.025), at(0.975)], count: all.len() }
}

/// The median of `by(a, b)` over the places where both have a number.
#[must_use]
pub fn paired(a: &[Option<f64>], b: &[Option<f64>], by: impl Fn(f64, f64) -> f64) -> Interval {
    let both = a.iter().zip(b).filter_map(|(a, b)| Some(by((*a)?, (*b)?)));
    median_of(&both.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_without_a_partner_do_not_count_and_an_offset_is_found_exactly() {
        let a: Vec<Option<f64>> = (0..20).map(|k| (k % 5 > 0).then_some(f64::from(k))).collect();
        let b: Vec<Option<f64>> = (0..20).map(|k| (k % 7 > 0).then_some(f64::from(k) + 2.0)).collect();
        let found = paired(&a, &b, |a, b| b - a);
        assert_eq!((found.median, found.ends, found.count), (2.0, [2.0, 2.0], 14));
    }

    #[test]
    fn the_interval_of_a_median_holds_it_in_about_95_percent_of_draws() {
        let mut source = Source::new(3);
        let holds = |_: &u32| {
            let drawn: Vec<f64> = (0..30).map(|_| source.normal()).collect();
            let Interval { ends, .. } = median_of(&drawn);
            ends[0] <= 0.0 && 0.0 <= ends[1]
        };
        let held = (0..20).filter(holds).count();
        assert!(held >= 17, "{held}");
    }
}
