use super::write_contact_report;
use crate::Scene;
use recon::object_dynamics::{ContactSimulation, SampleTimes};

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
