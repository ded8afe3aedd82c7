//! Atomics and cells for code that threads share. The model checker of the tests replaces this module.

#[cfg(feature = "std")]
pub use core::sync::atomic::{AtomicBool, AtomicUsize};
pub use core::sync::atomic::{AtomicU8, Ordering};

/// A place that several threads can access.
#[derive(Debug, Default)]
pub struct UnsafeCell<T>(core::cell::UnsafeCell<T>);

impl<T> UnsafeCell<T> {
    pub const fn new(value: T) -> Self {
        Self(core::cell::UnsafeCell::new(value))
    }

    #[inline(always)]
    pub fn with_mut<R>(&self, look: impl FnOnce(*mut T) -> R) -> R {
        look(self.0.get())
    }
}
