//! Scenes of tilting planes with fingertips, cups and cylinders in the place of some of them.

use recon::contact_kinematics::{
    Direction, Ellipsoid, PalmSurface, SupportFunction, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::{BodyState, ContactScene, ContactStart, PalmDrive, SampleTimes};
use shape_bounds::generators::Source;
use std::error::Error;

/// Draws of shapes that are tried for some that do not overlap.
const TRIED: usize = 100;

/// The same body at rest, on surfaces that touch it where the planes do, of shapes that are drawn until none overlap.
pub(crate) fn mixed(
    scene: &ContactScene<Ellipsoid>,
    start: &BodyState,
    source: &mut Source,
) -> Result<ContactScene<Ellipsoid>, Box<dyn Error>> {
    let mut drawn = once(scene, start, source);
    for _ in 1..TRIED {
        if drawn.is_ok() {
            break;
        }
        drawn = once(scene, start, source);
    }
    drawn
}

/// On surfaces that touch it where the planes do; radii in its largest semi-axes.
fn once(
    scene: &ContactScene<Ellipsoid>,
    start: &BodyState,
    source: &mut Source,
) -> Result<ContactScene<Ellipsoid>, Box<dyn Error>> {
    let largest = scene.body().semi_axes().max_element();
    let mut palms = scene.palms().to_vec();
    for (i, palm) in palms.iter_mut().enumerate() {
        let frame = scene.palm_state(i, 0.0, &scene.palms_at_start()[i]);
        let n = frame.R_WP.z_axis;
        let own = Direction::new(start.R_WO.inverse() * -n)?;
        let c = start.p_WCm + start.R_WO * scene.body().point(own);
        let (surface, centre) = match source.below(6) {
            0 | 1 => continue,
            2 | 3 => {
                let radius = largest * source.between(0.15, 0.6);
                (PalmSurface::Sphere { radius }, c - n * radius)
            }
            4 => {
                let radius = largest * source.between(4.0, 10.0);
                (PalmSurface::Cup { radius }, c + n * radius)
            }
            _ => {
                let radius = largest * source.between(0.15, 0.6);
                (PalmSurface::Cylinder { radius }, c - n * radius)
            }
        };
        palm.surface = surface;
        if let PalmDrive::Prescribed(SurfaceMotion::Parts { pose, .. }) = &mut palm.drive {
            *pose = SurfacePose::new(centre, pose.R_WP)?;
        }
    }
    let made = ContactScene::new(*scene.body(), *scene.mass(), palms, scene.gravity().length())?;
    made.simulate(&ContactStart::touching(*start), SampleTimes { duration: 1e-3, rate: 1000.0 }, 1e-6)?;
    Ok(made)
}
