//! The report's data as compact JSON: thinned in time, rounded to what a screen can show.

use super::contacts::doubtful_spans;
use super::contacts::estimate::BAND;
use super::data::{Bound, Departure, Level, MotionState, PalmTrack, ReportData, TrueShape};
use crate::TriangleMesh;
use crate::number::{on_scale, significant};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

/// Most times that a chart or a curve holds: about one per two pixels of a wide screen.
const MOST_TIMES: usize = 700;

/// Decimal places below the object's size to which points are rounded: 1e-5 of it is far below a pixel.
const PLACES: i32 = 5;

/// Everything that the page needs.
pub(super) fn encode(data: &ReportData) -> Value {
    let keep = thin(data.times.len());
    let size = size(data);
    json!({
        "title": data.title,
        "version": env!("CARGO_PKG_VERSION"),
        "size": significant(size, 4),
        "t": keep.iter().map(|&k| on_scale(data.times[k], duration(data), 5)).collect::<Vec<_>>(),
        "palms": ([0, 1, 2].map(|i| palm(data, i, &keep, size))),
        "motion": motion(&data.motion, &keep, size, DQuat::IDENTITY),
        "band": band(data, &keep),
        "doubtful": doubtful_spans(&data.times, &data.relied_on),
        // Beside the estimate: of a half turn rounding would decide on each sign.
        "truth": data.truth.as_ref().map(|truth| motion(truth, &keep, size, first_sign(&data.motion))),
        "departure": data.departures().map(|d| departure(&d, &keep)),
        "bounds": data.bounds.as_ref().map(|b| json!({
            "lower": bound(&b.lower, size),
            "upper": b.upper.as_ref().map(|u| bound(u, size)),
            "apart": b.largest_gap.map(|gap| vector(gap.outer, size)),
        })),
        "shape": data.true_shape.as_ref().map(|s| shape(s, size)),
    })
}

/// At most [`MOST_TIMES`] indices spread evenly over `0..count`, with the first and the last.
pub(super) fn thin(count: usize) -> Vec<usize> {
    if count <= MOST_TIMES {
        return (0..count).collect();
    }
    (0..MOST_TIMES).map(|k| (k * (count - 1) + (MOST_TIMES - 1) / 2) / (MOST_TIMES - 1)).collect()
}

fn duration(data: &ReportData) -> f64 {
    match (data.times.first(), data.times.last()) {
        (Some(first), Some(last)) => (last - first).max(first.abs()).max(last.abs()),
        _ => 0.0,
    }
}

/// Largest distance of a contact from the centre of mass: the length that everything is drawn against.
fn size(data: &ReportData) -> f64 {
    let contacts = data.palms.iter().flat_map(|p| p.contacts.iter().flatten());
    contacts.map(|c| c.p_OC.length()).filter(|l| l.is_finite()).fold(0.0, f64::max)
}

fn palm(data: &ReportData, i: usize, keep: &[usize], size: f64) -> Value {
    let track = &data.palms[i];
    let point = |of: fn(&super::PalmContact) -> DVec3| -> Vec<Option<f64>> {
        keep.iter().flat_map(|&k| optional_point(track.contacts[k].as_ref().map(of), size)).collect()
    };
    let radius = |k: usize| track.contacts[k].and_then(|c| number(on_scale(c.radius, size, PLACES)));
    let true_radius = |k: usize| {
        track.contacts[k].and(data.true_radii(k)).and_then(|r| number(on_scale(r[i], size, PLACES)))
    };
    json!({
        "normals": normals(track, keep),
        "world": point(|c| c.p_WC),
        "body": point(|c| c.p_OC),
        "radius": keep.iter().map(|&k| radius(k)).collect::<Vec<_>>(),
        // The palm's plane is known: what is not is the centre of mass along its normal.
        "radiusBand": keep.iter().map(|&k| half_height((track.frames[k].n * data.deviations[k][0]).length())).collect::<Vec<_>>(),
        "force": keep.iter().map(|&k| track.forces[k].and_then(|f| number(significant(f, 5)))).collect::<Vec<_>>(),
        "trueRadius": data.truth.as_ref().map(|_| keep.iter().map(|&k| true_radius(k)).collect::<Vec<_>>()),
    })
}

/// One normal for a palm that does not move, else one per time.
fn normals(track: &PalmTrack, keep: &[usize]) -> Vec<Option<f64>> {
    let still = track.frames.iter().all(|f| (f.n - track.frames[0].n).abs().max_element() < 1e-7);
    let shown = if still { &keep[..1] } else { keep };
    shown.iter().flat_map(|&k| vector(track.frames[k].n, 1.0)).collect()
}

