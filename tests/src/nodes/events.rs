use apex_rt::prelude::*;

/// Triggers its event with its values, one per firing, until the script ends. A negative value triggers nothing.
#[node]
pub struct Emit {
    /// The script.
    #[param]
    values: &'static [i64],
    at: usize,
}

#[node]
impl Emit {
    fn process(&mut self, e: Event<i64>) {
        self.at += 1;
        if let Some(value) = self.values.get(self.at - 1).filter(|v| **v >= 0) {
            e.emit(*value);
        }
    }
}

/// Triggers four events in one firing.
#[node]
pub fn four(a: Event<i64>, b: Event<i64>, c: Event<i64>, d: Event<i64>) {
    d.emit(4);
    c.emit(3);
    b.emit(2);
    a.emit(1);
}

/// Records the tokens at its slot.
#[node]
#[derive(Default)]
pub struct Take {
    /// Received tokens.
    pub seen: Vec<i64>,
}

#[node]
impl Take {
    #[slot]
    fn s(&mut self, token: &i64) {
        self.seen.push(*token);
    }
}

/// Passes the tokens at its slot on by an event.
#[node]
#[derive(Default)]
pub struct Pass {
    /// Received tokens.
    pub seen: Vec<i64>,
}

#[node]
impl Pass {
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        self.seen.push(*token);
        e.emit(*token);
    }
}

/// Passes the tokens at its slot on by an event while it is active, and stays active.
#[node]
#[derive(Default)]
pub struct PassActive;

#[node]
impl PassActive {
    #[slot]
    fn enter(&mut self) {}
    #[slot]
    fn s(&mut self, token: &i64, ctx: &Ctx, e: Event<i64>) {
        if ctx.active() {
            e.emit(*token);
        }
    }
}

/// Passes values on, and triggers an event with each.
#[node]
#[derive(Default)]
pub struct Tee;

#[node]
impl Tee {
    fn process(&mut self, x: &i64, e: Event<i64>) -> i64 {
        e.emit(*x);
        *x
    }
}

/// Passes values on, and records its activity.
#[node]
#[derive(Default)]
pub struct Watch {
    /// For each firing, `true` if the node was active.
    pub seen: Vec<bool>,
}

#[node]
impl Watch {
    fn process(&mut self, ctx: &Ctx, x: &i64) -> i64 {
        self.seen.push(ctx.active());
        *x
    }
}

/// Removes activity.
#[node]
#[deactivates]
#[derive(Default)]
pub struct Dampen;

#[node]
impl Dampen {
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        e.emit(*token);
    }
}

/// Triggers an event without a value for each token.
#[node]
#[derive(Default)]
pub struct Signal;

#[node]
impl Signal {
    #[slot]
    fn s(&mut self, _token: &i64, e: Event<()>) {
        e.emit(());
    }
}
