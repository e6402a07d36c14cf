//! Curves of the page: angles of the force, friction of each push, gaps that the fit leaves.

use crate::planar_figures::{FigureCurve, FigurePanel};
use recon::object_dynamics::pushing::PushMode;
use recon::observer::pushes::{PushInstant, PushesEstimate};

/// Width of a bin of angles, degrees.
const BIN: f64 = 2.0;

pub(super) fn panels(told: &PushesEstimate) -> Vec<FigurePanel> {
    vec![angles(told), friction(told), friction_by_slip(told), gaps(told)]
}

fn curve(name: &str, points: Vec<[f64; 2]>, dots: bool) -> FigureCurve {
    FigureCurve { name: name.to_owned(), points, dots, ..FigureCurve::default() }
}

/// How often each angle between force and inward normal occurs, by mode.
fn angles(told: &PushesEstimate) -> FigurePanel {
    let instants: Vec<&PushInstant> = told.pushes.iter().flat_map(|p| &p.instants).collect();
    let degrees = |i: &PushInstant| i.ratio.atan().to_degrees();
    let most = instants.iter().map(|i| degrees(i).abs()).fold(10.0, f64::max).min(60.0);
    let bins = (most / BIN).ceil() as i32;
    let steps = |name: &str, mode: PushMode| {
        let mut points = Vec::new();
        for k in -bins..bins {
            let (from, to) = (f64::from(k) * BIN, f64::from(k + 1) * BIN);
            let there = |i: &&&PushInstant| i.mode() == mode && (from..to).contains(&degrees(i));
            let share = 100.0 * instants.iter().filter(there).count() as f64 / instants.len().max(1) as f64;
            points.extend([[from, share], [to, share]]);
        }
        curve(name, points, false)
    };
    // Colours follow the order of curves: blue, red, green.
    let curves = vec![
        steps("sticks", PushMode::Stick),
        steps("left", PushMode::Left),
        steps("right", PushMode::Right),
    ];
    let edge = told.friction.map(|f| {
        [f.value - 2.0 * told.spread[0], f.value + 2.0 * told.spread[0]]
            .map(|mu| mu.max(0.0).atan().to_degrees())
    });
    let shaded = edge.map_or_else(Vec::new, |[from, to]| vec![[from, to], [-to, -from]]);
    FigurePanel {
        title: "Angle of the force".to_owned(),
        axes: ["angle in degrees, left positive".to_owned(), "% of the time".to_owned()],
        curves,
        shaded,
        ..FigurePanel::default()
    }
}

/// A line with twice the deviation of the friction about it.
fn line(told: &PushesEstimate, name: &str, points: [[f64; 2]; 2]) -> FigureCurve {
    let deviation = told.friction.map_or(f64::NAN, |f| f.deviation);
    FigureCurve { half_heights: vec![2.0 * deviation; 2], ..curve(name, points.to_vec(), false) }
}

fn friction(told: &PushesEstimate) -> FigurePanel {
    let own = told.pushes.iter().filter_map(|p| Some([f64::from(p.number), p.friction?]));
    let numbers = || told.pushes.iter().map(|p| f64::from(p.number));
    let (from, to) = (numbers().fold(f64::INFINITY, f64::min), numbers().fold(f64::NEG_INFINITY, f64::max));
    FigurePanel {
        title: "Friction by push".to_owned(),
        axes: ["push".to_owned(), "coefficient".to_owned()],
        curves: told
            .friction
            .map(|f| line(told, "mean", [[from, f.value], [to, f.value]]))
            .into_iter()
            .chain([curve("one push", own.collect(), true)])
            .collect(),
        ..FigurePanel::default()
    }
}

/// Friction against the mean speed of the slip.
fn friction_by_slip(told: &PushesEstimate) -> FigurePanel {
    let own: Vec<[f64; 2]> = told
        .pushes
        .iter()
        .filter_map(|p| {
            let weight: f64 = p.instants.iter().map(|i| i.left + i.right).sum();
            let slip: f64 = p.instants.iter().map(|i| i.slip * (i.left - i.right)).sum();
            Some([1e3 * slip / weight, p.friction?])
        })
        .collect();
    let most = own.iter().fold(0.0, |most: f64, p| most.max(p[0]));
    FigurePanel {
        title: "Friction by speed of the slip".to_owned(),
        axes: ["slip in mm/s".to_owned(), "coefficient".to_owned()],
        curves: told
            .friction
            .map(|f| line(told, "all", [[0.0, f.at(0.0)], [most, f.at(1e-3 * most)]]))
            .into_iter()
            .chain([curve("one push", own, true)])
            .collect(),
        ..FigurePanel::default()
    }
}

fn gaps(told: &PushesEstimate) -> FigurePanel {
    let of =
        |i: usize| told.pushes.iter().map(|p| [f64::from(p.number), 1e3 * p.gaps[i]]).collect::<Vec<_>>();
    FigurePanel {
        title: "Gaps left by the outline".to_owned(),
        axes: ["push".to_owned(), "mm".to_owned()],
        curves: vec![curve("first touch", of(0), true), curve("last touch", of(1), true)],
        ..FigurePanel::default()
    }
}
