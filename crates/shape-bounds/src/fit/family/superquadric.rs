use super::norm::Nested;
use super::{Model, write};
use contact_kinematics::{CurvatureRadii, Direction, ShapeError, SupportFunction, SupportJet};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::DVector;

/// Exponents are kept this far within (0, 2), where the surface is a box or a double pyramid.
const EDGE: f64 = 0.1;

/// A convex superquadric: `((|x/a|^(2/e2) + |y/b|^(2/e2))^(e2/e1) + |z/c|^(2/e1)) = 1` about its centre and in its own
/// axes (Barr, "Superquadrics and angle-preserving transformations", 1981, equation (2.8)).
///
/// The left side is a power of a norm, two nested norms of exponents `2/e1` and `2/e2`, so the support function is the
/// dual norm, nested likewise, with exponents `q = 2 / (2 - e)`: closed form with all derivatives. With both exponents 1 it
/// is an ellipsoid; below 1 it tends to a box, above to a double pyramid. Unless both are 1, radii of curvature are zero
/// or infinite in places, so [`contact_kinematics::check_convex`] refuses it as a body for dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superquadric {
    centre: DVec3,
    semi_axes: DVec3,
    rotation: DQuat,
    exponents: [f64; 2],
}

impl Superquadric {
    /// From centre (m), semi-axes (m), the rotation of its own axes into the body's, and the exponents `e1`, `e2`.
    ///
    /// # Errors
    /// [`ShapeError::Length`] for lengths that are not positive and finite, [`ShapeError::Coefficient`] for exponents
    /// (index 0 and 1) outside of 0.1 to 1.9.
    pub fn new(
        centre: DVec3,
        semi_axes: DVec3,
        rotation: DQuat,
        exponents: [f64; 2],
    ) -> Result<Self, ShapeError> {
        for (what, value) in
            ["semi-axis x", "semi-axis y", "semi-axis z"].into_iter().zip(semi_axes.to_array())
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ShapeError::Length { what, value });
            }
        }
        if !(centre.is_finite() && rotation.is_finite()) {
            return Err(ShapeError::Length { what: "centre or rotation", value: f64::NAN });
        }
        for (index, value) in exponents.into_iter().enumerate() {
            if !(EDGE..=2.0 - EDGE).contains(&value) {
                return Err(ShapeError::Coefficient { index, value });
            }
        }
        Ok(Self { centre, semi_axes, rotation: rotation.normalize(), exponents })
    }

    /// Centre in m.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Semi-axes `a`, `b`, `c` in m.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }

    /// Turns its own axes into the body's.
    #[must_use]
    pub fn rotation(&self) -> DQuat {
        self.rotation
    }

    /// `e1` (along the third axis) and `e2` (around it).
    #[must_use]
    pub fn exponents(&self) -> [f64; 2] {
        self.exponents
    }

    fn norm(&self, n: DVec3) -> Nested {
        Nested::at(self.semi_axes * (self.rotation.inverse() * n), self.exponents.map(|e| 2.0 / (2.0 - e)))
    }

    fn jet_of(&self, n: DVec3, norm: &Nested) -> SupportJet {
        let turn = DMat3::from_quat(self.rotation) * DMat3::from_diagonal(self.semi_axes);
        SupportJet {
            value: norm.value + self.centre.dot(n),
            point: turn * norm.gradient + self.centre,
            hessian: turn * norm.hessian * turn.transpose(),
        }
    }
}

impl SupportFunction for Superquadric {
    /// Where a face is flat or an edge sharp, the Hessian is large or small but finite: shares of the norm below 1e-6
    /// count as 1e-6.
    fn jet(&self, n: Direction) -> SupportJet {
        self.jet_of(n.get(), &self.norm(n.get()))
    }

    /// Those of the ellipsoid if both exponents are 1, else zero and infinity.
    fn curvature_radii(&self) -> CurvatureRadii {
        if self.exponents == [1.0, 1.0] {
            let (short, long) = (self.semi_axes.min_element(), self.semi_axes.max_element());
            CurvatureRadii { min: short * short / long, max: long * long / short }
        } else {
            CurvatureRadii { min: 0.0, max: f64::INFINITY }
        }
    }
}

/// Centre, semi-axes, rotation vector (steps compose from the left) and exponents.
pub(in crate::fit) struct SuperquadricModel;

impl SuperquadricModel {
    pub(in crate::fit) fn body(theta: &DVector<f64>) -> Result<Superquadric, ShapeError> {
        let three = |i: usize| DVec3::new(theta[i], theta[i + 1], theta[i + 2]);
        Superquadric::new(three(0), three(3), DQuat::from_scaled_axis(three(6)), [theta[9], theta[10]])
    }

    pub(in crate::fit) fn parameters(body: &Superquadric) -> DVector<f64> {
        let mut theta = DVector::zeros(11);
        for (i, v) in [body.centre, body.semi_axes, body.rotation.to_scaled_axis()].into_iter().enumerate() {
            v.to_array().into_iter().enumerate().for_each(|(j, c)| theta[3 * i + j] = c);
        }
        theta[9] = body.exponents[0];
        theta[10] = body.exponents[1];
        theta
    }
}

impl Model for SuperquadricModel {
    fn count(&self) -> usize {
        11
    }

    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn SupportFunction>> {
        Some(Box::new(Self::body(theta).ok()?))
    }

