#[cfg(feature = "std")]
use crate::end::is_asked;
use crate::{Clock, Time};

/// Environment of a running program besides its clock. `()` is an empty one.
pub(crate) trait Outside<P> {
    /// Moves tokens into the program and out of it. Returns `true` if there were any.
    fn exchange(&mut self, program: &mut P) -> bool;

    /// Serves requests for the program's parameters.
    fn serve(&mut self, program: &mut P);

    /// Returns `true` if a program that only waits for input may still get some.
    fn is_open(&self) -> bool;

    /// Waits until `until`, forever if that is `None`, or until there are tokens to be moved. Returns `false` if the
    /// clock ends before.
    fn wait<C: Clock>(&mut self, clock: &mut C, until: Option<Time>) -> bool;
}

impl<P> Outside<P> for () {
    #[inline]
    fn exchange(&mut self, _program: &mut P) -> bool {
        false
    }

    #[inline]
    fn serve(&mut self, _program: &mut P) {}

    #[inline]
    fn is_open(&self) -> bool {
        false
    }

    #[inline]
    fn wait<C: Clock>(&mut self, clock: &mut C, until: Option<Time>) -> bool {
        #[cfg(feature = "std")]
        return clock.wait(until, &is_asked);
        #[cfg(not(feature = "std"))]
        until.is_some_and(|time| clock.wait_until(time))
    }
}
