//! Failures of nodes: they end the firing, not the program.

use core::fmt::{self, Display, Write};

/// What a node said when it failed: the text of its error or of its panic, as far as there is room for it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Failure {
    text: [u8; Failure::ROOM],
    len: u8,
}

impl Failure {
    /// So many bytes of the text are kept.
    pub const ROOM: usize = 112;

    /// The failure with the text of `error`.
    pub fn new(error: &impl Display) -> Self {
        let mut failure = Self { text: [0; Self::ROOM], len: 0 };
        // What does not fit is left out: that is no failure of its own.
        let _ = write!(failure, "{error}");
        failure
    }

    /// The text.
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

/// Calls a node; a panic is its failure, where panics unwind.
#[cfg(all(feature = "std", panic = "unwind"))]
#[inline(always)]
pub fn contain<T>(call: impl FnOnce() -> T) -> Result<T, Failure> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(call)).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
        Failure::new(&text.unwrap_or("panicked"))
    })
}

/// Calls a node. Where panics do not unwind, there is nothing to contain.
#[cfg(not(all(feature = "std", panic = "unwind")))]
#[inline(always)]
pub fn contain<T>(call: impl FnOnce() -> T) -> Result<T, Failure> {
    Ok(call())
}

/// As [`contain`], for a node that says itself when it fails.
#[inline(always)]
pub fn contain_fallible<T, E: Display>(call: impl FnOnce() -> Result<T, E>) -> Result<T, Failure> {
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
