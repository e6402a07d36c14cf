use super::{write_contact_report, write_planar_contact_report};
use crate::{PlanarScene, Scene};
use recon::object_dynamics::{ContactSimulation, SampleTimes, planar};

const PICK_UP: &str = include_str!("../../../../recon-cli/scenes/pick-up.toml");
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
    assert!(!page.contains("inf") && !page.contains("src=") && !page.contains("href"));
    assert_eq!(page.matches("<figure").count(), 6);
    // Of five palms each is drawn in every picture.
    for palm in 1..=5 {
        assert_eq!(page.matches(&format!("class=\"palm p{palm}\"")).count(), 6);
        assert!(page.contains(&format!("class=\"name p{palm}\"")));
    }
    // The object starts on the table alone and ends in three fingers that stick.
    let touches: Vec<usize> =
        page.split("<figure").skip(1).map(|one| one.matches("\"touch m2\"").count()).collect();
    assert_eq!((touches[0], touches[5]), (1, 3));
    let bands = &page[page.find("class=\"bands\"").unwrap()..page.find("class=\"legend\"").unwrap()];
    assert!(bands.matches("class=\"m2\"").count() >= 4 && bands.matches("class=\"frame\"").count() == 5);
    for title in ["Normal force", "Speed of slip", "Energy since the start", "Turn since the start"] {
        assert!(page.contains(title), "{title}");
    }
}

/// Points of the first line of a class, px.
fn line(page: &str, class: &str) -> Vec<[f64; 2]> {
    let opening = format!("class=\"{class}\" d=\"M");
    let text = page.split(&opening).nth(1).unwrap().split('"').next().unwrap();
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
    assert_eq!(page.matches("<figure").count(), 6);
    for class in ["palm p1 open", "palm p2", "palm p3 open", "object"] {
        assert_eq!(page.matches(&format!("class=\"{class}\"")).count(), 6, "{class}");
    }
    // It falls, and lands on the line: nothing is touched in the first picture, one palm in the last.
    let touches: Vec<usize> =
        page.split("<figure").skip(1).map(|one| one.matches("\"touch").count()).collect();
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
