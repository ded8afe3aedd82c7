//! Figures of the studio: frames per second and delay at 1,000 nodes, and memory after an hour.

use crate::{
    browser::Browser,
    page::{RUNNING, opened, wiring},
    several::NoText,
    socket,
    steady::Steady,
};
use apex_rt::studio::message::{About, AboutChannel, AboutConnection, AboutNode, PortRole, Report, VERSION, write};
use apex_studio::{Remote, Seat};
use serde_json::{Value, json};
use std::{
    fs,
    io::Write as _,
    net::TcpStream,
    os::unix::net::UnixListener,
    sync::Arc,
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};
use tungstenite::{Message, WebSocket, client, client::IntoClientRequest as _};

const NODES: u32 = 1000;
/// Number of nodes in each nested graph.
const NESTED: u32 = 40;

/// A robot with many nodes: chains in nested graphs.
fn many() -> About {
    let node = |at: u32| AboutNode {
        name: format!("part{}.node{at}", at / NESTED),
        kind: "Step".to_owned(),
        docs: String::new(),
        file: 0,
        line: at + 1,
        column: 1,
        ports: vec![("in".into(), PortRole::Input, "f32".into()), ("out".into(), PortRole::Output, "f32".into())],
    };
    let connection = |at: u32| AboutConnection {
        from: at,
        output: "out".to_owned(),
        to: at + 1,
        input: "in".to_owned(),
        activity: at.is_multiple_of(3),
    };
    About {
        version: VERSION,
        name: "Many".to_owned(),
        docs: String::new(),
        files: vec![],
        simulated: false,
        nodes: (0..NODES).map(node).collect(),
        connections: (0..NODES - 1).map(connection).collect(),
        groups: vec!["main".to_owned()],
        claims: vec![],
        channels: (0..NODES)
            .map(|at| AboutChannel { name: format!("part{}.node{at}.out", at / NESTED), node: at, schema: None })
            .collect(),
        params: vec![],
    }
}

/// Plays that robot for a viewer: all nodes fire 100 times a second but the first, which fires at odd times. The time
/// of the robot is that of the machine.
fn play(listener: &UnixListener) {
    let (mut viewer, _) = listener.accept().expect("the studio connects");
    let mut bytes = vec![];
    write(&Report::About(many()), &mut bytes);
    write(&Report::Active((0..NODES).step_by(7).collect()), &mut bytes);
    for step in 0_u64.. {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970").as_nanos();
        write(&Report::Reaction { group: 0, now: now as i64 }, &mut bytes);
        // 13 and 20 reactions apart in turns: at all phases of the interval at which pages get news.
        if matches!(step % 33, 0 | 13) {
            write(&Report::Fired(0), &mut bytes);
        }
        (1..NODES).for_each(|node| write(&Report::Fired(node), &mut bytes));
        if viewer.write_all(&bytes).is_err() {
            return;
        }
        bytes.clear();
        thread::sleep(Duration::from_micros(10_137));
    }
}

/// Measurement of the page: times of frames in ms, and ages in ms of the first node's firings when a frame shows them.
const MEASURE: &str = "import('./studio.js').then(({ robot }) => new Promise((done) => {
    const [frames, ages, start] = [[], [], performance.now()];
    let fired = robot.nodes[0].fired;
    const frame = () => {
        const now = performance.now();
        frames.push(now);
        if (robot.nodes[0].fired !== fired) {
            fired = robot.nodes[0].fired;
            ages.push(performance.timeOrigin + now - robot.nodes[0].last * 1000);
        }
        if (now - start < 20000) requestAnimationFrame(frame);
        else done({ frames, ages });
    };
    requestAnimationFrame(frame);
}))";

fn numbers(value: &Value) -> Vec<f64> {
    let mut numbers: Vec<f64> = value.as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    numbers.sort_by(f64::total_cmp);
    numbers
}

/// Resident memory of this process in MB.
fn memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) / 1000
}

#[test]
#[ignore = "measures: cargo test --release -p apex-tests --test studio -- --ignored --nocapture figures"]
fn figures_of_a_thousand_nodes() {
    let path = socket("many");
    let listener = UnixListener::bind(&path).expect("a new socket");
    thread::spawn(move || play(&listener));
    let robot = Box::new(Remote { address: path.display().to_string() });
    let seat = Seat { name: "many".to_owned(), robot, source: Arc::new(NoText), shadow_of: None };
    let mut page = Browser::open(&opened(vec![seat], false)).expect("a browser");
    page.size(1280, 760, false);
    page.wait_for(RUNNING);
    wiring(&mut page);
    page.wait_for("document.querySelector('.item.is-firing')");
    for all_open in [false, true] {
        if all_open {
            page.value(
                "import('./page.js').then(({ ask }) => ask({ open: { view: 'wiring', open: [...Array(25).keys()].map((n) => `part${n}`) } }))",
            );
            page.wait_for("document.querySelectorAll('#picture [data-item]').length > 1000");
        }
        let measured = page.value(MEASURE);
        let (frames, ages) = (numbers(&measured["frames"]), numbers(&measured["ages"]));
        let rate = (frames.len() - 1) as f64 / (frames[frames.len() - 1] - frames[0]) * 1000.0;
        let boxes = page.value("document.querySelectorAll('#picture [data-item]').length");
        let at = |share: f64| ages[((ages.len() - 1) as f64 * share) as usize];
        println!(
            "{NODES} nodes at 100 Hz, {boxes} boxes: {rate:.0} frames per second; delay p50 {:.0} ms, p99 {:.0} ms ({} firings)",
            at(0.5),
            at(0.99),
            ages.len()
        );
    }
    fs::remove_file(path).expect("it is still there");
}

