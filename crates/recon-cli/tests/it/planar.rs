//! `recon planar`: the paper's Fig. 3 from nothing, its log without forces, and bad input.

use crate::common::Scratch;

/// Last row of a CSV table as numbers.
fn last_row(text: &str) -> Vec<f64> {
    text.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect()
}

#[test]
fn the_demo_and_its_log_without_forces_agree_with_the_truth() {
    let scratch = Scratch::new("planar");
    let run = scratch.run(&["planar"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let log = scratch.read("recon-planar/log.csv");
    let header: Vec<&str> = log.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap();
    let truth = last_row(&log);
    let phi = truth[column("phi0")] - 5.85;
    let observed = last_row(&scratch.read("recon-planar/motion.csv"));
    assert!((observed[1] - phi).abs() < 1e-8, "{observed:?} {phi}");
    let figures = scratch.read("recon-planar/figures.svg");
    assert!(figures.contains("error in r1") && !figures.contains("NaN"));

    // Contacts and palm angles alone; two radians of a body with three harmonics, fitted with three.
    let without: Vec<String> =
        log.lines().map(|l| l.split(',').take(5).collect::<Vec<_>>().join(",")).step_by(10).collect();
    let rows: Vec<&str> = without.iter().map(String::as_str).collect();
    scratch.write("bare.csv", &rows.join("\n"));
    let run = scratch.run(&["planar", "bare.csv", "--contact-noise", "1e-4", "--order", "3", "-o", "fit"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let fitted = last_row(&scratch.read("fit/motion.csv"));
    let close = log.lines().filter_map(|l| l.split(',').nth(column("phi0"))?.parse::<f64>().ok());
    let at_end = close.zip(0..).filter(|(_, k)| k % 10 == 9).last().unwrap().0 - 5.85;
    assert!((fitted[1] - at_end).abs() < 1e-2, "{fitted:?} {at_end}");
}

#[test]
fn bad_input_is_refused() {
    let scratch = Scratch::new("planar-bad");
    scratch.write("flat.csv", "t,phi1,phi2,s1,s2\n0,0.7,1.5,1,1\n1,0.7,4,1,1\n");
    scratch.write("word.csv", "t,phi1,phi2,s1,s2\n0,0.7,1.5,one,1\n1,0.7,1.5,1,1\n");
    let rows = (0..20).map(|k| format!("{},45,90,2000,2100,1,1\n", 0.01 * f64::from(k)));
    let degrees: String = rows.collect();
    scratch.write("degrees.csv", &format!("t,phi1,phi2,s1,s2,f1,f2\n{degrees}"));
    let millimetres = degrees.replace(",45,90,", ",0.7,1.6,");
    scratch.write("millimetres.csv", &format!("t,phi1,phi2,s1,s2,f1,f2\n{millimetres}"));
    let known = |file| vec!["planar", file, "--mass", "1", "--inertia", "1"];
    for (arguments, code, words) in [
        (known("degrees.csv"), 3, "radians"),
        (known("millimetres.csv"), 3, "object of about 2110"),
        (vec!["planar", "millimetres.csv"], 3, "--contact-noise"),
        (vec!["planar", "none.csv"], 3, "none.csv"),
        (vec!["planar", "flat.csv", "--contact-noise", "1e-3"], 3, "line 3"),
        (vec!["planar", "word.csv", "--contact-noise", "1e-3"], 3, "`one` is not a number"),
        (vec!["planar", "flat.csv", "--mass", "2"], 2, "--inertia"),
        (vec!["planar", "flat.csv", "--gravity", "nan"], 2, "positive"),
    ] {
        let run = scratch.run(&arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {}{}", run.stdout, run.stderr);
        assert!(run.stderr.contains(words), "{arguments:?}: {}", run.stderr);
        assert!(!scratch.path().join("recon-planar").exists());
    }
}
