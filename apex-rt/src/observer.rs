use crate::{Next, Parameters, Time};
use core::{
    fmt::{Debug, Display},
    time::Duration,
};

/// Observer of a program's reactions. Every method does nothing unless it is overridden; with `()` a program is
/// compiled as if there were no observer.
///
/// Nodes are given by their index in [`Info::nodes`](crate::Info::nodes), connections by their index in
/// [`Info::connections`](crate::Info::connections).
///
/// ```
/// use apex_rt::{drive_with, prelude::*};
///
/// apex_macros::graph!("examples/blink.afg");
///
/// /// Counts reactions, and keeps the time of the last one.
/// #[derive(Default)]
/// struct Reactions(u32, Time);
///
/// impl Observer for Reactions {
///     fn before_reaction(&mut self, now: Time, _params: &mut impl Parameters) {
///         *self = Self(self.0 + 1, now);
///     }
/// }
///
/// # fn main() {
/// let mut reactions = Reactions::default();
/// drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), &mut reactions);
/// assert_eq!((reactions.0, reactions.1), (50, Time::from_millis(980)));
/// # }
/// ```
pub trait Observer {
    /// Called before a reaction at `now`, on the thread that drives the program or one of its thread groups. `params`
    /// are the parameters of this group, which may be set here.
    #[inline(always)]
    fn before_reaction(&mut self, now: Time, params: &mut impl Parameters) {
        let _ = (now, params);
    }

    /// Called after a reaction.
    #[inline(always)]
    fn after_reaction(&mut self, next: Next) {
        let _ = next;
    }

    /// Called before node `node` fires.
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        let _ = node;
    }

    /// Called after a firing of node `node`, or after a call of its slot.
    #[inline(always)]
    fn finished(&mut self, node: usize) {
        let _ = node;
    }

    /// Called before the slot at the end of connection `connection` takes its token.
    #[inline(always)]
    fn handled(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Called when node `node` becomes active or inactive. Each state of a state machine is a node, too.
    #[inline(always)]
    fn activity(&mut self, node: usize, active: bool) {
        let _ = (node, active);
    }

    /// Called when a reaction has used up its steps, because tokens cycle without time passing. `nodes` took part in
    /// the last steps, each as often as `counts` says.
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let _ = (nodes, counts);
    }

    /// Called when nothing can happen any more while the node at the end of connection `connection` still waits for its
    /// event.
    fn waits(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Called for each token that can never be taken any more, because tokens wait for one another: the token on
    /// connection `connection` is at a slot whose node is not called before its events were taken.
    fn stuck(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Called when node `node` returned an error, or panicked and the panic was caught. Its outputs carry ⊥.
    #[inline(always)]
    fn failed(&mut self, node: usize, error: &impl Display) {
        let _ = (node, error);
    }

    /// Called when node `node` missed its deadline: it finished `age` after the source of its oldest token fired.
    #[inline(always)]
    fn late(&mut self, node: usize, age: Duration) {
        let _ = (node, age);
    }

    /// Called when node `node` hangs: it has been running for `running` and has not finished. The call comes from
    /// another thread.
    fn hung(&mut self, node: usize, running: Duration) {
        let _ = (node, running);
    }

    /// Called when the time of a reaction was earlier than that of the reaction before, by `by`. The program's own time
    /// goes on from where it was.
    fn set_back(&mut self, by: Duration) {
        let _ = by;
    }

    /// Called when the program has fallen behind its clock: it is `behind` late, and its last reaction took `reaction`.
    /// The next call comes after it has caught up.
    fn behind(&mut self, behind: Duration, reaction: Duration) {
        let _ = (behind, reaction);
    }

    /// Called when the token of the program's event `event` has not been taken for `waits`: what triggers it is held
    /// back meanwhile. The next call comes for another event.
    fn untaken(&mut self, event: &'static str, waits: Duration) {
        let _ = (event, waits);
    }

    /// Returns `true` if a late reaction ends after the first of the instants that have passed, so that other things
    /// are served between them; `false` if it makes up for all of them.
    #[inline(always)]
    fn ends_early(&mut self) -> bool {
        false
    }

    /// Returns the duration of this reaction so far, by the machine's clock. A deadline adds it to the time that tokens
    /// waited. Zero if it is not measured.
    #[inline(always)]
    fn elapsed(&mut self) -> Duration {
        Duration::ZERO
    }

    /// Called when a token at the parameter port `parameter` of node `node` was out of range. The node keeps its value.
    #[inline(always)]
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let _ = (node, parameter, value);
    }

    /// Called when claim `claim` (by its index in [`Info::claims`](crate::Info::claims)) is violated. It is reported
    /// again only after it held in between. Claims that the compiler has decided are not checked.
    fn claim_failed(&mut self, claim: usize) {
        let _ = claim;
    }

    /// Returns `true` if the observer wants to see the tokens of channel `channel` (by its index in
    /// [`Program::channels`](crate::Program::channels)): what one output or event of a node sends. By default it wants
    /// what its [tap](Self::tap) wants.
    #[cfg(feature = "record")]
    #[inline(always)]
    fn wants(&mut self, channel: usize) -> bool {
        self.tap().is_some_and(|tap| tap.wants(channel))
    }

    /// Called with each token of a channel that the observer [wants](Self::wants). `codec` writes it as bytes; `None`
    /// if its type cannot be recorded.
    #[cfg(feature = "record")]
    fn sent<T>(&mut self, channel: usize, codec: Option<crate::record::Codec<T>>, token: &T) {
        if let Some(tap) = self.tap() {
            tap.sent(channel, codec, token);
        }
    }

    /// Returns the tap through which the program's tokens are recorded or replayed.
    #[cfg(feature = "record")]
    #[inline(always)]
    fn tap(&mut self) -> Option<&mut crate::record::Tap> {
        None
    }
}

