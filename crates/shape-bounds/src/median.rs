//! The median, which a few outliers do not move.

/// Median of the absolute value of a standard normal: the scale of a median of absolute deviations.
pub(crate) const OF_NORMAL: f64 = 0.674_489_75;

/// The middle one of `values`, the upper of two; zero for none. Reorders them.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_one_is_found() {
        assert_eq!(median(&mut []), 0.0);
        assert_eq!(median(&mut [3.0]), 3.0);
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 3.0);
        assert_eq!(median(&mut [5.0, f64::INFINITY, 1.0, 2.0, 3.0]), 3.0);
    }
}
