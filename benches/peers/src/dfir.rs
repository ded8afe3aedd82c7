//! dfir_rs: a graph language compiled by a macro. A tick of the graph is a tick of the flow.

use crate::{Ran, timed};
use apex_bench::nodes::{Count, OneOf, Pairs, Ping, Rows, Sink, add, mix, numbered, op};
use dfir_rs::dfir_syntax;
use seq_macro::seq;
use std::{cell::RefCell, hint::black_box, rc::Rc};

/// State shared between a flow and its caller.
fn shared<T: Default>() -> (Rc<RefCell<T>>, Rc<RefCell<T>>) {
    let shared = Rc::<RefCell<T>>::default();
    (shared.clone(), shared)
}

/// Runs one tick of the flow per tick; the checksum is that of the sink.
macro_rules! ticks {
    ($flow:ident, $ticks:ident, $sink:ident) => {{
        let time = timed(|| {
            for _ in 0..$ticks {
                $flow.run_tick_sync();
            }
        });
        Ran { time, checksum: $sink.borrow().checksum() }
    }};
}

macro_rules! chain {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations in a row.")]
            pub fn $name(ticks: u64) -> Ran {
                let mut source = Count::default();
                let (inner, sink) = shared::<Sink>();
                seq!(K in 1..=$n {
                    let mut flow = dfir_syntax! {
                        spin() -> map(|()| source.process()) #(-> map(|x: u64| op(&x, K)))*
                            -> for_each(|x: u64| inner.borrow_mut().process(&x));
                    };
                });
                ticks!(flow, ticks, sink)
            }
        )*
    };
}

chain! {
    chain3: 3;
    chain10: 10;
    chain100: 100;
}

macro_rules! batch {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations in a row, all ticks in one.")]
            pub fn $name(ticks: u64) -> Ran {
                let mut source = Count::default();
                let (inner, sink) = shared::<Sink>();
                seq!(K in 1..=$n {
                    let mut flow = dfir_syntax! {
                        source_iter(0..ticks) -> map(|_| source.process()) #(-> map(|x: u64| op(&x, K)))*
                            -> for_each(|x: u64| inner.borrow_mut().process(&x));
                    };
                });
                let time = timed(|| flow.run_available_sync());
                Ran { time, checksum: sink.borrow().checksum() }
            }
        )*
    };
}

batch! {
    chain3_batch: 3;
    chain10_batch: 10;
    chain100_batch: 100;
}

macro_rules! diamond {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations side by side.")]
            pub fn $name(ticks: u64) -> Ran {
                let mut source = Count::default();
                let (inner, sink) = shared::<Sink>();
                seq!(K in 1..=$n {
                    let mut flow = dfir_syntax! {
                        all = spin() -> map(|()| source.process()) -> tee();
                        #(all -> map(|x: u64| op(&x, K)) -> sum;)*
                        sum = union() -> fold::<'tick>(|| 0, |sum: &mut u64, x: u64| *sum = sum.wrapping_add(x))
                            -> for_each(|x: u64| inner.borrow_mut().process(&x));
                    };
                });
                ticks!(flow, ticks, sink)
            }
        )*
    };
}

diamond! {
    diamond8: 8;
    diamond64: 64;
}

/// A filter that passes 1 % of the values to 98 operations.
pub fn bot100(ticks: u64) -> Ran {
    let (mut source, mut filter) = (Count::default(), OneOf::new(100));
    let (inner, sink) = shared::<Sink>();
    seq!(K in 3..=100 {
        let mut flow = dfir_syntax! {
            spin() -> map(|()| source.process()) -> map(|x: u64| op(&x, 1)) -> filter_map(|x: u64| filter.process(&x))
                #(-> map(|x: u64| op(&x, K)))*
                -> for_each(|x: u64| inner.borrow_mut().process(&x));
        };
    });
    ticks!(flow, ticks, sink)
}

