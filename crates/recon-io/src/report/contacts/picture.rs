//! Pictures of object and palms: a film of many instants, and a few of them beside it.

use super::super::page::section;
use super::view::View;
use crate::number::{brief_to, on_scale, push_pair};
use crate::planar_figures::{Turn, round_step};
use glam::{DVec2, DVec3};
use recon::object_dynamics::ContactMode;
use std::fmt::Write as _;

/// Pictures that stand still, and those of the film.
const STILLS: usize = 6;
const FILM: usize = 48;
/// How long the film takes at least and at most, s: else as long as the motion.
const LASTS: [f64; 2] = [4.0, 20.0];
/// Width of a picture and largest height, px.
const WIDTH: f64 = 290.0;
const HIGHEST: f64 = 1.5 * WIDTH;
const MARGIN: f64 = 6.0;
/// Height of the foot in which axes, gravity and a length stand, px.
const FOOT: f64 = 26.0;
/// Length of an axis, and of a scale bar at most, px.
const AXIS: f64 = 12.0;
const BAR: f64 = 45.0;
/// Longest arrow of a force in sizes of the object, and its head as a share of the arrow.
const LONGEST: f64 = 1.0;
const HEAD: f64 = 0.25;
/// Times the median of all forces beyond which one is a blow, whose arrow is cut.
const BLOW: f64 = 4.0;

/// A line of a picture, in m on the plane of view, in pieces.
pub(super) struct Line {
    pub(super) class: String,
    pub(super) pieces: Vec<Vec<DVec2>>,
}

/// What is farther than this from one point of a curve to the next, in sizes of the object, is not drawn through: the curve was elsewhere in between.
const APART: f64 = 0.25;

impl Line {
    pub(super) fn new(class: &str, points: Vec<DVec2>) -> Self {
        Self { class: class.to_owned(), pieces: vec![points] }
    }

    /// A curve through places, as far as there are any and they are near enough to each other for an object of this `size` (m); where hardly two
    /// are, dots.
    pub(super) fn through(
        class: &str,
        places: impl IntoIterator<Item = Option<DVec2>>,
        size: f64,
    ) -> Option<Self> {
        let places: Vec<Option<DVec2>> = places.into_iter().collect();
        let steps = || places.windows(2).filter_map(|of| Some(of[0]?.distance(of[1]?)));
        let far = steps().filter(|step| *step > APART * size).count();
        let dots = far > steps().count() / 5;
        let (mut pieces, mut last): (Vec<Vec<DVec2>>, _) = (Vec::new(), None);
        for place in places {
            match (place, last) {
                (Some(p), Some(before)) if !dots && p.distance(before) <= APART * size => {
                    pieces.last_mut().into_iter().for_each(|piece| piece.push(p));
                }
                (Some(p), _) => pieces.push(vec![p]),
                (None, _) => {}
            }
            last = place;
        }
        for piece in pieces.iter_mut().filter(|piece| piece.len() == 1) {
            piece.push(piece[0]);
        }
        let class = if dots { format!("{class} dots") } else { class.to_owned() };
        (!pieces.is_empty()).then_some(Self { class, pieces })
    }

    /// The palm `i` (from 0); lines that enclose nothing are `open`.
    pub(super) fn palm(i: usize, open: bool, points: Vec<DVec2>) -> Self {
        Self { class: format!("palm p{}{}", i + 1, if open { " open" } else { "" }), pieces: vec![points] }
    }

    /// The same before the object, which shows through.
    pub(super) fn in_front(self) -> Self {
        Self { class: self.class + " front", ..self }
    }

    /// A contact.
    pub(super) fn touch(mode: ContactMode, at: DVec2) -> Self {
        // A line without length under a round cap is a dot.
        Self { class: format!("touch m{}", mode.number()), pieces: vec![vec![at, at]] }
    }

    /// The centre of mass.
    pub(super) fn centre(at: DVec2) -> Self {
        Self::new("centre", vec![at, at])
    }

