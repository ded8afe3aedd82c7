//! `apex studio` from outside: the robots that it shows, seen by a page without a browser.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
    steady::Steady,
};
use serde_json::{Value, json};
use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead as _, BufReader},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};
use tungstenite::{Message, WebSocket, client, client::IntoClientRequest as _};

const NODES: &str = "use apex_rt::prelude::*;

/// An unpredictable number.
#[node]
pub fn noise() -> u8 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |t| (t.as_nanos() / 100 % 100) as u8)
}

/// Passes numbers from a limit on.
#[node]
pub struct High {
    #[param(default = 50, range = 0..=100)]
    limit: u8,
}

#[node]
impl High {
    fn process(&mut self, value: &u8) -> Option<u8> {
        (*value >= self.limit).then_some(*value)
    }
}

/// Adds up.
#[node]
#[derive(Default)]
pub struct Sum {
    sum: u64,
}

#[node]
impl Sum {
    fn process(&mut self, value: &u8) -> u64 {
        self.sum += u64::from(*value);
        self.sum
    }
}

/// Takes what comes.
#[node]
pub fn end(value: &u64) {
    let _ = value;
}
";

const ROBOT: &str = "graph Robot {
    node noise = noise() every 10ms;
    node high  = High(limit = 50);
    node sum   = Sum();
    noise -> high -> sum -> end();
}
";

/// Makes a package with a robot. Returns the path of its source file.
fn robot(folder: &Folder) -> PathBuf {
    package(folder, NODES);
    folder.file("robot.afg", ROBOT)
}

/// A studio that runs.
pub struct Studio {
    process: Child,
    /// Address of the page.
    pub address: String,
}

impl Studio {
    pub fn open(arguments: &[&str]) -> Self {
        Self::open_in(Path::new("."), arguments)
    }

    /// Opens a studio in a folder.
    pub fn open_in(folder: &Path, arguments: &[&str]) -> Self {
        let mut command = apex();
        command.current_dir(folder);
        command.arg("studio").args(arguments).args(["--listen", "127.0.0.1:0"]).env("CARGO_TARGET_DIR", TARGET);
        let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(process.stderr.take().unwrap()).lines().map_while(Result::ok);
        let mut said = vec![];
        let address = lines.find_map(|line| {
            let address = line.strip_prefix("studio: ").map(str::to_owned);
            said.push(line);
            address
        });
        thread::spawn(move || lines.for_each(drop));
        Self { process, address: address.unwrap_or_else(|| panic!("{said:?}")) }
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        // Its robots have to end, too.
        let _ = Command::new("kill").arg(self.process.id().to_string()).status();
        let _ = self.process.wait();
    }
}

/// Longer than a build of the robot takes.
const PATIENCE: Duration = Duration::from_secs(120);

/// A page without a browser.
pub struct Page(WebSocket<Steady>);

impl Page {
    pub fn open(address: &str) -> Self {
        Self::open_at(address, "live")
    }

    /// Opens a page of a robot (`live`) or of a study (`follow`).
    pub fn open_at(address: &str, place: &str) -> Self {
        let (host, token) = address.strip_prefix("http://").and_then(|rest| rest.split_once("/#")).unwrap();
        let mut request = format!("ws://{host}/{place}").into_client_request().unwrap();
        request.headers_mut().insert("Origin", format!("http://{host}").parse().unwrap());
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = client(request, Steady(stream)).unwrap();
        let mut page = Self(socket);
        page.say(token);
        page
    }

    fn say(&mut self, text: &str) {
        self.0.send(Message::Text(text.to_owned().into())).unwrap();
    }

    pub fn ask(&mut self, asked: &Value) {
        self.say(&asked.to_string());
    }

    /// Waits for a message of a kind for which a condition holds.
    pub fn until(&mut self, kind: &str, is: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        let mut last = BTreeMap::<String, Value>::new();
        loop {
            let Message::Text(text) = self.0.read().unwrap() else { continue };
            let mut told: Value = serde_json::from_str(&text).unwrap();
            match told.get_mut(kind) {
                Some(value) if is(value) => return value.take(),
                _ => last.extend(told.as_object().cloned().unwrap_or_default()),
            }
            assert!(start.elapsed() < PATIENCE, "no such `{kind}`, but {last:#?}");
        }
    }

