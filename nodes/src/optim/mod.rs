//! Optimization of parameters by evolution (feature `optim`; thesis 3.6.4, 9.3.1).
//!
//! The fitness E(P) of a parameter set is minimized, as in thesis 3.6.4. A [`Search`] proposes a generation of
//! candidates and is told their fitness by number, so that candidates can be evaluated in any order and on any number
//! of threads with the same result. Same seed, same search, on every platform.

mod cma;
mod de;
mod descent;
mod eigen;
mod node;
mod search;
mod space;
#[cfg(test)]
mod tests;

pub use cma::CmaSearch;
pub use de::DeSearch;
pub use node::{BadRanges, Candidate, CmaEs, DifferentialEvolution, MAX_DIMENSIONS, nth};
pub use search::{Best, Search, Selection};
pub use space::{Axis, BadAxis, Scale, Space};
