use apex_rt::{Failure, prelude::*};

/// Triggers one of its events per firing, according to its script: 1 is `a`, 2 is `b`, 3 is `c`, others are none.
#[node]
pub struct Buttons {
    /// The script.
    #[param]
    script: &'static [i64],
    at: usize,
}

#[node]
impl Buttons {
    fn process(&mut self, a: Event<()>, b: Event<()>, c: Event<()>) {
        self.at += 1;
        match self.script.get(self.at - 1) {
            Some(1) => a.emit(()),
            Some(2) => b.emit(()),
            Some(3) => c.emit(()),
            _ => {}
        }
    }
}

/// Records messages about failures.
#[node]
#[derive(Default)]
pub struct Notes {
    /// Received messages.
    pub seen: Vec<String>,
}

#[node]
impl Notes {
    #[slot]
    fn s(&mut self, failure: &Failure) {
        self.seen.push(failure.to_string());
    }
}

/// Counts its values, and panics at `at`.
#[node]
pub struct Shaky {
    /// Number at which it panics.
    #[param]
    at: i64,
    count: i64,
}

#[node]
impl Shaky {
    fn process(&mut self, x: &i64) -> i64 {
        self.count += 1;
        assert_ne!(*x, self.at, "not this one");
        self.count
    }
    #[slot]
    fn s(&mut self, token: &i64) {
        self.count += 10;
        assert_ne!(*token, self.at, "nor here");
    }
}

/// Fails at odd tokens.
#[node]
#[derive(Default)]
pub struct OddSlot {
    /// Received even tokens.
    pub seen: Vec<i64>,
}

#[node]
impl OddSlot {
    #[slot]
    fn s(&mut self, token: &i64) -> Result<(), String> {
        if token % 2 != 0 {
            return Err(format!("{token} is odd"));
        }
        self.seen.push(*token);
        Ok(())
    }
}

/// Records tokens with their ports.
#[node]
#[derive(Default)]
pub struct Both {
    /// `p` for `process`, `s` for the slot.
    pub seen: Vec<(char, i64)>,
}

#[node]
impl Both {
    fn process(&mut self, x: &i64) {
        self.seen.push(('p', *x));
    }
    #[slot]
    fn s(&mut self, token: &i64) {
        self.seen.push(('s', *token));
    }
}

/// Triggers two events in one firing, with a number and its negative.
#[node]
#[derive(Default)]
pub struct Twins {
    last: i64,
}

#[node]
impl Twins {
    fn process(&mut self, a: Event<i64>, b: Event<i64>) {
        self.last += 1;
        a.emit(self.last);
        b.emit(-self.last);
    }
}

/// Triggers an event from `process` and from a slot.
#[node]
#[derive(Default)]
pub struct Echo;

#[node]
impl Echo {
    fn process(&mut self, x: &i64, e: Event<i64>) {
        e.emit(*x);
    }
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        e.emit(100 + token);
    }
}

/// A slot that takes some time on the wall clock.
#[node]
#[derive(Default)]
pub struct Slow {
    /// Received tokens.
    pub seen: Vec<i64>,
}

#[node]
impl Slow {
    #[slot]
    fn s(&mut self, token: &i64) {
        std::thread::sleep(std::time::Duration::from_millis(4));
        self.seen.push(*token);
    }
}

/// Records the times of its firings.
#[node]
#[derive(Default)]
pub struct Stamps {
    /// Times of the firings.
    pub seen: Vec<Time>,
}

#[node]
impl Stamps {
    fn process(&mut self, ctx: &Ctx) {
        self.seen.push(ctx.now());
    }
}

/// Records its events `late`, and the ages of its tokens.
#[node]
#[derive(Default)]
pub struct Ages {
    /// Times of the slot calls.
    pub late: Vec<Time>,
    /// Ages of the tokens at the input, in ms.
    pub ages: Vec<u128>,
}

#[node]
impl Ages {
    fn process(&mut self, x: &i64, y: &i64, ctx: &Ctx) {
        let _ = (x, y);
        self.ages.push(ctx.now().since(ctx.stamp()).as_millis());
    }
    #[slot]
    fn late(&mut self, ctx: &Ctx) {
        self.late.push(ctx.now());
    }
}
