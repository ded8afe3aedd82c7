//! The thread that talks to viewers, for the threads of the program.

use super::{server::Server, shared::Shared};
use std::{
    io,
    sync::{Arc, Mutex, PoisonError, atomic::Ordering::Release},
    thread::{self, JoinHandle},
};

/// The thread that talks to viewers. It is stopped while the process copies itself.
pub struct Serving {
    shared: Arc<Shared>,
    thread: Mutex<Option<JoinHandle<Server>>>,
}

impl Serving {
    /// Starts a thread that serves the viewers of a program with the state `shared`.
    pub fn of(shared: Arc<Shared>, server: Server) -> io::Result<Self> {
        let serving = Self { shared, thread: Mutex::new(None) };
        serving.start(server)?;
        Ok(serving)
    }

    /// Starts the thread again.
    pub fn start(&self, server: Server) -> io::Result<()> {
        let thread = thread::Builder::new().name("apex-studio".into()).spawn(move || server.run())?;
        *self.thread.lock().unwrap_or_else(PoisonError::into_inner) = Some(thread);
        Ok(())
    }

    /// Stops the thread and returns its state; `None` if it does not run.
    pub fn stop(&self) -> Option<Server> {
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take()?;
        self.shared.stops.store(true, Release);
        thread.thread().unpark();
        // A panic there concerns only the viewers.
        let server = thread.join().ok();
        self.shared.stops.store(false, Release);
        server
    }
}
