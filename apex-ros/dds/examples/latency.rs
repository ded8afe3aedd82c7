//! Time from a message to the message that a program sends for it over DDS, beside a plain program of RustDDS that
//! decodes and encodes the same messages: `cargo run --release -p apex-ros-dds --example latency`.

#[path = "../../examples/latency/echo.rs"]
mod echo;

use apex_messages::Message as _;
use apex_nodes::scan::Scan;
use apex_ros::{Error, Ros, wire_type};
use apex_ros_dds::Dds;
use apex_rt::{Ports, Switch, UntilStopped, drive_from};
use echo::{Echo, ROUNDS};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, QosPolicies, QosPolicyBuilder, RepresentationIdentifier, TopicKind,
    bytes::Bytes,
    no_key::{
        DataWriter, Decode, DefaultDecoder, DeserializerAdapter, SerializerAdapter, SimpleDataReader as DataReader,
    },
    policy,
};
use std::{
    convert::Infallible,
    net::Ipv4Addr,
    process,
    sync::{Arc, mpsc},
    task::Wake,
    thread::{self, Thread},
    time::{Duration, Instant},
};

/// Adapter for messages as bytes, without their head.
struct Plain;

/// Decoder of [`Plain`].
#[derive(Clone)]
struct Whole;

impl SerializerAdapter<Bytes> for Plain {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(value: &Bytes) -> Result<Bytes, Infallible> {
        Ok(value.clone())
    }
}

impl DeserializerAdapter<Bytes> for Plain {
    type Error = Infallible;
    type Decoded = Bytes;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[RepresentationIdentifier::CDR_LE]
    }

    fn transform_decoded(decoded: Bytes) -> Bytes {
        decoded
    }
}

impl DefaultDecoder<Bytes> for Plain {
    type Decoder = Whole;
    const DECODER: Whole = Whole;
}

impl Decode<'_, Bytes> for Whole {
    type Error = Infallible;

    fn decode_bytes(self, bytes: &[u8], _: RepresentationIdentifier) -> Result<Bytes, Infallible> {
        Ok([&[0, 1, 0, 0], bytes].concat().into())
    }
}

/// Wakes a thread when a message has come.
struct Unpark(Thread);

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

/// Calls `hear` with each message, on a thread of its own.
fn listen(reader: DataReader<Bytes, Plain>, mut hear: impl FnMut(Bytes) + Send + 'static) {
    thread::spawn(move || {
        let waker = Arc::new(Unpark(thread::current())).into();
        loop {
            reader.drain_read_notifications();
            reader.set_waker(Some(Clone::clone(&waker)));
            while let Ok(Some(sample)) = reader.try_take_one() {
                hear(sample.into_value());
            }
            thread::park_timeout(Duration::from_millis(50));
        }
    });
}

/// Participant of a plain program.
struct Program(DomainParticipant);

impl Program {
    fn open(domain: u16) -> Self {
        let builder = DomainParticipantBuilder::new(domain).with_only_networks([Ipv4Addr::LOCALHOST]);
        Self(builder.build().expect("a participant"))
    }

    /// The default of ROS 2.
    fn policies() -> QosPolicies {
        QosPolicyBuilder::new()
            .reliability(policy::Reliability::Reliable { max_blocking_time: rustdds::Duration::from_millis(100) })
            .history(policy::History::KeepLast { depth: 10 })
            .build()
    }

    fn topic(&self, name: &str) -> rustdds::Topic {
        let (name, ty) = (format!("rt/{name}"), wire_type(Scan::NAME));
        self.0.create_topic(name, ty, &Self::policies(), TopicKind::NoKey).expect("a topic")
    }

    fn writer(&self, topic: &str) -> DataWriter<Bytes, Plain> {
        let publisher = self.0.create_publisher(&Self::policies()).expect("a publisher");
        publisher.create_datawriter_no_key(&self.topic(topic), None).expect("a writer")
    }

    fn reader(&self, topic: &str) -> DataReader<Bytes, Plain> {
        let subscriber = self.0.create_subscriber(&Self::policies()).expect("a subscriber");
        subscriber.create_simple_datareader_no_key(&self.topic(topic), None).expect("a reader")
    }

    /// Sends scans back.
    fn echo(&self, ping: &str, pong: &str) {
        let writer = self.writer(pong);
        listen(self.reader(ping), move |bytes| {
            writer.write(Bytes::from(echo::answer(&bytes)).slice(4..), None).expect("it is there");
        });
    }
}

/// Sender of pings and receiver of pongs.
struct Tester {
    pings: DataWriter<Bytes, Plain>,
    pongs: mpsc::Receiver<Instant>,
}

impl Tester {
    fn open(program: &Program, ping: &str, pong: &str) -> Self {
        let (sender, pongs) = mpsc::channel();
        listen(program.reader(pong), move |_| {
            let _ = sender.send(Instant::now());
        });
        Self { pings: program.writer(ping), pongs }
    }

    /// Times of round trips, in µs.
    fn measure(&self) -> Vec<f64> {
        let payload = Bytes::from(echo::ping()).slice(4..);
        echo::measure(|| self.pings.write(payload.clone(), None).expect("it is there"), &self.pongs)
    }
}

fn main() -> Result<(), Error> {
    let domain = 1 + process::id() % 100;
    let [tester, other] = [(); 2].map(|()| Program::open(domain as u16));
    other.echo("ping_plain", "pong_plain");

    static STOP: Switch = Switch::new();
    let settings = Dds::new().networks([Ipv4Addr::LOCALHOST.into()]);
    let ros = Ros::node("echo").args([""; 0]).domain(domain);
    let ros = ros.over(move |domain, distribution| settings.open(domain, distribution)).open()?;
    let mut ports = Ports::<Echo>::new();
    ros.subscribe("/ping").quiet().feed(ports.input(|inputs| &mut inputs.scan))?;
    ros.publish("/pong").quiet().take(ports.event(|events| &mut events.again))?;
    let clock = UntilStopped::new(ros.clock(), &STOP);
    let driver = thread::spawn(move || drive_from(Echo::new(), clock, ports));
    let testers = [Tester::open(&tester, "ping_plain", "pong_plain"), Tester::open(&tester, "ping", "pong")];
    thread::sleep(Duration::from_secs(3));
    let mut times = [vec![], vec![]];
    for _ in 0..ROUNDS {
        for (times, tester) in times.iter_mut().zip(&testers) {
            times.extend(tester.measure());
        }
    }
    let [plain, apex] = times;
    echo::print("plain RustDDS", plain);
    echo::print("Apex", apex);
    STOP.set();
    drop(driver.join());
    Ok(())
}
