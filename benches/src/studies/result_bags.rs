//! Bags of results, read back by another implementation: every message as `mcap-ros2-support` decodes it beside what was written.
//!
//! Arguments: bags, samples a bag. Needs Python with `mcap-ros2-support`, `rosbags` and `rerun-sdk`. Writes Markdown tables.

use glam::DVec3;
use recon_io::{ResultBag, ResultContact, ResultPose, TriangleMesh};
use serde_json::Value;
use shape_bounds::generators::Source;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::process::Command;

type Failure = Box<dyn Error>;

const EPOCH: i64 = 1_760_000_000_000_000_000;
const PALMS: usize = 3;
/// Balls and arrows at the contacts, whose sizes follow from the whole bag: they are decoded, and not compared.
const DRAWN: [&str; 2] = ["/recon/markers", "/recon/forces"];
/// Single precision keeps a share of a number of half of this.
const SINGLE: f64 = f32::EPSILON as f64;

/// What was found on the topics of one type.
#[derive(Default)]
struct Tally {
    messages: usize,
    numbers: usize,
    /// Stamps, frames and names that differ.
    words_off: usize,
    /// Largest difference of a number, as a share of it.
    off: f64,
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let bags: u64 = words.next().map_or(Ok(20), |a| a.parse())?;
    let samples: usize = words.next().map_or(Ok(500), |a| a.parse())?;
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    let path = std::env::temp_dir().join(format!("recon-result-{}.mcap", std::process::id()));
    for seed in 0..bags {
        let compared = compare(&path, seed, samples, &mut tallies);
        // Also after an error; what cannot be removed is in a folder for such things.
        let _ = std::fs::remove_file(&path);
        compared?;
    }
    println!("# Bags of results, read by another implementation\n");
    println!(
        "Made by `cargo xtask study result_bags`: {bags} bags of {samples} random samples each (lengths from 1 mm to 10 m, {PALMS} palms, contacts \
         that come and go, a covariance or none), written as `--mcap` does and decoded by `mcap-ros2-support` through the definitions in the bag \
         (`tests/ros2/read_back.py`), with all checksums verified. Numbers are compared with what was written, in the order of the definition. Balls and arrows at contacts \
         (`{}`) are decoded, and not compared.\n",
        DRAWN.join("`, `")
    );
    println!(
        "| topics of type | messages | numbers | stamps and names that differ | largest difference, of the number |"
    );
    println!("|---|---|---|---|---|");
    for (kind, tally) in &tallies {
        let Tally { messages, numbers, words_off, off } = tally;
        println!(
            "| {kind} | {messages} | {numbers} | {words_off} | {} |",
            if *off == 0.0 { "0".to_owned() } else { format!("{off:.1e}") }
        );
    }
    println!(
        "\nPoints of clouds are in single precision, as viewers take them: half of {SINGLE:.1e} of a number is what that leaves."
    );
    in_viewers(&path, samples)
}

/// What viewers make of a bag, topic by topic.
fn in_viewers(path: &Path, samples: usize) -> Result<(), Failure> {
    let times: Vec<f64> = (0..samples).map(|k| 1e-3 * k as f64).collect();
    let mesh = TriangleMesh::net(5, 8, |unit| unit);
    std::fs::write(path, bag(&mut Source::new(0), 1.0, &times, &mesh, true).bytes()?)?;
    let told = script("in_viewers.py", path);
    let _ = std::fs::remove_file(path);
    println!("\n## In viewers\n");
    println!(
        "The first of these bags, as Rerun's own loader takes it in (`rerun mcap convert`, what its viewer does with a bag), and its definitions beside \
         those that ROS 2 publishes (Jazzy, as `rosbags` has them), field by field (`tests/ros2/in_viewers.py`); and whether what is in the messages can be drawn: \
         unit quaternions, arrows of two points, triangles of three corners to scale, colours that are seen, clouds whose fields and sizes fit, and of every frame a \
         transform at or before the stamp, as Foxglove's 3D panel asks for. Rerun makes nothing of poses with \
         covariance and of markers but messages to be read: it shows the moving frame, contacts, forces (as points along their arrows), curves and the \
         bounds (as points all over them); the meshes it shows from `--mesh glb`. Foxglove's 3D panel lists all of these types; that it draws them was not looked at, for it does not run here. No message has a schema of Foxglove's own (`foxglove.SceneUpdate` and the like).\n"
    );
    println!(
        "| topic | type | as published | can be drawn | in Rerun (rows) |\n|---|---|---|---|---|\n{}",
        told?.trim_end()
    );
    Ok(())
}

