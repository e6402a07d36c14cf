use super::{
    EstimateData, doubtful_spans, write_contact_report, write_estimate_report, write_planar_contact_report,
};
use crate::{
    Evidence, EvidenceValue, Level, PalmContact, PlanarScene, Scene, Verdict, estimate_summary,
    write_estimated_motion,
};
use glam::{DMat3, DVec3};
use recon::object_dynamics::{ContactLog, ContactMode, ContactSimulation, MOST_PALMS, SampleTimes, planar};
use recon::observer::contact_modes::{ContactOdds, LearnedFriction};
use recon::observer::contacts::{ContactEstimate, ContactEvidence, EstimatedModes};
use recon::observer::reliability::Reliability;

const PICK_UP: &str = include_str!("../../../scenes/pick-up.toml");
const OTHERS: &str = r#"
[[palm]]
kind = "cylinder"
radius = 0.01
pose = { position = [0.0, 0.0, 0.2] }
"#;

fn page(text: &str) -> String {
    let scene = Scene::parse(text).unwrap();
    let (start, times) = scene.contact_start().unwrap();
    let world = scene.contact_scene().unwrap();
    let run = world.simulate(&start, SampleTimes { rate: 200.0, ..times }, 1e-8).unwrap();
    let mut page = Vec::new();
    write_contact_report("<Fingers & table>", &world, &run, &mut page).unwrap();
    let none = ContactSimulation { instants: Vec::new(), ..run };
    assert!(write_contact_report("", &world, &none, Vec::new()).is_err());
    String::from_utf8(page).unwrap()
}

#[test]
fn the_page_is_whole_and_needs_nothing_else() {
    let page = page(&(PICK_UP.to_owned() + OTHERS));
    assert!(page.contains("&lt;Fingers &amp; table&gt;") && !page.contains("{{") && !page.contains("NaN"));
    let numbers = page.replace("infinite", "");
    assert!(!numbers.contains("inf") && !page.contains("src=") && !page.contains("href"));
    assert_eq!((page.matches("<figure").count(), page.matches("class=\"turn").count()), (1 + 6, 48));
    // Of five palms each is drawn in every picture.
    for palm in 1..=5 {
        assert_eq!(page.matches(&format!("class=\"palm p{palm}")).count(), 48 + 6);
        assert!(page.contains(&format!("class=\"name p{palm}\"")));
    }
    // A force goes with each contact, a centre of mass with each object; axes, gravity and a length stand under the film.
    assert_eq!(page.matches("class=\"force\"").count(), page.matches("class=\"touch m").count());
    assert_eq!(
        ["centre", "axis", "gravity", "scale"].map(|of| page.matches(&format!("class=\"{of}\"")).count()),
        [48 + 6, 3 + 4, 1, 1],
        "an axis for each panel as well"
    );
    assert!(page.contains(">0.02 m</text>"), "a round length");
    // The object starts on the table alone and ends in three fingers that stick.
    let touches: Vec<usize> =
        page.split("<figure").skip(2).map(|one| one.matches("\"touch m2\"").count()).collect();
    assert_eq!((touches[0], touches[5]), (1, 3));
    let bands = &page[page.find("class=\"bands\"").unwrap()..page.find("class=\"modes\"").unwrap()];
    assert!(bands.matches("class=\"m2\"").count() >= 4 && bands.matches("class=\"frame\"").count() == 5);
    for title in ["Normal force", "Speed of slip", "Energy since the start", "Turn since the start"] {
        assert!(page.contains(title), "{title}");
    }
}

