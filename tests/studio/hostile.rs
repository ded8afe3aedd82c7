//! Robots and browsers that do not behave, as the studio and its pages get along with them.

use crate::{
    page::{opened_at, studio_of},
    steady::Steady,
    stream::Robot,
};
use apex_rt::studio::message::{self, About, AboutNode, AboutParam, Report};
use apex_studio::{Remote, Seat};
use serde_json::{Value, json};
use std::{
    io::{Read as _, Write as _},
    net::{TcpListener, TcpStream},
    sync::Arc,
    thread,
    time::{Duration, Instant},
};
use tungstenite::{Message, WebSocket, client, client::IntoClientRequest as _};

/// Time in which everything has to happen.
const PATIENCE: Duration = Duration::from_secs(30);

/// A page without a browser.
struct Page(WebSocket<Steady>);

impl Page {
    /// Opens a page, as a browser does that has been given another address for it.
    fn open_as(address: &str, host: &str, origin: &str) -> Result<Self, String> {
        let (own, token) = address.strip_prefix("http://").and_then(|rest| rest.split_once("/#")).expect("an address");
        let mut request = format!("ws://{own}/live").into_client_request().expect("an address");
        request.headers_mut().insert("Origin", origin.parse().expect("a header"));
        request.headers_mut().insert("Host", host.parse().expect("a header"));
        let stream = TcpStream::connect(own).map_err(|error| error.to_string())?;
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        let (socket, _) = client(request, Steady(stream)).map_err(|error| error.to_string())?;
        let mut page = Self(socket);
        page.0.send(Message::Text(token.to_owned().into())).expect("it listens");
        Ok(page)
    }

    fn open(address: &str) -> Self {
        let host = address.strip_prefix("http://").and_then(|rest| rest.split_once("/#")).expect("an address").0;
        Self::open_as(address, host, &format!("http://{host}")).expect("a page")
    }

    fn ask(&mut self, asked: &Value) {
        self.0.send(Message::Text(asked.to_string().into())).expect("it listens");
    }

    /// Waits for a message of a kind for which a condition holds. Returns the kinds of those before it, too.
    fn until(&mut self, kind: &str, is: impl Fn(&Value) -> bool) -> Vec<String> {
        let (start, mut kinds) = (Instant::now(), vec![]);
        loop {
            assert!(start.elapsed() < PATIENCE, "no `{kind}`, but {kinds:?}");
            let Message::Text(text) = self.0.read().expect("the page is served") else { continue };
            let told: Value = serde_json::from_str(&text).expect("JSON");
            kinds.extend(told.as_object().expect("an object").keys().cloned());
            if told.get(kind).is_some_and(&is) {
                return kinds;
            }
        }
    }
}

/// A description of a robot with one node and one parameter.
fn about() -> About {
    let node = AboutNode {
        name: "pulse".into(),
        kind: "Pulse".into(),
        docs: String::new(),
        file: 0,
        line: 1,
        column: 1,
        ports: vec![],
    };
    let param = AboutParam { name: "pulse.gain".into(), ty: "f64".into(), unit: None, min: None, max: None };
    About {
        version: message::VERSION,
        name: "Counts".into(),
        docs: String::new(),
        files: vec![],
        simulated: false,
        nodes: vec![node],
        connections: vec![],
        groups: vec![],
        claims: vec![],
        channels: vec![],
        params: vec![param],
    }
}

/// Starts a robot that sends messages and never reads: a description, `first`, and a reaction each 10 ms from then on.
fn talker(first: Vec<Report>) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    thread::spawn(move || {
        for mut socket in listener.incoming().flatten() {
            let mut bytes = vec![];
            message::write(&Report::About(about()), &mut bytes);
            first.iter().for_each(|report| message::write(report, &mut bytes));
            let mut now = 0;
            while socket.write_all(&bytes).is_ok() {
                bytes.clear();
                now += 10_000_000;
                message::write(&Report::Reaction { group: 0, now }, &mut bytes);
                message::write(&Report::Fired(0), &mut bytes);
                thread::sleep(Duration::from_millis(10));
            }
        }
    });
    address
}

#[test]
fn a_robot_that_does_not_read_keeps_no_page_waiting() {
    let (address, _) = studio_of(Remote { address: talker(vec![]) }, false);
    let (mut one, mut other) = (Page::open(&address), Page::open(&address));
    one.until("tick", |tick| tick["now"].as_f64() > Some(0.1));
    let start = Instant::now();
    for _ in 0..12 {
        one.ask(&json!({ "set": { "name": "pulse.gain", "value": format!("\"{}\"", "x".repeat(900_000)) } }));
        other.until("tick", |_| true);
    }
    // It is shown, and so is the robot when it is there again.
    other.until("tick", |tick| tick["run"]["lost"].as_str().is_some_and(|why| why.contains("takes no commands")));
    Page::open(&address).until("about", |_| true);
    assert!(start.elapsed() < PATIENCE);
}

