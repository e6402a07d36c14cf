use super::*;
use crate::{FolderTarget, TriangleMesh, write_ply};
use glam::DVec3;
use serde_json::json;
use std::fs;
use std::io::Write;
use std::path::PathBuf;

/// A folder of results that a test spoils.
struct Results {
    path: PathBuf,
    files: Vec<(String, Vec<u8>)>,
}

fn octahedron(size: f64) -> TriangleMesh {
    let vertices =
        [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis * size, axis * -size]).collect();
    let triangles = (0..8).map(|k: u32| {
        let [x, y, z] = [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2 & 1)];
        if k.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    });
    TriangleMesh { vertices, triangles: triangles.collect() }
}

fn ply(mesh: &TriangleMesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_ply(mesh, "a bound", &mut bytes).unwrap();
    bytes
}

fn summary() -> Value {
    json!({
        "method": "made up",
        "status": "converged",
        "bounds": { "lower_volume_m3": 4.0 / 3.0, "upper_volume_m3": 32.0 / 3.0, "contradiction_m": 0.0 },
        "warnings": [],
    })
}

impl Results {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("recon-io-check-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        let files = [
            ("motion.csv", b"t,x\n0.0,1.0\n1.0,2.5e-3\n".to_vec()),
            ("radius_functions.csv", b"t,r_1,r_2,r_3\n0.0,1.0,nan,1.0\n".to_vec()),
            ("lower_bound.ply", ply(&octahedron(1.0))),
            ("upper_bound.ply", ply(&octahedron(2.0))),
            ("summary.json", summary().to_string().into_bytes()),
        ];
        Self { path, files: files.map(|(name, bytes)| (name.to_owned(), bytes)).to_vec() }
    }

    fn spoilt(&self, name: &str, bytes: Vec<u8>) -> Vec<Fault> {
        let files = self.files.iter().filter(|(other, _)| other != name).cloned();
        self.faults(files.chain([(name.to_owned(), bytes)]).collect())
    }

    fn spoilt_mesh(&self, name: &str, spoil: impl FnOnce(&mut TriangleMesh)) -> Vec<Fault> {
        let mut mesh = octahedron(if name.starts_with("lower") { 1.0 } else { 2.0 });
        spoil(&mut mesh);
        self.spoilt(name, ply(&mesh))
    }

    fn spoilt_summary(&self, spoil: impl FnOnce(&mut Value)) -> Vec<Fault> {
        let mut summary = summary();
        spoil(&mut summary);
        self.spoilt("summary.json", summary.to_string().into_bytes())
    }

    /// Writes the files and what is wrong with them.
    fn faults(&self, files: Vec<(String, Vec<u8>)>) -> Vec<Fault> {
        let _ = fs::remove_dir_all(&self.path);
        let folder = FolderTarget::new(&self.path, &[], false).unwrap().begin().unwrap();
        for (name, bytes) in &files {
            folder.write(name, |to| to.write_all(bytes)).unwrap();
        }
        folder.place().unwrap();
        self.found()
    }

    fn found(&self) -> Vec<Fault> {
        match check(&self.path) {
            Ok(_) => Vec::new(),
            Err(CheckError::Faults { faults }) => faults,
            Err(other) => panic!("{other}"),
        }
    }
}

impl Drop for Results {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.path);
    }
}

/// Asserts that the faults are those expected, in words.
fn assert_named(faults: &[Fault], expected: &[&str]) {
    let found: Vec<String> = faults.iter().map(Fault::to_string).collect();
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for words in expected {
        assert!(found.iter().any(|fault| fault.contains(words)), "`{words}` is not in {found:#?}");
    }
}

#[test]
fn sound_results_hold_and_say_what_was_checked() {
    let results = Results::new("sound");
    assert_eq!(results.faults(results.files.clone()), []);
    let held = check(&results.path).unwrap().join("\n");
    for words in [
        "5 files as written",
        "motion.csv: all numbers",
        "1.333333e0 m^3 as stated",
        "lower_bound.ply is inside",
    ] {
        assert!(held.contains(words), "{held}");
    }
}

#[test]
fn files_that_are_gone_or_changed_are_named() {
    let results = Results::new("files");
    results.faults(results.files.clone());
    fs::write(results.path.join("motion.csv"), "t,x\n0.0,1.0\n1.0,2.6e-3\n").unwrap();
    fs::remove_file(results.path.join("radius_functions.csv")).unwrap();
    assert_named(&results.found(), &["motion.csv was changed", "radius_functions.csv is missing"]);
    fs::remove_file(results.path.join(MANIFEST)).unwrap();
    assert!(matches!(check(&results.path), Err(CheckError::NoManifest { .. })));
    assert!(matches!(check(results.path.join("none")), Err(CheckError::NoManifest { .. })));
}

