//! The one place that knows the plotting library (kuva).
//!
//! Logarithmic axes are drawn as linear axes of decimal logarithms with our own tick labels: kuva's own logarithmic
//! ticks stop at 1e-10, and errors near the rounding of a double lie well below that.

use std::sync::Arc;

use kuva::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::plot::legend::{LegendEntry, LegendPosition, LegendShape};
use kuva::plot::line::LineStyle;
use kuva::plot::{LinePlot, MarkerShape, ScatterPlot};
use kuva::render::annotations::TextAnnotation;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, TextAnchor, render_multiple};
use kuva::render::theme::Theme;

use super::axis::Scale;
use super::drawing::{Curve, Drawing, LegendItem, Place};
use super::notes::{Placed, placed};
use super::style::{Marker, Style};

const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 480.0;
/// Pixels of the raster image for each unit of the drawing.
const PIXELS: f32 = 2.0;
const INK: &str = "#1F2933";
const FAINT: &str = "#7B8794";
/// A subtitle is broken into lines of at most so many characters, which fit into the width.
const SUBTITLE_COLUMNS: usize = 100;
const NOTE_SIZE: u32 = 10;
const DASHES: &str = "7 7";
/// What the axes leave of the usual width and height for the diagram itself.
const PLOT_WIDTH: f64 = 540.0;
const PLOT_HEIGHT: f64 = 360.0;

/// Lays out a drawing.
pub(super) fn scene(drawing: &Drawing) -> Scene {
    let frame = Frame::around(drawing);
    let mut plots = Vec::new();
    for curve in &drawing.curves {
        plots.extend(plots_of(curve));
    }
    for star in &drawing.stars {
        plots.push(points(vec![(star.at, star.label.clone())], Style::goal()));
    }
    let layout = frame.apply(annotate(layout(drawing, &plots), drawing, &frame));
    let mut scene = render_multiple(plots, layout);
    add_foot(&mut scene, drawing);
    scene
}

/// kuva numbers its clip paths through the life of the process; from 1 in each file, the same figures give the same
/// file.
pub(super) fn svg(scene: &Scene) -> String {
    const CLIP: &str = "kuva-clip-";
    let raw = SvgBackend::new().with_pretty(true).render_scene(scene);
    let mut pieces = raw.split(CLIP);
    let mut text = pieces.next().unwrap_or_default().to_owned();
    let mut seen: Vec<&str> = Vec::new();
    for piece in pieces {
        let (number, rest) = piece.split_at(piece.find(|c: char| !c.is_ascii_digit()).unwrap_or(piece.len()));
        let index = seen.iter().position(|other| *other == number).unwrap_or_else(|| {
            seen.push(number);
            seen.len() - 1
        });
        text += &format!("clip-{}{rest}", index + 1);
    }
    text
}

pub(super) fn png(scene: &Scene) -> Result<Vec<u8>, String> {
    RasterBackend::new().with_scale(PIXELS).render_scene(scene)
}

fn plots_of(curve: &Curve) -> Vec<Plot> {
    let Style { colour, line_width, marker, .. } = curve.style;
    let mut plots = Vec::new();
    if curve.points.is_empty() {
        return plots;
    }
    if line_width > 0.0 {
        let line = LinePlot::new().with_data(curve.points.iter().map(|(at, _)| *at));
        let line = line.with_color(colour).with_stroke_width(line_width);
        let dashes = LineStyle::Custom(DASHES.into());
        plots.push(if curve.dashed { line.with_line_style(dashes) } else { line }.into());
    }
    if marker != Marker::None {
        plots.push(points(curve.points.clone(), curve.style));
    }
    plots
}

fn points(points: Vec<(Place, String)>, style: Style) -> Plot {
    let (places, tooltips): (Vec<_>, Vec<_>) = points.into_iter().unzip();
    ScatterPlot::new()
        .with_data(places)
        .with_color(style.colour)
        .with_size(style.size)
        .with_marker(shape(style.marker))
        .with_tooltips()
        .with_tooltip_labels(tooltips)
        .into()
}

fn shape(marker: Marker) -> MarkerShape {
    match marker {
        Marker::None | Marker::Circle => MarkerShape::Circle,
        Marker::Square => MarkerShape::Square,
        Marker::Triangle => MarkerShape::Triangle,
        Marker::Diamond => MarkerShape::Diamond,
        Marker::TriangleDown => MarkerShape::TriangleDown,
        Marker::Pentagon => MarkerShape::Pentagon,
        Marker::Hexagon => MarkerShape::Hexagon,
        Marker::Star => MarkerShape::Star,
    }
}

fn layout(drawing: &Drawing, plots: &[Plot]) -> Layout {
    let mut layout = Layout::auto_from_plots(plots)
        .with_width(width(drawing))
        .with_height(HEIGHT)
        .with_title(drawing.title.as_str())
        .with_x_label(drawing.x.label())
        .with_y_label(drawing.y.label())
        .with_legend_position(LegendPosition::OutsideRightMiddle)
        .with_legend_box(false)
        .with_title_size(18)
        .with_label_size(13)
        .with_tick_size(11)
        .with_theme(theme());
    if !drawing.subtitle.is_empty() {
        let subtitle = drawing.subtitle.as_str();
        layout = layout.with_subtitle(subtitle).with_subtitle_size(12).with_subtitle_wrap(SUBTITLE_COLUMNS);
    }
    for (heading, items) in &drawing.legend {
        let entries: Vec<_> = items.iter().map(legend_entry).collect();
        layout = match *heading {
            "" => layout.with_legend_entries(entries),
            heading => layout.with_legend_group(heading, entries),
        };
    }
    layout
}