#[test]
fn no_time_of_a_robot_and_a_page_ends_the_page() {
    let times = [i64::MIN, -1, 0, i64::MAX - 1, i64::MAX];
    let first = times.into_iter().flat_map(|now| {
        let failed = Report::Failed { node: 0, error: "x".into() };
        let activity = |active| Report::Activity { node: 0, active };
        [Report::Reaction { group: 0, now }, activity(true), Report::Fired(0), failed, activity(false)]
    });
    let (address, _) = studio_of(Remote { address: talker(first.collect()) }, false);
    let mut page = Page::open(&address);
    page.until("tick", |tick| tick["now"].as_f64() > Some(1e9));
    let extremes = [-1e300, -9.3e9, -1.0, 0.0, 1.0, 9.3e9, 1e300];
    for from in extremes {
        for to in extremes {
            page.ask(&json!({ "lanes": { "from": from, "to": to, "columns": 1000, "also": [0] } }));
            page.ask(&json!({ "test": [from, to] }));
        }
        page.ask(&json!({ "why": { "node": 0, "at": from } }));
        page.until("why", |_| true);
    }
}

#[test]
fn connections_that_say_nothing_lock_nobody_out_and_end() {
    let (address, _) = studio_of(Remote { address: talker(vec![]) }, false);
    let host = address.strip_prefix("http://").and_then(|rest| rest.split_once("/#")).expect("an address").0;
    let mut idle: Vec<TcpStream> = (0..300).map(|_| TcpStream::connect(host).expect("a connection")).collect();
    // One that has begun to ask, and goes on forever.
    let mut slow = TcpStream::connect(host).expect("a connection");
    slow.write_all(b"GET / HTTP/1.1\r\nHost: x\r\n").expect("it listens");
    Page::open(&address).until("about", |_| true);
    let start = Instant::now();
    for stream in idle.iter_mut().chain([&mut slow]) {
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        while stream.read(&mut [0; 1024]).is_ok_and(|count| count > 0) {}
    }
    assert!(start.elapsed() < PATIENCE, "they end after a time, not with this test");
}

#[test]
fn tunnels_and_proxies_lead_to_a_page() {
    let seat = Seat {
        name: "robot".to_owned(),
        robot: Box::new(Remote { address: talker(vec![]) }),
        source: Arc::<crate::page::Text>::default(),
        shadow_of: None,
    };
    let address = opened_at(vec![seat], &["https://robot.example"]);
    // `ssh -L 8888:localhost:PORT`, and a proxy that encrypts.
    for (host, origin) in [("localhost:8888", "http://localhost:8888"), ("robot.example", "https://robot.example")] {
        Page::open_as(&address, host, origin).expect("a page").until("about", |_| true);
    }
    for (host, origin) in [("localhost:8888", "http://localhost:3000"), ("evil.example", "http://evil.example")] {
        assert!(Page::open_as(&address, host, origin).is_err_and(|error| error.contains("403")), "{origin}");
    }
}

#[test]
fn a_page_that_may_only_look_gives_the_robot_nothing_to_do() {
    let _robot = crate::page::start("looks-only", 3600);
    let (address, text) = crate::page::studio("looks-only", true);
    let mut page = Page::open(&address);
    page.until("tick", |tick| tick["now"].as_f64() > Some(0.1));
    page.ask(&json!({ "watch": [0, 1, 2, 3] }));
    page.ask(&json!({ "measure": true }));
    page.ask(&json!({ "edit": { "file": 0, "version": 1, "text": "graph" } }));
    page.ask(&json!({ "keep": { "file": 0, "text": "graph", "over": true } }));
    let told = page.until("tick", |tick| tick["now"].as_f64() > Some(1.5));
    for kind in ["tokens", "times", "written"] {
        assert!(!told.iter().any(|told| told == kind), "{told:?}");
    }
    assert!(text.text.lock().expect("no panic").is_none());
}

#[cfg(unix)]
#[test]
fn a_robot_that_stands_still_is_shown_as_such() {
    let robot = Robot::start("still", &[]);
    let (address, _) = studio_of(Remote { address: robot.address.clone() }, false);
    let mut page = Page::open(&address);
    page.until("tick", |tick| {
        tick["run"] == "running" && tick["silence"].is_null() && tick["now"].as_f64() > Some(1.5)
    });
    robot.signal("-STOP");
    let start = Instant::now();
    page.until("tick", |tick| tick["silence"].as_str().is_some_and(|why| why.contains("no news for")));
    let after = start.elapsed();
    assert!((Duration::from_secs(1)..Duration::from_secs(4)).contains(&after), "{after:?}");
    robot.signal("-CONT");
    page.until("tick", |tick| tick["run"] == "running" && tick["silence"].is_null());
}
