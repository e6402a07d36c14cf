//! Rows of CSV (RFC 4180): ten lines that need no crate.

/// One row with its line end; cells are quoted where they must be.
pub(super) fn row<const N: usize>(cells: [&str; N]) -> String {
    cells.map(quoted).join(",") + "\n"
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

/// The shortest decimal that reads back as the same number.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_with_commas_and_quotes_are_quoted() {
        assert_eq!(row(["a", "b,c", "say \"d\""]), "a,\"b,c\",\"say \"\"d\"\"\"\n");
    }

    #[test]
    fn numbers_read_back_unchanged() {
        for value in [0.1, 1.0 / 3.0, -2.5e-17, 6.02e23, 0.0, 1e-3, 1e6, f64::MIN_POSITIVE] {
            assert_eq!(number(value).parse(), Ok(value));
        }
    }
}