    fn columns(&self, theta: &DVector<f64>, n: Direction, columns: &mut [DVec3]) -> Option<()> {
        let body = Self::body(theta).ok()?;
        let n = n.get();
        let norm = body.norm(n);
        let jet = body.jet_of(n, &norm);
        let turn = body.rotation;
        let local = turn.inverse() * n;
        let own = jet.point - body.centre;
        // y_j = a_j N_j(s), s_i = a_i m_i.
        let by_axis = |i: usize| {
            let second = norm.hessian.col(i) * local[i];
            turn * (DVec3::AXES[i] * norm.gradient[i] + body.semi_axes * second)
        };
        // x = R y(R'n): a turn w of R moves x by w x x and the normal, seen by y, by -w x n.
        let by_turn = |axis: DVec3| axis.cross(own) - jet.hessian * axis.cross(n);
        // dq / de = q^2 / 2.
        let by_exponent = |i: usize| {
            let q = 2.0 / (2.0 - body.exponents[i]);
            turn * (body.semi_axes * norm.by_exponents[i]) * (0.5 * q * q)
        };
        let [x, y, z] = DVec3::AXES;
        write(
            columns,
            [
                x,
                y,
                z,
                by_axis(0),
                by_axis(1),
                by_axis(2),
                by_turn(x),
                by_turn(y),
                by_turn(z),
                by_exponent(0),
                by_exponent(1),
            ],
        );
        Some(())
    }

    /// Semi-axes lose no more than nine tenths in a step, and exponents stay in range.
    fn moved(&self, theta: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        let mut next = theta + step;
        for i in 3..6 {
            next[i] = next[i].max(0.1 * theta[i]);
        }
        let vector = |v: &DVector<f64>| DQuat::from_scaled_axis(DVec3::new(v[6], v[7], v[8]));
        let turned = (vector(step) * vector(theta)).normalize().to_scaled_axis();
        turned.to_array().into_iter().enumerate().for_each(|(j, c)| next[6 + j] = c);
        for i in 9..11 {
            next[i] = next[i].clamp(EDGE, 2.0 - EDGE);
        }
        next
    }

    fn scales(&self, size: f64) -> DVector<f64> {
        DVector::from_fn(11, |i, _| if i < 6 { size } else { 1.0 })
    }

    fn name(&self, parameter: usize) -> String {
        [
            "centre x",
            "centre y",
            "centre z",
            "semi-axis 1",
            "semi-axis 2",
            "semi-axis 3",
            "turn about x",
            "turn about y",
            "turn about z",
            "exponent e1",
            "exponent e2",
        ][parameter]
            .to_owned()
    }

    fn ball(&self, centre: DVec3, radius: f64) -> DVector<f64> {
        let mut theta = DVector::zeros(11);
        centre.to_array().into_iter().enumerate().for_each(|(j, c)| theta[j] = c);
        (3..6).for_each(|i| theta[i] = radius);
        (9..11).for_each(|i| theta[i] = 1.0);
        theta
    }
}

impl Superquadric {
    /// The ellipsoid as a superquadric.
    pub(in crate::fit) fn from_ellipsoid(body: &super::SkewEllipsoid) -> Result<Self, ShapeError> {
        Self::new(body.centre(), body.semi_axes(), body.rotation(), [1.0, 1.0])
    }

    /// The exponent of the section across an axis.
    fn section(&self, across: usize) -> f64 {
        self.exponents[usize::from(across == 2)]
    }

    /// One about as large, turned by an eighth about an axis: corners of the section across it come where its sides were.
    pub(in crate::fit) fn turned_by_an_eighth(&self, about: usize) -> Option<Self> {
        let [i, j] = [(about + 1) % 3, (about + 2) % 3];
        let mut lengths = self.semi_axes;
        // Both axes across have the same length then: where |x|^(2/e) + |y|^(2/e) = 1 meets x = y.
        let between = (0.5 * (1.0 - self.section(about))).exp2();
        lengths[i] = 0.5 * (self.semi_axes[i] + self.semi_axes[j]) * between;
        lengths[j] = lengths[i];
        let turn = DQuat::from_axis_angle(DVec3::AXES[about], std::f64::consts::FRAC_PI_4);
        let mut exponents = self.exponents;
        let own = &mut exponents[usize::from(about == 2)];
        *own = (2.0 - *own).clamp(EDGE, 2.0 - EDGE);
        Self::new(self.centre, lengths, self.rotation * turn, exponents).ok()
    }

    /// One about alike whose third axis, that of the first exponent, is the axis `third` of this one.
    pub(in crate::fit) fn with_third(&self, third: usize) -> Option<Self> {
        let axes = [(third + 1) % 3, (third + 2) % 3, third];
        let frame = DMat3::from_quat(self.rotation);
        let turned = DMat3::from_cols(frame.col(axes[0]), frame.col(axes[1]), frame.col(axes[2]));
        let lengths = DVec3::from_array(axes.map(|i| self.semi_axes[i]));
        // The two sections through the third axis share an exponent.
        let through = 0.5 * (self.section(axes[0]) + self.section(axes[1]));
        let exponents = [through, self.section(third)];
        Self::new(self.centre, lengths, DQuat::from_mat3(&turned), exponents).ok()
    }
}