/// A join of a filtered and a full branch.
pub fn throttle(ticks: u64) -> Ran {
    let (mut source, mut filter) = (Count::default(), OneOf::new(10));
    let (inner, sink) = shared::<Sink>();
    seq!(K in 10..=17 {
        let mut flow = dfir_syntax! {
            a = spin() -> map(|()| source.process()) -> map(|x: u64| op(&x, 1)) -> tee();
            a -> filter_map(|x: u64| filter.process(&x)) -> map(|x: u64| op(&x, 2)) -> [0]join;
            a #(-> map(|x: u64| op(&x, K)))* -> [1]join;
            join = zip::<'tick>() -> for_each(|(a, b): (u64, u64)| inner.borrow_mut().process(&add(&a, &b)));
        };
    });
    ticks!(flow, ticks, sink)
}

/// Two tokens per firing meet three tokens per firing.
pub fn rate23(ticks: u64) -> Ran {
    let mut source = Pairs::default();
    let (inner, sink) = shared::<Sink>();
    let mut waiting = (0, [0; 3]);
    let mut flow = dfir_syntax! {
        spin() -> flat_map(|()| [(); 3]) -> flat_map(|()| source.process())
            -> filter_map(|x: u64| {
                let (count, tokens) = &mut waiting;
                tokens[*count] = x;
                *count = (*count + 1) % 3;
                (*count == 0).then_some(*tokens)
            })
            -> map(|x: [u64; 3]| mix(&x)) -> map(|x: u64| op(&x, 3))
            -> for_each(|x: u64| inner.borrow_mut().process(&x));
    };
    ticks!(flow, ticks, sink)
}

/// Three operations for each of 1000 elements.
pub fn nested1000(ticks: u64) -> Ran {
    let (mut source, mut list) = (Rows::default(), apex_rt::Out::new());
    let (inner, sink) = shared::<Sink>();
    let mut flow = dfir_syntax! {
        spin() -> flat_map(|()| {
                source.process(&mut list);
                list.get().cloned().unwrap_or_default()
            })
            -> map(|x: u64| op(&x, 1)) -> map(|x: u64| op(&x, 2)) -> map(|x: u64| op(&x, 3))
            -> fold::<'tick>(|| 0, |sum: &mut u64, x: u64| *sum = sum.wrapping_add(x))
            -> for_each(|x: u64| inner.borrow_mut().process(&x));
    };
    ticks!(flow, ticks, sink)
}

/// A token that goes back and forth: to B in a tick and back to A, whose next token is sent in the next tick.
pub fn pingpong(ticks: u64) -> Ran {
    let (inner, a) = shared::<Ping>();
    let mut flow = dfir_syntax! {
        source_iter([0]) -> x;
        x = union() -> map(|x: u64| op(&x, 1)) -> map(|y: u64| inner.borrow_mut().back(&y)) -> defer_tick() -> x;
    };
    ticks!(flow, ticks, a)
}

/// Sum of all values.
#[derive(Default)]
struct Sum {
    acc: u64,
}

impl Sum {
    fn checksum(&self) -> u64 {
        self.acc
    }
}

/// Value that producer `p` sends, and the number of its operation.
fn event(i: u64, p: u64) -> (u64, u64) {
    (p + 1, numbered(&i, p))
}

/// Eight values per tick.
pub fn mpse8(ticks: u64) -> Ran {
    let mut source = Count::default();
    let (inner, sum) = shared::<Sum>();
    seq!(P in 0..8 {
        let mut flow = dfir_syntax! {
            all = spin() -> map(|()| source.process()) -> tee();
            #(all -> map(|i: u64| event(i, P)) -> consumer;)*
            consumer = union() -> for_each(|(k, v): (u64, u64)| {
                let mut sum = inner.borrow_mut();
                sum.acc = black_box(sum.acc.wrapping_add(op(&v, k)));
            });
        };
    });
    ticks!(flow, ticks, sum)
}
