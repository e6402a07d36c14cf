//! Logs of palms of any shape with friction, made by MuJoCo: as they are read, they obey mechanics as far as that simulator does.
//!
//! Excerpts are in `data/`; the full logs are read where they lie unpacked beside the repository, and skipped aloud where not.

use glam::{DMat3, DVec3};
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::{ContactLog, ContactMode, SampleTimes, SensedAxes, TwistSource};
use recon_io::{AnyLog, PalmSetup, Scene, parse_contact_log, read_any_log, write_contact_log};
use std::path::{Path, PathBuf};

/// What is true of a scene, and how well its log keeps the laws: largest departures as they were measured when it was made.
struct Case {
    name: &'static str,
    surfaces: Vec<PalmSurface>,
    friction: f64,
    mass: f64,
    axes: DVec3,
    /// Of `m a - m g - sum f`, N, and of `d(I w)/dt - sum (p - cm) x f`, N m.
    balance: [f64; 2],
    /// Of `m (v - v0) - m g t - sum J` with the numbers of the simulator, N s.
    impulse: f64,
    /// Largest gap in contact, m.
    gap: f64,
}

fn case(
    name: &'static str,
    surfaces: &[PalmSurface],
    [friction, mass]: [f64; 2],
    axes: [f64; 3],
    [newton, euler, impulse, gap]: [f64; 4],
) -> Case {
    let (surfaces, axes) = (surfaces.to_vec(), axes.into());
    Case { name, surfaces, friction, mass, axes, balance: [newton, euler], impulse, gap }
}

const FLAT: PalmSurface = PalmSurface::Plane;
const FINGERTIP: PalmSurface = PalmSurface::Sphere { radius: 0.012 };

fn cases() -> [Case; 2] {
    [
        case("S2", &[FLAT; 3], [0.3, 0.2], [0.05, 0.04, 0.03], [1.9e-7, 4.9e-9, 8.0e-9, 6.7e-8]),
        case("S4", &[FINGERTIP; 3], [0.8, 0.1], [0.035, 0.03, 0.025], [5.3e-8, 1.7e-9, 1.4e-10, 1.5e-6]),
    ]
}

/// The other logs of the same maker.
fn more_cases() -> [Case; 6] {
    let cups = [PalmSurface::Cup { radius: 0.08 }, PalmSurface::Cup { radius: 0.1 }];
    [
        case("S1", &[FLAT; 3], [0.05, 1.0], [2.5, 2.0, 1.0], [9.9e-7, 7.0e-7, 1.8e-7, 3.2e-7]),
        case("S3", &[FLAT; 4], [0.5, 0.25], [0.045, 0.035, 0.03], [3.2e-7, 1.0e-8, 1.1e-8, 8.1e-7]),
        case("S5", &[FLAT; 2], [0.8, 0.12], [0.035, 0.03, 0.025], [1.0e-14, 7.3e-16, 3.3e-13, 1.8e-6]),
        case("S6", &[FLAT], [0.2, 0.15], [0.05, 0.04, 0.025], [2.4e-8, 6.2e-10, 6.2e-10, 1.7e-7]),
        case("S7", &cups, [0.3, 0.2], [0.04, 0.035, 0.03], [2.8e-7, 8.8e-9, 6.0e-10, 1.2e-6]),
        case("S8", &[FLAT; 3], [0.3, 0.2], [0.05, 0.04, 0.03], [3.6e-7, 1.1e-8, 7.8e-9, 1.6e-5]),
    ]
}

fn read(case: &Case, path: &Path) -> ContactLog {
    let setup = |surface: &PalmSurface| PalmSetup {
        surface: *surface,
        friction: Some(case.friction),
        pose: None,
        hinge: None,
        largest_offset: 1.1 * case.gap,
    };
    let palms: Vec<_> = case.surfaces.iter().map(setup).collect();
    match read_any_log(path, Some(&palms)) {
        Ok(AnyLog::Contacts(log)) => log,
        other => panic!("{}: {other:?}", case.name),
    }
}

/// Three columns of the file as vectors: what a sensor log does not hold.
fn vectors(path: &Path, names: [&str; 3]) -> Vec<DVec3> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header: Vec<_> = lines.next().unwrap().split(',').collect();
    let places = names.map(|name| header.iter().position(|h| *h == name).unwrap());
    let row = |line: &str| {
        let cells: Vec<_> = line.split(',').collect();
        DVec3::from_array(places.map(|place| cells[place].parse().unwrap()))
    };
    lines.map(row).collect()
}

