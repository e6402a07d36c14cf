//! Colours and markers: the Okabe-Ito set, which colour-blind readers can tell apart, and one marker per curve for
//! print in grey.

/// Shape of the points of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Marker {
    None,
    Circle,
    Square,
    Triangle,
    Diamond,
    TriangleDown,
    Pentagon,
    Hexagon,
    Star,
}

/// How a curve looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Style {
    pub(super) colour: &'static str,
    pub(super) marker: Marker,
    pub(super) line_width: f64,
    pub(super) size: f64,
}

const COLOURS: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#6A51A3", "#4D4D4D"];
const MARKERS: [Marker; 7] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::TriangleDown,
    Marker::Pentagon,
    Marker::Hexagon,
];

/// Methods that more than one diagram shows, each with the place of its colour and marker, so that it looks the same on all of them. Names are told by
/// how they begin.
const KNOWN: &[(&str, usize)] = &[
    ("minimal coordinates, DOP853", 0),
    ("multiplier form", 1),
    ("minimal coordinates, Runge-Kutta", 2),
    ("any palms", 2),
    ("MuJoCo", 3),
    ("Drake", 5),
    ("SciPy", 6),
    ("no noise", 0),
    ("from contacts, no guess", 0),
    ("0.1 %", 4),
    ("1 %", 2),
    ("(35)-(37), Adams, held", 17),
    ("(35)-(37), Adams", 9),
    ("(35)-(37), Heun", 25),
    ("random", 7),
    ("Gaussian process", 3),
    ("Hausdorff-greedy", 0),
    ("largest gap", 0),
    ("path-aware", 2),
    ("golden-angle sweep", 5),
    ("R2 sweep", 5),
    ("fixed sweep", 5),
    ("n* of", 6),
    ("area-greedy", 1),
    ("volume-greedy", 1),
    ("hull", 4),
    ("half-", 1),
    ("inner", 0),
    ("outer", 2),
];

impl Style {
    /// The styles of the curves of one diagram, by their names: known ones as on all diagrams, the others by what is left of 56 that differ in colour or
    /// marker.
    pub(super) fn of_methods<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<Self> {
        let places: Vec<Option<usize>> = names
            .into_iter()
            .map(|name| KNOWN.iter().find(|(known, _)| name.starts_with(known)).map(|(_, place)| *place))
            .collect();
        let mut taken: Vec<usize> = Vec::with_capacity(places.len());
        // Two of one family on one diagram (a version measured here and one recorded elsewhere) keep apart by their markers.
        let mut free = |wanted: Option<usize>| {
            let step = if wanted.is_some() { COLOURS.len() } else { 1 };
            let kept = |place: &usize| wanted == Some(*place) || !places.contains(&Some(*place));
            let own = (0..).map(|k| wanted.unwrap_or(0) + k * step).find(|p| !taken.contains(p) && kept(p));
            let own = own.unwrap_or_default();
            taken.push(own);
            own
        };
        places.iter().map(|wanted| Self::of_place(free(*wanted))).collect()
    }

    fn of_place(index: usize) -> Self {
        Self {
            colour: COLOURS[index % COLOURS.len()],
            marker: MARKERS[index % MARKERS.len()],
            line_width: 2.0,
            size: 4.5,
        }
    }

    /// Of a line without points.
    pub(super) fn without_marker(self) -> Self {
        Self { marker: Marker::None, line_width: 1.6, ..self }
    }

    /// A goal on a work-precision chart.
    pub(super) fn goal() -> Self {
        Self { colour: "#1F2933", marker: Marker::Star, line_width: 0.0, size: 6.5 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_never_look_alike() {
        let count = COLOURS.len() * MARKERS.len();
        for i in 0..count {
            for j in 0..i {
                let (a, b) = (Style::of_place(i), Style::of_place(j));
                assert!(a.colour != b.colour || a.marker != b.marker, "{i} {j}");
            }
        }
    }

    #[test]
    fn a_method_looks_the_same_wherever_it_is_and_two_never_alike_on_one_diagram() {
        let one = Style::of_methods(["new", "random", "MuJoCo 4.0.0", "MuJoCo 4.0, recorded", "other"]);
        let two = Style::of_methods(["MuJoCo 3", "random"]);
        assert_eq!((one[1], one[2]), (two[1], two[0]));
        assert_eq!(one[2].colour, one[3].colour);
        for (i, a) in one.iter().enumerate() {
            assert!(one[..i].iter().all(|b| a.colour != b.colour || a.marker != b.marker), "{i}");
        }
    }
}
