//! Running integrals of sampled data by local polynomials, at any spacing of the samples.

use std::ops::{Add, Mul};

/// Samples that the local polynomial passes through: degree 5, local error of order 7 in the spacing.
const STENCIL: usize = 6;
/// Relative departure of two stencils below which the weights of one serve the other.
const SAME_STENCIL: f64 = 1e-9;

/// `integral of f from t[0] to t[k]` for every `k`. Times are strictly increasing and as many as values.
pub(crate) fn running_integral<V>(t: &[f64], f: &[V], zero: V) -> Vec<V>
where
    V: Copy + Add<Output = V> + Mul<f64, Output = V>,
{
    let count = t.len().min(f.len());
    let mut sum = zero;
    let mut integral = Vec::with_capacity(count);
    integral.extend(f.first().filter(|_| count > 0).map(|_| zero));
    let mut known: Option<Weights> = None;
    for k in 1..count {
        let (start, nodes) = stencil_before(&t[..count], k);
        let weights = match known.filter(|w| w.stencil.is_like(&nodes)) {
            Some(weights) => weights,
            None => Weights::new(nodes),
        };
        sum = sum + weights.of(&f[start..], zero) * (t[k] - t[k - 1]);
        integral.push(sum);
        known = Some(weights);
    }
    integral
}

/// First sample and stencil of the interval that ends at sample `k`, which is not the first.
fn stencil_before(t: &[f64], k: usize) -> (usize, Stencil) {
    let width = t.len().min(STENCIL);
    let start = (k - 1).saturating_sub((width - 1) / 2).min(t.len() - width);
    (start, Stencil::new(&t[start..start + width], k - 1 - start))
}

/// Derivative of the local polynomial at every sample.
pub(crate) fn derivative<V>(t: &[f64], f: &[V], zero: V) -> Vec<V>
where
    V: Copy + Add<Output = V> + Mul<f64, Output = V>,
{
    let count = t.len().min(f.len());
    let width = count.min(STENCIL - 1);
    let mut known: Option<Slopes> = None;
    let mut rates = Vec::with_capacity(count);
    for k in 0..count {
        let start = k.saturating_sub(width / 2).min(count - width);
        let here = k - start;
        if width < 2 {
            rates.push(zero);
            continue;
        }
        let interval = here.min(width - 2);
        let stencil = Stencil::new(&t[start..start + width], interval);
        let slopes = match known.filter(|s| s.here == here && s.stencil.is_like(&stencil)) {
            Some(slopes) => slopes,
            None => Slopes::new(stencil, here),
        };
        let step = t[start + interval + 1] - t[start + interval];
        let mut sum = zero;
        for j in 0..width {
            sum = sum + f[start + j] * slopes.values[j];
        }
        known = Some(slopes);
        rates.push(sum * (1.0 / step));
    }
    rates
}

/// Derivatives, at one of the nodes, of the Lagrange polynomials of all.
#[derive(Clone, Copy)]
struct Slopes {
    stencil: Stencil,
    here: usize,
    values: [f64; STENCIL],
}

impl Slopes {
    fn new(stencil: Stencil, here: usize) -> Self {
        let nodes = &stencil.nodes[..stencil.width];
        let at = nodes[here];
        let mut values = [0.0; STENCIL];
        for (j, &node) in nodes.iter().enumerate() {
            let others = || (0..nodes.len()).filter(|&i| i != j && i != here).map(|i| nodes[i]);
            // The nodes are distinct because time increases strictly.
            values[j] = if j == here {
                others().map(|other| 1.0 / (at - other)).sum()
            } else {
                others().map(|other| (at - other) / (node - other)).product::<f64>() / (node - at)
            };
        }
        Self { stencil, here, values }
    }
}

/// Nodes in units of the interval `[0, 1]` that is integrated over.
#[derive(Clone, Copy)]
struct Stencil {
    nodes: [f64; STENCIL],
    width: usize,
}

