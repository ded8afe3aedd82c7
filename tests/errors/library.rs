//! Nodes of another crate: a source file has to import them.
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

    /// Not accessible from outside.
    #[node]
    pub fn faces(x: &u64) -> u64 {
        *x
    }
}
