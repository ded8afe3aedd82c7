//! Parameters of a running program for other threads.

use crate::{
    Parameters,
    params::{Access, IntoParam, ParamError, ParamInfo, ParamValue, ParamVisitor, Rejection, find},
    switch::{Bell, Listens},
};
use std::sync::{
    Arc, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicUsize, Ordering},
    mpsc::sync_channel,
};

/// Reads and sets the parameters of a running program from another thread.
///
/// Each call is served between two reactions of the thread group that the parameter belongs to, and returns then: after
/// at most one reaction. A sleeping group is woken for it. Calls before the program starts wait for its first reaction.
/// A recording contains the new values, so that a replay sets them at the same reactions.
///
/// Do not call it from a node: a node runs within a reaction, which would wait for itself.
#[derive(Clone)]
pub struct RemoteParams {
    requests: Arc<Requests>,
    params: &'static [ParamInfo],
}

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
        self.ask(name, |access| T::take(access.get()))
    }

    /// Sets the parameter `name` to `value`, in SI units, as [`Parameters::set_param`] does.
    ///
    /// # Errors
    /// A parameter that does not exist or is of another type, a value out of its range, or a program that has ended.
    /// The parameter keeps its value.
    pub fn set(&self, name: &str, value: impl IntoParam + Send + 'static) -> Result<(), ParamError> {
        self.ask(name, move |access| access.set(value.give()))
    }

    /// Returns the value of the parameter `name` in TOML: `0.5`, `"laser"`, `[1, 2]`.
    ///
    /// # Errors
    /// The errors of [`get`](Self::get).
    pub fn get_text(&self, name: &str) -> Result<String, ParamError> {
        self.ask(name, |access| Ok(access.get().to_string()))
    }

    /// Sets the parameter `name` to a value in TOML.
    ///
    /// # Errors
    /// The errors of [`set`](Self::set).
    #[cfg(feature = "params")]
    pub fn set_text(&self, name: &str, value: &str) -> Result<(), ParamError> {
        let value = value.to_owned();
        self.ask(name, move |access| crate::params::with_text(&value, |value| access.set(value)))
    }

    /// Calls `act` on the thread of the parameter's group, and returns its result.
    pub(crate) fn ask<T, F>(&self, name: &str, act: F) -> Result<T, ParamError>
    where
        T: Send + 'static,
        F: FnOnce(&mut dyn Access) -> Result<T, Rejection> + Send + 'static,
    {
        let (answer, answered) = sync_channel(1);
        // Nobody waits for the answer of a thread that has ended.
        self.post(name, act, move |result| drop(answer.send(result)))?;
        answered.recv().unwrap_or(Err(ParamError::Ended))
    }

    /// Lets `act` be called on the thread of the parameter's group, and `answer` there with its result. A program that
    /// has ended calls neither.
    pub(crate) fn post<T, F, A>(&self, name: &str, act: F, answer: A) -> Result<(), ParamError>
    where
        F: FnOnce(&mut dyn Access) -> Result<T, Rejection> + Send + 'static,
        A: FnOnce(Result<T, ParamError>) + Send + 'static,
    {
        let param = find(self.params, name)?;
        let act = move |access: Option<&mut dyn Access>| {
            let result = access.map_or(Err(Rejection::Opaque), act);
            answer(result.map_err(|refusal| ParamError::Refused { param, refusal }));
        };
        self.requests.put(Request { name: param.name, act: Box::new(act) });
        Ok(())
    }
}

/// Operation on a parameter; `None` if its type is not a [`ParamValue`].
type Act = Box<dyn FnOnce(Option<&mut dyn Access>) + Send>;

/// A request of another thread. If it is dropped unserved, that thread learns that the program has ended.
struct Request {
    name: &'static str,
    act: Act,
}

/// Requests that wait for the groups of a program.
#[derive(Default)]
pub(crate) struct Requests {
    bell: Bell,
    /// Number of requests so far: a group sees without a lock that there is a new one.
    count: AtomicUsize,
    waiting: Mutex<Waiting>,
}

#[derive(Default)]
struct Waiting {
    requests: Vec<Request>,
    ended: bool,
}

impl Requests {
    fn put(&self, request: Request) {
        let mut waiting = self.waiting();
        if waiting.ended {
            return;
        }
        waiting.requests.push(request);
        drop(waiting);
        self.count.fetch_add(1, Ordering::Release);
        self.bell.ring();
    }

    /// Refuses all requests from now on: the program has ended.
    pub fn end(&self) {
        let mut waiting = self.waiting();
        waiting.ended = true;
        waiting.requests.clear();
    }

    /// Forgets all requests that wait.
    #[cfg(feature = "studio")]
    pub fn forget(&self) {
        self.waiting().requests.clear();
    }

    /// Registers this thread: it is unparked by each request as long as the result lives.
    pub fn listen(&self) -> Listens<'_> {
        self.bell.listen()
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A thread group's view of the requests.
#[derive(Clone, Default)]
pub(crate) struct ServedRequests {
    pub shared: Arc<Requests>,
    /// Number of requests that the group has looked at.
    seen: usize,
}

impl ServedRequests {
    /// A view of the requests in `shared`.
    #[cfg(feature = "studio")]
    pub fn new(shared: Arc<Requests>) -> Self {
        Self { shared, seen: 0 }
    }

    /// Returns `true` if there are requests that the group has not looked at.
    pub fn are_new(&self) -> bool {
        self.shared.count.load(Ordering::Acquire) != self.seen
    }

    /// Serves the requests for the parameters of `part`: those of the program, or of one of its thread groups.
    pub fn serve<P: Parameters>(&mut self, part: &mut P) {
        if self.are_new() {
            self.seen = self.shared.count.load(Ordering::Acquire);
            part.visit_params(&mut Server(&mut self.shared.waiting().requests));
        }
    }
}

/// Visitor that serves the requests for the parameters that it visits.
struct Server<'a>(&'a mut Vec<Request>);

impl ParamVisitor for Server<'_> {
    fn param(&mut self, info: &'static ParamInfo, mut access: Option<&mut dyn Access>) {
        for request in self.0.extract_if(.., |request| request.name == info.name) {
            (request.act)(access.as_mut().map(|access| &mut **access as &mut dyn Access));
        }
    }
}
