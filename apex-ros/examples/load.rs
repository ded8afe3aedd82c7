//! Images of 1 MB at 30 Hz and scans at 40 Hz from one node through a router into a program: how many are lost, how
//! late they are, and how often an image is copied. `cargo run --release --example load -- 600` does so for 10 minutes,
//! `-- 600 all` with a publisher that waits instead of dropping messages.

use apex_macros::graph;
use apex_messages::{
    Message,
    sensor_msgs::{Image, LaserScan},
};
use apex_ros::{Error, Kind, Publisher, Qos, Ros};
use apex_rt::{PortReceiver, Ports, Switch, UntilStopped, drive_from, prelude::*};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    collections::BTreeSet,
    env,
    net::TcpListener,
    sync::{
        Arc, Mutex,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::{Duration, Instant},
};
use zenoh::{Config, Session, Wait as _};

/// Sends the numbers of images.
#[node]
#[derive(Default)]
#[allow(non_camel_case_types, reason = "as a function")]
pub struct number_of_image;

#[node]
impl number_of_image {
    /// Sends the number of an image.
    #[slot]
    fn put(&mut self, image: &Image, seen: Event<f64>) {
        seen.emit(image.step.into());
    }
}

/// Sends the numbers of scans.
#[node]
#[derive(Default)]
#[allow(non_camel_case_types, reason = "as a function")]
pub struct number_of_scan;

#[node]
impl number_of_scan {
    /// Sends the number of a scan.
    #[slot]
    fn put(&mut self, scan: &LaserScan, seen: Event<f64>) {
        seen.emit(scan.scan_time.into());
    }
}

graph!("load.afg");

/// Bytes of an image, and beams of a scan.
const BYTES: usize = 1_000_000;
const BEAMS: usize = 720;
/// Bytes from which on a reserved piece of memory is one for an image.
const LARGE: usize = 900_000;

/// Pieces of memory for images: those that the thread of the publisher reserved, and others.
static PIECES: [AtomicU64; 2] = [const { AtomicU64::new(0) }; 2];

thread_local! {
    static PUBLISHES: Cell<bool> = const { Cell::new(false) };
}

/// Counts large pieces of memory: an image is copied into each of them.
struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

fn count(size: usize) {
    if size >= LARGE {
        let publishes = PUBLISHES.try_with(Cell::get).unwrap_or(false);
        PIECES[usize::from(!publishes)].fetch_add(1, Ordering::Relaxed);
    }
}

// SAFETY: all is left to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: what holds for the caller holds here.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// A publisher that waits, and subscriptions that keep as much: those by default drop messages on a machine that has
/// too much to do.
const ALL: Qos = Qos { depth: None, ..Qos::DEFAULT };

/// Fate of the messages of a topic.
#[derive(Debug)]
struct Outcome {
    sent: u32,
    /// Number of messages that the subscription dropped, because the program was busy.
    dropped: u64,
    /// Numbers of those that did not arrive.
    lost: Vec<u32>,
    /// `true` if none came twice or before an earlier one.
    is_in_order: bool,
    /// Latest of all messages.
    latest: Duration,
}

/// Times at which messages were sent, by their number.
type Sent = Arc<Mutex<Vec<Instant>>>;

/// Sends a message at each period, with its number, and takes note of the time.
fn send<M: Message>(
    publisher: &Publisher<M>,
    period: Duration,
    lasts: Duration,
    sent: &Sent,
    mut message: M,
    set: fn(&mut M, u32),
) {
    let start = Instant::now();
    for (number, at) in (0..).map(|number| (number, period * number)).take_while(|(_, at)| *at < lasts) {
        thread::sleep((start + at).saturating_duration_since(Instant::now()));
        set(&mut message, number);
        sent.lock().expect("no panic").push(Instant::now());
        publisher.send(&message).expect("the node is there");
    }
}

/// Follows the numbers that come, until the program ends.
fn follow(numbers: &PortReceiver<f64>, sent: &Sent) -> Outcome {
    let (mut arrived, mut latest) = (vec![], Duration::ZERO);
    while let Some(number) = numbers.receive() {
        let at = sent.lock().expect("no panic").get(number as usize).copied();
        latest = latest.max(at.map_or(Duration::MAX, |at| at.elapsed()));
        arrived.push(number as u32);
    }
    let sent = sent.lock().expect("no panic").len() as u32;
    let is_in_order = arrived.windows(2).all(|pair| pair[0] < pair[1]);
    let came: BTreeSet<u32> = arrived.into_iter().collect();
    let lost = (0..sent).filter(|number| !came.contains(number)).collect();
    Outcome { sent, dropped: 0, lost, is_in_order, latest }
}

fn router(address: &str) -> Session {
    let mut config = Config::default();
    for (setting, value) in [
        ("mode", "\"router\"".to_owned()),
        ("listen/endpoints", format!("[{address:?}]")),
        ("scouting/multicast/enabled", "false".to_owned()),
    ] {
        config.insert_json5(setting, &value).expect("a setting");
    }
    zenoh::open(config).wait().expect("a router")
}