/// Points of the first piece of the first line of a class, px.
fn line(page: &str, class: &str) -> Vec<[f64; 2]> {
    let opening = format!("class=\"{class}\" d=\"M");
    let text = page.split(&opening).nth(1).unwrap().split(['"', 'M']).next().unwrap().trim_end();
    let point = |p: &str| {
        let (x, y) = p.split_once(' ').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    text.split(" L").map(point).collect()
}

#[test]
fn a_scene_of_the_plane_has_the_same_page() {
    let scene = r#"
plane = true
gravity = 9.81
[object]
mass = 0.2
inertia = 1e-4
[palms]
friction = 0.3
[[palm]]
kind = "line"
pose = { position = [0.0, 0.0], angle_deg = 5.0 }
[[palm]]
kind = "arc"
radius = 0.012
pose = { position = [0.12, 0.09] }
[[palm]]
kind = "cup"
radius = 5.0
pose = { position = [0.0, 4.9] }
[simulation]
duration = 0.3
sample_rate = 200.0
position = [0.0, 0.08]
touches = []
shape = { kind = "circle", radius = 0.05 }
"#;
    let scene = PlanarScene::parse(scene).unwrap();
    let start = planar::ContactStart { body: scene.start, contacts: Vec::new() };
    let run = scene.world.simulate(&start, &scene.times.all().unwrap(), 1e-8).unwrap();
    let mut page = Vec::new();
    write_planar_contact_report("disc", &scene.world, &run, &mut page).unwrap();
    let page = String::from_utf8(page).unwrap();
    assert!(page.contains("<title>disc") && !page.contains("{{") && !page.contains("NaN"));
    assert_eq!((page.matches("<figure").count(), page.matches("class=\"turn").count()), (1 + 6, 48));
    for class in ["palm p1 open", "palm p2", "palm p3 open", "object"] {
        assert_eq!(page.matches(&format!("class=\"{class}\"")).count(), 48 + 6, "{class}");
    }
    // It falls, and lands on the line: nothing is touched in the first picture, one palm in the last.
    let touches: Vec<usize> =
        page.split("<figure").skip(2).map(|one| one.matches("\"touch").count()).collect();
    assert_eq!((touches[0], touches[5]), (0, 1));
    assert!(page.contains("class=\"flight\"") && page.contains("class=\"name p3\""));
    // The line rises by 5 degrees to the right, and circles are as large as they are to each other.
    let [from, .., to] = line(&page, "palm p1 open")[..] else { unreachable!() };
    let slope = (from[1] - to[1]) / (to[0] - from[0]);
    assert!((slope - 5.0_f64.to_radians().tan()).abs() < 2e-3, "{slope}");
    let width = |class: &str| {
        let x = line(&page, class).into_iter().map(|p| p[0]);
        x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min)
    };
    assert!((width("object") / width("palm p2") - 0.05 / 0.012).abs() < 0.1);
    // Of a large cup no more than some sizes of the object is drawn.
    assert!(width("palm p3 open") < 13.0 * width("object"));
}

#[test]
fn cups_are_arcs_under_the_contact_and_cylinders_strips() {
    let scene = r#"
gravity = 9.81
[object]
mass = 0.1
principal_moments = [3.05e-5, 3.7e-5, 4.25e-5]
[palms]
friction = 0.2
[[palm]]
kind = "cup"
radius = 0.08
pose = { position = [0.0, 0.0, 0.08] }
[[palm]]
kind = "cylinder"
radius = 0.01
pose = { position = [0.0, 0.06, 0.03] }
[simulation]
duration = 0.1
position = [0.0, 0.0, 0.025]
shape = { kind = "ellipsoid", semi_axes = [0.035, 0.03, 0.025] }
"#;
    let page = page(scene);
    let line = |class: &str| line(&page, class);
    let cup = line("palm p1 open");
    // An arc that opens upwards: its middle is lowest, at the contact, and its ends are not joined.
    let (first, middle, last) = (cup[0], cup[cup.len() / 2], cup[cup.len() - 1]);
    assert!(middle[1] > first[1] && middle[1] > last[1] && (first[0] - last[0]).abs() > 50.0);
    let touch = line("touch m2")[0];
    assert!((touch[0] - middle[0]).abs() < 1.0, "{touch:?} {middle:?}");
    // A parallelogram that ends where it begins; of four places rounded to 0.1 px, sides are off by 0.28 at most.
    let strip = line("palm p2");
    assert_eq!((strip.len(), strip[0]), (5, strip[4]));
    let side = |k: usize| (strip[k + 1][0] - strip[k][0]).hypot(strip[k + 1][1] - strip[k][1]);
    assert!((side(0) - side(2)).abs() < 0.3 && (side(1) - side(3)).abs() < 0.3 && side(0) > 2.0 * side(1));
}

