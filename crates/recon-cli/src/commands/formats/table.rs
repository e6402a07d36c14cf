//! The columns of all formats. `i` stands for the number of a palm, from 1.

/// A kind of file.
pub(super) struct Format {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    pub(super) columns: &'static [Column],
}

/// Columns that belong together, by comma, or from one to another (`nx_i..nz_i`).
pub(super) struct Column {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    pub(super) needed: bool,
}

const fn needed(name: &'static str, unit: &'static str, meaning: &'static str) -> Column {
    Column { name, unit, meaning, needed: true }
}

const fn may(name: &'static str, unit: &'static str, meaning: &'static str) -> Column {
    Column { name, unit, meaning, needed: false }
}

const TRUTH: Column = may(
    "cmx..cmz, qw..qz, vx..vz, wx..wz",
    "m, 1, m/s, rad/s",
    "truth, to compare with alone: centre of mass, body to world, velocities in world axes",
);

const MODE: Column = may(
    "mode_i",
    "-",
    "contact mode of the palm: 0 off, 1 slides, 2 sticks; while it is followed the one to act on",
);
const MODE_ODDS: Column = may(
    "p_slide_i, p_stick_i",
    "-",
    "how probable it is that palm i slides and that it sticks; off is what is left to 1",
);

pub(super) const FORMATS: [Format; 26] = [
    Format {
        name: "log",
        about: "sensor log, version 1: three flat palms through the origin. t1 of a palm is horizontal, t2 points up it, n towards the object, t1 = t2 x n",
        columns: &[
            needed("t", "s", "time, strictly increasing"),
            needed("s1_i, s2_i", "m", "contact in the palm's frame, s1 t1 + s2 t2; both nan without contact"),
            needed("nx_i..nz_i", "1", "unit normal of the palm, world axes, towards the object"),
            may("f_i", "N", "size of the normal force; 0 without contact"),
            may("tau_i", "N m", "torque of the palm's motor about t1"),
            may("rate_i", "rad/s", "rate of rotation about t1; else taken from the normals"),
            TRUTH,
        ],
    },
    Format {
        name: "log-2",
        about: "sensor log, version 2: one to five palms of any shape and motion, which stand in the scene's [[palm]] tables in the same order",
        columns: &[
            needed("t", "s", "time, strictly increasing"),
            needed(
                "px_i..pz_i",
                "m",
                "contact point, world; nan without contact (or sx_i..sz_i in the palm's frame)",
            ),
            may("sx_i..sz_i", "m", "contact point in the palm's frame, in place of px_i..pz_i"),
            may(
                "Px_i..Pz_i, Qw_i..Qz_i",
                "m, 1",
                "pose of the palm's frame, palm to world; needed unless the scene has it",
            ),
            may(
                "Vx_i..Vz_i, Wx_i..Wz_i",
                "m/s, rad/s",
                "velocity of the frame's origin, angular velocity, world axes",
            ),
            may("fx_i..fz_i", "N", "force on the object, world axes"),
            may("fn_i", "N", "its part along the palm's normal, in place of fx_i..fz_i"),
            may("Jx_i..Jz_i", "N s", "integral of the force since one time for the whole log"),
            may("Jn_i", "N s", "its part along the palm's normal, in place of Jx_i..Jz_i"),
            may("tau_i", "N m", "torque of the palm's motor; nan where it was not measured"),
            may(
                "gap_i, slip_i, mode_i",
                "m, m/s, -",
                "truth: distance, speed of slip; 0 off, 1 slides, 2 sticks",
            ),
            TRUTH,
        ],
    },
    Format {
        name: "planar-log",
        about: "planar sensor log, version 1: two palms hinged at the origin",
        columns: &[
            needed("t", "s", "time, strictly increasing"),
            needed("phi1, phi2", "rad", "palm 1 against the world, palm 2 against palm 1"),
            needed("s1, s2", "m", "contacts, from the hinge along each palm; nan without contact"),
            may("f1, f2", "N", "normal forces"),
            may("tau1, tau2", "N m", "torques of the palms' motors"),
            may("cmx, cmy, phi0, vx, vy, omega0", "m, rad, m/s, rad/s", "truth"),
        ],
    },
    Format {
        name: "planar-log-2",
        about: "planar sensor log, version 2: palms of any number, shape and motion; x to the right, y up, angles counter-clockwise",
        columns: &[
            needed("t", "s", "time, strictly increasing"),
            needed("px_i, py_i", "m", "contact point, world; nan without contact"),
            needed(
                "Px_i, Py_i, angle_i",
                "m, rad",
                "origin of the palm's frame, and its x axis against the world's",
            ),
            needed("fx_i, fy_i", "N", "force on the object, world axes; 0 or nan without contact"),
            may("Jx_i, Jy_i", "N s", "its integral since one time for the whole log"),
            may("cmx, cmy, phi0, vx, vy, omega0", "m, rad, m/s, rad/s", "truth"),
        ],
    },
    Format {
        name: "contacts",
        about: "contact points with outward normals in any one frame of the object (recon bounds); in the plane without z and nz",
        columns: &[
            needed("x, y, z", "m", "point on the surface"),
            needed("nx, ny, nz", "1", "outward unit normal there"),
            may("palm", "-", "a new curve begins where the number changes (or curve)"),
            may("curve", "-", "in place of palm"),
        ],
    },
    Format {
        name: "poses",
        about: "poses of a body above a plane, sampled evenly (recon bounds)",
        columns: &[
            needed("qw, qx, qy, qz", "1", "unit quaternion, body to world"),
            needed("px, py, pz", "m", "origin of the body, world, z up"),
            may("toss", "-", "a new run begins where the number changes (or run)"),
            may("run", "-", "in place of toss"),
            may("frame", "-", "counts by ones within a run"),
        ],
    },
    Format {
        name: "push-samples",
        about: "samples of pushes by a round finger on a table (recon pushes); world frame, in the plane of the table",
        columns: &[
            may("log", "-", "number of the log: one object, finger and table; else all is log 0"),
            needed("push", "-", "number of the push within its log"),
            needed("t", "s", "time since the push began; does not run backward"),
            needed("fx, fy", "N", "force of the finger on the object"),
            needed("finger_x, finger_y", "m", "centre of the finger"),
        ],
    },
    Format {
        name: "push-poses",
        about: "poses of the pushed object before and after each push (recon pushes); origin in the centre of mass",
        columns: &[
            may("log", "-", "as in push-samples"),
            needed("push", "-", "number of the push; a row for each"),
            needed("pre_x, pre_y, pre_theta", "m, rad", "pose before it: origin, angle counter-clockwise"),
            needed("post_x, post_y, post_theta", "m, rad", "pose after it"),
        ],
    },
    Format {
        name: "push-outline",
        about: "outline.csv of recon pushes: points all around the object, counter-clockwise, in the frame of the poses",
        columns: &[
            needed("log", "-", "number of the log"),
            needed("x, y", "m", "point"),
            needed("nx, ny", "1", "unit normal out of the object"),
            needed("std", "m", "standard deviation of the outline along it"),
            needed("to_touch", "m", "way along the outline to the nearest touched stretch; 0 on one"),
        ],
    },
    Format {
        name: "push-corners",
        about: "corners.csv of recon pushes: corners of a polygon, counter-clockwise; none of a smooth outline",
        columns: &[
            needed("log, corner", "-", "number of the log, of the corner from 1"),
            needed("x, y", "m", "point, in the frame of the poses"),
            needed("std_x, std_y, cov_xy", "m, m, m^2", "standard deviations and covariance"),
            needed(
                "touch_before, touch_after",
                "m",
                "ways along the outline to the nearest touch, clockwise and on",
            ),
        ],
    },
    Format {
        name: "push-touches",
        about: "touches.csv of recon pushes: where each push first and last touched the outline",
        columns: &[
            needed("log, push, end", "-", "number of log and push; 0 at the first, 1 at the last touch"),
            needed("x, y", "m", "point of the outline"),
            needed("gap", "m", "what the fit leaves between finger and outline"),
        ],
    },
    Format {
        name: "push-modes",
        about: "modes.csv of recon pushes: sticking or sliding at each instant under load; left and right as the finger looks at the object",
        columns: &[
            needed("log, push", "-", "number of log and push"),
            needed("t", "s", "time since the push began"),
            needed("x, y", "m", "touched point of the outline"),
            needed("ratio", "1", "friction over normal force, positive to the left"),
            needed("slip", "m/s", "of the finger over the outline, positive to the left"),
            needed("stick, left, right", "1", "probabilities; they sum to one"),
            needed("mode", "-", "the most probable: 1 slides to the left, 2 sticks, 3 slides to the right"),
            needed(
                "px, py, theta",
                "m, rad",
                "pose by which it was judged: inferred between those that were measured",
            ),
        ],
    },
    Format {
        name: "motion",
        about: "motion.csv: the estimated motion, in body axes of the estimate, with deviations; where forces were used with modes, their probabilities and marks",
        columns: &[
            needed("t", "s", "time"),
            needed(
                "cmx..cmz, qw..qz, vx..vz, wx..wz",
                "m, 1, m/s, rad/s",
                "centre of mass, body to world, velocities in world axes",
            ),
            may(
                "std_cmx..std_cmz, std_vx..std_vz, std_wx..std_wz",
                "m, m/s, rad/s",
                "standard deviations, world axes",
            ),
            may(
                "std_turnx..std_turnz",
                "rad",
                "standard deviations of the turn since the first sample, world axes",
            ),
            MODE,
            MODE_ODDS,
            may("relied_on", "-", "1 where the motion is relied on to within its deviations"),
        ],
    },
    Format {
        name: "planar-motion",
        about: "motion.csv of a log in the plane: the estimated motion with deviations, modes, their probabilities, and marks",
        columns: &[
            needed("t", "s", "time"),
            needed(
                "x, y, phi0, vx, vy, omega0",
                "m, rad, m/s, rad/s",
                "centre of mass, turn since the first sample, velocities, world axes",
            ),
            may(
                "std_x, std_y, std_phi0, std_vx, std_vy, std_omega0",
                "m, rad, m/s, rad/s",
                "standard deviations of these",
            ),
            MODE,
            MODE_ODDS,
            may("relied_on", "-", "1 where the motion is relied on to within its deviations"),
        ],
    },
    Format {
        name: "contact-points",
        about: "contact_points.csv of a log in the plane: where the palms touched the object, in the axes of the world at the first sample, from the centre of mass",
        columns: &[
            needed("palm", "-", "number of the palm, from 1"),
            needed("t", "s", "time"),
            needed("x, y", "m", "point"),
            needed("nx, ny", "1", "outward unit normal"),
        ],
    },
    Format {
        name: "contact-curves",
        about: "contact_curves.csv: where the palms touched the object, body axes from the centre of mass",
        columns: &[
            needed("palm", "-", "number of the palm, from 1"),
            needed("t", "s", "time"),
            needed("x, y, z", "m", "point"),
            needed("nx, ny, nz", "1", "outward unit normal"),
        ],
    },
    Format {
        name: "contact-marks",
        about: "contact_marks.csv: what each contact that bounds the object is on, where it is not smooth; recon bounds reads it",
        columns: &[
            needed("curve", "-", "number of the curve or palm, from 1"),
            needed("contact", "-", "number of the contact in its curve, or of the log's sample, from 1"),
            needed("x, y, z", "m", "point"),
            needed("nx, ny, nz", "1", "outward unit normal"),
            needed("kind", "-", "0 open, 1 smooth, 2 corner, 3 edge, 4 face"),
            needed("feature", "-", "which corner, edge or face of the summary, from 1; 0 for none"),
            needed("log_odds", "-", "natural logarithm of the odds for its kind against all others"),
        ],
    },
    Format {
        name: "following",
        about: "table of recon follow: the motion as it becomes known; nan before it is found",
        columns: &[
            needed("t", "s", "time"),
            needed(
                "cmx..cmz, qw..qz, vx..vz, wx..wz",
                "m, 1, m/s, rad/s",
                "centre of mass, body to world, velocities in world axes",
            ),
            needed(
                "std_cm, std_v, std_w, std_turn",
                "m, m/s, rad/s, rad",
                "standard deviations, all axes together",
            ),
            needed("stage", "-", "gathering, searching, tracking, contradicted"),
            needed("relied_on", "-", "1 where the motion is relied on"),
            needed("misfit", "-", "about 1 where all is as stated"),
            needed("mass, std_mass", "kg", "where they are estimated along, else nan"),
            MODE,
            MODE_ODDS,
            may("doubt_i", "-", "what contradicts the readings that the palm's modes rest on, or none"),
        ],
    },
    Format {
        name: "batch",
        about: "results.csv of recon batch: a row for each log; nan where a number is not known",
        columns: &[
            needed("log", "-", "name of the file"),
            needed("state", "-", "relied on, not relied on, skipped"),
            needed("seconds", "s", "time that it took"),
            needed("samples, duration_s", "-, s", "of the log"),
            needed("mass_kg, std_mass_kg", "kg", "mass and its standard deviation"),
            needed("moment_x_kg_m2, std_moment_x_kg_m2", "kg m^2", "least principal moment"),
            needed("moment_y_kg_m2, std_moment_y_kg_m2", "kg m^2", "middle principal moment"),
            needed("moment_z_kg_m2, std_moment_z_kg_m2", "kg m^2", "largest principal moment"),
            needed("misfit", "-", "chi-squared a condition, about 1 where noise explains what is left"),
            needed(
                "relied_on_share",
                "-",
                "share of the samples whose motion is relied on, where that is known",
            ),
            needed(
                "inertia_kg_m2, std_inertia_kg_m2",
                "kg m^2",
                "of a log in the plane: moment of inertia and its standard deviation",
            ),
            needed("lower_volume_m3, upper_volume_m3", "m^3", "volumes of the bounds"),
            needed("lower_area_m2, upper_area_m2", "m^2", "of a log in the plane: areas of the bounds"),
            needed("warnings", "-", "how many there are"),
            needed("why", "-", "the verdict, or why the log was skipped"),
        ],
    },
    Format {
        name: "contour",
        about: "contour.csv of recon explore --contour: touches of a round finger along an outline, counter-clockwise; of one followed once round the last is past the first",
        columns: &[
            needed("touch", "-", "number of the touch, from 1"),
            needed("x, y", "m", "point of the outline"),
            needed(
                "nx, ny",
                "1",
                "outward unit normal there; the finger's centre is its radius along it away",
            ),
            needed("way", "m", "motion of the finger's centre from the touch before"),
        ],
    },
    Format {
        name: "jumps",
        about: "jumps.csv of recon explore --contour: where the finger does not get in",
        columns: &[
            needed("after", "-", "number of the touch before it"),
            needed("x1, y1, x2, y2", "m", "the contacts before and after it"),
            needed("mouth", "m", "how far they are apart"),
            needed(
                "radius_at_most",
                "m",
                "mean radius of curvature of what is between at most, if it was felt after all",
            ),
        ],
    },
    Format {
        name: "outline",
        about: "scene of an outline (TOML) for recon explore --contour; a scene of the plane with the shape of an object serves as well",
        columns: &[
            may("finger.radius", "m", "radius of the round finger; else --finger"),
            may(
                "outline.points",
                "m",
                "points, in either sense, of a closed curve that is twice differentiable: 4 or more, as [[x, y], ..]",
            ),
            may(
                "outline.waves",
                "m, 1, -",
                "or r = size (1 + depth cos(count angle)): { size, depth, count }",
            ),
        ],
    },
    Format {
        name: "covariance",
        about: "covariance.csv of recon reconstruct --covariance: beside each row of motion.csv the covariance of the pose, on and above the diagonal",
        columns: &[
            needed("t", "s", "time"),
            needed(
                "cov_cmx_cmx, cov_cmx_cmy .. cov_turnz_turnz",
                "m^2, m rad, rad^2",
                "of centre of mass and turn since the first sample, world axes; in the plane cov_x_x, cov_x_y .. cov_phi0_phi0",
            ),
        ],
    },
    Format {
        name: "relief",
        about: "relief.csv of recon explore --relief: touches of a round finger that comes down on lines; jumps.csv has both contacts of each jump as x1 .. z2, misses.csv the lines that met nothing",
        columns: &[
            needed("x, y, z", "m", "point of the surface; of a miss the line's point nearest to the origin"),
            needed("nx, ny, nz", "1", "outward unit normal there"),
            needed("ax, ay, az", "1", "where the finger came from"),
        ],
    },
    Format {
        name: "surface",
        about: "scene of a surface (TOML) for recon explore --relief",
        columns: &[
            may("finger.radius", "m", "radius of the round finger; else --finger"),
            needed("surface.size", "m", "mean distance of the surface from its centre"),
            may(
                "surface.waves",
                "1, 1, -",
                "by which it is farther: a list of { axis, depth, count }, size times the sum of depth cos(count angle), the angle from the axis",
            ),
        ],
    },
    Format {
        name: "scene",
        about: "scene file (TOML): what is known beside a log; recon init writes one with each key explained",
        columns: &[
            needed("gravity", "m/s^2", "along -z of the world"),
            may("object.mass", "kg", "mass, where it is known"),
            may(
                "object.principal_moments",
                "kg m^2",
                "about the centre of mass; or inertia (3 x 3, body axes), or radii_of_gyration (m)",
            ),
            may("object.size", "m", "mean radius, about; needed where all contacts are on one palm"),
            may("object.curvature_radii", "m", "limits on the principal radii of curvature"),
            may("sensors.contact_std", "m", "noise of a contact in each direction of the palm"),
            may("sensors.force_std, sensors.force_share", "N, 1", "noise of forces: fixed, and as a share"),
            may(
                "sensors.impulse_std, sensors.impulse_share",
                "N s, 1",
                "noise of impulses from sample to sample",
            ),
            may("sensors.torque_std", "N m", "noise of torques"),
            may("sensors.contact_off_palm", "m", "how far a contact may be from its palm"),
            may("palms.friction", "1", "coefficient of palms that state none"),
            may(
                "[[palm]] kind, radius, friction, pose, motion",
                "m",
                "a palm: flat, sphere, cup or cylinder; one table for each, in the order of the log",
            ),
            may("[simulation]", "", "shape, start, duration and sample_rate, for recon simulate alone"),
        ],
    },
];
