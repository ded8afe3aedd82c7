//! Libraries that pass values between threads: two regions that run independently.

use crate::{Ran, timed};
use apex_bench::tworegion::{Region, Value};
use crossbeam_queue::ArrayQueue;
use std::{
    sync::{Arc, Barrier},
    thread,
};

/// Ticks of a region, which reads the latest value if there is a new one, and publishes its own.
fn run(ticks: u64, mut read: impl FnMut(&mut Value), mut publish: impl FnMut(Value)) -> u64 {
    let (mut region, mut other) = (Region::default(), Value::default());
    for _ in 0..ticks {
        read(&mut other);
        publish(region.tick(&other));
    }
    region.torn()
}

/// Runs one region on a new thread and the other on this one.
fn together(theirs: impl FnOnce() -> u64 + Send, ours: impl FnOnce() -> u64) -> Ran {
    let start = Barrier::new(2);
    thread::scope(|scope| {
        let other = scope.spawn(|| {
            start.wait();
            theirs()
        });
        start.wait();
        let mut torn = 0;
        let time = timed(|| torn = ours() + other.join().expect("a region does not panic"));
        Ran { time, checksum: torn }
    })
}

/// One triple buffer for each direction.
pub fn triple_buffer(ticks: u64) -> Ran {
    let (mut to_left, mut from_right) = triple_buffer::triple_buffer(&Value::default());
    let (mut to_right, mut from_left) = triple_buffer::triple_buffer(&Value::default());
    together(
        move || run(ticks, |other| *other = *from_right.read(), |value| to_right.write(value)),
        move || run(ticks, |other| *other = *from_left.read(), |value| to_left.write(value)),
    )
}

/// A queue of one element for each direction.
pub fn array_queue(ticks: u64) -> Ran {
    let queue = || Arc::new(ArrayQueue::<Value>::new(1));
    let (left, right) = (queue(), queue());
    let region = |from: Arc<ArrayQueue<Value>>, to: Arc<ArrayQueue<Value>>| {
        move || {
            let read = |other: &mut Value| {
                if let Some(value) = from.pop() {
                    *other = value;
                }
            };
            run(ticks, read, |value| _ = to.force_push(value))
        }
    };
    together(region(left.clone(), right.clone()), region(right, left))
}
