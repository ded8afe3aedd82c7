//! Ports of a running program for other threads.

use crate::{
    Clock, Mailbox, Program, RemoteParams, Time,
    end::is_asked,
    outside::Outside,
    requests::{Requests, ServedRequests},
    switch::{Bell, Listens},
};
use std::sync::{
    Arc, Condvar, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicUsize, Ordering},
};

/// The ports of a program that other threads use while [`drive_from`](crate::drive_from) drives it. A token that they
/// put in wakes the program. A program that waits for input does not end while one of the [`PortSender`]s exists.
///
/// As in every connection, there is room for one token between a sender or receiver and the mailbox of the program.
///
/// ```
/// use apex_rt::{Ports, drive_from, prelude::*};
/// use std::thread;
///
/// apex_macros::graph!("examples/count.afg");
///
/// # fn main() {
/// let mut ports = Ports::<Count>::new();
/// let ticks = ports.input(|inputs| &mut inputs.tick);
/// let counts = ports.event(|events| &mut events.count);
/// let user = thread::spawn(move || {
///     let count = || ticks.send(()).ok().and_then(|()| counts.receive());
///     [count(), count()]
/// });
/// assert_eq!(drive_from(Count::new(), WallClock::new(), ports), 0);
/// assert_eq!(user.join().expect("it does not panic"), [Some(1), Some(2)]);
/// # }
/// ```
pub struct Ports<P: Program>(pub(crate) Ways<P::Inputs, P::Events>);

impl<P: Program> Ports<P> {
    /// Returns ports without senders and receivers.
    pub fn new() -> Self {
        let requests = ServedRequests::new(Arc::new(Requests::new(P::PARAMS)));
        Self(Ways { inputs: vec![], events: vec![], outside: Arc::default(), kept: false, requests })
    }

    /// Returns the sender for a graph-level input or slot: `ports.input(|inputs| &mut inputs.stop)`.
    pub fn input<T: Send + 'static>(&mut self, port: fn(&mut P::Inputs) -> &mut Mailbox<T>) -> PortSender<T>
    where
        P::Inputs: 'static,
    {
        let cell = Arc::new(Cell::default());
        self.0.inputs.push(Box::new(WayIn { cell: Arc::clone(&cell), port }));
        self.0.outside.senders.fetch_add(1, Ordering::AcqRel);
        PortSender { cell, outside: Arc::clone(&self.0.outside) }
    }

    /// Returns the receiver for an event of the program: `ports.event(|events| &mut events.done)`.
    pub fn event<T: Send + 'static>(&mut self, port: fn(&mut P::Events) -> &mut Mailbox<T>) -> PortReceiver<T>
    where
        P::Events: 'static,
    {
        let cell = Arc::new(Cell::default());
        self.0.events.push(Box::new(WayOut { cell: Arc::clone(&cell), port }));
        PortReceiver { cell, outside: Arc::clone(&self.0.outside) }
    }

    /// Returns the requests that the program serves.
    #[cfg(feature = "studio")]
    pub(crate) fn requests(&self) -> Arc<Requests> {
        Arc::clone(&self.0.requests.shared)
    }

    /// Returns access to the program's parameters. It does not keep a program running that waits for input.
    pub fn params(&self) -> RemoteParams {
        RemoteParams::new(Arc::clone(&self.0.requests.shared), P::PARAMS)
    }
}

impl<P: Program> Default for Ports<P> {
    fn default() -> Self {
        Self::new()
    }
}

/// Sender of tokens to a graph-level input or slot, for another thread.
///
/// ```
/// use apex_rt::{Ports, drive_from, prelude::*};
///
/// apex_macros::graph!("examples/count.afg");
///
/// # fn main() {
/// let mut ports = Ports::<Count>::new();
/// let ticks = ports.input(|inputs| &mut inputs.tick);
/// assert_eq!(ticks.put(()), Ok(()));
/// assert_eq!(ticks.put(()), Err(()), "the first one was not taken");
/// drive_from(Count::new(), SimClock::until(Time::MAX), ports);
/// assert_eq!(ticks.put(()), Err(()), "the program has ended");
/// # }
/// ```
pub struct PortSender<T> {
    cell: Arc<Cell<T>>,
    outside: Arc<Others>,
}

