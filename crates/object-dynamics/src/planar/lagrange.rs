/// Lagrange polynomial of the node `own` among `nodes` and its first two derivatives, at `t`: the product rule, factor by factor. Nodes are
/// to differ from each other.
#[must_use]
pub fn lagrange(nodes: impl Iterator<Item = f64>, own: f64, t: f64) -> [f64; 3] {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_lower_degree_than_nodes_are_exact() {
        let nodes = [0.0, 0.1, 0.25, 0.3, 0.5, 0.55, 0.6, 0.75, 0.9, 1.0];
        for degree in 0..10 {
            let (n, t) = (f64::from(degree), 0.27_f64);
            let expected = [
                t.powi(degree),
                if degree > 0 { n * t.powi(degree - 1) } else { 0.0 },
                if degree > 1 { n * (n - 1.0) * t.powi(degree - 2) } else { 0.0 },
            ];
            let mut found = [0.0; 3];
            for own in nodes {
                let weights = lagrange(nodes.into_iter(), own, t);
                (0..3).for_each(|m| found[m] += weights[m] * own.powi(degree));
            }
            for m in 0..3 {
                assert!((found[m] - expected[m]).abs() < 1e-9, "degree {degree} derivative {m}");
            }
        }
    }
}