const GRAVITY: DVec3 = DVec3::new(0.0, 0.0, -9.81);
/// Half a unit of the tenth digit, relative: what printing left of a number.
const PRINTED: f64 = 5e-10;

/// `m a = m g + sum f` and `d(I w)/dt = sum (p - cm) x f` at every sample, with the simulator's own accelerations.
fn balances(case: &Case, log: &ContactLog, path: &Path) {
    let (a, alpha) = (vectors(path, ["ax", "ay", "az"]), vectors(path, ["alx", "aly", "alz"]));
    let squares = case.axes * case.axes;
    let moments =
        case.mass / 5.0 * DVec3::new(squares.y + squares.z, squares.x + squares.z, squares.x + squares.y);
    let mut worst = [0.0_f64; 2];
    for (k, state) in log.truth().unwrap().iter().enumerate() {
        let turn = DMat3::from_quat(state.R_WO);
        let inertia = turn * DMat3::from_diagonal(moments) * turn.transpose();
        let mut newton = case.mass * (a[k] - GRAVITY);
        let mut euler = inertia * alpha[k] + state.w_WO.cross(inertia * state.w_WO);
        let (mut forces, mut moved) = (newton.length(), 0.0);
        for palm in log.palms() {
            let force = palm.force(k).unwrap().vector;
            newton -= force;
            if let Some(touch) = palm.touch(k) {
                euler -= (touch.p_WC - state.p_WCm).cross(force);
                forces += force.length();
                // The contact was put on the palm, along the normal, from no farther off than the gap.
                moved += force.cross(touch.n.get()).length() * palm.truth(k).unwrap().gap.abs();
            }
        }
        let printed =
            [4.0 * PRINTED * forces, 8.0 * PRINTED * forces * case.axes.max_element() + 1.01 * moved];
        let left = [newton.abs().max_element(), euler.abs().max_element()];
        for i in 0..2 {
            // The figures are given to two digits.
            let allowed = 1.05 * case.balance[i] + printed[i];
            assert!(left[i] < allowed, "{} {k}: {left:?}, printed {printed:?}", case.name);
            worst[i] = worst[i].max(left[i]);
        }
    }
    println!("{}: left {:.1e} N, {:.1e} N m", case.name, worst[0], worst[1]);
}

/// `m dv = sum J + m g dt` over every interval, blows included.
fn impulses(case: &Case, log: &ContactLog) {
    let truth = log.truth().unwrap();
    let mut total = [DVec3::ZERO; 5];
    for k in 1..log.times().len() {
        let dt = log.times()[k] - log.times()[k - 1];
        let mut left = case.mass * (truth[k].v_WCm - truth[k - 1].v_WCm - GRAVITY * dt);
        let mut printed = 2.0 * case.mass * truth[k].v_WCm.length() * PRINTED;
        for (palm, total) in log.palms().iter().zip(&mut total) {
            let impulse = palm.impulse(k).unwrap();
            assert_eq!(impulse.axes, SensedAxes::Three);
            left -= impulse.vector;
            *total += impulse.vector;
            printed += 4.0 * total.length() * PRINTED;
        }
        assert!(
            left.abs().max_element() < 2.0 * case.impulse + printed,
            "{} {k} {left} {printed}",
            case.name
        );
    }
}