/// A state machine was called. It was in state `before`, and is in `after`: both are indices in
/// [`Info::nodes`](crate::Info::nodes).
#[inline(always)]
pub fn turned(observer: &mut impl Observer, before: usize, after: usize) {
    if before != after {
        observer.activity(before, false);
        observer.activity(after, true);
    }
}

impl Observer for () {}

impl<T> Observer for core::marker::PhantomData<T> {}

/// Implements all methods by calling those of other observers.
macro_rules! pass_on {
    ($self:ident, $($to:expr),+) => {
        #[inline(always)]
        fn fired(&mut $self, node: usize) {
            $($to.fired(node);)+
        }
        #[inline(always)]
        fn finished(&mut $self, node: usize) {
            $($to.finished(node);)+
        }
        #[inline(always)]
        fn handled(&mut $self, connection: usize) {
            $($to.handled(connection);)+
        }
        pass_on_others!($self, $($to),+);
    };
}

/// Implements all methods except those for the beginning and end of firings by calling those of other observers.
macro_rules! pass_on_others {
    ($self:ident, $($to:expr),+) => {
        #[inline(always)]
        fn before_reaction(&mut $self, now: Time, params: &mut impl Parameters) {
            $($to.before_reaction(now, params);)+
        }
        #[inline(always)]
        fn after_reaction(&mut $self, next: Next) {
            $($to.after_reaction(next);)+
        }
        #[inline(always)]
        fn activity(&mut $self, node: usize, active: bool) {
            $($to.activity(node, active);)+
        }
        fn endless(&mut $self, nodes: &[usize], counts: &[u32]) {
            $($to.endless(nodes, counts);)+
        }
        fn waits(&mut $self, connection: usize) {
            $($to.waits(connection);)+
        }
        fn stuck(&mut $self, connection: usize) {
            $($to.stuck(connection);)+
        }
        #[inline(always)]
        fn failed(&mut $self, node: usize, error: &impl Display) {
            $($to.failed(node, error);)+
        }
        #[inline(always)]
        fn late(&mut $self, node: usize, age: Duration) {
            $($to.late(node, age);)+
        }
        fn hung(&mut $self, node: usize, running: Duration) {
            $($to.hung(node, running);)+
        }
        fn set_back(&mut $self, by: Duration) {
            $($to.set_back(by);)+
        }
        fn behind(&mut $self, behind: Duration, reaction: Duration) {
            $($to.behind(behind, reaction);)+
        }
        fn untaken(&mut $self, event: &'static str, waits: Duration) {
            $($to.untaken(event, waits);)+
        }
        #[inline(always)]
        fn ends_early(&mut $self) -> bool {
            false $(|| $to.ends_early())+
        }
        #[inline(always)]
        fn elapsed(&mut $self) -> Duration {
            Duration::ZERO$(.max($to.elapsed()))+
        }
        #[inline(always)]
        fn refused(&mut $self, node: usize, parameter: &'static str, value: &impl Debug) {
            $($to.refused(node, parameter, value);)+
        }
        fn claim_failed(&mut $self, claim: usize) {
            $($to.claim_failed(claim);)+
        }
        #[cfg(feature = "record")]
        #[inline(always)]
        fn wants(&mut $self, channel: usize) -> bool {
            false $(|| $to.wants(channel))+
        }
        #[cfg(feature = "record")]
        fn sent<T>(&mut $self, channel: usize, codec: Option<crate::record::Codec<T>>, token: &T) {
            $(if $to.wants(channel) {
                $to.sent(channel, codec, token);
            })+
        }
        #[cfg(feature = "record")]
        #[inline(always)]
        fn tap(&mut $self) -> Option<&mut crate::record::Tap> {
            None$(.or($to.tap()))+
        }
    };
}

