//! What a plane leaves of a cube.

use glam::DVec3;

/// Of the cut's normal, components below this share of the largest count as none, and the plane is moved out instead: by so much of the cube's side at most.
const FLAT: f64 = 1e-4;

/// Volume of the points `p` of the cube `|p_i| <= half` with `p . normal >= offset` (m^3, m; a unit normal), from above by `FLAT` at most.
///
/// The volume below a plane in the unit cube by the order of its normal's components (Scardovelli and Zaleski, "Analytical relations connecting linear interfaces and
/// volume fractions in rectangular grids", J. Comput. Phys. 164, 2000).
pub(super) fn left_of_cube(half: f64, normal: DVec3, offset: f64) -> f64 {
    let mut n = normal.abs().to_array();
    n.sort_by(f64::total_cmp);
    let mut offset = offset;
    for component in n.iter_mut().take(2) {
        // What is left out moves no corner by more than this along the normal.
        if *component < FLAT {
            offset -= *component * half;
            *component = 0.0;
        }
    }
    let sum: f64 = n.iter().sum();
    let volume = (2.0 * half).powi(3);
    // Height of the far side above the plane, over the height of the cube along the normal.
    let alpha = (half * sum - offset) / (2.0 * half * sum);
    let share = match alpha {
        a if a <= 0.0 => 0.0,
        a if a >= 1.0 => 1.0,
        a if a <= 0.5 => below(n.map(|c| c / sum), a),
        a => 1.0 - below(n.map(|c| c / sum), 1.0 - a),
    };
    volume * share
}

/// Share of the unit cube with `m . x <= a`, for ordered components `m >= 0` of sum 1 and `a` in (0, 0.5].
fn below([m1, m2, m3]: [f64; 3], a: f64) -> f64 {
    let m12 = m1 + m2;
    let corner = |m: f64| if a > m { m * m * (m - 3.0 * a) } else { 0.0 };
    if a < m1 {
        a.powi(3) / (6.0 * m1 * m2 * m3)
    } else if a < m2 {
        // Here 0 <= m1 <= a < m2, and m3 is a third at least.
        (a * (a - m1) + m1 * m1 / 3.0) / (2.0 * m2 * m3)
    } else if a < m12.min(m3) {
        // m2 <= a < m1 + m2: m1 is not zero, hence above FLAT.
        (a * a * (3.0 * m12 - a) + corner(m1) + corner(m2)) / (6.0 * m1 * m2 * m3)
    } else if m12 <= a {
        (2.0 * a - m12) / (2.0 * m3)
    } else {
        // m3 <= a < m1 + m2 with m1 <= m2 <= m3: m1 is not zero.
        (a * a * (3.0 - 2.0 * a) + corner(m1) + corner(m2) + corner(m3)) / (6.0 * m1 * m2 * m3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Source;
    use proptest::prelude::*;

    /// Counted on a lattice of the cube.
    fn counted(half: f64, normal: DVec3, offset: f64) -> f64 {
        let side = 60;
        let place = |k: usize| half * (2.0 * (k as f64 + 0.5) / side as f64 - 1.0);
        let cell = |k: usize| {
            DVec3::new(place(k % side), place(k / side % side), place(k / (side * side))).dot(normal)
                >= offset
        };
        let inside = (0..side.pow(3)).filter(|k| cell(*k)).count();
        inside as f64 * (2.0 * half / side as f64).powi(3)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn what_is_left_is_what_is_counted(seed in 0_u64.., share in -1.1..1.1, flat in prop::array::uniform3(0_u8..3)) {
            let half = 0.7;
            // Some components zero, some nearly.
            let scale = flat.map(|f| [1.0, 1.0, 1e-5][f as usize]);
            let n = (Source::new(seed).direction().get() * DVec3::from(scale)).normalize();
            let offset = share * half * n.abs().element_sum();
            let (left, expected) = (left_of_cube(half, n, offset), counted(half, n, offset));
            // Of 60 layers one may be counted wrong by half of it.
            prop_assert!((left - expected).abs() < 0.02 * (2.0 * half).powi(3), "{left} {expected} {n}");
        }

        /// Both sides of a plane are the cube, from above.
        #[test]
        fn both_sides_are_the_cube(seed in 0_u64.., share in -1.1..1.1) {
            let n = Source::new(seed).direction().get();
            let offset = share * n.abs().element_sum();
            let both = left_of_cube(1.0, n, offset) + left_of_cube(1.0, -n, -offset);
            prop_assert!((8.0 - 1e-11..8.0 + 8.0 * 4.0 * FLAT).contains(&both), "{both}");
        }
    }

    #[test]
    fn an_axis_cuts_a_box() {
        assert_eq!(left_of_cube(1.0, DVec3::Z, 0.5), 2.0);
        assert_eq!(left_of_cube(1.0, DVec3::Z, -3.0), 8.0);
        assert_eq!(left_of_cube(1.0, -DVec3::X, 3.0), 0.0);
        let diagonal = DVec3::new(1.0, 1.0, 0.0).normalize();
        assert!((left_of_cube(1.0, diagonal, 0.0) - 4.0).abs() < 1e-12);
    }
}
