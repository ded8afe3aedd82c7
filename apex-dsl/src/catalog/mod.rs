//! Node signatures, read from the Rust sources of the node crates. rustc has the last word on types: the catalog
//! reports a mismatch only if it has seen both definitions.

#[allow(clippy::module_inception, reason = "the catalog itself")]
mod catalog;
mod cfg;
mod collect;
mod constants;
mod crates;
mod docs;
mod impls;
mod items;
pub mod library;
mod lookup;
mod reach;
mod read;
mod rust;
mod signature;
mod structs;
mod traits;
mod tree;
mod ty;
mod types;

pub use catalog::Catalog;
pub use cfg::Conditions;
pub use constants::{Constant, is_path};
pub use crates::{CrateSpec, Crates, RustFiles, Site};
pub use docs::{first_sentence, linkless};
pub use items::{Default as DefaultValue, Item, Limits, Literal};
pub use library::{DURATION, PRIMITIVES, STD, TIME};
pub use read::read as read_items;
pub use signature::{ArgSig, MachineSig, ParamSig, PortSig, ReturnSig, Signature, SignatureId, SlotSig, WaitSig};
pub use structs::{Field, Struct, Structure};
pub use traits::Trait;
pub use tree::{DefId, ModuleId, Need};
pub use ty::Ty;
pub use types::{Match, Type};
