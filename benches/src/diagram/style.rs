//! Colours and markers: the Okabe-Ito set, which colour-blind readers can tell apart, and one marker per curve for
//! print in grey.

use super::Verdict;

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
    Cross,
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

impl Style {
    /// The style of the curve with this index; 56 curves differ in colour or marker.
    pub(super) fn of_method(index: usize) -> Self {
        Self {
            colour: COLOURS[index % COLOURS.len()],
            marker: MARKERS[index % MARKERS.len()],
            line_width: 2.0,
            size: 4.5,
        }
    }

    /// Points of a sweep: the colour says the verdict. Wrong without a warning is a large red cross.
    pub(super) fn of_verdict(verdict: Verdict, marker: Marker) -> Self {
        let (colour, marker, size) = match verdict {
            Verdict::Right => ("#0072B2", marker, 4.5),
            Verdict::ReportedAsUnreliable => ("#E69F00", marker, 4.5),
            Verdict::WrongWithoutWarning => ("#B00020", Marker::Cross, 7.0),
        };
        Self { colour, marker, line_width: 0.0, size }
    }

    /// Legend entry of a marker whose colour carries another meaning.
    pub(super) fn neutral(marker: Marker) -> Self {
        Self { colour: "#7B8794", marker, line_width: 0.0, size: 4.5 }
    }

    /// The thin line that joins the points of one subject of a sweep.
    pub(super) fn thread() -> Self {
        Self { colour: "#CBD2D9", marker: Marker::None, line_width: 1.2, size: 0.0 }
    }

    /// A goal on a work-precision chart.
    pub(super) fn goal() -> Self {
        Self { colour: "#1F2933", marker: Marker::Star, line_width: 0.0, size: 6.5 }
    }
}

impl Marker {
    /// The marker of the subject of a sweep with this index.
    pub(super) fn of_subject(index: usize) -> Self {
        MARKERS[index % MARKERS.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_methods_never_look_alike() {
        let count = COLOURS.len() * MARKERS.len();
        for i in 0..count {
            for j in 0..i {
                let (a, b) = (Style::of_method(i), Style::of_method(j));
                assert!(a.colour != b.colour || a.marker != b.marker, "{i} {j}");
            }
        }
    }
}