/// Number of reactions in an hour at 1 kHz, and of the nodes that fire in each.
const HOUR: u64 = 3_600_000;
const BUSY: u32 = 20;

/// Plays an hour of a robot at 1 kHz for a viewer, as fast as it can: 20 nodes fire in each reaction, tokens are sent
/// over 20 channels, and one node becomes active and inactive all the time.
fn play_an_hour(listener: &UnixListener) {
    let (mut viewer, _) = listener.accept().expect("the studio connects");
    let mut bytes = vec![];
    write(&Report::About(many()), &mut bytes);
    for step in 0..HOUR {
        write(&Report::Reaction { group: 0, now: step as i64 * 1_000_000 }, &mut bytes);
        for node in 0..BUSY {
            write(&Report::Fired(node), &mut bytes);
            write(&Report::Sent(node), &mut bytes);
        }
        if step.is_multiple_of(10) {
            write(&Report::Activity { node: 3, active: step.is_multiple_of(20) }, &mut bytes);
        }
        if bytes.len() > 1 << 16 {
            viewer.write_all(&bytes).expect("the studio reads");
            bytes.clear();
        }
    }
    viewer.write_all(&bytes).expect("the studio reads");
    thread::sleep(Duration::from_secs(60));
}

/// A page without a browser.
struct Socket(WebSocket<Steady>);

impl Socket {
    fn open(url: &str) -> Self {
        let (host, token) =
            url.strip_prefix("http://").and_then(|rest| rest.split_once("/#")).expect("an address with a token");
        let mut request = format!("ws://{host}/live").into_client_request().expect("an address");
        request.headers_mut().insert("Origin", format!("http://{host}").parse().expect("a header"));
        let (mut socket, _) =
            client(request, Steady(TcpStream::connect(host).expect("the studio listens"))).expect("it answers");
        socket.send(Message::Text(token.to_owned().into())).expect("it reads");
        Self(socket)
    }

    /// Waits for a message with this field.
    fn hear(&mut self, kind: &str) -> Value {
        loop {
            let Message::Text(text) = self.0.read().expect("the studio answers") else { continue };
            let mut told: Value = serde_json::from_str(&text).expect("JSON");
            if !told[kind].is_null() {
                return told[kind].take();
            }
        }
    }

    /// The lanes between two times in s, and the duration of the answer.
    fn lanes(&mut self, from: f64, to: f64) -> (Value, Duration) {
        let (start, also) = (Instant::now(), [0_u32]);
        let asked = json!({ "lanes": { "from": from, "to": to, "columns": 1000, "also": also } });
        self.0.send(Message::Text(asked.to_string().into())).expect("it reads");
        (self.hear("lanes"), start.elapsed())
    }
}

#[test]
#[ignore = "measures: cargo test --release -p apex-tests --test studio -- --ignored --nocapture figures"]
fn figures_of_an_hour_at_1_khz() {
    let path = socket("hour");
    let listener = UnixListener::bind(&path).expect("a new socket");
    let (before, start) = (memory(), Instant::now());
    thread::spawn(move || play_an_hour(&listener));
    let robot = Box::new(Remote { address: path.display().to_string() });
    let seat = Seat { name: "hour".to_owned(), robot, source: Arc::new(NoText), shadow_of: None };
    let mut page = Socket::open(&opened(vec![seat], false));
    let (mut now, mut told) = (0.0, 0.0);
    while now < 3599.999 {
        now = page.hear("tick")["now"].as_f64().expect("a time");
        if now >= told {
            println!("{:.0} minutes: {} MB, {before} MB at the beginning", now / 60.0, memory());
            told += 600.0;
        }
    }
    println!("an hour at 1 kHz: {} MB; the studio has read it in {:.0?}", memory(), start.elapsed());
    for (from, to) in [(0.0, 3600.0), (1800.0, 1860.0), (1800.0, 1801.0), (1800.0, 1800.05)] {
        let (lanes, duration) = page.lanes(from, to);
        let first = &lanes["lanes"][0];
        let all = first["ticks"].as_array().into_iter().flatten();
        let count: u64 = all.filter_map(|tick| tick[1].as_u64()).sum();
        println!("lanes of {} s: {duration:.1?}, {count} firings of a node", to - from);
        assert_eq!(first["node"], 0);
        // Long windows are drawn from sums, and the first and the last of them may reach beyond the window.
        let (expected, slack) = (((to - from) * 1000.0) as u64, if to - from > 10.0 { 1024 } else { 2 });
        assert!(count.abs_diff(expected) <= slack, "{count} instead of {expected}");
    }
    fs::remove_file(path).expect("it is still there");
}
