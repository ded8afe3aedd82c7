use crate::Time;

/// Time of a program's next reaction.
///
/// ```
/// use apex_rt::prelude::*;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// let (mut blink, mut now) = (Blink::new(), Time::ZERO);
/// // A loop of your own. A robot would sleep until `time`.
/// while let Next::At(time) = blink.react(now)
///     && time <= Time::from_secs(1)
/// {
///     now = time;
/// }
/// assert_eq!(now, Time::from_secs(1));
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// At once: a source without a period is to fire again.
    Now,
    /// At this time, or when a token is put into a mailbox.
    At(Time),
    /// Only when a token is put into a mailbox.
    Input,
    /// Never: a token came to `exit` (0) or `abort` (1).
    Exit(u8),
}

impl Next {
    /// Returns the earlier of two times. An exit comes first.
    ///
    /// ```
    /// use apex_rt::prelude::*;
    ///
    /// let (early, late) = (Next::At(Time::from_secs(1)), Next::At(Time::from_secs(2)));
    /// assert_eq!([late.or(early), late.or(Next::Input), late.or(Next::Now)], [early, late, Next::Now]);
    /// ```
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Exit(code), _) | (_, Self::Exit(code)) => Self::Exit(code),
            (Self::Now, _) | (_, Self::Now) => Self::Now,
            (Self::At(a), Self::At(b)) => Self::At(if a < b { a } else { b }),
            (Self::At(t), Self::Input) | (Self::Input, Self::At(t)) => Self::At(t),
            (Self::Input, Self::Input) => Self::Input,
        }
    }

    /// Returns `true` for a time that is not after `time`.
    #[doc(hidden)]
    #[inline(always)]
    pub fn is_at_most(self, time: Time) -> bool {
        matches!(self, Self::At(at) if at <= time)
    }
}
