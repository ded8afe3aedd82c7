use apex_rt::prelude::*;

/// Sends lists, one per firing, then nothing.
#[node]
pub struct Lists {
    /// The script.
    #[param]
    lists: &'static [&'static [i64]],
    at: usize,
}

#[node]
impl Lists {
    fn process(&mut self) -> Option<Vec<i64>> {
        self.at += 1;
        self.lists.get(self.at - 1).map(|list| list.to_vec())
    }
}

/// `[0·x, 1·x, … (n−1)·x]`, written in place.
#[node]
pub struct Range {
    /// Length.
    #[param(default = 8)]
    n: i64,
}

#[node]
impl Range {
    fn process(&mut self, x: &i64, list: &mut Out<Vec<i64>>) {
        let list = list.get_mut();
        list.clear();
        list.extend((0..self.n).map(|j| j * x));
    }
}

/// Passes values below `limit`.
#[node]
pub fn below(x: &i64, limit: &i64) -> Option<i64> {
    (x < limit).then_some(*x)
}

/// `[0, … x/2]`.
#[node]
pub fn halves(x: &i64) -> Vec<i64> {
    (0..=x / 2).collect()
}

/// Sum of a list.
#[node]
pub fn list_sum(list: &Vec<i64>) -> i64 {
    list.iter().sum()
}

/// Outputs of [`parity`].
#[derive(Outputs)]
pub struct Parity {
    /// Half of an even value.
    pub half: Option<i64>,
    /// `true` if the value is odd.
    pub odd: bool,
}

/// Half of even values, and the parity of each value.
#[node]
pub fn parity(x: &i64) -> Parity {
    Parity { half: (x % 2 == 0).then_some(x / 2), odd: x % 2 != 0 }
}

/// Sends the number of its values, across all elements and iterations.
#[node]
#[derive(Default)]
pub struct Tally {
    count: i64,
}

#[node]
impl Tally {
    fn process(&mut self, x: &i64) -> i64 {
        let _ = x;
        self.count += 1;
        self.count
    }
}

/// Records lists.
#[node]
#[derive(Default)]
pub struct ListSink {
    /// Received lists.
    pub seen: Vec<Vec<i64>>,
}

#[node]
impl ListSink {
    fn process(&mut self, x: &Vec<i64>) {
        self.seen.push(x.clone());
    }
}

/// Records lists of lists.
#[node]
#[derive(Default)]
pub struct PairSink {
    /// Received lists.
    pub seen: Vec<Vec<Vec<i64>>>,
}

#[node]
impl PairSink {
    fn process(&mut self, x: &Vec<Vec<i64>>) {
        self.seen.push(x.clone());
    }
}

/// `k` times a value: a struct without state, which writes in place.
#[node]
pub struct Times {
    /// The factor.
    #[param]
    k: i64,
}

#[node]
impl Times {
    fn process(&mut self, x: &i64, y: &mut Out<i64>) {
        y.set(x * self.k);
    }
}

/// `[0·x, … (n−1)·x]`, written in place by a function.
#[node]
pub fn multiples(x: &i64, list: &mut Out<Vec<i64>>, #[param] n: i64) {
    let list = list.get_mut();
    list.clear();
    list.extend((0..n).map(|j| j * x));
}
