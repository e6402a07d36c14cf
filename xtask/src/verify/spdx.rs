//! Licence expressions (SPDX, annex D): `AND` binds tighter than `OR`, `WITH` tighter than both.

/// Whether the licences in `allowed` are enough to use something under this expression.
///
/// The slash of old manifests (`MIT/Apache-2.0`) is read as `OR`; a licence with an exception is a licence of its own
/// (`Apache-2.0 WITH LLVM-exception`). An error says what is wrong with the expression.
pub(crate) fn is_allowed(expression: &str, allowed: &[&str]) -> Result<bool, String> {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let mut words = spaced.split_whitespace().peekable();
    let verdict = any(&mut words, allowed)?;
    match words.next() {
        None => Ok(verdict),
        Some(word) => Err(format!("{word:?} is not expected there")),
    }
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

fn any(words: &mut Words, allowed: &[&str]) -> Result<bool, String> {
    let mut verdict = all(words, allowed)?;
    while words.next_if_eq(&"OR").is_some() {
        verdict |= all(words, allowed)?;
    }
    Ok(verdict)
}

fn all(words: &mut Words, allowed: &[&str]) -> Result<bool, String> {
    let mut verdict = one(words, allowed)?;
    while words.next_if_eq(&"AND").is_some() {
        verdict &= one(words, allowed)?;
    }
    Ok(verdict)
}

fn one(words: &mut Words, allowed: &[&str]) -> Result<bool, String> {
    match words.next() {
        Some("(") => {
            let verdict = any(words, allowed)?;
            words.next_if_eq(&")").map(|_| verdict).ok_or_else(|| "a bracket is not closed".to_owned())
        }
        None | Some(")" | "OR" | "AND" | "WITH") => Err("a licence is missing".to_owned()),
        Some(licence) => {
            if words.next_if_eq(&"WITH").is_none() {
                return Ok(allowed.contains(&licence));
            }
            let exception = words.next().ok_or("WITH lacks its exception")?;
            Ok(allowed.contains(&format!("{licence} WITH {exception}").as_str()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(expression: &str) -> Option<bool> {
        is_allowed(expression, &["MIT", "Apache-2.0", "Unicode-3.0"]).ok()
    }

    #[test]
    fn one_side_of_or_is_enough_and_both_of_and_are_needed() {
        assert_eq!(verdict("MIT"), Some(true));
        assert_eq!(verdict("GPL-3.0-only"), Some(false));
        assert_eq!(verdict("GPL-3.0-only OR MIT"), Some(true));
        assert_eq!(verdict("GPL-3.0-only AND MIT"), Some(false));
        assert_eq!(verdict("MIT/GPL-3.0-only"), Some(true));
    }

    #[test]
    fn and_binds_tighter_than_or_unless_brackets_say_otherwise() {
        assert_eq!(verdict("MIT OR Apache-2.0 AND GPL-3.0-only"), Some(true));
        assert_eq!(verdict("(MIT OR Apache-2.0) AND GPL-3.0-only"), Some(false));
        assert_eq!(verdict("(MIT OR Apache-2.0) AND Unicode-3.0"), Some(true));
        assert_eq!(verdict("(MIT OR (GPL-2.0 AND X)) AND (Y OR Unicode-3.0)"), Some(true));
    }

    #[test]
    fn an_exception_makes_another_licence() {
        assert_eq!(verdict("Apache-2.0 WITH LLVM-exception"), Some(false));
        assert_eq!(verdict("Apache-2.0 WITH LLVM-exception OR MIT"), Some(true));
        assert_eq!(is_allowed("A WITH B", &["A WITH B"]), Ok(true));
    }

    #[test]
    fn broken_expressions_are_errors() {
        for expression in ["", "MIT OR", "(MIT", "MIT)", "AND MIT", "MIT Apache-2.0", "MIT WITH", "()"] {
            assert_eq!(verdict(expression), None, "{expression:?}");
        }
    }
}