fn motion(states: &[MotionState], keep: &[usize], size: f64, near: DQuat) -> Value {
    let largest = |of: fn(&MotionState) -> DVec3| {
        states.iter().map(|s| of(s).abs().max_element()).filter(|v| v.is_finite()).fold(0.0, f64::max)
    };
    let track = |of: fn(&MotionState) -> DVec3, scale: f64| -> Vec<Option<f64>> {
        keep.iter().flat_map(|&k| vector(of(&states[k]), scale)).collect()
    };
    json!({
        "p": track(|s| s.p_WCm, size),
        "q": orientations(states, keep, near),
        "w": track(|s| s.w_WO, largest(|s| s.w_WO)),
    })
}

/// Half the heights of the bands about the curves of the motion.
fn band(data: &ReportData, keep: &[usize]) -> Value {
    let track = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<Option<f64>> {
        keep.iter().flat_map(|&k| of(k)).map(half_height).collect()
    };
    let along = |i: usize| track(&|k| data.deviations[k][i].to_array().to_vec());
    // A turn `a` about the world's axes changes an orientation `q` by `(0, a) q / 2`.
    let orientation = |k: usize| {
        let q = data.motion[k].R_WO;
        let by_axis = |i: usize| {
            let turn = DVec3::AXES[i] * data.deviations[k][3][i];
            DQuat::from_xyzw(turn.x, turn.y, turn.z, 0.0) * q * 0.5
        };
        let [a, b, c] = [by_axis(0), by_axis(1), by_axis(2)];
        [|q: DQuat| q.w, |q: DQuat| q.x, |q: DQuat| q.y, |q: DQuat| q.z]
            .map(|of| DVec3::new(of(a), of(b), of(c)).length())
            .to_vec()
    };
    json!({ "p": along(0), "w": along(2), "q": track(&orientation) })
}

/// Half the height of a band about a number with this standard deviation.
fn half_height(deviation: f64) -> Option<f64> {
    number(significant(BAND * deviation, 3))
}

/// The first orientation, with the sign that is nearest to no rotation.
fn first_sign(states: &[MotionState]) -> DQuat {
    let first = states.first().map_or(DQuat::IDENTITY, |state| state.R_WO);
    if first.dot(DQuat::IDENTITY) < 0.0 { -first } else { first }
}

/// Quaternions, w first, with signs chosen so that neighbours agree and the first is the one nearest to `near`.
fn orientations(states: &[MotionState], keep: &[usize], near: DQuat) -> Vec<Option<f64>> {
    let mut before = near;
    let mut numbers = Vec::with_capacity(4 * keep.len());
    for &k in keep {
        let q = states[k].R_WO;
        let q = if q.dot(before) < 0.0 { -q } else { q };
        before = q;
        numbers.extend([q.w, q.x, q.y, q.z].map(|v| number(on_scale(v, 1.0, PLACES))));
    }
    numbers
}

/// How far the estimate is from the truth, at full precision before rounding.
fn departure(departures: &[Departure], keep: &[usize]) -> Value {
    let track = |of: fn(&Departure) -> f64| -> Vec<Option<f64>> {
        keep.iter().map(|&k| number(significant(of(&departures[k]), 3))).collect()
    };
    json!({
        "p": track(|d| d.position),
        "angle": track(|d| d.angle),
        "w": track(|d| d.angular_velocity),
    })
}

fn bound(bound: &Bound, size: f64) -> Value {
    let mut value = mesh(&bound.mesh, size);
    value["volume"] = json!(significant(bound.volume, 8));
    value
}

fn shape(shape: &TrueShape, size: f64) -> Value {
    let lines = shape.wireframe.iter().map(|l| l.iter().flat_map(|&p| vector(p, size)).collect::<Vec<_>>());
    json!({
        "mesh": mesh(&shape.mesh, size),
        "lines": lines.collect::<Vec<_>>(),
        "volume": shape.volume.map(|v| significant(v, 8)),
    })
}

fn mesh(mesh: &TriangleMesh, size: f64) -> Value {
    json!({
        "v": mesh.vertices.iter().flat_map(|&v| vector(v, size)).collect::<Vec<_>>(),
        "f": mesh.triangles.concat(),
    })
}

/// The name of a level in JSON.
pub(crate) fn level(level: Level) -> &'static str {
    match level {
        Level::Good => "good",
        Level::Caution => "caution",
        Level::Bad => "bad",
        Level::Neutral => "neutral",
    }
}

fn vector(v: DVec3, scale: f64) -> [Option<f64>; 3] {
    v.to_array().map(|x| number(on_scale(x, scale, PLACES)))
}

fn optional_point(p: Option<DVec3>, scale: f64) -> [Option<f64>; 3] {
    p.map_or([None; 3], |p| vector(p, scale))
}

/// JSON knows no NaN and no infinity.
fn number(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends_and_order() {
        for count in [2, 699, 700, 701, 4201, 1_000_000] {
            let keep = thin(count);
            assert_eq!((keep[0], keep[keep.len() - 1]), (0, count - 1));
            assert!(keep.len() <= MOST_TIMES && keep.windows(2).all(|w| w[0] < w[1]));
        }
    }
}
