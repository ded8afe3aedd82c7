//! The picture of the robot: its activity, which anybody can read, and its wiring, in which one finds one's way.

use crate::{
    Pumps, Tends,
    browser::Browser,
    page::{RUNNING, Started, start_of, studio_for_file, wiring},
};

/// Starts the robot that tends plants, and opens its page.
pub fn tends(name: &'static str) -> Option<(Browser, Started)> {
    let robot = start_of(name, Tends::new, 3600);
    let mut page = Browser::open(&studio_for_file(name, "studio/tends.afg"))?;
    page.size(1000, 700, false);
    page.wait_for(RUNNING);
    Some((page, robot))
}

/// The rectangle of a box on the screen: left, top, right and bottom, and those of the picture.
fn places(page: &mut Browser, item: &str) -> [f64; 8] {
    let places = page.value(&format!(
        "[document.querySelector('[data-item=\"{item}\"] > .box'), document.getElementById('picture')].flatMap((of) => {{
            const {{ left, top, right, bottom }} = of.getBoundingClientRect();
            return [left, top, right, bottom]; }})"
    ));
    std::array::from_fn(|at| places[at].as_f64().expect(item))
}

/// `true` if a box is in the window as a whole.
fn is_in_window(page: &mut Browser, item: &str) -> bool {
    let [left, top, right, bottom, first, above, last, below] = places(page, item);
    left >= first - 1.0 && top >= above - 1.0 && right <= last + 1.0 && bottom <= below + 1.0
}

/// Heights of the letters on the screen of all words that are shown, in pixels.
const LETTERS: &str = "[...document.querySelectorAll('#picture text')]
    .filter((text) => text.textContent !== '' && text.getBoundingClientRect().width > 0)
    .map((text) => parseFloat(getComputedStyle(text).fontSize) * document.querySelector('#picture svg').getScreenCTM().a)";