/// Publishes both topics for a while.
fn publish(camera: &Ros, lasts: Duration, qos: Qos, sent: &[Sent; 2]) -> Result<(), Error> {
    let (images, scans) =
        (camera.publish("image").qos(qos).open::<Image>()?, camera.publish("scan").qos(qos).open::<LaserScan>()?);
    // The routes are there a moment after both ends know each other.
    let hears = |topic, ty| camera.sees(Kind::Subscription, topic, ty);
    while !(hears("image", Image::NAME) && hears("scan", LaserScan::NAME)) {
        thread::sleep(Duration::from_millis(10));
    }
    thread::sleep(Duration::from_secs(1));
    thread::scope(|scope| {
        scope.spawn(|| {
            PUBLISHES.set(true);
            let image = Image { height: 1000, width: 1000, data: vec![7; BYTES], ..Image::default() };
            send(&images, Duration::from_secs(1) / 30, lasts, &sent[0], image, |image, number| image.step = number);
        });
        scope.spawn(|| {
            let scan = LaserScan { ranges: vec![1.0; BEAMS], ..LaserScan::default() };
            let set = |scan: &mut LaserScan, number| scan.scan_time = number as f32;
            send(&scans, Duration::from_millis(25), lasts, &sent[1], scan, set);
        });
    });
    // The last ones arrive.
    thread::sleep(Duration::from_secs(2));
    Ok(())
}

/// Sends for a while. Returns what became of images and scans, and the numbers of copies of an image: those of the
/// publisher, and the others.
fn run(lasts: Duration, qos: Qos) -> Result<([Outcome; 2], [f64; 2]), Error> {
    let port = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port").port();
    let address = format!("tcp/127.0.0.1:{port}");
    let _router = router(&address);
    let open = |name| Ros::node(name).args([""; 0]).router(&address).open();
    let (camera, robot) = (open("camera")?, open("robot")?);
    let mut ports = Ports::<Numbers>::new();
    let subscriptions = [
        robot.subscribe("image").qos(qos).feed(ports.input(|inputs| &mut inputs.image))?,
        robot.subscribe("scan").qos(qos).feed(ports.input(|inputs| &mut inputs.scan))?,
    ];
    let seen = [ports.event(|events| &mut events.seen_image), ports.event(|events| &mut events.seen_scan)];
    let sent = [Sent::default(), Sent::default()];
    let mut sent_of = sent.clone().into_iter();
    let followers = seen.map(|seen| {
        let sent = sent_of.next().unwrap_or_default();
        thread::spawn(move || follow(&seen, &sent))
    });
    let stop: &'static Switch = Box::leak(Box::default());
    let clock = UntilStopped::new(robot.clock(), stop);
    let driver = thread::spawn(move || drive_from(Numbers::new(), clock, ports));
    let before = PIECES.each_ref().map(|pieces| pieces.load(Ordering::Relaxed));
    publish(&camera, lasts, qos, &sent)?;
    stop.set();
    drop(driver.join());
    let mut outcomes = followers.map(|follower| follower.join().expect("no panic"));
    for (outcome, subscription) in outcomes.iter_mut().zip(&subscriptions) {
        outcome.dropped = subscription.dropped();
    }
    let pieces = |i: usize| (PIECES[i].load(Ordering::Relaxed) - before[i]) as f64;
    let copies = [0, 1].map(|i| pieces(i) / f64::from(outcomes[0].sent));
    Ok((outcomes, copies))
}

fn main() -> Result<(), Error> {
    let seconds = env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(10);
    let qos = if env::args().any(|argument| argument == "all") { ALL } else { Qos::DEFAULT };
    let (outcomes, [there, here]) = run(Duration::from_secs(seconds), qos)?;
    for (name, Outcome { sent, dropped, lost, is_in_order, latest }) in ["images", "scans"].into_iter().zip(outcomes) {
        let (order, latest) = (if is_in_order { "in order" } else { "NOT in order" }, latest.as_secs_f64() * 1e3);
        let lost = lost.len();
        println!(
            "{name}: {sent} sent, {lost} lost ({dropped} by the subscription), {order}; the latest after {latest:.1} ms"
        );
    }
    println!("copies of an image: {there:.2} by the publisher, {here:.2} on the way and by the program");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_lost_and_copies_are_few() {
        let (outcomes, [there, here]) = run(Duration::from_secs(3), ALL).expect("it runs");
        for Outcome { lost, is_in_order, .. } in &outcomes {
            assert!(lost.is_empty() && *is_in_order, "{outcomes:?}");
        }
        assert!(outcomes[0].sent >= 90 && outcomes[1].sent >= 120, "{outcomes:?}");
        // A copy more at any place is one too many.
        assert!(there <= 1.2 && here <= 3.2, "{there} {here}");
    }
}
