//! What cannot be simulated is named.

use super::*;
