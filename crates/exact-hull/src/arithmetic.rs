//! Sums and products that keep their digits where plain ones lose them; rounded, in contrast to [`crate::predicates`].

pub use crate::integrals::Compensated;
pub use crate::twofold::cross_of_differences;
