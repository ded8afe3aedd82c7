//! Pseudo-random numbers, and with the feature `search` the optimization of parameters by evolution (thesis 3.6.4,
//! 9.3.1): what the nodes of `apex-nodes` and the studies of `apex-tune` have in common.
//!
//! The fitness E(P) of a parameter set is minimized, as in thesis 3.6.4. A [`Search`] proposes a generation of
//! candidates and is told their fitness by number, so that candidates can be evaluated in any order and on any number
//! of threads with the same result. Same seed, same search, on every platform.

#![cfg_attr(not(any(test, feature = "search")), no_std)]

#[cfg(feature = "search")]
mod cma;
#[cfg(feature = "search")]
mod de;
#[cfg(feature = "search")]
mod descent;
#[cfg(feature = "search")]
mod eigen;
mod random;
#[cfg(feature = "search")]
mod search;
#[cfg(feature = "search")]
mod space;
#[cfg(all(test, feature = "search"))]
mod tests;

#[cfg(feature = "search")]
pub use cma::CmaSearch;
#[cfg(feature = "search")]
pub use de::DeSearch;
pub use random::Random;
#[cfg(feature = "search")]
pub use search::{Best, Search, Selection};
#[cfg(feature = "search")]
pub use space::{Axis, BadAxis, Scale, Space};
