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
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, atomic::Ordering},
    time::{Duration, Instant},
};

/// Problems that wait to be published. The oldest makes room.
#[derive(Clone, Default)]
pub struct Log(Arc<(Mutex<State>, Condvar)>);

#[derive(Default)]
struct State {
    waiting: VecDeque<String>,
    is_closed: bool,
}

/// Most problems that wait.
const ROOM: usize = 100;
/// Time between two messages in `/diagnostics`.
const PERIOD: Duration = Duration::from_secs(1);
/// Time for which a problem is shown as the present one.
const RECENT: Duration = Duration::from_secs(10);

impl Log {
    /// Adds a problem. Does not wait. Returns `false` if it will not be published, because the node has ended.
    pub fn add(&self, text: &str) -> bool {
        let mut state = self.state();
        if state.is_closed {
            return false;
        }
        if state.waiting.len() >= ROOM {
            state.waiting.pop_front();
        }
        state.waiting.push_back(text.to_owned());
        drop(state);
        self.0.1.notify_one();
        true
    }

    /// Ends the thread that publishes.
    pub fn close(&self) {
        self.state().is_closed = true;
        self.0.1.notify_all();
    }

    /// Waits for problems until a time. Returns them, or `None` at the end.
    fn take(&self, until: Instant) -> Option<VecDeque<String>> {
        let is_idle = |state: &mut State| state.waiting.is_empty() && !state.is_closed;
        let left = until.saturating_duration_since(Instant::now());
        let waited = self.0.1.wait_timeout_while(self.state(), left, is_idle);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let taken = std::mem::take(&mut state.waiting);
        (!state.is_closed).then_some(taken)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_problem_makes_room() {
        let log = Log::default();
        assert!((0..=ROOM).all(|number| log.add(&number.to_string())));
        let taken = log.take(Instant::now()).expect("problems");
        assert_eq!((taken.len(), taken.front().map(String::as_str)), (ROOM, Some("1")));
        assert_eq!(log.take(Instant::now()).map(|taken| taken.len()), Some(0));
        log.close();
        assert!(log.take(Instant::now() + PERIOD).is_none() && !log.add("late"));
    }
}
