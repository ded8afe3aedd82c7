//! The page of a study in a real browser: what it shows while the journal grows.

use crate::{
    browser::Browser,
    page::{RUNNING, Text, answer, opened_with, start},
    socket,
};
use apex_studio::{Remote, Seat, Study as Shown};
use apex_tune::{Axis, Follower, Goal, Journal, Method, Objective, Parameter, Report, Scale, Study, Summary};
use std::{
    fs::{self, OpenOptions},
    io::Write as _,
    path::{Path, PathBuf},
    sync::Arc,
};

/// Noisy valley, in which small values fail.
struct Valley;

impl Objective for Valley {
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
        let noise = (seed.wrapping_mul(0x9e37_79b9) % 1000) as f64 / 1000.0;
        let (x, y) = (values[0] - 2.0 - 0.4 * noise, values[1].ln() - 1.0);
        let cost = 0.1 * noise + x * x + 3.0 * (y - x) * (y - x);
        Ok(vec![if values[0] < -5.0 { f64::NAN } else { cost }, values[0] - noise])
    }
}

/// Names that would run scripts if they were more than text.
const NAME: &str = "Valley <img src=x onerror=\"alert(1)\">";

fn study() -> Study {
    let parameter = |name: &str, low, high, scale, default| {
        let (axis, unit) = (Axis::new(low, high, scale, false).expect("a range"), "m<sup>".to_owned());
        Parameter {
            name: name.to_owned(),
            unit,
            shown_in: None,
            axis,
            default,
            targets: vec!["node.x".to_owned()],
            single: false,
        }
    };
    let (unit, summary) = ("m</td>".to_owned(), Summary::Quantile(0.9));
    Study {
        name: NAME.to_owned(),
        objective: 7,
        parameters: vec![
            parameter("<script>alert(2)</script>", -10.0, 10.0, Scale::Linear, 5.0),
            parameter("y", 0.01, 100.0, Scale::Logarithmic, 1.0),
        ],
        method: Method::DifferentialEvolution,
        goals: vec![Goal { name: "cost".to_owned(), unit, maximise: false, summary, least: f64::NEG_INFINITY }],
        seeds: (0..16).collect(),
        held_out: (100..116).collect(),
        searches: 1,
        candidates: 90,
        seed: 5,
        racing: true,
    }
}

/// The folder of a study for a test, and the whole journal of this study.
fn folder(name: &str, study: &Study) -> (PathBuf, String) {
    let folder = socket(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a new folder");
    let file = folder.join("whole");
    let mut journal = Journal::open(&file, study).expect("a new journal");
    let found = study.run(&Valley, &mut journal, (0, 1), &mut |_| ()).expect("a study");
    Report::new(study, found, &Valley, &mut journal).expect("scores").expect("a result");
    let text = fs::read_to_string(&file).expect("the journal");
    (folder, text)
}

/// Opens a studio for the study in a folder, and returns the address of its page.
fn studio(folder: &Path) -> String {
    opened_with(vec![], vec![Shown { name: "valley".to_owned(), folder: folder.to_owned() }], false)
}

fn append(folder: &Path, text: &str) {
    let file = OpenOptions::new().append(true).create(true).open(folder.join(Journal::FILE));
    file.and_then(|mut file| file.write_all(text.as_bytes())).expect("the journal");
}

/// Numbers of the lanes that are drawn with their fates.
const LANES: &str = "document.getElementById('candidates').dataset.lanes";

/// The place in the lane of a candidate, at a share of its width.
fn lane(page: &mut Browser, number: usize, x: f64) -> (f64, f64) {
    let place = page.value(&format!(
        "(() => {{ const box = document.getElementById('candidates').getBoundingClientRect();
            const y = box.top + ({number} * 18 - document.getElementById('lanes').scrollTop) + 9;
            return [box.left + 170 + {x} * (box.width - 170), y]; }})()"
    ));
    (place[0].as_f64().expect("a number"), place[1].as_f64().expect("a number"))
}