/// Writes a bag, has it decoded, and compares all that was written, in its order.
fn compare(
    path: &Path,
    seed: u64,
    samples: usize,
    tallies: &mut BTreeMap<String, Tally>,
) -> Result<(), Failure> {
    let mut source = Source::new(seed);
    let size = 10.0_f64.powf(source.between(-3.0, 1.0));
    let times: Vec<f64> = (0..samples).map(|k| 1e-3 * k as f64).collect();
    let mesh = TriangleMesh::net(5, 8, |unit| size * unit);
    let bag = bag(&mut source, size, &times, &mesh, seed.is_multiple_of(2));
    std::fs::write(path, bag.bytes()?)?;
    let mut told = decoded(path)?;
    for (topic, messages) in expected(&bag, &mesh) {
        let (kind, found) = told.remove(&topic).ok_or_else(|| format!("{topic} is not in the bag"))?;
        if found.len() != messages.len() {
            let (written, read) = (messages.len(), found.len());
            return Err(format!("{topic}: {written} messages were written and {read} read").into());
        }
        let tally = tallies.entry(kind).or_default();
        for (own, found) in messages.iter().zip(&found) {
            tally.add(own, found).map_err(|wrong| format!("{topic}: {wrong}"))?;
        }
    }
    match told.keys().next() {
        Some(topic) => Err(format!("{topic} was not expected").into()),
        None => Ok(()),
    }
}

fn bag<'a>(
    source: &mut Source,
    size: f64,
    times: &'a [f64],
    mesh: &'a TriangleMesh,
    with_covariance: bool,
) -> ResultBag<'a> {
    let mut motion = Vec::new();
    let mut contacts = vec![Vec::new(); PALMS];
    for _ in times {
        let (p_WCm, R_WO) = (size * source.normal3(), source.rotation());
        let covariance = std::array::from_fn(|_| std::array::from_fn(|_| size * source.normal()));
        motion.push(ResultPose { p_WCm, R_WO, covariance: with_covariance.then_some(covariance) });
        for palm in &mut contacts {
            let contact = ResultContact { p_WC: size * source.normal3(), force: Some(source.normal3()) };
            palm.push((source.unit() < 0.8).then_some(contact));
        }
    }
    let curves = (0..100).map(|_| size * source.normal3()).collect();
    ResultBag { epoch: EPOCH, times, motion, contacts, curves, lower: Some(mesh), upper: Some(mesh) }
}

