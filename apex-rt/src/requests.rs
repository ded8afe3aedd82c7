//! Requests of other threads for the parameters of a running program. They are handed over without a lock that another
//! thread could hold while a group wants it, and a group serves only a few of them between two reactions: whoever asks
//! cannot delay a reaction.

use crate::{
    Parameters,
    params::{Access, AnyParams, MAX_VALUE, ParamInfo, ParamVisitor},
    switch::{Bell, Listens},
};
use std::sync::{
    Arc, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicBool, AtomicU8, AtomicU64, AtomicUsize, Ordering},
};

/// Operation on a parameter, or on `None` if its type is not a [`ParamValue`](crate::params::ParamValue). Returns how
/// many bytes it has moved.
pub type Act = Box<dyn FnOnce(Option<&mut dyn Access>) -> usize + Send>;

/// Number of requests that may wait, besides one for each parameter.
pub const ROOM: usize = 1088;
/// Number of requests that a group serves between two reactions, and number of bytes after which it serves no other.
const MOST: usize = 4;
const MOST_BYTES: usize = MAX_VALUE / 4;

/// States of a place: it is free, its request waits, or the request is being taken out.
const FREE: u8 = 0;
const WAITS: u8 = 1;
const TAKEN: u8 = 2;

/// A place for a request.
#[derive(Default)]
struct Place {
    state: AtomicU8,
    /// Number of the parameter in the table.
    param: AtomicUsize,
    /// Number of the request: those before it are smaller.
    number: AtomicU64,
    /// Whoever has changed the state from `WAITS` to `TAKEN`, or writes into a free place, has the lock for itself.
    act: Mutex<Option<Act>>,
}

impl Place {
    /// Takes the request out, if it still waits.
    fn take(&self) -> Option<Act> {
        self.state.compare_exchange(WAITS, TAKEN, Ordering::AcqRel, Ordering::Relaxed).ok()?;
        let act = locked(&self.act).take();
        self.state.store(FREE, Ordering::Release);
        act
    }
}

/// Requests that wait for the groups of a program.
pub struct Requests {
    params: &'static [ParamInfo],
    bell: Bell,
    /// Number of requests so far: a group sees that there is a new one.
    count: AtomicUsize,
    places: Box<[Place]>,
    /// Lock of those who ask.
    senders: Mutex<Senders>,
    ended: AtomicBool,
}

#[derive(Default)]
struct Senders {
    /// Number of the next request.
    number: u64,
    /// The place at which the search for a free one begins.
    next: usize,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Requests {
    pub fn new(params: &'static [ParamInfo]) -> Self {
        // A program without parameters gets no requests.
        let room = if params.is_empty() { 0 } else { ROOM + params.len() };
        Self {
            params,
            bell: Bell::new(),
            count: AtomicUsize::new(0),
            places: (0..room).map(|_| Place::default()).collect(),
            senders: Mutex::default(),
            ended: AtomicBool::new(false),
        }
    }

    /// Lets the group of a parameter, given by its number, do something. A program that has ended drops the request.
    ///
    /// # Errors
    /// Returns the request if too many of them wait.
    pub fn put(&self, (param, act): (usize, Act)) -> Result<(), (usize, Act)> {
        let mut senders = locked(&self.senders);
        if self.ended.load(Ordering::Acquire) {
            return Ok(());
        }
        let free = |at: &usize| self.places[*at].state.load(Ordering::Acquire) == FREE;
        let all = self.places.len();
        let Some(at) = (senders.next..all).chain(0..senders.next).find(free) else { return Err((param, act)) };
        let place = &self.places[at];
        *locked(&place.act) = Some(act);
        place.param.store(param, Ordering::Relaxed);
        place.number.store(senders.number, Ordering::Relaxed);
        place.state.store(WAITS, Ordering::Release);
        *senders = Senders { number: senders.number + 1, next: (at + 1) % all };
        drop(senders);
        self.count.fetch_add(1, Ordering::Release);
        self.bell.ring();
        Ok(())
    }

    /// Refuses all requests from now on: the program has ended.
    pub fn end(&self) {
        let _senders = locked(&self.senders);
        self.ended.store(true, Ordering::Release);
        self.places.iter().for_each(|place| drop(place.take()));
    }

    /// Forgets all requests that wait.
    #[cfg(feature = "studio")]
    pub fn forget(&self) {
        let _senders = locked(&self.senders);
        self.places.iter().for_each(|place| drop(place.take()));
    }

    /// Registers this thread: it is unparked by each request as long as the result lives.
    pub fn listen(&self) -> Listens<'_> {
        self.bell.listen()
    }
}

