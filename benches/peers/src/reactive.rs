//! rxrust: operators on streams that a subject pushes values into.

use crate::{Ran, timed};
use apex_bench::nodes::{Count, OneOf, Pairs, Rows, Sink, add, mix, numbered, op, sum};
use rxrust::prelude::*;
use seq_macro::seq;
use std::{cell::RefCell, hint::black_box, rc::Rc};

/// Sends one value per tick into a stream.
fn counted<O: Observer<Item = u64>>(ticks: u64, mut subject: O, sink: &RefCell<Sink>) -> Ran {
    let mut source = Count::default();
    let time = timed(|| {
        for _ in 0..ticks {
            subject.next(source.process());
        }
    });
    Ran { time, checksum: sink.borrow().checksum() }
}

macro_rules! chain {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations in a row.")]
            pub fn $name(ticks: u64) -> Ran {
                let (subject, sink) = (LocalSubject::new(), Rc::<RefCell<Sink>>::default());
                let inner = sink.clone();
                seq!(K in 1..=$n {
                    subject.clone()#(.map(|x: u64| op(&x, K)))*.subscribe(move |x: u64| inner.borrow_mut().process(&x));
                });
                counted(ticks, subject, &sink)
            }
        )*
    };
}

chain! {
    chain3: 3;
    chain10: 10;
    chain100: 100;
}

macro_rules! diamond {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations side by side.")]
            pub fn $name(ticks: u64) -> Ran {
                let (subject, sink) = (LocalSubject::new(), Rc::<RefCell<Sink>>::default());
                let inner = sink.clone();
                seq!(K in 2..=$n {
                    subject.clone().map(|x: u64| op(&x, 1))#(.merge(subject.clone().map(|x: u64| op(&x, K))))*
                        .buffer_with_count($n).map(|all: Vec<u64>| sum(&all))
                        .subscribe(move |x: u64| inner.borrow_mut().process(&x));
                });
                counted(ticks, subject, &sink)
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
    let (subject, sink) = (LocalSubject::new(), Rc::<RefCell<Sink>>::default());
    let (inner, mut filter) = (sink.clone(), OneOf::new(100));
    seq!(K in 3..=100 {
        subject.clone().map(|x: u64| op(&x, 1)).filter_map(move |x: u64| filter.process(&x))
            #(.map(|x: u64| op(&x, K)))*
            .subscribe(move |x: u64| inner.borrow_mut().process(&x));
    });
    counted(ticks, subject, &sink)
}

/// A join of a filtered and a full branch. `zip` pairs values by their order, so ⊥ is a value here.
pub fn throttle(ticks: u64) -> Ran {
    let (subject, sink) = (LocalSubject::new(), Rc::<RefCell<Sink>>::default());
    let (inner, filter) = (sink.clone(), RefCell::new(OneOf::new(10)));
    let thinned =
        subject.clone().map(|x: u64| op(&x, 1)).map(move |x: u64| filter.borrow_mut().process(&x).map(|x| op(&x, 2)));
    seq!(K in 10..=17 {
        let full = subject.clone().map(|x: u64| op(&x, 1))#(.map(|x: u64| op(&x, K)))*;
    });
    thinned
        .zip(full)
        .filter_map(|(a, b): (Option<u64>, u64)| a.map(|a| add(&a, &b)))
        .subscribe(move |x: u64| inner.borrow_mut().process(&x));
    counted(ticks, subject, &sink)
}

/// Two tokens per firing meet three tokens per firing.
pub fn rate23(ticks: u64) -> Ran {
    let (mut subject, sink) = (LocalSubject::new(), Rc::<RefCell<Sink>>::default());
    let (inner, mut source) = (sink.clone(), Pairs::default());
    subject
        .clone()
        .buffer_with_count(3)
        .map(|x: Vec<u64>| mix(&[x[0], x[1], x[2]]))
        .map(|x: u64| op(&x, 3))
        .subscribe(move |x: u64| inner.borrow_mut().process(&x));
    let time = timed(|| {
        for _ in 0..3 * ticks {
            for x in source.process() {
                subject.next(x);
            }
        }
    });
    let checksum = sink.borrow().checksum();
    Ran { time, checksum }
}

/// Three operations for each of 1000 elements.
pub fn nested1000(ticks: u64) -> Ran {
    let (mut subject, sink) = (LocalSubject::new(), Rc::<RefCell<Sink>>::default());
    let (inner, mut source, mut list) = (sink.clone(), Rows::default(), apex_rt::Out::<Vec<u64>>::new());
    subject
        .clone()
        .map(|x: u64| op(&x, 1))
        .map(|x: u64| op(&x, 2))
        .map(|x: u64| op(&x, 3))
        .buffer_with_count(1000)
        .map(|all: Vec<u64>| sum(&all))
        .subscribe(move |x: u64| inner.borrow_mut().process(&x));
    let time = timed(|| {
        for _ in 0..ticks {
            source.process(&mut list);
            for x in list.get().into_iter().flatten() {
                subject.next(*x);
            }
        }
    });
    let checksum = sink.borrow().checksum();
    Ran { time, checksum }
}

/// Eight values per tick.
pub fn mpse8(ticks: u64) -> Ran {
    let (mut subject, sum) = (LocalSubject::new(), Rc::new(RefCell::new(0u64)));
    let (inner, mut source) = (sum.clone(), Count::default());
    let producer = |p: u64| subject.clone().map(move |i: u64| (p + 1, numbered(&i, p)));
    seq!(P in 1..8 {
        producer(0)#(.merge(producer(P)))*.subscribe(move |(k, v): (u64, u64)| {
            let mut sum = inner.borrow_mut();
            *sum = black_box(sum.wrapping_add(op(&v, k)));
        });
    });
    let time = timed(|| {
        for _ in 0..ticks {
            subject.next(source.process());
        }
    });
    let checksum = *sum.borrow();
    Ran { time, checksum }
}
