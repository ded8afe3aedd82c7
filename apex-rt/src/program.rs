//! Compiled graphs, and their thread groups.

use crate::{
    Arrival, CellSender, Info, Next, Observer, Parameters, Time,
    cell_message::CellMessage,
    params::{ParamInfo, ParamVisitor},
};

/// A compiled graph. `graph!` generates a struct that implements this trait. The struct itself has the functions `new`,
/// `react`, `inputs`, `outputs`, `events` and `nodes`.
///
/// ```
/// use apex_rt::prelude::*;
/// use std::time::Duration;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// /// Returns the shortest period of the sources of a program.
/// fn period<P: Program>(_program: &P) -> Option<Duration> {
///     P::INFO.nodes.iter().filter_map(|node| node.every).min()
/// }
///
/// # fn main() {
/// let mut blink = Blink::new();
/// assert_eq!(period(&blink), Some(Duration::from_millis(20)));
/// // With an observer; `react` is the same without one.
/// assert_eq!(blink.react_with(Time::ZERO, &mut ()), Next::At(Time::from_millis(20)));
/// # }
/// ```
pub trait Program: Parameters {
    /// Static description of the graph.
    const INFO: Info;

    /// Mailboxes of the graph-level inputs and slots.
    type Inputs;

    /// Mailboxes of the events.
    type Events;

    /// Reacts at `now`: runs until nothing is ready. Returns the time of the next reaction.
    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next;

    /// Returns the mailboxes, for use between two reactions.
    fn mailboxes(&mut self) -> (&mut Self::Inputs, &mut Self::Events);

    /// Returns the event of the program whose token has been waiting the longest, by its name, and the number of the
    /// token.
    #[doc(hidden)]
    fn untaken(&self) -> Option<(&'static str, Arrival)> {
        None
    }

    /// File for recordings of the program, from its `record` statement.
    #[cfg(feature = "record")]
    const RECORD: Option<&'static str> = None;

    /// Returns the channels that can be recorded.
    #[cfg(feature = "record")]
    fn channels() -> std::vec::Vec<crate::record::Channel> {
        std::vec::Vec::new()
    }

    /// Calls `found` with each connection (by index) whose event is missing at a node that has other tokens. If nothing
    /// else can happen, that is a deadlock.
    fn waiting(&self, found: impl FnMut(usize)) {
        let _ = found;
    }

    /// Calls the `#[on_stop]` methods of all nodes, because the program has ended: a driver stops its motors there.
    fn stop(&mut self) {}

    /// Returns `true` if node `node` is active (thesis eq. 7.1).
    fn is_active(&self, node: usize) -> bool {
        let _ = node;
        false
    }

    /// Passes the thread groups of a program to `spawn`, the main group last. `wake` is called when a group has to
    /// react.
    #[doc(hidden)]
    fn on_threads<'a, W, S>(&'a mut self, wake: W, spawn: &mut S)
    where
        W: Wake + Copy + Send + 'a,
        S: Spawn<'a, Self::Inputs, Self::Events>,
        Self: Sized,
    {
        let _ = wake;
        spawn.stay(0, SingleGroup(self));
    }

    /// Returns `true` if nested graph `graph`, by its index in [`Info::graphs`], is active: one of its nodes is active,
    /// or activity is on its way between two of them.
    fn is_graph_active(&self, graph: usize) -> bool {
        let _ = graph;
        false
    }
}

impl<P: Program> Program for &mut P {
    const INFO: Info = P::INFO;
    type Inputs = P::Inputs;
    type Events = P::Events;

    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next {
        (**self).react_with(now, observer)
    }

    fn mailboxes(&mut self) -> (&mut Self::Inputs, &mut Self::Events) {
        (**self).mailboxes()
    }

    fn untaken(&self) -> Option<(&'static str, Arrival)> {
        (**self).untaken()
    }

    fn on_threads<'a, W, S>(&'a mut self, wake: W, spawn: &mut S)
    where
        W: Wake + Copy + Send + 'a,
        S: Spawn<'a, Self::Inputs, Self::Events>,
    {
        (**self).on_threads(wake, spawn);
    }

    fn waiting(&self, found: impl FnMut(usize)) {
        (**self).waiting(found);
    }

    fn stop(&mut self) {
        (**self).stop();
    }

    #[cfg(feature = "record")]
    const RECORD: Option<&'static str> = P::RECORD;

    #[cfg(feature = "record")]
    fn channels() -> std::vec::Vec<crate::record::Channel> {
        P::channels()
    }

    fn is_active(&self, node: usize) -> bool {
        (**self).is_active(node)
    }

    fn is_graph_active(&self, graph: usize) -> bool {
        (**self).is_graph_active(graph)
    }
}

