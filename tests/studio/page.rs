//! The page of the studio in a real browser: what it shows, by what stands in it.

use crate::{Counts, browser::Browser, checkpoints::Own, drive_of, open, socket};
use apex_diagram::{Item, diagram};
use apex_dsl::{catalog::Catalog, passes, report::Diagnostics, source::Sources};
use apex_host::{Disk, Seen, Workspace};
use apex_rt::{Program, studio::StreamedTime};
use apex_studio::{ParamChange, Remote, Replayed, Robot, Seat, Source, Studio, Study};
use std::{
    fs,
    io::{Read as _, Write as _},
    net::TcpStream,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex,
        atomic::{AtomicU32, Ordering},
        mpsc::channel,
    },
    thread,
};

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

/// The source of the program, with errors if a test wants some.
#[derive(Default)]
pub struct Text {
    errors: Mutex<Option<String>>,
    saved: Mutex<String>,
    /// Its file, if it is not that of `Counts`.
    pub file: Option<&'static str>,
    /// Its text, if it was changed.
    pub text: Mutex<Option<String>>,
}

impl Source for Text {
    fn picture(&self, name: &str) -> Option<Item> {
        let workspace = Workspace::load(Path::new(FOLDER)).ok()?;
        let mut disk = Disk::new(Some(&workspace.cache_folder()));
        let mut catalog = Catalog::load(workspace.crates(&Seen::Package), &mut disk);
        let mut sources = Sources::default();
        let path = Path::new(FOLDER).join(self.file.unwrap_or("studio/counts.afg"));
        let text = fs::read_to_string(&path).ok()?;
        let file = sources.add(path, text);
        let checked = passes::check(file, &mut catalog, &mut sources, &mut disk, &mut Diagnostics::default());
        let graph = checked.programs.iter().map(|program| &program.graph).find(|graph| graph.name == name)?;
        Some(diagram(graph, &checked.texts.machines, &catalog))
    }

    fn errors(&self) -> Option<String> {
        self.errors.lock().unwrap().clone()
    }

    fn save_params(&self, params: &str) -> Result<String, String> {
        params.clone_into(&mut self.saved.lock().unwrap());
        Ok("counts.toml".to_owned())
    }

    fn write_param(&self, change: &ParamChange<'_>) -> Result<String, String> {
        *self.saved.lock().unwrap() = format!("{change:?}");
        Err("not a plain <b>number</b>".to_owned())
    }

    fn replayed(&self) -> Result<Option<Replayed>, String> {
        Ok(None)
    }

    fn write_test(&self, program: &str, test: &str) -> Result<String, String> {
        *self.saved.lock().unwrap() =
            format!("//! A moment in a run of `{program}`.\nuse counts::{program};\n\n{test}");
        Ok("counts_moment.afg".to_owned())
    }

    fn texts(&self, files: &[String]) -> Vec<String> {
        // Paths are those that the compiler was given: from the folder of the workspace.
        let root = Path::new(FOLDER).parent().expect("the folder of the workspace");
        let written = self.text.lock().unwrap().clone();
        let read = |file: &String| fs::read_to_string(root.join(file)).unwrap_or_default();
        files.iter().map(|file| written.clone().unwrap_or_else(|| read(file))).collect()
    }

    fn path(&self, file: &str) -> Option<PathBuf> {
        Path::new(FOLDER).parent().map(|root| root.join(file))
    }

    fn write_text(&self, _file: &str, text: &str) -> Result<(), String> {
        *self.text.lock().unwrap() = Some(text.to_owned());
        Ok(())
    }
}

/// Starts a studio for the socket `name`, and returns the address of its page.
pub fn studio(name: &str, readonly: bool) -> (String, Arc<Text>) {
    studio_of(Remote { address: socket(name).display().to_string() }, readonly)
}

/// Starts a studio for a robot.
pub fn studio_of(robot: impl Robot + 'static, readonly: bool) -> (String, Arc<Text>) {
    let source = Arc::new(Text::default());
    let text: Arc<Text> = Arc::clone(&source);
    let seat = Seat { name: "robot".to_owned(), robot: Box::new(robot), source, shadow_of: None };
    (opened(vec![seat], readonly), text)
}