/// An estimate of the fingertips' scene that is the truth, but for what is said of it.
fn estimate() -> EstimateData {
    let scene = Scene::parse(PICK_UP).unwrap();
    let (start, times) = scene.contact_start().unwrap();
    let world = scene.contact_scene().unwrap();
    let run = world.simulate(&start, SampleTimes { rate: 50.0, ..times }, 1e-8).unwrap();
    let log = ContactLog::from_simulation(&world, &run).unwrap();
    let states = log.truth().unwrap().to_vec();
    let count = states.len();
    let modes = |k: usize| -> [ContactMode; MOST_PALMS] {
        std::array::from_fn(|i| {
            log.palms().get(i).and_then(|palm| palm.truth(k)).map_or(ContactMode::Off, |t| t.mode)
        })
    };
    let estimate = ContactEstimate {
        pose_errors: None,
        pose_covariances: Vec::new(),
        misread: Vec::new(),
        misread_forces: Vec::new(),
        suspects: Vec::new(),
        explanations: Vec::new(),
        inertia_covariance: Default::default(),
        deviations: vec![[DVec3::splat(1e-3); 4]; count],
        // The third sample to the fifth, and the last one.
        relied_on: (0..count).map(|k| !(2..5).contains(&k) && k + 1 < count).collect(),
        modes: (0..count).map(modes).collect(),
        mode_odds: None,
        mass: 0.1,
        axes_deviations: None,
        mass_deviation: 0.02,
        inertia: DMat3::from_diagonal(DVec3::new(3.05e-5, 3.7e-5, 4.25e-5)),
        inertia_deviations: [0.1, 0.2, 0.7],
        reliability: Reliability::Reliable,
        evidence: ContactEvidence {
            samples: count,
            nodes: count,
            conditions: 3 * count,
            misfit: 1.0,
            lasting: 1.0,
            unresolved: 0.0,
            rougher: [1.0; 2],
            iterations: [5, 9],
            settled: true,
        },
        states: states.clone(),
    };
    let contact = |palm: &recon::object_dynamics::LoggedPalm, k: usize| {
        let touch = palm.touch(k).filter(|_| estimate.relied_on[k])?;
        let turn = states[k].R_WO.inverse();
        let (p_OC, normal) = (turn * (touch.p_WC - states[k].p_WCm), turn * -touch.n.get());
        Some(PalmContact { p_WC: touch.p_WC, p_OC, normal, radius: p_OC.dot(normal) })
    };
    EstimateData {
        title: "<Fingers & table>".into(),
        verdict: Verdict { level: Level::Good, text: "All <is> well.".into() },
        note: "Four palms & no more.".into(),
        curves: log.palms().iter().map(|palm| (0..count).map(|k| contact(palm, k)).collect()).collect(),
        truth: Some(states.iter().map(|state| (*state).into()).collect()),
        bounds: None,
        true_shape: None,
        marks: Vec::new(),
        shape: Vec::new(),
        force_noise: [0.1, 0.01],
        evidence: vec![Evidence {
            key: "misfit".into(),
            name: "Chi-squared".into(),
            value: EvidenceValue::Number(1.0),
            unit: String::new(),
            meaning: "About 1 & good.".into(),
            level: Level::Good,
        }],
        least_model: Vec::new(),
        warnings: vec!["<b>mind</b>".into()],
        next: "touch <more>".into(),
        log: log.split_truth().0,
        estimate,
    }
}

/// Where an object is is not known from a motion that is not relied on, and neither it nor its centre of mass is drawn anywhere.
#[test]
fn the_page_of_a_motion_that_is_not_relied_on_draws_no_object() {
    let mut data = estimate();
    let drawn = |data: &EstimateData| {
        let mut bytes = Vec::new();
        write_estimate_report(data, &mut bytes).unwrap();
        let page = String::from_utf8(bytes).unwrap();
        ["centre", "object", "force"].map(|class| page.matches(&format!("class=\"{class}\"")).count())
    };
    let [centres, objects, forces] = drawn(&data);
    assert!(centres > 0 && objects > 0 && forces > 0, "{centres} {objects} {forces}");
    data.estimate.relied_on.fill(false);
    // Far away: the picture is about the contacts.
    data.estimate.states.iter_mut().for_each(|state| state.p_WCm += DVec3::splat(1e3));
    data.curves.iter_mut().flatten().for_each(|contact| *contact = None);
    assert_eq!(drawn(&data), [0, 0, forces]);
}