/// Wakes thread groups, by number, when a token has come for them or has been taken from them.
#[doc(hidden)]
pub trait Wake {
    /// Wakes group `group`, because there is something to react to.
    fn wake(&self, group: usize);
}

impl<W: Wake> Wake for &W {
    fn wake(&self, group: usize) {
        (**self).wake(group);
    }
}

/// A part of a program that runs on one thread.
#[doc(hidden)]
pub trait Group: Program {
    /// Reacts at `now`. Sources without a period fire only if `begins` is `true`: the reaction then begins, instead of
    /// continuing because of actions of other groups.
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> Next;
}

/// Runner of the thread groups of a program with the mailboxes `I` and `E`. Each group is passed to it.
#[doc(hidden)]
pub trait Spawn<'a, I, E> {
    /// Runs a group on any thread.
    fn spawn<G: Group + Send + 'a>(&mut self, group: usize, part: G);

    /// Takes the cell that reports hanging nodes to group `group`. Called before the other methods.
    fn watch(&mut self, group: usize, hung: CellSender<'a, CellMessage<()>>);

    /// Runs the main group, which has the ports of the program, on the current thread. Called last.
    fn stay<G: Group<Inputs = I, Events = E> + 'a>(&mut self, group: usize, part: G);
}

/// A program with a single group.
#[derive(Debug)]
#[doc(hidden)]
pub struct SingleGroup<'a, P>(pub &'a mut P);

impl<P: Program> Parameters for SingleGroup<'_, P> {
    const PARAMS: &'static [ParamInfo] = P::PARAMS;

    fn visit_params(&mut self, visitor: &mut dyn ParamVisitor) {
        self.0.visit_params(visitor);
    }
}

impl<P: Program> Program for SingleGroup<'_, P> {
    const INFO: Info = P::INFO;
    type Inputs = P::Inputs;
    type Events = P::Events;

    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next {
        self.0.react_with(now, observer)
    }

    fn mailboxes(&mut self) -> (&mut P::Inputs, &mut P::Events) {
        self.0.mailboxes()
    }

    fn untaken(&self) -> Option<(&'static str, Arrival)> {
        self.0.untaken()
    }
}

impl<P: Program> Group for SingleGroup<'_, P> {
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> Next {
        if begins { self.0.react_with(now, observer) } else { Next::Input }
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::drive_with;

    /// A program that records its calls.
    struct Asked(std::vec::Vec<&'static str>);

    impl Parameters for Asked {}

    impl Program for Asked {
        const INFO: Info = Info {
            name: "Asked",
            docs: "",
            files: &[],
            nodes: &[],
            kinds: &[],
            graphs: &[],
            connections: &[],
            clusters: &[],
            groups: &[],
            end_if_hung: None,
            claims: &[],
        };
        type Inputs = u8;
        type Events = u16;

        fn react_with<O: Observer>(&mut self, _now: Time, _observer: &mut O) -> Next {
            self.0.push("react_with");
            Next::Exit(3)
        }
        fn mailboxes(&mut self) -> (&mut u8, &mut u16) {
            std::unreachable!("nobody drives it with ports")
        }
        fn waiting(&self, mut found: impl FnMut(usize)) {
            found(7);
        }
        fn is_active(&self, node: usize) -> bool {
            node == 5
        }
        fn is_graph_active(&self, graph: usize) -> bool {
            graph == 6
        }
        #[cfg(feature = "record")]
        const RECORD: Option<&'static str> = Some("a.mcap");
    }

    /// Calls all methods of a program that have a default.
    fn ask<P: Program>(program: &P) {
        let mut found = std::vec![];
        program.waiting(|connection| found.push(connection));
        assert_eq!(found, [7]);
        assert!(program.is_active(5) && program.is_graph_active(6));
        #[cfg(feature = "record")]
        assert_eq!(P::RECORD, Some("a.mcap"));
    }

    #[test]
    fn a_borrowed_program_answers_as_the_program_does() {
        let mut program = Asked(std::vec![]);
        ask(&program);
        ask(&&mut program);
        assert_eq!(drive_with(&mut program, crate::SimClock::until(Time::MAX), ()), 3);
        assert_eq!(program.0, ["react_with"]);
    }
}
