use apex_rt::prelude::*;

/// Multiplies by `k`.
#[node]
pub fn mul(x: &i64, #[param] k: i64) -> i64 {
    x * k
}

/// Passes every value on.
#[node]
pub fn pass(x: &i64) -> i64 {
    *x
}

/// Sum.
#[node]
pub fn add(a: &i64, b: &i64) -> i64 {
    a + b
}

/// Product.
#[node]
pub fn product(a: &i64, b: &i64) -> i64 {
    a * b
}

/// Sum of five values.
#[node]
pub fn total_of_five(a: &i64, b: &i64, c: &i64, d: &i64, e: &i64) -> i64 {
    a + b + c + d + e
}

/// Sum of any number of values.
#[node]
pub fn total<const N: usize>(values: [&i64; N]) -> i64 {
    values.into_iter().sum()
}

/// Weights the values that are there by their positions, `i + 1`, and adds the number of inputs times 1000.
#[node]
pub fn weigh<const N: usize>(offset: &i64, values: [Option<&i64>; N]) -> i64 {
    let weighted = values.into_iter().enumerate().map(|(i, value)| (i as i64 + 1) * value.unwrap_or(&0));
    1000 * N as i64 + offset + weighted.sum::<i64>()
}

/// Adds up the largest values of its firings, and counts the firings at which a value is missing.
#[node]
#[derive(Default)]
pub struct Census {
    sum: i64,
    /// Number of firings without all values.
    pub incomplete: i64,
}

#[node]
impl Census {
    fn process<const N: usize>(&mut self, values: [&i64; N]) -> i64 {
        self.sum += values.into_iter().max().unwrap_or(&0);
        self.sum % 1009
    }

    #[no_message]
    fn missing(&mut self) {
        self.incomplete += 1;
    }
}

/// Passes even values.
#[node]
pub fn drop_odd(x: &i64) -> Option<i64> {
    (x % 2 == 0).then_some(*x)
}

/// Passes multiples of `of`.
#[node]
pub fn keep_multiples(x: &i64, #[param] of: i64) -> Option<i64> {
    (x % of == 0).then_some(*x)
}

/// `x` plus the value at `by`, or plus 100 without it.
#[node]
pub fn add_or(x: &i64, by: Option<&i64>) -> i64 {
    x + by.unwrap_or(&100)
}

/// Combines the present values: a node without a mandatory input.
#[node]
pub fn both_or(a: Option<&i64>, b: Option<&i64>) -> Option<i64> {
    match (a, b) {
        (None, None) => None,
        (a, b) => Some(a.unwrap_or(&0) + 10 * b.unwrap_or(&0)),
    }
}

/// Fails at `at`.
#[node]
pub fn fails_at(x: &i64, #[param] at: i64) -> Result<i64, String> {
    if *x == at { Err(format!("no {at}")) } else { Ok(*x) }
}

/// Passes multiples of 4, nothing for other even values, fails at odd ones.
#[node]
pub fn odd_fails(x: &i64) -> Result<Option<i64>, &'static str> {
    match x % 4 {
        0 => Ok(Some(*x)),
        2 => Ok(None),
        _ => Err("odd"),
    }
}

/// Two outputs, one of which gets the value.
#[derive(Outputs)]
pub struct Switch {
    /// Even values.
    pub even: Option<i64>,
    /// Odd values.
    pub odd: Option<i64>,
}

/// Sends even values to one output and odd ones to the other (thesis 3.6.1).
#[node]
pub fn switch(x: &i64) -> Switch {
    let even = x % 2 == 0;
    Switch { even: even.then_some(*x), odd: (!even).then_some(*x) }
}

/// [`switch`] for values below `limit`, nothing for others.
#[node]
pub fn switch_or_nothing(x: &i64, #[param] limit: i64) -> Option<Switch> {
    (*x < limit).then(|| switch(x))
}

/// [`switch_or_nothing`] that fails at multiples of 5.
#[node]
pub fn switch_checked(x: &i64, #[param] limit: i64) -> Result<Option<Switch>, String> {
    if x % 5 == 0 { Err(format!("{x} is a multiple of 5")) } else { Ok(switch_or_nothing(x, limit)) }
}

/// A value and its negative.
#[derive(Outputs)]
pub struct Signs {
    /// The value.
    pub plus: i64,
    /// Its negative, only for odd values.
    pub minus: Option<i64>,
}

/// The value, and for odd ones its negative.
#[node]
pub fn negate_odd(x: &i64) -> Signs {
    Signs { plus: *x, minus: (x % 2 != 0).then_some(-x) }
}

/// Twice the value, written in place; multiples of 3 are not sent.
#[node]
pub fn doubled_in_place(x: &i64, y: &mut Out<i64>) {
    if x % 3 != 0 {
        *y.get_mut() = 2 * x;
    }
}

/// Three times the value, written in place; fails at 2, after it has written.
#[node]
pub fn in_place_or_fails(x: &i64, y: &mut Out<i64>) -> Result<(), String> {
    y.set(3 * x);
    if *x == 2 { Err("no 2".to_owned()) } else { Ok(()) }
}

/// Two outputs written in place: multiples of 2, multiples of 3.
#[node]
pub fn split_buffered(x: &i64, twos: &mut Out<i64>, threes: &mut Out<i64>) {
    if x % 2 == 0 {
        twos.set(*x);
    }
    if x % 3 == 0 {
        threes.set(*x);
    }
}

/// A list of the value, written in place, and the value itself.
#[node]
pub fn listed(x: &i64, list: &mut Out<Vec<i64>>) -> i64 {
    let list = list.get_mut();
    list.clear();
    list.push(*x);
    *x
}

/// Current sum of all values, modulo 1009.
#[node]
#[derive(Default)]
pub struct Accumulate {
    sum: i64,
}

#[node]
impl Accumulate {
    fn process(&mut self, x: &i64) -> i64 {
        self.sum = (self.sum + x) % 1009;
        self.sum
    }
}

/// Passes a value that is larger than the previous one.
#[node]
#[derive(Default)]
pub struct Rise {
    last: Option<i64>,
}

#[node]
impl Rise {
    fn process(&mut self, x: &i64) -> Option<i64> {
        let before = self.last.replace(*x);
        before.is_none_or(|b| b < *x).then_some(*x)
    }
}

/// Passes every `n`th value (thesis 3.6.1).
#[node]
pub struct Throttle {
    /// Number of values of which one passes.
    #[param(range = 1..=1000)]
    n: i64,
    seen: i64,
}

#[node]
impl Throttle {
    fn process(&mut self, x: &i64) -> Option<i64> {
        self.seen += 1;
        (self.seen % self.n == 0).then_some(*x)
    }
}
