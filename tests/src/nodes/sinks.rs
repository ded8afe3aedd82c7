use apex_rt::prelude::*;

/// Records values.
#[node]
#[derive(Default)]
pub struct Snk {
    /// What came.
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
    /// What came.
    pub seen: Vec<(i64, i64)>,
}

#[node]
impl Pair {
    fn process(&mut self, x: &i64, y: &i64) {
        self.seen.push((*x, *y));
    }
}

/// Records values and the lack of one.
#[node]
#[derive(Default)]
pub struct Essential {
    /// What came; `None` is ⊥.
    pub seen: Vec<Option<i64>>,
}

#[node]
impl Essential {
    fn process(&mut self, x: Option<&i64>) {
        self.seen.push(x.copied());
    }
}

/// Records values, and counts how often there was none.
#[node]
#[derive(Default)]
pub struct Keen {
    /// What came; `None` is ⊥.
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