/// Wide enough that a legend with long names does not squeeze the diagram.
fn width(drawing: &Drawing) -> f64 {
    /// Legend labels up to so many characters fit into the usual width; each further one takes about 7 units.
    const USUAL: usize = 26;
    let labels = drawing.legend.iter().flat_map(|(_, items)| items).map(|item| item.label.chars().count());
    WIDTH + 7.0 * labels.max().unwrap_or(0).saturating_sub(USUAL) as f64
}

fn legend_entry(item: &LegendItem) -> LegendEntry {
    LegendEntry {
        label: item.label.clone(),
        color: item.style.colour.to_owned(),
        shape: if item.dashed { LegendShape::Line } else { LegendShape::Marker(shape(item.style.marker)) },
        dasharray: item.dashed.then(|| DASHES.to_owned()),
    }
}

fn theme() -> Theme {
    Theme {
        background: "#FCFCFD".into(),
        axis_color: "#52606D".into(),
        grid_color: "#E4E7EB".into(),
        tick_color: "#52606D".into(),
        text_color: INK.into(),
        legend_bg: "#FCFCFD".into(),
        legend_border: "none".into(),
        font_family: Some("DejaVu Sans, Verdana, Helvetica, Arial, sans-serif".into()),
        ..Theme::light()
    }
}

fn annotate(mut layout: Layout, drawing: &Drawing, frame: &Frame) -> Layout {
    for Placed { at, text } in placed(drawing, [frame.x, frame.y], [PLOT_WIDTH, PLOT_HEIGHT]) {
        layout =
            layout.with_annotation(TextAnnotation::new(text.as_str(), at.0, at.1).with_font_size(NOTE_SIZE));
    }
    layout
}

/// Two small lines under the diagram: what is missing from it, and where it was measured.
fn add_foot(scene: &mut Scene, drawing: &Drawing) {
    let left_out = match drawing.left_out {
        0 => String::new(),
        1 => "1 setting is not drawn (failed, zero or not finite): see the CSV".to_owned(),
        n => format!("{n} settings are not drawn (failed, zero or not finite): see the CSV"),
    };
    for line in [left_out.as_str(), drawing.foot.as_str()] {
        if line.is_empty() {
            continue;
        }
        scene.add(Primitive::Text {
            x: 12.0,
            y: scene.height + 6.0,
            content: line.to_owned(),
            size: 9,
            anchor: TextAnchor::Start,
            rotate: None,
            bold: false,
            color: Some(FAINT.into()),
        });
        scene.height += 16.0;
    }
}

/// What the axes show.
struct Frame {
    x: (f64, f64),
    y: (f64, f64),
    scales: (Scale, Scale),
}

impl Frame {
    fn around(drawing: &Drawing) -> Self {
        let (xs, ys) = drawing.extent();
        let x = range(&xs, drawing.x.scale);
        let y = range(&ys, drawing.y.scale);
        Self { x, y, scales: (drawing.x.scale, drawing.y.scale) }
    }

    fn apply(&self, mut layout: Layout) -> Layout {
        if self.scales.0 == Scale::Log {
            layout = layout.with_x_tick_step(decades(self.x)).with_x_tick_format(powers_of_ten());
        }
        if self.scales.1 == Scale::Log {
            layout = layout.with_y_tick_step(decades(self.y)).with_y_tick_format(powers_of_ten());
        }
        layout
            .with_x_axis_min(self.x.0)
            .with_x_axis_max(self.x.1)
            .with_y_axis_min(self.y.0)
            .with_y_axis_max(self.y.1)
    }
}

/// The range of places with a margin; on a logarithmic axis at least two decades, so that there are ticks.
fn range(places: &[f64], scale: Scale) -> (f64, f64) {
    let low = places.iter().copied().fold(f64::INFINITY, f64::min);
    let high = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return (0.0, 1.0);
    }
    let least = match scale {
        Scale::Log => 2.0,
        // Ticks of three digits must differ.
        Scale::Linear => (0.1 * low.abs().max(high.abs())).max(f64::MIN_POSITIVE.sqrt()),
    };
    let grow = (0.5 * (least - (high - low))).max(0.07 * (high - low));
    (low - grow, high + grow)
}

/// Decades between ticks, for at most about eight ticks.
fn decades((low, high): (f64, f64)) -> f64 {
    ((high - low) / 8.0).ceil().max(1.0)
}

fn powers_of_ten() -> TickFormat {
    TickFormat::Custom(Arc::new(power_of_ten))
}

/// `10` with its exponent raised.
fn power_of_ten(exponent: f64) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    format!("{:.0}", exponent + 0.0).chars().map(raised).fold("10".to_owned(), |mut text, c| {
        text.push(c);
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_raised() {
        assert_eq!(power_of_ten(-12.0), "10⁻¹²");
        assert_eq!(power_of_ten(0.0), "10⁰");
        assert_eq!(power_of_ten(-0.0), "10⁰");
        assert_eq!(power_of_ten(345_678_910.0), "10³⁴⁵⁶⁷⁸⁹¹⁰");
    }

    #[test]
    fn a_range_holds_its_places_with_a_margin() {
        for scale in [Scale::Log, Scale::Linear] {
            for places in [vec![0.0], vec![-3.0, -2.9], vec![-16.0, 2.0], vec![5e8, 5e8]] {
                let (low, high) = range(&places, scale);
                assert!(places.iter().all(|p| low < *p && *p < high), "{places:?} {scale:?}: {low} {high}");
            }
        }
    }
}