/// Starts a studio for the socket `name` of the program in `file`, and returns the address of its page.
pub fn studio_for_file(name: &str, file: &'static str) -> String {
    let robot = Box::new(Remote { address: socket(name).display().to_string() });
    let source = Arc::new(Text { file: Some(file), ..Text::default() });
    opened(vec![Seat { name: "robot".to_owned(), robot, source, shadow_of: None }], false)
}

/// Starts a studio for several robots, and returns the address of its page.
pub fn opened(robots: Vec<Seat>, readonly: bool) -> String {
    opened_with(robots, vec![], readonly)
}

/// Starts a studio for robots behind proxies with these origins, and returns the address of its page.
pub fn opened_at(robots: Vec<Seat>, origins: &[&str]) -> String {
    let origins = origins.iter().map(|origin| apex_studio::origin(origin).unwrap()).collect();
    serve(Studio { origins, ..studio_for(robots) })
}

/// Starts a studio for robots and studies, and returns the address of its page.
pub fn opened_with(robots: Vec<Seat>, studies: Vec<Study>, readonly: bool) -> String {
    serve(Studio { studies, readonly, ..studio_for(robots) })
}

fn studio_for(robots: Vec<Seat>) -> Studio {
    let address = "127.0.0.1:0".parse().unwrap();
    Studio { robots, studies: vec![], address, origins: vec![], readonly: false, speed: Some(1.0) }
}

fn serve(studio: Studio) -> String {
    let (opened, address) = channel();
    thread::spawn(move || {
        studio.serve(|addresses| opened.send(addresses.page.clone()).unwrap()).expect("a free port");
    });
    address.recv().expect("it opens")
}

/// Runs the program for `seconds` at the speed that the studio chooses.
pub fn start(name: &'static str, seconds: i64) -> Started {
    start_of(name, Counts::new, seconds)
}

/// Runs a program for `seconds` at the speed that the studio chooses.
pub fn start_of<P: Program + 'static>(name: &'static str, program: fn() -> P, seconds: i64) -> Started {
    let robot = open::<P>(name, StreamedTime::Waiting);
    Started { name, thread: Some(thread::spawn(move || drive_of(&robot, program(), seconds))) }
}

/// A program that runs at least until the end of its test.
pub struct Started {
    name: &'static str,
    thread: Option<thread::JoinHandle<()>>,
}

impl Started {
    /// Waits for the end of the program.
    pub fn join(mut self) {
        self.thread.take().map(thread::JoinHandle::join).expect("it has not been joined").expect("it runs to its end");
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        // The program itself would remove its socket at its end.
        let _ = fs::remove_file(socket(self.name));
    }
}

/// A robot in a process of its own, which can be started again.
pub struct Restarted {
    name: &'static str,
    /// Kind of the robot.
    kind: Option<&'static str>,
    /// Kind of the robot after a change of its source, once there was one.
    changed: Arc<Mutex<Option<&'static str>>>,
    starts: Arc<AtomicU32>,
    process: Option<Own>,
}

impl Restarted {
    pub fn new(name: &'static str, kind: Option<&'static str>) -> Self {
        Self { name, kind, changed: Arc::default(), starts: Arc::default(), process: None }
    }
}

impl Robot for Restarted {
    fn start(&mut self, _again: bool) -> Result<String, String> {
        self.starts.fetch_add(1, Ordering::Relaxed);
        let own = Own::start(self.name, 1, self.kind);
        Ok(self.process.insert(own).path.display().to_string())
    }

    fn runs(&mut self) -> bool {
        true
    }

    fn stop(&mut self) {
        self.process = None;
    }

    fn has_changed(&mut self) -> bool {
        let changed = self.changed.lock().unwrap().take();
        self.kind = changed.or(self.kind);
        changed.is_some()
    }
}

