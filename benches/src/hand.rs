//! The same work as straight-line Rust, written with knowledge of the whole graph: values in local variables, ⊥ as
//! control flow.

#[rustfmt::skip]
#[allow(clippy::all, clippy::pedantic, unused_assignments, unused_variables)]
pub(crate) mod mixed1000;

use crate::{
    frames::{Frame, FrameSink, Frames, tint},
    graphs::milliseconds,
    image::{Camera, Gray, Labels, blur, components, gray, threshold},
    nodes::{Count, Entered, OneOf, Pairs, Ping, Rows, Silent, Sink, Symbols, add, mix, numbered, op, sum},
};
use apex_rt::{Clock, Out, SimClock, Time, Timer};
use seq_macro::seq;
use std::hint::black_box;

macro_rules! chain {
    ($($name:ident: $source:ty, $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations in a row.")]
            #[inline(never)]
            pub fn $name(ticks: u64) -> u64 {
                let (mut source, mut sink) = (<$source>::default(), Sink::default());
                for _ in 0..ticks {
                    let x = source.process();
                    seq!(K in 1..=$n { let x = op(&x, K); });
                    sink.process(&x);
                }
                sink.checksum()
            }
        )*
    };
}

chain! {
    chain3: Count, 3;
    chain10: Count, 10;
    chain100: Count, 100;
    chain1000: Count, 1000;
}

/// 10 operations in a row, with the loop around a simulated clock.
#[inline(never)]
pub fn drive10(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Count::default(), Sink::default());
    let mut clock = SimClock::until(Time::from_millis(ticks as i64));
    loop {
        let now = clock.now();
        let x = source.process();
        seq!(K in 1..=10 { let x = op(&x, K); });
        sink.process(&x);
        if !clock.wait_until(now) {
            return sink.checksum();
        }
    }
}

macro_rules! silent {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations in a row that never get a message.")]
            #[inline(never)]
            pub fn $name(ticks: u64) -> u64 {
                let (mut source, mut sink) = (Silent::default(), Sink::default());
                for _ in 0..ticks {
                    if let Some(x) = source.process() {
                        seq!(K in 1..=$n { let x = op(&x, K); });
                        sink.process(&x);
                    }
                }
                sink.checksum()
            }
        )*
    };
}

silent! {
    silent10: 10;
    silent100: 100;
    silent1000: 1000;
}

