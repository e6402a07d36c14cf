//! The modes of a system, how likely each follows which, and what a switch does to the state.

use super::error::BankError;
use super::gaussian::Gaussian;
use super::jump::Jump;
use super::member::Member;

/// Probabilities must sum to one this exactly.
const SUM: f64 = 1e-9;

/// Fills a row of switch probabilities from the state in a mode and the input of the interval that follows.
type Rates<I> = Box<dyn Fn(&Gaussian, &I, &mut [f64]) + Send>;

/// The modes of a system and the switches between them: all that does not change with the data.
pub struct Modes<I> {
    members: Vec<Box<dyn Member<I>>>,
    /// Logarithms of the switch probabilities, row by row; minus infinity where there is no switch.
    log_switches: Vec<f64>,
    /// By row; none where states are copied.
    jumps: Vec<Option<Box<dyn Jump<I>>>>,
    /// By mode; none where the row is that of the table.
    rates: Vec<Option<Rates<I>>>,
}

impl<I> Modes<I> {
    /// Modes with the probabilities `switches[from][to]` of mode `to` at a sample when it was `from` at the one before. Keep
    /// every switch that can happen above zero: a mode that was given up comes back through it. Between modes of the same size
    /// states are copied unless [`Self::with_jump`] says otherwise.
    ///
    /// # Errors
    /// [`BankError::NoMember`]; [`BankError::Outputs`] for members that predict different numbers of outputs;
    /// [`BankError::Size`] for a table of the wrong size; [`BankError::Value`] and [`BankError::RowSum`] for rows that are no
    /// probabilities.
    pub fn new(members: Vec<Box<dyn Member<I>>>, switches: &[&[f64]]) -> Result<Self, BankError> {
        let count = members.len();
        let outputs = members.first().ok_or(BankError::NoMember)?.outputs();
        if let Some(mode) = members.iter().position(|m| m.outputs() != outputs) {
            return Err(BankError::Outputs { mode, found: members[mode].outputs(), needed: outputs });
        }
        let log_switches = log_switches(count, switches)?;
        let jumps = (0..count * count).map(|_| None).collect();
        Ok(Self { members, log_switches, jumps, rates: (0..count).map(|_| None).collect() })
    }

    /// With a map of states for the switch from one mode to another.
    ///
    /// # Errors
    /// [`BankError::NoMode`] for a mode that there is not; [`BankError::Stays`] for one from a mode to itself;
    /// [`BankError::Jump`] for a map that does not fit their states.
    pub fn with_jump(mut self, from: usize, to: usize, jump: Box<dyn Jump<I>>) -> Result<Self, BankError> {
        let count = self.members.len();
        if let Some(mode) = [from, to].into_iter().find(|m| *m >= count) {
            return Err(BankError::NoMode { mode, last: count - 1 });
        }
        if from == to {
            return Err(BankError::Stays { mode: from });
        }
        let (found, needed) = (jump.sizes(), (self.members[from].states(), self.members[to].states()));
        if found != needed {
            return Err(BankError::Jump { from, to, found, needed });
        }
        self.jumps[from * count + to] = Some(jump);
        Ok(self)
    }

    /// With probabilities of the switches from one mode that depend on its state and on the input of the interval that follows:
    /// `rates` fills the row. Where the table has a zero it must too.
    ///
    /// This is the place of a condition that one mode has and others have not, such as that nothing slides while it sticks: as an
    /// output of that mode alone it would make odds depend on its unit. As a probability to switch of
    /// `h exp(-|s|^2 / (2 c^2))` at a slip `s` it is a number, and its mean over a Gaussian slip with mean `m` and covariance
    /// `P`, of `d` components, is `h (2 pi)^(d / 2) c^d N(m; 0, P + c^2)`. What the switch says of the state belongs into the jump.
    ///
    /// # Errors
    /// [`BankError::NoMode`] for a mode that there is not. Rows that are no probabilities are errors of [`Bank::push`](crate::bank::Bank::push).
    pub fn with_rates(
        mut self,
        from: usize,
        rates: impl Fn(&Gaussian, &I, &mut [f64]) + Send + 'static,
    ) -> Result<Self, BankError> {
        let last = self.members.len() - 1;
        *self.rates.get_mut(from).ok_or(BankError::NoMode { mode: from, last })? = Some(Box::new(rates));
        Ok(self)
    }

