//! How numbers are printed: exactly in data files, briefly for people.

use std::fmt::Write as _;

/// Longest text that a number has in full: `-1.7976931348623157e308` and its like, and a few more.
const LONGEST: usize = 25;

/// `value` for people, to six significant digits and in twelve characters at most.
#[must_use]
pub fn brief(value: f64) -> String {
    brief_to(6, value)
}

/// `value` for people, to at most so many significant digits, six of them in twelve characters at most: plain between 1e-4
/// and 1e6, else with an exponent; digits before the point are never rounded away.
#[must_use]
pub fn brief_to(digits: usize, value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return if value.is_nan() { "nan".to_owned() } else { format!("{}", value + 0.0) };
    }
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (1e-4..1e6).contains(&size) {
        let before = [10.0, 100.0, 1e3, 1e4, 1e5].iter().filter(|power| size >= **power).count();
        let zeros = [1.0, 0.1, 0.01, 1e-3].iter().filter(|power| size < **power).count();
        return trimmed(&format!("{value:.*}", (digits + zeros).saturating_sub(before + 1)));
    }
    let text = format!("{value:.*e}", digits.clamp(1, 5) - 1);
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
        None => text,
    }
}

/// `text` with every number that is written out in more digits than it has, as `{}` writes 1e300, made brief.
#[must_use]
pub fn with_brief_numbers(text: &str) -> String {
    let belongs = |c: char| c.is_ascii_digit() || c == '.';
    let mut brief_text = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, from) = rest.split_at(start);
        let (number, after) = from.split_at(from.find(|c| !belongs(c)).unwrap_or(from.len()));
        // The end of a sentence is no part of its last number.
        let digits = number.trim_end_matches('.');
        let value = (digits.len() > LONGEST).then(|| digits.parse().ok()).flatten();
        brief_text += before;
        brief_text += &value.map_or_else(|| digits.to_owned(), brief);
        brief_text += &number[digits.len()..];
        rest = after;
    }
    brief_text + rest
}

/// The shortest decimal that reads back as the same `f64`; `nan`, `inf` and `-inf` where there is no number.
pub(crate) fn exact(value: f64) -> String {
    let mut text = String::new();
    push_exact(&mut text, value);
    text
}

/// Appends the same.
pub(crate) fn push_exact(text: &mut String, value: f64) {
    let mut buffer = zmij::Buffer::new();
    let _ = match value.abs() {
        // Beyond these exponents are written otherwise there.
        size if (1e-4..1e16).contains(&size) => text.write_str(buffer.format_finite(value)),
        _ if value.is_nan() => text.write_str("nan"),
        _ => write!(text, "{value:?}"),
    };
}

/// Appends some of them, with commas between.
pub(crate) fn push_row(text: &mut String, values: &[f64]) {
    for (place, value) in values.iter().enumerate() {
        if place > 0 {
            text.push(',');
        }
        push_exact(text, *value);
    }
}

/// Appends `value` as `{}` writes it: of tenths, which places on a screen are, several times as fast.
pub(crate) fn push(text: &mut String, value: f64) {
    let tenths = (10.0 * value).round();
    let is_plain =
        tenths.abs() < MOST_TENTHS && tenths / 10.0 == value && (value != 0.0 || value.is_sign_positive());
    if !is_plain {
        let _ = write!(text, "{value}");
        return;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole, not negative, below the limit"
    )]
    let mut left = tenths.abs() as u64;
    let mut digits = [0; 16];
    let mut from = digits.len();
    let mut place = |digit: u8| {
        from -= 1;
        digits[from] = digit;
    };
    if !left.is_multiple_of(10) {
        place(b'0' + (left % 10) as u8);
        place(b'.');
    }
    left /= 10;
    loop {
        place(b'0' + (left % 10) as u8);
        left /= 10;
        if left == 0 {
            break;
        }
    }
    if value < 0.0 {
        text.push('-');
    }
    text.extend(digits[from..].iter().map(|&digit| char::from(digit)));
}

/// Up to here tenths are told apart by their shortest decimals, and fit.
const MOST_TENTHS: f64 = 1e14;

/// Appends two numbers with something between them.
pub(crate) fn push_pair(text: &mut String, [x, y]: [f64; 2], between: char) {
    push(text, x);
    text.push(between);
    push(text, y);
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rounding_keeps_what_a_picture_needs() {
        assert_eq!(on_scale(1.234_567, 2.5, 4), 1.2346);
        assert_eq!(on_scale(-1e-9, 2.5, 4), 0.0);
        assert!(on_scale(f64::NAN, 1.0, 3).is_nan());
    }

    #[test]
    fn people_read_few_digits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (4.2, "4.2"),
            (13.205_290_1, "13.2053"),
            (1.2588, "1.2588"),
            (-0.000_123_456_78, "-0.000123457"),
            (999_999.96, "1000000"),
            (123_456.7, "123457"),
            (1e6, "1e6"),
            (-1.234_567e-300, "-1.2346e-300"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, "nan"),
        ] {
            assert_eq!(brief(value), text);
        }
        assert_eq!([28.6, 1234.0, -8.21, 3e300].map(|v| brief_to(2, v)), ["29", "1234", "-8.2", "3e300"]);
        let text = format!("{} samples up to t = {} s, {}.", 12, 1.5e300, -1e-40);
        assert_eq!(with_brief_numbers(&text), "12 samples up to t = 1.5e300 s, -1e-40.");
        let untouched = "run-20261122094510.csv: 0.1 + 0.2 = 0.30000000000000004; 127.0.0.1";
        assert_eq!(with_brief_numbers(untouched), untouched);
    }

    proptest! {
        #[test]
        fn no_number_for_people_is_long_or_wrong(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            for text in [brief(value), brief(value % 1e6)] {
                prop_assert!(text.len() <= 12, "{text}");
            }
            if value.is_finite() {
                let back: f64 = brief(value).parse().unwrap();
                // Five digits at least.
                prop_assert!((back - value).abs() <= 5.1e-5 * value.abs(), "{value:e} {back:e}");
            }
            let sentence = with_brief_numbers(&format!("from {value} to {value:.6}."));
            prop_assert!(sentence.split(' ').all(|word| word.len() <= LONGEST + 2), "{sentence}");
        }

        #[test]
        fn what_is_pushed_is_what_is_displayed(bits in any::<u64>(), tenths in -2_000_000_000_000_000_i64..2_000_000_000_000_000, small in -99_999..99_999) {
            let value = f64::from_bits(bits);
            let tenths = [tenths, i64::from(small)].map(|tenths| tenths as f64 / 10.0);
            for value in [value, value % 1e4, on_scale(value % 1e4, 100.0, 3), 0.0, -0.0, tenths[0], tenths[1]] {
                let mut text = String::new();
                push(&mut text, value);
                prop_assert_eq!(text, value.to_string());
            }
        }

        #[test]
        fn exact_reads_back_and_is_as_long_as_what_is_debugged(bits in any::<u64>(), near in -20.0_f64..20.0) {
            for value in [f64::from_bits(bits), 10_f64.powf(near), -10_f64.powf(near), 10_f64.powi(near as i32), near.round()] {
                let back: f64 = exact(value).parse().unwrap();
                prop_assert!(back.to_bits() == value.to_bits() || (back.is_nan() && value.is_nan()));
                // Of two decimals as near the one or the other is written.
                let form = |text: String| (text.len(), text.contains('e'));
                prop_assert!(form(exact(value)) == form(format!("{value:?}")), "{} {value:?}", exact(value));
            }
        }
    }
}
