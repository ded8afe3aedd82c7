use apex_rt::prelude::*;

/// A type that differs from all others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Label(pub String);

/// Sends the first of two tokens.
#[node]
pub fn first_of<A: Clone, B>(a: &A, b: &B) -> A {
    let _ = b;
    a.clone()
}

/// Sends two tokens in reverse order.
#[node]
pub fn swap<A: Clone, B: Clone>(a: &A, b: &B, x: &mut Out<B>, y: &mut Out<A>) {
    x.set(b.clone());
    y.set(a.clone());
}

/// Sends the length of a list.
#[node]
pub fn len_of<T>(list: &Vec<T>) -> i64 {
    list.len() as i64
}

/// Sends a label for a number.
#[node]
pub fn keep(x: &i64) -> Label {
    Label(x.to_string())
}

/// Sends the last value; before the first, nothing.
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
    /// Received tokens.
    pub seen: Vec<T>,
}

#[node]
impl<T: Clone> Held<T> {
    fn process(&mut self, x: &T) {
        self.seen.push(x.clone());
    }
}
