//! Ways into a program while it is driven, and out of it, for other threads.

use crate::{
    Clock, Mailbox, Program, Time,
    run::Outside,
    switch::{Bell, Listens},
};
use std::sync::{
    Arc, Condvar, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicUsize, Ordering},
};

/// The ports of a program that other threads use while [`drive_from`](crate::drive_from) drives it. What they put in
/// wakes the program, which waits for it as long as one of the [`PortSender`]s is there.
///
/// Between such an end and the mailbox of the program there is room for one token, as everywhere.
pub struct Ports<P: Program>(pub(crate) Ways<P::Inputs, P::Events>);

impl<P: Program> Ports<P> {
    /// None yet.
    pub fn new() -> Self {
        Self(Ways { inputs: vec![], events: vec![], outside: Arc::default(), kept: false })
    }

    /// The end of a graph-level input or slot: `ports.input(|inputs| &mut inputs.stop)`.
    pub fn input<T: Send + 'static>(&mut self, port: fn(&mut P::Inputs) -> &mut Mailbox<T>) -> PortSender<T>
    where
        P::Inputs: 'static,
    {
        let cell = Arc::new(Cell::default());
        self.0.inputs.push(Box::new(WayIn { cell: Arc::clone(&cell), port }));
        self.0.outside.senders.fetch_add(1, Ordering::AcqRel);
        PortSender { cell, outside: Arc::clone(&self.0.outside) }
    }

    /// The end of an event of the program: `ports.event(|events| &mut events.done)`.
    pub fn event<T: Send + 'static>(&mut self, port: fn(&mut P::Events) -> &mut Mailbox<T>) -> PortReceiver<T>
    where
        P::Events: 'static,
    {
        let cell = Arc::new(Cell::default());
        self.0.events.push(Box::new(WayOut { cell: Arc::clone(&cell), port }));
        PortReceiver { cell, outside: Arc::clone(&self.0.outside) }
    }
}

impl<P: Program> Default for Ports<P> {
    fn default() -> Self {
        Self::new()
    }
}

/// The end of a graph-level input or slot that another thread has.
pub struct PortSender<T> {
    cell: Arc<Cell<T>>,
    outside: Arc<Others>,
}

impl<T> PortSender<T> {
    /// Puts a token in, and wakes the program.
    ///
    /// # Errors
    /// Gives the token back while the one before has not been taken, and when the program has ended.
    pub fn put(&self, token: T) -> Result<(), T> {
        self.put_into(self.cell.state(), token)
    }

    /// Waits until there is room for a token, and puts it in.
    ///
    /// # Errors
    /// Gives the token back when the program has ended.
    pub fn send(&self, token: T) -> Result<(), T> {
        let is_full = |state: &mut State<T>| state.token.is_some() && !state.ended;
        let state = self.cell.changed.wait_while(self.cell.state(), is_full).unwrap_or_else(PoisonError::into_inner);
        self.put_into(state, token)
    }

    fn put_into(&self, mut state: MutexGuard<'_, State<T>>, token: T) -> Result<(), T> {
        if state.token.is_some() || state.ended {
            return Err(token);
        }
        state.token = Some(token);
        drop(state);
        self.outside.bell.ring();
        Ok(())
    }
}

impl<T> Clone for PortSender<T> {
    fn clone(&self) -> Self {
        self.outside.senders.fetch_add(1, Ordering::AcqRel);
        Self { cell: Arc::clone(&self.cell), outside: Arc::clone(&self.outside) }
    }
}

impl<T> Drop for PortSender<T> {
    fn drop(&mut self) {
        if self.outside.senders.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.outside.bell.ring();
        }
    }
}

/// The end of an event of a program that another thread has.
pub struct PortReceiver<T> {
    cell: Arc<Cell<T>>,
    outside: Arc<Others>,
}

impl<T> PortReceiver<T> {
    /// Takes the token out that has come, if one has.
    pub fn take(&self) -> Option<T> {
        self.take_from(self.cell.state())
    }

    /// Waits for a token and takes it out; `None` when the program has ended.
    pub fn receive(&self) -> Option<T> {
        let is_empty = |state: &mut State<T>| state.token.is_none() && !state.ended;
        let state = self.cell.changed.wait_while(self.cell.state(), is_empty).unwrap_or_else(PoisonError::into_inner);
        self.take_from(state)
    }

    fn take_from(&self, mut state: MutexGuard<'_, State<T>>) -> Option<T> {
        let token = state.token.take();
        drop(state);
        if token.is_some() {
            self.outside.bell.ring();
        }
        token
    }
}

impl<T> Drop for PortReceiver<T> {
    fn drop(&mut self) {
        self.cell.state().ended = true;
        self.outside.bell.ring();
    }
}