    /// Number of modes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.members.len()
    }

    /// Number of outputs that every mode predicts.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.members.first().map_or(0, |m| m.outputs())
    }

    /// A switch that can happen between states of unequal size needs a map.
    pub(super) fn check_jumps(&self) -> Result<(), BankError> {
        for from in 0..self.count() {
            for to in 0..self.count() {
                let (from_states, to_states) = (self.members[from].states(), self.members[to].states());
                let mapped = from_states == to_states || self.jump(from, to).is_some();
                if !mapped && self.log_switch(from, to) > f64::NEG_INFINITY {
                    return Err(BankError::NoJump { from, to, from_states, to_states });
                }
            }
        }
        Ok(())
    }

    pub(super) fn member(&self, mode: usize) -> &dyn Member<I> {
        &*self.members[mode]
    }

    fn log_switch(&self, from: usize, to: usize) -> f64 {
        self.log_switches[from * self.count() + to]
    }

    /// Logarithms of the probabilities to go from a mode in this state to each mode.
    pub(super) fn log_row(
        &self,
        from: usize,
        state: &Gaussian,
        input: &I,
        row: &mut [f64],
    ) -> Result<(), BankError> {
        let count = self.count();
        let table = &self.log_switches[from * count..(from + 1) * count];
        let Some(rates) = &self.rates[from] else {
            row.copy_from_slice(table);
            return Ok(());
        };
        row.fill(0.0);
        rates(state, input, row);
        check_row(from, row)?;
        if let Some(to) = (0..count).find(|&to| row[to] > 0.0 && table[to] == f64::NEG_INFINITY) {
            let what = "rate of a switch that the table excludes";
            return Err(BankError::Value {
                what,
                value: row[to],
                needed: "zero, or the table's entry above zero",
            });
        }
        row.iter_mut().for_each(|p| *p = p.ln());
        Ok(())
    }

    pub(super) fn jump(&self, from: usize, to: usize) -> Option<&dyn Jump<I>> {
        self.jumps[from * self.count() + to].as_deref()
    }

    /// Mean and covariance in mode `to` of what was in mode `from`.
    pub(super) fn land(&self, from: usize, to: usize, state: &Gaussian, input: &I, landed: &mut Gaussian) {
        match self.jump(from, to) {
            Some(jump) => jump.land(state, input, landed),
            None => landed.copy_from(state),
        }
    }
}

fn check_row(mode: usize, row: &[f64]) -> Result<(), BankError> {
    check_sum("switch probability", row.iter().copied()).map_err(|error| match error {
        BankError::Sum { sum, .. } => BankError::RowSum { mode, sum },
        other => other,
    })
}

/// Logarithms of the switch probabilities, row by row.
pub(super) fn log_switches(count: usize, switches: &[&[f64]]) -> Result<Vec<f64>, BankError> {
    if switches.len() != count {
        let what = "table of switches (its rows)";
        return Err(BankError::Size { what, mode: 0, found: switches.len(), needed: count });
    }
    for (mode, row) in switches.iter().enumerate() {
        if row.len() != count {
            let what = "row of switch probabilities";
            return Err(BankError::Size { what, mode, found: row.len(), needed: count });
        }
        check_row(mode, row)?;
    }
    Ok(switches.iter().flat_map(|row| row.iter().map(|p| p.ln())).collect())
}

/// Probabilities: each from zero to one, all together one.
pub(super) fn check_sum(
    what: &'static str,
    probabilities: impl Iterator<Item = f64>,
) -> Result<(), BankError> {
    let mut sum = 0.0;
    for value in probabilities {
        if !(0.0..=1.0 + SUM).contains(&value) {
            return Err(BankError::Value { what, value, needed: "from zero to one" });
        }
        sum += value;
    }
    // Written so that a sum that is no number does not pass.
    if (sum - 1.0).abs() <= SUM { Ok(()) } else { Err(BankError::Sum { what, sum }) }
}