/// What is in the messages of each topic.
fn expected(bag: &ResultBag<'_>, mesh: &TriangleMesh) -> Vec<(String, Vec<Vec<Value>>)> {
    let moving = |values: &dyn Fn(usize) -> Vec<Value>, between: &[&str]| -> Vec<Vec<Value>> {
        // Times are whole milliseconds.
        let stamps = (0..bag.times.len()).map(|k| EPOCH + 1_000_000 * k as i64);
        stamps.enumerate().map(|(k, stamp)| [head(stamp, between), values(k)].concat()).collect()
    };
    let place = |k: usize| {
        let pose = &bag.motion[k];
        numbers([pose.p_WCm.to_array().as_slice(), &pose.R_WO.to_array()].concat())
    };
    let covariance = |k: usize| numbers(bag.motion[k].covariance.unwrap_or_default().as_flattened().to_vec());
    let touched = |k: usize| points((0..PALMS).filter_map(|palm| Some(bag.contacts[palm][k]?.p_WC)));
    let touch = |palm: usize, k: usize| {
        let contact = bag.contacts[palm][k].map(|c| [c.p_WC, c.force.unwrap_or_default()]);
        let touched = Value::from(u8::from(contact.is_some()));
        [vec![touched], points(contact.unwrap_or_default())].concat()
    };
    let still = |values: Vec<Value>| vec![[head(EPOCH, &["object"]), values].concat()];
    let triangles = |name: &str, id: u8| {
        let upright = numbers(vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let corners = mesh.triangles.iter().flatten().map(|&corner| mesh.vertices[corner as usize]);
        let words = vec![name.into(), id.into(), 11.into(), 0.into()];
        [head(EPOCH, &["object"]), words, upright, points(corners)].concat()
    };
    let mut all_topics = vec![
        ("/tf".to_owned(), moving(&place, &["world", "object"])),
        ("/recon/pose".to_owned(), moving(&|k| [place(k), covariance(k)].concat(), &["world"])),
        ("/recon/contact_curves".to_owned(), still(points(bag.curves.iter().copied()))),
        ("/recon/lower_bound".to_owned(), still(points(mesh.spread(ResultBag::OVER_BOUND)))),
        ("/recon/upper_bound".to_owned(), still(points(mesh.spread(ResultBag::OVER_BOUND)))),
        ("/recon/bounds".to_owned(), vec![[triangles("lower", 0), triangles("upper", 1)].concat()]),
    ];
    // As often as markers.
    let often = moving(&touched, &["world"]).into_iter().step_by(10).collect();
    all_topics.push(("/recon/contacts".to_owned(), often));
    let palms =
        (0..PALMS).map(|i| (format!("/recon/palm_{}/contact", i + 1), moving(&|k| touch(i, k), &["world"])));
    all_topics.extend(palms);
    all_topics
}

/// Type and messages of each topic.
type Topics = BTreeMap<String, (String, Vec<Vec<Value>>)>;

fn decoded(path: &Path) -> Result<Topics, Failure> {
    let mut topics = Topics::new();
    for line in script("read_back.py", path)?.lines() {
        let told: Value = serde_json::from_str(line)?;
        let word = |key: &str| told[key].as_str().unwrap_or_default().to_owned();
        if DRAWN.contains(&word("topic").as_str()) {
            continue;
        }
        let (_, messages) = topics.entry(word("topic")).or_insert_with(|| (word("type"), Vec::new()));
        messages.push(told["values"].as_array().cloned().unwrap_or_default());
    }
    Ok(topics)
}

/// What a script of `tests/ros2` prints of a bag.
fn script(name: &str, bag: &Path) -> Result<String, Failure> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/ros2").join(name);
    let run = Command::new("python3").arg(script).arg(bag).output()?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned().into());
    }
    Ok(String::from_utf8(run.stdout)?)
}

impl Tally {
    /// Counts a message; what has another length is an error.
    fn add(&mut self, own: &[Value], found: &[Value]) -> Result<(), String> {
        if own.len() != found.len() {
            return Err(format!("{} values were written and {} read", own.len(), found.len()));
        }
        self.messages += 1;
        for (own, found) in own.iter().zip(found) {
            let read = found.as_str().and_then(|word| word.parse::<f64>().ok());
            match (own.is_f64(), own.as_f64(), read) {
                (true, Some(own), Some(found)) => {
                    self.numbers += 1;
                    let off = if own == found { 0.0 } else { ((found - own) / own).abs() };
                    self.off = if off.is_nan() { f64::NAN } else { self.off.max(off) };
                }
                _ => self.words_off += usize::from(own != found),
            }
        }
        Ok(())
    }
}

fn head(stamp: i64, words: &[&str]) -> Vec<Value> {
    std::iter::once(stamp.into()).chain(words.iter().map(|word| Value::from(*word))).collect()
}

fn points(points: impl IntoIterator<Item = DVec3>) -> Vec<Value> {
    numbers(points.into_iter().flat_map(|point| point.to_array()).collect())
}

fn numbers(numbers: Vec<f64>) -> Vec<Value> {
    numbers.into_iter().map(Value::from).collect()
}
