use glam::DVec3;
use recon::contact_kinematics::PalmSurface;

/// Contacts that are this near to a shape, as a share of their reach, are taken for contacts on it.
const NEAR: f64 = 2e-3;
/// Fewer contacts than these tell no shape.
const FEWEST: usize = 8;

/// The shape of a palm on which all of these contacts (palm axes, m) are, if it is one of a kind that is known; `inward` says
/// whether the force there points to the origin, as in a cup.
pub(in crate::bag) fn guess_shape(contacts: &[DVec3], inward: bool) -> Option<PalmSurface> {
    let reach = contacts.iter().map(|c| c.length()).fold(0.0, f64::max);
    if contacts.len() < FEWEST || reach == 0.0 {
        return None;
    }
    if contacts.iter().all(|c| c.z.abs() <= NEAR * reach) {
        return Some(PalmSurface::Plane);
    }
    let alike = |distance: fn(&DVec3) -> f64| {
        let all: Vec<f64> = contacts.iter().map(distance).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        all.iter().all(|d| (d - mean).abs() <= NEAR * mean).then_some(rounded(mean))
    };
    if let Some(radius) = alike(|c| c.length()) {
        return Some(if inward { PalmSurface::Cup { radius } } else { PalmSurface::Sphere { radius } });
    }
    alike(|c| c.y.hypot(c.z)).map(|radius| PalmSurface::Cylinder { radius })
}

/// Three digits: palms are built to such sizes, and contacts know them no better.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// A shape in words, as in `sphere of radius 0.012 m`.
pub(in crate::bag) fn described(surface: PalmSurface) -> String {
    match surface.radius() {
        None => surface.name().to_owned(),
        Some(radius) => format!("{} of radius {radius} m", surface.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(surface: PalmSurface) -> Vec<DVec3> {
        let far =
            |k: u32| DVec3::new(0.3 * f64::from(k) - 1.0, (f64::from(k)).sin(), 2.0 + f64::from(k).cos());
        (0..20).map(|k| surface.nearest(0.1 * far(k)).unwrap().p_P).collect()
    }

    #[test]
    fn planted_shapes_are_found() {
        let radius = 0.012;
        for surface in [
            PalmSurface::Plane,
            PalmSurface::Sphere { radius },
            PalmSurface::Cup { radius },
            PalmSurface::Cylinder { radius },
        ] {
            let inward = matches!(surface, PalmSurface::Cup { .. });
            assert_eq!(guess_shape(&on(surface), inward), Some(surface));
        }
        assert_eq!(guess_shape(&on(PalmSurface::Plane)[..5], false), None);
        let anywhere: Vec<DVec3> = (0..9).map(|k| DVec3::new(1.0, f64::from(k), 1.0)).collect();
        assert_eq!(guess_shape(&anywhere, false), None);
    }
}
