//! The polynomial through the latest samples: values, slopes and curvatures, and how far it can be trusted.

/// Quantities that are interpolated: `P1, P2, f1, f2, s1, s2`.
pub(super) const QUANTITIES: usize = 6;

/// Readings of one sample, in the order above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) t: f64,
    pub(super) values: [f64; QUANTITIES],
}

/// Lagrange polynomial of the node `own` among `nodes` and its first two derivatives, at `t`: the product rule, factor by
/// factor. Nodes increase strictly, which the logs' readers check.
pub(super) fn lagrange(nodes: impl Iterator<Item = f64>, own: f64, t: f64) -> [f64; 3] {
    let [mut value, mut slope, mut curvature] = [1.0, 0.0, 0.0];
    for node in nodes.filter(|&node| node != own) {
        let step = 1.0 / (own - node);
        let factor = (t - node) * step;
        curvature = curvature * factor + 2.0 * slope * step;
        slope = slope * factor + value * step;
        value *= factor;
    }
    [value, slope, curvature]
}

fn times(rows: &[Row]) -> impl Iterator<Item = f64> {
    rows.iter().map(|row| row.t)
}

/// Quantity `i` at `t`.
pub(super) fn value(rows: &[Row], i: usize, t: f64) -> f64 {
    rows.iter().map(|row| lagrange(times(rows), row.t, t)[0] * row.values[i]).sum()
}

/// All quantities at `t`, and the slopes of the first two (the palms' rates).
pub(super) fn interpolate(rows: &[Row], t: f64) -> ([f64; QUANTITIES], [f64; 2]) {
    let (mut value, mut slope) = ([0.0; QUANTITIES], [0.0; 2]);
    for row in rows {
        let [weight, rise, _] = lagrange(times(rows), row.t, t);
        for (sum, v) in value.iter_mut().zip(row.values) {
            *sum += weight * v;
        }
        // Angles relative to the first row: the weights of a slope add up to zero, and large angles would cancel.
        for (i, sum) in slope.iter_mut().enumerate() {
            *sum += rise * (row.values[i] - rows[0].values[i]);
        }
    }
    (value, slope)
}

/// Second derivatives of the first two quantities (the palms' accelerations) at `t`.
pub(super) fn curvatures(rows: &[Row], t: f64) -> [f64; 2] {
    let mut out = [0.0; 2];
    for row in rows {
        let [_, _, bend] = lagrange(times(rows), row.t, t);
        for (i, sum) in out.iter_mut().enumerate() {
            *sum += bend * (row.values[i] - rows[0].values[i]);
        }
    }
    out
}

/// How many rows a polynomial through quantity `i` is worth, and its error.
///
/// Differences of the readings fall with their order until noise is all that is left of them, and from there on they grow.
/// Where those of order `n` are what noise alone makes of them, a polynomial through more than `n` rows amplifies noise and
/// gains nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// Rows to use.
    pub(super) order: usize,
    /// Difference of that order, as a divided difference, root mean square over the rows, noise taken out.
    difference: f64,
}

/// Differences up to twice what noise makes of them count as noise: the error that this may leave is below the noise itself.
const NOISE_FACTOR: f64 = 2.0;
/// Fewest rows of a polynomial; its order is even, so that it lies evenly about an interval.
const FEWEST_ROWS: usize = 4;

impl Fit {
    /// For quantity `i` with readings of standard deviation `noise`.
    pub(super) fn new(rows: &[Row], i: usize, noise: f64) -> Self {
        let squares = mean_squares(rows, i);
        for order in (FEWEST_ROWS..rows.len()).step_by(2).take_while(|_| noise > 0.0) {
            let expected = noise_square(rows, order) * noise * noise;
            if squares[order] <= NOISE_FACTOR * NOISE_FACTOR * expected {
                return Self { order, difference: (squares[order] - expected).max(0.0).sqrt() };
            }
        }
        let spacing = (rows[rows.len() - 1].t - rows[0].t) / (rows.len() - 1) as f64;
        Self { order: rows.len(), difference: extrapolated(&squares, spacing) }
    }

    /// The rows to use for the interval that ends at row `end`, as many on either side of it as there are.
    pub(super) fn rows<'a>(&self, rows: &'a [Row], end: usize) -> &'a [Row] {
        let from = end.saturating_sub(self.order / 2).min(rows.len() - self.order);
        &rows[from..from + self.order]
    }

    /// Error at `t` of the polynomial through `rows` for exact readings, by the remainder of Newton's form.
    pub(super) fn error(&self, rows: &[Row], t: f64) -> f64 {
        let reach: f64 = rows.iter().map(|row| t - row.t).product();
        (self.difference * reach).abs()
    }
}

