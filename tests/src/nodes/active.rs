use apex_rt::prelude::*;

/// Sends numbers and events without end; its slot only takes activity.
#[node]
#[derive(Default)]
pub struct Starter {
    last: i64,
}

#[node]
impl Starter {
    fn process(&mut self, e: Event<i64>) -> i64 {
        self.last += 1;
        e.emit(self.last);
        self.last
    }
    #[slot]
    fn s(&mut self, _token: &i64) {}
}

/// Like `Src`, with a slot that only takes activity.
#[node]
pub struct Scripted {
    /// The script.
    #[param]
    values: &'static [i64],
    at: usize,
}

#[node]
impl Scripted {
    fn process(&mut self) -> Option<i64> {
        self.at += 1;
        self.values.get(self.at - 1).copied().filter(|v| *v >= 0)
    }
    #[slot]
    fn s(&mut self, _token: &i64) {}
}

/// Takes activity, and counts its activations and deactivations.
#[node]
#[derive(Default)]
pub struct Taker {
    /// Received tokens.
    pub seen: Vec<i64>,
    /// Number of activations.
    pub came: usize,
    /// Number of deactivations.
    pub went: usize,
}

#[node]
impl Taker {
    #[slot]
    fn s(&mut self, token: &i64) {
        self.seen.push(*token);
    }
    #[on_activate]
    fn came(&mut self) {
        self.came += 1;
    }
    #[on_deactivate]
    fn went(&mut self) {
        self.went += 1;
    }
}

/// Counts signals.
#[node]
#[derive(Default)]
pub struct Told {
    /// Number of signals.
    pub count: usize,
}

#[node]
impl Told {
    #[slot]
    fn s(&mut self) {
        self.count += 1;
    }
}

/// A state of a machine that was translated to activity: while it is active, each letter leads to another state.
#[node]
#[derive(Default)]
pub struct Phase {}

#[node]
impl Phase {
    #[slot]
    fn enter(&mut self) {}
    #[slot]
    fn a(&mut self, ctx: &Ctx, on_a: Event<()>) {
        if ctx.active() {
            on_a.emit(());
        }
    }
    #[slot]
    fn b(&mut self, ctx: &Ctx, on_b: Event<()>) {
        if ctx.active() {
            on_b.emit(());
        }
    }
    #[slot]
    fn c(&mut self, ctx: &Ctx, on_c: Event<()>) {
        if ctx.active() {
            on_c.emit(());
        }
    }
}
