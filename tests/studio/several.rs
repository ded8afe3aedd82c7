//! Several robots in one studio, and robots whose text is not at hand.

use crate::{
    browser::Browser,
    page::{RUNNING, Text, opened, start, wiring},
    socket,
};
use apex_diagram::Item;
use apex_studio::{ParamChange, Remote, Replayed, Seat, Source};
use std::{path::PathBuf, sync::Arc};

/// A source that is not at hand.
pub struct NoText;

impl Source for NoText {
    fn picture(&self, _name: &str) -> Option<Item> {
        None
    }

    fn errors(&self) -> Option<String> {
        None
    }

    fn save_params(&self, _params: &str) -> Result<String, String> {
        Err("there is no file".to_owned())
    }

    fn write_param(&self, _change: &ParamChange<'_>) -> Result<String, String> {
        Err("there is no file".to_owned())
    }

    fn replayed(&self) -> Result<Option<Replayed>, String> {
        Ok(None)
    }

    fn write_test(&self, _program: &str, _test: &str) -> Result<String, String> {
        Err("there is no file".to_owned())
    }

    fn texts(&self, files: &[String]) -> Vec<String> {
        vec![String::new(); files.len()]
    }

    fn path(&self, _file: &str) -> Option<PathBuf> {
        None
    }

    fn write_text(&self, _file: &str, _text: &str) -> Result<(), String> {
        Err("there is no file".to_owned())
    }
}

fn seat(name: &str, source: Arc<dyn Source>) -> Seat {
    let robot = Box::new(Remote { address: socket(name).display().to_string() });
    Seat { name: name.to_owned(), robot, source, shadow_of: None }
}

#[test]
fn a_page_shows_one_of_several_robots() {
    let robots = vec![seat("left", Arc::new(Text::default())), seat("right", Arc::new(NoText))];
    let (_left, address) = (start("left", 3600), opened(robots, false));
    let Some(mut page) = Browser::open(&address) else { return };
    page.wait_for(RUNNING);
    wiring(&mut page);
    page.wait_for("document.querySelector('[data-item=times]')");
    let choice = "document.getElementById('robot')";
    assert_eq!(page.value(&format!("[{choice}.hidden, {choice}.options.length]")), serde_json::json!([false, 2]));
    let choose = |page: &mut Browser, at: u32| {
        page.choose(choice, &format!("option.value === '{at}'"));
    };
    // The other one is not there yet.
    choose(&mut page, 1);
    page.wait_for("document.getElementById('run').textContent.includes('connecting')");
    page.wait_for("!document.querySelector('[data-item=times]')");
    let _right = start("right", 3600);
    page.wait_for(RUNNING);
    // The view is that of the robot before.
    page.wait_for("document.querySelector('[data-item=times]')");
    choose(&mut page, 0);
    page.wait_for(&format!("{choice}.value === '0' && document.querySelector('[data-item=times]')"));
    page.wait_for("document.querySelector('#text-area textarea').value.includes('graph Counts')");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn a_robot_without_its_text_is_drawn_from_what_it_says() {
    let _robot = start("untold", 3600);
    let Some(mut page) = Browser::open(&opened(vec![seat("untold", Arc::new(NoText))], false)) else { return };
    page.wait_for(RUNNING);
    // Its activity, too.
    page.wait_for("document.getElementById('does').textContent.startsWith('does: gate,')");
    wiring(&mut page);
    page.wait_for("document.querySelector('[data-item=\"gated.gate\"].is-active')");
    page.wait_for("document.querySelector('[data-item=gated].is-active')");
    page.wait_for("document.querySelector('[data-item=count].is-firing')");
    page.wait_for("document.querySelector('.line.flows')");
    page.wait_for("document.querySelector('.line[data-from=\"times:out\"]')");
    page.wait_for("document.getElementById('text-said').textContent.includes('no text')");
    assert_eq!(page.complaints, Vec::<String>::new());
}