#[test]
fn tables_and_figures_without_a_number_are_named() {
    let results = Results::new("numbers");
    assert_named(
        &results.spoilt("motion.csv", b"t,x\n0,1\n1,nan\n".to_vec()),
        &["line 3, column `x` is `nan`"],
    );
    assert_named(&results.spoilt("motion.csv", b"t,x\n0,1\n1,1e999\n".to_vec()), &["column `x` is `1e999`"]);
    assert_named(
        &results.spoilt("motion.csv", b"t,x\n0,1\n1\n".to_vec()),
        &["line 3 has 1 cells; the header has 2"],
    );
    for (header, row, must) in [
        ("t,std_cmx", "0,-1e-9", "zero or above"),
        ("t,mode_2", "0,3", "0, 1 or 2"),
        ("t,relied_on", "0,0.5", "0 or 1"),
    ] {
        let table = format!("{header}\n{row}\n").into_bytes();
        let words = format!("line 2, column `{}` is `{}`; it must be {must}", &header[2..], &row[2..]);
        assert_named(&results.spoilt("motion.csv", table), &[&words]);
    }
    assert_named(&results.spoilt("motion.csv", b"t,std_cmx,mode_1,relied_on\n0,0,2,1\n".to_vec()), &[]);
    // Reading 1761 / 1801 from JSON ends in another last digit.
    for (rows, ones, share, faults) in [
        (4, 3, 0.75, &[][..]),
        (1801, 1761, 1761.0 / 1801.0, &[]),
        (4, 3, 0.5, &["3 of 4 rows are relied on, stated is a share of 0.5"]),
        (1801, 1761, 1762.0 / 1801.0, &["1761 of 1801 rows are relied on"]),
    ] {
        let row = |k: usize| format!("{k},{}\n", u8::from(k < ones));
        let table = "t,relied_on\n".to_owned() + &(0..rows).map(row).collect::<String>();
        let mut stated = summary();
        stated["relied_on_share"] = json!(share);
        let bounds = results.files.iter().filter(|(name, _)| name.ends_with(".ply")).cloned();
        let told = [("motion.csv", table), ("summary.json", stated.to_string())];
        let told = told.map(|(name, text)| (name.to_owned(), text.into_bytes()));
        assert_named(&results.faults(bounds.chain(told).collect()), faults);
    }
    assert_named(
        &results.spoilt("summary.json", b"{".to_vec()),
        &["summary.json cannot be read", "summary.json is missing"],
    );
    let null = |summary: &mut Value| summary["residual"] = Value::Null;
    assert_named(&results.spoilt_summary(null), &["`residual` is no number, and no warning"]);
    let warned = |summary: &mut Value| {
        null(summary);
        summary["warnings"] = json!(["no residual"]);
    };
    assert_named(&results.spoilt_summary(warned), &[]);
}

#[test]
fn fits_without_an_end_are_named() {
    let results = Results::new("fits");
    let spoilt = |key: &str, value: Value| results.spoilt_summary(|summary| summary[key] = value);
    assert_named(&spoilt("status", Value::Null), &["`status` is no number", "made up has no status"]);
    assert_named(&spoilt("status", json!("moving")), &["`status` is moving, and no warning"]);
    assert_named(
        &spoilt("verdict", json!({ "text": "fine" })),
        &["the motion has no status (`verdict/level`)"],
    );
    assert_named(&spoilt("about", json!({ "fit": { "family": "ball" } })), &["ball has no status"]);
}

#[test]
fn meshes_that_are_no_closed_surface_are_named() {
    let results = Results::new("surfaces");
    let open = "faces are open or turned against each other";
    let torn = results.spoilt_mesh("upper_bound.ply", |mesh| mesh.triangles.truncate(7));
    assert!(torn.iter().any(|fault| matches!(fault, Fault::Open { .. })), "{torn:?}");
    let turned = results.spoilt_mesh("upper_bound.ply", |mesh| mesh.triangles[3].swap(0, 1));
    assert!(turned.iter().any(|fault| fault.to_string().contains(open)), "{turned:?}");
    let inside_out =
        results.spoilt_mesh("lower_bound.ply", |mesh| mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1)));
    assert!(
        inside_out.iter().any(|fault| matches!(fault, Fault::Size { found, .. } if *found < 0.0)),
        "{inside_out:?}"
    );
    let not_finite = results.spoilt_mesh("lower_bound.ply", |mesh| mesh.vertices[2].x = f64::INFINITY);
    assert_named(&not_finite, &["corner 3 is", "do not go together"]);
    let none = results.spoilt_mesh("lower_bound.ply", |mesh| mesh.triangles[0][0] = 6);
    assert_named(&none, &["face 1 names a corner", "do not go together"]);
    let mut bytes = ply(&octahedron(1.0));
    bytes.pop();
    assert_named(&results.spoilt("lower_bound.ply", bytes), &["it ends too early", "do not go together"]);
    let longer = [ply(&octahedron(1.0)), vec![0]].concat();
    assert_named(
        &results.spoilt("lower_bound.ply", longer),
        &["goes on after its last face", "do not go together"],
    );
    // A further surface beside the bounds.
    assert_named(
        &results.spoilt("object_inner.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()),
        &[open],
    );
}

