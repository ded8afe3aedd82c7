//! Interface of a node, read from Rust syntax. `#[node]` and the catalog of the compiler share this crate, so that a
//! signature has the same meaning for both.

mod callable;
pub mod fraction;
mod marks;
mod methods;
mod param;
mod types;
pub mod units;

pub use callable::{Arg, Callable, Form, InputForm, Returns, Token, function, generics, params};
pub use marks::{COMPUTED, DEACTIVATES, FAILURE, KEEPS_FRAME, METHOD_MARKS, UNIT, docs, is_node, marked, unit};
pub use methods::{Methods, Slot, methods};
pub use param::ParamDecl;
pub use types::{error_type, option_of};
