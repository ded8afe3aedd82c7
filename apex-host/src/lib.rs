//! What the Apex compiler needs from the machine it runs on. The compiler itself is pure; `graph!` and the
//! `apex` command share this crate to give it files and the crates that cargo knows of.

mod disk;
mod kept;
mod workspace;

pub use disk::{Disk, read_from, read_text};
pub use kept::Kept;
pub use workspace::{Seen, Workspace, cargo, name_of, no_cargo};
