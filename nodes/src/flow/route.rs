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

/// First of the values that is not ⊥, in the order of the connections. Joins the branches of [`switch`], and the
/// outputs of nodes that are never active together.
#[node]
pub fn merge<T: Clone, const N: usize>(values: [Option<&T>; N]) -> Option<T> {
    // Small values stay in registers, while references to them would force them into memory.
    if const { size_of::<T>() <= 4 * size_of::<usize>() && !core::mem::needs_drop::<T>() } {
        values.map(|value| value.cloned()).into_iter().fold(None, Option::or)
    } else {
        values.into_iter().find_map(|value| value).cloned()
    }
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
        assert_eq!(merge([Some(&1), Some(&2)]), Some(1));
        assert_eq!(merge([None, None, Some(&2)]), Some(2));
        assert_eq!(merge::<i32, 2>([None, None]), None);
        assert_eq!(merge([None, Some(&vec![2]), Some(&vec![3])]), Some(vec![2]));
    }

    #[test]
    fn merge_undoes_switch() {
        for condition in [true, false] {
            let parted = switch(&3, &condition);
            assert_eq!(merge([parted.on_true.as_ref(), parted.on_false.as_ref()]), Some(3));
        }
    }

    #[test]
    fn select_takes_no_substitute() {
        assert_eq!(select(&true, Some(&1), Some(&2)), Some(1));
        assert_eq!(select(&false, Some(&1), Some(&2)), Some(2));
        assert_eq!(select(&true, None, Some(&2)), None);
    }
}
