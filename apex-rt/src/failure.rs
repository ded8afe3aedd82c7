//! Failures of nodes: they end the firing, not the program.

use core::fmt::{self, Display, Write};

/// The failure of a node: the text of its error or of its panic, cut to [`Failure::ROOM`] bytes.
///
/// ```
/// use apex_rt::prelude::*;
///
/// /// Shows why a node failed: `printer.failed -> screen.show`.
/// #[node]
/// #[derive(Default)]
/// struct Screen {
///     line: String,
/// }
///
/// #[node]
/// impl Screen {
///     #[slot]
///     fn show(&mut self, failure: &Failure) {
///         self.line = format!("error: {failure}");
///     }
/// }
///
/// let mut screen = Screen::default();
/// screen.show(&Failure::new(&"no more paper"));
/// assert_eq!(screen.line, "error: no more paper");
/// ```
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Failure {
    text: [u8; Failure::ROOM],
    len: u8,
}

impl Failure {
    /// Maximum length of the text, in bytes.
    pub const ROOM: usize = 112;

    /// Returns the failure with the text of `error`.
    pub fn new(error: &impl Display) -> Self {
        let mut failure = Self { text: [0; Self::ROOM], len: 0 };
        // Text that does not fit is cut off: that is not an error.
        let _ = write!(failure, "{error}");
        failure
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
        core::str::from_utf8(&self.text[..usize::from(self.len)]).unwrap_or_default()
    }
}

impl Write for Failure {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for c in text.chars() {
            let room = &mut self.text[usize::from(self.len)..];
            if c.len_utf8() > room.len() {
                return Err(fmt::Error);
            }
            self.len += c.encode_utf8(room).len() as u8;
        }
        Ok(())
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

impl fmt::Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.text(), f)
    }
}

/// Calls a node. A panic becomes its failure.
#[cfg(all(feature = "std", panic = "unwind"))]
#[inline(always)]
pub fn contain<T>(call: impl FnOnce() -> T) -> Result<T, Failure> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(call)).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
        Failure::new(&text.unwrap_or("panicked"))
    })
}

/// Calls a node. Panics cannot be caught on this target: there is nothing to contain.
#[cfg(not(all(feature = "std", panic = "unwind")))]
#[inline(always)]
pub fn contain<T>(call: impl FnOnce() -> T) -> Result<T, Failure> {
    Ok(call())
}

/// An error that a node may return: its text becomes that of the failure.
#[diagnostic::on_unimplemented(
    message = "a node cannot fail with `{Self}`, which has no text",
    label = "not `Display`",
    note = "implement `Display` for it, or return `Result<T, String>`"
)]
pub trait Explains: Display {}

#[diagnostic::do_not_recommend]
impl<E: Display> Explains for E {}

/// Asks whether a node may return an error.
pub const fn explains<E: Explains>() {}

/// Calls a node that returns a `Result`. An error becomes its failure, as does a panic (see [`contain`]).
#[inline(always)]
pub fn contain_fallible<T, E: Explains>(call: impl FnOnce() -> Result<T, E>) -> Result<T, Failure> {
    contain(call)?.map_err(|error| Failure::new(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_text_is_cut_between_characters() {
        let failure = Failure::new(&"ä".repeat(100));
        assert_eq!(failure.text(), "ä".repeat(56));
    }

    #[cfg(feature = "std")]
    #[test]
    fn a_panic_is_a_failure() {
        let failure = contain(|| {
            if true {
                panic!("no more {}", "paper")
            }
        });
        assert_eq!(failure, Err(Failure::new(&"no more paper")));
    }
}