/// What the ends of all ports share.
#[derive(Default)]
pub(crate) struct Others {
    bell: Bell,
    senders: AtomicUsize,
}

impl Others {
    /// This thread is unparked when somebody does something at the other end of a port.
    pub fn listen(&self) -> Listens<'_> {
        self.bell.listen()
    }
}

/// Room for a token between a mailbox and the end that another thread has.
struct Cell<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    token: Option<T>,
    /// The program has ended, or who takes its events is gone.
    ended: bool,
}

impl<T> Default for Cell<T> {
    fn default() -> Self {
        Self { state: Mutex::new(State { token: None, ended: false }), changed: Condvar::new() }
    }
}

impl<T> Cell<T> {
    /// A thread that panicked while it had this left nothing half done.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A way between the mailboxes `M` of a program and another thread.
trait Way<M>: Send {
    /// Moves a token on, if there is one, and room for it.
    fn pass(&self, mailboxes: &mut M) -> bool;

    /// Whether a token waits for room, which may come.
    fn holds_back(&self, mailboxes: &mut M) -> bool;

    /// The program has ended.
    fn end(&self);
}

struct WayIn<M, T> {
    cell: Arc<Cell<T>>,
    port: fn(&mut M) -> &mut Mailbox<T>,
}

impl<M, T: Send> Way<M> for WayIn<M, T> {
    fn pass(&self, mailboxes: &mut M) -> bool {
        let mailbox = (self.port)(mailboxes);
        if mailbox.is_full() {
            return false;
        }
        let token = self.cell.state().token.take();
        let moved = token.is_some_and(|token| mailbox.put(token).is_ok());
        if moved {
            self.cell.changed.notify_all();
        }
        moved
    }

    fn holds_back(&self, _mailboxes: &mut M) -> bool {
        false
    }

    fn end(&self) {
        self.cell.state().ended = true;
        self.cell.changed.notify_all();
    }
}

struct WayOut<M, T> {
    cell: Arc<Cell<T>>,
    port: fn(&mut M) -> &mut Mailbox<T>,
}

impl<M, T: Send> Way<M> for WayOut<M, T> {
    fn pass(&self, mailboxes: &mut M) -> bool {
        let (mailbox, mut state) = ((self.port)(mailboxes), self.cell.state());
        if state.token.is_some() || state.ended {
            return false;
        }
        state.token = mailbox.take();
        let moved = state.token.is_some();
        drop(state);
        if moved {
            self.cell.changed.notify_all();
        }
        moved
    }

    fn holds_back(&self, mailboxes: &mut M) -> bool {
        (self.port)(mailboxes).is_full() && !self.cell.state().ended
    }

    fn end(&self) {
        self.cell.state().ended = true;
        self.cell.changed.notify_all();
    }
}

/// The near ends of all ports of a program with the mailboxes `I` and `E`.
pub(crate) struct Ways<I, E> {
    inputs: Vec<Box<dyn Way<I>>>,
    events: Vec<Box<dyn Way<E>>>,
    outside: Arc<Others>,
    /// Whether somebody could wake the program, when tokens were moved last.
    kept: bool,
}

impl<I, E> Ways<I, E> {
    /// Moves all tokens on that can be moved; whether there were some. The program has something to do then.
    pub fn pass(&mut self, (inputs, events): (&mut I, &mut E)) -> bool {
        self.outside.bell.take();
        // Not lazily: all of them.
        let came = self.inputs.iter().fold(false, |any, way| way.pass(inputs) | any);
        let went = self.events.iter().fold(false, |any, way| way.pass(events) | any);
        let held = self.events.iter().any(|way| way.holds_back(events));
        self.kept = held || self.outside.senders.load(Ordering::Acquire) > 0;
        came | went
    }

    /// Whether somebody could still put a token in or take one out that the program waits with.
    pub const fn is_open(&self) -> bool {
        self.kept
    }

    /// Whether somebody did something at the other ends since tokens were moved.
    pub fn rings(&self) -> bool {
        self.outside.bell.rings()
    }

    /// What rings then, for the thread that drives the program to listen to.
    pub fn bell(&self) -> Arc<Others> {
        Arc::clone(&self.outside)
    }
}

impl<I, E> Drop for Ways<I, E> {
    fn drop(&mut self) {
        self.inputs.iter().for_each(|way| way.end());
        self.events.iter().for_each(|way| way.end());
    }
}

impl<P: Program> Outside<P> for Ways<P::Inputs, P::Events> {
    fn exchange(&mut self, program: &mut P) -> bool {
        self.pass(program.mailboxes())
    }

    fn is_open(&self) -> bool {
        self.kept
    }

    fn wait<C: Clock>(&mut self, clock: &mut C, until: Option<Time>) -> bool {
        clock.wait(until, &|| self.rings())
    }
}