    pub fn until_time(&mut self, seconds: f64) {
        self.until("tick", |tick| tick["now"].as_f64() > Some(seconds));
    }

    pub fn until_value(&mut self, name: &str, value: &str) {
        self.until("params", |params| params[name]["value"] == value);
    }

    /// Time at which the robot begins to differ from another one.
    pub fn differs(&mut self) -> Option<f64> {
        self.ask(&json!({ "lanes": { "from": 0, "to": 1e4, "columns": 100, "also": [] } }));
        self.until("lanes", |_| true)["differs"].as_f64()
    }
}

#[test]
fn a_shadow_gets_the_inputs_of_the_robot_and_hands_its_parameters_over() {
    let _guard = builds();
    let folder = Folder::new("studio-shadow");
    let file = robot(&folder);
    let studio = Studio::open(&["--shadow", file.to_str().unwrap()]);
    let (mut first, mut second) = (Page::open(&studio.address), Page::open(&studio.address));
    second.ask(&json!({ "robot": 1 }));
    second.until("robots", |robots| robots["shown"] == 1);
    assert_eq!(first.until("about", |_| true)["beside"], "shadow");
    assert_eq!(second.until("about", |_| true)["beside"], "robot");
    // Numbers that no second run would have again.
    second.until_time(1.0);
    assert_eq!(second.differs(), None);
    assert_eq!(first.differs(), None);
    // Its own parameter changes the shadow alone.
    second.ask(&json!({ "set": { "name": "high.limit", "value": "90" } }));
    second.until_value("high.limit", "90");
    while second.differs().is_none() {}
    assert!(first.differs() > Some(0.9));
    first.ask(&json!({ "take": null }));
    second.ask(&json!("take"));
    first.until_value("high.limit", "90");
    // The text changes: the next shadow begins with the parameters of this one, and with the new inputs.
    second.ask(&json!({ "set": { "name": "high.limit", "value": "70" } }));
    second.until_value("high.limit", "70");
    fs::write(&file, ROBOT.replace("10ms", "20ms")).unwrap();
    second.until("about", |_| true);
    second.until_value("high.limit", "70");
    second.until_time(0.5);
}

#[test]
fn a_recording_is_repeated_and_goes_back() {
    let _guard = builds();
    let folder = Folder::new("studio-replay");
    let file = robot(&folder);
    let recording = folder.0.join("run.mcap");
    record(&file, &recording);
    // Slow enough that it is paused before its end, also on a busy machine: what has ended has no checkpoints.
    let studio = Studio::open(&["--replay", recording.to_str().unwrap(), "--speed", "2", file.to_str().unwrap()]);
    let mut page = Page::open(&studio.address);
    let about = page.until("about", |_| true);
    assert_eq!((&about["travels"], &about["about"]["simulated"]), (&json!(true), &json!(true)));
    page.until_time(1.0);
    page.ask(&json!("pause"));
    page.until("tick", |tick| tick["paused"] == true);
    let now = page.until("tick", |_| true)["now"].as_f64().unwrap();
    page.ask(&json!("back"));
    // By a checkpoint: a replay reads its file with a position of its own.
    page.until("back", |_| true);
    page.until("tick", |tick| tick["run"] == "running" && tick["paused"] == true && tick["now"].as_f64() < Some(now));
    page.ask(&json!({ "goto": 0.5 }));
    page.until("tick", |tick| tick["run"] == "running" && tick["paused"] == true && tick["now"].as_f64() < Some(0.51));
    // The same again, but for a parameter.
    page.ask(&json!({ "set": { "name": "high.limit", "value": "99" } }));
    page.until_value("high.limit", "99");
    page.ask(&json!({ "run": { "speed": 20 } }));
    page.until_time(now);
    assert!(page.differs() > Some(0.49));
}

/// Records two seconds of the robot.
fn record(file: &Path, recording: &Path) {
    let mut command = apex();
    command.args(["run", "--record"]).arg(recording).arg(file).env("CARGO_TARGET_DIR", TARGET);
    let mut process = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let is_there = || fs::metadata(recording).is_ok_and(|file| file.len() > 40_000);
    while !is_there() {
        assert!(process.try_wait().unwrap().is_none(), "it ends too early");
        thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("pkill").args(["-INT", "-P", &process.id().to_string()]).status().is_ok());
    process.wait().unwrap();
}

