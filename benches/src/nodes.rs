//! The nodes of the graphs. Hand-written code calls the same functions, so that both have the same optimisation
//! barriers: only the source and the sink of a tick hide their values from the optimiser.

use apex_rt::prelude::*;
use std::hint::black_box;

/// 0, 1, 2, …
#[node]
#[derive(Default)]
pub struct Count {
    next: u64,
}

#[node]
impl Count {
    /// One number.
    pub fn process(&mut self) -> u64 {
        let t = black_box(self.next);
        self.next = t + 1;
        t
    }
}

/// A source that never has a message. The optimiser does not know this.
#[node]
#[derive(Default)]
pub struct Silent {}

#[node]
impl Silent {
    /// Sends ⊥.
    pub fn process(&mut self) -> Option<u64> {
        black_box(None)
    }
}

/// (3·x) xor k: two instructions that cannot be merged with those of another `op`.
#[node]
pub fn op(x: &u64, #[param] k: u64) -> u64 {
    x.wrapping_mul(3) ^ k
}

/// a + b.
#[node]
pub fn add(a: &u64, b: &u64) -> u64 {
    a.wrapping_add(*b)
}

/// Passes every `period`-th message, beginning with the first.
#[node]
#[derive(Default)]
pub struct OneOf {
    /// Number of messages in a period.
    #[param]
    period: u64,
    count: u64,
}

#[node]
impl OneOf {
    /// The node, for use without a graph.
    pub fn new(period: u64) -> Self {
        Self { period, count: 0 }
    }

    /// Sends `x` or ⊥.
    pub fn process(&mut self, x: &u64) -> Option<u64> {
        let passes = self.count == 0;
        self.count += 1;
        if self.count == self.period {
            self.count = 0;
        }
        passes.then_some(*x)
    }
}

/// Sum of any number of values.
#[node]
pub fn total<const N: usize>(values: [&u64; N]) -> u64 {
    values.into_iter().fold(0, |sum: u64, x| sum.wrapping_add(*x))
}

/// First of the values that is there.
#[node]
pub fn first<const N: usize>(values: [Option<&u64>; N]) -> Option<u64> {
    values.map(Option::<&u64>::copied).into_iter().fold(None, Option::or)
}

/// Two tokens per firing: `op` with 1 and with 2 of 0, 1, 2, …
#[node]
#[derive(Default)]
pub struct Pairs {
    count: Count,
}

#[node]
impl Pairs {
    /// Sends two tokens.
    pub fn process(&mut self) -> [u64; 2] {
        let n = self.count.process();
        [op(&n, 1), op(&n, 2)]
    }
}

/// Combines three tokens into one.
#[node]
pub fn mix(x: &[u64; 3]) -> u64 {
    x[0].wrapping_add(x[1].rotate_left(1)).wrapping_add(x[2].rotate_left(2))
}

/// 1000·t + i for all i below 1000.
#[node]
#[derive(Default)]
pub struct Rows {
    count: Count,
}

#[node]
impl Rows {
    /// Sends one list.
    pub fn process(&mut self, list: &mut Out<Vec<u64>>) {
        let first = self.count.process().wrapping_mul(1000);
        let list = list.get_mut();
        list.clear();
        list.extend((0..1000).map(|i| first.wrapping_add(i)));
    }
}

/// Sum of a list. The type of its port is that of `Rows` and `each`: a `Vec`.
#[node]
#[allow(clippy::ptr_arg)]
pub fn sum(list: &Vec<u64>) -> u64 {
    list.iter().fold(0, |sum, x| sum.wrapping_add(*x))
}

/// Folds all values into a checksum.
#[node]
#[derive(Default)]
pub struct Sink {
    acc: u64,
}

#[node]
impl Sink {
    /// Current checksum.
    pub fn checksum(&self) -> u64 {
        self.acc
    }

    /// acc ← rotl(acc, 5) xor x.
    pub fn process(&mut self, x: &u64) {
        self.acc = black_box(self.acc.rotate_left(5) ^ x);
    }
}

/// Node A of a ping-pong: folds each returned token into a checksum, and sends the next one.
#[node]
#[derive(Default)]
pub struct Ping {
    acc: u64,
}

