//! Lanes, lists and fields of the page, as the mouse and the keys find them.

use crate::{
    activity::tends,
    browser::Browser,
    page::{RUNNING, Text, moment, opened, start, studio, wiring},
};
use apex_studio::{Robot, Seat};
use serde_json::json;
use std::{sync::Arc, thread, time::Duration};

/// `true` if the robot is halted.
pub const HALTED: &str = "document.getElementById('run').textContent === 'halted'";

/// The rows of the timeline.
const ROWS: &str = "document.getElementById('timeline').dataset.rows";

/// Clicks the name of a row of the timeline.
fn click_row(page: &mut Browser, row: u32) {
    let box_ =
        page.value("(({ left, top }) => [left, top])(document.getElementById('timeline').getBoundingClientRect())");
    let (left, top) = (box_[0].as_f64().expect("a number"), box_[1].as_f64().expect("a number"));
    page.click_at((left + 30.0, top + 20.0 + 18.0 * (f64::from(row) + 0.5)));
}

#[test]
fn lanes_are_below_their_graphs_and_no_line_goes_through_their_names() {
    let Some((mut page, _robot)) = tends("lanes") else { return };
    // The token three is a problem.
    page.wait_for(&format!("{ROWS} === 'tend\\n go\\n water\\nrest\\nfirst.one'"));
    click_row(&mut page, 0);
    page.wait_for(&format!("{ROWS} === 'tend\\nrest\\nfirst.one'"));
    page.wait_for("import('./studio.js').then(({ robot }) => robot.selected === 'tend')");
    click_row(&mut page, 0);
    page.wait_for(&format!("{ROWS} === 'tend\\n go\\n water\\nrest\\nfirst.one'"));
    click_row(&mut page, 2);
    page.wait_for("document.querySelector('[data-item=\"tend.water\"].is-selected')");
    page.press("Escape");
    // Of one graph alone, its name is left out.
    page.fill("document.getElementById('lanes-filter')", "tend");
    page.wait_for(&format!("{ROWS} === 'go\\nwater'"));
    page.fill("document.getElementById('lanes-filter')", "");
    // A cursor that is not in view.
    let place = moment(&mut page, 0.5);
    page.click_at(place);
    page.press("Escape");
    page.value("document.getElementById('timeline').dispatchEvent(new CustomEvent('look', { detail: [2, 3, 0.5] }))");
    let accent = "(() => {
        const canvas = document.getElementById('timeline');
        const { data } = canvas.getContext('2d').getImageData(0, 0, 170, canvas.height);
        for (let at = 0; at < data.length; at += 4) if (data[at] === 28 && data[at + 1] === 109 && data[at + 2] === 208) return true;
        return false; })()";
    assert_eq!(page.value(accent), false);
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn names_in_a_condition_are_completed() {
    let Some((mut page, _robot)) = tends("condition") else { return };
    let field = "document.getElementById('break')";
    page.click(field);
    page.type_in("wat");
    page.wait_for("document.querySelector('#names [aria-selected=true]')?.textContent === 'tend.water'");
    page.press("Enter");
    page.wait_for(&format!("{field}.value === 'active(tend.water)'"));
    page.type_in(" && !active(re");
    page.wait_for("document.querySelector('#names [aria-selected=true]')?.textContent === 'rest'");
    page.press("Enter");
    page.type_in(")\n");
    page.wait_for(&format!("{field}.value === 'active(tend.water) && !active(rest)'"));
    page.wait_for(HALTED);
    page.wait_for("document.getElementById('does').textContent.startsWith('does: tend > water')");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn space_halts_wherever_one_was_before_and_sliders_stay_under_the_mouse() {
    let _robot = start("space", 3600);
    let Some(mut page) = Browser::open(&studio("space", false).0) else { return };
    page.wait_for(RUNNING);
    let space = |page: &mut Browser| {
        page.press(" ");
        page.wait_for(HALTED);
        page.press(" ");
        page.wait_for(RUNNING);
    };
    let row = "document.querySelector('[data-param=\"times.factor\"]')";
    let slider = format!("{row}.querySelector('[type=range]')");
    page.wait_for(row);
    page.click("document.querySelector('[data-tab=params]')");
    let place = |page: &mut Browser| {
        page.value(&format!("(({{ x, y, width }}) => [x, y, width])({slider}.getBoundingClientRect())"))
    };
    let before = place(&mut page);
    let [x, y, width] = [0, 1, 2].map(|at| before[at].as_f64().expect("a number"));
    page.drag((x + width * 2.0 / 9.0, y + 8.0), (x + width * 0.8, y + 8.0), false);
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    page.wait_for(&format!("{row}.querySelector('input[type=text]').value === '8'"));
    assert_eq!((place(&mut page), page.value(&format!("{slider}.value"))), (before, json!("8")));
    // Wherever it was in between and the robot has told, the last place counts.
    let shown = format!("{row}.querySelector('input[type=text]').value");
    for (number, pause) in [20, 35, 45, 55, 70, 90].into_iter().enumerate() {
        let last = if number % 2 == 0 { 0.3 } else { 0.8 };
        let at = |share: f64| (x + width * share, y + 8.0);
        page.drag_over(&[1.1 - last, 0.5, 0.2, 0.7, 0.1, 0.6, last].map(at), Duration::from_millis(pause));
        let there = page.value(&format!("{slider}.value"));
        thread::sleep(Duration::from_millis(300));
        assert_eq!([page.value(&shown), page.value(&format!("{slider}.value"))], [there.clone(), there]);
    }
    space(&mut page);
    page.fill(&format!("{row}.querySelector('input[type=text]')"), "5");
    space(&mut page);
    // Names have no spaces.
    page.click("document.getElementById('params-filter')");
    space(&mut page);
    assert_eq!(page.value("document.getElementById('params-filter').value"), "");
    page.choose("document.getElementById('speed')", "option.value === '4'");
    space(&mut page);
    page.click("document.getElementById('help')");
    space(&mut page);
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn pinned_ports_come_first_and_scans_are_where_they_were_taken() {
    let Some((mut page, _robot)) = tends("pinned") else { return };
    page.click("document.querySelector('[data-tab=values]')");
    let scan = "document.querySelector('[data-channel^=\"scan_ahead\"]')";
    page.wait_for(scan);
    assert_eq!(page.value(&format!("{scan}.previousElementSibling === null")), false);
    page.click(&format!("{scan}.querySelector('input')"));
    page.wait_for(&format!("{scan}.previousElementSibling === null"));
    // The node that scans takes a pose; nobody has chosen one.
    page.wait_for(&format!("{scan}.querySelector('select').value.startsWith('pose_on_circle')"));
    page.wait_for("document.getElementById('world').dataset.from === '1'");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn why_tells_values_and_what_slots_took() {
    let _robot = start("values", 3600);
    let Some(mut page) = Browser::open(&studio("values", false).0) else { return };
    page.wait_for(RUNNING);
    wiring(&mut page);
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 0.3");
    page.press(" ");
    page.wait_for(HALTED);
    page.click("document.querySelector('[data-item=\"gated.gate\"]')");
    page.press("w");
    let why = "document.getElementById('why').textContent";
    page.wait_for(&format!("{why}.includes('`gated.gate.activate` took a token at 0.000 s')"));
    // The answer about the next reaction has the values, too.
    page.value("new Promise((done) => setTimeout(done, 200))");
    page.press(".");
    page.value("new Promise((done) => setTimeout(done, 300))");
    page.press("w");
    page.wait_for(&format!("/`times.out` was sent: \\d+ at /.test({why})"));
    page.wait_for(&format!("/`count.out` was sent: \\d+ at /.test({why})"));
    assert_eq!(page.complaints, Vec::<String>::new());
}

/// A robot that has been started, and has not opened its socket yet.
struct Late;

impl Robot for Late {
    fn start(&mut self, _again: bool) -> Result<String, String> {
        Ok("/tmp/apex-studio-late/robot".to_owned())
    }

    fn runs(&mut self) -> bool {
        true
    }

    fn stop(&mut self) {}
}

#[test]
fn a_robot_that_starts_is_said_to_start() {
    let late =
        Seat { name: "late".to_owned(), robot: Box::new(Late), source: Arc::new(Text::default()), shadow_of: None };
    let Some(mut page) = Browser::open(&opened(vec![late], false)) else { return };
    page.wait_for("document.getElementById('run').textContent === 'starting'");
    assert!(!page.words().contains("/tmp"));
}
