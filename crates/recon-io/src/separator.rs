//! Tables whose fields something else than commas separates, as spreadsheets write them where the comma is a decimal point.

/// What to say of a header in which a column is missing; nothing where commas separate it.
pub(crate) fn advice(found: &str) -> &'static str {
    match (found.contains(','), found.contains(';'), found.contains('\t')) {
        (false, true, _) => {
            "; separate fields by commas instead of semicolons, and write decimals with a point"
        }
        (false, _, true) => "; separate fields by commas instead of tabs",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_separators_are_named() {
        assert_eq!(advice("t, s1_1"), "");
        assert_eq!(advice("t"), "");
        assert!(advice("t;s1_1").contains("semicolons"));
        assert!(advice("t\ts1_1").contains("tabs"));
    }
}
