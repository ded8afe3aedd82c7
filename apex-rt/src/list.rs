/// A list that `each` can iterate over, and the list of the same kind that collects its results.
///
/// ```
/// use apex_rt::List;
///
/// /// Halves all elements, into a list of the same kind.
/// fn halves<L: List<Item = i32>>(list: &L) -> L::Of<f64> {
///     let mut halves = L::Of::<f64>::default();
///     halves.append(list.items().iter().map(|x| f64::from(*x) / 2.0));
///     halves
/// }
///
/// assert_eq!(halves(&vec![1, 2, 3]), [0.5, 1.0, 1.5]);
/// ```
pub trait List {
    /// The type of one element.
    type Item;
    /// The same kind of list with other elements.
    type Of<U>: List<Item = U> + Default;

    /// Returns the elements in order.
    fn items(&self) -> &[Self::Item];
    /// Removes all elements and keeps the storage.
    fn clear(&mut self);
    /// Appends `items`. A list of fixed size panics when it is full; the results of `each` over a list of the same size
    /// always fit.
    fn append(&mut self, items: impl Iterator<Item = Self::Item>);
}

#[cfg(feature = "alloc")]
impl<T> List for alloc::vec::Vec<T> {
    type Item = T;
    type Of<U> = alloc::vec::Vec<U>;

    #[inline(always)]
    fn items(&self) -> &[T] {
        self
    }
    #[inline(always)]
    fn clear(&mut self) {
        alloc::vec::Vec::clear(self);
    }
    #[inline(always)]
    fn append(&mut self, items: impl Iterator<Item = T>) {
        self.extend(items);
    }
}

impl<T, const N: usize> List for heapless::Vec<T, N> {
    type Item = T;
    type Of<U> = heapless::Vec<U, N>;

    #[inline(always)]
    fn items(&self) -> &[T] {
        self
    }
    #[inline(always)]
    fn clear(&mut self) {
        heapless::Vec::clear(self);
    }
    #[inline(always)]
    fn append(&mut self, items: impl Iterator<Item = T>) {
        self.extend(items);
    }
}
