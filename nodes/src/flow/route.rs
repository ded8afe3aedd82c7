use apex_rt::{Outputs, node};

/// Outputs of [`switch`]: one carries the value, the other ⊥.
#[derive(Debug, Clone, PartialEq, Eq, Outputs)]
pub struct Branches<T> {
    /// The value if the condition is `true`.
    pub on_true: Option<T>,
    /// The value if the condition is `false`.
    pub on_false: Option<T>,
}

/// Sends `value` to the output selected by `condition`; the other output carries ⊥ (thesis 3.6.1).
#[node]
pub fn switch<T: Clone>(value: &T, condition: &bool) -> Branches<T> {
    let value = Some(value.clone());
    if *condition { Branches { on_true: value, on_false: None } } else { Branches { on_true: None, on_false: value } }
}

/// Forwards `value` while `open` is `true`; ⊥ otherwise (thesis 3.6.2).
#[node]
pub fn gate<T: Clone>(value: &T, open: &bool) -> Option<T> {
    open.then(|| value.clone())
}

/// Value of `first`, or of `second` if `first` is ⊥. Joins the branches of [`switch`].
#[node]
pub fn merge<T: Clone>(first: Option<&T>, second: Option<&T>) -> Option<T> {
    first.or(second).cloned()
}

/// Value of `on_true` or `on_false`, selected by `condition`; ⊥ if the selected input is ⊥.
#[node]
pub fn select<T: Clone>(condition: &bool, on_true: Option<&T>, on_false: Option<&T>) -> Option<T> {
    let chosen = if *condition { on_true } else { on_false };
    chosen.cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switch_sends_to_exactly_one_output() {
        assert_eq!(switch(&7, &true), Branches { on_true: Some(7), on_false: None });
        assert_eq!(switch(&7, &false), Branches { on_true: None, on_false: Some(7) });
    }

    #[test]
    fn gate_passes_only_while_open() {
        assert_eq!(gate(&"x", &true), Some("x"));
        assert_eq!(gate(&"x", &false), None);
    }

    #[test]
    fn merge_prefers_the_first() {
        assert_eq!(merge(Some(&1), Some(&2)), Some(1));
        assert_eq!(merge(None, Some(&2)), Some(2));
        assert_eq!(merge::<i32>(None, None), None);
    }

    #[test]
    fn merge_undoes_switch() {
        for condition in [true, false] {
            let parted = switch(&3, &condition);
            assert_eq!(merge(parted.on_true.as_ref(), parted.on_false.as_ref()), Some(3));
        }
    }

    #[test]
    fn select_takes_no_substitute() {
        assert_eq!(select(&true, Some(&1), Some(&2)), Some(1));
        assert_eq!(select(&false, Some(&1), Some(&2)), Some(2));
        assert_eq!(select(&true, None, Some(&2)), None);
    }
}