#[test]
fn the_page_of_an_estimate_shows_palms_object_modes_and_doubts() {
    let mut data = estimate();
    let mut bytes = Vec::new();
    write_estimate_report(&data, &mut bytes).unwrap();
    let page = String::from_utf8(bytes).unwrap();
    assert!(page.contains("&lt;Fingers &amp; table&gt;") && !page.contains("{{") && !page.contains("NaN"));
    assert!(!page.contains("src=") && !page.contains("href") && page.contains("&lt;b&gt;mind&lt;/b&gt;"));
    assert!(page.contains("</strong>Four palms &amp; no more.</p>"));
    assert!(page.contains("All &lt;is&gt; well.") && page.contains("About 1 &amp; good."));
    assert_eq!((page.matches("<figure").count(), page.matches("class=\"turn").count()), (1 + 6, 48));
    for palm in 1..=4 {
        assert_eq!(page.matches(&format!("class=\"palm p{palm}")).count(), 48 + 6);
    }
    // The object is drawn each time, the doubts over bands of modes and over each of seven panels.
    assert_eq!(page.matches("class=\"object\"").count(), 48 + 6);
    assert_eq!(doubtful_spans(data.log.times(), &data.estimate.relied_on).len(), 2);
    assert_eq!(page.matches("class=\"shade\"").count(), 14);
    assert_eq!(page.matches("<rect class=\"doubtful\" x=").count(), 2);
    let [first, last] = [
        doubtful_spans(data.log.times(), &data.estimate.relied_on)[0],
        doubtful_spans(data.log.times(), &data.estimate.relied_on)[1],
    ];
    for (found, expected) in first.iter().chain(&last).zip([0.03, 0.09, 0.99, 1.0]) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    assert_eq!(page.matches("class=\"force\"").count(), page.matches("class=\"touch m").count());
    assert!(page.contains("Next</strong>Touch &lt;more&gt;.") && page.contains(">Contact forces</text>"));
    // Three components of three vectors and one turn with their bands and the truth, and so radii, in pieces.
    let motion =
        page.split("Motion over time</h2>").nth(1).unwrap().split("Radius functions").next().unwrap();
    assert_eq!(
        (motion.matches("<polygon").count(), motion.matches("stroke-dasharray=\"5 4\"").count()),
        (10, 10)
    );
    data.estimate.modes.pop();
    assert!(write_estimate_report(&data, Vec::new()).is_err());
}

/// Bands are as high as 95 % of the errors are large: of a distance from a palm, and of a force by its noise.
#[test]
fn radii_and_forces_carry_their_uncertainty() {
    let data = estimate();
    let panels = data.panels();
    let of = |title: &str| panels.iter().find(|panel| panel.title == title).unwrap();
    let radius = &of("Radius functions").curves[0];
    // Alike along all axes, and so along each normal; where nothing is relied on there is none.
    assert!((radius.half_heights[0] - 1.96e-3).abs() < 1e-12 && radius.half_heights[3].is_nan());
    assert!((radius.points[0][1] - radius.reference[0][1]).abs() < 1e-12, "the estimate is the truth");
    let force = &of("Contact forces").curves[0];
    assert_eq!(force.half_heights[0], 1.96 * 0.1_f64.hypot(0.01 * force.points[0][1]));
    assert!(data.largest_radius_error().unwrap() < 1e-12);
    assert_eq!(of("Distance from the truth").curves.len(), 3);
}