/// A thread group's view of the requests.
#[derive(Clone)]
pub struct ServedRequests {
    pub shared: Arc<Requests>,
    /// Number of requests that the group has looked at.
    seen: usize,
    /// `true` if some of them still wait for the group.
    has_more: bool,
    /// `true` for each parameter of the group, by its number; empty before the first request.
    own: Box<[bool]>,
}

impl ServedRequests {
    /// A view of the requests in `shared`.
    pub fn new(shared: Arc<Requests>) -> Self {
        Self { shared, seen: 0, has_more: false, own: Box::default() }
    }

    /// Returns `true` if there are requests that the group has not looked at.
    pub fn are_new(&self) -> bool {
        self.has_more || self.shared.count.load(Ordering::Acquire) != self.seen
    }

    /// Serves some of the requests for the parameters of `part`: those of the program, or of one of its thread groups.
    /// It waits for no other thread, and takes a limited time.
    pub fn serve<P: Parameters>(&mut self, part: &mut P) {
        if self.are_new() {
            self.serve_now(part);
        }
    }

    fn serve_now(&mut self, part: &mut dyn AnyParams) {
        self.seen = self.shared.count.load(Ordering::Acquire);
        if self.own.is_empty() {
            self.own = own(self.shared.params, part);
        }
        let mut due = Due::default();
        for (at, place) in self.shared.places.iter().enumerate() {
            let waits = place.state.load(Ordering::Acquire) == WAITS;
            let param = place.param.load(Ordering::Relaxed);
            if waits && self.own.get(param) == Some(&true) {
                due.add(Next { number: place.number.load(Ordering::Relaxed), at, param });
            }
        }
        let mut server = Server { requests: &self.shared, due: &mut due, moved: 0 };
        if server.due.next.iter().any(Option::is_some) {
            part.visit(&mut server);
        }
        self.has_more = due.has_more;
    }

    /// Serves all requests, however long it takes: the time of the program stands still.
    #[cfg(feature = "studio")]
    pub fn serve_all<P: Parameters>(&mut self, part: &mut P) {
        while self.are_new() {
            self.serve(part);
        }
    }
}

/// Returns `true` for each of the parameters that `part` has.
fn own(params: &'static [ParamInfo], part: &mut dyn AnyParams) -> Box<[bool]> {
    struct Own {
        params: &'static [ParamInfo],
        own: Box<[bool]>,
        next: usize,
    }
    impl ParamVisitor for Own {
        fn param(&mut self, info: &'static ParamInfo, _access: Option<&mut dyn Access>) {
            // They come in the sequence of the table.
            let mut all = (self.next..self.params.len()).chain(0..self.next);
            if let Some(at) = all.find(|at| self.params[*at].name == info.name) {
                self.own[at] = true;
                self.next = at + 1;
            }
        }
    }
    let mut visitor = Own { params, own: vec![false; params.len()].into(), next: 0 };
    part.visit(&mut visitor);
    visitor.own
}

/// A request that is served next.
#[derive(Clone, Copy)]
struct Next {
    number: u64,
    at: usize,
    param: usize,
}

/// The oldest requests, in sequence.
#[derive(Default)]
struct Due {
    next: [Option<Next>; MOST],
    /// `true` if there are others.
    has_more: bool,
}

impl Due {
    fn add(&mut self, mut new: Next) {
        for known in &mut self.next {
            match known {
                None => {
                    *known = Some(new);
                    return;
                }
                Some(known) if new.number < known.number => core::mem::swap(known, &mut new),
                Some(_) => {}
            }
        }
        self.has_more = true;
    }
}

/// Visitor that serves the requests for the parameters that it visits.
struct Server<'a> {
    requests: &'a Requests,
    due: &'a mut Due,
    /// Number of bytes that they have moved.
    moved: usize,
}

