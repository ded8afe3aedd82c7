//! Parameters of a running program for other threads.

use crate::{
    params::{Access, Given, IntoParam, ParamError, ParamInfo, ParamValue, Rejection, find},
    requests::{Act, Requests},
};
use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, Thread},
    time::Duration,
};

/// Reads and sets the parameters of a running program from another thread.
///
/// Each call is served between two reactions of the thread group that the parameter belongs to, and returns then. A
/// sleeping group is woken for it. A group serves a few calls between two reactions and waits for no other thread
/// meanwhile; more of them wait for their turn. Calls before the program starts wait for its first reaction. A
/// recording contains the new values, so that a replay sets them at the same reactions.
///
/// Do not call it from a node: a node runs within a reaction, which would wait for itself.
///
/// ```
/// use apex_rt::{Ports, drive_from, prelude::*};
/// use std::thread;
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let mut ports = Ports::<Smooth>::new();
/// let (x, params) = (ports.input(|inputs| &mut inputs.x), ports.params());
/// let robot = thread::spawn(|| drive_from(Smooth::new(), WallClock::new(), ports));
/// assert_eq!(params.set("filter.weight", 0.25), Ok(()));
/// assert_eq!(params.get("filter.weight"), Ok(0.25));
/// assert_eq!(params.get_text("filter.weight").as_deref(), Ok("0.25"));
/// // A program that waits for input runs as long as it may get some.
/// drop(x);
/// assert_eq!(robot.join().expect("it does not panic"), 0);
/// # }
/// ```
#[derive(Clone)]
pub struct RemoteParams {
    requests: Arc<Requests>,
    params: &'static [ParamInfo],
}

/// Time between two attempts to find a place for a request.
const RETRY: Duration = Duration::from_millis(1);

impl RemoteParams {
    pub(crate) const fn new(requests: Arc<Requests>, params: &'static [ParamInfo]) -> Self {
        Self { requests, params }
    }

