//! Threads that take the messages of readers.

use crate::raw::{Plain, Raw};
use apex_ros::Error;
use rustdds::no_key::{DeserializedCacheChange, SimpleDataReader};
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    task::Wake,
    thread::{self, Thread},
    time::Duration,
};

/// Reader of a topic.
pub type Reader = SimpleDataReader<Raw, Plain>;
/// Message with its writer and number.
pub type Sample = DeserializedCacheChange<Raw>;

/// Time after which a thread looks again, even if it was not woken.
const LOOK: Duration = Duration::from_millis(50);

/// Thread that takes messages until it is dropped.
pub struct Listening {
    is_over: Arc<AtomicBool>,
    thread: Thread,
}

/// Wakes a thread when a message has come.
struct Unpark(Thread);

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

impl Listening {
    /// Passes each message to `hear`, and calls `look` between them, at least every 50 ms.
    pub fn start(
        name: &str,
        reader: Reader,
        mut hear: impl FnMut(Sample) + Send + 'static,
        mut look: impl FnMut() + Send + 'static,
    ) -> Result<Self, Error> {
        let is_over = Arc::new(AtomicBool::new(false));
        let over = Arc::clone(&is_over);
        let take = move || {
            let waker = Arc::new(Unpark(thread::current())).into();
            while !over.load(Ordering::Acquire) {
                reader.drain_read_notifications();
                reader.set_waker(Some(Clone::clone(&waker)));
                // What cannot be read as bytes is not a message of ROS.
                while let Ok(Some(sample)) = reader.try_take_one() {
                    hear(sample);
                }
                look();
                thread::park_timeout(LOOK);
            }
        };
        let thread = thread::Builder::new().name(name.to_owned()).spawn(take);
        let thread = thread.map_err(|error| Error::new(format!("the thread `{name}` cannot be started: {error}")))?;
        Ok(Self { is_over, thread: thread.thread().clone() })
    }
}

impl Drop for Listening {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Release);
        self.thread.unpark();
    }
}
