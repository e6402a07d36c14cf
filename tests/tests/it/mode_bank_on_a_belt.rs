//! What a bank's odds are worth, over many runs of a body on a belt.