/// Mean square over the rows of the divided differences of each order, from the values (order 0) on.
fn mean_squares(rows: &[Row], i: usize) -> Vec<f64> {
    let mut differences: Vec<f64> = rows.iter().map(|row| row.values[i]).collect();
    let mut squares = Vec::with_capacity(rows.len());
    while !differences.is_empty() {
        squares.push(differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64);
        let order = squares.len();
        for k in 1..differences.len() {
            differences[k - 1] =
                (differences[k] - differences[k - 1]) / (rows[k - 1 + order].t - rows[k - 1].t);
        }
        differences.pop();
    }
    squares
}

/// Mean square of the divided differences of an order of white noise of one.
fn noise_square(rows: &[Row], order: usize) -> f64 {
    let square = |part: &[Row]| -> f64 {
        let others = |own: f64| times(part).filter(move |&t| t != own);
        times(part).map(|own| others(own).map(|t| own - t).product::<f64>().powi(-2)).sum()
    };
    rows.windows(order + 1).map(square).sum::<f64>() / (rows.len() - order) as f64
}

/// Divided difference of one order more than there are, from how the last four fall. Derivatives of a sinusoid of
/// neighbouring orders are a quarter of a period apart: two of them together have its amplitude, and none is taken for small
/// where it passes through zero. `spacing` is the time between samples.
fn extrapolated(squares: &[f64], spacing: f64) -> f64 {
    let next = squares.len();
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    // Derivatives, which are divided differences times the factorial of their order.
    let [d1, d2, d3, d4] = [1, 2, 3, 4].map(|back| squares[next - back].sqrt() * factorial(next - back));
    let below = d4 + spacing * d3;
    let frequency_square = if below > 0.0 { (d2 + spacing * d1) / below } else { 0.0 };
    let amplitude = (frequency_square * d2).hypot(frequency_square.sqrt() * d1);
    // The mean square of a sinusoid is half its amplitude's.
    amplitude / (factorial(next) * std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNEVEN: [f64; 10] = [0.0, 0.1, 0.25, 0.3, 0.5, 0.55, 0.6, 0.75, 0.9, 1.0];

    fn rows(times: &[f64], f: impl Fn(f64) -> f64) -> Vec<Row> {
        times.iter().map(|&t| Row { t, values: [f(t); QUANTITIES] }).collect()
    }

    #[test]
    fn polynomials_of_lower_degree_than_rows_are_exact() {
        for degree in 0..10 {
            let n = f64::from(degree);
            let rows = rows(&UNEVEN, |t| t.powi(degree));
            let t = 0.27_f64;
            let expected = [
                t.powi(degree),
                if degree > 0 { n * t.powi(degree - 1) } else { 0.0 },
                if degree > 1 { n * (n - 1.0) * t.powi(degree - 2) } else { 0.0 },
            ];
            let (values, slopes) = interpolate(&rows, t);
            let found = [values[0], slopes[0], curvatures(&rows, t)[0]];
            for m in 0..3 {
                assert!((found[m] - expected[m]).abs() < 1e-9, "degree {degree} derivative {m}");
            }
            assert!((value(&rows, 3, t) - expected[0]).abs() < 1e-11);
        }
    }

    #[test]
    fn divided_differences_of_a_power_are_one() {
        let squares = mean_squares(&rows(&UNEVEN, |t| t.powi(6)), 0);
        assert!((squares[6] - 1.0).abs() < 1e-9, "{squares:?}");
        assert!(squares[7] < 1e-12, "{squares:?}");
    }

    /// The stated error of a sinusoid against the true one, over all phases, for well and for barely sampled ones.
    #[test]
    fn error_of_a_sinusoid_is_known() {
        let times: [f64; 10] = std::array::from_fn(|k| k as f64);
        for frequency in [0.1, 0.2, 0.4, 0.7] {
            let (mut actual, mut stated) = (0.0, 0.0);
            for phase in 0..16 {
                let f = |t: f64| (frequency * t + 0.4 * f64::from(phase)).sin();
                let rows = rows(&times, f);
                let fit = Fit::new(&rows, 0, 0.0);
                for t in [4.5, 6.5, 8.5] {
                    actual += (value(&rows, 0, t) - f(t)).powi(2);
                    stated += fit.error(&rows, t).powi(2);
                }
            }
            let ratio = f64::sqrt(stated / actual);
            // At 0.1 the error is 1e-12, and rounding shares in it.
            assert!((0.5..2.5).contains(&ratio) || frequency < 0.2, "frequency {frequency}: {ratio}");
        }
    }

    /// Noise is not fitted: four rows where differences of fourth order are noise, all of them where they are the signal.
    #[test]
    fn noise_bounds_the_number_of_rows() {
        let times: [f64; 10] = std::array::from_fn(|k| k as f64);
        let signal = |t: f64| (0.4 * t).sin();
        // Fourth differences: 0.4^4 = 0.026 of the signal, 8.4 of the noise.
        assert_eq!(Fit::new(&rows(&times, signal), 0, 0.01).order, 4);
        assert_eq!(Fit::new(&rows(&times, signal), 0, 1e-5).order, 8);
        assert_eq!(Fit::new(&rows(&times, signal), 0, 0.0).order, 10);
    }
}
