//! Identifications of goals among those of all programs.

use apex_nodes::action::GoalId;
use std::hash::{DefaultHasher, Hash, Hasher as _};

/// Makes the numbers of a program's goals identifications that no other program has.
pub struct Ids(u64);

impl Ids {
    /// Returns the identifications of a client: the same for the same seed and client.
    pub fn new(seed: u64, client: impl Hash) -> Self {
        let mut hasher = DefaultHasher::new();
        (seed, client).hash(&mut hasher);
        Self(hasher.finish())
    }

    /// Returns the identification of a goal: a UUID of version 4.
    pub fn of(&self, goal: GoalId) -> GoalId {
        let (high, low) = ((goal.0 >> 64) as u64, goal.0 as u64);
        let first = mixed(mixed(self.0 ^ high) ^ low);
        let second = mixed(first ^ self.0.rotate_left(32));
        let bits = u128::from(first) << 64 | u128::from(second);
        let (version, variant) = (0xf000_u128 << 64, 0xc000_u128 << 48);
        GoalId(bits & !version & !variant | 0x4000_u128 << 64 | 0x8000_u128 << 48)
    }
}

/// A bijection that spreads each bit (the last step of SplitMix64).
fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let number = (number ^ number >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ number >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ number >> 31
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn identifications_follow_from_the_seed() {
        let ids = |seed, client| Ids::new(seed, client);
        let of = |ids: Ids| (0..500).map(|goal| ids.of(GoalId(goal << 60))).collect::<Vec<_>>();
        assert_eq!(of(ids(7, "/a")), of(ids(7, "/a")));
        let all: BTreeSet<_> = [ids(7, "/a"), ids(8, "/a"), ids(7, "/b")].into_iter().flat_map(of).collect();
        assert_eq!(all.len(), 1500);
        assert!(all.iter().all(|id| id.0 >> 76 & 15 == 4 && id.0 >> 62 & 3 == 2), "UUIDs of version 4");
    }
}