impl Stencil {
    fn new(t: &[f64], interval: usize) -> Self {
        let (origin, inverse) = (t[interval], 1.0 / (t[interval + 1] - t[interval]));
        let mut nodes = [0.0; STENCIL];
        for (node, t) in nodes.iter_mut().zip(t) {
            *node = (t - origin) * inverse;
        }
        Self { nodes, width: t.len() }
    }

    fn is_like(&self, other: &Self) -> bool {
        self.width == other.width
            && self.nodes.iter().zip(&other.nodes).all(|(a, b)| (a - b).abs() < SAME_STENCIL)
    }
}

#[derive(Clone, Copy)]
struct Weights {
    stencil: Stencil,
    values: [f64; STENCIL],
}

impl Weights {
    /// The weighted sum of the first values, as many as the stencil has nodes.
    #[inline]
    fn of<V>(&self, values: &[V], zero: V) -> V
    where
        V: Copy + Add<Output = V> + Mul<f64, Output = V>,
    {
        let weighed = values.iter().zip(&self.values[..self.stencil.width]);
        weighed.fold(zero, |sum, (&value, &weight)| sum + value * weight)
    }

    /// Integrals over `[0, 1]` of the Lagrange polynomials of the nodes, expanded into powers.
    fn new(stencil: Stencil) -> Self {
        let nodes = &stencil.nodes[..stencil.width];
        let mut values = [0.0; STENCIL];
        for (j, value) in values.iter_mut().enumerate().take(stencil.width) {
            let mut powers = [0.0; STENCIL];
            powers[0] = 1.0;
            for (i, &node) in nodes.iter().enumerate().filter(|&(i, _)| i != j) {
                // Times (x - node) / (nodes[j] - node); the nodes are distinct because time increases strictly.
                let scale = 1.0 / (nodes[j] - nodes[i]);
                for p in (0..STENCIL).rev() {
                    let lower = if p > 0 { powers[p - 1] } else { 0.0 };
                    powers[p] = (lower - node * powers[p]) * scale;
                }
            }
            *value = powers.iter().zip(1u32..).map(|(c, p)| c / f64::from(p)).sum();
        }
        Self { stencil, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(count: usize, uneven: f64) -> (f64, f64) {
        let t: Vec<f64> = (0..=count)
            .map(|k| k as f64 / count as f64)
            .map(|s| 3.0 * (s + uneven * (7.0 * s).sin() / 7.0))
            .collect();
        let f: Vec<f64> = t.iter().map(|t| t.cos()).collect();
        let integral = running_integral(&t, &f, 0.0);
        let rate = derivative(&t, &f, 0.0);
        let worst = |a: &[f64], exact: &dyn Fn(f64) -> f64| {
            a.iter().zip(&t).fold(0.0, |m: f64, (a, t)| m.max((a - exact(*t)).abs()))
        };
        (worst(&integral, &|x: f64| x.sin() - t[0].sin()), worst(&rate, &|t| -t.sin()))
    }

    #[test]
    fn integrals_converge_with_sixth_order_and_derivatives_with_fourth() {
        for uneven in [0.0, 0.4] {
            let ((i1, d1), (i2, d2)) = (error(60, uneven), error(120, uneven));
            let (oi, od) = ((i1 / i2).log2(), (d1 / d2).log2());
            assert!((5.5..8.0).contains(&oi), "{uneven}: {oi} ({i1:e}, {i2:e})");
            assert!((3.5..5.5).contains(&od), "{uneven}: {od}");
        }
    }

    #[test]
    fn short_data_use_what_there_is() {
        assert_eq!(running_integral(&[0.0, 2.0], &[1.0, 3.0], 0.0), vec![0.0, 4.0]);
        assert_eq!(derivative(&[0.0, 2.0], &[1.0, 3.0], 0.0), vec![1.0, 1.0]);
        assert_eq!(running_integral(&[1.0], &[1.0], 0.0), vec![0.0]);
        assert_eq!(derivative(&[1.0], &[1.0], 0.0), vec![0.0]);
    }
}
