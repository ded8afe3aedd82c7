use core::{
    fmt::{Debug, Display},
    time::Duration,
};

/// Watches a program while it reacts. Every method does nothing unless it is overridden; with `()` a
/// program is compiled as if nobody watched.
///
/// Nodes are given by their index in [`Info::nodes`](crate::Info::nodes), connections by theirs in
/// [`Info::connections`](crate::Info::connections).
pub trait Observer {
    /// Node `node` is about to fire.
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        let _ = node;
    }

    /// Node `node` has finished what it began: a firing, or a call of its slot.
    #[inline(always)]
    fn finished(&mut self, node: usize) {
        let _ = node;
    }

    /// The slot at the end of connection `connection` is about to take its token.
    #[inline(always)]
    fn handled(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Node `node` became active, or is no longer.
    #[inline(always)]
    fn activity(&mut self, node: usize, active: bool) {
        let _ = (node, active);
    }

    /// A reaction used up its steps, because tokens go round while the time stands still. `nodes` took part in the
    /// last steps, each as often as `counts` says.
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let _ = (nodes, counts);
    }

    /// The program can do nothing more, and the end of connection `connection` waits for its event.
    fn waits(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Node `node` returned an error, or panicked where that is contained; its outputs carry ⊥.
    #[inline(always)]
    fn failed(&mut self, node: usize, error: &impl Display) {
        let _ = (node, error);
    }

    /// Node `node` had finished only this `age` after the firing of the source that its oldest token descends from, which is
    /// more than its `deadline`.
    #[inline(always)]
    fn late(&mut self, node: usize, age: Duration) {
        let _ = (node, age);
    }

    /// Node `node` has been running for so long, and is still running: it hangs. Told on another thread.
    fn hung(&mut self, node: usize, running: Duration) {
        let _ = (node, running);
    }

    /// How long this reaction has been going on, by the machine's clock: what a deadline counts besides the time that
    /// tokens waited. Zero, where nobody measures it.
    #[inline(always)]
    fn elapsed(&mut self) -> Duration {
        Duration::ZERO
    }

    /// A token at the parameter port `parameter` of node `node` was out of range; the node keeps the value it has.
    #[inline(always)]
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let _ = (node, parameter, value);
    }

    /// Claim `claim` (by its index in [`Info::claims`](crate::Info::claims)) was broken. It is reported again only
    /// after it held in between. Claims that the compiler decided are not looked at.
    fn claim_failed(&mut self, claim: usize) {
        let _ = claim;
    }

    /// Where a program lets tokens out, to be recorded, or takes recorded ones in.
    #[cfg(feature = "record")]
    #[inline(always)]
    fn tap(&mut self) -> Option<&mut crate::record::Tap> {
        None
    }
}

impl Observer for () {}

/// Passes on what an observer is told to others.
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

/// The same, but for the beginning and the end of what nodes do.
macro_rules! pass_on_others {
    ($self:ident, $($to:expr),+) => {
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
        fn tap(&mut $self) -> Option<&mut crate::record::Tap> {
            None$(.or($to.tap()))+
        }
    };
}

#[cfg(feature = "std")]
impl<O: Observer> Observer for crate::threads::WatchdogObserver<'_, O> {
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        self.runs(node + 1);
        self.observer.fired(node);
    }
    #[inline(always)]
    fn handled(&mut self, connection: usize) {
        self.runs(self.info.connections[connection].to + 1);
        self.observer.handled(connection);
    }
    #[inline(always)]
    fn finished(&mut self, node: usize) {
        self.runs(0);
        self.observer.finished(node);
    }
    pass_on_others!(self, self.observer);
}

impl<O: Observer> Observer for &mut O {
    pass_on!(self, (**self));
}

/// Both are told, the first one first.
impl<A: Observer, B: Observer> Observer for (A, B) {
    pass_on!(self, self.0, self.1);
}

/// Writes failures, late nodes, refused parameter values, endless loops and broken claims to standard error, with the
/// names of the nodes.
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct StdErr(pub &'static crate::Info);

#[cfg(feature = "std")]
impl Observer for StdErr {
    fn failed(&mut self, node: usize, error: &impl Display) {
        eprintln!("{}: `{}` failed: {error}", self.0.name, self.0.nodes[node].name);
    }
    fn late(&mut self, node: usize, age: Duration) {
        eprintln!("{}: `{}` is late: it had finished after {age:.1?}", self.0.name, self.0.nodes[node].name);
    }
    fn hung(&mut self, node: usize, running: Duration) {
        eprintln!("{}: `{}` hangs: it has been running for {running:.1?}", self.0.name, self.0.nodes[node].name);
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let name = self.0.nodes[node].name;
        eprintln!("{}: `{name}` keeps its `{parameter}`: {value:?} is out of range", self.0.name);
    }
    fn waits(&mut self, connection: usize) {
        let (info, c) = (self.0, &self.0.connections[connection]);
        let (from, to) = (info.nodes[c.from].name, info.nodes[c.to].name);
        eprintln!("{}: `{to}` waits for the event `{from}.{}`, which never came", info.name, c.output);
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let total: u32 = counts.iter().sum();
        eprintln!("{}: tokens go round while the time stands still; of the last {total} steps:", self.0.name);
        for (node, count) in nodes.iter().zip(counts).filter(|(_, count)| **count > 0) {
            eprintln!("{count:>8}  `{}`", self.0.nodes[*node].name);
        }
    }
    fn claim_failed(&mut self, claim: usize) {
        eprintln!("{}: the claim `{}` does not hold", self.0.name, self.0.claims[claim]);
    }
}
