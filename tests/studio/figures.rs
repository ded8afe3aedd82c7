//! Figures of the studio: frames per second and delay at 1,000 nodes, and memory after an hour.

use crate::{
    browser::Browser,
    page::{RUNNING, Restarted, opened, studio_of},
    several::NoText,
    socket,
};
use apex_rt::studio::message::{About, AboutChannel, AboutConnection, AboutNode, PortRole, Report, VERSION, write};
use apex_studio::{Remote, Seat};
use serde_json::Value;
use std::{
    fs,
    io::Write as _,
    os::unix::net::UnixListener,
    path::Path,
    sync::Arc,
    thread,
    time::{Duration, SystemTime, UNIX_EPOCH},
};

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
    let robot = Remote { address: path.display().to_string() };
    let seat = Seat { name: "many".to_owned(), robot, source: Arc::new(NoText) };
    let mut page = Browser::open(&opened(vec![seat], false)).expect("a browser");
    page.size(1280, 760, false);
    page.wait_for(RUNNING);
    page.wait_for("document.querySelector('.item.is-firing')");
    for all_open in [false, true] {
        if all_open {
            page.value(
                "import('./studio.js').then(({ ask }) => ask({ open: [...Array(25).keys()].map((n) => `part${n}`) }))",
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

#[test]
#[ignore = "measures: cargo test --release -p apex-tests --test studio -- --ignored --nocapture figures"]
fn figures_of_an_hour() {
    assert!(Path::new("/proc/self/status").exists(), "memory is read from /proc");
    let (address, _) = studio_of(Restarted::new("hour", None), false);
    let mut page = Browser::open(&address).expect("a browser");
    page.wait_for(RUNNING);
    let before = memory();
    page.value("import('./studio.js').then(({ ask }) => ask({ run: { speed: null } }))");
    let mut now = 0.0;
    while now < 3599.0 {
        thread::sleep(Duration::from_secs(1));
        let text = page.value("parseFloat(document.getElementById('now').textContent)");
        now = text.as_f64().unwrap_or(0.0);
    }
    let heap = page.value("performance.memory.usedJSHeapSize / 1e6").as_f64().unwrap_or(f64::NAN);
    println!(
        "an hour at 100 Hz: the studio has {} MB, {before} MB at the beginning; the page has {heap:.0} MB",
        memory()
    );
}
