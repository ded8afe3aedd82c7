//! The text on the page of the studio: edited, checked by the language server, and saved.

use crate::{
    browser::Browser,
    page::{RUNNING, start, studio, wiring},
};
use std::{thread, time::Duration};

const AREA: &str = "document.querySelector('#text-area textarea')";
const SELECTED: &str = "document.querySelector('#text .is-selected')";

/// Opens the text of a robot on its page.
fn open(page: &mut Browser) {
    page.wait_for(RUNNING);
    wiring(page);
    page.click("document.querySelector('[data-tab=text]')");
    page.wait_for(&format!("{AREA}.value.includes('graph Counts')"));
    page.wait_for("document.querySelector('#text .keyword')?.textContent === 'use'");
}

/// The place of the first letter of words in the text, and that behind their last one, where the coloured rows show
/// them as soon as the page stands still: what it is told meanwhile may still move the text.
fn ends(page: &mut Browser, words: &str) -> [(f64, f64); 2] {
    let mut last = ends_now(page, words);
    loop {
        thread::sleep(Duration::from_millis(50));
        let now = ends_now(page, words);
        if now == last {
            return now;
        }
        last = now;
    }
}

fn ends_now(page: &mut Browser, words: &str) -> [(f64, f64); 2] {
    let place = page.value(&format!(
        "(() => {{
            const at = {AREA}.value.indexOf('{words}');
            const before = {AREA}.value.slice(0, at).split('\\n');
            const row = document.querySelectorAll('#text .paper .row')[before.length - 1];
            row.scrollIntoView({{ block: 'center' }});
            const point = (column) => {{
                const range = document.createRange(), walk = document.createTreeWalker(row, NodeFilter.SHOW_TEXT);
                for (let node = walk.nextNode(); node; node = walk.nextNode()) {{
                    if (column > node.length) {{ column -= node.length; continue; }}
                    range.setStart(node, column);
                    const box = range.getBoundingClientRect();
                    return [box.left + 0.5, box.top + box.height / 2];
                }}
            }};
            const column = before.at(-1).length, ends = () => [point(column), point(column + '{words}'.length)];
            // In the middle, since the browser scrolls while the mouse marks something near an edge.
            const [from, to] = ends(), area = document.getElementById('text-area'), box = area.getBoundingClientRect();
            area.scrollLeft += (from[0] + to[0]) / 2 - (box.left + box.width / 2);
            return ends(); }})()"
    ));
    [0, 1].map(|end| (place[end][0].as_f64().expect(words), place[end][1].as_f64().expect(words)))
}

/// Replaces words of the text: they are marked with the mouse, and others are typed.
fn replace(page: &mut Browser, old: &str, new: &str) {
    let [from, to] = ends(page, old);
    page.drag(from, to, false);
    assert_eq!(page.value(&format!("{AREA}.value.slice({AREA}.selectionStart, {AREA}.selectionEnd)")), old);
    page.type_in(new);
    // What was typed may have opened a list of names.
    if page.value("document.querySelector('#text .menu').hidden") == false {
        page.press("Escape");
    }
}

fn save(page: &mut Browser) {
    page.press("Control+s");
}

