//! tokio: one task per node with channels of one element between them, all on one thread.

use crate::Ran;
use apex_bench::nodes::{Count, OneOf, Ping, Sink, add, numbered, op};
use std::hint::black_box;
use tokio::{
    runtime::Builder,
    spawn,
    sync::mpsc::{Receiver, Sender, channel},
};

/// A message, or ⊥, because the sink must be notified of every tick.
type Token = Option<u64>;

/// A task that converts each token.
fn node(mut from: Receiver<Token>, mut make: impl FnMut(u64) -> Token + Send + 'static) -> Receiver<Token> {
    let (to, output) = channel(1);
    spawn(async move {
        while let Some(token) = from.recv().await {
            if to.send(token.and_then(&mut make)).await.is_err() {
                break;
            }
        }
    });
    output
}

/// A chain of operations.
fn ops(from: Receiver<Token>, numbers: impl Iterator<Item = u64>) -> Receiver<Token> {
    numbers.fold(from, |from, k| node(from, move |x| Some(op(&x, k))))
}

/// Copies each token to several receivers.
fn tee(mut from: Receiver<Token>, count: usize) -> Vec<Receiver<Token>> {
    let (senders, receivers): (Vec<Sender<Token>>, Vec<_>) = (0..count).map(|_| channel(1)).unzip();
    spawn(async move {
        while let Some(token) = from.recv().await {
            for to in &senders {
                let _ = to.send(token).await;
            }
        }
    });
    receivers
}

/// Sum of one token from each receiver, or ⊥ if one of them is ⊥.
fn join(mut from: Vec<Receiver<Token>>) -> Receiver<Token> {
    let (to, output) = channel(1);
    spawn(async move {
        loop {
            let mut sum = Some(0);
            for input in &mut from {
                let Some(token) = input.recv().await else { return };
                sum = sum.zip(token).map(|(a, b)| add(&a, &b));
            }
            if to.send(sum).await.is_err() {
                return;
            }
        }
    });
    output
}

/// Runs `graph` in a runtime of one thread.
fn on_one_thread<T>(graph: impl Future<Output = T>) -> T {
    Builder::new_current_thread().build().expect("a runtime needs nothing").block_on(graph)
}

/// Runs source and sink, with the nodes of `graph` between them.
fn lockstep(ticks: u64, graph: impl FnOnce(Receiver<Token>) -> Receiver<Token>) -> Ran {
    on_one_thread(async {
        let (mut source, mut sink) = (Count::default(), Sink::default());
        let (to, input) = channel(1);
        let mut output = graph(input);
        let start = std::time::Instant::now();
        for _ in 0..ticks {
            let _ = to.send(Some(source.process())).await;
            if let Some(Some(x)) = output.recv().await {
                sink.process(&x);
            }
        }
        Ran { time: start.elapsed(), checksum: sink.checksum() }
    })
}

/// A chain of `N` operations.
pub fn chain<const N: u64>(ticks: u64) -> Ran {
    lockstep(ticks, |input| ops(input, 1..=N))
}

/// `N` parallel operations.
pub fn diamond<const N: usize>(ticks: u64) -> Ran {
    lockstep(ticks, |input| join((1..).zip(tee(input, N)).map(|(k, branch)| ops(branch, k..=k)).collect()))
}

/// A filter that passes 1 % of the values to 98 operations.
pub fn bot100(ticks: u64) -> Ran {
    let mut filter = OneOf::new(100);
    lockstep(ticks, |input| ops(node(ops(input, 1..=1), move |x| filter.process(&x)), 3..=100))
}

/// A join of a filtered and a full branch.
pub fn throttle(ticks: u64) -> Ran {
    let mut filter = OneOf::new(10);
    lockstep(ticks, |input| {
        let mut branches = tee(ops(input, 1..=1), 2);
        let full = ops(branches.remove(1), 10..=17);
        join(vec![ops(node(branches.remove(0), move |x| filter.process(&x)), 2..=2), full])
    })
}

/// A token that goes back and forth.
pub fn pingpong(ticks: u64) -> Ran {
    on_one_thread(async {
        let (to, input) = channel(1);
        let mut back = ops(input, 1..=1);
        let (mut a, mut x) = (Ping::default(), 0);
        let start = std::time::Instant::now();
        for _ in 0..ticks {
            let _ = to.send(Some(x)).await;
            if let Some(Some(y)) = back.recv().await {
                x = a.back(&y);
            }
        }
        Ran { time: start.elapsed(), checksum: a.checksum() }
    })
}

/// Eight values per tick.
pub fn mpse8(ticks: u64) -> Ran {
    on_one_thread(async {
        let (to, input) = channel(1);
        let (events, mut consumer) = channel(8);
        for (p, mut input) in (0..8).zip(tee(input, 8)) {
            let events = events.clone();
            spawn(async move {
                while let Some(Some(i)) = input.recv().await {
                    let _ = events.send((p + 1, numbered(&i, p))).await;
                }
            });
        }
        let (mut source, mut acc) = (Count::default(), 0u64);
        let start = std::time::Instant::now();
        for _ in 0..ticks {
            let _ = to.send(Some(source.process())).await;
            for _ in 0..8 {
                if let Some((k, v)) = consumer.recv().await {
                    acc = acc.wrapping_add(op(&v, k));
                }
            }
            acc = black_box(acc);
        }
        Ran { time: start.elapsed(), checksum: acc }
    })
}