#[test]
fn a_robot_with_another_text_does_the_same_again_and_is_compared() {
    let robot = Restarted::new("changed", None);
    let changed = Arc::clone(&robot.changed);
    let Some(mut page) = Browser::open(&studio_of(robot, false).0) else { return };
    page.wait_for(RUNNING);
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 0.3");
    let row = "document.querySelector('[data-param=\"times.factor\"]')";
    page.fill(&format!("{row}.querySelector('input[type=text]')"), "5");
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 1");
    assert_eq!(page.value("document.getElementById('differs').textContent"), "");
    *changed.lock().unwrap() = Some("slow");
    page.wait_for("document.getElementById('name').textContent === 'SlowCounts'");
    // The parameter is set again, and the robot goes on, as the old one did.
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    page.wait_for(RUNNING);
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 1.5");
    page.wait_for("document.getElementById('differs').textContent === 'differs from the run before since 0.010 s'");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn a_robot_goes_back_to_a_checkpoint_and_to_conditions() {
    let robot = Restarted::new("back", None);
    let starts = Arc::clone(&robot.starts);
    goes_back(robot);
    // At its first start, and at the restart in the end.
    assert_eq!(starts.load(Ordering::Relaxed), 2);
}

#[test]
fn a_robot_with_threads_goes_back_by_a_new_run() {
    let robot = Restarted::new("back-anew", Some("thread"));
    let starts = Arc::clone(&robot.starts);
    goes_back(robot);
    assert_eq!(starts.load(Ordering::Relaxed), 4);
}

fn goes_back(robot: Restarted) {
    let has_thread = robot.kind.is_some();
    let Some(mut page) = Browser::open(&studio_of(robot, false).0) else { return };
    goes_back_on(&mut page, has_thread);
}

fn goes_back_on(page: &mut Browser, has_thread: bool) {
    page.wait_for(RUNNING);
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 0.5");
    page.press(" ");
    let halted = "document.getElementById('run').textContent === 'halted'";
    page.wait_for(halted);
    let now = |page: &mut Browser| {
        // Until the last messages have come.
        page.value("new Promise((done) => setTimeout(done, 200))");
        let text = page.value("document.getElementById('now').textContent");
        text.as_str().and_then(|text| text.strip_suffix(" s")?.parse::<f64>().ok()).expect("a time")
    };
    let row = "document.querySelector('[data-param=\"times.factor\"]')";
    let factor = |of: &str| format!("{row}.querySelector('input[type=text]').value === '{of}'");
    let back = if has_thread { "Back, from the start" } else { "Back" };
    page.wait_for(&format!("document.getElementById('back').textContent === '{back}'"));
    let set_at = now(page);
    page.fill(&format!("{row}.querySelector('input[type=text]')"), "5");
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    page.press("Escape");
    page.press(" ");
    page.wait_for(&format!("parseFloat(document.getElementById('now').textContent) > {}", set_at + 0.5));
    page.press(" ");
    page.wait_for(halted);
    // One reaction back, with the parameter as it was set.
    let last = now(page);
    page.press(",");
    page.wait_for(&format!("document.getElementById('now').textContent === '{:.3} s'", last - 0.01));
    page.wait_for(halted);
    page.wait_for(&factor("5"));
    // Before the parameter was set.
    let place = moment(page, 0.2);
    page.click_at(place);
    page.press("g");
    page.wait_for("Math.abs(parseFloat(document.getElementById('now').textContent) - 0.2) < 0.05");
    page.wait_for(halted);
    page.wait_for(&factor("2"));
    page.wait_for("document.querySelector('[data-item=\"gated.gate\"].is-active')");
    assert_eq!(page.value("document.getElementById('differs').textContent"), "");
    // To a condition, after mistakes in it.
    let condition = |page: &mut Browser, text: &str| {
        page.fill("document.getElementById('break')", text);
    };
    condition(page, "active(cuont)");
    page.wait_for("document.getElementById('tip').textContent.includes('did you mean')");
    condition(page, "active(gated) && !active(count)");
    page.wait_for("!document.getElementById('break').classList.contains('is-wrong')");
    page.click("document.getElementById('restart')");
    page.wait_for("document.getElementById('now').textContent === '0.000 s'");
    page.wait_for(halted);
}

/// The place of a time in s in the timeline.
pub fn moment(page: &mut Browser, time: f64) -> (f64, f64) {
    let place = page.value(&format!(
        "(() => {{ const canvas = document.getElementById('timeline'); const box = canvas.getBoundingClientRect();
            const [from, to] = canvas.dataset.window.split(' ').map(Number);
            return [box.left + 170 + (box.width - 170) * ({time} - from) / (to - from), box.top + 10]; }})()"
    ));
    (place[0].as_f64().expect("a number"), place[1].as_f64().expect("a number"))
}

