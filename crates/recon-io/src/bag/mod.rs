//! Bags of ROS 2 in MCAP, which is how robots record: topics of different rates and clocks become the log in memory that a
//! CSV file gives, by a short mapping; results go back into a bag that viewers show.

mod cdr;
mod error;
mod message;
mod read;
mod records;
mod topic;

#[cfg(test)]
mod tests;

pub use error::{BagError, BagErrorKind, Unread};
pub use message::{BagTransform, Joint, MessageKind, Reading};
pub use read::{Bag, is_bag, parse_bag, read_bag};
pub use topic::{Message, Topic};
