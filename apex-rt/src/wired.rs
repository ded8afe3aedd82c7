//! Meaning of activity and events (execution semantics, section 5), once for all programs: generated code has constant
//! rows of nodes, ports, slots and timeouts, and calls the functions of [`Wired`] with them.
//!
//! Row and state are known where a function is inlined, so that mostly a few bit operations remain. rustc inlines them
//! in small programs; large ones share them.

use crate::{Ctx, Observer, Out, Time, Timeout};
use core::time::Duration;
use rows::{Brings, Node, Port, Slot};

/// Rows of generated code: static data.
pub mod rows {
    /// Node that can be active.
    #[derive(Debug, Clone, Copy)]
    pub struct Node {
        pub(super) number: usize,
        /// Number of its timeout, and the longest time for which it may be active, in ns.
        pub(super) timeout: Option<(usize, u64)>,
        /// `true` if observers are notified of its activity.
        pub(super) observed: bool,
    }

    impl Node {
        /// Returns the node `number`.
        pub const fn new(number: usize) -> Self {
            Self { number, timeout: None, observed: true }
        }

        /// Sets the number of its timeout, and the longest time for which it may be active, in ns.
        #[must_use]
        pub const fn timeout(self, timeout: usize, after: u64) -> Self {
            Self { timeout: Some((timeout, after)), ..self }
        }

        /// Hides the activity of a node that only passes tokens on.
        #[must_use]
        pub const fn unobserved(self) -> Self {
            Self { observed: false, ..self }
        }
    }

    /// Port outside its region: effects of its tokens.
    #[derive(Debug, Clone, Copy)]
    pub struct Port {
        /// Node whose activity goes along with a token, unless it went already.
        pub(super) passes: Option<Node>,
        /// Slots whose tokens then carry activity.
        pub(super) carries: &'static [u32],
        /// Nodes whose inputs then hold activity.
        pub(super) gains: &'static [u32],
        /// Nodes that lose activity.
        pub(super) loses: &'static [u32],
        /// Slots whose tokens are queued.
        pub(super) queues: &'static [u16],
        /// Conditions "holds a token" that are set.
        pub(super) raises: &'static [u32],
        /// Conditions "is free" that are cleared.
        pub(super) occupies: &'static [u32],
        /// Stamps of connections that are set.
        pub(super) stamps: &'static [u32],
    }

    impl Port {
        /// Port whose tokens have no effects yet.
        pub const NEW: Self = Self {
            passes: None,
            carries: &[],
            gains: &[],
            loses: &[],
            queues: &[],
            raises: &[],
            occupies: &[],
            stamps: &[],
        };

        /// Passes the activity of `node` on.
        #[must_use]
        pub const fn passes(self, node: Node) -> Self {
            Self { passes: Some(node), ..self }
        }

        /// Adds slots whose tokens carry the activity that is passed on.
        #[must_use]
        pub const fn carries(self, carries: &'static [u32]) -> Self {
            Self { carries, ..self }
        }

        /// Adds nodes at whose inputs the activity arrives that is passed on.
        #[must_use]
        pub const fn gains(self, gains: &'static [u32]) -> Self {
            Self { gains, ..self }
        }

        /// Adds nodes that lose activity.
        #[must_use]
        pub const fn loses(self, loses: &'static [u32]) -> Self {
            Self { loses, ..self }
        }

        /// Adds slots to which a token goes.
        #[must_use]
        pub const fn queues(self, queues: &'static [u16]) -> Self {
            Self { queues, ..self }
        }

        /// Adds inputs to which a token goes.
        #[must_use]
        pub const fn raises(self, raises: &'static [u32]) -> Self {
            Self { raises, ..self }
        }

        /// Adds connections that are occupied until a token is taken.
        #[must_use]
        pub const fn occupies(self, occupies: &'static [u32]) -> Self {
            Self { occupies, ..self }
        }

        /// Adds connections that keep the stamp of a token.
        #[must_use]
        pub const fn stamps(self, stamps: &'static [u32]) -> Self {
            Self { stamps, ..self }
        }
    }

    /// Effect of a token on the activity of the node that takes it.
    #[derive(Debug, Clone, Copy)]
    pub(super) enum Brings {
        Nothing,
        /// Activity, always: the token comes from `start`.
        Activity(Node),
        /// Activity, if the token of the slot carries it.
        Carried(usize, Node),
        /// The end of its activity.
        Inactivity(Node),
    }

    /// Connection to a slot.
    #[derive(Debug, Clone, Copy)]
    pub struct Slot {
        /// Number of the node.
        pub(super) node: usize,
        /// Number of the connection, unless the token comes from another thread group.
        pub(crate) connection: Option<usize>,
        /// Condition "is free" of the connection.
        pub(super) frees: Option<usize>,
        /// Stamp of the connection.
        pub(super) stamp: Option<usize>,
        pub(super) brings: Brings,
        /// Slots whose tokens are taken before.
        pub(crate) after: &'static [u16],
    }

