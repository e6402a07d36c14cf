//! The table of the page: what the result rests on.

use super::PushedLog;
use crate::number::brief_to;
use crate::report::page::escape_text;

/// Rows of the table.
pub(super) fn rows(log: &PushedLog) -> String {
    let told = log.told;
    let millimetres = |v: f64| format!("{:.2} mm", 1e3 * v);
    let mut rows: Vec<(String, String, &str)> = Vec::new();
    for (k, corner) in told.outline.corners.iter().enumerate() {
        let [x, y] = corner.point.to_array().map(|v| 1e3 * v);
        let reach = corner.to_touch.map(|way| format!("{:.0}", 1e3 * way)).join(" and ");
        rows.push((
            format!("Corner {}", k + 1),
            format!("({x:.2}, {y:.2}) ± {:.2} mm; touched {reach} mm away", 1e3 * corner.deviation()),
            "where its edges meet; the ways to the nearest touch, clockwise and on",
        ));
    }
    if let Some([a, b]) = log.halves {
        let value = format!("{:.3} ± {:.3}, {:.3} ± {:.3}", a.value, a.deviation, b.value, b.deviation);
        rows.push((
            "Friction of both halves".to_owned(),
            value,
            "each by its own pushes and its own outline",
        ));
    }
    if let Some(f) = told.friction {
        let [slope, deviation] = [f.by_slip.0, f.by_slip.1].map(|v| 1e-3 * v);
        let value = format!("{slope:+.3} ± {deviation:.3} per mm/s");
        rows.push((
            "Friction: change with slip".to_owned(),
            value,
            "by the pushes that slide; before anything is seen, none",
        ));
    }
    let of_push = format!("{:.3}, {:.3}", told.spread[0], told.spread[1]);
    rows.push((
        "Friction: push to push, within a push".to_owned(),
        of_push,
        "standard deviations of what is not one number",
    ));
    let [ahead, behind] = told.clocks.map(|(t, d)| format!("{t:.2} ± {d:.2} s"));
    rows.push((
        "Finger ahead, first and last touch".to_owned(),
        format!("{ahead}; {behind}"),
        "clocks of finger and force, and way after the last sample",
    ));
    let [mean, half] = told.touch_deviations.map(millimetres);
    rows.push((
        "Deviation of touches".to_owned(),
        format!("{mean}; {half}"),
        "of both touches of a push together, and of half their difference",
    ));
    let bend = format!("{} mm/N", brief_to(2, 1e3 * told.compliance));
    rows.push(("The finger gives way by".to_owned(), bend, "by the way on which the force first rises"));
    rows.push((
        "Friction length of the table".to_owned(),
        millimetres(told.table_length),
        "its largest torque over its largest force",
    ));
    let missed = format!("{}, {:.2} degrees", millimetres(told.missed.0), told.missed.1.to_degrees());
    rows.push((
        "Motion that the force does not tell".to_owned(),
        missed,
        "between where it would end and the pose after the push, medians",
    ));
    if let Some(noise) = told.force_noise {
        rows.push((
            "Noise of the force".to_owned(),
            format!("{} N", brief_to(2, noise)),
            "before the finger touches",
        ));
    }
    let others = told.outline.candidates.iter().take(4).map(|c| format!("{} ({:.1})", c.name, c.against));
    rows.push((
        "Outlines by evidence".to_owned(),
        others.collect::<Vec<_>>().join(", "),
        "log odds against each; the fewest unknowns below 3 are taken",
    ));
    let row = |(name, value, meaning): &(String, String, &str)| {
        format!(
            "        <tr><td>{}</td><td class=\"words\">{}</td><td class=\"meaning\">{meaning}</td></tr>\n",
            escape_text(name),
            escape_text(value)
        )
    };
    rows.iter().map(row).collect()
}