#[test]
fn radius_functions_are_a_table() {
    let data = estimate();
    let curves: Vec<_> = data.curves.iter().map(Vec::as_slice).collect();
    let mut bytes = Vec::new();
    crate::write_radius_functions(data.log.times(), &curves, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        (&rows[0][..], rows.len()),
        (&["t", "r_1", "r_2", "r_3", "r_4"][..], data.log.times().len() + 1)
    );
    assert_eq!(rows[1][1].parse::<f64>().unwrap(), data.curves[0][0].unwrap().radius);
    assert_eq!(rows[4][1], "nan");
}

#[test]
fn probabilities_of_modes_are_in_the_table_the_summary_and_the_bands() {
    let mut data = estimate();
    let count = data.log.times().len();
    let odds = |slide: f64| ContactOdds { off: 0.0, slide, stick: 1.0 - slide };
    let mut all = vec![[odds(1.0); MOST_PALMS]; count];
    all[3][0] = odds(0.7);
    all[4][0] = odds(0.7);
    let mut frictions = [None; MOST_PALMS];
    frictions[1] = Some(LearnedFriction { coefficient: 0.8, deviation: 4e-3 });
    let modes =
        EstimatedModes { odds: all, by_ratio: Vec::new(), frictions, one_friction: 0.9, doubts: Vec::new() };
    data.estimate.modes.fill([ContactMode::Slide; MOST_PALMS]);
    data.estimate.mode_odds = Some(modes);
    let figures = estimate_summary(&data);
    assert_eq!(figures["unsure_mode_samples"], 2);
    assert_eq!(figures["friction"], serde_json::json!([{ "palm": 2, "coefficient": 0.8, "std": 4e-3 }]));
    let mut bytes = Vec::new();
    write_estimated_motion(data.log.times(), &data.estimate, 4, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][30..32], ["p_slide_1", "p_stick_1"]);
    assert_eq!((rows[4][30], rows[4][31], rows[6][30], rows[0].len()), ("0.7", "0.3", "1", 31 + 8));
    let mut bytes = Vec::new();
    write_estimate_report(&data, &mut bytes).unwrap();
    let page = String::from_utf8(bytes).unwrap();
    // One pale stretch, with what is certain before and after it.
    assert_eq!(page.matches("<rect class=\"m1\" fill-opacity=\".7\"").count(), 1);
    assert_eq!(page.matches("<rect class=\"m1\" x=").count(), 2 + 3);
    if let Some(modes) = &mut data.estimate.mode_odds {
        modes.odds.pop();
    }
    assert!(write_estimate_report(&data, Vec::new()).is_err());
}

#[test]
fn table_and_summary_of_an_estimate_hold_what_is_relied_on() {
    let mut data = estimate();
    // An error where nothing is relied on does not count, another one does.
    data.estimate.states[3].p_WCm.x += 1.0;
    data.estimate.states[7].p_WCm.x += 1e-3;
    let figures = estimate_summary(&data);
    let count = data.log.times().len() as f64;
    let error = |which: &str| figures[which]["position_m"].as_f64().unwrap();
    assert!((error("largest_error") - 1e-3).abs() < 1e-12);
    assert!((error("rms_error") - 1e-3 / (count - 4.0).sqrt()).abs() < 1e-12);
    assert_eq!(figures["relied_on_share"].as_f64().unwrap(), (count - 4.0) / count);
    assert_eq!(figures["inertia_learned"], serde_json::json!([true, true, false]));
    let shares = figures["mode_shares"].as_array().unwrap();
    assert!(shares.len() == 4 && shares[0]["off"].as_f64().unwrap() > 0.3, "{shares:?}");
    let mut bytes = Vec::new();
    write_estimated_motion(data.log.times(), &data.estimate, 4, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!((rows.len(), rows[0].len()), (data.log.times().len() + 1, 14 + 12 + 4 + 1));
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    assert_eq!(rows[0][14..18], ["std_cmx", "std_cmy", "std_cmz", "std_vx"]);
    assert_eq!((rows[3][30], rows[6][30], rows[1][26]), ("0", "1", "2"));
    // Without anything to rely on there are no errors to tell.
    data.estimate.relied_on.fill(false);
    assert!(estimate_summary(&data)["rms_error"].is_null());
}