    impl Slot {
        /// Returns the connection to a slot of `node`.
        pub const fn new(node: usize) -> Self {
            Self { node, connection: None, frees: None, stamp: None, brings: Brings::Nothing, after: &[] }
        }

        /// Sets the number of the connection.
        #[must_use]
        pub const fn on(self, connection: usize) -> Self {
            Self { connection: Some(connection), ..self }
        }

        /// Sets the condition "is free" of the connection.
        #[must_use]
        pub const fn frees(self, bit: usize) -> Self {
            Self { frees: Some(bit), ..self }
        }

        /// Sets the stamp of the connection.
        #[must_use]
        pub const fn stamp(self, stamp: usize) -> Self {
            Self { stamp: Some(stamp), ..self }
        }

        /// Adds slots whose tokens must be taken before.
        #[must_use]
        pub const fn after(self, after: &'static [u16]) -> Self {
            Self { after, ..self }
        }

        /// Declares that the token comes from `start` and activates `node`.
        #[must_use]
        pub const fn always_activates(self, node: Node) -> Self {
            Self { brings: Brings::Activity(node), ..self }
        }

        /// Declares that the token of the slot `number` activates `node` if it carries activity.
        #[must_use]
        pub const fn activates(self, number: usize, node: Node) -> Self {
            Self { brings: Brings::Carried(number, node), ..self }
        }

        /// Declares that the token deactivates `node`.
        #[must_use]
        pub const fn deactivates(self, node: Node) -> Self {
            Self { brings: Brings::Inactivity(node), ..self }
        }
    }
}

/// Token that may be ⊥, or whether it is there.
pub trait There {
    /// Returns `true` unless it is ⊥.
    fn is_there(&self) -> bool;
}

impl There for bool {
    #[inline(always)]
    fn is_there(&self) -> bool {
        *self
    }
}

impl<T> There for Option<T> {
    #[inline(always)]
    fn is_there(&self) -> bool {
        self.is_some()
    }
}

impl<T> There for Out<T> {
    #[inline(always)]
    fn is_there(&self) -> bool {
        self.get().is_some()
    }
}

/// State of a program's asynchronous half. A program has those parts that its rows refer to; the default of each is
/// that the program has none.
pub trait Wired {
    /// Active nodes, by number: words of 64 bits.
    #[inline(always)]
    fn active(&mut self) -> &mut [u64] {
        &mut []
    }

    /// Nodes with activity at their inputs.
    #[inline(always)]
    fn gains(&mut self) -> &mut [u64] {
        &mut []
    }

    /// Nodes that lose activity when they take their tokens.
    #[inline(always)]
    fn loses(&mut self) -> &mut [u64] {
        &mut []
    }

    /// Slots whose tokens carry activity.
    #[inline(always)]
    fn carries(&mut self) -> &mut [u64] {
        &mut []
    }

    /// Stamps of connections.
    #[inline(always)]
    fn stamps(&mut self) -> &mut [Time] {
        &mut []
    }

    /// Timeouts of nodes.
    #[inline(always)]
    fn timeouts(&mut self) -> &mut [Timeout] {
        &mut []
    }

    /// Opens the agenda, because a timeout has changed.
    #[inline(always)]
    fn open_agenda(&mut self) {}

    /// Queues the token of a slot.
    #[inline(always)]
    fn queue(&mut self, _slot: u16) {}

    /// Sets a condition of the dispatcher.
    #[inline(always)]
    fn raise(&mut self, _bit: usize) {}

    /// Clears a condition of the dispatcher.
    #[inline(always)]
    fn occupy(&mut self, _bit: usize) {}

    /// Takes the token that waits for a slot: its connection is free again, and activity moves as the token says.
    /// Returns the context of the call, and `true` if the activity of the node has changed.
    #[inline(always)]
    fn enter<O: Observer>(&mut self, slot: &Slot, ctx: &Ctx, observer: &mut O) -> (Ctx, bool) {
        if let Some(connection) = slot.connection {
            observer.handled(connection);
        }
        if let Some(bit) = slot.frees {
            self.raise(bit);
        }
        let stamp = slot.stamp.and_then(|stamp| self.stamps().get(stamp).copied());
        let ctx = stamp.map_or(*ctx, |stamp| ctx.since(stamp));
        let turned = match slot.brings {
            Brings::Nothing => false,
            Brings::Activity(node) => self.activate(&node, &ctx, observer),
            Brings::Carried(number, node) => take(self.carries(), number) && self.activate(&node, &ctx, observer),
            Brings::Inactivity(node) => self.deactivate(&node, observer),
        };
        (ctx, turned)
    }

