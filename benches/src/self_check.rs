//! The harness on a problem with a known answer: Euler and Runge-Kutta 4 on a pendulum must show orders 1 and 4 on
//! their chart.

use std::path::{Path, PathBuf};

use crate::{Axis, Budget, ChartError, Diagram, Method, Outcome, Study, WorkPrecision, WrittenChart};

/// A folder that is gone at the end of the test; `RECON_KEEP_CHARTS=FOLDER` keeps the files for a look.
struct Folder(PathBuf, bool);

impl Folder {
    fn new(name: &str) -> Self {
        match std::env::var_os("RECON_KEEP_CHARTS") {
            Some(folder) => Self(folder.into(), true),
            None => Self(std::env::temp_dir().join(format!("recon-{name}-{}", std::process::id())), false),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.1 {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

type State = [f64; 2];

/// Angle and rate of a pendulum of unit frequency.
fn rate([angle, rate]: State) -> State {
    [rate, -angle.sin()]
}

fn along(state: State, h: f64, slope: State) -> State {
    [state[0] + h * slope[0], state[1] + h * slope[1]]
}

fn euler(state: State, h: f64) -> State {
    along(state, h, rate(state))
}

fn runge_kutta_4(state: State, h: f64) -> State {
    let k1 = rate(state);
    let k2 = rate(along(state, 0.5 * h, k1));
    let k3 = rate(along(state, 0.5 * h, k2));
    let k4 = rate(along(state, h, k3));
    let mean = [0, 1].map(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0);
    along(state, h, mean)
}

const DURATION: f64 = 10.0;

fn run(step: fn(State, f64) -> State, steps: u32) -> State {
    (0..steps).fold([1.0, 0.0], |state, _| step(state, DURATION / f64::from(steps)))
}

fn study() -> Vec<Method> {
    // Its own error is near 1e-14 (order 4 from 1e-12 at a tenth of the steps), far below what the chart shows.
    let exact = run(runge_kutta_4, 1 << 17);
    let error = |state: &State| (state[0] - exact[0]).hypot(state[1] - exact[1]);
    let mut study = Study::new();
    for doubling in 6..=12 {
        let steps = 1 << doubling;
        study.case("Euler", format!("{steps} steps"), move || run(euler, steps), error);
        study.case("Runge-Kutta 4", format!("{steps} steps"), move || run(runge_kutta_4, steps), error);
    }
    study.measure(Budget::quick(), DURATION)
}

fn errors(method: &Method) -> Vec<f64> {
    let error = |outcome: &Outcome| match outcome {
        Outcome::Measured { error, .. } => Some(*error),
        Outcome::Failed { .. } => None,
    };
    method.points().iter().filter_map(|point| error(&point.outcome)).collect()
}

fn pendulum(methods: Vec<Method>) -> Diagram {
    WorkPrecision::new("pendulum", "A pendulum over 10 s")
        .subtitle(
            "angle and rate at the end against Runge-Kutta 4 with 131072 steps; points: number of steps",
        )
        .axes(Axis::log("error of the end state", "rad"), Axis::log("cost", "ms per simulated second"))
        .methods(methods)
        .method(
            Method::recorded("a peer", "an invented figure")
                .point("1 ms", 1e-3, 0.2)
                .point("0.1 ms", 1e-5, 2.0),
        )
        .goal("peer / 100", 1e-3, 2e-3)
        .into()
}

fn assert_written(files: &WrittenChart) {
    let read = |path: &Path| std::fs::read(path).expect("it was written");
    assert!(read(&files.png).starts_with(b"\x89PNG"));
    let svg = String::from_utf8(read(&files.svg)).expect("SVG is text");
    assert!(svg.contains("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(read(&files.csv).iter().filter(|byte| **byte == b'\n').count() > 10);
    let folder = files.csv.parent().expect("files are in a folder");
    let left: Vec<_> = std::fs::read_dir(folder).expect("it was made").flatten().map(|e| e.path()).collect();
    assert!(!left.iter().any(|path| path.extension().is_some_and(|e| e == "part")), "{left:?}");
}

#[test]
fn the_chart_of_a_pendulum_shows_orders_one_and_four() {
    let methods = study();
    for (method, order) in methods.iter().zip([1.0, 4.0]) {
        let errors = errors(method);
        assert_eq!(errors.len(), 7);
        // The last doubling, where the leading term rules: 5 % is what the next term leaves at this step.
        let observed = (errors[5] / errors[6]).log2();
        assert!((observed / order - 1.0).abs() < 0.05, "{}: order {observed}", method.name());
    }
    let folder = Folder::new("pendulum");
    let files = pendulum(methods).save(&folder.0).expect("a temporary folder can be written");
    assert_written(&files);
    let csv = std::fs::read_to_string(&files.csv).expect("it was written");
    assert!(csv.contains("Runge-Kutta 4,4096 steps,") && csv.contains("an invented figure"), "{csv}");
}

#[test]
fn the_same_figures_give_the_same_files() {
    let folder = Folder::new("same");
    let invented = Method::new("random").point("10", 0.1, 3.0).point("20", 0.01, 7.0).point("40", 0.0, 9.0);
    let other = (0..12).fold(Method::new("other"), |m, k| m.point("n", 0.5_f64.powi(k), f64::from(k + 1)));
    let chart = || {
        WorkPrecision::new("same", "Twice").methods([invented.clone(), other.clone()]).goal("goal", 0.1, 3.0)
    };
    let save = |name: &str| Diagram::from(chart()).save(&folder.0.join(name)).expect("it can be written");
    let (once, twice) = (save("once"), save("twice"));
    assert_written(&once);
    for (a, b) in [(&once.csv, &twice.csv), (&once.svg, &twice.svg), (&once.png, &twice.png)] {
        let read = |path: &Path| std::fs::read(path).expect("it was written");
        assert!(read(a) == read(b), "{} and {} differ", a.display(), b.display());
    }
}

/// The example of the first page, line for line.
#[test]
fn the_example_of_the_first_page_holds() {
    use recon_benches::{Axis, Budget, Study, WorkPrecision};

    let mut study = Study::new();
    for n in [10_u32, 100, 1000] {
        let mean = move || (0..n).map(|i| (f64::from(i) / f64::from(n)).exp()).sum::<f64>() / f64::from(n);
        study.case("left sum", format!("n = {n}"), mean, |mean| (mean - (1.0_f64.exp() - 1.0)).abs());
    }
    let chart = WorkPrecision::new("quadrature", "Integral of exp over the unit interval")
        .axes(Axis::log("error", "1"), Axis::log("time", "ms"))
        .methods(study.measure(Budget::quick(), 1.0));
    assert!(chart.csv().starts_with("method,setting,"));

    let page = include_str!("lib.rs").lines().filter_map(|line| line.strip_prefix("//! "));
    let shown = page.skip_while(|line| *line != "```").skip(1).take_while(|line| *line != "```");
    let (_, here) = include_str!("self_check.rs").split_once("first_page_holds").expect("this function");
    let other: Vec<&str> = shown.filter(|line| !here.contains(&format!("    {line}\n"))).collect();
    assert!(other.is_empty() && here.len() > 1000, "not run here: {other:?}");
}

#[test]
fn a_chart_without_a_point_is_an_error_that_says_so() {
    let folder = Folder::new("empty");
    let chart = WorkPrecision::new("empty", "").method(Method::new("zero").point("1", 0.0, f64::NAN));
    let outcome = Diagram::from(chart).save(&folder.0);
    assert!(matches!(outcome, Err(ChartError::NothingToDraw { left_out: 1, .. })), "{outcome:?}");
    assert!(!folder.0.exists() || folder.1, "nothing may be written");
}