/// Modes, slip and normals: what is computed at reading against what the simulator wrote beside it.
fn contacts(case: &Case, log: &ContactLog, path: &Path) {
    for (i, palm) in log.palms().iter().enumerate() {
        let normals = vectors(
            path,
            ["nx", "ny", "nz"].map(|n| format!("{n}_{}", i + 1)).each_ref().map(String::as_str),
        );
        let (mut slides, mut off, mut off_cone) = (0, 0, 0);
        for (k, state) in log.truth().unwrap().iter().enumerate() {
            let (contact, motion) = (palm.truth(k).unwrap(), palm.motion(k));
            let Some(touch) = palm.touch(k) else {
                assert_eq!(contact.mode, ContactMode::Off);
                off += 1;
                continue;
            };
            let n = touch.n.get();
            let extent = palm.surface().radius().unwrap_or(1.0);
            assert!((n - normals[k]).length() < 8.0 * PRINTED * (1.0 + 0.1 / extent), "{} {k}", case.name);
            let velocity = state.v_WCm + state.w_WO.cross(touch.p_WC - state.p_WCm);
            let slip = velocity - motion.material_velocity(touch.p_WC);
            let slip = (slip - slip.dot(n) * n).length();
            // Slip is printed to three digits; a contact that moves by the gap sees another material.
            let allowed = 6e-3 * contact.slip + 2.0 * case.gap * (state.w_WO - motion.w_WP).length() + 1e-9;
            assert!((slip - contact.slip).abs() < allowed, "{} {k}: {slip} {}", case.name, contact.slip);
            let force = palm.force(k).unwrap().vector;
            let along = force.dot(n);
            let tangential = (force - along * n).length();
            if contact.mode == ContactMode::Slide {
                slides += 1;
                let printed = 16.0 * PRINTED * (1.0 + 0.1 / extent) * along;
                off_cone += usize::from((tangential - case.friction * along).abs() > printed);
            }
        }
        // Of a blow: the force at its sample is not that of a contact that slides on.
        assert!(100 * off_cone <= slides, "{}: {off_cone} of {slides}", case.name);
        println!("{} palm {}: {slides} slide, {off} off, of {}", case.name, i + 1, log.times().len());
        assert!(palm.twist_source() != TwistSource::FromPoses && palm.largest_offset() > 0.0);
    }
}

fn check(case: &Case, path: &Path) {
    let log = read(case, path);
    balances(case, &log, path);
    impulses(case, &log);
    contacts(case, &log, path);
    println!("{}: {} bytes per sample in memory", case.name, log.bytes_per_sample());
}

fn excerpt(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(format!("contacts_{name}.csv"))
}

#[test]
fn excerpts_of_contact_logs_obey_mechanics() {
    for case in cases() {
        check(&case, &excerpt(case.name));
    }
}

#[test]
fn full_contact_logs_obey_mechanics() {
    let folder: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "..", "..", "shared", "logs", "contacts"].iter().collect();
    let there: Vec<_> = cases()
        .into_iter()
        .chain(more_cases())
        .map(|case| (folder.join(format!("{}.csv", case.name)), case))
        .filter(|(path, _)| path.is_file())
        .collect();
    if there.is_empty() {
        println!("skipped: no full contact log lies unpacked beside this repository");
    }
    for (path, case) in there {
        check(&case, &path);
    }
}

#[test]
fn palms_with_friction_are_no_three_planes() {
    let log = read(&cases()[0], &excerpt("S2"));
    let refused = log.three_planes().unwrap_err().to_string();
    assert!(refused.contains("friction is felt on palm 1"), "{refused}");
    let log = read(&cases()[1], &excerpt("S4"));
    let refused = log.three_planes().unwrap_err().to_string();
    assert!(refused.contains("palm 1 is not flat but a sphere"), "{refused}");
}

#[test]
fn a_scene_file_becomes_a_log_file_that_reads_back() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/recon-cli/scenes/pick-up.toml");
    let scene = Scene::read(path).unwrap();
    let (start, times) = scene.contact_start().unwrap();
    let world = scene.contact_scene().unwrap();
    // Until the fingertips, which move in, touch.
    let times = SampleTimes { duration: 0.1, ..times };
    let simulation = world.simulate(&start, times, 1e-8).unwrap();
    let log = ContactLog::from_simulation(&world, &simulation).unwrap();
    let last = log.times().len() - 1;
    assert!(log.palms()[0].touch(last).is_some() && log.palms()[1].touch(last).is_none());
    let weight = log.palms()[0].force(last).unwrap().vector;
    assert!((weight - DVec3::Z * 0.981).length() < 1e-9 && log.palms()[1].motion(last).v_WP.y < -1e-3);
    let noisy = log.with_noise(&scene.sensors.contact_noise(), 1).unwrap();
    for log in [log, noisy] {
        let mut text = Vec::new();
        write_contact_log(&log, &mut text).unwrap();
        let back = parse_contact_log(&text[..], &scene.palm_setups().unwrap()).unwrap();
        assert_eq!(log.truth(), back.truth());
        for (a, b) in log.palms().iter().zip(back.palms()) {
            assert_eq!((a.surface(), a.friction()), (b.surface(), b.friction()));
            for k in 0..=last {
                assert_eq!((a.touch(k), a.motion(k), a.truth(k)), (b.touch(k), b.motion(k), b.truth(k)));
                assert_eq!((a.force(k), a.impulse(k)), (b.force(k), b.impulse(k)));
            }
        }
    }
}
