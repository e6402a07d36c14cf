use thiserror::Error;

/// Why there is no pose (any more).
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RollingError {
    /// Noise that is none.
    #[error("{what} is {value}; it must be finite and not negative")]
    Noise {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// A reading with a number that is none.
    #[error("reading {index} has a number that is not finite")]
    NotFinite {
        /// From 0.
        index: usize,
    },
    /// The upper palm is not above the lower one.
    #[error(
        "reading {index}: the upper palm is at {height} m above the lower one; it must be above it (is z up, and in m?)"
    )]
    Height {
        /// From 0.
        index: usize,
        /// As given, m.
        height: f64,
    },
    /// Readings that are too far apart.
    #[error(
        "between readings {before} and {index} the body turned by {turn:.3} rad; read more often, at least every {most} rad", before = index - 1
    )]
    Apart {
        /// Of the later one, from 1.
        index: usize,
        /// In rad.
        turn: f64,
        /// Largest turn between readings, rad.
        most: f64,
    },
    /// A contact slips, or noise is larger than stated.
    #[error(
        "by reading {index} the height of the upper palm is {by:.3e} m from where a body that rolls would have it, {deviations:.1} deviations: a contact slips, or the noise of contacts or palm is larger \
         than stated"
    )]
    Slipped {
        /// From 0.
        index: usize,
        /// By how much, m.
        by: f64,
        /// The same in standard deviations.
        deviations: f64,
    },
}
