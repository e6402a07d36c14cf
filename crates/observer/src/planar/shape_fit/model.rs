//! Motion of a Fourier body between moving palms with its sensitivities: no forces enter.

use nalgebra::SVector;

/// Contact quantities in the order `r_1, d_1, rho_1, r_2, d_2, rho_2, omega0`.
pub(super) type Seven = SVector<f64, 7>;

/// Absolute palm angles, rates and accelerations at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PalmInstant {
    pub(super) angles: [f64; 2],
    pub(super) rates: [f64; 2],
    pub(super) accelerations: [f64; 2],
}

/// Angular acceleration and contacts with their gradients.
pub(super) struct Reaction {
    pub(super) alpha: f64,
    pub(super) by_contact: Seven,
    pub(super) by_gyration: f64,
    pub(super) contacts: [f64; 2],
    pub(super) contacts_by: [Seven; 2],
}

fn unit(i: usize) -> Seven {
    let mut e = Seven::zeros();
    e[i] = 1.0;
    e
}

/// The prescribed-palm dynamics of `object_dynamics::planar`, differentiated: with the contact quantities `c` everything up
/// to `b_i = k_i - n_i . g` is linear for a given `omega0`, and `alpha = -<d, b> / (gyration^2 + <d, d>)`.
pub(super) fn reaction(palms: &PalmInstant, gravity: f64, gyration_squared: f64, c: &Seven) -> Reaction {
    let (sin, cos) = (palms.angles[1] - palms.angles[0]).sin_cos();
    let ([w1, w2], [a1, a2]) = (palms.rates, palms.accelerations);
    let omega0 = c[6];
    let (z1, z2) = (omega0 - w1, omega0 - w2);
    let s1 = (unit(0) * cos + unit(3)) / sin - unit(1);
    let s2 = (unit(0) + unit(3) * cos) / sin + unit(4);
    let (s1_value, s2_value) = (s1.dot(c), s2.dot(c));
    // n_1 . v = d_1 omega0 + s_1 W_1, n_2 . v = d_2 omega0 - s_2 W_2: values and gradients.
    let e1 = (c[1] * omega0 + s1_value * w1, unit(1) * omega0 + unit(6) * c[1] + s1 * w1);
    let e2 = (c[4] * omega0 - s2_value * w2, unit(4) * omega0 + unit(6) * c[4] - s2 * w2);
    let u1v = ((e1.0 * cos + e2.0) / sin, (e1.1 * cos + e2.1) / sin);
    let u2v = ((e1.0 + e2.0 * cos) / sin, (e1.1 + e2.1 * cos) / sin);
    let b1 = (c[2] - c[0]) * z1 * z1
        + 2.0 * w1 * u1v.0
        + w1 * w1 * c[0]
        + s1_value * a1
        + gravity * palms.angles[0].cos();
    let b2 = (c[5] - c[3]) * z2 * z2 - 2.0 * w2 * u2v.0 + w2 * w2 * c[3]
        - s2_value * a2
        - gravity * palms.angles[1].cos();
    let db1 = (unit(2) - unit(0)) * (z1 * z1)
        + unit(6) * (2.0 * z1 * (c[2] - c[0]))
        + u1v.1 * (2.0 * w1)
        + unit(0) * (w1 * w1)
        + s1 * a1;
    let db2 = (unit(5) - unit(3)) * (z2 * z2) + unit(6) * (2.0 * z2 * (c[5] - c[3])) - u2v.1 * (2.0 * w2)
        + unit(3) * (w2 * w2)
        - s2 * a2;
    let dual = |x: f64, y: f64| [(x + cos * y) / (sin * sin), (cos * x + y) / (sin * sin)];
    let (qd, qb) = (dual(c[1], c[4]), dual(b1, b2));
    // Positive: the squared radius of gyration is, and Q is positive definite.
    let denominator = gyration_squared + qd[0] * c[1] + qd[1] * c[4];
    let alpha = -(qd[0] * b1 + qd[1] * b2) / denominator;
    let numerator_by = db1 * qd[0] + db2 * qd[1] + unit(1) * qb[0] + unit(4) * qb[1];
    let denominator_by = (unit(1) * qd[0] + unit(4) * qd[1]) * 2.0;
    Reaction {
        alpha,
        by_contact: -(numerator_by + denominator_by * alpha) / denominator,
        by_gyration: -alpha / denominator,
        contacts: [s1_value, s2_value],
        contacts_by: [s1, s2],
    }
}

/// Fourier coefficients `a_0, a_1, b_1, a_2, b_2, ...`: contact quantities at one orientation, their derivatives by the
/// orientation, and the waves of which `r`, `d`, `rho` of each palm are made.
pub(super) struct Contacts {
    pub(super) values: Seven,
    pub(super) by_phi: Seven,
    /// `cos k theta_i`, `sin k theta_i` for `k = 0..=order`.
    pub(super) waves: [Vec<[f64; 2]>; 2],
}

impl Contacts {
    pub(super) fn new(order: usize) -> Self {
        let waves = || vec![[0.0; 2]; order + 1];
        Self { values: Seven::zeros(), by_phi: Seven::zeros(), waves: [waves(), waves()] }
    }

    /// Evaluates at orientation `phi`; no allocation.
    pub(super) fn set(&mut self, coefficients: &[f64], palms: &PalmInstant, phi: f64, omega0: f64) {
        let quarter = std::f64::consts::FRAC_PI_2;
        let thetas = [palms.angles[0] - phi - quarter, palms.angles[1] - phi + quarter];
        self.values[6] = omega0;
        self.by_phi[6] = 0.0;
        for (i, theta) in thetas.into_iter().enumerate() {
            let (sin1, cos1) = theta.sin_cos();
            let (mut cos, mut sin) = (1.0, 0.0);
            let (mut r, mut d, mut rho, mut rho_slope) = (0.0, 0.0, 0.0, 0.0);
            for (k, wave) in self.waves[i].iter_mut().enumerate() {
                *wave = [cos, sin];
                let order = k as f64;
                let (a, b) = if k == 0 {
                    (coefficients[0], 0.0)
                } else {
                    (coefficients[2 * k - 1], coefficients[2 * k])
                };
                let (value, slope) = (a * cos + b * sin, order * (b * cos - a * sin));
                r += value;
                d -= slope;
                rho += (1.0 - order * order) * value;
                rho_slope += (1.0 - order * order) * slope;
                (cos, sin) = (cos * cos1 - sin * sin1, sin * cos1 + cos * sin1);
            }
            // theta falls as phi rises: dr/dphi = d, dd/dphi = rho - r.
            for (slot, value, slope) in [(0, r, d), (1, d, rho - r), (2, rho, -rho_slope)] {
                self.values[3 * i + slot] = value;
                self.by_phi[3 * i + slot] = slope;
            }
        }
    }

    /// Derivative of the contact quantities by coefficient `j`, orientation fixed, projected on `gradient`.
    pub(super) fn by_coefficient(&self, gradient: &Seven, j: usize) -> f64 {
        let (k, part) = (j.div_ceil(2), if j % 2 == 1 || j == 0 { 0 } else { 1 });
        let order = k as f64;
        let mut sum = 0.0;
        for (i, waves) in self.waves.iter().enumerate() {
            let [cos, sin] = waves[k];
            let (r, d) = if part == 0 { (cos, order * sin) } else { (sin, -order * cos) };
            let rho = (1.0 - order * order) * r;
            sum += gradient[3 * i] * r + gradient[3 * i + 1] * d + gradient[3 * i + 2] * rho;
        }
        sum
    }
}
