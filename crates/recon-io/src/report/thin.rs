//! Which of many samples a curve shows.

/// Most times that a curve holds: about one per two pixels of a wide screen.
const MOST_TIMES: usize = 700;

/// At most [`MOST_TIMES`] indices spread evenly over `0..count`, with the first and the last.
pub(super) fn thin(count: usize) -> Vec<usize> {
    if count <= MOST_TIMES {
        return (0..count).collect();
    }
    (0..MOST_TIMES).map(|k| (k * (count - 1) + (MOST_TIMES - 1) / 2) / (MOST_TIMES - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends_and_order() {
        for count in [2, 699, 700, 701, 4201, 1_000_000] {
            let keep = thin(count);
            assert_eq!((keep[0], keep[keep.len() - 1]), (0, count - 1));
            assert!(keep.len() <= MOST_TIMES && keep.windows(2).all(|w| w[0] < w[1]));
        }
    }
}
