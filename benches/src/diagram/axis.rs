//! Axes: what is drawn, in which unit, on which scale.

/// Spacing of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal distances are equal ratios; holds positive values only.
    Log,
    /// Equal distances are equal differences.
    Linear,
}

/// One axis of a diagram: a quantity, its unit (as printed in brackets) and its scale.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) scale: Scale,
}

impl Axis {
    /// A logarithmic axis, e.g. `Axis::log("pose error", "m")`.
    #[must_use]
    pub fn log(quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { quantity: quantity.into(), unit: unit.into(), scale: Scale::Log }
    }

    /// A linear axis, e.g. `Axis::linear("slope of palm 3", "deg")`.
    #[must_use]
    pub fn linear(quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { quantity: quantity.into(), unit: unit.into(), scale: Scale::Linear }
    }

    /// `quantity [unit]`, or the quantity alone for a number without unit (`""` or `"1"`).
    #[must_use]
    pub fn label(&self) -> String {
        match self.unit.as_str() {
            "" | "1" => self.quantity.clone(),
            unit => format!("{} [{unit}]", self.quantity),
        }
    }

    /// The place of a value on the axis (its decimal logarithm where the scale is logarithmic), or `None` where it
    /// has none: not finite, or not positive on a logarithmic axis.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let place = match self.scale {
            Scale::Log if value > 0.0 => value.log10(),
            Scale::Log => return None,
            Scale::Linear => value,
        };
        place.is_finite().then_some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_logarithmic_axis_has_no_place_for_zero_negatives_or_nan() {
        let axis = Axis::log("error", "m");
        assert_eq!(axis.place(1e-3), Some(-3.0));
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(axis.place(value), None, "{value}");
        }
    }

    #[test]
    fn a_number_without_unit_has_no_brackets() {
        assert_eq!(Axis::linear("ratio", "1").label(), "ratio");
        assert_eq!(Axis::linear("time", "s").label(), "time [s]");
    }
}