    /// All parameters of the program.
    pub const fn all(&self) -> &'static [ParamInfo] {
        self.params
    }

    /// Returns the value of the parameter `name`.
    ///
    /// # Errors
    /// A parameter that does not exist or is of another type, or a program that has ended.
    pub fn get<T: ParamValue + Send + 'static>(&self, name: &str) -> Result<T, ParamError> {
        self.ask(name, |access| (T::take(access.get()), 1))
    }

    /// Sets the parameter `name` to `value`, in SI units, as
    /// [`Parameters::set_param`](crate::Parameters::set_param) does.
    ///
    /// # Errors
    /// A parameter that does not exist or is of another type, a value out of its range, or a program that has ended.
    /// The parameter keeps its value.
    pub fn set(&self, name: &str, value: impl IntoParam + Send + 'static) -> Result<(), ParamError> {
        self.ask(name, move |access| (access.set(value.give()), 1))
    }

    /// Returns the value of the parameter `name` in TOML: `0.5`, `"laser"`, `[1, 2]`.
    ///
    /// # Errors
    /// The errors of [`get`](Self::get).
    pub fn get_text(&self, name: &str) -> Result<String, ParamError> {
        let value = self.ask(name, |access| {
            let mut room = usize::MAX;
            let value = Given::copy(access.get(), &mut room);
            (Ok(value), usize::MAX - room)
        })?;
        // There was room for any value.
        Ok(value.map(|value| value.give().to_string()).unwrap_or_default())
    }

    /// Sets the parameter `name` to a value in TOML. It is read on this thread.
    ///
    /// # Errors
    /// The errors of [`set`](Self::set).
    #[cfg(feature = "params")]
    pub fn set_text(&self, name: &str, value: &str) -> Result<(), ParamError> {
        let (size, value) = (value.len(), crate::params::parsed(value));
        // The value comes back, so that the group need not free its memory.
        let (set, _) = self.ask(name, move |access| {
            let set = access.set(value.give());
            (Ok((set, value)), size)
        })?;
        set.map_err(|refusal| self.refused(name, refusal))
    }

    /// The error of a value that was refused.
    #[cfg(feature = "params")]
    pub(crate) fn refused(&self, name: &str, refusal: Rejection) -> ParamError {
        find(self.params, name).map_or_else(|unknown| unknown, |param| ParamError::Refused { param, refusal })
    }

    /// Calls `act` on the thread of the parameter's group, and returns its result.
    fn ask<T, F>(&self, name: &str, act: F) -> Result<T, ParamError>
    where
        T: Send + 'static,
        F: FnOnce(&mut dyn Access) -> (Result<T, Rejection>, usize) + Send + 'static,
    {
        let (mut request, asked) = self.request(name, act)?;
        while let Err(full) = self.requests.put(request) {
            request = full;
            thread::sleep(RETRY);
        }
        asked.wait()
    }

    /// Lets `act` be called on the thread of the parameter's group, if there is a place for another request. `act`
    /// returns its result, and how many bytes it has moved.
    ///
    /// # Errors
    /// There is no such parameter.
    #[cfg(feature = "studio")]
    pub(crate) fn post<T, F>(&self, name: &str, act: F) -> Result<Option<Asked<T>>, ParamError>
    where
        T: Send + 'static,
        F: FnOnce(&mut dyn Access) -> (Result<T, Rejection>, usize) + Send + 'static,
    {
        let (request, asked) = self.request(name, act)?;
        Ok(self.requests.put(request).is_ok().then_some(asked))
    }

    fn request<T, F>(&self, name: &str, act: F) -> Result<((usize, Act), Asked<T>), ParamError>
    where
        T: Send + 'static,
        F: FnOnce(&mut dyn Access) -> (Result<T, Rejection>, usize) + Send + 'static,
    {
        let param = find(self.params, name)?;
        let at = self.params.iter().position(|other| std::ptr::eq(other, param)).unwrap_or_default();
        let answer =
            Arc::new(Answer { given: Mutex::new(None), is_over: AtomicBool::new(false), asks: thread::current() });
        let teller = Teller(Arc::clone(&answer));
        let act = move |access: Option<&mut dyn Access>| {
            let (result, moved) = access.map_or((Err(Rejection::Opaque), 1), act);
            teller.tell(result.map_err(|refusal| ParamError::Refused { param, refusal }));
            moved
        };
        Ok(((at, Box::new(act)), Asked(answer)))
    }
}

/// The answer to a request.
struct Answer<T> {
    given: Mutex<Option<Result<T, ParamError>>>,
    /// `true` if there is nothing to wait for any more.
    is_over: AtomicBool,
    /// The thread that asks.
    asks: Thread,
}

/// The end of the thread that answers. If it is dropped without an answer, the program has ended.
struct Teller<T>(Arc<Answer<T>>);

impl<T> Teller<T> {
    /// Answers. The other end does not look before this one is dropped: the lock is free.
    fn tell(self, answer: Result<T, ParamError>) {
        *self.0.given.lock().unwrap_or_else(PoisonError::into_inner) = Some(answer);
    }
}

impl<T> Drop for Teller<T> {
    fn drop(&mut self) {
        self.0.is_over.store(true, Ordering::Release);
        self.0.asks.unpark();
    }
}

/// The end of the thread that asks.
pub(crate) struct Asked<T>(Arc<Answer<T>>);

impl<T> Asked<T> {
    /// Returns the answer, or `None` as long as there is none.
    pub fn take(&self) -> Option<Result<T, ParamError>> {
        let is_over = self.0.is_over.load(Ordering::Acquire);
        let given = || self.0.given.lock().unwrap_or_else(PoisonError::into_inner).take();
        is_over.then(|| given().unwrap_or(Err(ParamError::Ended)))
    }

    fn wait(&self) -> Result<T, ParamError> {
        loop {
            if let Some(answer) = self.take() {
                return answer;
            }
            thread::park();
        }
    }
}