impl<T> PortSender<T> {
    /// Puts a token in, and wakes the program.
    ///
    /// # Errors
    /// Returns the token if the previous one has not been taken, or if the program has ended.
    pub fn put(&self, token: T) -> Result<(), T> {
        self.put_into(self.cell.state(), token)
    }

    /// Waits until there is room for a token, and puts it in.
    ///
    /// # Errors
    /// Returns the token if the program has ended.
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

/// Receiver of the tokens of a program's event, for another thread.
///
/// ```
/// use apex_rt::{Ports, drive_from, prelude::*};
///
/// apex_macros::graph!("examples/count.afg");
///
/// # fn main() {
/// let mut ports = Ports::<Count>::new();
/// let ticks = ports.input(|inputs| &mut inputs.tick);
/// let counts = ports.event(|events| &mut events.count);
/// assert_eq!((ticks.put(()), counts.take()), (Ok(()), None));
/// drive_from(Count::new(), SimClock::until(Time::MAX), ports);
/// assert_eq!((counts.take(), counts.receive()), (Some(1), None));
/// # }
/// ```
pub struct PortReceiver<T> {
    cell: Arc<Cell<T>>,
    outside: Arc<Others>,
}

impl<T> PortReceiver<T> {
    /// Takes the token out, if there is one.
    pub fn take(&self) -> Option<T> {
        self.take_from(self.cell.state())
    }

    /// Waits for a token and takes it out. Returns `None` if the program has ended.
    pub fn receive(&self) -> Option<T> {
        let is_empty = |state: &mut State<T>| state.token.is_none() && !state.ended;
        let mut state = self.cell.state();
        state.is_busy = false;
        let mut state = self.cell.changed.wait_while(state, is_empty).unwrap_or_else(PoisonError::into_inner);
        state.is_busy = state.token.is_some();
        self.take_from(state)
    }

    /// Gives tokens to `act` first, on the thread that drives the program, which waits for it: this saves the way to
    /// another thread. A token that it returns is left to [`PortReceiver::receive`], and so are those after it until
    /// that is called again: they stay in their order.
    ///
    /// ```
    /// use apex_rt::{Ports, drive_from, prelude::*};
    /// use std::sync::mpsc::channel;
    ///
    /// apex_macros::graph!("examples/count.afg");
    ///
    /// # fn main() {
    /// let mut ports = Ports::<Count>::new();
    /// let ticks = ports.input(|inputs| &mut inputs.tick);
    /// let counts = ports.event(|events| &mut events.count);
    /// let (sender, receiver) = channel();
    /// counts.at_once(move |count| sender.send(count).err().map(|unsent| unsent.0));
    /// assert_eq!(ticks.put(()), Ok(()));
    /// drive_from(Count::new(), SimClock::until(Time::MAX), ports);
    /// assert_eq!((receiver.recv(), counts.take()), (Ok(1), None));
    /// # }
    /// ```
    pub fn at_once(&self, act: impl FnMut(T) -> Option<T> + Send + 'static) {
        self.cell.state().first = Some(Box::new(act));
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

/// State that all senders and receivers of a program share.
#[derive(Default)]
pub(crate) struct Others {
    bell: Bell,
    senders: AtomicUsize,
}

impl Others {
    /// Registers this thread: it is unparked when another thread uses a sender or receiver, as long as the result
    /// lives.
    pub fn listen(&self) -> Listens<'_> {
        self.bell.listen()
    }
}

/// Storage for a token between a mailbox and the sender or receiver of another thread.
struct Cell<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    token: Option<T>,
    /// Function that gets the tokens of an event first.
    first: Option<First<T>>,
    /// `true` while the token that was received last is in use.
    is_busy: bool,
    /// `true` if the program has ended, or the receiver of its events is dropped.
    ended: bool,
}

/// Function that takes tokens on the thread of the program, or returns them.
type First<T> = Box<dyn FnMut(T) -> Option<T> + Send>;

impl<T> Default for Cell<T> {
    fn default() -> Self {
        let state = State { token: None, first: None, is_busy: false, ended: false };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }
}

impl<T> Cell<T> {
    /// Locks the state. A poisoned lock is used as it is: a thread that panicked has left nothing half done.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Path of tokens between the mailboxes `M` of a program and another thread.
trait Way<M>: Send {
    /// Moves a token, if there is one and there is room for it. Returns `true` if it did.
    fn pass(&self, mailboxes: &mut M) -> bool;