#[cfg(feature = "std")]
pub(crate) use pass_on_others;

impl<O: Observer> Observer for &mut O {
    pass_on!(self, (**self));
}

/// Calls both observers, the first one first.
impl<A: Observer, B: Observer> Observer for (A, B) {
    pass_on!(self, self.0, self.1);
}

/// Listener to problems. It returns `false` when it does not want any more of them.
#[cfg(feature = "std")]
type Listener = std::boxed::Box<dyn Fn(&str) -> bool + Send>;

/// Listeners to what [`StdErr`] writes.
#[cfg(feature = "std")]
static LISTENERS: std::sync::Mutex<std::vec::Vec<Listener>> = std::sync::Mutex::new(std::vec::Vec::new());

/// Calls `listener` with each problem that the programs of this process write to standard error, too, until it returns
/// `false`: a driver can pass them on. It is called within reactions, so it must not wait.
///
/// ```
/// use apex_rt::{Info, listen_to_problems, prelude::*};
/// use std::sync::mpsc;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// let (sender, problems) = mpsc::channel();
/// listen_to_problems(move |problem| sender.send(problem.to_owned()).is_ok());
/// const INFO: Info = Blink::INFO;
/// StdErr(&INFO).failed(0, &"no more paper");
/// assert_eq!(problems.recv().as_deref(), Ok("Blink: `clock` failed: no more paper"));
/// # }
/// ```
#[cfg(feature = "std")]
pub fn listen_to_problems(listener: impl Fn(&str) -> bool + Send + 'static) {
    listeners().push(std::boxed::Box::new(listener));
}

#[cfg(feature = "std")]
fn listeners() -> std::sync::MutexGuard<'static, std::vec::Vec<Listener>> {
    LISTENERS.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Number of problems that viewers get who come later.
#[cfg(feature = "std")]
const TOLD: usize = 100;

/// Problems beside the programs: their number, and the newest ones.
#[cfg(feature = "std")]
static BESIDE: std::sync::Mutex<(u64, std::collections::VecDeque<std::string::String>)> =
    std::sync::Mutex::new((0, std::collections::VecDeque::new()));

/// Shows a problem that is not one of a node, as a network that is silent, to the viewers of the programs of this
/// process: in the studio. Viewers that come later get the last hundred of them. Without the feature `studio` there are
/// no viewers.
///
/// ```
/// use apex_rt::tell_viewers;
/// use std::{io::Error, net::UdpSocket};
///
/// /// Opens the socket of a driver.
/// fn open(address: &str) -> Option<UdpSocket> {
///     let tell = |error: &Error| tell_viewers(&format!("no lidar at {address}: {error}"));
///     UdpSocket::bind(address).inspect_err(tell).ok()
/// }
///
/// assert!(open("127.0.0.1:0").is_some());
/// assert!(open("203.0.113.1:2368").is_none());
/// ```
#[cfg(feature = "std")]
pub fn tell_viewers(problem: &str) {
    let mut told = BESIDE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    told.0 += 1;
    told.1.push_back(problem.into());
    if told.1.len() > TOLD {
        told.1.pop_front();
    }
}

