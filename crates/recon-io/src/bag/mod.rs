//! Bags of ROS 2 in MCAP, which is how robots record: topics of different rates and clocks become the log in memory that a
//! CSV file gives, by a short mapping; results go back into a bag that viewers show.

mod cdr;
mod clock;
mod definition;
mod error;
mod frames;
mod inspect;
mod log;
mod mapping;
mod message;
mod palm;
mod read;
mod records;
mod result;
mod samples;
mod silences;
mod topic;

#[cfg(test)]
mod tests;

pub use error::{BagError, BagErrorKind, Unread};
pub use inspect::{BagOverview, TopicOverview, overview};
pub use log::{BagLog, PalmClock, clocks_of_bag, log_of_bag, palms_of};
pub use mapping::{
    BagMapping, BagUnits, ForceOn, JointTopic, MappingDraft, MappingError, MappingErrorKind, PalmTopics,
    Pitch, TaxelTopic, TaxelValue, TimeOf, TopicClock, draft_mapping,
};
pub use message::{BagTransform, Joint, MessageKind, Reading};
pub use read::{Bag, is_bag, parse_bag, read_bag};
pub use result::{ResultBag, ResultContact, ResultPose};
pub use silences::TopicGap;
pub use topic::{Message, Topic};
