//! Noise that is the same on every machine.

/// A standard normal generator, the same on every machine: splitmix64 and the Box-Muller transform.
#[derive(Default)]
pub(crate) struct Normal {
    state: u64,
    /// The other of the two that each transform gives.
    spare: Option<f64>,
}

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        // In (0, 1]: the logarithm below needs it.
        (((z ^ (z >> 31)) >> 11) + 1) as f64 / (1u64 << 53) as f64
    }

    /// A generator of its own sequence for each seed.
    pub(crate) fn seeded(seed: u64) -> Self {
        Self { state: seed, spare: None }
    }

    pub(crate) fn draw(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let (a, b) = (self.uniform(), self.uniform());
        let (length, (sin, cos)) = ((-2.0 * a.ln()).sqrt(), (std::f64::consts::TAU * b).sin_cos());
        self.spare = Some(length * sin);
        length * cos
    }
}
