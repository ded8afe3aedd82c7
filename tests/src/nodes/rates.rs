use apex_rt::prelude::*;

/// Sum of two tokens.
#[node]
pub fn pair_sum(x: &[i64; 2]) -> i64 {
    x.iter().sum()
}

/// Sum of three tokens.
#[node]
pub fn triple_sum(x: &[i64; 3]) -> i64 {
    x.iter().sum()
}

/// `10·x`, `10·x + 1`.
#[node]
pub fn split_in_two(x: &i64) -> [i64; 2] {
    [10 * x, 10 * x + 1]
}

/// Three equal values, written in place; none for odd values.
#[node]
pub fn triples(x: &i64, y: &mut Out<[i64; 3]>) {
    if x % 2 == 0 {
        y.set([*x; 3]);
    }
}

/// Two numbers per firing: 0 1, 2 3, …
#[node]
#[derive(Default)]
pub struct Pairs {
    next: i64,
}

#[node]
impl Pairs {
    fn process(&mut self) -> [i64; 2] {
        self.next += 2;
        [self.next - 2, self.next - 1]
    }
}
