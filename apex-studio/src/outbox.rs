//! Commands on their way to a robot. A thread of its own writes them: whoever sends one never waits for the robot.

use apex_rt::studio::message::{self, Command};
use std::{
    io::{self, Write},
    sync::{
        Arc,
        atomic::{
            AtomicBool, AtomicUsize,
            Ordering::{AcqRel, Acquire, Release},
        },
        mpsc::{Sender, channel},
    },
    thread,
};

/// Number of bytes that may wait for a robot. One that takes less is disconnected.
const MAX_BYTES: usize = 4 << 20;

/// Commands that wait for a robot.
pub struct Outbox {
    sender: Sender<Vec<u8>>,
    state: Arc<State>,
    closed: Arc<AtomicBool>,
}

#[derive(Default)]
struct State {
    /// Number of bytes that wait.
    waiting: AtomicUsize,
    /// `true` if the robot has not taken them.
    is_deaf: AtomicBool,
}

impl Outbox {
    /// Starts the thread. It sets `closed` when the robot takes nothing any more, and ends with the outbox.
    pub fn new(mut to: Box<dyn Write + Send>, closed: Arc<AtomicBool>) -> io::Result<Self> {
        let ((sender, commands), state) = (channel::<Vec<u8>>(), Arc::<State>::default());
        let (own, ends) = (Arc::clone(&state), Arc::clone(&closed));
        thread::Builder::new().name("commands".to_owned()).spawn(move || {
            for bytes in commands {
                if let Err(error) = to.write_all(&bytes) {
                    let is_late = matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut);
                    own.is_deaf.fetch_or(is_late, AcqRel);
                    // The end of a connection ends the reader, too, after the last messages.
                    ends.fetch_or(is_late, AcqRel);
                    return;
                }
                own.waiting.fetch_sub(bytes.len(), AcqRel);
            }
        })?;
        Ok(Self { sender, state, closed })
    }

    /// Sends a command. Returns `false` if the robot takes none any more.
    pub fn put(&self, command: &Command) -> bool {
        let mut bytes = vec![];
        message::write(command, &mut bytes);
        let size = bytes.len();
        if self.state.waiting.fetch_add(size, AcqRel) + size > MAX_BYTES {
            self.state.is_deaf.store(true, Release);
            self.close();
            return false;
        }
        self.sender.send(bytes).is_ok()
    }

    /// Ends the connection.
    pub fn close(&self) {
        self.closed.store(true, Release);
    }

    /// `true` if the connection has ended because the robot took no commands.
    pub fn is_deaf(&self) -> bool {
        self.state.is_deaf.load(Acquire)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        sync::mpsc::Receiver,
        time::{Duration, Instant},
    };

    /// A robot that takes bytes only when the test lets it.
    struct Slow(Receiver<()>);

    impl Write for Slow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.recv().map(|()| bytes.len()).map_err(|_| io::ErrorKind::TimedOut.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn whoever_sends_commands_never_waits_for_a_robot_that_does_not_read() {
        let ((reads, robot), closed) = (channel(), Arc::<AtomicBool>::default());
        let outbox = Outbox::new(Box::new(Slow(robot)), Arc::clone(&closed)).unwrap();
        let set = Command::Set { name: "a".to_owned(), value: "x".repeat(900_000) };
        let sent = (0..10).take_while(|_| outbox.put(&set)).count();
        assert_eq!((sent, outbox.is_deaf(), closed.load(Acquire)), (4, true, true));
        drop(reads);
    }

    #[test]
    fn a_robot_that_takes_nothing_for_long_is_disconnected() {
        let ((reads, robot), closed) = (channel(), Arc::<AtomicBool>::default());
        let outbox = Outbox::new(Box::new(Slow(robot)), Arc::clone(&closed)).unwrap();
        assert!(outbox.put(&Command::Pause) && outbox.put(&Command::Step));
        reads.send(()).unwrap();
        drop(reads);
        let start = Instant::now();
        while !closed.load(Acquire) && start.elapsed() < Duration::from_secs(10) {
            thread::sleep(Duration::from_millis(1));
        }
        assert!(outbox.is_deaf() && !outbox.put(&Command::Pause));
    }
}
