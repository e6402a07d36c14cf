//! Common Data Representation, in which ROS 2 stores messages: plain CDR of the first version (OMG DDS-XTypes 1.3, section
//! 7.4.3) in either byte order, and plain CDR of the second, which differs in that nothing is aligned to more than four bytes.

mod read;
mod write;

#[cfg(test)]
mod tests;

pub(super) use read::{Cdr, CdrError};
pub(super) use write::CdrWriter;

/// Bytes of the header that says the byte order.
const HEADER: usize = 4;
