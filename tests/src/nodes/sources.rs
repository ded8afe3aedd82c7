use apex_rt::prelude::*;

/// Sends its values, one per firing, then nothing. A negative value is ⊥.
#[node]
pub struct Src {
    /// The script.
    #[param]
    values: &'static [i64],
    at: usize,
}

#[node]
impl Src {
    fn process(&mut self) -> Option<i64> {
        self.at += 1;
        self.values.get(self.at - 1).copied().filter(|v| *v >= 0)
    }
}

/// Sends 0, 1, 2, … below `end`.
#[node]
pub struct Count {
    /// The first number that is not sent.
    #[param(default = 1_000_000_000)]
    end: i64,
    next: i64,
}

#[node]
impl Count {
    fn process(&mut self) -> Option<i64> {
        self.next += 1;
        Some(self.next - 1).filter(|v| *v < self.end)
    }
}

/// Sends 1, 2, 3, … without end: an output that is never ⊥.
#[node]
#[derive(Default)]
pub struct OneBased {
    last: i64,
}

#[node]
impl OneBased {
    fn process(&mut self) -> i64 {
        self.last += 1;
        self.last
    }
}

/// Sends only ⊥.
#[node]
pub fn silent() -> Option<i64> {
    None
}
