//! Problems of the program and of its topics, in `/rosout` and `/diagnostics`.

use crate::{Error, Kind, Publisher, Qos, Ros, endpoint::Endpoints};
use apex_messages::{
    builtin_interfaces::Time,
    diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue},
    rcl_interfaces,
    std_msgs::Header,
};
use apex_rt::listen_to_problems;
use std::{
    sync::{Arc, atomic::Ordering},
    time::{Duration, Instant},
};

/// Time between two messages in `/diagnostics`.
const PERIOD: Duration = Duration::from_secs(1);
/// Time for which a problem is shown as the present one.
const RECENT: Duration = Duration::from_secs(10);

impl Ros {
    /// Publishes the problems of the programs of this process, and those of the topics of this node, in `/rosout`, and
    /// once in a second the state of the node in `/diagnostics`: problems, and the messages of each topic.
    /// [`Ros::drive`] does so.
    ///
    /// # Errors
    /// The publishers cannot be declared.
    pub fn report(&self, program: &str) -> Result<(), Error> {
        let last = Qos { depth: Some(1000), lifespan: Some(Duration::from_secs(10)), ..Qos::DEFAULT };
        let rosout = self.publish("/rosout").qos(last).transient_local().quiet().open()?;
        let diagnostics = self.publish("/diagnostics").quiet().open()?;
        let log = self.log.clone();
        listen_to_problems({
            let log = log.clone();
            move |text| log.add(text)
        });
        let endpoints = Arc::downgrade(&self.endpoints);
        let mut reporter =
            Reporter { rosout, diagnostics, node: self.name(), program: program.to_owned(), count: 0, last: None };
        self.endpoints.spawn("ros-report", move || {
            let mut next = Instant::now();
            while let Some(problems) = log.take(next) {
                let Some(endpoints) = endpoints.upgrade() else { break };
                problems.into_iter().for_each(|text| reporter.tell(text, endpoints.time.now()));
                if Instant::now() >= next {
                    next += PERIOD;
                    reporter.show(&endpoints);
                }
            }
        })
    }
}

/// Publisher of problems.
struct Reporter {
    rosout: Publisher<rcl_interfaces::Log>,
    diagnostics: Publisher<DiagnosticArray>,
    node: String,
    program: String,
    count: u64,
    /// The last problem.
    last: Option<(String, Instant)>,
}

impl Reporter {
    /// Publishes a problem.
    fn tell(&mut self, text: String, now: i64) {
        let log = rcl_interfaces::Log {
            stamp: Time::from_nanos(now),
            level: rcl_interfaces::Log::WARN,
            name: self.node.trim_start_matches('/').replace('/', "."),
            msg: text.clone(),
            ..Default::default()
        };
        // A node that ends cannot tell.
        drop(self.rosout.send(&log));
        self.count += 1;
        self.last = Some((text, Instant::now()));
    }

    /// Publishes the state.
    fn show(&self, endpoints: &Endpoints) {
        let recent = self.last.as_ref().filter(|(_, at)| at.elapsed() < RECENT);
        let program = DiagnosticStatus {
            level: if recent.is_some() { DiagnosticStatus::WARN } else { DiagnosticStatus::OK },
            name: format!("{}: program", self.node),
            message: recent.map_or_else(|| "no problem".to_owned(), |(text, _)| text.clone()),
            hardware_id: self.program.clone(),
            values: vec![value("problems", &self.count.to_string())],
        };
        let ours = endpoints.watch.all();
        let topics = ours.iter().filter(|ours| ours.endpoint.kind == Kind::Subscription).map(|ours| {
            let (heard, dropped) = (ours.heard.load(Ordering::Relaxed), ours.dropped.load(Ordering::Relaxed));
            value(&ours.endpoint.name, &format!("{heard} messages, {dropped} of them dropped"))
        });
        let topics = DiagnosticStatus {
            level: DiagnosticStatus::OK,
            name: format!("{}: topics", self.node),
            message: "messages since the start".to_owned(),
            hardware_id: self.program.clone(),
            values: topics.collect(),
        };
        let array = DiagnosticArray { header: Header::default(), status: vec![program, topics] };
        drop(self.diagnostics.send(&array));
    }
}

fn value(key: &str, value: &str) -> KeyValue {
    KeyValue { key: key.to_owned(), value: value.to_owned() }
}
