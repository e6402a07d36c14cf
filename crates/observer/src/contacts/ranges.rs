//! Sums over ranges of samples, of whatever can be joined, by a tree of partial sums.
//!
//! A range is joined from twice the logarithm of its length of them. Differences of running sums would be one step, but keep the rounding of the
//! largest sample there was; here only what lies in a range has a part in its sum.

use std::ops::{Add, Range};

/// Partial sums: the samples are the second half, and each entry before is the sum of the two at twice its number.
pub(super) struct Ranges<T>(Vec<T>);

impl<T: Copy + Default + Add<Output = T>> Ranges<T> {
    pub(super) fn new(samples: &[T]) -> Self {
        let count = samples.len();
        let mut sums = vec![T::default(); count];
        sums.extend_from_slice(samples);
        for i in (1..count).rev() {
            sums[i] = sums[2 * i] + sums[2 * i + 1];
        }
        Self(sums)
    }

    /// Of the samples with these numbers, joined in their order.
    pub(super) fn sum(&self, range: Range<usize>) -> T {
        let count = self.0.len() / 2;
        let (mut from, mut to) = (range.start + count, range.end.min(count) + count);
        let (mut left, mut right) = (T::default(), T::default());
        while from < to {
            if from % 2 == 1 {
                left = left + self.0[from];
                from += 1;
            }
            if to % 2 == 1 {
                to -= 1;
                right = self.0[to] + right;
            }
            (from, to) = (from / 2, to / 2);
        }
        left + right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sample_of_a_range_is_in_its_sum_once_and_no_other() {
        for count in 0..40_u32 {
            // A bit for each sample: sums of them tell which are in.
            let samples: Vec<u64> = (0..count).map(|i| 1 << i).collect();
            let ranges = Ranges::new(&samples);
            for from in 0..samples.len() {
                for to in from..=samples.len() {
                    assert_eq!(
                        ranges.sum(from..to),
                        samples[from..to].iter().sum::<u64>(),
                        "{count} {from} {to}"
                    );
                }
            }
        }
        assert_eq!(Ranges::<u64>::new(&[]).sum(0..0), 0);
    }

    #[test]
    fn what_is_beside_a_range_leaves_no_trace() {
        let samples: Vec<f64> = (0..1000).map(|k| if k == 500 { f64::INFINITY } else { 0.1 }).collect();
        let ranges = Ranges::new(&samples);
        assert!((ranges.sum(0..500) - 50.0).abs() < 1e-12 && (ranges.sum(501..601) - 10.0).abs() < 1e-13);
        assert_eq!(ranges.sum(400..501), f64::INFINITY);
    }
}
