//! One mode to act on, from odds that change at every sample.

use super::error::BankError;

/// The mode that someone acts on who needs one: it changes only when another mode is more likely than a level, so that odds
/// near one half do not make it flutter. A level of 0.7 to 0.8 removes nearly all flutter for some samples of delay; 0.99
/// misses switches. What is said to others should be the probabilities.
///
/// ```
/// # fn main() -> Result<(), observer::bank::BankError> {
/// let mut label = observer::bank::ModeLabel::new(0.75)?;
/// let told = [[0.9, 0.1], [0.45, 0.55], [0.3, 0.7], [0.2, 0.8], [0.6, 0.4]].map(|odds| label.follow(odds));
/// assert_eq!(told, [0, 0, 0, 1, 1]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ModeLabel {
    level: f64,
    mode: Option<usize>,
}

impl ModeLabel {
    /// A label that changes at this probability, from 0.5 to below 1.
    ///
    /// # Errors
    /// [`BankError::Value`] for any other.
    pub fn new(level: f64) -> Result<Self, BankError> {
        if (0.5..1.0).contains(&level) {
            Ok(Self { level, mode: None })
        } else {
            Err(BankError::Value { what: "level of the label", value: level, needed: "from 0.5 to below 1" })
        }
    }

    /// Takes the probability of each mode, and returns the label: at first the likeliest mode.
    pub fn follow(&mut self, probabilities: impl IntoIterator<Item = f64>) -> usize {
        let likeliest = probabilities.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let (mode, probability) = likeliest.unwrap_or((0, 0.0));
        let label = self.mode.get_or_insert(mode);
        if probability > self.level {
            *label = mode;
        }
        *label
    }
}
