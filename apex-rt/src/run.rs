use crate::{Clock, Info, Observer, Time};

/// When a program wants to be called again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// At once: it has a source that sets no pace of its own.
    Now,
    /// At this time, or when a token is put into a mailbox.
    At(Time),
    /// Only when a token is put into a mailbox.
    Input,
}

impl Next {
    /// The earlier of two wishes.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Now, _) | (_, Self::Now) => Self::Now,
            (Self::At(a), Self::At(b)) => Self::At(if a < b { a } else { b }),
            (Self::At(t), Self::Input) | (Self::Input, Self::At(t)) => Self::At(t),
            (Self::Input, Self::Input) => Self::Input,
        }
    }
}

/// A compiled graph: what `graph!` makes a struct for.
pub trait Program {
    /// Its static description.
    const INFO: Info;

    /// Reacts at `now`: runs until nothing is ready, and says when it wants to be called next.
    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next;
}

impl<P: Program> Program for &mut P {
    const INFO: Info = P::INFO;

    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next {
        (**self).react_with(now, observer)
    }
}

/// Drives `program` by `clock` until nothing can happen any more: no source is left to fire, or the clock ends.
pub fn run<P: Program, C: Clock>(mut program: P, mut clock: C) {
    #[cfg(feature = "std")]
    let mut observer = crate::StdErr(const { &P::INFO });
    #[cfg(not(feature = "std"))]
    let mut observer = ();
    loop {
        let now = clock.now();
        let wake = match program.react_with(now, &mut observer) {
            Next::Now => now,
            Next::At(time) => time,
            Next::Input => return,
        };
        if !clock.wait_until(wake) {
            return;
        }
    }
}
