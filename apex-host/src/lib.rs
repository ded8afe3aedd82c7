//! Access of the Apex compiler to its machine. The compiler itself does no input or output; `graph!` and the `apex`
//! command share this crate, which reads files and asks cargo for crates.

mod disk;
mod kept;
mod workspace;

pub use disk::{Disk, read_from, read_text};
pub use kept::Kept;
pub use workspace::{Seen, Workspace, cargo, name_of, no_cargo};
