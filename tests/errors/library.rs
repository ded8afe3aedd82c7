//! The nodes of another crate: a text has to import them.
use apex_rt::prelude::*;

#[node]
pub fn edges(x: &u64) -> u64 {
    *x
}

#[node]
pub fn corners(x: &u64) -> u64 {
    *x
}

mod inside {
    use apex_rt::prelude::*;

    /// Nobody outside can name it.
    #[node]
    pub fn faces(x: &u64) -> u64 {
        *x
    }
}
