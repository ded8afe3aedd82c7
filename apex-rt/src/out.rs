/// The storage of an output that a node writes in place.
///
/// The value written last stays in it, so that a node which refills it (`get_mut`) allocates nothing in
/// steady state. An output that is not written during a firing carries ⊥ ("no message").
#[derive(Debug, Clone)]
pub struct Out<T> {
    value: Option<T>,
    present: bool,
}

impl<T> Out<T> {
    /// An output that holds nothing yet.
    pub const fn new() -> Self {
        Self { value: None, present: false }
    }

    /// Sends `value`.
    #[inline(always)]
    pub fn set(&mut self, value: T) {
        self.value = Some(value);
        self.present = true;
    }

    /// Sends what the returned reference holds in the end. It still holds the value sent last (at first
    /// `T::default()`), so that its storage can be used again.
    #[inline(always)]
    pub fn get_mut(&mut self) -> &mut T
    where
        T: Default,
    {
        self.present = true;
        self.value.get_or_insert_with(T::default)
    }

    /// The value of this firing; `None` is ⊥.
    #[inline(always)]
    pub fn get(&self) -> Option<&T> {
        if self.present { self.value.as_ref() } else { None }
    }

    /// Takes back what was set in this firing: the output carries ⊥.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.present = false;
    }

    /// Called by generated code before a firing.
    #[doc(hidden)]
    #[inline(always)]
    pub fn begin(&mut self) -> &mut Self {
        self.present = false;
        self
    }
}

impl<T> Default for Out<T> {
    fn default() -> Self {
        Self::new()
    }
}