#[test]
fn a_study_is_followed_while_it_runs() {
    let (folder, text) = folder("study", &study());
    let (first, rest) = text.split_at(text.len() / 3);
    append(&folder, first);
    let Some(mut page) = Browser::open(&studio(&folder)) else { return };
    page.size(1200, 2600, false);
    page.wait_for(&format!("document.getElementById('name').textContent === {NAME:?}"));
    page.wait_for("document.getElementById('run').textContent === 'running'");
    page.wait_for(&format!("{LANES}.startsWith('0:complete ') && {LANES}.includes(':running')"));
    let ended = "parseInt(document.getElementById('progress').textContent)";
    let before = page.value(ended).as_u64().expect("a number");
    assert!((1..60).contains(&before), "{before}");
    page.wait_for("/^best .* m<\\/td>, defaults .* m<\\/td>$/.test(document.getElementById('value').textContent)");
    // It grows, with an end in the middle of a line.
    let (second, last) = rest.split_at(rest.len() / 2);
    append(&folder, second);
    page.wait_for(&format!("{ended} > {before}"));
    assert!(page.value("document.getElementById('run').textContent") == "running");
    page.wait_for(&format!("{LANES}.includes(':stopped') && {LANES}.includes(':failed')"));
    append(&folder, last);
    page.wait_for("document.getElementById('run').textContent === 'finished'");
    page.wait_for("document.getElementById('progress').textContent === '90 of 90 candidates'");
    page.wait_for(&format!("{LANES}.split(' ').length === 90 && !{LANES}.includes(':running')"));
    page.wait_for("document.getElementById('result').textContent.includes('lost with the default')");
    assert_eq!(page.complaints, Vec::<String>::new());
    assert_eq!(page.value("document.querySelectorAll('img, sup, main script').length"), 0);
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
fn a_candidate_shows_its_values_and_offers_them_as_a_file() {
    let (folder, text) = folder("candidate", &study());
    append(&folder, &text);
    let mut follower = Follower::new(folder.join(Journal::FILE));
    while follower.read().expect("a journal") {}
    let seen = follower.seen().expect("a study");
    let best = seen.best().expect("a best one").1;
    let Some(mut page) = Browser::open(&studio(&folder)) else { return };
    page.size(1200, 2600, false);
    let title = "document.querySelector('#candidate h2').textContent";
    let toml = "document.getElementById('toml').textContent";
    let file = |number: usize| seen.study().params(&seen.trail(0).expect("a search").candidates()[number].values);
    // At first the best one.
    page.wait_for(&format!("{title} === 'Candidate {best}, the best'"));
    page.wait_for(&format!("{toml} === {:?}", file(best)));
    page.wait_for(&format!("{LANES}.split(' ').length === 90"));
    // Under the pointer, and away again.
    let first = lane(&mut page, 0, 0.01);
    page.point_at(first);
    page.wait_for(&format!("{title} === 'Candidate 0'"));
    page.wait_for("document.getElementById('tip').textContent.startsWith('candidate 0\\nseed 0: ')");
    assert_eq!(page.value(toml), "");
    assert!(page.value("document.querySelectorAll('.param.is-changed').length") == 0);
    page.point_at((first.0, 2.0));
    page.wait_for(&format!("{title} === 'Candidate {best}, the best'"));
    assert!(page.value("document.querySelectorAll('.param.is-changed').length") == 2);
    // A click keeps it.
    let eighth = lane(&mut page, 7, 0.5);
    page.click_at(eighth);
    page.wait_for(&format!("{title} === 'Candidate 7'"));
    page.wait_for(&format!("{toml} === {:?}", file(7)));
    page.press("c");
    page.wait_for("document.getElementById('copied').textContent !== ''");
    let shown = "[...document.querySelectorAll('.param .number')].map((number) => Number(number.textContent))";
    let values = page.value(shown);
    for (shown, value) in values.as_array().expect("numbers").iter().zip(&seen.trail(0).unwrap().candidates()[7].values)
    {
        assert!((shown.as_f64().expect("a number") - value).abs() <= 1e-5 * value.abs(), "{values}");
    }
    // Keys: the best one, the best first, the next lane.
    page.press("b");
    page.wait_for(&format!("{title} === 'Candidate {best}, the best'"));
    page.press("o");
    page.wait_for(&format!("{LANES}.startsWith('{best}:complete ')"));
    page.value("document.getElementById('candidates').focus()");
    page.press("ArrowDown");
    page.wait_for(&format!(
        "!{title}.includes('the best') && document.querySelector('#candidate .fate').classList.contains('complete')"
    ));
    page.press("2");
    page.wait_for("!document.getElementById('result').hidden");
    assert_eq!(page.complaints, Vec::<String>::new());
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
fn a_journal_that_cannot_be_read_is_an_error_until_it_can() {
    let (folder, text) = folder("wrong-study", &study());
    let Some(mut page) = Browser::open(&studio(&folder)) else { return };
    let error = "document.getElementById('errors').textContent";
    let journal = folder.join(Journal::FILE);
    page.wait_for(&format!("{error}.includes('No such file')"));
    fs::write(&journal, "<b>of</b> another program\n").expect("a file");
    page.wait_for(&format!("{error}.includes('journal.csv:1: the study of the journal cannot be shown')"));
    fs::write(&journal, "\u{fffd}").expect("a file");
    page.wait_for("document.getElementById('run').textContent === 'the journal has no complete line yet'");
    fs::write(&journal, b"\xff\xfe\n").expect("a file");
    page.wait_for(&format!("{error}.includes('journal.csv:1: not a run')"));
    let line = text.match_indices('\n').nth(40).expect("many lines").0 + 1;
    fs::write(&journal, [&text[..line], "0,<img>,1\n", &text[line..]].concat()).expect("a file");
    page.wait_for(&format!("{error}.includes('journal.csv:42: not a run')"));
    page.wait_for("document.getElementById('run').textContent === 'the journal has an error'");
    page.wait_for(&format!("{LANES}.startsWith('0:')"));
    assert_eq!(page.complaints, Vec::<String>::new());
    fs::write(&journal, text).expect("a file");
    page.wait_for("document.getElementById('errors').hidden");
    page.wait_for("document.getElementById('run').textContent === 'finished'");
    page.value("location.hash = 'wrong'");
    page.wait_for("document.getElementById('run').textContent.includes('wrong token')");
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
fn searches_and_goals_can_be_chosen() {
    let one = study();
    let far = Goal { name: "far".to_owned(), unit: "km".to_owned(), maximise: true, ..one.goals[0].clone() };
    let several = Study { goals: vec![one.goals[0].clone(), far], searches: 3, candidates: 20, ..one };
    let (folder, text) = folder("several-goals", &several);
    append(&folder, &text);
    let Some(mut page) = Browser::open(&studio(&folder)) else { return };
    page.size(1200, 2600, false);
    page.wait_for("document.getElementById('progress').textContent === '60 of 60 candidates'");
    page.wait_for(
        "/^best .* % against the defaults, defaults .* m<\\/td>$/.test(document.getElementById('value').textContent)",
    );
    let choose = |page: &mut Browser, id: &str, number: usize| {
        page.choose(&format!("document.getElementById('{id}')"), &format!("option.index === {number}"));
    };
    let title = "document.querySelector('#candidate h2').textContent";
    page.wait_for(&format!("/^Candidate .* of search 1, the best$/.test({title})"));
    choose(&mut page, "search", 2);
    page.wait_for(&format!("/^Candidate .* of search 3, the best$/.test({title})"));
    page.wait_for("document.getElementById('scale').textContent.endsWith(' m</td>')");
    choose(&mut page, "goal", 1);
    page.wait_for("document.getElementById('scale').textContent.endsWith(' km')");
    // A goal to be maximised has its greatest values at the good end.
    let scale = page.value("document.getElementById('scale').textContent");
    let numbers = page
        .value("[...document.getElementById('scale').childNodes].map(({ textContent }) => parseFloat(textContent))");
    assert!(numbers[0].as_f64() > numbers[2].as_f64(), "{scale}: {numbers}");
    page.wait_for(&format!("{LANES}.startsWith('0:')"));
    let first = lane(&mut page, 0, 0.99);
    page.point_at(first);
    page.wait_for("/^candidate 0\\nseed 15: .* km$/.test(document.getElementById('tip').textContent)");
    assert_eq!(page.complaints, Vec::<String>::new());
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
fn the_page_of_a_robot_leads_to_its_studies_and_back() {
    let (folder, text) = folder("beside", &study());
    append(&folder, &text);
    let _robot = start("studied", 3600);
    let robot = Remote { address: socket("studied").display().to_string() };
    let source = Arc::new(Text::default());
    let seat = Seat { name: "robot".to_owned(), robot: Box::new(robot), source, shadow_of: None };
    let shown = |name: &str| Shown { name: name.to_owned(), folder: folder.clone() };
    let Some(mut page) = Browser::open(&opened_with(vec![seat], vec![shown("Valley"), shown("Other")], false)) else {
        return;
    };
    page.wait_for(RUNNING);
    let choose = |page: &mut Browser, name: &str| {
        page.choose("document.getElementById('robot')", &format!("option.text.startsWith('{name}')"));
    };
    choose(&mut page, "study Other");
    page.wait_for("document.getElementById('run').textContent === 'finished'");
    page.wait_for("document.getElementById('robot').selectedOptions[0].text === 'study Other'");
    choose(&mut page, "Counts");
    page.wait_for(RUNNING);
    assert_eq!(page.complaints, Vec::<String>::new());
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
fn pages_of_other_sites_are_refused_a_study() {
    let folder = socket("foreign-study");
    let url = studio(&folder);
    let address = url.trim_start_matches("http://").split('/').next().expect("an address");
    assert_eq!(answer(address, "/follow", address, &format!("http://{address}")), "HTTP/1.1 101");
    assert_eq!(answer(address, "/follow", address, "http://example.org"), "HTTP/1.1 403");
    assert_eq!(answer(address, "/follow", "example.org", "http://example.org"), "HTTP/1.1 403");
}
