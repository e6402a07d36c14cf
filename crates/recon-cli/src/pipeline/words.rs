//! Words that several results share.

/// What to say of bounds from contacts whose noise is `noise`, m, which hold at `confidence`.
pub(super) fn margins(noise: f64, confidence: f64) -> String {
    format!(
        "Contacts are noisy by {noise:.1e} m: the bounds have margins with which they hold at {:.0} % confidence.",
        100.0 * confidence
    )
}

/// A message as a sentence of its own.
pub(super) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let end = if text.ends_with(['.', '?', ')']) { "" } else { "." };
    format!("{first}{}{end}", letters.as_str())
}
