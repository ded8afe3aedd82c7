use apex_rt::prelude::*;

/// A type of its own, so that a token of another type shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Label(pub String);

/// The first of two.
#[node]
pub fn first_of<A: Clone, B>(a: &A, b: &B) -> A {
    let _ = b;
    a.clone()
}

/// Both, the other way round.
#[node]
pub fn swap<A: Clone, B: Clone>(a: &A, b: &B, x: &mut Out<B>, y: &mut Out<A>) {
    x.set(b.clone());
    y.set(a.clone());
}

/// How many.
#[node]
pub fn len_of<T>(list: &Vec<T>) -> i64 {
    list.len() as i64
}

/// A label for a number.
#[node]
pub fn keep(x: &i64) -> Label {
    Label(x.to_string())
}

/// Sends the value that came last; before the first, nothing.
#[node]
#[derive(Default)]
pub struct Latch<T> {
    last: Option<T>,
}

#[node]
impl<T: Clone> Latch<T> {
    fn process(&mut self, x: Option<&T>) -> Option<T> {
        if let Some(x) = x {
            self.last = Some(x.clone());
        }
        self.last.clone()
    }
}

/// Records tokens of any type.
#[node]
#[derive(Default)]
pub struct Held<T> {
    /// What came.
    pub seen: Vec<T>,
}

#[node]
impl<T: Clone> Held<T> {
    fn process(&mut self, x: &T) {
        self.seen.push(x.clone());
    }
}
