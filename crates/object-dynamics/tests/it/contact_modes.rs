//! Modes of several contacts: agreement of formulations, invariants, and where rigid bodies have no answer.
