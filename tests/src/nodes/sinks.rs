use apex_rt::prelude::*;

/// Records values.
#[node]
#[derive(Default)]
pub struct Snk {
    /// Received values.
    pub seen: Vec<i64>,
}

#[node]
impl Snk {
    fn process(&mut self, x: &i64) {
        self.seen.push(*x);
    }
}

/// Records pairs.
#[node]
#[derive(Default)]
pub struct Pair {
    /// Received pairs.
    pub seen: Vec<(i64, i64)>,
}

#[node]
impl Pair {
    fn process(&mut self, x: &i64, y: &i64) {
        self.seen.push((*x, *y));
    }
}

/// Records values and absent values.
#[node]
#[derive(Default)]
pub struct Essential {
    /// Received values; `None` is ⊥.
    pub seen: Vec<Option<i64>>,
}

#[node]
impl Essential {
    fn process(&mut self, x: Option<&i64>) {
        self.seen.push(x.copied());
    }
}

/// Records values and notifications of ⊥.
#[node]
#[derive(Default)]
pub struct Keen {
    /// Received values; `None` is ⊥.
    pub seen: Vec<Option<i64>>,
}

#[node]
impl Keen {
    fn process(&mut self, x: &i64) {
        self.seen.push(Some(*x));
    }
    #[no_message]
    fn nothing(&mut self) {
        self.seen.push(None);
    }
}
