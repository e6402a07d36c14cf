//! The atlas in words: counts as CSV, boundaries as tables, and every run that was wrong without a warning with its command.

use super::picture::short;
use super::plan::{Counts, Spot};
use super::{METHODS, Outcome};
use std::fmt::Write;

/// Share of right runs below which a method is past its boundary.
const BOUNDARY: f64 = 0.5;

/// Counts of all spots as CSV.
#[must_use]
pub fn counts_csv(spots: &[Spot], counts: &[Counts]) -> String {
    let mut text = "what,way,at,right,reported,error,silent,crash,no scene,median error of what is right over what is allowed\n".to_owned();
    for (spot, counts) in spots.iter().zip(counts) {
        let (what, way, at) = match spot {
            Spot::Cell(method, way, strength) => (method.name, way.word(), short(*strength)),
            Spot::Place(map, at) => (map.name, "map", format!("{} {}", short(at[0]), short(at[1]))),
        };
        let numbers: Vec<String> = counts.of.iter().map(ToString::to_string).collect();
        let off = median(&counts.offs).map_or_else(String::new, |off| format!("{off:.2e}"));
        let _ = writeln!(text, "\"{what}\",{way},{at},{},{off}", numbers.join(","));
    }
    text
}

/// The page below its head.
#[must_use]
pub fn page(spots: &[Spot], counts: &[Counts]) -> String {
    let mut text = totals(spots, counts);
    for method in METHODS {
        let own: Vec<(&Spot, &Counts)> = spots
            .iter()
            .zip(counts)
            .filter(|(spot, _)| matches!(spot, Spot::Cell(of, ..) if of.name == method.name))
            .collect();
        if own.is_empty() {
            continue;
        }
        let _ = writeln!(
            text,
            "\n## {}\n\n{}.\n\n![{}](atlas/{}.svg)\n",
            capital(method.name),
            capital(method.about),
            method.name,
            stem(method.name)
        );
        let _ = writeln!(
            text,
            "| way | right at | half and more right up to | then | median ms |\n|---|---|---|---|---|"
        );
        for way in method.ways {
            let cells: Vec<(f64, &Counts)> = own
                .iter()
                .filter_map(|(spot, counts)| match spot {
                    Spot::Cell(_, of, strength) if of == way => Some((*strength, *counts)),
                    _ => None,
                })
                .collect();
            let _ = writeln!(text, "{}", boundary(way.words(), way.unit(), &cells));
        }
    }
    let maps: Vec<&str> = spots
        .iter()
        .filter_map(|spot| if let Spot::Place(map, _) = spot { Some(map.name) } else { None })
        .collect();
    if !maps.is_empty() {
        text.push_str("\n## Two causes\n");
    }
    let mut before = "";
    for name in maps {
        if name != before {
            let _ = writeln!(text, "\n![{name}](atlas/{}.svg)", stem(name));
            before = name;
        }
    }
    text + &wrong(spots, counts)
}

/// The row of a way.
fn boundary(words: &str, unit: &str, cells: &[(f64, &Counts)]) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    let share = |counts: &Counts| counts.count(Outcome::Right) as f64 / counts.judged().max(1) as f64;
    let right: usize = cells.iter().map(|(_, counts)| counts.count(Outcome::Right)).sum();
    let judged: usize = cells.iter().map(|(_, counts)| counts.judged()).sum();
    let last = cells.iter().rposition(|(_, counts)| counts.judged() > 0 && share(counts) >= BOUNDARY);
    let beyond = last.map_or(0, |last| last + 1);
    let mut sums = [0; 6];
    for (_, counts) in &cells[beyond..] {
        sums.iter_mut().zip(counts.of).for_each(|(sum, n)| *sum += n);
    }
    let then: Vec<String> = Outcome::ALL
        .into_iter()
        .zip(sums)
        .filter(|(_, n)| *n > 0)
        .map(|(outcome, n)| format!("{n} {}", outcome.words()))
        .collect();
    let up_to = last.map_or("nowhere".to_owned(), |last| format!("{}{unit}", short(cells[last].0)));
    let then = if then.is_empty() { "its end".to_owned() } else { then.join(", ") };
    let times: Vec<f64> = cells.iter().flat_map(|(_, counts)| counts.milliseconds.iter().copied()).collect();
    let ms = median(&times).unwrap_or(f64::NAN);
    format!("| {words} | {right} of {judged} | {up_to} | {then} | {ms:.0} |")
}

