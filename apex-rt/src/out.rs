/// Storage of an output that a node writes in place.
///
/// The last value stays in the storage, so that a node which refills it ([`Out::get_mut`]) allocates nothing in steady
/// state. An output that is not written during a firing carries ⊥ ("no message").
///
/// ```
/// use apex_rt::prelude::*;
///
/// /// Keeps the values that are not negative.
/// #[node]
/// fn positive(values: &Vec<f64>, kept: &mut Out<Vec<f64>>) {
///     let kept = kept.get_mut();
///     kept.clear();
///     kept.extend(values.iter().filter(|x| **x >= 0.0));
/// }
///
/// let mut kept = Out::new();
/// positive(&vec![1.0, -2.0, 3.0], &mut kept);
/// assert_eq!(kept.get(), Some(&vec![1.0, 3.0]));
/// ```
#[derive(Debug, Clone)]
pub struct Out<T> {
    value: Option<T>,
    present: bool,
}

impl<T> Out<T> {
    /// Returns an empty output.
    pub const fn new() -> Self {
        Self { value: None, present: false }
    }

    /// Sends `value`.
    #[inline(always)]
    pub fn set(&mut self, value: T) {
        self.value = Some(value);
        self.present = true;
    }

    /// Sends the value that the returned reference holds at the end of the firing. At first it holds the value that was
    /// sent last, or `T::default()`, so that its storage can be reused.
    #[inline(always)]
    pub fn get_mut(&mut self) -> &mut T
    where
        T: Default,
    {
        self.present = true;
        self.value.get_or_insert_with(T::default)
    }

    /// Returns the value of this firing; `None` is ⊥.
    #[inline(always)]
    pub fn get(&self) -> Option<&T> {
        if self.present { self.value.as_ref() } else { None }
    }

    /// Withdraws the value that was set in this firing: the output carries ⊥.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.present = false;
    }

    /// Resets the output to ⊥. Generated code calls this before a firing.
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
