//! Time from a message to the message that a program sends for it, beside a plain program of Zenoh that decodes and
//! encodes the same messages: `cargo run --release --example latency`.

mod echo;

use apex_messages::Message as _;
use apex_nodes::scan::Scan;
use apex_ros::{Attachment, Error, Ros, key, wire_type};
use apex_rt::{Ports, Switch, UntilStopped, drive_from};
use echo::{Echo, ROUNDS};
use std::{
    net::TcpListener,
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};
use zenoh::{Config, Session, Wait as _, bytes::ZBytes, sample::Sample};

fn session(mode: &str, listen: &str, connect: &str) -> Session {
    let mut config = Config::default();
    for (setting, value) in [
        ("mode", format!("{mode:?}")),
        ("listen/endpoints", format!("[{listen:?}]")),
        ("connect/endpoints", if connect.is_empty() { "[]".to_owned() } else { format!("[{connect:?}]") }),
        ("scouting/multicast/enabled", "false".to_owned()),
    ] {
        config.insert_json5(setting, &value).expect("a setting");
    }
    zenoh::open(config).wait().expect("a session")
}

/// Key of the scans of a topic.
fn scans(topic: &str) -> String {
    key(0, topic, &wire_type(Scan::NAME), Scan::HASH)
}

/// Echoes by a callback of Zenoh.
fn plain(session: &Session) -> impl Sized + use<> {
    let publisher = session.declare_publisher(scans("/pong_plain")).wait().expect("a publisher");
    let answer = move |sample: Sample| {
        let bytes = echo::answer(&sample.payload().to_bytes());
        let attachment = Attachment { number: 1, time: 1, sender: [1; 16] }.to_bytes();
        publisher.put(bytes).attachment(attachment.to_vec()).wait().expect("it is there");
    };
    session.declare_subscriber(scans("/ping_plain")).callback(answer).wait().expect("a subscriber")
}

/// Times of the round trips, in µs.
fn measure(session: &Session, ping: &str, pong: &str) -> Vec<f64> {
    let (sender, receiver) = mpsc::channel();
    let hear = move |_: Sample| {
        let _ = sender.send(Instant::now());
    };
    let subscriber = session.declare_subscriber(scans(pong)).callback(hear).wait().expect("a subscriber");
    let publisher = session.declare_publisher(scans(ping)).wait().expect("a publisher");
    thread::sleep(Duration::from_millis(300));
    let payload = ZBytes::from(echo::ping());
    let send = || publisher.put(payload.clone()).wait().expect("it is there");
    let times = echo::measure(send, &receiver);
    drop(subscriber);
    times
}

fn main() -> Result<(), Error> {
    let port = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port").port();
    let address = format!("tcp/127.0.0.1:{port}");
    let _router = session("router", &address, "");
    let (tester, other) = (session("peer", "tcp/127.0.0.1:0", &address), session("peer", "tcp/127.0.0.1:0", &address));
    let _plain = plain(&other);

    static STOP: Switch = Switch::new();
    let ros = Ros::node("echo").args([""; 0]).router(&address).open()?;
    let mut ports = Ports::<Echo>::new();
    ros.subscribe("/ping").quiet().feed(ports.input(|inputs| &mut inputs.scan))?;
    ros.publish("/pong").quiet().take(ports.event(|events| &mut events.again))?;
    let clock = UntilStopped::new(ros.clock(), &STOP);
    let driver = thread::spawn(move || drive_from(Echo::new(), clock, ports));
    thread::sleep(Duration::from_secs(1));
    let (mut bare, mut apex) = (vec![], vec![]);
    for _ in 0..ROUNDS {
        bare.extend(measure(&tester, "/ping_plain", "/pong_plain"));
        apex.extend(measure(&tester, "/ping", "/pong"));
    }
    echo::print("plain Zenoh", bare);
    echo::print("Apex", apex);
    STOP.set();
    drop(driver.join());
    Ok(())
}
