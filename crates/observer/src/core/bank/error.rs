//! Why a bank cannot be set up, or cannot take a sample.

use thiserror::Error;

/// Why a bank of modes cannot be set up, or cannot take a sample. Modes and samples are counted from zero. A bank that
/// refuses a sample stays as it was before.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BankError {
    /// There is no mode.
    #[error("the bank has no member; give at least one mode")]
    NoMember,
    /// Something has not the size that it needs.
    #[error("{what} of mode {mode} has {found} entries; it must have {needed}")]
    Size {
        /// What it is.
        what: &'static str,
        /// The mode.
        mode: usize,
        /// As given.
        found: usize,
        /// As needed.
        needed: usize,
    },
    /// A member predicts another number of outputs than the first one: odds are only defined over the same outputs.
    #[error(
        "mode {mode} predicts {found} output(s), mode 0 predicts {needed}: every mode must give the density of the same \
         outputs; let it supply one for each, or leave the output out for all"
    )]
    Outputs {
        /// The mode.
        mode: usize,
        /// Its outputs.
        found: usize,
        /// Those of the first mode.
        needed: usize,
    },
    /// A sample has another number of outputs than the members predict.
    #[error(
        "sample {sample} has {found} output(s), the modes predict {needed}; mark one that is missing as none"
    )]
    Readings {
        /// The sample.
        sample: usize,
        /// Its outputs.
        found: usize,
        /// Those predicted.
        needed: usize,
    },
    /// Probabilities do not sum to one within 1e-9.
    #[error("{what} sum to {sum}; they must sum to one within 1e-9")]
    Sum {
        /// Which ones.
        what: &'static str,
        /// Their sum.
        sum: f64,
    },
    /// The probabilities of where a mode goes do not sum to one within 1e-9.
    #[error(
        "the probabilities to go from mode {mode} to each mode sum to {sum}; they must sum to one within 1e-9"
    )]
    RowSum {
        /// The mode.
        mode: usize,
        /// Their sum.
        sum: f64,
    },
    /// A number is not usable.
    #[error("{what} is {value}; it must be {needed}")]
    Value {
        /// What the number is.
        what: &'static str,
        /// As given.
        value: f64,
        /// What it has to be.
        needed: &'static str,
    },
    /// Switches between modes of unequal size have no map.
    #[error(
        "modes {from} and {to} have {from_states} and {to_states} states; state what becomes of the state at a switch \
         (`Modes::with_jump`), or give the switch probability zero"
    )]
    NoJump {
        /// Mode before the switch.
        from: usize,
        /// Mode after it.
        to: usize,
        /// States before.
        from_states: usize,
        /// States after.
        to_states: usize,
    },
    /// A map between modes does not fit their states.
    #[error(
        "the jump from mode {from} to mode {to} leads from {found:?} states; these modes have {needed:?} (before, after)"
    )]
    Jump {
        /// Mode before the switch.
        from: usize,
        /// Mode after it.
        to: usize,
        /// States before and after that it maps.
        found: (usize, usize),
        /// States before and after that the modes have.
        needed: (usize, usize),
    },
    /// A map for a mode that stays as it is.
    #[error(
        "mode {mode} was given a jump to itself; a mode that stays keeps its state, so put it into the flow"
    )]
    Stays {
        /// The mode.
        mode: usize,
    },
    /// There is no such mode.
    #[error("there is no mode {mode}; the modes are numbered from 0 to {last}")]
    NoMode {
        /// As given.
        mode: usize,
        /// Number of the last one.
        last: usize,
    },
    /// Too few hypotheses to keep one for each mode.
    #[error("{found} hypotheses are to be kept; it takes at least one for each of the {needed} modes")]
    Hypotheses {
        /// As given.
        found: usize,
        /// Number of modes.
        needed: usize,
    },
    /// A covariance is not symmetric and positive definite.
    #[error(
        "the covariance of mode {mode} at sample {sample} is not symmetric and positive definite; check its start, its jumps and its noise"
    )]
    Covariance {
        /// The mode.
        mode: usize,
        /// The sample.
        sample: usize,
    },
    /// What was given or computed is not finite.
    #[error(
        "the {what} of entry or mode {mode} at sample {sample} is not finite; leave it out, or scale the quantities"
    )]
    NotFinite {
        /// What it is.
        what: &'static str,
        /// The mode, or the output for a reading.
        mode: usize,
        /// The sample.
        sample: usize,
    },
    /// No mode explains a sample at all.
    #[error(
        "no mode gives sample {sample} any likelihood; leave it out as an outlier, or add a mode that allows for it"
    )]
    NoLikelihood {
        /// The sample.
        sample: usize,
    },
}
