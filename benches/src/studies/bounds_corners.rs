//! How exact the corners of the half-space intersection are, on three curves: against rational arithmetic, and whether any
//! contact is cut off.
//!
//! Usage: `bounds_corners [LARGEST]` (1,000,000 by default). Prints the table
//! `docs/charts/bounds/corners.csv`. Errors are relative to the largest semi-axis.

use glam::DVec3;
use num_rational::BigRational;
use shape_bounds::exact_hull::{HalfSpace, Hull, Intersection, Polyhedron};
use shape_bounds::generators::{AXES, Source, curve_contacts};

type Failure = Box<dyn std::error::Error>;

const CORNERS: usize = 20_000;
/// Corners whose planes are the closest to parallel.
const WORST: usize = 5_000;
const CONTACTS: usize = 200;

pub(crate) fn main() -> Result<(), Failure> {
    let largest: usize = crate::words().next().map_or(Ok(1_000_000), |a| a.parse())?;
    println!(
        "contacts,corners_checked,error_median,error_99,error_largest,error_of_worst_determined,residual_largest,contacts_checked,cut_off"
    );
    for n in [1000, 10_000, 100_000, 1_000_000].into_iter().filter(|n| *n <= largest) {
        crate::print_line(|| -> Result<String, Failure> {
            let contacts = curve_contacts(n, 1);
            let spaces: Vec<HalfSpace> = contacts.iter().map(|c| c.half_space()).collect();
            let intersection = Intersection::of(&spaces)?;
            let body = intersection.bounded().ok_or("unbounded")?;
            let (errors, worst, residual) = corner_errors(body);
            let hull = Hull::of(body.vertices())?;
            let hull = hull.solid().ok_or("flat")?;
            let mut s = Source::new(3);
            let cut_off = (0..CONTACTS).filter(|_| !hull.contains(contacts[s.below(n)].point)).count();
            let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
            Ok(format!(
                "{n},{},{:.1e},{:.1e},{:.1e},{worst:.1e},{residual:.1e},{CONTACTS},{cut_off}",
                errors.len(),
                at(0.5),
                at(0.99),
                at(1.0)
            ))
        })?;
    }
    Ok(())
}

/// Distances of random corners, sorted, and of those that their planes determine worst, from the exact common points of
/// their three planes, and the largest distance of any of them from one of its planes.
fn corner_errors(body: &Polyhedron) -> (Vec<f64>, f64, f64) {
    let mut faces_at = vec![Vec::with_capacity(3); body.vertices().len()];
    for face in 0..body.face_count() {
        body.face(face).for_each(|v| faces_at[v as usize].push(face));
    }
    let planes = |v: usize| -> Option<[HalfSpace; 3]> {
        faces_at[v].iter().map(|f| body.face_half_spaces()[*f]).collect::<Vec<_>>().try_into().ok()
    };
    let mut residual = 0.0_f64;
    let mut error = |v: usize| {
        let (planes, corner) = (planes(v)?, body.vertices()[v]);
        residual = planes.iter().map(|h| h.excess(corner).abs()).fold(residual, f64::max);
        Some(exact_distance(&planes, corner)? / AXES.max_element())
    };
    let mut s = Source::new(2);
    let mut errors: Vec<f64> = (0..CORNERS).filter_map(|_| error(s.below(faces_at.len()))).collect();
    errors.sort_unstable_by(f64::total_cmp);
    let mut by_volume: Vec<(f64, usize)> = (0..faces_at.len())
        .filter_map(|v| {
            let [i, j, k] = planes(v)?.map(|h| h.normal.get());
            Some((i.dot((j - i).cross(k - i)).abs(), v))
        })
        .collect();
    by_volume.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let worst = by_volume.iter().take(WORST).filter_map(|(_, v)| error(*v)).fold(0.0, f64::max);
    (errors, worst, residual / AXES.max_element())
}

/// Distance of `corner` from the common point of the planes, by rational arithmetic.
fn exact_distance(planes: &[HalfSpace; 3], corner: DVec3) -> Option<f64> {
    let exact = |x: f64| BigRational::from_float(x);
    let mut rows = Vec::new();
    let mut offsets = Vec::new();
    for h in planes {
        let mut row = Vec::new();
        let mut offset = exact(h.margin)?;
        for axis in 0..3 {
            let n = exact(h.normal.get()[axis])?;
            offset += &n * (exact(h.point[axis])? - exact(corner[axis])?);
            row.push(n);
        }
        rows.push(row);
        offsets.push(offset);
    }
    let minor = |a: &[BigRational], b: &[BigRational], p: usize, q: usize| &a[p] * &b[q] - &a[q] * &b[p];
    let cross =
        |a: &[BigRational], b: &[BigRational]| [minor(a, b, 1, 2), minor(a, b, 2, 0), minor(a, b, 0, 1)];
    let [bc, ca, ab] = [cross(&rows[1], &rows[2]), cross(&rows[2], &rows[0]), cross(&rows[0], &rows[1])];
    let determinant = (0..3).fold(exact(0.0)?, |sum, k| sum + &rows[0][k] * &bc[k]);
    if determinant == exact(0.0)? {
        return None;
    }
    let mut squared = 0.0;
    for axis in 0..3 {
        let numerator = &offsets[0] * &bc[axis] + &offsets[1] * &ca[axis] + &offsets[2] * &ab[axis];
        squared += to_f64(&(numerator / &determinant)).powi(2);
    }
    Some(squared.sqrt())
}

fn to_f64(x: &BigRational) -> f64 {
    // Numerators beyond 2^1024 must be shortened together with their denominators.
    let excess = x.numer().bits().max(x.denom().bits()).saturating_sub(900);
    let (n, d) = (x.numer() >> excess, x.denom() >> excess);
    let parse = |text: String| text.parse::<f64>().unwrap_or(f64::NAN);
    parse(n.to_string()) / parse(d.to_string())
}