/// All runs by method and outcome.
fn totals(spots: &[Spot], counts: &[Counts]) -> String {
    let mut names: Vec<&str> = Vec::new();
    let mut sums: Vec<[usize; 6]> = Vec::new();
    for (spot, counts) in spots.iter().zip(counts) {
        let name = match spot {
            Spot::Cell(method, ..) => method.name,
            Spot::Place(map, _) => map.name,
        };
        if names.last() != Some(&name) {
            names.push(name);
            sums.push([0; 6]);
        }
        if let Some(sum) = sums.last_mut() {
            sum.iter_mut().zip(counts.of).for_each(|(sum, n)| *sum += n);
        }
    }
    let mut text = "| method | runs | right | reported | typed error | wrong without a warning | crash | no such scene |\n|---|---|---|---|---|---|---|---|\n".to_owned();
    let mut all = [0; 6];
    let row = |name: &str, of: &[usize; 6]| {
        let numbers: Vec<String> = of.iter().map(ToString::to_string).collect();
        format!("| {name} | {} | {} |\n", of.iter().sum::<usize>(), numbers.join(" | "))
    };
    for (name, of) in names.iter().zip(&sums) {
        text += &row(name, of);
        all.iter_mut().zip(of).for_each(|(all, n)| *all += n);
    }
    text + &row("all", &all)
}

/// What was wrong without a warning, or crashed, with its command.
fn wrong(spots: &[Spot], counts: &[Counts]) -> String {
    let mut text = "\n## Wrong without a warning, and crashes\n\nEach with the command that repeats it, and its error in what is allowed.\n\n".to_owned();
    let mut none = true;
    for (spot, counts) in spots.iter().zip(counts) {
        for (seed, off, words) in &counts.bad {
            let command = match spot {
                Spot::Cell(method, way, strength) => {
                    format!(
                        "cargo xtask atlas one \"{}\" {} {} {seed}",
                        method.name,
                        way.word(),
                        short(*strength)
                    )
                }
                Spot::Place(map, at) => {
                    format!("cargo xtask atlas one \"{}\" {} {} {seed}", map.name, short(at[0]), short(at[1]))
                }
            };
            let how = if words.is_empty() { format!("{off:.2}") } else { words.clone() };
            let _ = writeln!(text, "- `{command}`: {how}");
            none = false;
        }
    }
    if none {
        text += "None.\n";
    }
    text
}

/// The stem of a file for a name.
#[must_use]
pub fn stem(name: &str) -> String {
    let allowed = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let all: String = name.chars().map(allowed).collect();
    all.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

fn capital(words: &str) -> String {
    let mut chars = words.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + chars.as_str())
}

fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boundary_is_the_last_strength_at_which_half_is_right() {
        let of = |right: usize, reported: usize| {
            let mut counts = Counts::default();
            counts.of[0] = right;
            counts.of[1] = reported;
            counts
        };
        let (a, b, c) = (of(4, 0), of(2, 2), of(1, 3));
        let row = boundary("noise", "sizes", &[(0.1, &a), (0.2, &b), (0.4, &c)]);
        assert!(row.contains("7 of 12 | 0.2 sizes | 1 right, 3 reported"), "{row}");
    }

    #[test]
    fn stems_are_file_names() {
        assert_eq!(stem("bounds, limits on curvature"), "bounds-limits-on-curvature");
    }
}