impl ParamVisitor for Server<'_> {
    fn param(&mut self, info: &'static ParamInfo, mut access: Option<&mut dyn Access>) {
        let Self { requests, due, moved } = self;
        for next in due.next.iter().flatten() {
            if requests.params[next.param].name != info.name {
                continue;
            }
            if *moved > MOST_BYTES {
                due.has_more = true;
            } else if let Some(act) = requests.places[next.at].take() {
                *moved = moved.saturating_add(act(access.as_mut().map(|access| &mut **access as &mut dyn Access)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::{Declared, IntoParam as _, ParamRange, ParamRef, Rejection};

    const DECLARED: Declared = Declared::new(None, ParamRange::new(None, None, false));
    const PARAMS: [ParamInfo; 2] = [DECLARED.of("a.x", "f64"), DECLARED.of("b.x", "f64")];

    /// A group with one of the two parameters.
    struct Part(&'static ParamInfo, f64);

    struct Value<'a>(&'a mut f64);

    impl Access for Value<'_> {
        fn get(&mut self) -> ParamRef<'_> {
            self.0.give()
        }
        fn check(&self, _value: ParamRef<'_>) -> Result<(), Rejection> {
            Ok(())
        }
        fn set(&mut self, value: ParamRef<'_>) -> Result<(), Rejection> {
            *self.0 = crate::params::ParamValue::take(value)?;
            Ok(())
        }
    }

    impl Parameters for Part {
        fn visit_params(&mut self, visitor: &mut dyn ParamVisitor) {
            visitor.param(self.0, Some(&mut Value(&mut self.1)));
        }
    }

    /// A program of two groups, and the requests for it.
    fn program() -> (Arc<Requests>, [(Part, ServedRequests); 2]) {
        let requests = Arc::new(Requests::new(&PARAMS));
        let group = |at: usize| (Part(&PARAMS[at], 0.0), ServedRequests::new(Arc::clone(&requests)));
        (Arc::clone(&requests), [group(0), group(1)])
    }

    /// Sets a parameter to `value`, which counts as so many bytes.
    fn set(requests: &Requests, param: usize, value: f64, bytes: usize) -> bool {
        let act = move |access: Option<&mut dyn Access>| {
            access.expect("a number").set(value.give()).expect("it fits");
            bytes
        };
        requests.put((param, Box::new(act))).is_ok()
    }

    #[test]
    fn a_group_serves_a_few_requests_at_a_time_in_their_sequence() {
        let (requests, [(mut one, mut served), (mut other, mut of_other)]) = program();
        for value in 1..=10 {
            assert!(set(&requests, 0, f64::from(value), 1) && set(&requests, 1, -1.0, 1));
        }
        let mut values = vec![];
        while served.are_new() {
            served.serve(&mut one);
            values.push(one.1);
        }
        assert_eq!(values, [4.0, 8.0, 10.0]);
        assert!(of_other.are_new());
        of_other.serve(&mut other);
        assert_eq!((other.1, of_other.are_new()), (-1.0, true));
    }

    #[test]
    fn after_a_long_value_the_group_serves_no_other() {
        let (requests, [(mut part, mut served), _]) = program();
        (1..=3).for_each(|value| assert!(set(&requests, 0, f64::from(value), MAX_VALUE)));
        served.serve(&mut part);
        assert_eq!((part.1, served.are_new()), (1.0, true));
    }

    #[test]
    fn there_is_room_for_a_limited_number_of_requests_which_become_free_again() {
        let (requests, [(mut part, mut served), _]) = program();
        let put = || (0..).take_while(|value| set(&requests, 0, f64::from(*value), 1)).count();
        assert_eq!(put(), ROOM + PARAMS.len());
        served.serve(&mut part);
        assert_eq!((part.1, put()), (3.0, MOST));
        requests.end();
        assert!(set(&requests, 0, 0.0, 1), "it is dropped");
        served.serve(&mut part);
        assert_eq!(part.1, 3.0);
    }

    #[test]
    fn a_group_waits_for_nobody_who_asks() {
        let (requests, [(mut part, mut served), (mut other, mut of_other)]) = program();
        assert!(set(&requests, 0, 1.0, 1));
        // A thread that asks stands still in the middle of it, and another group while it takes its request.
        let _senders = locked(&requests.senders);
        let _place = locked(&requests.places[1].act);
        served.serve(&mut part);
        of_other.serve(&mut other);
        assert_eq!((part.1, other.1), (1.0, 0.0));
    }
}