    /// Takes the token of a slot that calls nothing and sends nothing.
    #[inline(always)]
    fn only_enter<O: Observer>(&mut self, slot: &Slot, ctx: &Ctx, observer: &mut O) {
        self.enter(slot, ctx, observer);
        observer.finished(slot.node);
    }

    /// Ends the step of a node that sends at one port only: its activity goes with the token.
    #[inline(always)]
    fn leave<O: Observer>(&mut self, port: &Port, token: &impl There, ctx: &Ctx, observer: &mut O) {
        self.pass(port, token, observer);
        self.send(port, token, ctx);
    }

    /// Activates a node. Returns `true` unless it was active.
    #[inline(always)]
    fn activate<O: Observer>(&mut self, node: &Node, ctx: &Ctx, observer: &mut O) -> bool {
        if has(self.active(), node.number) {
            return false;
        }
        set(self.active(), node.number);
        if node.observed {
            observer.activity(node.number, true);
        }
        if let Some((timeout, after)) = node.timeout {
            self.start_timeout(timeout, after, ctx);
        }
        true
    }

    /// Deactivates a node. Returns `true` if it was active.
    #[inline(always)]
    fn deactivate<O: Observer>(&mut self, node: &Node, observer: &mut O) -> bool {
        if !take(self.active(), node.number) {
            return false;
        }
        if node.observed {
            observer.activity(node.number, false);
        }
        if let Some((timeout, _)) = node.timeout {
            self.stop_timeout(timeout);
        }
        true
    }

    /// Passes the activity of a node on with a token at a port, if there is one. Returns `true` if it went along.
    #[inline(always)]
    fn pass<O: Observer>(&mut self, port: &Port, token: &impl There, observer: &mut O) -> bool {
        if !token.is_there() {
            return false;
        }
        for node in port.loses {
            set(self.loses(), *node as usize);
        }
        let passes = port.passes.is_some_and(|node| self.deactivate(&node, observer));
        if passes {
            self.carry(port);
        }
        passes
    }

    /// Marks the tokens that come from a port as those that carry activity.
    #[inline(always)]
    fn carry(&mut self, port: &Port) {
        for slot in port.carries {
            set(self.carries(), *slot as usize);
        }
        for node in port.gains {
            set(self.gains(), *node as usize);
        }
    }

    /// Sends the token at a port, if there is one.
    #[inline(always)]
    fn send(&mut self, port: &Port, token: &impl There, ctx: &Ctx) {
        if !token.is_there() {
            return;
        }
        for slot in port.queues {
            self.queue(*slot);
        }
        for bit in port.raises {
            self.raise(*bit as usize);
        }
        for bit in port.occupies {
            self.occupy(*bit as usize);
        }
        for stamp in port.stamps {
            if let Some(kept) = self.stamps().get_mut(*stamp as usize) {
                *kept = ctx.stamp();
            }
        }
    }

    /// Starts a timeout of `after` nanoseconds.
    #[inline(always)]
    fn start_timeout(&mut self, timeout: usize, after: u64, ctx: &Ctx) {
        if let Some(timeout) = self.timeouts().get_mut(timeout) {
            timeout.start(ctx.now(), Duration::from_nanos(after));
        }
        self.open_agenda();
    }

    /// Starts and stops the times of the states of a machine, which begin with the timeout `first`. `turned` holds
    /// those that have begun (`true`) or ended, `after` their lengths in nanoseconds.
    #[inline]
    fn time_states<const N: usize>(&mut self, first: usize, turned: [Option<bool>; N], after: [u64; N], ctx: &Ctx) {
        for (timeout, (turned, after)) in (first..).zip(turned.into_iter().zip(after)) {
            match turned {
                Some(true) => self.start_timeout(timeout, after, ctx),
                Some(false) => self.stop_timeout(timeout),
                None => {}
            }
        }
    }

    /// Stops a timeout.
    #[inline(always)]
    fn stop_timeout(&mut self, timeout: usize) {
        if let Some(timeout) = self.timeouts().get_mut(timeout) {
            timeout.stop();
        }
        self.open_agenda();
    }
}

/// A program whose slots need neither a queue nor conditions, and in which nothing can be active.
impl Wired for () {}

#[inline(always)]
fn has(set: &[u64], bit: usize) -> bool {
    set.get(bit / 64).is_some_and(|word| word & 1 << (bit % 64) != 0)
}

#[inline(always)]
fn set(set: &mut [u64], bit: usize) {
    if let Some(word) = set.get_mut(bit / 64) {
        *word |= 1 << (bit % 64);
    }
}

#[inline(always)]
fn take(set: &mut [u64], bit: usize) -> bool {
    let held = has(set, bit);
    if let Some(word) = set.get_mut(bit / 64) {
        *word &= !(1 << (bit % 64));
    }
    held
}