/// Shows all nodes and connections instead of the activity.
pub fn wiring(page: &mut Browser) {
    page.wait_for("!document.getElementById('views').hidden");
    page.press("a");
    page.wait_for("document.getElementById('picture').dataset.view === 'wiring'");
}

pub const RUNNING: &str = "document.getElementById('run').textContent === 'running'";

#[test]
fn the_picture_is_alive_and_nothing_in_names_is_executed() {
    let _robot = start("alive", 3600);
    let Some(mut page) = Browser::open(&studio("alive", false).0) else { return };
    page.wait_for(RUNNING);
    wiring(&mut page);
    page.wait_for("document.querySelector('[data-item=\"gated.gate\"].is-active')");
    page.wait_for("document.querySelector('[data-item=gated].is-active')");
    page.wait_for("document.querySelector('[data-item=count].is-firing')");
    page.wait_for("document.querySelector('.line.flows')");
    page.wait_for("document.getElementById('active').innerText.includes('gated.gate')");
    // One failure, of the token three.
    page.wait_for("document.querySelector('[data-item=times].has-problem')");
    page.wait_for("document.getElementById('problems').textContent.includes('times: three <b>')");
    // Closed in place, and opened by a jump to what is inside.
    page.double_click("document.querySelector('[data-item=\"gated.gate\"] > .box')");
    page.wait_for("!document.querySelector('[data-item=\"gated.gate\"]')");
    page.wait_for("document.querySelector('[data-item=gated].is-active')");
    page.click("document.querySelector('#active button')");
    page.wait_for("document.querySelector('[data-item=\"gated.gate\"].is-selected')");
    // Computing times on request.
    page.press("h");
    page.wait_for("document.querySelector('[data-item=times].is-hot')");
    page.press("h");
    page.wait_for("!document.querySelector('.is-hot')");
    // The text has its line, and the timeline its lane.
    page.wait_for("document.querySelector('#text .is-selected').textContent.includes('ActivityGate()')");
    page.wait_for("document.getElementById('timeline').dataset.lanes.includes('gated.gate')");
    assert_eq!(page.complaints, Vec::<String>::new());
    assert_eq!(page.value("document.querySelectorAll('img, #picture script').length"), 0);
}