#[test]
fn a_robot_that_runs_already_is_shown_and_told() {
    let _guard = builds();
    let folder = Folder::new("studio-connect");
    let file = robot(&folder);
    let socket = folder.0.join("robot");
    let studio = Studio::open(&["--connect", socket.to_str().unwrap(), file.to_str().unwrap()]);
    let mut page = Page::open(&studio.address);
    page.until("tick", |tick| tick["run"]["starting"].as_str().is_some_and(|what| what.contains("connecting")));
    let mut command = apex();
    command.args(["run", "--stream"]).arg(&socket).arg(&file).env("CARGO_TARGET_DIR", TARGET);
    let mut process = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    assert_eq!(page.until("about", |_| true)["about"]["simulated"], false);
    page.until_time(0.1);
    page.ask(&json!({ "set": { "name": "high.limit", "value": "101" } }));
    page.until("params", |params| {
        params["high.limit"]["error"].as_str().is_some_and(|error| error.contains("0..=100"))
    });
    // What it cannot do is not done.
    page.ask(&json!("back"));
    page.ask(&json!("pause"));
    page.until_time(0.5);
    let _ = process.kill();
    let _ = process.wait();
    page.until("tick", |tick| tick["run"] == "ended" || tick["run"]["lost"].is_string());
}

#[test]
fn studies_of_a_text_are_listed_beside_the_robot() {
    let folder = Folder::new("studio-studies");
    package(&folder, NODES);
    let studies = "tune InStudio: Robot { vary high.limit; wait 1s; minimise total; }\n\
        tune Without: Robot { vary high.limit; wait 1s; maximise total; }\n";
    let robot = ROBOT.replace("graph Robot {", "graph Robot {\n    out total: u64;").replace("end()", "total");
    let file = folder.file("robot.afg", robot + studies);
    let default = Path::new(TARGET).join("apex/tune/InStudio");
    fs::create_dir_all(&default).unwrap();
    fs::write(default.join("journal.csv"), "of another version\n").unwrap();
    let studio = Studio::open(&["--connect", folder.0.join("none").to_str().unwrap(), file.to_str().unwrap()]);
    let robots = Page::open(&studio.address).until("robots", |_| true);
    assert_eq!(robots["studies"], json!(["InStudio"]));
    let mut page = Page::open_at(&studio.address, "follow");
    assert_eq!(page.until("studies", |_| true)["names"], json!(["InStudio"]));
    page.until("errors", |error| error.as_str().is_some_and(|error| error.contains("does not describe a study")));
    fs::remove_dir_all(default).unwrap();
}

#[test]
fn bad_input_is_reported_before_a_page_is_opened() {
    let folder = Folder::new("studio-bad");
    let file = robot(&folder);
    let file = file.to_str().unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    let path = |name: &str| folder.0.join(name).display().to_string();
    folder.file("wrong.mcap", "not a recording");
    folder.file("wrong.afg", "graph Robot { node a = nothing(); }");
    let study = path("study");
    fs::create_dir(&study).unwrap();
    folder.file("study/journal.csv", "");
    let wrong: [(&[&str], &str); 10] = [
        (&[&path(".")], "is a folder without the journal of a study"),
        (&["--simulated", &study], "`--simulated` is for robots"),
        (&[&path("none.afg")], "none.afg"),
        (&[&path("wrong.afg")], "nothing"),
        (&["--replay", &path("none.mcap"), file], "none.mcap"),
        (&["--replay", &path("wrong.mcap"), file], "it is not an MCAP file"),
        (&["--connect", "127.0.0.1:1", "--listen", &taken], "choose another address with `--listen`"),
        (&["--listen", "here", file], "--listen"),
        (&["--speed", "0", file], "--speed"),
        (&["--shadow", "--connect", "127.0.0.1:1"], "--shadow"),
    ];
    for (arguments, said) in wrong {
        let output = apex().arg("studio").args(arguments).env("CARGO_TARGET_DIR", TARGET).output().unwrap();
        assert!(!output.status.success() && stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
    }
}