#[test]
fn bounds_that_are_not_as_stated_or_not_inside_each_other_are_named() {
    let results = Results::new("bounds");
    let stated =
        |key: &str, value: f64| results.spoilt_summary(|summary| summary["bounds"][key] = json!(value));
    assert_named(
        &stated("lower_volume_m3", 1.333_333),
        &["lower_bound.ply has 1.3333333333333333 m^3, stated are 1.333333"],
    );
    assert_named(&stated("contradiction_m", 0.1), &["contradict each other by 1.0e-1 m, and no warning"]);
    let gone = results.files.iter().filter(|(name, _)| name != "upper_bound.ply").cloned().collect();
    assert_named(&results.faults(gone), &["upper_bound.ply and the size of this bound"]);
    // One corner out of the other bound, by a thousandth of a millionth of a metre and by a hundredth.
    let out = |by: f64| {
        let mesh = |mesh: &mut TriangleMesh| mesh.vertices[0].x = 2.0 + by;
        results.spoilt_mesh("lower_bound.ply", mesh)
    };
    for (by, words) in [
        (1e-9, "corner 1 of lower_bound.ply is 1.0e-9 m outside"),
        (1e-2, "corner 1 of lower_bound.ply is 1.0e-2 m outside"),
    ] {
        assert_named(&out(by), &[words, "stated are 1.3333"]);
    }
    assert_named(&out(0.0), &["stated are 1.3333"]);
    // A dent that leaves everything else nearly as it was.
    let dented = results.spoilt_mesh("upper_bound.ply", |mesh| {
        mesh.vertices.push(DVec3::splat(0.6));
        let [a, b, c] = mesh.triangles.remove(0);
        mesh.triangles.extend([[a, b, 6], [b, c, 6], [c, a, 6]]);
    });
    assert_named(&dented, &["upper_bound.ply is not convex: it is dented by", "stated are 10.66"]);
    let mut crossed = results.files.clone();
    crossed[2].1 = ply(&octahedron(2.0));
    crossed[3].1 = ply(&octahedron(1.0));
    let mut figures = summary();
    figures["bounds"] = json!({ "lower_volume_m3": 32.0 / 3.0, "upper_volume_m3": 4.0 / 3.0 });
    crossed[4].1 = figures.to_string().into_bytes();
    assert_named(&results.faults(crossed), &["larger than the upper one", "outside of the upper bound"]);
}

#[test]
fn outlines_are_checked_as_surfaces_are() {
    let mut results = Results::new("outlines");
    let square = |s: f64| format!("x,y\n{s},{s}\n-{s},{s}\n-{s},-{s}\n{s},-{s}\n");
    let figures = json!({ "bounds": { "lower_area_m2": 4.0, "upper_area_m2": 16.0 } });
    let [lower, upper] = ["lower_bound.csv", "upper_bound.csv"].map(str::to_owned);
    results.files = vec![
        (lower.clone(), square(1.0).into_bytes()),
        (upper.clone(), square(2.0).into_bytes()),
        ("summary.json".to_owned(), figures.to_string().into_bytes()),
    ];
    assert_eq!(results.faults(results.files.clone()), []);
    let spoilt = |file: &str, text: &str| results.spoilt(file, text.as_bytes().to_vec());
    let backwards = "x,y\n2,-2\n-2,-2\n-2,2\n2,2\n";
    let found = spoilt(&upper, backwards);
    assert!(found.iter().any(|f| matches!(f, Fault::Size { found, .. } if *found == -16.0)), "{found:?}");
    assert_named(
        &spoilt(&lower, "x,y\n3,1\n-1,1\n-1,-1\n1,-1\n"),
        &["corner 1 of lower_bound.csv is 1.0e0 m outside", "stated are 4"],
    );
    assert_named(&spoilt(&lower, "x,y\n1,1\n-1,1\n-1,-1\n0,0.5\n"), &["is dented by", "stated are 4"]);
    assert_named(&spoilt(&lower, "x,y\n1,1\n-1,inf\n"), &["column `y` is `inf`", "do not go together"]);
    assert_named(&spoilt(&lower, &square(0.5)), &["lower_bound.csv has 1 m^2, stated are 4"]);
}
