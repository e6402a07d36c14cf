//! How numbers are printed: exactly in data files, briefly in reports.

/// The shortest decimal that reads back as the same `f64`; `nan`, `inf` and `-inf` where there is no number.
pub(crate) fn exact(value: f64) -> String {
    if value.is_nan() { "nan".to_owned() } else { format!("{value:?}") }
}

/// `value` rounded to a multiple of the power of ten that lies `digits` below `scale`: for pictures, where a
/// number stands for a place on a screen.
pub(crate) fn on_scale(value: f64, scale: f64, digits: i32) -> f64 {
    if !value.is_finite() || scale.is_nan() || scale <= 0.0 {
        return value;
    }
    #[expect(clippy::cast_possible_truncation, reason = "the exponent of an f64 lies within +-324")]
    let places = digits - scale.log10().floor() as i32;
    // A negative power of ten is not exact in binary; a quotient of the exact positive one is rounded once.
    let unit = 10.0_f64.powi(places.abs());
    let rounded = if places >= 0 { (value * unit).round() / unit } else { (value / unit).round() * unit };
    if rounded.is_finite() { rounded + 0.0 } else { value }
}

/// `value` rounded to `digits` significant digits.
pub(crate) fn significant(value: f64, digits: i32) -> f64 {
    on_scale(value, value.abs(), digits - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rounding_keeps_what_a_picture_needs() {
        assert_eq!(on_scale(1.234_567, 2.5, 4), 1.2346);
        assert_eq!(on_scale(-1e-9, 2.5, 4), 0.0);
        assert!(on_scale(f64::NAN, 1.0, 3).is_nan());
        assert_eq!(significant(0.000_123_456, 3), 0.000_123);
        assert_eq!(significant(123_456.0, 3), 123_000.0);
        assert_eq!(significant(0.0, 3), 0.0);
    }

    proptest! {
        #[test]
        fn exact_reads_back(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            let back: f64 = exact(value).parse().unwrap();
            prop_assert!(back.to_bits() == value.to_bits() || (back.is_nan() && value.is_nan()));
        }
    }
}