/// Returns the problems beside the programs after the first `seen` of them, and the number of all. It does not wait for
/// a thread that tells one.
#[cfg(feature = "studio")]
pub(crate) fn told_viewers(seen: u64) -> (u64, std::vec::Vec<std::string::String>) {
    let Ok(told) = BESIDE.try_lock() else { return (seen, std::vec::Vec::new()) };
    let new = usize::try_from(told.0.saturating_sub(seen)).unwrap_or(usize::MAX).min(told.1.len());
    (told.0, told.1.iter().skip(told.1.len() - new).cloned().collect())
}

/// Writes a problem to standard error, and passes it on.
#[cfg(feature = "std")]
macro_rules! tell {
    ($($text:tt)*) => {{
        let text = std::format!($($text)*);
        eprintln!("{text}");
        listeners().retain(|listener| listener(&text));
    }};
}

/// Observer that writes failures, missed deadlines, hanging nodes, refused parameter values, deadlocks, endless loops,
/// violated claims, and what is odd about the time to standard error, with the names of the nodes.
///
/// ```
/// use apex_rt::{Info, drive_with, prelude::*};
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// const INFO: Info = Blink::INFO;
/// // `drive` has this observer; `drive_with` has only those that it is given.
/// let observer = StdErr(&INFO);
/// assert_eq!(drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), observer), 0);
/// # }
/// ```
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct StdErr(pub &'static crate::Info);

#[cfg(feature = "std")]
impl Observer for StdErr {
    fn failed(&mut self, node: usize, error: &impl Display) {
        tell!("{}: `{}` failed: {error}", self.0.name, self.0.nodes[node].name);
    }
    fn late(&mut self, node: usize, age: Duration) {
        tell!(
            "{}: `{}` missed its deadline: it finished {age:.1?} after its source fired",
            self.0.name,
            self.0.nodes[node].name
        );
    }
    fn hung(&mut self, node: usize, running: Duration) {
        tell!("{}: `{}` hangs: it has been running for {running:.1?}", self.0.name, self.0.nodes[node].name);
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let name = self.0.nodes[node].name;
        tell!("{}: `{name}` keeps its `{parameter}`: {value:?} is out of range", self.0.name);
    }
    fn waits(&mut self, connection: usize) {
        let (info, c) = (self.0, &self.0.connections[connection]);
        let (from, to) = (info.nodes[c.from].name, info.nodes[c.to].name);
        tell!(
            "{}: deadlock: `{to}` waits for the event `{from}.{}`, which can no longer be triggered",
            info.name,
            c.output
        );
    }
    fn stuck(&mut self, connection: usize) {
        let (info, c) = (self.0, &self.0.connections[connection]);
        let (from, to) = (info.nodes[c.from].name, info.nodes[c.to].name);
        tell!(
            "{}: deadlock: the token of `{from}.{}` waits at `{to}.{}` forever, for one that waits for it",
            info.name,
            c.output,
            c.input
        );
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let total: u32 = counts.iter().sum();
        tell!("{}: endless cycle of tokens at one point in time; of the last {total} steps:", self.0.name);
        for (node, count) in nodes.iter().zip(counts).filter(|(_, count)| **count > 0) {
            tell!("{count:>8}  `{}`", self.0.nodes[*node].name);
        }
    }
    fn claim_failed(&mut self, claim: usize) {
        tell!("{}: the claim `{}` does not hold", self.0.name, self.0.claims[claim]);
    }
    fn set_back(&mut self, by: Duration) {
        tell!("{}: the time was set back by {by:.1?}; the program's own time goes on from where it was", self.0.name);
    }
    fn untaken(&mut self, event: &'static str, waits: Duration) {
        tell!(
            "{}: nobody takes the event `{event}`: its token has waited for {waits:.1?}, and what triggers it is held back; receive it with `Ports::event`, or connect nothing to it",
            self.0.name
        );
    }
    fn behind(&mut self, behind: Duration, reaction: Duration) {
        let name = self.0.name;
        let shortest = self.0.nodes.iter().filter_map(|node| Some((node.every?, node.name))).min();
        let period = shortest.map(|(every, source)| format!(", and `{source}` fires every {every:?}"));
        tell!(
            "{name}: slow: a reaction takes {reaction:.1?}{}: {behind:.1?} behind; move slow nodes to a thread group of their own, or let sources `skip` what they miss",
            period.unwrap_or_default()
        );
    }
}
