//! The schema of `summary.json` refuses what it should; that each command's summary keeps it is checked at each run of the other tests.

use crate::common::schema::complaints;
use crate::common::{Scratch, scratch_reconstructed};
use serde_json::{Value, json};

fn summary(scratch: &Scratch, arguments: &[&str], folder: &str) -> Value {
    let run = scratch.run(arguments);
    assert!(matches!(run.code, Some(0 | 4)), "{}{}", run.stdout, run.stderr);
    serde_json::from_str(&scratch.read(&format!("{folder}/summary.json"))).unwrap()
}

#[test]
fn keys_that_are_spelled_otherwise_are_told() {
    let (scratch, _) = scratch_reconstructed("schema", false);
    let good: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    assert_eq!((good["schema"].as_str(), complaints(&good)), (Some("reconstruction/1"), Vec::new()));
    let spoilt = |spoil: &dyn Fn(&mut Value)| {
        let mut bad = good.clone();
        spoil(&mut bad);
        complaints(&bad).join("; ")
    };
    let told = spoilt(&|bad| bad["mass_deviation_kg"] = json!(1.0));
    assert!(told.contains("`/mass_deviation_kg` is no key of the schema"), "{told}");
    let told = spoilt(&|bad| drop(bad.as_object_mut().unwrap().remove("verdict")));
    assert!(told.contains("lacks \"verdict\""), "{told}");
    let told = spoilt(&|bad| bad["samples"] = json!("many"));
    assert!(told.contains("`/samples` is \"many\": not of type"), "{told}");
    let told = spoilt(&|bad| bad["verdict"]["level"] = json!("fine"));
    assert!(told.contains("`/verdict/level` is \"fine\": none of"), "{told}");
    let told = spoilt(&|bad| bad["schema"] = json!("bounds/1"));
    assert!(!told.is_empty());
}

#[test]
fn each_kind_of_summary_is_there() {
    let scratch = Scratch::new("schema-kinds");
    let start = summary(&scratch, &["init", "start"], "start");
    let bounds = summary(&scratch, &["bounds", "start/contacts.csv", "--fit", "auto", "-o", "b"], "b");
    let concave = summary(&scratch, &["bounds", "start/contacts.csv", "--concave", "-o", "c"], "c");
    let arguments = ["explore", "start/scene.toml", "--until", "gap=0.9", "-o", "e"];
    let explored = summary(&scratch, &arguments, "e");
    let kinds = [&start, &bounds, &concave, &explored].map(|of| of["schema"].as_str().unwrap());
    assert_eq!(kinds, ["start/1", "bounds/1", "bounds/1", "exploration/1"]);
    // What tells of a result has a page.
    for (folder, says) in [("b", "Fitted shape"), ("c", "Smooth surface"), ("e", "Touch by touch")] {
        let page = scratch.read(&format!("{folder}/report.html"));
        assert!(page.contains(says) && page.contains("<svg") && !page.contains("src="), "{folder}");
    }
}