#[node]
impl Ping {
    /// Current checksum.
    pub fn checksum(&self) -> u64 {
        self.acc
    }

    /// Takes a returned token and computes the next one. The optimisation barrier of a round trip is here; it costs
    /// nothing.
    #[inline]
    pub fn back(&mut self, y: &u64) -> u64 {
        self.acc = self.acc.rotate_left(5) ^ y;
        black_box(());
        op(y, 2)
    }

    /// Sends the first token.
    #[slot]
    pub fn begin(&mut self, e: Event<u64>) {
        e.emit(0);
    }

    /// Takes a token and sends the next one.
    #[slot]
    pub fn s(&mut self, y: &u64, e: Event<u64>) {
        e.emit(self.back(y));
    }
}

/// Node A of a ping-pong that sends one token per tick.
#[node]
#[derive(Default)]
pub struct Serve {
    ping: Ping,
    next: u64,
}

#[node]
impl Serve {
    /// Current checksum.
    pub fn checksum(&self) -> u64 {
        self.ping.checksum()
    }

    /// Sends the token.
    pub fn process(&mut self, e: Event<u64>) {
        e.emit(self.next);
    }

    /// Stores the token for the next tick.
    #[slot]
    pub fn s(&mut self, y: &u64) {
        self.next = self.ping.back(y);
    }
}

/// Node B of a ping-pong.
#[node]
#[derive(Default)]
pub struct Pong;

#[node]
impl Pong {
    /// Sends the token back.
    #[slot]
    pub fn s(&mut self, x: &u64, e: Event<u64>) {
        e.emit(op(x, 1));
    }
}

/// Passes on tokens without a value.
#[node]
#[derive(Default)]
pub struct Pass;

#[node]
impl Pass {
    /// Passes the token on.
    #[slot]
    pub fn put(&mut self, _token: &(), passed: Event<()>) {
        passed.emit(());
    }
}

/// Producer number `p`: sends an event for each number.
#[node]
pub fn produce(i: &u64, #[param] p: u64, e: Event<u64>) {
    e.emit(numbered(i, p));
}

/// The i-th value of producer `p`.
pub fn numbered(i: &u64, p: u64) -> u64 {
    (p << 32) | i
}

/// Sums the values at its eight slots. The last slot contains the optimisation barrier of a tick.
#[node]
#[derive(Default)]
pub struct Eight {
    acc: u64,
}

macro_rules! add_op {
    ($self:ident, $v:ident, $k:literal) => {
        $self.acc = $self.acc.wrapping_add(op($v, $k))
    };
}

#[node]
impl Eight {
    /// Current checksum.
    pub fn checksum(&self) -> u64 {
        self.acc
    }

    /// Value from producer 0.
    #[slot]
    pub fn s0(&mut self, v: &u64) {
        add_op!(self, v, 1);
    }

    /// Value from producer 1.
    #[slot]
    pub fn s1(&mut self, v: &u64) {
        add_op!(self, v, 2);
    }

    /// Value from producer 2.
    #[slot]
    pub fn s2(&mut self, v: &u64) {
        add_op!(self, v, 3);
    }

    /// Value from producer 3.
    #[slot]
    pub fn s3(&mut self, v: &u64) {
        add_op!(self, v, 4);
    }

    /// Value from producer 4.
    #[slot]
    pub fn s4(&mut self, v: &u64) {
        add_op!(self, v, 5);
    }

    /// Value from producer 5.
    #[slot]
    pub fn s5(&mut self, v: &u64) {
        add_op!(self, v, 6);
    }

    /// Value from producer 6.
    #[slot]
    pub fn s6(&mut self, v: &u64) {
        add_op!(self, v, 7);
    }

    /// Value from producer 7.
    #[slot]
    pub fn s7(&mut self, v: &u64) {
        add_op!(self, v, 8);
        self.acc = black_box(self.acc);
    }
}

/// Input of a state machine: every thousandth symbol is `reset`, all others are `next`. The optimiser does not know
/// which.
#[node]
#[derive(Default)]
pub struct Symbols {
    count: u64,
}