    /// A force on the object: an arrow that ends where it acts.
    pub(super) fn force(at: DVec2, force: DVec2, scale: ForceScale) -> Self {
        let shaft = (scale.per_newton * force).clamp_length_max(scale.longest);
        let side = |turn: f64| at - HEAD * DVec2::from_angle(turn).rotate(shaft);
        Self::new("force", vec![at - shaft, at, side(0.4), at, side(-0.4)])
    }
}

/// How long forces are drawn.
#[derive(Clone, Copy)]
pub(super) struct ForceScale {
    /// Of a newton, m.
    per_newton: f64,
    /// Of any force, m.
    longest: f64,
}

impl ForceScale {
    /// For an object of the size `reach`, m, and forces of these sizes, N. By the largest that is no blow: beside one all others would be too short to be
    /// seen.
    pub(super) fn new(reach: f64, forces: impl Iterator<Item = f64>) -> Self {
        let mut sizes: Vec<f64> = forces.filter(|force| force.is_finite() && *force > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        let largest = sizes.into_iter().rfind(|size| *size <= BLOW * usual);
        let longest = LONGEST * reach;
        Self { per_newton: largest.map_or(0.0, |largest| longest / largest), longest }
    }

    /// The same for an object so many times as large.
    pub(super) fn times(self, larger: f64) -> Self {
        Self { per_newton: self.per_newton * larger, longest: self.longest * larger }
    }
}

/// Where axes of the world are seen, and where gravity pulls: names and unit vectors on the picture.
pub(super) type Axes = Vec<(&'static str, DVec2)>;

/// Those of the vertical plane.
pub(super) fn axes_of_plane() -> Axes {
    vec![("x", DVec2::X), ("y", DVec2::Y), ("g", DVec2::NEG_Y)]
}

/// Those of space.
pub(super) fn axes_of_space(view: &View) -> Axes {
    let of = |axis| view.place(axis);
    vec![("x", of(DVec3::X)), ("y", of(DVec3::Y)), ("z", of(DVec3::Z)), ("g", of(DVec3::NEG_Z))]
}

/// What is seen at a time in s, from back to front.
pub(super) struct Picture {
    pub(super) t: f64,
    pub(super) lines: Vec<Line>,
    pub(super) axes: Axes,
}

/// A motion as it is shown: a film, and pictures of a few instants.
#[derive(Default)]
pub(super) struct Pictures {
    film: Vec<Picture>,
    stills: Vec<Picture>,
}

impl Pictures {
    /// Of samples, spread evenly over them.
    pub(super) fn of<T>(all: &[T], picture: impl Fn(&T) -> Picture) -> Self {
        let some = |count: usize| -> Vec<Picture> {
            let at = |k: usize| all.get(k * all.len().saturating_sub(1) / (count - 1));
            (0..count).filter_map(at).map(&picture).collect()
        };
        Self { film: some(FILM), stills: some(STILLS) }
    }

    /// Of the pictures that stand still, s.
    pub(super) fn times(&self) -> Vec<f64> {
        self.stills.iter().map(|picture| picture.t).collect()
    }

    /// All of them to one scale, with axes, gravity and a length, as a section of the page; none without any.
    pub(super) fn section(&self, caption: &str) -> String {
        if self.film.is_empty() {
            return String::new();
        }
        let paper = Paper::under(self.film.iter().chain(&self.stills));
        let stills: String = self.stills.iter().map(|picture| paper.still(picture)).collect();
        let shown = format!(
            "<div class=\"motion\">\n<figure class=\"panel film instant\">\n{}</figure>\n<div class=\"instants\">\n{stills}</div>\n</div>\n",
            paper.film(&self.film)
        );
        section("Object and palms", &shown, caption)
    }
}

/// Where what is seen is on a picture.
struct Paper {
    low: DVec2,
    high: DVec2,
    /// px a metre.
    scale: f64,
    /// px.
    left: f64,
    height: f64,
}

impl Paper {
    /// On which all pictures have room.
    fn under<'a>(pictures: impl Iterator<Item = &'a Picture> + Clone) -> Self {
        let points = || {
            pictures.clone().flat_map(|picture| &picture.lines).flat_map(|line| line.pieces.iter().flatten())
        };
        let low = points().fold(DVec2::INFINITY, |low, p| low.min(*p));
        let high = points().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
        let size = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let scale = ((WIDTH - 2.0 * MARGIN) / size.x).min((HIGHEST - 2.0 * MARGIN) / size.y);
        let (height, left) = (scale * size.y + 2.0 * MARGIN, 0.5 * (WIDTH - scale * size.x));
        Self { low, high, scale, left, height: on_scale(height, 100.0, 3) }
    }

    fn lines(&self, picture: &Picture) -> String {
        let place = |p: &DVec2| {
            let at = [self.left + self.scale * (p.x - self.low.x), MARGIN + self.scale * (self.high.y - p.y)];
            at.map(|v| on_scale(v, 100.0, 3))
        };
        let mut text = String::new();
        for line in &picture.lines {
            let _ = write!(text, "<path class=\"{}\" d=\"", line.class);
            for (i, piece) in line.pieces.iter().enumerate() {
                text += if i > 0 { " M" } else { "M" };
                for (k, at) in piece.iter().map(place).enumerate() {
                    text += if k > 0 { " L" } else { "" };
                    push_pair(&mut text, at, ' ');
                }
            }
            text += "\"/>\n";
        }
        text
    }

    fn still(&self, picture: &Picture) -> String {
        format!(
            "<figure class=\"panel instant\"><svg viewBox=\"0 0 {WIDTH} {}\" role=\"img\">\n{}</svg><figcaption>{}</figcaption></figure>\n",
            self.height,
            self.lines(picture),
            time(picture)
        )
    }

    fn film(&self, pictures: &[Picture]) -> String {
        let lasts = pictures.last().zip(pictures.first()).map_or(0.0, |(last, first)| last.t - first.t);
        let turn = Turn::new(pictures.len(), lasts.clamp(LASTS[0], LASTS[1]) / FILM as f64);
        let height = on_scale(self.height + FOOT, 100.0, 3);
        let mut out = format!("<svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\">\n{ROUND}{}", turn.style());
        for (k, picture) in pictures.iter().enumerate() {
            let (x, y) = (0.5 * WIDTH, self.height + FOOT - 8.0);
            let _ = writeln!(
                out,
                "<g {}>\n{}<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{}</text></g>",
                turn.attributes(k),
                self.lines(picture),
                time(picture)
            );
        }
        out += &pictures.first().map_or_else(String::new, |of| foot(&of.axes, self.height, self.scale));
        out + "</svg>\n"
    }
}

/// Light on the object, from above on the left.
const ROUND: &str = "<defs><radialGradient id=\"round\" cx=\".38\" cy=\".3\" r=\".8\"><stop class=\"near\" offset=\"0\"/>\
    <stop class=\"far\" offset=\"1\"/></radialGradient></defs>\n";

fn time(picture: &Picture) -> String {
    format!("t = {} s", on_scale(picture.t, 1.0, 3))
}

/// Axes and gravity as arrows with names, and a bar of a round length; `scale` is px a metre.
fn foot(axes: &Axes, top: f64, scale: f64) -> String {
    let mut out = String::new();
    let from = DVec2::new(AXIS + 8.0, top + 0.5 * FOOT);
    let place = |p: DVec2| p.to_array().map(|v| on_scale(v, 100.0, 3));
    for (name, axis) in axes {
        let along = DVec2::new(axis.x, -axis.y);
        // Gravity stands beside the axes, along one of which it pulls.
        let (class, from) = if *name == "g" {
            ("gravity", from + DVec2::new(2.0 * AXIS, -0.5 * AXIS))
        } else {
            ("axis", from)
        };
        let ([x, y], [to_x, to_y]) = (place(from), place(from + AXIS * along));
        let [name_x, name_y] = place(from + (AXIS + 4.0) * along);
        let head = if *name == "g" { " m-2 -3.5 l2 3.5 l2 -3.5" } else { "" };
        let _ = writeln!(out, "<path class=\"{class}\" d=\"M{x} {y} L{to_x} {to_y}{head}\"/>");
        let _ = writeln!(
            out,
            "<text x=\"{name_x}\" y=\"{}\" text-anchor=\"middle\">{name}</text>",
            on_scale(name_y + 2.0, 100.0, 3)
        );
    }
    // The largest round length of which the bar is no longer than it may be.
    let longest = BAR / scale;
    let step = round_step(0.5 * longest);
    let length = if step <= longest { step } else { 0.5 * longest };
    let (right, y) = (WIDTH - MARGIN - 4.0, top + FOOT - 8.0);
    let left = on_scale(right - scale * length, 100.0, 3);
    let _ = writeln!(out, "<path class=\"scale\" d=\"M{left} {} v4 m0 -2 H{right} m0 -2 v4\"/>", y - 2.0);
    let _ = writeln!(
        out,
        "<text x=\"{right}\" y=\"{}\" text-anchor=\"end\">{} m</text>",
        y - 5.0,
        brief_to(1, length)
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blow_leaves_the_arrows_of_other_forces_as_long_as_they_were() {
        let shaft = |scale: ForceScale, newton: f64| {
            let arrow = Line::force(DVec2::ZERO, DVec2::new(newton, 0.0), scale);
            arrow.pieces[0][0].distance(arrow.pieces[0][1])
        };
        let forces = [0.0, 1.0, 1.5, 2.0, f64::NAN];
        let [calm, struck] =
            [&[][..], &[1e4]].map(|blow: &[f64]| ForceScale::new(0.1, forces.iter().chain(blow).copied()));
        assert_eq!([1.0, 2.0].map(|of| shaft(calm, of)), [0.5 * LONGEST * 0.1, LONGEST * 0.1]);
        assert_eq!(shaft(struck, 1.0), shaft(calm, 1.0));
        // What would leave the picture is cut.
        assert!((shaft(struck, 1e4) - LONGEST * 0.1).abs() < 1e-15);
        assert_eq!(shaft(ForceScale::new(0.1, [0.0].into_iter()), 1.0), 0.0);
    }

    /// Of a size of 1 m: what is near is joined, what is not stands alone, and nothing goes through a gap.
    #[test]
    fn a_curve_is_not_drawn_through_what_it_did_not_touch() {
        let drawn = |places: &[Option<f64>]| {
            let places = places.iter().map(|x| x.map(|x| DVec2::new(x, 0.0)));
            let line = Line::through("trace", places, 1.0).unwrap();
            let pieces = line.pieces.iter().map(|piece| piece.iter().map(|p| p.x).collect());
            (line.class.clone(), pieces.collect::<Vec<Vec<f64>>>())
        };
        let near = [0.0, 0.1, 0.2, 0.3, 0.4, 1.0, 1.1].map(Some);
        let gap = [near.as_slice(), &[None, Some(1.2)]].concat();
        let pieces = vec![vec![0.0, 0.1, 0.2, 0.3, 0.4], vec![1.0, 1.1], vec![1.2, 1.2]];
        assert_eq!(drawn(&gap), ("trace".to_owned(), pieces));
        let dots = vec![vec![0.0, 0.0], vec![0.5, 0.5], vec![0.6, 0.6]];
        assert_eq!(drawn(&[0.0, 0.5, 0.6].map(Some)), ("trace dots".to_owned(), dots));
        assert!(Line::through("trace", [None, None], 1.0).is_none());
    }
}