#[test]
fn a_node_says_why_it_fired_and_why_not() {
    let _robot = start("why", 3600);
    let Some(mut page) = Browser::open(&studio("why", false).0) else { return };
    page.wait_for(RUNNING);
    wiring(&mut page);
    let problem = "document.querySelector('#problems button')";
    page.wait_for(&format!("{problem}?.textContent.includes('three')"));
    let gate = "document.querySelector('[data-item=\"gated.gate\"]')";
    let ask = |page: &mut Browser| {
        page.click(gate);
        page.wait_for(&format!("{gate}.classList.contains('is-selected')"));
        page.press("w");
    };
    let answer = |page: &mut Browser| {
        page.wait_for("document.querySelector('#why button')");
        let text =
            page.value("[...document.querySelectorAll('#why button')].map((line) => line.textContent).join('\\n')");
        text.as_str().expect("a text").to_owned()
    };
    // Now: it fires.
    ask(&mut page);
    let why = answer(&mut page);
    for line in [
        "`gated.gate` is active since 0.000 s",
        "`start => gated.gate.activate`",
        "`times.out` was sent",
        "`count` fired",
    ] {
        assert!(why.contains(line), "{line}: {why}");
    }
    page.wait_for("document.querySelector('[data-item=count].is-cause')");
    page.wait_for("document.querySelector('.line.is-lit')");
    // When `times` has failed, it does not.
    page.click(problem);
    ask(&mut page);
    page.wait_for("document.getElementById('why').textContent.includes('did not fire')");
    let why = answer(&mut page);
    assert!(why.contains("`times` fired, but sent ⊥ at `out`"), "{why}");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn a_halted_robot_goes_step_by_step() {
    let _robot = start("halted", 3600);
    let Some(mut page) = Browser::open(&studio("halted", false).0) else { return };
    page.wait_for(RUNNING);
    page.press(" ");
    page.wait_for("document.getElementById('run').textContent === 'halted'");
    let now = "document.getElementById('now').textContent";
    page.value("new Promise((done) => setTimeout(done, 200))");
    let before = page.value(now);
    let seconds = |text: &serde_json::Value| text.as_str().and_then(|t| t.strip_suffix(" s")?.parse::<f64>().ok());
    page.press(".");
    page.wait_for(&format!("{now} !== {before}"));
    let step = seconds(&page.value(now)).unwrap() - seconds(&before).unwrap();
    assert!((step - 0.01).abs() < 1e-6, "{step}");
    page.press(" ");
    page.wait_for(RUNNING);
}

#[test]
fn parameters_are_set_checked_undone_and_saved() {
    let _robot = start("params", 3600);
    let (address, text) = studio("params", false);
    let Some(mut page) = Browser::open(&address) else { return };
    let row = "document.querySelector('[data-param=\"times.factor\"]')";
    page.wait_for(&format!("{row}?.querySelector('input[type=text]').value === '2'"));
    let set = |page: &mut Browser, value: &str| {
        page.fill(&format!("{row}.querySelector('input[type=text]')"), value);
    };
    set(&mut page, "7");
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    set(&mut page, "12");
    page.wait_for(&format!("{row}.querySelector('.error').textContent.includes('0..=9')"));
    page.click("document.getElementById('params-save')");
    page.wait_for("document.getElementById('params-saved').textContent === 'written to counts.toml'");
    assert_eq!(*text.saved.lock().unwrap(), "times.factor = 7\n");
    page.click(&format!("{row}.querySelector('.write')"));
    page.wait_for("document.getElementById('params-saved').textContent === 'not a plain <b>number</b>'");
    let change = text.saved.lock().unwrap().clone();
    for part in ["counts.afg", "node: \"times\"", "param: \"factor\"", "value: \"7\""] {
        assert!(change.contains(part), "{change}");
    }
    page.click(&format!("{row}.querySelector('.undo')"));
    page.wait_for(&format!("!{row}.classList.contains('is-changed')"));
}

#[test]
fn a_marked_moment_becomes_a_test() {
    let _robot = start("moment", 3600);
    let (address, text) = studio("moment", false);
    let Some(mut page) = Browser::open(&address) else { return };
    page.wait_for(RUNNING);
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 0.5");
    let mark = |page: &mut Browser, from: f64, to: f64| {
        let (from, to) = (moment(page, from), moment(page, to));
        page.drag(from, to, true);
        page.click("document.getElementById('moment-test')");
    };
    mark(&mut page, 28.0, 29.0);
    page.wait_for("document.getElementById('moment').textContent === 'mark an interval in the past'");
    // Out of order, as when one drags to the left.
    mark(&mut page, 0.3, 0.1);
    page.wait_for("document.getElementById('moment').textContent === 'written to counts_moment.afg'");
    // This text is a test of this crate, too: it passes.
    assert_eq!(*text.saved.lock().unwrap(), include_str!("counts_moment.afg"));
    let row = "document.querySelector('[data-param=\"times.factor\"]')";
    page.fill(&format!("{row}.querySelector('input[type=text]')"), "7");
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    page.value("new Promise((done) => setTimeout(done, 300))");
    mark(&mut page, 0.1, 29.0);
    page.wait_for("document.getElementById('moment').textContent.includes('write it into the source')");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn tokens_are_shown_of_pinned_ports_only() {
    let _robot = start("tokens", 3600);
    let Some(mut page) = Browser::open(&studio("tokens", false).0) else { return };
    page.click("document.querySelector('[data-tab=values]')");
    let row = "document.querySelector('[data-channel=\"count.out\"]')";
    page.wait_for(row);
    page.click(&format!("{row}.querySelector('input')"));
    page.wait_for(&format!("Number({row}.querySelector('pre')?.textContent) > 10"));
    page.wait_for(&format!("{row}.querySelector('canvas')"));
    assert!(page.value("document.querySelectorAll('#values pre').length") == 1);
    // What has a place is drawn in the plane.
    assert_eq!(page.value("document.getElementById('world').hidden"), true);
    let pose = "document.querySelector('[data-channel^=\"pose_on_circle\"]')";
    page.click(&format!("{pose}.querySelector('input')"));
    page.wait_for("document.getElementById('world').dataset.drawn === '1'");
    page.wait_for(
        "[...document.getElementById('world').getContext('2d').getImageData(0, 0, 400, 200).data].some((byte) => byte > 0)",
    );
    // A view that a node brings, whose script does not run.
    let view = "document.querySelector('[data-channel^=\"drawn_count\"]')";
    page.click(&format!("{view}.querySelector('input')"));
    page.wait_for(&format!("{view}.querySelector('img')?.naturalWidth > 0"));
    page.wait_for(&format!("{view}.querySelector('pre').hidden"));
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn a_robot_may_end_and_come_back_and_several_pages_see_it() {
    let (address, text) = studio("returns", true);
    let robot = start("returns", 1);
    let Some(mut first) = Browser::open(&address) else { return };
    let Some(mut second) = Browser::open(&address) else { return };
    first.wait_for("document.getElementById('run').textContent === 'ended'");
    second.wait_for("document.getElementById('run').textContent === 'ended'");
    robot.join();
    let again = start("returns", 3600);
    first.wait_for(RUNNING);
    second.wait_for(RUNNING);
    // The first run can still be looked at.
    let look = |page: &mut Browser, run: u32| {
        page.wait_for(&format!("[...document.getElementById('earlier').options].some((run) => run.value === '{run}')"));
        page.choose("document.getElementById('earlier')", &format!("option.value === '{run}'"));
    };
    look(&mut first, 1);
    first.wait_for("document.getElementById('run').textContent === 'ended'");
    first.wait_for("document.getElementById('now').textContent === '0.990 s'");
    first.wait_for("document.getElementById('problems').textContent.includes('times: three')");
    first.wait_for("document.getElementById('timeline').dataset.lanes.includes('gated.gate')");
    assert_eq!(second.value(RUNNING), true);
    look(&mut first, 2);
    first.wait_for(RUNNING);
    drop(again);
    *text.errors.lock().unwrap() = Some("error: <b>wrong</b>".to_owned());
    first.wait_for("document.getElementById('errors').textContent === 'error: <b>wrong</b>'");
    // Who may only look has no buttons, and is not obeyed.
    assert_eq!(first.value("document.getElementById('restart').hidden"), true);
    first.value("location.hash = 'wrong'");
    first.wait_for("document.getElementById('run').textContent.includes('wrong token')");
}

/// Answer of the server to a request for one of its sockets.
pub fn answer(address: &str, path: &str, host: &str, origin: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("the studio listens");
    write!(
        stream,
        "GET {path} HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    .expect("it reads");
    let mut start = [0; 12];
    stream.read_exact(&mut start).expect("it answers");
    String::from_utf8_lossy(&start).into_owned()
}

#[test]
fn pages_of_other_sites_are_refused() {
    let url = studio("foreign", false).0;
    let address = url.trim_start_matches("http://").split('/').next().expect("an address").to_owned();
    let own = format!("http://{address}");
    assert_eq!(answer(&address, "/live", &address, &own), "HTTP/1.1 101");
    assert_eq!(answer(&address, "/live", &address, "http://example.org"), "HTTP/1.1 403");
    assert_eq!(answer(&address, "/live", "example.org", "http://example.org"), "HTTP/1.1 403");
    assert_eq!(answer(&address, "/live", &address, "null"), "HTTP/1.1 403");
}

#[test]
fn what_is_not_a_robot_is_reported() {
    use std::os::unix::net::UnixListener;
    let path = socket("hostile");
    let listener = UnixListener::bind(&path).expect("a new socket");
    let Some(mut page) = Browser::open(&studio("hostile", false).0) else { return };
    // Too long, of another version, cut off.
    let wrong: [&[u8]; 3] = [&[0xff; 64], &[2, 0, 0, 0, 77, 77], &[200, 0, 0, 0, 1]];
    let said = ["is too long", "cannot be read", "broken off"];
    for (bytes, said) in wrong.into_iter().zip(said) {
        let (mut stream, _) = listener.accept().expect("the studio connects");
        stream.write_all(bytes).expect("the studio reads");
        drop(stream);
        page.wait_for(&format!("document.getElementById('run').textContent.includes('{said}')"));
    }
    fs::remove_file(path).expect("it is still there");
}