#[test]
fn errors_of_the_text_are_shown_in_it_and_over_the_running_picture() {
    let _robot = start("errors", 3600);
    let Some(mut page) = Browser::open(&studio("errors", false).0) else { return };
    open(&mut page);
    for kind in ["docs", "type", "number", "arrow"] {
        page.wait_for(&format!("document.querySelector('#text .paper .{kind}')"));
    }
    // In a node, in the graph above.
    replace(&mut page, "factor = 2", "faktor = 2");
    page.wait_for("document.querySelector('#text .wrong')?.textContent.includes('faktor')");
    page.wait_for("document.querySelector('[data-item=times].is-wrong')");
    assert_eq!(page.value("document.querySelectorAll('#picture .is-wrong').length"), 1);
    page.wait_for("document.getElementById('text-found').textContent.includes('1 error')");
    // The old robot goes on.
    assert_eq!(page.value(RUNNING), true);
    replace(&mut page, "faktor = 2", "factor = 2");
    page.wait_for("!document.querySelector('#picture .is-wrong')");
    // In a connection.
    replace(&mut page, "times -> gated.number", "times -> gated.enable");
    page.wait_for("document.querySelector('#text .wrong')");
    page.wait_for("document.querySelector('.line.is-wrong')?.dataset.from.startsWith('times:')");
    replace(&mut page, "times -> gated.enable", "times -> gated.number");
    page.wait_for("!document.querySelector('#picture .is-wrong')");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn a_text_is_saved_unless_others_have_changed_it() {
    let _robot = start("saves", 3600);
    let (address, text) = studio("saves", false);
    let Some(mut page) = Browser::open(&address) else { return };
    open(&mut page);
    let saved = |page: &mut Browser| page.wait_for("document.getElementById('text-said').textContent === 'saved'");
    let is_own = "document.querySelector('[data-tab=text]').classList.contains('is-own')";
    assert_eq!(page.value(is_own), false);
    replace(&mut page, "factor = 2", "factor = 3");
    page.wait_for(is_own);
    save(&mut page);
    saved(&mut page);
    page.wait_for(&format!("!{is_own}"));
    let written = text.text.lock().unwrap().clone().expect("it was saved");
    assert!(written.contains("factor = 3") && written.contains("graph Counts"), "{written}");
    // A change by others is taken if nothing was typed here.
    let others = written.replace("factor = 3", "factor = 4");
    *text.text.lock().unwrap() = Some(others.clone());
    page.wait_for(&format!("{AREA}.value.includes('factor = 4')"));
    // Otherwise it is neither taken nor overwritten.
    replace(&mut page, "factor = 4", "factor = 5");
    *text.text.lock().unwrap() = Some(others.replace("factor = 4", "factor = 6"));
    save(&mut page);
    page.wait_for("!document.getElementById('text-over').hidden");
    assert!(text.text.lock().unwrap().as_ref().is_some_and(|text| text.contains("factor = 6")));
    assert_eq!(page.value(&format!("{AREA}.value.includes('factor = 5')")), true);
    page.click("document.getElementById('text-over')");
    saved(&mut page);
    page.wait_for("document.getElementById('text-over').hidden");
    assert!(text.text.lock().unwrap().as_ref().is_some_and(|text| text.contains("factor = 5")));
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn names_are_completed_and_explained() {
    let _robot = start("completes", 3600);
    let Some(mut page) = Browser::open(&studio("completes", false).0) else { return };
    open(&mut page);
    // By the keyboard alone.
    replace(&mut page, "times -> gated.number", "times -> gated.numb");
    page.press("Control+ ");
    page.wait_for("document.querySelector('#text .menu li[aria-selected=true]')?.textContent.startsWith('number')");
    page.press("Enter");
    page.wait_for(&format!("{AREA}.value.includes('times -> gated.number;')"));
    page.wait_for("document.querySelector('#text .menu').hidden");
    let [place, _] = ends(&mut page, "untUp() every");
    page.click_at(place);
    page.press("F1");
    page.wait_for("document.getElementById('tip').textContent.includes('CountUp')");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn lines_and_nodes_are_selected_together_also_while_the_text_changes() {
    let _robot = start("lines", 3600);
    let Some(mut page) = Browser::open(&studio("lines", false).0) else { return };
    open(&mut page);
    replace(&mut page, "/// Lets", "/// One.\\n/// Two.\\n/// Lets");
    let click = |page: &mut Browser, words: &str| {
        let [place, _] = ends(page, words);
        page.click_at(place);
    };
    click(&mut page, "node times");
    page.wait_for("document.querySelector('[data-item=times].is-selected')");
    page.wait_for(&format!("{SELECTED}.textContent.includes('node times')"));
    let count = "document.querySelector('[data-item=count]')";
    page.click(count);
    page.wait_for(&format!("{SELECTED}.textContent.includes('node count')"));
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn who_may_only_look_changes_no_text() {
    let _robot = start("locked", 3600);
    let (address, text) = studio("locked", true);
    let Some(mut page) = Browser::open(&address) else { return };
    open(&mut page);
    assert_eq!(page.value(&format!("{AREA}.readOnly")), true);
    assert_eq!(page.value("document.getElementById('text-save').hidden"), true);
    // Nor by messages of its own.
    page.value("import('./page.js').then(({ ask }) => ask({ keep: { file: 0, text: 'graph Other {}', over: true } }))");
    page.value("new Promise((done) => setTimeout(done, 300))");
    assert_eq!(*text.text.lock().unwrap(), None);
}
