//! Some hundred changes of modes, seeded.