#[node]
impl Symbols {
    /// `true` if the next symbol is `reset`.
    #[inline]
    pub fn is_reset(&mut self) -> bool {
        self.count += 1;
        let last = self.count == 1000;
        if last {
            self.count = 0;
        }
        black_box(last)
    }

    /// Sends one symbol.
    pub fn process(&mut self, next: Event<()>, reset: Event<()>) {
        if self.is_reset() { reset.emit(()) } else { next.emit(()) }
    }
}

/// Folds the numbers of entered states into a checksum.
#[node]
#[derive(Default)]
pub struct Entered {
    acc: u64,
}

#[node]
impl Entered {
    /// Current checksum.
    pub fn checksum(&self) -> u64 {
        self.acc
    }

    /// acc ← rotl(acc, 5) xor s.
    #[slot]
    pub fn s(&mut self, s: &u64) {
        self.acc = self.acc.rotate_left(5) ^ s;
    }
}

/// A state of a ring: passes its activity to the next state at `next`, and to the first one at `reset`.
#[node]
#[derive(Default)]
pub struct State {
    /// Number to send when the state is entered.
    #[param]
    number: u64,
}

#[node]
impl State {
    /// Enters the state.
    #[slot]
    pub fn enter(&mut self, entered: Event<u64>) {
        entered.emit(self.number);
    }

    /// Leaves for the next state.
    #[slot]
    pub fn next(&mut self, ctx: &Ctx, left: Event<()>) {
        if ctx.active() {
            left.emit(());
        }
    }

    /// Leaves for the first state.
    #[slot]
    pub fn reset(&mut self, ctx: &Ctx, back: Event<()>) {
        if ctx.active() {
            back.emit(());
        }
    }
}

/// The first state of a ring. At `reset` it is entered again: a node cannot send an event to its own slot.
#[node]
#[derive(Default)]
pub struct First {
    /// Number to send when the state is entered.
    #[param]
    number: u64,
}

#[node]
impl First {
    /// Enters the state.
    #[slot]
    pub fn enter(&mut self, entered: Event<u64>) {
        entered.emit(self.number);
    }

    /// Leaves for the next state.
    #[slot]
    pub fn next(&mut self, ctx: &Ctx, left: Event<()>) {
        if ctx.active() {
            left.emit(());
        }
    }

    /// Enters the state again.
    #[slot]
    pub fn reset(&mut self, ctx: &Ctx, entered: Event<u64>) {
        if ctx.active() {
            entered.emit(self.number);
        }
    }
}

/// (a + rotl(b, 1)) xor k.
#[node]
pub fn merge(a: &u64, b: &u64, #[param] k: u64) -> u64 {
    a.wrapping_add(b.rotate_left(1)) ^ k
}

/// Passes three quarters of all messages.
#[node]
pub fn gate(x: &u64) -> Option<u64> {
    ((x >> 7) & 3 != 0).then_some(*x)
}

/// Passes every message.
#[node]
pub fn pass(x: &u64) -> u64 {
    *x
}

/// `op`, with an event of the same value.
#[node]
pub fn tell(x: &u64, #[param] k: u64, e: Event<u64>) -> u64 {
    let y = op(x, k);
    e.emit(y);
    y
}

/// Merges the events of several nodes.
#[node]
#[derive(Default)]
pub struct Relay;

#[node]
impl Relay {
    /// Passes the token on.
    #[slot]
    pub fn s(&mut self, x: &u64, e: Event<u64>) {
        e.emit(*x);
    }
}

/// acc + x·(2k + 1).
pub fn weigh(acc: u64, x: u64, k: u64) -> u64 {
    acc.wrapping_add(x.wrapping_mul(2 * k + 1))
}

/// Sum of all values, weighted by its number.
#[node]
#[derive(Default)]
pub struct Weigh {
    /// Number of the node.
    #[param]
    k: u64,
    acc: u64,
}

#[node]
impl Weigh {
    /// Current sum.
    pub fn sum(&self) -> u64 {
        self.acc
    }

    /// Adds `x`.
    pub fn process(&mut self, x: &u64) {
        self.acc = weigh(self.acc, *x, self.k);
    }
}