/// 8 parallel operations.
#[inline(never)]
pub fn diamond8(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Count::default(), Sink::default());
    for _ in 0..ticks {
        let x = source.process();
        seq!(K in 1..=8 { sink.process(&(0_u64 #(.wrapping_add(op(&x, K)))*)); });
    }
    sink.checksum()
}

/// 64 parallel operations.
#[inline(never)]
pub fn diamond64(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Count::default(), Sink::default());
    for _ in 0..ticks {
        let x = source.process();
        seq!(K in 1..=64 { sink.process(&(0_u64 #(.wrapping_add(op(&x, K)))*)); });
    }
    sink.checksum()
}

/// A filter that passes 1 % of the values to 98 operations.
#[inline(never)]
pub fn bot100(ticks: u64) -> u64 {
    let (mut source, mut filter, mut sink) = (Count::default(), OneOf::new(100), Sink::default());
    for _ in 0..ticks {
        let x = op(&source.process(), 1);
        if let Some(x) = filter.process(&x) {
            seq!(K in 3..=100 { let x = op(&x, K); });
            sink.process(&x);
        }
    }
    sink.checksum()
}

/// The first of 8 filters that passes a value.
#[inline(never)]
pub fn merge8(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Count::default(), Sink::default());
    seq!(K in 2..10 { let mut filter~K = OneOf::new(K); });
    for _ in 0..ticks {
        let x = source.process();
        if let Some(x) = seq!(K in 2..10 { None #(.or(filter~K.process(&x)))* }) {
            sink.process(&x);
        }
    }
    sink.checksum()
}

/// A join of a filtered and a full branch.
#[inline(never)]
pub fn throttle(ticks: u64) -> u64 {
    let (mut source, mut filter, mut sink) = (Count::default(), OneOf::new(10), Sink::default());
    for _ in 0..ticks {
        let x = op(&source.process(), 1);
        let b = x;
        seq!(K in 10..=17 { let b = op(&b, K); });
        if let Some(a) = filter.process(&x) {
            sink.process(&add(&op(&a, 2), &b));
        }
    }
    sink.checksum()
}

/// Two tokens per firing meet three tokens per firing.
#[inline(never)]
pub fn rate23(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Pairs::default(), Sink::default());
    for _ in 0..ticks {
        let [a, b] = source.process();
        let [c, d] = source.process();
        let [e, f] = source.process();
        sink.process(&op(&mix(&[a, b, c]), 3));
        sink.process(&op(&mix(&[d, e, f]), 3));
    }
    sink.checksum()
}

/// Three operations for each of 1000 elements.
#[inline(never)]
pub fn nested1000(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Rows::default(), Sink::default());
    let (mut list, mut results) = (Out::new(), Vec::new());
    for _ in 0..ticks {
        source.process(&mut list);
        let Some(list) = list.get() else { continue };
        results.clear();
        results.extend(list.iter().map(|x| op(&op(&op(x, 1), 2), 3)));
        sink.process(&sum(&results));
    }
    sink.checksum()
}

/// Finds bright discs.
#[inline(never)]
pub fn image(ticks: u64) -> u64 {
    let (mut camera, mut sink, mut labels) = (Camera::default(), Sink::default(), Labels::default());
    let (mut brightness, mut blurred, mut mask) = (Gray::default(), Gray::default(), Gray::default());
    for _ in 0..ticks {
        gray(&camera.process(), &mut brightness);
        blur(&brightness, &mut blurred);
        threshold(&blurred, &mut mask);
        sink.process(&components(&mask, &mut labels));
    }
    sink.checksum()
}

/// A chain whose source has a period.
#[inline(never)]
pub fn timer10(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Count::default(), Sink::default());
    let mut timer = Timer::new(0, 1_000_000);
    for now in milliseconds(ticks) {
        while timer.is_due(now) {
            timer.advance();
            let x = source.process();
            seq!(K in 1..=10 { let x = op(&x, K); });
            sink.process(&x);
        }
    }
    sink.checksum()
}

/// Two sources with periods, and a join that waits for both.
#[inline(never)]
pub fn timers2(ticks: u64) -> u64 {
    let (mut left, mut right, mut sink) = (Count::default(), Count::default(), Sink::default());
    let mut timers = [1, 2].map(|ms| Timer::new(0, ms * 1_000_000));
    let (mut a, mut b) = (None, None);
    for now in milliseconds(ticks) {
        loop {
            if a.is_none() && timers[0].is_due(now) {
                timers[0].advance();
                a = Some(op(&left.process(), 1));
            }
            if b.is_none() && timers[1].is_due(now) {
                timers[1].advance();
                b = Some(op(&right.process(), 2));
            }
            let (Some(x), Some(y)) = (a, b) else { break };
            sink.process(&add(&x, &y));
            (a, b) = (None, None);
        }
    }
    sink.checksum()
}

/// Three sources with periods, and two joins in sequence. A source fires again only when its token has reached the end.
#[inline(never)]
pub fn timers3(ticks: u64) -> u64 {
    let mut sources: [Count; 3] = Default::default();
    let mut timers = [1, 2, 3].map(|ms| Timer::new(0, ms * 1_000_000));
    let mut tokens = [None; 3];
    let mut sink = Sink::default();
    for now in milliseconds(ticks) {
        loop {
            for (i, token) in tokens.iter_mut().enumerate() {
                if token.is_none() && timers[i].is_due(now) {
                    timers[i].advance();
                    *token = Some(op(&sources[i].process(), i as u64 + 1));
                }
            }
            let [Some(x), Some(y), Some(z)] = tokens else { break };
            sink.process(&add(&add(&x, &y), &z));
            tokens = [None; 3];
        }
    }
    sink.checksum()
}

/// Messages of 4 kB in local variables.
#[inline(never)]
pub fn frames_by_value(ticks: u64) -> u64 {
    let (mut source, mut sink) = (Frames::default(), FrameSink::default());
    for _ in 0..ticks {
        let frame = source.process();
        let frame = tint(&frame, 1);
        sink.process(&tint(&frame, 2));
    }
    sink.checksum()
}

/// Messages of 4 kB in three buffers.
#[inline(never)]
pub fn frames_in_place(ticks: u64) -> u64 {
    let mut sink = FrameSink::default();
    let mut buffers: [Frame; 3] = Default::default();
    for tick in 1..=ticks {
        let [first, second, third] = &mut buffers;
        first.fill(black_box(tick));
        second.tint_from(first, 1);
        third.tint_from(second, 2);
        sink.process(third);
    }
    sink.checksum()
}

/// A token that goes back and forth.
#[inline(never)]
pub fn pingpong(ticks: u64) -> u64 {
    let (mut a, mut x) = (Ping::default(), 0);
    for _ in 0..ticks {
        x = a.back(&op(&x, 1));
    }
    a.checksum()
}

/// Eight values per tick.
#[inline(never)]
pub fn mpse8(ticks: u64) -> u64 {
    let (mut source, mut acc) = (Count::default(), 0u64);
    for _ in 0..ticks {
        let i = source.process();
        let mut take = |p| acc = acc.wrapping_add(op(&numbered(&i, p), p + 1));
        seq!(P in 0..8 { take(P); });
        acc = black_box(acc);
    }
    acc
}

/// A ring of 16 states, by arithmetic.
#[inline(never)]
pub fn fsm16(ticks: u64) -> u64 {
    let (mut symbols, mut sink, mut state) = (Symbols::default(), Entered::default(), 0);
    sink.s(&1);
    for _ in 0..ticks {
        state = if symbols.is_reset() { 0 } else { (state + 1) % 16 };
        sink.s(&(state + 1));
    }
    sink.checksum()
}

seq!(N in 0..16 {
    #[derive(Clone, Copy)]
    enum Ring { #(S~N,)* }
});

/// A ring of 16 states, by a `match` over states.
#[inline(never)]
pub fn fsm16_match(ticks: u64) -> u64 {
    let (mut symbols, mut sink, mut state) = (Symbols::default(), Entered::default(), Ring::S0);
    sink.s(&1);
    for _ in 0..ticks {
        state = match state {
            _ if symbols.is_reset() => Ring::S0,
            Ring::S0 => Ring::S1,
            Ring::S1 => Ring::S2,
            Ring::S2 => Ring::S3,
            Ring::S3 => Ring::S4,
            Ring::S4 => Ring::S5,
            Ring::S5 => Ring::S6,
            Ring::S6 => Ring::S7,
            Ring::S7 => Ring::S8,
            Ring::S8 => Ring::S9,
            Ring::S9 => Ring::S10,
            Ring::S10 => Ring::S11,
            Ring::S11 => Ring::S12,
            Ring::S12 => Ring::S13,
            Ring::S13 => Ring::S14,
            Ring::S14 => Ring::S15,
            Ring::S15 => Ring::S0,
        };
        sink.s(&(state as u64 + 1));
    }
    sink.checksum()
}

/// Regions joined by events, node by node.
#[inline(never)]
pub fn mixed1000(ticks: u64) -> u64 {
    let (mut source, mut acc) = (Count::default(), 0);
    for _ in 0..ticks {
        acc = black_box(mixed1000::region0(source.process(), acc));
    }
    acc
}

/// Regions joined by events, ⊥ as control flow.
#[inline(never)]
pub fn mixed1000_clock(ticks: u64) -> u64 {
    let (mut source, mut acc) = (Count::default(), 0);
    for _ in 0..ticks {
        acc = black_box(mixed1000::clock0(source.process(), acc));
    }
    acc
}