    /// Returns `true` if a token waits for room that may become free.
    fn holds_back(&self, mailboxes: &mut M) -> bool;

    /// Reports to the other thread that the program has ended.
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
        let Some(token) = mailbox.take() else { return false };
        let is_idle = !state.is_busy;
        state.token = match &mut state.first {
            Some(first) if is_idle => first(token),
            _ => Some(token),
        };
        let waits = state.token.is_some();
        drop(state);
        if waits {
            self.cell.changed.notify_all();
        }
        true
    }

    fn holds_back(&self, mailboxes: &mut M) -> bool {
        (self.port)(mailboxes).is_full() && !self.cell.state().ended
    }

    fn end(&self) {
        self.cell.state().ended = true;
        self.cell.changed.notify_all();
    }
}

/// The program's ends of all ports, for the mailboxes `I` and `E`.
pub(crate) struct Ways<I, E> {
    inputs: Vec<Box<dyn Way<I>>>,
    events: Vec<Box<dyn Way<E>>>,
    outside: Arc<Others>,
    /// Value of [`Ways::is_open`], as of the last call of [`Ways::pass`].
    kept: bool,
    /// Requests for the parameters.
    pub requests: ServedRequests,
}

impl<I, E> Ways<I, E> {
    /// Moves all tokens that can be moved. Returns `true` if there were any: the program then has something to do.
    pub fn pass(&mut self, (inputs, events): (&mut I, &mut E)) -> bool {
        self.outside.bell.take();
        // Not `any`, which stops at the first: all of them are called.
        let came = self.inputs.iter().fold(false, |any, way| way.pass(inputs) | any);
        let went = self.events.iter().fold(false, |any, way| way.pass(events) | any);
        let held = self.events.iter().any(|way| way.holds_back(events));
        self.kept = held || self.outside.senders.load(Ordering::Acquire) > 0;
        came | went
    }

    /// Returns `true` if another thread may still put a token in, or take out one that the program waits with.
    pub const fn is_open(&self) -> bool {
        self.kept
    }

    /// Returns `true` if another thread used a sender or receiver since tokens were moved last.
    pub fn rings(&self) -> bool {
        self.outside.bell.rings()
    }

    /// Returns the state with the bell that rings then. The thread that drives the program listens to it.
    pub fn bell(&self) -> Arc<Others> {
        Arc::clone(&self.outside)
    }
}

impl<I, E> Drop for Ways<I, E> {
    fn drop(&mut self) {
        self.inputs.iter().for_each(|way| way.end());
        self.events.iter().for_each(|way| way.end());
        self.requests.shared.end();
    }
}

impl<P: Program> Outside<P> for Ways<P::Inputs, P::Events> {
    #[inline]
    fn exchange(&mut self, program: &mut P) -> bool {
        // Most programs have no ports, and an exchange comes after every reaction.
        !(self.inputs.is_empty() && self.events.is_empty()) && self.pass(program.mailboxes())
    }

    fn serve(&mut self, program: &mut P) {
        self.requests.serve(program);
    }

    fn is_open(&self) -> bool {
        self.kept
    }

    fn wait<C: Clock>(&mut self, clock: &mut C, until: Option<Time>) -> bool {
        clock.wait(until, &|| self.rings() || self.requests.are_new() || is_asked())
    }
}