#[test]
fn the_page_says_what_the_robot_does_and_since_when() {
    let Some((mut page, _robot)) = tends("tends") else { return };
    page.wait_for("document.getElementById('does').textContent === 'does: tend > go, 1 s'");
    let is_large = "parseFloat(getComputedStyle(document.getElementById('does')).fontSize) > 20";
    assert_eq!(page.value(is_large), true);
    // The states alone, of which one is active; what only computes is elsewhere.
    page.wait_for("document.querySelector('[data-item=\"tend.go\"].is-active')");
    page.wait_for("document.querySelector('[data-item=\"tend.go\"]').textContent.includes('1 s')");
    assert_eq!(page.value("document.querySelector('[data-item=count]')"), serde_json::Value::Null);
    assert_eq!(page.value("document.querySelectorAll('#picture .item.is-active:not(.frame)').length"), 1);
    page.wait_for("document.getElementById('does').textContent === 'does: tend > water, 0 s'");
    page.wait_for("document.querySelector('.line.is-last')?.dataset.from === 'tend.go:'");
    assert_eq!(page.value("document.querySelector('.line.is-last').dataset.to"), "tend.water:");
    page.wait_for("document.getElementById('does').textContent.startsWith('does: rest')");
    page.wait_for("document.querySelector('[data-item=\"tend.go\"]').textContent.includes('Wait')");
    // Lines into and out of a closed graph are lit, too.
    page.double_click("document.querySelector('[data-item=tend] > text')");
    page.wait_for("!document.querySelector('[data-item=\"tend.go\"]')");
    page.wait_for("document.getElementById('does').textContent.startsWith('does: tend > go')");
    page.wait_for("document.querySelector('[data-item=tend].is-active')");
    page.wait_for("document.querySelector('.line.is-last')?.dataset.from === 'rest:'");
    // A click on what it does shows where.
    page.click("document.getElementById('does')");
    page.wait_for("document.querySelector('[data-item=\"tend.go\"].is-selected')");
    // What is no state is shown in the wiring.
    page.value("import('./studio.js').then(({ picture }) => picture.jump('second.two'))");
    page.wait_for("document.querySelector('[data-item=\"second.two\"].is-selected')");
    assert_eq!(page.value("document.getElementById('picture').dataset.view"), "wiring");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn the_state_of_a_state_machine_is_lit() {
    let _robot = start_of("pump", Pumps::new, 3600);
    let Some(mut page) = Browser::open(&studio_for_file("pump", "studio/pump.afg")) else { return };
    page.size(1000, 700, false);
    page.wait_for(RUNNING);
    for state in ["rest", "run.fill", "run.settle"] {
        page.wait_for(&format!("document.querySelector('[data-item=\"pump.{state}\"].is-active')"));
        assert_eq!(page.value("document.querySelectorAll('[data-item^=\"pump.\"].is-active').length"), 1);
        page.wait_for("document.getElementById('does').textContent.includes('pump')");
    }
    // The machine itself is always in a state: it would always be lit.
    assert_eq!(page.value("document.querySelector('[data-item=pump]').classList.contains('is-active')"), false);
    page.click("document.querySelector('[data-item=\"pump.run.settle\"]')");
    page.wait_for("document.querySelector('[data-item=\"pump.run.settle\"].is-selected')");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn names_can_be_read_however_small_the_picture_is() {
    let Some((mut page, _robot)) = tends("small") else { return };
    wiring(&mut page);
    page.wait_for("document.getElementById('picture').classList.contains('is-small')");
    let letters = page.value(LETTERS);
    let letters: Vec<f64> = letters.as_array().expect("a list").iter().filter_map(serde_json::Value::as_f64).collect();
    assert!(letters.len() > 10 && letters.iter().all(|height| (10.0..14.0).contains(height)), "{letters:?}");
    // Nothing lies over a name, and ports have none.
    let shown = "[...document.querySelectorAll('#picture .label')].map((label) => label.textContent).filter(Boolean)";
    let names = page.value(shown);
    assert!(names.as_array().expect("a list").iter().any(|name| name == "count"), "{names}");
    page.wait_for("![...document.querySelectorAll('#picture .item > rect:not(.box)')].some((port) => port.getBoundingClientRect().width > 0)");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn a_click_comes_nearer_and_an_opened_graph_stays_in_the_window() {
    let Some((mut page, _robot)) = tends("near") else { return };
    wiring(&mut page);
    let first = "document.querySelector('[data-item=first] > .box')";
    page.wait_for("document.getElementById('picture').classList.contains('is-small')");
    page.click("document.querySelector('[data-item=\"second.six\"] > .box')");
    page.wait_for("document.querySelector('[data-item=\"second.six\"].is-selected')");
    page.wait_for("!document.getElementById('picture').classList.contains('is-small')");
    assert!(is_in_window(&mut page, "second.six"));
    // Of a selected graph only the border is another one.
    let color = "getComputedStyle(document.querySelector('[data-item=tend] > .box')).fill";
    page.press("0");
    page.wait_for("document.querySelector('[data-item=tend].is-active')");
    page.value("new Promise((done) => setTimeout(done, 400))");
    let before = page.value(color);
    let [left, top, ..] = places(&mut page, "tend");
    page.click_at((left + 4.0, top + 25.0));
    page.wait_for("document.querySelector('[data-item=tend].is-selected')");
    assert_eq!(page.value(color), before);
    // Closed, dragged to the edge of the window, and opened again.
    page.press("0");
    page.double_click("[...document.querySelectorAll('[data-item=first] > .box')][0]");
    page.wait_for("!document.querySelector('[data-item=\"first.one\"]')");
    let [_, top, right, bottom, ..] = places(&mut page, "first");
    let [.., last, _] = places(&mut page, "first");
    page.drag((right - 4.0, f64::midpoint(top, bottom)), (last - 4.0, f64::midpoint(top, bottom)), false);
    page.double_click(first);
    page.wait_for("document.querySelector('[data-item=\"first.one\"]')");
    assert!(is_in_window(&mut page, "first"));
    assert_eq!(page.complaints, Vec::<String>::new());
}
