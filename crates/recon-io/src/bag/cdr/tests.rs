use super::{Cdr, CdrError, CdrWriter};
use proptest::prelude::*;

/// All that messages have, in an order that needs every kind of alignment.
fn written(mut to: CdrWriter, text: &str, values: &[f64]) -> Vec<u8> {
    to.u8(7).i32(-2).u8(1).f64(0.1).text(text).f32(1.5).count(values.len()).f64s(values).u8(3);
    to.into_bytes()
}

fn check(bytes: &[u8], text: &str, values: &[f64]) {
    let mut from = Cdr::new(bytes).unwrap();
    assert_eq!((from.u8("a"), from.i32("b"), from.u8("c"), from.f64("d")), (Ok(7), Ok(-2), Ok(1), Ok(0.1)));
    assert_eq!((from.text("e"), from.f32("f")), (Ok(text), Ok(1.5)));
    assert_eq!(from.count(8, "g"), Ok(values.len()));
    for value in values {
        assert_eq!(from.f64("h").unwrap().to_bits(), value.to_bits());
    }
    assert_eq!((from.u8("i"), from.end()), (Ok(3), Ok(())));
}

proptest! {
    #[test]
    fn both_byte_orders_read_back(text in "\\PC{0,20}", values in proptest::collection::vec(proptest::num::f64::ANY, 0..5)) {
        check(&written(CdrWriter::new(), &text, &values), &text, &values);
        check(&written(CdrWriter::big_endian(), &text, &values), &text, &values);
    }
}

/// Bytes as an independent encoder (`mcap-ros2-support` 0.6.0) wrote a PointStamped.
#[test]
fn bytes_of_another_encoder_are_read() {
    let hex = "000100000078e768000000000700000070616c6d5f31000000000000b343dcdf0301ca3c142764ee4f5b11400000000000000000";
    let bytes: Vec<u8> =
        (0..hex.len()).step_by(2).map(|k| u8::from_str_radix(&hex[k..k + 2], 16).unwrap()).collect();
    let mut from = Cdr::new(&bytes).unwrap();
    assert_eq!(
        (from.i32("sec"), from.u32("nanosec"), from.text("frame")),
        (Ok(1_760_000_000), Ok(0), Ok("palm_1"))
    );
    assert_eq!(from.f64s("point"), Ok([7.217_550_271_19e-16, 4.339_172_100_89, 0.0]));
    assert_eq!(from.end(), Ok(()));
}

/// In the second version of CDR numbers of eight bytes are aligned to four.
#[test]
fn version_two_aligns_to_four() {
    let mut bytes = vec![0, 7, 0, 0, 9, 0, 0, 0];
    bytes.extend(2.5_f64.to_le_bytes());
    let mut from = Cdr::new(&bytes).unwrap();
    assert_eq!((from.u32("a"), from.f64("b"), from.end()), (Ok(9), Ok(2.5), Ok(())));
}

#[test]
fn what_is_no_message_says_why_and_where() {
    for bytes in [&[][..], &[0, 1, 0], &[0, 2, 0, 0], &[1, 1, 0, 0]] {
        assert!(matches!(Cdr::new(bytes), Err(CdrError::Representation { .. })), "{bytes:?}");
    }
    let mut short = Cdr::new(&[0, 1, 0, 0, 1, 2]).unwrap();
    assert_eq!(short.f64("x"), Err(CdrError::Ends { place: 4, what: "x", needed: 8, left: 2 }));
    let no_end = [0, 1, 0, 0, 2, 0, 0, 0, b'a', b'b'];
    let fault = "does not end in a zero byte";
    assert_eq!(Cdr::new(&no_end).unwrap().text("t"), Err(CdrError::Text { place: 8, fault }));
    let not_text = [0, 1, 0, 0, 2, 0, 0, 0, 0xff, 0];
    assert_eq!(
        Cdr::new(&not_text).unwrap().text("t"),
        Err(CdrError::Text { place: 8, fault: "is not UTF-8" })
    );
    assert_eq!(Cdr::new(&[0, 1, 0, 0, 0, 0, 0, 0]).unwrap().text("t"), Ok(""));
    // A sequence of four thousand million elements of which there is none.
    let many = Cdr::new(&[0, 1, 0, 0, 255, 255, 255, 255]).unwrap().count(24, "s");
    assert_eq!(many, Err(CdrError::Ends { place: 8, what: "s", needed: 24 * 0xffff_ffff, left: 0 }));
    assert_eq!(Cdr::new(&[0, 1, 0, 0, 0, 0, 0, 0]).unwrap().end(), Err(CdrError::Goes { place: 4, left: 4 }));
}
